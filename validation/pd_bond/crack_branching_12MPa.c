/* Claim: a notched plate of soda-lime glass pulled by 12 MPa breaks as in FSI section 3: the crack
 * leaves the notch at about 10e-6 s, has become two branches, and reaches the far edge at about
 * 50e-6 s (figure 3; 200 x 80 particles, m = 3, dt 50e-9 s).
 * Tolerances. FSI prints both times to one digit with "about": half a unit of that digit, 5e-6 s,
 * is 50 % of 10 and 10 % of 50. The number of branches is exact.
 * A sharper reference for the start is fracture mechanics (crack_plate.h), 6.06e-6 s, for the first
 * broken bond: a lattice toughness wrong by 10 % moves t - t0 by 20 % (0.5e-6 s), and the load
 * reaches over the horizon in 0.3e-6 s: 0.8e-6 s together, 13 %.
 * Energy: external work = kinetic + elastic + fracture. Verlet's energy is off by (dt/dt_max)^2/8
 * = 3 % of the elastic part at most, which is 1 to 2 % of the work at the end; 1 % is asked.
 * --full: other integrators, steps, grids and corrections, reported beside.
 * BUILD modules=solid_tools,pd_interface
 * TEST  ranks=2 */
#include "crack_plate.h"

static const char fsi[] = "FSI paper (peridynamics and Navier-Stokes), section 3, figure 3";

static void record(bw_validation *v, const specimen_config *c, const outcome *o, const char *how,
                   bool claimed)
{
  char extra[128];
  snprintf(extra, sizeof extra, "\"nodes\": %d, \"run\": \"%s\"",
           c->shape.particles * c->shape.particles * 2 / 5, how);
  const bw_claim rows[] = {
      {"the crack leaves the notch when FSI saw it", "t_start", o->crack.t_start, 10e-6,
       claimed ? 0.5 : INFINITY, BW_PUBLISHED, fsi, extra},
      {"the crack reaches the far edge when FSI saw it", "t_edge", o->crack.t_end, 50e-6,
       claimed ? 0.1 : INFINITY, BW_PUBLISHED, fsi, extra},
      {"the crack branches into two", "branches", (double)o->fork.branches, 2.0,
       claimed ? 0.0 : INFINITY, BW_PUBLISHED, fsi, extra},
      {"the first bond breaks when K reaches its limit", "t_first_bond", o->crack.t_first,
       start_by_mechanics(c), claimed ? 0.13 : INFINITY, BW_ANALYTIC, mechanics_source, extra},
      {"work equals kinetic, elastic and fracture energy", "energy_error", o->energy_error, 0.0,
       claimed ? 0.01 : INFINITY, BW_CONSERVATION, "first law", extra},
  };
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    (void)bw_validation_row(v, &rows[q]);
}

static bw_status vary(bw_validation *v)
{
  enum { OTHERS = 8 };
  static const char *const how[OTHERS] = {"RK3",
                                          "dt 25e-9",
                                          "dt 10e-9",
                                          "no surface correction",
                                          "m = 4",
                                          "400 x 160, dt 25e-9",
                                          "energy correction",
                                          "|xi| < horizon"};
  specimen_config other[OTHERS];
  for (int q = 0; q < OTHERS; q++)
    BW_TRY(glass(bw_validation_comm(v), 200, 12e6, &other[q]));
  other[0].solid.integrator = BW_SOLID_RK3;
  other[1].time.step = 25e-9;
  other[2].time.step = 10e-9;
  other[3].solid.surface_correction = BW_PD_SURFACE_NONE;
  other[4].solid.horizon_ratio = 4.0;
  other[5].shape.particles = 400, other[5].time.step = 25e-9;
  other[6].solid.surface_correction = BW_PD_SURFACE_ENERGY;
  other[7].solid.family_reach = BW_PD_REACH_HORIZON;
  for (int q = 0; q < OTHERS; q++) {
    outcome o;
    BW_TRY(tear(bw_validation_comm(v), &other[q], &o));
    record(v, &other[q], &o, how[q], false);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  specimen_config c;
  outcome o;
  BW_TRY(glass(bw_validation_comm(v), 200, 12e6, &c));
  BW_TRY(tear(bw_validation_comm(v), &c, &o));
  record(v, &c, &o, "FSI", true);
  return bw_validation_full(v) ? vary(v) : BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.crack_branching_12MPa", run);
}
