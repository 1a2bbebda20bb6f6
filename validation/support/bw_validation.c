#include "bw_validation.h"
#include "bw_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct bw_validation {
  bw_comm *comm;
  const char *name;
  char folder[512];
  FILE *file; /* rank 0 */
  bool full;
  int rows, failed;
};

static const char *kind_name(bw_claim_kind kind)
{
  static const char *const names[] = {"analytic", "published", "independent-code", "conservation",
                                      "order"};
  return names[kind];
}

const bw_comm *bw_validation_comm(const bw_validation *v)
{
  return v->comm;
}

bool bw_validation_full(const bw_validation *v)
{
  return v->full;
}

const char *bw_validation_folder(const bw_validation *v)
{
  return v->folder;
}

double bw_validation_order(double h1, double e1, double h2, double e2)
{
  return log(e1 / e2) / log(h1 / h2);
}

static bool read_row(const char *line, int columns, double row[])
{
  char *end = NULL;
  for (int q = 0; q < columns; q++, line = end + 1) {
    row[q] = strtod(line, &end);
    if (end == line || (q + 1 < columns && *end != ',')) return false;
  }
  return true;
}

bw_status bw_validation_table(const char *file, int columns, int most, double table[], int *rows)
{
  enum { MOST_COLUMNS = 32 };
  const char *root = getenv("BW_SOURCE_DIR");
  char path[512], line[1024];
  double row[MOST_COLUMNS];
  snprintf(path, sizeof path, "%s/data/%s", root != NULL ? root : ".", file);
  BW_REQUIRE(columns <= MOST_COLUMNS, BW_EINPUT, "%s: more than %d columns", path, MOST_COLUMNS);
  FILE *in = fopen(path, "r");
  BW_REQUIRE(in != NULL, BW_EIO, "cannot read %s (set BW_SOURCE_DIR to the source folder)", path);
  *rows = 0;
  while (fgets(line, sizeof line, in) != NULL) {
    if (!read_row(line, columns, row)) continue;
    if (*rows < most)
      memcpy(table + (size_t)columns * (size_t)*rows, row, (size_t)columns * sizeof *row);
    ++*rows;
  }
  fclose(in);
  BW_REQUIRE(*rows > 0 && *rows <= most, BW_EINPUT, "%s: %d rows of %d numbers, 1 to %d expected",
             path, *rows, columns, most);
  return BW_OK;
}

/* JSON has no inf and nan. */
static void put_number(FILE *f, const char *key, double x)
{
  if (isfinite(x))
    fprintf(f, "\"%s\": %.10g, ", key, x);
  else
    fprintf(f, "\"%s\": null, ", key);
}

static void put_row(bw_validation *v, const bw_claim *c, double error, bool pass)
{
  fprintf(v->file, "%s\n  {\"claim\": \"%s\", \"quantity\": \"%s\", ", v->rows > 0 ? "," : "",
          c->claim, c->quantity);
  put_number(v->file, "measured", c->measured);
  put_number(v->file, "reference", c->reference);
  put_number(v->file, "error", error);
  put_number(v->file, "tolerance", c->tolerance);
  if (c->extra != NULL) fprintf(v->file, "%s, ", c->extra);
  fprintf(v->file, "\"kind\": \"%s\", \"source\": \"%s\", \"pass\": %s}", kind_name(c->kind),
          c->source, pass ? "true" : "false");
  fflush(v->file);
  printf("%-4s %-58s measured %- .6e reference %- .6e error %.1e tolerance %.1e%s%s\n",
         pass ? "ok" : "FAIL", c->claim, c->measured, c->reference, error, c->tolerance,
         c->extra != NULL ? "  " : "", c->extra != NULL ? c->extra : "");
}

bool bw_validation_row(bw_validation *v, const bw_claim *c)
{
  const double difference = fabs(c->measured - c->reference);
  const double error = c->reference != 0.0 ? difference / fabs(c->reference) : difference;
  const bool pass = error <= c->tolerance; /* false for NaN */
  if (v->file != NULL) put_row(v, c, error, pass);
  v->rows++;
  v->failed += !pass;
  return pass;
}

/* Make every folder of a path; those that exist are fine. */
static void make_folders(const char *path)
{
  char part[512];
  snprintf(part, sizeof part, "%s", path);
  for (char *slash = strchr(part + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    mkdir(part, 0777);
    *slash = '/';
  }
  mkdir(part, 0777);
}

static bw_status open_file(bw_validation *v)
{
  const char *build = getenv("BW_BUILD_DIR");
  char path[640];
  snprintf(v->folder, sizeof v->folder, "%s/verification", build != NULL ? build : "build");
  if (bw_comm_rank(v->comm) != 0) return BW_OK;
  make_folders(v->folder);
  snprintf(path, sizeof path, "%s/%s.json", v->folder, v->name);
  v->file = fopen(path, "w");
  BW_REQUIRE(v->file != NULL, BW_EIO, "cannot write %s", path);
  fputs("[", v->file);
  return BW_OK;
}

int bw_validation_main(int argc, char **argv, const char *name, bw_status (*run)(bw_validation *v))
{
  bw_validation v = {.name = name};
  bw_status st = bw_init(&argc, &argv, &v.comm);
  for (int a = 1; a < argc; a++)
    v.full |= strcmp(argv[a], "--full") == 0;
  BW_THEN(st, bw_comm_agree(v.comm, open_file(&v)));
  BW_THEN(st, run(&v));
  if (v.file != NULL) {
    fputs("\n]\n", v.file);
    const bool whole = !ferror(v.file);
    if (fclose(v.file) != 0 || !whole)
      BW_THEN(st, BW_FAIL(BW_EIO, "%s/%s.json could not be written to the end", v.folder, name));
    printf("%s: %d of %d claims hold\n", name, v.rows - v.failed, v.rows);
  }
  if (st != BW_OK && v.comm != NULL && bw_comm_size(v.comm) > 1) {
    /* maybe on this rank alone, while others wait for it */
    fprintf(stderr, "%s: %s\n", name, bw_last_message());
    bw_comm_abort(v.comm, (int)st);
  }
  const int code = bw_finish(&v.comm, st);
  return code != 0 ? code : v.failed > 0 || v.rows == 0;
}
