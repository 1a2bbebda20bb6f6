/* Which sites are the medium: a box with pores taken out, or a body from a file cut to the box; on
 * a slab under the lower wall that holds it. */
#include "bw_memory.h"
#include "bw_shape_pack.h"
#include "porous_case.h"

#include <math.h>
#include <stdio.h>

typedef struct {
  int count;
  bw_shape *shape;
  bw_shape_mask *mask;
  char key[1100]; /* that decides how much of it is pores, with its value: for messages */
} medium_body;

static double spacing(const porous_config *q)
{
  return q->domain.length[1] / q->domain.cells[1];
}

static bw_shape box_of(const porous_config *q)
{
  const porous_medium *m = &q->medium;
  return (bw_shape){.kind = BW_SHAPE_BOX,
                    .lower = {m->front, 0.0, 0.0},
                    .upper = {m->front + m->length, q->domain.length[1], q->domain.length[2]}};
}

static bw_shape slab_of(const porous_config *q)
{
  bw_shape slab = box_of(q);
  slab.lower[1] = -q->medium.clamped_layers * spacing(q);
  slab.upper[1] = 0.0;
  slab.particle_kind = BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE;
  return slab;
}

static bw_status check_lattice(const porous_config *q)
{
  const porous_medium *m = &q->medium;
  const double span = q->domain.length[2], pitches = span / m->pitch;
  BW_REQUIRE(!isnan(m->pitch) && !isnan(m->radius_over_pitch), BW_EINPUT,
             "medium.%s is missing: a lattice of pores needs pitch and radius_over_pitch",
             isnan(m->pitch) ? "pitch" : "radius_over_pitch");
  BW_REQUIRE(m->pitch * (1.0 - 1e-9) <= span, BW_EINPUT,
             "medium.pitch = %g m is larger than the span domain.length[2] = %g m", m->pitch, span);
  BW_REQUIRE(fabs(pitches - round(pitches)) < 1e-9 * pitches, BW_EINPUT,
             "medium.pitch = %g m: the periodic span %g m must hold a whole number of pitches (%g)",
             m->pitch, span, pitches);
  return BW_OK;
}

static bw_status lattice(const porous_config *q, medium_body *b)
{
  const porous_medium *m = &q->medium;
  BW_TRY(check_lattice(q));
  BW_TRY(BW_ALLOCATE(&b->shape, 3));
  /* A box, less spheres on the sites of a lattice. */
  b->shape[0] = box_of(q);
  b->shape[1] = (bw_shape){.kind = (bw_shape_kind)m->lattice,
                           .remove = true,
                           .radius = m->radius_over_pitch * m->pitch,
                           .pitch = m->pitch,
                           .centre = {m->front}};
  for (int d = 0; d < 3; d++)
    b->shape[1].centre[d] += m->offset[d] * m->pitch;
  b->count = 2;
  snprintf(b->key, sizeof b->key, "medium.radius_over_pitch = %g", m->radius_over_pitch);
  return BW_OK;
}

/* Balls at independent places: a place is in none of them with probability exp(-sum of volumes per
 * volume). Those whose centre is outside the box reach in as well. */
static bw_status random_pores(const porous_config *q, medium_body *b)
{
  const porous_random *r = &q->medium.random;
  const bw_shape box = box_of(q);
  bw_shape_pack_config c = bw_shape_pack_config_default();
  bw_shape *ball = NULL;
  int balls = 0, count = 0;
  c.radius_min = r->radius[0], c.radius_max = r->radius[1];
  /* Any overlap is allowed, so places are independent of each other ... */
  c.gap = -2.0 * c.radius_max;
  /* ... and a share `porosity` is in at least one ball when their volumes add up to this. */
  c.fraction = -log1p(-r->porosity);
  c.seed = (uint64_t)r->seed;
  c.periodic[2] = true;
  /* Balls whose centre is outside still reach in. */
  for (int d = 0; d < 3; d++) {
    const double beyond = c.periodic[d] ? 0.0 : c.radius_max;
    c.lower[d] = box.lower[d] - beyond, c.upper[d] = box.upper[d] + beyond;
  }
  snprintf(b->key, sizeof b->key, "medium.random.porosity = %g", r->porosity);
  BW_TRY(bw_shape_pack_spheres(&c, &balls, &count, &ball));
  const bw_status st = BW_ALLOCATE(&b->shape, (size_t)count + 2);
  /* A box, less all balls; room for the slab that may follow. */
  if (st == BW_OK) {
    b->shape[0] = box;
    for (int k = 0; k < count; k++) {
      b->shape[k + 1] = ball[k];
      b->shape[k + 1].remove = true;
    }
    b->count = count + 1;
  }
  bw_release(&ball);
  return st;
}

/* The mask, put where the medium is and cut to its box. */
static bw_status cut_mask(const porous_config *q, medium_body *b)
{
  BW_TRY(BW_ALLOCATE(&b->shape, 3));
  b->shape[1] = box_of(q);
  for (int d = 0; d < 3; d++)
    b->mask->lower[d] = b->shape[1].lower[d];
  b->shape[0] = (bw_shape){.kind = BW_SHAPE_MASK, .mask = b->mask};
  b->shape[1].remove = b->shape[1].outside = true;
  b->count = 2;
  return BW_OK;
}

static bw_status image(const porous_config *q, medium_body *b)
{
  static const char axis[3] = {'x', 'y', 'z'};
  const porous_image *m = &q->medium.image;
  const bw_shape box = box_of(q);
  snprintf(b->key, sizeof b->key, "medium.image.solid = [%g, %g] of %s", m->solid[0], m->solid[1],
           m->file);
  BW_TRY(bw_shape_mask_open_image(m->file, m->solid[0], m->solid[1], &b->mask));
  /* An image smaller than the medium would leave a part of it empty. */
  for (int d = 0; d < 3; d++) {
    if (!isnan(m->voxel)) b->mask->spacing[d] = m->voxel;
    const double have = b->mask->spacing[d] * (double)b->mask->size[d];
    const double need = box.upper[d] - box.lower[d];
    BW_REQUIRE(have >= need * (1.0 - 1e-9), BW_EINPUT,
               "medium.image: %s is %g m along %c (%lld voxels of %g m), the medium %g m; the rest "
               "would be empty: take voxels of %g m (medium.image.voxel) or a smaller medium",
               m->file, have, axis[d], (long long)b->mask->size[d], b->mask->spacing[d], need,
               need / (double)b->mask->size[d]);
  }
  return cut_mask(q, b);
}

static bw_status surface(const porous_config *q, medium_body *b)
{
  const porous_surface *m = &q->medium.surface;
  snprintf(b->key, sizeof b->key, "medium.surface.scale = %g of %s", m->scale, m->file);
  BW_TRY(bw_shape_mask_read_stl(m->file, m->scale, spacing(q), &b->mask));
  return cut_mask(q, b);
}

typedef bw_status (*medium_way)(const porous_config *q, medium_body *b);

static bw_status choose(const porous_medium *m, medium_way *way)
{
  const bool pores = !isnan(m->pitch) || !isnan(m->radius_over_pitch);
  const int given = pores + m->has_random + m->has_image + m->has_surface;
  /* Exactly one description of the pores. */
  BW_REQUIRE(
      given == 1, BW_EINPUT,
      "medium: %d of pitch with radius_over_pitch, random, image and surface are given; give "
      "one",
      given);
  *way = m->has_random ? random_pores : m->has_image ? image : m->has_surface ? surface : lattice;
  return BW_OK;
}

/* The channel's cells: 0 empty, 1 not to be entered (solid, or been there). */
typedef struct {
  int n[3];
  uint8_t *closed;
  size_t *queue;
} labyrinth;

static void enter(labyrinth *l, const int at[3], size_t *queued)
{
  const int z = (at[2] + l->n[2]) % l->n[2]; /* the span is periodic */
  if (at[0] < 0 || at[0] >= l->n[0] || at[1] < 0 || at[1] >= l->n[1]) return;
  const size_t cell =
      ((size_t)z * (size_t)l->n[1] + (size_t)at[1]) * (size_t)l->n[0] + (size_t)at[0];
  if (l->closed[cell]) return;
  l->closed[cell] = 1;
  l->queue[(*queued)++] = cell;
}

/* Is the outflow reached from the inflow, from cell to cell over their faces? */
static bool way_through(labyrinth *l)
{
  size_t queued = 0;
  bool through = false;
  /* Every open cell of the inflow is entered ... */
  for (int k = 0; k < l->n[2]; k++)
    for (int j = 0; j < l->n[1]; j++)
      enter(l, (int[3]){0, j, k}, &queued);
  /* ... and the front moves on over faces until it reaches the outflow. */
  for (size_t next = 0; next < queued && !through; next++) {
    const size_t cell = l->queue[next], row = cell / (size_t)l->n[0];
    const int at[3] = {(int)(cell % (size_t)l->n[0]), (int)(row % (size_t)l->n[1]),
                       (int)(row / (size_t)l->n[1])};
    through = at[0] == l->n[0] - 1;
    for (int side = 0; side < 6; side++) {
      int to[3] = {at[0], at[1], at[2]};
      to[side / 2] += side % 2 == 0 ? 1 : -1;
      enter(l, to, &queued);
    }
  }
  return through;
}

static bw_status check_way(const porous_config *q, const char *key, int64_t n, const int32_t *site)
{
  labyrinth l = {.n = {q->domain.cells[0], q->domain.cells[1], q->domain.cells[2]}};
  const size_t cells = (size_t)l.n[0] * (size_t)l.n[1] * (size_t)l.n[2];
  bw_status st = BW_ALLOCATE(&l.closed, cells);
  BW_THEN(st, BW_ALLOCATE(&l.queue, cells));
  /* Particles sit on the fluid's cells: a site is a cell. */
  for (int64_t k = 0; st == BW_OK && k < n; k++) {
    const int32_t *at = site + 3 * k;
    if (at[1] < 0) continue; /* the slab */
    l.closed[((size_t)at[2] * (size_t)l.n[1] + (size_t)at[1]) * (size_t)l.n[0] + (size_t)at[0]] = 1;
  }
  if (st == BW_OK && !way_through(&l))
    st = BW_FAIL(BW_EINPUT,
                 "%s: nothing flows through, as no way one cell (%g m) wide joins inflow and "
                 "outflow; take larger pores",
                 key, spacing(q));
  bw_release(&l.closed);
  bw_release(&l.queue);
  return st;
}

static bw_status fill(const porous_config *q, medium_way way, medium_body *b, int64_t *n,
                      int32_t **site, uint8_t **kind)
{
  static const double origin[3] = {0.0, 0.0, 0.0};
  BW_TRY(way(q, b));
  /* The slab comes last: it is under the box and takes nothing from it. */
  if (q->medium.clamped_layers > 0) b->shape[b->count++] = slab_of(q);
  const bw_shape_lattice lattice = bw_shape_lattice_straight(spacing(q), origin, false);
  BW_TRY(bw_shape_fill(b->count, b->shape, &lattice, 0, 1, n, site, kind, NULL));
  int64_t above = 0;
  /* The slab alone is no medium. */
  for (int64_t k = 0; k < *n; k++)
    above += (*site)[3 * k + 1] >= 0;
  BW_REQUIRE(above > 0, BW_EINPUT, "%s: no particle of spacing %g m is left; take smaller pores",
             b->key, spacing(q));
  return check_way(q, b->key, *n, *site);
}

bw_status porous_medium_sites(const bw_comm *comm, const porous_config *q, int64_t *n,
                              int32_t **site, uint8_t **kind)
{
  medium_way way = NULL;
  medium_body body = {0};
  *site = NULL, *kind = NULL;
  /* Every rank makes the same list. */
  bw_status st = choose(&q->medium, &way);
  BW_THEN(st, fill(q, way, &body, n, site, kind));
  bw_release(&body.shape);
  bw_shape_mask_destroy(&body.mask);
  return bw_comm_agree(comm, st); /* a file may fail on one rank alone */
}
