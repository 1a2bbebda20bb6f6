#include "bw_comm_mpi.h"
#include "bw_memory.h"
#include "bw_message.h"
#include "core_internal.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TAG_GATHER = 73 };
static const size_t LIMIT = (size_t)1 << 30; /* bytes of a message: below INT_MAX, MPI's count */

struct bw_comm {
  MPI_Comm mpi;
  int rank, size;
  size_t limit;
};

static bw_status wrap(MPI_Comm parent, size_t limit, bw_comm **out)
{
  bw_comm *c = NULL;
  const int mine = BW_ALLOCATE(&c, 1);
  int worst = mine;
  MPI_Allreduce(&mine, &worst, 1, MPI_INT, MPI_MAX, parent);
  if (worst != BW_OK) {
    bw_release(&c);
    return (bw_status)worst;
  }
  MPI_Comm_dup(parent, &c->mpi);
  MPI_Comm_rank(c->mpi, &c->rank);
  MPI_Comm_size(c->mpi, &c->size);
  c->limit = limit;
  *out = c;
  return BW_OK;
}

bw_status bw_init(int *argc, char ***argv, bw_comm **world)
{
  MPI_Init(argc, argv);
  return wrap(MPI_COMM_WORLD, LIMIT, world);
}

int bw_finish(bw_comm **world, bw_status mine)
{
  bw_status worst = mine;
  if (*world != NULL) worst = bw_comm_agree(*world, mine);
  const bool speaker = *world == NULL || bw_comm_rank(*world) == 0;
  if (worst != BW_OK && speaker)
    fprintf(stderr, "breakwater: %s: %s\n", worst == BW_EUNFINISHED ? "unfinished" : "error",
            bw_last_message()[0] != '\0' ? bw_last_message() : bw_status_text(worst));
  bw_comm_destroy(world);
  MPI_Finalize();
  return (int)worst;
}

void bw_comm_abort(const bw_comm *comm, int code)
{
  fflush(NULL);
  MPI_Abort(comm->mpi, code);
  for (;;) /* MPI_Abort does not return, but its header does not say so */
    continue;
}

bw_status bw_comm_self(bw_comm **out)
{
  return wrap(MPI_COMM_SELF, LIMIT, out);
}

bw_status bw_comm_copy(const bw_comm *comm, size_t limit, bw_comm **out)
{
  *out = NULL;
  BW_REQUIRE(limit <= INT_MAX, BW_EINPUT,
             "comm: messages of %zu bytes are longer than MPI's counts (%d); take fewer", limit,
             INT_MAX);
  return bw_comm_agree(comm, wrap(comm->mpi, limit > 0 ? limit : comm->limit, out));
}

void bw_comm_destroy(bw_comm **comm)
{
  if (*comm == NULL) return;
  MPI_Comm_free(&(*comm)->mpi);
  bw_release(comm);
}

int bw_comm_rank(const bw_comm *comm)
{
  return comm->rank;
}

int bw_comm_size(const bw_comm *comm)
{
  return comm->size;
}

size_t bw_comm_message_limit(const bw_comm *comm)
{
  return comm->limit;
}

MPI_Comm bw_comm_mpi(const bw_comm *comm)
{
  return comm->mpi;
}

bw_status bw_comm_agree(const bw_comm *comm, bw_status mine)
{
  /* One reduction finds both: the largest code and, with its sign turned, the lowest rank that
   * failed. */
  int failed_rank = mine == BW_OK ? INT_MAX : comm->rank;
  int in[2] = {(int)mine, -failed_rank}, out[2];
  MPI_Allreduce(in, out, 2, MPI_INT, MPI_MAX, comm->mpi);
  /* The usual way out: nothing failed anywhere, and no message has to travel. */
  if (out[0] == BW_OK) return BW_OK;
  failed_rank = -out[1];
  char text[BW_MESSAGE_SIZE];
  /* All ranks take over the message of that rank, so that whoever prints it says what happened. */
  snprintf(text, sizeof text, "%s", bw_last_message());
  MPI_Bcast(text, sizeof text, MPI_CHAR, failed_rank, comm->mpi);
  bw_core__set_message(text);
  return (bw_status)out[0];
}

/* x[n] of numbers of 8 bytes, reduced in place, a message's worth at a time. */
static void reduce(const bw_comm *comm, size_t n, void *x, MPI_Datatype type, MPI_Op operation)
{
  const size_t most = comm->limit > 8 ? comm->limit / 8 : 1;
  for (size_t at = 0; at < n; at += most) {
    const int count = (int)(n - at < most ? n - at : most);
    MPI_Allreduce(MPI_IN_PLACE, (unsigned char *)x + 8 * at, count, type, operation, comm->mpi);
  }
}

void bw_comm_sum(const bw_comm *comm, size_t n, double x[])
{
  reduce(comm, n, x, MPI_DOUBLE, MPI_SUM);
}

void bw_comm_max(const bw_comm *comm, size_t n, double x[])
{
  reduce(comm, n, x, MPI_DOUBLE, MPI_MAX);
}

void bw_comm_min(const bw_comm *comm, size_t n, double x[])
{
  reduce(comm, n, x, MPI_DOUBLE, MPI_MIN);
}

void bw_comm_sum_int(const bw_comm *comm, size_t n, int64_t x[])
{
  reduce(comm, n, x, MPI_INT64_T, MPI_SUM);
}

void bw_comm_max_int(const bw_comm *comm, size_t n, int64_t x[])
{
  reduce(comm, n, x, MPI_INT64_T, MPI_MAX);
}

void bw_comm_xor(const bw_comm *comm, size_t n, uint64_t x[])
{
  reduce(comm, n, x, MPI_UINT64_T, MPI_BXOR);
}

void bw_comm_or(const bw_comm *comm, size_t n, uint64_t x[])
{
  reduce(comm, n, x, MPI_UINT64_T, MPI_BOR);
}

int64_t bw_comm_prefix_sum(const bw_comm *comm, int64_t x)
{
  int64_t below = 0;
  MPI_Exscan(&x, &below, 1, MPI_INT64_T, MPI_SUM, comm->mpi);
  return comm->rank == 0 ? 0 : below;
}

/* `root`'s bytes on all ranks. */
static void broadcast(const bw_comm *comm, int root, size_t bytes, unsigned char *data)
{
  size_t n = 0;
  for (size_t at = 0; at < bytes; at += n) {
    n = bytes - at < comm->limit ? bytes - at : comm->limit;
    MPI_Bcast(data + at, (int)n, MPI_BYTE, root, comm->mpi);
  }
}

void bw_comm_broadcast(const bw_comm *comm, size_t bytes, void *data)
{
  broadcast(comm, 0, bytes, data);
}

/* Where the bytes of each rank lie in what is gathered. */
typedef struct {
  uint64_t *bytes; /* (size) */
  size_t total;    /* of all ranks */
  int *counts,
      *starts; /* (size) the same for one MPI call, where the limit of a message allows it */
} layout;

static void forget(layout *l)
{
  bw_release(&l->bytes);
  bw_release(&l->counts);
  bw_release(&l->starts);
}

static bw_status lay_out(const bw_comm *comm, size_t bytes, layout *l)
{
  const size_t ranks = (size_t)comm->size;
  bw_status st = BW_ALLOCATE(&l->bytes, ranks);
  BW_THEN(st, BW_ALLOCATE(&l->counts, ranks));
  BW_THEN(st, BW_ALLOCATE(&l->starts, ranks));
  BW_TRY(bw_comm_agree(comm, st));
  const uint64_t mine = bytes;
  MPI_Allgather(&mine, 1, MPI_UINT64_T, l->bytes, 1, MPI_UINT64_T, comm->mpi);
  for (size_t r = 0; r < ranks; r++) { /* all ranks find the same */
    BW_REQUIRE(l->bytes[r] <= SIZE_MAX - l->total, BW_EMEM,
               "gathering %zu bytes of rank %zu after %zu: more than an address can name",
               (size_t)l->bytes[r], r, l->total);
    l->total += (size_t)l->bytes[r];
  }
  /* The counts of one MPI call are int; beyond the limit they are left at 0 and nobody looks at
   * them. */
  for (size_t r = 0, at = 0; r < ranks && l->total <= comm->limit; r++) {
    l->counts[r] = (int)l->bytes[r];
    l->starts[r] = (int)at;
    at += (size_t)l->bytes[r];
  }
  return BW_OK;
}

/* Too much for one call: every rank tells the others its bytes, one after the other. */
static void allgather_long(const bw_comm *comm, const layout *l, const void *mine,
                           unsigned char *out)
{
  for (int r = 0; r < comm->size; r++) {
    const size_t n = (size_t)l->bytes[r];
    if (r == comm->rank && n > 0) memcpy(out, mine, n);
    broadcast(comm, r, n, out);
    out += n;
  }
}

bw_status bw_comm_allgather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                            void **out)
{
  layout l = {0};
  *out = NULL;
  bw_status st = lay_out(comm, bytes, &l);
  BW_THEN(st, bw_allocate(l.total, 1, out));
  /* Nobody begins to send what one rank has no room for. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK && l.total > comm->limit)
    allgather_long(comm, &l, mine, *out);
  else if (st == BW_OK)
    MPI_Allgatherv(mine, (int)bytes, MPI_BYTE, *out, l.counts, l.starts, MPI_BYTE, comm->mpi);
  *total = l.total;
  forget(&l);
  return st;
}

/* Too much for one call: rank 0 receives from one rank after the other. */
static void gather_long(const bw_comm *comm, const layout *l, const void *mine, unsigned char *out)
{
  const bw_message_way way = {comm->mpi, TAG_GATHER, comm->limit};
  const size_t own = (size_t)l->bytes[comm->rank];
  MPI_Request request;
  /* Rank 0 asks in the order of the ranks: each waits for its turn. */
  if (comm->rank != 0) {
    for (size_t piece = 0; bw_message_send(&way, 0, own, mine, piece, &request) > 0; piece++)
      MPI_Wait(&request, MPI_STATUS_IGNORE);
    return;
  }
  if (own > 0) memcpy(out, mine, own);
  for (int r = 1; r < comm->size; r++) {
    out += (size_t)l->bytes[r - 1];
    const size_t n = (size_t)l->bytes[r];
    for (size_t piece = 0; bw_message_receive(&way, r, n, out, piece, &request) > 0; piece++)
      MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
}

bw_status bw_comm_gather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                         void **out)
{
  layout l = {0};
  *out = NULL;
  bw_status st = lay_out(comm, bytes, &l);
  if (comm->rank == 0) BW_THEN(st, bw_allocate(l.total, 1, out));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK && l.total > comm->limit)
    gather_long(comm, &l, mine, *out);
  else if (st == BW_OK)
    MPI_Gatherv(mine, (int)bytes, MPI_BYTE, *out, l.counts, l.starts, MPI_BYTE, 0, comm->mpi);
  *total = comm->rank == 0 ? l.total : 0;
  forget(&l);
  return st;
}

void bw_comm_barrier(const bw_comm *comm)
{
  MPI_Barrier(comm->mpi);
}

double bw_wall_time(void)
{
  return MPI_Wtime();
}
