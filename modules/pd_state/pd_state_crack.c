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

/* Ordinary, over a flat cut: constant, then inverse influence; rows of horizon ratios. */
static const double ordinary_plane[2][M_PLANE][NU] = {
    {{1.406, 1.574, 1.687, 1.829, 2.023, 2.318, 2.733},
     {1.290, 1.485, 1.587, 1.716, 1.892, 2.134, 2.277},
     {1.200, 1.324, 1.401, 1.496, 1.609, 1.783, 2.161},
     {1.082, 1.171, 1.232, 1.316, 1.389, 1.509, 1.837}},
    {{1.408, 1.593, 1.722, 1.887, 2.077, 2.391, 2.817},
     {1.263, 1.427, 1.539, 1.689, 1.911, 2.268, 2.444},
     {1.112, 1.255, 1.353, 1.481, 1.670, 2.060, 2.212},
     {1.019, 1.121, 1.187, 1.315, 1.485, 1.843, 1.943}}};
static const double ordinary_space[2][M_SPACE][NU] = {
    {{1.133, 1.287, 1.353, 1.496, 1.727, 2.296, 2.849},
     {0.905, 1.011, 1.073, 1.187, 1.295, 1.559, 1.794}},
    {{1.109, 1.232, 1.336, 1.475, 1.645, 1.990, 2.515},
     {0.927, 1.038, 1.117, 1.236, 1.348, 1.623, 1.867}}};

/* Correspondence, over E s0^2 horizon: cubic, then uniform weights. */
static const double correspondence_plane[2][M_PLANE][NU] = {
    {{1.233, 1.256, 1.342, 1.513, 1.863, 2.796, 4.191},
     {1.161, 1.139, 1.194, 1.310, 1.556, 2.228, 3.422},
     {1.143, 1.147, 1.188, 1.286, 1.482, 2.073, 3.143},
     {1.183, 1.151, 1.172, 1.233, 1.336, 1.716, 2.531}},
    {{1.200, 1.183, 1.236, 1.354, 1.605, 2.288, 3.492},
     {1.111, 1.120, 1.172, 1.268, 1.476, 2.043, 3.006},
     {1.199, 1.166, 1.192, 1.250, 1.335, 1.734, 2.476},
     {1.239, 1.234, 1.238, 1.316, 1.409, 1.620, 2.173}}};
static const double correspondence_space[2][M_SPACE][NU] = {
    {{1.674, 1.567, 1.626, 1.788, 2.061, 2.775, 4.138},
     {1.808, 1.746, 1.762, 1.842, 2.019, 2.530, 3.346}},
    {{1.700, 1.597, 1.683, 1.883, 2.172, 2.775, 3.862},
     {1.853, 1.800, 1.807, 1.951, 2.100, 2.513, 3.288}}};

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

/* One entry of a law's two tables, each (weight, horizon ratio, Poisson's ratio). */
static double cost(const bw_pd_body_config *c, const double plane[M_PLANE][NU],
                   const double space[M_SPACE][NU], double nu)
{
  return c->geometry == BW_PD_3D ? between(M_SPACE, knot_space, space, c->horizon_ratio, nu)
                                 : between(M_PLANE, knot_plane, plane, c->horizon_ratio, nu);
}

double bw_pd_state__ordinary_crack(const bw_pd_body_config *c, bool inverse, double nu)
{
  return cost(c, ordinary_plane[inverse], ordinary_space[inverse], nu);
}

double bw_pd_state__correspondence_crack(const bw_pd_body_config *c, bool uniform, double nu)
{
  return cost(c, correspondence_plane[uniform], correspondence_space[uniform], nu);
}
