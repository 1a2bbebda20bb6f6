/* The coupler: where markers and probes are, the load of a known pressure, sub-steps, state.
 * BUILD modules=coupler,shape
 * TEST  ranks=1,2,3 timeout=3600 */
#include "cube_scene.h"
#include "ledger.h"
#include "pd_body.h"

#include <stdio.h>
#include <string.h>

/* Probes begin on the surface, (1/2) h outside the centre (ds = h), on a smooth slanted surface at
 * the mean height of its steps; markers so far inside as the retraction says (the cube is flat: its
 * markers know no normal). */
START_TEST(markers_sit_where_the_retraction_says)
{
  for (int q = 0; q < 3; q++) {
    const double retraction = q < 2 ? 0.5 * q : NAN;
    const bw_ibm_mdf_config forcing = bw_ibm_mdf_config_default();
    scene s = build(retraction, 1.0);
    const bw_coupler *c = s.coupler;
    double *X = NULL;
    bw_check_ok(BW_ALLOCATE(&X, 3 * bw_solid_count(s.solid)));
    bw_solid_get_position(s.solid, X);
    for (size_t m = 0; m < c->n_surface; m++) {
      const double *n = c->normal + 3 * m;
      const bool smooth = bw_pd_interface_surface(c->interface).smooth[c->row[m]];
      const double height = smooth ? 0.5 / (fabs(n[0]) + fabs(n[1]) + fabs(n[2])) : 0.5;
      const double in = q < 2 ? retraction : bw_ibm_mdf_retraction(&forcing);
      for (int d = 0; d < 3; d++) {
        const double centre = X[3 * (size_t)c->particle[m] + d];
        bw_check_near(c->marker_X[3 * m + d], centre + (height - in) * H * n[d], ROUND_OFF);
        bw_check_near(c->root[3 * m + d], centre + height * H * n[d], ROUND_OFF);
      }
    }
    bw_release(&X);
    destroy(&s);
  }
}
END_TEST

/* p/rho = -G x pushes a closed body that is accelerated with the fluid (by G) along +x with
 * rho G V. The bound is what the discrete surface allows: normals at edges lean over 45 degrees,
 * and the probes' roots enclose (8 h)^3. The acceleration is that over the last step. */
START_TEST(linear_pressure_lifts_the_body)
{
  scene s = build(0.5, 0.5);
  const bw_grid_view *g = bw_grid_look(s.grid);
  bw_real *p = bw_ns_channel_pressure(s.fluid), *const *u = bw_ns_channel_velocity(s.fluid);
  for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
    for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
      for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++)
        p[bw_at(g, i, j, k)] = (bw_real)(-3.0 * (i - 0.5) * H);
  for (int d = 0; d < 3; d++)
    memset(u[d], 0, g->size * sizeof *u[d]);
  bw_coupler_hold_solid(s.coupler, false);
  for (size_t i = 0; i < bw_solid_count(s.solid); i++)
    s.coupler->V_before[3 * i] = -3.0 * 0.25; /* the particles are at rest now */
  bw_check_ok(bw_coupler__probe_force(s.coupler, 0.25));
  bw_coupler__carry_force(s.coupler, false);
  bw_coupler__relax_load(s.coupler, 0.25, 0.5);
  double force[3];
  memcpy(force, s.coupler->force_probe, sizeof force);
  bw_comm_sum(bw_check_world(), 3, force);
  const double expected = RHO * 3.0 * pow(BLOCK * H, 3);
  ck_assert_double_gt(force[0], 0.85 * expected);
  ck_assert_double_lt(force[0], 1.15 * expected);
  ck_assert_double_lt(fabs(force[1]), ROUND_OFF * expected);
  ck_assert_double_lt(fabs(force[2]), ROUND_OFF * expected);
  double total = 0.0; /* the load on the particles is half of that force: the relaxation */
  for (size_t i = 0; i < bw_solid_count(s.solid); i++)
    total += s.coupler->F[3 * i] * bw_solid_volume(s.solid);
  bw_comm_sum(bw_check_world(), 1, &total);
  bw_check_near(total, 0.5 * force[0], ROUND_OFF);
  destroy(&s);
}
END_TEST

/* Force, moment and power of F at x, where the velocity is v. */
static void add_force(const double x[3], const double F[3], const double v[3], double sum[7])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    sum[d] += F[d];
    sum[3 + d] += x[e] * F[f] - x[f] * F[e];
    sum[6] += F[d] * v[d];
  }
}

/* Blocks of 2 x 2 particles share a marker: 4 x 4 on each of six faces (edges go with one of
 * theirs). Sums over markers equal sums over particles: area, its first moment, and of the reaction
 * the force, the torque about z and the power, with every particle moving at its own speed. */
START_TEST(blocks_share_a_marker_and_its_force)
{
  scene s = build_blocks(0.3, 1.0, 2.0);
  const bw_coupler *c = s.coupler;
  const bw_coupler__blocks *b = &c->blocks;
  const size_t n = bw_solid_count(s.solid);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_position(s.solid, X);
  for (size_t i = 0; i < n; i++) /* spinning about z, stretched along z */
    V[3 * i] = -X[3 * i + 1], V[3 * i + 1] = X[3 * i], V[3 * i + 2] = 0.3 * X[3 * i + 2];
  bw_solid_set_state(s.solid, X, V);
  bw_check_ok(bw_coupler__follow_surface(s.coupler));
  bw_check_ok(bw_coupler_step(s.coupler, 1.0e-3));
  bw_coupler__reaction_force(s.coupler);
  bw_coupler_report r;
  bw_check_ok(bw_coupler_measure(s.coupler, &r));
  ck_assert_int_eq(r.markers, 96);
  bw_coupler__reaction_force(s.coupler);
  double of_blocks[7] = {0}, of_particles[7] = {0};
  for (size_t m = 0; m < b->n; m++) {
    const double *x = b->X + 3 * m, *q = b->force + 3 * m, *v = b->V + 3 * m;
    of_blocks[0] += b->dV[m] / H;
    for (int d = 0; d < 3; d++)
      of_blocks[1 + d] += b->area[m] * x[d];
    of_blocks[4] -= RHO * q[0];
    of_blocks[5] -= RHO * (x[0] * q[1] - x[1] * q[0]);
    of_blocks[6] -= RHO * (q[0] * v[0] + q[1] * v[1] + q[2] * v[2]);
  }
  double largest = 0.0;
  for (size_t m = 0; m < c->n_surface; m++) {
    const double *x = c->marker_X + 3 * m, *F = c->force + 3 * m, *v = c->marker_V + 3 * m;
    of_particles[0] += c->area[m];
    for (int d = 0; d < 3; d++)
      of_particles[1 + d] += c->area[m] * x[d];
    of_particles[4] += F[0];
    of_particles[5] += x[0] * F[1] - x[1] * F[0];
    of_particles[6] += F[0] * v[0] + F[1] * v[1] + F[2] * v[2];
    largest = fmax(largest, fabs(F[0]));
  }
  bw_comm_sum(bw_check_world(), 7, of_blocks);
  bw_comm_sum(bw_check_world(), 7, of_particles);
  bw_comm_max(bw_check_world(), 1, &largest);
  ck_assert_double_gt(largest, 0.0);
  for (int q = 0; q < 7; q++)
    bw_check_near(of_particles[q], of_blocks[q], q < 4 ? 1e-12 : 1e3 * BW_REAL_EPSILON);
  bw_check_near(of_particles[4], r.force_reaction[0], 1e3 * BW_REAL_EPSILON);
  ck_assert_double_ne(of_particles[6], 0.0);
  bw_release(&X);
  bw_release(&V);
  destroy(&s);
}
END_TEST

/* The force at a marker is 0.2 h outside the particle; what the particles bear has its moment, and
 * its power for any velocities. */
START_TEST(the_load_has_the_markers_moment_and_power)
{
  scene s = build(0.3, 1.0);
  const bw_coupler *c = s.coupler;
  const size_t n = bw_solid_count(s.solid);
  double *X = NULL, *V = NULL, sum[2][7] = {{0.0}};
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_position(s.solid, X);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++)
      V[3 * i + d] = sin(40.0 * X[3 * i + (d + 1) % 3]) - X[3 * i + d];
  bw_solid_set_state(s.solid, X, V);
  bw_check_ok(bw_coupler__follow_surface(s.coupler));
  for (size_t q = 0; q < c->n_surface; q++)
    for (size_t d = 0; d < 3; d++)
      c->force[3 * q + d] = cos(30.0 * c->marker_X[3 * q + d]) + c->marker_X[3 * q + (d + 2) % 3];
  bw_coupler__carry_force(s.coupler, true);
  for (size_t q = 0; q < c->n_surface; q++)
    add_force(c->marker_X + 3 * q, c->force + 3 * q, c->marker_V + 3 * q, sum[0]);
  for (size_t i = 0; i < n; i++)
    add_force(X + 3 * i, c->load + 3 * i, V + 3 * i, sum[1]);
  bw_comm_sum(bw_check_world(), 14, sum[0]);
  for (int q = 0; q < 7; q++)
    bw_check_near(sum[1][q], sum[0][q], ROUND_OFF);
  bw_release(&X);
  bw_release(&V);
  destroy(&s);
}
END_TEST

/* The mean of the pressure is gathered in watched steps, wherever probes read it: not a number is
 * left from before, and none is claimed after a step that was not watched. */
START_TEST(probes_look_when_watched)
{
  scene s = build(0.5, 0.5);
  bw_coupler_report r;
  for (int watched = 0; watched <= 1; watched++) {
    for (size_t i = 0; i < bw_grid_look(s.grid)->size; i++)
      s.coupler->p_mean[i] = NAN;
    bw_coupler_watch(s.coupler, watched == 1);
    bw_check_ok(bw_coupler_step(s.coupler, 1.0e-3));
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    for (int d = 0; d < 3; d++)
      ck_assert_int_eq(isfinite(r.force_probe[d]), watched);
  }
  destroy(&s);
}
END_TEST

/* Cells that hold the body are found anew as soon as it has moved by a tenth of a cell. */
START_TEST(cells_of_the_body_move_with_it)
{
  scene s = build(0.5, 0.5);
  const size_t n = bw_solid_count(s.solid);
  double *X = NULL, *V = NULL;
  bw_coupler_report r;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_coupler_hold_solid(s.coupler, true);
  for (int moved = 0; moved <= 1; moved++) {
    const bw_grid_view *g = bw_grid_look(s.grid);
    bw_solid_get_reference(s.solid, X);
    for (size_t i = 0; i < n; i++)
      X[3 * i] += 0.7 * H * moved;
    bw_solid_set_state(s.solid, X, V);
    bw_check_ok(bw_coupler__follow_surface(s.coupler));
    bw_coupler_watch(s.coupler, true);
    bw_check_ok(bw_coupler_step(s.coupler, 1.0e-3));
    bw_check_ok(bw_coupler_measure(s.coupler, &r)); /* probes look where the body is */
    /* x is not divided: the row through the middle, where this rank has it. */
    const int middle = FIRST + BLOCK / 2, j = middle + 1 - g->lo[1], k = middle + 1 - g->lo[2];
    for (int q = 0; q < N && j >= 1 && j <= g->m[1] && k >= 1 && k <= g->m[2]; q++) {
      const bool body = q >= FIRST + moved && q < FIRST + BLOCK + moved;
      ck_assert_int_eq((int)s.coupler->inside[bw_at(g, q + 1, j, k)], body);
    }
  }
  bw_release(&X);
  bw_release(&V);
  destroy(&s);
}
END_TEST

START_TEST(substeps_keep_the_solid_within_its_limit)
{
  scene s = build(0.5, 0.5);
  const double limit = 0.8 * bw_solid_dt_max(s.solid);
  ck_assert_int_eq(bw_coupler_substeps(s.coupler, 0.5 * limit), 1);
  ck_assert_int_eq(bw_coupler_substeps(s.coupler, 3.5 * limit), 4);
  destroy(&s);
}
END_TEST

static double max_difference(const double a[], const double b[], size_t n)
{
  double most = 0.0;
  for (size_t i = 0; i < n; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  bw_comm_max(bw_check_world(), 1, &most);
  return most;
}

/* A held solid stays; a free one is moved by the stream, and not against it. */
START_TEST(held_solid_stays_free_one_is_carried)
{
  scene s = build(0.5, 0.5);
  const size_t n = 3 * bw_solid_count(s.solid);
  double *before = NULL, *after = NULL;
  bw_check_ok(BW_ALLOCATE(&before, n));
  bw_check_ok(BW_ALLOCATE(&after, n));
  bw_solid_get_position(s.solid, before);
  for (int q = 0; q < 2; q++)
    bw_check_ok(bw_coupler_step(s.coupler, 2.0e-3));
  bw_solid_get_position(s.solid, after);
  ck_assert_double_eq(max_difference(before, after, n), 0.0);
  bw_coupler_hold_solid(s.coupler, false);
  for (int q = 0; q < 3; q++)
    bw_check_ok(bw_coupler_step(s.coupler, 2.0e-3));
  const bw_solid_ledger e = ledger_of(s.solid);
  ck_assert_double_gt(e.momentum[0], 0.0);
  bw_release(&before);
  bw_release(&after);
  destroy(&s);
}
END_TEST

/* Saved, gone on, loaded, gone on again: the same state. */
START_TEST(loaded_state_goes_on_as_the_saved_one)
{
  scene s = build(0.5, 0.5);
  const size_t n = 3 * bw_solid_count(s.solid);
  double *first = NULL, *second = NULL;
  bw_checkpoint *ck = NULL;
  char path[32]; /* of this number of ranks: tests run side by side */
  snprintf(path, sizeof path, "test_coupler_np%d.h5", bw_comm_size(bw_check_world()));
  bw_check_ok(BW_ALLOCATE(&first, n));
  bw_check_ok(BW_ALLOCATE(&second, n));
  bw_coupler_hold_solid(s.coupler, false);
  for (int q = 0; q < 2; q++)
    bw_check_ok(bw_coupler_step(s.coupler, 2.0e-3));
  bw_check_ok(bw_checkpoint_create(bw_check_world(), path, &ck));
  bw_check_ok(bw_coupler_save(s.coupler, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  for (int round = 0; round < 2; round++) {
    for (int q = 0; q < 3; q++)
      bw_check_ok(bw_coupler_step(s.coupler, 2.0e-3));
    bw_solid_get_velocity(s.solid, round == 0 ? first : second);
    if (round > 0) break;
    bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
    bw_check_ok(bw_coupler_load(s.coupler, ck));
    bw_check_ok(bw_checkpoint_close(&ck));
  }
  double scale = max_difference(first, (double *)memset(s.coupler->X, 0, n * sizeof(double)), n);
  ck_assert_double_gt(scale, 0.0);
  ck_assert_double_lt(max_difference(first, second, n), ROUND_OFF * scale);
  bw_release(&first);
  bw_release(&second);
  destroy(&s);
  if (bw_comm_rank(bw_check_world()) == 0) remove(path);
}
END_TEST

START_TEST(bad_configurations_are_refused_by_name)
{
  scene s = build(0.5, 0.5);
  bw_coupler *c = NULL;
  bw_coupler_config config = bw_coupler_config_default();
  bw_check_status(bw_coupler_create(&config, s.fluid, s.solid, &c), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "rho"));
  config.rho = 1.0;
  bw_check_status(bw_coupler_create(&config, s.fluid, s.solid, &c), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "nu"));
  config.nu = 1.0;
  config.solid_safety = 1.5;
  bw_check_status(bw_coupler_create(&config, s.fluid, s.solid, &c), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "solid_safety"));
  ck_assert_ptr_null(c);
  bw_checkpoint *ck = NULL;
  char none[40];
  snprintf(none, sizeof none, "test_coupler_none_np%d.h5", bw_comm_size(bw_check_world()));
  bw_check_ok(bw_checkpoint_create(bw_check_world(), none, &ck));
  bw_check_status(bw_coupler_save_kept(s.coupler, ck), BW_EINPUT);
  bw_checkpoint_abandon(&ck);
  destroy(&s);
}
END_TEST

/* Who keeps lists of particles makes them anew when the solid says that its particles have changed:
 * where they have not, nothing differs. The twin's solid says so after the second of four steps. */
START_TEST(another_set_of_particles_is_followed)
{
  double force[2][3];
  size_t n_surface[2];
  for (int twin = 0; twin < 2; twin++) {
    scene s = build(0.5, 1.0);
    bw_coupler_hold_solid(s.coupler, false);
    for (int q = 0; q < 4; q++) {
      if (twin == 1 && q == 2) bw_pd_body_touch(bw_solid_body(s.solid));
      bw_check_ok(bw_coupler_step(s.coupler, 1e-3));
    }
    ck_assert_int_eq(s.coupler->revision, twin);
    bw_coupler_report r;
    bw_check_ok(bw_coupler_measure(s.coupler, &r));
    memcpy(force[twin], r.force_reaction, sizeof r.force_reaction);
    n_surface[twin] = s.coupler->n_surface;
    destroy(&s);
  }
  ck_assert_uint_eq(n_surface[0], n_surface[1]);
  for (int d = 0; d < 3; d++)
    bw_check_near(force[1][d], force[0][d], ROUND_OFF * (1 + fabs(force[0][0])));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(another_set_of_particles_is_followed),
                                      BW_TEST(markers_sit_where_the_retraction_says),
                                      BW_TEST(linear_pressure_lifts_the_body),
                                      BW_TEST(blocks_share_a_marker_and_its_force),
                                      BW_TEST(the_load_has_the_markers_moment_and_power),
                                      BW_TEST(probes_look_when_watched),
                                      BW_TEST(cells_of_the_body_move_with_it),
                                      BW_TEST(substeps_keep_the_solid_within_its_limit),
                                      BW_TEST(held_solid_stays_free_one_is_carried),
                                      BW_TEST(loaded_state_goes_on_as_the_saved_one),
                                      BW_TEST(bad_configurations_are_refused_by_name)};
BW_CHECK_MAIN("coupler", tests)
