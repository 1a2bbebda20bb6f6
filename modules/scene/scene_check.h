/* scene_check.h -- parts of bw_scene_check; shared inside `scene`. All local; BW_EINPUT. */
#pragma once
#include "scene_shapes.h"

bw_status bw_scene__check_fluid(const bw_scene_config *c) BW_MUST_CHECK; /* and domain */
/* scene_check_water.c: a fluid of particles, and bodies and gauges as far as they meet it. */
bw_status bw_scene__check_water(const bw_scene_config *c) BW_MUST_CHECK;
/* Has its box no wall at the lower (end 0) or upper (1) side along d? */
bool bw_scene__is_open(const bw_scene_config *c, int d, int end);
bw_status
bw_scene__check_materials(const bw_scene_config *c) BW_MUST_CHECK;        /* laws of this build */
bw_status bw_scene__check_bodies(const bw_scene_config *c) BW_MUST_CHECK; /* shapes, overlaps */
bw_status bw_scene__check_loads(const bw_scene_config *c) BW_MUST_CHECK;  /* and contact */
bw_status bw_scene__check_phases(const bw_scene_config *c) BW_MUST_CHECK; /* and output */
bw_status bw_scene__check_gauges(const bw_scene_config *c) BW_MUST_CHECK; /* and watch */

/* scene_failure.c: the numbers that a gauge of failure needs. */
bw_status bw_scene__check_failure(const bw_scene_config *c,
                                  const bw_scene_gauge_config *g) BW_MUST_CHECK;

/* The material of body b, or the first of those of its parts; NULL: it has none. Laws of all of
 * them are alike: bonds, or state-based. */
const bw_scene_material *bw_scene__material_of(const bw_scene_config *c, int b);
/* Does numerics.surface_correction act on something? Not where all that deforms is of state-based
 * laws, whose families at faces are whole. */
bool bw_scene__corrects_surfaces(const bw_scene_config *c);
/* Do bonds of a material break by their stretch, of a fracture energy? */
bool bw_scene__breaks_by_stretch(const bw_scene_material *m);
/* Keys of state-based laws: those that the law of a material reads, and all that it needs. */
bw_status bw_scene__check_state(const bw_scene_material *m) BW_MUST_CHECK;

/* Mass, springs and held directions of a rigid body, and where one can be. */
bw_status bw_scene__check_rigid(const bw_scene_config *c, const bw_scene_body *b) BW_MUST_CHECK;

/* Is some body rigid? */
bool bw_scene__any_rigid(const bw_scene_config *c);
/* In a flow on a grid: is some body that is not rigid an image or a surface of triangles? It is
 * made of particles then, as are all that are not rigid. */
bool bw_scene__any_image(const bw_scene_config *c);
/* Is body b one of bw_rigid's: rigid, or one that does not deform in a scene of rigid ones? */
bool bw_scene__in_rigid(const bw_scene_config *c, int b);
/* Bits 0 .. 5 <- directions that a rigid body is held in: x, y, z, turn about x, y, z. False: a
 * word is none of them, wrong (BW_SCENE_NAME) <- it. */
bool bw_scene__held_bits(const char *held, unsigned *bits, char wrong[]);

/* Does the scene have a fluid on a grid? One of particles? Any? */
bool bw_scene__has_fluid(const bw_scene_config *c);
bool bw_scene__has_particles(const bw_scene_config *c);
bool bw_scene__has_flow(const bw_scene_config *c);
/* Does the body deform? */
bool bw_scene__deforms(const bw_scene_body *b);
/* Does body a hold b, or b a? */
bool bw_scene__joined(const bw_scene_config *c, int a, int b);
/* Is body b a wall of a fluid of particles: fixed, and joined to nothing that deforms? */
bool bw_scene__is_wall(const bw_scene_config *c, int b);
/* Some body deforms. */
bool bw_scene__any_deforms(const bw_scene_config *c);
