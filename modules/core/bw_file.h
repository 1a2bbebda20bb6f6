/* bw_file.h -- one file written by all ranks together at byte offsets.
 *
 * The bytes go to PATH.part, which is renamed to PATH by a close that found all of them written:
 * an interrupted or failed write never replaces a good file. They are brought to the disk before
 * that, so that a power failure does not, either.
 * Life     create -> { write_at_all }* -> close, or abandon after an error.
 * Errors   BW_EIO with the path and the system's reason; agreed by all ranks. */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* A file that is being written. */
typedef struct bw_file bw_file;

/* Begin PATH.part; its folder has to exist (bw_folder_make). `comm` is borrowed until close.
 * On failure *out is NULL. Collective. */
bw_status bw_file_create(const bw_comm *comm, const char *path, bw_file **out) BW_MUST_CHECK;

/* Each rank writes `bytes` bytes (0 is fine, data may then be NULL) at `offset` from the start of
 * the file; the ranges of different ranks must not overlap. Any size (split inside). BW_EIO with
 * the offset on all ranks when one could not write. Collective. */
bw_status bw_file_write_at_all(bw_file *file, int64_t offset, size_t bytes,
                               const void *data) BW_MUST_CHECK;

/* Finish and rename; *file becomes NULL, also on failure (then PATH.part is removed). NULL inside
 * is fine. Collective. */
bw_status bw_file_close(bw_file **file) BW_MUST_CHECK;

/* Give up after an error: PATH.part is removed, PATH stays as it was, *file becomes NULL; NULL
 * inside is fine. Collective. */
void bw_file_abandon(bw_file **file);

/* A small text file written by rank 0 (other ranks' text is not looked at), with the same
 * promise: PATH.part, then renamed. BW_EIO, BW_EMEM. Collective. */
bw_status bw_file_write_text(const bw_comm *comm, const char *path, const char *text) BW_MUST_CHECK;

/* The content of a file read by rank 0, on all ranks, with a 0 behind it: *text is allocated and
 * owned by the caller (bw_release), NULL after a failure; *bytes (may be NULL) excludes the 0.
 * BW_EIO when it cannot be read or exceeds 1 GiB. Collective. */
bw_status bw_file_read_text(const bw_comm *comm, const char *path, size_t *bytes,
                            char **text) BW_MUST_CHECK;

BW_END_DECLS
