/* crack_plate.h -- the notched plate of cases/crack_branching, torn once, for the claims about it.
 */
#pragma once
#include "../../cases/crack_branching/plate.c" /* the case's own plate, not a second one */
#include "bw_validation.h"
#include <stdio.h>

/* Soda-lime glass, 0.1 x 0.04 m, notched to the middle: FSI section 3 and ADAPT section 6.1. */
static plate_config glass(int particles, double stress, double end)
{
  return (plate_config){
      .shape = {.length = 0.1, .height = 0.04, .notch = 0.05, .particles = particles},
      .solid = {.young_modulus = 72e9,
                .density = 2440.0,
                .fracture_energy = 135.0,
                .horizon_ratio = 3.0,
                .surface_correction = BW_PD_SURFACE_VOLUME,
                .volume_fraction = BW_PD_FRACTION_LINEAR,
                .family_reach = BW_PD_REACH_HALF_CELL,
                .integrator = BW_PD_VERLET},
      .load = {.stress = stress, .rows = 1},
      .time = {.step = 50e-9, .end = end}};
}

/* Linear elastic fracture mechanics. The two pulled edges send waves of stress sigma that meet in
 * the notch's plane at t0 = (height/2)/c_d and add up to 2 sigma there; a semi-infinite crack
 * under a stress S from t0 on has (Freund 1990, section 2.5)
 *   K(t) = 2 S sqrt(1 - 2 nu')/(1 - nu') sqrt(c_d (t - t0)/pi),  nu' = nu/(1 + nu) (plane stress)
 * and starts at K^2 = E G0, if that is before the first echo, 3 t0. */
static const char mechanics_source[] = "Freund, Dynamic Fracture Mechanics (1990), 2.5; K^2 = E G0";

static double wave_arrival(const plate_config *c)
{
  const double nu = 1.0 / 3.0, E = c->solid.young_modulus, rho = c->solid.density;
  return 0.5 * c->shape.height / sqrt(E / (rho * (1.0 - nu * nu)));
}

static double start_by_mechanics(const plate_config *c) /* [s] */
{
  const double pi = acos(-1.0), nu = 1.0 / 3.0, changed = nu / (1.0 + nu);
  const double speed = 0.5 * c->shape.height / wave_arrival(c);
  const double K = sqrt(c->solid.young_modulus * c->solid.fracture_energy);
  const double per_root =
      2.0 * 2.0 * c->load.stress * sqrt(1.0 - 2.0 * changed) / (1.0 - changed) * sqrt(speed / pi);
  return wave_arrival(c) + (K / per_root) * (K / per_root);
}

typedef struct {
  plate_crack crack;
  int branches;                   /* half way between the fork (or the notch) and the tip */
  double fork;                    /* x where it forks [m] */
  double energy_error;            /* work not found again, over the work */
  double speed_mean;              /* of the tip from the start to the edge or the end [m/s] */
  double speed_max;               /* over 4e-6 s, between arrivals [m/s] */
  double speed_max_2us;           /* over 2e-6 s, between any two moments, as in ADAPT 6.1 [m/s] */
  double angle_first, angle_last; /* of a branch to the crack's way, over 5 mm behind the fork
                                     and before the tip or edge [rad] */
} outcome;

static bw_status look_at_branches(plate *p, outcome *o)
{
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  const double gap = 1.5 * p->ds, reach = 5e-3, tip = p->crack.tip;
  BW_TRY(plate_branches(p, tip, &o->branches, &o->fork));
  const double from = isnan(o->fork) ? p->config.shape.notch : o->fork;
  const double column = (floor(0.5 * (from + tip) / p->ds) + 0.5) * p->ds;
  BW_TRY(plate_branches(p, column, &o->branches, &o->fork));
  bw_pd_crack crack;
  BW_TRY(bw_pd_crack_collect(p->comm, &look, p->n, p->X0, p->damage, &crack));
  o->angle_first = 0.5 * bw_pd_crack_angle(&crack, from, from + reach, p->ds, gap);
  o->angle_last = 0.5 * bw_pd_crack_angle(&crack, tip - reach, tip, p->ds, gap);
  bw_pd_crack_release(&crack);
  return BW_OK;
}

/* The tip's way in 2e-6 s, the most at any step until the edge. */
static double speed_of_moments(const plate *p)
{
  const double window = 2e-6, step = p->config.time.step;
  const double until = isnan(p->crack.t_edge) ? p->time : p->crack.t_edge;
  double most = 0.0;
  for (int64_t k = llround(window / step); (double)k * step <= until; k++)
    most = fmax(most, bw_pd_crack_speed_at(&p->track, window, (double)k * step));
  return most;
}

static bw_status tear(const bw_comm *comm, const plate_config *c, outcome *o)
{
  plate p;
  bw_status st = plate_create(comm, c, &p);
  const int64_t steps = llround(c->time.end / c->time.step);
  while (st == BW_OK && p.steps < steps)
    st = plate_step(&p);
  if (st == BW_OK) {
    const bw_pd_bond_ledger e = bw_pd_bond_account(p.solid);
    o->crack = p.crack;
    o->energy_error = (e.external - e.kinetic - e.elastic - e.fracture) / e.external;
    const double stop = isnan(p.crack.t_edge) ? p.time : p.crack.t_edge;
    o->speed_mean = (p.crack.tip - p.notch_tip) / (stop - p.crack.t_start);
    o->speed_max = plate_speed(&p, 4e-6);
    o->speed_max_2us = speed_of_moments(&p);
    st = look_at_branches(&p, o);
  }
  plate_destroy(&p);
  return st;
}
