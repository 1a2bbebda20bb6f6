/* Loaded before a program (LD_PRELOAD): the disk goes wrong below the folder BAD_DISK, at the
 * BAD_DISK_AT-th call that changes something there (a file made, written, cut, brought to the disk,
 * renamed, removed). BAD_DISK_HOW says what happens then:
 *   kill   the process is killed before the call
 *   torn   half of the bytes of a write are written, then it is killed
 *   power  as torn; besides, every file is cut to what fsync has brought to the disk
 *   full   from here on there is no room: ENOSPC, a write gives half of its bytes first
 *   locked from here on nothing may be made, renamed or removed (EACCES)
 * BAD_DISK_ONLY: calls count whose path holds this text. BAD_DISK_COUNT: a file that gets the
 * number of calls at the end. Of several ranks BAD_DISK_RANK. */
#define _GNU_SOURCE /* RTLD_NEXT, fopencookie */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

enum { FILES = 64, STREAMS = 16 };

/* A file that holds more than was brought to the disk. */
typedef struct {
  char path[PATH_MAX];
  off_t synced;
} dirty_file;

static dirty_file dirty[FILES]; /* path "": free */
static struct {
  FILE *stream;
  int fd;
} streams[STREAMS];
static long calls;

/* POSIX lets a data pointer of dlsym hold that of a function; ISO C has no cast for it. */
static void next(const char *name, void *function)
{
  void *found = dlsym(RTLD_NEXT, name);
  memcpy(function, &found, sizeof found);
}
/* The system's own function of that name. */
#define SYSTEM(result, name, ...)                                                                  \
  static result (*system_##name)(__VA_ARGS__);                                                     \
  if (system_##name == NULL) next(#name, &system_##name)

static bool concerns(const char *path)
{
  const char *folder = getenv("BAD_DISK"), *rank = getenv("OMPI_COMM_WORLD_RANK");
  const char *chosen = getenv("BAD_DISK_RANK"), *only = getenv("BAD_DISK_ONLY");
  if (folder == NULL || (only != NULL && strstr(path, only) == NULL) ||
      (rank != NULL && chosen != NULL && strcmp(rank, chosen) != 0))
    return false;
  return strncmp(path, folder, strlen(folder)) == 0 && path[strlen(folder)] == '/';
}

static bool path_of(int fd, char path[PATH_MAX])
{
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, PATH_MAX - 1);
  path[n > 0 ? n : 0] = '\0';
  return concerns(path);
}

/* ---- what is on the disk ---- */

static dirty_file *dirty_of(const char *path)
{
  for (int q = 0; q < FILES; q++)
    if (strcmp(dirty[q].path, path) == 0) return &dirty[q];
  return NULL;
}

/* It is about to hold more than the disk has. */
static void touch(int fd, const char *path)
{
  struct stat info;
  dirty_file *f = dirty_of(path);
  if (f != NULL || (f = dirty_of("")) == NULL || fstat(fd, &info) != 0) return;
  strcpy(f->path, path);
  f->synced = info.st_size;
}

static void lose(void)
{
  for (int q = 0; q < FILES; q++)
    if (dirty[q].path[0] != '\0' && truncate(dirty[q].path, dirty[q].synced) != 0 &&
        errno != ENOENT)
      _exit(2);
}

/* ---- what happens ---- */

static bool how(const char *word)
{
  const char *chosen = getenv("BAD_DISK_HOW");
  return chosen != NULL && strcmp(chosen, word) == 0;
}

static bool now(void)
{
  const char *at = getenv("BAD_DISK_AT");
  calls++;
  return at != NULL && atol(at) > 0 && calls >= atol(at);
}

static void die(void)
{
  if (how("power")) lose();
  kill(getpid(), SIGKILL);
  for (;;)
    pause();
}

/* A call that changes names, or makes or cuts a file: its errno, 0 where it goes on. */
static int refused(const char *path)
{
  if (!concerns(path) || !now()) return 0;
  if (how("full")) return ENOSPC;
  if (how("locked")) return EACCES;
  die();
  return 0;
}

/* A write of `bytes` at `offset` (-1: at the end): how many of them go through; *reason is 0 where
 * all of them do. */
static size_t allowed(int fd, size_t bytes, off_t offset, int *reason)
{
  char path[PATH_MAX];
  struct stat info;
  *reason = 0;
  if (!path_of(fd, path)) return bytes;
  touch(fd, path);
  if (!now() || how("locked") || fstat(fd, &info) != 0) return bytes;
  if (how("kill")) die();
  /* What replaces bytes that are there finds room on a full disk. */
  if (how("full") && offset >= 0 && offset + (off_t)bytes <= info.st_size) return bytes;
  *reason = ENOSPC;
  return bytes / 2;
}

/* What `written` of a write that was cut short means to its caller. */
static ssize_t after_write(ssize_t written, int reason)
{
  if (reason == 0) return written;
  if (!how("full")) die();
  if (written > 0) return written;
  errno = reason;
  return -1;
}

/* ---- writes ---- */

ssize_t write(int fd, const void *data, size_t bytes)
{
  SYSTEM(ssize_t, write, int, const void *, size_t);
  int reason;
  const size_t n = allowed(fd, bytes, -1, &reason);
  return after_write(n > 0 || bytes == 0 ? system_write(fd, data, n) : 0, reason);
}

ssize_t pwrite(int fd, const void *data, size_t bytes, off_t offset)
{
  SYSTEM(ssize_t, pwrite, int, const void *, size_t, off_t);
  int reason;
  const size_t n = allowed(fd, bytes, offset, &reason);
  return after_write(n > 0 || bytes == 0 ? system_pwrite(fd, data, n, offset) : 0, reason);
}

ssize_t pwrite64(int fd, const void *data, size_t bytes, off64_t offset)
{
  return pwrite(fd, data, bytes, offset);
}

ssize_t pwritev(int fd, const struct iovec *part, int count, off_t offset)
{
  SYSTEM(ssize_t, pwritev, int, const struct iovec *, int, off_t);
  int reason;
  size_t bytes = 0;
  for (int q = 0; q < count; q++)
    bytes += part[q].iov_len;
  const size_t n = allowed(fd, bytes, offset, &reason);
  if (reason == 0) return system_pwritev(fd, part, count, offset);
  /* Of what is cut short the first part stands for all. */
  const struct iovec first = {part[0].iov_base, n < part[0].iov_len ? n : part[0].iov_len};
  return after_write(first.iov_len > 0 ? system_pwritev(fd, &first, 1, offset) : 0, reason);
}

ssize_t pwritev64(int fd, const struct iovec *part, int count, off64_t offset)
{
  return pwritev(fd, part, count, offset);
}

ssize_t writev(int fd, const struct iovec *part, int count)
{
  SYSTEM(ssize_t, writev, int, const struct iovec *, int);
  char path[PATH_MAX];
  if (count < 1 || !path_of(fd, path)) return system_writev(fd, part, count);
  return write(fd, part[0].iov_base, part[0].iov_len); /* a short write is a write */
}

int fsync(int fd)
{
  SYSTEM(int, fsync, int);
  char path[PATH_MAX];
  if (!path_of(fd, path)) return system_fsync(fd);
  if (now() && !how("locked")) {
    if (how("full")) return errno = ENOSPC, -1;
    die();
  }
  dirty_file *f = dirty_of(path);
  if (f != NULL) f->path[0] = '\0';
  return 0; /* the disk of this test is the table of dirty files */
}

int ftruncate(int fd, off_t length)
{
  SYSTEM(int, ftruncate, int, off_t);
  char path[PATH_MAX];
  if (path_of(fd, path)) {
    (void)refused(path); /* a longer file is a hole, which needs no room */
    touch(fd, path);
  }
  return system_ftruncate(fd, length);
}

int ftruncate64(int fd, off64_t length)
{
  return ftruncate(fd, length);
}

/* ---- names ---- */

int rename(const char *from, const char *to)
{
  SYSTEM(int, rename, const char *, const char *);
  const int reason = refused(to);
  /* A disk that is full still renames. */
  if (reason != 0 && reason != ENOSPC) return errno = reason, -1;
  dirty_file *f = concerns(to) ? dirty_of(from) : NULL;
  if (f != NULL) {
    dirty_file *old = dirty_of(to);
    if (old != NULL) old->path[0] = '\0';
    strncpy(f->path, to, PATH_MAX - 1);
  }
  return system_rename(from, to);
}

int link(const char *from, const char *to)
{
  SYSTEM(int, link, const char *, const char *);
  const int reason = refused(to);
  return reason != 0 ? (errno = reason, -1) : system_link(from, to);
}

int unlink(const char *path)
{
  SYSTEM(int, unlink, const char *);
  const int reason = refused(path);
  return reason != 0 && reason != ENOSPC ? (errno = reason, -1) : system_unlink(path);
}

int remove(const char *path)
{
  return unlink(path); /* only files are removed by this code */
}

/* May `path` be opened with these flags? Making or cutting a file changes the disk. */
static bool may_open(const char *path, int flags)
{
  struct stat info;
  const bool makes = (flags & O_CREAT) != 0 && stat(path, &info) != 0;
  const int reason = makes || (flags & O_TRUNC) != 0 ? refused(path) : 0;
  if (reason == 0) return true;
  errno = reason;
  return false;
}

int open(const char *path, int flags, ...)
{
  SYSTEM(int, open, const char *, int, ...);
  va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  return may_open(path, flags) ? system_open(path, flags, mode) : -1;
}

int open64(const char *path, int flags, ...)
{
  va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  return open(path, flags | O_LARGEFILE, mode);
}

/* ---- streams: the C library's own writes do not come by here, so they get ours ---- */

static ssize_t stream_write(void *cookie, const char *data, size_t bytes)
{
  size_t done = 0;
  /* As the C library does: a short write is gone on with. */
  for (ssize_t n = 1; n > 0 && done<bytes; done += n> 0 ? (size_t)n : 0)
    n = write((int)(intptr_t)cookie, data + done, bytes - done);
  return (ssize_t)done;
}

static int stream_close(void *cookie)
{
  const int fd = (int)(intptr_t)cookie;
  for (int q = 0; q < STREAMS; q++)
    if (streams[q].stream != NULL && streams[q].fd == fd) streams[q].stream = NULL;
  return close(fd);
}

FILE *fopen(const char *path, const char *mode)
{
  SYSTEM(FILE *, fopen, const char *, const char *);
  if (!concerns(path) || mode[0] == 'r') return system_fopen(path, mode);
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (mode[0] == 'a' ? O_APPEND : O_TRUNC);
  const int fd = open(path, flags, 0666);
  if (fd < 0) return NULL;
  const cookie_io_functions_t ours = {.write = stream_write, .close = stream_close};
  FILE *stream = fopencookie((void *)(intptr_t)fd, mode, ours);
  for (int q = 0; q < STREAMS; q++)
    if (streams[q].stream == NULL) {
      streams[q].stream = stream, streams[q].fd = fd;
      break;
    }
  return stream;
}

FILE *fopen64(const char *path, const char *mode)
{
  return fopen(path, mode);
}

int fileno(FILE *stream)
{
  SYSTEM(int, fileno, FILE *);
  for (int q = 0; q < STREAMS; q++)
    if (streams[q].stream == stream) return streams[q].fd;
  return system_fileno(stream);
}

__attribute__((destructor)) static void tell(void)
{
  const char *path = getenv("BAD_DISK_COUNT"), *rank = getenv("OMPI_COMM_WORLD_RANK");
  const char *chosen = getenv("BAD_DISK_RANK");
  /* A helper that MPI starts has this loaded, too, and writes nothing there. */
  if (path == NULL || calls == 0 || (rank != NULL && chosen != NULL && strcmp(rank, chosen) != 0))
    return;
  const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (fd < 0) return;
  dprintf(fd, "%ld\n", calls);
  close(fd);
}
