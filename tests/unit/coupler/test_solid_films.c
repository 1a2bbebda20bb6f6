/* Films between faces of particles: ranks, restart, momentum, energy, what is refused.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,3 */
#include "bodies_scene.h"
#include "ledger.h"

#include <string.h>

static const double DT = 1e-2;
enum { MOST = 96 };

/* A block that falls on a wider one, half a cell under it, which falls on the floor, a cell under
 * it. No roughness is reached. */
static bodies_set_up pile(void)
{
  return (bodies_set_up){
      .length = 20,
      .periodic = true,
      .still = true,
      .ratio = 4.0,
      .gravity = 2.0,
      .n_block = 2,
      .block = {{4, 1, 12, 5}, {6, 9, 11, 13}},
      .lower = {0.0, 3.5},
      .load = BW_LOAD_REACTION,
      .films = {.on = true, .limit = NAN, .roughness = 1e-4, .least = -INFINITY, .flux = true}};
}

/* The same on all ranks together and on each alone. */
START_TEST(ranks_do_not_matter)
{
  double X[2][3 * MOST];
  bw_comm *self = NULL;
  size_t total = 0;
  bw_check_ok(bw_comm_self(&self));
  for (int alone = 0; alone < 2; alone++) {
    bodies_set_up set_up = pile();
    if (alone == 1) set_up.comm = self;
    bodies_scene s = bodies_build(&set_up);
    const bw_coupler_report r = bodies_step(&s, 25, DT);
    ck_assert_int_gt(r.film_nodes, 15);
    ck_assert_double_gt(r.work_film, 0.0);
    bodies_gather(&s, bw_solid_get_position, X[alone]);
    total = s.total;
    bodies_destroy(&s);
  }
  bw_comm_destroy(&self);
  for (size_t i = 0; i < 3 * total; i++)
    bw_check_near(X[0][i], X[1][i], 1e5 * BW_REAL_EPSILON);
}
END_TEST

/* Saved, gone on, loaded, gone on again: the same. */
START_TEST(restart)
{
  const bodies_set_up set_up = pile();
  bodies_scene s = bodies_build(&set_up);
  double X[2][3 * MOST], film[2];
  bw_checkpoint *ck = NULL;
  char path[48];
  snprintf(path, sizeof path, "test_solid_films_np%d.h5", bw_comm_size(bw_check_world()));
  bodies_step(&s, 15, DT);
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_save(s.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  for (int round = 0; round < 2; round++) {
    film[round] = bodies_step(&s, 15, DT).work_film;
    bodies_gather(&s, bw_solid_get_position, X[round]);
    if (round > 0) break;
    bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
    bw_check_ok(bw_coupler_load(s.coupler, ck));
    bw_check_ok(bw_checkpoint_close(&ck));
  }
  for (size_t i = 0; i < 3 * s.total; i++)
    bw_check_near(X[1][i], X[0][i], 1e5 * BW_REAL_EPSILON);
  bw_check_near(film[1] / film[0], 1.0, 1e7 * BW_REAL_EPSILON);
  bodies_destroy(&s);
  if (bw_comm_rank(bw_check_world()) == 0) remove(path);
}
END_TEST

static double fallen(const bodies_scene *s)
{
  double X[3 * MOST], sum = 0.0;
  bodies_gather(s, bw_solid_get_position, X);
  for (size_t i = 0; i < s->total; i++)
    sum += X[3 * i + 1];
  return sum;
}

/* The solid's external work is that of weight and load less what films took. Films never give. */
START_TEST(energy_is_booked)
{
  const bodies_set_up set_up = pile();
  bodies_scene s = bodies_build(&set_up);
  const double of_one = H * H * H * (4.0 - 1.0) * 2.0, from = fallen(&s);
  double before = 0.0;
  bw_coupler_report r = {0};
  for (int q = 0; q < 6; q++) {
    r = bodies_step(&s, 5, DT);
    ck_assert_double_gt(r.work_film, before);
    before = r.work_film;
  }
  const double weight = of_one * (from - fallen(&s));
  bw_check_near(ledger_of(s.solid).external / weight,
                (weight + r.work_received - r.work_film) / weight, 2e-3);
  ck_assert_double_gt(r.work_film, 0.1 * weight);
  bodies_destroy(&s);
}
END_TEST

/* Far from everything films are nothing: the same bits with them and without. */
START_TEST(far_apart)
{
  double X[2][3 * MOST];
  for (int on = 0; on < 2; on++) {
    bodies_set_up set_up = pile();
    set_up.n_block = 1, set_up.films.on = on == 1;
    set_up.block[0][1] = 6, set_up.block[0][3] = 10;
    bodies_scene s = bodies_build(&set_up);
    const bw_coupler_report r = bodies_step(&s, 5, DT);
    ck_assert_int_eq(r.film_nodes, 0);
    ck_assert_double_eq(r.work_film, 0.0);
    ck_assert(isinf(r.film_gap));
    bodies_gather(&s, bw_solid_get_position, X[on]);
    bodies_destroy(&s);
  }
  ck_assert_int_eq(memcmp(X[0], X[1], 3 * 32 * sizeof(double)), 0);
}
END_TEST

START_TEST(bad_input_is_refused)
{
  const struct {
    const char *word;
    double limit, roughness, least;
  } cases[] = {{"roughness", NAN, 2.0 * H, -1.0},
               {"roughness", NAN, NAN, -1.0},
               {"limit", 0.5 * H, 1e-3, -1.0},
               {"least", NAN, 1e-3, 1.0}};
  const bodies_set_up set_up = pile();
  bodies_scene s = {0};
  bodies_make_fluid(&set_up, &s);
  bodies_make_solid(&set_up, &s);
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_coupler_config c = bodies_coupling(&set_up);
    c.films.limit = cases[q].limit, c.films.roughness = cases[q].roughness;
    c.films.least = cases[q].least;
    bw_check_status(bw_coupler_create(&c, s.fluid, s.solid, &s.coupler), BW_EINPUT);
    ck_assert_msg(strstr(bw_last_message(), cases[q].word) != NULL, "%s", bw_last_message());
  }
  bodies_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(ranks_do_not_matter), BW_TEST(restart),
                                      BW_TEST(energy_is_booked), BW_TEST(far_apart),
                                      BW_TEST(bad_input_is_refused)};
BW_CHECK_MAIN("solid_films", tests)
