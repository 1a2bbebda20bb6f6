/* Configuration: what is accepted, every kind of error message, overrides, the dump read back.
 * TEST ranks=1,3 */
#include "bw_check.h"
#include "bw_config.h"
#include "bw_file.h"
#include "bw_memory.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  double nu, rho;
  int n[3];
  bool periodic[3];
  int inflow;
} fluid_config;
typedef struct {
  double radius, x[3];
  int kind;
} shape_config;
typedef struct {
  double length;
  int count;
} probe_config;
typedef struct {
  char name[16];
  double dt, cfl, courant_limit;
  int steps;
  bool verbose;
  fluid_config fluid;
  bool has_probe, has_damping;
  probe_config probe, damping;
  int n_shapes;
  shape_config shapes[3];
} config;

static const bw_config_word inflow_words[] = {{"poiseuille", 4, NULL}, {"uniform", -7, NULL}, {0}};
static const bw_config_field fluid_fields[] = {
    BW_CONFIG_VALUE(fluid_config, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
    BW_CONFIG_VALUE(fluid_config, rho, BW_OPTIONAL, BW_AT_LEAST(0.5), "kg/m3", "density"),
    BW_CONFIG_VALUE(fluid_config, n, BW_REQUIRED, BW_FROM_TO(1, 4096), "", "cells in x, y, z"),
    BW_CONFIG_VALUE(fluid_config, periodic, BW_OPTIONAL, BW_ANY, "", "periodic directions"),
    BW_CONFIG_WORD(fluid_config, inflow, BW_OPTIONAL, inflow_words, "profile at x = 0"),
    BW_CONFIG_END};
static const bw_config_field shape_fields[] = {
    BW_CONFIG_VALUE(shape_config, radius, BW_REQUIRED, BW_BETWEEN(0, 2), "m", "radius"),
    BW_CONFIG_VALUE(shape_config, x, BW_OPTIONAL, BW_ANY, "m", "centre"),
    BW_CONFIG_WORD(shape_config, kind, BW_OPTIONAL, inflow_words, "kind"), BW_CONFIG_END};
static const bw_config_field probe_fields[] = {
    BW_CONFIG_VALUE(probe_config, length, BW_REQUIRED, BW_ABOVE(0), "m", "probe length"),
    BW_CONFIG_VALUE(probe_config, count, BW_OPTIONAL, BW_AT_MOST(9), "", "points"), BW_CONFIG_END};
static const bw_config_field fields[] = {
    BW_CONFIG_VALUE(config, name, BW_REQUIRED, BW_ANY, "", "name of the run"),
    BW_CONFIG_VALUE(config, dt, BW_OPTIONAL, BW_ABOVE(0), "s", "time step"),
    BW_CONFIG_VALUE(config, cfl, BW_OPTIONAL, BW_ABOVE_TO(0, 1), "", "CFL number"),
    BW_CONFIG_VALUE(config, courant_limit, BW_OPTIONAL, BW_BELOW(2), "", "limit"),
    BW_CONFIG_VALUE(config, steps, BW_REQUIRED, BW_AT_LEAST(0), "", "time steps"),
    BW_CONFIG_VALUE(config, verbose, BW_OPTIONAL, BW_ANY, "", "say more"),
    BW_CONFIG_MAP(config, fluid, fluid_fields, "the fluid"),
    BW_CONFIG_MAP_IF(config, probe, has_probe, probe_fields, "normal probes"),
    BW_CONFIG_MAP_IF(config, damping, has_damping, probe_fields, "on by default"),
    BW_CONFIG_LIST(config, shapes, n_shapes, BW_REQUIRED, shape_fields, "the solid"),
    BW_CONFIG_END};

/* Plain bytes are compared below: no padding garbage. */
static config defaults(void)
{
  config c;
  memset(&c, 0, sizeof c);
  c.dt = NAN;
  c.cfl = 0.5;
  c.courant_limit = 1.0;
  c.steps = INT_MIN;
  c.fluid.nu = NAN;
  c.fluid.rho = 1000.0;
  c.fluid.n[0] = c.fluid.n[1] = c.fluid.n[2] = INT_MIN;
  c.fluid.periodic[2] = true;
  c.fluid.inflow = 4;
  c.probe.length = NAN;
  c.probe.count = 3;
  c.has_damping = true;
  c.damping.length = 0.25;
  c.shapes[0].radius = NAN;
  c.shapes[0].x[1] = 0.75;
  c.shapes[0].kind = -7;
  return c;
}

static const char good[] = "# a comment\n"
                           "name: tube\n"
                           "steps: 1e3\n"
                           "fluid:\n"
                           "  nu: 1.5e-3\n"
                           "  n: [8, 16, 1]\n"
                           "shapes:\n"
                           "  - radius: 0.1\n"
                           "  - {radius: 0.3, x: [1, -2.5, .5], kind: poiseuille}\n";

/* Load `text` with overrides; the file name is the same in all messages. */
static bw_status load(const char *text, int n, const char *const overrides[], config *c)
{
  char path[64];
  snprintf(path, sizeof path, "test_core_config_np%d.yaml", bw_comm_size(bw_check_world()));
  bw_check_ok(bw_file_write_text(bw_check_world(), path, text));
  return bw_config_load(bw_check_world(), path, fields, n, overrides, sizeof *c, c);
}

/* `text` fails, and its message has all the given pieces; nothing is changed. */
static void expect_pieces(const char *text, int n, const char *const overrides[],
                          const char *const pieces[])
{
  config c = defaults();
  const config before = c;
  const bw_status st = load(text, n, overrides, &c);
  ck_assert_msg(st == BW_EINPUT, "accepted: %s", text);
  for (int q = 0; pieces[q] != NULL; q++)
    ck_assert_msg(strstr(bw_last_message(), pieces[q]) != NULL, "'%s' not in: %s", pieces[q],
                  bw_last_message());
  ck_assert_int_eq(memcmp(&c, &before, sizeof c), 0);
}
#define EXPECT(text, ...) expect_pieces(text, 0, NULL, (const char *const[]){__VA_ARGS__, NULL})
#define EXPECT_SET(set, ...)                                                                       \
  expect_pieces(good, 1, (const char *const[]){set}, (const char *const[]){__VA_ARGS__, NULL})

START_TEST(values_and_defaults)
{
  config c = defaults();
  bw_check_ok(load(good, 0, NULL, &c));
  ck_assert_str_eq(c.name, "tube");
  ck_assert_int_eq(c.steps, 1000);
  ck_assert(isnan(c.dt));
  ck_assert_double_eq(c.cfl, 0.5);
  ck_assert_double_eq(c.fluid.nu, 1.5e-3);
  ck_assert_double_eq(c.fluid.rho, 1000.0);
  ck_assert(c.fluid.n[0] == 8 && c.fluid.n[1] == 16 && c.fluid.n[2] == 1);
  ck_assert(!c.fluid.periodic[0] && c.fluid.periodic[2]);
  ck_assert_int_eq(c.fluid.inflow, 4);
  ck_assert(!c.has_probe && c.has_damping);
  ck_assert_double_eq(c.damping.length, 0.25);
  ck_assert_int_eq(c.n_shapes, 2);
  ck_assert_double_eq(c.shapes[0].radius, 0.1);
  ck_assert_double_eq(c.shapes[0].x[1], 0.75); /* the default of item 0 ... */
  ck_assert_int_eq(c.shapes[0].kind, -7);
  ck_assert_double_eq(c.shapes[1].x[0], 1.0);
  ck_assert_double_eq(c.shapes[1].x[1], -2.5);
  ck_assert_double_eq(c.shapes[1].x[2], 0.5);
  ck_assert_int_eq(c.shapes[1].kind, 4);

  char more[1024];
  snprintf(more, sizeof more, "%s  - radius: 1\nverbose: Yes\nprobe: {length: 2}\ndamping: none\n",
           good);
  c = defaults();
  bw_check_ok(load(more, 0, NULL, &c));
  ck_assert_int_eq(c.n_shapes, 3);
  ck_assert_int_eq(c.shapes[2].kind, -7);
  ck_assert_double_eq(c.shapes[2].x[1], 0.75); /* ... is that of every item */
  ck_assert(c.verbose && c.has_probe && !c.has_damping);
  ck_assert_double_eq(c.probe.length, 2.0);
  ck_assert_int_eq(c.probe.count, 3);

  c = defaults();
  bw_check_ok(load("name: a\nsteps: 0\nfluid: {nu: 1, n: [1, 1, 1]}\n"
                   "shapes: [{radius: 1, x: [9, 9, 9], kind: poiseuille}, {radius: 0.5}]\n",
                   0, NULL, &c));
  ck_assert_double_eq(c.shapes[0].x[1], 9.0);
  ck_assert_double_eq(c.shapes[1].x[1], 0.75); /* the defaults, not what item 0 was given */
  ck_assert_int_eq(c.shapes[1].kind, -7);
}
END_TEST

START_TEST(overrides_change_and_add)
{
  static const char *const sets[] = {"fluid.nu=3e-3",
                                     "shapes.0.radius=0.7",
                                     "shapes.2.radius=0.9",
                                     "fluid.periodic=[true, false, false]",
                                     "probe.length=4",
                                     "fluid.n.1=32",
                                     "name=a b",
                                     "damping=none",
                                     "dt=1e-4",
                                     "dt=2e-4",
                                     "fluid.inflow=uniform"};
  config c = defaults();
  bw_check_ok(load(good, sizeof sets / sizeof *sets, sets, &c));
  ck_assert_double_eq(c.fluid.nu, 3e-3);
  ck_assert_double_eq(c.shapes[0].radius, 0.7);
  ck_assert_int_eq(c.n_shapes, 3);
  ck_assert_double_eq(c.shapes[2].radius, 0.9);
  ck_assert_double_eq(c.shapes[2].x[1], 0.75);
  ck_assert(c.fluid.periodic[0] && !c.fluid.periodic[1] && !c.fluid.periodic[2]);
  ck_assert(c.has_probe && !c.has_damping);
  ck_assert_double_eq(c.probe.length, 4.0);
  ck_assert(c.fluid.n[0] == 8 && c.fluid.n[1] == 32 && c.fluid.n[2] == 1);
  ck_assert_str_eq(c.name, "a b");
  ck_assert_double_eq(c.dt, 2e-4); /* the last one counts */
  ck_assert_int_eq(c.fluid.inflow, -7);

  static const char *const all[] = {"name=x", "steps=1", "fluid.nu=1", "fluid.n=[1, 2, 3]",
                                    "shapes.0.radius=1"};
  c = defaults();
  bw_check_ok(bw_config_load(bw_check_world(), NULL, fields, 5, all, sizeof c, &c));
  ck_assert_int_eq(c.n_shapes, 1);
  ck_assert_int_eq(c.fluid.n[2], 3);
}
END_TEST

START_TEST(wrong_overrides_name_themselves)
{
  EXPECT_SET("fluid.nu=-1", "--set fluid.nu=-1: fluid.nu = -1: must be > 0", "[m2/s]");
  EXPECT_SET("fluid.nuu=1", "--set fluid.nuu=1: fluid.nuu: unknown key; did you mean fluid.nu?");
  EXPECT_SET("nu=1", "--set nu=1: nu: unknown key; did you mean fluid.nu?");
  EXPECT_SET("fluid.nu", "--set fluid.nu: write it as --set key.path=value");
  EXPECT_SET("=1", "write it as --set key.path=value");
  EXPECT_SET("fluid.nu.x=1", "--set fluid.nu.x=1: fluid.nu is a value, it has no key 'x'");
  EXPECT_SET("shapes.5.radius=1", "shapes is a list of 2 items: '5' must be a number from 0 to 2");
  EXPECT_SET("shapes.a.radius=1", "'a' must be a number");
  EXPECT_SET("fluid..nu=1", "empty key");
  EXPECT_SET("fluid.n=[1, 2", "--set fluid.n=[1, 2", "not YAML");
  EXPECT_SET("steps=", "--set steps=: steps = nothing: must be a whole number");
}
END_TEST

START_TEST(unknown_keys_get_a_suggestion)
{
  EXPECT("nmae: tube\nsteps: 1\n", ".yaml:1: nmae: unknown key; did you mean name?",
         "name is missing");
  EXPECT("name: a\nfluid:\n  nu: 1\n  peridoic: [true, true, true]\n",
         ".yaml:4: fluid.peridoic: unknown key; did you mean fluid.periodic?");
  EXPECT("name: a\nradius: 2\n", ".yaml:2: radius: unknown key; did you mean shapes.0.radius?");
  EXPECT("fluid: {temperature: 3}\n",
         "fluid.temperature: unknown key; known here: nu, rho, n, periodic, inflow");
  EXPECT("shapes:\n  - radius: 1\n  - raduis: 2\n",
         ".yaml:3: shapes.1.raduis: unknown key; did you mean shapes.1.radius?",
         ".yaml:3: shapes.1.radius is missing");
  EXPECT("name: a\nsteps: 2\nname: b\n", ".yaml:3: name: given twice, first at ", ".yaml:1");
}
END_TEST

START_TEST(wrong_types_and_ranges)
{
  EXPECT("fluid:\n\n  nu: -0.001\n",
         ".yaml:3: fluid.nu = -0.001: must be > 0 (kinematic viscosity [m2/s])");
  EXPECT("fluid:\n  nu: fast\n",
         ".yaml:2: fluid.nu = fast: must be a number > 0 (kinematic viscosity [m2/s])");
  EXPECT("fluid:\n  nu: 1.0f\n", "fluid.nu = 1.0f: must be a number");
  EXPECT("fluid:\n  nu: .nan\n", "fluid.nu = .nan: must be a number");
  EXPECT("fluid:\n  nu: 1e999\n", "fluid.nu = 1e999: must be a number");
  EXPECT("fluid:\n  nu: 1-2\n", "fluid.nu = 1-2: must be a number");
  EXPECT("fluid:\n  nu: {a: 1}\n", "fluid.nu = a block: must be a number");
  EXPECT("fluid:\n  nu: [1]\n", "fluid.nu = a list of 1: must be a number");
  EXPECT("fluid:\n  nu:\n", "fluid.nu = nothing: must be a number");
  EXPECT("fluid:\n  nu: 0\n", "fluid.nu = 0: must be > 0");
  EXPECT("fluid:\n  rho: 0.4\n", "fluid.rho = 0.4: must be >= 0.5 (density [kg/m3])");
  EXPECT("fluid:\n  n: [8, 0, 1]\n", "fluid.n.1 = 0: must be >= 1 and <= 4096");
  EXPECT("fluid:\n  n: [8, 4097, 1]\n", "fluid.n.1 = 4097: must be >= 1 and <= 4096");
  EXPECT("fluid:\n  n: [8, 1.5, 1]\n", "fluid.n.1 = 1.5: must be", "whole number");
  EXPECT("fluid:\n  n: [8, 1]\n", "fluid.n = a list of 2: must be a list of 3 whole numbers");
  EXPECT("fluid:\n  n: 8\n", "fluid.n = 8: must be a list of 3 whole numbers");
  EXPECT("cfl: 1.1\n", "cfl = 1.1: must be > 0 and <= 1 (CFL number)");
  EXPECT("cfl: 0\n", "cfl = 0: must be > 0 and <= 1");
  EXPECT("courant_limit: 2\n", "courant_limit = 2: must be < 2");
  EXPECT("probe: {length: 1, count: 10}\n", "probe.count = 10: must be <= 9");
  EXPECT("steps: 3000000000\n", "steps = 3000000000: too large");
  EXPECT("verbose: 3\n", "verbose = 3: must be true or false (say more)");
  EXPECT("fluid: {inflow: unifrom}\n",
         "fluid.inflow = unifrom: must be one of poiseuille, uniform; did you mean uniform?");
  EXPECT("fluid: {inflow: plug}\n", "fluid.inflow = plug: must be one of poiseuille, uniform");
  EXPECT("fluid: 3\n", "fluid = 3: must be a block of keys (the fluid)");
  EXPECT("name: sixteen_letters_\n", "name: must be a text of at most 15 bytes, 16 are given");
  EXPECT("shapes: 3\n", "shapes = 3: must be a list of blocks (the solid)");
  EXPECT("shapes: [3]\n", "shapes.0: must be a block of keys");
  EXPECT("shapes: []\n", "shapes: at least one item is needed (the solid)");
  EXPECT("shapes: [{radius: 1}, {radius: 1}, {radius: 1}, {radius: 1}]\n",
         "shapes: at most 3 items, 4 are given (the solid)");
  EXPECT("shapes: [{radius: 2}]\n", "shapes.0.radius = 2: must be > 0 and < 2 (radius [m])");
}
END_TEST

START_TEST(missing_values_are_named)
{
  EXPECT("name: a\nsteps: 1\nfluid:\n  nu: 1\n",
         ".yaml:3: fluid.n is missing: give a list of 3 whole numbers >= 1 and <= 4096 (cells in ",
         "shapes is missing: give a list of blocks (the solid)");
  EXPECT("name: a\n", "fluid.nu is missing", "fluid.n is missing", "steps is missing");
  EXPECT("name: a\nprobe:\n", ".yaml:2: probe.length is missing: give a number > 0 (probe length");
  EXPECT("", "name is missing: give a text (name of the run)");
  EXPECT("name: ''\n", "name = nothing: must be a text");
  EXPECT("shapes:\n- x: [0, 0, 0]\n", ".yaml:2: shapes.0.radius is missing");
}
END_TEST

START_TEST(broken_files)
{
  EXPECT("name: [a\nsteps: 1\n", ".yaml:2: not YAML", "while parsing");
  EXPECT("name: a\n\tsteps: 1\n", ".yaml:2: not YAML");
  EXPECT("- a\n- b\n", "the file must hold 'key: value' lines");
  EXPECT("name: a\n---\nname: b\n", ".yaml:3: a second YAML document begins");
  config c = defaults();
  bw_check_status(bw_config_load(bw_check_world(), "no_such.yaml", fields, 0, NULL, sizeof c, &c),
                  BW_EIO);
  ck_assert_str_eq(bw_last_message(), "cannot read no_such.yaml: No such file or directory");
}
END_TEST

/* Many problems: as many whole lines as fit, then how many more there are. */
START_TEST(all_problems_are_listed)
{
  char *text = NULL;
  const int n = 200;
  bw_check_ok(BW_ALLOCATE(&text, 40 * (size_t)n));
  for (int q = 0, at = 0; q < n; q++)
    at += sprintf(text + at, "unknown_key_number_%03d: 1\n", q);
  config c = defaults();
  bw_check_status(load(text, 0, NULL, &c), BW_EINPUT);
  int lines = 1, more = 0;
  const char *end = bw_last_message(), *next;
  while ((next = strchr(end, '\n')) != NULL) {
    lines++;
    end = next + 1;
  }
  ck_assert_int_eq(sscanf(end, "(and %d more)", &more), 1);
  ck_assert_int_gt(lines, 10);
  ck_assert_int_eq(lines - 1 + more, n + 5); /* and 5 missing: name, steps, nu, n, shapes */
  bw_release(&text);
}
END_TEST

/* Values that only 17 digits give back, odd texts, none, empty: dump and load are inverse. */
START_TEST(the_dump_loads_back)
{
  static const char *const sets[] = {"fluid.nu=0.1",
                                     "fluid.rho=1000.0000000000001",
                                     "name=\"a: \\\"b\\\" #\\n\\\\\"",
                                     "probe.length=1e-49",
                                     "damping=none",
                                     "shapes.0.x=[1e49, -0.3333333333333333, 2e-5]"};
  config c = defaults(), again = defaults(), third = defaults();
  char *text = NULL, *text_again = NULL;
  bw_check_ok(load(good, sizeof sets / sizeof *sets, sets, &c));
  bw_check_ok(bw_config_dump(fields, &c, &text));
  bw_check_ok(load(text, 0, NULL, &again));
  ck_assert_int_eq(memcmp(&c, &again, sizeof c), 0);
  ck_assert_str_eq(c.name, "a: \"b\" #\n\\");
  bw_check_ok(bw_config_dump(fields, &again, &text_again));
  ck_assert_str_eq(text, text_again);
  ck_assert_ptr_nonnull(strstr(text, "rho: 1000.0000000000001"));
  ck_assert_ptr_nonnull(strstr(text, "damping: none"));
  ck_assert_ptr_null(strstr(text, "dt:")); /* not set */

  char record[4096]; /* a run.yaml has one more block, which is ignored */
  snprintf(record, sizeof record, "%srun:\n  version: 1\n", text);
  bw_check_ok(load(record, 0, NULL, &third));
  ck_assert_int_eq(memcmp(&c, &third, sizeof c), 0);
  bw_release(&text);
  bw_release(&text_again);
}
END_TEST

START_TEST(help_names_every_key)
{
  static const char *const keys[] = {"  name ",         "  fluid.nu ",
                                     "  fluid.n ",      "  shapes.N.radius ",
                                     "  probe.length ", "kinematic viscosity [m2/s]",
                                     "default 1000",    "required"};
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  const config c = defaults();
  bw_config_help(fields, &c, out);
  fclose(out);
  /* A block has no default of its own. */
  const char *block = strstr(text, "  fluid ");
  ck_assert_ptr_nonnull(block);
  ck_assert_uint_lt(strcspn(block, "\n"), strcspn(block, ";"));
  for (size_t q = 0; q < sizeof keys / sizeof *keys; q++)
    ck_assert_msg(strstr(text, keys[q]) != NULL, "'%s' not in:\n%s", keys[q], text);
  free(text);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(values_and_defaults),
                                      BW_TEST(overrides_change_and_add),
                                      BW_TEST(wrong_overrides_name_themselves),
                                      BW_TEST(unknown_keys_get_a_suggestion),
                                      BW_TEST(wrong_types_and_ranges),
                                      BW_TEST(missing_values_are_named),
                                      BW_TEST(broken_files),
                                      BW_TEST(all_problems_are_listed),
                                      BW_TEST(the_dump_loads_back),
                                      BW_TEST(help_names_every_key)};
BW_CHECK_MAIN("core.config", tests)
