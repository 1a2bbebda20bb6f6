/* bw_memory.h -- allocation with overflow check, 64-byte alignment and zeroed content. */
#pragma once
#include "bw_status.h"
#include <stddef.h>

BW_BEGIN_DECLS

/* *out = zeroed array of `count` items of `size` bytes, aligned to 64 bytes; never NULL on
 * success (also for count = 0), NULL after a failure. `out` is the address of a pointer of any type
 * of object. The caller owns the array and frees it with bw_release. BW_EMEM with the size asked
 * for, also when it exceeds the address space. Local. */
bw_status bw_allocate(size_t count, size_t size, void *out) BW_MUST_CHECK;

/* Free *out (a pointer's address) and set it to NULL; NULL inside is fine. Local. */
void bw_release(void *out);

/* Typed form: BW_ALLOCATE(&x, n) for `double *x`, the status of bw_allocate. */
#define BW_ALLOCATE(pointer, count) bw_allocate((count), sizeof **(pointer), (pointer))

/* *array, of which `kept` items are in use, becomes one of `count` >= kept items with those at its
 * beginning, zeros behind; as it was after a failure. `array` is the address of a pointer as above,
 * which may be NULL where kept is 0. BW_EMEM. Local. */
bw_status bw_enlarge(size_t kept, size_t count, size_t size, void *array) BW_MUST_CHECK;

/* Typed form: BW_ENLARGE(&x, kept, count) for `double *x`. */
#define BW_ENLARGE(pointer, kept, count) bw_enlarge((kept), (count), sizeof **(pointer), (pointer))

/* What this process has allocated and not released [bytes]; 0 where the C library does not tell.
 * Local. */
size_t bw_memory_in_use(void);

/* Memory of this process that is resident now [bytes]; 0 where the system does not tell. Local. */
size_t bw_memory_resident(void);

/* The most that it has been since this process began [bytes]; 0 where the system does not tell.
 * Local. */
size_t bw_memory_peak(void);

BW_END_DECLS
