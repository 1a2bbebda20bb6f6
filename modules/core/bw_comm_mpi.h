/* bw_comm_mpi.h -- the MPI communicator inside a bw_comm, for code that must call MPI itself.
 *
 * Apart from bw_comm.h, so that a program which only uses Breakwater needs no mpi.h. */
#pragma once
#include "bw_comm.h"
#include <mpi.h>

BW_BEGIN_DECLS

/* The communicator of `comm`: owned by `comm`, valid until bw_comm_destroy, not to be freed. For
 * libraries that want one (HDF5); messages of your own belong on a duplicate of it. Local. */
MPI_Comm bw_comm_mpi(const bw_comm *comm);

BW_END_DECLS
