/* Solids of a scene against mechanics that needs no computer: loads, weight, prescribed motion,
 * collisions, materials.
 * TEST ranks=1,2 */
#include "scene_text.h"

/* Round-off of a step, times the steps. */
static const double TINY = 2e3 * BW_REAL_EPSILON;

#define BLOCK                                                                                      \
  "plane: strain\nthickness: 2\nmaterials: {m: {density: 3, young_modulus: 100}, heavy: "          \
  "{density: 30, young_modulus: 100}}\n"

/* Free fall: Verlet is exact for a constant force. */
START_TEST(weight)
{
  bw_scene *s =
      made(BLOCK "gravity: [1, -2]\n"
                 "bodies: {a: {shape: {box: {from: [0, 0], to: [0.4, 0.3]}}, material: m,"
                 " motion: elastic, spacing: 0.1, velocity: [0, 5]}}\n"
                 "phases: {until: 0.5}\n"
                 "gauges: {x: {body: a, of: [displacement, velocity]}, e: {of: energy}}\n");
  run(s);
  bw_check_near(gauge(s, "x.displacement.x"), 0.5 * 0.25, TINY);
  bw_check_near(gauge(s, "x.displacement.y"), 5 * 0.5 - 0.25, 3 * TINY);
  bw_check_near(gauge(s, "x.velocity.y"), 5 - 2 * 0.5, 6 * TINY);
  /* Work of the weight is the gain of kinetic energy: m/2 (v^2 - v0^2), m = 3 * 0.12 * 2. */
  bw_check_near(gauge(s, "e.external"), 0.36 * (0.25 + 16 - 25), 20 * TINY);
  bw_scene_destroy(&s);
}
END_TEST

/* Newton: a traction, a force and a pressure give the momentum that they say, by their ramps. */
START_TEST(loads)
{
  static const struct {
    const char *load;
    double force[2]; /* of all of it: the sides are 0.3 and 0.4 long and 2 deep */
  } cases[] = {{"{on: a, kind: traction, where: x_upper, value: [10, 4], ramp: 0.2}", {6.0, 2.4}},
               {"{on: a, kind: pressure, where: y_upper, value: 10, ramp: 0.2}", {0.0, -8.0}},
               {"{on: a, kind: pressure, where: {side: x_lower, layers: 2}, value: 10, ramp: 0.2}",
                {6.0, 0.0}},
               {"{on: a, kind: force, value: [1, 2], ramp: 0.2}", {1.0, 2.0}},
               {"{on: a, kind: force, where: {box: {from: [0, 0], to: [0.2, 0.1]}}, value: [1, 2], "
                "ramp: 0.2}",
                {1.0, 2.0}},
               {"{on: a, kind: gravity, value: [1, -1], ramp: 0.2}", {0.72, -0.72}}};
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    char text[1024];
    snprintf(text, sizeof text,
             BLOCK "bodies: {a: {shape: {box: {from: [0, 0], to: [0.4, 0.3]}}, material: m,"
                   " motion: elastic, spacing: 0.1}}\nloads: %s\n"
                   "phases: {until: 0.4}\ngauges: {v: {body: a, of: velocity}}\n",
             cases[q].load);
    bw_scene *s = made(text);
    run(s);
    /* Half of the ramp and all of the rest: 0.1 + 0.2 of the force; a step's corner is missed. */
    const double mass = 3 * 0.12 * 2, corner = bw_scene_last_step(s);
    bw_check_near(gauge(s, "v.x"), cases[q].force[0] * 0.3 / mass,
                  fabs(cases[q].force[0]) / mass * corner * corner / 0.2 + TINY);
    bw_check_near(gauge(s, "v.y"), cases[q].force[1] * 0.3 / mass,
                  fabs(cases[q].force[1]) / mass * corner * corner / 0.2 + TINY);
    bw_scene_destroy(&s);
  }
}
END_TEST

/* A body that turns and swings stands where it is told to, whatever the steps are. */
START_TEST(prescribed)
{
  bw_scene *s =
      made(BLOCK
           "bodies:\n"
           "  a: {shape: {box: {from: [0, 0], to: [0.4, 0.3]}}, motion: prescribed, spacing: 0.1,\n"
           "      velocity: [0.5, 0], rotation: {rate: 1.5707963267948966, centre: [0, 0]},\n"
           "      swing: {amplitude: [0, 0.2], frequency: 0.25}}\n"
           "  b: {shape: {box: {from: [9, 9], to: [9.4, 9.3]}}, material: m, motion: elastic, "
           "spacing: 0.1}\n"
           "phases: {until: 1}\n"
           "gauges: {p: {body: a, nearest: [0.35, 0.05], of: position}}\n");
  run(s);
  /* A quarter of a turn brings (0.35, 0.05) to (-0.05, 0.35); then velocity and swing. */
  bw_check_near(gauge(s, "p.x"), -0.05 + 0.5, TINY);
  bw_check_near(gauge(s, "p.y"), 0.35 + 0.2, TINY);
  bw_scene_destroy(&s);
}
END_TEST

/* Two equal blocks meet: momentum stays, they part, the book closes. */
START_TEST(collision)
{
  bw_scene *s = made(
      BLOCK "bodies:\n"
            "  a: {shape: {box: {from: [0, 0], to: [0.4, 0.4]}}, material: m, motion: elastic, "
            "spacing: 0.1, velocity: [1, 0]}\n"
            "  b: {shape: {box: {from: [0.5, 0], to: [0.9, 0.4]}}, material: m, motion: elastic, "
            "spacing: 0.1}\n"
            "phases: {until: 1}\nnumerics: {step_share: 0.1}\n"
            "gauges: {a: {body: a, of: velocity}, b: {body: b, of: velocity}, e: {of: energy}}\n");
  run(s);
  bw_check_near(gauge(s, "a.x") + gauge(s, "b.x"), 1.0, TINY);
  ck_assert_double_gt(gauge(s, "b.x"), 0.7);
  ck_assert_double_lt(gauge(s, "a.x"), 0.3);
  /* Verlet keeps energy to the square of the step, a hundredth of a percent here. */
  const double all = gauge(s, "e.kinetic") + gauge(s, "e.elastic") + gauge(s, "e.contact");
  bw_check_near(all, 0.5 * 3 * 0.16 * 2, 2e-3 * all);
  bw_scene_destroy(&s);
}
END_TEST

/* Parts of their own material; a hole by minus and by remove. */
START_TEST(materials_and_holes)
{
  bw_scene *s = made(
      BLOCK "bodies:\n"
            "  a:\n    shape: [{box: {from: [0, 0], to: [0.4, 0.4]}}, {box: {from: [0.2, 0], to: "
            "[0.4, 0.4]}, material: heavy},\n"
            "            {minus: hole}, {box: {from: [0, 0], to: [0.1, 0.1]}, remove: true}]\n"
            "    material: m\n    motion: elastic\n    spacing: 0.1\n    velocity: [2, 0]\n"
            "  hole: {shape: {box: {from: [0.3, 0.3], to: [0.4, 0.4]}}, motion: fixed, spacing: "
            "0.1}\n"
            "contact: {between: none}\n"
            "phases: {until: {steps: 1}}\ngauges: {e: {of: energy}}\n");
  /* 7 light, 7 heavy particles of 0.02: m/2 v^2. */
  bw_check_near(gauge(s, "e.kinetic"), 2 * (7 * 3 + 7 * 30) * 0.02, 1e2 * TINY);
  bw_scene_destroy(&s);
}
END_TEST

/* A name is one word: the columns of a history are made of it. The first body's, too. */
START_TEST(names_are_words)
{
  for (int q = 0; q < 2; q++) {
    char text[512];
    snprintf(text, sizeof text,
             BLOCK "bodies:\n"
                   "  %s: {shape: {box: {from: [0, 0], to: [0.4, 0.3]}}, material: m,"
                   " motion: elastic, spacing: 0.1}\n"
                   "  %s: {shape: {box: {from: [2, 0], to: [2.4, 0.3]}}, material: m,"
                   " motion: elastic, spacing: 0.1}\nphases: {until: 0.1}\n",
             q == 0 ? "'a b'" : "a", q == 1 ? "'b c'" : "c");
    ck_assert_ptr_null(scene_of(text));
    ck_assert_ptr_nonnull(strstr(bw_last_message(), "a name is one word"));
  }
}
END_TEST

/* Phases end by time and by steps, and damping belongs to them. */
START_TEST(phases)
{
  bw_scene *s =
      made(BLOCK "bodies: {a: {shape: {box: {from: [0, 0], to: [0.4, 0.3]}}, material: m, motion: "
                 "elastic, spacing: 0.1, velocity: [1, 0]}}\n"
                 "phases: [{until: 0.1}, {until: {steps: 7}, step: 1e-3}, {until: 1, damp: 30}]\n"
                 "gauges: {v: {body: a, of: velocity}}\n");
  while (bw_scene_phase_now(s) == 0)
    bw_check_ok(bw_scene_step(s, INFINITY));
  bw_check_near(bw_scene_time(s), 0.1, 1e-15);
  const int64_t first = bw_scene_steps(s);
  while (bw_scene_phase_now(s) == 1)
    bw_check_ok(bw_scene_step(s, INFINITY));
  ck_assert_int_eq(bw_scene_steps(s), first + 7);
  /* The steps of that phase are its own. */
  bw_check_near(bw_scene_time(s), 0.107, 1e-15);
  bw_check_near(gauge(s, "v.x"), 1.0, TINY);
  const double from = bw_scene_time(s);
  run(s);
  bw_check_near(bw_scene_time(s), 1.0, 1e-15);
  /* v' = -k/rho v; the damping of Verlet's half step is of first order in the step. */
  const double decay = exp(-10.0 * (1.0 - from));
  bw_check_near(gauge(s, "v.x"), decay, 10 * bw_scene_last_step(s) * 10 * decay + TINY);
  bw_scene_destroy(&s);
}
END_TEST

/* A block between two grips that part: beyond its yield stress it flows; without one it would carry
 * E times the stretch. */
START_TEST(a_metal_yields)
{
  static const char *const plastic[] = {"", ", plastic: j2, yield_stress: 0.5"};
  double energy[2];
  for (int q = 0; q < 2; q++) {
    char text[1200];
    snprintf(text, sizeof text,
             "plane: strain\nthickness: 1\nmaterials: {m: {density: 1, young_modulus: 100, "
             "poisson_ratio: 0.3, law: correspondence%s}}\n"
             "bodies: {a: {shape: {box: {from: [0, 0], to: [1, 0.5]}}, material: m, "
             "motion: elastic, spacing: 0.1}}\n"
             "loads: [{on: a, kind: velocity, where: {side: x_upper, layers: 3}, value: [0.2, 0]}, "
             "{on: a, kind: velocity, where: {side: x_lower, layers: 3}, value: [-0.2, 0]}]\n"
             "phases: {until: 0.25}\ngauges: {e: {of: energy}}\n",
             plastic[q]);
    bw_scene *s = made(text);
    run(s);
    energy[q] = gauge(s, "e.elastic");
    ck_assert(isfinite(energy[q]));
    bw_scene_destroy(&s);
  }
  ck_assert_double_lt(energy[1], 0.25 * energy[0]);
}
END_TEST

/* Levels: loads give the momentum that they say, whatever cells they meet; gauges are means of
 * volume; what levels do not go with is refused by name. */
START_TEST(levels)
{
#define FINER                                                                                      \
  "numerics: {surface_correction: none}\nbodies: {a: {shape: {box: {from: [0, 0], to: [0.8, "      \
  "0.6]}},"                                                                                        \
  " material: m, motion: elastic, spacing: 0.1, levels: {level: 1, from: [0.4, 0.3], to: [1, "     \
  "1]}}}\n"
  static const char *const acts[] = {"{on: a, kind: traction, where: x_upper, value: [10, 0]}",
                                     "{on: a, kind: force, value: [12, 0]}"};
  for (int q = 0; q < 2; q++) {
    char text[1024];
    snprintf(text, sizeof text,
             BLOCK FINER "loads: %s\nphases: {until: 0.2}\n"
                         "gauges: {v: {body: a, of: velocity}}\n",
             acts[q]);
    bw_scene *s = made(text);
    /* 12 of 48 cells in four parts each. */
    ck_assert_int_eq(bw_solid_total(s->solid[0].solid), 36 + 4 * 12);
    run(s);
    const double mass = 3 * 0.48 * 2;
    bw_check_near(gauge(s, "v.x"), 12 * 0.2 / mass, TINY);
    bw_scene_destroy(&s);
  }
  ck_assert_ptr_null(scene_of(BLOCK "bodies: {a: {shape: {box: {from: [0, 0], to: [1, 1]}},"
                                    " material: m, motion: elastic, spacing: 0.1,"
                                    " levels: {level: 1, from: [2, 2], to: [3, 3]}}}\n"
                                    "phases: {until: 0.5}\n"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "levels.0"));
  ck_assert_ptr_null(scene_of(BLOCK "bodies: {a: {shape: {box: {from: [0, 0], to: [1, 1]}},"
                                    " material: m, motion: elastic, spacing: 0.1, turn: 20,"
                                    " levels: {level: 1, from: [0, 0], to: [1, 1]}}}\n"
                                    "phases: {until: 0.5}\n"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "turn"));
  /* In a flow: the plate is pushed along the stream, and moves that way. */
#define IN_FLOW(finer)                                                                             \
  "domain: {length: [2, 1, 0.1], cells: [20, 10, 1]}\nfluid: {density: 1, viscosity: 0.1, sides: " \
  "{x: {lower: {kind: inflow, profile: poiseuille, mean: 1}, upper: {kind: outflow}}, y: {lower: " \
  "{kind: wall}, upper: {kind: wall}}}}\nmaterials: {m: {density: 10, young_modulus: 1.0e3}}\n"    \
  "numerics: {surface_correction: none}\nbodies: {a: {shape: {box: {from: [0.5, -0.2], to: [0.8, " \
  "0.5]}}, material: m, motion: elastic, spacing: 0.1, held: {side: y_lower, layers: 2}, " finer   \
  "}}\nphases: {until: 0.2}\ngauges: {v: {body: a, of: velocity}, d: {body: a, of: force}}\n"
  bw_scene *s = made(IN_FLOW("levels: {level: 1, from: [0.4, 0.3], to: [0.9, 0.6]}"));
  run(s);
  ck_assert_double_gt(gauge(s, "d.reaction.x"), 0.0);
  ck_assert_double_gt(gauge(s, "v.x"), 0.0);
  bw_scene_destroy(&s);
}
END_TEST

/* Levels that change: tractions give the momentum that they say all along, a scene goes on from its
 * checkpoint to the same numbers; what such levels do not go with is refused by name. */
START_TEST(refine)
{
#define TIP ", t: {body: a, of: crack_tip, origin: [0.5, 0.6]}"
#define REFINED(more)                                                                              \
  "plane: strain\nthickness: 2\nmaterials: {m: {density: 3, young_modulus: 100, fracture_energy: " \
  "0.06}}\nnumerics: {surface_correction: none}\nbodies: {a: {shape: {box: {from: [0, 0], to: "    \
  "[1.6, 1.2]}}, material: m, motion: breakable, spacing: 0.1, self_contact: false,"               \
  " cracks: {from: [-0.1, 0.6], to: [0.5, 0.6]}, refine: {level: 1}}}\nloads:\n"                   \
  "  - {on: a, kind: traction, where: y_upper, value: [1, 2.5]}\n"                                 \
  "  - {on: a, kind: traction, where: y_lower, value: [0, -2.5]}\n"                                \
  "phases: {until: 0.4}\ngauges: {v: {body: a, of: velocity}, e: {of: energy}, f: {of: "           \
  "fragments}" more "}\n"
  bw_scene *s = made(REFINED(TIP));
  bw_check_near(gauge(s, "t.x"), 0.5, 0.0); /* the cut itself is no part of the crack */
  const int64_t few = bw_solid_total(s->solid[0].solid);
  ck_assert_int_gt(few, 16 * 12); /* the crack's tip is fine */
  while (bw_scene_time(s) < 0.35)
    bw_check_ok(bw_scene_step(s, 0.35));
  ck_assert_int_gt(bw_solid_total(s->solid[0].solid), few);
  bw_scene *other = again(s, REFINED(TIP));
  run(s);
  run(other);
  ck_assert_int_eq(bw_solid_total(s->solid[0].solid), bw_solid_total(other->solid[0].solid));
  bw_check_near(gauge(s, "v.x"), 1 * 1.6 * 2 * 0.4 / (3 * 1.92 * 2), 10 * TINY);
  bw_check_near(gauge(other, "v.y"), gauge(s, "v.y"), 0.0);
  bw_check_near(gauge(other, "f"), gauge(s, "f"), 0.0);
  bw_check_near(gauge(other, "t.x"), gauge(s, "t.x"), 0.0);
  ck_assert_double_gt(gauge(s, "t.x"), 0.6); /* it has run, from 0.5 */
  ck_assert_double_ge(gauge(s, "f"), 1);
  bw_check_near(gauge(other, "e.elastic"), gauge(s, "e.elastic"), 1e2 * BW_REAL_EPSILON);
  bw_scene_destroy(&s);
  bw_scene_destroy(&other);
  ck_assert_ptr_null(scene_of(IN_FLOW("refine: {level: 1}")));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "refine: a flow"));
}
END_TEST

/* A strip in tension, sigma = 1: its middle fails at the strength over sigma; nothing is told
 * before it is loaded. */
START_TEST(fails_at)
{
#define STRENGTH(by)                                                                               \
  "body: a, of: [failure, failure_place], region: {from: [0.8, 0], to: [1.2, 0.4]}, strength: "    \
  "{" by "}}"
  bw_scene *s = made(
      "plane: strain\nmaterials: {m: {density: 1, young_modulus: 1000}}\n"
      "bodies: {a: {shape: {box: {from: [0, 0], to: [2, 0.4]}}, material: m,"
      " motion: elastic, spacing: 0.05}}\nnumerics: {horizon_ratio: 3}\n"
      "loads:\n  - {on: a, kind: traction, where: x_lower, value: [-1, 0]}\n"
      "  - {on: a, kind: traction, where: x_upper, value: [1, 0]}\n"
      "phases: {until: 2, damp: 40}\ngauges:\n"
      "  r: {" STRENGTH(
          "by: rankine, tension: 3") "\n"
                                     "  m: {" STRENGTH(
                                         "by: mises, yield: 3") "\n"
                                                                "  c: {" STRENGTH(
                                                                    "by: mohr_coulomb, cohesion: "
                                                                    "3, friction_angle: 0") "\n");
  double start;
  bw_check_ok(bw_scene_gauge(s, "r.failure", &start));
  ck_assert(isnan(start));
  run(s);
  /* Across the plane nu sigma: von Mises sqrt(1 - nu + nu^2) sigma; the shear is half of sigma. */
  ck_assert_msg(fabs(gauge(s, "r.failure") / 3.0 - 1.0) < 0.02, "%g", gauge(s, "r.failure"));
  ck_assert_msg(fabs(gauge(s, "m.failure") * sqrt(0.8125) / 3.0 - 1.0) < 0.02, "%g",
                gauge(s, "m.failure"));
  ck_assert_msg(fabs(gauge(s, "c.failure") / 6.0 - 1.0) < 0.02, "%g", gauge(s, "c.failure"));
  ck_assert(fabs(gauge(s, "r.failure_place.x") - 1.0) < 0.2);
  bw_scene_destroy(&s);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(fails_at),       BW_TEST(names_are_words),
                                      BW_TEST(a_metal_yields), BW_TEST(weight),
                                      BW_TEST(loads),          BW_TEST(prescribed),
                                      BW_TEST(collision),      BW_TEST(materials_and_holes),
                                      BW_TEST(phases),         BW_TEST(levels),
                                      BW_TEST(refine)};
BW_CHECK_MAIN("scene.solids", tests)
