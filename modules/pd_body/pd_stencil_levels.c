/* The directions of a family whose partners may be of the next coarser or the next finer level.
 *
 * Between two levels, a the coarser one, the dual form (half of what either end's own family pulls
 * with, Gamma of the other's cell in the own horizon) is the spring
 *   (c_a Gamma_ab + c_b Gamma_ba)/2 = c_a fraction,   fraction = (Gamma_ab + (c_b/c_a) Gamma_ba)/2
 * with c ~ horizon^-(D+1) for the same E. It breaks, if ever, with the energy of its two halves:
 *   s0^2 = (k_ab s0_a^2 + k_ba s0_b^2)/(k_ab + k_ba),   s0 ~ horizon^-1/2. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <stdlib.h>

/* Offsets between particles of two levels. */
typedef struct {
  const bw_pd_body *pd;
  int l, other;  /* of the owner, of its partner */
  int step;      /* of which the components of an offset are multiples; odd ones between levels */
  int side;      /* of known: components in steps are below */
  double *known; /* (2, side^3) Gamma + 1 of the owner's and of the partner's view; 0: not yet */
} pair;

/* How far the family of level l reaches to cells of level p [L]. */
static double reach_of(const bw_pd_body *pd, int l, int p)
{
  const double half = pd->config.family_reach == BW_PD_REACH_HORIZON ? 0 : 0.5 * pd->level[p].ds;
  return pd->level[l].horizon + half;
}

static int compare_int(const void *a, const void *b)
{
  return *(const int *)a - *(const int *)b;
}

/* Gamma of a cell of level p in the horizon of level l; o in steps. */
static bw_status gamma_of(const pair *x, int l, int p, const int o[3], double *gamma)
{
  const bw_pd_body *pd = x->pd;
  const double scale = x->step * pd->level->stencil.unit / pd->level[p].ds;
  int c[3] = {abs(o[0]), abs(o[1]), abs(o[2])};
  double at[3], r2 = 0;
  for (int k = 0; k < 3; k++)
    at[k] = scale * o[k], r2 += at[k] * at[k];
  /* In the cell's own spacings: the margin only absorbs the rounding of m. */
  const double reach = reach_of(pd, l, p) / pd->level[p].ds;
  *gamma = 0;
  if (!(r2 < reach * reach * (1 - 1e-12))) return BW_OK;
  /* Offsets equal up to signs and order have the same fraction: it is computed once. */
  qsort(c, pd->dimension == 3 ? 3 : 2, sizeof *c, compare_int);
  double *memo = &x->known[(l == x->l ? 0 : x->side * x->side * x->side) + c[0] +
                           x->side * (c[1] + x->side * c[2])];
  if (*memo == 0) {
    BW_TRY(bw_pd_body_fraction(pd, pd->level[l].horizon / pd->level[p].ds, at, memo));
    *memo += 1;
  }
  *gamma = *memo - 1;
  return BW_OK;
}

/* What the stencil says of an offset; fraction 0: there is no bond. */
typedef struct {
  double fraction, volume, tough;
} said;

static bw_status bond_of(const pair *x, const int o[3], said *out)
{
  const bw_pd_level *level = x->pd->level;
  const int a = x->l < x->other ? x->l : x->other, b = x->l < x->other ? x->other : x->l;
  double ab, ba;
  BW_TRY(gamma_of(x, a, b, o, &ab));
  *out = (said){ab, ab, 1};
  if (a == b) return BW_OK;
  BW_TRY(gamma_of(x, b, a, o, &ba));
  out->volume = (x->l == a ? ab : ba) * level[x->other].dv / level[x->l].dv;
  ba *= level[b].stiff / level[a].stiff;
  out->fraction = x->pd->config.finer.jump != BW_PD_JUMP_ONE_SIDED ? (ab + ba) / 2
                  : x->l == a                                      ? ab
                                                                   : ba;
  /* By energy: the finer half bears more. */
  const double s2 = pow(level[b].stretch / level[a].stretch, 2);
  if (ab + ba > 0) out->tough = (ab + ba * s2) / (ab + ba);
  return BW_OK;
}

/* The directions of a pair of levels, x fastest, from row `n` of the stencil on; counted only while
 * there are no offsets. */
static bw_status list_pair(const pair *x, bw_pd_stencil *s, int *n)
{
  const int most = x->side - 1, every = x->l == x->other ? 1 : 2;
  const int first = every == 1 || most % 2 == 1 ? -most : -most + 1;
  const int flat = x->pd->dimension == 2;
  for (int z = flat ? 0 : first; z <= (flat ? 0 : most); z += every)
    for (int y = first; y <= most; y += every)
      for (int i = first; i <= most; i += every) {
        const int o[3] = {i, y, z};
        said bond;
        if (i == 0 && y == 0 && z == 0) continue;
        BW_TRY(bond_of(x, o, &bond));
        if (!(bond.fraction > 0)) continue;
        if (s->offset != NULL) {
          for (int k = 0; k < 3; k++)
            s->offset[3 * *n + k] = o[k] * x->step;
          s->fraction[*n] = bond.fraction;
          s->volume[*n] = bond.volume;
          s->tough[*n] = bond.tough;
          s->other[*n] = (uint8_t)x->other;
        }
        ++*n;
      }
  return BW_OK;
}

static bw_status list_level(bw_pd_body *pd, int l, int *n, int *same)
{
  bw_pd_stencil *s = &pd->level[l].stencil;
  *n = 0;
  /* Own level, coarser, finer: the order in which a family is summed. */
  for (int q = 0; q < 3; q++) {
    const int other = l + (const int[]){0, -1, 1}[q], finer = other > l ? other : l;
    if (other < 0 || other > pd->finest) continue;
    pair x = {.pd = pd, .l = l, .other = other};
    x.step = 1 << (pd->finest - finer + (other == l));
    const double most = fmax(reach_of(pd, l, other), reach_of(pd, other, l));
    x.side = (int)ceil(most / (x.step * pd->level->stencil.unit)) + 1;
    BW_TRY(BW_ALLOCATE(&x.known, 2 * (size_t)x.side * (size_t)x.side * (size_t)x.side));
    const bw_status st = list_pair(&x, s, n);
    bw_release(&x.known);
    BW_TRY(st);
    if (q == 0) *same = *n;
  }
  return BW_OK;
}

/* Families of one horizon and other cells have the same modulus by their own first moment. */
static bw_status equal_moduli(bw_pd_body *pd)
{
  double first = 0;
  for (int l = 0; l <= pd->finest; l++) {
    const double m = pd->level[l].horizon / pd->level[l].ds;
    const int reach = (int)ceil(m + 0.5), flat = pd->dimension == 2;
    double sum = 0;
    for (int z = flat ? 0 : -reach; z <= (flat ? 0 : reach); z++)
      for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
          const double at[3] = {x, y, z}, r = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
          double gamma = 0;
          if (r > 0 && r * pd->level[l].ds < pd->level[l].reach * (1 - 1e-12))
            BW_TRY(bw_pd_body_fraction(pd, m, at, &gamma));
          sum += gamma * r * pd->level[l].ds * pd->level[l].dv;
        }
    if (l == 0) first = sum;
    pd->level[l].stiff = first / sum;
  }
  return BW_OK;
}

bw_status bw_pd_body_stencil_levels(bw_pd_body *pd)
{
  const double unit = ldexp(pd->config.ds, -pd->finest - 1);
  if (pd->config.finer.same_horizon) BW_TRY(equal_moduli(pd));
  for (int l = 0; l <= pd->finest; l++)
    pd->level[l].stencil.unit = unit;
  for (int l = 0; l <= pd->finest; l++) {
    bw_pd_stencil *s = &pd->level[l].stencil;
    int n = 0, same = 0;
    /* Counted first; the offsets are written once there is room. */
    BW_TRY(list_level(pd, l, &n, &same));
    BW_TRY(bw_pd_body_stencil_room(pd, l, n));
    BW_TRY(list_level(pd, l, &n, &same));
    s->same = same;
    bw_pd_body_stencil_lengths(pd, s);
    /* No cloud has levels: who is family is sure. */
    for (int q = 0; q < s->n; q++)
      s->sure[q] = true;
    for (int q = 0; q < 3 * s->n; q++)
      s->reach = abs(s->offset[q]) > s->reach ? abs(s->offset[q]) : s->reach;
  }
  return BW_OK;
}
