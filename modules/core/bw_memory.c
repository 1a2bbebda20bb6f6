#define _DEFAULT_SOURCE /* madvise */
#include "bw_memory.h"

#include <malloc.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

enum { ALIGNMENT = 64, HUGE_PAGE = 1 << 21 };

/* Fields live in huge pages where the system grants them: strided sweeps and transforms miss the
 * translation buffer less (measured: Poisson 6 to 10 % faster). A wish, not a need. Pages that have
 * been touched stay small, so that fields must be fresh ones: without a fixed threshold the heap
 * would hand out those of the fields freed before (measured: momentum of a process's second scene
 * three times slower). */
static void *reserve(size_t bytes)
{
  if (bytes < 2 * HUGE_PAGE) return aligned_alloc(ALIGNMENT, bytes);
  void *p = NULL;
#ifdef M_MMAP_THRESHOLD
  (void)mallopt(M_MMAP_THRESHOLD, HUGE_PAGE);
#endif
  if (posix_memalign(&p, HUGE_PAGE, bytes) != 0) return NULL;
#ifdef MADV_HUGEPAGE
  (void)madvise(p, bytes, MADV_HUGEPAGE);
#endif
  return p;
}

bw_status bw_allocate(size_t count, size_t size, void *out)
{
  void *p = NULL;
  /* `out` is the address of a pointer of some type: an access as void ** would break the rules of
   * aliasing, a copy of its bytes does not. */
  memcpy(out, &p, sizeof p);
  BW_REQUIRE(size == 0 || count <= (SIZE_MAX - 2 * ALIGNMENT) / size, BW_EMEM,
             "an array of %zu items of %zu bytes exceeds the address space", count, size);
  /* Never empty, and whole cache lines: a vector that reads beyond the end of an array stays
   * inside. */
  const size_t bytes = (count * size + 2 * ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  p = reserve(bytes);
  memcpy(out, &p, sizeof p);
  BW_REQUIRE(p != NULL, BW_EMEM, "no memory for an array of %zu items of %zu bytes (%.1f MiB)",
             count, size, (double)bytes / 1048576.0);
  memset(p, 0, bytes);
  return BW_OK;
}

bw_status bw_enlarge(size_t kept, size_t count, size_t size, void *array)
{
  void *old = NULL, *larger = NULL;
  BW_TRY(bw_allocate(count, size, &larger));
  memcpy(&old, array, sizeof old);
  if (kept > 0) memcpy(larger, old, kept * size);
  free(old);
  memcpy(array, &larger, sizeof larger);
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

size_t bw_memory_in_use(void)
{
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 m = mallinfo2();
  return m.uordblks + m.hblkhd; /* in the heap, and mapped by themselves */
#else
  return 0;
#endif
}

size_t bw_memory_resident(void)
{
  long pages = 0, all = 0;
  FILE *f = fopen("/proc/self/statm", "r");
  if (f == NULL) return 0;
  const int read = fscanf(f, "%ld %ld", &all, &pages);
  fclose(f);
  return read == 2 ? (size_t)pages * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

size_t bw_memory_peak(void)
{
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? (size_t)usage.ru_maxrss * 1024 : 0; /* Linux: KiB */
}
