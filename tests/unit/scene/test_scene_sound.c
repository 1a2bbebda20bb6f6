/* Twelve kinds of going wrong, planted into runs that are right: each is noticed within a bounded
 * number of steps, by an end with a message or a warning; the runs as they are raise no doubt.
 * TEST ranks=1,2 */
#include "coupler_internal.h"
#include "scene_text.h"

#define FLOW                                                                                       \
  "domain: {length: [1, 1, 0.0625], cells: [16, 16, 1]}\nfluid:\n  density: 1\n"                   \
  "  viscosity: 1.0e-3\n  sides:\n    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"     \
  "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n"                                    \
  "  start: {velocity: [1, 0, 0], vortices: [{centre: [0.5, 0.5], radius: 0.15, swirl: 0.5}]}\n"   \
  "phases: {until: {steps: 1000}}\nnumerics: {step: 1.0e-3}\n"
#define SOLID                                                                                      \
  "plane: strain\nthickness: 1\nmaterials: {m: {density: 1, young_modulus: 1}}\n"                  \
  "phases: {until: {steps: 1000}}\nbodies:\n"                                                      \
  "  a: {shape: {box: {from: [0, 0], to: [0.8, 0.8]}}, material: m, motion: elastic, spacing: "    \
  "0.1, rotation: {rate: 0.05, centre: [0.4, 0.4]}}\n"
#define TWO                                                                                        \
  SOLID                                                                                            \
  "  b: {shape: {box: {from: [0.8, 0], to: [1.6, 0.8]}}, material: m, motion: elastic, spacing: "  \
  "0.1, velocity: [-0.05, 0]}\n"
#define COUPLED                                                                                    \
  "domain: {length: [1, 1, 0.0625], cells: [16, 16, 1]}\nfluid:\n  density: 1\n"                   \
  "  viscosity: 0.02\n  sides:\n    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"       \
  "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n  start: {velocity: [1, 0, 0]}\n"    \
  "materials: {m: {density: 0.1, young_modulus: 100}}\nphases: {until: {steps: 2000}}\nbodies:\n"  \
  "  a: {shape: {box: {from: [0.25, 0.25], to: [0.75, 0.75]}}, material: m, motion: elastic}\n"
#define WATER                                                                                      \
  "domain: {length: [1, 1, 1], cells: [10, 10, 1]}\ngravity: [0, -1]\nfluid:\n"                    \
  "  model: particles\n  density: 1\n  viscosity: 1.0e-3\n"                                        \
  "  shape: {box: {from: [0, 0], to: [1, 0.5]}}\nphases: {until: {steps: 1000}}\n"
#define RIGID                                                                                      \
  "domain: {length: [1, 1, 0.0625], cells: [16, 16, 1]}\nfluid:\n  density: 1\n"                   \
  "  viscosity: 0.02\n  sides:\n    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"       \
  "    y: {lower: {kind: wall}, upper: {kind: wall}}\n"                                            \
  "materials: {m: {density: 2, young_modulus: 100}}\nphases: {until: {steps: 1000}}\nbodies:\n"    \
  "  a: {shape: {sphere: {centre: [0.5, 0.5], radius: 0.25}}, material: m, motion: rigid}\n"

/* ---- what goes wrong: after step q ---- */

static bw_real *inside(bw_scene *s)
{
  return bw_ns_channel_velocity(s->fluid)[0] + bw_at(bw_grid_look(s->grid), 3, 3, 1);
}

static void not_a_number(bw_scene *s, int q)
{
  if (q == 0) *inside(s) = (bw_real)NAN;
  bw_ns_channel_refresh(s->fluid);
}

static void a_gust(bw_scene *s, int q)
{
  if (q == 0) *inside(s) = 1000;
  bw_ns_channel_refresh(s->fluid);
}

static void a_step_too_long(bw_scene *s, int q)
{
  if (q == 0) s->config.numerics.step = 0.5;
}

/* A wave from row to row, which is free of divergence and grows by 2 % in each step. */
static void ripples(bw_scene *s, int q)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  bw_real *u = bw_ns_channel_velocity(s->fluid)[0];
  const double more = 0.02 * pow(1.02, q);
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++)
      u[bw_at(g, i, j, 1)] += (bw_real)((j + g->lo[1]) % 2 == 0 ? more : -more);
  bw_ns_channel_refresh(s->fluid);
}

/* A solid moved along x by `way`, velocities times a factor, and one of them as given. */
static void change(bw_scene *s, double way, double factor, double one)
{
  bw_solid *solid = s->solid[0].solid;
  const size_t n = s->solid[0].n;
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n + 3));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n + 3));
  bw_solid_get_position(solid, X);
  bw_solid_get_velocity(solid, V);
  for (size_t i = 0; i < 3 * n; i++) {
    X[i] += i % 3 == 0 ? way : 0.0;
    V[i] *= factor;
  }
  if (one != 0.0 && n > 0) V[0] = one;
  bw_solid_set_state(solid, X, V);
  bw_release(&X);
  bw_release(&V);
}

static void a_particle_is_lost(bw_scene *s, int q)
{
  change(s, 0.0, 1.0, q == 0 ? NAN : 0.0);
}

static void a_particle_is_shot(bw_scene *s, int q)
{
  change(s, 0.0, 1.0, q == 0 ? 1e4 : 0.0);
}

static void energy_from_nowhere(bw_scene *s, int q)
{
  (void)q;
  change(s, 0.0, 1.005, 0.0);
}

static void energy_is_gone(bw_scene *s, int q)
{
  (void)q;
  change(s, 0.0, 0.99, 0.0);
}

/* One block is put half a spacing into the other. */
static void passed_through(bw_scene *s, int q)
{
  change(s, q == 0 ? 0.05 : 0.0, 1.0, 0.0);
}

/* All of the load at once on a body lighter than the fluid that it carries along. */
static void load_too_late(bw_scene *s, int q)
{
  if (q == 0) s->coupler->config.load_relaxation = 1.0, s->coupler->config.virtual_mass = 0.0;
}

/* Of the particle fluid: the number at a place of the row of the first particle, times a factor. */
static void change_water(bw_scene *s, double factor)
{
  bw_ulph *u = s->water->fluid;
  const size_t n = bw_ulph_count(u);
  double *rows = NULL, numbers[BW_ULPH_NUMBERS];
  int64_t *id = NULL;
  bw_check_ok(BW_ALLOCATE(&rows, n * BW_ULPH_ROW + 1));
  bw_check_ok(BW_ALLOCATE(&id, n + 1));
  bw_ulph_state_get(u, rows, numbers);
  bw_ulph_ids(u, id);
  for (size_t i = 0; i < n; i++)
    for (int d = 3; d < 6; d++)
      rows[i * BW_ULPH_ROW + (size_t)d] = factor * (1.0 + rows[i * BW_ULPH_ROW + (size_t)d]);
  bw_check_ok(bw_ulph_state_set(u, n, id, rows, numbers));
  bw_release(&rows);
  bw_release(&id);
}

static void water_too_fast(bw_scene *s, int q)
{
  if (q == 0) change_water(s, 1e3);
}

static void a_rigid_body_is_lost(bw_scene *s, int q)
{
  const double v[3] = {NAN, 0.0, 0.0}, spin[3] = {0.0, 0.0, 0.0};
  if (q == 0) bw_rigid_set_motion(s->rigid, 0, v, spin);
}

typedef struct {
  const char *name, *text;
  void (*plant)(bw_scene *s, int q);
  int bound; /* steps until it is noticed */
} wrong;

static const wrong kinds[] = {{"not a number in a velocity", FLOW, not_a_number, 1},
                              {"a velocity beyond its step", FLOW, a_gust, 1},
                              {"a step beyond the limit", FLOW, a_step_too_long, 1},
                              {"waves of two cells", FLOW, ripples, 300},
                              {"not a number in a solid", SOLID, a_particle_is_lost, 1},
                              {"a particle that is shot off", SOLID, a_particle_is_shot, 1},
                              {"energy from nowhere", SOLID, energy_from_nowhere, 200},
                              {"energy that is gone", SOLID, energy_is_gone, 200},
                              {"bodies in each other", TWO, passed_through, 101},
                              {"a load too late for a light body", COUPLED, load_too_late, 200},
                              {"water faster than sound", WATER, water_too_fast, 2},
                              {"a rigid body that is lost", RIGID, a_rigid_body_is_lost, 2}};

/* Steps until it is noticed; plant NULL: none is planted. */
static int steps_until(const wrong *k, bool planted, int most)
{
  bw_scene *s = made(k->text);
  int q = 0;
  bool noticed = false;
  for (q = 0; q < most && !noticed; q++) {
    noticed = bw_scene_step(s, INFINITY) != BW_OK || s->sound.doubts > 0;
    if (planted && !noticed) k->plant(s, q);
  }
  bw_scene_destroy(&s);
  return noticed ? q - 1 : most;
}

START_TEST(each_is_noticed)
{
  const int n = (int)(sizeof kinds / sizeof kinds[0]);
  ck_assert_int_ge(n, 12);
  for (int k = 0; k < n; k++) {
    const int most = kinds[k].bound + 2;
    const int steps = steps_until(&kinds[k], true, most);
    ck_assert_msg(steps <= kinds[k].bound, "%s: not noticed in %d steps", kinds[k].name, steps);
    ck_assert_msg(steps_until(&kinds[k], false, most) == most, "%s: doubted without it",
                  kinds[k].name);
  }
}
END_TEST

/* The projection of the next step would mend it: what it leaves is looked at. */
START_TEST(a_source_of_fluid_is_seen)
{
  bw_scene *s = made(FLOW);
  bw_check_ok(bw_scene_step(s, INFINITY));
  bw_check_ok(bw_scene__look(s));
  *inside(s) += (bw_real)0.1;
  bw_ns_channel_refresh(s->fluid);
  bw_check_status(bw_scene__look(s), BW_EDIVERGED);
  bw_scene_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(each_is_noticed), BW_TEST(a_source_of_fluid_is_seen)};
BW_CHECK_MAIN("scene.sound", tests)
