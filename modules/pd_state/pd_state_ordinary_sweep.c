/* The two passes of the ordinary law over the bonds, BW_PD_LANES at a time.
 *
 * The kernel rows hold w Gamma dV in place of a stiffness, and 2 w_c/w in place of a squared
 * length: twice the energy of a bond that breaks. In a cloud both follow from |xi|. */
#include "pd_state_ordinary.h"
#include "pd_sweep.h"

/* What a pass reads besides the body. */
typedef struct {
  sweep all;
  const bw_real *swell, *stiff;
  bw_real *pull;
  const bw_real *own, *reverse; /* of bonds near jumps between levels; NULL: none */
  bool inverse;                 /* w = 1/|xi| */
} ordinary;

INLINE ordinary ordinary_of(const bw_pd_body *pd)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  return (ordinary){sweep_of(pd),
                    o->swell,
                    o->stiff,
                    o->pull,
                    o->own,
                    o->reverse,
                    o->options.influence == BW_PD_STATE_INVERSE};
}

/* A bond: its direction times its length, 1 over that length, |xi|, e, and w Gamma dV. */
typedef struct {
  vec z[3], over, r0, e, weight;
} stretched;

/* w Gamma dV and |xi|, in a cloud from |xi|^2. */
INLINE void rest_of(const ordinary *s, const bw_real *row, vec rest2, bool cloud, stretched *b)
{
  b->r0 = vec_all(row[BW_PD_R0]);
  b->weight = vec_all(row[BW_PD_STIFFNESS]);
  if (!cloud) return;
  const vec q0 = vec_rsqrt(rest2);
  b->r0 = rest2 * q0;
  b->weight *= gamma_of(&s->all, b->r0);
  if (s->inverse) b->weight *= q0;
}

/* |xi + eta| - |xi|. Doubles leave enough of the difference of both; in single precision it is
 * (2 xi + eta).eta/(|xi + eta| + |xi|), which has no difference of large numbers. */
INLINE vec extension(const ordinary *s, const bw_pd_slot *slot, const owners *h, const bond *x,
                     const stretched *b, int dimension)
{
#ifdef BW_SINGLE
  vec dot = vec_all(0);
  for (int k = 0; k < dimension; k++) {
    const vec eta = vec_load(s->all.u[k] + slot->base) - h->u[k];
    dot = vec_fma(x->z[k] + (x->z[k] - eta), eta, dot);
  }
  return dot / (x->r2 * b->over + b->r0);
#else
  (void)s, (void)slot, (void)h, (void)dimension;
  return x->r2 * b->over - b->r0;
#endif
}

INLINE stretched stretched_of(const ordinary *s, const bw_pd_slot *slot, const bw_real *row,
                              const owners *h, int dimension, bool cloud)
{
  stretched b;
  const bond x = bond_of(&s->all, slot, row, h, dimension, cloud);
  rest_of(s, row, x.rest2, cloud, &b);
  b.over = vec_rsqrt(x.r2);
  b.e = extension(s, slot, h, &x, &b, dimension);
  for (int k = 0; k < dimension; k++)
    b.z[k] = x.z[k];
  return b;
}

/* The same about the reference shape: u is small, e its part along xi. */
INLINE stretched linear_of(const ordinary *s, const bw_pd_slot *slot, const bw_real *row,
                           const owners *h, int dimension, bool cloud)
{
  stretched b;
  vec rest2 = vec_all(row[BW_PD_R0] * row[BW_PD_R0]), along = vec_all(0);
  for (int k = 0; k < dimension; k++) {
    b.z[k] = vec_all(row[BW_PD_XI + k]);
    if (cloud) {
      b.z[k] = (vec_load(s->all.shift[k] + slot->base) - h->shift[k]) + b.z[k];
      rest2 = k == 0 ? b.z[k] * b.z[k] : vec_fma(b.z[k], b.z[k], rest2);
    }
    along = vec_fma(vec_load(s->all.u[k] + slot->base) - h->u[k], b.z[k], along);
  }
  rest_of(s, row, rest2, cloud, &b);
  b.over = 1 / b.r0;
  b.e = along * b.over;
  return b;
}

INLINE stretched look(const ordinary *s, const bw_pd_slot *slot, const bw_real *row,
                      const owners *h, int dimension, bool cloud, bool linear)
{
  return linear ? linear_of(s, slot, row, h, dimension, cloud)
                : stretched_of(s, slot, row, h, dimension, cloud);
}

/* d (lam* - mu) theta/q of the owners, to pull. */
INLINE void dilation(const ordinary *s, const bw_pd_block *block, int dimension, bool cloud,
                     bool linear, bool near)
{
  const owners h = owners_of(&s->all, block, dimension, cloud);
  const bw_real *rows = rows_of(&s->all, block);
  vec sum = vec_all(0);
  const bw_pd_slot *end = s->all.slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = s->all.slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const stretched b =
        look(s, slot, rows + slot->direction * BW_PD_ROW, &h, dimension, cloud, linear);
    const vec weight =
        near ? vec_load(s->own + bw_pd_ordinary_near(s->all.pd, block, slot)) : b.weight;
    sum += vec_keep(lanes_of(slot->mask), weight * b.r0 * b.e);
  }
  /* Lanes that are copies keep what their owners will send. */
  const vec pull = sum * vec_load(s->swell + block->first);
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask >> lane & 1) s->pull[block->first + lane] = pull[lane];
}

/* Near a jump between levels bonds have weights of their own. */
static __attribute__((noinline)) void near_dilation(const ordinary *s, const bw_pd_block *block,
                                                    bool linear)
{
  dilation(s, block, 3, false, linear, true);
}

INLINE void block_dilation(const ordinary *s, const bw_pd_block *block, int dimension, bool cloud,
                           bool linear)
{
  if (!cloud && s->own != NULL && block->exact >= 0)
    near_dilation(s, block, linear);
  else
    dilation(s, block, dimension, cloud, linear, false);
}

/* A sum of two halves of a bond, the first end's first: the same from both ends. */
INLINE vec halves(bool first, vec a, vec x, vec b, vec y)
{
  return first ? vec_fma(a, x, b * y) : vec_fma(b, y, a * x);
}

/* block_force where bonds have two weights: near a jump between levels. */
static __attribute__((noinline)) bool near_force(const ordinary *s, const bw_pd_block *block,
                                                 bool linear, bool check, vec sum[3])
{
  const owners h = owners_of(&s->all, block, 3, false);
  const bw_real *rows = rows_of(&s->all, block);
  const vec pull = vec_load(s->pull + block->first), stiff = vec_load(s->stiff + block->first);
  const bool mixed = block->group == BW_PD_MIXED;
  const bw_pd_stencil *stencil = &s->all.level[block->level].stencil;
  const int same = stencil->same;
  lanes beyond = lanes_of(0);
  for (int k = 0; k < 3; k++)
    sum[k] = vec_all(0);
  const bw_pd_slot *end = s->all.slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = s->all.slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const stretched b = look(s, slot, row, &h, 3, false, linear);
    const size_t at = bw_pd_ordinary_near(s->all.pd, block, slot);
    const bool first = bw_pd_body_is_first(stencil, slot->direction);
    const vec own = vec_load(s->own + at), reverse = vec_load(s->reverse + at);
    const vec mine = vec_fma(stiff, b.e, pull * b.r0);
    const vec theirs =
        vec_fma(vec_load(s->stiff + slot->base), b.e, vec_load(s->pull + slot->base) * b.r0);
    /* Bonds of one weight are as in block_force, to the bit: blocks are divided over ranks. */
    const lanes differ = slot->direction >= same
                             ? lanes_of((1 << BW_PD_LANES) - 1)
                             : vec_above(own, reverse) | vec_above(reverse, own);
    const lanes one = (lanes)~differ;
    const vec both = vec_fma(stiff + vec_load(s->stiff + slot->base), b.e,
                             (pull + vec_load(s->pull + slot->base)) * b.r0);
    const vec two = halves(first, own, mine, reverse, theirs);
    const vec f = vec_keep(one, own * both) + vec_keep(differ, two);
    const vec c = vec_keep(lanes_of(slot->mask), f * b.over);
    for (int k = 0; k < 3; k++)
      sum[k] = vec_fma(c, b.z[k], sum[k]);
    if (!check) continue;
    const vec limit = constant_of(&s->all, block, slot, row, BW_PD_LIMIT2, mixed);
    const vec partner = constant_of(&s->all, block, slot, row, BW_PD_PARTNER_LIMIT, mixed);
    const vec of_two = halves(first, own, limit, reverse, partner) * vec_all((bw_real)0.5);
    const lanes over =
        (one & vec_above(both * b.e, limit)) | (differ & vec_above(two * b.e, of_two));
    beyond |= over & vec_above(b.e, vec_all(0)) & lanes_of(slot->mask);
  }
  return check && lanes_bits(beyond) != 0;
}

/* Force density of the owners; returns whether a bond that holds is beyond its limit. */
INLINE bool block_force(const ordinary *s, const bw_pd_block *block, int dimension, bool cloud,
                        bool linear, bool check, bool mixed, vec sum[3])
{
  const owners h = owners_of(&s->all, block, dimension, cloud);
  const bw_real *rows = rows_of(&s->all, block);
  const vec pull = vec_load(s->pull + block->first), stiff = vec_load(s->stiff + block->first);
  lanes beyond = lanes_of(0);
  for (int k = 0; k < 3; k++)
    sum[k] = vec_all(0);
  const bw_pd_slot *end = s->all.slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = s->all.slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const stretched b = look(s, slot, row, &h, dimension, cloud, linear);
    /* (t_h + t_l)/w: the sums of both ends' numbers are the same from either. */
    const vec both = stiff + vec_load(s->stiff + slot->base);
    const vec f = vec_fma(both, b.e, (pull + vec_load(s->pull + slot->base)) * b.r0);
    const vec c = vec_keep(lanes_of(slot->mask), b.weight * f * b.over);
    for (int k = 0; k < dimension; k++)
      sum[k] = vec_fma(c, b.z[k], sum[k]);
    if (!check) continue;
    /* Stretched, and (t_h + t_l) e/2 above w_c. */
    vec limit = constant_of(&s->all, block, slot, row, BW_PD_LIMIT2, mixed);
    if (cloud && s->inverse) limit *= b.r0;
    beyond |= vec_above(f * b.e, limit) & vec_above(b.e, vec_all(0)) & lanes_of(slot->mask);
  }
  return check && lanes_bits(beyond) != 0;
}

typedef void (*dilate_function)(const ordinary *, size_t, size_t);
typedef size_t (*force_function)(const ordinary *, size_t, size_t, uint32_t[]);

INLINE size_t force_blocks(const ordinary *s, size_t first, size_t last, int dimension, bool cloud,
                           bool check, uint32_t hit[])
{
  size_t n_hit = 0;
  for (size_t q = first; q < last; q++) {
    const bw_pd_block *block = &s->all.block[q];
    const bool mixed = block->group == BW_PD_MIXED;
    vec sum[3];
    const bool near = !cloud && s->own != NULL && block->exact >= 0;
    if (near ? near_force(s, block, false, check, sum)
             : block_force(s, block, dimension, cloud, false, check, mixed, sum))
      hit[n_hit++] = (uint32_t)q;
    const vec over = over_density(&s->all, block, 1, mixed);
    for (int k = 0; k < dimension; k++)
      vec_put_owners(block, sum[k] * over, s->all.a[k]);
  }
  return n_hit;
}

/* Compiled once for each dimension, lattice or cloud, with a check or without. */
#define KIND(name, dimension, cloud)                                                               \
  static void dilate_##name(const ordinary *s, size_t first, size_t last)                          \
  {                                                                                                \
    for (size_t q = first; q < last; q++)                                                          \
      block_dilation(s, &s->all.block[q], dimension, cloud, false);                                \
  }                                                                                                \
  static size_t force_##name(const ordinary *s, size_t first, size_t last, uint32_t hit[])         \
  {                                                                                                \
    return force_blocks(s, first, last, dimension, cloud, false, hit);                             \
  }                                                                                                \
  static size_t check_##name(const ordinary *s, size_t first, size_t last, uint32_t hit[])         \
  {                                                                                                \
    return force_blocks(s, first, last, dimension, cloud, true, hit);                              \
  }
KIND(plane, 2, false)
KIND(space, 3, false)
KIND(plane_cloud, 2, true)
KIND(space_cloud, 3, true)

static const dilate_function dilate[2][2] = {{dilate_plane, dilate_space},
                                             {dilate_plane_cloud, dilate_space_cloud}};
static const force_function force[2][2][2] = {
    {{force_plane, check_plane}, {force_space, check_space}},
    {{force_plane_cloud, check_plane_cloud}, {force_space_cloud, check_space_cloud}}};

void bw_pd_state__ordinary_dilate(bw_pd_body *pd, size_t first, size_t last, bool check,
                                  bool damping)
{
  (void)check, (void)damping;
  /* Where lam* = mu everywhere no family pulls: pull stays 0. */
  if (!bw_pd_ordinary_of(pd)->dilates) return;
  const ordinary s = ordinary_of(pd);
  dilate[pd->config.disorder > 0][pd->dimension - 2](&s, first, last);
}

void bw_pd_state__ordinary_force(bw_pd_body *pd, size_t first, size_t last, bool check,
                                 bool damping)
{
  (void)damping;
  const ordinary s = ordinary_of(pd);
  const bool really = check && pd->breakage && bw_pd_ordinary_of(pd)->breakable;
  pd->bonds.n_hit += force[pd->config.disorder > 0][pd->dimension - 2][really](
      &s, first, last, pd->bonds.hit + pd->bonds.n_hit);
}

/* The same two passes at small strain, over displacements x. Collective. */
void bw_pd_state__ordinary_tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  ordinary s = ordinary_of(pd);
  const bool cloud = pd->config.disorder > 0;
  for (int k = 0; k < 3; k++)
    s.all.u[k] = x[k];
  for (size_t q = 0; q < pd->bonds.n_block && bw_pd_ordinary_of(pd)->dilates; q++)
    block_dilation(&s, &pd->bonds.block[q], 3, cloud, true);
  /* Neighbours' dilatation, also of those that others own. */
  bw_pd_body_fill_places(pd, s.pull);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    vec sum[3];
    if (s.own != NULL && block->exact >= 0)
      near_force(&s, block, true, false, sum);
    else
      block_force(&s, block, 3, cloud, true, false, false, sum);
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      for (size_t k = 0; k < 3; k++)
        if (block->mask >> lane & 1)
          kx[3 * (size_t)bw_pd_body_owner(block, lane) + k] = -(double)sum[k][lane];
  }
}

/* What breaks later leaves theta, not q. */
void bw_pd_state__ordinary_moments(bw_pd_body *pd)
{
  bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    double sum[BW_PD_LANES] = {0};
    for (bw_pd_walk x = bw_pd_walk_families(pd, &pd->bonds.block[b]); bw_pd_walk_next(&x);)
      sum[x.lane] += bw_pd_ordinary_weight(pd, &pd->bonds.block[b], &x) * x.rest.r0 * x.rest.r0;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (pd->bonds.block[b].mask >> lane & 1)
        o->q[pd->bonds.block[b].first + lane] = (bw_real)sum[lane];
  }
  bw_pd_body_fill_places(pd, o->q);
}
