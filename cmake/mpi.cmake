# MPI, and whose it is: other libraries built on MPI have to be built on the same one.
include(CheckCSourceCompiles)
find_package(MPI REQUIRED COMPONENTS C)

set(CMAKE_REQUIRED_LIBRARIES MPI::MPI_C)
check_c_source_compiles("#include <mpi.h>
#ifndef OPEN_MPI
#error
#endif
int main(void) { return 0; }" BW_MPI_IS_OPEN_MPI)
check_c_source_compiles("#include <mpi.h>
#ifndef MPICH_VERSION
#error
#endif
int main(void) { return 0; }" BW_MPI_IS_MPICH)
unset(CMAKE_REQUIRED_LIBRARIES)

if(BW_MPI_IS_OPEN_MPI)
  set(BW_MPI "Open MPI")
elseif(BW_MPI_IS_MPICH)
  set(BW_MPI "MPICH")
else()
  set(BW_MPI "this MPI")
endif()
