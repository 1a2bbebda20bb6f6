/* The two passes of the correspondence law over the bonds, BW_PD_LANES at a time.
 *
 * First    H = (sum w eta xi Gamma dV) K^-1, the material's P, and B = P K^-1 - beta H.
 * Second   L_h = sum w [(B_h + B_l) xi + (beta_h + beta_l) eta] Gamma dV, where B_h leaves the sum.
 * The kernel rows hold w Gamma dV in place of a stiffness. */
#include "pd_state_correspondence.h"
#include "pd_sweep.h"

typedef struct {
  sweep all;
  bw_pd_correspondence *law;
  bool uniform;  /* w = 1 */
  bool springs;  /* some particle, here or of a copy, is on central springs */
  bw_real reach; /* 1/reach of the family [1/L] */
  const bw_real *B[9], *beta, *measure;
} passes;

/* Entries of a tensor in the plane or space, among nine. */
INLINE int entry(int i, int j)
{
  return 3 * i + j;
}

static passes passes_of(const bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  passes s = {.all = sweep_of(pd),
              .law = o,
              .uniform = o->options.weight == BW_PD_STATE_UNIFORM,
              .reach = (bw_real)(1 / pd->level[0].reach), /* of clouds, which have one level */
              .beta = o->beta,
              .measure = o->measure};
  for (int q = 0; q < 9; q++)
    s.B[q] = o->B[q];
  return s;
}

/* A bond at rest: xi, and w Gamma dV of those that hold. */
typedef struct {
  vec xi[3], weight, rest2;
} rest;

INLINE vec root(vec x)
{
  return x * vec_rsqrt(x);
}

INLINE vec square(vec x)
{
  return x * x;
}

INLINE rest rest_of(const passes *s, const bw_pd_slot *slot, const bw_real *row, const owners *h,
                    int dimension, bool cloud)
{
  rest b;
  b.weight = vec_all(row[BW_PD_STIFFNESS]);
  b.rest2 = vec_all(row[BW_PD_R0] * row[BW_PD_R0]);
  for (int k = 0; k < dimension; k++) {
    b.xi[k] = vec_all(row[BW_PD_XI + k]);
    if (!cloud) continue;
    b.xi[k] = (vec_load(s->all.shift[k] + slot->base) - h->shift[k]) + b.xi[k];
    b.rest2 = k == 0 ? b.xi[k] * b.xi[k] : vec_fma(b.xi[k], b.xi[k], b.rest2);
  }
  if (cloud) {
    const vec r0 = b.rest2 * vec_rsqrt(b.rest2), q = r0 * s->reach, p = 1 - q;
    b.weight *= gamma_of(&s->all, r0);
    if (!s->uniform) b.weight *= p * p * (1 + 2 * q);
  }
  b.weight = vec_keep(lanes_of(slot->mask), b.weight);
  return b;
}

/* K^-1 of a block, symmetric: entry (i, j) of six. */
INLINE int of_six(int i, int j)
{
  return i == j ? i : 6 - i - j;
}

/* H of a block's owners. */
INLINE void block_gradient(const passes *s, const bw_pd_block *block, int dimension, bool cloud,
                           vec H[9])
{
  const owners h = owners_of(&s->all, block, dimension, cloud);
  const bw_real *rows = rows_of(&s->all, block);
  vec S[9], inverse[6];
  for (int q = 0; q < 9; q++)
    S[q] = H[q] = vec_all(0);
  const bw_pd_slot *end = s->all.slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = s->all.slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const rest b = rest_of(s, slot, rows + slot->direction * BW_PD_ROW, &h, dimension, cloud);
    for (int i = 0; i < dimension; i++) {
      const vec eta = b.weight * (vec_load(s->all.u[i] + slot->base) - h.u[i]);
      for (int j = 0; j < dimension; j++)
        S[entry(i, j)] = vec_fma(eta, b.xi[j], S[entry(i, j)]);
    }
  }
  for (int q = 0; q < 6; q++)
    inverse[q] = vec_load(s->law->inverse[q] + block->first);
  for (int i = 0; i < dimension; i++)
    for (int j = 0; j < dimension; j++)
      for (int k = 0; k < dimension; k++)
        H[entry(i, j)] = vec_fma(S[entry(i, k)], inverse[of_six(k, j)], H[entry(i, j)]);
}

/* Lanes of a block on springs: they have no P. */
static uint8_t on_springs(const passes *s, const bw_pd_block *block)
{
  return lanes_bits(vec_above(vec_all(0), vec_load(s->beta + block->first)));
}

/* B of a block from H; small: with the materials of small strain. */
INLINE void block_deform(const passes *s, const bw_pd_block *block, int dimension, bool cloud,
                         bool small)
{
  const bw_pd_body *pd = s->all.pd;
  vec H[9], B[9], inverse[6];
  bw_pd_material_lanes wide[9], P[9];
  block_gradient(s, block, dimension, cloud, H);
  for (int q = 0; q < 9; q++) {
    wide[q] = (bw_pd_material_lanes){0};
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      wide[q][lane] = H[q][lane];
  }
  bw_pd_state__stress(pd, block, small, wide, P);
  if (!small) bw_pd_state__soften(pd, block);
  if (!small && s->law->measure != NULL) bw_pd_state__measure(pd, block, wide, P);
  for (int q = 0; q < 6; q++)
    inverse[q] = vec_load(s->law->inverse[q] + block->first);
  const vec beta = vec_load(s->beta + block->first);
  for (int i = 0; i < dimension; i++)
    for (int j = 0; j < dimension; j++) {
      vec x = vec_all(0);
      for (int k = 0; k < dimension; k++) {
        vec p = vec_all(0);
        for (int lane = 0; lane < BW_PD_LANES; lane++)
          p[lane] = (bw_real)P[entry(i, k)][lane];
        x = vec_fma(p, inverse[of_six(k, j)], x);
      }
      B[entry(i, j)] = vec_fnma(beta, H[entry(i, j)], x);
    }
  /* Copies keep what their owners will send; who is on springs has no B. */
  const uint8_t none = on_springs(s, block);
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    for (int i = 0; i < dimension && block->mask >> lane & 1; i++)
      for (int j = 0; j < dimension; j++)
        s->law->B[entry(i, j)][block->first + lane] = none >> lane & 1 ? 0 : B[entry(i, j)][lane];
}

/* w c s e/eta of central springs: c (1/|xi| - 1/|y|) along y, linear c xi.eta/|xi|^3 along xi. */
INLINE vec spring_force(const rest *b, const vec eta[3], int dimension, bool small, vec c,
                        vec along[3])
{
  const vec q0 = vec_rsqrt(b->rest2);
  vec r2 = vec_all(0), dot = vec_all(0);
  for (int k = 0; k < dimension; k++) {
    along[k] = small ? b->xi[k] : b->xi[k] + eta[k];
    r2 = vec_fma(along[k], along[k], r2);
    dot = vec_fma(b->xi[k], eta[k], dot);
  }
  return small ? c * dot * q0 * q0 * q0 : c * (q0 - vec_rsqrt(r2));
}

/* Force density of a block's owners; returns whether a bond that holds is beyond its limit. */
INLINE bool block_force(const passes *s, const bw_pd_block *block, int dimension, bool cloud,
                        bool small, bool springs, bool check, bool mixed, vec sum[3])
{
  const owners h = owners_of(&s->all, block, dimension, cloud);
  const bw_real *rows = rows_of(&s->all, block);
  const vec zero = vec_all(0), beta_h = vec_load(s->beta + block->first);
  vec moment[3] = {zero, zero, zero};
  lanes beyond = lanes_of(0);
  sum[0] = sum[1] = sum[2] = zero;
  const bw_pd_slot *end = s->all.slot + bw_pd_body_slot_end(block);
  for (const bw_pd_slot *slot = s->all.slot + block->slot; slot < end; slot++) {
    if (slot->mask == 0) continue;
    const bw_real *row = rows + slot->direction * BW_PD_ROW;
    const rest b = rest_of(s, slot, row, &h, dimension, cloud);
    vec eta[3], beta_l = vec_load(s->beta + slot->base), both = beta_h + beta_l, c = zero;
    if (springs) {
      /* Negative: springs in place of a stabilised stress. */
      const vec p = vec_keep(vec_above(beta_h, zero), beta_h);
      const vec q = vec_keep(vec_above(beta_l, zero), beta_l);
      c = p + q - both;
      both = p + q;
    }
    for (int k = 0; k < dimension; k++)
      eta[k] = vec_load(s->all.u[k] + slot->base) - h.u[k];
    for (int i = 0; i < dimension; i++) {
      vec t = both * eta[i];
      for (int j = 0; j < dimension; j++)
        t = vec_fma(vec_load(s->B[entry(i, j)] + slot->base), b.xi[j], t);
      sum[i] = vec_fma(b.weight, t, sum[i]);
      moment[i] = vec_fma(b.weight, b.xi[i], moment[i]);
    }
    if (springs) {
      vec along[3];
      const vec f = vec_keep(lanes_of(slot->mask),
                             b.weight * spring_force(&b, eta, dimension, small, c, along));
      for (int k = 0; k < dimension; k++)
        sum[k] = vec_fma(f, along[k], sum[k]);
    }
    if (!check) continue;
    vec r2 = zero;
    for (int k = 0; k < dimension; k++)
      r2 = vec_fma(b.xi[k] + eta[k], b.xi[k] + eta[k], r2);
    if (s->measure != NULL) {
      const vec m = vec_load(s->measure + block->first) + vec_load(s->measure + slot->base);
      beyond |= vec_above(m, vec_all(2)) & vec_above(r2, b.rest2) & lanes_of(slot->mask);
      continue;
    }
    vec limit = constant_of(&s->all, block, slot, row, BW_PD_LIMIT2, mixed);
    if (cloud) limit = square(root(b.rest2) + limit * root(root(b.rest2)));
    beyond |= vec_above(r2, limit) & lanes_of(slot->mask);
  }
  /* B_h xi of all bonds at once. */
  for (int i = 0; i < dimension; i++)
    for (int j = 0; j < dimension; j++)
      sum[i] = vec_fma(vec_load(s->B[entry(i, j)] + block->first), moment[j], sum[i]);
  return check && lanes_bits(beyond) != 0;
}

INLINE size_t force_blocks(const passes *s, size_t first, size_t last, int dimension, bool cloud,
                           bool springs, bool check, uint32_t hit[])
{
  size_t n_hit = 0;
  for (size_t q = first; q < last; q++) {
    const bw_pd_block *block = &s->all.block[q];
    const bool mixed = block->group == BW_PD_MIXED;
    vec sum[3];
    if (block_force(s, block, dimension, cloud, false, springs, check, mixed, sum))
      hit[n_hit++] = (uint32_t)q;
    const vec over = over_density(&s->all, block, 1, mixed);
    for (int k = 0; k < dimension; k++)
      vec_put_owners(block, sum[k] * over, s->all.a[k]);
  }
  return n_hit;
}

typedef void (*deform_function)(const passes *, size_t, size_t);
typedef size_t (*force_function)(const passes *, size_t, size_t, uint32_t[]);

/* Compiled once for each dimension, lattice or cloud, with a check or without. Where springs are,
 * few compare: that kernel decides as it runs. */
#define KIND(name, dimension, cloud)                                                               \
  static void deform_##name(const passes *s, size_t first, size_t last)                            \
  {                                                                                                \
    for (size_t q = first; q < last; q++)                                                          \
      block_deform(s, &s->all.block[q], dimension, cloud, false);                                  \
  }                                                                                                \
  static size_t force_##name(const passes *s, size_t first, size_t last, uint32_t hit[])           \
  {                                                                                                \
    return force_blocks(s, first, last, dimension, cloud, false, false, hit);                      \
  }                                                                                                \
  static size_t check_##name(const passes *s, size_t first, size_t last, uint32_t hit[])           \
  {                                                                                                \
    return force_blocks(s, first, last, dimension, cloud, false, true, hit);                       \
  }                                                                                                \
  static size_t springs_##name(const passes *s, size_t first, size_t last, uint32_t hit[])         \
  {                                                                                                \
    return force_blocks(s, first, last, dimension, cloud, true, true, hit);                        \
  }
KIND(plane, 2, false)
KIND(space, 3, false)
KIND(plane_cloud, 2, true)
KIND(space_cloud, 3, true)

static const deform_function deform[2][2] = {{deform_plane, deform_space},
                                             {deform_plane_cloud, deform_space_cloud}};
static const force_function force[2][2][3] = {
    {{force_plane, check_plane, springs_plane}, {force_space, check_space, springs_space}},
    {{force_plane_cloud, check_plane_cloud, springs_plane_cloud},
     {force_space_cloud, check_space_cloud, springs_space_cloud}}};

/* Some own particle or copy is on springs. */
static bool any_springs(const bw_pd_body *pd, const bw_real *beta)
{
  bool any = false;
  for (size_t p = 0; p < pd->points.n_storage; p++)
    any |= beta[p] < 0;
  return any;
}

void bw_pd_state__deform(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping)
{
  (void)check, (void)damping;
  bw_pd_state__shapes(pd);
  const passes s = passes_of(pd);
  deform[pd->config.disorder > 0][pd->dimension - 2](&s, first, last);
}

void bw_pd_state__force(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping)
{
  (void)damping;
  const passes s = passes_of(pd);
  const bool springs = any_springs(pd, s.beta);
  const bool really = check && pd->breakage && s.law->breakable;
  const size_t before = pd->bonds.n_hit;
  pd->bonds.n_hit += force[pd->config.disorder > 0][pd->dimension - 2][springs ? 2 : really](
      &s, first, last, pd->bonds.hit + before);
  if (!really) pd->bonds.n_hit = before;
}

/* The same two passes with materials of small strain, over displacements x. Collective. */
void bw_pd_state__tangent(const bw_pd_body *pd, bw_real *const x[3], double kx[])
{
  bw_pd_state__shapes(pd);
  passes s = passes_of(pd);
  const bool cloud = pd->config.disorder > 0;
  for (int k = 0; k < 3; k++)
    s.all.u[k] = x[k];
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    if (pd->dimension == 2)
      block_deform(&s, &pd->bonds.block[q], 2, cloud, true);
    else
      block_deform(&s, &pd->bonds.block[q], 3, cloud, true);
  for (int q = 0; q < pd->fields.n; q++)
    if (pd->fields.row[q].after == 0) bw_pd_body_fill_places(pd, pd->fields.row[q].value);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    vec sum[3];
    if (pd->dimension == 2)
      block_force(&s, block, 2, cloud, true, true, false, false, sum);
    else
      block_force(&s, block, 3, cloud, true, true, false, false, sum);
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      for (size_t k = 0; k < 3; k++)
        if (block->mask >> lane & 1)
          kx[3 * (size_t)bw_pd_body_owner(block, lane) + k] = -(double)sum[k][lane];
  }
}
