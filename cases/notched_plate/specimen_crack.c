/* The crack of a specimen: its particles, its tip, its branches. */
#include "specimen.h"
#include <math.h>

enum { FORKED = 3 }; /* sections of two branches in a row that make a fork */

/* Diagonal neighbours are joined; in a cloud not every particle of a path loses enough bonds. */
static double gap(const specimen *p)
{
  return (p->config.solid.disorder > 0.0 ? 3.0 : 1.5) * p->ds;
}

bw_status specimen_find(specimen *p, bw_pd_crack *crack)
{
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  const specimen_follow *f = &p->config.follow;
  bw_solid_get_damage(p->solid, p->damage);
  /* Notches do not count. */
  for (size_t h = 0; h < p->n; h++)
    if (p->notched[h]) p->damage[h] = 0.0;
  BW_TRY(bw_pd_crack_collect(p->comm, &look, p->n, p->X0, p->damage, crack));
  /* The window first, then what hangs together with the notch's tip. */
  bw_pd_crack_crop(crack, f->lower, f->upper);
  return bw_comm_agree(p->comm, bw_pd_crack_join(crack, f->from[0], f->from[1], gap(p)));
}

bw_status specimen_fit(specimen *p, bw_pd_crack_line *line)
{
  const specimen_follow *f = &p->config.follow;
  bw_pd_crack crack;
  BW_TRY(specimen_find(p, &crack));
  *line = bw_pd_crack_fit(&crack, f->from[0], f->from[1], f->fit_from, f->fit_to);
  bw_pd_crack_release(&crack);
  return BW_OK;
}

/* Where it forks, in sections across x; NAN: nowhere. */
static double fork_of(const specimen *p, const bw_pd_crack *crack)
{
  const double from = p->config.follow.from[0] + 0.5 * p->ds;
  return bw_pd_crack_fork(crack, from, p->ds, FORKED, gap(p));
}

bw_status specimen_branches(specimen *p, specimen_fork *out)
{
  const double notch = p->config.follow.from[0] + 0.5 * p->ds;
  bw_pd_crack crack;
  BW_TRY(specimen_find(p, &crack));
  /* Where it forks; branches are counted half way from there to the tip. */
  *out = (specimen_fork){.x = fork_of(p, &crack), .middle = {NAN, NAN}};
  const double from = isnan(out->x) ? notch : out->x, tip = p->crack.tip[0];
  const double station = from + p->ds * floor(0.5 * (tip - from) / p->ds);
  out->branches = bw_pd_crack_branches(&crack, station, 0.5 * p->ds, gap(p), 2, out->middle);
  /* Just behind the fork and just before the tip. */
  const double over = p->config.follow.angle_over;
  out->angle_first = bw_pd_crack_angle(&crack, from, from + over, p->ds, gap(p));
  out->angle_last = bw_pd_crack_angle(&crack, tip - over, tip, p->ds, gap(p));
  bw_pd_crack_release(&crack);
  return BW_OK;
}

/* Is the place within 1.5 ds of an edge or a hole? */
static bool at_an_end(const specimen *p, const double x[2])
{
  const specimen_shape *s = &p->config.shape;
  const double near = 1.5 * p->ds;
  double gap = fmin(fmin(x[0], s->length - x[0]), fmin(x[1], s->height - x[1]));
  /* A hole is an end as an edge is. */
  for (int q = 0; q < p->config.n_holes; q++) {
    const specimen_hole *o = &p->config.holes[q];
    gap = fmin(gap, hypot(x[0] - o->centre[0], x[1] - o->centre[1]) - o->radius);
  }
  return gap < near;
}

static void note_time(double *what, bool happened, double time)
{
  if (happened && isnan(*what)) *what = time;
}

static bw_status find_tip(specimen *p)
{
  specimen_crack *c = &p->crack;
  const specimen_follow *f = &p->config.follow;
  bw_pd_crack crack;
  BW_TRY(specimen_find(p, &crack));
  double tip[2] = {NAN, NAN};
  /* The farthest particle; reach never shrinks. */
  const double reach = bw_pd_crack_reach(&crack, f->from[0], f->from[1], tip);
  if (reach > c->reach) c->reach = reach, c->tip[0] = tip[0], c->tip[1] = tip[1];
  if (isnan(c->t_branch)) note_time(&c->t_branch, !isnan(fork_of(p, &crack)), p->time);
  bw_pd_crack_release(&crack);
  /* Each moment is noted once, when it is first seen. */
  note_time(&c->t_start, c->reach > 1.5 * p->ds, p->time);
  note_time(&c->t_end, !isnan(c->t_start) && at_an_end(p, c->tip), p->time);
  return bw_comm_agree(p->comm, bw_pd_crack_track_note(&p->track, p->time, c->reach));
}

/* Has a bond broken on any rank since the last look? Collective. */
static bool broke(specimen *p)
{
  int64_t news = bw_solid_events(p->solid) != p->events;
  p->events = bw_solid_events(p->solid);
  bw_comm_max_int(p->comm, 1, &news);
  return news != 0;
}

double specimen_speed(const specimen *p, double window)
{
  return bw_pd_crack_speed(&p->track, window, p->crack.t_end);
}

bw_status specimen_look(specimen *p)
{
  /* Where nothing broke the crack is where it was. */
  if (broke(p)) {
    note_time(&p->crack.t_first, true, p->time);
    BW_TRY(find_tip(p));
  }
  p->crack.speed = bw_pd_crack_speed_at(&p->track, p->config.follow.speed_window, p->time);
  return BW_OK;
}
