/* scene_quantity.h -- what gauges can measure; shared inside `scene`. */
#pragma once
#include "scene_internal.h"

/* What a gauge needs to be told and where its values come from. */
typedef enum {
  BW_SCENE__OF_PLACE,  /* particles of a body: nearest, region, or all */
  BW_SCENE__OF_BODIES, /* one or more bodies as a whole */
  BW_SCENE__OF_SOLIDS, /* bodies or, without `body`, all solids */
  BW_SCENE__OF_POINT,  /* a place in the fluid: point, line or slice */
  BW_SCENE__OF_FLUID   /* all of the fluid */
} bw_scene__source;

enum { BW_SCENE__COMPONENTS = 9 }; /* of a quantity, at most */

typedef struct {
  const char *word; /* NULL ends the table */
  bw_scene__source source;
  int n;                                       /* components, in three dimensions */
  bool vector;                                 /* x, y, z: two in two dimensions */
  const char *component[BW_SCENE__COMPONENTS]; /* "": the gauge's name alone */
  const char *unit;
} bw_scene__quantity;

extern const bw_scene__quantity bw_scene__quantities[];

/* The row of a word as asked of this gauge (velocity is of bodies or of points); NULL: none. */
const bw_scene__quantity *bw_scene__quantity_named(const bw_scene_gauge_config *g,
                                                   const char *word);
/* Is a place given? */
bool bw_scene__given(const double x[3]);
