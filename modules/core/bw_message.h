/* bw_message.h -- messages of any length between two ranks. For core and grid, who call MPI.
 *
 * The counts of MPI are int, so that one MPI message holds at most 2 GiB. A longer one is cut into
 * pieces of `limit` bytes (bw_comm_message_limit), the last one shorter; a message up to that
 * length is one piece. The pieces of all partners are posted in rounds:
 *   for (size_t piece = 0, n = 1; n > 0; piece++) {
 *     n = 0;
 *     for every partner: n += bw_message_receive(&way, ..., piece, &request[n]);
 *     for every partner: n += bw_message_send(&way, ..., piece, &request[n]);
 *     MPI_Waitall(n, request, MPI_STATUSES_IGNORE);
 *   }
 * so that one request per message is enough and pieces of one message arrive in order. No rank
 * waits for ever: whoever is in the earliest round waits only for pieces that all of its partners
 * have posted. */
#pragma once
#include "bw_comm_mpi.h"

BW_BEGIN_DECLS

/* Where messages travel. */
typedef struct {
  MPI_Comm mpi; /* the communicator that they travel on */
  int tag;      /* of all of them; each use of a communicator has its own */
  size_t limit; /* [bytes] of a piece, 1 .. INT_MAX, the same on all ranks */
} bw_message_way;

/* Bytes of piece number `piece` of a message of `bytes`; 0: there is none. It begins at
 * piece * limit. Local. */
size_t bw_message_piece(size_t bytes, size_t limit, size_t piece);

/* Post that piece of a message to or from `rank` of way->mpi, without waiting: *request is for
 * MPI_Waitall, until when data[bytes], the whole message, is borrowed. Return 1, or 0 where the
 * message has no such piece (then *request is not touched). Both ranks have to name the same
 * length. Local. */
int bw_message_send(const bw_message_way *way, int rank, size_t bytes, const void *data,
                    size_t piece, MPI_Request *request);
int bw_message_receive(const bw_message_way *way, int rank, size_t bytes, void *data, size_t piece,
                       MPI_Request *request);

BW_END_DECLS
