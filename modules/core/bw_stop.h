/* bw_stop.h -- end a long run in good order when the system or the user asks for it.
 *
 *   bw_stop_install();
 *   while (...) { step; if (bw_stop_requested(comm)) { write a checkpoint; break; } }
 * Signals: SIGUSR1, SIGTERM, SIGINT. Under mpirun use SIGUSR1, which Open MPI passes on to its
 * ranks (kill -USR1 PID_OF_MPIRUN; batch systems: --signal=B:USR1@300); a SIGTERM or SIGINT to
 * mpirun makes it kill them at once. A second signal of the same kind has its usual effect. */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* From now on the first signal of each kind only sets a flag of this process. Once per program,
 * before the loop. Local. */
void bw_stop_install(void);

/* Has any rank been asked? The same answer on all ranks. Once per step is cheap. Collective. */
bool bw_stop_requested(const bw_comm *comm);

/* Forget a request (a program that runs several jobs; tests). Local. */
void bw_stop_clear(void);

BW_END_DECLS
