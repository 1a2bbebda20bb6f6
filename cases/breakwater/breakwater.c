/* Any scene: bodies and a fluid from one file (docs/guide).
 *
 * Run:   build/bin/breakwater SCENE.yaml --out out/scene
 * BUILD modules=scene */
#include "bw_memory.h"
#include "bw_scene.h"
#include "bw_solid.h"

#include <string.h>

/* Is a key of the help the one asked for, or below it? N stands for any item of a list, by its
 * number and, with `names`, by its name; it may be left out: bodies.flap.motion, bodies.0.motion
 * and bodies.motion are one key. */
static bool answers(const char *key, const char *asked, bool names)
{
  for (;;) {
    const size_t n = strcspn(key, ". "), m = strcspn(asked, ".");
    const bool list = n == 1 && key[0] == 'N', same = n == m && strncmp(key, asked, n) == 0;
    const bool item = list && (names || strspn(asked, "0123456789") == m);
    if (list && key[n] == '.' && answers(key + n + 1, asked, names)) return true;
    if (!item && !same) return false;
    if (asked[m] == '\0') return true;
    if (key[n] != '.') return false;
    key += n + 1, asked += m + 1;
  }
}

static int print_answers(const char *help, const char *asked, bool names)
{
  int lines = 0;
  for (const char *line = help; *line != '\0'; line += strcspn(line, "\n") + 1) {
    if (!answers(line + strspn(line, " "), asked, names)) continue;
    printf("%.*s\n", (int)strcspn(line, "\n"), line);
    lines++;
  }
  return lines;
}

/* --help KEY: the lines of the help that answer it; what may be the name of an item is taken for
 * one only where no key has it. */
static int help_of(const char *key, const bw_scene_config *defaults)
{
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) return 1;
  bw_config_help(bw_scene_fields, defaults, out);
  fclose(out);
  int lines = print_answers(text, key, false);
  if (lines == 0) lines = print_answers(text, key, true);
  bw_release(&text);
  if (lines == 0) fprintf(stderr, "there is no key %s; --help lists all\n", key);
  return lines > 0 ? 0 : 2;
}

int main(int argc, char **argv)
{
  bw_scene_config *config = NULL;
  const bw_case_about about = {"breakwater", "bodies and a fluid from one scene file",
                               bw_scene_fields, sizeof *config, bw_checkpoint_read_case};
  if (bw_allocate(1, sizeof *config, &config) != BW_OK) return 1;
  bw_scene_config_default(config);
  int code = 0;
  /* What needs neither ranks nor a file is answered at once. */
  if (argc == 3 && strcmp(argv[1], "--help") == 0)
    code = help_of(argv[2], config);
  else if (argc == 2 && strcmp(argv[1], "--schema") == 0)
    bw_scene_schema(stdout);
  else if (argc == 2 && strcmp(argv[1], "--laws") == 0)
    bw_solid_laws_describe(stdout);
  else
    code = bw_case_main(argc, argv, &about, config, bw_scene_run);
  bw_release(&config);
  return code;
}
