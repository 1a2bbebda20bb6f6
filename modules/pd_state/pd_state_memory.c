/* Materials of a block's particles, and what those that yield remember. */
#include "bw_pd_material_criterion.h"
#include "pd_state_correspondence.h"

#include <string.h>

typedef bw_pd_material_lanes wide;

/* The numbers of a state in the order of the fields. */
static wide *number(bw_pd_material_state *s, int q)
{
  return q < 9 ? &s->H[q] : q < 15 ? &s->sigma[q - 9] : q == 15 ? &s->flow : &s->dissipated;
}

bw_pd_material_state bw_pd_state__remembered(const bw_pd_body *pd, int32_t place)
{
  bw_pd_material_state s;
  for (int q = 0; q < BW_PD_REMEMBERED; q++)
    for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++)
      (*number(&s, q))[lane] = (double)bw_pd_correspondence_of(pd)->accepted[q][place];
  return s;
}

/* A step of the lanes' states, to `trial`. */
static void remember(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked,
                     const bw_pd_material_point *m, const wide H[9], wide P[9])
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  bw_pd_material_state old = {0}, next;
  for (int q = 0; q < BW_PD_REMEMBERED; q++)
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (asked >> lane & 1) (*number(&old, q))[lane] = (double)o->accepted[q][block->first + lane];
  bw_pd_material_rate(m, &old, H, &next, P, NULL);
  for (int q = 0; q < BW_PD_REMEMBERED; q++)
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (asked >> lane & 1) o->trial[q][block->first + lane] = (bw_real)(*number(&next, q))[lane];
}

static void of_group(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked, int group,
                     bool small, wide H[9], wide P[9])
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_material_point *m = &o->material[group];
  if (small)
    bw_pd_material_stress(&o->small[group], H, P, NULL);
  else if (isfinite(m->yield.k))
    remember(pd, block, asked, m, H, P);
  else
    bw_pd_material_stress(m, H, P, NULL);
}

void bw_pd_state__stress(const bw_pd_body *pd, const bw_pd_block *block, bool small,
                         bw_pd_material_lanes H[9], bw_pd_material_lanes P[9])
{
  if (block->group != BW_PD_MIXED) {
    of_group(pd, block, block->mask, block->group, small, H, P);
    return;
  }
  /* Each group's material for all, of which its own lanes are kept. */
  memset(P, 0, 9 * sizeof *P);
  for (int g = 0; g < pd->config.n_group; g++) {
    uint8_t own = 0;
    wide G[9], Q[9];
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask >> lane & 1 && bw_pd_body_group_at(pd, block->first + lane) == g)
        own |= (uint8_t)(1u << lane);
    if (own == 0) continue;
    memcpy(G, H, sizeof G);
    of_group(pd, block, own, g, small, G, Q);
    for (int q = 0; q < 9; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if (own >> lane & 1) P[q][lane] = Q[q][lane];
  }
}

/* sigma = P F^T/J, xx yy zz yz xz xy. */
static void cauchy(const double H[9], const double P[9], double s[6])
{
  double F[9];
  for (int q = 0; q < 9; q++)
    F[q] = H[q] + (q % 4 == 0);
  const double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                   F[2] * (F[3] * F[7] - F[4] * F[6]);
  for (int q = 0; q < 6; q++) {
    const int i = q < 3 ? q : (q + 1) % 3, j = q < 3 ? q : (q + 2) % 3;
    s[q] = 0;
    for (int k = 0; k < 3; k++)
      s[q] += P[3 * i + k] * F[3 * j + k] / J;
  }
}

/* The criterion of a rule that breaks by the stress. */
static bw_pd_material_criterion_kind criterion(bw_pd_state_breaks breaks)
{
  switch (breaks) {
  case BW_PD_STATE_BREAKS_BY_ENERGY:
    return BW_PD_MATERIAL_ENERGY;
  case BW_PD_STATE_BREAKS_BY_MISES:
    return BW_PD_MATERIAL_MISES;
  case BW_PD_STATE_BREAKS_BY_MOHR_COULOMB:
    return BW_PD_MATERIAL_MOHR_COULOMB;
  case BW_PD_STATE_BREAKS_BY_CONE:
    return BW_PD_MATERIAL_CONE;
  default:
    return BW_PD_MATERIAL_RANKINE;
  }
}

void bw_pd_state__measure(const bw_pd_body *pd, const bw_pd_block *block,
                          const bw_pd_material_lanes H[9], const bw_pd_material_lanes P[9])
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_material_criterion c = {criterion(o->options.breaks), o->options.limit,
                                      o->options.friction};
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const int32_t h = block->first + lane;
    if (o->options.breaks == BW_PD_STATE_BREAKS_BY_FLOW) {
      o->measure[h] = (bw_real)(o->remembers ? (double)o->trial[15][h] / o->options.limit : 0);
      continue;
    }
    double h9[9], p9[9], s[6];
    for (int q = 0; q < 9; q++)
      h9[q] = H[q][lane], p9[q] = P[q][lane];
    cauchy(h9, p9, s);
    const bw_pd_material_point *m = &o->material[bw_pd_body_group_at(pd, h)];
    o->measure[h] = (bw_real)bw_pd_material_used(&c, m->lam, m->mu, s);
  }
}

void bw_pd_state__soften(const bw_pd_body *pd, const bw_pd_block *block)
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  for (int lane = 0; lane < BW_PD_LANES && o->whole != NULL; lane++) {
    const int32_t h = block->first + lane;
    if (!(block->mask >> lane & 1) || !(o->whole[h] > 0)) continue;
    const double left = bw_pd_correspondence_secant(pd, h, (double)o->trial[15][h]);
    o->beta[h] = (bw_real)(left * (double)o->whole[h]);
  }
}

double bw_pd_state__dissipated(const bw_pd_body *pd)
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  double sum = 0;
  for (size_t i = 0; i < pd->n && o->remembers; i++)
    sum += (double)o->accepted[BW_PD_REMEMBERED - 1][pd->points.place[i]] *
           bw_pd_body_level(pd, i)->dv;
  return sum;
}
