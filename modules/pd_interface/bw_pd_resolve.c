/* What surrounds one particle, direction by direction, and what follows from it. */
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

/* Reflect xi (from X0, in the reference shape) in the walls it crosses, coded in *cross as in
 * bw_pd_interface__near. False when it crosses none. */
static bool reflect(const bw_pd_interface *pi, const double X0[3], const double xi[3],
                    double image[3], uint8_t *cross)
{
  const bw_pd_interface_config *c = &pi->config;
  const double tie = 1e-6 * pi->stencil->ds; /* a partner on the plane itself is inside */
  *cross = 0;
  for (int d = 0; d < 3; d++) {
    const double x = X0[d] + xi[d];
    const bool low = c->walled[d][0] && x < c->lower[d] - tie;
    const bool high = c->walled[d][1] && x > c->upper[d] + tie;
    image[d] = xi[d];
    /* Mirrored in the plane: what stands as far on this side. */
    if (low) image[d] = 2.0 * (c->lower[d] - X0[d]) - xi[d];
    if (high) image[d] = 2.0 * (c->upper[d] - X0[d]) - xi[d];
    *cross = (uint8_t)(*cross | (low ? 1u : high ? 2u : 0u) << (2 * d));
  }
  return *cross != 0;
}

/* Directions across a wall: what the wall mirrors is there, at the mirrored place; only a broken
 * bond across it counts as it is. Images read directions inside, which stay as they are. */
static void fill_images(bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  const double *X0 = &pi->X0[3 * h];
  for (int q = 0; q < s->slots; q++) {
    double image[3], nothing[3];
    uint8_t cross, again;
    /* A bond across the wall that broke stays broken. */
    if (pi->seen.state[q] == BW_PD_INTERFACE__BROKEN) continue;
    if (!reflect(pi, X0, &s->xi[3 * q], image, &cross)) continue;
    /* A particle on the wall may be its own image. */
    const double still = sqrt(image[0] * image[0] + image[1] * image[1] + image[2] * image[2]);
    const bool itself = still < 0.25 * s->ds;
    const int m = itself ? -2 : bw_pd_interface__slot_of(s, image, s->other[q]);
    const bool trapped = reflect(pi, X0, image, nothing, &again);
    bw_pd_interface__near *near = &pi->seen.near[q];
    near->slot = (int16_t)q;
    near->cross = cross;
    /* Four cases: itself, a partner's image, the image of a
     * place where nobody is, no mirror at all. */
    if (itself) {
      pi->seen.state[q] = BW_PD_INTERFACE__INTACT;
      near->partner = (int32_t)h;
    } else if (m >= 0 && !trapped) {
      pi->seen.state[q] = pi->seen.state[m];
      near->partner = pi->seen.near[m].partner;
    } else if ((m == -1 && !trapped) || s->other[q] != s->level) {
      pi->seen.state[q] = BW_PD_INTERFACE__ABSENT;
    } else { /* no mirror on this lattice (or between two walls): the wall counts as solid */
      pi->seen.state[q] = BW_PD_INTERFACE__INTACT;
      near->partner = -1;
    }
  }
}

bool bw_pd_interface__moved_off(const bw_pd_interface *pi, size_t h, const bw_pd_motion *now)
{
  const bw_pd_interface_config *c = &pi->config;
  const double opening = bw_pd_interface__opening(pi, h);
  bool off = false;
  for (size_t d = 0; d < 3; d++) {
    /* Away from the wall, along its normal. */
    const double moved = (double)now->u[d][now->place[h]];
    off = off || (c->walled[d][0] && moved > opening);
    off = off || (c->walled[d][1] && moved < -opening);
  }
  return off;
}

void bw_pd_interface__resolve(bw_pd_interface *pi, size_t h, bool reference)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  /* Nobody is there, but for those that the solid lists. */
  memset(pi->seen.state, BW_PD_INTERFACE__ABSENT, (size_t)s->slots);
  const int family = bw_solid_links(pi->pd, h, pi->seen.link);
  for (int q = 0; q < family; q++) {
    const bw_pd_link *l = &pi->seen.link[q];
    const bool intact = l->intact || reference;
    /* Coarser partners beyond the own horizon, whose own one h is in, tell nothing of its surface.
     */
    if (s->other[l->slot] != s->level && !(s->fraction[l->slot] > 0.0)) continue;
    pi->seen.state[l->slot] = intact ? BW_PD_INTERFACE__INTACT : BW_PD_INTERFACE__BROKEN;
    pi->seen.near[l->slot] = (bw_pd_interface__near){.partner = l->neighbour, .slot = l->slot};
  }
  /* A wall counts as solid until the particle has moved off it. */
  if (pi->wall.leans[h] && (reference || !pi->wall.off[h])) fill_images(pi, h);
}

/* Place of a partner relative to h: at rest, and what both moved since (images the other way). */
static void locate_one(const bw_pd_interface *pi, size_t h, const bw_pd_motion *now,
                       const bw_pd_interface__near *near, double x[3])
{
  memcpy(x, &bw_pd_interface__stencil_of(pi, h)->xi[3 * near->slot], 3 * sizeof *x);
  if (now == NULL || near->partner < 0) return;
  const size_t l = (size_t)near->partner;
  /* In a cloud partners are not where the stencil has them. */
  if (pi->now.off_lattice != NULL) {
    bw_solid_get_place(pi->pd, l, x);
    for (size_t d = 0; d < 3; d++)
      x[d] -= pi->X0[3 * h + d];
  }
  for (size_t d = 0; d < 3; d++) {
    /* An image moves the other way along the wall's normal. */
    const bool image = (near->cross >> (2 * d) & 3) != 0;
    const double moved = (double)now->u[d][now->place[l]];
    x[d] += (image ? -moved : moved) - (double)now->u[d][now->place[h]];
  }
}

void bw_pd_interface__locate(bw_pd_interface *pi, size_t h, const bw_pd_motion *now)
{
  for (int q = 0; q < bw_pd_interface__stencil_of(pi, h)->slots; q++)
    if (pi->seen.state[q] != BW_PD_INTERFACE__ABSENT)
      locate_one(pi, h, now, &pi->seen.near[q], &pi->seen.place[3 * q]);
}

void bw_pd_interface__bare_sectors(const bw_pd_interface *pi, size_t h, uint32_t *not_held,
                                   uint32_t *never)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  uint32_t held = 0, known = 0;
  /* A direction on a border belongs to several sectors. */
  for (int q = 0; q < s->slots; q++) {
    if (pi->seen.state[q] == BW_PD_INTERFACE__INTACT) held |= s->sector_of[q];
    if (pi->seen.state[q] != BW_PD_INTERFACE__ABSENT) known |= s->sector_of[q];
  }
  const uint32_t all = (1u << (unsigned)s->sectors) - 1u; /* at most 24 */
  *not_held = all & ~held;
  *never = all & ~known;
}

uint32_t bw_pd_interface__empty_sectors(const bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  double sum[BW_PD_INTERFACE__SECTORS] = {0.0}, broken[BW_PD_INTERFACE__SECTORS] = {0.0};
  const double opening = bw_pd_interface__opening(pi, h);
  uint32_t empty, never;
  bw_pd_interface__bare_sectors(pi, h, &empty, &never);
  /* Only sectors without an intact bond can be empty; their broken partners tell how far. */
  for (int q = 0; q < s->slots; q++) {
    if (pi->seen.state[q] != BW_PD_INTERFACE__BROKEN || (s->sector_of[q] & empty) == 0) continue;
    const double *x = &pi->seen.place[3 * q];
    const double distance = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int k = 0; k < s->sectors; k++)
      if (s->sector_of[q] >> (unsigned)k & 1u) sum[k] += distance, broken[k] += 1.0;
  }
  for (int k = 0; k < s->sectors; k++) /* 3.42 */
    if (broken[k] > 0.0 && !(sum[k] > opening * broken[k])) empty &= ~(1u << (unsigned)k);
  return empty;
}

bool bw_pd_interface__normal_of(const bw_pd_interface *pi, size_t h, double n[3])
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  double mean[3] = {0.0, 0.0, 0.0}, weight = 0.0;
  /* POROUS 3.45: minus the centroid of what is there, in the reference shape. */
  for (int q = 0; q < s->slots; q++) {
    if (pi->seen.state[q] != BW_PD_INTERFACE__INTACT) continue;
    /* POROUS 3.46. */
    for (int d = 0; d < 3; d++)
      mean[d] += s->fraction[q] * s->xi[3 * q + d];
    weight += s->fraction[q];
  }
  const double length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
  /* A face has about ds here, a sheet of two layers ds/2; below ds/50 it is chance. */
  if (!(length > 0.02 * s->ds * weight)) return false;
  for (int d = 0; d < 3; d++)
    n[d] = -mean[d] / length;
  return true;
}

/* |n.e| of the open face half a step along e: n from the centroid of the solid in a ball
 * about the face itself, cut off linearly over the last ds. Half in the solid and half outside it
 * sees no bias from curvature (a normal at the particle has one of 0.2 ds times the sum of the
 * principal curvatures); with m = 3 the ball just fits into the family. */
static double face_projection(const bw_pd_interface__stencil *s, const uint8_t state[],
                              const double e[3])
{
  const double half = 0.5 * s->ds, c[3] = {half * e[0], half * e[1], half * e[2]};
  double v[3] = {-c[0] * s->ds, -c[1] * s->ds, -c[2] * s->ds}; /* the particle itself, weight ds */
  /* Centroid, about the face, of the partners in the ball. */
  for (int q = 0; q < s->slots; q++) {
    if (state[q] != BW_PD_INTERFACE__INTACT) continue;
    /* A cell of another size weighs as its volume, and the rim cuts it off over its own width. */
    const double ds = ldexp(s->ds, s->level - s->other[q]), radius = s->family - s->ds + 0.5 * ds;
    const double face = ldexp(1.0, (s->dims - 1) * (s->level - s->other[q])), *xi = &s->xi[3 * q];
    const double x[3] = {xi[0] - c[0], xi[1] - c[1], xi[2] - c[2]};
    const double weight = radius - sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int d = 0; d < 3; d++)
      v[d] += face * fmin(fmax(weight, 0.0), ds) * x[d];
  }
  const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return fabs(v[0] * e[0] + v[1] * e[1] + v[2] * e[2]) / length;
}

unsigned bw_pd_interface__open_sides(const bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  unsigned closed = 0;
  /* A side is open when nobody ever touched it: cells are split as wholes, so that one finer
   * neighbour there is as good as all. */
  for (int q = 0; q < s->slots; q++)
    if (pi->seen.state[q] != BW_PD_INTERFACE__ABSENT) closed |= s->faces[q];
  return ~closed & ((1u << (2 * s->dims)) - 1u);
}

/* The open sides of h, resolved last: outward unit normals e, (6,3) at most. */
static int open_sides(const bw_pd_interface *pi, size_t h, double e[][3])
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  const unsigned bits = bw_pd_interface__open_sides(pi, h);
  int open = 0;
  for (int r = 0; r < s->dims; r++)
    for (int side = -1; side <= 1; side += 2) {
      if (!(bits >> (2 * r + (side > 0)) & 1u)) continue;
      for (int d = 0; d < 3; d++)
        e[open][d] = side * s->axes[r][d];
      open++;
    }
  return open;
}

bool bw_pd_interface__has_open_side(const bw_pd_interface *pi, size_t h)
{
  double e[6][3];
  return open_sides(pi, h, e) > 0;
}

double bw_pd_interface__open_area(const bw_pd_interface *pi, size_t h)
{
  double e[6][3], area = 0.0;
  const int open = open_sides(pi, h, e);
  for (int f = 0; f < open; f++)
    area += face_projection(bw_pd_interface__stencil_of(pi, h), pi->seen.state, e[f]);
  return area * bw_pd_interface__side_area(pi, h);
}

double bw_pd_interface__facing_area(const bw_pd_interface *pi, size_t h, const double n[3])
{
  double e[6][3], area = 0.0;
  const int open = open_sides(pi, h, e);
  for (int f = 0; f < open; f++)
    area += e[f][0] * n[0] + e[f][1] * n[1] + e[f][2] * n[2];
  return area * bw_pd_interface__side_area(pi, h);
}
