/* Particles that have left the mechanics: they move on, no force acts on them or comes from them.
 */
#include "solid_internal.h"

/* Everything that follows from the kinds of the own particles. */
void bw_solid__renew_kinds(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  /* Who is not pushed: prescribed, and retired. */
  s->n_retired = 0;
  for (size_t i = 0; i < pd->n; i++) {
    pd->held.mobile[i] = (pd->points.kind[i] & (BW_PD_PRESCRIBED | BW_PD_RETIRED)) == 0;
    if (pd->points.kind[i] & BW_PD_RETIRED) s->retired[s->n_retired++] = (int32_t)i;
  }
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    /* A block of which all are gone has no slots: it costs nothing any more. */
    bw_pd_block *block = &pd->bonds.block[b];
    block->gone = 0;
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (block->mask >> lane & 1 && pd->points.kind[bw_pd_body_owner(block, lane)] & BW_PD_RETIRED)
        block->gone |= (uint8_t)(1u << lane);
  }
  /* Copies of retired particles have to be known as such, so that nobody touches them. */
  bw_pd_body_fill_extended(pd, 1, pd->points.kind, pd->points.kind);
  if (s->contact != NULL) bw_pd_contact_forget(s->contact);
}

/* Energy of the bonds of the block's lanes that are retired now and were not before. */
static double stored(const bw_pd_body *pd, const bw_pd_block *block, const bool gone[])
{
  /* Booked once: who was retired before is not counted again. */
  uint8_t fresh = 0;
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if ((block->mask & ~block->gone) >> lane & 1) {
      const int32_t i = bw_pd_body_owner(block, lane);
      if (gone[i] && !(pd->points.kind[i] & BW_PD_PRESCRIBED)) fresh |= (uint8_t)(1u << lane);
    }
  return fresh == 0 ? 0 : pd->law->energy(pd, block, fresh);
}

bw_status bw_solid_retire(bw_solid *s, const bool gone[])
{
  bw_pd_body *pd = s->body;
  /* Bonds and contact hold what present places of both ends say. */
  if (!pd->current) bw_pd_body_refresh(pd, false);
  if (s->contact != NULL) BW_TRY(bw_comm_agree(pd->comm, bw_pd_contact_update(s->contact)));
  if (s->contact != NULL) s->book.retired += bw_pd_contact_energy(s->contact);
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    s->book.retired += stored(pd, &pd->bonds.block[b], gone);
  /* Energies are booked: now the kinds may change. */
  for (size_t i = 0; i < pd->n; i++)
    if (gone[i] && !(pd->points.kind[i] & BW_PD_PRESCRIBED)) pd->points.kind[i] |= BW_PD_RETIRED;
  bw_solid__renew_kinds(s);
  /* Forces anew: those of the retired are gone from everybody's. */
  BW_TRY(bw_comm_agree(pd->comm, bw_solid__evaluate(s, false)));
  /* What is left of contact was not theirs. */
  if (s->contact != NULL) s->book.retired -= bw_pd_contact_energy(s->contact);
  return BW_OK;
}

void bw_solid__retire_rows(bw_solid *s, size_t width, const double rows[])
{
  bw_pd_body *pd = s->body;
  /* A restart may have more of them, or less. */
  int64_t changed = 0;
  for (size_t i = 0; i < pd->n; i++) {
    const bool gone = (int)rows[width * i + BW_SOLID__ROW - 1] & BW_SOLID__GONE;
    const uint8_t kind =
        (uint8_t)((pd->points.kind[i] & ~BW_PD_RETIRED) | (gone ? BW_PD_RETIRED : 0));
    changed |= kind != pd->points.kind[i];
    pd->points.kind[i] = kind;
  }
  bw_comm_max_int(pd->comm, 1, &changed);
  if (changed) bw_solid__renew_kinds(s);
}
