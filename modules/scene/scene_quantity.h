/* scene_quantity.h -- what gauges can measure; shared inside `scene`. */
#pragma once
#include "scene_internal.h"

/* What a gauge needs to be told and where its values come from. */
typedef enum {
  BW_SCENE__OF_PLACE,  /* particles of a body: nearest, region, or all */
  BW_SCENE__OF_RIGID,  /* one rigid body */
  BW_SCENE__OF_BODIES, /* one or more bodies as a whole */
  BW_SCENE__OF_SOLIDS, /* bodies or, without `body`, all solids */
  BW_SCENE__OF_POINT,  /* a place in the fluid: point, line or slice */
  BW_SCENE__OF_FLUID,  /* all of the fluid on a grid */
  BW_SCENE__OF_COLUMN, /* a column of a fluid of particles: point */
  BW_SCENE__OF_WATER   /* all of a fluid of particles, or what is in a region */
} bw_scene__source;

enum { BW_SCENE__COMPONENTS = 12 }; /* of a quantity, at most */

/* Ways to the force of the flow: components 0 .. 2, 3 .. 5, 6 .. 8 of it. */
typedef enum {
  BW_SCENE__BY_REACTION, /* of the markers */
  BW_SCENE__BY_PROBES,   /* the stress that they see */
  BW_SCENE__BY_BOX       /* momentum balance of a box around all bodies */
} bw_scene__route;

typedef struct {
  const char *word; /* NULL ends the table */
  bw_scene__source source;
  int n;                                       /* components, in three dimensions */
  bool vector;                                 /* x, y, z: two in two dimensions */
  bool axial;                                  /* about x, y, z: one in two dimensions */
  const char *component[BW_SCENE__COMPONENTS]; /* "": the gauge's name alone */
  const char *unit;
} bw_scene__quantity;

extern const bw_scene__quantity bw_scene__quantities[];

/* The row of a word as asked of this gauge (velocity is of bodies or of points); NULL: none. */
const bw_scene__quantity *bw_scene__quantity_named(const bw_scene_gauge_config *g,
                                                   const char *word);
/* Does the force that a gauge asks for follow by this route? Not by a box, which is around all
 * bodies, for some of them or around bodies that are rigid; not by probes for those. */
bool bw_scene__force_holds(const bw_scene_config *c, const bw_scene_gauge_config *g,
                           bw_scene__route route);
/* Is it asked of some of the bodies of particles in a flow? Then it is known by the route alone
 * that loads them. */
bool bw_scene__some_of_coupled(const bw_scene_config *c, const bw_scene_gauge_config *g);
/* Does a gauge name (or, without names, mean) every body? */
bool bw_scene__names_all(const bw_scene_config *c, const bw_scene_gauge_config *g);
/* Is this quantity of this gauge that of one rigid body? */
bool bw_scene__of_rigid(const bw_scene_config *c, const bw_scene_gauge_config *g,
                        const bw_scene__quantity *what);

/* Is a place given? */
bool bw_scene__given(const double x[3]);
