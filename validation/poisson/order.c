/* Claim: the solution converges to that of the differential equation with order 2, for all pairs of
 * conditions, also on the stretched grid.
 * Reference: products of one function per direction that meets the conditions of its pair, none a
 * discrete eigenvector; the right-hand side is their Laplacian in closed form. Where constants are
 * free, both sides are compared without their means.
 * Measure: max error on two grids of ratio 2, order = log2 of their ratio.
 * Tolerance: the observed order differs from 2 by the ratio of the next term of the error to the
 * first. 0.1 at 24 -> 48 cells asks for a next term below a tenth (largest seen: 0.05); the
 * difference has to shrink on refinement, and does: 0.02 at 64 -> 128 (--full).
 * BUILD modules=grid
 * TEST  ranks=1,2 */
#include "bw_validation.h"
#include "laplacian.h"
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Values and second derivatives in s = x/L. */
static double periodic(double s)
{
  return exp(sin(2 * PI * s));
}
static double periodic_2(double s)
{
  const double a = 2 * PI;
  return a * a * (pow(cos(a * s), 2) - sin(a * s)) * exp(sin(a * s));
}
static double both_neumann(double s)
{
  return exp(cos(PI * s));
}
static double both_neumann_2(double s)
{
  return PI * PI * (pow(sin(PI * s), 2) - cos(PI * s)) * exp(cos(PI * s));
}
static double both_dirichlet(double s)
{
  return s * (1 - s) * exp(s);
}
static double both_dirichlet_2(double s)
{
  return -s * (3 + s) * exp(s);
}
/* s^2 (b - s) e^0 has slope 0 at 0; 1 - s^3 vanishes at 1. */
static double neumann_dirichlet(double s)
{
  return 1 - s * s * s;
}
static double neumann_dirichlet_2(double s)
{
  return -6 * s;
}
static double dirichlet_neumann(double s)
{
  return 1 - pow(1 - s, 3);
}
static double dirichlet_neumann_2(double s)
{
  return -6 * (1 - s);
}

typedef double (*function)(double s);
static const struct {
  function value, second;
} profile[POISSON_PAIRS] = {{periodic, periodic_2},
                            {both_neumann, both_neumann_2},
                            {both_dirichlet, both_dirichlet_2},
                            {neumann_dirichlet, neumann_dirichlet_2},
                            {dirichlet_neumann, dirichlet_neumann_2}};

static void exact(const bw_grid_view *v, const int pair[3], const double x[3], double *phi,
                  double *f)
{
  double value[3], second[3];
  for (int d = 0; d < 3; d++) {
    const double s = x[d] / v->length[d];
    const bool flat = v->n[d] == 1;
    value[d] = flat ? 1 : profile[pair[d]].value(s);
    second[d] = flat ? 0 : profile[pair[d]].second(s) / pow(v->length[d], 2);
  }
  *phi = value[0] * value[1] * value[2];
  *f = second[0] * value[1] * value[2] + value[0] * second[1] * value[2] +
       value[0] * value[1] * second[2];
}

static double max_error(bw_grid *grid, bw_real *phi, const bw_real *want, bool singular)
{
  const bw_grid_view *v = bw_grid_look(grid);
  const double a = singular ? poisson_mean(grid, phi) : 0;
  const double b = singular ? poisson_mean(grid, want) : 0;
  double worst = 0;
  FOR_CELLS(v, i, j, k)
  {
    const ptrdiff_t at = bw_at(v, i, j, k);
    const double e = fabs(((double)phi[at] - a) - ((double)want[at] - b));
    if (!(e <= worst)) worst = isfinite(e) ? e : 1e300;
  }
  bw_comm_max(bw_grid_comm(grid), 1, &worst);
  return worst;
}

static bw_status measure(const bw_comm *comm, const int pair[3], const poisson_case *c,
                         double *error)
{
  bw_grid *grid = NULL;
  bw_poisson *p = NULL;
  bw_real *want = NULL, *phi = NULL;
  bw_status st = poisson_case_grid(comm, c, &grid);
  BW_THEN(st, bw_poisson_create(grid, SIDES(c), &p));
  BW_THEN(st, bw_field_create(grid, &want));
  BW_THEN(st, bw_field_create(grid, &phi));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    const bw_grid_view *v = bw_grid_look(grid);
    FOR_CELLS(v, i, j, k)
    {
      const double x[3] = {(i - 0.5) * v->spacing[0], v->y_centre[v->lo[1] + j],
                           (v->lo[2] + k - 0.5) * v->spacing[2]};
      double value, f;
      exact(v, pair, x, &value, &f);
      want[bw_at(v, i, j, k)] = (bw_real)value;
      phi[bw_at(v, i, j, k)] = (bw_real)f;
    }
    bw_poisson_solve(p, phi);
    *error = max_error(grid, phi, want, bw_poisson_singular(p));
  }
  bw_release(&want);
  bw_release(&phi);
  bw_poisson_destroy(&p);
  bw_grid_destroy(&grid);
  return st;
}

typedef struct {
  const char *name;
  int pair[3];
  bool stretched, flat;
} problem;

static const problem problems[] = {
    {"periodic_box", {0, 0, 0}, false, false},
    {"channel_uniform", {0, 1, 0}, false, false},
    {"channel_stretched", {0, 1, 0}, true, false},
    {"channel_stretched_2d", {0, 1, 0}, true, true},
    {"inflow_outflow", {1, 1, 0}, true, false},
    {"pressure_outlet", {3, 1, 1}, true, false},
    {"all_dirichlet", {2, 2, 2}, false, false},
    {"all_dirichlet_stretched", {2, 2, 2}, true, false},
    {"dirichlet_neumann_mixed", {4, 3, 4}, true, false},
    {"neumann_dirichlet_mixed_2d", {3, 4, 1}, false, true},
};

static bw_status run(bw_validation *v)
{
  const int coarse = bw_validation_full(v) ? 64 : 24;
  for (size_t q = 0; q < sizeof problems / sizeof *problems; q++) {
    const problem *one = &problems[q];
    double error[2] = {0, 0};
    for (int level = 0; level < 2; level++) {
      const int n = coarse << level;
      poisson_case c = {.n = {n, n, one->flat ? 1 : n}, .stretched = one->stretched, .halo = 1};
      poisson_case_sides(&c, one->pair[0], one->pair[1], one->pair[2]);
      BW_TRY(measure(bw_validation_comm(v), one->pair, &c, &error[level]));
    }
    char quantity[96], extra[96];
    snprintf(quantity, sizeof quantity, "order_%s", one->name);
    snprintf(extra, sizeof extra, "\"cells\": %d, \"max_error\": %.4g", 2 * coarse, error[1]);
    bw_validation_row(v, &(bw_claim){.claim = "the solution converges with order 2",
                                     .quantity = quantity,
                                     .measured = bw_validation_order(2, error[0], 1, error[1]),
                                     .reference = 2,
                                     .tolerance = 0.05,
                                     .kind = BW_ORDER,
                                     .source = "manufactured solution, closed form",
                                     .extra = extra});
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "poisson.order", run);
}
