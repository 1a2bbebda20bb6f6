/* Any scene: bodies and a fluid from one file (docs/guide).
 *
 * Run:   build/bin/breakwater SCENE.yaml --out out/scene
 * BUILD modules=scene */
#include "bw_memory.h"
#include "bw_scene.h"
#include "bw_solid.h"

#include <string.h>

/* --help KEY: the lines of the help whose key begins so. */
static int help_of(const char *key, const bw_scene_config *defaults)
{
  char *text = NULL;
  size_t length = 0;
  int lines = 0;
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) return 1;
  bw_config_help(bw_scene_fields, defaults, out);
  fclose(out);
  for (char *line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
    const char *name = line + strspn(line, " ");
    const size_t n = strlen(key);
    if (strncmp(name, key, n) != 0 || strchr(". ", name[n]) == NULL) continue;
    puts(line);
    lines++;
  }
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
