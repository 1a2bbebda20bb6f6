/* Rigid bodies in a fluid: Galilean motion, what a held body feels, ranks, refusals.
 * TEST ranks=1,2,3 */
#include "bw_check.h"
#include "bw_coupler_rigid.h"
#include "bw_memory.h"

#include <string.h>

enum { CELLS = 16 };
static const double H = 1.0 / CELLS;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_rigid *rigid;
  bw_coupler_rigid *coupler;
} scene;

static void stream(const double x[3], double t, void *context, double u[3])
{
  (void)x, (void)t;
  memcpy(u, context, 3 * sizeof *u);
}

/* A periodic box of fluid that moves at U, a ball that crosses its side. */
static bw_status build(const bw_rigid_body *body, double U[3], const bw_coupler_rigid_config *c,
                       double spacing, scene *s)
{
  const bw_comm *comm = bw_check_world();
  bw_grid_config grid = bw_grid_config_default();
  bw_ns_channel_config fluid = bw_ns_channel_config_default();
  bw_rigid_config rigid = bw_rigid_config_default();
  *s = (scene){.grid = NULL};
  for (int d = 0; d < 3; d++) {
    grid.n[d] = CELLS, grid.length[d] = 1.0, grid.periodic[d] = true;
    fluid.side[d][0].kind = fluid.side[d][1].kind = BW_SIDE_PERIODIC;
  }
  grid.halo = 2;
  fluid.nu = 0.01;
  rigid.spacing = spacing;
  BW_TRY(bw_grid_create(comm, &grid, &s->grid));
  BW_TRY(bw_ns_channel_create(s->grid, &fluid, &s->fluid));
  BW_TRY(bw_ns_channel_set_velocity(s->fluid, stream, U, 0.0));
  BW_TRY(bw_rigid_create(comm, &rigid, 1, body, &s->rigid));
  return bw_coupler_rigid_create(c, s->fluid, s->rigid, &s->coupler);
}

static void destroy(scene *s)
{
  bw_coupler_rigid_destroy(&s->coupler);
  bw_rigid_destroy(&s->rigid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

static bw_coupler_rigid_config oil(void)
{
  bw_coupler_rigid_config c = bw_coupler_rigid_config_default();
  c.rho = 2.0, c.nu = 0.01;
  return c;
}

static const bw_shape BALL = {.kind = BW_SHAPE_SPHERE, .centre = {0.95, 0.5, 0.52}, .radius = 0.2};

/* Moving with the fluid, a ball of any weight goes straight on across the periodic side: the fluid
 * does nothing to it. */
START_TEST(a_body_goes_with_the_fluid)
{
  double U[3] = {0.5, -0.2, 0.1};
  const bw_rigid_body body = {
      .count = 1, .shape = &BALL, .density = 0.5, .velocity = {0.5, -0.2, 0.1}};
  const bw_coupler_rigid_config c = oil();
  const double dt = 0.02;
  scene s;
  bw_coupler_rigid_report report;
  bw_check_ok(build(&body, U, &c, H, &s));
  for (int q = 0; q < 20; q++)
    bw_check_ok(bw_coupler_rigid_step(s.coupler, dt));
  bw_check_ok(bw_coupler_rigid_measure(s.coupler, &report));
  const bw_rigid_state state = bw_rigid_state_of(s.rigid, 0);
  for (int d = 0; d < 3; d++) {
    bw_check_near(state.velocity[d], U[d], 2e4 * BW_REAL_EPSILON);
    bw_check_near(state.position[d], BALL.centre[d] + 20 * dt * U[d], 1e-3);
    bw_check_near(report.force[d], 0.0, 1e5 * BW_REAL_EPSILON);
  }
  bw_check_near(report.slip, 0.0, 1e4 * BW_REAL_EPSILON);
  bw_check_near(report.flux, 0.0, 1e4 * BW_REAL_EPSILON);
  destroy(&s);
}
END_TEST

/* The memory of the step to come holds no pressure inside the ball (bw_ibm_mdf_close). */
static void check_pressure_inside(scene *s)
{
  const size_t n = bw_rigid_points(s->rigid);
  double *X = NULL, *V = NULL, *N = NULL, *M = NULL, load[6], sums[2] = {0.0, 0.0};
  double **const arrays[] = {&X, &V, &N, &M};
  for (int q = 0; q < 4; q++)
    bw_check_ok(BW_ALLOCATE(arrays[q], 3 * n));
  bw_check_ok(bw_coupler_rigid_begin(s->coupler));
  bw_coupler_rigid_get_state(s->coupler, M, load);
  bw_rigid_surface(s->rigid, X, V, N);
  for (size_t i = 0; i < 3 * n; i++)
    sums[0] += M[i] * N[i], sums[1] += fabs(M[i]);
  bw_comm_sum(bw_check_world(), 2, sums);
  ck_assert_double_gt(sums[1], 0.0);
  bw_check_near(sums[0] / sums[1], 0.0, 1e4 * BW_REAL_EPSILON);
  for (int q = 0; q < 4; q++)
    bw_release(arrays[q]);
}

/* A held ball takes from the fluid outside what that loses: momentum of all fluid, less that
 * inside, changes by -F dt. A free one of the fluid's density takes the momentum with it. */
START_TEST(momentum_is_passed_on)
{
  double U[3] = {0.5, 0.0, 0.0};
  for (int held = 0; held < 2; held++) {
    const bw_rigid_body body = {
        .count = 1, .shape = &BALL, .density = 2.0, .held = {held, held, held, held, held, held}};
    const bw_coupler_rigid_config c = oil();
    const double dt = 0.005;
    double impulse = 0.0;
    scene s;
    bw_coupler_rigid_report report;
    bw_check_ok(build(&body, U, &c, H, &s));
    const double volume = bw_rigid_state_of(s.rigid, 0).volume;
    for (int q = 0; q < 100; q++) {
      bw_check_ok(bw_coupler_rigid_step(s.coupler, dt));
      bw_check_ok(bw_coupler_rigid_measure(s.coupler, &report));
      impulse += report.force[0] * dt;
    }
    /* Momentum outside: all but what moves with the ball inside. */
    const bw_rigid_state state = bw_rigid_state_of(s.rigid, 0);
    const double outside =
        2.0 * (bw_ns_channel_summary(s.fluid).bulk_velocity - volume * state.velocity[0]);
    const double before = 2.0 * (0.5 - volume * 0.5);
    ck_assert_msg(impulse > 0.02, "the stream did not push: %g", impulse);
    /* inside, the fluid lags behind the surface by what a fifth of a diffusion time leaves */
    bw_check_near(impulse / (before - outside), 1.0, 0.05);
    if (held)
      bw_check_near(state.velocity[0], 0.0, 0.0);
    else /* the load comes a step late, relaxed by a half */
      bw_check_near(state.velocity[0] * state.mass / impulse, 1.0, 0.03);
    bw_check_near(report.force[1], 0.0, 2e-2 * fabs(report.force[0]) + 1e-3);
    ck_assert_msg(report.slip < 0.05, "slip %g", report.slip);
    check_pressure_inside(&s);
    destroy(&s);
  }
}
END_TEST

START_TEST(bad_input_is_refused)
{
  double U[3] = {0.0, 0.0, 0.0};
  bw_shape small = BALL;
  small.radius = 0.09;
  const bw_rigid_body good = {.count = 1, .shape = &BALL, .density = 1.0};
  const bw_rigid_body tiny = {.count = 1, .shape = &small, .density = 1.0};
  const struct {
    const char *word;
    double rho, nu, virtual_mass, memory, spacing;
    const bw_rigid_body *body;
  } cases[] = {
      {"rho", NAN, 1, 1, 0.2, H, &good},         {"nu", 1, NAN, 1, 0.2, H, &good},
      {"virtual_mass", 1, 1, -1, 0.2, H, &good}, {"memory", 1, 1, 1, 0.0, H, &good},
      {"leak", 1, 1, 1, 0.2, 2.0 * H, &good},    {"four cells", 1, 1, 1, 0.2, 0.03, &tiny}};
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_coupler_rigid_config c = bw_coupler_rigid_config_default();
    c.rho = cases[q].rho, c.nu = cases[q].nu, c.virtual_mass = cases[q].virtual_mass;
    c.body.memory = cases[q].memory;
    scene s;
    bw_check_status(build(cases[q].body, U, &c, cases[q].spacing, &s), BW_EINPUT);
    ck_assert_msg(strstr(bw_last_message(), cases[q].word) != NULL, "%s: %s", cases[q].word,
                  bw_last_message());
    ck_assert_ptr_null(s.coupler);
    destroy(&s);
  }
}
END_TEST

/* Films: a roughness that the grid resolves, none at all, a limit that it does not; cavitation. */
START_TEST(films_are_refused)
{
  double U[3] = {0};
  const bw_rigid_body body = {.count = 1, .shape = &BALL, .density = 1.0};
  const bw_coupler_films films[] = {{true, NAN, 2.0 * H, -INFINITY, false},
                                    {true, NAN, NAN, -INFINITY, false},
                                    {true, 0.5 * H, 0.1 * H, -INFINITY, false},
                                    {true, NAN, 0.1 * H, -1.0, false}};
  for (size_t q = 0; q < sizeof films / sizeof *films; q++) {
    bw_coupler_rigid_config c = oil();
    scene s;
    c.films = films[q];
    bw_check_status(build(&body, U, &c, H, &s), BW_EINPUT);
    static const char *const word[] = {"roughness", "roughness", "limit", "least"};
    ck_assert_msg(strstr(bw_last_message(), word[q]) != NULL, "%s", bw_last_message());
    ck_assert_ptr_null(s.coupler);
    destroy(&s);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_body_goes_with_the_fluid),
                                      BW_TEST(momentum_is_passed_on), BW_TEST(bad_input_is_refused),
                                      BW_TEST(films_are_refused)};
BW_CHECK_MAIN("coupler.rigid", tests)
