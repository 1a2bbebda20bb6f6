/* lattice_sum.h -- sums over a family written once more, for the validation of pd_bond: fractions
 * of cells by columns (exact along one direction, midpoints in the others), no code shared with
 * the module. Lengths in lattice spacings. */
#pragma once
#include <math.h>
#include <stdbool.h>

static const double LATTICE_PI = 3.14159265358979323846;

/* Part of the unit cell at o within m: columns along the last direction used. */
static inline double lattice_fraction(double m, const int o[3], bool planar)
{
  const int n = planar ? 2000 : 60;
  double sum = 0;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < (planar ? 1 : n); b++) {
      const double x = o[0] + (a + 0.5) / n - 0.5, y = planar ? 0 : o[2] + (b + 0.5) / n - 0.5;
      const double h2 = m * m - x * x - y * y, h = h2 > 0 ? sqrt(h2) : 0;
      sum += fmax(0, fmin(o[1] + 0.5, h) - fmax(o[1] - 0.5, -h));
    }
  return sum / (planar ? n : (double)n * n);
}

/* ERRATA 2. */
static inline double lattice_fraction_linear(double m, const int o[3])
{
  const double r = sqrt((double)(o[0] * o[0] + o[1] * o[1]));
  return fmax(0, fmin(1, m - r + 0.5));
}

/* term(xi, data) summed over the family |xi| < m + 1/2 with its fractions. */
typedef double (*lattice_term)(const double xi[3], const void *data);
static inline double lattice_sum(double m, bool planar, bool linear, lattice_term term,
                                 const void *data)
{
  const int r = (int)(m + 1), rz = planar ? 0 : r;
  double sum = 0;
  for (int z = -rz; z <= rz; z++)
    for (int y = -r; y <= r; y++)
      for (int x = -r; x <= r; x++) {
        const int o[3] = {x, y, z}, r2 = x * x + y * y + z * z;
        if (r2 == 0 || r2 >= (m + 0.5) * (m + 0.5)) continue;
        const double xi[3] = {x, y, z};
        const double part = linear ? lattice_fraction_linear(m, o) : lattice_fraction(m, o, planar);
        sum += part * term(xi, data);
      }
  return sum;
}

static inline double lattice_one(const double xi[3], const void *data)
{
  (void)xi, (void)data;
  return 1;
}

/* alpha of the volume method in the bulk (3.43). */
static inline double lattice_alpha(double m, bool planar, bool linear)
{
  const double ball = planar ? LATTICE_PI * m * m : 4.0 / 3 * LATTICE_PI * m * m * m;
  return ball / lattice_sum(m, planar, linear, lattice_one, 0);
}

/* How far a family sum of |xi|^p-like terms is from its integral, relative: the mass of a cell cut
 * by the horizon sits at its centre instead of its inner part's centroid, on average
 * Gamma (1 - Gamma)/2 = 1/12 of a spacing outwards. Of the integral of r^p r^(d-1) that is
 * p (p + d)/(12 m^2); the midpoint rule inside errs the other way and by less. */
static inline double lattice_bound(double m, bool planar, double p)
{
  return p * (p + (planar ? 2 : 3)) / (12 * m * m);
}
