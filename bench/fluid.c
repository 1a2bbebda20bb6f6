/* Cost of the flow solver per cell and sub-step, against what it cannot avoid.
 *
 * Rival: CaNS on the same channel (bench/cans_channel.nml), run just before by
 * `./run bench fluid --rival cans=PATH`; without it none. Floor: the words a sub-step must move
 * (below) at the triad bandwidth, and its transforms by FFTW's measured plans on numbers in the
 * cache; both timed in this run, on all ranks at once.
 * bytes_per_cell: growth of the resident memory on creation, Poisson's buffers and plans included.
 * Messages: what grid counts, over the least: one face of u, v, w, p per side, two transposes of a
 * field. projection_1e4: the same counts on 100 x 100 ranks, docs/scaling.md.
 * BUILD modules=ns_channel libs=fftw
 * TEST ranks=2 */
#include "bw_bench.h"
#include "bw_memory.h"
#include "bw_ns_channel.h"

#include <fftw3.h>
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Words per cell and sub-step that cannot be avoided when no array stays in cache: momentum reads
 * u v w p R(3), writes u* v* w* R(3) (13); divergence reads 3, writes 1 (4); two transforms and a
 * tridiagonal solve each way read and write phi (10); correction reads phi u v w p, writes u v w p
 * (9). Implicit y reads and writes u (6); all implicit reads u, reads and writes the change twice,
 * and reads and writes u (21). */
static const double WORDS = 13 + 4 + 10 + 9;
static const double IMPLICIT_WORDS[] = {
    [BW_VISCOUS_EXPLICIT] = 0, [BW_VISCOUS_IMPLICIT_Y] = 6, [BW_VISCOUS_IMPLICIT] = 21};

typedef struct {
  const char *name;
  int n[3];
  double length[3];
  bool inout;
  bw_ns_viscous viscous;
  int steps;
} fluid_case;

/* ---- the rival ---- */

enum { CANS_STEPS = 24, CANS_WARM = 4 }; /* of its run; those that are not counted */

/* Median time of its steps, core-ns per cell and sub-step, from the log of its run on this many
 * ranks; NaN where it was not run. */
static double cans(const fluid_case *c, int ranks)
{
  const char *build = getenv("BW_BUILD_DIR");
  char path[640], line[256];
  double seconds[CANS_STEPS];
  int steps = 0;
  snprintf(path, sizeof path, "%s/bench/cans/%s.log", build != NULL ? build : "build", c->name);
  FILE *log = ranks == 2 ? fopen(path, "r") : NULL;
  if (log == NULL) return NAN;
  /* A headline, and on the next line mean, least and largest time over the ranks. */
  while (steps < CANS_STEPS && fgets(line, sizeof line, log) != NULL)
    if (strstr(line, "elapsed time") != NULL && fgets(line, sizeof line, log) != NULL &&
        sscanf(line, "%*f %*f %lf", &seconds[steps]) == 1)
      steps++;
  fclose(log);
  if (steps < CANS_STEPS) return NAN;
  const double cells = (double)c->n[0] * c->n[1] * c->n[2];
  return 1e9 * bw_bench_middle(CANS_STEPS - CANS_WARM, seconds + CANS_WARM) * ranks / (3.0 * cells);
}

/* ---- transforms ---- */

#ifdef BW_SINGLE
#define BW_FFT(name) fftwf_##name
#else
#define BW_FFT(name) fftw_##name
#endif

typedef struct {
  BW_FFT(plan) plan[2];
} fft_pair;

static void run_pair(void *context)
{
  const fft_pair *p = context;
  for (int q = 0; q < 50; q++)
    for (int way = 0; way < 2; way++)
      BW_FFT(execute)(p->plan[way]);
}

/* Seconds per number of a forward and a backward transform of ROWS rows of n reals, or of complex
 * numbers: of few enough that they stay in the cache. */
static bw_status transform_time(const bw_comm *comm, int n, bool real, double *seconds)
{
  enum { ROWS = 16 };
  const int half = real ? n / 2 + 1 : n, size = real ? 2 * half : 2 * n;
  bw_real *a = NULL;
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&a, (size_t)ROWS * (size_t)size)));
  BW_FFT(complex) *z = (BW_FFT(complex) *)a;
  fft_pair p;
  /* Plans are measured, which overwrites the arrays: they are cleared afterwards. */
  for (int way = 0; way < 2; way++)
    if (!real)
      p.plan[way] = BW_FFT(plan_many_dft)(1, &n, ROWS, z, NULL, 1, n, z, NULL, 1, n,
                                          way == 0 ? FFTW_FORWARD : FFTW_BACKWARD, FFTW_MEASURE);
  if (real) {
    p.plan[0] =
        BW_FFT(plan_many_dft_r2c)(1, &n, ROWS, a, NULL, 1, size, z, NULL, 1, half, FFTW_MEASURE);
    p.plan[1] =
        BW_FFT(plan_many_dft_c2r)(1, &n, ROWS, z, NULL, 1, half, a, NULL, 1, size, FFTW_MEASURE);
  }
  memset(a, 0, sizeof *a * ROWS * (size_t)size);
  /* 50 pairs of transforms of all rows; a pair per number. */
  *seconds = bw_bench_median(comm, run_pair, &p) / (50.0 * ROWS * n);
  for (int way = 0; way < 2; way++)
    BW_FFT(destroy_plan)(p.plan[way]);
  bw_release(&a);
  return BW_OK;
}

/* A cell's share of the transforms: one real number along x, half a complex one along z. */
static bw_status transforms_per_cell(const bw_comm *comm, const int n[3], double *seconds)
{
  double x, z;
  BW_TRY(transform_time(comm, n[0], true, &x));
  BW_TRY(transform_time(comm, n[2], false, &z));
  *seconds = x + 0.5 * (n[0] + 2.0) / n[0] * z;
  return BW_OK;
}

/* ---- a case ---- */

typedef struct {
  bw_ns_channel *ns;
  double dt;
  int steps;
  bw_status st;
} fluid_work;

static void advance(void *context)
{
  fluid_work *w = context;
  for (int q = 0; q < w->steps; q++)
    BW_THEN(w->st, bw_ns_channel_step(w->ns, w->dt));
}

static void start(const double x[3], double t, void *context, double u[3])
{
  const double *L = context, y = x[1] / L[1];
  (void)t;
  u[0] = 6.0 * y * (1.0 - y) * (1.0 + 0.1 * sin(6.2831853 * x[2] / L[2]));
  u[1] = u[2] = 0.0;
}

static bw_status create(const bw_comm *comm, const fluid_case *c, bw_grid **grid,
                        bw_ns_channel **ns)
{
  bw_grid_config g = bw_grid_config_default();
  bw_ns_channel_config f = bw_ns_channel_config_default();
  /* A periodic channel at constant flow rate, or one from inflow to outflow. */
  for (int d = 0; d < 3; d++)
    g.n[d] = c->n[d], g.length[d] = c->length[d];
  g.periodic[0] = !c->inout, g.periodic[2] = true;
  f.nu = 1.0 / 5600.0;
  f.viscous = c->viscous;
  f.side[2][0].kind = f.side[2][1].kind = BW_SIDE_PERIODIC;
  if (c->inout) {
    f.side[0][0] = (bw_ns_side){
        .kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 1.0};
    f.side[0][1].kind = BW_SIDE_OUTFLOW;
  } else {
    f.side[0][0].kind = f.side[0][1].kind = BW_SIDE_PERIODIC;
    f.forcing = BW_FORCING_FLOW_RATE;
    f.forcing_value = 1.0;
  }
  BW_TRY(bw_grid_create(comm, &g, grid));
  BW_TRY(bw_ns_channel_create(*grid, &f, ns));
  return bw_ns_channel_set_velocity(*ns, start, (void *)(uintptr_t)c->length, 0.0);
}

/* What a sub-step sends, of this rank, over the least. */
static void put_messages(bw_bench *b, const fluid_case *c, bw_grid *grid, fluid_work *w)
{
  const bw_grid_view *g = bw_grid_look(grid);
  bw_grid_sent halo[2], swap[2];
  /* What grid has counted before and after a few steps. */
  bw_grid_traffic(grid, &halo[0], &swap[0]);
  advance(w);
  bw_grid_traffic(grid, &halo[1], &swap[1]);
  const double substeps = 3.0 * w->steps, cells = (double)g->m[0] * g->m[1] * g->m[2];
  const double away = 1.0 - 1.0 / g->ranks[2];
  /* The least: one face of four fields, two transposes of what is not on the rank already. */
  bw_bench_put(b, &(bw_bench_row){c->name, "halo_bytes_per_substep", "B",
                                  (double)(halo[1].bytes - halo[0].bytes) / substeps, NULL, NAN,
                                  4.0 * (double)bw_halo_volume(grid)});
  bw_bench_put(b, &(bw_bench_row){c->name, "swap_bytes_per_substep", "B",
                                  (double)(swap[1].bytes - swap[0].bytes) / substeps, NULL, NAN,
                                  2.0 * away * cells * sizeof(bw_real)});
  bw_bench_put(b, &(bw_bench_row){c->name, "messages_per_substep", "",
                                  (double)(halo[1].messages - halo[0].messages + swap[1].messages -
                                           swap[0].messages) /
                                      substeps,
                                  NULL, NAN, NAN});
}

/* *ns_per_cell: nanoseconds of one core. `name`: of the rows. */
static bw_status measure(bw_bench *b, const bw_comm *comm, const char *name, const fluid_case *c,
                         double triad, double *ns_per_cell)
{
  bw_grid *grid = NULL;
  fluid_work w = {.steps = c->steps};
  double transforms = NAN;
  malloc_trim(0); /* what the case before freed must not count as there already */
  /* Resident memory before and after creation. */
  double bytes = -(double)bw_memory_resident();
  bw_status st = create(comm, c, &grid, &w.ns);
  bytes += (double)bw_memory_resident();
  BW_THEN(st, transforms_per_cell(comm, c->n, &transforms));
  /* Half the limit: the field stays as it is over all repetitions. */
  if (st == BW_OK) {
    bw_comm_sum(comm, 1, &bytes);
    w.dt = 0.5 * bw_ns_channel_dt_max(w.ns);
    const double cells = (double)c->n[0] * c->n[1] * c->n[2];
    const double words = WORDS + IMPLICIT_WORDS[c->viscous];
    /* Core-time: wall time of the slowest rank, times the number of ranks. */
    *ns_per_cell =
        1e9 * bw_bench_median(comm, advance, &w) * bw_comm_size(comm) / (3.0 * c->steps * cells);
    bw_bench_put(b, &(bw_bench_row){name, "core_ns_per_cell_substep", "ns", *ns_per_cell, "CaNS",
                                    cans(c, bw_comm_size(comm)),
                                    1e9 * (words * sizeof(bw_real) / triad + transforms)});
    bw_bench_put(b, &(bw_bench_row){name, "bytes_per_cell", "B", bytes / cells, NULL, NAN, NAN});
    bw_bench_put(b,
                 &(bw_bench_row){name, "floor_transforms", "ns", 1e9 * transforms, NULL, NAN, NAN});
    if (bw_comm_size(comm) > 1) put_messages(b, c, grid, &w);
    st = w.st;
  }
  bw_ns_channel_destroy(&w.ns);
  bw_grid_destroy(&grid);
  return st;
}

/* The same case on rank 0 alone, while the others wait; speed-up of all ranks over it. */
static bw_status scaling(bw_bench *b, const char *name, const fluid_case *c, double triad,
                         double core_ns)
{
  const bw_comm *comm = bw_bench_comm(b);
  bw_comm *self = NULL;
  double alone = NAN;
  bw_status st = BW_OK;
  /* The others wait in the agreement below. */
  if (bw_comm_rank(comm) == 0) {
    st = bw_comm_self(&self);
    BW_THEN(st, measure(b, self, name, c, triad, &alone));
    bw_comm_destroy(&self);
  }
  bw_bench_put(b, &(bw_bench_row){c->name, "speedup_over_one_rank", "",
                                  alone * bw_comm_size(comm) / core_ns, NULL, NAN, NAN});
  return bw_comm_agree(comm, st);
}

/* docs/scaling.md: 4096 x 2048 x 2048 cells on 100 x 100 ranks. */
static void projection(bw_bench *b, double core_ns)
{
  const double n[3] = {4096, 2048, 2048}, ranks[2] = {100, 100};
  const double latency = 2e-6, bandwidth = 25e9 / 64.0; /* of a link that 64 ranks share [B/s] */
  const double m1 = n[1] / ranks[0], m2 = n[2] / ranks[1], cells = n[0] * m1 * m2;
  /* Numbers sent by a rank in a sub-step: halos, lines of the tridiagonal solve, transposes. */
  const double halo = 9.0 * n[0] * (m1 + m2), lines = 8.0 * n[0] * m2 * (1.0 - 1.0 / ranks[0]);
  const double transposes = 2.0 * cells * (1.0 - 1.0 / ranks[1]);
  const double messages = 10.0 + 2.0 * (ranks[0] - 1.0) + 2.0 * (ranks[1] - 1.0) +
                          2.0 * log2(ranks[0] * ranks[1]); /* two sums over all ranks */
  /* Work as measured here; the network's latency and bandwidth are assumed. */
  const double work = 1e-9 * core_ns * cells, wait = messages * latency;
  const double transfer = 8.0 * (halo + lines + transposes) / bandwidth;
  const bw_bench_row rows[] = {
      {"projection_1e4", "work_per_substep", "ms", 1e3 * work, NULL, NAN, NAN},
      {"projection_1e4", "latency_per_substep", "ms", 1e3 * wait, NULL, NAN, NAN},
      {"projection_1e4", "transfer_per_substep", "ms", 1e3 * transfer, NULL, NAN,
       1e3 * 8.0 * (8.0 * n[0] * (m1 + m2) + transposes) / bandwidth},
      {"projection_1e4", "parallel_efficiency", "", work / (work + wait + transfer), NULL, NAN,
       NAN}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_bench_put(b, &rows[q]);
}

static bw_status run(bw_bench *b)
{
  enum { LARGE, CHANNEL, INOUT, IMPLICIT_Y, IMPLICIT, CASES };
  const double pi = 3.14159265358979323846;
  fluid_case cases[CASES];
  for (int q = 0; q < CASES; q++)
    cases[q] = (fluid_case){.n = {128, 64, 64}, .length = {2, 1, 1}, .steps = 10};
  cases[LARGE] = (fluid_case){.n = {192, 128, 160}, .length = {2 * pi, 1, pi}, .steps = 2};
  cases[LARGE].name = "channel_192x128x160_np2";
  cases[CHANNEL].name = "channel_128x64x64_np2";
  cases[INOUT].name = "inout_128x64x64_np2", cases[INOUT].inout = true;
  cases[IMPLICIT_Y].name = "implicit_y_128x64x64_np2";
  cases[IMPLICIT_Y].viscous = BW_VISCOUS_IMPLICIT_Y;
  cases[IMPLICIT].name = "implicit_128x64x64_np2";
  cases[IMPLICIT].viscous = BW_VISCOUS_IMPLICIT;
  const bw_comm *comm = bw_bench_comm(b);
  /* Bandwidth in this very run: what the floor is made of. */
  const double triad = bw_bench_triad(comm);
  double ns[CASES];
  bw_bench_put(
      b, &(bw_bench_row){"triad", "bandwidth_per_rank", "GB/s", 1e-9 * triad, NULL, NAN, NAN});
  for (int q = 0; q < CASES; q++)
    BW_TRY(measure(b, comm, cases[q].name, &cases[q], triad, &ns[q]));
  bw_bench_put(b, &(bw_bench_row){cases[IMPLICIT].name, "price_over_explicit", "",
                                  ns[IMPLICIT] / ns[CHANNEL], NULL, NAN, NAN});
  /* The same cases on one rank. */
  BW_TRY(scaling(b, "channel_128x64x64_np1", &cases[CHANNEL], triad, ns[CHANNEL]));
  BW_TRY(scaling(b, "channel_192x128x160_np1", &cases[LARGE], triad, ns[LARGE]));
  projection(b, ns[LARGE]);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "fluid", run);
}
