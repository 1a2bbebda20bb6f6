/* Fuzzer of images that begin as TIFF files do, read as a whole and in parts.
 * BUILD modules=shape */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  bw_shape_mask *mask = NULL;
  const char *path = fuzz_file("image.tif", data, size);
  fuzz_mask(bw_shape_mask_open_image(path, 1, 200, &mask), &mask, data, size);
  return 0;
}
