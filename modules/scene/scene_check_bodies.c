/* What a run would refuse of bodies and loads. */
#include "scene_check.h"

#include "bw_shape_surface.h"
#include <math.h>
#include <string.h>

static bw_status check_material(const bw_scene_config *c, const bw_scene_body *b, const char *name,
                                const char *key)
{
  const int m = bw_scene__material_named(c, name);
  BW_REQUIRE(m >= 0, BW_EINPUT,
             "bodies.%s.%s = %s: there is no such material; give it in materials", b->name, key,
             name[0] != '\0' ? name : "(nothing)");
  BW_REQUIRE(b->motion != BW_SCENE_BREAKABLE || !isnan(c->materials[m].fracture_energy) ||
                 !bw_scene__breaks_by_stretch(&c->materials[m]),
             BW_EINPUT,
             "bodies.%s.motion = breakable, but materials.%s has no fracture_energy; give it, or "
             "make the body elastic",
             b->name, name);
  return BW_OK;
}

static bw_status check_motion(const bw_scene_config *c, const bw_scene_body *b)
{
  const bool still = b->velocity[0] == 0 && b->velocity[1] == 0 && b->velocity[2] == 0;
  BW_REQUIRE(b->motion != BW_SCENE_FIXED || (still && !b->has_rotation && !b->has_swing), BW_EINPUT,
             "bodies.%s: a fixed body has no velocity, rotation or swing; make it prescribed",
             b->name);
  BW_REQUIRE(b->motion == BW_SCENE_PRESCRIBED || !b->has_swing, BW_EINPUT,
             "bodies.%s.swing: it belongs to a prescribed body; leave it out", b->name);
  BW_REQUIRE(!bw_scene__planar(c) || b->velocity[2] == 0.0, BW_EINPUT,
             "bodies.%s.velocity[2] = %g: the scene has two dimensions; give 0", b->name,
             b->velocity[2]);
  BW_REQUIRE(
      b->turn == 0.0 || !bw_scene__has_flow(c), BW_EINPUT,
      "bodies.%s.turn = %g deg: lattices in a flow are not turned in this build; leave it out",
      b->name, b->turn);
  BW_TRY(bw_scene__check_rigid(c, b));
  if (!bw_scene__deforms(b)) return BW_OK;
  BW_TRY(check_material(c, b, b->material, "material"));
  for (int p = 0; p < b->n_shape; p++)
    if (b->shape[p].material[0] != '\0')
      BW_TRY(check_material(c, b, b->shape[p].material, "shape.material"));
  return BW_OK;
}

/* Sites of the lattice have 32-bit numbers; more particles than a machine holds are a unit's. */
static bw_status check_size(const bw_scene_config *c, const bw_scene_body *b,
                            const bw_scene__shapes *s)
{
  double n = 1.0;
  BW_REQUIRE(b->spacing > 0.0, BW_EINPUT,
             "bodies.%s.spacing is missing: there is no fluid whose spacing it could take",
             b->name);
  for (int d = 0; d < (bw_scene__planar(c) ? 2 : 3); d++) {
    const double length = s->upper[d] - s->lower[d];
    BW_REQUIRE(length > 0.0 && length < HUGE_VAL, BW_EINPUT,
               "bodies.%s.shape: it goes from %g to %g along %c; give it an extent", b->name,
               s->lower[d], s->upper[d], "xyz"[d]);
    BW_REQUIRE(!c->has_domain || length < 10.0 * c->domain.length[d], BW_EINPUT,
               "bodies.%s.shape: it is %g long along %c, in a domain of %g; check its unit",
               b->name, length, "xyz"[d], c -> domain.length[d]);
    n *= fmax(1.0, length / b->spacing);
  }
  BW_REQUIRE(n < 2e10, BW_EINPUT,
             "bodies.%s.spacing = %g: the lattice would hold %.3g sites; check the unit, or take a "
             "larger spacing",
             b->name, b->spacing, n);
  /* Something of it has to be where the fluid is. */
  for (int d = 0; c->has_domain && d < (bw_scene__planar(c) ? 2 : 3); d++)
    BW_REQUIRE(s->upper[d] > 0.0 && s->lower[d] < c->domain.length[d], BW_EINPUT,
               "bodies.%s.shape: it is outside the domain, from %g to %g along %c of 0 to %g",
               b->name, s->lower[d], s->upper[d], "xyz"[d], c -> domain.length[d]);
  return BW_OK;
}

static bool meets(const bw_scene__shapes *s, int dims, const double from[3], const double to[3])
{
  for (int d = 0; d < dims; d++)
    if (fmax(from[d], to[d]) < s->lower[d] || fmin(from[d], to[d]) > s->upper[d]) return false;
  return true;
}

static bw_status check_held(const bw_scene_config *c, const bw_scene_body *b,
                            const bw_scene__shapes *s)
{
  const int dims = bw_scene__planar(c) ? 2 : 3;
  BW_REQUIRE(bw_scene__deforms(b) || b->n_held == 0, BW_EINPUT,
             "bodies.%s.held: a fixed or prescribed body is told how to move altogether; leave it "
             "out, or make the body elastic or breakable",
             b->name);
  for (int q = 0; q < b->n_held; q++) {
    const bw_scene_held *h = &b->held[q];
    int d, end;
    BW_REQUIRE((h->by[0] != '\0') + (h->side[0] != '\0') + h->has_box == 1, BW_EINPUT,
               "bodies.%s.held.%d: give one of by, side and box", b->name, q);
    /* Held by a body: its particles are prescribed ones of the same lattice, so it has to have that
     * spacing. */
    const int by = bw_scene__body_named(c, h->by);
    BW_REQUIRE(h->by[0] == '\0' || (by >= 0 && !bw_scene__deforms(&c->bodies[by])), BW_EINPUT,
               "bodies.%s.held.%d.by = %s: there is no such body that is fixed or prescribed",
               b->name, q, h->by);
    BW_REQUIRE(by < 0 || c->bodies[by].spacing == b->spacing || isnan(c->bodies[by].spacing),
               BW_EINPUT,
               "bodies.%s.held.%d.by = %s: they share a lattice, but their spacings are %g and %g; "
               "make them equal",
               b->name, q, h->by, b->spacing, c->bodies[by].spacing);
    /* Held by a side or a box: there has to be something of the body. */
    BW_REQUIRE(h->side[0] == '\0' || bw_scene__side_named(h->side, &d, &end), BW_EINPUT,
               "bodies.%s.held.%d.side = %s: must be one of x_lower, x_upper, y_lower, y_upper, "
               "z_lower, z_upper",
               b->name, q, h->side);
    BW_REQUIRE(!h->has_box || meets(s, dims, h->box.from, h->box.to), BW_EINPUT,
               "bodies.%s.held.%d.box: nothing of the body is in it; it goes from (%g, %g, %g) to "
               "(%g, %g, %g)",
               b->name, q, s->lower[0], s->lower[1], s->lower[2], s->upper[0], s->upper[1],
               s->upper[2]);
  }
  return BW_OK;
}

static bw_status check_cracks(const bw_scene_config *c, const bw_scene_body *b,
                              const bw_scene__shapes *s)
{
  const bool flat = bw_scene__planar(c);
  for (int q = 0; q < b->n_cracks; q++) {
    const bw_scene_crack *k = &b->cracks[q];
    const double *a = k->along;
    BW_REQUIRE(bw_scene__deforms(b), BW_EINPUT, "bodies.%s.cracks: the body does not deform",
               b->name);
    BW_REQUIRE(meets(s, flat ? 2 : 3, k->from, k->to), BW_EINPUT,
               "bodies.%s.cracks.%d: it is outside the body, which goes from (%g, %g, %g) to (%g, "
               "%g, %g)",
               b->name, q, s->lower[0], s->lower[1], s->lower[2], s->upper[0], s->upper[1],
               s->upper[2]);
    BW_REQUIRE(flat || a[0] != 0 || a[1] != 0 || a[2] != 0, BW_EINPUT,
               "bodies.%s.cracks.%d.along is missing: in three dimensions a cut is a parallelogram",
               b->name, q);
  }
  return BW_OK;
}

/* Finer boxes: of bodies that deform by bonds, on a lattice that is not turned. */
static bw_status check_levels(const bw_scene_config *c, const bw_scene_body *b,
                              const bw_scene__shapes *s)
{
  if (b->n_levels == 0 && !b->has_refine) return BW_OK;
  BW_REQUIRE(isnan(c->fluid.film_roughness), BW_EINPUT,
             "bodies.%s.%s: films (fluid.film_roughness) are found for particles of one spacing; "
             "leave either out",
             b->name, b->n_levels > 0 ? "levels" : "refine");
  BW_REQUIRE(bw_scene__deforms(b) && !bw_scene__has_particles(c) && b->turn == 0, BW_EINPUT,
             "bodies.%s.%s: they are of bodies that deform, outside of a fluid of particles, "
             "without turn; leave them out",
             b->name, b->n_levels > 0 ? "levels" : "refine");
  BW_REQUIRE(!b->has_refine || !c->has_domain, BW_EINPUT,
             "bodies.%s.refine: a flow does not follow levels that change; give levels that stay",
             b->name);
  for (int q = 0; q < b->n_levels; q++)
    BW_REQUIRE(meets(s, bw_scene__planar(c) ? 2 : 3, b->levels[q].from, b->levels[q].to), BW_EINPUT,
               "bodies.%s.levels.%d: nothing of the body is in it; it goes from (%g, %g, %g) to "
               "(%g, %g, %g)",
               b->name, q, s->lower[0], s->lower[1], s->lower[2], s->upper[0], s->upper[1],
               s->upper[2]);
  return BW_OK;
}

/* Is one point in both? A grid of points over what their extents share is looked at. */
static bw_status check_overlap(const bw_scene_config *c, int a, int b, const bw_scene__shapes *sa,
                               const bw_scene__shapes *sb)
{
  enum { POINTS = 24 };
  const bool flat = bw_scene__planar(c);
  double lower[3] = {0}, upper[3] = {0};
  for (int d = 0; d < (flat ? 2 : 3); d++) {
    lower[d] = fmax(sa->lower[d], sb->lower[d]), upper[d] = fmin(sa->upper[d], sb->upper[d]);
    if (lower[d] >= upper[d]) return BW_OK;
  }
  if (!sa->analytic || !sb->analytic) return BW_OK; /* found when particles are made */
  for (int q = 0; q < POINTS * POINTS * (flat ? 1 : POINTS); q++) {
    const int at[3] = {q % POINTS, q / POINTS % POINTS, q / POINTS / POINTS};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = lower[d] + (at[d] + 0.5) / POINTS * (upper[d] - lower[d]);
    /* Less than half a particle of the finer one is the lattice's rounding, of which the true
     * surface of a rigid body in a flow has none: it may be a fifth of one beyond a face. */
    const bool true_surface = bw_scene__has_fluid(c) && (c->bodies[a].motion == BW_SCENE_RIGID ||
                                                         c->bodies[b].motion == BW_SCENE_RIGID);
    const double deep =
        (true_surface ? -0.1 : -0.5) * fmin(c->bodies[a].spacing, c->bodies[b].spacing);
    BW_REQUIRE(
        bw_shape_distance(sa->n, sa->shape, flat, x) > deep ||
            bw_shape_distance(sb->n, sb->shape, flat, x) > deep,
        BW_EINPUT,
        "bodies.%s and bodies.%s overlap, at (%g, %g, %g); move one, or take it away from the "
        "other: {minus: %s}",
        c->bodies[a].name, c->bodies[b].name, x[0], x[1], x[2], c->bodies[a].name);
  }
  return BW_OK;
}

/* Body b by itself, and against those before it. */
static bw_status check_body(const bw_scene_config *c, int b, const bw_scene__shapes *s)
{
  const bw_scene_body *body = &c->bodies[b];
  BW_TRY(check_size(c, body, s));
  BW_TRY(check_held(c, body, s));
  BW_TRY(check_cracks(c, body, s));
  BW_TRY(check_levels(c, body, s));
  for (int a = 0; a < b; a++) {
    bw_scene__shapes other;
    bw_status st = bw_scene__shapes_make(c, a, &other);
    BW_THEN(st, check_overlap(c, a, b, &other, s));
    bw_scene__shapes_release(&other);
    BW_TRY(st);
  }
  return BW_OK;
}

bw_status bw_scene__check_bodies(const bw_scene_config *c)
{
  for (int b = 0; b < c->n_bodies; b++) {
    bw_scene__shapes s;
    BW_TRY(check_motion(c, &c->bodies[b]));
    bw_status st = bw_scene__shapes_make(c, b, &s);
    BW_THEN(st, check_body(c, b, &s));
    bw_scene__shapes_release(&s);
    BW_TRY(st);
  }
  return BW_OK;
}

/* A load that fills cracks. */
static bw_status check_filled(const bw_scene_load *l, const bw_scene_body *b, int q)
{
  BW_REQUIRE(
      l->kind == BW_SCENE_PRESSURE, BW_EINPUT,
      "loads.%d.where = crack: a pressure alone fills cracks; give kind: pressure, or a side", q);
  BW_REQUIRE(b->n_cracks > 0, BW_EINPUT,
             "loads.%d.where = crack: %s has none to begin with; give bodies.%s.cracks", q, b->name,
             b->name);
  BW_REQUIRE(
      b->n_levels == 0, BW_EINPUT,
      "loads.%d.where = crack: it needs particles of one spacing; leave out bodies.%s.levels", q,
      b->name);
  return BW_OK;
}

static bw_status check_where(const bw_scene_config *c, const bw_scene_load *l, int q, int body)
{
  int d, end;
  const bw_scene_where *w = &l->where;
  const bool side = l->has_where && w->side[0] != '\0',
             crack = side && strcmp(w->side, "crack") == 0;
  if (crack) BW_TRY(check_filled(l, &c->bodies[body], q));
  BW_REQUIRE(
      !side || crack || bw_scene__side_named(w->side, &d, &end), BW_EINPUT,
      "loads.%d.where.side = %s: must be one of x_lower, x_upper, y_lower, y_upper, z_lower, "
      "z_upper",
      q, w->side);
  BW_REQUIRE(side || (l->kind != BW_SCENE_TRACTION && l->kind != BW_SCENE_PRESSURE), BW_EINPUT,
             "loads.%d.where.side is missing: a %s acts on a side, as where: y_upper", q,
             l->kind == BW_SCENE_TRACTION ? "traction" : "pressure");
  bw_scene__shapes s;
  bw_status st = bw_scene__shapes_make(c, body, &s);
  if (st == BW_OK && l->has_where && w->has_box &&
      !meets(&s, bw_scene__planar(c) ? 2 : 3, w->box.from, w->box.to))
    st =
        BW_FAIL(BW_EINPUT,
                "loads.%d.where.box: nothing of %s is in it; it goes from (%g, %g, %g) to (%g, %g, "
                "%g)",
                q, l->on, s.lower[0], s.lower[1], s.lower[2], s.upper[0], s.upper[1], s.upper[2]);
  bw_scene__shapes_release(&s);
  return st;
}

bw_status bw_scene__check_loads(const bw_scene_config *c)
{
  char known[256];
  bw_scene__body_names(c, sizeof known, known);
  for (int q = 0; q < c->n_loads; q++) {
    const bw_scene_load *l = &c->loads[q];
    const int b = bw_scene__body_named(c, l->on);
    BW_REQUIRE(b >= 0, BW_EINPUT, "loads.%d.on = %s: there is no such body; there are: %s", q,
               l->on, known);
    BW_REQUIRE(bw_scene__deforms(&c->bodies[b]), BW_EINPUT,
               "loads.%d.on = %s: that body is %s, no load moves it; leave the load out", q, l->on,
               bw_scene__word(bw_scene__motion_words, c->bodies[b].motion));
    BW_REQUIRE(!bw_scene__has_flow(c) || l->kind == BW_SCENE_VELOCITY, BW_EINPUT,
               "loads.%d: in a flow this build has the loads of the fluid, gravity: and kind: "
               "velocity only; leave it out",
               q);
    BW_TRY(check_where(c, l, q, b));
  }
  BW_REQUIRE(c->contact.friction == 0.0 || (bw_scene__any_rigid(c) && !bw_scene__any_deforms(c)),
             BW_EINPUT,
             "contact.friction = %g: in this build rigid bodies rub against each other, against "
             "fixed and prescribed ones and walls, where no body deforms; give 0",
             c->contact.friction);
  BW_REQUIRE(strcmp(c->contact.between, "all") == 0 || strcmp(c->contact.between, "none") == 0,
             BW_EINPUT, "contact.between = %s: must be all or none in this build",
             c->contact.between);
  return BW_OK;
}
