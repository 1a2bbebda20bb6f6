/* bw_shape_pack.h -- random packs of balls (discs in 2D), by random sequential addition.
 *
 * Centres are drawn evenly from the box, radii evenly between the two given; a ball nearer than
 * `gap` to one that lies already is drawn again. The same seed gives the same pack everywhere
 * (GSL's mt19937). */
#pragma once
#include "bw_shape.h"

typedef struct {
  double lower[3], upper[3];     /* box of the centres [L]                     required */
  double radius_min, radius_max; /* [L]                                        required */
  double gap;       /* least distance of surfaces [L]; negative: may overlap, default 0 */
  double fraction;  /* sum of the balls' volumes over the box's   required */
  bool planar;      /* discs: z is ignored                        default false */
  bool periodic[3]; /* balls go on at the other side              default false */
  uint64_t seed;    /*                                            default 1 */
  int max_attempts; /* for one ball                               default 100000 */
} bw_shape_pack_config;
bw_shape_pack_config bw_shape_pack_config_default(void);

/* Spheres as shapes, to be added or removed (`remove` false; the caller may change it), with the
 * images of balls that reach over a periodic side; the first *balls are the balls themselves.
 * *shape
 * (*count) is the caller's (bw_release). BW_EINPUT names what is impossible, and when a ball finds
 * no place the fraction reached. Balls are compared with all others: meant for up to some 10^4.
 * Local. */
bw_status bw_shape_pack_spheres(const bw_shape_pack_config *config, int *balls, int *count,
                                bw_shape **shape) BW_MUST_CHECK;
