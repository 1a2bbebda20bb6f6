/* Loaded before a program (LD_PRELOAD): the NO_MEMORY_AT-th array that rank NO_MEMORY_RANK asks for
 * is refused. Counts what bw_allocate asks the system for, by its alignments, and nobody else.
 * NO_MEMORY_COUNT: a file that gets the number of arrays at the end. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dlfcn.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL = 64, HUGE_PAGE = 1 << 21 };

static long asked_for;

static bool on_this_rank(void)
{
  const char *rank = getenv("OMPI_COMM_WORLD_RANK"), *chosen = getenv("NO_MEMORY_RANK");
  return rank != NULL && chosen != NULL && strcmp(rank, chosen) == 0;
}

static bool refused(void)
{
  const char *at = getenv("NO_MEMORY_AT");
  if (!on_this_rank()) return false;
  asked_for++;
  return at != NULL && asked_for == atol(at);
}

/* POSIX lets a data pointer of dlsym hold that of a function; ISO C has no cast for it. */
static void next(const char *name, void *function)
{
  void *found = dlsym(RTLD_NEXT, name);
  memcpy(function, &found, sizeof found);
}

void *aligned_alloc(size_t alignment, size_t size)
{
  static void *(*system_one)(size_t, size_t);
  if (system_one == NULL) next("aligned_alloc", &system_one);
  return alignment == SMALL && refused() ? NULL : system_one(alignment, size);
}

int posix_memalign(void **out, size_t alignment, size_t size)
{
  static int (*system_one)(void **, size_t, size_t);
  if (system_one == NULL) next("posix_memalign", &system_one);
  return alignment == HUGE_PAGE && refused() ? ENOMEM : system_one(out, alignment, size);
}

__attribute__((destructor)) static void tell(void)
{
  const char *path = getenv("NO_MEMORY_COUNT");
  FILE *out = path != NULL && on_this_rank() ? fopen(path, "w") : NULL;
  if (out == NULL) return;
  fprintf(out, "%ld\n", asked_for);
  fclose(out);
}
