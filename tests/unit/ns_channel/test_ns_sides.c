/* Inflow and outflow at any side: mirror images, laminar sections, re-entry.
 * TEST ranks=1,2,3,4 */
#include "ns_support.h"

static const bool closed[3] = {false, false, false};
static const double length[3] = {1.2, 1.0, 0.8};

/* A flow along direction d, from the lower side to the upper one, or its mirror image. */
typedef struct {
  int d;
  bool mirrored;
  bw_ns_viscous viscous;
} through;

/* Strong enough for fluid to come back through the outflow. */
static void swirl(const double x[3], double t, void *context, double u[3])
{
  const through *w = context;
  double y[3] = {x[0], x[1], x[2]};
  if (w->mirrored) y[w->d] = length[w->d] - y[w->d];
  (void)t;
  for (int c = 0; c < 3; c++)
    u[c] = (c == w->d ? 1.0 : 0.0) + 3.0 * sin(5.0 * y[(c + 1) % 3] + c) +
           2.0 * sin(6.0 * y[(c + 2) % 3] - y[c]);
  if (w->mirrored) u[w->d] = -u[w->d];
}

/* Cells in y that grow from 0.6 to 1.4 of the mean upwards; downwards where the flow is mirrored
 * in y. */
static bw_grid *grid_through(const bw_comm *comm, const through *w, int n2)
{
  enum { N1 = 9 };
  double y[N1 + 1];
  bw_grid_config c = bw_grid_config_default();
  bw_grid *grid = NULL;
  for (int j = 0; j <= N1; j++) {
    const bool down = w->mirrored && w->d == 1;
    const double s = (double)(down ? N1 - j : j) / N1, up = length[1] * s * (0.6 + 0.4 * s);
    y[j] = down ? length[1] - up : up;
  }
  c.n[0] = 8, c.n[1] = N1, c.n[2] = n2;
  memcpy(c.length, length, sizeof c.length);
  c.y_stretch = BW_STRETCH_TABLE, c.y_table = y;
  bw_check_ok(bw_grid_create(comm, &c, &grid));
  return grid;
}

static bw_ns_channel *flow_through(const bw_comm *comm, through *w, int n2)
{
  const int d = w->d, a = (d + 1) % (n2 == 1 ? 2 : 3), in = w->mirrored ? 1 : 0;
  const double sign = w->mirrored ? -1.0 : 1.0;
  bw_ns_channel_config c = ns_config(closed, 0.02);
  c.viscous = w->viscous;
  c.side[d][in] = (bw_ns_side){.kind = BW_SIDE_INFLOW};
  for (int e = 0; e < 3; e++)
    c.side[d][in].velocity[e] = e == d ? sign : 0.1 * (e + 1);
  c.side[d][1 - in].kind = BW_SIDE_OUTFLOW;
  c.side[a][0].velocity[d] = 0.6 * sign;
  c.side[a][1].kind = BW_SIDE_FREE_SLIP;
  bw_ns_channel *ns = ns_solver(grid_through(comm, w, n2), &c);
  bw_check_ok(bw_ns_channel_set_velocity(ns, swirl, w, 0));
  return ns;
}

/* Does fluid come back somewhere through the upper side of d? */
static bool re_enters(const bw_ns_channel *ns, int d)
{
  double most = 0;
  const bw_grid_view *g = ns->g;
  for (int k = d == 2 ? g->m[2] : 1; k <= g->m[2]; k++)
    for (int j = d == 1 ? g->m[1] : 1; j <= g->m[1]; j++)
      for (int i = d == 0 ? g->m[0] : 1; i <= g->m[0] && g->last[d]; i++)
        most = fmax(most, -(double)ns->u[d][bw_at(g, i, j, k)]);
  bw_comm_max(ns->comm, 1, &most);
  return most > 0;
}

static void compare_mirrored(const bw_ns_channel *one, const bw_ns_channel *image, int d)
{
  const bw_grid_view *g = image->g;
  for (int c = 0; c < image->components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          int at[3] = {i, j + g->lo[1], k + g->lo[2]};
          at[d] = (c == d ? g->n[d] : g->n[d] + 1) - at[d];
          const double u = (double)one->u[c][bw_at(one->g, at[0], at[1], at[2])];
          const double v = (double)image->u[c][bw_at(g, i, j, k)];
          /* round-off of 90 sub-steps */
          ck_assert_msg(fabs(u - (c == d ? -v : v)) < NS_TOLERANCE(1e-12),
                        "direction %d, component %d (%d,%d,%d): %g and %g", d, c, i, j, k, u, v);
        }
}

/* `image` on all ranks, its twin on one. */
static void run_both_ways(const bw_comm *self, int d, int n2, bw_ns_viscous viscous)
{
  through up = {d, false, viscous}, down = {d, true, viscous};
  bw_ns_channel *one = flow_through(self, &up, n2);
  bw_ns_channel *image = flow_through(bw_check_world(), &down, n2);
  bool back = false;
  for (int step = 0; step < 30; step++) {
    back |= re_enters(one, d);
    const double dt = 0.5 * bw_ns_channel_dt_max(one);
    bw_check_ok(bw_ns_channel_step(one, dt));
    bw_check_ok(bw_ns_channel_step(image, dt));
    bw_check_near(bw_ns_channel_divergence(image), 0.0, NS_TOLERANCE(1e-13));
  }
  ck_assert_msg(back, "nothing comes back in direction %d", d);
  compare_mirrored(one, image, d);
  ns_free(&one);
  ns_free(&image);
}

START_TEST(downwards_is_the_mirror_image_of_upwards)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  for (int d = 0; d < 3; d++) {
    run_both_ways(self, d, 6, BW_VISCOUS_EXPLICIT);
    run_both_ways(self, d, 6, BW_VISCOUS_IMPLICIT_Y);
    run_both_ways(self, d, 6, BW_VISCOUS_IMPLICIT);
    if (d < 2) run_both_ways(self, d, 1, BW_VISCOUS_EXPLICIT);
  }
  bw_comm_destroy(&self);
}
END_TEST

/* Plane channel, duct, half of either, in every direction and from either end: the profile brings
 * its bulk velocity and crosses the box unchanged. */
typedef struct {
  const char *name;
  int d, in;
  bool walls[3][2]; /* else free slip */
} section;

static const section sections[] = {
    {"plane", 0, 0, {{0, 0}, {1, 1}, {0, 0}}},     {"duct", 0, 0, {{0, 0}, {1, 1}, {1, 1}}},
    {"duct down", 0, 1, {{0, 0}, {1, 1}, {1, 1}}}, {"film", 0, 0, {{0, 0}, {1, 0}, {0, 0}}},
    {"gutter", 0, 0, {{0, 0}, {1, 0}, {1, 1}}},    {"duct in y", 1, 0, {{1, 1}, {0, 0}, {1, 1}}},
    {"down in y", 1, 1, {{1, 1}, {0, 0}, {0, 0}}}, {"duct in z", 2, 1, {{1, 1}, {1, 1}, {0, 0}}}};

static bw_ns_channel *laminar(const section *q, int n2)
{
  const int n[3] = {8, 10, n2};
  bw_ns_channel_config c = ns_config(closed, 0.02);
  for (int e = 0; e < 3; e++)
    for (int s = 0; s < 2; s++)
      c.side[e][s].kind = q->walls[e][s] ? BW_SIDE_WALL : BW_SIDE_FREE_SLIP;
  c.side[q->d][q->in] = (bw_ns_side){.kind = BW_SIDE_INFLOW,
                                     .profile = BW_PROFILE_POISEUILLE,
                                     .bulk_velocity = q->in == 0 ? 1.0 : -1.0};
  c.side[q->d][1 - q->in].kind = BW_SIDE_OUTFLOW;
  return ns_solver(ns_grid(bw_check_world(), n, length, closed, 1.3, 1), &c);
}

/* The plane of the inflow in every layer of the box. */
static void spread_inflow(bw_ns_channel *ns, const section *q)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_plane *p = &ns->plane[q->d][q->in];
  double sheet[10 * 10] = {0}; /* the whole side, the same on all ranks */
  const int t0 = bw_ns__tangent(q->d, 0), t1 = bw_ns__tangent(q->d, 1);
  for (int b = 1; b <= g->m[t1] && p->here; b++)
    for (int a = 1; a <= g->m[t0]; a++)
      sheet[(b + g->lo[t1] - 1) * 10 + a + g->lo[t0] - 1] =
          (double)p->value[q->d][(b - p->low[1]) * p->extent[0] + a - p->low[0]];
  bw_comm_sum(ns->comm, 100, sheet);
  for (int c = 0; c < ns->components; c++)
    for (int k = 0; k <= g->m[2]; k++)
      for (int j = 0; j <= g->m[1]; j++)
        for (int i = 0; i <= g->m[0]; i++) {
          const int at[3] = {i, j + g->lo[1], k + g->lo[2]};
          const bool inside = at[t0] > 0 && at[t1] > 0 && (g->n[2] > 1 || k > 0);
          if (inside)
            ns->u[c][bw_at(g, i, j, k)] =
                c == q->d ? (bw_real)sheet[(at[t1] - 1) * 10 + at[t0] - 1] : 0;
        }
  bw_ns_channel_refresh(ns);
}

static double largest_change(bw_ns_channel *ns, bw_real *const before[3])
{
  const bw_grid_view *g = ns->g;
  double most = 0;
  for (int c = 0; c < ns->components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const ptrdiff_t at = bw_at(g, i, j, k);
          most = fmax(most, fabs((double)ns->u[c][at] - (double)before[c][at]));
        }
  bw_comm_max(ns->comm, 1, &most);
  return most;
}

START_TEST(laminar_profiles_cross_unchanged)
{
  for (size_t w = 0; w < sizeof sections / sizeof *sections; w++)
    for (int n2 = sections[w].d == 2 || sections[w].walls[2][0] ? 7 : 1; n2 <= 7; n2 += 6) {
      const section *q = &sections[w];
      bw_ns_channel *ns = laminar(q, n2);
      bw_real *before[3] = {NULL, NULL, NULL};
      const double area = length[0] * length[1] * length[2] / length[q->d];
      double flux = bw_ns__side_flux(ns, q->d, q->in);
      bw_comm_sum(ns->comm, 1, &flux);
      bw_check_near(flux, -area, NS_TOLERANCE(4e-15));
      spread_inflow(ns, q);
      for (int c = 0; c < ns->components; c++) {
        bw_check_ok(bw_field_create(ns->grid, &before[c]));
        memcpy(before[c], ns->u[c], ns->g->size * sizeof *before[c]);
      }
      bw_check_near(bw_ns_channel_divergence(ns), 0.0, NS_TOLERANCE(1e-14));
      for (int step = 0; step < 200; step++)
        bw_check_ok(bw_ns_channel_step(ns, 0.01));
      const double change = largest_change(ns, before);
      /* 600 sub-steps of round-off in p/dt */
      ck_assert_msg(change < NS_TOLERANCE(1e-11), "%s, %d cells in z: %g", q->name, n2, change);
      for (int c = 0; c < 3; c++)
        bw_release(&before[c]);
      ns_free(&ns);
    }
}
END_TEST

/* What comes back through an outflow is slower than what is there, by the law of ns_outflow.c. */
START_TEST(re_entry_is_slowed)
{
  const int n[3] = {6, 4, 1};
  bw_ns_channel_config c = ns_config(closed, 1e-3);
  c.side[0][0] = (bw_ns_side){.kind = BW_SIDE_INFLOW, .velocity = {1.0, 0.0, 0.0}};
  c.side[0][1].kind = BW_SIDE_OUTFLOW;
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 1), &c);
  const bw_grid_view *g = ns->g;
  const double dx = 0.2, dt = 0.01, courant = dt / dx; /* U_c = 1 */
  double given[4], inside[4], sum = 0;
  for (int j = 0; j < 4; j++) {
    given[j] = 3.0 - 2.0 * j, inside[j] = 1.0 - given[j];
    const int at = j + 1 - g->lo[1];
    if (at < 1 || at > g->m[1]) continue;
    ns->u[0][bw_at(g, 6, at, 1)] = (bw_real)given[j];
    ns->u[0][bw_at(g, 5, at, 1)] = (bw_real)inside[j];
  }
  bw_ns__outflow_advance(ns, dt, length[1] * length[2]);
  for (int j = 0; j < 4; j++) {
    given[j] += courant * (inside[j] - given[j]);
    if (given[j] < 0) given[j] /= 1.0 - courant * given[j];
    sum += 0.25 * given[j];
  }
  for (int j = 0; j < 4; j++) {
    const int at = j + 1 - g->lo[1];
    if (at < 1 || at > g->m[1]) continue;
    const bw_ns_plane *p = &ns->plane[0][1];
    const double got = (double)p->value[0][(1 - p->low[1]) * p->extent[0] + at - p->low[0]];
    bw_check_near(got, given[j] + 1.0 - sum, NS_TOLERANCE(1e-14));
  }
  ns_free(&ns);
}
END_TEST

/* Straight to x = 0.6, slanted from there on. */
static void bend(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  for (int k = 0; k <= g->m[2]; k++)
    for (int j = 0; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        ns->u[0][bw_at(g, i - 1, j, k)] = ns->u[0][bw_at(g, i, j, k)] = 1;
        ns->u[1][bw_at(g, i, j, k)] = i > g->m[0] / 2 ? (bw_real)0.75 : 0;
      }
}

START_TEST(tortuosity_is_of_the_cells_between_the_corners)
{
  const double low[3] = {0.0, 0.2, 0.0}, straight[3] = {0.6, 0.8, 0.7}, high[3] = {1.2, 0.8, 0.7};
  const through w = {.d = 0};
  bw_ns_channel_config c = ns_config(closed, 0.02);
  bw_ns_channel *ns = ns_solver(grid_through(bw_check_world(), &w, 7), &c);
  bend(ns);
  bw_check_near(bw_ns_channel_tortuosity(ns, 0, low, straight), 1.0, NS_TOLERANCE(1e-14));
  /* sqrt(1 + 0.75^2) = 1.25 in the other half. */
  bw_check_near(bw_ns_channel_tortuosity(ns, 0, low, high), 1.125, NS_TOLERANCE(1e-14));
  ck_assert(isnan(bw_ns_channel_tortuosity(ns, 2, low, high)));
  ns_free(&ns);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(downwards_is_the_mirror_image_of_upwards), BW_TEST(laminar_profiles_cross_unchanged),
    BW_TEST(re_entry_is_slowed), BW_TEST(tortuosity_is_of_the_cells_between_the_corners)};
BW_CHECK_MAIN("ns_channel.sides", tests)
