/* Fuzzer of surfaces, text and binary.
 * BUILD modules=shape */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  bw_shape_mask *mask = NULL;
  bw_shape_surface_config c = bw_shape_surface_config_default();
  c.scale = 0.5, c.spacing = 0.25;
  c.placed = size % 2 == 0;
  const char *path = fuzz_file("body.stl", data, size);
  fuzz_mask(bw_shape_mask_open_stl(path, &c, &mask), &mask, data, size);
  return 0;
}
