/* Fuzzer of case files.
 * BUILD modules=core,shape */
#include "fuzz.h"
#include "fuzz_case.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  fuzz_case c = fuzz_case_default();
  const char *path = fuzz_file("case.yaml", data, size);
  const bw_status st = bw_config_load(fuzz_comm(), path, fuzz_fields, 0, NULL, sizeof c, &c);
  if (st != BW_OK && bw_last_message()[0] == 0) abort();
  if (st == BW_OK) fuzz_there_and_back(&c);
  return 0;
}
