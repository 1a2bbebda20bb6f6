/* The bond force 3.39 and the bond energy, block by block.
 *
 * With q = 1/(r S), S = w_h + w_l, T = r^2 S^2 the volume-corrected coefficient is
 *   2 c0 Gamma dV/(rho r0) (r - r0)/(r S) = k q (q r^2 S - r0):
 * one reciprocal root holds the length and the correction. In a cloud it is
 *   2 c0 Gamma dV/rho (r/r0 - 1)/(r S) = K Gamma q (q r^2 S/r0 - 1), with 1/r0 another root. */
#include "pd_bond.h"
#include "pd_jump.h"
#include "pd_sweep.h"

/* The sweeps are compiled once per geometry, correction, check, damping, and for lattices and
 * clouds: nothing of that is decided inside their loops. */

/* Acceleration = force times bond vector; inverse2 = 1/r^2. */
typedef struct {
  vec force, inverse2;
} coefficients;

/* A sweep with the surface factors of particles (w, storage) or of bonds (alpha, as slots). */
typedef struct {
  sweep all;
  const bw_real *w;
  const uint16_t *alpha;
  const bw_real *exact;
} bonds;

INLINE bonds bonds_of(const bw_pd_body *pd)
{
  return (bonds){sweep_of(pd), bw_pd_bond__state(pd)->w, pd->bonds.factor, pd->bonds.exact};
}

/* The bonds' own factors in units of the row's stiffness. */
INLINE vec stored(const bonds *s, const bw_pd_slot *slot)
{
  return vec_whole(s->alpha + (slot - s->all.slot) * BW_PD_LANES);
}

/* Those near a jump between levels, in the same units. */
INLINE vec exactly(const bonds *s, const bw_pd_block *block, const bw_pd_slot *slot)
{
  return vec_load(s->exact +
                  (block->exact + (slot - s->all.slot - (ptrdiff_t)block->slot)) * BW_PD_LANES);
}

INLINE coefficients cloud_coefficient(const bonds *s, const bw_pd_slot *slot, vec stiffness,
                                      const bond *x, vec wh, int surface)
{
  /* 1/|xi|, for Gamma and for the stretch. */
  const vec q0 = vec_rsqrt(x->rest2);
  const vec k = stiffness * gamma_of(&s->all, x->rest2 * q0);
  /* alpha = 2 V_0/(V_h + V_l) is in the root; of energy the mean of both ends. */
  if (surface == BW_PD_SURFACE_VOLUME) {
    const vec sum = wh + vec_load(s->w + slot->base), t = x->r2 * sum;
    const vec q = vec_rsqrt(t * sum), qs = q * sum;
    return (coefficients){k * q * vec_fma(t * q, q0, vec_all(-1)), qs * qs};
  }
  const vec q = vec_rsqrt(x->r2), c = k * q * vec_fma(x->r2 * q, q0, vec_all(-1));
  return (coefficients){surface == BW_PD_SURFACE_NONE ? c : c * (wh + vec_load(s->w + slot->base)),
                        q * q};
}

INLINE coefficients coefficient(const bonds *s, const bw_pd_block *block, const bw_pd_slot *slot,
                                const bw_real *row, const bond *x, vec wh, int surface, bool cloud,
                                bool mixed)
{
  /* `surface` is known when this is compiled: one of the branches is left. */
  const vec k = constant_of(&s->all, block, slot, row, BW_PD_STIFFNESS, mixed);
  if (cloud) return cloud_coefficient(s, slot, k, x, wh, surface);
  const vec r2 = x->r2, minus_r0 = vec_all(row[BW_PD_MINUS_R0]);
  if (surface == BW_PD_SURFACE_VOLUME) {
    const vec sum = wh + vec_load(s->w + slot->base), t = r2 * sum;
    const vec q = vec_rsqrt(t * sum), qs = q * sum;
    return (coefficients){k * q * vec_fma(q, t, minus_r0), qs * qs};
  }
  const vec q = vec_rsqrt(r2), c = k * vec_fma(minus_r0, q, vec_all(1));
  if (surface == BW_PD_SURFACE_NONE) return (coefficients){c, q * q};
  if (surface == BW_PD_SURFACE_TENSOR) return (coefficients){c * stored(s, slot), q * q};
  if (surface == BW_PD_BOND_EXACT) return (coefficients){c * exactly(s, block, slot), q * q};
  return (coefficients){c * (wh + vec_load(s->w + slot->base)), q * q};
}

/* Adds the pair damping of a slot (3.41, ERRATA 4): along the bond, like the force. */
INLINE void add_damping(const sweep *s, const bw_pd_slot *slot, const bw_real *row, const bond *x,
                        vec inverse2, vec pair, const vec vh[3], int dimension, bool cloud,
                        vec sum[3])
{
  /* (V_l - V_h).z; z/r^2 makes a unit vector and a direction of it. */
  vec along = vec_all(0);
  for (int k = 0; k < dimension; k++)
    along = vec_fma(vec_load(s->v[k] + slot->base) - vh[k], x->z[k], along);
  const vec c =
      vec_keep(lanes_of(slot->mask), weight_of(s, row, x, cloud) * pair * along * inverse2);
  for (int k = 0; k < dimension; k++)
    sum[k] = vec_fma(c, x->z[k], sum[k]);
}

/* Acceleration of one block's owners; returns whether a bond that holds is beyond s0. */
INLINE bool block_force(const bonds *s, const bw_pd_block *block, int dimension, bool cloud,
                        int surface, bool check, bool damping, bool mixed)
{
  const sweep *all = &s->all;
  /* What the owners bring is loaded once for all slots of the block. */
  const owners h = owners_of(all, block, dimension, cloud);
  const bw_real *rows = rows_of(all, block);
  const vec pair = over_density(all, block, all->pd->damping.pair, mixed);
  vec vh[3], sum[3], damp[3], wh = vec_load(s->w + block->first);
  lanes beyond = lanes_of(0);
  for (int k = 0; k < dimension; k++) {
    vh[k] = vec_load(all->v[k] + block->first);
    sum[k] = damp[k] = vec_all(0);
  }
  const bw_pd_slot *end = all->slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = all->slot + block->slot; slot < end; slot++) {
    /* Most slots hold; one without a bond costs one comparison. */
    if (slot->mask == 0) continue;
    const lanes holds = lanes_of(slot->mask);
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const bond x = bond_of(all, slot, row, &h, dimension, cloud);
    const coefficients c = coefficient(s, block, slot, row, &x, wh, surface, cloud, mixed);
    /* Lanes without a bond compute too; their number, whatever it is, is dropped here. */
    const vec force = vec_keep(holds, c.force);
    for (int k = 0; k < dimension; k++)
      sum[k] = vec_fma(force, x.z[k], sum[k]);
    /* s > s0 (3.34) as squares of lengths: no root is needed. */
    if (check) beyond |= vec_above(x.r2, limit_of(all, block, slot, row, &x, cloud, mixed)) & holds;
    if (damping) add_damping(all, slot, row, &x, c.inverse2, pair, vh, dimension, cloud, damp);
  }
  /* The sum over the family is complete: it is written, not added. */
  for (int k = 0; k < dimension; k++) {
    vec_put_owners(block, sum[k], all->a[k]);
    if (damping) vec_put_owners(block, damp[k], all->damp[k]);
  }
  return check && lanes_bits(beyond) != 0;
}

static int factors_of(const bw_pd_body *pd, const bw_pd_block *block)
{
  return block->exact >= 0 ? (int)BW_PD_BOND_EXACT
                           : (int)bw_pd_bond__state(pd)->options.surface_correction;
}

/* A block where groups meet: few, so that nothing is decided when this is compiled. */
static __attribute__((noinline)) bool mixed_force(const bonds *s, const bw_pd_block *block,
                                                  bool check, bool damping)
{
  /* Out of plane all is zero in 2D, so that three components are right there too. */
  const bw_pd_body *pd = s->all.pd;
  return block_force(s, block, 3, pd->config.disorder > 0, factors_of(pd, block), check, damping,
                     true);
}

/* A block near a jump between levels. */
static __attribute__((noinline)) bool exact_force(const bonds *s, const bw_pd_block *block,
                                                  bool check, bool damping)
{
  return s->all.pd->dimension == 2
             ? block_force(s, block, 2, false, BW_PD_BOND_EXACT, check, damping, false)
             : block_force(s, block, 3, false, BW_PD_BOND_EXACT, check, damping, false);
}

/* Notes in hit the blocks with a bond beyond s0; returns how many. */
INLINE size_t sweep_blocks(const bonds *s, size_t first, size_t last, int dimension, bool cloud,
                           bw_pd_surface_correction surface, bool check, bool damping,
                           uint32_t hit[])
{
  size_t n_hit = 0;
  for (size_t b = first; b < last; b++) {
    const bw_pd_block *block = &s->all.block[b];
    /* Blocks of one group keep the kernel that knows all choices. */
    const bool beyond = block->group == BW_PD_MIXED ? mixed_force(s, block, check, damping)
                        : block->exact >= 0         ? exact_force(s, block, check, damping)
                                            : block_force(s, block, dimension, cloud, surface,
                                                          check, damping, false);
    if (check && beyond) hit[n_hit++] = (uint32_t)b;
  }
  return n_hit;
}

typedef size_t (*sweep_function)(const bonds *, size_t, size_t, uint32_t[]);
#define ONE(name, dimension, cloud, surface, check, damping)                                       \
  static size_t name(const bonds *s, size_t first, size_t last, uint32_t hit[])                    \
  {                                                                                                \
    return sweep_blocks(s, first, last, dimension, cloud, surface, check, damping, hit);           \
  }
#define FOUR(name, dimension, cloud, surface)                                                      \
  ONE(name, dimension, cloud, surface, false, false)                                               \
  ONE(name##_damped, dimension, cloud, surface, false, true)                                       \
  ONE(name##_check, dimension, cloud, surface, true, false)                                        \
  ONE(name##_check_damped, dimension, cloud, surface, true, true)
#define ALL(name, surface)                                                                         \
  FOUR(name##_2, 2, false, surface)                                                                \
  FOUR(name##_3, 3, false, surface)                                                                \
  FOUR(name##_cloud_2, 2, true, surface)                                                           \
  FOUR(name##_cloud_3, 3, true, surface)
ALL(plain, BW_PD_SURFACE_NONE)
ALL(volume, BW_PD_SURFACE_VOLUME)
ALL(energy, BW_PD_SURFACE_ENERGY)
FOUR(tensor_2, 2, false, BW_PD_SURFACE_TENSOR)
FOUR(tensor_3, 3, false, BW_PD_SURFACE_TENSOR)

#define ROW(name)                                                                                  \
  {                                                                                                \
    {name, name##_damped},                                                                         \
    {                                                                                              \
      name##_check, name##_check_damped                                                            \
    }                                                                                              \
  }
#define ROWS(name)                                                                                 \
  {                                                                                                \
    {ROW(name##_2), ROW(name##_3)},                                                                \
    {                                                                                              \
      ROW(name##_cloud_2), ROW(name##_cloud_3)                                                     \
    }                                                                                              \
  }
static const sweep_function function[4][2][2][2][2] = {
    ROWS(plain), ROWS(volume), ROWS(energy), {{ROW(tensor_2), ROW(tensor_3)}}};

void bw_pd_bond__force(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping)
{
  const bonds s = bonds_of(pd);
  /* Unbreakable bodies, and steps that do not check, take the sweep without comparison. */
  const bool cloud = pd->config.disorder > 0,
             really = check && pd->breakage && bw_pd_bond__state(pd)->breakable;
  const sweep_function sweep_all = function[bw_pd_bond__state(pd)->options.surface_correction]
                                           [cloud][pd->dimension - 2][really][damping];
  pd->bonds.n_hit += sweep_all(&s, first, last, pd->bonds.hit + pd->bonds.n_hit);
}

/* Lanes of a slot whose bond has an unbreakable end. */
static uint8_t unbreakable(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot,
                           uint8_t lanes_asked)
{
  uint8_t out = 0;
  for (int k = 0; k < BW_PD_LANES; k++)
    if (lanes_asked >> k & 1) {
      /* Either end's word is enough, and both ends see both. */
      const uint8_t kinds = pd->points.kind[pd->points.occupant[block->first + k]] |
                            pd->points.kind[pd->points.occupant[slot->base + k]];
      if (kinds & BW_PD_UNBREAKABLE) out |= (uint8_t)(1u << k);
    }
  return out;
}

/* The sweep that follows a break would give the same but for the rounding of the sum. */
bool bw_pd_bond__breaks(bw_pd_body *pd, bw_pd_block *block)
{
  const bonds s = bonds_of(pd);
  const int surface = factors_of(pd, block);
  const bool cloud = pd->config.disorder > 0, mixed = block->group == BW_PD_MIXED;
  /* The motion has not changed since the sweep that noted the block. */
  const owners h = owners_of(&s.all, block, 3, cloud);
  const bw_real *rows = rows_of(&s.all, block);
  vec lost[3], wh = vec_load(s.w + block->first);
  bool any = false;
  for (int k = 0; k < 3; k++)
    lost[k] = vec_all(0);
  for (uint32_t q = block->slot; q < bw_pd_body_slot_end(block); q++) {
    bw_pd_slot *slot = &pd->bonds.slot[q];
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const bond x = bond_of(&s.all, slot, row, &h, 3, cloud);
    const vec limit = limit_of(&s.all, block, slot, row, &x, cloud, mixed);
    /* Of a retired particle nothing breaks any more. */
    uint8_t over = slot->mask & (uint8_t)~block->gone & lanes_bits(vec_above(x.r2, limit));
    if (over == 0) continue;
    over &= (uint8_t)~unbreakable(pd, block, slot, over);
    if (over != 0 && bw_pd_body_above_finest(pd, block, slot)) {
      bw_pd_body_note_astray(pd, block, over);
      continue;
    }
    /* What these bonds pull with now is no longer part of the acceleration. */
    const coefficients all = coefficient(&s, block, slot, row, &x, wh, surface, cloud, mixed);
    const vec c = vec_keep(lanes_of(over), all.force);
    for (int k = 0; k < 3; k++)
      lost[k] = vec_fma(c, x.z[k], lost[k]);
    /* The other end does the same with the same numbers, here or on its rank. */
    for (int k = 0; k < BW_PD_LANES; k++)
      if (over >> k & 1) bw_pd_body_cut(pd, block, slot, k), any = true;
  }
  /* Their pull is taken out: the next step starts without them, and no sweep is repeated. */
  for (int lane = 0; any && lane < BW_PD_LANES; lane++)
    for (int k = 0; k < 3; k++)
      if (block->mask >> lane & 1) pd->a[k][bw_pd_body_owner(block, lane)] -= lost[k][lane];
  return any;
}

/* 1/4 c0 alpha s^2 |xi| Gamma dV dV: half of the bond's energy. */
double bw_pd_bond__bond_energy(const bw_pd_body *pd, const bw_pd_block *block,
                               const bw_pd_slot *slot, int lane)
{
  const int32_t h = block->first + lane, l = slot->base + lane;
  /* Half at this end: the other one books the other half. */
  const bw_pd_rest rest = bw_pd_body_rest(pd, slot->direction, h, l);
  const double s = bw_pd_body_length(pd, h, slot, lane, rest.xi) / rest.r0 - 1;
  const double alpha = bw_pd_bond__alpha(pd, block, slot, lane);
  const double dv_h = bw_pd_body_level_at(pd, h)->dv, dv_l = bw_pd_body_level_at(pd, l)->dv;
  return 0.25 * bw_pd_bond__micromodulus(pd, h, l) * alpha * s * s * rest.r0 * rest.fraction *
         dv_h * dv_l;
}

/* The energy of a block's lanes over their density: in bw_pd_bond__energy. */
static vec block_energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t lanes_asked)
{
  const bonds s = bonds_of(pd);
  const int surface = factors_of(pd, block);
  const bool cloud = pd->config.disorder > 0, mixed = block->group == BW_PD_MIXED;
  /* As the force, but with the square of the change of length. */
  const owners h = owners_of(&s.all, block, 3, cloud);
  const bw_real *rows = rows_of(&s.all, block);
  vec sum = vec_all(0), wh = vec_load(s.w + block->first);
  for (uint32_t q = block->slot; q < bw_pd_body_slot_end(block); q++) {
    const bw_pd_slot *slot = &s.all.slot[q];
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const bond x = bond_of(&s.all, slot, row, &h, 3, cloud);
    vec r0 = vec_all(row[BW_PD_R0]);
    vec k = constant_of(&s.all, block, slot, row, BW_PD_STIFFNESS, mixed);
    /* In a cloud Gamma and 1/|xi| are the bond's own. */
    if (cloud) {
      const vec q0 = vec_rsqrt(x.rest2);
      r0 = x.rest2 * q0;
      k *= gamma_of(&s.all, r0) * q0;
    }
    /* The row's constant already holds what the factors of a kind share. */
    const vec both = wh + vec_load(s.w + slot->base);
    const vec alpha = surface == BW_PD_SURFACE_VOLUME   ? 1 / both
                      : surface == BW_PD_SURFACE_ENERGY ? both
                      : surface == BW_PD_SURFACE_TENSOR ? stored(&s, slot)
                      : surface == BW_PD_BOND_EXACT     ? exactly(&s, block, slot)
                                                        : vec_all(1);
    const vec stretch = x.r2 * vec_rsqrt(x.r2) - r0;
    sum += vec_keep(lanes_of(slot->mask & lanes_asked), k * alpha * stretch * stretch);
  }
  return sum;
}

/* Half of 1/2 c0 alpha s^2 |xi| Gamma dV dV for each end: summed over ranks, every bond once. */
double bw_pd_bond__energy(const bw_pd_body *pd, const bw_pd_block *block, uint8_t lanes_asked)
{
  const vec sum = block_energy(pd, block, lanes_asked);
  const double dv = bw_pd_body_level_of(pd, block)->dv;
  /* The row's stiffness is over the owner's density, which is put back here. */
  if (block->group != BW_PD_MIXED)
    return 0.25 * pd->config.material[block->group].rho * dv * vec_sum(sum);
  double energy = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask >> lane & 1)
      energy += 0.25 * dv * (double)sum[lane] *
                bw_pd_body_material(pd, (size_t)bw_pd_body_owner(block, lane))->rho;
  return energy;
}
