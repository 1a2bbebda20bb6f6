#include "bw_stop.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>

/* Mutable and static because a signal handler takes no argument: this is its only way to speak. */
static volatile sig_atomic_t requested;

static void note(int signal_number)
{
  (void)signal_number;
  requested = 1;
}

void bw_stop_install(void)
{
  static const int signals[] = {SIGTERM, SIGINT, SIGUSR1};
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = note;
  /* System calls go on after the signal; a second one of the kind has its usual effect. */
  action.sa_flags = (int)((unsigned)SA_RESTART | (unsigned)SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (size_t q = 0; q < sizeof signals / sizeof *signals; q++)
    sigaction(signals[q], &action, NULL);
}

bool bw_stop_requested(const bw_comm *comm)
{
  int64_t any = requested != 0;
  bw_comm_max_int(comm, 1, &any);
  return any != 0;
}

void bw_stop_clear(void)
{
  requested = 0;
}
