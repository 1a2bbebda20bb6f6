/* pd_refine.h -- which cells of a body are split (pd_refine.c). */
#pragma once
#include "bw_pd_body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What particles there are once boxes have split cells. */
typedef struct {
  bw_pd_sites
      sites;     /* of them; site holds places as pd_level.h says, with one level lattice sites */
  int32_t *site; /* (n,3) owned, as the next three; NULL: those that were given */
  uint8_t *kind, *group;
  uint8_t *level; /* (n) row of the table of levels; NULL: all 0 */
} bw_pd_refined;

/* Sites of the lattice -> particles; to be released also after a failure. BW_EMEM, BW_EINPUT.
 * Local. */
bw_status bw_pd_body_refine(const bw_pd_body_config *config, const bw_pd_sites *given,
                            bw_pd_refined *out) BW_MUST_CHECK;
void bw_pd_body_refined_release(bw_pd_refined *refined);

/* The largest level of a box or of the map; 0: there is neither. Local. */
int bw_pd_body_finest(const bw_pd_body_config *config);

#ifdef __cplusplus
}
#endif
