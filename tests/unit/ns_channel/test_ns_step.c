/* Whole steps: the same on any number of ranks, 2D equals 3D, flow rate, steady Poiseuille,
 * limits, errors.
 * TEST ranks=1,2,3,4 */
#include "ns_support.h"

static const bool channel[3] = {true, false, true}, closed[3] = {false, false, false};

typedef struct {
  const char *name;
  int n[3];
  double stretch;
  bw_ns_channel_config config;
} flow;

/* Of each viscous term: channel at constant flow rate; its 2D form; inflow/outflow; closed box with
 * a lid; periodic. */
enum { SCENES = 5, FLOWS = 3 * SCENES };

static flow flow_of(int which)
{
  flow f = {.name = "channel", .n = {8, 10, 9}, .stretch = 1.3, .config = ns_config(channel, 0.02)};
  f.config.forcing = BW_FORCING_FLOW_RATE;
  f.config.forcing_value = 0.7;
  if (which % SCENES == 1) f.name = "2D", f.n[2] = 1;
  if (which % SCENES == 4) {
    static const bool all[3] = {true, true, true};
    f.name = "periodic", f.config = ns_config(all, 0.02), f.stretch = 0;
  }
  if (which % SCENES == 2 || which % SCENES == 3) {
    f.config = ns_config(closed, 0.02);
    f.config.side[1][1].velocity[0] = 1.0;
    f.name = "lid";
  }
  if (which % SCENES == 2) {
    f.name = "inflow";
    f.config.side[1][1].velocity[0] = 0.0;
    f.config.side[0][0].kind = BW_SIDE_INFLOW;
    f.config.side[0][0].profile = BW_PROFILE_POISEUILLE;
    f.config.side[0][0].bulk_velocity = 1.0;
    f.config.side[0][1].kind = BW_SIDE_OUTFLOW;
  }
  f.config.viscous = (bw_ns_viscous)(which / SCENES);
  return f;
}

static bw_ns_channel *run_flow(const bw_comm *comm, const flow *f, int steps, bw_ns_velocity_fn u0)
{
  const double length[3] = {1.6, 1.0, 1.2};
  bool periodic[3];
  for (int d = 0; d < 3; d++)
    periodic[d] = f->config.side[d][0].kind == BW_SIDE_PERIODIC;
  bw_grid_config c = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    c.n[d] = f->n[d], c.length[d] = length[d], c.periodic[d] = periodic[d];
  if (f->stretch > 0) c.y_stretch = BW_STRETCH_TANH, c.y_stretch_strength = f->stretch;
  if (f->config.viscous == BW_VISCOUS_IMPLICIT_Y) /* y divided: the coupled solver */
    c.ranks[0] = bw_comm_size(comm), c.ranks[1] = 1;
  if (f->config.viscous == BW_VISCOUS_IMPLICIT && bw_comm_size(comm) == 4 && f->n[2] > 1)
    c.ranks[0] = c.ranks[1] = 2; /* both divided */
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(comm, &c, &grid));
  bw_ns_channel *ns = ns_solver(grid, &f->config);
  bw_check_ok(bw_ns_channel_set_velocity(ns, u0, NULL, 0));
  for (int step = 0; step < steps; step++)
    bw_check_ok(bw_ns_channel_step(ns, 0.01));
  return ns;
}

START_TEST(ranks_do_not_show)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  for (int which = 0; which < FLOWS; which++) {
    const flow f = flow_of(which);
    bw_ns_channel *many = run_flow(bw_check_world(), &f, 8, ns_smooth);
    bw_ns_channel *one = run_flow(self, &f, 8, ns_smooth);
    const bw_grid_view *g = many->g;
    for (int c = 0; c < many->components + 1; c++)
      for (int k = 1; k <= g->m[2]; k++)
        for (int j = 1; j <= g->m[1]; j++)
          for (int i = 1; i <= g->m[0]; i++) {
            const bw_real *a = c < many->components ? many->u[c] : many->p;
            const bw_real *b = c < many->components ? one->u[c] : one->p;
            const double x = (double)a[bw_at(g, i, j, k)];
            const double y = (double)b[bw_at(one->g, i, j + g->lo[1], k + g->lo[2])];
            /* round-off of 24 sub-steps; p is divided by dt = 0.01 */
            ck_assert_msg(fabs(x - y) < NS_TOLERANCE(1e-12),
                          "%s, viscous %d, field %d (%d,%d,%d): %g", f.name, (int)f.config.viscous,
                          c, i, j, k, x - y);
          }
    ns_free(&many);
    ns_free(&one);
  }
  bw_comm_destroy(&self);
}
END_TEST

static void planar_noise(const double x[3], double t, void *context, double u[3])
{
  const double flat[3] = {x[0], x[1], 0.0};
  ns_noise(flat, t, context, u);
  u[2] = 0.0;
}

/* Two dimensions cost two: nothing exists of w, and each field has one plane. */
static void nothing_in_z(const bw_ns_channel *flat)
{
  const bw_grid_view *g = flat->g;
  const size_t plane = (size_t)(g->stride[1] * (g->m[1] + 2 * g->halo[1]));
  ck_assert_ptr_null(flat->u[2]);
  ck_assert_ptr_null(flat->R[2]);
  for (int d = 0; d < 3; d++)
    for (int s = 0; s < 2; s++)
      ck_assert_ptr_null(flat->plane[d][s].value[2]);
  ck_assert_int_eq(flat->components, 2);
  ck_assert_int_eq((int)g->stride[2], 0);
  ck_assert_uint_le(g->size, plane + 64 / sizeof(bw_real)); /* a row begins on 64 bytes */
  if (flat->config.viscous == BW_VISCOUS_EXPLICIT) /* u, v, p, phi, R, R; ten rows of fluxes */
    ck_assert_uint_le(flat->cost.bytes,
                      sizeof(bw_real) * (6 * g->size + 10 * (size_t)(g->m[0] + 1)));
}

/* The same flow, planar and uniform over four cells in z: which is channel, inflow, lid. */
static void planar_twin(int which, bw_ns_viscous viscous, int layers)
{
  flow thick = flow_of(which);
  thick.config.viscous = viscous;
  thick.n[2] = layers;
  for (int s = 0; s < 2 && which > 0; s++)
    thick.config.side[2][s] = (bw_ns_side){.kind = BW_SIDE_FREE_SLIP};
  flow flat = thick;
  flat.n[2] = 1;
  bw_ns_channel *a = run_flow(bw_check_world(), &flat, 10, planar_noise);
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  bw_ns_channel *b = run_flow(self, &thick, 10, planar_noise);
  nothing_in_z(a);
  for (int c = 0; c < 3; c++)
    for (int j = 1; j <= a->g->m[1]; j++)
      for (int i = 1; i <= a->g->m[0]; i++)
        for (int k = 1; k <= b->g->m[2]; k++) {
          const ptrdiff_t at = bw_at(b->g, i, j + a->g->lo[1], k);
          const double planar = (double)(c < 2 ? a->u[c] : a->p)[bw_at(a->g, i, j, 1)];
          bw_check_near((c < 2 ? b->u[c] : b->p)[at], planar, NS_TOLERANCE(1e-12));
          bw_check_near(b->u[2][at], 0.0, NS_TOLERANCE(1e-13));
        }
  ns_free(&a);
  ns_free(&b);
  bw_comm_destroy(&self);
}

START_TEST(two_dimensions_are_three_without_z)
{
  static const int flows[] = {0, 2, 3};
  for (int q = 0; q < 3; q++) {
    planar_twin(flows[q], BW_VISCOUS_EXPLICIT, 4);
    planar_twin(flows[q], BW_VISCOUS_IMPLICIT_Y, 4);
    planar_twin(flows[q], BW_VISCOUS_IMPLICIT, 4);
  }
  /* Two layers of a cycle: each is the neighbour of the other on both sides. */
  planar_twin(0, BW_VISCOUS_IMPLICIT, 2);
}
END_TEST

static void copy_interior(const bw_grid_view *g, const bw_real *from, bw_real *to)
{
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++)
        to[bw_at(g, i, j, k)] = from[bw_at(g, i, j, k)];
}

/* The interior of u, v, w, p, the time and the gradient are the whole state: a new solver that
 * gets them goes on to the last bit, also in the step it chooses. */
START_TEST(restart_is_exact)
{
  for (int which = 0; which < FLOWS; which++) {
    const flow f = flow_of(which);
    bw_ns_channel *a = run_flow(bw_check_world(), &f, 3, ns_smooth);
    bw_ns_channel *b = run_flow(bw_check_world(), &f, 0, ns_noise);
    for (int c = 0; c < a->components; c++)
      copy_interior(a->g, a->u[c], b->u[c]);
    copy_interior(a->g, a->p, b->p);
    bw_ns_channel_set_time(b, bw_ns_channel_time(a));
    bw_ns_channel_set_gradient(b, bw_ns_channel_gradient(a));
    bw_ns_channel_refresh(b);
    ck_assert_double_eq(bw_ns_channel_dt_max(a), bw_ns_channel_dt_max(b));
    for (int step = 0; step < 3; step++) {
      const double dt = 0.3 * bw_ns_channel_dt_max(a);
      bw_check_ok(bw_ns_channel_step(a, dt));
      bw_check_ok(bw_ns_channel_step(b, dt));
    }
    for (int c = 0; c <= a->components; c++) {
      const bw_real *x = c < a->components ? a->u[c] : a->p,
                    *y = c < a->components ? b->u[c] : b->p;
      for (int k = 1; k <= a->g->m[2]; k++)
        for (int j = 1; j <= a->g->m[1]; j++)
          for (int i = 1; i <= a->g->m[0]; i++)
            ck_assert_msg(x[bw_at(a->g, i, j, k)] == y[bw_at(a->g, i, j, k)], "%s, field %d",
                          f.name, c);
    }
    ns_free(&a);
    ns_free(&b);
  }
}
END_TEST

/* After every project the bulk velocity is the wanted one, whatever a body did; and the gradient
 * reported is what the body and the walls take. */
START_TEST(flow_rate_is_exact_with_a_body)
{
  flow f = flow_of(0);
  bw_ns_channel *ns = run_flow(bw_check_world(), &f, 0, ns_smooth);
  const bw_grid_view *g = ns->g;
  for (int step = 0; step < 4; step++)
    for (int r = 0; r < 3; r++) {
      bw_ns_channel_predict(ns, r, 0.01);
      for (int i = 2; i <= 4; i++)
        ns->u[0][bw_at(g, i, 1, 1)] *= (bw_real)0.5;
      bw_ns_channel_project(ns, r, 0.01);
      bw_check_near(bw_ns_channel_summary(ns).bulk_velocity, 0.7, NS_TOLERANCE(1e-14));
    }
  ck_assert_double_gt(bw_ns_channel_summary(ns).pressure_gradient, 0.0);
  ns_free(&ns);
}
END_TEST

/* Stokes decay at the viscous limit stays bounded, over it grows; the message names the limit. */
START_TEST(sources_give_what_they_say)
{
  static const bool sides[3] = {false, false, true};
  const int n[3] = {12, 10, 4};
  const double length[3] = {1.2, 1.0, 0.4};
  bw_ns_channel_config c = ns_config(sides, 0.05);
  bw_grid *grid = ns_grid(bw_check_world(), n, length, sides, 0, 2);
  bw_ns_channel *ns = ns_solver(grid, &c);
  const bw_grid_view *g = bw_grid_look(grid);
  const double rate = 0.3;
  ptrdiff_t cell[2];
  double rates[2], through = 0.0;
  size_t k = 0;
  /* In at one place, out at another, each whole on the rank that has it. */
  for (int q = 0; q < 2; q++) {
    const int i = 3 + 6 * q, j = 5 - g->lo[1], z = 2 - g->lo[2];
    if (j < 1 || j > g->m[1] || z < 1 || z > g->m[2]) continue;
    cell[k] = bw_at(g, i, j, z), rates[k++] = q == 0 ? rate : -rate;
  }
  bw_check_ok(bw_ns_channel_set_sources(ns, k, cell, rates));
  for (int step = 0; step < 5; step++)
    bw_check_ok(bw_ns_channel_step(ns, 2e-3));
  bw_check_near(bw_ns_channel_divergence(ns), 0.0, NS_TOLERANCE(1e-12));
  /* All of it flows through a plane between them. */
  for (int z = 1; z <= g->m[2]; z++)
    for (int j = 1; j <= g->m[1]; j++)
      through += (double)bw_ns_channel_velocity(ns)[0][bw_at(g, 6, j, z)];
  bw_comm_sum(bw_check_world(), 1, &through);
  bw_check_near(through, rate * 0.1, NS_TOLERANCE(1e-12));
  ns_free(&ns);
}
END_TEST

START_TEST(limits_are_checked)
{
  flow f = flow_of(0);
  bw_ns_channel *ns = run_flow(bw_check_world(), &f, 1, ns_smooth);
  const double limit = bw_ns_channel_dt_max(ns);
  bw_check_status(bw_ns_channel_step(ns, 1.01 * limit), BW_ECFL);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "over the limit"));
  bw_check_status(bw_ns_channel_step(ns, -1.0), BW_EINPUT);
  bw_check_status(bw_ns_channel_step(ns, (double)NAN), BW_EINPUT);
  bw_check_ok(bw_ns_channel_step(ns, 0.99 * limit));
  const bw_grid_view *g = ns->g; /* global cell (3, 7, 5) of v */
  const int j = 7 - g->lo[1], k = 5 - g->lo[2];
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(ns, r, 0.001);
    bw_ns_channel_project(ns, r, 0.001);
  }
  if (j >= 1 && j <= g->m[1] && k >= 1 && k <= g->m[2]) ns->u[1][bw_at(g, 3, j, k)] = (bw_real)NAN;
  bw_ns_channel_refresh(ns);
  bw_check_status(bw_ns_channel_check(ns, 0.001), BW_EDIVERGED);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "component v"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "(3, 7, 5)"));
  ns_free(&ns);
}
END_TEST

/* A value that a body makes infinite between predict and project is found after the step. */
START_TEST(what_is_not_finite_is_found)
{
  flow f = flow_of(3);
  bw_ns_channel *ns = run_flow(bw_check_world(), &f, 1, ns_smooth);
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(ns, r, 0.001);
    if (r == 2 && bw_comm_rank(bw_check_world()) == 0)
      ns->u[0][bw_at(ns->g, 2, 1, 1)] = (bw_real)INFINITY;
    bw_ns_channel_project(ns, r, 0.001);
  }
  bw_check_status(bw_ns_channel_check(ns, 0.001), BW_EDIVERGED);
  ns_free(&ns);
}
END_TEST

static void refused(const bool periodic[3], const bw_ns_channel_config *c, const char *word)
{
  const int n[3] = {4, 4, 4};
  const double length[3] = {1, 1, 1};
  bw_grid *grid = ns_grid(bw_check_world(), n, length, periodic, 0, 1);
  bw_ns_channel *ns = NULL;
  bw_check_status(bw_ns_channel_create(grid, c, &ns), BW_EINPUT);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "'%s' is not in: %s", word,
                bw_last_message());
  ck_assert_ptr_null(ns);
  bw_grid_destroy(&grid);
}

static void brings_nothing(const double x[3], double t, void *context, double u[3])
{
  (void)x, (void)t, (void)context;
  u[0] = u[1] = u[2] = 0.0;
}

START_TEST(contradictions_are_refused)
{
  bw_ns_channel_config good = ns_config(closed, 0.1), c = good;
  c.nu = (double)NAN;
  refused(closed, &c, "nu");
  c.nu = -1.0;
  refused(closed, &c, "nu");
  c = good, c.side[2][1].kind = BW_SIDE_PERIODIC;
  refused(closed, &c, "z upper side is periodic");
  refused(channel, &good, "x lower side is not periodic");
  c = good, c.forcing = BW_FORCING_FLOW_RATE, c.forcing_value = 1;
  refused(closed, &c, "periodic x");
  c = ns_config(channel, 0.1), c.forcing = BW_FORCING_GRADIENT, c.forcing_value = (double)NAN;
  refused(channel, &c, "forcing_value");
  c = good, c.side[1][0].velocity[1] = 1;
  refused(closed, &c, "tangentially");
  c = good, c.side[1][0].profile = BW_PROFILE_CALLBACK;
  refused(closed, &c, "a callback wall needs side.function");
  c = good, c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = 1;
  refused(closed, &c, "add an outflow");
  c = good, c.side[0][1].kind = BW_SIDE_OUTFLOW;
  refused(closed, &c, "no inflow");
  c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].velocity[0] = -1;
  refused(closed, &c, "velocities count along");
  c.side[0][0].kind = BW_SIDE_INFLOW, c.side[0][0].profile = BW_PROFILE_CALLBACK;
  refused(closed, &c, "function");
  c.side[0][0].function = brings_nothing, c.side[0][1].kind = BW_SIDE_WALL;
  c.side[0][0].velocity[0] = 0;
  refused(closed, &c, "outflow"); /* nobody knows what a callback brings */
  c.side[0][1].kind = BW_SIDE_OUTFLOW, c.side[0][0].velocity[0] = -1;
  c.side[0][0].profile = BW_PROFILE_POISEUILLE;
  refused(closed, &c, "bulk_velocity");
  c.side[0][0].bulk_velocity = 1, c.side[1][0].velocity[0] = 1;
  refused(closed, &c, "the y lower one is none of them");
  for (int d = 1; d < 3; d++)
    for (int s = 0; s < 2; s++)
      c.side[d][s] = (bw_ns_side){.kind = BW_SIDE_FREE_SLIP};
  refused(closed, &c, "needs walls at rest");
}
END_TEST

/* What one inflow brings another may take: no outflow is needed then, whatever the length of a
 * unit. */
START_TEST(inflows_that_balance_are_taken)
{
  static const int n[3] = {8, 8, 8};
  for (double unit = 1e-6; unit < 10; unit *= 1e6) {
    const double length[3] = {unit, unit, unit};
    bw_ns_channel_config c = ns_config(closed, 0.1 * unit);
    c.side[0][0].kind = c.side[0][1].kind = BW_SIDE_INFLOW;
    c.side[0][0].velocity[0] = c.side[0][1].velocity[0] = 1;
    bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, length, closed, 0, 1), &c);
    bw_check_ok(bw_ns_channel_step(ns, 0.1 * bw_ns_channel_dt_max(ns)));
    ns_free(&ns);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(ranks_do_not_show),
                                      BW_TEST(two_dimensions_are_three_without_z),
                                      BW_TEST(restart_is_exact),
                                      BW_TEST(flow_rate_is_exact_with_a_body),
                                      BW_TEST(sources_give_what_they_say),
                                      BW_TEST(limits_are_checked),
                                      BW_TEST(what_is_not_finite_is_found),
                                      BW_TEST(contradictions_are_refused),
                                      BW_TEST(inflows_that_balance_are_taken)};
BW_CHECK_MAIN("ns_channel.step", tests)
