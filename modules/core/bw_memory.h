/* bw_memory.h -- allocation with overflow check, 64-byte alignment and zeroed content. */
#pragma once
#include "bw_status.h"
#include <stddef.h>

/* *out = zeroed array of `count` items of `size` bytes, aligned to 64 bytes; never NULL on
 * success (also for count = 0), NULL after a failure. The caller owns it and frees it with
 * bw_release. Local. */
bw_status bw_allocate(size_t count, size_t size, void *out) BW_MUST_CHECK;

/* Free *out (a pointer's address) and set it to NULL; NULL inside is fine. Local. */
void bw_release(void *out);

/* Typed form: BW_ALLOCATE(&x, n) for `double *x`. */
#define BW_ALLOCATE(pointer, count) bw_allocate((count), sizeof **(pointer), (pointer))

/* Memory of this process that is resident now [bytes]; 0 where the system does not tell. Local. */
size_t bw_memory_resident(void);
/* The most that it has been since this process began [bytes]. Local. */
size_t bw_memory_peak(void);
