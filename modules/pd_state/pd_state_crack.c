/* What a crack costs in a state-based solid: where the limit of a bond comes from.
 *
 * A flat cut all of whose bonds are at their limit holds a sum over the family. A crack does not
 * come about so: bonds break one after the other, each lets its neighbours relax, and the load has
 * to carry the crack over the hardest of them. The energy that this takes is found by virtual
 * extension, G = -dE/da at fixed displacements of a rim that follow the singular field of a long
 * crack along the lattice (validation/pd_state/crack_tip.c, where the tables can be made anew).
 * Plane stress needs no table: small strains in the plane are those of plane strain with another
 * Poisson's ratio. */
#include "pd_state.h"

enum { NU = 7, M_PLANE = 4, M_SPACE = 2 };

static const double knot_nu[NU] = {-0.2, 0, 0.1, 0.2, 0.3, 0.4, 0.45};
static const double knot_plane[M_PLANE] = {2, 2.5, 3, 4}, knot_space[M_SPACE] = {2, 3};

/* Ordinary: constant, then inverse influence; rows of horizon ratios. Of the last row the last four
 * are scaled from those of constant influence. */
static const double plane[2][M_PLANE][NU] = {{{1.406, 1.574, 1.687, 1.829, 2.023, 2.318, 2.733},
                                              {1.331, 1.485, 1.587, 1.716, 1.892, 2.134, 2.277},
                                              {1.200, 1.324, 1.401, 1.496, 1.609, 1.783, 2.161},
                                              {1.082, 1.171, 1.232, 1.316, 1.389, 1.509, 1.780}},
                                             {{1.408, 1.593, 1.722, 1.887, 2.077, 2.391, 2.817},
                                              {1.263, 1.427, 1.539, 1.689, 1.911, 2.268, 2.444},
                                              {1.112, 1.255, 1.353, 1.481, 1.670, 2.060, 2.212},
                                              {1.019, 1.121, 1.187, 1.305, 1.512, 1.844, 1.931}}};
static const double space[2][M_SPACE][NU] = {{{1.133, 1.287, 1.353, 1.496, 1.727, 2.296, 2.849},
                                              {0.905, 1.011, 1.073, 1.187, 1.295, 1.559, 1.794}},
                                             {{1.109, 1.232, 1.336, 1.475, 1.645, 1.990, 2.515},
                                              {0.927, 1.038, 1.117, 1.236, 1.348, 1.623, 1.867}}};

double bw_pd_state__strain_poisson(bw_pd_geometry geometry, double nu)
{
  return geometry == BW_PD_PLANE_STRESS ? nu / (1 + nu) : nu;
}

/* Which interval of the knots x is in, and where: 0 .. 1; beyond them at their end. */
static int interval(int n, const double knot[], double x, double *part)
{
  int q = 0;
  while (q < n - 2 && x > knot[q + 1])
    q++;
  *part = fmax(0, fmin(1, (x - knot[q]) / (knot[q + 1] - knot[q])));
  return q;
}

/* Straight between the knots, in both directions. */
static double between(int n, const double knot[], const double table[][NU], double m, double nu)
{
  double s, t;
  const int q = interval(n, knot, m, &s), p = interval(NU, knot_nu, nu, &t);
  const double low = table[q][p] + t * (table[q][p + 1] - table[q][p]);
  const double high = table[q + 1][p] + t * (table[q + 1][p + 1] - table[q + 1][p]);
  return low + s * (high - low);
}

double bw_pd_state__ordinary_crack(const bw_pd_body_config *c, bool inverse, double nu)
{
  return c->geometry == BW_PD_3D
             ? between(M_SPACE, knot_space, space[inverse], c->horizon_ratio, nu)
             : between(M_PLANE, knot_plane, plane[inverse], c->horizon_ratio, nu);
}

double bw_pd_state__correspondence_crack(const bw_pd_body_config *c, bool uniform, double nu)
{
  /* Cubic weights at nu = 0.1, 0.25, 0.4, for m = 2 and 3: strips of 24 cells in plane strain.
   * Uniform ones need 1.25 times as much (the same at nu = 0.25 and 0.3, m = 3). */
  enum { KNOTS = 3 };
  static const double knot[KNOTS] = {0.1, 0.25, 0.4};
  static const double cubic[2][KNOTS] = {{1.079, 1.295, 2.522}, {0.837, 0.942, 1.317}};
  const double share = fmax(0, fmin(1, c->horizon_ratio - 2)), at = fmax(0.1, fmin(0.4, nu));
  double row[2] = {0};
  /* The parabola through the three (Lagrange's form). */
  for (int k = 0; k < KNOTS; k++) {
    double weight = 1;
    for (int j = 0; j < KNOTS; j++)
      if (j != k) weight *= (at - knot[j]) / (knot[k] - knot[j]);
    for (int q = 0; q < 2; q++)
      row[q] += weight * cubic[q][k];
  }
  return (uniform ? 1.25 : 1) * (row[0] + share * (row[1] - row[0]));
}
