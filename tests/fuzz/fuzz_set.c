/* Fuzzer of --set: each line of the bytes is one.
 * BUILD modules=core,shape */
#include "fuzz.h"
#include "fuzz_case.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  enum { MOST = 8 };
  char text[2000];
  const char *line[MOST];
  int n = 0;
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  /* Arguments of a command line end at a byte of 0, and so does this. */
  for (char *at = text; n < MOST && *at != 0;) {
    line[n++] = at;
    at += strcspn(at, "\n");
    if (*at != 0) *at++ = 0;
  }
  fuzz_case c = fuzz_case_default();
  const bw_status st = bw_config_load(fuzz_comm(), NULL, fuzz_fields, n, line, sizeof c, &c);
  if (st != BW_OK && bw_last_message()[0] == 0) abort();
  if (st == BW_OK) fuzz_there_and_back(&c);
  return 0;
}
