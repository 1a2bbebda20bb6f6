/* Which sites are the medium: a box with pores taken out, or a body from a file cut to the box; on
 * a slab under the lower wall that holds it. */
#include "bw_memory.h"
#include "bw_shape_pack.h"
#include "bw_shape_way.h"
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

/* Is the outflow reached from the inflow, from cell to cell over their faces? Collective. */
static bw_status check_way(const bw_comm *comm, const porous_config *q, const char *key, int64_t n,
                           const int32_t site[])
{
  const int *cells = q->domain.cells;
  const bw_shape_way_box channel = {
      .cells = {cells[0], cells[1], cells[2]}, .axis = 0, .periodic = {false, false, true}};
  bw_shape_way way;
  /* Particles sit on the fluid's cells: a site is a cell. The slab under the wall lies outside the
   * channel and is left out. */
  BW_TRY(bw_shape_find_way(comm, &channel, n, site, &way));
  BW_REQUIRE(way.through, BW_EINPUT,
             "%s: nothing flows through, as no way one cell (%g m) wide joins inflow and "
             "outflow; take larger pores",
             key, spacing(q));
  return BW_OK;
}

/* This rank's part of the body. Collective. */
static bw_status fill(const bw_comm *comm, const porous_config *q, medium_body *b, int64_t *n,
                      int32_t **site, uint8_t **kind)
{
  static const double origin[3] = {0.0, 0.0, 0.0};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(spacing(q), origin, false);
  /* The slab comes last: it is under the box and takes nothing from it. */
  if (q->medium.clamped_layers > 0) b->shape[b->count++] = slab_of(q);
  BW_TRY(bw_shape_fill_shared(comm, b->count, b->shape, &lattice, n, site, kind, NULL));
  int64_t above = 0;
  /* The slab alone is no medium. */
  for (int64_t k = 0; k < *n; k++)
    above += (*site)[3 * k + 1] >= 0;
  bw_comm_sum_int(comm, 1, &above);
  BW_REQUIRE(above > 0, BW_EINPUT, "%s: no particle of spacing %g m is left; take smaller pores",
             b->key, spacing(q));
  return BW_OK;
}

bw_status porous_medium_sites(const bw_comm *comm, const porous_config *q, int64_t *n,
                              int32_t **site, uint8_t **kind)
{
  medium_way way = NULL;
  medium_body body = {0};
  *site = NULL, *kind = NULL;
  /* All ranks describe the same body, of which each fills a part. */
  bw_status st = choose(&q->medium, &way);
  BW_THEN(st, way(q, &body));
  st = bw_comm_agree(comm, st); /* a file may fail on one rank alone */
  BW_THEN(st, fill(comm, q, &body, n, site, kind));
  BW_THEN(st, check_way(comm, q, body.key, *n, *site));
  bw_release(&body.shape);
  bw_shape_mask_destroy(&body.mask);
  return st;
}

/* Sites inside a body, from some of its rows if there are many. */
static bw_status count_some(const medium_body *b, const bw_shape_lattice *lattice,
                            double *particles)
{
  enum { ROWS = 512 };
  int64_t lo[3], hi[3], n = 0, sum = 0;
  BW_TRY(bw_shape_range(b->count, b->shape, lattice, lo, hi));
  const double rows = (double)(hi[1] - lo[1]) * (double)(hi[2] - lo[2]);
  const int parts = (int)fmin(rows, (double)INT32_MAX), looks = parts < ROWS ? parts : ROWS;
  for (int q = 0; q < looks; q++) {
    /* All rows, or some that keep no step with the pores: multiples of the golden section. */
    const double place = fmod(0.61803398874989485 * (q + 0.5), 1.0);
    const int part = looks == parts ? q : (int)(place * parts);
    BW_TRY(bw_shape_count(b->count, b->shape, lattice, part, parts, &n));
    sum += n;
  }
  /* Nothing in the rows that were looked at: in all of them? */
  if (sum == 0)
    BW_TRY(bw_shape_count(b->count, b->shape, lattice, 0, 1, &sum));
  else
    *particles = (double)sum * parts / looks;
  if (*particles == 0.0) *particles = (double)sum;
  return BW_OK;
}

bw_status porous_medium_try(const bw_comm *comm, const porous_config *q, bw_log *log,
                            double *particles, bool *exact)
{
  static const double few = 2097152.0; /* cells whose ways are looked for */
  static const double origin[3] = {0.0, 0.0, 0.0};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(spacing(q), origin, false);
  const int *cells = q->domain.cells;
  *exact = (double)cells[0] * cells[1] * cells[2] <= few;
  if (*exact) {
    int64_t n = 0;
    int32_t *site = NULL;
    uint8_t *kind = NULL;
    *particles = 0.0;
    BW_TRY(porous_medium_sites(comm, q, &n, &site, &kind));
    for (int64_t k = 0; k < n; k++)
      *particles += site[3 * k + 1] >= 0;
    bw_release(&site);
    bw_release(&kind);
    bw_comm_sum(comm, 1, particles);
    return BW_OK;
  }
  medium_way way = NULL;
  medium_body body = {0};
  *particles = 0.0;
  bw_status st = choose(&q->medium, &way);
  BW_THEN(st, way(q, &body));
  BW_THEN(st, count_some(&body, &lattice, particles));
  if (st == BW_OK && *particles == 0.0)
    st = BW_FAIL(BW_EINPUT, "%s: no particle of spacing %g m is left; take smaller pores", body.key,
                 spacing(q));
  bw_release(&body.shape);
  bw_shape_mask_destroy(&body.mask);
  BW_TRY(bw_comm_agree(comm, st));
  bw_log_info(log, "medium     whether a way leads through is looked for when the run begins");
  return BW_OK;
}
