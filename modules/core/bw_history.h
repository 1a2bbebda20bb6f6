/* bw_history.h -- history.csv: one row of numbers per sample, a unit in every column name.
 *
 * Rank 0 writes and flushes each row, in digits that read back to the same doubles. A number that
 * was not measured (NaN) is an empty cell. Times increase from row to row. */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* An open history.csv. */
typedef struct bw_history bw_history;

/* Begin `path` with the n column names, names[0] being the time, e.g. {"time[s]",
 * "pressure_drop_over_p0[-]"}. restart_time NaN: a new file replaces an old one. Otherwise the
 * existing file goes on: its rows later than restart_time (written before the run was killed)
 * and an incomplete last line are dropped, so that no sample appears twice; without a file a new
 * one begins. Rows until restart_time are checked: as many cells as columns, numbers or nothing,
 * times that increase, and restart_rows of them, which is what bw_history_rows said when the
 * checkpoint was written (-1: not known). Errors: BW_EINPUT for a name without a unit in [] or with
 * a comma, when the existing file has other columns, and with the line for a row that is damaged,
 * missing or too many; BW_EIO. Names are not kept. Collective. */
bw_status bw_history_create(const bw_comm *comm, const char *path, int n, const char *const names[],
                            double restart_time, int64_t restart_rows,
                            bw_history **out) BW_MUST_CHECK;

/* One row: values[n] of rank 0, values[0] being the time; other ranks' are not looked at. A row of
 * the time of the row before, also of the last one that a restart has kept, is that row again and
 * is not repeated. Errors of writing, and a number that is infinite, are remembered and returned by
 * close; behind a row that failed none is written. Local. */
void bw_history_append(bw_history *history, const double values[]);

/* Before a checkpoint that counts the rows: all of them on the disk, so that a power failure does
 * not leave the checkpoint with fewer. BW_EIO when one could not be written: a checkpoint would
 * lose it. NULL is fine. Collective. */
bw_status bw_history_sync(const bw_comm *comm, bw_history *history) BW_MUST_CHECK;

/* Rows in the file (those kept included). Meaningful on rank 0, 0 elsewhere. Local. */
int64_t bw_history_rows(const bw_history *history);

/* *history is freed; NULL inside is fine. BW_EIO when a row could not be written, BW_EDIVERGED with
 * the column and the time when a number in it was infinite. Collective. */
bw_status bw_history_close(const bw_comm *comm, bw_history **history) BW_MUST_CHECK;

BW_END_DECLS
