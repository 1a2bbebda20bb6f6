/* A grid, a field, and a direct solve of div grad phi = f on it: periodic in x and z, walls in y.
 * BUILD modules=grid,poisson
 * TEST  ranks=1,2,4 */
#include "bw_memory.h"
#include "bw_poisson.h"
#include <math.h>

static const double pi = 3.141592653589793;

/* -k^2 as differences over h see it. */
static double second_difference(double k, double h)
{
  return -pow(2.0 * sin(0.5 * k * h) / h, 2);
}

/* f of a wave whose second derivative on the walls' normal vanishes there. */
static bw_status make_field(const bw_comm *world, bw_grid **grid, bw_real **f)
{
  bw_grid_config box = bw_grid_config_default();
  box.n[0] = 32, box.n[1] = 24, box.n[2] = 16;
  box.length[0] = 2.0, box.length[1] = box.length[2] = 1.0;
  box.periodic[0] = box.periodic[2] = true;
  BW_TRY(bw_grid_create(world, &box, grid));
  BW_TRY(bw_field_create(*grid, f));
  const bw_grid_view *g = bw_grid_look(*grid); /* m cells are this rank's, behind lo others */
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const double x = (i - 0.5) * g->spacing[0], y = g->y_centre[g->lo[1] + j];
        const double z = (g->lo[2] + k - 0.5) * g->spacing[2];
        (*f)[bw_at(g, i, j, k)] = (bw_real)(cos(pi * x) * cos(pi * y) * cos(2 * pi * z));
      }
  bw_halo_update(*grid, 1, f); /* what lies beside this rank's cells is there now */
  return BW_OK;
}

static bw_status solve(bw_grid *grid, bw_real *phi)
{
  bw_poisson *p = NULL;
  const bw_poisson_side side[3][2] = {{BW_POISSON_PERIODIC, BW_POISSON_PERIODIC},
                                      {BW_POISSON_NEUMANN, BW_POISSON_NEUMANN},
                                      {BW_POISSON_PERIODIC, BW_POISSON_PERIODIC}};
  BW_TRY(bw_poisson_create(grid, side, &p));
  bw_poisson_solve(p, phi); /* f goes in, the solution of mean zero comes out */
  bw_halo_update(grid, 1, &phi);
  bw_poisson_destroy(&p);
  return BW_OK;
}

/* The wave is an eigenvector of the discrete operator too: f comes back divided by its eigenvalue,
 * but for rounding in a few transforms. */
static bw_status compare(const bw_grid *grid, const bw_real *f, const bw_real *phi)
{
  const bw_grid_view *g = bw_grid_look(grid);
  const double lambda = second_difference(pi, g->spacing[0]) +
                        second_difference(pi, g->spacing[1]) +
                        second_difference(2 * pi, g->spacing[2]);
  double worst = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t here = bw_at(g, i, j, k);
        worst = fmax(worst, fabs((double)phi[here] * lambda - (double)f[here]));
      }
  bw_comm_max(bw_grid_comm(grid), 1, &worst);
  BW_REQUIRE(worst < 100 * BW_REAL_EPSILON, BW_EDIVERGED, "phi is off by %g of f", worst);
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_grid *grid = NULL;
  bw_real *f = NULL, *phi = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, make_field(world, &grid, &f));
  BW_THEN(st, bw_field_create(grid, &phi));
  for (size_t q = 0; st == BW_OK && q < bw_grid_look(grid)->size; q++)
    phi[q] = f[q];
  BW_THEN(st, solve(grid, phi));
  BW_THEN(st, compare(grid, f, phi));
  bw_release(&f);
  bw_release(&phi);
  bw_grid_destroy(&grid);
  return bw_finish(&world, st);
}
