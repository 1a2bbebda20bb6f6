/* Who is near a jump between levels, and what is asked of its bonds.
 *
 * Conditions are of three kinds. A particle whose family is whole wants no force under any uniform
 * strain: all cubics of A vanish. Of one that misses cells, with the surface correction `tensor`,
 * only the harmonics have to, as in pd_bond_tensor.c: what is left is what a traction on its face
 * needs; and of its neighbours, which bear a share of that. Without that correction it is left as
 * faces are left, and held particles want nothing. */
#include "bw_memory.h"
#include "pd_bond_levels.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

/* Exponents of the monomials of degree 3, x^3 first; returns how many. */
static int monomials(int dimension, int power[BW_PD_BOND_CUBICS][3])
{
  int n = 0;
  for (int a = 3; a >= 0; a--)
    for (int b = 3 - a; b >= 0; b--) {
      if (dimension == 2 && a + b < 3) continue;
      power[n][0] = a, power[n][1] = b, power[n][2] = 3 - a - b;
      n++;
    }
  return n;
}

int bw_pd_bond__cubics(int dimension)
{
  int power[BW_PD_BOND_CUBICS][3];
  return monomials(dimension, power);
}

/* Tables of directions: monomials and pull. */
static bw_status tables(bw_pd_bond_zone *z)
{
  const bw_pd_body *pd = z->pd;
  int power[BW_PD_BOND_CUBICS][3];
  z->cubics = monomials(pd->dimension, power);
  for (int l = 0; l <= pd->finest; l++) {
    const bw_pd_level *level = &pd->level[l];
    const bw_pd_stencil *s = &level->stencil;
    BW_TRY(BW_ALLOCATE(&z->cubic[l], (size_t)(s->n * z->cubics)));
    BW_TRY(BW_ALLOCATE(&z->pull[l], (size_t)s->n));
    for (int q = 0; q < s->n; q++) {
      const bw_pd_level *other = &pd->level[s->other[q]];
      /* Numbers of order 1: over the micromodulus and the volume of level 0. */
      z->pull[l][q] = (bw_real)(s->fraction[q] * bw_pd_level_coarser(level, other)->stiff *
                                other->dv / pd->level->dv);
      for (int k = 0; k < z->cubics; k++) {
        double x = 1;
        for (int d = 0; d < 3; d++)
          x *= pow(s->offset[3 * q + d] * s->unit / s->r0[q], power[k][d]);
        z->cubic[l][q * z->cubics + k] = (bw_real)x;
      }
    }
  }
  return BW_OK;
}

/* Who has a bond across a jump has all that is needed among its bonds to others of these; a wider
 * zone makes the factors no better (validation/pd_bond/levels_patch.c, levels_reflection.c). */
static bw_status find(bw_pd_bond_zone *z)
{
  const bw_pd_body *pd = z->pd;
  BW_TRY(bw_comm_agree(pd->comm, bw_pd_body_storage_array(pd->points.n_storage, &z->near)));
  bw_pd_body_near_jumps(pd, z->near);
  return BW_OK;
}

static bw_status list_rows(bw_pd_bond_zone *z, const bw_pd_bond_change *change)
{
  const bw_pd_body *pd = z->pd;
  BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &z->cut));
  BW_TRY(BW_ALLOCATE(&z->row, pd->n));
  BW_TRY(BW_ALLOCATE(&z->particle, pd->n));
  for (size_t i = 0; i < pd->n; i++) {
    z->row[i] = -1;
    const int32_t place = pd->points.place[i];
    if (!(z->near[place] > 0) || (change != NULL && !(change->near[place] > 0))) continue;
    z->particle[z->rows] = (int32_t)i;
    z->row[i] = (int32_t)z->rows++;
  }
  const size_t numbers = (size_t)(z->cubics * z->cubics);
  BW_TRY(BW_ALLOCATE(&z->white, z->rows * numbers));
  for (int k = 0; k < z->cubics; k++)
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &z->mu[k]));
  return BW_OK;
}

/* Room for the factors of the blocks near a jump. */
static bw_status room(bw_pd_bond_zone *z)
{
  bw_pd_bonds *bonds = &z->pd->bonds;
  bw_release(&bonds->exact);
  BW_TRY(bw_pd_body_jump_room(z->pd, z->near));
  BW_TRY(BW_ALLOCATE(&bonds->exact, bonds->n_exact * BW_PD_LANES));
  return BW_ALLOCATE(&z->free, bonds->n_exact);
}

/* The factors that there are, and which of them may change: those between two near particles. */
void bw_pd_bond__zone_begin(bw_pd_bond_zone *z)
{
  bw_pd_body *pd = z->pd;
  bw_pd_bonds *bonds = &pd->bonds;
  for (size_t b = 0; b < bonds->n_block; b++) {
    const bw_pd_block *block = &bonds->block[b];
    for (uint32_t q = block->slot; q < block[1].slot && block->exact >= 0; q++) {
      const size_t row = (size_t)block->exact + (q - block->slot);
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        /* In the units of the row's stiffness: 1, or whole numbers of the tensor's. */
        const size_t at = (size_t)q * BW_PD_LANES + (size_t)lane;
        bonds->exact[row * BW_PD_LANES + (size_t)lane] =
            bonds->factor != NULL ? (bw_real)bonds->factor[at] : 1;
        const bool both = (bonds->slot[q].family >> lane & 1) && z->near[block->first + lane] > 0 &&
                          z->near[bonds->slot[q].base + lane] > 0;
        if (both) z->free[row] |= (uint8_t)(1u << lane);
      }
    }
  }
}

/* cut of the neighbours of those that are cut, too. Collective. */
static bw_status widen(bw_pd_bond_zone *z)
{
  const bw_pd_body *pd = z->pd;
  bw_real *before = NULL;
  BW_TRY(bw_comm_agree(pd->comm, bw_pd_body_storage_array(pd->points.n_storage, &before)));
  memcpy(before, z->cut, pd->points.n_storage * sizeof *before);
  bw_pd_body_mark_near(pd, before, z->cut);
  bw_pd_body_fill_places(pd, z->cut);
  bw_pd_body_release_storage_array(&before);
  return BW_OK;
}

/* Harmonics of degree 3 as sums of monomials; returns how many. */
static int harmonics(int dimension, double h[][BW_PD_BOND_CUBICS])
{
  int power[BW_PD_BOND_CUBICS][3], n = 0;
  const int cubics = monomials(dimension, power);
  memset(h, 0, BW_PD_BOND_CUBICS * sizeof *h);
  for (int p = 0; p < dimension; p++) {
    /* p (p^2 - 3 q^2) in the plane; p (2 p^2 - 3 q^2 - 3 r^2) and p (q^2 - r^2) in space. */
    const int q = (p + 1) % dimension, r = dimension == 3 ? (p + 2) % 3 : -1;
    for (int k = 0; k < cubics; k++) {
      if (power[k][p] == 3) h[n][k] = dimension == 3 ? 2 : 1;
      if (power[k][p] == 1 && power[k][q] == 2) h[n][k] = -3;
      if (r >= 0 && power[k][p] == 1 && power[k][r] == 2) h[n][k] = -3;
      if (r >= 0 && power[k][p] == 1 && power[k][q] == 2) h[n + 3][k] = 1;
      if (r >= 0 && power[k][p] == 1 && power[k][r] == 2) h[n + 3][k] = -1;
      if (r >= 0 && power[k][0] == 1 && power[k][1] == 1 && power[k][2] == 1) h[6][k] = 1;
    }
    n++;
  }
  return dimension == 3 ? 7 : 2;
}

/* white = D^-1/2 U^T C of the conditions C (m, cubics), where C G C^T = U D U^T; rows that follow
 * from the others are 0. */
static bw_status whiten(int cubics, int m, double C[][BW_PD_BOND_CUBICS], const double G[],
                        double white[])
{
  double S[BW_PD_BOND_CUBICS * BW_PD_BOND_CUBICS] = {0}, U[BW_PD_BOND_CUBICS * BW_PD_BOND_CUBICS];
  double D[BW_PD_BOND_CUBICS];
  for (int a = 0; a < m; a++)
    for (int b = 0; b < m; b++)
      for (int p = 0; p < cubics; p++)
        for (int q = 0; q < cubics; q++)
          S[a * m + b] += C[a][p] * G[p * cubics + q] * C[b][q];
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc((size_t)m);
  BW_REQUIRE(work != NULL, BW_EMEM, "solid: no memory for an eigenvalue problem of %d", m);
  gsl_matrix_view matrix = gsl_matrix_view_array(S, (size_t)m, (size_t)m);
  gsl_matrix_view vectors = gsl_matrix_view_array(U, (size_t)m, (size_t)m);
  gsl_vector_view values = gsl_vector_view_array(D, (size_t)m);
  gsl_eigen_symmv(&matrix.matrix, &values.vector, &vectors.matrix, work);
  gsl_eigen_symmv_free(work);
  double most = 0;
  for (int a = 0; a < m; a++)
    most = fmax(most, D[a]);
  for (int a = 0; a < m; a++)
    for (int q = 0; q < cubics && D[a] > 1e-9 * most; q++)
      for (int b = 0; b < m; b++)
        white[a * cubics + q] += U[b * m + a] * C[b][q] / sqrt(D[a]);
  return BW_OK;
}

/* Gram matrix of the cubics over the bonds that may change. */
static void gram(const bw_pd_bond_zone *z, const bw_pd_block *block, int lane, double G[])
{
  const bw_pd_body *pd = z->pd;
  const int n = z->cubics;
  memset(G, 0, (size_t)(n * n) * sizeof *G);
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const size_t row = (size_t)block->exact + (q - block->slot);
    if (!(z->free[row] >> lane & 1)) continue;
    const int d = pd->bonds.slot[q].direction;
    const bw_real *f = z->cubic[block->level] + d * n;
    const double w = (double)z->pull[block->level][d];
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        G[a * n + b] += w * w * (double)f[a] * (double)f[b];
  }
}

bw_status bw_pd_bond__conditions(bw_pd_bond_zone *z)
{
  const bw_pd_body *pd = z->pd;
  const int n = z->cubics;
  double all[BW_PD_BOND_CUBICS][BW_PD_BOND_CUBICS] = {{0}};
  double some[BW_PD_BOND_CUBICS][BW_PD_BOND_CUBICS];
  double G[BW_PD_BOND_CUBICS * BW_PD_BOND_CUBICS];
  const bool faces = pd->bonds.factor != NULL;
  const int harmonic = harmonics(pd->dimension, some);
  memset(z->white, 0, z->rows * (size_t)(n * n) * sizeof *z->white);
  for (int k = 0; k < n; k++)
    all[k][k] = 1;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    for (int lane = 0; lane < BW_PD_LANES && block->exact >= 0; lane++) {
      if (!(block->mask >> lane & 1)) continue;
      const int32_t i = bw_pd_body_owner(block, lane), r = z->row[i];
      if (r < 0 || (pd->points.kind[i] & BW_PD_PRESCRIBED)) continue;
      const bool cut = z->cut[block->first + lane] > 0;
      if (cut && !faces) continue;
      gram(z, block, lane, G);
      BW_TRY(whiten(n, cut ? harmonic : n, cut ? some : all, G,
                    z->white + (size_t)r * (size_t)(n * n)));
    }
  }
  return BW_OK;
}

bw_status bw_pd_bond__zone(bw_pd_body *pd, const bw_pd_bond_change *change, bw_pd_bond_zone *z)
{
  z->pd = pd;
  bw_status st = bw_comm_agree(pd->comm, tables(z));
  if (st == BW_OK) st = find(z);
  BW_THEN(st, list_rows(z, change));
  BW_THEN(st, room(z));
  st = bw_comm_agree(pd->comm, st);
  if (st != BW_OK) return st;
  bw_pd_bond__zone_begin(z);
  z->all = (int64_t)z->rows;
  bw_comm_sum_int(pd->comm, 1, &z->all);
  BW_TRY(bw_pd_body_cut_families(pd, z->cut));
  return pd->bonds.factor != NULL ? widen(z) : BW_OK;
}

void bw_pd_bond__zone_release(bw_pd_bond_zone *z)
{
  for (int l = 0; l <= BW_PD_FINEST; l++) {
    bw_release(&z->cubic[l]);
    bw_release(&z->pull[l]);
  }
  for (int k = 0; k < BW_PD_BOND_CUBICS; k++)
    bw_pd_body_release_storage_array(&z->mu[k]);
  bw_pd_body_release_storage_array(&z->near);
  bw_pd_body_release_storage_array(&z->cut);
  bw_release(&z->particle);
  bw_release(&z->row);
  bw_release(&z->white);
  bw_release(&z->free);
}
