#include "pd_bond_internal.h"

void bw_pd_bond_get_broken(const bw_pd_bond *pd, uint16_t broken[])
{
  for (size_t b = 0; b < pd->n_block; b++) {
    uint16_t lost[BW_PD_LANES] = {0};
    for (uint32_t q = pd->block[b].slot; q < pd->block[b + 1].slot; q++) {
      const unsigned gone = (unsigned)(pd->slot[q].family & ~pd->slot[q].mask);
      if (gone == 0) continue; /* nearly always */
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        lost[lane] = (uint16_t)(lost[lane] + (gone >> lane & 1u));
    }
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (pd->block[b].mask >> lane & 1)
        broken[bw_pd_bond__owner(&pd->block[b], lane)] = lost[lane];
  }
}
