#include "bw_history.h"
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "core_internal.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct bw_history {
  int n;
  char *path;
  FILE *out; /* rank 0 only */
  int64_t rows;
  double last;  /* time of the last row; NaN: none */
  int reason;   /* errno of the first failed write; 0: none */
  int infinite; /* column of the first infinite number, -1: none ... */
  double when;  /* ... and its time */
};

/* Letters and a unit, nothing that would break a CSV reader. */
static bw_status check_names(const char *path, int n, const char *const names[])
{
  BW_REQUIRE(n >= 1, BW_EINPUT, "%s: no columns", path);
  for (int q = 0; q < n; q++) {
    const char *open = strchr(names[q], '['), *close = open != NULL ? strchr(open, ']') : NULL;
    /* Every column says its unit: a reader of the file needs no other document. */
    BW_REQUIRE(close != NULL && close > open + 1 && close[1] == '\0' && open != names[q], BW_EINPUT,
               "%s: column '%s' has no unit: write it as 'name[unit]', '[-]' for a pure number",
               path, names[q]);
    BW_REQUIRE(strpbrk(names[q], ",\"\n\r") == NULL, BW_EINPUT,
               "%s: column '%s' contains a comma, quote or newline", path, names[q]);
  }
  return BW_OK;
}

static bw_status make_header(int n, const char *const names[], char **header)
{
  size_t length = 1;
  for (int q = 0; q < n; q++)
    length += strlen(names[q]) + 1;
  BW_TRY(BW_ALLOCATE(header, length));
  /* The length is known: nothing is cut. */
  for (int q = 0, at = 0; q < n; q++)
    at += snprintf(*header + at, length - (size_t)at, "%s%s", q == 0 ? "" : ",", names[q]);
  return BW_OK;
}

/* A row up to its end: as many cells as columns, each empty or one number. */
static bool is_row(const char *line, const char *end, int n, double *time)
{
  int cells = 0;
  for (const char *at = line; at <= end; cells++) {
    const size_t length = strcspn(at, ",\n");
    char *behind = NULL;
    const double x = length > 0 ? strtod(at, &behind) : (double)NAN;
    /* strtod would go over a line's end to the next number, and take hexadecimal ones. */
    if (length > 0 && (behind != at + length || strspn(at, "+-.0123456789eE") < length))
      return false;
    if (cells == 0) *time = x;
    at += length + 1;
  }
  return cells == n && isfinite(*time);
}

/* Line `number` against those before; *row: does it belong to the time until the restart? */
static bw_status check_row(bw_history *h, const char *line, const char *end, int64_t number,
                           double restart, bool *row)
{
  double time = NAN;
  BW_REQUIRE(is_row(line, end, h->n, &time), BW_EINPUT,
             "%s:%lld: no row of %d numbers: the file is damaged; restore it or give another --out",
             h->path, (long long)number, h->n);
  *row = time <= restart;
  BW_REQUIRE(!*row || !(time <= h->last), BW_EINPUT,
             "%s:%lld: the time %.15g does not follow that of the row before, %.15g: the file is "
             "damaged; restore it or give another --out",
             h->path, (long long)number, time, h->last);
  if (*row) h->last = time;
  return BW_OK;
}

static bw_status check_header(const bw_history *h, const char *header, char *line, char *end)
{
  const size_t length = strlen(header);
  const bool same =
      end != NULL && (size_t)(end - line) == length && strncmp(line, header, length) == 0;
  /* The header stands alone for a message, and is put together with its rows again below. */
  if (end != NULL) *end = '\0';
  BW_REQUIRE(same, BW_EINPUT,
             "%s holds other columns (%.300s) than this run writes (%.300s): give another --out",
             h->path, line, header);
  *end = '\n';
  return BW_OK;
}

/* Cut `text` behind the last row not later than `restart`; check and count the rows kept. Rows that
 * a killed run wrote after the checkpoint will be computed once more. A last line without its end
 * was being written when the run was killed. */
static bw_status keep_rows(bw_history *h, const char *header, double restart, int64_t rows,
                           char *text)
{
  char *line = text, *end = strchr(line, '\n');
  BW_TRY(check_header(h, header, line, end));
  for (line = end + 1; (end = strchr(line, '\n')) != NULL; line = end + 1) {
    bool row = false;
    const bw_status st = check_row(h, line, end, h->rows + 2, restart, &row);
    /* Behind the checkpoint's rows anything may stand: it goes. */
    if (rows >= 0 && h->rows == rows && (st != BW_OK || !row)) break;
    BW_TRY(st);
    if (!row) break;
    h->rows++;
  }
  BW_REQUIRE(
      rows < 0 || h->rows == rows, BW_EINPUT,
      "%s holds %lld rows until the time of the checkpoint, %.15g; the run had written %lld: "
      "the file is damaged; restore it or give another --out",
      h->path, (long long)h->rows, restart, (long long)rows);
  *line = '\0';
  return BW_OK;
}

static bw_status open_file(bw_history *h, const char *header, char *old)
{
  /* A history that goes on was cut to the restart time before. */
  h->out = fopen(h->path, old != NULL ? "a" : "w");
  BW_REQUIRE(h->out != NULL, BW_EIO, "cannot write %s: %s", h->path, strerror(errno));
  if (old == NULL) {
    const bool ok = fprintf(h->out, "%s\n", header) > 0 && fflush(h->out) == 0;
    BW_REQUIRE(ok, BW_EIO, "cannot write %s: %s", h->path, strerror(errno));
  }
  return BW_OK;
}

bw_status bw_history_create(const bw_comm *comm, const char *path, int n, const char *const names[],
                            double restart_time, int64_t restart_rows, bw_history **out)
{
  bw_history *h = NULL;
  char *header = NULL, *old = NULL;
  size_t bytes = 0;
  *out = NULL;
  bw_status st = BW_ALLOCATE(&h, 1);
  BW_THEN(st, check_names(path, n, names));
  BW_THEN(st, bw_path_join("", path, &h->path));
  BW_THEN(st, make_header(n, names, &header));
  /* Names are sound and memory is there on all ranks; now the disk. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    h->n = n;
    h->last = NAN;
    h->infinite = -1;
    if (!isnan(restart_time) && bw_path_exists(comm, path))
      st = bw_file_read_text(comm, path, &bytes, &old);
    /* Killed before its first line; where rows were there before, they are lost. */
    if (bytes == 0 && restart_rows <= 0) bw_release(&old);
    if (old != NULL)
      BW_THEN(st, bw_comm_agree(comm, keep_rows(h, header, restart_time, restart_rows, old)));
    /* The file is replaced as a whole: a run killed now leaves the old one or the cut one. */
    if (old != NULL) BW_THEN(st, bw_file_write_text(comm, path, old));
    if (st == BW_OK && bw_comm_rank(comm) == 0) st = open_file(h, header, old);
    st = bw_comm_agree(comm, st);
  }
  bw_release(&header);
  bw_release(&old);
  /* On rank 0 the file may be open although another rank failed. */
  if (st != BW_OK && h != NULL) {
    if (h->out != NULL) fclose(h->out);
    bw_release(&h->path);
    bw_release(&h);
  }
  *out = h;
  return st;
}

void bw_history_append(bw_history *h, const double values[])
{
  if (h == NULL || h->out == NULL) return;
  /* The end of a phase may also be the time of a sample; a restarted run samples the state it
   * begins with, which the old file may hold already. */
  if (values[0] == h->last || h->reason != 0) return;
  h->last = values[0];
  bool ok = true;
  for (int q = 0; q < h->n; q++) {
    char number[BW_NUMBER_SIZE];
    number[0] = '\0'; /* not measured: nothing is written */
    if (!isnan(values[q])) bw_core__format_double(values[q], number);
    ok = fprintf(h->out, "%s%s", q == 0 ? "" : ",", number) >= 0 && ok;
    if (isinf(values[q]) && h->infinite < 0) h->infinite = q, h->when = values[0];
  }
  ok = fputc('\n', h->out) != EOF && ok;
  /* A killed run keeps all rows but the one being written. */
  ok = fflush(h->out) == 0 && ok;
  /* What is left of a row without its end is dropped when the run goes on. */
  if (!ok) h->reason = errno != 0 ? errno : EIO;
  h->rows += ok;
}

static bw_status write_failed(const bw_history *h)
{
  return BW_FAIL(BW_EIO, "cannot write %s: %s", h->path, strerror(h->reason));
}

bw_status bw_history_sync(const bw_comm *comm, bw_history *h)
{
  bw_status st = BW_OK;
  if (h != NULL && h->out != NULL) {
    /* EINVAL: a pipe or a device, which has no disk behind it. */
    if (h->reason == 0 && fsync(fileno(h->out)) != 0 && errno != EINVAL) h->reason = errno;
    if (h->reason != 0) st = write_failed(h);
  }
  return bw_comm_agree(comm, st);
}

int64_t bw_history_rows(const bw_history *h)
{
  return h->out != NULL ? h->rows : 0;
}

bw_status bw_history_close(const bw_comm *comm, bw_history **history)
{
  bw_history *h = *history;
  bw_status st = BW_OK;
  if (h != NULL && h->out != NULL) {
    errno = 0;
    /* What failed in between shows here at the latest: rows are written without a status. */
    if (fclose(h->out) != 0 && h->reason == 0) h->reason = errno;
    if (h->reason != 0)
      st = write_failed(h);
    else if (h->infinite >= 0)
      st = BW_FAIL(BW_EDIVERGED, "%s: column %d is infinite at %.15g, the first time", h->path,
                   h->infinite + 1, h->when);
  }
  st = bw_comm_agree(comm, st);
  if (h != NULL) bw_release(&h->path);
  bw_release(history);
  return st;
}
