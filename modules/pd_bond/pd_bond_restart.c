/* What a checkpoint holds. */
#include "pd_bond_contact.h"

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
  for (size_t q = 0; pd->contact != NULL && q < pd->contact->n_near; q++)
    pd->contact->near[q].held = true; /* to be looked at again */
  if (!pd->restored) pd->current = false;
  return BW_OK;
}

void bw_pd_bond_get_restart(const bw_pd_bond *pd, double rows[], double sums[])
{
  for (size_t i = 0; i < pd->n; i++) {
    double *row = rows + BW_PD_RESTART_ROW * i;
    for (size_t k = 0; k < 3; k++) {
      row[k] = (double)pd->u[k][pd->place[i]];
      row[3 + k] = (double)pd->v[k][i];
      row[6 + k] = (double)(pd->a[k][i] + pd->extra[k][i]);
      row[9 + k] = (double)pd->damp[k][i];
    }
    row[BW_PD_RESTART_ROW - 1] = (pd->kind[i] & BW_PD_RETIRED) != 0;
  }
  const double mine[BW_PD_RESTART_SUMS] = {
      pd->done_damping,  pd->done_fracture, pd->done_external, (double)pd->precracked,
      pd->done_retired,  pd->done_wall[0],  pd->done_wall[1],  pd->done_wall[2],
      pd->wall_force[0], pd->wall_force[1], pd->wall_force[2]};
  memcpy(sums, mine, sizeof mine);
  bw_comm_sum(pd->comm, BW_PD_RESTART_SUMS, sums);
}

/* The sums of all ranks are the first one's. */
static void set_sums(bw_pd_bond *pd, const double sums[])
{
  const double own = bw_comm_rank(pd->comm) == 0;
  pd->done_damping = own * sums[0];
  pd->done_fracture = own * sums[1];
  pd->done_external = own * sums[2];
  pd->precracked = (int64_t)(own * sums[3]);
  pd->done_retired = own * sums[4];
  for (int k = 0; k < 3; k++) {
    pd->done_wall[k] = own * sums[5 + k];
    pd->wall_force[k] = own * sums[8 + k];
  }
}

bw_status bw_pd_bond_set_restart(bw_pd_bond *pd, const double rows[], const double sums[])
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
  bw_pd_bond__retire_rows(pd, rows);
  set_sums(pd, sums);
  bw_pd_bond__refresh(pd, true);
  pd->current = pd->restored = true;
  pd->loaded = pd->config.contact || bw_pd_bond__damped(pd);
  return BW_OK;
}
