/* Only what is required: eight scenes, and what each of them makes and calls. No step of any of
 * them leaves memory behind.
 * TEST ranks=1 */
#include "scene_text.h"

#include <malloc.h>

#define SOLID                                                                                      \
  "plane: strain\nmaterials: {m: {density: 3, young_modulus: 100, fracture_energy: 1}}\n"
#define FLUID                                                                                      \
  "domain: {length: [2, 1, 0.0625], cells: [32, 16, 1]}\n"                                         \
  "fluid:\n  density: 1\n  viscosity: 0.05\n  start: {developed: true}\n  sides:\n"                \
  "    x: {lower: {kind: inflow, profile: poiseuille, mean: 1}, upper: {kind: outflow}}\n"         \
  "    y: {lower: {kind: wall}, upper: {kind: wall}}\n"
#define WATER                                                                                      \
  "domain: {length: [1, 1, 1], cells: [20, 20, 1]}\ngravity: [0, -10]\nfluid:\n"                   \
  "  model: particles\n  density: 1000\n  viscosity: 1.0e-6\n"                                     \
  "  shape: {box: {from: [0, 0], to: [1, 0.5]}}\n"
#define BALL "  ball: {shape: {sphere: {centre: [1, 0.5], radius: 0.2}}, motion: fixed}\n"

typedef struct {
  const char *text;
  int solids;
  bool assembly, contact, fluid, markers, probe, coupler, box, interface;
  bool water; /* a fluid of particles */
} scene_case;

static const scene_case cases[] = {
    {"plane: strain\nmaterials: {m: {density: 3, young_modulus: 100}}\n"
     "bodies: {a: {shape: {box: {from: [0, 0], to: [1, 1]}}, material: m, motion: elastic, "
     "spacing: "
     "0.1}}\nphases: {until: {steps: 30}}\n",
     1, false, false, false, false, false, false, false, false, .water = false},
    {SOLID
     "bodies:\n  a: {shape: {box: {from: [0, 0], to: [1, 1]}}, material: m, motion: breakable, "
     "spacing: 0.1}\n"
     "  b: {shape: {box: {from: [3, 0], to: [4, 1]}}, motion: fixed, spacing: 0.1}\n"
     "phases: {until: {steps: 30}}\ngauges: {n: {of: fragments}}\n",
     2, true, true, false, false, false, false, false, true, .water = false},
    {FLUID "phases: {until: {steps: 10}}\n", 0, false, false, true, false, false, false, false,
     false, .water = false},
    {FLUID "bodies:\n" BALL "phases: {until: {steps: 10}}\n", 0, false, false, true, true, false,
     false, false, false, .water = false},
    {FLUID "bodies:\n" BALL "phases: {until: {steps: 10}}\ngauges: {f: {body: ball, of: force}}\n",
     0, false, false, true, true, true, false, true, false, .water = false},
    {FLUID
     "materials: {m: {density: 30, young_modulus: 1000}}\nbodies:\n"
     "  ball: {shape: {sphere: {centre: [1, 0.5], radius: 0.2}}, material: m, motion: elastic}\n"
     "phases: {until: {steps: 10}}\n",
     1, false, false, true, false, false, true, false, false, .water = false},
    {WATER "phases: {until: {steps: 10}}\n", 0, .water = true},
    {WATER "materials: {m: {density: 2000, young_modulus: 1.0e7}}\nbodies:\n"
           "  a: {shape: {box: {from: [0.4, 0.1], to: [0.6, 0.3]}}, material: m, motion: elastic}\n"
           "phases: {until: {steps: 10}}\n",
     1, .water = true}};

static size_t in_use(void)
{
  const struct mallinfo2 m = mallinfo2();
  return m.uordblks + m.hblkhd;
}

/* Some part of the fluid's momentum is balanced in a box. */
static bool watches_box(bw_scene *s)
{
  double force[3] = {0};
  if (s->fluid != NULL) bw_ns_channel_control_volume(s->fluid, force);
  return force[0] != 0.0;
}

static void check(const scene_case *c)
{
  bw_scene *s = made(c->text);
  bool contact = false;
  ck_assert_int_eq(s->n_solids, c->solids);
  for (int q = 0; q < s->n_solids; q++)
    contact = contact || bw_solid_settings(s->solid[q].solid)->contact;
  ck_assert(contact == c->contact);
  ck_assert((s->assembly != NULL) == c->assembly);
  ck_assert((s->grid != NULL) == c->fluid && (s->fluid != NULL) == c->fluid);
  ck_assert((s->markers != NULL) == c->markers);
  ck_assert((s->probe != NULL) == c->probe && (s->wall.n > 0) == c->probe);
  ck_assert((s->coupler != NULL) == c->coupler);
  ck_assert((s->water != NULL) == c->water);
  ck_assert(s->water == NULL || (s->water->both != NULL) == (c->solids > 0));
  /* The first steps fill what is filled once; then nothing is left behind. */
  for (int q = 0; q < 3; q++)
    bw_check_ok(bw_scene_step(s, INFINITY));
  double row[64];
  ck_assert_int_le(s->n_columns, 64);
  bw_check_ok(bw_scene_measure(s, row));
  ck_assert((s->interface[0] != NULL) == c->interface);
  ck_assert(watches_box(s) == c->box);
  const size_t before = in_use();
  const int64_t first = bw_scene_steps(s);
  /* Before its first step a coupler has measured what holds. */
  const long so_far = s->fluid != NULL ? bw_ns_channel_cost(s->fluid).substeps : 0;
  while (!bw_scene_done(s))
    bw_check_ok(bw_scene_step(s, INFINITY));
  ck_assert_uint_eq(in_use(), before);
  ck_assert_int_ge(bw_scene_steps(s) - first, 7);
  /* Three sub-steps of the fluid each, and none without one. */
  const long substeps = s->fluid != NULL ? bw_ns_channel_cost(s->fluid).substeps : 0;
  ck_assert_int_eq(substeps - so_far, s->fluid != NULL ? 3 * (bw_scene_steps(s) - first) : 0);
  bw_scene_destroy(&s);
}

START_TEST(all_scenes)
{
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++)
    check(&cases[q]);
}
END_TEST

/* The list says what is there. */
START_TEST(list)
{
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_scene *s = made(cases[q].text);
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    ck_assert_ptr_nonnull(out);
    bw_scene_blocks(s, out);
    fclose(out);
    ck_assert((strstr(text, "runs fluid, pressure") != NULL) == cases[q].fluid);
    ck_assert((strstr(text, "runs fluid of particles") != NULL) == cases[q].water);
    ck_assert((strstr(text, "runs loads by particles") != NULL) ==
              (cases[q].water && cases[q].solids > 0));
    ck_assert((strstr(text, "runs particles") != NULL) == (cases[q].solids > 0));
    ck_assert((strstr(text, "runs contact") != NULL) == (cases[q].contact || cases[q].assembly));
    ck_assert((strstr(text, "runs fragments") != NULL) == cases[q].interface);
    ck_assert((strstr(text, "runs momentum balance") != NULL) == cases[q].box);
    bw_release(&text);
    bw_scene_destroy(&s);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(all_scenes), BW_TEST(list)};
BW_CHECK_MAIN("scene.blocks", tests)
