/* Cost of plates that break.
 *
 * branching_16000: the plate of cases/crack_branching, 1000 steps with the search for its tip.
 *
 * plate_3d_1000000: 500 x 200 x 10 particles, m = 3, on one rank and on two; speedup is the ratio
 * of their times. Memory: growth of the resident memory on creation. Floor of a step as in
 * bench/solid.c, with positions and velocities read and written.
 *
 * broken_48x32x32: a block cut by planes; rival: the same block whole. A step must not cost more
 * when bonds are gone, but for contact across the cuts (broken_contact).
 *
 * halo_48x32x32: copies of other ranks' particles; floor: the three layers at the cut.
 *
 * BUILD modules=solid,solid_tools,pd_interface,shape
 * TEST ranks=2 */
#include "../cases/notched_plate/specimen.c" /* the case's own plate, not a second one */
#include "../cases/notched_plate/specimen_crack.c"
#include "../cases/notched_plate/specimen_input.c"
#include "../cases/notched_plate/specimen_plan.c"
#include "bw_bench_solid.h"
#include "bw_shape.h"

#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 3 };

static bw_status box(const bw_comm *comm, const int size[3], double m, bool contact, bw_solid **pd)
{
  bw_solid_config c = bw_solid_config_default();
  c.ds = 1e-3, c.rho = 3000, c.E = 1e8, c.G0 = 1.0, c.horizon_ratio = m;
  c.contact = contact;
  /* A block of whole particles. */
  const bw_shape block = {.kind = BW_SHAPE_BOX,
                          .upper = {size[0] * c.ds, size[1] * c.ds, size[2] * c.ds}};
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(c.ds, c.origin, false);
  bw_status st = bw_shape_fill_shared(comm, 1, &block, &lattice, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create(comm, &c, &(bw_pd_sites){n, site, kind, NULL}, pd));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static double ms_per_step(const bw_comm *comm, bw_solid *pd, bw_status *st)
{
  return 1e3 * bw_bench_solid_seconds(comm, pd, STEPS, st);
}

static void put(bw_bench *b, const char *name, const char *quantity, const char *unit, double value,
                const char *rival, double rival_value, double floor)
{
  bw_bench_put(b, &(bw_bench_row){name, quantity, unit, value, rival, rival_value, floor});
}

typedef struct {
  const bw_comm *comm;
  specimen_config config;
  bw_status st;
} plate_work;

static void tear(void *context)
{
  plate_work *w = context;
  specimen p;
  memset(&p, 0, sizeof p);
  BW_THEN(w->st, specimen_create(w->comm, &w->config, &p));
  for (int step = 0; w->st == BW_OK && step < 1000; step++)
    w->st = specimen_step(&p);
  specimen_destroy(&p);
}

static bw_status branching(bw_bench *b, const bw_comm *self)
{
  plate_work w = {self, specimen_default(), BW_OK};
  char path[1024];
  const char *root = getenv("BW_SOURCE_DIR");
  snprintf(path, sizeof path, "%s/cases/crack_branching/crack_branching.yaml",
           root != NULL ? root : ".");
  BW_TRY(bw_config_load(self, path, specimen_fields, 0, NULL, sizeof w.config, &w.config));
  put(b, "branching_16000_np1", "seconds_per_1000_steps", "s", bw_bench_median(self, tear, &w),
      NULL, NAN, NAN);
  return w.st;
}

static bw_status broken(bw_bench *b, const bw_comm *self, bool contact)
{
  const char *name = contact ? "broken_contact_48x32x32_np1" : "broken_48x32x32_np1";
  const int size[3] = {48, 32, 32};
  bw_solid *pd = NULL;
  BW_TRY(box(self, size, 3.0, contact, &pd));
  bw_solid_ledger e = {0};
  bw_status st = bw_solid_account(pd, &e);
  const int64_t bonds = e.bonds;
  const double whole = ms_per_step(self, pd, &st);
  /* Cut by planes every four spacings, then timed against itself when it was whole. */
  for (int cut = 4; cut < size[0] && st == BW_OK; cut += 4) {
    const double x = 1e-3 * cut, far = 1;
    st = bw_solid_precrack(pd, (double[3]){x, -far, -far}, (double[3]){x, far, -far},
                           (double[3]){x, -far, far});
  }
  BW_THEN(st, bw_solid_account(pd, &e));
  if (st == BW_OK) {
    const double part = 1 - (double)e.bonds / (double)bonds;
    const double ms = ms_per_step(self, pd, &st);
    put(b, name, "broken_fraction", "-", part, NULL, NAN, NAN);
    put(b, name, "ms_per_step", "ms", ms, "the same block whole", whole, NAN);
  }
  bw_solid_destroy(&pd);
  return st;
}

static bw_status halo(bw_bench *b, const bw_comm *comm)
{
  const int size[3] = {48, 32, 32};
  bw_solid *pd = NULL;
  BW_TRY(box(comm, size, 3.0, false, &pd));
  /* Copies of others' particles, on the rank that has most. */
  double copies = (double)(bw_solid_get_extended(pd).n - bw_solid_count(pd));
  bw_comm_max(comm, 1, &copies);
  put(b, "halo_48x32x32_np2", "copies_per_rank", "-", copies, NULL, NAN, 3.0 * 32 * 32);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status million(bw_bench *b, const bw_comm *comm, const char *name, double triad,
                         double *ms)
{
  const int size[3] = {500, 200, 10};
  bw_solid *pd = NULL;
  double before = -(double)bw_memory_resident(), lists;
  bw_status st = box(comm, size, 3.0, false, &pd);
  if (st != BW_OK) return st;
  /* Resident memory by which creation grew it. */
  before += (double)bw_memory_resident(), lists = (double)bw_solid_list_bytes(pd);
  bw_comm_sum(comm, 1, &before);
  bw_comm_sum(comm, 1, &lists);
  const double n = (double)bw_solid_total(pd);
  /* Floor: lists once, positions and velocities in and out. */
  const double moved = lists + n * 12.0 * sizeof(bw_real); /* X, V in and out */
  *ms = ms_per_step(comm, pd, &st);
  put(b, name, "ms_per_step", "ms", *ms, NULL, NAN, 1e3 * moved / (triad * bw_comm_size(comm)));
  put(b, name, "bytes_per_particle", "B", before / n, NULL, NAN, NAN);
  bw_solid_ledger e = {0};
  BW_THEN(st, bw_solid_account(pd, &e));
  put(b, name, "bonds", "-", (double)e.bonds, NULL, NAN, NAN);
  bw_solid_destroy(&pd);
  return st;
}

static bw_status alone(bw_bench *b, const bw_comm *self, double triad, double *ms)
{
  BW_TRY(branching(b, self));
  BW_TRY(broken(b, self, false));
  BW_TRY(broken(b, self, true));
  return million(b, self, "plate_3d_1000000_np1", triad, ms);
}

static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  const double triad = bw_bench_triad(comm);
  double one = NAN, two = NAN;
  bw_comm *self = NULL;
  bw_status st = bw_comm_self(&self);
  /* Rank 0 alone first. */
  if (bw_comm_rank(comm) == 0) BW_THEN(st, alone(b, self, triad, &one));
  st = bw_comm_agree(comm, st); /* the others wait here */
  bw_comm_destroy(&self);
  if (st != BW_OK || bw_comm_size(comm) != 2) return st;
  BW_TRY(halo(b, comm));
  BW_TRY(million(b, comm, "plate_3d_1000000_np2", triad, &two));
  put(b, "plate_3d_1000000_np2", "speedup", "-", one / two, NULL, NAN, 2);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "plates", run);
}
