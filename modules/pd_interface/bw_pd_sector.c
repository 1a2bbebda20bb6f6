/* The sectors of a particle's surroundings, and which directions of the stencil lie in them. */
#include "bw_memory.h"
#include "pd_interface_internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* 2D: sector s reaches 22.5 degrees to both sides of 45 s. No lattice direction lies on a border
 * (tan 22.5 is irrational), so each belongs to one sector, as POROUS asks. */
static uint32_t sectors_in_plane(const int o[3])
{
  const double pi = acos(-1.0);
  const int s = (int)lround(atan2((double)o[1], (double)o[0]) / (pi / 4.0));
  return 1u << (unsigned)((s + 8) % 8);
}

/* 3D: sector 3 octant + axis holds the directions of the octant (bit d set: component d >= 0, else
 * <= 0) whose largest component is along the axis. Closed: a direction on a border belongs to
 * all sectors that meet there, so that a sector can only be empty when its side's own neighbour
 * is missing. */
static uint32_t sectors_in_space(const int o[3])
{
  int largest = 0;
  for (int d = 0; d < 3; d++)
    if (abs(o[d]) > largest) largest = abs(o[d]);
  uint32_t bits = 0;
  /* Zero components fit both signs, equal ones several axes: the sectors are closed. */
  for (int octant = 0; octant < 8; octant++)
    for (int axis = 0; axis < 3; axis++) {
      bool in = abs(o[axis]) == largest;
      for (int d = 0; d < 3; d++)
        in = in && ((octant >> d & 1) ? o[d] >= 0 : o[d] <= 0);
      if (in) bits |= 1u << (unsigned)(3 * octant + axis);
    }
  return bits;
}

static void unit_direction(const bw_pd_interface__stencil *s, const double lattice[3],
                           double out[3])
{
  double x[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  for (int r = 0; r < 3; r++)
    for (int d = 0; d < 3; d++)
      x[d] += lattice[r] * s->axes[r][d];
  for (int d = 0; d < 3; d++)
    squared += x[d] * x[d];
  for (int d = 0; d < 3; d++)
    out[d] = x[d] / sqrt(squared);
}

/* Neighbours share a border: in space the other two largest components of the octant, and the
 * same largest component with one of the other signs turned. */
static void lay_out_sectors(bw_pd_interface__stencil *s)
{
  s->sectors = s->dims == 2 ? 8 : 24;
  for (int k = 0; k < s->sectors; k++) {
    double middle[3] = {0.0, 0.0, 0.0};
    /* In the plane the neighbours are those before and after, around the circle. */
    if (s->dims == 2) {
      s->adjacent[k] = 1u << (unsigned)((k + 1) % 8) | 1u << (unsigned)((k + 7) % 8);
      middle[0] = cos(k * acos(-1.0) / 4.0), middle[1] = sin(k * acos(-1.0) / 4.0);
    } else {
      /* In space: the octant's other two sectors, and the same axis in the two octants beside
       * it. */
      const int octant = k / 3, axis = k % 3;
      s->adjacent[k] = 0;
      for (int d = 0; d < 3; d++) {
        middle[d] = ((octant >> d & 1) ? 1.0 : -1.0) * (d == axis ? 2.0 : 1.0);
        if (d == axis) continue;
        s->adjacent[k] |= 1u << (unsigned)(3 * octant + d);
        s->adjacent[k] |= 1u << (unsigned)(3 * (octant ^ (1 << d)) + axis);
      }
    }
    unit_direction(s, middle, s->direction[k]);
  }
}

static bool lattice_offset(const bw_pd_interface__stencil *s, const double xi[3], int o[3])
{
  bool on = true;
  for (int r = 0; r < 3; r++) {
    const double *a = s->axes[r];
    const double q = (xi[0] * a[0] + xi[1] * a[1] + xi[2] * a[2]) / s->unit;
    o[r] = (int)lround(q);
    on = on && fabs(q - o[r]) < 0.25;
  }
  return on;
}

/* Can a particle of level `other` be at an offset? Of the own level at whole spacings; of another
 * one at odd multiples of half the finer spacing (pd_level.h). */
static bool may_be(const bw_pd_interface__stencil *s, const int o[3], int other)
{
  const bool own = other == s->level;
  const int finer = other > s->level ? other : s->level;
  const int step = s->finest == 0 ? 1 : 1 << (s->finest - finer + own);
  bool can = true;
  for (int d = 0; d < s->dims; d++)
    can = can && o[d] % step == 0 && (own || o[d] / step % 2 != 0);
  return can;
}

/* The faces of the own cell that a cell at an offset touches. */
static uint8_t faces_of(const bw_pd_interface__stencil *s, const int o[3], int other)
{
  /* Between the centres of cells side by side, in units. */
  const double apart = 0.5 * (s->ds + ldexp(s->ds, s->level - other)) / s->unit;
  unsigned bits = 0;
  for (int r = 0; r < s->dims; r++) {
    bool beside = fabs(abs(o[r]) - apart) < 0.25;
    for (int d = 0; d < s->dims; d++)
      beside = beside && (d == r || abs(o[d]) < apart - 0.25);
    if (beside) bits |= 1u << (2 * r + (o[r] > 0));
  }
  return (uint8_t)bits;
}

static size_t slot_index(const bw_pd_interface__stencil *s, const int o[3])
{
  const size_t w = (size_t)(2 * s->reach + 1);
  return ((size_t)(o[2] + s->reach) * w + (size_t)(o[1] + s->reach)) * w +
         (size_t)(o[0] + s->reach);
}

int bw_pd_interface__slot_of(const bw_pd_interface__stencil *s, const double xi[3], int other)
{
  int o[3];
  /* Within a quarter of a unit of a site, else it is none. */
  if (!lattice_offset(s, xi, o) || !may_be(s, o, other)) return -2;
  for (int d = 0; d < 3; d++)
    if (abs(o[d]) > s->reach) return -1;
  return s->slot_at[slot_index(s, o)];
}

/* The farthest component of an offset, in units. */
static int farthest(const bw_solid *pd, const bw_pd_interface__stencil *s)
{
  const bw_solid_config *c = bw_solid_settings(pd);
  /* A cloud's partners may stand in sites beyond the horizon, by twice the disorder. */
  int most = s->finest > 0 ? 0 : (int)floor(c->horizon_ratio + 0.5 + 2.0 * c->disorder);
  for (int q = 0; q < s->slots && s->finest > 0; q++) {
    int o[3];
    lattice_offset(s, bw_solid_leads(pd, s->level, q).xi, o);
    for (int d = 0; d < 3; d++)
      most = abs(o[d]) > most ? abs(o[d]) : most;
  }
  return most;
}

bw_status bw_pd_interface__stencil_create(const bw_solid *pd, int level,
                                          bw_pd_interface__stencil *s)
{
  const bw_solid_config *c = bw_solid_settings(pd);
  memset(s, 0, sizeof *s);
  s->dims = c->geometry == BW_PD_3D ? 3 : 2;
  s->level = level;
  s->finest = bw_solid_finest(pd);
  s->ds = ldexp(c->ds, -level);
  s->unit = s->finest > 0 ? ldexp(c->ds, -s->finest - 1) : c->ds;
  const double m = ldexp(c->horizon_ratio, c->finer.same_horizon ? level : 0);
  s->family = s->ds * (m + (c->family_reach == BW_PD_REACH_HORIZON ? 0.0 : 0.5));
  memcpy(s->axes, c->axes, sizeof s->axes);
  s->slots = bw_solid_directions(pd, level);
  s->reach = farthest(pd, s);
  const size_t n = (size_t)s->slots, w = (size_t)(2 * s->reach + 1);
  BW_TRY(BW_ALLOCATE(&s->xi, 3 * n));
  BW_TRY(BW_ALLOCATE(&s->fraction, n));
  BW_TRY(BW_ALLOCATE(&s->other, n));
  BW_TRY(BW_ALLOCATE(&s->faces, n));
  BW_TRY(BW_ALLOCATE(&s->sector_of, n));
  BW_TRY(BW_ALLOCATE(&s->slot_at, w * w * w));
  /* No slot but for the stencil's own offsets. */
  for (size_t q = 0; q < w * w * w; q++)
    s->slot_at[q] = -1;
  lay_out_sectors(s);
  /* Every direction of the solid's stencil finds its sectors, once. */
  for (int q = 0; q < s->slots; q++) {
    int o[3];
    const bw_solid_direction way = bw_solid_leads(pd, level, q);
    memcpy(&s->xi[3 * q], way.xi, sizeof way.xi);
    s->fraction[q] = way.volume;
    s->other[q] = (uint8_t)way.other;
    const bool on = lattice_offset(s, &s->xi[3 * q], o);
    BW_ASSERT(on);
    (void)on;
    s->slot_at[slot_index(s, o)] = (int16_t)q;
    s->faces[q] = faces_of(s, o, way.other);
    s->sector_of[q] = s->dims == 2 ? sectors_in_plane(o) : sectors_in_space(o);
  }
  return BW_OK;
}

void bw_pd_interface__stencil_release(bw_pd_interface__stencil *s)
{
  bw_release(&s->xi);
  bw_release(&s->fraction);
  bw_release(&s->other);
  bw_release(&s->faces);
  bw_release(&s->sector_of);
  bw_release(&s->slot_at);
}

static int bits_set(uint32_t x)
{
  int n = 0;
  for (; x != 0; x &= x - 1)
    n++;
  return n;
}

uint32_t bw_pd_interface__group(const bw_pd_interface__stencil *s, uint32_t empty)
{
  /* The lowest bit, then what touches it, until nothing is added. */
  uint32_t group = empty & (~empty + 1), before = 0;
  while (group != before) {
    before = group;
    for (int k = 0; k < s->sectors; k++)
      if (before >> (unsigned)k & 1u) group |= s->adjacent[k] & empty;
  }
  return group;
}

bool bw_pd_interface__is_open(const bw_pd_interface__stencil *s, uint32_t empty, int n_empty)
{
  bool open = false;
  /* Group by group: one that is large enough opens the particle. */
  while (empty != 0) {
    const uint32_t group = bw_pd_interface__group(s, empty);
    open = open || bits_set(group) >= n_empty;
    empty &= ~group;
  }
  return open;
}
