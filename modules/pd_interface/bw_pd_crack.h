/* bw_pd_crack.h -- where a crack is: its tip, how many branches it has, where it forked.
 *
 * A particle belongs to the crack when its damage exceeds `level`; 0.35 as in ADAPT section 6.1
 * and Ha & Bobaru 2010. (A straight crack leaves about 0.4 in the two rows beside it at m = 3 and
 * about 0.2 in the next ones.) Positions are those of the reference shape, in two directions:
 * s along the crack's way, t across it; both unit vectors. A crack that turns is followed by its
 * distance from where it began and by the line that fits it best.
 * Lengths in [L]. Everything is the same on all ranks. */
#pragma once
#include "bw_comm.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Damage above which a particle belongs to a crack [-] (ADAPT 6.1; Ha & Bobaru 2010). */
#define BW_PD_CRACK_LEVEL 0.35

/* What is a crack, and which way it runs. */
typedef struct {
  double level;     /* damage of a cracked particle [-]   default 0.35 */
  double along[3];  /* unit vector of s                   default x */
  double across[3]; /* unit vector of t                   default y */
} bw_pd_crack_config;

/* Defaults as above. Pure. */
bw_pd_crack_config bw_pd_crack_config_default(void);

/* The cracked particles of all ranks, by rising s, then t. */
typedef struct {
  size_t n;  /* how many */
  double *s; /* (n) place along the crack's way [L] */
  double *t; /* (n) place across it [L] */
} bw_pd_crack;

/* The whole crack on every rank; free with bw_pd_crack_release. X0 (n,3) reference positions and
 * damage (n) of this rank's particles, as bw_pd_bond gives them. BW_EMEM. Collective. */
bw_status bw_pd_crack_collect(const bw_comm *comm, const bw_pd_crack_config *config, size_t n,
                              const double X0[], const double damage[],
                              bw_pd_crack *out) BW_MUST_CHECK;
/* Releases the arrays; an empty crack is fine. Local. */
void bw_pd_crack_release(bw_pd_crack *crack);

/* Connected parts of the crack in the section |s - station| <= half: those whose t differ by more
 * than `gap` (1.5 ds: a sound row lies between) are two. On a lattice along s take half = ds/2.
 * `middle` (room for `most`, may be NULL) gets their mean t, rising. Local. */
int bw_pd_crack_branches(const bw_pd_crack *crack, double station, double half, double gap,
                         int most, double middle[]);

/* Where the crack forks: the first section from s = `from` on, `step` apart, that begins `run`
 * sections of two branches or more each; NAN when there is none. Local. */
double bw_pd_crack_fork(const bw_pd_crack *crack, double from, double step, int run, double gap);

/* Angle [rad] between the outermost branches from s = a to s = b (least-squares lines through
 * their middles, sections `step` apart); NAN with fewer than three forked sections. Local. */
double bw_pd_crack_angle(const bw_pd_crack *crack, double a, double b, double step, double gap);

/* Keep the particles with lower[0] <= s < upper[0] and lower[1] <= t < upper[1]. Local. */
void bw_pd_crack_crop(bw_pd_crack *crack, const double lower[2], const double upper[2]);

/* Keep what is joined to the point (s, t): the particles that are reached from it by going from
 * one to the next in steps of at most `gap` (1.5 ds: neighbours on the lattice). BW_EMEM, the crack
 * as it was. Local. */
bw_status bw_pd_crack_join(bw_pd_crack *crack, double s, double t, double gap) BW_MUST_CHECK;

/* Distance from (s, t) to the farthest particle, whose place goes to tip[2] (may be NULL); of
 * equally far ones the first. NAN, and tip untouched, when there is none. Local. */
double bw_pd_crack_reach(const bw_pd_crack *crack, double s, double t, double tip[2]);

/* A straight line through a part of a crack. */
typedef struct {
  size_t n;     /* particles fitted */
  double angle; /* of the line to s, turned towards t, away from the start [rad], -pi .. pi */
  double width; /* root mean square distance from the line [L] */
} bw_pd_crack_line;

/* The line of least total squares (principal axis) through the particles at a distance a .. b
 * from (s, t). A crack n rows thick of spacing ds has a width of ds sqrt((n n - 1)/12) if it is
 * straight. angle and width are NAN with fewer than four particles. Local. */
bw_pd_crack_line bw_pd_crack_fit(const bw_pd_crack *crack, double s, double t, double a, double b);

/* The way of a tip in time: the moments it arrived farther than before, by `step` at least. Starts
 * as {.step = ds/2}: a particle beside the tip that cracks later is no arrival. */
typedef struct {
  double step;   /* by which an arrival is farther than the one before [L] */
  size_t n;      /* arrivals so far */
  size_t room;   /* arrivals that fit without allocating */
  double *time;  /* (n) of each arrival [T], rising */
  double *place; /* (n) how far the tip was then [L], rising */
} bw_pd_crack_track;
/* Releases the arrays; an empty track is fine. Local. */
void bw_pd_crack_track_release(bw_pd_crack_track *track);

/* The tip is at `place` [L] at `time` [T]; forgotten when that is no arrival. BW_EMEM. Local. */
bw_status bw_pd_crack_track_note(bw_pd_crack_track *track, double time, double place) BW_MUST_CHECK;

/* Highest speed [L/T] between two arrivals that are `window` [T] or just more apart, up to the time
 * `until` (NAN: all); 0 when there are none. Between any two moments a tip that jumps by ds gains
 * one jump too many when the first is just before one and the last just after one, and a maximum
 * finds these: it is ds/window too fast. Between arrivals the error is that of one arrival, by a
 * part of ds at either end and of either sign. Local. */
double bw_pd_crack_speed(const bw_pd_crack_track *track, double window, double until);

/* Mean speed [L/T] over the last `window` before `time`: for a history. Local. */
double bw_pd_crack_speed_at(const bw_pd_crack_track *track, double window, double time);

#ifdef __cplusplus
}
#endif
