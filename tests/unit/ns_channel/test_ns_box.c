/* The balance of a watched box is the force of what is inside, to round-off.
 * TEST ranks=1,2,3,4 */
#include "ns_support.h"

enum { CASES = 6 };

static const int n[3] = {12, 10, 8};
static const double length[3] = {1.2, 1.0, 0.8};

/* Periodic channel with flow rate; gradient; inflow/outflow; implicit y; 2D; from upper to lower z.
 * Stretched where the
 * balance has to know the heights. */
static bw_ns_channel *solver_of(int which)
{
  const bool channel[3] = {true, false, true}, closed[3] = {false, false, false};
  const bool *periodic = which == 2 || which == 5 ? closed : channel;
  bw_ns_channel_config c = ns_config(periodic, 0.05);
  if (which == 5) {
    c.side[2][1].kind = BW_SIDE_INFLOW, c.side[2][1].velocity[2] = -0.5;
    c.side[2][0].kind = BW_SIDE_OUTFLOW;
  } else if (which != 2) {
    c.forcing = which == 1 ? BW_FORCING_GRADIENT : BW_FORCING_FLOW_RATE;
    c.forcing_value = 0.5;
  } else {
    c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = 0.5;
    c.side[0][1].kind = BW_SIDE_OUTFLOW;
  }
  bw_grid_config gc = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    gc.n[d] = n[d], gc.length[d] = length[d], gc.periodic[d] = periodic[d];
  gc.y_stretch = BW_STRETCH_TANH;
  if (which == 3) {
    c.viscous = BW_VISCOUS_IMPLICIT_Y;
    gc.ranks[0] = bw_comm_size(bw_check_world()), gc.ranks[1] = 1;
  }
  if (which == 4) gc.n[2] = 1;
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(bw_check_world(), &gc, &grid));
  return ns_solver(grid, &c);
}

/* Add dt f to the points of the cells lo < i <= hi of every component; *impulse grows by the
 * impulse given, of this rank. */
static void push(bw_ns_channel *ns, const int lo[3], const int hi[3], double dt, double impulse[3])
{
  const bw_grid_view *g = ns->g;
  for (int c = 0; c < ns->components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int at[3] = {i, j + g->lo[1], k + g->lo[2]};
          bool inside = true;
          for (int d = 0; d < ns->components; d++)
            inside &= lo[d] < at[d] && at[d] <= hi[d];
          if (!inside) continue;
          const double f = (c + 1) * sin(1.0 + at[0] + 2 * at[1] + 3 * at[2]) - 0.3;
          const double height = c == 1 ? ns->metrics.dyc[j] : ns->metrics.dyf[j];
          bw_real *u = &ns->u[c][bw_at(g, i, j, k)];
          const double before = (double)*u;
          *u += (bw_real)(dt * f);
          impulse[c] += ((double)*u - before) * height * g->spacing[0] * g->spacing[2];
        }
}

static void balance(int which, const int lo[3], const int hi[3], const int push_lo[3],
                    const int push_hi[3], bool inside)
{
  bw_ns_channel *ns = solver_of(which);
  bw_check_ok(bw_ns_channel_watch_box(ns, lo, hi));
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_smooth, NULL, 0));
  double force[3];
  bw_ns_channel_control_volume(ns, force);
  for (int d = 0; d < 3; d++)
    ck_assert_double_eq(force[d], 0.0);
  const double dt = 0.004;
  for (int step = 0; step < 3; step++) {
    double impulse[3] = {0, 0, 0};
    for (int r = 0; r < 3; r++) {
      bw_ns_channel_predict(ns, r, dt);
      push(ns, push_lo, push_hi, dt, impulse);
      bw_ns_channel_project(ns, r, dt);
    }
    bw_comm_sum(ns->comm, 3, impulse);
    bw_ns_channel_control_volume(ns, force);
    for (int d = 0; d < ns->components; d++) {
      ck_assert_double_gt(fabs(impulse[d] / dt), 1e-3);
      /* the momentum of the box, of order one, is differenced over dt = 0.004 */
      ck_assert_msg(fabs(force[d] - (inside ? impulse[d] / dt : 0.0)) < NS_TOLERANCE(2e-13),
                    "case %d, step %d: F[%d] = %.15g, impulse/dt = %.15g", which, step, d, force[d],
                    impulse[d] / dt);
    }
  }
  ns_free(&ns);
}

START_TEST(force_inside_is_found)
{
  for (int which = 0; which < CASES; which++) {
    const int top = which == 4 ? 1 : 7, under = which == 4 ? 0 : 1;
    const int lo[3] = {2, 1, under}, hi[3] = {9, 8, top};
    const int push_lo[3] = {4, 3, which == 4 ? 0 : 2}, push_hi[3] = {7, 6, which == 4 ? 1 : 5};
    balance(which, lo, hi, push_lo, push_hi, true);
  }
}
END_TEST

START_TEST(force_outside_is_not)
{
  for (int which = 0; which < CASES; which++) {
    const int lo[3] = {5, 2, 0}, hi[3] = {9, 6, which == 4 ? 1 : 4};
    const int push_lo[3] = {1, 3, 0}, push_hi[3] = {4, 6, which == 4 ? 1 : 3};
    balance(which, lo, hi, push_lo, push_hi, false);
  }
}
END_TEST

/* From wall to wall: friction at the walls is in the fluxes, the normal velocity of the wall's
 * faces is no point of the box. Also the whole box. */
START_TEST(box_may_touch_walls)
{
  for (int which = 0; which < CASES; which++) {
    const int lo[3] = {0, 0, 0}, hi[3] = {which == 2 ? 11 : 12, 10, which == 4 ? 1 : 8};
    const int push_lo[3] = {4, 3, 0}, push_hi[3] = {7, 6, which == 4 ? 1 : 5};
    balance(which, lo, hi, push_lo, push_hi, true);
    const int all[3] = {12, 10, which == 4 ? 1 : 8};
    balance(which, lo, all, push_lo, push_hi, true);
  }
}
END_TEST

START_TEST(empty_boxes_are_refused)
{
  bw_ns_channel *ns = solver_of(0);
  bw_check_status(bw_ns_channel_watch_box(ns, (int[3]){3, 3, 3}, (int[3]){3, 5, 5}), BW_EINPUT);
  bw_check_status(bw_ns_channel_watch_box(ns, (int[3]){-1, 3, 3}, (int[3]){3, 5, 5}), BW_EINPUT);
  bw_check_status(bw_ns_channel_watch_box(ns, (int[3]){0, 0, 0}, (int[3]){12, 10, 9}), BW_EINPUT);
  ns_free(&ns);
}
END_TEST

/* The factored viscous term has fluxes of its own, which the balance does not know. */
START_TEST(all_implicit_is_refused)
{
  const bool channel[3] = {true, false, true};
  bw_ns_channel_config c = ns_config(channel, 0.05);
  c.viscous = BW_VISCOUS_IMPLICIT;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, channel, 0, 1), &c);
  bw_check_status(bw_ns_channel_watch_box(ns, (int[3]){0, 0, 0}, (int[3]){2, 2, 2}), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "use explicit or implicit_y"));
  ns_free(&ns);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(force_inside_is_found), BW_TEST(force_outside_is_not), BW_TEST(box_may_touch_walls),
    BW_TEST(empty_boxes_are_refused), BW_TEST(all_implicit_is_refused)};
BW_CHECK_MAIN("ns_channel.box", tests)
