/* Files that a case names: which file is meant, as a path that holds from any folder. */
#include "bw_folder.h"
#include "bw_memory.h"
#include "config_internal.h"

#include <errno.h>
#include <limits.h>
#include <string.h>
#include <unistd.h>

/* *out = FOLDER/NAME from the root; `folder` ends with a slash or is empty. */
static bw_status absolute(const char *folder, const char *name, char **out)
{
  char here[PATH_MAX], *joined = NULL;
  BW_TRY(bw_path_join(folder, name, &joined));
  if (joined[0] == '/') {
    *out = joined;
    return BW_OK;
  }
  bw_status st = BW_OK;
  if (getcwd(here, sizeof here) == NULL)
    st = BW_FAIL(BW_EIO, "the present folder cannot be told: %s", strerror(errno));
  BW_THEN(st, bw_path_join(here, joined, out));
  bw_release(&joined);
  return st;
}

bw_status bw_core__config_file(const bw_core__config_source *s, int id, const char *value,
                               char **path)
{
  const char *slash = strrchr(s->name, '/');
  const bool typed = bw_core__config_override(s, id) >= 0;
  char folder[PATH_MAX] = "", *beside = NULL, *here = NULL;
  /* The case file's folder, with its slash; none where the file lies in the present folder. */
  if (!typed && slash != NULL)
    snprintf(folder, sizeof folder, "%.*s", (int)(slash + 1 - s->name), s->name);
  bw_status st = absolute(folder, value, &beside);
  BW_THEN(st, absolute("", value, &here));
  /* A file that stands in neither place is reported where it is looked for first. */
  const bool found = st != BW_OK || access(beside, F_OK) == 0 || access(here, F_OK) != 0;
  *path = found ? beside : here;
  bw_release(found ? &here : &beside);
  if (st != BW_OK) bw_release(path);
  return st;
}
