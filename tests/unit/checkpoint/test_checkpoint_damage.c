/* Checkpoints that cannot be used are refused with a line that says why; damaged ones never give
 * wrong values.
 * BUILD libs=hdf5
 * TEST  ranks=1,2,4 */
#include "checkpoint_test.h"

#include <hdf5.h>

static void refused(const char *path, const char *why)
{
  bw_checkpoint *ck = NULL;
  bw_check_status(bw_checkpoint_open(bw_check_world(), path, &ck), BW_EIO);
  ck_assert_ptr_null(ck);
  ck_message_names(path, why);
}

START_TEST(missing_and_foreign_files)
{
  char path[512];
  bw_checkpoint *ck = NULL;
  ck_path(path, "no/such.h5");
  refused(path, "No such file");
  bw_check_status(bw_checkpoint_create(bw_check_world(), path, &ck), BW_EIO);
  ck_assert_ptr_null(ck);
  ck_message_names(path, "No such file");
  ck_path(path, ".");
  refused(path, "directory");

  ck_path(path, "empty.h5");
  ck_write_bytes(path, 0, (const unsigned char *)"");
  refused(path, "not HDF5");
  ck_path(path, "text.h5");
  ck_write_bytes(path, 12, (const unsigned char *)"solid: true\n");
  refused(path, "not HDF5");
}
END_TEST

/* An HDF5 file of somebody else's; then, step by step, what a checkpoint has in its head. */
static void write_head(const char *path, int members, uint64_t format, uint64_t real,
                       uint64_t complete)
{
  static const char *const names[] = {"breakwater_format", "complete", "bytes_per_real"};
  const uint64_t values[] = {format, complete, real};
  if (ck_first()) {
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate(H5S_SCALAR);
    for (int q = 0; q < members; q++) {
      const hid_t a =
          H5Acreate2(file, names[q], H5T_NATIVE_UINT64, space, H5P_DEFAULT, H5P_DEFAULT);
      ck_assert_int_ge(H5Awrite(a, H5T_NATIVE_UINT64, &values[q]), 0);
      H5Aclose(a);
    }
    H5Sclose(space);
    H5Fclose(file);
  }
  bw_comm_barrier(bw_check_world());
}

START_TEST(heads_of_other_files)
{
  char path[512];
  const uint64_t real = sizeof(bw_real), other = 12 - real;
  ck_path(path, "head.h5");
  write_head(path, 0, 1, real, 1);
  refused(path, "no checkpoint of Breakwater");
  write_head(path, 3, 2, real, 1);
  refused(path, "format 2, expected 1");
  write_head(path, 1, 1, real, 1);
  refused(path, "not complete");
  write_head(path, 3, 1, real, 0);
  refused(path, "not complete");
  write_head(path, 3, 1, other, 1);
  refused(path, other == 4 ? "reals have 4 bytes, expected 8" : "reals have 8 bytes, expected 4");
  bw_checkpoint *ck = NULL;
  write_head(path, 3, 1, real, 1);
  bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
  bw_check_ok(bw_checkpoint_close(&ck));
}
END_TEST

/* Every length but the whole is refused. */
START_TEST(files_cut_short)
{
  char path[512];
  unsigned char *bytes = NULL;
  ck_path(path, "short.h5");
  bw_check_ok(ck_put_state(path));
  const size_t n = ck_read_bytes(path, &bytes);
  bw_comm_barrier(bw_check_world());
  for (size_t length = 1; length < n; length += 1 + n / 40) {
    ck_write_bytes(path, length, bytes);
    refused(path, NULL);
  }
  ck_write_bytes(path, n - 1, bytes);
  refused(path, "cut short");
  ck_write_bytes(path, n, bytes);
  bw_check_ok(ck_get_state(bw_check_world(), path));
  bw_release(&bytes);
}
END_TEST

static size_t find(const unsigned char *bytes, size_t n, const void *what, size_t size)
{
  for (size_t q = 0; q + size <= n; q++)
    if (memcmp(bytes + q, what, size) == 0) return q;
  return n;
}

/* A bit of the data: the checksum notices, on every rank, and names the data set. */
START_TEST(flipped_bits_of_data)
{
  char path[512];
  unsigned char *bytes = NULL;
  ck_path(path, "flipped.h5");
  bw_check_ok(ck_put_state(path));
  const size_t n = ck_read_bytes(path, &bytes);
  bw_comm_barrier(bw_check_world());
  const double row7 = ck_state_value(7, 1);
  const struct {
    const void *what;
    size_t size;
    const char *name;
  } data[] = {{&row7, sizeof row7, "'solid/x'"}, {"horizon: 3", 10, "'case'"}};
  for (int q = 0; q < 2; q++) {
    const size_t at = find(bytes, n, data[q].what, data[q].size);
    ck_assert_uint_lt(at, n);
    bytes[at] ^= 1;
    ck_write_bytes(path, n, bytes);
    bytes[at] ^= 1;
    bw_check_status(ck_get_state(bw_check_world(), path), BW_EIO);
    ck_message_names(path, data[q].name);
    ck_message_names(path, "checksum");
  }
  bw_release(&bytes);
}
END_TEST

/* Two rows in each other's place: every bit is there, but not where it was. */
START_TEST(rows_that_changed_places)
{
  enum { ROW = 3 * sizeof(double) };
  char path[512];
  unsigned char *bytes = NULL, row[ROW];
  ck_path(path, "swapped.h5");
  bw_check_ok(ck_put_state(path));
  const size_t n = ck_read_bytes(path, &bytes);
  bw_comm_barrier(bw_check_world());
  const double row2 = ck_state_value(2, 0);
  const size_t at = find(bytes, n, &row2, sizeof row2);
  ck_assert_uint_lt(at + 2 * ROW, n);
  memcpy(row, bytes + at, ROW);
  memcpy(bytes + at, bytes + at + ROW, ROW);
  memcpy(bytes + at + ROW, row, ROW);
  ck_write_bytes(path, n, bytes);
  bw_check_status(ck_get_state(bw_check_world(), path), BW_EIO);
  ck_message_names(path, "'solid/x' is damaged");
  bw_release(&bytes);
}
END_TEST

/* A flipped bit anywhere: refused, or it sat where nothing is kept and all values are right
 * (ck_get_state compares them). */
START_TEST(flipped_bits_anywhere)
{
  char path[512];
  unsigned char *bytes = NULL;
  ck_path(path, "anywhere.h5");
  bw_check_ok(ck_put_state(path));
  const size_t n = ck_read_bytes(path, &bytes);
  bw_comm_barrier(bw_check_world());
  const size_t stride = 1 + n / (bw_comm_size(bw_check_world()) == 1 ? 2000 : 150);
  size_t harmless = 0, tried = 0;
  for (size_t at = 0; at < n; at += stride, tried++) {
    const unsigned char bit = (unsigned char)(1u << (at % 8));
    bytes[at] ^= bit;
    ck_write_bytes(path, n, bytes);
    bytes[at] ^= bit;
    const bw_status st = ck_get_state(bw_check_world(), path);
    harmless += st == BW_OK;
    ck_assert_msg(st == BW_OK || st == BW_EIO, "bit of byte %zu: status %d, %s", at, (int)st,
                  bw_last_message());
    if (st != BW_OK) ck_message_names(path, NULL);
  }
  ck_assert_uint_lt(harmless, tried);
  bw_release(&bytes);
}
END_TEST

START_TEST(requests_that_do_not_fit)
{
  char path[512];
  ck_path(path, "fit.h5");
  bw_check_ok(ck_put_state(path));
  bw_checkpoint *ck = NULL;
  double x[99];
  char *text = NULL;
  const int64_t id[] = {0, STATE_ROWS};
  bw_check_ok(bw_checkpoint_open(bw_check_world(), path, &ck));
  bw_check_status(bw_checkpoint_get_numbers(ck, "tine", 2, x), BW_EIO);
  ck_message_names(path, "no data set 'tine'");
  bw_check_status(bw_checkpoint_get_numbers(ck, "time", 3, x), BW_EIO);
  ck_message_names(path, "'time' has size 2, expected 3");
  bw_check_status(bw_checkpoint_get_text(ck, "time", &text), BW_EIO);
  ck_message_names(path, "'time' is numbers, expected a text");
  ck_assert_ptr_null(text);
  bw_check_status(bw_checkpoint_get_table(ck, "solid/x", 12, 1, id, 3, BW_CK_DOUBLE, x), BW_EIO);
  ck_message_names(path, "'solid/x' has size 11 x 3, expected 12 x 3");
  bw_check_status(bw_checkpoint_get_table(ck, "solid/x", 11, 1, id, 3, BW_CK_INT32, x), BW_EIO);
  ck_message_names(path, "another type");
  bw_check_status(bw_checkpoint_get_table(ck, "solid/x", 11, 2, id, 3, BW_CK_DOUBLE, x), BW_EINPUT);
  ck_message_names(path, "ids 0 to 10, not 11");
  bw_check_status(bw_checkpoint_put_numbers(ck, "more", 1, x), BW_EINPUT);
  bw_check_ok(bw_checkpoint_close(&ck));
}
END_TEST

/* Ids of a table that are not each of 0 .. total-1 once. */
START_TEST(tables_with_wrong_ids)
{
  char path[512];
  ck_path(path, "ids.h5");
  const bw_comm *comm = bw_check_world();
  const bool last = bw_comm_rank(comm) == bw_comm_size(comm) - 1;
  const int64_t ids[][3] = {{0, 1, 1}, {0, 1, 3}, {-1, 0, 1}};
  const char *const why[] = {"id 1 twice", "not 3", "not -1"};
  const double rows[3] = {0};
  bw_checkpoint *ck = NULL;
  for (int q = 0; q < 4; q++) {
    bw_check_ok(bw_checkpoint_create(comm, path, &ck));
    const size_t n = !last ? 0 : q < 3 ? 3 : 2;
    bw_check_status(bw_checkpoint_put_table(ck, "x", 3, n, ids[q % 3], 1, BW_CK_DOUBLE, rows),
                    BW_EINPUT);
    ck_message_names(path, q < 3 ? why[q] : "no row with id 2");
    bw_check_status(bw_checkpoint_close(&ck), BW_EINPUT);
  }
  /* Neither fewer than no rows nor rows of nothing. */
  for (int q = 0; q < 2; q++) {
    bw_check_ok(bw_checkpoint_create(comm, path, &ck));
    bw_check_status(
        bw_checkpoint_put_table(ck, "x", q == 0 ? -1 : 0, 0, NULL, 1 - q, BW_CK_DOUBLE, NULL),
        BW_EINPUT);
    ck_message_names(path, q == 0 ? "of -1 rows" : "with 0 components");
    bw_check_status(bw_checkpoint_close(&ck), BW_EINPUT);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(missing_and_foreign_files), BW_TEST(heads_of_other_files),
    BW_TEST(files_cut_short),           BW_TEST(flipped_bits_of_data),
    BW_TEST(rows_that_changed_places),  BW_TEST(flipped_bits_anywhere),
    BW_TEST(requests_that_do_not_fit),  BW_TEST(tables_with_wrong_ids)};
BW_CHECK_MAIN("checkpoint.damage", tests)
