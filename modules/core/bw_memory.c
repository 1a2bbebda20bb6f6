#include "bw_memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

bw_status bw_allocate(size_t count, size_t size, void *out)
{
  void *p = NULL;
  memcpy(out, &p, sizeof p);
  BW_REQUIRE(size == 0 || count <= (SIZE_MAX - 2 * ALIGNMENT) / size, BW_EMEM,
             "an array of %zu items of %zu bytes exceeds the address space", count, size);
  const size_t bytes = (count * size + 2 * ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  p = aligned_alloc(ALIGNMENT, bytes);
  memcpy(out, &p, sizeof p);
  BW_REQUIRE(p != NULL, BW_EMEM, "no memory for an array of %zu items of %zu bytes (%.1f MiB)",
             count, size, (double)bytes / 1048576.0);
  memset(p, 0, bytes);
  return BW_OK;
}

void bw_release(void *out)
{
  void *p = NULL;
  memcpy(&p, out, sizeof p);
  free(p);
  p = NULL;
  memcpy(out, &p, sizeof p);
}
