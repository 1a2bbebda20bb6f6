/* Shorter ways to write a value in a case file, and that they are what the long way is.
 * TEST ranks=1,3 */
#include "bw_check.h"
#include "bw_config.h"
#include "bw_memory.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  double time;
  int steps;
} until;
typedef struct {
  char name[16];
  double x[3];
  char of[32];
} item;
typedef struct {
  int n_items, n_parts;
  item items[4];
  until parts[3];
  bool has_until;
  until until;
} config;
static const bw_config_field until_fields[] = {
    BW_CONFIG_VALUE(until, time, BW_OPTIONAL, BW_ABOVE(0), "s", "when"),
    BW_CONFIG_VALUE(until, steps, BW_OPTIONAL, BW_AT_LEAST(1), "", "how many"), BW_CONFIG_END};
static const bw_config_field item_fields[] = {
    BW_CONFIG_VALUE(item, name, BW_REQUIRED, BW_ANY, "", "its name"),
    BW_CONFIG_VALUE(item, x, BW_OPTIONAL, BW_POINT, "m", "a place"),
    BW_CONFIG_VALUE(item, of, BW_OPTIONAL, BW_TEXTS, "", "what"), BW_CONFIG_END};
static const bw_config_field fields[] = {
    BW_CONFIG_NAMED(config, items, n_items, BW_OPTIONAL, item_fields, "items"),
    BW_CONFIG_LIST(config, parts, n_parts, BW_OPTIONAL, until_fields, "parts"),
    BW_CONFIG_BRIEF(config, until, has_until, until_fields, "the end"), BW_CONFIG_END};

/* A case file, and up to two --set. */
static bw_status load(const char *text, const char *set, const char *other, config *c)
{
  char path[64];
  const char *const overrides[2] = {set, other};
  snprintf(path, sizeof path, "test_core_short_np%d.yaml", bw_comm_size(bw_check_world()));
  if (bw_comm_rank(bw_check_world()) == 0) {
    FILE *out = fopen(path, "w");
    ck_assert_ptr_nonnull(out);
    fputs(text, out);
    ck_assert_int_eq(fclose(out), 0);
  }
  bw_comm_barrier(bw_check_world());
  memset(c, 0, sizeof *c);
  c->parts[0] = (until){NAN, 7};
  c->until = (until){NAN, INT_MIN};
  return bw_config_load(bw_check_world(), path, fields, (set != NULL) + (other != NULL), overrides,
                        sizeof *c, c);
}

static void expect(const char *text, const char *set, const char *piece)
{
  config c;
  bw_check_status(load(text, set, NULL, &c), BW_EINPUT);
  ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                bw_last_message());
}

START_TEST(items_by_name)
{
  config c;
  const char *text = "items:\n  tip: {x: [1, 2, 3]}\n  root:\n    of: a\n";
  bw_check_ok(load(text, NULL, NULL, &c));
  ck_assert_int_eq(c.n_items, 2);
  ck_assert_str_eq(c.items[0].name, "tip");
  ck_assert_str_eq(c.items[1].name, "root");
  ck_assert_double_eq(c.items[0].x[2], 3.0);
  /* The long way is the same. */
  bw_check_ok(load("items: [{name: tip, x: [1, 2, 3]}, {name: root, of: a}]\n", NULL, NULL, &c));
  ck_assert_str_eq(c.items[1].of, "a");
  /* An item that is there is overridden, one that is not is refused by name. */
  bw_check_ok(load(text, "items.root.of=b", "items.tip.x=[4, 5, 6]", &c));
  ck_assert_str_eq(c.items[1].of, "b");
  ck_assert_double_eq(c.items[0].x[0], 4.0);
  bw_check_ok(load("", "items.new.of=c", NULL, &c));
  ck_assert_str_eq(c.items[0].name, "new");
  expect(text, "items.stem.of=b", "'stem' must be a number from 0 to 2, or the name of an item");
}
END_TEST

START_TEST(messages_have_line_and_name)
{
  expect("items:\n  tip: {x: [1, 2, 3]}\n  root:\n    off: a\n", NULL,
         ".yaml:4: items.root.off: unknown key; did you mean items.root.of?");
  expect("items:\n  tip: {x: [1, a, 3]}\n", NULL, ".yaml:2: items.tip.x.1 = a");
  expect("items:\n  tip: {}\n  tip: {}\n", NULL, "there is another item of that name");
  expect("items:\n  tip: 3\n", NULL, ".yaml:2: items.tip.(a block of keys is needed)");
}
END_TEST

START_TEST(the_rest)
{
  config c;
  bw_check_ok(
      load("items: {a: {x: 5, of: [one, two]}, b: {x: [1, 2]}}\nuntil: 3\n", NULL, NULL, &c));
  ck_assert_double_eq(c.items[0].x[0], 5.0);
  ck_assert_double_eq(c.items[0].x[1], 0.0);
  ck_assert_double_eq(c.items[1].x[1], 2.0);
  ck_assert_double_eq(c.items[1].x[2], 0.0);
  ck_assert_str_eq(c.items[0].of, "one two");
  ck_assert(c.has_until);
  ck_assert_double_eq(c.until.time, 3.0);
  /* A block for a list of one; defaults of item 0 as ever. */
  bw_check_ok(load("parts: {time: 2}\nuntil: {steps: 4}\n", NULL, NULL, &c));
  ck_assert_int_eq(c.n_parts, 1);
  ck_assert_int_eq(c.parts[0].steps, 7);
  ck_assert_int_eq(c.until.steps, 4);
  expect("until: [3]\n", NULL, "until = a list of 1: must be a block of keys");
  expect("items: {a: {x: [1, 2, 3, 4]}}\n", NULL, "items.a.x = a list of 4");
  expect("items: {a: {of: [one, [two]]}}\n", NULL, "items.a.of = a list of 2");
}
END_TEST

/* What is printed loads back to the same. */
START_TEST(dump_and_back)
{
  config c, again;
  char *text = NULL;
  bw_check_ok(
      load("items: {a: {x: 5, of: [one, two]}}\nparts: {time: 2}\nuntil: 3\n", NULL, NULL, &c));
  bw_check_ok(bw_config_dump(fields, &c, &text));
  bw_check_ok(load(text, NULL, NULL, &again));
  ck_assert_mem_eq(&c.items[0], &again.items[0], sizeof(item));
  ck_assert_double_eq(again.until.time, 3.0);
  ck_assert_int_eq(again.n_parts, 1);
  bw_release(&text);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(items_by_name), BW_TEST(messages_have_line_and_name),
                                      BW_TEST(the_rest), BW_TEST(dump_and_back)};
BW_CHECK_MAIN("core.config_short", tests)
