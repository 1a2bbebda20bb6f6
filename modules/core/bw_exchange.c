#include "bw_exchange.h"
#include "bw_comm_mpi.h"
#include "bw_memory.h"

#include <limits.h>
#include <string.h>

enum { TAG_FORWARD = 71, TAG_BACKWARD = 72 };

struct bw_exchange {
  const bw_comm *comm;
  size_t sent, received;
  size_t *order;                 /* (sent) item that is q-th in the send buffer (sorted by rank) */
  int n_to, n_from;              /* partners, this rank itself excluded */
  int *to, *from;                /* partner ranks, rising */
  size_t *to_start, *from_start; /* (n+1) first item of each partner in its buffer */
  size_t self_send, self_receive, self_count; /* items that stay: offsets in the two buffers */
  size_t *to_offset, *from_offset;
  unsigned char *buffer; /* grows to the largest message set ever packed */
  size_t buffer_bytes;
  MPI_Request *requests;
};

/* Stable counting sort of the items by destination: order[] and the counts per rank. */
static bw_status sort_by_destination(bw_exchange *e, const int destination[], int *count)
{
  const int size = bw_comm_size(e->comm);
  size_t *next = NULL;
  BW_TRY(BW_ALLOCATE(&next, (size_t)size + 1));
  for (size_t i = 0; i < e->sent; i++) {
    BW_ASSERT(destination[i] >= 0 && destination[i] < size);
    count[destination[i]]++;
  }
  for (int r = 0; r < size; r++)
    next[r + 1] = next[r] + (size_t)count[r];
  for (size_t i = 0; i < e->sent; i++)
    e->order[next[destination[i]]++] = i;
  bw_release(&next);
  return BW_OK;
}

/* Compress counts per rank to partner lists; the items of this rank itself are noted apart. */
static bw_status partners(const bw_comm *comm, const int count[], int *n, int **rank,
                          size_t **start, size_t **offset, size_t *self_offset, size_t *total)
{
  const int size = bw_comm_size(comm), me = bw_comm_rank(comm);
  size_t sum = 0;
  *n = 0;
  for (int r = 0; r < size; r++)
    *n += r != me && count[r] > 0;
  BW_TRY(BW_ALLOCATE(rank, (size_t)*n));
  BW_TRY(BW_ALLOCATE(start, (size_t)*n + 1));
  BW_TRY(BW_ALLOCATE(offset, (size_t)*n));
  for (int r = 0, q = 0; r < size; r++) {
    if (r == me) *self_offset = sum;
    if (r != me && count[r] > 0) {
      (*rank)[q] = r;
      (*offset)[q] = sum;
      (*start)[q + 1] = (*start)[q] + (size_t)count[r];
      q++;
    }
    sum += (size_t)count[r];
  }
  *total = sum;
  return BW_OK;
}

static bw_status plan(bw_exchange *e, const int destination[], int *out_count, int *in_count)
{
  const bw_comm *comm = e->comm;
  bw_status st = BW_ALLOCATE(&e->order, e->sent);
  BW_THEN(st, sort_by_destination(e, destination, out_count));
  BW_TRY(bw_comm_agree(comm, st)); /* before the first message */
  MPI_Alltoall(out_count, 1, MPI_INT, in_count, 1, MPI_INT, bw_comm_mpi(comm));
  e->self_count = (size_t)out_count[bw_comm_rank(comm)];
  BW_TRY(partners(comm, out_count, &e->n_to, &e->to, &e->to_start, &e->to_offset, &e->self_send,
                  &e->sent));
  BW_TRY(partners(comm, in_count, &e->n_from, &e->from, &e->from_start, &e->from_offset,
                  &e->self_receive, &e->received));
  return BW_ALLOCATE(&e->requests, (size_t)(e->n_to + e->n_from));
}

bw_status bw_exchange_create(const bw_comm *comm, size_t n, const int destination[],
                             bw_exchange **out)
{
  bw_exchange *e = NULL;
  int *out_count = NULL, *in_count = NULL;
  const size_t size = (size_t)bw_comm_size(comm);
  bw_status st = BW_ALLOCATE(&e, 1);
  BW_THEN(st, BW_ALLOCATE(&out_count, size));
  BW_THEN(st, BW_ALLOCATE(&in_count, size));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    e->comm = comm;
    e->sent = n;
    st = bw_comm_agree(comm, plan(e, destination, out_count, in_count));
  }
  bw_release(&out_count);
  bw_release(&in_count);
  if (st != BW_OK) bw_exchange_destroy(&e);
  *out = e;
  return st;
}

void bw_exchange_destroy(bw_exchange **plan_)
{
  bw_exchange *e = *plan_;
  if (e == NULL) return;
  bw_release(&e->order);
  bw_release(&e->to);
  bw_release(&e->from);
  bw_release(&e->to_start);
  bw_release(&e->from_start);
  bw_release(&e->to_offset);
  bw_release(&e->from_offset);
  bw_release(&e->buffer);
  bw_release(&e->requests);
  bw_release(plan_);
}

size_t bw_exchange_sent(const bw_exchange *e)
{
  return e->sent;
}

size_t bw_exchange_received(const bw_exchange *e)
{
  return e->received;
}

size_t bw_exchange_volume(const bw_exchange *e, size_t bytes)
{
  return (e->sent - e->self_count) * bytes;
}

/* Length of the run of consecutive items that begins at order[q]. */
static size_t run_at(const bw_exchange *e, size_t q, size_t end)
{
  size_t n = 1;
  while (q + n < end && e->order[q + n] == e->order[q] + n)
    n++;
  return n;
}

/* to <- the items order[begin..end) of `from`, in that order. */
static void gather(const bw_exchange *e, size_t begin, size_t end, size_t bytes,
                   const unsigned char *from, unsigned char *to)
{
  for (size_t q = begin, n; q < end; q += n) {
    n = run_at(e, q, end);
    memcpy(to + (q - begin) * bytes, from + e->order[q] * bytes, n * bytes);
  }
}

/* The way back. */
static void scatter(const bw_exchange *e, size_t begin, size_t end, size_t bytes,
                    const unsigned char *from, unsigned char *to)
{
  for (size_t q = begin, n; q < end; q += n) {
    n = run_at(e, q, end);
    memcpy(to + e->order[q] * bytes, from + (q - begin) * bytes, n * bytes);
  }
}

/* The packed side needs a buffer of all items sent; it only ever grows. */
static unsigned char *packed(bw_exchange *e, size_t bytes)
{
  if (e->sent * bytes > e->buffer_bytes) {
    bw_release(&e->buffer);
    e->buffer_bytes = e->sent * bytes;
    if (bw_allocate(e->buffer_bytes, 1, &e->buffer) != BW_OK) MPI_Abort(MPI_COMM_WORLD, BW_EMEM);
  }
  return e->buffer;
}

static void post(bw_exchange *e, bool receive, int n, const int rank[], const size_t start[],
                 const size_t offset[], size_t bytes, unsigned char *data, int tag, MPI_Request *q)
{
  const MPI_Comm comm = bw_comm_mpi(e->comm);
  for (int p = 0; p < n; p++) {
    unsigned char *at = data + offset[p] * bytes;
    const int length = (int)((start[p + 1] - start[p]) * bytes);
    BW_ASSERT((start[p + 1] - start[p]) * bytes <= INT_MAX);
    if (receive)
      MPI_Irecv(at, length, MPI_BYTE, rank[p], tag, comm, &q[p]);
    else
      MPI_Isend(at, length, MPI_BYTE, rank[p], tag, comm, &q[p]);
  }
}

void bw_exchange_forward(bw_exchange *e, size_t bytes, const void *send, void *receive)
{
  unsigned char *to = receive, *buffer = packed(e, bytes);
  const unsigned char *from = send;
  const size_t stay_end = e->self_send + e->self_count;
  post(e, true, e->n_from, e->from, e->from_start, e->from_offset, bytes, to, TAG_FORWARD,
       e->requests);
  gather(e, 0, e->self_send, bytes, from, buffer);
  gather(e, stay_end, e->sent, bytes, from, buffer + stay_end * bytes);
  post(e, false, e->n_to, e->to, e->to_start, e->to_offset, bytes, buffer, TAG_FORWARD,
       e->requests + e->n_from);
  gather(e, e->self_send, stay_end, bytes, from, to + e->self_receive * bytes);
  MPI_Waitall(e->n_from + e->n_to, e->requests, MPI_STATUSES_IGNORE);
}

void bw_exchange_backward(bw_exchange *e, size_t bytes, const void *reply, void *answer)
{
  unsigned char *to = answer, *buffer = packed(e, bytes);
  unsigned char *from = (unsigned char *)(uintptr_t)reply; /* MPI_Isend only reads it */
  const size_t stay_end = e->self_send + e->self_count;
  post(e, true, e->n_to, e->to, e->to_start, e->to_offset, bytes, buffer, TAG_BACKWARD,
       e->requests);
  post(e, false, e->n_from, e->from, e->from_start, e->from_offset, bytes, from, TAG_BACKWARD,
       e->requests + e->n_to);
  scatter(e, e->self_send, stay_end, bytes, from + e->self_receive * bytes, to);
  MPI_Waitall(e->n_from + e->n_to, e->requests, MPI_STATUSES_IGNORE);
  scatter(e, 0, e->self_send, bytes, buffer, to);
  scatter(e, stay_end, e->sent, bytes, buffer + stay_end * bytes, to);
}
