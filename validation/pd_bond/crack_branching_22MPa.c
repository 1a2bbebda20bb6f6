/* Claim: the branching of ADAPT section 6.1 (tables 6.1 to 6.3; 4000 and 16000 nodes, m = 3,
 * dt 50e-9 s) comes out, but at the load its own t_start belongs to, not at the printed 22 MPa.
 *
 * Fracture mechanics (crack_plate.h; no free number) has the crack start at 4.24e-6 s under
 * 22 MPa; ADAPT prints 6.05e-6 and 6.00e-6 s, which is the start under 12.1 MPa (FSI's plate is
 * the same but for 12 MPa). So two runs per grid:
 * - 22 MPa: the first broken bond is claimed against fracture mechanics, 13 % as in
 *   crack_branching_12MPa; ADAPT's figures are reported beside, without a claim;
 * - the load that makes fracture mechanics start at ADAPT's t_start (_inferred_load): ADAPT's
 *   figures, 25 %. Origin: whether t_start means the first bond or the first particle with
 *   damage > 0.35, 1e-6 s later, shifts the inferred load by 29 %, to which times, lengths and
 *   speeds answer about proportionally; ADAPT's two grids differ by 12 % in l_branch and by up
 *   to 35 % in the angles. Angles have half a row over their 5 mm on top: 5.7 and 2.9 degrees.
 *
 * t_start: first broken bond. Angles: of one branch to the crack's way, over the first and the
 * last 5 mm.
 * speed_max: over 4e-6 s between two arrivals of the tip at a particle, against Bowden's 1580 m/s
 * (ADAPT figure 6.4): either end is known to one spacing, 2 ds of 6.3 mm (32 and 16 %). ADAPT takes
 * 2e-6 s between any two moments (_2us, reported): a whole number of 250 or 500 m/s, and as a
 * maximum up to one too many. Under 22 MPa 2000 m/s and more are no matter of the measurement:
 * they last for 8e-6 s and stand for every level of damage from 0.2 to 0.5.
 *
 * --full: other readings of ADAPT's set-up, reported: how many of its six figures come out within
 * 10 %. Under 22 MPa one at most, whatever is changed; without a surface correction, as ADAPT runs,
 * 22 MPa pull the loaded row off at 0.4e-6 s. Best are 14 MPa on families that count every partner
 * as a whole one, 4 and 5 of 6; nothing in ADAPT says so. Only stress over the root of G0 counts
 * (as long as strains are small), so that another G0 or s0 is another load; how many rows take the
 * load, the integrator and the step do not matter (crack_branching_12MPa).
 *
 * BUILD modules=solid_tools,pd_interface
 * TEST  ranks=2 timeout=3600 */
#include "crack_plate.h"

typedef struct {
  int particles, nodes;
  double t_start, t_branch, l_branch, angle_first, angle_last, speed_mean; /* ADAPT; degrees */
} printed;

static const printed tables[] = {
    {100, 4000, 6.05e-6, 21.85e-6, 17.0e-3, 26.5, 11.5, 1319.0},
    {200, 16000, 6.00e-6, 20.85e-6, 15.0e-3, 33.5, 15.5, 1344.0},
};

/* Load under which fracture mechanics has the crack start at t: t - t0 goes with 1/stress^2. */
static double load_for_start(const specimen_config *c, double t)
{
  const double t0 = wave_arrival(c), stress = fabs(c->loads[0].value[1]);
  return stress * sqrt((start_by_mechanics(c) - t0) / (t - t0));
}

enum { PRINTED = 6, MEASURED = 8 };

static bw_status measure(const bw_comm *comm, const specimen_config *c, outcome *o, double out[])
{
  const double degree = acos(-1.0) / 180.0;
  BW_TRY(tear(comm, c, o));
  const double all[MEASURED] = {o->crack.t_first,
                                o->crack.t_branch,
                                o->fork.x - c->follow.from[0],
                                0.5 * o->fork.angle_first / degree,
                                0.5 * o->fork.angle_last / degree,
                                o->speed_mean,
                                o->speed_max,
                                o->speed_max_2us};
  memcpy(out, all, sizeof all);
  return BW_OK;
}

static void printed_figures(const printed *a, double out[])
{
  const double all[MEASURED] = {a->t_start,    a->t_branch,   a->l_branch, a->angle_first,
                                a->angle_last, a->speed_mean, 1580.0,      1580.0};
  memcpy(out, all, sizeof all);
}

/* Of figure q at the inferred load. */
static double tolerance(const printed *a, int q, double reference)
{
  const double ds = 0.1 / a->particles, half_row = atan(0.5 * ds / 5e-3) * 180.0 / acos(-1.0);
  if (q == 3 || q == 4) return 0.25 + half_row / reference;
  if (q == 6) return 2.0 * ds / (4e-6 * reference);
  return q == 7 ? INFINITY : 0.25;
}

static bw_status compare(bw_validation *v, const printed *a, double stress, bool claimed)
{
  static const char adapt[] = "ADAPT section 6.1, tables 6.2 and 6.3";
  static const char *const names[MEASURED] = {"t_start",       "t_branch",     "l_branch",
                                              "angle_initial", "angle_final",  "speed_mean",
                                              "speed_max",     "speed_max_2us"};
  specimen_config c;
  outcome o;
  double measured[MEASURED], reference[MEASURED];
  char extra[96], name[64];
  BW_TRY(glass(bw_validation_comm(v), a->particles, stress, &c));
  BW_TRY(measure(bw_validation_comm(v), &c, &o, measured));
  printed_figures(a, reference);
  snprintf(extra, sizeof extra, "\"nodes\": %d, \"stress\": %.4g", a->nodes, stress);
  for (int q = 0; q < MEASURED; q++) {
    snprintf(name, sizeof name, "%s%s", names[q], claimed ? "_inferred_load" : "");
    const bw_claim row = {claimed ? "branching as ADAPT's at the load its start belongs to"
                                  : "branching beside ADAPT's at the printed load",
                          name,
                          measured[q],
                          reference[q],
                          claimed ? tolerance(a, q, reference[q]) : INFINITY,
                          BW_PUBLISHED,
                          q < PRINTED ? adapt : "Bowden et al. 1967, quoted in ADAPT figure 6.4",
                          extra};
    (void)bw_validation_row(v, &row);
  }
  const bw_claim row = {"the first bond breaks when K reaches its limit",
                        "t_first_bond",
                        o.crack.t_first,
                        start_by_mechanics(&c),
                        0.13,
                        BW_ANALYTIC,
                        mechanics_source,
                        extra};
  (void)bw_validation_row(v, &row);
  return BW_OK;
}

typedef struct {
  const char *how;
  double stress, horizon_ratio;
  int reach, fraction, correction;
} reading;

static const reading readings[] = {
    {"as the claims", 22e6, 3.0, BW_PD_REACH_HALF_CELL, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_VOLUME},
    {"half of the load", 11e6, 3.0, BW_PD_REACH_HALF_CELL, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_VOLUME},
    {"m = 4", 22e6, 4.0, BW_PD_REACH_HALF_CELL, BW_PD_FRACTION_LINEAR, BW_PD_SURFACE_VOLUME},
    {"no surface correction", 22e6, 3.0, BW_PD_REACH_HALF_CELL, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_NONE},
    {"partners within the horizon", 22e6, 3.01, BW_PD_REACH_HORIZON, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_VOLUME},
    {"ADAPT's families, no correction", 22e6, 3.01, BW_PD_REACH_HORIZON, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_NONE},
    {"ADAPT's families, no correction", 12e6, 3.01, BW_PD_REACH_HORIZON, BW_PD_FRACTION_LINEAR,
     BW_PD_SURFACE_NONE},
    {"whole partners within the horizon, no correction", 14e6, 3.01, BW_PD_REACH_HORIZON,
     BW_PD_FRACTION_NONE, BW_PD_SURFACE_NONE},
    {"whole partners", 14e6, 3.0, BW_PD_REACH_HALF_CELL, BW_PD_FRACTION_NONE, BW_PD_SURFACE_VOLUME},
};

static bw_status read_otherwise(bw_validation *v, const printed *a, const reading *r)
{
  specimen_config c;
  outcome o;
  double measured[MEASURED], reference[MEASURED], within = 0.0;
  char extra[128];
  BW_TRY(glass(bw_validation_comm(v), a->particles, r->stress, &c));
  c.solid.horizon_ratio = r->horizon_ratio;
  c.solid.family_reach = r->reach;
  c.solid.volume_fraction = r->fraction;
  c.solid.surface_correction = r->correction;
  BW_TRY(measure(bw_validation_comm(v), &c, &o, measured));
  printed_figures(a, reference);
  for (int q = 0; q < PRINTED; q++)
    within += fabs(measured[q] / reference[q] - 1.0) <= 0.1;
  snprintf(extra, sizeof extra, "\"nodes\": %d, \"stress\": %.4g, \"run\": \"%s\"", a->nodes,
           r->stress, r->how);
  const bw_claim row = {"figures of ADAPT's tables within 10 % under another reading",
                        "within_10_percent",
                        within,
                        PRINTED,
                        INFINITY,
                        BW_PUBLISHED,
                        "ADAPT section 6.1, tables 6.2 and 6.3",
                        extra};
  (void)bw_validation_row(v, &row);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  specimen_config c;
  BW_TRY(glass(bw_validation_comm(v), 200, 22e6, &c));
  for (size_t q = 0; q < sizeof tables / sizeof *tables; q++) {
    BW_TRY(compare(v, &tables[q], 22e6, false));
    BW_TRY(compare(v, &tables[q], load_for_start(&c, tables[q].t_start), true));
    for (size_t k = 0; bw_validation_full(v) && k < sizeof readings / sizeof *readings; k++)
      BW_TRY(read_otherwise(v, &tables[q], &readings[k]));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.crack_branching_22MPa", run);
}
