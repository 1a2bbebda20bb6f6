/* Particles that have left the mechanics: they move on, no force acts on them or comes from them.
 */
#include "pd_bond_contact.h"

/* Everything that follows from the kinds of the own particles. */
static void renew(bw_pd_bond *pd)
{
  pd->n_retired = 0;
  for (size_t i = 0; i < pd->n; i++) {
    pd->mobile[i] = (pd->kind[i] & (BW_PD_PRESCRIBED | BW_PD_RETIRED)) == 0;
    if (pd->kind[i] & BW_PD_RETIRED) pd->retired[pd->n_retired++] = (int32_t)i;
  }
  for (size_t b = 0; b < pd->n_block; b++) {
    bw_pd_block *block = &pd->block[b];
    block->gone = 0;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask >> lane & 1 && pd->kind[bw_pd_bond__owner(block, lane)] & BW_PD_RETIRED)
        block->gone |= (uint8_t)(1u << lane);
  }
  bw_pd_bond_fill_extended(pd, 1, pd->kind, pd->kind);
  if (pd->contact != NULL) pd->contact->built = false;
}

void bw_pd_bond__still_retired(bw_pd_bond *pd)
{
  for (int k = 0; k < pd->dimension; k++)
    for (size_t q = 0; q < pd->n_retired; q++) {
      const int32_t i = pd->retired[q];
      pd->a[k][i] = pd->extra[k][i] = pd->damp[k][i] = 0;
    }
}

/* Energy of the bonds of the block's lanes that are retired now and were not before. */
static double stored(const bw_pd_bond *pd, const bw_pd_block *block, const bool gone[])
{
  uint8_t fresh = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if ((block->mask & ~block->gone) >> lane & 1) {
      const int32_t i = bw_pd_bond__owner(block, lane);
      if (gone[i] && !(pd->kind[i] & BW_PD_PRESCRIBED)) fresh |= (uint8_t)(1u << lane);
    }
  return fresh == 0 ? 0 : bw_pd_bond__elastic_of(pd, block, fresh);
}

bw_status bw_pd_bond_retire(bw_pd_bond *pd, const bool gone[])
{
  if (!pd->current) bw_pd_bond__refresh(pd, false);
  for (size_t b = 0; b < pd->n_block; b++)
    pd->done_retired += stored(pd, &pd->block[b], gone);
  for (size_t i = 0; i < pd->n; i++)
    if (gone[i] && !(pd->kind[i] & BW_PD_PRESCRIBED)) pd->kind[i] |= BW_PD_RETIRED;
  renew(pd);
  return bw_comm_agree(pd->comm, bw_pd_bond__evaluate(pd, false));
}

void bw_pd_bond__retire_rows(bw_pd_bond *pd, const double rows[])
{
  int64_t changed = 0;
  for (size_t i = 0; i < pd->n; i++) {
    const bool gone = rows[BW_PD_RESTART_ROW * i + BW_PD_RESTART_ROW - 1] != 0;
    const uint8_t kind = (uint8_t)((pd->kind[i] & ~BW_PD_RETIRED) | (gone ? BW_PD_RETIRED : 0));
    changed |= kind != pd->kind[i];
    pd->kind[i] = kind;
  }
  bw_comm_max_int(pd->comm, 1, &changed);
  if (changed) renew(pd);
}
