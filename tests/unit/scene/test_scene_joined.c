/* Rigid bodies beside bodies of particles in one flow: what they do to each other keeps momentum,
 * angular momentum and energy, what the fluid does to both passes its momentum on; a bed bears a
 * rigid weight; a body that is held for a phase is pushed against; restarts go on to the last bit.
 * TEST ranks=1,2,3 */
#include "scene_text.h"

/* A periodic box, a block of particles, a ball of ten times its density beside its line; %s: the
 * fluid's density, what the rigid body and the numerics have beside that. */
#define PAIR                                                                                       \
  "domain: {length: [1.6, 1.6, 0.05], cells: [32, 32, 1]}\n"                                       \
  "fluid:\n  density: %s\n  viscosity: 0.01\n  sides:\n"                                           \
  "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"                                    \
  "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n"                                    \
  "materials: {m: {density: 3, young_modulus: 100}, heavy: {density: 30, young_modulus: 100}}\n"   \
  "bodies:\n"                                                                                      \
  "  a: {shape: {box: {from: [0.3, 0.6], to: [0.7, 1.0]}}, material: m, motion: elastic, "         \
  "velocity: [1, 0]}\n"                                                                            \
  "  b: {shape: {sphere: {centre: [1.0, 0.9], radius: 0.2}}, material: heavy, motion: rigid%s}\n"  \
  "phases: {until: %s}\nnumerics: {load: reaction, step: 0.01, solid_share: 0.1%s}\n"              \
  "gauges: {a: {body: a, of: [position, velocity]}, b: {body: b, of: [position, velocity, "        \
  "spin]}, e: {of: energy}}\n"

/* In a gas a millionth as dense as the block: what the fluid takes is less than 1e-5. */
START_TEST(they_collide)
{
  char text[2048];
  snprintf(text, sizeof text, PAIR, "3e-6", "", "0.6", "");
  bw_scene *s = made(text);
  const double ma = 3 * 0.16 * 0.05, mb = bw_rigid_state_of(s->rigid, 0).mass;
  const double thin = 1e-5 * ma;
  ck_assert_int_eq(s->n_solids, 1);
  ck_assert_int_eq(s->solid_of[1], -1);
  run(s);
  ck_assert_double_gt(gauge(s, "b.velocity.x"), 0.05);
  ck_assert_double_lt(gauge(s, "a.velocity.x"), 0.5);
  for (int d = 0; d < 2; d++) {
    const char *const a[] = {"a.velocity.x", "a.velocity.y"};
    const char *const b[] = {"b.velocity.x", "b.velocity.y"};
    bw_check_near(ma * gauge(s, a[d]) + mb * gauge(s, b[d]), d == 0 ? ma : 0.0, thin);
  }
  bw_check_near(angular_momentum(s, 0, 0), -0.8 * ma, 2.0 * thin);
  /* Nothing rubs: a smooth ball is not turned. */
  ck_assert_double_lt(fabs(gauge(s, "b.spin.z")) * 0.2, 1e-5 * gauge(s, "b.velocity.x"));
  /* Verlet's energy, with a tenth of the stable step (modules/pd_contact: 0.5 %). */
  const double all = gauge(s, "e.kinetic") + gauge(s, "e.elastic") + gauge(s, "e.contact") -
                     gauge(s, "e.external");
  bw_check_near(all, 0.5 * ma, 5e-3 * ma);
  bw_scene_destroy(&s);
}
END_TEST

/* The periodic seam: the same collision across it. */
START_TEST(across_the_seam)
{
  char text[2048];
  snprintf(text, sizeof text, PAIR, "3e-6", "", "0.6", "");
  bw_scene *s = made(text);
  run(s);
  const double v = gauge(s, "b.velocity.x"), w = gauge(s, "b.velocity.y");
  bw_scene_destroy(&s);
  /* Both 1.0 to the right, the ball an image to the left. */
  char *at = strstr(text, "from: [0.3"), *ball = strstr(text, "centre: [1.0");
  memcpy(at, "from: [1.1", 10);
  memcpy(strstr(at, "to: [0.7"), "to: [1.5", 8);
  memcpy(ball, "centre: [0.2", 12);
  s = made(text);
  run(s);
  bw_check_near(gauge(s, "b.velocity.x"), v, 1e-4 * v);
  bw_check_near(gauge(s, "b.velocity.y"), w, 1e-4 * v);
  bw_scene_destroy(&s);
}
END_TEST

/* A fluid a third as dense as the block, all at rest at first but the block: the momentum of all
 * three stays. Of the fluid inside the ball, which moves with it, the load knows
 * (bw_coupler_rigid.h): its share counts once. Loads are not relaxed, so that none is late; what
 * the fluid inside lags behind is 1 % of what was passed on. */
START_TEST(momentum_is_passed_on)
{
  static const char *const words[] = {", load_relaxation: 1, virtual_mass: 0",
                                      ", load_relaxation: 0.3, virtual_mass: 0, predictor: true"};
  for (int q = 0; q < 2; q++) {
    char text[2048];
    snprintf(text, sizeof text, PAIR, "1", "", "0.5", words[q]);
    bw_scene *s = made(text);
    const double ma = 3 * 0.16 * 0.05;
    const bw_rigid_state b = bw_rigid_state_of(s->rigid, 0);
    run(s);
    const double fluid = 1.0 * 1.6 * 1.6 * 0.05 * bw_ns_channel_summary(s->fluid).bulk_velocity;
    const double left = ma * gauge(s, "a.velocity.x");
    const double ball = (b.mass - 1.0 * b.volume) * gauge(s, "b.velocity.x");
    ck_assert_double_lt(left, 0.5 * ma);
    ck_assert_double_gt(ball, 0.1 * ma);
    ck_assert_double_gt(fluid, 0.05 * ma);
    bw_check_near(left + ball + fluid, ma, 0.01 * ma);
    bw_scene_destroy(&s);
  }
}
END_TEST

/* %s: what stands on the bed of particles, the phases. */
#define BED                                                                                        \
  "domain: {length: [0.8, 1.2, 0.05], cells: [16, 24, 1]}\n"                                       \
  "fluid:\n  density: 1\n  viscosity: 0.05\n  sides:\n"                                            \
  "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"                                    \
  "    y: {lower: {kind: wall}, upper: {kind: wall}}\n"                                            \
  "materials: {m: {density: 3, young_modulus: 2000}, heavy: {density: 9, young_modulus: 100}}\n"   \
  "bodies:\n"                                                                                      \
  "  bed: {shape: {box: {from: [0.1, 0], to: [0.7, 0.2]}}, material: m, motion: elastic, held: "   \
  "{side: y_lower, layers: 2}}\n"                                                                  \
  "  load: {shape: {box: {from: [0.25, 0.2], to: [0.55, 0.5]}}, material: heavy, motion: rigid%s}" \
  "\n"                                                                                             \
  "gravity: [0, -1]\nphases: %s\nnumerics: {load: reaction}\n"                                     \
  "gauges: {load: {body: load, of: [displacement, velocity, force]}, bed: {body: bed, of: "        \
  "[force, force_on_support]}}\n"

/* At rest the support of the bed bears the weight of both, less their buoyancy, and less what the
 * fluid still bears: markers that share cells forget slowly what they did to each other. */
START_TEST(a_bed_bears_a_weight)
{
  char text[2048];
  snprintf(text, sizeof text, BED, "", "{until: 2, damp: 60}");
  bw_scene *s = made(text);
  run(s);
  const bw_rigid_state b = bw_rigid_state_of(s->rigid, 0);
  /* Two of four layers are held, and not borne. */
  const double weight = (9.0 - 1.0) * b.volume + (3.0 - 1.0) * 0.6 * 0.1 * 0.05;
  const double fluid = gauge(s, "bed.force.reaction.y") + gauge(s, "load.force.reaction.y");
  bw_check_near(b.volume, 0.09 * 0.05, 1e-3 * b.volume);
  ck_assert_double_lt(fabs(fluid), 0.03 * weight);
  bw_check_near(gauge(s, "bed.force_on_support.y"), fluid - weight, 1e-4 * weight);
  bw_check_near(gauge(s, "load.velocity.y"), 0.0, 1e-6);
  ck_assert_double_lt(gauge(s, "load.displacement.y"), 0.0);
  bw_scene_destroy(&s);
}
END_TEST

/* A bed that is held for a phase stays as it is, and turns a ball back. */
START_TEST(what_is_held_is_pushed_against)
{
  char text[2048];
  snprintf(text, sizeof text, BED, ", velocity: [0, 0]", "{until: 0.3, hold: [bed]}");
  bw_scene *s = made(text);
  run(s);
  /* Without contact it would have sunk by (1 - 1/9)/2 0.3^2 in vacuum, and some of that here. */
  ck_assert_double_gt(gauge(s, "load.displacement.y"), -1e-3);
  double X[3 * 1024];
  ck_assert_uint_le(s->solid[0].n, 1024);
  bw_solid_get_position(s->solid[0].solid, X);
  for (size_t i = 0; i < 3 * s->solid[0].n; i++)
    bw_check_near(X[i], s->solid[0].X0[i], 0.0);
  bw_scene_destroy(&s);
}
END_TEST

/* Explicit and iterated steps. */
START_TEST(restart)
{
  static const char *const names[] = {"a.position.x", "a.velocity.y", "b.velocity.x",
                                      "b.position.y", "b.spin.z",     NULL};
  static const char *const more[] = {"", ", coupling_iterations: 5, coupling_residual: 1e-3"};
  char text[2048];
  for (int q = 0; q < 2; q++) {
    snprintf(text, sizeof text, PAIR, "1", ", rigid: {stiffness: [20, 0]}",
             q == 0 ? "0.36" : "0.24", more[q]);
    /* In the middle of the contact, and before. */
    check_restart(text, q == 0 ? 0.3 : 0.12, names);
  }
}
END_TEST

/* A body that stands in another one is refused, by the file's names where shapes tell. */
START_TEST(refused)
{
  char text[2048];
  snprintf(text, sizeof text, PAIR, "1", "", "0.6", "");
  memcpy(strstr(text, "centre: [1.0"), "centre: [0.8", 12);
  ck_assert_ptr_null(scene_of(text));
  ck_assert_msg(strstr(bw_last_message(), "overlap") != NULL, "%s", bw_last_message());
  /* By less than half a particle: true surfaces are not rounded. */
  snprintf(text, sizeof text, PAIR, "1", "", "0.6", "");
  memcpy(strstr(text, "centre: [1.0"), "centre: [.88", 12);
  ck_assert_ptr_null(scene_of(text));
  ck_assert_msg(strstr(bw_last_message(), "overlap") != NULL, "%s", bw_last_message());
  snprintf(text, sizeof text, PAIR, "1", "", "0.6", ", memory: 0");
  ck_assert_ptr_null(scene_of(text));
  ck_assert_msg(strstr(bw_last_message(), "numerics.memory = 0") != NULL, "%s", bw_last_message());
  snprintf(text, sizeof text, PAIR, "1", "", "0.6", ", integrator: rk3");
  ck_assert_ptr_null(scene_of(text));
  ck_assert_msg(strstr(bw_last_message(), "integrator = rk3") != NULL, "%s", bw_last_message());
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(they_collide),
                                      BW_TEST(across_the_seam),
                                      BW_TEST(momentum_is_passed_on),
                                      BW_TEST(a_bed_bears_a_weight),
                                      BW_TEST(what_is_held_is_pushed_against),
                                      BW_TEST(restart),
                                      BW_TEST(refused)};
BW_CHECK_MAIN("scene.joined", tests)
