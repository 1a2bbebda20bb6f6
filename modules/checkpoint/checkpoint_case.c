/* Whose a checkpoint is: the program that wrote it, and its case. */
#include "bw_memory.h"
#include "checkpoint_internal.h"

static const char program_name[] = "case/program", version_name[] = "case/version",
                  parameters_name[] = "case/parameters";

bw_status bw_checkpoint_put_case(bw_checkpoint *ck, const bw_case *run)
{
  if (run == NULL) return BW_OK;
  BW_TRY(bw_checkpoint_put_text(ck, program_name, bw_case_program(run)));
  BW_TRY(bw_checkpoint_put_text(ck, version_name, bw_version()));
  return bw_checkpoint_put_text(ck, parameters_name, bw_case_parameters(run));
}

bw_status bw_checkpoint_read_case(const bw_comm *comm, const char *path, char **program,
                                  char **parameters)
{
  bw_checkpoint *ck = NULL;
  *program = *parameters = NULL;
  BW_TRY(bw_checkpoint_open(comm, path, &ck));
  bw_status st = BW_OK;
  if (!bw_checkpoint_has(ck, program_name) || !bw_checkpoint_has(ck, parameters_name))
    st = BW_FAIL(BW_EIO,
                 "checkpoint %s: it does not say which program wrote it ('%s' is missing); it is "
                 "none of a case, or of an earlier version",
                 path, program_name);
  BW_THEN(st, bw_checkpoint_get_text(ck, program_name, program));
  BW_THEN(st, bw_checkpoint_get_text(ck, parameters_name, parameters));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  if (st != BW_OK) {
    bw_release(program);
    bw_release(parameters);
  }
  return st;
}
