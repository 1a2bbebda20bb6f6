/* Cost of the flow solver per cell and sub-step, against the bytes it has to move.
 *
 * Rival: CaNS (gfortran -O3 -march=native, explicit RK3, double), measured on a machine of this
 * kind with two ranks; the median of quiet and typical runs. Floor: the words a sub-step must move
 * (below) at the triad bandwidth measured in this run.
 * bytes_per_cell: growth of the resident memory on creation, Poisson's buffers and plans included.
 * BUILD modules=ns_channel
 * TEST ranks=2 */
#include "bw_bench.h"
#include "bw_memory.h"
#include "bw_ns_channel.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>

/* Words per cell and sub-step that cannot be avoided when no array stays in cache: momentum reads
 * u v w p R(3), writes u* v* w* R(3) (13); divergence reads 3, writes 1 (4); two transforms and a
 * tridiagonal solve each way read and write phi (10); correction reads phi u v w p, writes u v w p
 * (9). */
static const double WORDS = 13 + 4 + 10 + 9;

typedef struct {
  const char *name;
  int n[3];
  double length[3];
  bool inout;
  bw_ns_viscous viscous;
  int steps;
  double rival, rival_bytes;
} fluid_case;

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

static bw_status measure(bw_bench *b, const fluid_case *c, double triad)
{
  const bw_comm *comm = bw_bench_comm(b);
  bw_grid *grid = NULL;
  fluid_work w = {.steps = c->steps};
  bw_grid_config g = bw_grid_config_default();
  bw_ns_channel_config f = bw_ns_channel_config_default();
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
  malloc_trim(0); /* what the case before freed must not count as there already */
  double bytes = -(double)bw_memory_resident();
  bw_status st = bw_grid_create(comm, &g, &grid);
  BW_THEN(st, bw_ns_channel_create(grid, &f, &w.ns));
  BW_THEN(st, bw_ns_channel_set_velocity(w.ns, start, (void *)(uintptr_t)c->length, 0.0));
  if (st == BW_OK) {
    bytes += (double)bw_memory_resident();
    bw_comm_sum(comm, 1, &bytes);
    w.dt = 0.5 * bw_ns_channel_dt_max(w.ns);
    const double seconds = bw_bench_median(comm, advance, &w);
    const double cells = (double)c->n[0] * c->n[1] * c->n[2];
    const double ns = 1e9 * seconds * bw_comm_size(comm) / (3.0 * c->steps * cells);
    bw_bench_put(b, &(bw_bench_row){c->name, "core_ns_per_cell_substep", "ns", ns, "CaNS", c->rival,
                                    1e9 * WORDS * sizeof(bw_real) / triad});
    bw_bench_put(b, &(bw_bench_row){c->name, "bytes_per_cell", "B", bytes / cells, "CaNS",
                                    c->rival_bytes, NAN});
    st = w.st;
  }
  bw_ns_channel_destroy(&w.ns);
  bw_grid_destroy(&grid);
  return st;
}

static bw_status run(bw_bench *b)
{
  const double pi = 3.14159265358979323846;
  const fluid_case cases[] = {
      {"channel_192x128x160_np2",
       {192, 128, 160},
       {2 * pi, 1, pi},
       false,
       BW_VISCOUS_EXPLICIT,
       2,
       115,
       147},
      {"channel_128x64x64_np2", {128, 64, 64}, {2, 1, 1}, false, BW_VISCOUS_EXPLICIT, 10, 102, 203},
      {"inout_128x64x64_np2", {128, 64, 64}, {2, 1, 1}, true, BW_VISCOUS_EXPLICIT, 10, 102, 203},
      {"implicit_y_128x64x64_np2",
       {128, 64, 64},
       {2, 1, 1},
       false,
       BW_VISCOUS_IMPLICIT_Y,
       10,
       143,
       203},
  };
  const double triad = bw_bench_triad(bw_bench_comm(b));
  bw_bench_put(
      b, &(bw_bench_row){"triad", "bandwidth_per_rank", "GB/s", 1e-9 * triad, NULL, NAN, NAN});
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++)
    BW_TRY(measure(b, &cases[q], triad));
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "fluid", run);
}
