#include "bw_folder.h"
#include "bw_memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bw_status make_one(const char *path)
{
  struct stat info;
  if (mkdir(path, 0777) == 0) return BW_OK;
  /* It is there, or it cannot be made; another process may also have made it between two calls. */
  const int reason = errno;
  if (stat(path, &info) == 0) {
    BW_REQUIRE(S_ISDIR(info.st_mode), BW_EIO,
               "cannot make the folder %s: a file of that name is in the way", path);
    return BW_OK;
  }
  return BW_FAIL(BW_EIO, "cannot make the folder %s: %s", path, strerror(reason));
}

/* `path` is cut at each '/' in turn and restored. */
static bw_status make_all(char *path)
{
  BW_REQUIRE(path[0] != '\0', BW_EIO, "cannot make a folder without a name");
  /* Parents first, from the root downwards. */
  for (char *p = path + 1; *p != '\0'; p++) {
    if (*p != '/') continue;
    *p = '\0';
    const bw_status st = make_one(path);
    *p = '/';
    BW_TRY(st);
  }
  BW_TRY(make_one(path));
  /* An old folder may belong to somebody else. */
  BW_REQUIRE(access(path, W_OK | X_OK) == 0, BW_EIO, "cannot write into the folder %s: %s", path,
             strerror(errno));
  return BW_OK;
}

bw_status bw_folder_make(const bw_comm *comm, const char *path)
{
  bw_status st = BW_OK;
  if (bw_comm_rank(comm) == 0) {
    /* make_all cuts the text in place, and the caller's is not ours. */
    char *copy = NULL;
    st = bw_path_join("", path, &copy);
    BW_THEN(st, make_all(copy));
    bw_release(&copy);
  }
  return bw_comm_agree(comm, st);
}

bool bw_path_exists(const bw_comm *comm, const char *path)
{
  struct stat info;
  /* Only rank 0 looks: on a shared disk other ranks may see a new file later. */
  int64_t found = bw_comm_rank(comm) == 0 && stat(path, &info) == 0;
  bw_comm_max_int(comm, 1, &found);
  return found != 0;
}

bw_status bw_path_check(const char *path)
{
  BW_REQUIRE(
      strlen(path) <= BW_PATH_LONGEST, BW_EIO,
      "%.40s...: the path has %zu bytes, %d at most: give a shorter one, or start nearer to it",
      path, strlen(path), BW_PATH_LONGEST);
  return BW_OK;
}

bw_status bw_path_join(const char *folder, const char *name, char **out)
{
  /* An absolute name needs no folder before it. */
  const bool alone = folder[0] == '\0' || name[0] == '/';
  const char *slash = alone || folder[strlen(folder) - 1] == '/' ? "" : "/";
  const char *front = alone ? "" : folder;
  const size_t length = strlen(front) + strlen(slash) + strlen(name) + 1;
  *out = NULL;
  BW_TRY(BW_ALLOCATE(out, length));
  snprintf(*out, length, "%s%s%s", front, slash, name);
  return BW_OK;
}
