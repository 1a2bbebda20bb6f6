/* What a run would refuse of rigid bodies. */
#include "scene_check.h"

#include "bw_solid.h"
#include <math.h>
#include <string.h>

bool bw_scene__any_rigid(const bw_scene_config *c)
{
  for (int b = 0; b < c->n_bodies; b++)
    if (c->bodies[b].motion == BW_SCENE_RIGID) return true;
  return false;
}

bool bw_scene__in_rigid(const bw_scene_config *c, int b)
{
  if (c->bodies[b].motion == BW_SCENE_RIGID) return true;
  return bw_scene__any_rigid(c) && !bw_scene__any_deforms(c) && !bw_scene__any_image(c);
}

bool bw_scene__any_image(const bw_scene_config *c)
{
  for (int b = 0; b < c->n_bodies && bw_scene__has_fluid(c); b++)
    for (int p = 0; p < c->bodies[b].n_shape && c->bodies[b].motion != BW_SCENE_RIGID; p++)
      if (c->bodies[b].shape[p].has_image || c->bodies[b].shape[p].has_stl) return true;
  return false;
}

bool bw_scene__held_bits(const char *held, unsigned *bits, char wrong[])
{
  static const struct {
    const char *word;
    unsigned bits;
  } words[] = {{"x", 1},       {"y", 2},       {"z", 4},    {"turn_x", 8},
               {"turn_y", 16}, {"turn_z", 32}, {"turn", 56}};
  char one[BW_SCENE_NAME];
  *bits = 0;
  while (bw_scene__next_name(&held, one)) {
    unsigned found = 0;
    for (size_t q = 0; q < sizeof words / sizeof *words; q++)
      if (strcmp(words[q].word, one) == 0) found = words[q].bits;
    if (found == 0) {
      memcpy(wrong, one, sizeof one);
      return false;
    }
    *bits |= found;
  }
  return true;
}

/* Numbers that are given have to be those of a body. */
static bw_status check_numbers(const bw_scene_config *c, const bw_scene_body *b)
{
  const bw_scene_rigid *r = &b->rigid;
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(r->stiffness[d] >= 0.0 && r->damping[d] >= 0.0, BW_EINPUT,
               "bodies.%s.rigid: stiffness[%d] = %g and damping[%d] = %g of springs must not be "
               "negative",
               b->name, d, r->stiffness[d], d, r->damping[d]);
  if (isnan(r->inertia[0])) return BW_OK;
  const double *I = r->inertia;
  if (bw_scene__planar(c)) {
    BW_REQUIRE(fmax(I[0], fmax(I[1], I[2])) > 0.0, BW_EINPUT,
               "bodies.%s.rigid.inertia: in two dimensions one number, about z, above 0", b->name);
    return BW_OK;
  }
  /* No mass distribution has a moment above the sum of the other two. */
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(I[d] > 0.0 && I[d] <= I[(d + 1) % 3] + I[(d + 2) % 3], BW_EINPUT,
               "bodies.%s.rigid.inertia[%d] = %g: must be above 0 and at most the sum of the other "
               "two, %g",
               b->name, d, I[d], I[(d + 1) % 3] + I[(d + 2) % 3]);
  return BW_OK;
}

bw_status bw_scene__check_rigid(const bw_scene_config *c, const bw_scene_body *b)
{
  char wrong[BW_SCENE_NAME];
  unsigned bits;
  BW_REQUIRE(b->motion == BW_SCENE_RIGID || !b->has_rigid, BW_EINPUT,
             "bodies.%s.rigid: the body is %s; leave the block out, or make it rigid", b->name,
             bw_scene__word(bw_scene__motion_words, b->motion));
  if (b->motion != BW_SCENE_RIGID) return BW_OK;
  const bool flow = bw_scene__has_fluid(c), beside = flow && bw_scene__any_deforms(c);
  BW_REQUIRE(
      !flow || !(c->numerics.memory == 0.0), BW_EINPUT,
      "numerics.memory = 0: the forcing of bodies.%s, which is rigid in a flow, needs one on "
      "its true surface; give 0.2, or leave it out",
      b->name);
  BW_REQUIRE(!beside || c->numerics.integrator == BW_SOLID_VERLET, BW_EINPUT,
             "numerics.integrator = rk3: beside bodies.%s, which is rigid in the same flow, solids "
             "are stepped by verlet; give that, or leave it out",
             b->name);
  BW_REQUIRE(!isnan(b->rigid.mass) || bw_scene__material_named(c, b->material) >= 0, BW_EINPUT,
             "bodies.%s.material = %s: there is no such material, and no mass; give the material, "
             "or rigid.mass",
             b->name, b->material[0] != '\0' ? b->material : "(nothing)");
  /* A body turns freely, about one axis, or not at all (rigid_internal.h). */
  BW_REQUIRE(bw_scene__held_bits(b->rigid.held, &bits, wrong), BW_EINPUT,
             "bodies.%s.rigid.held = %s: must be of x, y, z, turn_x, turn_y, turn_z, turn", b->name,
             wrong);
  const unsigned turns = bits >> 3;
  BW_REQUIRE(bw_scene__planar(c) || (turns != 1 && turns != 2 && turns != 4), BW_EINPUT,
             "bodies.%s.rigid.held = %s: two free turns are no hinge; hold none, two, or all three",
             b->name, b->rigid.held);
  BW_REQUIRE(b->n_held == 0 && b->n_cracks == 0, BW_EINPUT,
             "bodies.%s: held and cracks belong to bodies that deform; a rigid one has rigid.held",
             b->name);
  return check_numbers(c, b);
}
