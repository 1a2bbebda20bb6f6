/* What the coupler measures of its own stability, and what it chooses by that: a body in fluid at
 * rest, plane.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2,3 timeout=600 */
#include "../../../validation/coupler/block.h"
#include "bw_check.h"
#include "bw_mix.h"
#include "coupler_internal.h"

#include <stdio.h>
#include <string.h>

static const double SPEED = 1e-3;

/* The plate, w left open, unless said otherwise. */
static block_set_up plate(double ratio)
{
  return (block_set_up){.body = A_PLATE,
                        .ratio = ratio,
                        .w = NAN,
                        .virtual_mass = 1.0,
                        .dt = DT,
                        .load = BW_LOAD_PROBES,
                        .speed = SPEED};
}

static block_scene make(const block_set_up *b)
{
  block_scene s;
  bw_check_ok(block_create(bw_check_world(), b, &s));
  return s;
}

static void steps(block_scene *s, int n)
{
  for (int q = 0; q < n; q++)
    bw_check_ok(bw_coupler_step(s->coupler, DT));
}

/* Closed forms: all of the added mass in the first step, z = 1 - W - W lambda; all of it in the
 * second, z^2 - (1 - W) z + W lambda; and what the virtual mass makes of w. */
START_TEST(limits_of_the_recurrence)
{
  static const double first[2] = {7.0, 0.0}, second[2] = {0.0, 5.0}, mu = 2.0;
  static const double bisected = 0.035; /* of a limit, and what slow growth moves it by */
  ck_assert_double_eq_tol(bw_coupler__relaxation_limit(2, first, 0.0, false) / 0.25, 1.0, bisected);
  ck_assert_double_eq_tol(bw_coupler__relaxation_limit(2, second, 0.0, false) / 0.2, 1.0, bisected);
  ck_assert_double_eq_tol(bw_coupler__relaxation_limit(2, first, mu, false) / (log(2.0) / mu), 1.0,
                          1.5 * bisected);
  /* With a predictor what swings with the step meets 2 + 0.4/1.8 times the answer. */
  const double met = 2.0 + 0.4 / 1.8;
  ck_assert_double_eq_tol(
      bw_coupler__relaxation_limit(2, first, 0.0, true) * 0.5 * (1.0 + 7.0 * met), 1.0, bisected);
  /* Bodies heavy against the fluid hold with any w, those with more virtual mass than that too. */
  ck_assert_double_eq(bw_coupler__relaxation_limit(1, (double[]){0.9}, 0.0, false), 1.0);
  ck_assert_double_eq(bw_coupler__relaxation_limit(2, first, 4.1, false), 1.0);
}
END_TEST

static uint64_t add(uint64_t hash, size_t n, const double x[])
{
  for (size_t i = 0; i < n; i++) {
    uint64_t bits;
    memcpy(&bits, x + i, sizeof bits);
    hash = bw_mix(hash + bits);
  }
  return hash;
}

/* Everything of this rank that goes on from step to step. */
static uint64_t print_of(block_scene *s)
{
  const bw_coupler *c = s->coupler;
  const bw_grid_view *g = bw_grid_look(s->grid);
  uint64_t hash = 1;
  bw_solid_get_position(s->solid, s->X);
  bw_solid_get_velocity(s->solid, s->V);
  const double *const of[] = {s->X, s->V, c->F, c->M, c->V_before};
  for (size_t q = 0; q < sizeof of / sizeof *of; q++)
    hash = add(hash, 3 * c->n, of[q]);
  for (int d = 0; d < 2; d++)
    for (size_t i = 0; i < g->size; i++)
      hash = add(hash, 1, &(double){(double)bw_ns_channel_velocity(s->fluid)[d][i]});
  return hash;
}

/* A measurement on the way changes nothing: the same bits after two steps behind it. */
START_TEST(a_measurement_disturbs_nothing)
{
  for (int q = 0; q < 4; q++) {
    uint64_t print[2];
    for (int measured = 0; measured < 2; measured++) {
      block_set_up b = plate(1.0);
      b.w = 0.1, b.spacing = q / 2 * 2.0, b.load = (bw_coupler_load_kind)(q % 2);
      block_scene s = make(&b);
      bw_coupler_limit limit;
      steps(&s, 2);
      if (measured) bw_check_ok(bw_coupler_find_limit(s.coupler, DT, &limit));
      steps(&s, 2);
      print[measured] = print_of(&s);
      block_destroy(&s);
    }
    ck_assert_uint_eq(print[0], print[1]);
  }
}
END_TEST

/* What the coupler says on a log; at the end of `text`, of size `room`. */
static void listen(bw_coupler *c, size_t room, char text[])
{
  bw_log *log = NULL;
  bw_log_config config = bw_log_config_default();
  config.out = config.err = tmpfile();
  ck_assert_ptr_nonnull(config.err);
  bw_check_ok(bw_log_create(bw_check_world(), &config, &log));
  bw_coupler_tell_limit(c, log);
  bw_coupler_tell_limit(c, log); /* once */
  rewind(config.err);
  text[fread(text, 1, room - 1, config.err)] = '\0';
  bw_log_destroy(&log);
  fclose(config.err);
}

/* Heavy: a tenth. Light: half of the limit. The fluid's share goes with the inverse of the ratio.
 * Each is said once. */
START_TEST(what_is_left_open_is_chosen)
{
  static const double ratio[2] = {3.0, 0.1};
  static const char *const word[2] = {": 0.1 is taken", "is taken, so that loads come in over"};
  double added[2];
  for (int q = 0; q < 2; q++) {
    const block_set_up b = plate(ratio[q]);
    block_scene s = make(&b);
    bw_coupler_report r;
    char text[512];
    steps(&s, 1);
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    const double half = 0.5 * r.relaxation_limit;
    ck_assert_double_eq(r.relaxation, q == 0 ? 0.1 : half);
    ck_assert((half > 0.1) == (q == 0));
    added[q] = s.coupler->choice.limit.added * ratio[q];
    listen(s.coupler, sizeof text, text);
    if (bw_comm_rank(bw_check_world()) == 0) {
      const char *said = strstr(text, word[q]);
      ck_assert_ptr_nonnull(said);
      ck_assert_ptr_null(strstr(said + strlen(word[q]), "is taken"));
    }
    block_destroy(&s);
  }
  /* The plate's own speed of sound against the step is the same: only its mass differs. */
  ck_assert_double_eq_tol(added[1] / added[0], 1.0, 0.02);
}
END_TEST

/* Given by hand: measured when that is asked for, kept, and warned of above half of the limit. */
START_TEST(what_is_given_is_kept)
{
  static const double w[3] = {0.5, 0.04, 0.02}; /* the limit lies between twice the last two */
  static const char *const word[3] = {"will grow", "factor of two", NULL};
  for (int q = 0; q < 3; q++) {
    block_set_up b = plate(0.3);
    bw_coupler_report r;
    char text[512];
    b.w = w[q];
    block_scene s = make(&b);
    s.coupler->config.check_relaxation = true;
    steps(&s, 1);
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    ck_assert_double_eq(r.relaxation, w[q]);
    ck_assert(r.relaxation_limit > 0.04 && r.relaxation_limit < 0.08);
    listen(s.coupler, sizeof text, text);
    const bool speaks = word[q] != NULL && bw_comm_rank(bw_check_world()) == 0;
    ck_assert((strlen(text) > 0) == speaks);
    if (speaks) ck_assert_ptr_nonnull(strstr(text, word[q]));
    block_destroy(&s);
  }
}
END_TEST

/* A choice so small that loads take hundreds of steps is warned of, with the way out. */
START_TEST(loads_that_take_for_ever_are_told)
{
  static const double w[2] = {0.02, 0.005};
  for (int q = 0; q < 2; q++) {
    const block_set_up b = plate(1.0);
    block_scene s = make(&b);
    char text[512];
    s.coupler->config.load_relaxation = w[q];
    s.coupler->choice = (bw_coupler__choice){
        .open = true, .made = true, .dt = DT, .limit = {.relaxation = 2.0 * w[q], .added = 9.0}};
    listen(s.coupler, sizeof text, text);
    const bool warned = strstr(text, "coupling_iterations of 50") != NULL;
    ck_assert(warned == (q == 1 && bw_comm_rank(bw_check_world()) == 0));
    block_destroy(&s);
  }
}
END_TEST

/* A restart takes the choice over, whatever it would find itself, and goes on to the same bits. */
START_TEST(a_restart_keeps_the_choice)
{
  char path[40]; /* of this number of ranks: tests run side by side */
  snprintf(path, sizeof path, "test_stability_np%d.h5", bw_comm_size(bw_check_world()));
  const block_set_up b = plate(0.1);
  uint64_t print[2];
  bw_checkpoint *ck = NULL;
  block_scene s = make(&b);
  steps(&s, 3);
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_save(s.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  const double w = s.coupler->config.load_relaxation;
  steps(&s, 2);
  print[0] = print_of(&s);
  block_destroy(&s);
  s = make(&b);
  bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_load(s.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  ck_assert_double_eq(s.coupler->config.load_relaxation, w);
  ck_assert_double_lt(w, 0.1);
  steps(&s, 2);
  print[1] = print_of(&s);
  ck_assert_uint_eq(print[0], print[1]);
  block_destroy(&s);
  if (bw_comm_rank(bw_check_world()) == 0) remove(path);
}
END_TEST

/* Much has broken, or the step is another: what was found is found anew. */
START_TEST(another_body_is_measured_anew)
{
  const block_set_up b = plate(1.0);
  block_scene s = make(&b);
  const size_t bytes = bw_solid_bits_bytes(s.solid);
  uint8_t *bits = NULL;
  bw_check_ok(BW_ALLOCATE(&bits, s.n * bytes));
  steps(&s, 2);
  const double before = s.coupler->choice.limit.added;
  ck_assert(s.coupler->choice.broken == 0.0 && s.coupler->choice.dt == DT);
  /* All bonds of the upper half of the plate: free particles, with no more mass than their own. */
  bw_solid_get_position(s.solid, s.X);
  bw_solid_get_bits(s.solid, bits);
  for (size_t i = 0; i < s.n; i++)
    if (s.X[3 * i + 1] > 6.0 * H) memset(bits + i * bytes, 0, bytes);
  bw_check_ok(bw_solid_set_bits(s.solid, bits));
  steps(&s, 2);
  ck_assert_double_gt(s.coupler->choice.broken, 0.0);
  ck_assert_double_ne(s.coupler->choice.limit.added, before);
  bw_check_ok(bw_coupler_step(s.coupler, 0.5 * DT));
  ck_assert_double_eq(s.coupler->choice.dt, 0.5 * DT);
  bw_release(&bits);
  block_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(limits_of_the_recurrence),          BW_TEST(a_measurement_disturbs_nothing),
    BW_TEST(what_is_left_open_is_chosen),       BW_TEST(what_is_given_is_kept),
    BW_TEST(loads_that_take_for_ever_are_told), BW_TEST(a_restart_keeps_the_choice),
    BW_TEST(another_body_is_measured_anew)};
BW_CHECK_MAIN("coupler.stability", tests)
