/* Short-range repulsion (3.40 with ERRATA 3): on h, for r = |X_l - X_h| < r_c,
 *   C_h = - k_c (r_c/r - 1) e dV_l,  e from h to l,  n_c = 1, k_c = 15 c0, r_c = ds,
 * which derives from the energy k_c (r_c ln(r_c/r) - r_c + r) dV dV of a pair. In a cloud r_c of
 * two whose bond broke is not above |xi|: else neighbours nearer than ds from the start would push
 * when they part. */
#include "pd_contact.h"
#include "bw_memory.h"
#include "pd_sweep.h"

#include <math.h>

static const double SKIN =
    0.5; /* of the search, in the finest ds: a new one after a move of ds/4 */

/* A table for all pairs of kinds: no mean is taken in a step. */
static bw_status laws_of(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  c->kinds = (pd->finest + 1) * pd->config.n_group;
  bw_release(&c->law);
  BW_TRY(BW_ALLOCATE(&c->law, (size_t)c->kinds * (size_t)c->kinds));
  for (int a = 0; a < c->kinds; a++)
    for (int b = 0; b < c->kinds; b++) {
      bw_pd_pair pair = bw_pd_contact__law(pd, a, pd, b);
      pair.weight /= bw_pd_body_unit_mass(pd);
      c->law[a * c->kinds + b] = pair;
    }
  /* Two of the coarsest reach furthest; a move that counts is one of the finest. */
  c->reach = pd->level[0].ds;
  c->skin = SKIN * pd->level[pd->finest].ds;
  return BW_OK;
}

/* What is as long as the body's lists. */
static bw_status arrays_of(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  for (int k = 0; k < 3; k++) {
    bw_release(&c->u_built[k]);
    BW_TRY(BW_ALLOCATE(&c->u_built[k], pd->n));
  }
  bw_release(&c->link);
  BW_TRY(BW_ALLOCATE(&c->link, (size_t)pd->directions));
  BW_TRY(laws_of(c));
  c->revision = pd->revision;
  c->built = false;
  return BW_OK;
}

bw_status bw_pd_contact_create(bw_pd_body *pd, bw_pd_contact **out)
{
  bw_pd_contact *c = NULL;
  bw_status st = BW_ALLOCATE(&c, 1);
  if (st == BW_OK) {
    c->pd = pd;
    c->closest = INFINITY;
    st = arrays_of(c);
  }
  if (st != BW_OK) bw_pd_contact_destroy(&c);
  *out = c;
  return st;
}

void bw_pd_contact_destroy(bw_pd_contact **contact)
{
  bw_pd_contact *c = *contact;
  if (c == NULL) return;
  bw_pd_contact__release(c);
  for (int k = 0; k < 3; k++)
    bw_release(&c->u_built[k]);
  bw_release(&c->near);
  bw_release(&c->link);
  bw_release(&c->law);
  bw_release(contact);
}

void bw_pd_contact_forget(bw_pd_contact *c)
{
  c->built = false;
}

void bw_pd_contact_recheck(bw_pd_contact *c)
{
  for (size_t q = 0; q < c->n_near; q++)
    c->near[q].held = true; /* to be looked at again */
}

/* Whether an own particle moved by half the skin since the last search (NaN counts). */
static bool moved(const bw_pd_body *pd, const bw_pd_contact *c)
{
  /* Two that move towards each other by half the skin each close the whole of it. */
  const bw_real limit2 = (bw_real)(0.25 * c->skin * c->skin);
  int far = 0;
  for (size_t r = 0; r < pd->bonds.n_run; r++) {
    /* Runs are contiguous in both arrays, so that the comparison goes through whole vectors. */
    const bw_pd_run run = pd->bonds.run[r];
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

static void remember(const bw_pd_body *pd, bw_pd_contact *c)
{
  for (size_t i = 0; i < pd->n; i++)
    for (int k = 0; k < 3; k++)
      c->u_built[k][i] = pd->u[k][pd->points.place[i]];
  c->built = true;
}

/* Present positions of the particles in pairs, other ranks' too. */
static void positions(bw_pd_body *pd, bw_pd_contact *c)
{
  /* Only particles that are in pairs, here or elsewhere, are looked at. */
  for (size_t q = 0; q < c->found.n_sent; q++)
    bw_pd_contact__position(pd, (size_t)c->found.sent[q], c->found.send + 3 * q);
  for (size_t b = 0; b < c->found.n_busy; b++) {
    const size_t q = (size_t)c->found.busy[b];
    bw_pd_contact__position(pd, (size_t)c->found.mine[q], c->found.y + 3 * q);
  }
  bw_exchange_forward(c->found.plan, 3 * sizeof(double), c->found.send,
                      c->found.y + 3 * c->found.n_mine);
}

bw_status bw_pd_contact_update(bw_pd_contact *c)
{
  bw_pd_body *pd = c->pd;
  /* Another set of particles: nothing that was listed holds. */
  if (c->revision != pd->revision) BW_TRY(bw_comm_agree(pd->comm, arrays_of(c)));
  int64_t needed = !c->built || moved(pd, c);
  bw_comm_max_int(pd->comm, 1, &needed);
  if (needed) {
    BW_TRY(bw_pd_contact__search(c));
    remember(pd, c);
  }
  /* Pairs are those of the last search, positions those of now. */
  positions(pd, c);
  return bw_pd_contact__wall_update(c);
}

/* The lanes `near` of a slot with bonds x; reach: in a cloud of each bond. */
static double short_bonds(bw_pd_contact *c, const bw_pd_block *block, const bw_pd_slot *slot,
                          unsigned near, const bond *x, vec reach2, bool force)
{
  bw_pd_body *pd = c->pd;
  double energy = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(near >> lane & 1)) continue;
    /* Few lanes come here: one by one, in the order of the stencil. */
    const int32_t l = pd->points.occupant[slot->base + lane];
    if (pd->points.kind[l] & BW_PD_RETIRED) continue;
    double sum[3] = {0};
    const double d[3] = {(double)x->z[0][lane], (double)x->z[1][lane], (double)x->z[2][lane]};
    const int32_t h = bw_pd_body_owner(block, lane);
    /* In a cloud two that began nearer than r_c touch where they began. */
    bw_pd_pair pair = bw_pd_contact__pair(c, bw_pd_contact__kind(pd, (size_t)h),
                                          bw_pd_contact__kind(pd, (size_t)l));
    pair.reach = sqrt((double)reach2[lane]);
    energy += bw_pd_contact__repel(&pair, d, (double)x->r2[lane], sum);
    c->closest = pair.closest;
    for (int k = 0; force && k < 3; k++)
      pd->load.extra[k][h] += (bw_real)sum[k];
  }
  return energy;
}

/* Broken bonds of a block that are short. */
static double block_contact(bw_pd_contact *c, const bw_pd_block *block, bool force)
{
  const bw_pd_body *pd = c->pd;
  /* Displacements of copies are current: their distances are found as those of bonds. */
  const sweep all = sweep_of(pd);
  const bool cloud = pd->config.disorder > 0;
  const owners h = owners_of(&all, block, 3, cloud);
  const bw_real *rows = rows_of(&all, block);
  const bw_pd_level *own = bw_pd_body_level_of(pd, block);
  double energy = 0;
  for (uint32_t q = block->slot; q < bw_pd_body_slot_end(block); q++) {
    const bw_pd_slot *slot = &pd->bonds.slot[q];
    /* Every bond of the slot holds: joined particles do not touch. */
    if (slot->family == slot->mask) continue;
    const bond x = bond_of(&all, slot, rows + slot->direction * BW_PD_ROW, &h, 3, cloud);
    const double reach = fmin(own->ds, pd->level[own->stencil.other[slot->direction]].ds);
    vec reach2 = vec_all((bw_real)(reach * reach));
    if (cloud) reach2 = vec_least(reach2, x.rest2);
    /* Broken, not retired, and nearer than their reach. */
    const unsigned near =
        (unsigned)(slot->family & ~slot->mask & ~block->gone) & lanes_bits(vec_above(reach2, x.r2));
    if (near != 0) energy += short_bonds(c, block, slot, near, &x, reach2, force);
  }
  return energy;
}

static double family_contact(bw_pd_contact *c, bool force)
{
  const bw_pd_bonds *bonds = &c->pd->bonds;
  double energy = 0;
  for (size_t b = 0; b < bonds->n_block; b++)
    /* Whole blocks, nearly all, are not looked at. */
    if (bonds->block[b].broken) energy += block_contact(c, &bonds->block[b], force);
  return energy;
}

static double other_contact(bw_pd_contact *c, bool force)
{
  bw_pd_body *pd = c->pd;
  double energy = 0;
  for (size_t b = 0; b < c->found.n_busy; b++) {
    const size_t q = (size_t)c->found.busy[b];
    double sum[3] = {0}, d[3];
    /* Both ends list the pair, each on its rank, and get exactly opposite forces. */
    for (size_t p = c->found.pair_start[q]; p < c->found.pair_start[q + 1]; p++) {
      bw_pd_pair pair = bw_pd_contact__pair(c, c->found.kind[q], c->found.kind[c->found.pair[p]]);
      bw_pd_contact__difference(pd, c->found.y + 3 * q, c->found.y + 3 * (size_t)c->found.pair[p],
                                d);
      energy += bw_pd_contact__repel(&pair, d, d[0] * d[0] + d[1] * d[1] + d[2] * d[2], sum);
      c->closest = pair.closest;
    }
    for (int k = 0; force && k < 3; k++)
      for (int a = 0; a < 3; a++) /* back from lattice axes */
        pd->load.extra[k][c->found.mine[q]] += (bw_real)(pd->config.axes[a][k] * sum[a]);
  }
  return energy;
}

void bw_pd_contact_force(bw_pd_contact *c)
{
  /* Three kinds of partners, in an order that does not depend on ranks. */
  family_contact(c, true);
  other_contact(c, true);
  bw_pd_contact__wall_act(c, true);
}

double bw_pd_contact_energy(bw_pd_contact *c)
{
  /* By the mass of the first group on level 0, as the weights are. */
  const double energy =
      family_contact(c, false) + other_contact(c, false) + bw_pd_contact__wall_act(c, false);
  return energy * bw_pd_body_unit_mass(c->pd);
}

/* The stiffest pair against the lightest of the two: 1/w of their oscillation. */
double bw_pd_contact_time(const bw_pd_contact *c)
{
  double most = 0;
  for (int g = 0; g < c->kinds; g++)
    for (int h = 0; h < c->kinds; h++) {
      /* Two masses on one spring of stiffness k_c/r_c dV^2: w^2 is the sum of both
       * accelerations. */
      const bw_pd_pair a = bw_pd_contact__pair(c, g, h), b = bw_pd_contact__pair(c, h, g);
      most = fmax(most, (a.k + b.k) / fmin(a.reach, b.reach));
    }
  return 1 / sqrt(most);
}

double bw_pd_contact_closest(const bw_pd_contact *c)
{
  return c->closest;
}

double *bw_pd_contact_wall_force(bw_pd_contact *c)
{
  return c->wall_force;
}
