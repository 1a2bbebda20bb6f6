/* Bodies of a scene as shapes. */
#include "scene_shapes.h"

#include "bw_memory.h"
#include <limits.h>
#include <math.h>
#include <string.h>

void bw_scene__shapes_release(bw_scene__shapes *s)
{
  for (int q = 0; q < s->n_masks; q++)
    bw_shape_mask_destroy(&s->mask[q]);
  s->n = s->n_masks = 0;
}

static void add(bw_scene__shapes *s, int part, bw_shape shape)
{
  s->part[s->n] = part;
  s->shape[s->n++] = shape;
}

/* What is outside of a box goes, in one direction or in all. */
static bw_shape cut_to(const double lower[3], const double upper[3])
{
  bw_shape cut = {.kind = BW_SHAPE_BOX, .remove = true, .outside = true};
  memcpy(cut.lower, lower, sizeof cut.lower);
  memcpy(cut.upper, upper, sizeof cut.upper);
  return cut;
}

static void add_box(const bw_scene_config *c, const bw_scene_shape *part, int p,
                    bw_scene__shapes *s)
{
  bw_shape box = {.kind = BW_SHAPE_BOX, .remove = part->remove};
  for (int d = 0; d < 3; d++)
    box.lower[d] = part->box.from[d], box.upper[d] = part->box.to[d];
  /* In two dimensions z is not looked at: a box of some depth. */
  if (bw_scene__planar(c)) box.lower[2] = 0.0, box.upper[2] = c->thickness;
  add(s, p, box);
}

/* Whose shapes: a body's, or those of the fluid. */
typedef struct {
  int n;
  const bw_scene_shape *shape; /* (n) */
  char key[BW_SCENE_NAME + 8]; /* in messages */
  double spacing;              /* [L] */
} owner;

static owner owner_of(const bw_scene_config *c, int b)
{
  owner o = {.n = c->fluid.n_shape, .shape = c->fluid.shape, .key = "fluid"};
  if (b == BW_SCENE__FLUID) {
    o.spacing = c->domain.length[1] / c->domain.cells[1];
    return o;
  }
  o = (owner){.n = c->bodies[b].n_shape, .shape = c->bodies[b].shape};
  o.spacing = c->bodies[b].spacing;
  snprintf(o.key, sizeof o.key, "bodies.%s", c->bodies[b].name);
  return o;
}

/* Cylinders have no ends of their own: they end by a cut, which would go through what came before.
 */
static bw_status add_cylinder(const bw_scene_config *c, const owner *b, const bw_scene_shape *part,
                              int p, bw_scene__shapes *s)
{
  const bw_scene_cylinder *y = &part->cylinder;
  bw_shape shape = {
      .kind = BW_SHAPE_CYLINDER, .remove = part->remove, .radius = y->radius, .axis = y->axis};
  for (int d = 0, q = 0; d < 3; d++)
    if (d != y->axis) shape.centre[d] = y->centre[q++];
  add(s, p, shape);
  if (part->remove || (bw_scene__planar(c) && y->axis == 2)) return BW_OK;
  /* In space it ends where it is told to, else at the domain. */
  double lower[3], upper[3];
  const double from = isnan(y->from) && c->has_domain ? 0.0 : y->from;
  const double to = isnan(y->to) && c->has_domain ? c->domain.length[y->axis] : y->to;
  BW_REQUIRE(
      from < to, BW_EINPUT,
      "%s.shape.%d.cylinder: it ends nowhere along its axis; give from and to, from below to",
      b->key, p);
  BW_REQUIRE(p == 0, BW_EINPUT,
             "%s.shape.%d.cylinder: one that ends has to be the first shape of its body in this "
             "build; put it first, or make a body of its own",
             b->key, p);
  for (int d = 0; d < 3; d++) {
    lower[d] = d == y->axis ? from : shape.centre[d] - 2.0 * y->radius;
    upper[d] = d == y->axis ? to : shape.centre[d] + 2.0 * y->radius;
  }
  add(s, p, cut_to(lower, upper));
  return BW_OK;
}

static void add_round(const bw_scene_shape *part, int p, bw_scene__shapes *s)
{
  bw_shape shape = {.kind = BW_SHAPE_SPHERE, .remove = part->remove};
  const double *centre = part->has_sphere ? part->sphere.centre : part->pores.centre;
  memcpy(shape.centre, centre, sizeof shape.centre);
  shape.radius = part->has_sphere ? part->sphere.radius : part->pores.radius;
  if (part->has_pores)
    shape.kind = (bw_shape_kind)part->pores.kind, shape.pitch = part->pores.pitch;
  add(s, p, shape);
}

/* The part of an image that counts, mirrored, and brought to fewer voxels. */
static bw_status cut_image(const owner *b, const bw_scene_image *m, int p, bw_shape_mask *mask)
{
  int64_t from[3], to[3];
  for (int d = 0; d < 3; d++) {
    from[d] = m->from[d] != INT_MIN ? m->from[d] : 0;
    to[d] = m->to[d] != INT_MIN ? m->to[d] : mask->size[d];
    BW_REQUIRE(from[d] < to[d] && to[d] <= mask->size[d], BW_EINPUT,
               "%s.shape.%d.image: from[%d] = %lld, to[%d] = %lld: the image has the voxels "
               "0 to %lld along %c",
               b->key, p, d, (long long)from[d], d, (long long)to[d], (long long)mask->size[d] - 1,
               "xyz"[d]);
    BW_REQUIRE(m->coarsen[d] <= to[d] - from[d], BW_EINPUT,
               "%s.shape.%d.image: coarsen[%d] = %d, but there are %lld voxels along %c", b->key, p,
               d, m->coarsen[d], (long long)(to[d] - from[d]), "xyz"[d]);
  }
  BW_TRY(bw_shape_mask_crop(mask, from, to));
  for (int d = 0; d < 3; d++)
    if (m->flip[d]) BW_TRY(bw_shape_mask_flip(mask, d));
  return m->coarsen[0] * m->coarsen[1] * m->coarsen[2] > 1 ? bw_shape_mask_coarsen(mask, m->coarsen)
                                                           : BW_OK;
}

static bw_status add_mask(const owner *b, const bw_scene_shape *part, int p, bw_scene__shapes *s)
{
  bw_shape_mask **mask = &s->mask[s->n_masks];
  const double cell = isnan(part->stl.cell) ? 0.5 * b->spacing : part->stl.cell;
  if (part->has_image)
    BW_TRY(bw_shape_mask_open_image(part->image.file, part->image.low, part->image.high, mask));
  else
    BW_TRY(bw_shape_mask_read_stl(part->stl.file, part->stl.unit, cell, mask));
  s->n_masks++;
  s->analytic = false;
  BW_REQUIRE(!part->has_image || (*mask)->about.has_spacing || !isnan(part->image.voxel), BW_EINPUT,
             "%s.shape.%d.image: %s does not say how large a voxel is; give its edge (voxel)",
             b->key, p, part->image.file);
  /* Where the file puts it, or where the scene does. */
  for (int d = 0; part->has_image && d < 3; d++)
    if (!isnan(part->image.voxel)) (*mask)->spacing[d] = part->image.voxel;
  if (part->has_image) BW_TRY(cut_image(b, &part->image, p, *mask));
  for (int d = 0; part->has_image && d < 3; d++)
    if (!isnan(part->image.at[d])) (*mask)->lower[d] = part->image.at[d];
  add(s, p, (bw_shape){.kind = BW_SHAPE_MASK, .remove = part->remove, .mask = *mask});
  return BW_OK;
}

static bw_status add_part(const bw_scene_config *c, int b, int p, bool remove, bw_scene__shapes *s);

/* The shapes of another body, taken away. */
static bw_status add_minus(const bw_scene_config *c, int b, int p, bw_scene__shapes *s)
{
  const owner body = owner_of(c, b);
  const char *minus = body.shape[p].minus;
  const int other = bw_scene__body_named(c, minus);
  BW_REQUIRE(other >= 0 && other != b, BW_EINPUT,
             "%s.shape.%d.minus = %s: there is no other body of that name", body.key, p, minus);
  for (int q = 0; q < c->bodies[other].n_shape; q++) {
    const bw_scene_shape *part = &c->bodies[other].shape[q];
    BW_REQUIRE(
        !part->remove && part->minus[0] == '\0', BW_EINPUT,
        "%s.shape.%d.minus = %s: parts are taken away from that body, too, which this build cannot "
        "take away; name its shapes with remove: true",
        body.key, p, minus);
    const int first = s->n;
    BW_TRY(add_part(c, other, q, true, s));
    for (int k = first; k < s->n; k++)
      s->part[k] = p;
  }
  return BW_OK;
}

static bw_status add_part(const bw_scene_config *c, int b, int p, bool remove, bw_scene__shapes *s)
{
  const owner body = owner_of(c, b);
  bw_scene_shape part = body.shape[p];
  const int given = part.has_box + part.has_cylinder + part.has_sphere + part.has_pores +
                    part.has_image + part.has_stl + (part.minus[0] != '\0');
  BW_REQUIRE(
      given == 1, BW_EINPUT,
      "%s.shape.%d: %d shapes are given, one is needed: box, cylinder, sphere, pores, image, stl "
      "or minus",
      body.key, p, given);
  BW_REQUIRE(s->n + 3 <= BW_SCENE__SHAPES && s->n_masks < BW_SCENE_PARTS, BW_EINPUT,
             "%s.shape: too many shapes, with those taken away", body.key);
  part.remove = part.remove || remove;
  if (part.minus[0] != '\0') return add_minus(c, b, p, s);
  if (part.has_box)
    add_box(c, &part, p, s);
  else if (part.has_cylinder)
    return add_cylinder(c, &body, &part, p, s);
  else if (part.has_image || part.has_stl)
    return add_mask(&body, &part, p, s);
  else
    add_round(&part, p, s);
  return BW_OK;
}

void bw_scene__shape_extent(const bw_shape *s, double lower[3], double upper[3])
{
  for (int d = 0; d < 3; d++) {
    const bool endless = s->kind >= BW_SHAPE_PORES_SC && s->kind <= BW_SHAPE_PORES_FCC;
    const bool along = s->kind == BW_SHAPE_CYLINDER && d == s->axis;
    lower[d] = endless || along ? -HUGE_VAL : s->centre[d] - s->radius;
    upper[d] = endless || along ? HUGE_VAL : s->centre[d] + s->radius;
    if (s->kind == BW_SHAPE_BOX) lower[d] = s->lower[d], upper[d] = s->upper[d];
    if (s->kind == BW_SHAPE_MASK) {
      lower[d] = s->mask->lower[d];
      upper[d] = lower[d] + (double)s->mask->size[d] * s->mask->spacing[d];
    }
  }
}

static void measure(bw_scene__shapes *s)
{
  for (int d = 0; d < 3; d++)
    s->lower[d] = HUGE_VAL, s->upper[d] = -HUGE_VAL;
  for (int q = 0; q < s->n; q++) {
    double lower[3], upper[3];
    bw_scene__shape_extent(&s->shape[q], lower, upper);
    for (int d = 0; d < 3; d++) {
      if (s->shape[q].remove && s->shape[q].outside) {
        s->lower[d] = fmax(s->lower[d], lower[d]);
        s->upper[d] = fmin(s->upper[d], upper[d]);
      } else if (!s->shape[q].remove) {
        s->lower[d] = fmin(s->lower[d], lower[d]);
        s->upper[d] = fmax(s->upper[d], upper[d]);
      }
    }
  }
}

bw_status bw_scene__shapes_make(const bw_scene_config *c, int b, bw_scene__shapes *out)
{
  memset(out, 0, sizeof *out);
  out->analytic = true;
  for (int p = 0; p < owner_of(c, b).n; p++)
    BW_TRY(add_part(c, b, p, false, out));
  measure(out);
  return BW_OK;
}

bool bw_scene__side_named(const char *name, int *d, int *end)
{
  static const char *const ends[2] = {"_lower", "_upper"};
  for (*d = 0; *d < 3; (*d)++)
    for (*end = 0; *end < 2; (*end)++)
      if (name[0] == "xyz"[*d] && strcmp(name + 1, ends[*end]) == 0) return true;
  return false;
}

bool bw_scene__in_box(const bw_scene_box *box, bool planar, double spacing, const double x[3])
{
  const double tie = 1e-6 * spacing;
  for (int d = 0; d < (planar ? 2 : 3); d++)
    if (x[d] < box->from[d] - tie || x[d] >= box->to[d] - tie) return false;
  return true;
}
