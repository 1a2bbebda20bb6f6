#include "bw_comm_mpi.h"
#include "bw_memory.h"
#include "core_internal.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct bw_comm {
  MPI_Comm mpi;
  int rank, size;
};

static bw_status wrap(MPI_Comm parent, bw_comm **out)
{
  bw_comm *c = NULL;
  BW_TRY(BW_ALLOCATE(&c, 1));
  MPI_Comm_dup(parent, &c->mpi);
  MPI_Comm_rank(c->mpi, &c->rank);
  MPI_Comm_size(c->mpi, &c->size);
  *out = c;
  return BW_OK;
}

bw_status bw_init(int *argc, char ***argv, bw_comm **world)
{
  MPI_Init(argc, argv);
  return wrap(MPI_COMM_WORLD, world);
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
  return wrap(MPI_COMM_SELF, out);
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

MPI_Comm bw_comm_mpi(const bw_comm *comm)
{
  return comm->mpi;
}

bw_status bw_comm_agree(const bw_comm *comm, bw_status mine)
{
  int failed_rank = mine == BW_OK ? INT_MAX : comm->rank;
  int in[2] = {(int)mine, -failed_rank}, out[2];
  MPI_Allreduce(in, out, 2, MPI_INT, MPI_MAX, comm->mpi);
  if (out[0] == BW_OK) return BW_OK;
  failed_rank = -out[1];
  char text[BW_MESSAGE_SIZE];
  snprintf(text, sizeof text, "%s", bw_last_message());
  MPI_Bcast(text, sizeof text, MPI_CHAR, failed_rank, comm->mpi);
  bw_core__set_message(text);
  return (bw_status)out[0];
}

void bw_comm_sum(const bw_comm *comm, int n, double x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_DOUBLE, MPI_SUM, comm->mpi);
}

void bw_comm_max(const bw_comm *comm, int n, double x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_DOUBLE, MPI_MAX, comm->mpi);
}

void bw_comm_min(const bw_comm *comm, int n, double x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_DOUBLE, MPI_MIN, comm->mpi);
}

void bw_comm_sum_int(const bw_comm *comm, int n, int64_t x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_INT64_T, MPI_SUM, comm->mpi);
}

void bw_comm_max_int(const bw_comm *comm, int n, int64_t x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_INT64_T, MPI_MAX, comm->mpi);
}

void bw_comm_xor(const bw_comm *comm, int n, uint64_t x[])
{
  MPI_Allreduce(MPI_IN_PLACE, x, n, MPI_UINT64_T, MPI_BXOR, comm->mpi);
}

int64_t bw_comm_prefix_sum(const bw_comm *comm, int64_t x)
{
  int64_t below = 0;
  MPI_Exscan(&x, &below, 1, MPI_INT64_T, MPI_SUM, comm->mpi);
  return comm->rank == 0 ? 0 : below;
}

void bw_comm_broadcast(const bw_comm *comm, size_t bytes, void *data)
{
  BW_ASSERT(bytes <= INT_MAX);
  MPI_Bcast(data, (int)bytes, MPI_BYTE, 0, comm->mpi);
}

/* Byte counts of all ranks and where each one's bytes start. The sum must fit an MPI count. */
static bw_status layout(const bw_comm *comm, size_t bytes, int **counts, int **starts,
                        size_t *total)
{
  bw_status st = BW_ALLOCATE(counts, (size_t)comm->size);
  BW_THEN(st, BW_ALLOCATE(starts, (size_t)comm->size));
  BW_TRY(bw_comm_agree(comm, st));
  int64_t sum = (int64_t)bytes;
  bw_comm_sum_int(comm, 1, &sum);
  BW_REQUIRE(sum <= INT_MAX, BW_EMEM, "gathering %lld bytes on one rank: 2 GiB is the limit",
             (long long)sum);
  const int mine = (int)bytes;
  MPI_Allgather(&mine, 1, MPI_INT, *counts, 1, MPI_INT, comm->mpi);
  for (int r = 1; r < comm->size; r++)
    (*starts)[r] = (*starts)[r - 1] + (*counts)[r - 1];
  *total = (size_t)sum;
  return BW_OK;
}

bw_status bw_comm_allgather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                            void **out)
{
  int *counts = NULL, *starts = NULL;
  *out = NULL;
  bw_status st = layout(comm, bytes, &counts, &starts, total);
  BW_THEN(st, bw_allocate(*total, 1, out));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK)
    MPI_Allgatherv(mine, (int)bytes, MPI_BYTE, *out, counts, starts, MPI_BYTE, comm->mpi);
  bw_release(&counts);
  bw_release(&starts);
  return st;
}

bw_status bw_comm_gather(const bw_comm *comm, size_t bytes, const void *mine, size_t *total,
                         void **out)
{
  int *counts = NULL, *starts = NULL;
  *out = NULL;
  bw_status st = layout(comm, bytes, &counts, &starts, total);
  if (comm->rank == 0) BW_THEN(st, bw_allocate(*total, 1, out));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK)
    MPI_Gatherv(mine, (int)bytes, MPI_BYTE, *out, counts, starts, MPI_BYTE, 0, comm->mpi);
  if (comm->rank != 0) *total = 0;
  bw_release(&counts);
  bw_release(&starts);
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
