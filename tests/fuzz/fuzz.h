/* fuzz.h -- what the fuzzers share.
 *
 * A fuzzer is one source fuzz_NAME.c that defines the function below. It hands the bytes to a
 * reader as the file that they would be; whatever they are, the reader has to come back with a
 * status. libFuzzer and AFL bring a main of their own (BW_FUZZ=ON); without them driver.c mutates
 * the seeds. */
#pragma once
#include "bw_comm.h"
#include "bw_shape_mask.h"
#include <stddef.h>
#include <stdint.h>

/* One input. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Before the first input: MPI, on this process alone. */
int LLVMFuzzerInitialize(int *argc, char ***argv);

/* The group of this process. */
const bw_comm *fuzz_comm(void);

/* A folder of this process in memory (/dev/shm), or where TMPDIR says; made at the first call. */
const char *fuzz_folder(void);

/* The bytes as a file of that name in the folder: its path, until the next call with the name. */
const char *fuzz_file(const char *name, const uint8_t *data, size_t size);

/* A good file. */
typedef struct {
  uint8_t *byte;
  size_t size;
} fuzz_base;

/* The file of that name in the folder, to be changed. */
void fuzz_read(const char *name, fuzz_base *base);

/* A good file with changes, as that name: its path. The first byte says what part of it is left (0:
 * all), then four bytes each change one: two for where, what is done, and with what. */
const char *fuzz_patched(const char *name, const fuzz_base *base, const uint8_t *data, size_t size);

/* What `st` says was opened: hold all of the mask, or parts that the bytes choose, where it is
 * small; destroy it. */
void fuzz_mask(bw_status st, bw_shape_mask **mask, const uint8_t *data, size_t size);
