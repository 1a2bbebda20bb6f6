/* What a text of a case file may be: its bytes, the sizes of its numbers, the files that it names.
 * TEST ranks=1,3 */
#include "bw_check.h"
#include "bw_config.h"
#include "bw_file.h"
#include "bw_folder.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  char name[16], image[1024];
  double nu, x[2];
  int steps;
} config;
static const bw_config_field fields[] = {
    BW_CONFIG_VALUE(config, name, BW_OPTIONAL, BW_ANY, "", "name of the run"),
    BW_CONFIG_VALUE(config, image, BW_OPTIONAL, BW_FILE, "", "voxels"),
    BW_CONFIG_VALUE(config, nu, BW_OPTIONAL, BW_ANY, "m2/s", "viscosity"),
    BW_CONFIG_VALUE(config, x, BW_OPTIONAL, BW_ANY, "m", "place"),
    BW_CONFIG_VALUE(config, steps, BW_OPTIONAL, BW_ANY, "", "time steps"),
    BW_CONFIG_END};

/* A case file of n bytes, and a --set (or NULL). */
static bw_status load(const char *bytes, size_t n, const char *set, config *c)
{
  char path[64];
  snprintf(path, sizeof path, "test_core_texts_np%d.yaml", bw_comm_size(bw_check_world()));
  if (bw_comm_rank(bw_check_world()) == 0) {
    FILE *out = fopen(path, "wb");
    ck_assert_ptr_nonnull(out);
    ck_assert_uint_eq(fwrite(bytes, 1, n, out), n);
    ck_assert_int_eq(fclose(out), 0);
  }
  bw_comm_barrier(bw_check_world());
  *c = (config){.name = "", .nu = 7.0};
  return bw_config_load(bw_check_world(), path, fields, set != NULL, &set, sizeof *c, c);
}

static void expect(const char *bytes, size_t n, const char *set, const char *piece)
{
  config c;
  bw_check_status(load(bytes, n, set, &c), BW_EINPUT);
  ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                bw_last_message());
}
#define EXPECT(text, piece) expect(text, sizeof(text) - 1, NULL, piece)
#define LOAD(text, c)       load(text, sizeof(text) - 1, NULL, c)

/* No product of numbers that are accepted leaves what a double holds, and no count what an int
 * holds. */
START_TEST(sizes_that_cannot_be_meant)
{
  config c;
  EXPECT("nu: 1e-300\n", "nu = 1e-300: too small; 0, or in size at least 1e-50");
  EXPECT("nu: 1e300\n", "nu = 1e300: too large; in size at most 1e+50");
  EXPECT("nu: -1e51\n", "nu = -1e51: too large");
  EXPECT("nu: 1e-400\n", "nu = 1e-400: too small"); /* 0 as strtod reads it */
  EXPECT("x: [0, -1e-51]\n", "x.1 = -1e-51: too small");
  EXPECT("steps: 3000000000\n", "steps = 3000000000: too large; in size at most 2147483647");
  EXPECT("steps: 1e300\n", "steps = 1e300: too large");
  bw_check_ok(LOAD("nu: -0.000e5\nx: [1e-50, -1e50]\nsteps: 2147483647\n", &c));
  ck_assert(c.nu == 0.0 && c.x[0] == 1e-50 && c.x[1] == -1e50 && c.steps == 2147483647);
}
END_TEST

START_TEST(encodings)
{
  config c;
  EXPECT("name: tube\nsteps: 1\n\0nu: 0.1\n", ".yaml:3: a byte of 0");
  EXPECT("name: tube\nsteps: 1 # M\xfcller\n",
         ".yaml:2: the byte 0xfc is not UTF-8: save it as UTF-8");
  EXPECT("\xff\xfen\0a\0", ".yaml:1: the file is UTF-16: save it as UTF-8");
  EXPECT("\xfe\xff\0n\0a", "UTF-16");
  EXPECT("a\nb\0", ".yaml:2: a byte of 0");
  EXPECT("a: 1\n\n# \xc0\xaf\n", ".yaml:3: the byte 0xc0");
  EXPECT("# \xe2\x82", "0xe2"); /* cut inside a letter */
  EXPECT("name: a\nnu: \x01\n", ".yaml:2: not YAML: control characters");
  expect("", 0, "name=M\xfcller", "0xfc is not UTF-8");
  bw_check_ok(LOAD("\xef\xbb\xbfname: M\xc3\xbcller # \xe2\x82\xac \xf0\x9f\x8c\x8a\n", &c));
  ck_assert_str_eq(c.name, "M\xc3\xbcller");
}
END_TEST

static void expect_file(const char *yaml, const char *set, const char *expected)
{
  config c = {.name = ""};
  bw_check_ok(bw_config_load(bw_check_world(), yaml, fields, set != NULL, &set, sizeof c, &c));
  ck_assert_str_eq(c.image, expected);
}

START_TEST(files_are_looked_for_beside_the_case)
{
  const bw_comm *comm = bw_check_world();
  char here[512], beside[1024], below[1024], yaml[128], folder[64];
  ck_assert_ptr_nonnull(getcwd(here, sizeof here));
  snprintf(folder, sizeof folder, "test_core_files_np%d", bw_comm_size(comm));
  snprintf(yaml, sizeof yaml, "%s/case.yaml", folder);
  snprintf(beside, sizeof beside, "%s/%s/a.nrrd", here, folder);
  snprintf(below, sizeof below, "%s/test_core_b.nrrd", here);
  bw_check_ok(bw_folder_make(comm, folder));
  bw_check_ok(bw_file_write_text(comm, yaml, "image: a.nrrd\n"));
  bw_check_ok(bw_file_write_text(comm, "test_core_b.nrrd", "here"));
  /* Neither there: it is reported where it was looked for first. */
  expect_file(yaml, NULL, beside);
  bw_check_ok(bw_file_write_text(comm, beside, "voxels"));
  expect_file(yaml, NULL, beside);
  /* What is typed is where the user stands; a path from the root stays. */
  expect_file(yaml, "image=test_core_b.nrrd", below);
  expect_file(yaml, "image=/no/such", "/no/such");
  expect_file(yaml, "image=", "");
  bw_check_ok(bw_file_write_text(comm, yaml, "image: test_core_b.nrrd\n"));
  expect_file(yaml, NULL, below);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(sizes_that_cannot_be_meant), BW_TEST(encodings),
                                      BW_TEST(files_are_looked_for_beside_the_case)};
BW_CHECK_MAIN("core.config_texts", tests)
