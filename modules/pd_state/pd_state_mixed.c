/* Two state-based laws in one body: some groups are ordinary, the others correspondence.
 *
 * A bond's force is what both ends put into it, L_h = sum (T_h<xi> - T_l<-xi>) Gamma dV, and every
 * particle's energy is that of its own bonds by its own law. So the body's force is the sum of what
 * both laws find when to each the other's particles are of a material that resists nothing;
 * momentum and angular momentum stay exact, as each end's part keeps them by itself. What is
 * missing is a force-free state: under a uniform strain both laws spread the same stress
 * differently over a family, which leaves forces in pairs on both sides of a joint
 * (validation/pd_state/joint.c).
 *
 * A bond from one law to the other breaks when the ordinary end's part of its energy is beyond that
 * end's part of the limit. */
#include "pd_state_mixed.h"
#include "bw_memory.h"

#include <string.h>

/* What the other law's particles keep of their modulus: far below rounding, and no division by 0.
 * */
static const double NOTHING = 1e-30;

/* Moduli and fracture energies of a body, to be put back. */
typedef struct {
  bw_pd_material material[BW_PD_GROUPS];
  double joint_G0[BW_PD_GROUPS][BW_PD_GROUPS];
} looks;

/* The other law's groups resist nothing. Of a joint the ordinary end's part can break. */
static looks disguise(bw_pd_body *pd, const bw_pd_mixed *m, int q)
{
  bw_pd_body_config *c = &pd->config;
  looks was;
  memcpy(was.material, c->material, sizeof was.material);
  memcpy(was.joint_G0, c->joint_G0, sizeof was.joint_G0);
  for (int g = 0; g < c->n_group; g++)
    for (int h = 0; h < c->n_group; h++) {
      const bool a = m->options.correspondence_group[g], b = m->options.correspondence_group[h];
      if (a == b && (a ? BW_PD_CORRESPONDENCE_LAW : BW_PD_ORDINARY_LAW) == q) continue;
      const bool joint = a != b && q == BW_PD_ORDINARY_LAW;
      c->joint_G0[g][h] = joint ? 0.5 * bw_pd_state__joint_G0(c, g, h) : INFINITY;
    }
  for (int g = 0; g < c->n_group; g++) {
    if ((m->options.correspondence_group[g] ? BW_PD_CORRESPONDENCE_LAW : BW_PD_ORDINARY_LAW) == q)
      continue;
    c->material[g].E *= NOTHING;
    c->material[g].G0 = INFINITY;
  }
  return was;
}

/* Poisson's ratios stay: a law may have filled them in. */
static void undisguise(bw_pd_body *pd, const looks *was)
{
  for (int g = 0; g < pd->config.n_group; g++) {
    pd->config.material[g].E = was->material[g].E;
    pd->config.material[g].G0 = was->material[g].G0;
  }
  memcpy(pd->config.joint_G0, was->joint_G0, sizeof was->joint_G0);
}

static const void *options_of(const bw_pd_state_mixed_options *o, int q)
{
  return q == BW_PD_ORDINARY_LAW ? (const void *)&o->ordinary : (const void *)&o->correspondence;
}

bw_pd_state_mixed_options bw_pd_state_mixed_options_default(void)
{
  return (bw_pd_state_mixed_options){.ordinary = bw_pd_state_ordinary_options_default(),
                                     .correspondence =
                                         bw_pd_state_correspondence_options_default()};
}

static bw_status check(const bw_pd_body_config *c, const void *options)
{
  BW_REQUIRE(options != NULL, BW_EINPUT,
             "solid: two laws in one body need options that say which group has which");
  const bw_pd_state_mixed_options *o = options;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++)
    BW_TRY(bw_pd_state__mixed_laws[q]->check(c, options_of(o, q)));
  return BW_OK;
}

/* Which blocks a law has to look at. */
static void find_blocks(bw_pd_body *pd, bw_pd_mixed *m)
{
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask >> lane & 1)
        m->part[bw_pd_mixed_law_at(pd, m, block->first + lane)].holds[q] = true;
    for (bw_pd_walk b = bw_pd_walk_families(pd, block); bw_pd_walk_next(&b);)
      m->part[bw_pd_mixed_law_at(pd, m, b.l)].touches[q] =
          m->part[bw_pd_mixed_law_at(pd, m, b.h)].touches[q] = true;
  }
}

/* A pass begins with a look at all particles: short gaps are not worth another one. */
static void fill_gaps(size_t n, bool asked[])
{
  size_t last = n;
  for (size_t q = 0; q < n; q++) {
    if (!asked[q]) continue;
    for (size_t b = last + 1; b < q && q - last < 1 + n / 400; b++)
      asked[b] = true;
    last = q;
  }
}

static bw_status allocate(bw_pd_body *pd, bw_pd_mixed *m)
{
  const size_t pairs = (size_t)(pd->config.n_group * pd->config.n_group);
  for (int k = 0; k < 3; k++)
    BW_TRY(BW_ALLOCATE(&m->other[k], pd->n));
  BW_TRY(BW_ALLOCATE(&m->kx, 3 * pd->n));
  BW_TRY(BW_ALLOCATE(&m->hit, pd->bonds.n_block));
  BW_TRY(BW_ALLOCATE(&m->marked, pd->bonds.n_block));
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++) {
    BW_TRY(BW_ALLOCATE(&m->part[q].holds, pd->bonds.n_block));
    BW_TRY(BW_ALLOCATE(&m->part[q].touches, pd->bonds.n_block));
    for (int l = 0; l <= pd->finest; l++) {
      const size_t n = pairs * (size_t)pd->level[l].stencil.n * BW_PD_ROW;
      BW_TRY(BW_ALLOCATE(&m->part[q].row[l], n));
      memcpy(m->part[q].row[l], pd->level[l].row, n * sizeof(bw_real));
    }
  }
  return BW_OK;
}

static bw_status prepare(bw_pd_body *pd, const void *options)
{
  bw_status st = BW_ALLOCATE((bw_pd_mixed **)&pd->state, 1);
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  if (st == BW_OK) {
    m->options = *(const bw_pd_state_mixed_options *)options;
    st = allocate(pd, m);
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  find_blocks(pd, m);
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++)
    fill_gaps(pd->bonds.n_block, m->part[q].touches);
  for (int q = 0; q < BW_PD_MIXED_LAWS && st == BW_OK; q++) {
    const looks was = disguise(pd, m, q);
    bw_pd_state__mixed_enter(pd, q);
    st = bw_pd_state__mixed_laws[q]->prepare(pd, options_of(&m->options, q));
    bw_pd_state__mixed_leave(pd, m, q);
    undisguise(pd, &was);
  }
  return st;
}

static void constants(bw_pd_body *pd)
{
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++) {
    const looks was = disguise(pd, m, q);
    bw_pd_state__mixed_enter(pd, q);
    bw_pd_state__mixed_laws[q]->constants(pd);
    bw_pd_state__mixed_leave(pd, m, q);
    undisguise(pd, &was);
  }
}

/* Both ends see the same numbers: those of the ordinary law unless both are correspondence. */
static bool beyond(const bw_pd_body *pd, const bw_pd_level *level, const bw_pd_walk *b)
{
  const bw_pd_mixed *m = (const bw_pd_mixed *)pd->state;
  const int q = bw_pd_mixed_law_at(pd, m, b->h) == BW_PD_CORRESPONDENCE_LAW
                    ? bw_pd_mixed_law_at(pd, m, b->l)
                    : BW_PD_ORDINARY_LAW;
  bw_pd_mixed *entered = bw_pd_state__mixed_enter(pd, q);
  const bool out = q == BW_PD_ORDINARY_LAW ? bw_pd_state__ordinary_beyond(pd, level, b)
                                           : bw_pd_state__correspondence_beyond(pd, level, b);
  bw_pd_state__mixed_leave(pd, entered, q);
  return out;
}

static bool breaks(bw_pd_body *pd, bw_pd_block *block)
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  uint8_t changed = 0;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)~block->gone); bw_pd_walk_next(&b);) {
    if (!beyond(pd, level, &b) || bw_pd_walk_unbreakable(&b)) continue;
    bw_pd_body_cut(pd, block, b.slot, b.lane);
    changed |= (uint8_t)(1u << b.lane);
  }
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, BW_PD_CORRESPONDENCE_LAW);
  bw_pd_state__forget(pd, block, changed);
  bw_pd_state__mixed_leave(pd, m, BW_PD_CORRESPONDENCE_LAW);
  return changed != 0;
}

static double bond_energy(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                          int lane)
{
  const int q = bw_pd_mixed_law_at(pd, (const bw_pd_mixed *)pd->state, block->first + lane);
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, q);
  const double out = bw_pd_state__mixed_laws[q]->bond_energy(pd, block, slot, lane);
  bw_pd_state__mixed_leave(pd, m, q);
  return out;
}

static double energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t asked)
{
  double sum = 0;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++) {
    uint8_t own = 0;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask & asked & 1u << lane &&
          bw_pd_mixed_law_at(pd, (const bw_pd_mixed *)pd->state, block->first + lane) == q)
        own |= (uint8_t)(1u << lane);
    if (own == 0) continue;
    bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, q);
    sum += bw_pd_state__mixed_laws[q]->energy(pd, block, own);
    bw_pd_state__mixed_leave(pd, m, q);
  }
  return sum;
}

static double dissipated(const bw_pd_body *pd)
{
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, BW_PD_CORRESPONDENCE_LAW);
  const double out = bw_pd_state__dissipated(pd);
  bw_pd_state__mixed_leave(pd, m, BW_PD_CORRESPONDENCE_LAW);
  return out;
}

static void accept(bw_pd_body *pd)
{
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, BW_PD_CORRESPONDENCE_LAW);
  bw_pd_state__accept(pd);
  bw_pd_state__mixed_leave(pd, m, BW_PD_CORRESPONDENCE_LAW);
}

static void tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++) {
    bw_pd_state__mixed_enter(pd, q);
    bw_pd_state__mixed_laws[q]->tangent(pd, x, q == BW_PD_ORDINARY_LAW ? m->kx : kx);
    bw_pd_state__mixed_leave(pd, m, q);
  }
  for (size_t k = 0; k < 3 * pd->n; k++)
    kx[k] += m->kx[k];
}

static void virial(const bw_pd_body *pd, const bw_pd_block *block, int lane, double sum[3][3])
{
  const int q = bw_pd_mixed_law_at(pd, (const bw_pd_mixed *)pd->state, block->first + lane);
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, q);
  bw_pd_state__mixed_laws[q]->virial(pd, block, lane, sum);
  bw_pd_state__mixed_leave(pd, m, q);
}

static void destroy(bw_pd_body *pd)
{
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  if (m == NULL) return;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++) {
    pd->state = m->part[q].state;
    bw_pd_state__mixed_laws[q]->destroy(pd);
    for (int l = 0; l <= BW_PD_FINEST; l++)
      bw_release(&m->part[q].row[l]);
    bw_release(&m->part[q].holds);
    bw_release(&m->part[q].touches);
  }
  for (int k = 0; k < 3; k++)
    bw_release(&m->other[k]);
  bw_release(&m->kx);
  bw_release(&m->hit);
  bw_release(&m->marked);
  bw_release(&m);
  pd->state = NULL;
}

static const bw_pd_law_key keys[] = {{NULL, NULL, NULL}};

const bw_pd_law bw_pd_state_mixed_law = {
    .name = "ordinary and correspondence",
    .keys = keys,
    .check = check,
    .prepare = prepare,
    .constants = constants,
    .n_sweep = 2,
    .sweep = {bw_pd_state__mixed_deform, bw_pd_state__mixed_force},
    .breaks = breaks,
    .accept = accept,
    .bond_energy = bond_energy,
    .energy = energy,
    .dissipated = dissipated,
    .bound = bw_pd_state__bound,
    .tangent = tangent,
    .rows = bw_pd_state__rows,
    .virial = virial,
    .micromodulus = bw_pd_state__micromodulus,
    .destroy = destroy};
