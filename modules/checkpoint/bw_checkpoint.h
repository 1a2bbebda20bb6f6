/* bw_checkpoint.h -- state on disk: parallel HDF5, verified on reading, any number of ranks.
 *
 * A file holds named numbers, texts, fields of a grid (global arrays without halo, in double or
 * float as built) and tables of items that carry a global id 0..total-1 (rows stored in id
 * order). Every data set has a checksum that does not depend on the partition (exclusive or over
 * elements of a hash of index and bits), checked on reading; the file has a format version, the
 * name of the precision and a mark that it is complete. HDF5's own structures carry checksums
 * too (its newest format). Written as PATH.part, synchronised to the disk and renamed to PATH on
 * a successful close: an interrupted write never replaces a good file.
 * Any size: what one rank writes or reads at once is at most bw_comm_message_limit (1 GiB), in as
 * many operations as it takes; one layer of a field (n[0] x n[1] numbers) or one row of a table is
 * moved whole and must stay below 2 GiB.
 * Names may have folders ("solid/position"). Each name is written once.
 * Errors: BW_EIO naming path, data set and what was found; BW_EINPUT for arguments that cannot
 * be stored; agreed by all ranks. HDF5's own messages are turned off from create or open on.
 * After a failed put, close does not rename but fails too.
 * All functions are collective unless said otherwise. */
#pragma once
#include "bw_case.h"
#include "bw_grid.h"

BW_BEGIN_DECLS

/* An open checkpoint. */
typedef struct bw_checkpoint bw_checkpoint;

/* Begin PATH.part. `comm` is borrowed until close. On failure *out is NULL. */
bw_status bw_checkpoint_create(const bw_comm *comm, const char *path,
                               bw_checkpoint **out) BW_MUST_CHECK;

/* Open PATH for reading: format, precision (of bw_real), completeness and HDF5's structures are
 * checked, not yet the data. `comm` is borrowed until close. On failure *out is NULL. */
bw_status bw_checkpoint_open(const bw_comm *comm, const char *path,
                             bw_checkpoint **out) BW_MUST_CHECK;

/* Finish. For a file being written this marks it complete and renames it; check the result.
 * *ck becomes NULL, also on failure (then nothing is renamed and PATH.part is removed). */
bw_status bw_checkpoint_close(bw_checkpoint **ck) BW_MUST_CHECK;

/* Give up after an error: nothing is renamed, PATH.part is removed; NULL is fine. */
void bw_checkpoint_abandon(bw_checkpoint **ck);

/* Write x[n] of rank 0 under `name`; n >= 0 is the same on all ranks. */
bw_status bw_checkpoint_put_numbers(bw_checkpoint *ck, const char *name, int n,
                                    const double x[]) BW_MUST_CHECK;

/* x[n], on all ranks; BW_EIO when the file has another count. */
bw_status bw_checkpoint_get_numbers(bw_checkpoint *ck, const char *name, int n,
                                    double x[]) BW_MUST_CHECK;

/* Write the text of rank 0 under `name`. */
bw_status bw_checkpoint_put_text(bw_checkpoint *ck, const char *name,
                                 const char *text) BW_MUST_CHECK;

/* *text, on all ranks, is allocated and owned by the caller (bw_release); NULL after a failure. */
bw_status bw_checkpoint_get_text(bw_checkpoint *ck, const char *name, char **text) BW_MUST_CHECK;

/* Write whose the checkpoint is: program, version and resolved case of `run`, under "case/program",
 * "case/version" and "case/parameters". `run` NULL, of a program that is no case: nothing. */
bw_status bw_checkpoint_put_case(bw_checkpoint *ck, const bw_case *run) BW_MUST_CHECK;

/* The same from the file at PATH: a bw_case_reader. BW_EIO for a file of no case, too. */
bw_status bw_checkpoint_read_case(const bw_comm *comm, const char *path, char **program,
                                  char **parameters) BW_MUST_CHECK;

/* Is there an entry of that name? The same answer on all ranks. */
bool bw_checkpoint_has(bw_checkpoint *ck, const char *name);

/* Write the interior of a field (as bw_field_create makes it). `first_face` = true also stores the
 * layer of index 0 in direction `direction` (0, 1, 2; the lower boundary face of a staggered
 * component): size n+1 there. */
bw_status bw_checkpoint_put_field(bw_checkpoint *ck, const char *name, const bw_grid *grid,
                                  int direction, bool first_face,
                                  const bw_real *field) BW_MUST_CHECK;

/* The same back, on a grid of the same n and any division (BW_EIO otherwise); halos are not touched
 * (bw_halo_update follows). */
bw_status bw_checkpoint_get_field(bw_checkpoint *ck, const char *name, const bw_grid *grid,
                                  int direction, bool first_face, bw_real *field) BW_MUST_CHECK;

/* The elements of a table. */
typedef enum {
  BW_CK_DOUBLE, /* double */
  BW_CK_UINT8,  /* uint8_t */
  BW_CK_INT32   /* int32_t */
} bw_checkpoint_type;

/* Write a table: row i of this rank, rows[i components ..], is item id[i] of `total`, i = 0 .. n-1.
 * Every id 0 .. total-1 appears on exactly one rank, else BW_EINPUT names one that does not. */
bw_status bw_checkpoint_put_table(bw_checkpoint *ck, const char *name, int64_t total, size_t n,
                                  const int64_t id[], int components, bw_checkpoint_type type,
                                  const void *rows) BW_MUST_CHECK;

/* rows[n][components]: each rank asks for the ids it wants (any rank, any number of times). Total,
 * components and type must be those of the file (BW_EIO otherwise). */
bw_status bw_checkpoint_get_table(bw_checkpoint *ck, const char *name, int64_t total, size_t n,
                                  const int64_t id[], int components, bw_checkpoint_type type,
                                  void *rows) BW_MUST_CHECK;

/* Memory that writing takes on this rank beside what it is given, at most [bytes]: of a file while
 * it is open, and of a field of `grid` (one of bw_grid_plan, too) or a table of n rows of `row`
 * bytes while it is put. For estimates before anything is built. Local. */
double bw_checkpoint_file_bytes(void);
double bw_checkpoint_field_bytes(const bw_grid *grid);
double bw_checkpoint_table_bytes(double n, double row);

BW_END_DECLS
