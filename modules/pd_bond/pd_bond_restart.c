/* What a checkpoint holds. */
#include "pd_bond_internal.h"

#include <string.h>

size_t bw_pd_bond_bits_bytes(const bw_pd_bond *pd)
{
  return ((size_t)pd->stencil.n + 7) / 8;
}

void bw_pd_bond_get_bits(const bw_pd_bond *pd, uint8_t bits[])
{
  const size_t bytes = bw_pd_bond_bits_bytes(pd);
  memset(bits, 0, pd->n * bytes);
  for (size_t b = 0; b < pd->n_block; b++)
    for (uint32_t q = pd->block[b].slot; q < pd->block[b + 1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if (pd->slot[q].mask >> lane & 1) {
          const size_t h = (size_t)bw_pd_bond__owner(&pd->block[b], lane);
          const int d = pd->slot[q].direction;
          bits[h * bytes + (size_t)d / 8] |= (uint8_t)(1u << d % 8);
        }
}

bw_status bw_pd_bond_set_bits(bw_pd_bond *pd, const uint8_t bits[])
{
  const size_t bytes = bw_pd_bond_bits_bytes(pd);
  for (size_t b = 0; b < pd->n_block; b++) {
    pd->block[b].broken = false;
    for (uint32_t q = pd->block[b].slot; q < pd->block[b + 1].slot; q++) {
      bw_pd_slot *slot = &pd->slot[q];
      slot->mask = 0;
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        if (!(slot->family >> lane & 1)) continue;
        const size_t h = (size_t)bw_pd_bond__owner(&pd->block[b], lane);
        const int d = slot->direction;
        if (bits[h * bytes + (size_t)d / 8] >> d % 8 & 1) slot->mask |= (uint8_t)(1u << lane);
      }
      if (slot->mask != slot->family) pd->block[b].broken = true;
    }
  }
  pd->events++;
  if (!pd->restored) pd->current = false;
  return BW_OK;
}

void bw_pd_bond_get_restart(const bw_pd_bond *pd, double rows[], double sums[4])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++) {
      double *row = rows + BW_PD_RESTART_ROW * i + k;
      row[0] = (double)pd->u[k][pd->place[i]];
      row[3] = (double)pd->v[k][i];
      row[6] = (double)(pd->a[k][i] + pd->extra[k][i]);
      row[9] = (double)pd->damp[k][i];
    }
  double mine[4] = {pd->done_damping, pd->done_fracture, pd->done_external, (double)pd->precracked};
  bw_comm_sum(pd->comm, 4, mine);
  for (int q = 0; q < 4; q++)
    sums[q] = mine[q];
}

bw_status bw_pd_bond_set_restart(bw_pd_bond *pd, const double rows[], const double sums[4])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const double *row = rows + BW_PD_RESTART_ROW * i + k;
      pd->u[k][pd->place[i]] = (bw_real)row[0];
      pd->v[k][i] = (bw_real)row[3];
      pd->a[k][i] = (bw_real)row[6];
      pd->damp[k][i] = (bw_real)row[9]; /* for the book: that of Verlet is of the half step */
      pd->extra[k][i] = 0;              /* inside a */
    }
  bw_pd_bond__adopt_prescribed(pd);
  const bool first = bw_comm_rank(pd->comm) == 0;
  pd->done_damping = first ? sums[0] : 0;
  pd->done_fracture = first ? sums[1] : 0;
  pd->done_external = first ? sums[2] : 0;
  pd->precracked = first ? (int64_t)sums[3] : 0;
  bw_pd_bond__refresh(pd, true);
  pd->current = pd->restored = true;
  pd->loaded = pd->config.contact || bw_pd_bond__damped(pd);
  return BW_OK;
}
