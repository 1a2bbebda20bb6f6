/* Fuzzer of raw images: the first bytes are the layout, the rest the file.
 * BUILD modules=shape */
#include "fuzz.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  int16_t n[4];
  bw_shape_mask *mask = NULL;
  if (size < 2 + sizeof n) return 0;
  memcpy(n, data + 2, sizeof n);
  const bw_shape_voxels v = {.type = (bw_shape_voxel_type)(data[0] % (BW_SHAPE_VOXEL_COUNT + 1)),
                             .big_endian = data[1] & 1,
                             .size = {n[0], n[1], data[1] & 2 ? n[2] : INT64_C(1) << (n[2] & 31)},
                             .spacing = {1, 1, data[1] & 4 ? n[3] : 1},
                             .skip = n[3]};
  const size_t head = 2 + sizeof n;
  const char *path = fuzz_file("image.raw", data + head, size - head);
  fuzz_mask(bw_shape_mask_open_raw(path, &v, 1, 200, &mask), &mask, data, size);
  return 0;
}
