/* What is too long for one MPI message travels in pieces: the same answers with any limit.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_exchange.h"
#include "bw_memory.h"
#include "bw_message.h"

#include <limits.h>
#include <string.h>

/* Shorter than an item, no divisor of one, about one, several, and the default: no cut. */
static const size_t limits[] = {1, 7, 24, 100, 0};
enum { LIMITS = sizeof limits / sizeof *limits, ITEM = 24 };

static bw_comm *with_limit(size_t limit)
{
  bw_comm *comm = NULL;
  bw_check_ok(bw_comm_copy(bw_check_world(), limit, &comm));
  if (limit > 0) ck_assert_uint_eq(bw_comm_message_limit(comm), limit);
  ck_assert_int_eq(bw_comm_rank(comm), bw_comm_rank(bw_check_world()));
  ck_assert_int_eq(bw_comm_size(comm), bw_comm_size(bw_check_world()));
  return comm;
}

/* No two bytes that could be mistaken for each other stand near each other. */
static unsigned char byte_of(int rank, size_t at)
{
  return (unsigned char)(37 * rank + (int)(at % 251));
}

/* More bytes than an int counts; nothing is allocated. */
START_TEST(lengths_beyond_an_int)
{
  const size_t GiB = (size_t)1 << 30, bytes = 5 * GiB + 3;
  size_t sum = 0, piece = 0;
  ck_assert_uint_eq(bw_comm_message_limit(bw_check_world()), GiB);
  for (size_t n; (n = bw_message_piece(bytes, GiB, piece)) > 0; piece++) {
    ck_assert_uint_le(n, INT_MAX);
    sum += n;
  }
  ck_assert_uint_eq(sum, bytes);
  ck_assert_uint_eq(piece, 6);
  ck_assert_uint_eq(bw_message_piece(bytes, GiB, 5), 3);
  ck_assert_uint_eq(bw_message_piece(bytes, GiB, SIZE_MAX), 0);
  ck_assert_uint_eq(bw_message_piece(GiB, GiB, 0), GiB); /* the longest that is not cut */
  ck_assert_uint_eq(bw_message_piece(GiB, GiB, 1), 0);
  ck_assert_uint_eq(bw_message_piece(0, GiB, 0), 0);
  bw_comm *comm = NULL;
  bw_check_status(bw_comm_copy(bw_check_world(), (size_t)INT_MAX + 1, &comm), BW_EINPUT);
  ck_assert_ptr_null(comm);
}
END_TEST

/* Ten bytes by fours, to the next rank round: three MPI messages of 4, 4 and 2 bytes. */
START_TEST(a_message_is_cut)
{
  const bw_comm *comm = bw_check_world();
  const int size = bw_comm_size(comm), me = bw_comm_rank(comm), tag = 5;
  const int next = (me + 1) % size, last = (me + size - 1) % size;
  const bw_message_way way = {bw_comm_mpi(comm), tag, 4};
  unsigned char mine[10], got[12];
  MPI_Request request[3];
  int n = 0;
  for (size_t q = 0; q < sizeof mine; q++)
    mine[q] = byte_of(me, q);
  for (size_t piece = 0; piece < 5; piece++)
    n += bw_message_send(&way, next, sizeof mine, mine, piece, &request[n < 3 ? n : 0]);
  ck_assert_int_eq(n, 3);
  for (int piece = 0; piece < 3; piece++) {
    MPI_Status status;
    int length = 0;
    MPI_Recv(got + 4 * piece, 4, MPI_BYTE, last, tag, bw_comm_mpi(comm), &status);
    MPI_Get_count(&status, MPI_BYTE, &length);
    ck_assert_int_eq(length, piece < 2 ? 4 : 2);
  }
  MPI_Waitall(3, request, MPI_STATUSES_IGNORE);
  for (size_t q = 0; q < sizeof mine; q++)
    ck_assert_uint_eq(got[q], byte_of(last, q));
}
END_TEST

/* n items of ITEM bytes, item i to rank (me + i i) % size; there and back. Filled: received and
 * answer. */
static void move(const bw_comm *comm, size_t n, unsigned char *received, unsigned char *answer)
{
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  int destination[64];
  unsigned char send[64 * ITEM];
  bw_exchange *plan = NULL;
  for (size_t i = 0; i < n; i++)
    destination[i] = (me + (int)(i * i)) % size;
  for (size_t q = 0; q < n * ITEM; q++)
    send[q] = byte_of(me, q);
  bw_check_ok(bw_exchange_create(comm, n, destination, &plan));
  for (int round = 0; round < 2; round++) { /* a plan is used again */
    memset(received, 0, (size_t)size * 64 * ITEM);
    bw_exchange_forward(plan, ITEM, send, received);
    memset(answer, 0, n * ITEM);
    bw_exchange_backward(plan, ITEM, received, answer);
    ck_assert_int_eq(memcmp(answer, send, n * ITEM), 0);
  }
  bw_exchange_destroy(&plan);
}

/* Ranks with many items, with one and with none: partners of very different numbers of pieces. */
START_TEST(exchanges)
{
  static unsigned char whole[4 * 64 * ITEM], cut[4 * 64 * ITEM], answer[64 * ITEM];
  const int me = bw_comm_rank(bw_check_world());
  const size_t n = me == 0 ? 64 : me == 1 ? 1 : me == 2 ? 0 : 17;
  move(bw_check_world(), n, whole, answer);
  for (int q = 0; q < LIMITS; q++) {
    bw_comm *comm = with_limit(limits[q]);
    move(comm, n, cut, answer);
    ck_assert_int_eq(memcmp(cut, whole, sizeof whole), 0);
    bw_comm_destroy(&comm);
  }
}
END_TEST

/* Rank r gives 60 r bytes, in pieces; what one rank has alone may fit into one message. */
START_TEST(gathers)
{
  const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  unsigned char mine[60 * 3];
  for (size_t q = 0; q < sizeof mine; q++)
    mine[q] = byte_of(me, q);
  for (int q = 0; q < 2 * LIMITS; q++) {
    bw_comm *comm = with_limit(limits[q / 2]);
    const bool to_all = q % 2 == 1;
    size_t total = 99, at = 0;
    unsigned char *all = NULL;
    void *out = NULL;
    bw_check_ok(
        (to_all ? bw_comm_allgather : bw_comm_gather)(comm, 60 * (size_t)me, mine, &total, &out));
    all = out;
    ck_assert((all != NULL) == (to_all || me == 0));
    for (int r = 0; all != NULL && r < size; r++)
      for (size_t k = 0; k < 60 * (size_t)r; k++)
        ck_assert_uint_eq(all[at++], byte_of(r, k));
    ck_assert_uint_eq(total, at);
    bw_release(&out);
    bw_comm_destroy(&comm);
  }
}
END_TEST

/* Whole numbers of which sums are exact: no order of adding gives others. */
START_TEST(reductions_and_broadcasts)
{
  enum { N = 31 };
  const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  for (int q = 0; q < LIMITS; q++) {
    bw_comm *comm = with_limit(limits[q]);
    double sum[N], high[N], low[N];
    int64_t sums[N], highs[N];
    uint64_t bits[N];
    unsigned char text[N];
    for (int i = 0; i < N; i++) {
      sum[i] = high[i] = low[i] = i + 1000.0 * me;
      sums[i] = highs[i] = i * (INT64_C(1) << 33) + me;
      bits[i] = UINT64_C(1) << (me + i);
      text[i] = byte_of(me, (size_t)i);
    }
    bw_comm_sum(comm, N, sum), bw_comm_max(comm, N, high), bw_comm_min(comm, N, low);
    bw_comm_sum_int(comm, N, sums), bw_comm_max_int(comm, N, highs), bw_comm_xor(comm, N, bits);
    bw_comm_broadcast(comm, N, text);
    for (int i = 0; i < N; i++) {
      ck_assert_double_eq(sum[i], size * i + 500.0 * size * (size - 1));
      ck_assert(high[i] == i + 1000.0 * (size - 1) && low[i] == i);
      ck_assert_int_eq(sums[i], size * i * (INT64_C(1) << 33) + size * (size - 1) / 2);
      ck_assert_int_eq(highs[i], i * (INT64_C(1) << 33) + size - 1);
      ck_assert(bits[i] == ((UINT64_C(1) << size) - 1) << i);
      ck_assert_uint_eq(text[i], byte_of(0, (size_t)i));
    }
    bw_comm_destroy(&comm);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(lengths_beyond_an_int), BW_TEST(a_message_is_cut),
                                      BW_TEST(exchanges), BW_TEST(gathers),
                                      BW_TEST(reductions_and_broadcasts)};
BW_CHECK_MAIN("core.message", tests)
