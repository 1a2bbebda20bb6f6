/* Ghosts and faces of each kind of side; inflow profiles; mass balance; axes are alike.
 * TEST ranks=1,2,4 */
#include "ns_support.h"

static const bool closed[3] = {false, false, false};

static double at(const bw_ns_channel *ns, int c, int i, int j, int k)
{
  return (double)ns->u[c][bw_at(ns->g, i, j, k)];
}

/* A box with a moving lid, a free-slip floor, walls elsewhere; halo 2. */
START_TEST(ghosts_mirror_about_the_sides)
{
  const int n[3] = {6, 8, 6};
  const double length[3] = {1, 1, 1};
  bw_ns_channel_config c = ns_config(closed, 0.01);
  c.side[1][1].velocity[0] = 2.0;
  c.side[1][1].velocity[2] = -1.0;
  c.side[1][0].kind = BW_SIDE_FREE_SLIP;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 2), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_smooth, NULL, 0));
  const bw_grid_view *g = ns->g;
  const int m1 = g->m[1], m2 = g->m[2];
  const double tolerance = NS_TOLERANCE(1e-15);
  for (int q = 1; q <= 2; q++)
    for (int k = 1; k <= m2; k++)
      for (int i = 1; i < 6; i++) {
        if (g->first[1]) { /* free slip: even tangentially, odd and zero normally */
          bw_check_near(at(ns, 0, i, 1 - q, k), at(ns, 0, i, q, k), 0);
          bw_check_near(at(ns, 2, i, 1 - q, k), at(ns, 2, i, q, k), 0);
          bw_check_near(at(ns, 1, i, 0, k), 0.0, 0);
          if (q == 1) bw_check_near(at(ns, 1, i, -1, k), -at(ns, 1, i, 1, k), 0);
        }
        if (g->last[1]) { /* the mean across the lid is the lid's velocity */
          bw_check_near(at(ns, 0, i, m1 + q, k), 4.0 - at(ns, 0, i, m1 + 1 - q, k), tolerance);
          bw_check_near(at(ns, 2, i, m1 + q, k), -2.0 - at(ns, 2, i, m1 + 1 - q, k), tolerance);
          bw_check_near(at(ns, 1, i, m1, k), 0.0, 0);
          bw_check_near(at(ns, 1, i, m1 + q, k), -at(ns, 1, i, m1 - q, k), 0);
        }
      }
  for (int k = 1; k <= m2; k++)
    for (int j = 1; j <= m1; j++) { /* no-slip in x */
      bw_check_near(at(ns, 0, 0, j, k), 0.0, 0);
      bw_check_near(at(ns, 0, 6, j, k), 0.0, 0);
      bw_check_near(at(ns, 0, 8, j, k), -at(ns, 0, 4, j, k), 0);
      bw_check_near(at(ns, 1, 0, j, k), -at(ns, 1, 1, j, k), 0);
      bw_check_near(at(ns, 1, 8, j, k), -at(ns, 1, 5, j, k), 0);
      bw_check_near(at(ns, 2, -1, j, k), -at(ns, 2, 2, j, k), 0);
    }
  ns_free(&ns);
}
END_TEST

START_TEST(pressure_ghosts_are_even)
{
  const int n[3] = {6, 6, 6};
  const double length[3] = {1, 1, 1};
  bw_ns_channel_config c = ns_config(closed, 0.01);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 2), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_smooth, NULL, 0));
  bw_check_ok(bw_ns_channel_step(ns, 0.01));
  const bw_real *p = bw_ns_channel_pressure(ns);
  double most = 0;
  for (int k = 1; k <= ns->g->m[2]; k++)
    for (int j = 1; j <= ns->g->m[1]; j++)
      for (int q = 1; q <= 2; q++) {
        ck_assert(p[bw_at(ns->g, 1 - q, j, k)] == p[bw_at(ns->g, q, j, k)]);
        ck_assert(p[bw_at(ns->g, 6 + q, j, k)] == p[bw_at(ns->g, 7 - q, j, k)]);
        most = fmax(most, fabs((double)p[bw_at(ns->g, q, j, k)]));
      }
  ck_assert_double_gt(most, 1e-3);
  ns_free(&ns);
}
END_TEST

static bw_ns_channel_config in_out(bw_ns_profile profile)
{
  bw_ns_channel_config c = ns_config(closed, 0.02);
  c.side[0][0].kind = BW_SIDE_INFLOW;
  c.side[0][0].profile = profile;
  c.side[0][0].bulk_velocity = 1.5;
  c.side[0][0].velocity[0] = 1.5;
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  return c;
}

/* Beyond an outflow all ghosts are the last cell: what leaves goes on as it is. */
START_TEST(an_outflow_repeats_its_last_cells)
{
  const int n[3] = {6, 6, 6};
  const double length[3] = {1, 1, 1};
  const bw_ns_channel_config c = in_out(BW_PROFILE_UNIFORM);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 2), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_smooth, NULL, 0));
  const bw_grid_view *g = ns->g;
  double differ = 0.0;
  for (int c_ = 0; c_ < 3; c_++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++) {
        for (int q = 1; q <= 2; q++)
          bw_check_near(at(ns, c_, 6 + q, j, k), at(ns, c_, 6, j, k), 0);
        differ = fmax(differ, fabs(at(ns, c_, 6, j, k) - at(ns, c_, 5, j, k)));
      }
  ck_assert_double_gt(differ, 0.01); /* a mirror image would be another number */
  ns_free(&ns);
}
END_TEST

/* The Poiseuille profile brings exactly U_b H, is near 6 U_b y/H (1 - y/H), and what a step lets
 * out is what comes in. */
START_TEST(poiseuille_inflow_brings_its_bulk_velocity)
{
  const int n[3] = {8, 16, 1};
  const double length[3] = {1.0, 0.5, 0.1};
  bw_ns_channel_config c = in_out(BW_PROFILE_POISEUILLE);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 1.5, 1), &c);
  for (int step = 0; step < 5; step++) {
    const bw_ns_summary s = bw_ns_channel_summary(ns);
    bw_check_near(s.inflow, 1.5 * 0.5 * 0.1, NS_TOLERANCE(1e-15));
    bw_check_near(s.outflow, s.inflow, NS_TOLERANCE(1e-15));
    bw_check_near(bw_ns_channel_divergence(ns), 0.0, NS_TOLERANCE(1e-13));
    bw_check_ok(bw_ns_channel_step(ns, 0.25 * bw_ns_channel_dt_max(ns)));
  }
  for (int j = 1; j <= ns->g->m[1]; j++) {
    const double y = ns->g->y_centre[j + ns->g->lo[1]] / 0.5;
    /* 3 U_b (dy/H)^2 / 2 at most with the widest dy/H = 0.1 */
    ck_assert_double_eq_tol(at(ns, 0, 0, j, 1), 6 * 1.5 * y * (1 - y), 0.03);
  }
  ns_free(&ns);
}
END_TEST

static void profile(const double x[3], double t, void *context, double u[3])
{
  *(int *)context += 1;
  u[0] = 1.0 + x[1] * x[2] + 0.5 * t;
  u[1] = 0.25 * x[2];
  u[2] = x[1] - t;
  ck_assert(x[0] == 0.0 && x[1] >= 0 && x[1] <= 1 && x[2] >= 0 && x[2] <= 1);
}

/* A callback sees points on the side at the time of the sub-step's end; its tangential velocity
 * is met half way between the ghost and the first cell. */
START_TEST(callback_inflow_is_met_at_the_new_time)
{
  const int n[3] = {6, 6, 6};
  const double length[3] = {1, 1, 1};
  int calls = 0;
  bw_ns_channel_config c = in_out(BW_PROFILE_CALLBACK);
  c.side[0][0].function = profile;
  c.side[0][0].context = &calls;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 1), &c);
  bw_check_ok(bw_ns_channel_step(ns, 0.02));
  ck_assert_int_gt(calls, 0);
  for (int k = 1; k <= ns->g->m[2]; k++)
    for (int j = 1; j <= ns->g->m[1]; j++) {
      const double y = (j + ns->g->lo[1]) / 6.0, z = (k + ns->g->lo[2]) / 6.0, half = 0.5 / 6;
      const double tolerance = NS_TOLERANCE(1e-15);
      bw_check_near(at(ns, 0, 0, j, k), 1 + (y - half) * (z - half) + 0.01, tolerance);
      if (y < 0.99)
        bw_check_near(0.5 * (at(ns, 1, 0, j, k) + at(ns, 1, 1, j, k)), 0.25 * (z - half),
                      tolerance);
      if (z < 0.99)
        bw_check_near(0.5 * (at(ns, 2, 0, j, k) + at(ns, 2, 1, j, k)), y - half - 0.02, tolerance);
    }
  ns_free(&ns);
}
END_TEST

/* A uniform stream between free-slip sides is a solution: nothing may disturb it. */
START_TEST(free_stream_is_kept)
{
  const int n[3] = {10, 6, 4};
  const double length[3] = {1.0, 0.6, 0.4};
  bw_ns_channel_config c = in_out(BW_PROFILE_UNIFORM);
  for (int s = 0; s < 2; s++)
    c.side[1][s].kind = c.side[2][s].kind = BW_SIDE_FREE_SLIP;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 1.5, 1), &c);
  for (int step = 0; step < 20; step++)
    bw_check_ok(bw_ns_channel_step(ns, 0.8 * bw_ns_channel_dt_max(ns)));
  for (int k = 1; k <= ns->g->m[2]; k++)
    for (int j = 1; j <= ns->g->m[1]; j++)
      for (int i = 0; i <= 10; i++) {
        bw_check_near(at(ns, 0, i, j, k), 1.5, NS_TOLERANCE(1e-13)); /* 60 projections */
        bw_check_near(at(ns, 1, i, j, k), 0.0, NS_TOLERANCE(1e-13));
        bw_check_near(at(ns, 2, i, j, k), 0.0, NS_TOLERANCE(1e-13));
      }
  ns_free(&ns);
}
END_TEST

/* The same flow, its axes turned (x,y,z) -> (y,z,x) and again: inflow, outflow, moving wall,
 * free slip and noise meet every formula in every direction. */
typedef struct {
  int turn;
} turned;

static void turned_noise(const double x[3], double t, void *context, double u[3])
{
  const int turn = ((const turned *)context)->turn;
  double back[3], v[3];
  for (int d = 0; d < 3; d++)
    back[d] = x[(d + turn) % 3];
  ns_smooth(back, t, NULL, v);
  for (int d = 0; d < 3; d++)
    u[(d + turn) % 3] = v[d];
}

static bw_ns_channel *turned_flow(turned *which)
{
  static const int n[3] = {7, 6, 5};
  static const double length[3] = {1.4, 1.1, 0.9};
  bw_ns_channel_config base = in_out(BW_PROFILE_UNIFORM), c = base;
  base.side[1][0].velocity[0] = 0.7;
  base.side[1][0].velocity[2] = -0.4;
  base.side[2][1].kind = BW_SIDE_FREE_SLIP;
  base.side[0][0].velocity[1] = 0.3;
  int nt[3];
  double lt[3];
  for (int d = 0; d < 3; d++) {
    const int to = (d + which->turn) % 3;
    nt[to] = n[d], lt[to] = length[d];
    for (int s = 0; s < 2; s++) {
      c.side[to][s] = base.side[d][s];
      for (int e = 0; e < 3; e++)
        c.side[to][s].velocity[(e + which->turn) % 3] = base.side[d][s].velocity[e];
    }
  }
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), nt, lt, closed, 0, 1), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, turned_noise, which, 0));
  for (int step = 0; step < 10; step++)
    bw_check_ok(bw_ns_channel_step(ns, 0.01));
  return ns;
}

/* Sums over all ranks of u_c, u_c^2, u_c^3 weighted with the position, per original direction. */
static void fingerprint(const bw_ns_channel *ns, int turn, double sum[9])
{
  const bw_grid_view *g = ns->g;
  for (int q = 0; q < 9; q++)
    sum[q] = 0;
  for (int c = 0; c < 3; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int index[3] = {i, j + g->lo[1], k + g->lo[2]};
          double u = at(ns, (c + turn) % 3, i, j, k), weight = 1;
          for (int d = 0; d < 3; d++)
            weight += (d + 1) * 0.1 * index[(d + turn) % 3];
          sum[3 * c] += weight * u;
          sum[3 * c + 1] += weight * weight * u * u;
          sum[3 * c + 2] += weight * u * u * u;
        }
  bw_comm_sum(ns->comm, 9, sum);
}

START_TEST(axes_are_alike)
{
  double first[9], other[9];
  for (int turn = 0; turn < 3; turn++) {
    turned which = {turn};
    bw_ns_channel *ns = turned_flow(&which);
    fingerprint(ns, turn, turn == 0 ? first : other);
    for (int q = 0; q < 9 && turn > 0; q++)
      bw_check_near(other[q], first[q], NS_TOLERANCE(1e-11)); /* sums of some hundred terms */
    ns_free(&ns);
  }
  ck_assert_double_gt(fabs(first[3]), 1.0);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(ghosts_mirror_about_the_sides),
                                      BW_TEST(pressure_ghosts_are_even),
                                      BW_TEST(an_outflow_repeats_its_last_cells),
                                      BW_TEST(poiseuille_inflow_brings_its_bulk_velocity),
                                      BW_TEST(callback_inflow_is_met_at_the_new_time),
                                      BW_TEST(free_stream_is_kept),
                                      BW_TEST(axes_are_alike)};
BW_CHECK_MAIN("ns_channel.boundary", tests)
