/* Memory that making a solid takes at its peak, rank by rank: bytes are counted, not seconds.
 *
 * By hand with any number of particles (the figures of a body of four million):
 *   mpirun -n 4 build/bin/test_solid_memory 4e6
 * BUILD modules=shape
 * TEST ranks=2,4 timeout=600 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid.h"

#include <stdio.h>
#include <stdlib.h>

enum { FEW = 1000 }; /* particles: what any such program takes */

#ifdef __SANITIZE_ADDRESS__ /* slow, and it keeps what was freed: nothing is compared then */
static double asked = 1e4;
#else
/* Particles. On four ranks the share is a cube of 63 particles across, which with the copies of
 * three layers on two of its sides is 10 % more; with much fewer the copies alone would fill the
 * fifth. */
static double asked = 1e6;
#endif

/* A block as nearly a cube as n allows; returns its particles. */
static double block_of(double n, bw_shape *block)
{
  const double across = round(cbrt(n)), along = round(n / (across * across));
  *block = (bw_shape){.kind = BW_SHAPE_BOX, .upper = {along, across, across}};
  return along * across * across;
}

/* Makes a solid of about n particles on the ranks of comm, each of which fills its part of the
 * body, and lets it go; returns the peak of this rank's memory so far [bytes]. Collective. */
static double peak_of(const bw_comm *comm, double n)
{
  bw_shape block;
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  int64_t sites = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const double particles = block_of(n, &block);
  c.ds = 1.0, c.rho = 1.0, c.E = 1.0, c.G0 = 1.0;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(c.ds, c.origin, false);
  bw_check_ok(bw_shape_fill_shared(comm, 1, &block, &lattice, &sites, &site, &kind, NULL));
  bw_check_ok(bw_solid_create(comm, &c, &(bw_pd_sites){sites, site, kind, NULL}, &pd));
  bw_release(&site);
  bw_release(&kind);
  ck_assert_double_eq((double)bw_solid_total(pd), particles);
  bw_solid_destroy(&pd);
  return (double)bw_memory_peak();
}

/* A rank's share of a body takes what a body of that size takes alone, and a fifth more for the
 * copies of its neighbours' particles and for uneven shares. */
START_TEST(memory_falls_with_the_number_of_ranks)
{
  const bw_comm *world = bw_check_world();
  const int me = bw_comm_rank(world), size = bw_comm_size(world);
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  (void)peak_of(self, FEW);
  const double before = peak_of(world, FEW);
  const double alone = peak_of(self, asked / size) - before;
  const double together = peak_of(world, asked) - before;
  for (int r = 0; r < size; r++) {
    bw_comm_barrier(world);
    if (r == me)
      printf("rank %d of %d: %.1f MiB for its share of %.0f particles (%.0f bytes for each of the "
             "share), %.1f MiB for a body of that size alone\n",
             me, size, together / 1048576.0, asked, together * size / asked, alone / 1048576.0);
    fflush(stdout);
  }
  bw_comm_destroy(&self);
  const double most = 1.2 * alone;
  ck_assert_double_gt(alone, 0.0);
#ifdef __SANITIZE_ADDRESS__
  (void)most;
#else
  ck_assert_double_le(together, most);
#endif
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(memory_falls_with_the_number_of_ranks)};

int main(int argc, char **argv)
{
  if (argc > 1) asked = strtod(argv[1], NULL);
  return bw_check_run(argc, argv, "solid.solid_memory", sizeof tests / sizeof *tests, tests);
}
