/* Cost of a peridynamic force evaluation per directed bond, on one rank and on all.
 *
 * Block 48 x 32 x 32, family |xi| < 3.015 ds: bonds on the lattice and as a cloud, the ordinary law
 * and correspondence, and that with 26 neighbours (|xi| < 2 ds). All but the last may break. Rival:
 * LAMMPS, styles peri/pmb, peri/lps and smd/tlsph, on the same block (bench/lammps_block.in,
 * bench/lammps_tlsph.in), run just before by `./run bench solid` when the executable lmp is there
 * (Debian package lammps, which has no smd/tlsph), or another one by `--rival lammps=PROGRAM`.
 * Floor: positions read once and forces written once per particle, and the bond lists read once, at
 * the triad bandwidth of this run.
 * BUILD modules=solid,solid_tools,shape
 * TEST ranks=2 */
#include "bw_bench_solid.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_solid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEPS = 5 };

/* The last "Loop time of T on N procs for M steps" of a run of LAMMPS, ms per step; NaN where there
 * is none. */
static double lammps(const char *name, int ranks)
{
  const char *build = getenv("BW_BUILD_DIR");
  char path[640], line[256];
  double seconds, ms = NAN;
  int procs, steps;
  snprintf(path, sizeof path, "%s/bench/lammps_%s_np%d.log", build != NULL ? build : "build", name,
           ranks);
  FILE *log = fopen(path, "r");
  while (log != NULL && fgets(line, sizeof line, log) != NULL)
    if (sscanf(line, "Loop time of %lf on %d procs for %d", &seconds, &procs, &steps) == 3)
      ms = 1e3 * seconds / steps;
  if (log != NULL) fclose(log);
  return ms;
}

/* What is timed: bonds, or a state-based law that may break, on the same block. */
typedef struct {
  const char *name;
  int law; /* bw_solid_law_row */
  double horizon_ratio, disorder;
  const char *style, *rival; /* of LAMMPS, and its run of `./run bench`; or NULL */
} block;

static bw_status measure(bw_bench *b, const bw_comm *comm, const block *what, double triad)
{
  const char *name = what->name;
  char rival[40] = "";
  if (what->rival != NULL) snprintf(rival, sizeof rival, "LAMMPS %s", what->style);
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {0.048, 0.032, 0.032}};
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  c.ds = 1e-3, c.rho = 3000, c.E = 1e8, c.G0 = 1.0;
  c.horizon_ratio = what->horizon_ratio;
  /* 122 neighbours; of short weights 26, which nothing may break (a correspondence solid). */
  if (what->horizon_ratio > 2) c.family_reach = BW_PD_REACH_HORIZON;
  if (what->horizon_ratio < 2) c.G0 = INFINITY;
  c.disorder = what->disorder;
  c.choice.law = what->law;
  if (what->law != BW_SOLID_BOND) c.choice.poisson_ratio = 0.3;
  const bw_shape_lattice lattice = bw_shape_lattice_straight(c.ds, c.origin, false);
  bw_status st = bw_shape_fill_shared(comm, 1, &box, &lattice, &n, &site, &kind, NULL);
  bw_solid_ledger e;
  BW_THEN(st, bw_solid_create(comm, &c, &(bw_pd_sites){n, site, kind, NULL}, &pd));
  BW_THEN(st, bw_solid_account(pd, &e));
  /* Each bond is evaluated from both of its ends. */
  if (st == BW_OK) {
    const double bonds = 2.0 * (double)e.bonds;
    const double seconds = bw_bench_solid_seconds(comm, pd, STEPS, &st);
    double bytes = (double)bw_solid_list_bytes(pd);
    bw_comm_sum(comm, 1, &bytes);
    /* Floor: lists, positions read and forces written once. */
    const double moved = bytes + (double)bw_solid_total(pd) * 6.0 * sizeof(bw_real);
    bw_bench_put(
        b, &(bw_bench_row){name, "ms_per_force_evaluation", "ms", 1e3 * seconds,
                           what->rival == NULL ? NULL : rival,
                           what->rival == NULL ? NAN : lammps(what->rival, bw_comm_size(comm)),
                           1e3 * moved / (triad * bw_comm_size(comm))});
    bw_bench_put(b, &(bw_bench_row){name, "ns_per_directed_bond", "ns",
                                    1e9 * seconds * bw_comm_size(comm) / bonds, NULL, NAN, NAN});
    bw_bench_put(b, &(bw_bench_row){name, "ns_per_particle_step", "ns",
                                    1e9 * seconds * bw_comm_size(comm) / (double)bw_solid_total(pd),
                                    NULL, NAN, NAN});
    bw_bench_put(
        b, &(bw_bench_row){name, "bytes_per_directed_bond", "B", bytes / bonds, NULL, NAN, NAN});
  }
  bw_solid_destroy(&pd);
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static bw_status run(bw_bench *b)
{
  const bw_comm *comm = bw_bench_comm(b);
  const double triad = bw_bench_triad(comm);
  bw_comm *self = NULL;
  bw_status st = bw_comm_self(&self);
  /* Rank 0 alone: a block on the lattice, the same as a cloud, and by the state-based laws. */
  static const block alone[] = {
      {"block_48x32x32_np1", BW_SOLID_BOND, 3.015, 0, "peri/pmb", "pmb"},
      {"cloud_48x32x32_np1", BW_SOLID_BOND, 3.015, 0.3, NULL, NULL},
      {"lps_48x32x32_np1", BW_SOLID_ORDINARY, 3.015, 0, "peri/lps", "lps"},
      {"state_48x32x32_np1", BW_SOLID_CORRESPONDENCE, 3.015, 0, "smd/tlsph", "tlsph_122"},
      {"state_short_48x32x32_np1", BW_SOLID_CORRESPONDENCE, 1.5, 0, "smd/tlsph", "tlsph_26"}};
  for (int q = 0; bw_comm_rank(comm) == 0 && q < 5; q++)
    BW_THEN(st, measure(b, self, &alone[q], triad));
  st = bw_comm_agree(comm, st); /* the others wait here */
  const block both = {"block_48x32x32_np2", BW_SOLID_BOND, 3.015, 0, "peri/pmb", "pmb"};
  if (bw_comm_size(comm) == 2) BW_THEN(st, measure(b, comm, &both, triad));
  bw_comm_destroy(&self);
  return st;
}

int main(int argc, char **argv)
{
  return bw_bench_main(argc, argv, "solid", run);
}
