/* The fluid of a scene: gauges at places, ramps, forces on bodies by every route, bodies in it.
 * TEST ranks=1,2 */
#include "coupler_internal.h"
#include "scene_text.h"

#define CHANNEL "domain: {length: [2, 1, 0.125], cells: [16, 8, 1]}\n"
#define WALLS   "    y: {lower: {kind: wall}, upper: {kind: wall}}\n"

/* A field that is linear in all directions, halos too. */
static void fill(bw_scene *s, bw_real *f, int face, double c0, const double c[3])
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
    for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
      for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++) {
        const int at[3] = {i, j, k};
        double value = c0;
        for (int d = 0; d < 3; d++)
          value += c[d] * (at[d] + g->lo[d] - (d == face ? 0.0 : 0.5)) * g->spacing[d];
        f[bw_at(g, i, j, k)] = (bw_real)value;
      }
}

/* Linear fields are met everywhere, between points and next to sides. */
START_TEST(places)
{
  bw_scene *s =
      made("domain: {length: [2, 1, 1.5], cells: [16, 8, 12]}\n"
           "fluid:\n  density: 2\n  viscosity: 0.1\n  sides:\n"
           "    x: {lower: {kind: wall}, upper: {kind: wall}}\n" WALLS
           "    z: {lower: {kind: wall}, upper: {kind: wall}}\n"
           "phases: {until: {steps: 1}}\n"
           "gauges:\n  a: {point: [0.83, 0.41, 0.7], of: [velocity, pressure]}\n"
           "  b: {point: [0, 1, 1.5], minus: [1.2, 0.1, 0.02], of: [velocity, pressure]}\n");
  const double c[4][3] = {{1, 2, 3}, {-1, 4, 2}, {5, -3, 1}, {2, 2, -4}};
  for (int q = 0; q < 4; q++)
    fill(s, q < 3 ? bw_ns_channel_velocity(s->fluid)[q] : bw_ns_channel_pressure(s->fluid), q, q,
         c[q]);
  static const char *const names[] = {"velocity.x", "velocity.y", "velocity.z", "pressure"};
  for (int q = 0; q < 4; q++) {
    char a[32], b[32];
    const double scale = q == 3 ? 2.0 : 1.0; /* p is over the density in the field */
    snprintf(a, sizeof a, "a.%s", names[q]);
    snprintf(b, sizeof b, "b.%s", names[q]);
    bw_check_near(gauge(s, a), scale * (q + 0.83 * c[q][0] + 0.41 * c[q][1] + 0.7 * c[q][2]),
                  1e2 * BW_REAL_EPSILON);
    bw_check_near(gauge(s, b), scale * (-1.2 * c[q][0] + 0.9 * c[q][1] + 1.48 * c[q][2]),
                  1e3 * BW_REAL_EPSILON);
  }
  bw_scene_destroy(&s);
}
END_TEST

/* The gradient that drives a flow is in the pressure that a gauge tells. */
START_TEST(driven)
{
  bw_scene *s =
      made(CHANNEL "fluid:\n  density: 2\n  viscosity: 0.1\n  forcing: {kind: gradient, value: 3}\n"
                   "  sides:\n    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n" WALLS
                   "phases: {until: 0.01}\n"
                   "gauges: {p: {point: [0.25, 0.5], minus: [1.5, 0.5], of: pressure}, u: {of: "
                   "bulk_velocity}}\n");
  run(s);
  bw_check_near(gauge(s, "p"), 2 * 3 * 1.25, 1e3 * BW_REAL_EPSILON);
  /* From rest, but for the friction of a hundredth of a unit of time: 3 t. */
  bw_check_near(gauge(s, "u"), 0.03, 0.005);
  bw_scene_destroy(&s);
}
END_TEST

/* An inflow that rises brings mean (1 - cos(pi t/T))/2. */
START_TEST(ramp)
{
  bw_scene *s =
      made(CHANNEL "fluid:\n  density: 1\n  viscosity: 0.1\n  sides:\n"
                   "    x: {lower: {kind: inflow, profile: poiseuille, mean: 2, ramp: 0.4}, upper: "
                   "{kind: outflow}}\n" WALLS "phases: {until: 0.1}\n"
                   "gauges: {q: {of: flow_rate}}\nnumerics: {step: 0.005}\n");
  run(s);
  /* Through a section of 1 x 0.125; the sum of the parabola as above. */
  const double rate = 2 * 0.5 * (1 - cos(0.25 * acos(-1.0))) * 0.125 * (1 + 0.5 / 64);
  bw_check_near(gauge(s, "q.in"), rate, 1e3 * BW_REAL_EPSILON);
  bw_check_near(gauge(s, "q.out"), rate, 1e4 * BW_REAL_EPSILON);
  bw_scene_destroy(&s);
}
END_TEST

/* The memory of the step to come holds no pressure inside the bodies (bw_ibm_mdf_close). */
static void check_pressure_inside(bw_scene *s)
{
  const bw_scene__points *p = &s->inner;
  double along = 0.0, all = 0.0;
  bw_ibm_mdf_begin_step(s->markers);
  bw_ibm_mdf_memory(s->markers, p->M);
  for (size_t i = 0; i < 3 * p->n; i++)
    along += p->M[i] * p->N[i], all += fabs(p->M[i]);
  double sums[2] = {along, all};
  bw_comm_sum(s->comm, 2, sums);
  ck_assert_double_gt(sums[1], 0.0);
  bw_check_near(sums[0] / sums[1], 0.0, 1e4 * BW_REAL_EPSILON);
}

/* A sphere that does not move: markers have its area, the three routes its drag. The momentum
 * balance is the scheme's own, so that two of them are one to round-off. */
START_TEST(force)
{
  bw_scene *s =
      made("domain: {length: [2, 2, 2], cells: [16, 16, 16]}\n"
           "fluid:\n  density: 2\n  viscosity: 0.5\n  sides:\n"
           "    x: {lower: {kind: inflow, velocity: [1, 0, 0]}, upper: {kind: outflow}}\n"
           "    y: {lower: {kind: free_slip}, upper: {kind: free_slip}}\n"
           "    z: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
           "  start: {velocity: [1, 0, 0]}\n"
           "bodies: {ball: {shape: {sphere: {centre: [1, 1, 1], radius: 0.45}}, motion: fixed}}\n"
           "phases: {until: {steps: 30}}\ngauges: {f: {body: ball, of: force}}\n");
  const double retraction = bw_ibm_mdf_retraction(&(bw_ibm_mdf_config){BW_KERNEL_ROMA3, 1, 0.2});
  const double R = 0.45 - retraction * 0.125;
  double area = 0.0;
  for (size_t i = 0; i < s->inner.n; i++)
    area += s->inner.area[i];
  bw_comm_sum(s->comm, 1, &area);
  bw_check_near(area, 4 * acos(-1.0) * R * R, 1e-10);
  run(s);
  const double reaction = gauge(s, "f.reaction.x");
  ck_assert_double_gt(reaction, 0.0);
  bw_check_near(gauge(s, "f.box.x") / reaction, 1.0, 1e5 * BW_REAL_EPSILON);
  /* Probes err by the first order of the cell over the radius: 0.91, 0.83, 0.77 h/R low at 3.6, 7.2
   * and 10.8 cells per radius (t = 0.3). The bound h/R = 1/3.6 was set after the first of them. */
  bw_check_near(gauge(s, "f.probe.x") / reaction, 1.0, 0.28);
  bw_check_near(gauge(s, "f.reaction.y"), 0.0, 1e4 * BW_REAL_EPSILON);
  check_pressure_inside(s);
  bw_scene_destroy(&s);
}
END_TEST

/* A flap held by a fixed cylinder: one lattice, of which the cylinder stays and the flap gives. */
START_TEST(flap)
{
  bw_scene *s = made(
      "domain: {length: [2, 1, 0.0625], cells: [32, 16, 1]}\n"
      "fluid:\n  density: 1\n  viscosity: 0.05\n  sides:\n"
      "    x: {lower: {kind: inflow, profile: poiseuille, mean: 1}, upper: {kind: outflow}}\n" WALLS
      "  start: {developed: true}\n"
      "materials: {m: {density: 10, young_modulus: 1000}}\n"
      "bodies:\n"
      "  post: {shape: {cylinder: {centre: [0.5, 0.4], radius: 0.15}}, motion: fixed}\n"
      "  flap: {shape: [{box: {from: [0.5, 0.3125], to: [1.2, 0.5]}}, {minus: post}],\n"
      "         material: m, motion: elastic, held: {by: post}}\n"
      "phases: [{until: {steps: 3}, hold: flap}, {until: {steps: 8}}]\n"
      "gauges:\n  tip: {body: flap, nearest: [1.2, 0.4], of: displacement}\n"
      "  post: {body: post, of: displacement}\n"
      "  drag: {body: [post, flap], of: force}\n"
      "  of_post: {body: post, of: force}\n  of_flap: {body: flap, of: force}\n");
  ck_assert_int_eq(s->n_solids, 1);
  ck_assert(!bw_solid_settings(s->solid[0].solid)->contact);
  while (bw_scene_phase_now(s) == 0)
    bw_check_ok(bw_scene_step(s, INFINITY));
  bw_check_near(gauge(s, "tip.x"), 0.0, 0.0);
  /* Parts make the whole, held and moving, by the route that loads them. */
  bw_check_near(gauge(s, "of_post.probe.x") + gauge(s, "of_flap.probe.x"), gauge(s, "drag.probe.x"),
                1e3 * BW_REAL_EPSILON);
  run(s);
  bw_check_near(gauge(s, "of_post.probe.x") + gauge(s, "of_flap.probe.x"), gauge(s, "drag.probe.x"),
                1e3 * BW_REAL_EPSILON);
  ck_assert_double_gt(gauge(s, "of_post.probe.x"), 0.05);
  ck_assert_double_gt(gauge(s, "tip.x"), 0.0);
  bw_check_near(gauge(s, "post.x"), 0.0, 0.0);
  ck_assert_double_gt(gauge(s, "drag.reaction.x"), 0.0);
  bw_scene_destroy(&s);
}
END_TEST

/* A wall that a body stands on carries it, the wall opposite and the open sides do not. */
START_TEST(a_post_leans_on_its_wall)
{
  bw_scene *s =
      made(CHANNEL
           "fluid:\n  density: 1\n  viscosity: 0.05\n  sides:\n"
           "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n" WALLS
           "materials: {m: {density: 10, young_modulus: 1000}}\n"
           "bodies:\n  post: {shape: {box: {from: [0.75, -0.25], to: [1.25, 0.5]}}, material: m,\n"
           "         motion: elastic, held: {side: y_lower, layers: 2}}\nphases: {until: 1}\n"
           "gauges: {top: {body: post, of: displacement}}\nwatch: {top.x: {mean: midrange}}\n");
  for (int d = 0; d < 3; d++)
    for (int e = 0; e < 2; e++)
      ck_assert(s->coupler->config.walled[d][e] == (d == 1 && e == 0));
  /* Nothing moves: no share of nothing slips by it or goes through it. */
  bw_coupler_report r;
  bw_check_ok(bw_coupler_measure(s->coupler, &r));
  ck_assert_double_eq(r.slip, 0);
  ck_assert_double_eq(r.leak, 0);
  bw_scene_destroy(&s);
}
END_TEST

/* What is too near to another body in a flow would be bonded: refused, with both names. */
START_TEST(too_near)
{
  bw_scene *s = scene_of(
      CHANNEL
      "fluid:\n  density: 1\n  viscosity: 0.05\n  sides:\n"
      "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n" WALLS
      "materials: {m: {density: 10, young_modulus: 1000}}\n"
      "bodies:\n  a: {shape: {box: {from: [0.5, 0.25], to: [1, 0.5]}}, material: m, motion: "
      "elastic}\n"
      "  b: {shape: {box: {from: [1.125, 0.25], to: [1.5, 0.5]}}, material: m, motion: "
      "elastic}\nphases: {until: 1}\n");
  ck_assert_ptr_null(s);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "nearer than a horizon"));
  /* In families of more than a thousand partners, too. */
  s = scene_of(
      "domain: {length: [1.6, 0.8, 0.8], cells: [16, 8, 8]}\n"
      "fluid:\n  density: 1\n  viscosity: 0.05\n  sides:\n"
      "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n" WALLS
      "    z: {lower: {kind: wall}, upper: {kind: wall}}\n"
      "materials: {m: {density: 10, young_modulus: 1000}}\nnumerics: {horizon_ratio: 6}\n"
      "bodies:\n  a: {shape: {box: {from: [0.4, 0.3, 0.3], to: [0.6, 0.5, 0.5]}}, material: m,\n"
      "      motion: elastic}\n"
      "  b: {shape: {box: {from: [0.9, 0.3, 0.3], to: [1.1, 0.5, 0.5]}}, material: m,\n"
      "      motion: elastic}\nphases: {until: 1}\n");
  ck_assert_ptr_null(s);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "nearer than a horizon"));
}
END_TEST

/* A uniform inflow may rise whatever stands beside it, a laminar one between two walls alone. */
START_TEST(ramps_beside_free_slip)
{
#define BESIDE(inflow)                                                                             \
  CHANNEL "fluid:\n  density: 1\n  viscosity: 0.1\n  sides:\n"                                     \
          "    x: {lower: {kind: inflow, " inflow ", ramp: 0.5}, upper: {kind: outflow}}\n"        \
          "    y: {lower: {kind: free_slip}, upper: {kind: free_slip}}\n"                          \
          "phases: {until: 0.25}\ngauges: {v: {point: [1, 0.5], of: velocity}}\n"
  bw_scene *s = made(BESIDE("velocity: [2, 0, 0]"));
  run(s);
  /* Half of the ramp: the whole of the box has what enters. */
  bw_check_near(gauge(s, "v.x"), 1.0, 1e-6);
  bw_scene_destroy(&s);
  ck_assert_ptr_null(scene_of(BESIDE("profile: poiseuille, mean: 2")));
}
END_TEST

/* Straight flow along (3, 4): the way over that along x is 5/3, along y 5/4. */
START_TEST(straight)
{
  bw_scene *s =
      made(CHANNEL "fluid:\n  density: 2\n  viscosity: 0.1\n  start: {velocity: [3, 4]}\n"
                   "  sides:\n    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
                   "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
                   "phases: {until: {steps: 1}}\n"
                   "gauges: {all: {of: tortuosity}, half: {of: tortuosity, region: {from: [0, 0], "
                   "to: [1, 1]}}}\n");
  bw_check_near(gauge(s, "all.x"), 5.0 / 3.0, 10 * BW_REAL_EPSILON);
  bw_check_near(gauge(s, "half.y"), 5.0 / 4.0, 10 * BW_REAL_EPSILON);
  bw_scene_destroy(&s);
}
END_TEST

/* A square in a box without walls, driven along an axis: force on it along the axis by two routes,
 * and the flow there. */
static void drive(const char *axis, const char *kind, double out[3])
{
  char text[1024], name[32];
  const char c = axis[0];
  snprintf(text, sizeof text,
           "domain: {length: [1, 1, 0.0625], cells: [16, 16, 1]}\nfluid:\n  density: 2\n"
           "  viscosity: 0.05\n  forcing: {kind: %s, axis: %s, value: 0.7}\n  sides:\n"
           "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
           "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
           "bodies: {a: {shape: {box: {from: [0.3, 0.3], to: [0.7, 0.7]}}, motion: fixed}}\n"
           "phases: {until: {steps: 20}}\nnumerics: {step: 0.01}\n"
           "gauges: {f: {body: a, of: force}, all: {of: bulk_velocity}}\n",
           kind, axis);
  bw_scene *s = made(text);
  run(s);
  snprintf(name, sizeof name, "f.reaction.%c", c);
  out[0] = gauge(s, name);
  snprintf(name, sizeof name, "f.probe.%c", c);
  out[1] = gauge(s, name);
  out[2] = gauge(s, "all");
  bw_scene_destroy(&s);
}

/* What drives along y does what does along x, turned; a flow rate is kept to round-off. */
START_TEST(driven_along_any_axis)
{
  static const char *const kinds[] = {"gradient", "flow_rate"};
  for (int q = 0; q < 2; q++) {
    double x[3], y[3];
    drive("x", kinds[q], x);
    drive("y", kinds[q], y);
    ck_assert_double_gt(x[0], 0.03);
    for (int k = 0; k < 3; k++)
      bw_check_near(y[k], x[k], 1e5 * BW_REAL_EPSILON * fabs(x[0]));
    if (q == 1) bw_check_near(y[2], 0.7, 10 * BW_REAL_EPSILON);
  }
}
END_TEST

/* Between two walls across x, driven along y or z: u = g d (L - d)/(2 nu) at the end, and with
 * differences of second order g h^2/(8 nu) more, as walls are half a cell from the first points;
 * what the start has left is exp(-pi^2 nu t), 4e-6. The pressure falls by g per length. */
START_TEST(driven_between_walls)
{
  static const char *const axis[] = {"y", "z"};
  for (int q = 0; q < 2; q++) {
    char text[1024];
    snprintf(text, sizeof text,
             "domain: {length: [1, 0.5, 0.5], cells: [16, 8, 8]}\nfluid:\n  density: 2\n"
             "  viscosity: 0.5\n  forcing: {kind: gradient, axis: %s, value: 4}\n  sides:\n"
             "    x: {lower: {kind: wall}, upper: {kind: wall}}\n"
             "    y: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
             "    z: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
             "phases: {until: 2.5}\ngauges: {v: {point: [0.46875, 0.25, 0.25], of: velocity}, p: "
             "{point: [0.5, 0.4, 0.4], minus: [0.5, 0.2, 0.2], of: pressure}, all: {of: "
             "bulk_velocity}}\n",
             axis[q]);
    bw_scene *s = made(text);
    run(s);
    const double x = 0.46875, h2 = 1.0 / 256.0;
    const double right = 4.0 * x * (1.0 - x) / (2.0 * 0.5) + 4.0 * h2 / (8.0 * 0.5);
    bw_check_near(gauge(s, q == 0 ? "v.y" : "v.z"), right, 1e-5 + 1e3 * BW_REAL_EPSILON);
    bw_check_near(gauge(s, q == 0 ? "v.z" : "v.y"), 0.0, 1e3 * BW_REAL_EPSILON);
    bw_check_near(gauge(s, "p"), -2.0 * 4.0 * 0.2, 1e4 * BW_REAL_EPSILON);
    bw_check_near(gauge(s, "all"), 4.0 * (1.0 / 12.0 + h2 / 24.0 + h2 / 8.0) / 0.5,
                  1e-5 + 1e3 * BW_REAL_EPSILON);
    bw_scene_destroy(&s);
  }
  ck_assert_ptr_null(scene_of(
      "domain: {length: [1, 0.5, 0.1], cells: [16, 8, 1]}\nfluid:\n  density: 2\n  viscosity: 0.5\n"
      "  forcing: {kind: gradient, axis: z, value: 4}\n  sides:\n"
      "    x: {lower: {kind: periodic}, upper: {kind: periodic}}\n"
      "    y: {lower: {kind: wall}, upper: {kind: wall}}\nphases: {until: 1}\n"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "forcing_axis = 2"));
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(straight),
                                      BW_TEST(driven_along_any_axis),
                                      BW_TEST(driven_between_walls),
                                      BW_TEST(places),
                                      BW_TEST(driven),
                                      BW_TEST(ramp),
                                      BW_TEST(force),
                                      BW_TEST(flap),
                                      BW_TEST(a_post_leans_on_its_wall),
                                      BW_TEST(too_near),
                                      BW_TEST(ramps_beside_free_slip)};
BW_CHECK_MAIN("scene.fluid", tests)
