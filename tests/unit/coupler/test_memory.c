/* Memory of the forcing in a coupled run: kept per particle, shared by blocks, frozen while a step
 * is repeated, lost with the first bond.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2,3 */
#include "cube_scene.h"

#include <stdio.h>
#include <string.h>

static const double STEP = 1.0e-3, BETA = 0.2;

/* The cube's coupler anew, free. */
static void couple(scene *s, double spacing, int iterations)
{
  bw_coupler_config config = bw_coupler_config_default();
  config.rho = RHO;
  config.nu = 0.05;
  config.marker_spacing = spacing;
  config.coupling_iterations = iterations;
  bw_coupler_destroy(&s->coupler);
  bw_check_ok(bw_coupler_create(&config, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
}

/* What the markers, told to the forcing, will lose: the pressure inside the cube
 * (bw_ibm_mdf_close). normal (n,3), dV (n), M (n,3) of markers; lost (n,3). */
static void find_lost(size_t n, const double normal[], const double dV[], const double M[],
                      double lost[])
{
  double sum[2] = {0.0, 0.0};
  for (size_t m = 0; m < n; m++) {
    for (size_t d = 0; d < 3; d++)
      sum[0] += M[3 * m + d] * normal[3 * m + d];
    sum[1] += dV[m];
  }
  bw_comm_sum(bw_check_world(), 2, sum);
  for (size_t i = 0; i < 3 * n; i++)
    lost[i] = normal[i] * dV[i / 3] * sum[0] / sum[1];
}

/* Steps; after each the particles' memory has to be (1 - beta) times that of before, less the
 * pressure inside, plus beta times what their markers gave in the step: in shares of area of that
 * of the block. The surface of the step has to be known for it: it is the same before and after. */
static void check_steps(scene *s, int steps)
{
  bw_coupler *c = s->coupler;
  const bw_coupler__blocks *b = &c->blocks;
  double *before = NULL, *lost = NULL, largest = 0.0, pressed = 0.0;
  bw_check_ok(BW_ALLOCATE(&before, 3 * c->n));
  bw_check_ok(BW_ALLOCATE(&lost, 3 * (c->n + b->n)));
  for (int q = 0; q < steps; q++) {
    double all[2] = {0.0, 0.0};
    memcpy(before, c->M, 3 * c->n * sizeof *before);
    for (size_t m = 0; m < c->n_surface; m++)
      memcpy(c->marker_M + 3 * m, c->M + 3 * (size_t)c->particle[m], 3 * sizeof *lost);
    if (c->block > 1) bw_coupler__blocks_gather_memory(c);
    const size_t n = c->block > 1 ? b->n : c->n_surface;
    if (c->block > 1)
      find_lost(n, b->out, b->dV, b->M, lost);
    else
      find_lost(n, c->normal, c->marker_dV, c->marker_M, lost);
    for (size_t i = 0; i < 3 * n; i++) {
      all[0] -= (1.0 - BETA) * lost[i];
      pressed = fmax(pressed, fabs(lost[i]));
    }
    bw_check_ok(bw_coupler_step(c, STEP));
    bw_coupler__reaction_force(c); /* -rho Q dV */
    for (size_t i = 0; i < 3 * c->n; i++)
      all[0] += before[i], all[1] += c->M[i];
    for (size_t m = 0; m < c->n_surface; m++)
      for (size_t d = 0; d < 3; d++) {
        const size_t p = 3 * (size_t)c->particle[m] + d;
        const double force = -c->force[3 * m + d] / RHO;
        if (c->block == 1)
          bw_check_near(c->M[p], (1.0 - BETA) * (before[p] - lost[3 * m + d]) + BETA * force,
                        1e-10);
        all[0] += BETA * (force - before[p]);
        largest = fmax(largest, fabs(c->M[p]));
      }
    bw_comm_sum(bw_check_world(), 2, all);
    bw_check_near(all[1], all[0], 1e-10);
  }
  double most[2] = {largest, pressed};
  bw_comm_max(bw_check_world(), 2, most);
  ck_assert_double_gt(most[0], 1e-6);
  ck_assert_double_gt(most[1], 1e-6);
  bw_release(&before);
  bw_release(&lost);
}

START_TEST(it_is_kept_per_particle)
{
  scene s = build(0.3, 1.0);
  couple(&s, 0.0, 1);
  check_steps(&s, 4);
  destroy(&s);
}
END_TEST

/* Members of a block have its memory by their areas. */
START_TEST(blocks_share_it)
{
  scene s = build(0.3, 1.0);
  couple(&s, 2.0, 1);
  check_steps(&s, 4);
  const bw_coupler *c = s.coupler;
  double sums[2] = {0.0, 0.0};
  bw_coupler__blocks_memory(s.coupler); /* leaves that of the markers in blocks.force */
  for (size_t m = 0; m < 3 * c->blocks.n; m++)
    sums[0] += c->blocks.force[m];
  for (size_t i = 0; i < 3 * c->n; i++)
    sums[1] += c->M[i];
  bw_comm_sum(bw_check_world(), 2, sums);
  bw_check_near(sums[1], sums[0], 1e-10);
  destroy(&s);
}
END_TEST

/* Every try of a step begins from the memory of before it; the last one is taken up, once. */
START_TEST(tries_of_a_step_leave_it_alone)
{
  scene s = build(0.3, 0.1);
  couple(&s, 0.0, 20);
  check_steps(&s, 2);
  ck_assert_int_gt(s.coupler->iterations, 1);
  destroy(&s);
}
END_TEST

/* A held solid's markers stay with the forcing; what the particles have is the same. */
START_TEST(a_held_solid_has_one_too)
{
  scene s = build(0.3, 1.0);
  couple(&s, 0.0, 1);
  bw_coupler_hold_solid(s.coupler, true);
  check_steps(&s, 4);
  destroy(&s);
}
END_TEST

/* A cut through the cube: whoever lost a bond has no memory from the next step on, the others keep
 * theirs; markers too were told. */
START_TEST(broken_particles_have_none)
{
  scene s = build(0.3, 1.0);
  couple(&s, 0.0, 1);
  check_steps(&s, 2);
  bw_coupler *c = s.coupler;
  const double middle = (FIRST + BLOCK / 2) * H;
  bw_check_ok(bw_solid_precrack(s.solid, (double[3]){middle, 0, 0}, (double[3]){middle, 1, 0},
                                (double[3]){middle, 0, 1}));
  bw_check_ok(bw_coupler__follow_surface(c));
  bw_check_ok(bw_coupler_step(c, STEP));
  bw_check_ok(bw_coupler_step(c, STEP));
  uint16_t *broken = NULL;
  int64_t count[2] = {0, 0};
  bw_check_ok(BW_ALLOCATE(&broken, c->n));
  bw_solid_get_broken(s.solid, broken);
  for (size_t m = 0; m < c->n_surface; m++) {
    const size_t p = (size_t)c->particle[m];
    const bool has = c->M[3 * p] != 0.0 || c->M[3 * p + 1] != 0.0 || c->M[3 * p + 2] != 0.0;
    ck_assert(has == (broken[p] == 0));
    count[has]++;
  }
  bw_comm_sum_int(bw_check_world(), 2, count);
  ck_assert_int_gt(count[0], 0);
  ck_assert_int_gt(count[1], 0);
  bw_release(&broken);
  destroy(&s);
}
END_TEST

/* Fluid of velocity 1 along x that goes through a cube at rest as if it were not there: slip and
 * leak are the whole of the inflow's speed, 1, and of the flux past the cube's face. For blocks
 * too. */
START_TEST(slip_and_leak_are_told)
{
  for (int blocks = 0; blocks <= 1; blocks++) {
    scene s = build(0.3, 1.0);
    couple(&s, blocks ? 2.0 : 0.0, 1);
    bw_coupler_hold_solid(s.coupler, true);
    bw_check_ok(bw_coupler_step(s.coupler, STEP));
    bw_coupler_report r;
    for (int d = 0; d < 3; d++)
      for (size_t q = 0; q < bw_grid_look(s.grid)->size; q++)
        bw_ns_channel_velocity(s.fluid)[d][q] = d == 0;
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    /* 64 weights of one marker, each rounded */
    bw_check_near(r.slip, 1.0, 64 * BW_REAL_EPSILON);
    bw_check_near(r.leak, 1.0, 64 * BW_REAL_EPSILON);
    destroy(&s);
  }
}
END_TEST

/* Said once, when it was so five times running and the start is over. */
START_TEST(much_slip_is_said_once)
{
  scene s = build(0.3, 1.0);
  char text[512] = "";
  bw_log_config config = bw_log_config_default();
  config.err = tmpfile();
  ck_assert_ptr_nonnull(config.err);
  bw_log *log = NULL;
  bw_check_ok(bw_log_create(bw_check_world(), &config, &log));
  const bw_coupler_report little = {.slip = 0.01, .leak = 0.0}, much = {.leak = 0.03};
  s.coupler->config.memory = 0.0; /* it would help */
  for (int q = 0; q < 9; q++)     /* not in the first hundred steps */
    bw_coupler_warn_slip(s.coupler, &much, log);
  s.coupler->steps = 100;
  for (int q = 0; q < 9; q++)
    bw_coupler_warn_slip(s.coupler, q == 4 ? &little : &much, log);
  ck_assert_int_eq(ftell(config.err), 0);
  bw_coupler_warn_slip(s.coupler, &much, log);
  const long said = ftell(config.err);
  for (int q = 0; q < 9; q++)
    bw_coupler_warn_slip(s.coupler, &much, log);
  ck_assert_int_eq(ftell(config.err), said);
  ck_assert((said > 0) == (bw_comm_rank(bw_check_world()) == 0)); /* rank 0 speaks */
  rewind(config.err);
  if (said > 0) {
    ck_assert_ptr_nonnull(fgets(text, sizeof text, config.err));
    ck_assert_ptr_nonnull(strstr(text, "3.0 %"));
    ck_assert_ptr_nonnull(strstr(text, "coupling.memory"));
  }
  bw_log_destroy(&log);
  fclose(config.err);
  destroy(&s);
}
END_TEST

/* What slips by little of the largest speed that the run has had says nothing, however little moves
 * by then; where the speeds of the moment are the largest it is told. */
START_TEST(slip_at_rest_is_not_said)
{
  const bw_coupler_report r = {.slip = 7.98, .leak = 0.03};
  for (int rests = 0; rests < 2; rests++) {
    scene s = build(0.3, 1.0);
    bw_log_config config = bw_log_config_default();
    config.err = tmpfile();
    ck_assert_ptr_nonnull(config.err);
    bw_log *log = NULL;
    bw_check_ok(bw_log_create(bw_check_world(), &config, &log));
    bw_coupler_report seen;
    bw_check_ok(bw_coupler_measure(s.coupler, &seen));
    ck_assert_double_gt(s.coupler->speed, 0.0);
    ck_assert_double_eq(s.coupler->speed, s.coupler->speed_most);
    if (rests) s.coupler->speed = 1e-3 * s.coupler->speed_most;
    s.coupler->steps = 100;
    bw_coupler_warn_slip(s.coupler, &r, log);
    bw_coupler_warn_end(s.coupler, log);
    ck_assert((ftell(config.err) > 0) == (!rests && bw_comm_rank(bw_check_world()) == 0));
    bw_log_destroy(&log);
    fclose(config.err);
    destroy(&s);
  }
}
END_TEST

/* At the end of a short run, too, of the last report; a run that ends well says nothing. */
START_TEST(much_slip_at_the_end_is_said)
{
  const bw_coupler_report reports[] = {{.slip = 0.01, .leak = 0.01}, {.slip = 0.01, .leak = 0.07}};
  for (int q = 0; q < 2; q++) {
    scene s = build(0.3, 1.0);
    char text[512] = "";
    bw_log_config config = bw_log_config_default();
    config.err = tmpfile();
    ck_assert_ptr_nonnull(config.err);
    bw_log *log = NULL;
    bw_check_ok(bw_log_create(bw_check_world(), &config, &log));
    s.coupler->steps = 7;
    bw_coupler_warn_slip(s.coupler, &reports[q], log);
    ck_assert_int_eq(ftell(config.err), 0);
    bw_coupler_warn_end(s.coupler, log);
    const long said = ftell(config.err);
    bw_coupler_warn_end(s.coupler, log);
    ck_assert_int_eq(ftell(config.err), said);
    ck_assert((said > 0) == (q == 1 && bw_comm_rank(bw_check_world()) == 0));
    rewind(config.err);
    if (said > 0) {
      ck_assert_ptr_nonnull(fgets(text, sizeof text, config.err));
      ck_assert_ptr_nonnull(strstr(text, "7.0 % of it passes"));
      ck_assert_ptr_nonnull(strstr(text, "run longer (7 steps are a start)"));
    }
    bw_log_destroy(&log);
    fclose(config.err);
    destroy(&s);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(it_is_kept_per_particle),        BW_TEST(blocks_share_it),
    BW_TEST(tries_of_a_step_leave_it_alone), BW_TEST(a_held_solid_has_one_too),
    BW_TEST(broken_particles_have_none),     BW_TEST(slip_and_leak_are_told),
    BW_TEST(much_slip_is_said_once),         BW_TEST(slip_at_rest_is_not_said),
    BW_TEST(much_slip_at_the_end_is_said)};
BW_CHECK_MAIN("coupler.memory", tests)
