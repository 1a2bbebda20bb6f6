/* Cost of a step of the particle fluid per particle: a column of water that has begun to fall, in
 * two and three dimensions, with walls, diffusion, viscosity, shifting and the making of lists.
 *
 * No rival is run and no floor given: lists and records of neighbours stay in the second cache.
 * BUILD modules=ulph,shape
 * TEST ranks=2 */
#include "bw_bench.h"
#include "bw_memory.h"
#include "bw_ulph.h"

#include <math.h>

enum { STEPS = 10, BEGIN = 30 };

/* A column of water in a corner of a tank three times as long. */
static bw_status column(const bw_comm *comm, int d, int n, bw_ulph **u)
{
  bw_ulph_config c = bw_ulph_config_default();
  c.dimensions = d, c.dx = 1.0 / n, c.rho0 = 1000, c.speed = 6.3, c.gravity[1] = -9.81;
  const double wide = d == 3 ? 0.5 : 0, thick = 4 * c.dx, origin[3] = {0};
  const bw_shape water = {.kind = BW_SHAPE_BOX, .upper = {1, 1, wide}};
  const bw_shape wall[2] = {{.kind = BW_SHAPE_BOX,
                             .lower = {-thick, -thick, -thick},
                             .upper = {3 + thick, 1.5, wide + thick}},
                            {.kind = BW_SHAPE_BOX, .remove = true, .upper = {3, 9, wide}}};
  const bw_ulph_wall walls = {.count = 2, .shape = wall};
  size_t count = 0;
  double *x = NULL;
  bw_status st = bw_ulph_fill(comm, &c, origin, 1, &water, &count, &x);
  BW_THEN(st, bw_ulph_create(comm, &c, count, x, 1, &walls, u));
  bw_release(&x);
  return st;
}

/* Some steps, as work to be timed. */
typedef struct {
  bw_ulph *u;
  int steps;
  bw_status st;
} work;

static void advance(void *context)
{
  work *w = context;
  for (int q = 0; q < w->steps; q++)
    BW_THEN(w->st, bw_ulph_step(w->u, bw_ulph_dt_max(w->u)));
}

static bw_status measure(bw_bench *b, const bw_comm *comm, const char *name, int d, int n)
{
  work w = {NULL, BEGIN, BW_OK};
  BW_TRY(column(comm, d, n, &w.u));
  /* Until particles move against each other and lists are made as often as later. */
  advance(&w);
  w.steps = STEPS;
  const double seconds = bw_bench_median(comm, advance, &w) / STEPS;
  const double particles = (double)bw_ulph_total(w.u);
  bw_bench_put(b, &(bw_bench_row){name, "ns_per_particle_step", "ns", 1e9 * seconds / particles,
                                  NULL, NAN, NAN});
  bw_ulph_destroy(&w.u);
  return w.st;
}

static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  bw_comm *self = NULL;
  bw_status st = bw_comm_self(&self);
  /* Rank 0 alone, then all. */
  if (bw_comm_rank(comm) == 0) BW_THEN(st, measure(b, self, "column_2d_np1", 2, 160));
  if (bw_comm_rank(comm) == 0) BW_THEN(st, measure(b, self, "column_3d_np1", 3, 32));
  st = bw_comm_agree(comm, st); /* the others wait here */
  if (bw_comm_size(comm) == 2) BW_THEN(st, measure(b, comm, "column_3d_np2", 3, 32));
  bw_comm_destroy(&self);
  return st;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "particles", run);
}
