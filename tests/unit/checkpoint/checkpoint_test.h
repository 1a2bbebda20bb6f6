/* checkpoint_test.h -- paths, bytes of files and a state to store, for the tests of checkpoint. */
#pragma once
#include "bw_check.h"
#include "bw_checkpoint.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include <stdio.h>
#include <string.h>

/* PATH of a file of this program; one folder per number of ranks, as tests run side by side. */
static inline void ck_path(char path[512], const char *name)
{
  const char *build = getenv("BW_BUILD_DIR");
  char folder[400];
  snprintf(folder, sizeof folder, "%s/checkpoint_test_np%d", build != NULL ? build : "build",
           bw_comm_size(bw_check_world()));
  bw_check_ok(bw_folder_make(bw_check_world(), folder));
  snprintf(path, 512, "%s/%s", folder, name);
}

static inline bool ck_first(void)
{
  return bw_comm_rank(bw_check_world()) == 0;
}

/* The message names the file (and `what`, unless NULL) in one line. */
static inline void ck_message_names(const char *path, const char *what)
{
  const char *message = bw_last_message();
  ck_assert_msg(strstr(message, path) != NULL, "'%s' does not name %s", message, path);
  ck_assert_msg(what == NULL || strstr(message, what) != NULL, "'%s' does not say '%s'", message,
                what);
  ck_assert_ptr_null(strchr(message, '\n'));
}

static inline size_t ck_read_bytes(const char *path, unsigned char **bytes)
{
  FILE *f = fopen(path, "rb");
  ck_assert_ptr_nonnull(f);
  fseek(f, 0, SEEK_END);
  const size_t n = (size_t)ftell(f);
  rewind(f);
  bw_check_ok(BW_ALLOCATE(bytes, n));
  ck_assert_uint_eq(fread(*bytes, 1, n, f), n);
  fclose(f);
  return n;
}

/* By rank 0; the others wait. */
static inline void ck_write_bytes(const char *path, size_t n, const unsigned char *bytes)
{
  if (ck_first()) {
    FILE *f = fopen(path, "wb");
    ck_assert_ptr_nonnull(f);
    ck_assert_uint_eq(fwrite(bytes, 1, n, f), n);
    fclose(f);
  }
  bw_comm_barrier(bw_check_world());
}

/* A small state: two numbers, a text, a table of 11 rows in round-robin order. */
enum { STATE_ROWS = 11 };

static inline double ck_state_value(int64_t id, int c)
{
  return (double)id + 0.125 * c + 1.0 / 3.0;
}

static inline bw_status ck_put_state(const char *path)
{
  const bw_comm *comm = bw_check_world();
  bw_checkpoint *ck = NULL;
  int64_t id[STATE_ROWS];
  double rows[3 * STATE_ROWS];
  size_t n = 0;
  for (int q = bw_comm_rank(comm); q < STATE_ROWS; q += bw_comm_size(comm), n++) {
    id[n] = STATE_ROWS - 1 - q;
    for (int c = 0; c < 3; c++)
      rows[3 * n + (size_t)c] = ck_state_value(id[n], c);
  }
  BW_TRY(bw_checkpoint_create(comm, path, &ck));
  bw_status st = bw_checkpoint_put_numbers(ck, "time", 2, (const double[]){0.1, 2.0});
  BW_THEN(st, bw_checkpoint_put_text(ck, "case", "horizon: 3.0\n"));
  BW_THEN(st, bw_checkpoint_put_table(ck, "solid/x", STATE_ROWS, n, id, 3, BW_CK_DOUBLE, rows));
  if (st != BW_OK) {
    bw_checkpoint_abandon(&ck);
    return st;
  }
  return bw_checkpoint_close(&ck);
}

/* Read all of the state on `comm`. BW_OK only comes with the right values. */
static inline bw_status ck_get_state(const bw_comm *comm, const char *path)
{
  bw_checkpoint *ck = NULL;
  double time[2] = {0, 0}, rows[3 * STATE_ROWS];
  char *text = NULL;
  int64_t id[STATE_ROWS];
  for (int q = 0; q < STATE_ROWS; q++)
    id[q] = (5 * q) % STATE_ROWS;
  BW_TRY(bw_checkpoint_open(comm, path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "time", 2, time);
  BW_THEN(st, bw_checkpoint_get_text(ck, "case", &text));
  BW_THEN(st, bw_checkpoint_get_table(ck, "solid/x", STATE_ROWS, STATE_ROWS, id, 3, BW_CK_DOUBLE,
                                      rows));
  if (st == BW_OK) {
    ck_assert_double_eq(time[0], 0.1);
    ck_assert_double_eq(time[1], 2.0);
    ck_assert_str_eq(text, "horizon: 3.0\n");
    for (int q = 0; q < STATE_ROWS; q++)
      for (int c = 0; c < 3; c++)
        ck_assert_double_eq(rows[3 * q + c], ck_state_value(id[q], c));
  }
  bw_release(&text);
  if (st != BW_OK) {
    bw_checkpoint_abandon(&ck);
    return st;
  }
  return bw_checkpoint_close(&ck);
}
