/* Tables of a run: in memory first, so that the disk has all of one or what was there before. */
#include "bw_file.h"
#include "bw_memory.h"
#include "case_internal.h"

bw_status bw_case_text_begin(const bw_case *run, bw_case_text *t)
{
  bw_status st = BW_OK;
  *t = (bw_case_text){0};
  if (bw_comm_rank(run->args.comm) == 0) {
    t->out = open_memstream(&t->text, &t->length);
    if (t->out == NULL) st = BW_FAIL(BW_EMEM, "no memory for a text");
  }
  return bw_comm_agree(run->args.comm, st);
}

bw_status bw_case_text_end(const bw_case *run, bw_case_text *t, const char *name, bw_status st)
{
  char *path = NULL;
  /* The text is whole only where its stream could grow and was closed. */
  const bool whole = t->out == NULL || !ferror(t->out);
  const bool closed = t->out == NULL || fclose(t->out) == 0;
  if (st == BW_OK && !(whole && closed)) st = BW_FAIL(BW_EMEM, "%s: no memory for it", name);
  st = bw_comm_agree(run->args.comm, st);
  BW_THEN(st, bw_case_path(run, name, &path));
  BW_THEN(st, bw_file_write_text(run->args.comm, path, t->text));
  bw_release(&path);
  bw_release(&t->text);
  *t = (bw_case_text){0};
  return st;
}
