#include "bw_message.h"

size_t bw_message_piece(size_t bytes, size_t limit, size_t piece)
{
  const size_t whole = bytes / limit; /* pieces of full length: piece * limit may not be a number */
  if (piece < whole) return limit;
  return piece == whole ? bytes % limit : 0;
}

int bw_message_send(const bw_message_way *way, int rank, size_t bytes, const void *data,
                    size_t piece, MPI_Request *request)
{
  const int n = (int)bw_message_piece(bytes, way->limit, piece);
  if (n == 0) return 0;
  const unsigned char *from = (const unsigned char *)data + piece * way->limit;
  MPI_Isend(from, n, MPI_BYTE, rank, way->tag, way->mpi, request);
  return 1;
}

int bw_message_receive(const bw_message_way *way, int rank, size_t bytes, void *data, size_t piece,
                       MPI_Request *request)
{
  const int n = (int)bw_message_piece(bytes, way->limit, piece);
  if (n == 0) return 0;
  unsigned char *to = (unsigned char *)data + piece * way->limit;
  MPI_Irecv(to, n, MPI_BYTE, rank, way->tag, way->mpi, request);
  return 1;
}
