/* Fuzzer of checkpoints: the bytes are changes to a good one (fuzz_patched), of which all is read,
 * numbers, texts, a field, a table.
 * BUILD modules=checkpoint,shape */
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 6 };

static bw_grid *make_grid(void)
{
  bw_grid_config config = bw_grid_config_default();
  bw_grid *grid = NULL;
  for (int d = 0; d < 3; d++)
    config.n[d] = 4, config.length[d] = 1.0;
  if (bw_grid_create(fuzz_comm(), &config, &grid) != BW_OK) abort();
  return grid;
}

/* A checkpoint with one of everything. */
static bw_status write_all(const bw_grid *grid, const char *path)
{
  bw_checkpoint *ck = NULL;
  bw_real *field = NULL;
  const double x[3] = {1.0 / 3.0, -0.0, 1e300};
  int64_t id[ROWS];
  double row[2 * ROWS];
  for (int q = 0; q < ROWS; q++)
    id[q] = q, row[2 * q] = q, row[2 * q + 1] = -q;
  BW_TRY(bw_checkpoint_create(fuzz_comm(), path, &ck));
  bw_status st = bw_field_create(grid, &field);
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "run/x", 3, x));
  BW_THEN(st, bw_checkpoint_put_text(ck, "run/name", "a run"));
  BW_THEN(st, bw_checkpoint_put_field(ck, "u", grid, 0, true, field));
  BW_THEN(st, bw_checkpoint_put_table(ck, "rows", ROWS, ROWS, id, 2, BW_CK_DOUBLE, row));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_release(&field);
  return st;
}

static void read_all(bw_checkpoint *ck, const bw_grid *grid)
{
  static const int64_t id[2] = {ROWS - 1, 0};
  double x[3], row[4];
  char *text = NULL;
  bw_real *field = NULL;
  bw_status st[4];
  if (bw_field_create(grid, &field) != BW_OK) abort();
  st[0] = bw_checkpoint_get_numbers(ck, "run/x", 3, x);
  st[1] = bw_checkpoint_get_text(ck, "run/name", &text);
  if ((st[1] == BW_OK) != (text != NULL)) abort();
  st[2] = bw_checkpoint_get_field(ck, "u", grid, 0, true, field);
  st[3] = bw_checkpoint_get_table(ck, "rows", ROWS, 2, id, 2, BW_CK_DOUBLE, row);
  /* What its check sum lets through is what was written. */
  if (st[0] == BW_OK && x[2] != 1e300) abort();
  if (st[1] == BW_OK && strcmp(text, "a run") != 0) abort();
  if (st[3] == BW_OK && (row[0] != ROWS - 1 || row[3] != 0.0)) abort();
  bw_release(&text);
  bw_release(&field);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static bw_grid *grid;
  static fuzz_base good;
  bw_checkpoint *ck = NULL;
  if (grid == NULL) {
    grid = make_grid();
    if (write_all(grid, fuzz_file("good.h5", NULL, 0)) != BW_OK) abort();
    fuzz_read("good.h5", &good);
  }
  const char *path = fuzz_patched("state.h5", &good, data, size);
  bw_status st = bw_checkpoint_open(fuzz_comm(), path, &ck);
  if ((st == BW_OK) != (ck != NULL) || (st != BW_OK && bw_last_message()[0] == 0)) abort();
  if (st == BW_OK) {
    read_all(ck, grid);
    if (bw_checkpoint_close(&ck) != BW_OK || ck != NULL) abort();
  }
  return 0;
}
