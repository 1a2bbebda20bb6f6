/* The weights of an ordinary law's bonds near a jump between levels.
 *
 * Each end has its own family, so that a bond has two weights: W_hl = a_hl w Gamma_hl/q_h in the
 * family of h, and W_lh in that of l. With plain ones (a = 1) the dilatation of a uniform strain is
 * wrong beside a jump, and forces are left there. With
 *   sum_l W_hl xi xi dV_l = I/d,   sum_l (W_hl + W_lh) |xi| e e e dV_l = 0
 * a uniform strain has its dilatation at every particle and no force at any; a_hl is the smallest
 * change, sum (a - 1)^2 -> min. With multipliers tau of the squares and mu of the cubes,
 *   a_hl = 1 + W_hl dV_l [ |xi|^2 tau_h.(e e) + |xi| ds_h mu_h.(e e e) - ratio |xi| ds_l mu_l.(e e
 *          e) ]
 * with ratio = dV_h/dV_l, and the conditions are a symmetric system for the multipliers, solved by
 * conjugate residuals. q is that of a whole family of one spacing, so that who is beyond the jump
 * needs no change.
 *
 * Beside a jump that goes from face to face both are met to rounding. Around a finer region that is
 * closed they cannot be: summed over it with weights dV y^2, dV x^2 and -2 dV x y of the first
 * tensor's xx, yy, xy, and with cubics of the place of the second one, they ask for what bonds to
 * the outside do not give, as splitting a cell changes the second moment of the cells' middles.
 * Least squares leave 2e-3 of the forces where those with a bond across a jump have conditions,
 * 3e-4 where their neighbours have them, too. Particles that miss cells of their family, at faces,
 * have none: they are left as faces are left. */
#include "bw_memory.h"
#include "pd_state_ordinary_levels.h"

#include <string.h>

enum { MOST = 3000 };                    /* steps; some hundreds are usual */
static const double LOW = 0.1, HIGH = 4; /* of a: the softest, the stiffest that a bond gets */

/* A bond between two particles near a jump, seen from one that has conditions. */
typedef struct {
  int32_t h, l;        /* storage places */
  double n[3], r;      /* direction, length */
  double mine, theirs; /* W_hl dV_l; W_lh dV_l [1/L^2] */
  double ds[2], ratio; /* spacings of h and l; dV_h/dV_l */
} link;

/* Vectors are (rows, wants). */
typedef struct {
  bw_pd_body *pd;
  int squares, wants;
  size_t rows, links;
  int64_t all;                      /* rows of all ranks */
  int32_t *place;                   /* (rows) */
  size_t *first;                    /* (rows + 1) first link */
  link *bond;                       /* (links) those that may change */
  double *scale;                    /* of the conditions, made of order 1 */
  double *missing;                  /* what plain weights leave of them */
  bw_real *near, *whole;            /* storage: 1 near a jump; 1 with conditions */
  bw_real *multiplier[BW_PD_WANTS]; /* storage */
} zone;

/* Monomials of degree 2, then 3, of a direction. */
static void monomials(int dimension, const double n[3], double out[BW_PD_WANTS])
{
  int q = 0;
  for (int i = 0; i < dimension; i++)
    for (int j = i; j < dimension; j++)
      out[q++] = n[i] * n[j];
  for (int i = 0; i < dimension; i++)
    for (int j = i; j < dimension; j++)
      for (int k = j; k < dimension; k++)
        out[q++] = n[i] * n[j] * n[k];
}

/* a_hl - 1, the same bits from either end. */
static __attribute__((noinline)) double change(const zone *z, const link *b)
{
  double f[BW_PD_WANTS], sum = 0;
  monomials(z->pd->dimension, b->n, f);
  for (int k = 0; k < z->wants; k++) {
    const double own = (double)z->multiplier[k][b->h], other = (double)z->multiplier[k][b->l];
    if (k < z->squares)
      sum += b->r * b->r * f[k] * own;
    else
      sum += b->r * f[k] * (b->ds[0] * own - b->ratio * b->ds[1] * other);
  }
  return b->mine * sum;
}

static link reversed(const link *b)
{
  return (link){.h = b->l,
                .l = b->h,
                .n = {-b->n[0], -b->n[1], -b->n[2]},
                .r = b->r,
                .mine = b->theirs * b->ratio,
                .theirs = b->mine * b->ratio,
                .ds = {b->ds[1], b->ds[0]},
                .ratio = 1 / b->ratio};
}

static link link_of(const zone *z, const bw_pd_ordinary_plain *plain, const bw_pd_block *block,
                    const bw_pd_slot *slot, int lane)
{
  const bw_pd_body *pd = z->pd;
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  const bw_pd_level *own = bw_pd_body_level_of(pd, block);
  const bw_pd_stencil *s = &own->stencil;
  const bw_pd_level *other = &pd->level[s->other[slot->direction]];
  const bw_pd_ordinary_pair w = plain->of[block->level][slot->direction];
  link b = {.h = block->first + lane,
            .l = slot->base + lane,
            .r = s->r0[slot->direction],
            .ds = {own->ds, other->ds},
            .ratio = own->dv / other->dv};
  for (int k = 0; k < 3; k++)
    b.n[k] = s->offset[3 * slot->direction + k] * s->unit / b.r;
  b.mine = w.own / (double)o->q[b.h];
  b.theirs = w.reverse / (double)o->q[b.l];
  return b;
}

/* Adds the part of a bond whose two factors (or changes of them) are a, to the conditions of h. */
static void add(const zone *z, const link *b, const double a[2], double out[])
{
  double f[BW_PD_WANTS];
  monomials(z->pd->dimension, b->n, f);
  const double square = a[0] * b->mine * b->r * b->r;
  const double cube = (a[0] * b->mine + a[1] * b->theirs) * b->r * b->ds[0];
  for (int k = 0; k < z->wants; k++)
    out[k] += f[k] * (k < z->squares ? square : cube);
}

/* multipliers <- scale x, also of copies. Collective. */
static void spread(const zone *z, const double x[])
{
  const size_t n = (size_t)z->wants;
  for (size_t k = 0; k < n; k++) {
    for (size_t i = 0; i < z->rows; i++)
      z->multiplier[k][z->place[i]] = (bw_real)(z->scale[i * n + k] * x[i * n + k]);
    bw_pd_body_fill_places(z->pd, z->multiplier[k]);
  }
}

/* out <- the conditions' change by multipliers x. Collective. */
static void apply(const zone *z, const double x[], double out[])
{
  const size_t n = (size_t)z->wants;
  spread(z, x);
  memset(out, 0, z->rows * n * sizeof *out);
  for (size_t i = 0; i < z->rows; i++) {
    for (size_t q = z->first[i]; q < z->first[i + 1]; q++) {
      const link back = reversed(&z->bond[q]);
      add(z, &z->bond[q], (double[2]){change(z, &z->bond[q]), change(z, &back)}, out + i * n);
    }
    for (size_t k = 0; k < n; k++)
      out[i * n + k] *= z->scale[i * n + k];
  }
}

static bw_status solve(const zone *z)
{
  const size_t n = z->rows * (size_t)z->wants;
  double *x[5] = {NULL};
  bw_status st = BW_OK;
  for (int q = 0; q < 5; q++)
    BW_THEN(st, BW_ALLOCATE(&x[q], n));
  st = bw_comm_agree(z->pd->comm, st);
  double *y = x[0], *r = x[1], *p = x[2], *v = x[3], *sp = x[4];
  const double least = sizeof(bw_real) == sizeof(double) ? 1e-13 : 1e-6;
  if (st == BW_OK) {
    const bw_pd_body_rows_of rows = {z->pd->comm, z->rows, z->wants, z->all};
    memcpy(r, z->missing, n * sizeof *r);
    memcpy(p, r, n * sizeof *p);
    apply(z, r, v);
    memcpy(sp, v, n * sizeof *sp);
    const double scale = bw_pd_body_dot(&rows, r, r);
    double rv = bw_pd_body_dot(&rows, r, v), rr = scale;
    for (int q = 0; q < MOST && rr > least * least * scale && rv > 1e-30 * scale; q++) {
      const double a = rv / bw_pd_body_dot(&rows, sp, sp);
      for (size_t k = 0; k < n; k++)
        y[k] += a * p[k], r[k] -= a * sp[k];
      apply(z, r, v);
      const double now = bw_pd_body_dot(&rows, r, v), b = now / rv;
      rv = now;
      rr = bw_pd_body_dot(&rows, r, r);
      for (size_t k = 0; k < n; k++)
        p[k] = r[k] + b * p[k], sp[k] = v[k] + b * sp[k];
    }
    spread(z, y);
  }
  for (int q = 0; q < 5; q++)
    bw_release(&x[q]);
  return st;
}

/* Conditions that plain weights leave, and scales that make the system's diagonal 1. Local. */
static void conditions(zone *z, const bw_pd_ordinary_plain *plain)
{
  const bw_pd_body *pd = z->pd;
  const size_t n = (size_t)z->wants;
  size_t i = 0, at = 0;
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(block->mask >> lane & 1) || !(z->whole[block->first + lane] > 0)) continue;
      double *missing = z->missing + i * n, *scale = z->scale + i * n;
      z->place[i] = block->first + lane;
      z->first[i] = at;
      for (uint32_t s = block->slot; s < block[1].slot; s++) {
        const bw_pd_slot *slot = &pd->bonds.slot[s];
        if (!(slot->family >> lane & 1)) continue;
        const link b = link_of(z, plain, block, slot, lane);
        double f[BW_PD_WANTS];
        add(z, &b, (double[2]){-1, -1}, missing);
        if (!(z->near[b.l] > 0)) continue;
        monomials(pd->dimension, b.n, f);
        for (int k = 0; k < z->wants; k++) {
          const double x = b.mine * b.r * (k < z->squares ? b.r : b.ds[0]) * f[k];
          const double y = k < z->squares ? 0 : b.theirs * b.r * b.ds[0] * f[k];
          scale[k] += x * x + y * y;
        }
        z->bond[at++] = b;
      }
      /* The squares are those of the unit tensor over d. */
      for (int a = 0, k = 0; a < pd->dimension; a++)
        for (int b = a; b < pd->dimension; b++, k++)
          missing[k] += a == b ? 1.0 / pd->dimension : 0;
      for (int k = 0; k < z->wants; k++) {
        scale[k] = scale[k] > 0 ? 1 / sqrt(scale[k]) : 0;
        missing[k] *= scale[k];
      }
      i++;
    }
  }
  z->first[i] = at;
}

bw_status bw_pd_state__plain(const bw_pd_body *pd, bw_pd_ordinary_plain *out)
{
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  for (int l = 0; l <= pd->finest; l++) {
    const bw_pd_level *level = &pd->level[l];
    const bw_pd_stencil *s = &level->stencil;
    BW_TRY(BW_ALLOCATE(&out->of[l], (size_t)s->n));
    for (int q = 0; q < s->n; q++) {
      const bw_pd_level *other = &pd->level[s->other[q]];
      const bw_pd_stencil *back = &other->stencil;
      const int32_t *o3 = s->offset + 3 * q, opposite[3] = {-o3[0], -o3[1], -o3[2]};
      const int d = bw_pd_body_direction(back, opposite);
      const double w = bw_pd_ordinary_influence(o, s->r0[q]);
      /* Ratios of volumes are powers of 2: both ends have the same bits. */
      out->of[l][q].own = w * (s->volume[q] * level->dv);
      out->of[l][q].reverse = w * (back->volume[d] * other->dv) * (other->dv / level->dv);
    }
  }
  return BW_OK;
}

void bw_pd_state__plain_release(bw_pd_ordinary_plain *plain)
{
  for (int l = 0; l <= BW_PD_FINEST; l++)
    bw_release(&plain->of[l]);
}

/* Who is near, and who of these has conditions. Collective. */
static bw_status find(zone *z)
{
  bw_pd_body *pd = z->pd;
  bw_status st = bw_pd_body_storage_array(pd->points.n_storage, &z->near);
  BW_THEN(st, bw_pd_body_storage_array(pd->points.n_storage, &z->whole));
  for (int k = 0; k < z->wants; k++)
    BW_THEN(st, bw_pd_body_storage_array(pd->points.n_storage, &z->multiplier[k]));
  st = bw_comm_agree(pd->comm, st);
  if (st != BW_OK) return st;
  /* Who has a bond across a jump, and their neighbours: the more there are, the less is left of
   * what cannot be met. */
  bw_pd_body_near_jumps(pd, z->whole);
  memcpy(z->near, z->whole, pd->points.n_storage * sizeof *z->near);
  bw_pd_body_mark_near(pd, z->whole, z->near);
  bw_pd_body_fill_places(pd, z->near);
  BW_TRY(bw_comm_agree(pd->comm, bw_pd_body_jump_room(pd, z->near)));
  BW_TRY(bw_pd_body_cut_families(pd, z->whole));
  for (size_t i = 0; i < pd->n; i++) {
    const int32_t place = pd->points.place[i];
    const bool held = pd->points.kind[i] & BW_PD_PRESCRIBED;
    z->whole[place] = z->near[place] > 0 && !(z->whole[place] > 0) && !held;
    z->rows += z->whole[place] > 0;
  }
  bw_pd_body_fill_places(pd, z->whole);
  z->all = (int64_t)z->rows;
  bw_comm_sum_int(pd->comm, 1, &z->all);
  return BW_OK;
}

static bw_status arrays(zone *z)
{
  const bw_pd_body *pd = z->pd;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    for (uint32_t s = pd->bonds.block[q].slot; s < pd->bonds.block[q + 1].slot; s++)
      if (pd->bonds.block[q].exact >= 0)
        z->links += (size_t)__builtin_popcount(pd->bonds.slot[s].family);
  const size_t n = z->rows * (size_t)z->wants;
  BW_TRY(BW_ALLOCATE(&z->place, z->rows));
  BW_TRY(BW_ALLOCATE(&z->first, z->rows + 1));
  BW_TRY(BW_ALLOCATE(&z->bond, z->links));
  BW_TRY(BW_ALLOCATE(&z->scale, n));
  return BW_ALLOCATE(&z->missing, n);
}

static void release(zone *z)
{
  bw_release(&z->place);
  bw_release(&z->first);
  bw_release(&z->bond);
  bw_release(&z->scale);
  bw_release(&z->missing);
  bw_pd_body_release_storage_array(&z->near);
  bw_pd_body_release_storage_array(&z->whole);
  for (int k = 0; k < BW_PD_WANTS; k++)
    bw_pd_body_release_storage_array(&z->multiplier[k]);
}

static double bounded(double a)
{
  return fmin(fmax(a, LOW), HIGH);
}

/* The weights of all bonds of the blocks near jumps; plain where an end is not near. Local. */
static void store(const zone *z, const bw_pd_ordinary_plain *plain, bool solved)
{
  const bw_pd_body *pd = z->pd;
  const bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (uint32_t s = block->slot; s < block[1].slot && block->exact >= 0; s++) {
      const bw_pd_slot *slot = &pd->bonds.slot[s];
      const bw_pd_ordinary_pair w = plain->of[block->level][slot->direction];
      const size_t row = ((size_t)block->exact + (s - block->slot)) * BW_PD_LANES;
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        double a = 1, back = 1;
        const bool near = z->near[block->first + lane] > 0 && z->near[slot->base + lane] > 0;
        if (solved && near && (slot->family >> lane & 1)) {
          const link b = link_of(z, plain, block, slot, lane), c = reversed(&b);
          a = bounded(1 + change(z, &b));
          back = bounded(1 + change(z, &c));
        }
        o->own[row + (size_t)lane] = (bw_real)(w.own * a);
        o->reverse[row + (size_t)lane] = (bw_real)(w.reverse * back);
      }
    }
  }
}

/* q of who has conditions is that of a whole family of its own spacing. Collective. */
static void whole_moments(const zone *z)
{
  const bw_pd_body *pd = z->pd;
  bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    const bw_pd_level *level = bw_pd_body_level_of(pd, block);
    const bw_pd_stencil *s = &level->stencil;
    double sum = 0;
    for (int d = 0; d < s->same && block->exact >= 0; d++)
      sum +=
          bw_pd_ordinary_influence(o, s->r0[d]) * s->r0[d] * s->r0[d] * s->fraction[d] * level->dv;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if ((block->mask >> lane & 1) && z->whole[block->first + lane] > 0)
        o->q[block->first + lane] = (bw_real)sum;
  }
  bw_pd_body_fill_places(pd, o->q);
}

bw_status bw_pd_state__ordinary_levels(bw_pd_body *pd)
{
  bw_pd_ordinary *o = bw_pd_ordinary_of(pd);
  bw_pd_ordinary_plain plain = {{NULL}};
  zone z = {.pd = pd, .squares = pd->dimension == 2 ? 3 : 6, .wants = pd->dimension == 2 ? 7 : 16};
  bw_status st = find(&z);
  if (st == BW_OK) {
    st = bw_pd_state__plain(pd, &plain);
    BW_THEN(st, BW_ALLOCATE(&o->own, pd->bonds.n_exact * BW_PD_LANES));
    BW_THEN(st, BW_ALLOCATE(&o->reverse, pd->bonds.n_exact * BW_PD_LANES));
    BW_THEN(st, arrays(&z));
    st = bw_comm_agree(pd->comm, st);
  }
  if (st == BW_OK) {
    store(&z, &plain, false);
    bw_pd_state__ordinary_moments(pd);
    if (pd->config.finer.jump == BW_PD_JUMP_BALANCED) {
      whole_moments(&z);
      conditions(&z, &plain);
      st = solve(&z);
      if (st == BW_OK) store(&z, &plain, true);
    }
  }
  bw_pd_state__plain_release(&plain);
  release(&z);
  return st;
}
