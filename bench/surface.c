/* Cost of following the surface of a solid in which nothing breaks, against a step of the solid.
 *
 * The porous medium of POROUS chapter 5 on one rank; `update` gives positions and normals, `turn`
 * the spin. What has to stay small is update over a solid step; goal 0.05. Floor: what the surface
 * is told from and what is told, once each at the triad bandwidth of this run (per surface
 * particle: displacements at the ends of three line elements and its own, 3 indices and 2 vectors
 * to follow them, 2 results).
 * BUILD modules=pd_interface,shape
 * TEST ranks=1 */
#include "bw_bench_porous.h"
#include "bw_bench_solid.h"
#include "bw_memory.h"
#include "bw_pd_interface.h"

#include <math.h>

enum { CALLS = 20 };

typedef struct {
  bw_pd_interface *interface;
  double *spin;
  bw_status st;
} follower;

static void update(void *context)
{
  follower *f = context;
  for (int q = 0; q < CALLS; q++)
    BW_THEN(f->st, bw_pd_interface_update(f->interface));
}

static void turn(void *context)
{
  follower *f = context;
  for (int q = 0; q < CALLS; q++)
    bw_pd_interface_turn(f->interface, f->spin);
}

static bw_status report(bw_bench *b, bw_solid *pd, follower *f)
{
  const bw_comm *comm = bw_bench_comm(b);
  const char *name = "porous_np1";
  const double n = (double)bw_pd_interface_surface(f->interface).n;
  /* 160 bytes a surface particle: what is read and told (head of this file). */
  const double floor_s = n * 160.0 / bw_bench_triad(comm);
  const double updating = bw_bench_median(comm, update, f) / CALLS;
  const double turning = bw_bench_median(comm, turn, f) / CALLS;
  BW_TRY(f->st);
  /* In the same run, on the same clock. */
  const double step = bw_bench_solid_seconds(comm, pd, 4, &f->st);
  const bw_bench_row rows[] = {
      {name, "surface_particles", "-", n, NULL, NAN, NAN},
      {name, "ms_per_solid_step", "ms", 1e3 * step, NULL, NAN, NAN},
      {name, "ms_per_update", "ms", 1e3 * updating, NULL, NAN, 1e3 * floor_s},
      {name, "ms_per_turn", "ms", 1e3 * turning, NULL, NAN, 1e3 * floor_s},
      {name, "update_over_solid_step", "-", updating / step, "the goal", 0.05, NAN}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    bw_bench_put(b, &rows[q]);
  return f->st;
}

static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  bw_pd_interface_config c = bw_pd_interface_config_default();
  bw_solid *pd = NULL;
  follower f = {NULL, NULL, BW_OK};
  c.walled[1][0] = c.walled[1][1] = true;
  c.lower[1] = 0.0, c.upper[1] = bw_bench_height;
  bw_status st = bw_bench_porous(comm, 0.05, &pd);
  BW_THEN(st, bw_pd_interface_create(pd, &c, &f.interface));
  BW_THEN(st, BW_ALLOCATE(&f.spin, 3 * bw_solid_count(pd)));
  BW_THEN(st, report(b, pd, &f));
  bw_pd_interface_destroy(&f.interface);
  bw_solid_destroy(&pd);
  bw_release(&f.spin);
  return st;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "surface", run);
}
