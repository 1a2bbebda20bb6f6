/* Tables of items with a global id. In the file the rows lie in id order; each rank writes and
 * reads an equal share of consecutive ids, and rows travel between it and the ranks that hold or
 * want them. */
#include "bw_exchange.h"
#include "bw_memory.h"
#include "checkpoint_internal.h"

#include <inttypes.h>
#include <string.h>

typedef struct {
  bw_checkpoint__slab slab;
  int64_t total, share, lower; /* ids in all, per rank, and before this rank's */
  size_t mine;                 /* ids of this rank's share */
  size_t row;                  /* bytes of a row */
  bw_exchange *plan;           /* from the caller's rows to the shares */
  int64_t *asked;              /* ids as they arrive at the shares */
} table;

static bw_status element_of(const bw_checkpoint *ck, const char *name, bw_checkpoint_type type,
                            hid_t *id, size_t *bytes)
{
  const struct {
    hid_t id;
    size_t bytes;
  } kinds[] = {[BW_CK_DOUBLE] = {H5T_NATIVE_DOUBLE, 8},
               [BW_CK_UINT8] = {H5T_NATIVE_UINT8, 1},
               [BW_CK_INT32] = {H5T_NATIVE_INT32, 4}};
  BW_REQUIRE((size_t)type < sizeof kinds / sizeof *kinds, BW_EINPUT,
             "checkpoint %s: table '%s' of type %d, not one of bw_checkpoint_type", ck->path, name,
             (int)type);
  *id = kinds[type].id;
  *bytes = kinds[type].bytes;
  return BW_OK;
}

static bw_status describe(const bw_checkpoint *ck, const char *name, int64_t total, int components,
                          bw_checkpoint_type type, table *t)
{
  const int64_t ranks = bw_comm_size(ck->comm), me = bw_comm_rank(ck->comm);
  BW_REQUIRE(total >= 0 && components >= 1, BW_EINPUT,
             "checkpoint %s: table '%s' of %" PRId64 " rows with %d components", ck->path, name,
             total, components);
  /* Equal shares of consecutive ids; the last ranks may have fewer rows or none. */
  *t = (table){.total = total, .share = total / ranks + 1};
  BW_TRY(element_of(ck, name, type, &t->slab.type, &t->slab.bytes));
  t->lower = me * t->share < total ? me * t->share : total;
  t->mine = (size_t)(total - t->lower < t->share ? total - t->lower : t->share);
  t->row = t->slab.bytes * (size_t)components;
  /* The share is a band of whole rows: one contiguous piece of the file. */
  t->slab.kind = BW_CHECKPOINT__TABLE;
  t->slab.dimensions = 2;
  t->slab.size[0] = (hsize_t)total, t->slab.size[1] = (hsize_t)components;
  t->slab.start[0] = (hsize_t)t->lower;
  t->slab.count[0] = (hsize_t)t->mine, t->slab.count[1] = (hsize_t)components;
  return BW_OK;
}

static bw_status destinations(const bw_checkpoint *ck, const char *name, const table *t, size_t n,
                              const int64_t id[], int destination[])
{
  for (size_t i = 0; i < n; i++) {
    BW_REQUIRE(id[i] >= 0 && id[i] < t->total, BW_EINPUT,
               "checkpoint %s: table '%s' has ids 0 to %" PRId64 ", not %" PRId64, ck->path, name,
               t->total - 1, id[i]);
    destination[i] = (int)(id[i] / t->share);
  }
  return BW_OK;
}

/* The way of every row to its share, and the ids that arrive there. */
static bw_status plan_ways(bw_checkpoint *ck, const char *name, size_t n, const int64_t id[],
                           table *t)
{
  int *destination = NULL;
  bw_status st = BW_ALLOCATE(&destination, n);
  BW_THEN(st, destinations(ck, name, t, n, id, destination));
  /* A wrong id on one rank stops all of them before a message is sent. */
  st = bw_comm_agree(ck->comm, st);
  BW_THEN(st, bw_exchange_create(ck->comm, n, destination, &t->plan));
  bw_release(&destination);
  if (st != BW_OK) return st;
  BW_TRY(bw_comm_agree(ck->comm, BW_ALLOCATE(&t->asked, bw_exchange_received(t->plan))));
  /* The ids travel once; from now on the share knows which row each arrival is. */
  bw_exchange_forward(t->plan, sizeof *id, id, t->asked);
  return BW_OK;
}

static void forget(table *t)
{
  bw_exchange_destroy(&t->plan);
  bw_release(&t->asked);
}

/* Arrived rows to their places in the share; every id once. */
static bw_status sort_rows(const bw_checkpoint *ck, const char *name, const table *t,
                           const unsigned char *arrived, unsigned char *share, unsigned char *seen)
{
  const size_t n = bw_exchange_received(t->plan);
  for (size_t i = 0; i < n; i++) {
    const size_t at = (size_t)(t->asked[i] - t->lower);
    BW_REQUIRE(seen[at] == 0, BW_EINPUT, "checkpoint %s: table '%s' has id %" PRId64 " twice",
               ck->path, name, t->asked[i]);
    seen[at] = 1;
    memcpy(share + at * t->row, arrived + i * t->row, t->row);
  }
  /* Every id once and none missing: the file would otherwise hold rows that nobody wrote. */
  for (size_t at = 0; at < t->mine; at++)
    BW_REQUIRE(seen[at] != 0, BW_EINPUT, "checkpoint %s: table '%s' has no row with id %" PRId64,
               ck->path, name, t->lower + (int64_t)at);
  return BW_OK;
}

static bw_status put_rows(bw_checkpoint *ck, const char *name, table *t, const void *rows)
{
  unsigned char *arrived = NULL, *share = NULL, *seen = NULL;
  bw_status st = BW_ALLOCATE(&arrived, bw_exchange_received(t->plan) * t->row);
  BW_THEN(st, BW_ALLOCATE(&share, t->mine * t->row));
  BW_THEN(st, BW_ALLOCATE(&seen, t->mine));
  /* Room for the arriving rows is there on all ranks. */
  st = bw_comm_agree(ck->comm, st);
  if (st == BW_OK) {
    bw_exchange_forward(t->plan, t->row, rows, arrived);
    st = bw_comm_agree(ck->comm, sort_rows(ck, name, t, arrived, share, seen));
  }
  /* Rows lie in the order of their ids: what is written does not depend on the partition. */
  BW_THEN(st, bw_checkpoint__put(ck, name, &t->slab, share));
  bw_release(&arrived);
  bw_release(&share);
  bw_release(&seen);
  return st;
}

static bw_status get_rows(bw_checkpoint *ck, const char *name, table *t, void *rows)
{
  unsigned char *reply = NULL, *share = NULL;
  const size_t wanted = bw_exchange_received(t->plan);
  bw_status st = BW_ALLOCATE(&reply, wanted * t->row);
  BW_THEN(st, BW_ALLOCATE(&share, t->mine * t->row));
  st = bw_comm_agree(ck->comm, st);
  /* Each rank reads its share, whoever wants the rows. */
  BW_THEN(st, bw_checkpoint__get(ck, name, &t->slab, share));
  if (st == BW_OK) {
    for (size_t i = 0; i < wanted; i++)
      memcpy(reply + i * t->row, share + (size_t)(t->asked[i] - t->lower) * t->row, t->row);
    /* Back the way the ids came: in the order in which the caller asked. */
    bw_exchange_backward(t->plan, t->row, reply, rows);
  }
  bw_release(&reply);
  bw_release(&share);
  return st;
}

bw_status bw_checkpoint_put_table(bw_checkpoint *ck, const char *name, int64_t total, size_t n,
                                  const int64_t id[], int components, bw_checkpoint_type type,
                                  const void *rows)
{
  table t = {0};
  bw_status st = bw_comm_agree(ck->comm, describe(ck, name, total, components, type, &t));
  BW_THEN(st, plan_ways(ck, name, n, id, &t));
  BW_THEN(st, put_rows(ck, name, &t, rows));
  forget(&t);
  /* Failures before the data set was begun count as well: the file must not be renamed. */
  if (ck->part != NULL && ck->failed == BW_OK) ck->failed = st;
  return st;
}

bw_status bw_checkpoint_get_table(bw_checkpoint *ck, const char *name, int64_t total, size_t n,
                                  const int64_t id[], int components, bw_checkpoint_type type,
                                  void *rows)
{
  table t = {0};
  bw_status st = bw_comm_agree(ck->comm, describe(ck, name, total, components, type, &t));
  BW_THEN(st, plan_ways(ck, name, n, id, &t));
  BW_THEN(st, get_rows(ck, name, &t, rows));
  forget(&t);
  return st;
}
