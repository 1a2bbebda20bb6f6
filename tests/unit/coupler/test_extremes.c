/* Bodies that the method is not made for: they run and stay bounded, or are refused by name.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2 timeout=3600 */
#include "bodies_scene.h"
#include "ledger.h"

#include <string.h>

static const double DT = 5e-3;

/* Both loads for 40 steps: nothing faster than four times the stream, no mass lost. */
static void check_bounded(bodies_scene *s)
{
  const double mass = (double)s->total * bw_solid_settings(s->solid)->rho * H * H * H;
  const bw_coupler_report r = bodies_step(s, 40, DT);
  double *V = NULL, fastest = 0.0;
  bw_check_ok(BW_ALLOCATE(&V, 3 * s->n));
  bw_solid_get_velocity(s->solid, V);
  for (size_t i = 0; i < 3 * s->n; i++)
    fastest = fmax(fastest, fabs(V[i]));
  bw_comm_max(bw_check_world(), 1, &fastest);
  ck_assert_double_gt(fastest, 0.0);
  ck_assert_double_lt(fastest, 6.0);
  bw_check_near((r.mass_inside + r.mass_out + r.mass_left) / mass, 1.0, 1e-12);
  bw_release(&V);
}

static void check_runs(bodies_set_up set_up)
{
  for (int load = 0; load < 2; load++) {
    set_up.load = load == 0 ? BW_LOAD_PROBES : BW_LOAD_REACTION;
    bodies_scene s = bodies_build(&set_up);
    check_bounded(&s);
    bodies_destroy(&s);
  }
}

START_TEST(a_fragment_of_one_particle)
{
  check_runs((bodies_set_up){.length = 32, .ratio = 3.0, .n_block = 1, .block = {{8, 8, 9, 9}}});
}
END_TEST

START_TEST(bodies_one_cell_thick)
{
  check_runs((bodies_set_up){
      .length = 32, .ratio = 3.0, .n_block = 2, .block = {{8, 5, 9, 11}, {14, 8, 20, 9}}});
}
END_TEST

START_TEST(surfaces_closer_than_the_kernel)
{
  check_runs((bodies_set_up){.length = 32,
                             .ratio = 3.0,
                             .n_block = 3,
                             .block = {{8, 6, 11, 9}, {8, 10, 11, 13}, {12, 6, 15, 13}}});
}
END_TEST

START_TEST(a_body_on_the_wall)
{
  check_runs((bodies_set_up){
      .length = 32, .ratio = 3.0, .n_block = 2, .block = {{8, 0, 12, 4}, {16, 13, 20, 16}}});
}
END_TEST

START_TEST(a_body_at_the_inlet)
{
  check_runs((bodies_set_up){.length = 32, .ratio = 3.0, .n_block = 1, .block = {{0, 6, 4, 10}}});
}
END_TEST

START_TEST(a_body_at_the_outlet)
{
  check_runs((bodies_set_up){.length = 32, .ratio = 3.0, .n_block = 1, .block = {{28, 6, 32, 10}}});
}
END_TEST

/* Half of it is on either side of the seam. */
START_TEST(a_body_across_the_periodic_seam)
{
  check_runs((bodies_set_up){
      .length = 32, .periodic = true, .ratio = 3.0, .n_block = 1, .block = {{30, 6, 34, 10}}});
}
END_TEST

/* All bonds gone: a heap of grains that only contact keeps apart. */
START_TEST(all_bonds_broken)
{
  const bodies_set_up set_up = {.length = 32,
                                .ratio = 3.0,
                                .n_block = 1,
                                .block = {{8, 6, 12, 10}},
                                .load = BW_LOAD_REACTION};
  bodies_scene s = bodies_build(&set_up);
  uint8_t *bits = NULL;
  bw_check_ok(BW_ALLOCATE(&bits, s.n * bw_solid_bits_bytes(s.solid)));
  bw_check_ok(bw_solid_set_bits(s.solid, bits)); /* none */
  bw_release(&bits);
  const bw_solid_ledger e = ledger_of(s.solid);
  ck_assert_int_eq(e.broken, e.bonds);
  check_bounded(&s);
  bw_pd_fragments piece;
  bw_check_ok(bw_pd_interface_fragments(bw_coupler_edit_interface(s.coupler), NULL, &piece));
  ck_assert_int_eq(piece.total, 16);
  bw_pd_fragment_release(&piece);
  bodies_destroy(&s);
}
END_TEST

/* A block on a foundation of three layers under the wall, cut off along the wall: it is free, meets
 * the wall that it stood across, and the foundation stays where it is. */
START_TEST(a_crack_through_the_foundation)
{
  const bodies_set_up set_up = {.length = 32,
                                .ratio = 3.0,
                                .n_block = 2,
                                .gravity = 1.0,
                                .block = {{8, 0, 12, 5}, {8, -3, 12, 0}},
                                .held_block = 2,
                                .load = BW_LOAD_REACTION};
  bodies_scene s = bodies_build(&set_up);
  bw_check_ok(bw_solid_precrack(s.solid, (double[3]){0, 0, 0}, (double[3]){2, 0, 0}, NULL));
  check_bounded(&s);
  double X[3 * 64], lowest = 1.0;
  bodies_gather(&s, bw_solid_get_position, X);
  int under = 0;
  for (size_t i = 0; i < s.total; i++) {
    under += X[3 * i + 1] < 0.0;
    if (X[3 * i + 1] > 0.0) lowest = fmin(lowest, X[3 * i + 1]);
  }
  ck_assert_int_eq(under, 12);
  ck_assert_double_gt(lowest, 0.3 * H);
  bodies_destroy(&s);
}
END_TEST

/* A free particle on the wrong side of a wall has no place in the run. */
START_TEST(a_free_body_beyond_a_wall_is_refused)
{
  const bodies_set_up set_up = {
      .length = 32, .ratio = 3.0, .n_block = 1, .block = {{8, -3, 12, 0}}};
  bodies_scene s = {0};
  const bw_coupler_config c = bodies_coupling(&set_up);
  bodies_make_fluid(&set_up, &s);
  bodies_make_solid(&set_up, &s);
  bw_check_status(bw_coupler_create(&c, s.fluid, s.solid, &s.coupler), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "beyond the wall"));
  bodies_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(a_fragment_of_one_particle),
                                      BW_TEST(bodies_one_cell_thick),
                                      BW_TEST(surfaces_closer_than_the_kernel),
                                      BW_TEST(a_body_on_the_wall),
                                      BW_TEST(a_body_at_the_inlet),
                                      BW_TEST(a_body_at_the_outlet),
                                      BW_TEST(a_body_across_the_periodic_seam),
                                      BW_TEST(all_bonds_broken),
                                      BW_TEST(a_crack_through_the_foundation),
                                      BW_TEST(a_free_body_beyond_a_wall_is_refused)};
BW_CHECK_MAIN("coupler.extremes", tests)
