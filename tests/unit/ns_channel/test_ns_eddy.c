/* Eddy viscosity (WALE): its value in linear fields, nothing in shear and at walls, energy taken
 * and momentum kept, the same on any number of ranks, its share of the step's limit.
 * TEST ranks=1,2,3,4 */
#include "ns_support.h"

#include <math.h>

static const bool all[3] = {true, true, true}, channel[3] = {true, false, true};
enum { N = 8 };

static bw_ns_channel *box(const bool periodic[3], double nu, double stretch, bw_ns_viscous viscous)
{
  const int n[3] = {N, N, N};
  const double length[3] = {1.0, 1.5, 0.7};
  bw_ns_channel_config c = ns_config(periodic, nu);
  c.eddy = BW_EDDY_WALE, c.viscous = viscous;
  return ns_solver(ns_grid(bw_check_world(), n, length, periodic, stretch, 1), &c);
}

/* u = A x with its trace zero: the discrete gradient is A where no halo wraps around. */
typedef struct {
  double A[3][3];
} linear;

static void linear_velocity(const double x[3], double t, void *context, double u[3])
{
  const linear *f = context;
  (void)t;
  for (int c = 0; c < 3; c++)
    u[c] = f->A[c][0] * x[0] + f->A[c][1] * x[1] + f->A[c][2] * x[2];
}

/* Put the field there as it is: the periodic box would project it otherwise. */
static void put(bw_ns_channel *ns, bw_ns_velocity_fn f, void *context)
{
  const bw_grid_view *g = ns->g;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k <= g->m[2] + 1; k++)
      for (int j = 0; j <= g->m[1] + 1; j++)
        for (int i = 0; i <= g->m[0] + 1; i++) {
          double u[3];
          const double x[3] = {(i + g->lo[0] - (c == 0 ? 0.0 : 0.5)) * g->spacing[0],
                               (j + g->lo[1] - (c == 1 ? 0.0 : 0.5)) * g->spacing[1],
                               (k + g->lo[2] - (c == 2 ? 0.0 : 0.5)) * g->spacing[2]};
          f(x, 0.0, context, u);
          ns->u[c][bw_at(g, i, j, k)] = (bw_real)u[c];
        }
  bw_ns__eddy_update(ns);
}

/* The formula of Nicoud & Ducros by determinants and invariants: with S, W the symmetric and the
 * antisymmetric part, S^d:S^d = (S2 S2 + W2 W2)/6 + 2/3 S2 W2 + 2 IV, S2 = S:S, W2 = W:W,
 * IV = S_ik S_kj W_jl W_li (their equation 12). */
static double wale_by_invariants(double A[3][3])
{
  double S[3][3], W[3][3], S2 = 0, W2 = 0, IV = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      S[i][j] = 0.5 * (A[i][j] + A[j][i]), W[i][j] = 0.5 * (A[i][j] - A[j][i]);
      S2 += S[i][j] * S[i][j], W2 += W[i][j] * W[i][j];
    }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++)
        for (int l = 0; l < 3; l++)
          IV += S[i][k] * S[k][j] * W[j][l] * W[l][i];
  const double d = (S2 * S2 + W2 * W2) / 6 + 2.0 / 3.0 * S2 * W2 + 2 * IV;
  return pow(d, 1.5) / (pow(S2, 2.5) + pow(d, 1.25));
}

START_TEST(linear_fields_have_the_published_viscosity)
{
  /* Strain; rotation; both; any. */
  const linear fields[] = {{{{1, 0, 0}, {0, -2, 0}, {0, 0, 1}}},
                           {{{0, -1, 0}, {1, 0, 0}, {0, 0, 0}}},
                           {{{1, 2, 0}, {-1, 0.5, 0.3}, {0, 0.7, -1.5}}},
                           {{{0.3, -1.1, 0.4}, {0.9, 0.2, -0.6}, {1.3, 0.8, -0.5}}}};
  bw_ns_channel *ns = box(all, 0.01, 0, BW_VISCOUS_EXPLICIT);
  const double volume = 1.0 / N * 1.5 / N * 0.7 / N;
  for (size_t q = 0; q < sizeof fields / sizeof *fields; q++) {
    linear f = fields[q];
    put(ns, linear_velocity, &f);
    const double size = 0.325 * cbrt(volume), expected = size * size * wale_by_invariants(f.A);
    for (int k = 1; k <= ns->g->m[2]; k++)
      for (int j = 1; j <= ns->g->m[1]; j++)
        for (int i = 1; i <= ns->g->m[0]; i++)
          bw_check_near((double)bw_ns_channel_eddy_viscosity(ns)[bw_at(ns->g, i, j, k)] / expected,
                        1.0, NS_TOLERANCE(1e-12));
  }
  ns_free(&ns);
}
END_TEST

static void shear(const double x[3], double t, void *context, double u[3])
{
  (void)t, (void)context;
  /* Plane Poiseuille flow, and a spanwise one: laminar. */
  u[0] = x[1] * (1.5 - x[1]), u[1] = 0.0, u[2] = 0.5 * x[1];
}

/* In a laminar channel the model does nothing, to the last bit of the velocity. */
START_TEST(laminar_shear_has_none)
{
  bw_ns_channel *ns = box(channel, 0.01, 1.2, BW_VISCOUS_EXPLICIT);
  bw_check_ok(bw_ns_channel_set_velocity(ns, shear, NULL, 0.0));
  double most = 0.0;
  for (int k = 1; k <= ns->g->m[2]; k++)
    for (int j = 1; j <= ns->g->m[1]; j++)
      for (int i = 1; i <= ns->g->m[0]; i++)
        most = fmax(most, (double)ns->eddy.nu[bw_at(ns->g, i, j, k)]);
  /* Gradients across the stream are round-off e: S^d is of order e S^2, nu_t of e^(3/2). */
  ck_assert_double_le(most, NS_TOLERANCE(1e-14));
  ns_free(&ns);
}
END_TEST

/* Near a wall nu_t falls as y^3: u ~ y, w ~ y, v ~ y^2 there. */
static void near_wall(const double x[3], double t, void *context, double u[3])
{
  const double pi = acos(-1.0), a = 2 * pi * x[0], b = 2 * pi * x[2] / 0.7, y = x[1];
  (void)t, (void)context;
  u[0] = y * (1 + 0.5 * sin(a) * cos(b)), u[2] = 0.3 * y * cos(a) * sin(b);
  /* dv/dy = -(du/dx + dw/dz). */
  u[1] = -0.5 * y * y * (pi * cos(a) * cos(b) + 0.3 * 2 * pi / 0.7 * cos(a) * cos(b));
}

START_TEST(it_vanishes_as_the_third_power_at_a_wall)
{
  /* Mean of nu_t/Delta^2 over the planes of the first rows of a fine grid in y: exponents between
   * neighbours. */
  const int n[3] = {16, 64, 16};
  const double length[3] = {1.0, 0.2, 0.7};
  bw_ns_channel_config c = ns_config(channel, 0.01);
  c.eddy = BW_EDDY_WALE;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, channel, 0, 1), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, near_wall, NULL, 0.0));
  /* As given, not projected: the far wall is not part of it. */
  const bw_grid_view *g = ns->g;
  for (int q = 0; q < 3; q++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = q == 1 ? 0 : 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          double u[3];
          const double x[3] = {(i - (q == 0 ? 0.0 : 0.5)) * g->spacing[0],
                               q == 1 ? g->y_face[j + g->lo[1]] : g->y_centre[j + g->lo[1]],
                               (k + g->lo[2] - (q == 2 ? 0.0 : 0.5)) * g->spacing[2]};
          near_wall(x, 0.0, NULL, u);
          ns->u[q][bw_at(g, i, j, k)] = (bw_real)u[q];
        }
  bw_ns_channel_refresh(ns);
  double sum[2] = {0.0, 0.0};
  static const int row[2] = {4, 8};
  for (int q = 0; q < 2; q++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int i = 1; i <= g->m[0] && row[q] > g->lo[1] && row[q] <= g->lo[1] + g->m[1]; i++)
        sum[q] += (double)ns->eddy.nu[bw_at(g, i, row[q] - g->lo[1], k)];
  bw_comm_sum(bw_check_world(), 2, sum);
  /* Heights 3.5 and 7.5 cells, 1 and 2 % of the wave length: the next power is 5 % of it. */
  bw_check_near(log(sum[1] / sum[0]) / log(7.5 / 3.5), 3.0, 0.15);
  ns_free(&ns);
}
END_TEST

/* Sum of u . force over the momentum cells, and of force alone. */
static void balance(bw_ns_channel *ns, double power[4])
{
  const bw_grid_view *g = ns->g;
  for (int q = 0; q < 4; q++)
    power[q] = 0.0;
  for (int c = 0; c < 3; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const double height = c == 1 ? ns->metrics.dyc[j] : ns->metrics.dyf[j];
          const ptrdiff_t at = bw_at(g, i, j, k);
          if (c == 1 && ns->plane[1][1].here && j == g->m[1]) continue; /* the wall's face */
          power[0] += height * (double)ns->u[c][at] * (double)ns->eddy.force[c][at];
          power[1 + c] += height * (double)ns->eddy.force[c][at];
        }
  bw_comm_sum(bw_check_world(), 4, power);
}

START_TEST(it_takes_energy_and_keeps_momentum)
{
  /* Dissipation by the definition of the scheme: 2 nu_t du_c/dx_c^2 at centres, nu_t (du_c/dx_d +
   * du_d/dx_c)^2 on edges; here in a uniform periodic box. */
  bw_ns_channel *ns = box(all, 0.01, 0, BW_VISCOUS_EXPLICIT);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_noise, NULL, 0.0));
  bw_ns__eddy_force(ns);
  double power[4], loss = 0.0;
  balance(ns, power);
  const bw_grid_view *g = ns->g;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k), *s = g->stride;
        const double dy = g->spacing[1];
        for (int c = 0; c < 3; c++) {
          const bw_real *u = ns->u[c] + at, *nu = ns->eddy.nu + at;
          const double e = ((double)u[0] - (double)u[-s[c]]) / g->spacing[c];
          loss += dy * 2 * (double)nu[0] * e * e;
          const int d = (c + 1) % 3;
          const bw_real *v = ns->u[d] + at;
          const double f = ((double)u[s[d]] - (double)u[0]) / g->spacing[d] +
                           ((double)v[s[c]] - (double)v[0]) / g->spacing[c];
          loss += dy * f * f * 0.25 *
                  ((double)nu[0] + (double)nu[s[c]] + (double)nu[s[d]] + (double)nu[s[c] + s[d]]);
        }
      }
  bw_comm_sum(bw_check_world(), 1, &loss);
  ck_assert_double_gt(loss, 0.0);
  bw_check_near(power[0] / loss, -1.0, NS_TOLERANCE(1e-12));
  for (int c = 0; c < 3; c++)
    bw_check_near(power[1 + c] / loss, 0.0, NS_TOLERANCE(1e-12));
  ns_free(&ns);
  /* Between walls, stretched, it takes energy, too. */
  ns = box(channel, 0.01, 1.5, BW_VISCOUS_EXPLICIT);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_noise, NULL, 0.0));
  bw_ns__eddy_force(ns);
  balance(ns, power);
  ck_assert_double_lt(power[0], 0.0);
  ns_free(&ns);
}
END_TEST

/* The limit counts it: at dt_max noise decays with each viscous term, however weak the molecular
 * one is, and ranks do not show. */
START_TEST(steps_are_stable_and_the_same_on_all_ranks)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  for (int viscous = BW_VISCOUS_EXPLICIT; viscous <= BW_VISCOUS_IMPLICIT; viscous++) {
    bw_ns_channel *many = box(channel, 1e-9, 1.2, (bw_ns_viscous)viscous);
    const int n[3] = {N, N, N};
    const double length[3] = {1.0, 1.5, 0.7};
    bw_ns_channel_config c = *bw_ns_channel_settings(many);
    bw_ns_channel *one = ns_solver(ns_grid(self, n, length, channel, 1.2, 1), &c);
    bw_check_ok(bw_ns_channel_set_velocity(many, ns_noise, NULL, 0.0));
    bw_check_ok(bw_ns_channel_set_velocity(one, ns_noise, NULL, 0.0));
    double before = bw_ns_channel_summary(many).kinetic_energy;
    for (int step = 0; step < 4; step++) {
      const double dt = 0.95 * bw_ns_channel_dt_max(one);
      bw_check_near(bw_ns_channel_dt_max(many) / bw_ns_channel_dt_max(one), 1.0,
                    NS_TOLERANCE(1e-10));
      bw_check_ok(bw_ns_channel_step(many, dt));
      bw_check_ok(bw_ns_channel_step(one, dt));
      const double now = bw_ns_channel_summary(many).kinetic_energy;
      ck_assert_double_lt(now, before);
      before = now;
    }
    bw_check_near(before / bw_ns_channel_summary(one).kinetic_energy, 1.0, NS_TOLERANCE(1e-10));
    ns_free(&many);
    ns_free(&one);
  }
  bw_comm_destroy(&self);
}
END_TEST

/* The same in every plane of z. */
static void plane_flow(const double x[3], double t, void *context, double u[3])
{
  const double two_pi = 2.0 * acos(-1.0), a = two_pi * x[0], b = two_pi * x[1] / 1.5;
  (void)t, (void)context;
  u[0] = sin(b) + 0.3 * cos(2 * b), u[1] = 0.7 * sin(a), u[2] = cos(a) * sin(b);
}

/* Planes of a flow that does not depend on z stay alike: every cell takes its part of the force. */
START_TEST(planes_stay_alike)
{
  bw_ns_channel *ns = box(all, 1e-9, 0, BW_VISCOUS_EXPLICIT);
  const bw_grid_view *g = ns->g;
  bw_check_ok(bw_ns_channel_set_velocity(ns, plane_flow, NULL, 0.0));
  for (int step = 0; step < 3; step++)
    bw_check_ok(bw_ns_channel_step(ns, 0.5 * bw_ns_channel_dt_max(ns)));
  for (int c = 0; c < 3; c++)
    for (int k = 2; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++)
          bw_check_near((double)ns->u[c][bw_at(g, i, j, k)], (double)ns->u[c][bw_at(g, i, j, 1)],
                        NS_TOLERANCE(1e-12));
  ns_free(&ns);
}
END_TEST

static double energy_after(int steps)
{
  const int n[3] = {N, N, N};
  const double length[3] = {1.0, 1.5, 0.7}, end = 0.12;
  bw_ns_channel_config c = ns_config(all, 1e-9);
  c.eddy = BW_EDDY_WALE, c.eddy_constant = 1.0;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, all, 0, 1), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_smooth, NULL, 0.0));
  for (int step = 0; step < steps; step++)
    bw_check_ok(bw_ns_channel_step(ns, end / steps));
  const double energy = bw_ns_channel_summary(ns).kinetic_energy;
  ns_free(&ns);
  return energy;
}

/* As a part of R it is of the order of the scheme, three. */
START_TEST(it_is_of_third_order_in_time)
{
  if (sizeof(bw_real) < sizeof(double)) return; /* differences of 1e-6 of the energy */
  const double a = energy_after(6), b = energy_after(12), c = energy_after(24);
  bw_check_near(log2((a - b) / (b - c)), 3.0, 0.2);
}
END_TEST

START_TEST(what_cannot_be_is_refused)
{
  const int flat[3] = {4, 4, 1};
  const double length[3] = {1, 1, 1};
  bw_ns_channel_config c = ns_config(all, 0.1);
  c.eddy = BW_EDDY_WALE;
  bw_grid *grid = ns_grid(bw_check_world(), flat, length, all, 0, 1);
  bw_ns_channel *ns = NULL;
  bw_check_status(bw_ns_channel_create(grid, &c, &ns), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "two dimensions"));
  bw_grid_destroy(&grid);
  ns = box(all, 0.1, 0, BW_VISCOUS_EXPLICIT);
  bw_check_status(bw_ns_channel_watch_box(ns, (int[3]){0, 0, 0}, (int[3]){1, 1, 1}), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "eddy viscosity"));
  c = *bw_ns_channel_settings(ns), c.eddy_constant = NAN;
  bw_ns_channel *bad = NULL;
  bw_check_status(bw_ns_channel_create(bw_ns_channel_grid(ns), &c, &bad), BW_EINPUT);
  ns_free(&ns);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(linear_fields_have_the_published_viscosity),
                                      BW_TEST(laminar_shear_has_none),
                                      BW_TEST(it_vanishes_as_the_third_power_at_a_wall),
                                      BW_TEST(it_takes_energy_and_keeps_momentum),
                                      BW_TEST(steps_are_stable_and_the_same_on_all_ranks),
                                      BW_TEST(planes_stay_alike),
                                      BW_TEST(it_is_of_third_order_in_time),
                                      BW_TEST(what_cannot_be_is_refused)};
BW_CHECK_MAIN("ns_channel.eddy", tests)
