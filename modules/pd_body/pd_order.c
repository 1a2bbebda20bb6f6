/* Lattice order of a body of one or several levels. */
#include "bw_memory.h"
#include "bw_particles_order.h"
#include "pd_body.h"

#include <string.h>

uint8_t bw_pd_body_level_of_place(const bw_pd_body *pd, const int32_t site[3])
{
  /* An odd multiple of 2^(finest - level). */
  return (uint8_t)(pd->finest - __builtin_ctz((unsigned)site[0]));
}

/* Both site and offset are odd multiples of half a spacing, 2i + 1 and 2j + 1; centres of coarser
 * cells are odd multiples of twice that, i + j + 1. */
bool bw_pd_body_leads(const bw_pd_body *pd, int l, int direction, const int32_t site[3])
{
  const bw_pd_stencil *s = &pd->level[l].stencil;
  const int32_t *o = s->offset + 3 * direction;
  int32_t differ = (site[0] ^ o[0]) | (site[1] ^ o[1]);
  if (pd->dimension == 3) differ |= site[2] ^ o[2];
  return s->other[direction] >= l || (differ >> (pd->finest - l + 1) & 1) == 0;
}

/* Site on the lattice of its own level; along the fastest axis of a finer one even sites come
 * before odd ones, `apart` steps away. */
static void sort_key(const bw_pd_body *pd, int l, const int32_t place[3], int32_t apart,
                     int32_t key[3])
{
  for (int k = 0; k < 3; k++)
    key[k] = place[k] >> (pd->finest - l + 1);
  if (l == 0) return;
  int32_t *x = &key[pd->points.axis[0]];
  *x = (*x >> 1) + (*x & 1) * apart;
}

/* The rows of one level, in order, to order[]; `key` (n,3) is scratch, `row` (n), too. */
static bw_status order_level(const bw_pd_body *pd, int l, size_t n, const int32_t site[],
                             const uint8_t level[], int32_t *key, int32_t *row, int32_t order[],
                             size_t *done)
{
  int32_t lower[3], upper[3], *part = order + *done;
  size_t m = 0;
  bw_particles_extent(n, site, lower, upper);
  const int32_t apart = (upper[pd->points.axis[0]] - lower[pd->points.axis[0]]) / 2 + 2;
  for (size_t q = 0; q < n; q++)
    if (level[q] == l) {
      sort_key(pd, l, site + 3 * q, apart, key + 3 * m);
      row[m++] = (int32_t)q;
    }
  BW_TRY(bw_particles_lattice_order(pd->points.axis, m, key, part));
  for (size_t q = 0; q < m; q++)
    part[q] = row[part[q]];
  *done += m;
  return BW_OK;
}

bw_status bw_pd_body_order(const bw_pd_body *pd, size_t n, const int32_t site[],
                           const uint8_t level[], int32_t order[])
{
  if (pd->finest == 0) return bw_particles_lattice_order(pd->points.axis, n, site, order);
  int32_t *key = NULL, *row = NULL;
  size_t done = 0;
  bw_status st = BW_ALLOCATE(&key, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&row, n));
  for (int l = 0; l <= pd->finest && st == BW_OK; l++)
    st = order_level(pd, l, n, site, level, key, row, order, &done);
  bw_release(&key);
  bw_release(&row);
  return st;
}
