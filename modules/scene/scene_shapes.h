/* scene_shapes.h -- bodies of a scene as shapes on a lattice; shared inside `scene`. */
#pragma once
#include "bw_shape.h"
#include "scene_internal.h"

/* Two for an image and its cut, and those of a body that is taken away. */
enum { BW_SCENE__SHAPES = 4 * BW_SCENE_PARTS };

/* The shapes of one body; masks are owned. */
typedef struct {
  int n;
  bw_shape shape[BW_SCENE__SHAPES];
  int part[BW_SCENE__SHAPES]; /* number of the part in the file; of `minus`: that one */
  int n_masks;
  bw_shape_mask *mask[BW_SCENE_PARTS];
  double lower[3], upper[3]; /* extent of what is added [L] */
  bool analytic;             /* no masks: it has a true surface */
} bw_scene__shapes;

/* In place of the number of a body: the fluid of particles. */
enum { BW_SCENE__FLUID = -1 };

/* Shapes of body b, or of the fluid; images are opened (their headers read), surfaces read.
 * BW_EINPUT names the key; BW_EIO, BW_EMEM. Release also after a failure. Local. */
bw_status bw_scene__shapes_make(const bw_scene_config *c, int b,
                                bw_scene__shapes *out) BW_MUST_CHECK;
void bw_scene__shapes_release(bw_scene__shapes *s);

/* Where one shape ends (3), (3); infinite where it does not. Local. */
void bw_scene__shape_extent(const bw_shape *s, double lower[3], double upper[3]);

/* Is the scene flat? */
static inline bool bw_scene__planar(const bw_scene_config *c)
{
  return c->plane != BW_SCENE_SPACE;
}

/* A side "y_upper": its direction 0, 1, 2 and end 0, 1. False: no such side. */
bool bw_scene__side_named(const char *name, int *d, int *end);

/* Is x (3) in the half-open box, ties within 1e-6 of `spacing` not by rounding? */
bool bw_scene__in_box(const bw_scene_box *box, bool planar, double spacing, const double x[3]);
