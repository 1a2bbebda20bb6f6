/* crack_plate.h -- the plate of cases/crack_branching, torn once, for the claims about it. */
#pragma once
#include "specimen_run.h"

/* The case's plate with other particles and another load. Collective. */
static bw_status glass(const bw_comm *comm, int particles, double stress, specimen_config *c)
{
  BW_TRY(specimen_read(comm, "crack_branching/crack_branching", 0, NULL, c));
  c->shape.particles = particles;
  for (int q = 0; q < c->n_loads; q++)
    c->loads[q].value[1] = c->loads[q].edge == SPECIMEN_TOP ? stress : -stress;
  return BW_OK;
}

/* Linear elastic fracture mechanics. The two pulled edges send waves of stress sigma that meet in
 * the notch's plane at t0 = (height/2)/c_d and add up to 2 sigma there; a semi-infinite crack
 * under a stress S from t0 on has (Freund 1990, section 2.5)
 *   K(t) = 2 S sqrt(1 - 2 nu')/(1 - nu') sqrt(c_d (t - t0)/pi),  nu' = nu/(1 + nu) (plane stress)
 * and starts at K^2 = E G0, if that is before the first echo, 3 t0. */
static const char mechanics_source[] = "Freund, Dynamic Fracture Mechanics (1990), 2.5; K^2 = E G0";

static double wave_arrival(const specimen_config *c)
{
  const double nu = 1.0 / 3.0, E = c->solid.young_modulus, rho = c->solid.density;
  return 0.5 * c->shape.height / sqrt(E / (rho * (1.0 - nu * nu)));
}

static double start_by_mechanics(const specimen_config *c) /* [s] */
{
  const double pi = acos(-1.0), nu = 1.0 / 3.0, changed = nu / (1.0 + nu);
  const double speed = 0.5 * c->shape.height / wave_arrival(c);
  const double K = sqrt(c->solid.young_modulus * c->solid.fracture_energy);
  const double per_root = 2.0 * 2.0 * fabs(c->loads[0].value[1]) * sqrt(1.0 - 2.0 * changed) /
                          (1.0 - changed) * sqrt(speed / pi);
  return wave_arrival(c) + (K / per_root) * (K / per_root);
}

typedef struct {
  specimen_crack crack;
  specimen_fork fork;
  double energy_error;  /* work not found again, over the work */
  double speed_mean;    /* of the tip along x, from the start to the edge or the end [m/s] */
  double speed_max;     /* over 4e-6 s, between arrivals [m/s] */
  double speed_max_2us; /* over 2e-6 s, between any two moments, as in ADAPT 6.1 [m/s] */
} outcome;

static double stop_time(const specimen *p)
{
  return isnan(p->crack.t_end) ? p->time : p->crack.t_end;
}

/* The tip's way in 2e-6 s, the most at any step until the edge. */
static double speed_of_moments(const specimen *p)
{
  const double window = 2e-6, step = p->config.time.step;
  double most = 0.0;
  for (int64_t k = llround(window / step); (double)k * step <= stop_time(p); k++)
    most = fmax(most, bw_pd_crack_speed_at(&p->track, window, (double)k * step));
  return most;
}

static bw_status tear(const bw_comm *comm, const specimen_config *c, outcome *o)
{
  specimen p;
  memset(&p, 0, sizeof p);
  bw_status st = specimen_break(comm, c, &p);
  BW_THEN(st, specimen_residual(&p, &o->energy_error));
  if (st == BW_OK) {
    o->crack = p.crack;
    o->speed_mean = (p.crack.tip[0] - c->follow.from[0]) / (stop_time(&p) - p.crack.t_start);
    o->speed_max = specimen_speed(&p, 4e-6);
    o->speed_max_2us = speed_of_moments(&p);
    st = specimen_branches(&p, &o->fork);
  }
  specimen_destroy(&p);
  return st;
}
