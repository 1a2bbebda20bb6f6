#include "bw_config.h"
#include "bw_file.h"
#include "bw_memory.h"
#include "config_internal.h"

#include <string.h>

/* All of it on one rank, from the text of the file. */
static bw_status load(const char *name, const char *text, size_t bytes,
                      const bw_config_field fields[], int n_overrides,
                      const char *const overrides[], size_t size, void *config)
{
  bw_core__config_source source;
  char *accepted = NULL;
  void *loaded = NULL;
  bw_status st = bw_core__config_read(name, text, bytes, fields, n_overrides, overrides, &source);
  BW_THEN(st, bw_core__config_check(&source, fields, config, &accepted));
  BW_THEN(st, bw_core__config_convert(accepted, fields, size, &loaded));
  /* Nothing was wrong: only now the caller's struct is written, and only where a value was
   * given. */
  if (st == BW_OK) bw_core__config_copy(&source, fields, source.root, loaded, config);
  bw_core__config_free(&source);
  bw_release(&accepted);
  bw_release(&loaded);
  return st;
}

bw_status bw_config_load(const bw_comm *comm, const char *path, const bw_config_field fields[],
                         int n_overrides, const char *const overrides[], size_t size, void *config)
{
  const bool reader = bw_comm_rank(comm) == 0;
  bw_status st = BW_OK;
  if (reader) {
    bw_comm *self = NULL;
    char *text = NULL;
    size_t bytes = 0;
    /* A communicator of this rank alone: reading must not wait for ranks that do not read. */
    if (path != NULL) {
      st = bw_comm_self(&self);
      BW_THEN(st, bw_file_read_text(self, path, &bytes, &text));
      bw_comm_destroy(&self);
    }
    BW_THEN(st, load(path != NULL ? path : "(no file)", text != NULL ? text : "", bytes, fields,
                     n_overrides, overrides, size, config));
    bw_release(&text);
  }
  /* All know how it went. The struct is plain memory without pointers: its bytes are the
   * message. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) bw_comm_broadcast(comm, size, config);
  return st;
}
