/* bw_stop.h -- end a long run in good order when the system or the user asks for it.
 *
 *   bw_stop_install();
 *   while (...) { step; if (bw_stop_requested(comm)) { write a checkpoint; break; } }
 * A case asks bw_case_stopping instead, which also knows --stop-after.
 * Signals: SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2, at any rank. The first one is a
 * request; a second one, of whatever kind, ends the process at once. Under mpirun send SIGUSR1 or
 * SIGUSR2, which Open MPI passes on to its ranks; a SIGTERM or SIGINT to mpirun itself makes it
 * kill them. srun passes all on (--signal=USR1@300 asks five minutes before the end). */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* From now on the first of these signals only sets a flag of this process. SIGHUP stays ignored
 * where it is (nohup). SIGXCPU of the system, which repeats it every second, is one request. Once
 * per program, before the loop. Local. */
void bw_stop_install(void);

/* Has any rank been asked? The same answer on all ranks. Once per step is cheap. Collective. */
bool bw_stop_requested(const bw_comm *comm);

/* The signal that asked this process; 0: none. Local. */
int bw_stop_signal(void);

/* Forget a request (a program that runs several jobs; tests). Local. */
void bw_stop_clear(void);

BW_END_DECLS
