/* bw_pd_levels.h -- bodies whose levels change while they move: which cells are fine, and what of
 * the old particles goes into the new ones.
 *
 * The unit is a cell of the coarsest lattice: all particles in it are of one level, so that a map
 * of one byte per cell (bw_pd_map) says everything. It is the same on all ranks, small beside the
 * particles, and follows from maxima alone: a body is divided into levels alike on any number of
 * ranks. A body of another map is built anew and takes over the motion, cell by cell:
 *
 *   finer    f_c = f_p + G (x_c - x_p), G by least squares over the intact family of the parent
 *   coarser  the mean of the parts, which have one mass
 *   as was   taken over, with the bonds that are broken
 *
 * Momentum and centre of mass are kept to rounding, refining and coarsening at once gives back what
 * there was (ADAPT 3.2.4 with ERRATA-ADAPT 13). Energy changes, which whoever calls books.
 * Units    as in bw_pd_body.h. */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* pd_levels_map.c */

/* *map is of the cells around all sites that the ranks give, all of level 0. Periodic axes have one
 * cell per spacing of the period. The caller releases it. BW_EMEM; BW_EINPUT for a body beyond 2^20
 * cells each way or 2^31 in all. Collective. */
bw_status bw_pd_levels_map_create(const bw_comm *comm, const bw_pd_body_config *config,
                                  const bw_pd_sites *given, int finest,
                                  bw_pd_map *map) BW_MUST_CHECK;
void bw_pd_levels_map_release(bw_pd_map *map);   /* NULL inside is fine. Local. */
size_t bw_pd_levels_cells(const bw_pd_map *map); /* of the map. Local. */
/* Number of the cell in the map of a site of the coarsest lattice. Local. */
size_t bw_pd_levels_cell(const bw_pd_map *map, const int32_t site[3]);
/* Number of the cell that an own particle of a body of several levels is in. Local. */
size_t bw_pd_levels_cell_of(const bw_pd_body *pd, const bw_pd_map *map, size_t i);

/* Sets flag (cells) wherever a flag is set within `width` cells each way. BW_EMEM. Local. */
bw_status bw_pd_levels_widen(const bw_pd_body_config *config, const bw_pd_map *map, int width,
                             uint8_t flag[]) BW_MUST_CHECK;

/* Raises levels until two cells whose levels differ by more than one are farther apart than the
 * horizon of the coarser one. BW_EMEM. Local. */
bw_status bw_pd_levels_balance(const bw_pd_body_config *config, bw_pd_map *map) BW_MUST_CHECK;

/* Raises the cells that a box meets to its level, without belts. Local. */
void bw_pd_levels_fill(const bw_pd_body_config *config, const bw_pd_box *box, bw_pd_map *map);

/* pd_levels_transfer.c: pure functions of one cell. */

enum {
  BW_PD_LEVELS_VECTORS = 3
}; /* displacement [L], velocity [L/T], force over density [L/T^2] */

/* What a particle takes along. */
typedef struct {
  double f[BW_PD_LEVELS_VECTORS][3]; /* its vectors */
  double G[2][9]; /* gradients of the first two, [3 k + d] of component k along d: read where the
                     cell is refined */
  uint8_t kind;   /* bits of bw_pd_body.h */
} bw_pd_levels_rider;

/* G (9) of the least squares sum weight |df - G xi|^2 over n neighbours, xi (n,3) [L], df (n,3);
 * zero where they do not span the space. Local. */
void bw_pd_levels_gradient(int dimension, size_t n, const double weight[], const double xi[],
                           const double df[], double G[9]);

/* The particles of one cell of the coarsest lattice, of spacing ds along `axes`, at level `from`
 * (2^(dimension from) of them, each split's parts x first) -> at level `to`. Local. */
void bw_pd_levels_recast(int dimension, double ds, const double axes[3][3], int from, int to,
                         const bw_pd_levels_rider before[], bw_pd_levels_rider after[]);

/* pd_levels_move.c */

/* The motion, forces, broken bonds and the law's saved fields of a body of one map go to a body of
 * the same sites, of which the ranks gave the same parts, and of another map; fields are 0 in cells
 * whose level changes. The new body's displacements are 0 before. BW_EMEM, the same on all ranks.
 * Collective. */
bw_status bw_pd_levels_move(bw_pd_body *from, const bw_pd_map *old, const bw_pd_sites *given,
                            const bw_pd_map *now, bw_pd_body *to) BW_MUST_CHECK;

/* pd_levels_trigger.c */

/* What a particle says of its bonds. */
enum {
  BW_PD_LEVELS_WARM = 1, /* it is beyond `warm` */
  BW_PD_LEVELS_HOT = 2   /* it is beyond `hot`, or will soon be half way from there to its limit */
};

/* How near a particle is to breaking. */
typedef enum {
  BW_PD_LEVELS_STRETCH, /* stretch over the critical one of the finest level, where alone it may
                           break; the largest of the family */
  BW_PD_LEVELS_ENERGY,  /* its energy per volume over the largest of all, ADAPT 3.2.1: for
                           comparison, what it says depends on loads and notches */
  BW_PD_LEVELS_DAMAGE   /* its damage: for comparison, it comes after the first bond has broken */
} bw_pd_levels_trigger;

/* What is looked for. */
typedef struct {
  bw_pd_levels_trigger trigger; /* by what */
  double hot, warm;             /* 0 .. 1 */
  double time; /* that counts as soon, of stretches: their ends go on at their speed [T] */
} bw_pd_levels_glance;

/* flag (n) of the own particles of a body whose forces are of the present motion; 0 of those that
 * are retired, and of bonds that do not break. BW_EMEM. Collective. */
bw_status bw_pd_levels_look(bw_pd_body *pd, const bw_pd_levels_glance *glance,
                            uint8_t flag[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
