/* bw_shape_pack.h -- random packs of balls (discs in 2D), by random sequential addition.
 *
 * Centres are drawn evenly from the box, radii evenly between the two given; a ball nearer than
 * `gap` to one that lies already is drawn again. The same seed gives the same pack everywhere
 * (GSL's mt19937), so that ranks which call alike hold the same shapes. */
#pragma once
#include "bw_shape.h"
#ifdef __cplusplus
extern "C" {
#endif

/* What a user chooses. */
typedef struct {
  double lower[3], upper[3]; /* corners of the box of the centres [L]           required */
  double radius_min;         /* the smallest radius [L]                         required */
  double radius_max;         /* the largest, which may be the same [L]          required */
  double gap;                /* least distance of surfaces [L]; negative: they may overlap by it,
                              *                                                 default 0 */
  double fraction;           /* sum of the balls' volumes over the box's [-]    required */
  bool planar;               /* discs: z is ignored                             default false */
  bool periodic[3];          /* balls go on at the other side                   default false */
  uint64_t seed;             /* of the random numbers                           default 1 */
  int max_attempts;          /* places tried for one ball                       default 100000 */
} bw_shape_pack_config;

/* Defaults; what is required is NaN and refused by name where it stays so. Local. */
bw_shape_pack_config bw_shape_pack_config_default(void);

/* Spheres as shapes, to be added or removed (`remove` is false; the caller may change it), with the
 * images of balls that reach over a periodic side; the first *balls are the balls themselves.
 * *shape (*count) is the caller's (bw_release). BW_EINPUT names what is impossible, and when a ball
 * finds no place the fraction reached; BW_EMEM. Each ball is compared with all others, and filling
 * asks each ball about each site: meant for up to some 10^4. Local. */
bw_status bw_shape_pack_spheres(const bw_shape_pack_config *config, int *balls, int *count,
                                bw_shape **shape) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
