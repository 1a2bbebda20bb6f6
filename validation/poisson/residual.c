/* Claim: the solver inverts the discrete operator exactly, for every pair of conditions in every
 * direction, uniform and stretched, 2D and 3D: the residual is at round-off.
 * Reference: zero. The operator is written out in laplacian.h from its definition (differences of
 * face gradients, ghost = +-cell at a boundary face), without transforms. For singular cases the
 * mean of f is removed, and phi has mean zero.
 * Measure: max |lap phi - f| over epsilon (max|f| + |lap| max|phi|), |lap| the row sum of the
 * operator; f is noise, which excites all modes. For each pair, the worst over all others.
 * Tolerance 8: evaluating seven products and sums costs up to about 4 such units at worst, and
 * phi's own round-off enters once more through the same operator.
 * BUILD modules=grid
 * TEST  ranks=1,2 */
#include "bw_validation.h"
#include "laplacian.h"
#include <stdio.h>
#include <string.h>

static const char *const pair_name[] = {"periodic", "neumann_neumann", "dirichlet_dirichlet",
                                        "neumann_dirichlet", "dirichlet_neumann"};

typedef struct {
  double residual, mean; /* the latter of phi, over max|phi| epsilon */
} measured;

static bw_status measure(const bw_comm *comm, const poisson_case *c, measured *out)
{
  bw_grid *grid = NULL;
  bw_poisson *p = NULL;
  bw_real *f = NULL, *phi = NULL;
  bw_status st = poisson_case_grid(comm, c, &grid);
  BW_THEN(st, bw_poisson_create(grid, SIDES(c), &p));
  BW_THEN(st, bw_field_create(grid, &f));
  BW_THEN(st, bw_field_create(grid, &phi));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    poisson_fill_noise(grid, f);
    memcpy(phi, f, bw_grid_look(grid)->size * sizeof *f);
    bw_poisson_solve(p, phi);
    const bool singular = bw_poisson_singular(p);
    const double mean = singular ? poisson_mean(grid, f) : 0;
    out->residual = poisson_residual(grid, c, 0, -1, mean, phi, f);
    out->mean = singular ? fabs(poisson_mean(grid, phi)) / BW_REAL_EPSILON : 0;
  }
  bw_release(&f);
  bw_release(&phi);
  bw_poisson_destroy(&p);
  bw_grid_destroy(&grid);
  return st;
}

static bool row(bw_validation *v, const char *direction, const char *pair, double residual)
{
  char quantity[128];
  snprintf(quantity, sizeof quantity, "residual_in_round_off_%s_%s", direction, pair);
  return bw_validation_row(v, &(bw_claim){.claim = "the discrete operator is inverted exactly",
                                          .quantity = quantity,
                                          .measured = residual,
                                          .reference = 0,
                                          .tolerance = 8,
                                          .kind = BW_ANALYTIC,
                                          .source = "definition of the discrete operator"});
}

static void keep_worst(double *worst, double value)
{
  if (!(value <= *worst)) *worst = value;
}

static bw_status run(bw_validation *v)
{
  static const int quick[2][3] = {{18, 15, 14}, {21, 16, 1}};
  static const int full[2][3] = {{96, 75, 70}, {144, 125, 1}};
  double worst[3][POISSON_PAIRS] = {{0}}, stretched = 0, mean = 0;
  for (int q = 0; q < 2 * 2 * 125; q++) {
    const int pair[3] = {q % 5, q / 5 % 5, q / 25 % 5}, flat = q / 125 % 2;
    poisson_case c = {.halo = 1, .stretched = q / 250 != 0};
    memcpy(c.n, bw_validation_full(v) ? full[flat] : quick[flat], sizeof c.n);
    poisson_case_sides(&c, pair[0], pair[1], pair[2]);
    if (c.stretched && pair[1] == 0) continue; /* a periodic y is uniform */
    if (flat && pair[2] > 1) continue;         /* one cell in z has no Dirichlet side */
    measured m = {0, 0};
    BW_TRY(measure(bw_validation_comm(v), &c, &m));
    for (int d = 0; d < 3; d++)
      keep_worst(&worst[d][pair[d]], m.residual);
    if (c.stretched) keep_worst(&stretched, m.residual);
    keep_worst(&mean, m.mean);
  }
  static const char *const axis[] = {"x", "y", "z"};
  for (int d = 0; d < 3; d++)
    for (int k = 0; k < POISSON_PAIRS; k++)
      row(v, axis[d], pair_name[k], worst[d][k]);
  row(v, "y", "stretched", stretched);
  /* phi is below 1: the mean of n numbers, each with one rounding error, has less than one. */
  bw_validation_row(v, &(bw_claim){.claim = "the solution of a singular problem has mean zero",
                                   .quantity = "mean_phi_over_epsilon",
                                   .measured = mean,
                                   .reference = 0,
                                   .tolerance = 1,
                                   .kind = BW_CONSERVATION,
                                   .source = "normalisation stated in bw_poisson.h"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "poisson.residual", run);
}
