/* bw_solid_levels.h -- levels that change while a solid moves: config.finer.refine.level > 0.
 *
 * Cells of the coarsest lattice are refined and coarsened as wholes; around fine ones lie belts of
 * the levels between. After a change count, ids and the order of particles are new ones and
 * bw_solid_revision is raised: whoever holds lists of particles makes them anew. What moves is
 * taken over through the parents (bw_pd_levels.h), the external force too; broken bonds and
 * pre-cracks stay, a drag goes. The change of energy is booked as `regrid`. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One level for boxes, the least one elsewhere: level 0, or that of config.finer.box. Cells within
 * a horizon of a bond that broke stay as fine as can be. BW_EINPUT unless levels change, or for a
 * box without extent; BW_EMEM; the solid is then as it was. Collective. */
bw_status bw_solid_regrid(bw_solid *solid, int n, const bw_pd_box box[]) BW_MUST_CHECK;

/* Between two steps: looks, where it is time, whether cells have to be refined or may be coarsened,
 * and does it; *changed: there are other particles now. No look is due before a wave has come from
 * the fine cells' middle to within a horizon of their edge; a step that finds an overdue one is
 * refused (BW_EINPUT). Levels that stay as they are: nothing. Errors as above. Collective. */
bw_status bw_solid_adapt(bw_solid *solid, bool *changed) BW_MUST_CHECK;

/* part (n) <- which part of each family's bonds, by number, the pre-cracks cut: 0 but where levels
 * change. Local. */
void bw_solid_get_precut(const bw_solid *solid, double part[]);

/* What a checkpoint needs of levels that change: state (bw_solid_levels_numbers) <- cells, looks,
 * book; 0 numbers where they do not. The same on all ranks. Local. */
size_t bw_solid_levels_numbers(const bw_solid *solid);
void bw_solid_get_levels(const bw_solid *solid, double state[]);
/* The way back, before bits and rows: the solid has the levels of the state then. BW_EINPUT for
 * levels that it cannot have; errors as above. Collective. */
bw_status bw_solid_set_levels(bw_solid *solid, const double state[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
