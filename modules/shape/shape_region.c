/* The range of sites that a body may occupy, and its parts. */
#include "shape_internal.h"

#include <math.h>
#include <string.h>

typedef bw_shape__region region;

bw_shape_lattice bw_shape_lattice_straight(double ds, const double origin[3], bool planar)
{
  return (bw_shape_lattice){.ds = ds,
                            .origin = {origin[0], origin[1], origin[2]},
                            .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            .planar = planar};
}

static void unite(bw_shape__extent *e, const bw_shape__extent *with, int d)
{
  e->lower[d] = fmin(e->lower[d], with->lower[d]);
  e->upper[d] = fmax(e->upper[d], with->upper[d]);
}

bool bw_shape__space(int count, const bw_shape shape[], int dims, bw_shape__extent *space,
                     bool cut[3])
{
  bool ends = true;
  for (int d = 0; d < dims; d++) {
    /* `all` counts endless shapes as such, `finite` leaves them out. */
    bw_shape__extent all, finite;
    all.lower[d] = finite.lower[d] = INFINITY;
    all.upper[d] = finite.upper[d] = -INFINITY;
    bool endless = false;
    for (int q = 0; q < count; q++) {
      const bool within = shape[q].outside && shape[q].remove;
      if (shape[q].remove && !within) continue;
      bw_shape__extent e = bw_shape__bounds(&shape[q], dims);
      if (within) {
        /* What lies outside is taken away from all that came before, not from what follows. */
        all.lower[d] = fmax(all.lower[d], e.lower[d]);
        all.upper[d] = fmin(all.upper[d], e.upper[d]);
        continue;
      }
      if (shape[q].outside) e.lower[d] = -INFINITY, e.upper[d] = INFINITY;
      unite(&all, &e, d);
      if (isfinite(e.lower[d]))
        unite(&finite, &e, d);
      else
        endless = true;
    }
    /* Only where no other shape ends it may an endless one end where it is cut to a shape. */
    cut[d] = endless && isfinite(finite.lower[d]);
    space->lower[d] = cut[d] ? finite.lower[d] : all.lower[d];
    space->upper[d] = cut[d] ? finite.upper[d] : all.upper[d];
    ends = ends && isfinite(space->lower[d]) && isfinite(space->upper[d]);
  }
  return ends;
}

/* Least and most of (x - origin).axis/ds over the corners of the space. */
static void along_axis(const region *g, int a, double *least, double *most)
{
  *least = *most = 0.0;
  for (int d = 0; d < g->dims; d++) {
    const double p = g->axes[a][d] * (g->space.lower[d] - g->origin[d]) / g->ds;
    const double q = g->axes[a][d] * (g->space.upper[d] - g->origin[d]) / g->ds;
    *least += fmin(p, q);
    *most += fmax(p, q);
  }
}

static bw_status find_sites(region *g)
{
  double all = 1.0;
  for (int d = 0; d < g->dims; d++) {
    double least = (g->space.lower[d] - g->origin[d]) / g->ds;
    double most = (g->space.upper[d] - g->origin[d]) / g->ds;
    if (g->turned) along_axis(g, d, &least, &most);
    /* The corners of a turned space may round to either side of a site: one more is looked at. */
    const double a = ceil(least - 0.5 - BW_SHAPE__TIE) - g->turned;
    const double b = ceil(most - 0.5 - BW_SHAPE__TIE) + g->turned;
    BW_REQUIRE(a > (double)INT32_MIN && b < (double)INT32_MAX, BW_EINPUT,
               "shapes: %g .. %g in direction %d is more than 2^31 sites of ds = %g",
               g->space.lower[d], g->space.upper[d], d, g->ds);
    g->lo[d] = (int64_t)a;
    g->hi[d] = (int64_t)fmax(a, b);
    all *= fmax(1.0, (double)(g->hi[d] - g->lo[d]));
  }
  if (g->dims == 2) g->lo[2] = 0, g->hi[2] = 1;
  BW_REQUIRE(all < (double)INT64_MAX, BW_EINPUT,
             "shapes: %g sites of ds = %g are more than can be numbered; take a larger ds", all,
             g->ds);
  return BW_OK;
}

static bool is_straight(const double axes[3][3])
{
  bool unset = true, unit = true;
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) {
      unset = unset && axes[a][d] == 0.0;
      unit = unit && axes[a][d] == (a == d ? 1.0 : 0.0);
    }
  return unset || unit;
}

bw_status bw_shape__region_make(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                                region *g)
{
  *g = (region){.count = count,
                .shape = shape,
                .ds = lattice->ds,
                .dims = lattice->planar ? 2 : 3,
                .turned = !is_straight(lattice->axes)};
  memcpy(g->origin, lattice->origin, sizeof g->origin);
  memcpy(g->axes, lattice->axes, sizeof g->axes);
  BW_REQUIRE(isfinite(g->ds) && g->ds > 0.0, BW_EINPUT, "shapes: ds = %g has to be positive",
             g->ds);
  BW_REQUIRE(count > 0, BW_EINPUT, "shapes: the list is empty; a body needs one at least");
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(isfinite(g->origin[d]), BW_EINPUT, "shapes: origin[%d] = %g is not finite", d,
               g->origin[d]);
  if (g->turned) BW_TRY(bw_shape__check_axes("lattice", (const double(*)[3])g->axes, g->dims));
  for (int q = 0; q < count; q++)
    BW_TRY(bw_shape__check(q, &shape[q], g->dims));
  bool cut[3];
  const bool ends = bw_shape__space(count, shape, g->dims, &g->space, cut);
  for (int d = 0; d < g->dims && !ends; d++)
    BW_REQUIRE(isfinite(g->space.lower[d]), BW_EINPUT,
               "shapes: nothing that is added ends in direction %d; add a box to cut from", d);
  return find_sites(g);
}

bw_status bw_shape_range(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                         int64_t lo[3], int64_t hi[3])
{
  region g;
  memset(lo, 0, 3 * sizeof *lo);
  memset(hi, 0, 3 * sizeof *hi);
  BW_TRY(bw_shape__region_make(count, shape, lattice, &g));
  memcpy(lo, g.lo, sizeof g.lo);
  memcpy(hi, g.hi, sizeof g.hi);
  return BW_OK;
}

void bw_shape_part(const int64_t lo[3], const int64_t hi[3], int part, int parts, int64_t *first,
                   int64_t *rows)
{
  const int64_t all = (hi[1] - lo[1]) * (hi[2] - lo[2]);
  /* all*part/parts without the product, which may be too large */
  const int64_t each = all / parts, rest = all % parts;
  *first = each * part + rest * part / parts;
  *rows = each * (part + 1) + rest * (part + 1) / parts - *first;
}
