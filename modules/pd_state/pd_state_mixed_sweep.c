/* The two passes of a body of both laws: each law's own, over the blocks that it has to look at. */
#include "pd_state_mixed.h"
#include "pd_sweep.h"

#include <string.h>

const bw_pd_law *const bw_pd_state__mixed_laws[BW_PD_MIXED_LAWS] = {
    &bw_pd_state_ordinary_law, &bw_pd_state_correspondence_law};

static void swap_rows(bw_pd_body *pd, bw_pd_mixed_part *p)
{
  for (int l = 0; l <= pd->finest; l++) {
    bw_real *row = pd->level[l].row;
    pd->level[l].row = p->row[l];
    p->row[l] = row;
  }
}

bw_pd_mixed *bw_pd_state__mixed_enter(const bw_pd_body *pd, int q)
{
  bw_pd_body *body = (bw_pd_body *)pd;
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  body->state = m->part[q].state;
  swap_rows(body, &m->part[q]);
  return m;
}

void bw_pd_state__mixed_leave(const bw_pd_body *pd, bw_pd_mixed *m, int q)
{
  bw_pd_body *body = (bw_pd_body *)pd;
  m->part[q].state = body->state;
  swap_rows(body, &m->part[q]);
  body->state = m;
}

/* A pass of a law over those of the blocks that it asks for. */
static void sweep_blocks(bw_pd_body *pd, int q, int pass, const bool asked[], size_t first,
                         size_t last, bool check_limits)
{
  bw_pd_mixed *m = bw_pd_state__mixed_enter(pd, q);
  for (size_t b = first; b < last; b++) {
    size_t end = b;
    while (end < last && asked[end])
      end++;
    if (end > b) bw_pd_state__mixed_laws[q]->sweep[pass](pd, b, end, check_limits, false);
    if (end > b) b = end;
  }
  bw_pd_state__mixed_leave(pd, m, q);
}

/* The other law's particles have no B, whatever their families look like. */
static void no_stress(const bw_pd_body *pd, const bw_pd_mixed *m, size_t first, size_t last)
{
  const bw_pd_correspondence *o = m->part[BW_PD_CORRESPONDENCE_LAW].state;
  for (size_t q = first; q < last; q++) {
    const bw_pd_block *block = &pd->bonds.block[q];
    for (int lane = 0; lane < BW_PD_LANES && m->part[BW_PD_ORDINARY_LAW].holds[q]; lane++)
      for (int k = 0; k < 9; k++)
        if (block->mask >> lane & 1 &&
            bw_pd_mixed_law_at(pd, m, block->first + lane) == BW_PD_ORDINARY_LAW && o->B[k] != NULL)
          o->B[k][block->first + lane] = 0;
  }
}

void bw_pd_state__mixed_deform(bw_pd_body *pd, size_t first, size_t last, bool check_limits,
                               bool damping)
{
  (void)damping;
  const bw_pd_mixed *m = (const bw_pd_mixed *)pd->state;
  for (int q = 0; q < BW_PD_MIXED_LAWS; q++)
    sweep_blocks(pd, q, 0, m->part[q].holds, first, last, check_limits);
  no_stress(pd, m, first, last);
}

/* a of a block's owners: kept, and added to. */
static void keep(bw_pd_body *pd, bw_pd_mixed *m, const bw_pd_block *block, bool add)
{
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    if (!(block->mask >> lane & 1)) continue;
    const size_t i = bw_pd_body_owner(block, lane);
    for (int k = 0; k < 3; k++) {
      if (add)
        pd->a[k][i] += m->other[k][i];
      else
        m->other[k][i] = pd->a[k][i];
    }
  }
}

/* Blocks that either law noted, each once and in order. */
static void join_hits(bw_pd_body *pd, bw_pd_mixed *m, size_t before, size_t n_other)
{
  const size_t n = pd->bonds.n_hit - before;
  memset(m->marked, 0, pd->bonds.n_block * sizeof *m->marked);
  for (size_t q = 0; q < n_other; q++)
    m->marked[m->hit[q]] = true;
  for (size_t q = 0; q < n; q++)
    m->marked[pd->bonds.hit[before + q]] = true;
  pd->bonds.n_hit = before;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    if (m->marked[q]) pd->bonds.hit[pd->bonds.n_hit++] = (uint32_t)q;
}

void bw_pd_state__mixed_force(bw_pd_body *pd, size_t first, size_t last, bool check_limits,
                              bool damping)
{
  (void)damping;
  bw_pd_mixed *m = (bw_pd_mixed *)pd->state;
  const bool *touches[BW_PD_MIXED_LAWS] = {m->part[BW_PD_ORDINARY_LAW].touches,
                                           m->part[BW_PD_CORRESPONDENCE_LAW].touches};
  const size_t before = pd->bonds.n_hit;
  for (size_t q = first; q < last; q++)
    for (int k = 0; k < 3; k++)
      vec_put_owners(&pd->bonds.block[q], vec_all(0), pd->a[k]);
  sweep_blocks(pd, BW_PD_ORDINARY_LAW, 1, touches[BW_PD_ORDINARY_LAW], first, last, check_limits);
  for (size_t q = first; q < last; q++)
    if (touches[BW_PD_ORDINARY_LAW][q] && touches[BW_PD_CORRESPONDENCE_LAW][q])
      keep(pd, m, &pd->bonds.block[q], false);
  const size_t n_other = pd->bonds.n_hit - before;
  memcpy(m->hit, pd->bonds.hit + before, n_other * sizeof *m->hit);
  pd->bonds.n_hit = before;
  sweep_blocks(pd, BW_PD_CORRESPONDENCE_LAW, 1, touches[BW_PD_CORRESPONDENCE_LAW], first, last,
               check_limits);
  for (size_t q = first; q < last; q++)
    if (touches[BW_PD_ORDINARY_LAW][q] && touches[BW_PD_CORRESPONDENCE_LAW][q])
      keep(pd, m, &pd->bonds.block[q], true);
  if (check_limits) join_hits(pd, m, before, n_other);
}
