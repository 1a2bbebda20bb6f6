/* The output folder belongs to one run: its lock, what may be replaced, what was written. */
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "case_internal.h"
#include "core_internal.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char lock_name[] = "run.lock";  /* held while a run writes */
static const char list_name[] = "run.files"; /* what runs have written, a name per line */

/* ---- the lock ----
 * A lock of the system (fcntl) on run.lock. It goes with the process, however that ends, and is not
 * copied with the file; what the file says is for messages alone. */

static void holder_of(int fd, char text[160])
{
  const ssize_t n = pread(fd, text, 159, 0);
  text[n > 0 ? n : 0] = '\0';
  text[strcspn(text, "\n")] = '\0';
}

static bw_status in_use(const bw_case *run, int fd)
{
  char holder[160];
  holder_of(fd, holder);
  return BW_FAIL(BW_EINPUT,
                 "the folder %s is in use: %s writes into it; wait for it or give --out NEW",
                 run->out, holder[0] != '\0' ? holder : "another process");
}

/* Somebody else's lock is found without a file of the folder being touched. */
static bw_status check_unlocked(const bw_case *run, const char *path)
{
  struct flock want = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
  bw_status st = BW_OK;
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return BW_OK;
  if (fcntl(fd, F_GETLK, &want) == 0 && want.l_type != F_UNLCK) st = in_use(run, fd);
  close(fd);
  return st;
}

/* Is the file behind `fd` still the one of that name? The run before removes it at its end. */
static bool still_there(int fd, const char *path)
{
  struct stat held, named;
  return fstat(fd, &held) == 0 && stat(path, &named) == 0 && held.st_ino == named.st_ino &&
         held.st_dev == named.st_dev;
}

static bw_status sign(const bw_case *run, int fd, const char *path)
{
  char host[256] = "", text[400], since[BW_CORE__TIME];
  gethostname(host, sizeof host - 1);
  bw_core__case_now(since);
  const int n = snprintf(text, sizeof text, "process %ld on %s since %s (%s)\n", (long)getpid(),
                         host, since, run->about->name);
  BW_REQUIRE(ftruncate(fd, 0) == 0 && pwrite(fd, text, (size_t)n, 0) == n, BW_EIO,
             "cannot write %s: %s", path, strerror(errno));
  return BW_OK;
}

static bw_status hold(bw_case *run, const char *path)
{
  struct flock want = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
  for (;;) {
    const int fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    BW_REQUIRE(fd >= 0, BW_EIO, "cannot write %s: %s", path, strerror(errno));
    if (fcntl(fd, F_SETLK, &want) != 0) {
      const int reason = errno;
      const bool taken = reason == EACCES || reason == EAGAIN;
      const bw_status st = taken ? in_use(run, fd) : BW_OK;
      close(fd);
      /* A disk without locks is no reason not to run. */
      if (!taken)
        bw_log_warn(run->log, "%s cannot be locked (%s): nothing keeps a second run out of it",
                    run->out, strerror(reason));
      return st;
    }
    if (still_there(fd, path)) {
      run->lock = fd;
      run->locked = true;
      return sign(run, fd, path);
    }
    close(fd); /* the run before removed it between the two calls: again */
  }
}

void bw_core__case_leave(bw_case *run)
{
  char *path = NULL;
  if (!run->locked) return;
  /* Removed while it is held: whoever waits for it finds that it is gone and makes a new one. */
  if (bw_path_join(run->out, lock_name, &path) == BW_OK) unlink(path);
  close(run->lock);
  run->locked = false;
  bw_release(&path);
}

/* ---- what may be replaced ---- */

static bool ends_with(const char *name, const char *tail)
{
  const size_t n = strlen(name), m = strlen(tail);
  return n >= m && strcmp(name + n - m, tail) == 0;
}

/* Something in the folder that is no record of a run; with `but_checkpoints` *.h5 do not count.
 * *name is the caller's (bw_release); NULL: nothing. */
static bw_status find_result(const char *folder, bool but_checkpoints, char **name)
{
  bw_status st = BW_OK;
  DIR *d = opendir(folder);
  *name = NULL;
  if (d == NULL) return BW_OK;
  /* Records alone are no results: a run that stopped before its first output may begin again. */
  for (const struct dirent *e = readdir(d); e != NULL && *name == NULL && st == BW_OK;
       e = readdir(d)) {
    const bool record = strcmp(e->d_name, "run.yaml") == 0 ||
                        strcmp(e->d_name, "run.yaml.part") == 0 ||
                        strncmp(e->d_name, "run-", 4) == 0 || strcmp(e->d_name, lock_name) == 0 ||
                        strcmp(e->d_name, list_name) == 0;
    if (e->d_name[0] != '.' && !record && !(but_checkpoints && ends_with(e->d_name, ".h5")))
      st = bw_path_join("", e->d_name, name);
  }
  closedir(d);
  return st;
}

/* *same: is run.yaml the record of this program? *there: is there one at all? */
static bw_status read_record(const bw_case *run, const bw_comm *self, bool *there, bool *same)
{
  char *path = NULL, *text = NULL, line[128];
  bw_status st = bw_path_join(run->out, "run.yaml", &path);
  *there = st == BW_OK && bw_path_exists(self, path);
  *same = false;
  if (*there) BW_THEN(st, bw_file_read_text(self, path, NULL, &text));
  /* The key is looked for as put_record writes it, on lines of its own. */
  snprintf(line, sizeof line, "\nrun:\n  case: %s\n", run->about->name);
  if (text != NULL) *same = strstr(text, line) != NULL;
  bw_release(&text);
  bw_release(&path);
  return st;
}

/* Refused where something would be replaced that nobody has given up. */
static bw_status may_write(const bw_case *run, const bw_comm *self)
{
  const bool restart = run->args.restart != NULL, again = restart || run->args.overwrite;
  bool there = false, same = false;
  char *name = NULL;
  BW_TRY(read_record(run, self, &there, &same));
  /* A checkpoint may have been brought into a folder of its own. */
  BW_TRY(find_result(run->out, restart && !there, &name));
  if (name == NULL) return BW_OK;
  bw_status st = BW_OK;
  if (!there)
    st = BW_FAIL(BW_EINPUT,
                 "the folder %s holds %s, which is no result of %s (there is no run.yaml): give "
                 "--out NEW",
                 run->out, name, run->about->name);
  else if (!again)
    st = BW_FAIL(BW_EINPUT,
                 "the folder %s holds results of another run: give --out NEW, or --restart FILE to "
                 "go on with that one, or --overwrite to replace it",
                 run->out);
  else if (!same)
    st = BW_FAIL(BW_EINPUT, "the folder %s holds results of another case than %s: give --out NEW",
                 run->out, run->about->name);
  bw_release(&name);
  return st;
}

/* ---- what was written ---- */

/* Is `name` a line of the list? */
static bool listed(const char *list, const char *name)
{
  const size_t n = strlen(name);
  for (const char *line = list; line != NULL && *line != '\0';) {
    const char *end = strchr(line, '\n');
    if (end != NULL && (size_t)(end - line) == n && strncmp(line, name, n) == 0) return true;
    line = end != NULL ? end + 1 : NULL;
  }
  return false;
}

void bw_core__case_note(const bw_case *run, const char *name)
{
  bw_core__case_files *f = run->files;
  if (f == NULL || strpbrk(name, "/\n") != NULL || listed(f->list, name)) return;
  const size_t n = strlen(name) + 1;
  char *more = NULL, *path = NULL;
  /* A list that cannot be kept harms nobody: what is not on it --overwrite leaves alone. */
  if (bw_allocate(f->length + n + 1, 1, &more) != BW_OK) return;
  snprintf(more, f->length + n + 1, "%s%s\n", f->list != NULL ? f->list : "", name);
  bw_release(&f->list);
  f->list = more;
  f->length += n;
  FILE *out = bw_path_join(run->out, list_name, &path) == BW_OK ? fopen(path, "a") : NULL;
  if (out != NULL) {
    fprintf(out, "%s\n", name);
    fclose(out);
  }
  bw_release(&path);
}

/* A file that a run has written, and what is left of one that it was writing when it was killed. */
static bw_status remove_result(const char *file)
{
  char *part = NULL;
  BW_TRY(bw_core__part_path(file, &part));
  unlink(part);
  bw_release(&part);
  BW_REQUIRE(unlink(file) == 0 || errno == ENOENT, BW_EIO, "cannot remove %s: %s", file,
             strerror(errno));
  return BW_OK;
}

/* The list of the runs before; with --overwrite what is on it is removed, and nothing else. */
static bw_status take_list(bw_case *run, const bw_comm *self)
{
  char *path = NULL;
  BW_TRY(BW_ALLOCATE(&run->files, 1));
  bw_status st = bw_path_join(run->out, list_name, &path);
  if (st == BW_OK && bw_path_exists(self, path))
    st = bw_file_read_text(self, path, &run->files->length, &run->files->list);
  if (st == BW_OK && run->args.overwrite && run->files->list != NULL) {
    for (char *line = run->files->list, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
      char *file = NULL;
      *end = '\0';
      BW_THEN(st, bw_path_join(run->out, line, &file));
      if (file != NULL && strchr(line, '/') == NULL) st = remove_result(file);
      bw_release(&file);
    }
    bw_release(&run->files->list);
    run->files->length = 0;
    unlink(path);
  }
  bw_release(&path);
  return st;
}

/* run.yaml is kept as run-N.yaml, the first N that is free. A copy: a folder whose run is killed
 * here still has the record that says whose it is. */
static bw_status keep_old_record(const bw_case *run, const bw_comm *self)
{
  char *path = NULL, *text = NULL;
  bw_status st = bw_path_join(run->out, "run.yaml", &path);
  bool kept = st == BW_OK && !bw_path_exists(self, path);
  if (st == BW_OK && !kept) st = bw_file_read_text(self, path, NULL, &text);
  for (int n = 1; st == BW_OK && !kept; n++) {
    char name[32], *copy = NULL;
    snprintf(name, sizeof name, "run-%d.yaml", n);
    st = bw_path_join(run->out, name, &copy);
    /* A name that is taken is never overwritten: every start of the run stays on record. */
    if (st == BW_OK && !bw_path_exists(self, copy)) {
      st = bw_file_write_text(self, copy, text);
      kept = true;
    }
    bw_release(&copy);
  }
  bw_release(&text);
  bw_release(&path);
  return st;
}

/* Rank 0 looks, locks and makes room. */
static bw_status take(bw_case *run, const bw_comm *self)
{
  enum { LONGEST_NAME = 48 }; /* of a file that a case writes, with room to spare */
  char *lock = NULL;
  BW_REQUIRE(
      strlen(run->out) + 1 + LONGEST_NAME <= BW_PATH_LONGEST, BW_EINPUT,
      "--out %.40s...: the name of the folder has %zu bytes, %d at most: give a shorter one, or "
      "start nearer to it",
      run->out, strlen(run->out), BW_PATH_LONGEST - 1 - LONGEST_NAME);
  BW_TRY(bw_path_join(run->out, lock_name, &lock));
  /* Refusals first, so that nothing of somebody else's is touched. */
  bw_status st = check_unlocked(run, lock);
  BW_THEN(st, may_write(run, self));
  BW_THEN(st, bw_folder_make(self, run->out));
  BW_THEN(st, hold(run, lock));
  /* Once more: until the lock was held, another run may have been here. */
  BW_THEN(st, may_write(run, self));
  BW_THEN(st, take_list(run, self));
  BW_THEN(st, keep_old_record(run, self));
  bw_release(&lock);
  return st;
}

bw_status bw_core__case_folder(bw_case *run)
{
  bw_status st = BW_OK;
  if (bw_comm_rank(run->args.comm) == 0) {
    bw_comm *self = NULL;
    st = bw_comm_self(&self);
    BW_THEN(st, take(run, self));
    bw_comm_destroy(&self);
  }
  return bw_comm_agree(run->args.comm, st);
}
