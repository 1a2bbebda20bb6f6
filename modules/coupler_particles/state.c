/* The state of fluid and solid on its way into a checkpoint and back. */
#include "bw_memory.h"
#include "coupler_particles_internal.h"

#include <string.h>

/* Rows of the fluid, and what is between the two. */
typedef struct {
  double *rows, *solid, *body, *own; /* of fluid, solid, body; of the body those of this rank */
  int64_t *id;
  uint8_t *bits;
} table;

enum { SUMS = 5 };

static bw_status table_make(const bw_coupler_particles *c, size_t n, table *t)
{
  bw_status st = BW_OK;
  memset(t, 0, sizeof *t);
  st = BW_ALLOCATE(&t->rows, BW_ULPH_ROW * n);
  BW_THEN(st, BW_ALLOCATE(&t->id, n));
  BW_THEN(st, BW_ALLOCATE(&t->solid, bw_solid_restart_row(c->solid) * c->n));
  BW_THEN(st, BW_ALLOCATE(&t->bits, bw_solid_bits_bytes(c->solid) * c->n));
  BW_THEN(st, BW_ALLOCATE(&t->body, BW_ULPH_BODY_ROW * c->total));
  BW_THEN(st, BW_ALLOCATE(&t->own, BW_ULPH_BODY_ROW * c->n));
  return bw_comm_agree(bw_solid_comm(c->solid), st);
}

static void table_release(table *t)
{
  bw_release(&t->rows);
  bw_release(&t->solid);
  bw_release(&t->body);
  bw_release(&t->own);
  bw_release(&t->id);
  bw_release(&t->bits);
}

/* Which solid it is: its fingerprint in two halves, which doubles hold. */
static void print_of(const bw_coupler_particles *c, double numbers[2])
{
  const uint64_t print = bw_solid_fingerprint(c->solid);
  numbers[0] = (double)(print >> 32), numbers[1] = (double)(print & UINT32_MAX);
}

static bw_status put_fluid(const bw_ulph *fluid, bw_checkpoint *ck, int64_t id[], double rows[])
{
  double numbers[BW_ULPH_NUMBERS];
  bw_ulph_ids(fluid, id);
  bw_ulph_state_get(fluid, rows, numbers);
  BW_TRY(bw_checkpoint_put_numbers(ck, "fluid/numbers", BW_ULPH_NUMBERS, numbers));
  return bw_checkpoint_put_table(ck, "fluid/rows", bw_ulph_total(fluid), bw_ulph_count(fluid), id,
                                 BW_ULPH_ROW, BW_CK_DOUBLE, rows);
}

/* Rows of the particles that this rank reads. */
static bw_status get_fluid(bw_ulph *fluid, bw_checkpoint *ck, size_t n, const int64_t id[],
                           double rows[])
{
  double numbers[BW_ULPH_NUMBERS];
  BW_TRY(bw_checkpoint_get_numbers(ck, "fluid/numbers", BW_ULPH_NUMBERS, numbers));
  BW_TRY(bw_checkpoint_get_table(ck, "fluid/rows", bw_ulph_total(fluid), n, id, BW_ULPH_ROW,
                                 BW_CK_DOUBLE, rows));
  return bw_ulph_state_set(fluid, n, id, rows, numbers);
}

/* Which particles a rank reads: any division will do, the fluid sends them where they belong. */
static void part_of(const bw_comm *comm, int64_t total, int64_t *first, size_t *n)
{
  const int64_t size = bw_comm_size(comm), rank = bw_comm_rank(comm);
  *first = total * rank / size;
  *n = (size_t)(total * (rank + 1) / size - *first);
}

/* Rows and numbers of n particles of a fluid alone. */
static bw_status rows_make(const bw_comm *comm, size_t n, table *t)
{
  memset(t, 0, sizeof *t);
  bw_status st = BW_ALLOCATE(&t->rows, BW_ULPH_ROW * n);
  BW_THEN(st, BW_ALLOCATE(&t->id, n));
  return bw_comm_agree(comm, st);
}

bw_status bw_coupler_particles_save_fluid(const bw_comm *comm, const bw_ulph *fluid,
                                          bw_checkpoint *ck)
{
  table t;
  bw_status st = rows_make(comm, bw_ulph_count(fluid), &t);
  BW_THEN(st, put_fluid(fluid, ck, t.id, t.rows));
  table_release(&t);
  return st;
}

bw_status bw_coupler_particles_restore_fluid(const bw_comm *comm, bw_ulph *fluid, bw_checkpoint *ck)
{
  int64_t first;
  size_t n;
  table t;
  part_of(comm, bw_ulph_total(fluid), &first, &n);
  bw_status st = rows_make(comm, n, &t);
  for (size_t i = 0; i < n && st == BW_OK; i++)
    t.id[i] = first + (int64_t)i;
  BW_THEN(st, get_fluid(fluid, ck, n, t.id, t.rows));
  table_release(&t);
  return st;
}

static bw_status save(bw_coupler_particles *c, bw_checkpoint *ck, table *t)
{
  const int64_t total = (int64_t)c->total, *id = bw_solid_id(c->solid);
  double sums[BW_SOLID_RESTART_SUMS], print[2];
  double between[SUMS] = {c->late, c->received};
  memcpy(between + 2, c->impulse, sizeof c->impulse);
  bw_comm_sum(bw_solid_comm(c->solid), SUMS, between);
  print_of(c, print);
  /* The fluid by the numbers of its particles ... */
  BW_TRY(put_fluid(c->fluid, ck, t->id, t->rows));
  /* ... the solid by those of its own ... */
  bw_solid_get_restart(c->solid, t->solid, sums);
  bw_solid_get_bits(c->solid, t->bits);
  BW_TRY(bw_checkpoint_put_numbers(ck, "solid/body", 2, print));
  BW_TRY(bw_checkpoint_put_numbers(ck, "solid/sums", BW_SOLID_RESTART_SUMS, sums));
  BW_TRY(bw_checkpoint_put_table(ck, "solid/rows", total, c->n, id,
                                 (int)bw_solid_restart_row(c->solid), BW_CK_DOUBLE, t->solid));
  BW_TRY(bw_checkpoint_put_table(ck, "solid/bonds", total, c->n, id,
                                 (int)bw_solid_bits_bytes(c->solid), BW_CK_UINT8, t->bits));
  /* ... and what each knows of the other. */
  bw_ulph_body_get(c->fluid, t->body);
  for (size_t i = 0; i < c->n; i++)
    memcpy(t->own + BW_ULPH_BODY_ROW * i, t->body + BW_ULPH_BODY_ROW * (size_t)id[i],
           BW_ULPH_BODY_ROW * sizeof *t->own);
  BW_TRY(bw_checkpoint_put_numbers(ck, "between/sums", SUMS, between));
  BW_TRY(bw_checkpoint_put_table(ck, "between/body", total, c->n, id, BW_ULPH_BODY_ROW,
                                 BW_CK_DOUBLE, t->own));
  BW_TRY(bw_checkpoint_put_table(ck, "between/kept", total, c->n, id, 3, BW_CK_DOUBLE, c->kept));
  return bw_checkpoint_put_table(ck, "between/owed", total, c->n, id, 3, BW_CK_DOUBLE, c->owed);
}

bw_status bw_coupler_particles_save(bw_coupler_particles *c, bw_checkpoint *ck)
{
  table t;
  bw_status st = table_make(c, bw_ulph_count(c->fluid), &t);
  BW_THEN(st, save(c, ck, &t));
  table_release(&t);
  return st;
}

static bw_status read_solid(bw_coupler_particles *c, bw_checkpoint *ck, table *t)
{
  const int64_t total = (int64_t)c->total, *id = bw_solid_id(c->solid);
  double sums[BW_SOLID_RESTART_SUMS], here[2], there[2];
  print_of(c, here);
  BW_TRY(bw_checkpoint_get_numbers(ck, "solid/body", 2, there));
  BW_REQUIRE(memcmp(here, there, sizeof here) == 0, BW_EINPUT,
             "coupler_particles: the checkpoint is of another solid: build the one that it was "
             "written with");
  BW_TRY(bw_checkpoint_get_numbers(ck, "solid/sums", BW_SOLID_RESTART_SUMS, sums));
  BW_TRY(bw_checkpoint_get_table(ck, "solid/rows", total, c->n, id,
                                 (int)bw_solid_restart_row(c->solid), BW_CK_DOUBLE, t->solid));
  BW_TRY(bw_checkpoint_get_table(ck, "solid/bonds", total, c->n, id,
                                 (int)bw_solid_bits_bytes(c->solid), BW_CK_UINT8, t->bits));
  BW_TRY(bw_solid_set_bits(c->solid, t->bits));
  return bw_solid_set_restart(c->solid, t->solid, sums);
}

static bw_status read_between(bw_coupler_particles *c, bw_checkpoint *ck, table *t)
{
  const int64_t total = (int64_t)c->total, *id = bw_solid_id(c->solid);
  double between[SUMS];
  BW_TRY(bw_checkpoint_get_numbers(ck, "between/sums", SUMS, between));
  BW_TRY(bw_checkpoint_get_table(ck, "between/body", total, c->n, id, BW_ULPH_BODY_ROW,
                                 BW_CK_DOUBLE, t->own));
  BW_TRY(bw_checkpoint_get_table(ck, "between/kept", total, c->n, id, 3, BW_CK_DOUBLE, c->kept));
  BW_TRY(bw_checkpoint_get_table(ck, "between/owed", total, c->n, id, 3, BW_CK_DOUBLE, c->owed));
  memset(t->body, 0, BW_ULPH_BODY_ROW * c->total * sizeof *t->body);
  for (size_t i = 0; i < c->n; i++)
    memcpy(t->body + BW_ULPH_BODY_ROW * (size_t)id[i], t->own + BW_ULPH_BODY_ROW * i,
           BW_ULPH_BODY_ROW * sizeof *t->own);
  bw_comm_sum(bw_solid_comm(c->solid), BW_ULPH_BODY_ROW * c->total, t->body);
  /* Sums were saved as those of all ranks: one of them gets them. */
  const double own = bw_comm_rank(bw_solid_comm(c->solid)) == 0 ? 1 : 0;
  c->late = own * between[0], c->received = own * between[1];
  for (int k = 0; k < 3; k++)
    c->impulse[k] = own * between[2 + k];
  return BW_OK;
}

bw_status bw_coupler_particles_restore(bw_coupler_particles *c, bw_checkpoint *ck)
{
  const bw_comm *comm = bw_solid_comm(c->solid);
  int64_t first;
  size_t n;
  table t;
  part_of(comm, bw_ulph_total(c->fluid), &first, &n);
  bw_status st = table_make(c, n, &t);
  for (size_t i = 0; i < n && st == BW_OK; i++)
    t.id[i] = first + (int64_t)i;
  BW_THEN(st, read_solid(c, ck, &t));
  BW_THEN(st, read_between(c, ck, &t));
  /* The body before the fluid, whose lists are made with it. */
  if (st == BW_OK) bw_ulph_body_set(c->fluid, t.body);
  BW_THEN(st, get_fluid(c->fluid, ck, n, t.id, t.rows));
  if (st == BW_OK) {
    bw_solid_get_position(c->solid, c->X);
    bw_coupler_particles__join(c, c->X, c->x);
    c->known = false;
  }
  table_release(&t);
  return st;
}
