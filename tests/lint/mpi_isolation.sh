#!/bin/sh
# Only core and grid call MPI; everybody else may name MPI_Comm, MPI_COMM_* and MPI_INFO_NULL.
# Tokens are looked at, not lines: a line may hold an allowed and a forbidden name.
# usage: mpi_isolation.sh SOURCE
cd "$1" || exit 2
hits=$(grep -rnoE '\bMPI_[A-Za-z0-9_]+' modules cases validation bench docs tests \
            --include='*.c' --include='*.h' 2>/dev/null |
       grep -vE '^(modules|tests/unit)/(core|grid)/' |
       grep -vE ':(MPI_Comm|MPI_COMM_[A-Z]+|MPI_INFO_NULL)$')
[ -n "$hits" ] || exit 0
echo "MPI used outside core and grid:"
echo "$hits"
exit 1
