/* Which sites are the medium: a box with pores taken out, or a body from a file cut to the box;
 * with a slab behind each wall that holds it. */
#include "bw_memory.h"
#include "bw_shape_pack.h"
#include "bw_shape_way.h"
#include "porous_body.h"

#include <math.h>
#include <stdio.h>

static double spacing(const porous_config *q)
{
  return q->domain.length[1] / q->domain.cells[1];
}

int porous_clamps(const porous_medium *m)
{
  return m->clamped_layers > 0 ? m->clamped : 0;
}

/* Behind the floor or the ceiling. */
static bw_shape slab_of(const porous_config *q, int wall)
{
  const double thick = q->medium.clamped_layers * spacing(q), height = q->domain.length[1];
  bw_shape slab = porous_box(q);
  slab.lower[1] = wall == CLAMP_FLOOR ? -thick : height;
  slab.upper[1] = wall == CLAMP_FLOOR ? 0.0 : height + thick;
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

static bw_status lattice(const porous_config *q, porous_body *b)
{
  const porous_medium *m = &q->medium;
  BW_TRY(check_lattice(q));
  BW_TRY(BW_ALLOCATE(&b->shape, 2 + POROUS_SLABS));
  /* A box, less spheres on the sites of a lattice. */
  b->shape[0] = porous_box(q);
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
static bw_status random_pores(const porous_config *q, porous_body *b)
{
  const porous_random *r = &q->medium.random;
  const bw_shape box = porous_box(q);
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
  const bw_status st = BW_ALLOCATE(&b->shape, (size_t)count + 1 + POROUS_SLABS);
  /* A box, less all balls; room for the slabs that may follow. */
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

typedef bw_status (*medium_way)(const porous_config *q, porous_body *b);

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
  *way = m->has_random    ? random_pores
         : m->has_image   ? porous_image_body
         : m->has_surface ? porous_surface_body
                          : lattice;
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
  /* Particles sit on the fluid's cells: a site is a cell. Slabs behind the walls lie outside the
   * channel and are left out. */
  BW_TRY(bw_shape_find_way(comm, &channel, n, site, &way));
  BW_REQUIRE(way.through, BW_EINPUT,
             "%s: nothing flows through, as no way one cell (%g m) wide joins inflow and "
             "outflow; take larger pores",
             key, spacing(q));
  return BW_OK;
}

/* In the channel, and not in a slab behind its walls. */
static bool within(const porous_config *q, const int32_t site[3])
{
  return site[1] >= 0 && site[1] < q->domain.cells[1];
}

/* This rank's part of the body. Collective. */
static bw_status fill(const bw_comm *comm, const porous_config *q, porous_body *b, int64_t *n,
                      int32_t **site, uint8_t **kind)
{
  static const double origin[3] = {0.0, 0.0, 0.0};
  const bw_shape_lattice lattice = bw_shape_lattice_straight(spacing(q), origin, false);
  /* The slabs come last: they are beyond the box and take nothing from it. */
  for (int wall = CLAMP_FLOOR; wall <= CLAMP_CEILING; wall++)
    if (porous_clamps(&q->medium) & wall) b->shape[b->count++] = slab_of(q, wall);
  BW_TRY(bw_shape_fill_shared(comm, b->count, b->shape, &lattice, n, site, kind, NULL));
  int64_t inside = 0;
  /* Slabs alone are no medium. */
  for (int64_t k = 0; k < *n; k++)
    inside += within(q, *site + 3 * k);
  bw_comm_sum_int(comm, 1, &inside);
  BW_REQUIRE(inside > 0, BW_EINPUT, "%s: no particle of spacing %g m is left; take smaller pores",
             b->key, spacing(q));
  return BW_OK;
}

bw_status porous_medium_sites(const bw_comm *comm, const porous_config *q, bw_case *run, int64_t *n,
                              int32_t **site, uint8_t **kind)
{
  const bool tell = run != NULL && bw_case_args_of(run)->check;
  medium_way way = NULL;
  porous_body body = {0};
  *site = NULL, *kind = NULL;
  /* All ranks describe the same body, of which each fills a part. */
  bw_status st = choose(&q->medium, &way);
  BW_THEN(st, way(q, &body));
  st = bw_comm_agree(comm, st); /* a file may fail on one rank alone */
  /* What the file holds is told first, as it may be the reason why nothing is left of it. */
  if (st == BW_OK && tell) st = porous_tell_mask(comm, q, &body, run);
  BW_THEN(st, fill(comm, q, &body, n, site, kind));
  BW_THEN(st, check_way(comm, q, body.key, *n, *site));
  if (st == BW_OK && tell) st = porous_tell_pores(comm, q, *n, *site, run);
  bw_release(&body.shape);
  bw_shape_mask_destroy(&body.mask);
  return st;
}

/* Sites inside a body, from some of its rows if there are many. */
static bw_status count_some(const porous_body *b, const bw_shape_lattice *lattice,
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

bw_status porous_medium_try(const bw_comm *comm, const porous_config *q, bw_case *run,
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
    BW_TRY(porous_medium_sites(comm, q, run, &n, &site, &kind));
    for (int64_t k = 0; k < n; k++)
      *particles += within(q, site + 3 * k);
    bw_release(&site);
    bw_release(&kind);
    bw_comm_sum(comm, 1, particles);
    return BW_OK;
  }
  medium_way way = NULL;
  porous_body body = {0};
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
  bw_log_info(bw_case_log(run),
              "medium     whether a way leads through is looked for when the run begins");
  return BW_OK;
}
