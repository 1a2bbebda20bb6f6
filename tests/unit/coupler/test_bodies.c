/* Free bodies in the coupler: they fall on walls, cross seams, leave, and are accounted for.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2,4 timeout=3600 */
#include "bodies_scene.h"
#include "ledger.h"

#include <string.h>

static const double DT = 1e-2;
enum { MOST = 64 };

static void check_sum(const bw_coupler_report *r, double mass)
{
  bw_check_near((r->mass_inside + r->mass_out + r->mass_left) / mass, 1.0, 4 * 2.3e-16);
}

/* A block leaves through the outflow, another one stays; the fluid runs on. Meanwhile what is out
 * rises particle by particle; in the end exactly one block's mass has left. */
START_TEST(a_block_leaves_and_its_mass_is_known)
{
  const bodies_set_up set_up = {.length = 32,
                                .ratio = 2.0,
                                .n_block = 2,
                                .block = {{24, 6, 28, 10}, {6, 6, 9, 9}},
                                .load = BW_LOAD_REACTION};
  bodies_scene s = bodies_build(&set_up);
  const double of_one = 2.0 * H * H * H, mass = 25 * of_one;
  const double rate = hypot(1 / bw_solid_dt_max(s.solid), 1 / bw_solid_dt_contact(s.solid));
  ck_assert_int_eq(bw_coupler_substeps(s.coupler, 3.5 * 0.8 / rate), 4); /* bonds and contact */
  double part_out = 0.0, V[2][3 * MOST];
  bw_coupler_report r = {0};
  int q = 0;
  for (; q < 300 && r.mass_left == 0.0; q++) {
    r = bodies_step(&s, 1, DT);
    check_sum(&r, mass);
    if (r.mass_out > 0.0 && r.mass_out < 15.5 * of_one) part_out = r.mass_out;
  }
  ck_assert_double_gt(part_out, 0.0); /* it was seen halfway */
  bw_check_near(r.mass_left / of_one, 16.0, 1e-12);
  bw_check_near(r.mass_inside / of_one, 9.0, 1e-12);
  const int64_t markers = r.markers;
  bodies_gather(&s, bw_solid_get_velocity, V[0]);
  r = bodies_step(&s, 10, DT); /* the fluid runs on, the piece flies on */
  bodies_gather(&s, bw_solid_get_velocity, V[1]);
  check_sum(&r, mass);
  ck_assert_int_eq(r.markers, markers);
  bw_check_near(r.mass_left / of_one, 16.0, 1e-12);
  const double *before = V[0], *after = V[1];
  double stay = 0.0;
  for (size_t i = 0; i < s.total; i++) {
    const bool first = before[3 * i] == after[3 * i] && before[3 * i + 1] == after[3 * i + 1];
    stay += !first;
    if (first) ck_assert_double_gt(before[3 * i], 0.3); /* it was carried out, not dropped */
  }
  ck_assert_double_eq(stay, 9.0);
  bodies_destroy(&s);
}
END_TEST

/* Saved while the block is halfway out, gone on, loaded, gone on again: the same to the end. */
START_TEST(restart_in_the_middle_of_leaving)
{
  const bodies_set_up set_up = {.length = 32,
                                .ratio = 2.0,
                                .n_block = 1,
                                .block = {{25, 5, 29, 9}},
                                .load = BW_LOAD_REACTION};
  bodies_scene s = bodies_build(&set_up);
  char path[32]; /* of this number of ranks: tests run side by side */
  snprintf(path, sizeof path, "test_bodies_np%d.h5", bw_comm_size(bw_check_world()));
  double X[2][3 * MOST];
  bw_coupler_report r = {0};
  bw_checkpoint *ck = NULL;
  while (r.mass_out < 3 * H * H * H)
    r = bodies_step(&s, 1, DT);
  ck_assert_double_eq(r.mass_left, 0.0);
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_save(s.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  for (int round = 0; round < 2; round++) {
    r = bodies_step(&s, 40, DT);
    ck_assert_double_gt(r.mass_left, 0.0);
    bodies_gather(&s, bw_solid_get_position, X[round]);
    if (round > 0) break;
    bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
    bw_check_ok(bw_coupler_load(s.coupler, ck));
    bw_check_ok(bw_checkpoint_close(&ck));
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    ck_assert_double_eq(r.mass_left, 0.0); /* not retired at the time */
  }
  for (size_t q = 0; q < 3 * s.total; q++)
    bw_check_near(X[1][q], X[0][q], 1e5 * BW_REAL_EPSILON);
  bodies_destroy(&s);
  if (bw_comm_rank(bw_check_world()) == 0) remove(path);
}
END_TEST

/* A heavy block lies on the floor: no particle in the wall, the wall bears its weight less the
 * buoyancy. It begins there, as a face that comes down flat has a film of fluid to squeeze out,
 * which takes longer the thinner it gets (1/gap^3) where no slip is left. */
START_TEST(a_heavy_block_lies_on_the_floor)
{
  const bodies_set_up set_up = {.length = 16,
                                .periodic = true,
                                .still = true,
                                .ratio = 5.0,
                                .gravity = 2.0,
                                .n_block = 1,
                                .block = {{6, 0, 10, 4}},
                                .load = BW_LOAD_REACTION};
  bodies_scene s = bodies_build(&set_up);
  double X[3 * MOST], lowest = 1.0;
  bodies_step(&s, 300, DT);
  const double before = ledger_of(s.solid).wall[1];
  bodies_step(&s, 50, DT);
  const double weight = 16 * H * H * H * (5.0 - 1.0) * 2.0, push = ledger_of(s.solid).wall[1];
  bodies_gather(&s, bw_solid_get_position, X);
  for (size_t i = 0; i < s.total; i++)
    lowest = fmin(lowest, X[3 * i + 1]);
  ck_assert_double_gt(lowest, 0.45 * H);
  ck_assert_double_lt(lowest, 0.55 * H);
  bw_check_near(-(push - before) / (50 * DT * weight), 1.0, 0.01); /* the fluid still settles */
  bodies_destroy(&s);
}
END_TEST

/* Half the channel's length further on, with the seam in its way, a block does the same. */
START_TEST(the_seam_is_not_there)
{
  bodies_set_up set_up = {.length = 24, .periodic = true, .ratio = 2.0, .n_block = 1};
  for (int load = 0; load < 2; load++) {
    double X[2][3 * MOST];
    set_up.load = load == 0 ? BW_LOAD_PROBES : BW_LOAD_REACTION;
    for (int q = 0; q < 2; q++) {
      const int first = 4 + 12 * q; /* 16 ... 20: it reaches 24 and goes on */
      memcpy(set_up.block[0], (int[4]){first, 4, first + 4, 8}, sizeof set_up.block[0]);
      bodies_scene s = bodies_build(&set_up);
      bodies_step(&s, 100, DT);
      bodies_gather(&s, bw_solid_get_position, X[q]);
      bodies_destroy(&s);
    }
    ck_assert_double_gt(X[1][0], 24 * H); /* across, and not wrapped */
    for (size_t i = 0; i < 16; i++) {
      bw_check_near(X[1][3 * i] - X[0][3 * i], 12 * H, 1e6 * BW_REAL_EPSILON);
      bw_check_near(X[1][3 * i + 1], X[0][3 * i + 1], 1e6 * BW_REAL_EPSILON);
    }
  }
}
END_TEST

static double mean_speed(const bodies_scene *s)
{
  double V[3 * 16], mean = 0.0;
  bodies_gather(s, bw_solid_get_velocity, V);
  for (size_t i = 0; i < s->total; i++)
    mean += V[3 * i] / (double)s->total;
  return mean;
}

/* Fluid at rest that a gradient sets going takes a block of its own density along as if it were
 * fluid; its pressure field is without the gradient. Walls tell by diffusion after exp(-0.375^2/(4
 * nu t)) = 2e-8. 1 %: in the first step the acceleration is not known yet, and what slip that
 * leaves has some drag. Without what drives it the block would get half of it. By the reaction,
 * iterated, as well: if the fluid inside were a part of its mass, it would get less than two
 * thirds, (m_f + m_a)/(m + m_f + m_a). */
static void drive(bw_coupler_load_kind load, int iterations)
{
  const bodies_set_up set_up = {.load = load,
                                .iterations = iterations,
                                .length = 32,
                                .periodic = true,
                                .still = true,
                                .ratio = 1.0,
                                .n_block = 1,
                                .block = {{8, 6, 12, 10}}};
  const double dt = 5e-3;
  bodies_scene s = bodies_build(&set_up);
  bw_ns_channel_set_forcing(s.fluid, 1.0);
  bodies_step(&s, 5, dt);
  const double before = mean_speed(&s);
  bodies_step(&s, 15, dt);
  bw_check_near((mean_speed(&s) - before) / (15 * dt), 1.0, 0.01);
  bodies_destroy(&s);
}

START_TEST(what_drives_the_fluid_drives_the_body)
{
  drive(BW_LOAD_PROBES, 0);
  drive(BW_LOAD_PROBES, 50);
  drive(BW_LOAD_REACTION, 50);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_block_leaves_and_its_mass_is_known), BW_TEST(restart_in_the_middle_of_leaving),
    BW_TEST(a_heavy_block_lies_on_the_floor), BW_TEST(the_seam_is_not_there),
    BW_TEST(what_drives_the_fluid_drives_the_body)};
BW_CHECK_MAIN("coupler.bodies", tests)
