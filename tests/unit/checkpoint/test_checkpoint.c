/* Checkpoints: what was put is got, bit by bit, on any ranks and any partition.
 * TEST ranks=1,2,3,4 */
#include "checkpoint_test.h"

enum { NX = 5, NY = 8, NZ = 6 };

START_TEST(numbers_texts_and_names)
{
  char path[512];
  ck_path(path, "values.h5");
  const bw_comm *comm = bw_check_world();
  bw_checkpoint *ck = NULL;
  const double x[] = {1.0 / 3.0, -0.0, 1e-308, NAN};
  bw_check_ok(bw_checkpoint_create(comm, path, &ck));
  bw_check_ok(bw_checkpoint_put_numbers(ck, "a/b/x", 4, x));
  bw_check_ok(bw_checkpoint_put_numbers(ck, "none", 0, NULL));
  /* rank 0's text counts */
  bw_check_ok(bw_checkpoint_put_text(ck, "a/text", ck_first() ? "one\ntwo" : "other, longer"));
  bw_check_ok(bw_checkpoint_put_text(ck, "empty", ""));
  ck_assert(bw_checkpoint_has(ck, "a/b/x") && !bw_checkpoint_has(ck, "a/c/x"));
  bw_check_ok(bw_checkpoint_close(&ck));
  ck_assert_ptr_null(ck);

  double y[4] = {0};
  char *text = NULL, *empty = NULL;
  bw_check_ok(bw_checkpoint_open(comm, path, &ck));
  ck_assert(bw_checkpoint_has(ck, "a/b/x") && bw_checkpoint_has(ck, "a/text"));
  ck_assert(!bw_checkpoint_has(ck, "x") && !bw_checkpoint_has(ck, "a/b/x/y") &&
            !bw_checkpoint_has(ck, ""));
  bw_check_ok(bw_checkpoint_get_numbers(ck, "a/b/x", 4, y));
  ck_assert_int_eq(memcmp(x, y, sizeof x), 0);
  bw_check_ok(bw_checkpoint_get_numbers(ck, "none", 0, NULL));
  bw_check_ok(bw_checkpoint_get_text(ck, "a/text", &text));
  ck_assert_str_eq(text, "one\ntwo");
  bw_check_ok(bw_checkpoint_get_text(ck, "empty", &empty));
  ck_assert_str_eq(empty, "");
  bw_release(&text);
  bw_release(&empty);
  bw_check_ok(bw_checkpoint_close(&ck));
}
END_TEST

static bw_grid *make_grid(const bw_comm *comm, int nz, int ranks_y, int ranks_z)
{
  bw_grid_config config = bw_grid_config_default();
  const int n[3] = {NX, NY, nz};
  for (int d = 0; d < 3; d++)
    config.n[d] = n[d], config.length[d] = 1.0;
  config.ranks[0] = ranks_y, config.ranks[1] = ranks_z;
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(comm, &config, &grid));
  return grid;
}

static bw_real value_at(const bw_grid_view *g, int i, int j, int k)
{
  return (bw_real)(1.0 / (3.0 + i + 10 * (j + g->lo[1]) + 100 * (k + g->lo[2])));
}

/* Interior and first faces of `direction` (-1: none) hold their value, the rest `other`. */
static void fill(const bw_grid_view *g, int direction, bw_real other, bw_real *a)
{
  for (size_t q = 0; q < g->size; q++)
    a[q] = other;
  const int lower[3] = {direction == 0 && g->lo[0] == 0 ? 0 : 1,
                        direction == 1 && g->lo[1] == 0 ? 0 : 1,
                        direction == 2 && g->lo[2] == 0 && g->n[2] > 1 ? 0 : 1};
  for (int k = lower[2]; k <= g->m[2]; k++)
    for (int j = lower[1]; j <= g->m[1]; j++)
      for (int i = lower[0]; i <= g->m[0]; i++)
        a[bw_at(g, i, j, k)] = value_at(g, i, j, k);
}

static void put_fields(const char *path, const bw_grid *grid)
{
  static const char *const names[] = {"p", "u", "v", "w"};
  const bw_grid_view *g = bw_grid_look(grid);
  bw_checkpoint *ck = NULL;
  bw_real *a = NULL;
  bw_check_ok(bw_field_create(grid, &a));
  bw_check_ok(bw_checkpoint_create(bw_grid_comm(grid), path, &ck));
  for (int q = 0; q < 4; q++) {
    fill(g, q - 1, (bw_real)-1, a);
    bw_check_ok(bw_checkpoint_put_field(ck, names[q], grid, q - 1, q > 0, a));
  }
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_release(&a);
}

/* Every element of the array is looked at: halos have to stay as they were. */
static void get_fields(const char *path, const bw_grid *grid)
{
  static const char *const names[] = {"p", "u", "v", "w"};
  const bw_grid_view *g = bw_grid_look(grid);
  bw_checkpoint *ck = NULL;
  bw_real *a = NULL, *b = NULL;
  bw_check_ok(bw_field_create(grid, &a));
  bw_check_ok(bw_field_create(grid, &b));
  bw_check_ok(bw_checkpoint_open(bw_grid_comm(grid), path, &ck));
  for (int q = 0; q < 4; q++) {
    fill(g, q - 1, (bw_real)-2, a);
    for (size_t e = 0; e < g->size; e++)
      b[e] = (bw_real)-2;
    bw_check_ok(bw_checkpoint_get_field(ck, names[q], grid, q - 1, q > 0, b));
    ck_assert_int_eq(memcmp(a, b, g->size * sizeof *a), 0);
  }
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_release(&a);
  bw_release(&b);
}

/* Written by blocks of y; read by blocks of z, as chosen by the grid, and by one rank alone. */
static void fields_on_other_partitions(const bw_comm *comm, int nz, const char *name)
{
  char path[512];
  ck_path(path, name);
  const int size = bw_comm_size(bw_check_world());
  const int parts[][2] = {{size, 1}, {nz > 1 ? 1 : size, nz > 1 ? size : 1}, {0, 0}};
  for (int q = 0; q < 3; q++) {
    bw_grid *grid = make_grid(comm, nz, parts[q][0], parts[q][1]);
    if (q == 0) put_fields(path, grid);
    get_fields(path, grid);
    bw_grid_destroy(&grid);
  }
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  bw_grid *alone = make_grid(self, nz, 0, 0);
  get_fields(path, alone);
  bw_grid_destroy(&alone);
  bw_comm_destroy(&self);
}

START_TEST(fields_in_three_dimensions)
{
  fields_on_other_partitions(bw_check_world(), NZ, "fields.h5");
}
END_TEST

START_TEST(fields_in_two_dimensions)
{
  fields_on_other_partitions(bw_check_world(), 1, "flat.h5");
}
END_TEST

/* What a field takes on its way is the inside and less than its halos, whichever way it is long. */
START_TEST(bytes_of_a_field)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  for (int d = 0; d < 3; d++) {
    bw_grid_config c = bw_grid_config_default();
    bw_grid *grid = NULL;
    for (int e = 0; e < 3; e++)
      c.n[e] = e == d ? 64 : 4, c.length[e] = c.n[e];
    bw_check_ok(bw_grid_plan(self, &c, &grid));
    const double bytes = bw_checkpoint_field_bytes(grid) / (double)sizeof(bw_real);
    ck_assert_double_ge(bytes, 64 * 4 * 4);
    ck_assert_double_le(bytes, 66 * 6 * 6);
    bw_grid_destroy(&grid);
  }
  bw_comm_destroy(&self);
}
END_TEST

/* Rank r puts the ids that leave r modulo the ranks; the last of several ranks puts none. */
static void tables_by_ids(const bw_comm *comm, const bw_comm *reader, const char *name)
{
  enum { TOTAL = 1001 };
  char path[512];
  ck_path(path, name);
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  const int writers = size > 1 ? size - 1 : 1;
  int64_t *id = NULL;
  double *x = NULL;
  uint8_t *flag = NULL;
  int32_t *count = NULL;
  bw_check_ok(BW_ALLOCATE(&id, TOTAL));
  bw_check_ok(BW_ALLOCATE(&x, 2 * TOTAL));
  bw_check_ok(BW_ALLOCATE(&flag, TOTAL));
  bw_check_ok(BW_ALLOCATE(&count, 3 * TOTAL));
  size_t n = 0;
  for (int64_t q = TOTAL - 1 - me; q >= 0 && me < writers; q -= writers, n++) {
    id[n] = q;
    x[2 * n] = 1.0 / (double)(q + 1), x[2 * n + 1] = -(double)q;
    flag[n] = (uint8_t)(q % 251);
    for (size_t c = 0; c < 3; c++)
      count[3 * n + c] = (int32_t)(7 * q) - 3000 + (int32_t)c;
  }
  bw_checkpoint *ck = NULL;
  bw_check_ok(bw_checkpoint_create(comm, path, &ck));
  bw_check_ok(bw_checkpoint_put_table(ck, "x", TOTAL, n, id, 2, BW_CK_DOUBLE, x));
  bw_check_ok(bw_checkpoint_put_table(ck, "flag", TOTAL, n, id, 1, BW_CK_UINT8, flag));
  bw_check_ok(bw_checkpoint_put_table(ck, "count", TOTAL, n, id, 3, BW_CK_INT32, count));
  bw_check_ok(bw_checkpoint_put_table(ck, "nobody", 0, 0, NULL, 3, BW_CK_DOUBLE, NULL));
  bw_check_ok(bw_checkpoint_close(&ck));

  /* 400 ids in no order, some more than once and by several ranks; rank 0 of several none */
  n = size > 1 && me == 0 ? 0 : 400;
  for (size_t i = 0; i < n; i++)
    id[i] = (int64_t)(((size_t)me * 37 + i * i * 13 + 5) % TOTAL);
  bw_check_ok(bw_checkpoint_open(reader, path, &ck));
  bw_check_ok(bw_checkpoint_get_table(ck, "x", TOTAL, n, id, 2, BW_CK_DOUBLE, x));
  bw_check_ok(bw_checkpoint_get_table(ck, "flag", TOTAL, n, id, 1, BW_CK_UINT8, flag));
  bw_check_ok(bw_checkpoint_get_table(ck, "count", TOTAL, n, id, 3, BW_CK_INT32, count));
  bw_check_ok(bw_checkpoint_get_table(ck, "nobody", 0, 0, NULL, 3, BW_CK_DOUBLE, NULL));
  bw_check_ok(bw_checkpoint_close(&ck));
  for (size_t i = 0; i < n; i++) {
    ck_assert_double_eq(x[2 * i], 1.0 / (double)(id[i] + 1));
    ck_assert_double_eq(x[2 * i + 1], -(double)id[i]);
    ck_assert_int_eq(flag[i], (int)(id[i] % 251));
    for (size_t c = 0; c < 3; c++)
      ck_assert_int_eq(count[3 * i + c], (int)(7 * id[i] - 3000 + (int64_t)c));
  }
  bw_release(&id);
  bw_release(&x);
  bw_release(&flag);
  bw_release(&count);
}

START_TEST(tables_by_other_ids)
{
  tables_by_ids(bw_check_world(), bw_check_world(), "tables.h5");
}
END_TEST

/* Shares that are moved in many operations, and by some ranks in fewer than by others. 200 bytes
 * are 12 rows of a table of 1001, or one layer of a field. What was written so is read in one
 * operation as well, and the other way round. */
START_TEST(in_many_operations)
{
  bw_comm *cut = NULL;
  bw_check_ok(bw_comm_copy(bw_check_world(), 200, &cut));
  fields_on_other_partitions(cut, NZ, "fields.h5"); /* one rank alone reads them in one */
  tables_by_ids(cut, bw_check_world(), "tables.h5");
  tables_by_ids(bw_check_world(), cut, "tables.h5");
  bw_comm_destroy(&cut);
}
END_TEST

/* The same state gives the same bytes of data, hence the same file size, on any ranks; and one
 * rank reads what all wrote. */
START_TEST(one_rank_reads_what_all_wrote)
{
  char path[512];
  ck_path(path, "state.h5");
  bw_check_ok(ck_put_state(path));
  bw_check_ok(ck_get_state(bw_check_world(), path));
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  bw_check_ok(ck_get_state(self, path));
  bw_comm_destroy(&self);
}
END_TEST

static bool exists(const char *path, const char *tail)
{
  char name[520];
  snprintf(name, sizeof name, "%s%s", path, tail);
  return bw_path_exists(bw_check_world(), name);
}

/* An interrupted or failed write leaves the good file as it was. */
START_TEST(a_good_file_is_not_replaced_by_a_bad_one)
{
  char path[512];
  ck_path(path, "kept.h5");
  const bw_comm *comm = bw_check_world();
  bw_check_ok(ck_put_state(path));
  ck_assert(!exists(path, ".part"));

  bw_checkpoint *ck = NULL;
  bw_check_ok(bw_checkpoint_create(comm, path, &ck));
  bw_check_ok(bw_checkpoint_put_numbers(ck, "time", 1, (const double[]){9.0}));
  ck_assert(exists(path, ".part"));
  bw_checkpoint_abandon(&ck);
  ck_assert_ptr_null(ck);
  ck_assert(!exists(path, ".part"));
  bw_check_ok(ck_get_state(comm, path));

  bw_check_ok(bw_checkpoint_create(comm, path, &ck));
  bw_check_ok(bw_checkpoint_put_numbers(ck, "time", 1, (const double[]){9.0}));
  bw_check_status(bw_checkpoint_put_numbers(ck, "time", 1, (const double[]){8.0}), BW_EINPUT);
  ck_message_names(path, "'time'");
  bw_check_status(bw_checkpoint_close(&ck), BW_EINPUT);
  ck_assert_ptr_null(ck);
  ck_assert(!exists(path, ".part"));
  bw_check_ok(ck_get_state(comm, path));
  bw_checkpoint_abandon(&ck);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(bytes_of_a_field),
                                      BW_TEST(numbers_texts_and_names),
                                      BW_TEST(fields_in_three_dimensions),
                                      BW_TEST(fields_in_two_dimensions),
                                      BW_TEST(tables_by_other_ids),
                                      BW_TEST(in_many_operations),
                                      BW_TEST(one_rank_reads_what_all_wrote),
                                      BW_TEST(a_good_file_is_not_replaced_by_a_bad_one)};
BW_CHECK_MAIN("checkpoint", tests)
