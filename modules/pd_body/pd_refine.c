/* Which cells of a body are split: boxes of finer particles with belts around them.
 *
 * A box of level L splits the cells of level L - 1 that it meets. So that a particle never has a
 * bond to one two levels away, these are surrounded by a belt of level L - 1 that is as wide as the
 * horizon of level L - 2: the cells of level L - 2 that belt and box meet are split, too, and so
 * on down to level 0. All that is a range of cells per box and level: every rank knows which cells
 * are split without asking. A cell's particle is at its centre; its parts have the mass it had. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells lower .. upper - 1 of one level. */
typedef struct {
  int64_t lower[3], upper[3];
} range;

/* What is split: of box b the cells split[b][l] of each level l below its own. */
typedef struct {
  const bw_pd_body_config *config;
  int axes, finest;
  int64_t period[3]; /* in cells of level 0; 0: none */
  range split[BW_PD_BOXES][BW_PD_FINEST];
} plan;

int bw_pd_body_finest(const bw_pd_body_config *c)
{
  int finest = c->finer.map != NULL ? c->finer.map->finest : 0;
  for (int b = 0; b < c->finer.n; b++)
    finest = c->finer.box[b].level > finest ? c->finer.box[b].level : finest;
  return finest;
}

/* A number of cells from the origin, far beyond any body where the box is endless. */
static int64_t whole(double x)
{
  static const double FAR = 1 << 28;
  return (int64_t)fmax(-FAR, fmin(FAR, x));
}

static int64_t half_down(int64_t x)
{
  return (x - (x < 0)) / 2;
}

static void make_plan(const bw_pd_body_config *c, plan *p)
{
  static const double TOUCH = 1e-6; /* a box that only touches a cell, to rounding, leaves it */
  *p = (plan){.config = c, .axes = c->geometry == BW_PD_3D ? 3 : 2, .finest = bw_pd_body_finest(c)};
  for (int k = 0; k < p->axes; k++)
    p->period[k] = llround(c->period[k] / c->ds);
  for (int b = 0; b < c->finer.n; b++) {
    const bw_pd_box *box = &c->finer.box[b];
    const double ds = ldexp(c->ds, 1 - box->level);
    for (int k = 0; k < p->axes; k++) {
      double from = 0;
      for (int q = 0; q < 3; q++)
        from += c->axes[k][q] * c->origin[q];
      /* The box itself, then outwards: a belt, and whole cells of the next coarser level. */
      range *r = &p->split[b][box->level - 1];
      r->lower[k] = whole(floor((box->lower[k] - from) / ds + TOUCH));
      r->upper[k] = whole(ceil((box->upper[k] - from) / ds - TOUCH));
      for (int l = box->level - 2; l >= 0; l--, r--) {
        /* A horizon of level l, in cells of the next finer one. */
        const int halved = c->finer.same_horizon ? l + 1 : 1;
        const int64_t belt = (int64_t)ceil(ldexp(c->horizon_ratio, halved));
        p->split[b][l].lower[k] = half_down(r->lower[k] - belt);
        p->split[b][l].upper[k] = -half_down(-(r->upper[k] + belt));
      }
    }
  }
}

static bool within(const plan *p, int b, int l, const int32_t cell[3])
{
  const range *r = &p->split[b][l];
  for (int k = 0; k < p->axes; k++) {
    /* A box has an image in every period. */
    const int64_t period = p->period[k] << l;
    bool in = false;
    for (int64_t image = period > 0 ? -1 : 0; image <= (period > 0); image++) {
      const int64_t x = cell[k] + image * period;
      in = in || (x >= r->lower[k] && x < r->upper[k]);
    }
    if (!in) return false;
  }
  return true;
}

/* Level that the map gives to the cell of level 0 around a cell of level l. */
static int level_of(const bw_pd_map *map, int axes, int l, const int32_t cell[3])
{
  size_t at = 0;
  for (int k = axes - 1; k >= 0; k--) {
    const int32_t x = (cell[k] >> l) - map->lower[k];
    if (x < 0 || x >= map->size[k]) return 0;
    at = at * (size_t)map->size[k] + (size_t)x;
  }
  return map->level[at];
}

static bool is_split(const plan *p, int l, const int32_t cell[3])
{
  const bw_pd_map *map = p->config->finer.map;
  if (map != NULL && level_of(map, p->axes, l, cell) > l) return true;
  for (int b = 0; b < p->config->finer.n; b++)
    if (p->config->finer.box[b].level > l && within(p, b, l, cell)) return true;
  return false;
}

/* The cell of a given row and its parts, from row n of out on (counted only while out->site is
 * NULL). Returns the row after them. */
static size_t put(const plan *p, const bw_pd_sites *given, int64_t row, int l,
                  const int32_t cell[3], size_t n, bw_pd_refined *out)
{
  if (is_split(p, l, cell)) {
    for (int part = 0; part < 1 << p->axes; part++) {
      int32_t child[3] = {0};
      for (int k = 0; k < p->axes; k++)
        child[k] = 2 * cell[k] + (part >> k & 1);
      n = put(p, given, row, l + 1, child, n, out);
    }
    return n;
  }
  if (out->site != NULL) {
    /* A centre in half spacings of the finest level: (2 cell + 1) half spacings of its own. */
    for (int k = 0; k < 3; k++)
      out->site[3 * n + (size_t)k] =
          k < p->axes ? (2 * cell[k] + 1) * (1 << (p->finest - l)) : cell[k];
    out->level[n] = (uint8_t)l;
    out->kind[n] = given->kind == NULL ? BW_PD_FREE : given->kind[row];
    out->group[n] = given->group == NULL ? 0 : given->group[row];
  }
  return n + 1;
}

static bw_status refine(const plan *p, const bw_pd_sites *given, bw_pd_refined *out)
{
  size_t n = 0;
  for (int pass = 0; pass < 2; pass++) {
    n = 0;
    for (int64_t q = 0; q < given->n; q++)
      n = put(p, given, q, 0, given->site + 3 * q, n, out);
    if (pass == 1) break;
    BW_REQUIRE(n < INT32_MAX, BW_EINPUT,
               "solid: %zu particles of one rank after cells were split; it takes 2^31", n);
    BW_TRY(BW_ALLOCATE(&out->level, n));
    BW_TRY(BW_ALLOCATE(&out->kind, n));
    BW_TRY(BW_ALLOCATE(&out->group, n));
    BW_TRY(BW_ALLOCATE(&out->site, 3 * n));
  }
  out->sites =
      (bw_pd_sites){.n = (int64_t)n, .site = out->site, .kind = out->kind, .group = out->group};
  return BW_OK;
}

bw_status bw_pd_body_refine(const bw_pd_body_config *c, const bw_pd_sites *given,
                            bw_pd_refined *out)
{
  plan p;
  *out = (bw_pd_refined){.sites = *given};
  if (bw_pd_body_finest(c) == 0) return BW_OK;
  make_plan(c, &p);
  /* Sites become places: products of 2^(finest + 1) have to fit. */
  for (int64_t q = 0; q < 3 * given->n; q++)
    BW_REQUIRE(labs((long)given->site[q]) < 1 << 20, BW_EINPUT,
               "solid: site %d of a body with levels is more than 2^20 steps from the origin",
               given->site[q]);
  return refine(&p, given, out);
}

void bw_pd_body_refined_release(bw_pd_refined *r)
{
  bw_release(&r->site);
  bw_release(&r->level);
  bw_release(&r->kind);
  bw_release(&r->group);
}
