/* How the surface turns: the rigid rotation of each surface particle's family. */
#include "pd_interface_internal.h"

#include <math.h>
#include <string.h>

/* Sums over the partners present: Gamma, Gamma x, Gamma v, Gamma x x^T, Gamma x v^T; x and v
 * relative to the particle. */
typedef struct {
  double weight, x[3], v[3], xx[3][3], xv[3][3];
} family_sums;

static void sum_family(const bw_pd_interface *pi, const bw_real *X, const double *V, size_t h,
                       family_sums *s)
{
  const bw_pd_interface__near *partner = &pi->pool[pi->row[h]];
  memset(s, 0, sizeof *s);
  for (size_t q = 0; !pi->stale[h] && q < pi->row_n[h]; q++) {
    if (partner[q].cross != 0 || partner[q].partner < 0) continue; /* an image in a wall */
    const double fraction = pi->stencil.fraction[partner[q].slot];
    const size_t l = (size_t)partner[q].partner;
    double x[3], v[3];
    for (size_t d = 0; d < 3; d++) {
      x[d] = (double)X[3 * l + d] - (double)X[3 * h + d];
      v[d] = V[3 * l + d] - V[3 * h + d];
    }
    s->weight += fraction;
    for (int d = 0; d < 3; d++) {
      s->x[d] += fraction * x[d];
      s->v[d] += fraction * v[d];
      for (int e = 0; e < 3; e++) {
        s->xx[d][e] += fraction * x[d] * x[e];
        s->xv[d][e] += fraction * x[d] * v[e];
      }
    }
  }
}

static double determinant(double a[3][3])
{
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/* a x = b by Cramer's rule; x = 0 where a is singular (rods in space, lone particles). */
static void solve(double a[3][3], const double b[3], double x[3])
{
  const double trace = a[0][0] + a[1][1] + a[2][2], det = determinant(a);
  for (int c = 0; c < 3; c++) {
    double with_b[3][3];
    memcpy(with_b, a, sizeof with_b);
    for (int r = 0; r < 3; r++)
      with_b[r][c] = b[r];
    x[c] = det > 1e-6 * trace * trace * trace ? determinant(with_b) / det : 0.0;
  }
}

/* Least squares: v = v_mean + spin x (x - x_mean), the particle's own velocity left out (it carries
 * the waves of the lattice): I spin = sum Gamma (x - x_mean) x v. */
static void spin_of(const family_sums *s, const bw_pd_interface__stencil *g, double spin[3])
{
  double inertia[3][3], moment[3], trace = 0.0;
  memset(spin, 0, 3 * sizeof *spin);
  if (!(s->weight > 0.0)) return;
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    moment[d] =
        s->xv[e][f] - s->x[e] * s->v[f] / s->weight - (s->xv[f][e] - s->x[f] * s->v[e] / s->weight);
    trace += s->xx[d][d] - s->x[d] * s->x[d] / s->weight;
  }
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 3; e++)
      inertia[d][e] = (d == e) * trace - (s->xx[d][e] - s->x[d] * s->x[e] / s->weight);
  if (!(trace > 1e-6 * s->weight * g->ds * g->ds)) return; /* one partner: rounding is all */
  if (g->dims == 2)
    spin[2] = moment[2] / trace;
  else
    solve(inertia, moment, spin);
}

void bw_pd_interface_turn(bw_pd_interface *pi, double spin[])
{
  const bw_real *X = bw_pd_bond_get_extended(pi->pd).X;
  bw_pd_bond_get_velocity(pi->pd, pi->all_velocity);
  bw_pd_bond_fill_extended(pi->pd, 3 * sizeof(double), pi->all_velocity, pi->extended_velocity);
  for (size_t row = 0; row < pi->n_list; row++) {
    family_sums s;
    sum_family(pi, X, pi->extended_velocity, (size_t)pi->list[row], &s);
    spin_of(&s, &pi->stencil, spin + 3 * row);
  }
}
