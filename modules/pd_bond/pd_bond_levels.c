/* The factors of bonds near a jump between levels.
 *
 * With the dual form momentum is kept, but a uniform strain pulls at the particles beside a jump:
 *   A_h = sum_l k_hl alpha_hl e e e dV_l
 * does not vanish there ("ghost force", 0.74 E eps/horizon at a flat jump), which displaces what is
 * held and reflects waves in proportion to their wave number. So each bond gets the smallest change
 *   sum_bonds (alpha - alpha_0)^2 -> min   with   A_h = 0 (pd_bond_zone.c),
 * alpha_0 of the surface correction. With multipliers mu of the cubics of a direction, k over that
 * of level 0 and both ends alike,
 *   alpha_hl = alpha_0 + k [dV_l mu_h.f(e) - dV_h mu_l.f(e)],   f(-e) = -f(e),
 * and A alpha = 0 is a symmetric system S lambda = b, mu = white^T lambda. It is solved to the end
 * by conjugate residuals (Stiefel 1955), which take what cannot be met as a least square. Sums over
 * particles are made of whole numbers: the factors are the same on any number of ranks. */
#include "pd_bond_levels.h"
#include "bw_memory.h"

#include <math.h>
#include <string.h>

enum { MOST = 2000 }; /* steps; some 100 to 300 are usual */
enum { ROUNDS = 8 };  /* in each the bonds that would become too soft are fixed; 1 to 3 are usual */
enum { PAUSE = 6 };   /* steps in which, with faces, the square of the residual ... */
static const double FALLS = 0.9; /* ... has to fall to this part, or there are no more of them */
static const double LOW = 0.1, HIGH = 4; /* of alpha: the softest, the stiffest that a bond gets */

/* Vectors of the solution: (rows, cubics) each. */
typedef struct {
  double *lambda, *r, *p, *v, *sp;
} vectors;

/* Sum of x.y over all rows. Collective. */
static double dot(const bw_pd_bond_zone *z, const double x[], const double y[])
{
  return bw_pd_body_dot(&(bw_pd_body_rows_of){z->pd->comm, z->rows, z->cubics, z->all}, x, y);
}

/* mu = white^T x, also of copies. Collective. */
static void spread(const bw_pd_bond_zone *z, const double x[])
{
  const size_t n = (size_t)z->cubics;
  for (size_t i = 0; i < z->rows; i++) {
    const double *white = z->white + i * n * n;
    const int32_t place = z->pd->points.place[z->particle[i]];
    for (size_t q = 0; q < n; q++) {
      double sum = 0;
      for (size_t k = 0; k < n; k++)
        sum += white[k * n + q] * x[i * n + k];
      z->mu[q][place] = (bw_real)sum;
    }
  }
  for (size_t q = 0; q < n; q++)
    bw_pd_body_fill_places(z->pd, z->mu[q]);
}

/* alpha - alpha_0 of a slot: exactly the same seen from either end. */
INLINE vec change(const bw_pd_bond_zone *z, const bw_pd_block *block, const bw_pd_slot *slot)
{
  const bw_pd_level *own = bw_pd_body_level_of(z->pd, block);
  const bw_pd_level *other = z->pd->level + own->stencil.other[slot->direction];
  const bw_real *f = z->cubic[block->level] + slot->direction * z->cubics;
  vec mine = vec_all(0), theirs = vec_all(0);
  for (int k = 0; k < z->cubics; k++) {
    mine = vec_fma(vec_all(f[k]), vec_load(z->mu[k] + block->first), mine);
    theirs = vec_fma(vec_all(f[k]), vec_load(z->mu[k] + slot->base), theirs);
  }
  const double k_hl =
      own->stencil.fraction[slot->direction] * bw_pd_level_coarser(own, other)->stiff;
  const double unit = z->pd->level->dv;
  return mine * (bw_real)(k_hl * (other->dv / unit)) - theirs * (bw_real)(k_hl * (own->dv / unit));
}

static bool has_row(const bw_pd_bond_zone *z, const bw_pd_block *block)
{
  const int32_t end = block->own + __builtin_popcount(block->mask);
  for (int32_t i = block->own; i < end; i++)
    if (z->row[i] >= 0) return true;
  return false;
}

/* out = white A x for x the present factors (`all`), or their change by mu. Local. */
static void gather(const bw_pd_bond_zone *z, bool all, double out[])
{
  const bw_pd_body *pd = z->pd;
  const int n = z->cubics;
  const bw_real unit = (bw_real)(pd->bonds.factor != NULL ? BW_PD_ALPHA_UNIT : 1);
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    if (block->exact < 0 || !has_row(z, block)) continue;
    vec sum[BW_PD_BOND_CUBICS];
    for (int k = 0; k < n; k++)
      sum[k] = vec_all(0);
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      const bw_pd_slot *slot = &pd->bonds.slot[q];
      const size_t row = (size_t)block->exact + (q - block->slot);
      const bw_real *f = z->cubic[block->level] + slot->direction * n;
      if (!all && z->free[row] == 0) continue;
      const vec x = all ? vec_keep(lanes_of(slot->family),
                                   vec_load(pd->bonds.exact + row * BW_PD_LANES) * unit)
                        : vec_keep(lanes_of(z->free[row]), change(z, block, slot));
      const vec w = x * z->pull[block->level][slot->direction];
      for (int k = 0; k < n; k++)
        sum[k] = vec_fma(vec_all(f[k]), w, sum[k]);
    }
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      const int32_t i = block->mask >> lane & 1 ? z->row[bw_pd_body_owner(block, lane)] : -1;
      if (i < 0) continue;
      const double *white = z->white + (size_t)i * (size_t)(n * n);
      for (int k = 0; k < n; k++) {
        double y = 0;
        for (int q = 0; q < n; q++)
          y += white[k * n + q] * (double)sum[q][lane];
        out[i * n + k] = y;
      }
    }
  }
}

static void apply(const bw_pd_bond_zone *z, const double x[], double out[])
{
  spread(z, x);
  gather(z, false, out);
}

/* The square of what the present factors leave of the conditions. Collective. */
static double ghost(const bw_pd_bond_zone *z, const vectors *x)
{
  gather(z, true, x->r);
  return dot(z, x->r, x->r);
}

/* S lambda = -white A alpha_0 by conjugate residuals. The factors of faces come from a fixed number
 * of sweeps and are rounded: beside them no state is wholly at rest, and whoever demanded it would
 * get large factors for nothing. There a thousandth of the ghost force may stay, and where jumps
 * meet faces what is left when it hardly falls any more; scale: the square of what the surface's
 * factors leave. Collective. */
static void solve(const bw_pd_bond_zone *z, double scale, vectors *x)
{
  const size_t n = z->rows * (size_t)z->cubics;
  const bool faces = z->pd->bonds.factor != NULL;
  const int most = faces ? 60 : MOST;
  /* Until a residual of rounding: of the numbers that factors are stored in. */
  const double least = faces ? 1e-3 : sizeof(bw_real) == sizeof(double) ? 1e-13 : 1e-6;
  gather(z, true, x->r);
  for (size_t k = 0; k < n; k++) {
    x->lambda[k] = 0;
    x->p[k] = x->r[k] = -x->r[k];
  }
  apply(z, x->r, x->v);
  memcpy(x->sp, x->v, n * sizeof *x->sp);
  double rv = dot(z, x->r, x->v), rr = dot(z, x->r, x->r), before = INFINITY;
  for (int q = 0; q < most && rr > least * least * scale && rv > least * least * scale; q++) {
    if (faces && q % PAUSE == 0) {
      if (rr > FALLS * before) break;
      before = rr;
    }
    const double a = rv / dot(z, x->sp, x->sp);
    for (size_t k = 0; k < n; k++) {
      x->lambda[k] += a * x->p[k];
      x->r[k] -= a * x->sp[k];
    }
    apply(z, x->r, x->v);
    const double now = dot(z, x->r, x->v), b = now / rv;
    rv = now;
    rr = dot(z, x->r, x->r);
    for (size_t k = 0; k < n; k++) {
      x->p[k] = x->r[k] + b * x->p[k];
      x->sp[k] = x->v[k] + b * x->sp[k];
    }
  }
}

/* Factors with the change by mu. A round that finds bonds below LOW only fixes those, but for the
 * last one. Returns how many it fixed, of all ranks. Collective. */
static int64_t store(bw_pd_bond_zone *z, bool last)
{
  bw_pd_body *pd = z->pd;
  const bw_real unit = (bw_real)(pd->bonds.factor != NULL ? BW_PD_ALPHA_UNIT : 1);
  int64_t fixed = 0;
  for (int pass = 0; pass < 2 && fixed == 0; pass++) {
    for (size_t b = 0; b < pd->bonds.n_block; b++) {
      const bw_pd_block *block = &pd->bonds.block[b];
      for (uint32_t q = block->slot; q < block[1].slot && block->exact >= 0; q++) {
        const size_t row = (size_t)block->exact + (q - block->slot);
        bw_real *alpha = &pd->bonds.exact[row * BW_PD_LANES];
        const vec x = vec_load(alpha) + change(z, block, &pd->bonds.slot[q]) * (1 / unit);
        for (int lane = 0; lane < BW_PD_LANES; lane++) {
          if (!(z->free[row] >> lane & 1)) continue;
          const bool soft = x[lane] * unit < (bw_real)LOW;
          const bool stiff = x[lane] * unit > (bw_real)HIGH;
          if (pass == 1)
            alpha[lane] = soft ? (bw_real)LOW / unit : stiff ? (bw_real)HIGH / unit : x[lane];
          if (pass == 1 || !soft || last) continue;
          alpha[lane] = (bw_real)LOW / unit;
          z->free[row] = (uint8_t)(z->free[row] & ~(1u << lane));
          fixed++;
        }
      }
    }
    bw_comm_sum_int(pd->comm, 1, &fixed);
  }
  return fixed;
}

static bw_status arrays(const bw_pd_bond_zone *z, vectors *x)
{
  const size_t n = z->rows * (size_t)z->cubics;
  double **all[] = {&x->lambda, &x->r, &x->p, &x->v, &x->sp};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    BW_TRY(BW_ALLOCATE(all[q], n));
  return BW_OK;
}

/* mu of the zone <- what the body keeps; `fixed`: of those alone that have no row. Collective. */
static void recall(const bw_pd_bond_zone *z, bool fixed)
{
  const bw_pd_body *pd = z->pd;
  for (int k = 0; k < z->cubics; k++) {
    for (size_t i = 0; i < pd->n; i++) {
      const int32_t place = pd->points.place[i];
      const bool there = z->near[place] > 0 && !(fixed && z->row[i] >= 0);
      z->mu[k][place] = there ? bw_pd_bond__state(pd)->mu[k][place] : 0;
    }
    bw_pd_body_fill_places(pd, z->mu[k]);
  }
}

/* The body keeps mu of the rows, and no more that of who is not near a jump. Local. */
static void keep(const bw_pd_bond_zone *z)
{
  bw_pd_body *pd = z->pd;
  for (int k = 0; k < bw_pd_bond__state(pd)->n_mu; k++)
    for (size_t i = 0; i < pd->n; i++) {
      const int32_t place = pd->points.place[i];
      bw_real *mu = &bw_pd_bond__state(pd)->mu[k][place];
      *mu = !(z->near[place] > 0) ? 0 : z->row[i] >= 0 ? z->mu[k][place] : *mu;
    }
}

/* Where faces have their factors: one solution, beside what is kept of the body before. */
static bw_status solve_once(bw_pd_bond_zone *z, const bw_pd_bond_change *change, vectors *x)
{
  BW_TRY(bw_comm_agree(z->pd->comm, bw_pd_bond__conditions(z)));
  const double scale = ghost(z, x);
  if (change != NULL) {
    recall(z, true);
    store(z, true);
  }
  /* Rows alone are written from here on: those that are kept add nothing to a change. */
  for (int k = 0; k < z->cubics; k++)
    memset(z->mu[k], 0, z->pd->points.n_storage * sizeof *z->mu[k]);
  solve(z, scale, x);
  spread(z, x->lambda);
  keep(z);
  /* From all multipliers at once, as after a restart. */
  if (change != NULL) {
    bw_pd_bond__zone_begin(z);
    recall(z, false);
  }
  store(z, true);
  return BW_OK;
}

/* Elsewhere: bonds beside edges would have to push; they are left soft, the others do without. */
static bw_status solve_in_rounds(bw_pd_bond_zone *z, vectors *x)
{
  for (int round = 0; round < ROUNDS; round++) {
    BW_TRY(bw_comm_agree(z->pd->comm, bw_pd_bond__conditions(z)));
    solve(z, ghost(z, x), x);
    spread(z, x->lambda);
    if (store(z, round == ROUNDS - 1) == 0) break;
  }
  return BW_OK;
}

bw_status bw_pd_bond__levels_room(bw_pd_body *pd)
{
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  const int n = bw_pd_bond__cubics(pd->dimension);
  for (int k = 0; k < n; k++)
    BW_TRY(bw_pd_body_add_field(pd, -1, true, &state->mu[k]));
  state->n_mu = n;
  return BW_OK;
}

bw_status bw_pd_bond__levels_adopt(bw_pd_body *pd)
{
  bw_pd_bond_zone z = {0};
  const bw_status st = bw_pd_bond__zone(pd, NULL, &z);
  if (st == BW_OK) {
    recall(&z, false);
    store(&z, true);
  }
  bw_pd_bond__zone_release(&z);
  return st;
}

bw_status bw_pd_bond__levels(bw_pd_body *pd, const bw_pd_bond_change *change)
{
  bw_pd_bond_zone z = {0};
  vectors x = {0};
  bw_status st = bw_pd_bond__zone(pd, change, &z);
  if (st == BW_OK) st = bw_comm_agree(pd->comm, arrays(&z, &x));
  if (st == BW_OK)
    st = pd->bonds.factor != NULL ? solve_once(&z, change, &x) : solve_in_rounds(&z, &x);
  double **all[] = {&x.lambda, &x.r, &x.p, &x.v, &x.sp};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_pd_bond__zone_release(&z);
  return st;
}
