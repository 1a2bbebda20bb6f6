/* The spatial operators by themselves: exact on polynomials, conservative, blind to tiles.
 * TEST ranks=1,2,4 */
#include "ns_support.h"

static const double box[3] = {1.5, 1.0, 0.8};
static const bool closed[3] = {false, false, false}, open3[3] = {true, true, true};

/* Coordinates of the point (i, j, k) of component c. */
static void point(const bw_grid_view *g, int c, int i, int j, int k, double x[3])
{
  const int at[3] = {i + g->lo[0], j + g->lo[1], k + g->lo[2]};
  for (int d = 0; d < 3; d++)
    x[d] = (at[d] - (c == d ? 0.0 : 0.5)) * g->spacing[d];
}

typedef double (*scalar_fn)(int c, const double x[3]);

static void fill(bw_ns_channel *ns, scalar_fn f)
{
  const bw_grid_view *g = ns->g;
  const int h2 = g->halo[2];
  for (int c = 0; c < 4; c++) /* 3: p */
    for (int k = 1 - h2; k <= g->m[2] + h2 && (c == 3 || ns->u[c] != NULL); k++)
      for (int j = 0; j <= g->m[1] + 1; j++)
        for (int i = 0; i <= g->m[0] + 1; i++) {
          double x[3];
          point(g, c, i, j, k, x);
          (c == 3 ? ns->p : ns->u[c])[bw_at(g, i, j, k)] = (bw_real)f(c, x);
        }
}

/* Largest difference of field c (0..2 u, 3..5 R) from f in the interior. */
static double worst(const bw_ns_channel *ns, int c, scalar_fn f)
{
  const bw_grid_view *g = ns->g;
  double most = 0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double x[3];
        point(g, c % 3, i, j, k, x);
        const bw_real *field = c < 3 ? ns->u[c] : ns->R[c - 3];
        const double error = fabs((double)field[bw_at(g, i, j, k)] - f(c % 3, x));
        most = isfinite(error) ? fmax(most, error) : (double)INFINITY;
      }
  return most;
}

/* u = 1 + 2x - 3y + z, v = 2 - x + y + 4z, w = -1 + x + 2y - z; p = 5x - 7y + 2z. Products of
 * linear functions are integrated exactly by mid-points, so every term is exact. */
static double linear(int c, const double x[3])
{
  static const double a[4][4] = {{1, 2, -3, 1}, {2, -1, 1, 4}, {-1, 1, 2, -1}, {0, 5, -7, 2}};
  return a[c][0] + a[c][1] * x[0] + a[c][2] * x[1] + a[c][3] * x[2];
}

/* -d(u_c u_d)/dx_d by the product rule; div u = 2 + 1 - 1 = 2. */
static double linear_rhs(int c, const double x[3])
{
  static const double grad[3][3] = {{2, -3, 1}, {-1, 1, 4}, {1, 2, -1}};
  double n = 2.0 * linear(c, x);
  for (int d = 0; d < 3; d++)
    n += linear(d, x) * grad[c][d];
  return -n;
}

static const double source[3] = {0.125, 0.375, -0.25};
static double linear_after(int c, const double x[3])
{
  static const double grad_p[3] = {5, -7, 2};
  return linear(c, x) + 0.5 * linear_rhs(c, x) - 0.25 * grad_p[c] + source[c];
}

START_TEST(linear_fields_are_exact)
{
  const int n[3] = {7, 6, 5};
  bw_ns_channel_config c = ns_config(closed, 0.01);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, closed, 0, 1), &c);
  fill(ns, linear);
  ns->sweep.alpha_dt = (bw_real)0.5;
  ns->sweep.gamma_dt = (bw_real)0.25;
  for (int d = 0; d < 3; d++)
    ns->sweep.source[d] = (bw_real)source[d];
  bw_ns__momentum_sweep(&ns->sweep, 0);
  for (int q = 0; q < 3; q++) {
    /* 100: cancellation in differences over dx = 0.2 of fluxes of order 20 */
    bw_check_near(worst(ns, q + 3, linear_rhs), 0.0, NS_TOLERANCE(100 * 1e-14));
    bw_check_near(worst(ns, q, linear_after), 0.0, NS_TOLERANCE(100 * 1e-14));
  }
  ns_free(&ns);
}
END_TEST

/* One component depends on one other coordinate only, so convection vanishes: nu lap is left. */
static double quadratic(int c, const double x[3])
{
  return c == 0 ? 3 * x[1] * x[1] - 2 * x[2] * x[2] : 0.0;
}
static double quadratic_rhs(int c, const double x[3])
{
  (void)x;
  return c == 0 ? 0.5 * (6 - 4) : 0.0;
}
static double quadratic_v(int c, const double x[3])
{
  return c == 1 ? 3 * x[0] * x[0] + x[2] * x[2] : 0.0;
}
static double quadratic_v_rhs(int c, const double x[3])
{
  (void)x;
  return c == 1 ? 0.5 * (6 + 2) : 0.0;
}
static double quadratic_w(int c, const double x[3])
{
  return c == 2 ? -x[0] * x[0] + 4 * x[1] * x[1] : 0.0;
}
static double quadratic_w_rhs(int c, const double x[3])
{
  (void)x;
  return c == 2 ? 0.5 * (-2 + 8) : 0.0;
}

START_TEST(viscous_term_of_quadratics_is_exact)
{
  const int n[3] = {6, 6, 6};
  const scalar_fn field[] = {quadratic, quadratic_v, quadratic_w};
  const scalar_fn rhs[] = {quadratic_rhs, quadratic_v_rhs, quadratic_w_rhs};
  bw_ns_channel_config c = ns_config(closed, 0.5);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, closed, 0, 1), &c);
  for (int f = 0; f < 3; f++) {
    fill(ns, field[f]);
    bw_ns__momentum_sweep(&ns->sweep, 0);
    for (int q = 0; q < 3; q++)
      bw_check_near(worst(ns, q + 3, rhs[f]), 0.0, NS_TOLERANCE(1e-12)); /* eps u/dx^2 */
  }
  ns_free(&ns);
}
END_TEST

static double zero_field(int c, const double x[3])
{
  (void)c, (void)x;
  return 0.0;
}
static double remembered(int c, const double x[3])
{
  (void)x;
  return c == 0 ? 3 * 2.0 : c == 1 ? 3 * -1.0 : 3 * 0.5;
}

/* Stage 1 adds beta R_prev and keeps the new R (zero here); stage 0 does not read it. */
START_TEST(previous_right_hand_side_enters_with_beta)
{
  const int n[3] = {5, 5, 5};
  bw_ns_channel_config c = ns_config(open3, 0.5);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, open3, 0, 1), &c);
  for (int stage = 0; stage < 3; stage++) {
    fill(ns, zero_field);
    for (int q = 0; q < 3; q++)
      for (size_t at = 0; at < ns->g->size; at++)
        ns->R[q][at] = (bw_real)(q == 0 ? 2.0 : q == 1 ? -1.0 : 0.5);
    ns->sweep.beta_dt = 3;
    ns->sweep.alpha_dt = 7;
    ns->sweep.source[0] = 0;
    bw_ns__momentum_sweep(&ns->sweep, stage);
    for (int q = 0; q < 3; q++) {
      bw_check_near(worst(ns, q, stage == 0 ? zero_field : remembered), 0.0, 0.0);
      if (stage < 2) bw_check_near(worst(ns, q + 3, zero_field), 0.0, 0.0);
    }
  }
  ns_free(&ns);
}
END_TEST

START_TEST(tiles_do_not_show)
{
  const int n[3] = {8, 12, 8};
  bw_ns_channel_config c = ns_config(closed, 0.01);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, closed, 1.2, 1), &c);
  bw_ns_channel *one = ns_solver(ns_grid(bw_check_world(), n, box, closed, 1.2, 1), &c);
  ck_assert_int_eq(ns->sweep.tile, ns->g->m[1]);
  one->sweep.tile = 2;
  for (int q = 0; q < 2; q++) {
    bw_ns_channel *s = q == 0 ? ns : one;
    bw_check_ok(bw_ns_channel_set_velocity(s, ns_noise, NULL, 0));
    s->sweep.alpha_dt = s->sweep.gamma_dt = (bw_real)0.01;
    bw_ns__momentum_sweep(&s->sweep, 0);
  }
  for (int q = 0; q < 3; q++)
    for (size_t at = 0; at < ns->g->size; at++)
      ck_assert(ns->u[q][at] == one->u[q][at]);
  ns_free(&ns);
  ns_free(&one);
}
END_TEST

/* sum over points of u_c R_c dV and of |u_c R_c| dV. */
static void energy_rate(const bw_ns_channel *ns, bw_real *const u[3], double rate[2])
{
  const bw_grid_view *g = ns->g;
  rate[0] = rate[1] = 0.0;
  for (int c = 0; c < ns->components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const double height = c == 1 ? ns->metrics.dyc[j] : ns->metrics.dyf[j];
          const ptrdiff_t at = bw_at(g, i, j, k);
          const double e = (double)u[c][at] * (double)ns->R[c][at] * height;
          rate[0] += e;
          rate[1] += fabs(e);
        }
  bw_comm_sum(ns->comm, 2, rate);
}

/* Convection neither makes nor destroys kinetic energy where div u = 0: noise, all kinds of
 * sides, stretched y, 2D and 3D. Removing the heights' shares, or a factor in any of the nine
 * fluxes, shows. */
START_TEST(convection_keeps_energy)
{
  static const struct {
    int n[3];
    bool periodic[3];
    double stretch;
  } cases[] = {{{9, 8, 7}, {true, true, true}, 0},      {{9, 8, 7}, {true, false, true}, 1.7},
               {{9, 8, 7}, {false, false, false}, 1.7}, {{9, 8, 1}, {false, false, true}, 1.7},
               {{9, 8, 1}, {true, true, true}, 0},      {{8, 9, 8}, {false, true, false}, 0}};
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_ns_channel_config c = ns_config(cases[q].periodic, 0.01);
    bw_grid *grid =
        ns_grid(bw_check_world(), cases[q].n, box, cases[q].periodic, cases[q].stretch, 1);
    bw_ns_channel *ns = ns_solver(grid, &c);
    bw_check_ok(bw_ns_channel_set_velocity(ns, ns_noise, NULL, 0));
    ns->sweep.nu = 0;
    ns->sweep.alpha_dt = ns->sweep.gamma_dt = ns->sweep.source[0] = 0; /* u stays */
    bw_ns__momentum_sweep(&ns->sweep, 0);
    double rate[2];
    energy_rate(ns, ns->u, rate);
    ck_assert_msg(rate[1] > 0.1, "case %zu: there is no convection", q);
    /* the sum's round-off and that of the divergence, against the sum of magnitudes */
    ck_assert_msg(fabs(rate[0]) < NS_TOLERANCE(2e-14) * rate[1], "case %zu: %g of %g", q, rate[0],
                  rate[1]);
    ns_free(&ns);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(linear_fields_are_exact),
                                      BW_TEST(viscous_term_of_quadratics_is_exact),
                                      BW_TEST(previous_right_hand_side_enters_with_beta),
                                      BW_TEST(tiles_do_not_show), BW_TEST(convection_keeps_energy)};
BW_CHECK_MAIN("ns_channel.kernels", tests)
