/* The directions of a family: one fixed list of lattice offsets, x fastest. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double bw_pd_body_family_reach(const bw_pd_body_config *c)
{
  return c->horizon_ratio + (c->family_reach == BW_PD_REACH_HORIZON ? 0 : 0.5);
}

/* Whether sites at an offset are nearer than the family's reach, both moved by up to `more`/2 ds.
 * (|xi|/ds)^2 is a whole number: the margin only absorbs the rounding of m. */
static bool in_reach(const bw_pd_body_config *c, const int32_t o[3], double more)
{
  const double m = bw_pd_body_family_reach(c) + more;
  const int64_t r2 = (int64_t)o[0] * o[0] + (int64_t)o[1] * o[1] + (int64_t)o[2] * o[2];
  return r2 > 0 && (double)r2 < m * m * (1 - 1e-12);
}

/* Calls of x fastest over the cube of the reach; counts when `s->offset` is NULL. */
static int list_offsets(const bw_pd_body *pd, bw_pd_stencil *s)
{
  /* In the plane there is one layer and no offset across it. */
  const int r = s->reach, rz = pd->dimension == 3 ? r : 0;
  int n = 0;
  for (int32_t z = -rz; z <= rz; z++)
    for (int32_t y = -r; y <= r; y++)
      for (int32_t x = -r; x <= r; x++) {
        const int32_t o[3] = {x, y, z};
        if (!in_reach(&pd->config, o, 2 * pd->config.disorder)) continue;
        if (s->offset != NULL)
          for (int k = 0; k < 3; k++)
            s->offset[3 * n + k] = o[k];
        n++;
      }
  return n;
}

/* 3.33 with ERRATA 2: linear from 1 at m - 1/2 to 0 at m + 1/2. */
static double fraction_linear(double m, const double o[3])
{
  const double r = sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]);
  return fmax(0, fmin(1, m - r + 0.5));
}

bw_status bw_pd_body_fraction(const bw_pd_body *pd, double m, const double o[3], double *gamma)
{
  /* POROUS 3.33 in the plane, 3.3.5 in space, with ERRATA 2. */
  switch (pd->config.volume_fraction) {
  case BW_PD_FRACTION_LINEAR:
    *gamma = fraction_linear(m, o);
    return BW_OK;
  case BW_PD_FRACTION_EXACT:
    if (pd->dimension == 3) return bw_pd_body_fraction_volume(m, o, gamma);
    *gamma = bw_pd_body_fraction_area(m, o);
    return BW_OK;
  default:
    *gamma = 1;
    return BW_OK;
  }
}

static int compare_int(const void *a, const void *b)
{
  return *(const int32_t *)a - *(const int32_t *)b;
}

/* Offsets equal up to signs and order have the same fraction: it is computed once. */
static bw_status fractions(const bw_pd_body *pd, bw_pd_stencil *s)
{
  /* 0 is not yet known, else the fraction plus 1. */
  const int32_t side = s->reach + 1;
  double *known = NULL;
  BW_TRY(BW_ALLOCATE(&known, (size_t)(side * side * side)));
  bw_status st = BW_OK;
  for (int q = 0; q < s->n && st == BW_OK; q++) {
    int32_t o[3];
    for (int k = 0; k < 3; k++)
      o[k] = abs(s->offset[3 * q + k]);
    /* Sorted without signs: one name for all offsets of a class. */
    qsort(o, pd->dimension == 3 ? 3 : 2, sizeof *o, compare_int);
    double *memo = &known[o[0] + side * (o[1] + side * o[2])];
    if (*memo == 0) {
      const double at[3] = {o[0], o[1], o[2]};
      st = bw_pd_body_fraction(pd, pd->config.horizon_ratio, at, memo);
      *memo += 1;
    }
    s->fraction[q] = *memo - 1;
  }
  bw_release(&known);
  return st;
}

/* The direction of an offset by going through all. */
static int direction_among(const bw_pd_stencil *s, const int32_t o[3])
{
  int q = s->n - 1;
  while (q >= 0 && memcmp(s->offset + 3 * q, o, 3 * sizeof *o) != 0)
    q--;
  return q;
}

int bw_pd_body_direction(const bw_pd_stencil *s, const int32_t o[3])
{
  const int r = s->reach, side = 2 * r + 1;
  if (abs(o[0]) > r || abs(o[1]) > r || abs(o[2]) > r) return -1;
  if (s->number == NULL) return direction_among(s, o);
  return s->number[(o[0] + r) + side * ((o[1] + r) + side * (o[2] + r))];
}

bw_status bw_pd_body_stencil_room(bw_pd_body *pd, int l, int n)
{
  bw_pd_stencil *s = &pd->level[l].stencil;
  const int side = 2 * s->reach + 1, pairs = pd->config.n_group * pd->config.n_group;
  const size_t rows = (size_t)n, cells = (size_t)side * (size_t)side * (size_t)side;
  BW_TRY(BW_ALLOCATE(&pd->level[l].row, (size_t)pairs * rows * BW_PD_ROW));
  BW_TRY(BW_ALLOCATE(&s->offset, 3 * rows));
  BW_TRY(BW_ALLOCATE(&s->xi, 3 * rows));
  BW_TRY(BW_ALLOCATE(&s->r0, rows));
  BW_TRY(BW_ALLOCATE(&s->fraction, rows));
  BW_TRY(BW_ALLOCATE(&s->volume, rows));
  BW_TRY(BW_ALLOCATE(&s->tough, rows));
  BW_TRY(BW_ALLOCATE(&s->other, rows));
  BW_TRY(BW_ALLOCATE(&s->sure, rows));
  /* With several levels offsets are many steps long and few look for their numbers. */
  if (pd->finest == 0) BW_TRY(BW_ALLOCATE(&s->number, cells));
  /* Offsets that are no direction are told from those that are. */
  for (size_t q = 0; s->number != NULL && q < cells; q++)
    s->number[q] = -1;
  for (int q = 0; q < n; q++)
    s->tough[q] = 1, s->other[q] = (uint8_t)l;
  s->n = s->same = n;
  pd->directions = n > pd->directions ? n : pd->directions;
  return BW_OK;
}

void bw_pd_body_stencil_lengths(const bw_pd_body *pd, bw_pd_stencil *s)
{
  for (int q = 0; q < s->n; q++) {
    const int32_t *o = s->offset + 3 * q;
    double r2 = 0;
    for (int d = 0; d < 3; d++) {
      r2 += (double)o[d] * o[d];
      for (int k = 0; k < 3; k++)
        s->xi[3 * q + k] += s->unit * o[d] * pd->config.axes[d][k];
    }
    s->r0[q] = s->unit * sqrt(r2);
  }
}

bw_status bw_pd_body_stencil(bw_pd_body *pd)
{
  bw_pd_stencil *s = &pd->level->stencil;
  const bw_pd_body_config *c = &pd->config;
  /* Sites can be this far apart with their particles still within reach. */
  s->reach = (int)ceil(c->horizon_ratio + 0.5 + 2 * c->disorder);
  s->unit = c->ds;
  const int side = 2 * s->reach + 1;
  /* Counted first; the offsets are written once there is room. */
  BW_TRY(bw_pd_body_stencil_room(pd, 0, list_offsets(pd, s)));
  list_offsets(pd, s);
  bw_pd_body_stencil_lengths(pd, s);
  /* And back from an offset to its number. */
  for (int q = 0; q < s->n; q++) {
    const int32_t *o = s->offset + 3 * q;
    /* So near that both may be off their sites as they like: no distance has to be looked at. */
    s->sure[q] = in_reach(c, o, -2 * c->disorder);
    s->number[(o[0] + s->reach) + side * ((o[1] + s->reach) + side * (o[2] + s->reach))] =
        (int16_t)q;
  }
  BW_TRY(fractions(pd, s));
  memcpy(s->volume, s->fraction, (size_t)s->n * sizeof *s->volume);
  return BW_OK;
}

static void level_rows(bw_pd_body *pd, bw_pd_level *level)
{
  const bw_pd_stencil *s = &level->stencil;
  const bool cloud = pd->config.disorder > 0;
  const int pairs = pd->config.n_group * pd->config.n_group;
  /* One table for every pair of groups: geometry is the same, the law's columns differ. */
  for (int q = 0; q < pairs * s->n; q++) {
    bw_real *row = level->row + (size_t)q * BW_PD_ROW;
    const int direction = q % s->n;
    /* In a cloud length and Gamma belong to the bond: the row holds what is left, 1. */
    const double r0 = cloud ? 1 : s->r0[direction], gamma = cloud ? 1 : s->fraction[direction];
    for (int k = 0; k < 3; k++)
      row[BW_PD_XI + k] = (bw_real)s->xi[3 * direction + k];
    row[BW_PD_R0] = (bw_real)r0;
    row[BW_PD_MINUS_R0] = (bw_real)-r0;
    row[BW_PD_WEIGHT] = (bw_real)(gamma * pd->level[s->other[direction]].dv);
  }
}

void bw_pd_body_rows(bw_pd_body *pd)
{
  for (int l = 0; l <= pd->finest; l++)
    level_rows(pd, &pd->level[l]);
}
