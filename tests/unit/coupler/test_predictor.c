/* A step whose fluid is told how the solid would move in it.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2 timeout=600 */
#include "bw_mix.h"
#include "cube_scene.h"
#include "ledger.h"

#include <string.h>

static const double STEP = 4.0e-3;

/* The free cube in the stream, with a predictor or without; at first its particles move roughly,
 * and waves of the lattice go to and fro. */
static scene make(bool predictor, double rough)
{
  scene s = build(0.3, 0.1);
  bw_coupler_config config = s.coupler->config;
  config.predictor = predictor;
  config.load = BW_LOAD_REACTION;
  config.count_work = true;
  bw_coupler_destroy(&s.coupler);
  bw_check_ok(bw_coupler_create(&config, s.fluid, s.solid, &s.coupler));
  bw_coupler_hold_solid(s.coupler, false);
  double *X = NULL, *V = NULL;
  const size_t n = bw_solid_count(s.solid);
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_position(s.solid, X);
  for (size_t i = 0; i < 3 * n; i++) {
    const uint64_t id = 3 * (uint64_t)bw_solid_id(s.solid)[i / 3] + i % 3 + 1;
    V[i] = rough * ((double)(bw_mix(id) >> 11) * 0x1p-52 - 1.0);
  }
  bw_solid_set_state(s.solid, X, V);
  bw_release(&X);
  bw_release(&V);
  return s;
}

static void steps(scene *s, int n)
{
  for (int q = 0; q < n; q++)
    bw_check_ok(bw_coupler_step(s->coupler, STEP));
}

/* Looking ahead changes nothing but what the fluid is told, and that is the mean velocity of the
 * solid's own sub-steps under the load that it felt last, and a share of what it lagged behind. */
START_TEST(the_solid_is_put_back)
{
  scene s = make(true, 0.01);
  bw_coupler *c = s.coupler;
  const size_t n = 3 * bw_solid_count(s.solid), width = bw_solid_restart_row(s.solid) * n / 3;
  double *row[2] = {NULL, NULL}, sums[2][BW_SOLID_RESTART_SUMS], *X = NULL, *told = NULL;
  double most[2] = {0.0, 0.0};
  steps(&s, 3);
  const int64_t events = bw_solid_events(s.solid);
  bw_check_ok(BW_ALLOCATE(&X, n));
  bw_check_ok(BW_ALLOCATE(&told, n));
  for (int q = 0; q < 2; q++) {
    bw_check_ok(BW_ALLOCATE(&row[q], width));
    bw_solid_get_restart(s.solid, row[q], sums[q]);
    if (q == 0) bw_check_ok(bw_coupler__predict(c, STEP));
  }
  ck_assert_mem_eq(row[0], row[1], width * sizeof *row[0]);
  ck_assert_mem_eq(sums[0], sums[1], sizeof sums[0]);
  ck_assert_int_eq(bw_solid_events(s.solid), events);
  memcpy(told, c->V, n * sizeof *told);
  /* The same by hand. */
  bw_solid_get_position(s.solid, X);
  memcpy(c->F, c->felt, n * sizeof *c->F);
  bw_coupler__push_solid(c);
  const int K = bw_coupler_substeps(c, STEP);
  ck_assert_int_gt(K, 1);
  for (int q = 0; q < K; q++)
    bw_check_ok(bw_solid_step(s.solid, STEP / K));
  bw_solid_get_position(s.solid, c->X);
  for (size_t i = 0; i < n; i++) {
    most[0] = fmax(most[0], fabs(told[i]));
    const double moved = c->X[i] - X[i] + BW_COUPLER__CATCH_UP * c->lag[i];
    most[1] = fmax(most[1], fabs(told[i] - moved / STEP));
  }
  bw_comm_max(bw_check_world(), 2, most);
  ck_assert_double_gt(most[0], 0.0);
  ck_assert_double_le(most[1], ROUND_OFF * most[0]);
  bw_release(&row[0]);
  bw_release(&row[1]);
  bw_release(&X);
  bw_release(&told);
  destroy(&s);
}
END_TEST

/* Work that comes from nowhere while a rough motion rings, over that given. */
static double missed(bool predictor)
{
  scene s = make(predictor, 0.1);
  bw_coupler_report r;
  steps(&s, 20);
  bw_check_ok(bw_coupler_measure(s.coupler, &r));
  const double sum = r.work_given - r.work_late - r.work_received;
  ck_assert_double_gt(fabs(r.work_given), 0.0);
  destroy(&s);
  return fabs(sum / r.work_given);
}

/* The book closes ten times better, at least. */
START_TEST(less_work_comes_from_nowhere)
{
  const double with = missed(true), without = missed(false);
  ck_assert_double_gt(without, 1e-3); /* or there would be nothing to see */
  ck_assert_double_lt(with, 0.1 * without);
}
END_TEST

/* Saved, gone on, loaded, gone on again: the same velocities, to round-off. */
START_TEST(a_restart_looks_ahead_the_same_way)
{
  scene s = make(true, 0.01);
  steps(&s, 2);
  check_restart(&s, "test_predictor", STEP, 3);
  destroy(&s);
}
END_TEST

/* Repeated steps know the motion already. */
START_TEST(repeated_steps_refuse_it)
{
  scene s = build(0.3, 0.1);
  bw_coupler_config config = s.coupler->config;
  bw_coupler *other = NULL;
  config.predictor = true;
  config.coupling_iterations = 5;
  ck_assert_int_eq(bw_coupler_create(&config, s.fluid, s.solid, &other), BW_EINPUT);
  ck_assert_ptr_null(other);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "coupling_iterations = 5"));
  destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(the_solid_is_put_back), BW_TEST(less_work_comes_from_nowhere),
    BW_TEST(a_restart_looks_ahead_the_same_way), BW_TEST(repeated_steps_refuse_it)};
BW_CHECK_MAIN("coupler.predictor", tests)
