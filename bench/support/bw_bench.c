/* The frame of a benchmark: medians, the triad's bandwidth, rows of JSON. */
#include "bw_bench.h"
#include "bw_folder.h"
#include "bw_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct bw_bench {
  bw_comm *comm;
  FILE *file; /* rank 0 */
  int rows;
};

const bw_comm *bw_bench_comm(const bw_bench *b)
{
  return b->comm;
}

/* JSON has no inf and nan. */
static void put_number(FILE *f, const char *key, double x, const char *end)
{
  if (isfinite(x))
    fprintf(f, "\"%s\": %.6g%s", key, x, end);
  else
    fprintf(f, "\"%s\": null%s", key, end);
}

void bw_bench_put(bw_bench *b, const bw_bench_row *r)
{
  /* Only rank 0 writes. */
  if (b->file == NULL) return;
  const bool rival = r->rival != NULL && isfinite(r->rival_value);
  const double ratio = rival ? r->value / r->rival_value : NAN;
  fprintf(b->file, "%s\n  {\"case\": \"%s\", \"quantity\": \"%s\", ", b->rows++ > 0 ? "," : "",
          r->name, r->quantity);
  put_number(b->file, "value", r->value, ", ");
  fprintf(b->file, "\"unit\": \"%s\", \"rival\": \"%s\", ", r->unit, rival ? r->rival : "");
  put_number(b->file, "rival_value", rival ? r->rival_value : NAN, ", ");
  fprintf(b->file, "\"rival_measured\": \"%s\", ", rival ? "this run" : "");
  put_number(b->file, "floor_value", r->floor_value, ", ");
  put_number(b->file, "ratio_to_rival", ratio, ", ");
  put_number(b->file, "ratio_to_floor", r->value / r->floor_value, "}");
  fflush(b->file);
  /* The same for the eye. */
  printf("%-28s %-28s %10.4g %-12s", r->name, r->quantity, r->value, r->unit);
  if (rival) printf("  %5.2f of %s (%.4g)", ratio, r->rival, r->rival_value);
  if (isfinite(r->floor_value))
    printf("  %5.2f of the floor (%.4g)", r->value / r->floor_value, r->floor_value);
  printf("\n");
  fflush(stdout);
}

static int by_size(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double bw_bench_middle(int n, double x[])
{
  qsort(x, (size_t)n, sizeof *x, by_size);
  return x[n / 2];
}

double bw_bench_median(const bw_comm *comm, void (*work)(void *), void *context)
{
  double seconds[BW_BENCH_REPETITIONS];
  /* Warms up caches and plans. */
  work(context);
  for (int q = 0; q < BW_BENCH_REPETITIONS; q++) {
    bw_comm_barrier(comm);
    const double start = bw_wall_time();
    work(context);
    seconds[q] = bw_wall_time() - start;
  }
  /* A repetition takes as long as its slowest rank. */
  bw_comm_max(comm, BW_BENCH_REPETITIONS, seconds);
  return bw_bench_middle(BW_BENCH_REPETITIONS, seconds);
}

typedef struct {
  double *a, *b, *c;
  size_t n;
} triad_arrays;

static void triad(void *context)
{
  const triad_arrays *t = context;
  double *restrict a = t->a;
  const double *restrict b = t->b, *restrict c = t->c;
#pragma omp simd
  for (size_t i = 0; i < t->n; i++)
    a[i] = b[i] + 0.5 * c[i];
}

double bw_bench_triad(const bw_comm *comm)
{
  triad_arrays t = {.n = (size_t)1 << 25}; /* 256 MiB each: no cache holds them */
  double rate = NAN;
  bw_status st = BW_ALLOCATE(&t.a, t.n);
  BW_THEN(st, BW_ALLOCATE(&t.b, t.n));
  BW_THEN(st, BW_ALLOCATE(&t.c, t.n));
  /* All ranks at once, as they share the memory bus. NaN without memory. */
  if (bw_comm_agree(comm, st) == BW_OK)
    rate = 3.0 * sizeof(double) * (double)t.n / bw_bench_median(comm, triad, &t);
  bw_release(&t.a);
  bw_release(&t.b);
  bw_release(&t.c);
  return rate;
}

static bw_status open_file(bw_bench *b, const char *name)
{
  const char *build = getenv("BW_BUILD_DIR");
  char path[640];
  snprintf(path, sizeof path, "%s/bench", build != NULL ? build : "build");
  BW_TRY(bw_folder_make(b->comm, path));
  if (bw_comm_rank(b->comm) != 0) return BW_OK;
  snprintf(path, sizeof path, "%s/bench/%s.json", build != NULL ? build : "build", name);
  b->file = fopen(path, "w");
  BW_REQUIRE(b->file != NULL, BW_EIO, "%s: cannot be written", path);
  fputs("[", b->file);
  return BW_OK;
}

int bw_bench_main(int argc, char **argv, const char *name, bw_status (*run)(bw_bench *b))
{
  bw_bench b = {0};
  bw_status st = bw_init(&argc, &argv, &b.comm);
  /* Whether the file is there only rank 0 knows. */
  BW_THEN(st, bw_comm_agree(b.comm, open_file(&b, name)));
  BW_THEN(st, run(&b));
  if (b.file != NULL) {
    fputs("\n]\n", b.file);
    const bool whole = !ferror(b.file);
    if (fclose(b.file) != 0 || !whole)
      BW_THEN(st, BW_FAIL(BW_EIO, "%s.json could not be written to the end", name));
  }
  if (st != BW_OK && b.comm != NULL && bw_comm_size(b.comm) > 1) {
    /* maybe on this rank alone, while others wait for it */
    fprintf(stderr, "%s: %s\n", name, bw_last_message());
    bw_comm_abort(b.comm, (int)st);
  }
  return bw_finish(&b.comm, st);
}
