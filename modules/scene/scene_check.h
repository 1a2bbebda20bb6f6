/* scene_check.h -- parts of bw_scene_check; shared inside `scene`. All local; BW_EINPUT. */
#pragma once
#include "scene_shapes.h"

bw_status bw_scene__check_fluid(const bw_scene_config *c) BW_MUST_CHECK; /* and domain */
bw_status
bw_scene__check_materials(const bw_scene_config *c) BW_MUST_CHECK;        /* laws of this build */
bw_status bw_scene__check_bodies(const bw_scene_config *c) BW_MUST_CHECK; /* shapes, overlaps */
bw_status bw_scene__check_loads(const bw_scene_config *c) BW_MUST_CHECK;  /* and contact */
bw_status bw_scene__check_phases(const bw_scene_config *c) BW_MUST_CHECK; /* and output */
bw_status bw_scene__check_gauges(const bw_scene_config *c) BW_MUST_CHECK; /* and watch */

/* Keys of state-based laws: those that the law of a material reads, and all that it needs. */
bw_status bw_scene__check_state(const bw_scene_material *m) BW_MUST_CHECK;

/* Mass, springs and held directions of a rigid body, and where one can be. */
bw_status bw_scene__check_rigid(const bw_scene_config *c, const bw_scene_body *b) BW_MUST_CHECK;

/* Is some body rigid? */
bool bw_scene__any_rigid(const bw_scene_config *c);
/* Is body b one of bw_rigid's: rigid, or one that does not deform in a scene of rigid ones? */
bool bw_scene__in_rigid(const bw_scene_config *c, int b);
/* Bits 0 .. 5 <- directions that a rigid body is held in: x, y, z, turn about x, y, z. False: a
 * word is none of them, wrong (BW_SCENE_NAME) <- it. */
bool bw_scene__held_bits(const char *held, unsigned *bits, char wrong[]);

/* Does the scene have a fluid on a grid? */
bool bw_scene__has_fluid(const bw_scene_config *c);
/* Does the body deform? */
bool bw_scene__deforms(const bw_scene_body *b);
/* Some body deforms. */
bool bw_scene__any_deforms(const bw_scene_config *c);
