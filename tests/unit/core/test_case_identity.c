/* A restart is the same run: whose a checkpoint is, what may differ, what is refused.
 * TEST ranks=1,2 */
#include "case_test.h"

typedef struct {
  double centre[2], radius;
} ball;
typedef struct {
  double density;
  char image[256];
} body;
typedef struct {
  double nu, end;
  bool has_body;
  body body;
  int n_balls;
  ball balls[4];
} scene;
static const bw_config_field ball_fields[] = {
    BW_CONFIG_VALUE(ball, centre, BW_REQUIRED, BW_ANY, "m", "middle"),
    BW_CONFIG_VALUE(ball, radius, BW_OPTIONAL, BW_ABOVE(0), "m", "radius"), BW_CONFIG_END};
static const bw_config_field body_fields[] = {
    BW_CONFIG_VALUE(body, density, BW_OPTIONAL, BW_ABOVE(0), "kg/m3", "density"),
    BW_CONFIG_VALUE(body, image, BW_OPTIONAL, BW_FILE, "", "voxels"), BW_CONFIG_END};
static const bw_config_field scene_fields[] = {
    BW_CONFIG_VALUE(scene, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
    BW_CONFIG_VALUE(scene, end, BW_REQUIRED | BW_MAY_CHANGE, BW_ABOVE(0), "s", "end of the run"),
    BW_CONFIG_MAP_IF(scene, body, has_body, body_fields, "a body"),
    BW_CONFIG_LIST(scene, balls, n_balls, BW_OPTIONAL, ball_fields, "balls"), BW_CONFIG_END};
static const bw_case_about scene_case = {"scene", "a scene", scene_fields, sizeof(scene),
                                         read_text};

/* A run of scene_case on `file` with two words more (NULL: none). */
static bw_status begin_scene(const char *file, const char *word, const char *value, bw_case **run)
{
  char *argv[8] = {(char *)"scene"};
  static char copy[8][300];
  const char *const words[] = {file, "--check", "--quiet", word, value};
  int argc = 1;
  for (int q = 0; q < 5; q++) {
    if (words[q] == NULL) continue;
    snprintf(copy[argc], sizeof copy[argc], "%s", words[q]);
    argv[argc] = copy[argc];
    argc++;
  }
  scene s = {.nu = NAN, .end = NAN, .body.density = 1.0};
  s.balls[0] = (ball){.centre = {NAN, NAN}, .radius = 0.5};
  return bw_case_begin(bw_check_world(), argc, argv, &scene_case, &s, run);
}

/* A checkpoint as a run of `yaml` would write it. */
static void write_checkpoint(const char *yaml_text, char checkpoint[200])
{
  const bw_comm *comm = bw_check_world();
  char yaml[200], text[4096];
  bw_case *run = NULL;
  in_base("before.yaml", yaml);
  in_base("before.h5", checkpoint);
  bw_check_ok(bw_file_write_text(comm, yaml, yaml_text));
  bw_check_ok(begin_scene(yaml, NULL, NULL, &run));
  snprintf(text, sizeof text, "%s\n%s", bw_case_program(run), bw_case_parameters(run));
  bw_check_ok(bw_file_write_text(comm, checkpoint, text));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
}

/* The run of `yaml_text` from there: refused with `piece`, or not (NULL). */
static void go_on(const char *yaml_text, const char *checkpoint, const char *piece)
{
  const bw_comm *comm = bw_check_world();
  char yaml[200];
  bw_case *run = NULL;
  in_base("after.yaml", yaml);
  bw_check_ok(bw_file_write_text(comm, yaml, yaml_text));
  const bw_status st = begin_scene(yaml, "--restart", checkpoint, &run);
  if (piece == NULL) {
    bw_check_ok(st);
  } else {
    bw_check_status(st, BW_EINPUT);
    ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                  bw_last_message());
    ck_assert_ptr_nonnull(strstr(bw_last_message(), checkpoint));
  }
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
}

START_TEST(every_difference_is_refused_with_both_values)
{
  static const struct {
    const char *before, *after, *piece;
  } pairs[] = {
      {"nu: 0.1\nend: 2\n", "nu: 0.1\nend: 2\n", NULL},
      {"nu: 0.1\nend: 2\n", "nu: 1e-1\nend: 2.0\nbody: none\nballs: []\n", NULL},
      {"nu: 0.1\nend: 2\n", "nu: 0.2\nend: 2\n", "nu is 0.2, was 0.1 in the run that wrote it"},
      {"nu: 0.1\nend: 2\n", "nu: 0.10000000000000002\nend: 2\n", "nu is 0.10000000000000002, was"},
      {"nu: 0.1\nend: 2\n", "nu: 0.1\nend: 2\nbody: {}\n", "body is given, was none"},
      {"nu: 0.1\nend: 2\nbody: {density: 3}\n", "nu: 0.1\nend: 2\n", "body is none, was given"},
      {"nu: 0.1\nend: 2\nbody: {density: 3}\n", "nu: 0.1\nend: 2\n",
       "body.density is not set, was 3"},
      {"nu: 0.1\nend: 2\nbody: {density: 3}\n", "nu: 0.1\nend: 2\nbody: {}\n",
       "body.density is 1, was 3"},
      {"nu: 0.1\nend: 2\nballs: [{centre: [0, 1]}]\n",
       "nu: 0.1\nend: 2\nballs: [{centre: [0, 1], radius: 0.25}]\n",
       "balls.0.radius is 0.25, was 0.5"},
      {"nu: 0.1\nend: 2\nballs: [{centre: [0, 1]}]\n",
       "nu: 0.1\nend: 2\nballs: [{centre: [0, 2]}]\n", "balls.0.centre is [0, 2], was [0, 1]"},
      {"nu: 0.1\nend: 2\nballs: [{centre: [0, 1]}]\n",
       "nu: 0.1\nend: 2\nballs: [{centre: [0, 1]}, {centre: [0, 1]}]\n",
       "balls is a list of 2, was a list of 1"}};
  char checkpoint[200];
  for (size_t q = 0; q < sizeof pairs / sizeof *pairs; q++) {
    write_checkpoint(pairs[q].before, checkpoint);
    go_on(pairs[q].after, checkpoint, pairs[q].piece);
  }
}
END_TEST

/* All differences are named at once, also many of them. */
START_TEST(several_differences)
{
  char checkpoint[200];
  write_checkpoint("nu: 0.1\nend: 2\nbody: {density: 3}\n", checkpoint);
  go_on("nu: 0.2\nend: 2\nbody: {density: 4}\n", checkpoint, "nu is 0.2");
  go_on("nu: 0.2\nend: 2\nbody: {density: 4}\n", checkpoint, "body.density is 4");
  go_on("nu: 0.2\nend: 2\nballs: [{centre: [0, 1]}, {centre: [0, 1]}, {centre: [0, 1]}, {centre: "
        "[0, 1]}]\n",
        checkpoint, "(and more)");
}
END_TEST

/* What may change is listed in run.yaml, with what it was. */
START_TEST(changes_are_listed)
{
  const bw_comm *comm = bw_check_world();
  char yaml[200], folder[200], checkpoint[220], *record = NULL, *text = NULL;
  config c;
  bw_case *run = NULL;
  case_file(yaml);
  in_base("changed", folder);
  in_base("changed.h5", checkpoint);
  bw_check_ok(bw_file_write_text(comm, checkpoint, TUBE));
  bw_check_ok(begin(
      &about, WORDS(yaml, "--out", folder, "--quiet", "--restart", checkpoint, "--set", "steps=9"),
      &c, &run));
  ck_assert_int_eq(c.steps, 9);
  bw_check_ok(bw_case_path(run, "run.yaml", &record));
  /* The end that is asked for may not lie behind the state. */
  bw_check_ok(bw_case_check_end(run, "steps", 9, 9));
  bw_check_ok(bw_case_check_end(run, "steps", 9, 8));
  bw_check_status(bw_case_check_end(run, "steps", 9, 10), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "it is at 10 already, beyond steps = 9"));
  bw_check_ok(bw_case_end(comm, &run, BW_OK));
  bw_check_ok(bw_file_read_text(comm, record, NULL, &text));
  ck_assert_ptr_nonnull(strstr(text, "  changed:\n    - \"steps is 9, was 7\"\n"));
  bw_release(&record);
  bw_release(&text);
}
END_TEST

/* The content of a file counts, not its place. */
START_TEST(files_are_compared_by_content)
{
  const bw_comm *comm = bw_check_world();
  char first[200], second[200], longer[200], yaml[700], checkpoint[200];
  in_base("first.nrrd", first);
  in_base("second.nrrd", second);
  in_base("longer.nrrd", longer);
  bw_check_ok(bw_file_write_text(comm, first, "voxels (1)"));
  bw_check_ok(bw_file_write_text(comm, second, "voxels (1)"));
  bw_check_ok(bw_file_write_text(comm, longer, "voxels (1)\n"));
  snprintf(yaml, sizeof yaml, "nu: 1\nend: 2\nbody: {image: first.nrrd}\n");
  write_checkpoint(yaml, checkpoint);
  go_on(yaml, checkpoint, NULL);
  go_on("nu: 1\nend: 2\nbody: {image: second.nrrd}\n", checkpoint, NULL);
  go_on("nu: 1\nend: 2\nbody: {image: longer.nrrd}\n", checkpoint, "longer.nrrd\" (11 bytes");
  go_on("nu: 1\nend: 2\nbody: {image: gone.nrrd}\n", checkpoint, "gone.nrrd\" (cannot be read)");
  go_on("nu: 1\nend: 2\nbody: {}\n", checkpoint, "body.image is not set");
  bw_check_ok(bw_file_write_text(comm, first, "voxels (2)"));
  go_on(yaml, checkpoint, "first.nrrd\" (10 bytes, checksum");
}
END_TEST

/* Another program's, one of no case, one for a case that writes none, and none at all. */
START_TEST(foreign_checkpoints)
{
  const bw_comm *comm = bw_check_world();
  static const bw_case_about short_case = {"short", "a case without checkpoints", fields,
                                           sizeof(config), NULL};
  char yaml[200], checkpoint[200];
  case_file(yaml);
  in_base("foreign.h5", checkpoint);
  bw_check_ok(bw_file_write_text(comm, checkpoint, TUBE));
  expect_refusal(&other_case, WORDS(yaml, "--restart", checkpoint, "--check"), BW_EINPUT,
                 "written by tube, this is plate; go on with the program that wrote it");
  expect_refusal(&short_case, WORDS(yaml, "--restart", checkpoint), BW_EUSAGE,
                 "short writes no checkpoints; run it from the start");
  bw_check_ok(bw_file_write_text(comm, checkpoint, "tube\n"));
  expect_refusal(&about, WORDS(yaml, "--restart", checkpoint), BW_EINPUT, "nu is 0.5, was not set");
  bw_check_ok(bw_file_write_text(comm, checkpoint, "tube\n\n=\n= \n= nu\n= nu = 0.5\nx\n~ = 1"));
  expect_refusal(&about, WORDS(yaml, "--restart", checkpoint, "--set", "nu=2"), BW_EINPUT,
                 "nu is 2, was 0.5");
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(every_difference_is_refused_with_both_values),
                                      BW_TEST(several_differences), BW_TEST(changes_are_listed),
                                      BW_TEST(files_are_compared_by_content),
                                      BW_TEST(foreign_checkpoints)};
BW_CHECK_MAIN("case_identity", tests)
