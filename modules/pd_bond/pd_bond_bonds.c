/* Damage, bonds one by one, and values of the copies. */
#include "pd_bond_internal.h"

#include <string.h>

void bw_pd_bond_get_damage(const bw_pd_bond *pd, double damage[])
{
  for (size_t b = 0; b < pd->n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(pd->block[b].mask >> lane & 1)) continue;
      double family = 0, intact = 0;
      for (uint32_t q = pd->block[b].slot; q < pd->block[b + 1].slot; q++) {
        if (!(pd->slot[q].family >> lane & 1)) continue;
        const double gamma = bw_pd_bond__rest(pd, pd->slot[q].direction, pd->block[b].first + lane,
                                              pd->slot[q].base + lane)
                                 .fraction;
        family += gamma;
        if (pd->slot[q].mask >> lane & 1) intact += gamma;
      }
      damage[bw_pd_bond__owner(&pd->block[b], lane)] = family > 0 ? 1 - intact / family : 0;
    }
}

int bw_pd_bond_max_family(const bw_pd_bond *pd)
{
  return pd->stencil.n;
}

/* The block of own particle h: the last that starts at or before it. */
static size_t block_of(const bw_pd_bond *pd, size_t h)
{
  size_t low = 0, high = pd->n_block;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if ((size_t)pd->block[middle].own <= h)
      low = middle;
    else
      high = middle;
  }
  return low;
}

int bw_pd_bond_links(const bw_pd_bond *pd, size_t h, bw_pd_bond_link link[])
{
  const bw_pd_block *block = &pd->block[block_of(pd, h)];
  const int lane = pd->place[h] - block->first;
  int n = 0;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->slot[q];
    if (!(slot->family >> lane & 1)) continue;
    link[n++] = (bw_pd_bond_link){.neighbour = pd->occupant[slot->base + lane],
                                  .slot = (int16_t)slot->direction,
                                  .intact = (slot->mask >> lane & 1) != 0};
  }
  return n;
}

const double *bw_pd_bond_stencil_offset(const bw_pd_bond *pd, int slot)
{
  return pd->stencil.xi + 3 * slot;
}

double bw_pd_bond_stencil_fraction(const bw_pd_bond *pd, int slot)
{
  return pd->stencil.fraction[slot];
}

void bw_pd_bond_get_place(const bw_pd_bond *pd, size_t extended, double X0[3])
{
  bw_pd_bond__reference(pd, extended, X0);
}

bw_pd_bond_extended bw_pd_bond_get_extended(bw_pd_bond *pd)
{
  double X[3];
  if (!pd->current) bw_pd_bond__refresh(pd, false);
  for (size_t e = 0; e < pd->n_extended; e++) {
    bw_pd_bond__reference(pd, e, X);
    for (size_t k = 0; k < 3; k++)
      pd->extended_X[3 * e + k] = (bw_real)(X[k] + (double)pd->u[k][pd->place[e]]);
  }
  return (bw_pd_bond_extended){.n = pd->n_extended, .id = pd->id, .X = pd->extended_X};
}

bw_pd_bond_motion bw_pd_bond_get_motion(bw_pd_bond *pd, bool velocity)
{
  if (velocity || !pd->current) bw_pd_bond__refresh(pd, velocity);
  bw_pd_bond_motion m = {.place = pd->place};
  for (int k = 0; k < 3; k++) {
    m.u[k] = pd->u[k];
    m.v[k] = velocity ? pd->vs[k] : NULL;
  }
  return m;
}

/* In pieces that fit the halo's buffers: nothing is allocated here. */
void bw_pd_bond_fill_extended(bw_pd_bond *pd, size_t bytes, const void *own, void *all)
{
  unsigned char *to = all, *reply = (unsigned char *)pd->reply;
  unsigned char *answer = (unsigned char *)pd->answer;
  const size_t room = 6 * sizeof(bw_real), copies = pd->n_extended - pd->n;
  if (all != own) memmove(all, own, pd->n * bytes);
  for (size_t at = 0; at < bytes; at += room) {
    const size_t piece = bytes - at < room ? bytes - at : room;
    for (size_t q = 0; q < pd->n_asked; q++)
      memcpy(reply + q * piece, to + (size_t)pd->asked[q] * bytes + at, piece);
    bw_exchange_backward(pd->halo, piece, reply, answer);
    for (size_t c = 0; c < copies; c++)
      memcpy(to + (pd->n + c) * bytes + at, answer + c * piece, piece);
  }
}

/* In bw_real: that is what the halo's buffers hold. */
void bw_pd_bond_sum_extended(bw_pd_bond *pd, double *all)
{
  const size_t copies = pd->n_extended - pd->n;
  for (size_t c = 0; c < 3 * copies; c++)
    pd->answer[c] = (bw_real)all[3 * pd->n + c];
  bw_exchange_forward(pd->halo, 3 * sizeof(bw_real), pd->answer, pd->reply);
  for (size_t q = 0; q < pd->n_asked; q++)
    for (size_t k = 0; k < 3; k++)
      all[3 * (size_t)pd->asked[q] + k] += (double)pd->reply[3 * q + k];
}
