/* Who is near a jump between levels, which families miss cells, and sums over these particles. */
#include "pd_jump.h"
#include "bw_memory.h"

#include <math.h>
#include <string.h>

void bw_pd_body_mark_near(const bw_pd_body *pd, const bw_real before[], bw_real near[])
{
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    const bw_pd_block *block = &pd->bonds.block[b];
    const int same = bw_pd_body_level_of(pd, block)->stencil.same;
    for (uint32_t q = block->slot; q < block[1].slot; q++) {
      const bw_pd_slot *slot = &pd->bonds.slot[q];
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if ((slot->family >> lane & 1) &&
            (before == NULL ? slot->direction >= same : before[slot->base + lane] > 0))
          near[block->first + lane] = 1;
    }
  }
}

void bw_pd_body_near_jumps(const bw_pd_body *pd, bw_real near[])
{
  bw_pd_body_mark_near(pd, NULL, near);
  /* Copies follow their owners, so that all ranks find the same. */
  bw_pd_body_fill_places(pd, near);
}

static bool touches(const bw_pd_block *block, const bw_real near[])
{
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if ((block->mask >> lane & 1) && near[block->first + lane] > 0) return true;
  return false;
}

bw_status bw_pd_body_jump_room(bw_pd_body *pd, const bw_real near[])
{
  bw_pd_bonds *bonds = &pd->bonds;
  bonds->n_exact = 0;
  for (size_t b = 0; b < bonds->n_block; b++) {
    bw_pd_block *block = &bonds->block[b];
    block->exact = -1;
    if (!touches(block, near)) continue;
    BW_REQUIRE(bonds->n_exact + (block[1].slot - block->slot) < INT32_MAX / BW_PD_LANES, BW_EINPUT,
               "solid: too many bonds near jumps between levels on one rank; use more ranks");
    block->exact = (int32_t)bonds->n_exact;
    bonds->n_exact += block[1].slot - block->slot;
  }
  return BW_OK;
}

/* Cells of a family's own lattice, by offsets from the owner. */
typedef struct {
  int reach, side;
  bool *covered; /* (side^3) */
} cover;

static void put(cover *c, int dimension, const int cell[3])
{
  for (int k = 0; k < dimension; k++)
    if (cell[k] < -c->reach || cell[k] > c->reach) return;
  const int r = c->reach;
  c->covered[(cell[0] + r) + c->side * ((cell[1] + r) + c->side * (cell[2] + r))] = true;
}

/* The cells of the owner's lattice that a partner's cell lies in or consists of. */
static void put_partner(const bw_pd_body *pd, const bw_pd_level *level, int direction, cover *c)
{
  const bw_pd_stencil *s = &level->stencil;
  const int l = (int)(level - pd->level), step = 1 << (pd->finest - l + 1);
  const int32_t *o = s->offset + 3 * direction;
  const int parts = s->other[direction] < l ? 1 << pd->dimension : 1;
  for (int part = 0; part < parts; part++) {
    int cell[3] = {0};
    for (int k = 0; k < pd->dimension; k++) {
      /* A coarser cell's parts are half a cell either way; a finer one lies within one. */
      const int x = 2 * o[k] + (parts == 1 ? 0 : part >> k & 1 ? step : -step);
      cell[k] = (int)floor((double)x / (2 * step) + 0.5);
    }
    put(c, pd->dimension, cell);
  }
}

/* Whether no cell of the own lattice's family is missing. */
static bool is_whole(const bw_pd_body *pd, const bw_pd_block *block, int lane, cover *c)
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  const bw_pd_stencil *s = &level->stencil;
  const int l = (int)(level - pd->level), step = 1 << (pd->finest - l + 1);
  memset(c->covered, 0, (size_t)(c->side * c->side * c->side) * sizeof *c->covered);
  for (uint32_t q = block->slot; q < block[1].slot; q++)
    if (pd->bonds.slot[q].family >> lane & 1)
      put_partner(pd, level, pd->bonds.slot[q].direction, c);
  for (int q = 0; q < s->same; q++) {
    const int32_t *o = s->offset + 3 * q;
    const int r = c->reach, x = o[0] / step + r, y = o[1] / step + r, z = o[2] / step + r;
    if (!c->covered[x + c->side * (y + c->side * z)]) return false;
  }
  return true;
}

bw_status bw_pd_body_cut_families(const bw_pd_body *pd, bw_real cut[])
{
  const bw_pd_level *finest = pd->level + pd->finest;
  cover c = {.reach = (int)ceil(finest->horizon / finest->ds + 0.5)};
  c.side = 2 * c.reach + 1;
  const bw_status st =
      bw_comm_agree(pd->comm, BW_ALLOCATE(&c.covered, (size_t)(c.side * c.side * c.side)));
  if (st != BW_OK) return st;
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (int lane = 0; lane < BW_PD_LANES; lane++)
      if (pd->bonds.block[b].mask >> lane & 1)
        cut[pd->bonds.block[b].first + lane] = !is_whole(pd, &pd->bonds.block[b], lane, &c);
  bw_release(&c.covered);
  bw_pd_body_fill_places(pd, cut);
  /* Level by level downwards, so that each asks the final word of the coarser one. */
  for (int l = 1; l <= pd->finest; l++) {
    for (size_t b = 0; b < pd->bonds.n_block; b++) {
      const bw_pd_block *block = &pd->bonds.block[b];
      double sum[BW_PD_LANES] = {0};
      if (block->level != l || block->exact < 0) continue;
      for (uint32_t q = block->slot; q < block[1].slot; q++) {
        const bw_pd_slot *slot = &pd->bonds.slot[q];
        const bw_pd_stencil *s = &pd->level[l].stencil;
        for (int lane = 0; lane < BW_PD_LANES; lane++)
          if ((slot->family >> lane & 1) && s->other[slot->direction] < l)
            sum[lane] += s->fraction[slot->direction] * (cut[slot->base + lane] > 0 ? 1.0 : -1.0);
      }
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if (sum[lane] > 0) cut[block->first + lane] = 1;
    }
    bw_pd_body_fill_places(pd, cut);
  }
  return BW_OK;
}

double bw_pd_body_dot(const bw_pd_body_rows_of *z, const double x[], const double y[])
{
  const size_t n = (size_t)z->columns;
  double most = 0;
  int64_t sum[2] = {0, 0};
  for (size_t i = 0; i < z->rows; i++) {
    double t = 0;
    for (size_t k = 0; k < n; k++)
      t += x[i * n + k] * y[i * n + k];
    most = fmax(most, fabs(t));
  }
  bw_comm_max(z->comm, 1, &most);
  if (!(most > 0) || !isfinite(most)) return most;
  const int bits = 60 - (int)ceil(log2((double)z->all + 1));
  const double scale = ldexp(1, bits) / most;
  for (size_t i = 0; i < z->rows; i++) {
    double t = 0;
    for (size_t k = 0; k < n; k++)
      t += x[i * n + k] * y[i * n + k];
    const double whole = rint(t * scale);
    sum[0] += (int64_t)whole;
    sum[1] += (int64_t)rint(ldexp(t * scale - whole, bits));
  }
  bw_comm_sum_int(z->comm, 2, sum);
  return ((double)sum[0] + ldexp((double)sum[1], -bits)) / scale;
}

bool bw_pd_body_above_finest(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot)
{
  return block->level < pd->finest ||
         slot->direction >= bw_pd_body_level_of(pd, block)->stencil.same;
}

void bw_pd_body_note_astray(bw_pd_body *pd, const bw_pd_block *block, uint8_t over)
{
  pd->bonds.astray += __builtin_popcount(over);
  pd->bonds.astray_id = pd->points.id[bw_pd_body_owner(block, __builtin_ctz(over))];
}
