/* A fluid of particles in a scene: water at rest weighs on its walls, a body in it is borne, a
 * piston moves it, a scene is what the modules make of the same numbers, and what cannot be is
 * refused.
 * TEST ranks=1,2 */
#include "scene_text.h"

/* Water 0.5 deep and 1 wide, places 0.05 apart, in a layer of thickness 2. */
#define WATER(more)                                                                                \
  "domain: {length: [1, 1, 2], cells: [20, 20, 1]}\n"                                              \
  "fluid:\n  model: particles\n  density: 1000\n  viscosity: 1.0e-3\n" more "gravity: [0, -10]\n"
#define CLAY "materials: {clay: {density: 2000, young_modulus: 1.0e7}}\n"
#define POOL "  shape: {box: {from: [0, 0], to: [1, 0.5]}}\n"

/* Its weight is 1000 x 10 x 0.5 x 2 = 10 kN, borne by the floor; either side pushes with 2.5 kN. */
START_TEST(rest)
{
  bw_scene *s =
      made(WATER(POOL) "phases: {until: 0.5}\n"
                       "gauges:\n  walls: {of: [wall_force, mass, outside]}\n"
                       "  floor: {of: wall_pressure, region: {from: [0.2, -0.05], to: [0.8, 0]}}\n"
                       "  depth: {of: depth, point: [0.5]}\n"
                       "  energy: {of: fluid_energy}\n  front: {of: [front, height]}\n");
  double row[64], force[2] = {0}, floor = 0.0;
  int n = 0;
  ck_assert_int_le(s->n_columns, 64);
  while (!bw_scene_done(s)) {
    bw_check_ok(bw_scene_step(s, INFINITY));
    /* Sound passes through single steps: means of the second half. */
    if (bw_scene_time(s) < 0.25) continue;
    force[0] += gauge(s, "walls.wall_force.x");
    force[1] += gauge(s, "walls.wall_force.y");
    n++;
  }
  bw_check_ok(bw_scene_measure(s, row));
  floor = row[5];
  ck_assert_str_eq(s->names[5], "floor[M/(L T2)]");
  /* The walls bear the weight in the mean, to the sound that is left; the sides balance. */
  ck_assert_msg(fabs(force[1] / n / -10000.0 - 1.0) < 0.01, "%g", force[1] / n);
  ck_assert_msg(fabs(force[0] / n) < 20.0, "%g", force[0] / n);
  /* A mean over the run, where wall particles are: half a spacing below the floor. */
  ck_assert_msg(fabs(floor / 5250.0 - 1.0) < 0.01, "%g", floor);
  ck_assert(fabs(gauge(s, "walls.mass") / 1000.0 - 1.0) < 0.01);
  ck_assert(gauge(s, "walls.outside") == 0.0);
  ck_assert_msg(fabs(gauge(s, "depth") - 0.5) < 0.01, "%g", gauge(s, "depth"));
  ck_assert(fabs(gauge(s, "front.front") - 1.0) < 0.03);
  ck_assert(fabs(gauge(s, "front.height") - 0.5) < 0.03);
  /* m g H/2 above the origin. */
  ck_assert(fabs(gauge(s, "energy.potential") / 2500.0 - 1.0) < 0.01);
  ck_assert(gauge(s, "energy.kinetic") < 1.0);
  bw_scene_destroy(&s);
}
END_TEST

/* The scene against the module with the numbers written by hand: the same bits. */
START_TEST(is_the_module)
{
  bw_comm *world = bw_check_world();
  bw_scene *s = made(
      WATER("  shape: {box: {from: [0, 0], to: [0.4, 0.5]}}\n") "phases: {until: {steps: "
                                                                "40}}\nnumerics: {step_share: 1}\n"
                                                                "gauges: {f: {of: front}, w: {of: "
                                                                "wall_force}}\n");
  bw_ulph_config c = bw_ulph_config_default();
  const double origin[3] = {0}, t = 0.2;
  const bw_shape water = {.upper = {0.4, 0.5}};
  const bw_shape tank[2] = {{.lower = {-t, -t}, .upper = {1 + t, 1 + t}},
                            {.upper = {1, 1 + 2 * t}, .remove = true}};
  const bw_ulph_wall wall = {.count = 2, .shape = tank};
  bw_ulph *u = NULL;
  double *x = NULL, force[3];
  size_t n = 0;
  c.dimensions = 2, c.dx = 0.05, c.rho0 = 1000, c.mu = 1;
  c.gravity[1] = -10, c.speed = 2 * sqrt(5);
  bw_check_ok(bw_ulph_fill(world, &c, origin, 1, &water, &n, &x));
  bw_check_ok(bw_ulph_create(world, &c, n, x, 1, &wall, &u));
  bw_check_ok(bw_ulph_start(u, NULL, NULL));
  bw_scene *dry = made(
      WATER("  start: {hydrostatic: false}\n"
            "  shape: {box: {from: [0, 0], to: [0.4, 0.5]}}\n") "phases: {until: {steps: "
                                                                "40}}\nnumerics: {step_share: 1}\n"
                                                                "gauges: {f: {of: front}, w: {of: "
                                                                "wall_force}}\n");
  run(s);
  run(dry);
  for (int q = 0; q < 40; q++)
    bw_check_ok(bw_ulph_step(u, bw_ulph_dt_max(u)));
  bw_ulph_wall_force(u, force);
  ck_assert(gauge(dry, "f") == bw_ulph_reach(u, 0, (double[]){0, 0, -1}, (double[]){1, 1e30, 1}));
  ck_assert(gauge(dry, "w.x") == 2.0 * force[0] && gauge(dry, "w.y") == 2.0 * force[1]);
  /* Pressure at the start is not nothing. */
  ck_assert(gauge(s, "w.y") != gauge(dry, "w.y"));
  bw_ulph_destroy(&u);
  bw_release(&x);
  bw_scene_destroy(&s);
  bw_scene_destroy(&dry);
}
END_TEST

/* A block that is held 0.2 x 0.2 under water is borne by 1000 x 10 x 0.04 x 2 = 800 N; the walls
 * bear what is left of the water, and that. */
START_TEST(borne)
{
  bw_scene *s =
      made(WATER(POOL) CLAY
           "bodies:\n  block: {shape: {box: {from: [0.4, 0.15], to: [0.6, 0.35]}}, "
           "material: clay, motion: elastic, held: {box: {from: [0, 0], to: [1, 1]}}}\n"
           "phases: {until: 0.5}\n"
           "gauges:\n  lift: {body: block, of: force}\n  walls: {of: [wall_force, mass]}\n");
  double lift = 0.0, walls = 0.0;
  int n = 0;
  while (!bw_scene_done(s)) {
    bw_check_ok(bw_scene_step(s, INFINITY));
    if (bw_scene_time(s) < 0.25) continue;
    lift += gauge(s, "lift.reaction.y");
    walls += gauge(s, "walls.wall_force.y");
    n++;
  }
  /* What the fluid weighs, it gives to the walls and the block, in the mean of a half second. */
  const double weight = 10.0 * gauge(s, "walls.mass");
  ck_assert_msg(fabs((walls + lift) / n / -weight - 1.0) < 0.01, "%g %g", walls / n, lift / n);
  /* Four particles across: the surface is a tenth of a spacing off, on either side. */
  ck_assert_msg(fabs(lift / n / 800.0 - 1.0) < 0.08, "%g", lift / n);
  bw_scene_destroy(&s);
}
END_TEST

/* A piston that moves 0.1 into a pool of 0.8 x 0.4: what was 0.32 wide and high is 0.457 deep. */
START_TEST(piston)
{
  bw_scene *s = made(WATER(
      "  shape: {box: {from: [0.2, 0], to: [1, 0.4]}}\n") "bodies:\n  piston: {shape: {box: {from: "
                                                          "[0, 0], to: [0.2, 0.8]}}, "
                                                          "motion: prescribed, velocity: [0.2, "
                                                          "0]}\nphases: {until: 0.5}\n"
                                                          "gauges:\n  at: {body: piston, of: "
                                                          "displacement}\n"
                                                          "  push: {body: piston, of: force}\n  "
                                                          "energy: {of: fluid_energy}\n");
  run(s);
  bw_check_near(gauge(s, "at.x"), 0.1, 1e3 * BW_REAL_EPSILON);
  /* 640 kg, half of 0.457 above the floor; the rest is the swell that the piston raised. */
  const double potential = gauge(s, "energy.potential");
  ck_assert_msg(potential > 1450.0 && potential < 1510.0, "%g", potential);
  /* What the piston gave is there, but for what was lost: the book closes. */
  const char *const lines[] = {"energy.kinetic", "energy.potential", "energy.compression"};
  double now = 0.0;
  for (int q = 0; q < 3; q++)
    now += gauge(s, lines[q]);
  ck_assert(gauge(s, "energy.bodies") > 150.0 && now > 1450.0);
  ck_assert_msg(gauge(s, "push.reaction.x") < -500.0, "%g", gauge(s, "push.reaction.x"));
  bw_scene_destroy(&s);
}
END_TEST

/* A fixed body is a wall and no solid; one that holds another is on its lattice. */
START_TEST(walls)
{
  static const char *const text[] = {
      WATER(POOL) CLAY "bodies:\n  sill: {shape: {box: {from: [0.4, -0.2], to: [0.6, 0.2]}}, "
                       "motion: fixed}\nphases: {until: {steps: 2}}\n",
      WATER(POOL) CLAY
      "bodies:\n  sill: {shape: {box: {from: [0.4, -0.2], to: [0.6, 0.2]}}, motion: fixed}\n"
      "  leaf: {shape: {box: {from: [0.4, 0.2], to: [0.6, 0.3]}}, material: clay, motion: elastic, "
      "held: {by: sill}}\nphases: {until: {steps: 2}}\n"};
  for (int q = 0; q < 2; q++) {
    bw_scene *s = made(text[q]);
    ck_assert_int_eq(s->n_solids, q);
    ck_assert((s->water->both != NULL) == (q == 1));
    /* 20 x 10 places but those of the bodies: 4 x 4, and 4 x 2 more. */
    ck_assert_int_eq(bw_ulph_total(s->water->fluid), q == 0 ? 184 : 176);
    run(s);
    bw_scene_destroy(&s);
  }
}
END_TEST

/* A phase until the water is at rest: not at the first look, as what starts from rest has still to
 * move. At rest it has settled when what is remembered has faded, 0.95^90 < 1/100, every 20 steps.
 */
START_TEST(settles)
{
  bw_scene *s = made(WATER(POOL) "phases: [{until: {settled: 0.01}}, {until: {steps: 1}}]\n");
  while (bw_scene_phase_now(s) == 0)
    bw_check_ok(bw_scene_step(s, INFINITY));
  ck_assert_int_eq(bw_scene_steps(s), 1800);
  bw_scene_destroy(&s);
}
END_TEST

typedef struct {
  const char *text, *piece;
} refusal;
#define END  "phases: {until: 1}\n"
#define POST "  post: {shape: {box: {from: [0.6, 0], to: [0.8, 0.8]}}, motion: fixed}\n"
#define RAM  "shape: {box: {from: [0.1, 0.05], to: [0.25, 0.3]}}, motion: prescribed"
static const refusal refusals[] = {
    {WATER("") END, "fluid.shape is missing"},
    {WATER("  shape: {box: {from: [0, 0], to: [2, 0.5]}}\n") END, "it goes from 0 to 2 along x"},
    {WATER(POOL "  sides: {x: {lower: {kind: wall}, upper: {kind: wall}}, y: {lower: {kind: wall}, "
                "upper: {kind: wall}}}\n") END,
     "fluid.sides: not with fluid.model: particles"},
    {WATER(POOL "  start: {developed: true}\n") END, "fluid.start.developed: not with"},
    {WATER(POOL) END "gauges: {a: {of: divergence}}\n", "that of a fluid on a grid"},
    {WATER(POOL) END "gauges: {a: {of: depth}}\n", "gauges.a.point is missing"},
    {WATER(POOL) END "gauges: {a: {of: wall_pressure}}\n", "gauges.a.region is missing"},
    {WATER(POOL) END "gauges: {a: {of: work}}\n", "on bodies that deform, of which there is none"},
    {WATER(POOL) END "numerics: {sound_speed: 10}\n", "it must be at least 44.72"},
    {WATER(POOL) END "bodies: {a: {shape: {box: {from: [0.4, 0], to: [0.5, 1]}}, motion: fixed}}\n",
     "bodies.a.shape: it is 0.1 thick along x"},
    {WATER(POOL) CLAY END "bodies: {a: {shape: {box: {from: [0.4, 0], to: [0.6, 0.2]}}, motion: "
                          "rigid, material: clay}}\n",
     "bodies.a.motion = rigid: in a fluid of particles"},
    /* A ram runs into a post, or into the end of the tank; or swings into its beginning. */
    {WATER(POOL) END "bodies:\n" POST "  ram: {" RAM ", velocity: [0.5, 0]}\n",
     "brings it into bodies.post by more than a spacing, 0.05"},
    {WATER(POOL) END "bodies:\n  ram: {" RAM ", velocity: [0.9, 0]}\n",
     "brings it into the closed side x_upper by"},
    {WATER(POOL) END "bodies:\n" POST "  ram: {" RAM
                     ", swing: {amplitude: [0.2, 0, 0], frequency: 2}}\n",
     "brings it into the closed side x_lower by"},
    {WATER(POOL) END "bodies:\n  ram: {" RAM
                     ", rotation: {rate: 3, axis: [0, 0, 1], centre: [0.15, 0.1]}}\n",
     "brings it into the closed side x_lower by"},
    {WATER("  shape: {box: {from: [0, 0], to: [1, 0.04]}}\n") END,
     "fluid.shape: it is 0.04 thick along y, thinner than a particle"},
    {WATER(POOL "  speed: 1\n  start: {velocity: [3, 4]}\n") END,
     "fluid.speed = 1: fluid.start.velocity is 5 already"},
    {WATER(POOL) END
     "bodies: {a: {shape: {box: {from: [0.4, 0], to: [0.6, 0.2]}}, motion: fixed}}\n"
     "gauges: {f: {body: a, of: force}}\n",
     "gauges.f.body = a: a fixed body is a wall"},
    {"domain: {length: [1, 1, 2], cells: [20, 10, 1]}\nfluid:\n  model: particles\n  density: 1\n"
     "  viscosity: 1\n" POOL END,
     "domain.cells[0] = 20: the places of particles are cubes"},
    {"domain: {length: [1, 1, 2], cells: [10, 10, 1], open: up}\nfluid:\n  model: particles\n"
     "  density: 1\n  viscosity: 1\n" POOL END,
     "domain.open = up: must be of x_lower"},
    {"domain: {length: [1, 1, 2], cells: [20, 20, 1]}\nfluid:\n  model: particles\n  density: 1\n"
     "  viscosity: 1\n" POOL END,
     "fluid.speed is missing"},
    {"domain: {length: [1, 1, 1], cells: [20, 20, 1], shake: {amplitude: 1, frequency: 1}}\n"
     "fluid:\n  density: 1\n  viscosity: 1\n  sides: {x: {lower: {kind: wall}, upper: {kind: "
     "wall}}, y: {lower: {kind: wall}, upper: {kind: wall}}}\n" END,
     "domain.shake: it belongs to fluid.model: particles"}};

/* Ways that end in time, begin in the wall as a rod in its hole, or lead through an open side, and
 * a start faster than water that falls. */
static const char *const taken[] = {
    WATER(POOL) END "bodies:\n" POST "  ram: {" RAM ", velocity: [0.3, 0]}\n",
    WATER(POOL) END "bodies:\n  rod: {shape: {box: {from: [-0.1, 0.2], to: [0.2, 0.4]}}, motion: "
                    "prescribed, velocity: [-0.2, 0]}\n",
    WATER(POOL) END "bodies:\n  ram: {" RAM ", velocity: [0, 2]}\n",
    WATER(POOL "  start: {velocity: [30, 40]}\n") END};

START_TEST(accepted)
{
  for (size_t q = 0; q < sizeof taken / sizeof *taken; q++) {
    bw_scene *s = scene_of(taken[q]);
    ck_assert_msg(s != NULL, "%zu: %s", q, bw_last_message());
    bw_scene_destroy(&s);
  }
}
END_TEST

START_TEST(refused)
{
  for (size_t q = 0; q < sizeof refusals / sizeof *refusals; q++) {
    bw_scene *s = scene_of(refusals[q].text);
    ck_assert_msg(s == NULL && strstr(bw_last_message(), refusals[q].piece) != NULL,
                  "not '%s' but: %s", refusals[q].piece, s == NULL ? bw_last_message() : "taken");
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(rest),     BW_TEST(is_the_module), BW_TEST(borne),
                                      BW_TEST(piston),   BW_TEST(settles),       BW_TEST(walls),
                                      BW_TEST(accepted), BW_TEST(refused)};
BW_CHECK_MAIN("scene.water", tests)
