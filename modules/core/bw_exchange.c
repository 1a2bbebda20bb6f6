#include "bw_exchange.h"
#include "bw_comm_mpi.h"
#include "bw_memory.h"
#include "bw_message.h"

#include <stdio.h>
#include <string.h>

enum { TAG_FORWARD = 71, TAG_BACKWARD = 72 };

/* The partners of one direction, this rank itself excluded, and the buffer of its items, which is
 * ordered by rank. */
typedef struct {
  int n;
  int *rank;     /* (n) rising */
  size_t *first; /* (n) item of the buffer that is the partner's first */
  size_t *count; /* (n) */
  size_t self;   /* item of the buffer that is the first of those that stay */
  size_t total;  /* items in the buffer, those that stay included */
} side;

struct bw_exchange {
  const bw_comm *comm;
  size_t *order; /* (to.total) item that is q-th in the buffer of what is sent */
  side to, from;
  size_t self_count;     /* items that stay */
  unsigned char *buffer; /* grows to the largest message set ever packed */
  size_t buffer_bytes;
  MPI_Request *requests; /* (to.n + from.n) */
};

/* Stable counting sort of the items by destination: order[] and the counts per rank. */
static bw_status sort_by_destination(bw_exchange *e, const int destination[], int64_t *count)
{
  const int size = bw_comm_size(e->comm);
  size_t *next = NULL;
  BW_TRY(BW_ALLOCATE(&next, (size_t)size + 1));
  for (size_t i = 0; i < e->to.total; i++) {
    BW_ASSERT(destination[i] >= 0 && destination[i] < size);
    count[destination[i]]++;
  }
  /* Prefix sums: where the items of each rank begin. */
  for (int r = 0; r < size; r++)
    next[r + 1] = next[r] + (size_t)count[r];
  for (size_t i = 0; i < e->to.total; i++)
    e->order[next[destination[i]]++] = i;
  bw_release(&next);
  return BW_OK;
}

/* Compress counts per rank to a list of partners. */
static bw_status list_partners(const bw_comm *comm, const int64_t count[], side *s)
{
  const int size = bw_comm_size(comm), me = bw_comm_rank(comm);
  s->n = 0;
  for (int r = 0; r < size; r++)
    s->n += r != me && count[r] > 0;
  BW_TRY(BW_ALLOCATE(&s->rank, (size_t)s->n));
  BW_TRY(BW_ALLOCATE(&s->first, (size_t)s->n));
  BW_TRY(BW_ALLOCATE(&s->count, (size_t)s->n));
  s->total = 0;
  /* In rank order, the order of the buffer; what stays here has its place there but is no
   * partner. */
  for (int r = 0, q = 0; r < size; r++) {
    if (r == me) s->self = s->total;
    if (r != me && count[r] > 0) {
      s->rank[q] = r;
      s->first[q] = s->total;
      s->count[q++] = (size_t)count[r];
    }
    s->total += (size_t)count[r];
  }
  return BW_OK;
}

static bw_status plan(bw_exchange *e, const int destination[], int64_t *out_count,
                      int64_t *in_count)
{
  const bw_comm *comm = e->comm;
  bw_status st = BW_ALLOCATE(&e->order, e->to.total);
  BW_THEN(st, sort_by_destination(e, destination, out_count));
  BW_TRY(bw_comm_agree(comm, st)); /* before the first message */
  /* The only time that counts travel. */
  MPI_Alltoall(out_count, 1, MPI_INT64_T, in_count, 1, MPI_INT64_T, bw_comm_mpi(comm));
  e->self_count = (size_t)out_count[bw_comm_rank(comm)];
  BW_TRY(list_partners(comm, out_count, &e->to));
  BW_TRY(list_partners(comm, in_count, &e->from));
  return BW_ALLOCATE(&e->requests, (size_t)(e->to.n + e->from.n));
}

bw_status bw_exchange_create(const bw_comm *comm, size_t n, const int destination[],
                             bw_exchange **out)
{
  bw_exchange *e = NULL;
  int64_t *out_count = NULL, *in_count = NULL;
  const size_t size = (size_t)bw_comm_size(comm);
  bw_status st = BW_ALLOCATE(&e, 1);
  BW_THEN(st, BW_ALLOCATE(&out_count, size));
  BW_THEN(st, BW_ALLOCATE(&in_count, size));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    e->comm = comm;
    e->to.total = n;
    st = bw_comm_agree(comm, plan(e, destination, out_count, in_count));
  }
  bw_release(&out_count);
  bw_release(&in_count);
  if (st != BW_OK) bw_exchange_destroy(&e);
  *out = e;
  return st;
}

static void forget_side(side *s)
{
  bw_release(&s->rank);
  bw_release(&s->first);
  bw_release(&s->count);
}

void bw_exchange_destroy(bw_exchange **plan_)
{
  bw_exchange *e = *plan_;
  if (e == NULL) return;
  bw_release(&e->order);
  forget_side(&e->to);
  forget_side(&e->from);
  bw_release(&e->buffer);
  bw_release(&e->requests);
  bw_release(plan_);
}

size_t bw_exchange_sent(const bw_exchange *e)
{
  return e->to.total;
}

size_t bw_exchange_received(const bw_exchange *e)
{
  return e->from.total;
}

size_t bw_exchange_volume(const bw_exchange *e, size_t bytes)
{
  return (e->to.total - e->self_count) * bytes;
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
  /* No status comes from a move, and the others wait in it: without memory the run cannot go on. */
  if (e->to.total * bytes > e->buffer_bytes) {
    bw_release(&e->buffer);
    e->buffer_bytes = e->to.total * bytes;
    if (bw_allocate(e->buffer_bytes, 1, &e->buffer) == BW_OK) return e->buffer;
    fprintf(stderr, "breakwater: error: %s\n", bw_last_message());
    MPI_Abort(MPI_COMM_WORLD, BW_EMEM);
  }
  return e->buffer;
}

/* Where the messages of a move begin and end: buffers in rank order. */
typedef struct {
  const side *out, *in;
  const unsigned char *send;
  unsigned char *receive;
  size_t bytes; /* of an item */
  bw_message_way way;
} traffic;

/* Piece number `piece` of every message; both return how many there are. */
static int post_receives(const traffic *t, size_t piece, MPI_Request *request)
{
  int n = 0;
  for (int p = 0; p < t->in->n; p++)
    n += bw_message_receive(&t->way, t->in->rank[p], t->in->count[p] * t->bytes,
                            t->receive + t->in->first[p] * t->bytes, piece, &request[n]);
  return n;
}

static int post_sends(const traffic *t, size_t piece, MPI_Request *request)
{
  int n = 0;
  for (int p = 0; p < t->out->n; p++)
    n += bw_message_send(&t->way, t->out->rank[p], t->out->count[p] * t->bytes,
                         t->send + t->out->first[p] * t->bytes, piece, &request[n]);
  return n;
}

/* The first pieces, n of them, are under way; nearly always they are all. */
static void finish(const traffic *t, int n, MPI_Request *request)
{
  for (size_t piece = 1; n > 0; piece++) {
    MPI_Waitall(n, request, MPI_STATUSES_IGNORE);
    n = post_receives(t, piece, request);
    n += post_sends(t, piece, request + n);
  }
}

static bw_message_way way(const bw_exchange *e, int tag)
{
  return (bw_message_way){bw_comm_mpi(e->comm), tag, bw_comm_message_limit(e->comm)};
}

void bw_exchange_forward(bw_exchange *e, size_t bytes, const void *send, void *receive)
{
  unsigned char *to = receive, *buffer = packed(e, bytes);
  const unsigned char *from = send;
  const size_t stay = e->to.self, stay_end = stay + e->self_count;
  const traffic t = {&e->to, &e->from, buffer, to, bytes, way(e, TAG_FORWARD)};
  int n = post_receives(&t, 0, e->requests);
  /* Receives are posted. What goes to others is packed in rank order, a partner a stretch of the
   * buffer. */
  gather(e, 0, stay, bytes, from, buffer);
  gather(e, stay_end, e->to.total, bytes, from, buffer + stay_end * bytes);
  n += post_sends(&t, 0, e->requests + n);
  /* While messages travel, what stays is copied straight to its place. */
  gather(e, stay, stay_end, bytes, from, to + e->from.self * bytes);
  finish(&t, n, e->requests);
}

void bw_exchange_backward(bw_exchange *e, size_t bytes, const void *reply, void *answer)
{
  unsigned char *to = answer, *buffer = packed(e, bytes);
  const unsigned char *from = reply;
  const size_t stay = e->to.self, stay_end = stay + e->self_count;
  const traffic t = {&e->from, &e->to, from, buffer, bytes, way(e, TAG_BACKWARD)};
  int n = post_receives(&t, 0, e->requests);
  /* What arrived forth lies in rank order already and is sent from where it is. */
  n += post_sends(&t, 0, e->requests + n);
  /* While messages travel, what stayed goes back to its place. */
  scatter(e, stay, stay_end, bytes, from + e->from.self * bytes, to);
  finish(&t, n, e->requests);
  /* All answers are in the buffer, in rank order; each returns to the item it belongs to. */
  scatter(e, 0, stay, bytes, buffer, to);
  scatter(e, stay_end, e->to.total, bytes, buffer + stay_end * bytes, to);
}
