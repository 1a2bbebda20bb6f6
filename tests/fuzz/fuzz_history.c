/* Fuzzer of histories that a restart goes on with: the first byte says how many rows the checkpoint
 * counts.
 * BUILD modules=core,shape */
#include "bw_history.h"
#include "fuzz.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const char *const names[] = {"time[s]", "drag[N]", "lift[N]"};
  static const double row[] = {1e6, 2.0, 3.0};
  bw_history *h = NULL;
  if (size == 0) return 0;
  const char *path = fuzz_file("history.csv", data + 1, size - 1);
  const int64_t rows = (int64_t)(data[0] & 15) - 1;
  bw_status st = bw_history_create(fuzz_comm(), path, 3, names, 0.25 * (data[0] >> 4), rows, &h);
  if ((st == BW_OK) != (h != NULL) || (st != BW_OK && bw_last_message()[0] == 0)) abort();
  if (st == BW_OK) {
    /* What was accepted takes another row, and is accepted again with it. */
    bw_history_append(h, row);
    const int64_t all = bw_history_rows(h);
    if (bw_history_close(fuzz_comm(), &h) != BW_OK) abort();
    st = bw_history_create(fuzz_comm(), path, 3, names, 1e6, all, &h);
    if (st != BW_OK || bw_history_rows(h) != all) abort();
    if (bw_history_close(fuzz_comm(), &h) != BW_OK) abort();
  }
  return 0;
}
