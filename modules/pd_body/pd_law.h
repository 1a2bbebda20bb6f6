/* pd_law.h -- the socket of a law: how a body answers to its deformation.
 *
 * A law is one struct of functions; the table of those that a case file can name is solid/laws.c. A
 * step calls each function once per sweep, never per bond. docs/add-a-law.md is a law with text
 * around it. Helpers: pd_walk.h (bonds one by one), pd_springs.h (all members of a law of springs
 * from one function), pd_sweep.h (BW_PD_LANES bonds at a time).
 * All functions are local unless they say Collective; none allocates but prepare. */
#pragma once
#include "bw_pd_body.h"
#include "pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Blocks are as wide as the library was compiled for. A law compiled for another width would read
 * them wrongly, so the linker does not find this name: compile it with the library's flags. */
static const char *const bw_pd_law_fits __attribute__((used)) = &BW_PD_LANES_NAME(BW_PD_LANES);

enum { BW_PD_SWEEPS = 4 }; /* passes of one evaluation, at most */

/* A key of the law's options, for lists of what a law can be told (bw_solid_laws_describe). */
typedef struct {
  const char *name;    /* its word in a case file */
  const char *unit;    /* "" without one */
  const char *meaning; /* a phrase, with the default */
} bw_pd_law_key;

/* Passes over the blocks first .. last-1. The last pass of a law leaves the acceleration by
 * internal forces, L/rho, in pd->a. check (never while pd->breakage is off): it also notes in
 * pd->bonds.hit (from n_hit on, which it raises) the blocks that hold a bond beyond its limit.
 * damping: it also fills pd->load.damp with the pair damping (asked only of a law that `damps`). */
typedef void (*bw_pd_sweep)(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);

struct bw_pd_law {
  const char *name;          /* its word in a case file */
  const bw_pd_law_key *keys; /* ends with a NULL name */

  /* Refuses what the law cannot be: Poisson's ratio, geometry, its own options. BW_EINPUT with key,
   * value and remedy. */
  bw_status (*check)(const bw_pd_body_config *config, const void *options);
  /* The law's own state (pd->state, which destroy releases, also half built) and its fields, once
   * the body stands; Poisson's ratio in pd->config where it was left out. The status is the same on
   * all ranks. `options` is borrowed during the call. Collective. */
  bw_status (*prepare)(bw_pd_body *pd, const void *options);
  /* Of a body whose levels changed, once the saved fields of cells that kept their level are those
   * of the body before and all others are 0: what prepare left out as config.finer.later says.
   * fresh (n): own particles of cells that changed; NULL: all saved fields are those of a
   * checkpoint, and what follows from them is made anew. NULL: prepare did all. Collective. */
  bw_status (*settle)(bw_pd_body *pd, const bool fresh[]);
  /* The law's columns of the kernel rows from pd->config.material: after prepare and settle, and
   * after every change of it. */
  void (*constants)(bw_pd_body *pd);

  int n_sweep; /* 1 .. BW_PD_SWEEPS; after each the body sends the fields that named it */
  bw_pd_sweep sweep[BW_PD_SWEEPS]; /* (n_sweep) */
  bool damps;                      /* its last sweep can do the pair damping on the way */
  bool levels;                     /* it knows bonds between particles of different spacing */

  /* Breaks what is beyond its limit in one block; a law of one pass takes its force out of pd->a,
   * after one of several all passes follow. The energy that the owners' halves of these bonds held
   * is added to pd->bonds.released (bw_pd_body_cut does that). Unbreakable ends keep their bonds.
   * Both ends have to decide alike. Returns whether any broke. */
  bool (*breaks)(bw_pd_body *pd, bw_pd_block *block);
  /* The state of the last evaluation is what later ones start from: at the end of a step or a
   * relaxation, before bonds break. NULL: no memory, or one that comes out the same however often a
   * state is evaluated. */
  void (*accept)(bw_pd_body *pd);
  /* Energy of the bond of a lane of a slot, the owner's half [M L^2/T^2]. */
  double (*bond_energy)(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                        int lane);
  /* Elastic energy that the given lanes of a block hold [M L^2/T^2]; summed over all blocks and
   * ranks every bond counts once. Its fields are those of the last evaluation. */
  double (*energy)(const bw_pd_body *pd, const bw_pd_block *block, uint8_t lanes);
  /* Energy dissipated inside particles so far [M L^2/T^2]; NULL: none. */
  double (*dissipated)(const bw_pd_body *pd);

  /* pd->frequency2: a bound of the square of the largest angular frequency [1/T^2]. Collective. */
  bw_status (*bound)(bw_pd_body *pd);
  /* kx (n,3) <- K x of the own particles: minus the force density linearised about the reference
   * shape, bonds that hold only; x in storage arrays, copies current [M/(L^2 T^2)]. A law of
   * several passes may send values on the way: then it is collective. */
  void (*tangent)(const bw_pd_body *pd, bw_real *const x[3], double kx[]);
  /* row (n) <- half of the sum over a particle's bonds of their stiffness: with these masses and
   * unit step no frequency of a state that holds is above 2 (Gershgorin); never 0, see
   * bw_pd_body_fill_rows [M/(L^3 T^2)]. */
  void (*rows)(const bw_pd_body *pd, double row[]);
  /* Adds J times the Cauchy stress at a lane of a block [M/(L T^2)]. */
  void (*virial)(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3]);
  /* Micromodulus that contact takes its stiffness from, of a group [M/(L^5 T^2)]. */
  double (*micromodulus)(const bw_pd_body *pd, int group);

  void (*destroy)(bw_pd_body *pd); /* pd->state; may find it half built */
};

/* A field of the law at every particle: storage arrays that the body keeps, sends and saves. */
struct bw_pd_field {
  int after;      /* the pass after which copies get it from their owners; -1: never */
  bool saved;     /* it goes into a checkpoint: the own particles' values */
  bw_real *value; /* storage array, zero at first */
};

/* One more field, to be asked for in prepare; *value is borrowed until the body is destroyed.
 * BW_EMEM; BW_EINPUT beyond BW_PD_FIELDS. Local. */
bw_status bw_pd_body_add_field(bw_pd_body *pd, int after, bool saved,
                               bw_real **value) BW_MUST_CHECK;
/* settle of the law, where it has one, and what follows from it. Collective. */
bw_status bw_pd_body_settle(bw_pd_body *pd, const bool fresh[]) BW_MUST_CHECK;
/* All passes over all blocks, with what is sent between them. Collective when there are several. */
void bw_pd_body_internal_force(bw_pd_body *pd, bool check, bool damping);
/* What the last checked pass noted is broken; pd->bonds.hit keeps the blocks that changed. Returns
 * whether any did. With a law of several passes a is evaluated anew when one did on any rank:
 * Collective; else local. */
bool bw_pd_body_break_hits(bw_pd_body *pd);
/* Elastic energy of this rank's halves [M L^2/T^2]. Local. */
double bw_pd_body_elastic(const bw_pd_body *pd);
/* A block's force densities to pd->a, over the owners' densities. Local. */
void bw_pd_body_put_acceleration(bw_pd_body *pd, const bw_pd_block *block,
                                 double L[BW_PD_LANES][3]);
/* Rows that are 0, of particles without bonds, get what the stiffest particle has. Local. */
void bw_pd_body_fill_rows(const bw_pd_body *pd, double row[]);

#ifdef __cplusplus
}
#endif
