/* Fuzzer of scene files: read, resolved and checked, as far as a run goes before it builds.
 * BUILD modules=scene */
#include "bw_memory.h"
#include "bw_scene.h"
#include "fuzz.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  bw_scene_config *c = NULL;
  if (bw_allocate(1, sizeof *c, &c) != BW_OK) return 0;
  bw_scene_config_default(c);
  const char *path = fuzz_file("scene.yaml", data, size);
  const bw_status st = bw_scene_read(fuzz_comm(), path, 0, NULL, c);
  /* Whatever is refused says why. */
  if (st != BW_OK && bw_last_message()[0] == 0) abort();
  bw_release(&c);
  return 0;
}
