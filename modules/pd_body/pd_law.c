/* What a body asks of its law. */
#include "pd_law.h"

void bw_pd_body_internal_force(bw_pd_body *pd, bool check, bool damping)
{
  const bw_pd_law *law = pd->law;
  if (check) pd->bonds.n_hit = 0;
  /* Checks and damping need the final force: the last pass alone does them. */
  for (int pass = 0; pass < law->n_sweep; pass++) {
    const bool last = pass == law->n_sweep - 1;
    law->sweep[pass](pd, 0, pd->bonds.n_block, check && pd->breakage && last, damping && last);
    /* The next pass reads neighbours: those that others own have to be told. */
    for (int q = 0; q < pd->fields.n; q++)
      if (pd->fields.row[q].after == pass) bw_pd_body_fill_places(pd, pd->fields.row[q].value);
  }
}

bool bw_pd_body_break_hits(bw_pd_body *pd)
{
  size_t kept = 0;
  for (size_t q = 0; q < pd->bonds.n_hit; q++)
    /* A block was noted if one bond was beyond its limit; some of them may be unbreakable. */
    if (pd->law->breaks(pd, &pd->bonds.block[pd->bonds.hit[q]]))
      pd->bonds.hit[kept++] = pd->bonds.hit[q];
  pd->bonds.n_hit = kept;
  if (pd->law->n_sweep == 1) return kept > 0;
  /* What a family lost changes the force of its neighbours, too, on whichever rank: anew. */
  int64_t any = kept > 0;
  bw_comm_max_int(pd->comm, 1, &any);
  if (any) bw_pd_body_internal_force(pd, false, false);
  return kept > 0;
}

double bw_pd_body_elastic(const bw_pd_body *pd)
{
  double energy = 0;
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    /* Retired particles hold no energy: what they stored is booked already. */
    energy += pd->law->energy(pd, &pd->bonds.block[b], (uint8_t)~pd->bonds.block[b].gone);
  return energy;
}
