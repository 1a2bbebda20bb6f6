/* The list of files of a time series, .pvd. */
#include "bw_folder.h"
#include "bw_memory.h"
#include "vtk_internal.h"

#include <stdlib.h>
#include <string.h>

static const char head[] = "<?xml version=\"1.0\"?>\n"
                           "<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
static const char entry_begin[] = "    <DataSet timestep=\"";

/* Keep the entries of the old list whose time is below `time`: one line each, as written here. */
static bw_status keep_earlier(bw_vtk__text *text, const char *path, char *old, double time)
{
  BW_REQUIRE(strncmp(old, head, strlen(head)) == 0, BW_EIO,
             "%s is there and is not a time series of Breakwater; move it away", path);
  /* What the run wrote from this time on before it was restarted is dropped. */
  for (char *line = old + strlen(head); *line != '\0';) {
    char *end = strchr(line, '\n');
    if (end != NULL) *end = '\0';
    if (strncmp(line, entry_begin, strlen(entry_begin)) == 0 &&
        strtod(line + strlen(entry_begin), NULL) < time)
      bw_vtk__add(text, "%s\n", line);
    if (end == NULL) break;
    line = end + 1;
  }
  return BW_OK;
}

bw_status bw_vtk_series_add(const bw_comm *comm, const char *path, double time, const char *file)
{
  bw_vtk__text text = {0};
  char *old = NULL;
  /* The whole list is written anew, so that it is a valid file at any time. */
  bw_vtk__add(&text, "%s", head);
  bw_status st = BW_OK;
  if (bw_path_exists(comm, path)) {
    st = bw_file_read_text(comm, path, NULL, &old);
    BW_THEN(st, keep_earlier(&text, path, old, time));
  }
  bw_release(&old);
  /* Only entries earlier than this one are left: times increase down the list. */
  bw_vtk__add(&text, "%s%.17g\" part=\"0\" file=\"", entry_begin, time);
  bw_vtk__add_escaped(&text, file);
  bw_vtk__add(&text, "\"/>\n  </Collection>\n</VTKFile>\n");
  /* Memory may have run out on one rank in any of the additions above. */
  if (st == BW_OK) st = text.status;
  st = bw_comm_agree(comm, st);
  BW_THEN(st, bw_file_write_text(comm, path, text.chars));
  bw_release(&text.chars);
  return st;
}
