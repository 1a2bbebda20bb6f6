/* Short-range repulsion (3.40 with ERRATA 3): on h, for r = |X_l - X_h| < r_c,
 *   C_h = - k_c (r_c/r - 1) e dV_l,  e from h to l,  n_c = 1, k_c = 15 c0, r_c = ds,
 * which derives from the energy k_c (r_c ln(r_c/r) - r_c + r) dV dV of a pair. In a cloud r_c of
 * two whose bond broke is not above |xi|: else neighbours nearer than ds from the start would push
 * when they part. */
#include "pd_bond_contact.h"
#include "bw_memory.h"
#include "pd_bond_sweep.h"

#include <math.h>

static const double K_CONTACT = 15; /* k_c/c0: Macek & Silling 2007 */
static const double SKIN = 0.5;     /* of the search, in ds: a new one after a move of ds/4 */

bw_status bw_pd_bond__contact_create(bw_pd_bond *pd)
{
  BW_TRY(BW_ALLOCATE(&pd->contact, 1));
  bw_pd_contact *c = pd->contact;
  c->reach = pd->config.ds;
  c->skin = SKIN * pd->config.ds;
  c->closest = INFINITY;
  for (int k = 0; k < 3; k++)
    BW_TRY(BW_ALLOCATE(&c->u_built[k], pd->n));
  return BW_ALLOCATE(&c->link, (size_t)pd->stencil.n);
}

void bw_pd_bond__contact_destroy(bw_pd_bond *pd)
{
  bw_pd_contact *c = pd->contact;
  if (c == NULL) return;
  bw_pd_contact__forget(c);
  for (int k = 0; k < 3; k++)
    bw_release(&c->u_built[k]);
  bw_release(&c->near);
  bw_release(&c->link);
  bw_release(&pd->contact);
}

/* Whether an own particle moved by half the skin since the last search (NaN counts). */
static bool moved(const bw_pd_bond *pd, const bw_pd_contact *c)
{
  const bw_real limit2 = (bw_real)(0.25 * c->skin * c->skin);
  int far = 0;
  for (size_t r = 0; r < pd->n_run; r++) {
    const bw_pd_run run = pd->run[r];
    const bw_real *x = pd->u[0] + run.place, *a = c->u_built[0] + run.own;
    const bw_real *y = pd->u[1] + run.place, *b = c->u_built[1] + run.own;
    const bw_real *z = pd->u[2] + run.place, *e = c->u_built[2] + run.own;
#pragma omp simd reduction(+ : far)
    for (int32_t i = 0; i < run.n; i++) {
      const bw_real dx = x[i] - a[i], dy = y[i] - b[i], dz = z[i] - e[i];
      far += !(dx * dx + dy * dy + dz * dz <= limit2);
    }
  }
  return far > 0;
}

static void remember(const bw_pd_bond *pd, bw_pd_contact *c)
{
  for (size_t i = 0; i < pd->n; i++)
    for (int k = 0; k < 3; k++)
      c->u_built[k][i] = pd->u[k][pd->place[i]];
  c->built = true;
}

/* Present positions of the particles in pairs, other ranks' too. */
static void positions(bw_pd_bond *pd, bw_pd_contact *c)
{
  for (size_t q = 0; q < c->n_sent; q++)
    bw_pd_contact__position(pd, (size_t)c->sent[q], c->send + 3 * q);
  for (size_t b = 0; b < c->n_busy; b++) {
    const size_t q = (size_t)c->busy[b];
    bw_pd_contact__position(pd, (size_t)c->mine[q], c->y + 3 * q);
  }
  bw_exchange_forward(c->plan, 3 * sizeof(double), c->send, c->y + 3 * c->n_mine);
}

bw_status bw_pd_bond__contact_update(bw_pd_bond *pd)
{
  bw_pd_contact *c = pd->contact;
  int64_t needed = !c->built || moved(pd, c);
  bw_comm_max_int(pd->comm, 1, &needed);
  if (needed) {
    BW_TRY(bw_pd_contact__search(pd));
    remember(pd, c);
  }
  positions(pd, c);
  return bw_pd_contact__wall_update(pd);
}

double bw_pd_contact__repel(bw_pd_law *w, const double d[3], double r2, double sum[3])
{
  const double r = sqrt(r2);
  if (!(r2 < w->reach * w->reach) || r == 0) return 0;
  w->closest = fmin(w->closest, r / w->reach);
  const double f = w->k * (w->reach / r - 1) / r;
  for (int k = 0; k < 3; k++)
    sum[k] -= f * d[k];
  return 0.5 * w->k * (w->reach * log(w->reach / r) - w->reach + r);
}

/* The lanes `near` of a slot with bonds x; reach: in a cloud of each bond. */
static double short_bonds(bw_pd_bond *pd, bw_pd_law *w, const bw_pd_block *block,
                          const bw_pd_slot *slot, unsigned near, const bond *x, vec reach2,
                          bool force)
{
  double energy = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(near >> lane & 1)) continue;
    if (pd->kind[pd->occupant[slot->base + lane]] & BW_PD_RETIRED) continue;
    double sum[3] = {0};
    const double d[3] = {(double)x->z[0][lane], (double)x->z[1][lane], (double)x->z[2][lane]};
    bw_pd_law one = {sqrt((double)reach2[lane]), w->k, w->closest};
    energy += bw_pd_contact__repel(&one, d, (double)x->r2[lane], sum);
    w->closest = one.closest;
    const int32_t h = bw_pd_bond__owner(block, lane);
    for (int k = 0; force && k < 3; k++)
      pd->extra[k][h] += (bw_real)sum[k];
  }
  return energy;
}

/* Broken bonds of a block that are short. */
static double block_contact(bw_pd_bond *pd, bw_pd_law *w, const bw_pd_block *block, bool force)
{
  const sweep all = sweep_of(pd);
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(&all, block, 3, cloud);
  double energy = 0;
  for (uint32_t q = block->slot; q < bw_pd_bond__slot_end(block); q++) {
    const bw_pd_slot *slot = &pd->slot[q];
    if (slot->family == slot->mask) continue;
    const bw_real *row = pd->stencil.row + slot->direction * BW_PD_ROW;
    const bond x = bond_of(&all, slot, row, &h, 3, cloud);
    vec reach2 = vec_all((bw_real)(w->reach * w->reach));
    if (cloud) reach2 = vec_least(reach2, x.rest2);
    const unsigned near =
        (unsigned)(slot->family & ~slot->mask & ~block->gone) & lanes_bits(vec_above(reach2, x.r2));
    if (near != 0) energy += short_bonds(pd, w, block, slot, near, &x, reach2, force);
  }
  return energy;
}

static double family_contact(bw_pd_bond *pd, bw_pd_law *w, bool force)
{
  double energy = 0;
  for (size_t b = 0; b < pd->n_block; b++)
    if (pd->block[b].broken) energy += block_contact(pd, w, &pd->block[b], force);
  return energy;
}

static double other_contact(bw_pd_bond *pd, bw_pd_law *w, bool force)
{
  const bw_pd_contact *c = pd->contact;
  double energy = 0;
  for (size_t b = 0; b < c->n_busy; b++) {
    const size_t q = (size_t)c->busy[b];
    double sum[3] = {0}, d[3];
    for (size_t p = c->pair_start[q]; p < c->pair_start[q + 1]; p++) {
      bw_pd_contact__difference(pd, c->y + 3 * q, c->y + 3 * (size_t)c->pair[p], d);
      energy += bw_pd_contact__repel(w, d, d[0] * d[0] + d[1] * d[1] + d[2] * d[2], sum);
    }
    for (int k = 0; force && k < 3; k++)
      for (int a = 0; a < 3; a++) /* back from lattice axes */
        pd->extra[k][c->mine[q]] += (bw_real)(pd->config.axes[a][k] * sum[a]);
  }
  return energy;
}

double bw_pd_contact__stiffness(const bw_pd_bond *pd)
{
  return K_CONTACT * pd->c0 * pd->dv / pd->config.rho;
}

static bw_pd_law law_of(const bw_pd_bond *pd)
{
  return (bw_pd_law){pd->config.ds, bw_pd_contact__stiffness(pd), pd->contact->closest};
}

void bw_pd_bond__contact_force(bw_pd_bond *pd)
{
  bw_pd_law w = law_of(pd);
  family_contact(pd, &w, true);
  other_contact(pd, &w, true);
  bw_pd_contact__wall_act(pd, &w, true);
  pd->contact->closest = w.closest;
}

double bw_pd_bond__contact_energy(bw_pd_bond *pd)
{
  bw_pd_law w = law_of(pd);
  const double energy = family_contact(pd, &w, false) + other_contact(pd, &w, false) +
                        bw_pd_contact__wall_act(pd, &w, false);
  return energy * pd->config.rho * pd->dv;
}
