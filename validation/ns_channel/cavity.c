/* Claim: the flow in a lid-driven cavity (walls in x and y, one of them moving) is the known one.
 *
 * Reference: extrema along the centre lines. Re 100: Marchi, Suero & Araki 2009 (J. Braz. Soc.
 * Mech. Sci. Eng. 31, 186; 1024 x 1024 cells, extrapolated). Re 1000: Botella & Peyret 1998
 * (Computers & Fluids 27, 421; Chebyshev).
 *
 * Measured: from rest to t = 80 L/U (e^(-2 pi^2 80/Re) = 1e-7 of the slowest viscous mode is left
 * at Re 100), on 32^2 and 64^2 cells; --full also Re 1000 on 64^2 and 128^2 to t = 200. Extrema
 * through the parabola of three points.
 *
 * Tolerance: order 2 within 20 % (lid corners are singular: they feed terms of other powers).
 * Extrapolated: errors on 64^2 are about (pi/11)^2/8 = 1 % for a boundary layer of 11 cells, of
 * which terms of the fourth order leave (1 %)^2 x 8 = 1e-3. Re 1000: layers of Re^-1/2 have 7 cells
 * on 128^2: 2.5 %, and 5e-3 of that is left.
 *
 * TEST ranks=1,2 timeout=300 */
#include "flow.h"

#include <stdio.h>
#include <string.h>

enum { U_MIN, V_MAX, V_MIN, EXTREMA, LARGEST = 128 };

/* Highest value of the parabola through the highest of f[0..n-1] and its neighbours. */
static double highest(int n, const double f[])
{
  int q = 1;
  for (int i = 1; i < n - 1; i++)
    if (f[i] > f[q]) q = i;
  const double a = f[q + 1] - f[q - 1], b = f[q + 1] - 2.0 * f[q] + f[q - 1];
  return f[q] - a * a / (8.0 * b);
}

static bw_status cavity(const bw_comm *comm, double Re, int n, double until, double e[EXTREMA])
{
  const flow_box box = {
      .n = {n, n, 1}, .length = {1.0, 1.0, 1.0}, .periodic = {false, false, true}};
  bw_grid *grid = NULL;
  bw_ns_channel *ns = NULL;
  bw_ns_channel_config c = bw_ns_channel_config_default();
  c.nu = 1.0 / Re;
  c.side[1][1].velocity[0] = 1.0;
  BW_TRY(flow_create(comm, &box, &c, &grid, &ns));
  bw_status st = BW_OK;
  while (st == BW_OK && bw_ns_channel_time(ns) < until)
    st = bw_ns_channel_step(ns, 0.9 * bw_ns_channel_dt_max(ns));
  const bw_grid_view *g = bw_grid_look(grid);
  bw_real *const *u = bw_ns_channel_velocity(ns);
  double line[3][LARGEST];
  memset(line, 0, sizeof line);
  for (int j = 1; j <= g->m[1]; j++) {
    const int y = j + g->lo[1];
    line[U_MIN][y - 1] = -(double)u[0][bw_at(g, n / 2, j, 1)];
    for (int i = 1; i <= n && y == n / 2; i++) {
      line[V_MAX][i - 1] = (double)u[1][bw_at(g, i, j, 1)];
      line[V_MIN][i - 1] = -line[V_MAX][i - 1];
    }
  }
  bw_comm_sum(comm, 3 * LARGEST, line[0]);
  for (int q = 0; q < EXTREMA; q++)
    e[q] = (q == V_MAX ? 1.0 : -1.0) * highest(n, line[q]);
  flow_destroy(&grid, &ns);
  return st;
}

static bw_status rows(bw_validation *v, double Re, int n, double until, double tolerance,
                      const double reference[EXTREMA], const char *source)
{
  static const char *const name[] = {"u_min", "v_max", "v_min"};
  double coarse[EXTREMA], fine[EXTREMA];
  BW_TRY(cavity(bw_validation_comm(v), Re, n, until, coarse));
  BW_TRY(cavity(bw_validation_comm(v), Re, 2 * n, until, fine));
  for (int q = 0; q < EXTREMA; q++) {
    char claim[96], extra[96];
    snprintf(claim, sizeof claim, "lid-driven cavity, Re %g: %s, extrapolated", Re, name[q]);
    snprintf(extra, sizeof extra, "\"cells\": %d, \"fine_grid\": %.6f", 2 * n, fine[q]);
    bw_claim c = {.claim = claim,
                  .quantity = name[q],
                  .measured = fine[q] + (fine[q] - coarse[q]) / 3.0,
                  .reference = reference[q],
                  .tolerance = tolerance,
                  .kind = BW_PUBLISHED,
                  .source = source,
                  .extra = extra};
    bw_validation_row(v, &c);
    if (Re > 500.0) continue; /* 64^2 is too coarse there for an order */
    snprintf(claim, sizeof claim, "lid-driven cavity, Re %g: order of %s", Re, name[q]);
    c = (bw_claim){.claim = claim,
                   .quantity = "order",
                   .measured = bw_validation_order(2.0, fabs(coarse[q] - reference[q]), 1.0,
                                                   fabs(fine[q] - reference[q])),
                   .reference = 2.0,
                   .tolerance = 0.2,
                   .kind = BW_ORDER,
                   .source = source};
    bw_validation_row(v, &c);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const double re_100[EXTREMA] = {-0.2140417, 0.1795728, -0.2538030};
  static const double re_1000[EXTREMA] = {-0.3885698, 0.3769447, -0.5270771};
  BW_TRY(rows(v, 100.0, 32, 80.0, 1e-3, re_100, "Marchi, Suero & Araki 2009"));
  if (!bw_validation_full(v)) return BW_OK;
  return rows(v, 1000.0, 64, 200.0, 5e-3, re_1000, "Botella & Peyret 1998");
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ns_channel.cavity", run);
}
