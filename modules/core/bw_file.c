#include "bw_file.h"
#include "bw_comm_mpi.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "core_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
  CHUNK = 1 << 30,       /* bytes per MPI call: its counts are int */
  LARGEST_TEXT = 1 << 30 /* bytes that read_text takes: they are broadcast in one call */
};

struct bw_file {
  const bw_comm *comm;
  char *path, *part;
  MPI_File mpi;
  bool open;
  int64_t end; /* first byte behind everything this rank wrote */
};

static void release(bw_file **file)
{
  bw_release(&(*file)->path);
  bw_release(&(*file)->part);
  bw_release(file);
}

static bw_status mpi_failed(const char *path, int64_t offset, int code)
{
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  return BW_FAIL(BW_EIO, "cannot write %s at byte %lld: %s", path, (long long)offset, text);
}

/* Rank 0 makes the empty file itself: the system's reason for a refusal is clearer than MPI's. */
static bw_status make_empty(const char *path, const char *part)
{
  const int fd = open(part, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  BW_REQUIRE(fd >= 0, BW_EIO, "cannot write %s: %s", path, strerror(errno));
  close(fd);
  return BW_OK;
}

bw_status bw_core__part_path(const char *path, char **part)
{
  const size_t length = strlen(path) + sizeof ".part";
  BW_TRY(BW_ALLOCATE(part, length));
  snprintf(*part, length, "%s.part", path);
  return BW_OK;
}

bw_status bw_file_create(const bw_comm *comm, const char *path, bw_file **out)
{
  bw_file *f = NULL;
  *out = NULL;
  bw_status st = bw_path_check(path);
  BW_THEN(st, BW_ALLOCATE(&f, 1));
  BW_THEN(st, bw_path_join("", path, &f->path));
  BW_THEN(st, bw_core__part_path(path, &f->part));
  /* PATH.part is made by rank 0 alone, before all ranks open it together. */
  if (st == BW_OK && bw_comm_rank(comm) == 0) st = make_empty(path, f->part);
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    f->comm = comm;
    const int code =
        MPI_File_open(bw_comm_mpi(comm), f->part, MPI_MODE_WRONLY, MPI_INFO_NULL, &f->mpi);
    f->open = code == MPI_SUCCESS;
    st = bw_comm_agree(comm, f->open ? BW_OK : mpi_failed(path, 0, code));
  }
  /* Another rank may have failed where this one has the file open. */
  if (st != BW_OK && f != NULL) {
    if (f->open) MPI_File_close(&f->mpi);
    release(&f);
  }
  *out = f;
  return st;
}

bw_status bw_file_write_at_all(bw_file *f, int64_t offset, size_t bytes, const void *data)
{
  const unsigned char *from = data;
  int64_t rounds = (int64_t)((bytes + CHUNK - 1) / CHUNK);
  bw_status st = BW_OK;
  /* The call is collective: ranks with less to write take part with nothing until the last one is
   * done. */
  bw_comm_max_int(f->comm, 1, &rounds);
  for (int64_t q = 0; q < rounds; q++) {
    const int n = bytes > CHUNK ? CHUNK : (int)bytes;
    MPI_Status done;
    int written = 0;
    const int code = MPI_File_write_at_all(f->mpi, offset, from, n, MPI_BYTE, &done);
    /* A full disk may show as a short write only, not as an error of the call. */
    if (code == MPI_SUCCESS && n > 0) MPI_Get_count(&done, MPI_BYTE, &written);
    if (st == BW_OK && code != MPI_SUCCESS) st = mpi_failed(f->path, offset, code);
    if (st == BW_OK && written != n)
      st = BW_FAIL(BW_EIO, "cannot write %s: only %d of %d bytes at byte %lld (disk full?)",
                   f->path, written, n, (long long)offset);
    /* The first failure is kept and the others are not looked at: all ranks make the same number of
     * calls. */
    offset += n;
    bytes -= (size_t)n;
    if (n > 0) {
      from += n;
      if (offset > f->end) f->end = offset;
    }
  }
  return bw_comm_agree(f->comm, st);
}

/* All bytes have to be there before the name changes: a full disk may show up only here. */
static bw_status rename_complete(const bw_file *f, int64_t end)
{
  struct stat info;
  BW_REQUIRE(stat(f->part, &info) == 0, BW_EIO, "cannot write %s: %s", f->path, strerror(errno));
  BW_REQUIRE((int64_t)info.st_size >= end, BW_EIO,
             "cannot write %s: %lld bytes on disk of %lld written (disk full?)", f->path,
             (long long)info.st_size, (long long)end);
  BW_REQUIRE(rename(f->part, f->path) == 0, BW_EIO, "cannot rename %s to %s: %s", f->part, f->path,
             strerror(errno));
  return BW_OK;
}

bw_status bw_file_close(bw_file **file)
{
  bw_file *f = *file;
  if (f == NULL) return BW_OK;
  /* How long the file has to be, over all ranks: only they know what they have written. */
  int64_t end = f->end;
  bw_comm_max_int(f->comm, 1, &end);
  /* To the disk before the name: after a power failure the name stands for the old file or for all
   * of the new one. */
  const int synced = MPI_File_sync(f->mpi);
  const int closed = MPI_File_close(&f->mpi);
  const int code = synced != MPI_SUCCESS ? synced : closed;
  f->open = false;
  bw_status st = code == MPI_SUCCESS ? BW_OK : mpi_failed(f->path, end, code);
  st = bw_comm_agree(f->comm, st);
  /* Closed by all: what is missing now will not come. The name changes last. */
  if (bw_comm_rank(f->comm) == 0) {
    if (st == BW_OK) st = rename_complete(f, end);
    if (st != BW_OK) remove(f->part);
  }
  st = bw_comm_agree(f->comm, st);
  release(file);
  return st;
}

void bw_file_abandon(bw_file **file)
{
  bw_file *f = *file;
  if (f == NULL) return;
  /* PATH has not been touched so far and never will be. */
  if (f->open) MPI_File_close(&f->mpi);
  bw_comm_barrier(f->comm); /* nobody has it open when it goes */
  if (bw_comm_rank(f->comm) == 0) remove(f->part);
  release(file);
}

static bw_status write_whole(const char *path, const char *part, const char *text)
{
  FILE *out = fopen(part, "w");
  BW_REQUIRE(out != NULL, BW_EIO, "cannot write %s: %s", path, strerror(errno));
  /* Buffered: the disk may refuse only later. A pipe or a device (EINVAL) has no disk behind it. */
  errno = 0;
  bool ok = fputs(text, out) >= 0 && fflush(out) == 0;
  ok = ok && (fsync(fileno(out)) == 0 || errno == EINVAL);
  int reason = errno;
  const bool closed = fclose(out) == 0;
  if (ok && !closed) reason = errno;
  if (ok && closed && rename(part, path) == 0) return BW_OK;
  if (ok && closed) reason = errno;
  const bw_status st = BW_FAIL(BW_EIO, "cannot write %s: %s", path, strerror(reason));
  remove(part);
  return st;
}

bw_status bw_file_write_text(const bw_comm *comm, const char *path, const char *text)
{
  bw_status st = BW_OK;
  if (bw_comm_rank(comm) == 0) {
    char *part = NULL;
    st = bw_core__part_path(path, &part);
    BW_THEN(st, write_whole(path, part, text));
    bw_release(&part);
  }
  return bw_comm_agree(comm, st);
}

/* Grows as it reads: works for pipes (/dev/stdin) too. */
static bw_status read_whole(const char *path, char **text, size_t *bytes)
{
  size_t room = 65536, n = 0;
  FILE *in = fopen(path, "r");
  BW_REQUIRE(in != NULL, BW_EIO, "cannot read %s: %s", path, strerror(errno));
  bw_status st = BW_ALLOCATE(text, room);
  /* One byte stays free for the 0 behind the text, which is there because memory comes zeroed. */
  while (st == BW_OK) {
    n += fread(*text + n, 1, room - 1 - n, in);
    if (ferror(in)) st = BW_FAIL(BW_EIO, "cannot read %s: %s", path, strerror(errno));
    if (st != BW_OK || n < room - 1) break;
    /* The room is full: go on with twice as much, up to the longest text that is taken. */
    char *more = NULL;
    if (room >= (size_t)LARGEST_TEXT)
      st = BW_FAIL(BW_EIO, "cannot read %s: larger than 1 GiB", path);
    BW_THEN(st, BW_ALLOCATE(&more, 2 * room));
    if (st != BW_OK) break;
    memcpy(more, *text, n);
    bw_release(text);
    *text = more;
    room *= 2;
  }
  fclose(in);
  *bytes = n;
  return st;
}

bw_status bw_file_read_text(const bw_comm *comm, const char *path, size_t *bytes, char **text)
{
  const bool reader = bw_comm_rank(comm) == 0;
  char *content = NULL;
  size_t n = 0;
  bw_status st = BW_OK;
  if (reader) st = read_whole(path, &content, &n);
  st = bw_comm_agree(comm, st);
  /* The length first, so that the others have room for the text. */
  if (st == BW_OK) bw_comm_broadcast(comm, sizeof n, &n);
  if (st == BW_OK && !reader) st = BW_ALLOCATE(&content, n + 1);
  /* Room on all ranks, or none of them waits for the text. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) bw_comm_broadcast(comm, n, content);
  if (st != BW_OK) bw_release(&content);
  if (bytes != NULL) *bytes = n;
  *text = content;
  return st;
}
