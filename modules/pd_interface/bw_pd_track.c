/* Speed of a tip that goes from particle to particle. */
#include "bw_memory.h"
#include "bw_pd_crack.h"
#include <math.h>
#include <string.h>

static const double TIE = 1e-9; /* of the window: steps that add up to it are as long */

void bw_pd_crack_track_release(bw_pd_crack_track *track)
{
  bw_release(&track->time);
  bw_release(&track->place);
  track->n = track->room = 0;
}

bw_status bw_pd_crack_track_note(bw_pd_crack_track *track, double time, double place)
{
  /* No farther than before by a step: no arrival. */
  if (track->n > 0 && !(place > track->place[track->n - 1] + track->step)) return BW_OK;
  if (track->n == track->room) {
    const size_t room = 2 * track->room + 64;
    BW_TRY(BW_ENLARGE(&track->time, track->n, room));
    BW_TRY(BW_ENLARGE(&track->place, track->n, room));
    track->room = room;
  }
  track->time[track->n] = time;
  track->place[track->n++] = place;
  return BW_OK;
}

double bw_pd_crack_speed(const bw_pd_crack_track *track, double window, double until)
{
  const double *time = track->time, *place = track->place, least = window * (1.0 - TIE);
  double most = 0.0;
  size_t from = 0;
  for (size_t k = 1; k < track->n && !(time[k] > until); k++) {
    /* The latest arrival that is at least a window ago; `from` never goes back. */
    while (from + 1 < k && time[k] - time[from + 1] >= least)
      from++;
    const double taken = time[k] - time[from];
    if (taken >= least) most = fmax(most, (place[k] - place[from]) / taken);
  }
  return most;
}

/* Where the tip was at `time`. */
static double place_at(const bw_pd_crack_track *track, double time)
{
  size_t k = track->n;
  while (k > 1 && track->time[k - 1] > time)
    k--;
  return track->place[k - 1];
}

double bw_pd_crack_speed_at(const bw_pd_crack_track *track, double window, double time)
{
  /* A mean over a fixed window, so that a crack that stops is seen to slow down. */
  if (track->n == 0) return 0.0;
  return (place_at(track, time) - place_at(track, time - window)) / window;
}
