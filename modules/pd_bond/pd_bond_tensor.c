/* The surface correction `tensor`: one factor per bond, from linear algebra on the families.
 *
 * A family under a homogeneous strain eps stores 1/2 eps:M:eps and pulls its particle by A:eps,
 *   M = 1/2 c0 sum_l alpha e e e e |xi| Gamma dV,   A = c0 sum_l alpha e e e Gamma dV.
 * M ought to be the tensor of elasticity. A ought to be what a traction needs: sigma.a for some
 * vector a, a particle's share of the body's face; as the tensor of bonds is symmetric in all
 * indices that says that the part of A without trace (spherical harmonics of order 3) vanishes.
 * Then a homogeneous strain with sigma.n = 0 on the faces is a state of rest with the energy
 * of elasticity, whatever the thickness. So: the smallest change
 *   sum_bonds Gamma (alpha - 1)^2 -> min   with   LOW <= alpha <= HIGH,
 *   sum_l alpha_hl phi_k(xi) Gamma = T_k at every particle h, k = 1 .. K,
 * phi: the 15 monomials of degree 4 (2D: 5) and the 7 harmonics of degree 3 (2D: 2) of the
 * direction, made orthonormal over the full family. With multipliers lambda(h)
 *   alpha_hl = clip(1 + 1/2 (lambda(h).phi(xi) + lambda(l).phi(-xi))),
 * the same from both ends; lambda follows by ascent of the dual problem with Nesterov's momentum,
 *   lambda += T - sum alpha phi Gamma:
 * orthonormal phi bound the step by 1. What corners, single sheets and rods cannot meet stays a
 * residual there, between the bounds. The number of sweeps is fixed and nothing is summed over
 * particles: the factors are the same to the last bit on any number of ranks. */
#include "pd_bond_tensor.h"
#include "bw_memory.h"
#include "pd_sweep.h"

#include <string.h>

enum { MOST = BW_PD_BOND_CONDITIONS, SWEEPS = 60 };
enum { LAYERS = 3 }; /* families that a face is felt through, where levels change */
static const double LOW = 0.25, HIGH = 65535 * BW_PD_ALPHA_UNIT;

static vec clipped(vec x)
{
  const vec low = vec_all((bw_real)LOW), high = vec_all((bw_real)HIGH);
  const lanes above = vec_above(x, high), below = vec_above(low, x);
  return vec_keep(above, high) + vec_keep(below, low) + vec_keep((lanes) ~(above | below), x);
}

/* The factors of a slot. Both ends do the same operations on the same numbers. */
INLINE vec factors(const bw_pd_body *pd, const bw_pd_bond_solver *v, const bw_pd_block *block,
                   const bw_pd_slot *slot, int n)
{
  /* The opposite direction is the mirror place in the stencil: phi(-xi) of the other end. */
  const bw_real *phi = v->phi + slot->direction * n;
  const bw_real *back = v->phi + (pd->level[0].stencil.same - 1 - slot->direction) * n;
  vec mine = vec_all(0), other = vec_all(0);
  for (int k = 0; k < n; k++) {
    mine = vec_fma(vec_all(phi[k]), vec_load(v->at[k] + block->first), mine);
    other = vec_fma(vec_all(back[k]), vec_load(v->at[k] + slot->base), other);
  }
  return clipped(vec_all(1) + (mine + other) * (bw_real)0.5);
}

/* Ascent of one block's multipliers, to `next` (own): copies and neighbours still read the old. */
INLINE void ascend(const bw_pd_body *pd, const bw_pd_bond_solver *v, const bw_pd_block *block,
                   bw_real *const next[], int n)
{
  /* T - sum alpha phi Gamma, lane by lane: what is still lacking. */
  vec rest[MOST];
  for (int k = 0; k < n; k++)
    rest[k] = vec_all((bw_real)v->target[k]);
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    /* Factors are made from the multipliers at both ends each time: none is stored yet. */
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    if (slot->direction >= pd->level[0].stencil.same) continue; /* between levels */
    const bw_real *phi = v->phi + slot->direction * n;
    const vec alpha = vec_keep(lanes_of(slot->family), factors(pd, v, block, slot, n)) *
                      (bw_real)pd->level[0].stencil.fraction[slot->direction];
    for (int k = 0; k < n; k++)
      rest[k] = vec_fnma(vec_all(phi[k]), alpha, rest[k]);
  }
  for (int k = 0; k < n; k++)
    vec_put_owners(block, vec_load(v->at[k] + block->first) + rest[k], next[k]);
}

/* Does no owner of a block change its multipliers? */
static bool is_held(const bool held[], const bw_pd_block *block)
{
  const int32_t end = block->own + __builtin_popcount(block->mask);
  for (int32_t i = block->own; i < end; i++)
    if (!held[i]) return false;
  return true;
}

/* All blocks; K is known when this is compiled. */
static void ascend_all(const bw_pd_body *pd, const bw_pd_bond_solver *v)
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    if (pd->mapped && is_held(v->held, &pd->bonds.block[b])) continue;
    if (v->n == MOST)
      ascend(pd, v, &pd->bonds.block[b], v->next, MOST);
    else
      ascend(pd, v, &pd->bonds.block[b], v->next, v->n);
  }
}

/* Nesterov's sequence: t' = (1 + sqrt(1 + 4 t^2))/2, momentum (t - 1)/t'. Collective. */
static void solve(bw_pd_body *pd, bw_pd_bond_solver *v)
{
  /* A fixed number of sweeps, no norm over ranks: the same bits on any number of them. */
  double t = 1;
  for (int pass = 0; pass < SWEEPS; pass++) {
    const double after = (1 + sqrt(1 + 4 * t * t)) / 2;
    const bw_real momentum = (bw_real)((t - 1) / after);
    t = after;
    /* Everybody reads the old multipliers of its neighbours, whoever owns them. */
    ascend_all(pd, v);
    for (int k = 0; k < v->n; k++) {
      for (size_t i = 0; i < pd->n; i++) {
        if (v->held[i]) continue;
        const bw_real next = v->next[k][i];
        v->at[k][pd->points.place[i]] = next + momentum * (next - v->last[k][i]);
        v->last[k][i] = next;
      }
      /* Copies have to be current before the next sweep reads them. */
      bw_pd_body_fill_places(pd, v->at[k]);
    }
  }
}

/* The factors of all slots, in units of BW_PD_ALPHA_UNIT. */
static void store(bw_pd_body *pd, const bw_pd_bond_solver *v)
{
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++) {
      /* Rounded alike from both ends: a bond's two forces stay exact opposites. */
      const bool across = pd->bonds.slot[q].direction >= pd->level[0].stencil.same;
      const vec alpha =
          across ? vec_all(1) : factors(pd, v, &pd->bonds.block[b], &pd->bonds.slot[q], v->n);
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        pd->bonds.factor[(size_t)q * BW_PD_LANES + (size_t)lane] =
            (uint16_t)lround((double)alpha[lane] / BW_PD_ALPHA_UNIT);
    }
}

/* Held layers stand for the material behind them, and who has bonds to another level has its
 * family completed there: they keep the full family's multipliers. */
static void hold(const bw_pd_body *pd, bw_pd_bond_solver *v)
{
  for (size_t i = 0; i < pd->n; i++)
    v->held[i] = (pd->points.kind[i] & BW_PD_PRESCRIBED) != 0;
  for (size_t b = 0; pd->finest > 0 && b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      const bw_pd_slot *slot = &pd->bonds.slot[q];
      if (slot->direction < bw_pd_body_level_of(pd, block)->stencil.same) continue;
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if (slot->family >> lane & 1) v->held[bw_pd_body_owner(block, lane)] = true;
    }
  }
}

/* near (storage) of the particles whose family of the own level misses cells. */
static void mark_cut(const bw_pd_body *pd, const bw_pd_bond_solver *v, bw_real *near)
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    int missing[BW_PD_LANES];
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      missing[lane] = bw_pd_body_level_of(pd, block)->stencil.same;
    for (uint32_t q = block->slot; q < block[1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        missing[lane] -= pd->bonds.slot[q].family >> lane & 1;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if ((block->mask >> lane & 1) && missing[lane] > 0 && !v->held[bw_pd_body_owner(block, lane)])
        near[block->first + lane] = 1;
  }
}

void bw_pd_bond__mark_neighbours(const bw_pd_body *pd, const bw_real *before, bw_real *near)
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    for (uint32_t q = block->slot; q < block[1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if ((pd->bonds.slot[q].family >> lane & 1) && before[pd->bonds.slot[q].base + lane] > 0)
          near[block->first + lane] = 1;
  }
}

/* Where levels change a body is built often, and deep inside a full family's multipliers are the
 * solution: who is LAYERS families from every face keeps them, too. Collective. */
static bw_status hold_inside(bw_pd_body *pd, bw_pd_bond_solver *v)
{
  const size_t places = pd->points.n_storage;
  bw_real *near = NULL, *before = NULL;
  bw_status st = bw_pd_body_storage_array(places, &near);
  BW_THEN(st, bw_pd_body_storage_array(places, &before));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) mark_cut(pd, v, near);
  for (int layer = 0; layer < LAYERS && st == BW_OK; layer++) {
    bw_pd_body_fill_places(pd, near);
    memcpy(before, near, places * sizeof *before);
    bw_pd_bond__mark_neighbours(pd, before, near);
  }
  for (size_t i = 0; i < pd->n && st == BW_OK; i++)
    v->held[i] = v->held[i] || !(near[pd->points.place[i]] > 0);
  bw_pd_body_release_storage_array(&near);
  bw_pd_body_release_storage_array(&before);
  return st;
}

/* Room for the multipliers, or that which the body keeps; and for the factors. */
static bw_status solver_arrays(bw_pd_body *pd, bw_pd_bond_solver *v)
{
  const bw_pd_bond_state *state = bw_pd_bond__state(pd);
  BW_TRY(BW_ALLOCATE(&v->held, pd->n));
  for (int k = 0; k < v->n; k++) {
    if (state->n_lambda > 0)
      v->at[k] = state->lambda[k];
    else
      BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &v->at[k]));
    BW_TRY(BW_ALLOCATE(&v->last[k], pd->n));
    BW_TRY(BW_ALLOCATE(&v->next[k], pd->n));
  }
  return pd->bonds.factor != NULL ? BW_OK
                                  : BW_ALLOCATE(&pd->bonds.factor, pd->bonds.n_slot * BW_PD_LANES);
}

/* Where everybody starts: from the full family, which in the bulk is the solution; who had
 * multipliers, from those, and away from a change they are kept. Collective. */
static void begin(const bw_pd_body *pd, bw_pd_bond_solver *v, const bw_pd_bond_change *change)
{
  for (size_t i = 0; i < pd->n; i++) {
    const int32_t p = pd->points.place[i];
    const bool had = change != NULL && !change->fresh[i] && !v->held[i];
    for (int k = 0; k < v->n; k++)
      v->at[k][p] = v->last[k][i] = had ? v->at[k][p] : (bw_real)v->full[k];
    v->held[i] = v->held[i] || (had && !(change->near[p] > 0));
  }
  for (int k = 0; k < v->n; k++)
    bw_pd_body_fill_places(pd, v->at[k]);
}

static void release(const bw_pd_body *pd, bw_pd_bond_solver *v)
{
  const bool kept = bw_pd_bond__state(pd)->n_lambda > 0;
  for (int k = 0; k < MOST; k++) {
    if (!kept) bw_pd_body_release_storage_array(&v->at[k]);
    bw_release(&v->last[k]);
    bw_release(&v->next[k]);
  }
  bw_release(&v->phi);
  bw_release(&v->held);
}

/* The factors of the multipliers, and the constants that hold those of a full family. Collective.
 */
static bw_status finish(bw_pd_body *pd, const bw_pd_bond_solver *v)
{
  store(pd, v);
  BW_TRY(bw_comm_agree(pd->comm,
                       bw_pd_bond__full_family(pd))); /* a crack's energy holds the factors */
  bw_pd_bond__calibrate(pd);
  return BW_OK;
}

bw_status bw_pd_bond__tensor_room(bw_pd_body *pd)
{
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  bw_pd_bond_solver v = {0};
  bw_status st = bw_pd_bond__basis(pd, &v);
  for (int k = 0; k < v.n; k++)
    BW_THEN(st, bw_pd_body_add_field(pd, -1, true, &state->lambda[k]));
  bw_release(&v.phi);
  BW_TRY(st);
  state->n_lambda = v.n;
  /* Bonds may be cut before they have their factors. */
  BW_TRY(BW_ALLOCATE(&pd->bonds.factor, pd->bonds.n_slot * BW_PD_LANES));
  for (size_t q = 0; q < pd->bonds.n_slot * BW_PD_LANES; q++)
    pd->bonds.factor[q] = (uint16_t)(1 / BW_PD_ALPHA_UNIT);
  return BW_OK;
}

bw_status bw_pd_bond__tensor(bw_pd_body *pd, const bw_pd_bond_change *change)
{
  bw_pd_bond_solver v = {0};
  bw_status st = bw_pd_bond__basis(pd, &v);
  BW_THEN(st, solver_arrays(pd, &v));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) {
    hold(pd, &v);
    if (pd->mapped) st = hold_inside(pd, &v);
  }
  if (st == BW_OK) {
    begin(pd, &v, change);
    solve(pd, &v);
    st = finish(pd, &v);
  }
  release(pd, &v);
  return st;
}

bw_status bw_pd_bond__tensor_adopt(bw_pd_body *pd)
{
  bw_pd_bond_solver v = {0};
  bw_status st = bw_pd_bond__basis(pd, &v);
  BW_THEN(st, solver_arrays(pd, &v));
  st = bw_comm_agree(pd->comm, st);
  for (int k = 0; k < v.n && st == BW_OK; k++)
    bw_pd_body_fill_places(pd, v.at[k]);
  if (st == BW_OK) st = finish(pd, &v);
  release(pd, &v);
  return st;
}
