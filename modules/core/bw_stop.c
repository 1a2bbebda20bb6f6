#include "bw_stop.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>

/* Mutable and static because a signal handler takes no argument: this is its only way to speak. */
static volatile sig_atomic_t requested;

static void note(int signal_number, siginfo_t *info, void *context)
{
  (void)context;
  /* Past its limit of processor time a process is told so every second until it is killed. */
  const bool reminder = signal_number == SIGXCPU && info->si_code > 0;
  if (requested == 0) {
    requested = signal_number;
  } else if (!reminder) {
    /* Whoever asks twice does not want to wait: the usual effect, as soon as this handler ends. */
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}

void bw_stop_install(void)
{
  static const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2};
  struct sigaction action, before;
  memset(&action, 0, sizeof action);
  action.sa_sigaction = note;
  /* System calls go on after the signal. */
  action.sa_flags = (int)((unsigned)SA_RESTART | (unsigned)SA_SIGINFO);
  sigemptyset(&action.sa_mask);
  for (size_t q = 0; q < sizeof signals / sizeof *signals; q++) {
    /* nohup has asked for the terminal's end to be ignored. */
    const bool deaf = signals[q] == SIGHUP && sigaction(SIGHUP, NULL, &before) == 0 &&
                      before.sa_handler == SIG_IGN;
    if (!deaf) sigaction(signals[q], &action, NULL);
  }
}

bool bw_stop_requested(const bw_comm *comm)
{
  int64_t any = requested != 0;
  bw_comm_max_int(comm, 1, &any);
  return any != 0;
}

int bw_stop_signal(void)
{
  return requested;
}

void bw_stop_clear(void)
{
  requested = 0;
}
