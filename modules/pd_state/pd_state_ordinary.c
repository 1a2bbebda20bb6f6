/* The ordinary law as a row of the table of laws. */
#include "pd_state_ordinary.h"
#include "bw_memory.h"
#include "pd_jump.h"

bw_pd_state_ordinary_options bw_pd_state_ordinary_options_default(void)
{
  return (bw_pd_state_ordinary_options){.influence = BW_PD_STATE_CONSTANT};
}

static bw_pd_state_ordinary_options resolved(const void *options)
{
  return options == NULL ? bw_pd_state_ordinary_options_default()
                         : *(const bw_pd_state_ordinary_options *)options;
}

static bw_status check(const bw_pd_body_config *c, const void *options)
{
  const bw_pd_state_ordinary_options o = resolved(options);
  BW_REQUIRE((unsigned)o.influence <= BW_PD_STATE_INVERSE, BW_EINPUT,
             "solid: influence = %d is unknown", (int)o.influence);
  const bw_pd_finer *f = &c->finer;
  const bool levels = f->n > 0 || f->map != NULL;
  BW_REQUIRE(!levels || (f->map == NULL && !f->same_horizon && f->jump != BW_PD_JUMP_ONE_SIDED),
             BW_EINPUT,
             "solid: law = ordinary knows levels that stay, each with its own horizon; levels that "
             "change, one horizon for all and one-sided bonds are of law = bond");
  return bw_pd_state__check_poisson(c);
}

static bw_status prepare(bw_pd_body *pd, const void *options)
{
  bw_status st = BW_ALLOCATE((bw_pd_ordinary **)&pd->state, 1);
  if (st == BW_OK) {
    bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
    double moment;
    o->options = resolved(options);
    for (int l = 0; l <= pd->finest; l++)
      BW_THEN(st, bw_pd_state__full_sums(pd, &pd->level[l], &o->crossing[l], &moment));
    BW_THEN(st, bw_pd_body_add_field(pd, 0, false, &o->pull));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, false, &o->q));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, false, &o->stiff));
    BW_THEN(st, bw_pd_body_add_field(pd, -1, false, &o->swell));
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_pd_state__resolve_poisson(&pd->config);
  if (pd->finest > 0) return bw_pd_state__ordinary_levels(pd);
  bw_pd_state__ordinary_moments(pd);
  return BW_OK;
}

/* Columns of the kernel rows of a level of bonds between two groups. */
static void row_constants(bw_pd_body *pd, const bw_pd_level *level, int g, int h)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  const bw_pd_stencil *s = &level->stencil;
  bw_real *row = bw_pd_state__row(pd, level, g, h);
  const bool cloud = pd->config.disorder > 0;
  /* With all bonds across a flat cut at w_c their sum is G0 (ERRATA-ADAPT 24). A crack breaks them
   * one by one and needs more. */
  const bw_pd_body_config *c = &pd->config;
  const double nu =
      bw_pd_state__strain_poisson(c->geometry, 0.5 * (c->material[g].nu + c->material[h].nu));
  const double held =
      bw_pd_state__joint_G0(c, g, h) /
      bw_pd_state__ordinary_crack(c, o->options.influence == BW_PD_STATE_INVERSE, nu);
  for (int q = 0; q < s->n; q++, row += BW_PD_ROW) {
    const double w = cloud ? 1 : bw_pd_ordinary_influence(o, s->r0[q]);
    row[BW_PD_STIFFNESS] = (bw_real)(w * ((cloud ? 1 : s->fraction[q]) * level->dv));
    row[BW_PD_LIMIT2] = (bw_real)(2 * (held / o->crossing[level - pd->level]) / w);
    row[BW_PD_PARTNER_LIMIT] = (bw_real)(2 * (held / o->crossing[s->other[q]]) / w);
  }
}

static void constants(bw_pd_body *pd)
{
  bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  const int groups = pd->config.n_group, d = pd->dimension;
  o->dilates = o->breakable = false;
  for (int g = 0; g < groups; g++) {
    bw_pd_state__lame(&pd->config, &pd->config.material[g], &o->lam[g], &o->mu[g]);
    /* The bond law's own ratio: what is left of lam* - mu is rounding. */
    if (fabs(o->lam[g] - o->mu[g]) < 1e-14 * o->mu[g]) o->lam[g] = o->mu[g];
    o->dilates |= o->lam[g] != o->mu[g];
    for (int h = 0; h < groups; h++) {
      o->breakable |= isfinite(bw_pd_state__joint_G0(&pd->config, g, h));
      for (int l = 0; l <= pd->finest; l++)
        row_constants(pd, &pd->level[l], g, h);
    }
  }
  for (size_t e = 0; e < pd->n_extended; e++) {
    const int32_t p = pd->points.place[e];
    const int g = pd->points.group[e];
    const double q = (double)o->q[p];
    /* A particle without bonds neither pulls nor is asked. */
    o->stiff[p] = (bw_real)(q > 0 ? d * (d + 2) * o->mu[g] / q : 0);
    o->swell[p] = (bw_real)(q > 0 ? d * d * (o->lam[g] - o->mu[g]) / (q * q) : 0);
  }
}

/* Energy of the particle of a lane with the bonds that hold but for `without` (NULL: all). */
static double particle_energy(const bw_pd_body *pd, const bw_pd_block *block, int lane,
                              const bw_pd_slot *without)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  double swell = 0, bonds = 0, y[3];
  const int32_t h = block->first + lane;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)(1u << lane)); bw_pd_walk_next(&b);) {
    if (b.slot == without) continue;
    const double w = bw_pd_ordinary_weight(pd, block, &b);
    const double e = bw_pd_walk_present(&b, y) - b.rest.r0;
    swell += w * b.rest.r0 * e;
    bonds += w * e * e;
  }
  /* swell is d^2 (lam* - mu)/q^2, stiff d (d + 2) mu/q. */
  return 0.5 * bw_pd_body_level_of(pd, block)->dv *
         ((double)o->swell[h] * swell * swell + (double)o->stiff[h] * bonds);
}

/* What the owner's particle loses with the bond: energies of bonds cut one by one add up to what a
 * family held, though its dilatation belongs to all of them. */
static double bond_energy(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                          int lane)
{
  return particle_energy(pd, block, lane, NULL) - particle_energy(pd, block, lane, slot);
}

static double energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked)
{
  double sum = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask & asked & 1u << lane) sum += particle_energy(pd, block, lane, NULL);
  return sum;
}

/* Both ends see the same numbers, in sums that do not depend on their order. */
bool bw_pd_state__ordinary_beyond(const bw_pd_body *pd, const bw_pd_level *level,
                                  const bw_pd_walk *b)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  double y[3];
  const double e = bw_pd_walk_present(b, y) - b->rest.r0;
  const double f = ((double)o->stiff[b->h] + (double)o->stiff[b->l]) * e +
                   ((double)o->pull[b->h] + (double)o->pull[b->l]) * b->rest.r0;
  const bw_real *row =
      bw_pd_state__row(pd, level, bw_pd_body_group_at(pd, b->h), bw_pd_body_group_at(pd, b->l));
  double limit = (double)row[b->slot->direction * BW_PD_ROW + BW_PD_LIMIT2];
  if (pd->config.disorder > 0 && o->options.influence == BW_PD_STATE_INVERSE) limit *= b->rest.r0;
  return e > 0 && f * e > limit;
}

/* Whether a bond has two weights: across a jump, or where they differ. */
static bool has_two(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_walk *b)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  if (o->own == NULL || block->exact < 0) return false;
  const size_t at = bw_pd_ordinary_near(pd, block, b->slot) + (size_t)b->lane;
  return b->slot->direction >= bw_pd_body_level_of(pd, block)->stencil.same ||
         o->own[at] != o->reverse[at];
}

/* The same of a bond of two weights: what both halves hold, each by its own weight, against what
 * each may hold. From either end the same numbers but for a power of 2. */
static bool near_beyond(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_walk *b)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  const size_t at = bw_pd_ordinary_near(pd, block, b->slot) + (size_t)b->lane;
  const bw_real *row =
      bw_pd_state__row(pd, level, bw_pd_body_group_at(pd, b->h), bw_pd_body_group_at(pd, b->l)) +
      b->slot->direction * BW_PD_ROW;
  double y[3], half[2];
  const double e = bw_pd_walk_present(b, y) - b->rest.r0;
  for (int q = 0; q < 2; q++) {
    const int32_t p = q == 0 ? b->h : b->l;
    const double f = (double)o->stiff[p] * e + (double)o->pull[p] * b->rest.r0;
    const double limit = (double)row[q == 0 ? BW_PD_LIMIT2 : BW_PD_PARTNER_LIMIT];
    half[q] = (double)(q == 0 ? o->own : o->reverse)[at] * (f * e - 0.5 * limit);
  }
  return e > 0 && half[0] + half[1] > 0;
}

/* The force of what breaks goes with the passes that follow. */
static bool breaks(bw_pd_body *pd, bw_pd_block *block)
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  bool any = false;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)~block->gone); bw_pd_walk_next(&b);) {
    if (!(has_two(pd, block, &b) ? near_beyond(pd, block, &b)
                                 : bw_pd_state__ordinary_beyond(pd, level, &b)) ||
        bw_pd_walk_unbreakable(&b))
      continue;
    if (bw_pd_body_above_finest(pd, block, b.slot)) {
      bw_pd_body_note_astray(pd, block, (uint8_t)(1u << b.lane));
      continue;
    }
    bw_pd_body_cut(pd, block, b.slot, b.lane);
    any = true;
  }
  return any;
}

/* J sigma = sum_l t_h y y/|y| Gamma dV: the particle's own part, which in a homogeneous strain is
 * that of its neighbours, too. */
static void virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3])
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  const uint8_t one = (uint8_t)(1u << lane);
  const int32_t h = block->first + lane;
  double y[3], pull = 0;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, one); bw_pd_walk_next(&b);)
    pull +=
        bw_pd_ordinary_weight(pd, block, &b) * b.rest.r0 * (bw_pd_walk_present(&b, y) - b.rest.r0);
  pull *= (double)o->swell[h];
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, one); bw_pd_walk_next(&b);) {
    const double r = bw_pd_walk_present(&b, y);
    const double t = bw_pd_ordinary_weight(pd, block, &b) *
                     (pull * b.rest.r0 + (double)o->stiff[h] * (r - b.rest.r0));
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        sum[i][j] += t * y[i] * y[j] / r;
  }
}

static void destroy(bw_pd_body *pd)
{
  if (pd->state == NULL) return;
  bw_release(&bw_pd_ordinary_of(pd)->own);
  bw_release(&bw_pd_ordinary_of(pd)->reverse);
  bw_release(&pd->state);
}

static const bw_pd_law_key keys[] = {
    {"young_modulus", "Pa", "Young's modulus, above 0; required"},
    {"poisson_ratio", "",
     "Poisson's ratio, -1 .. 0.4999; default that of bonds: 1/4, 1/3 in plane "
     "stress"},
    {"fracture_energy", "J/m2", "energy of a cut per area, above 0; default: it does not break"},
    {"influence", "", "weight of a neighbour: constant or inverse (1/|xi|); default constant"},
    {NULL, NULL, NULL}};

const bw_pd_law bw_pd_state_ordinary_law = {
    .name = "ordinary",
    .keys = keys,
    .check = check,
    .prepare = prepare,
    .constants = constants,
    .n_sweep = 2,
    .levels = true,
    .sweep = {bw_pd_state__ordinary_dilate, bw_pd_state__ordinary_force},
    .breaks = breaks,
    .bond_energy = bond_energy,
    .energy = energy,
    .bound = bw_pd_state__bound,
    .tangent = bw_pd_state__ordinary_tangent,
    .rows = bw_pd_state__rows,
    .virial = virial,
    .micromodulus = bw_pd_state__micromodulus,
    .destroy = destroy};
