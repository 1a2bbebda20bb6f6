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
 * last 5 mm. speed_max stands beside Bowden's 1580 m/s (ADAPT figure 6.4), without a claim: in
 * 2e-6 s the tip moves 4 to 10 particles, so that it is a multiple of 250 or 500 m/s.
 *
 * BUILD modules=pd_interface
 * TEST ranks=2 timeout=200 */
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
static double load_for_start(const printed *a, double t)
{
  const plate_config c = glass(a->particles, 22e6, 0.0);
  const double t0 = wave_arrival(&c);
  return 22e6 * sqrt((start_by_mechanics(&c) - t0) / (t - t0));
}

static bw_status compare(bw_validation *v, const printed *a, double stress, bool claimed)
{
  static const char adapt[] = "ADAPT section 6.1, tables 6.2 and 6.3";
  static const char *const names[2][7] = {{"t_start", "t_branch", "l_branch", "angle_initial",
                                           "angle_final", "speed_mean", "speed_max"},
                                          {"t_start_inferred_load", "t_branch_inferred_load",
                                           "l_branch_inferred_load", "angle_initial_inferred_load",
                                           "angle_final_inferred_load", "speed_mean_inferred_load",
                                           "speed_max_inferred_load"}};
  const plate_config c = glass(a->particles, stress, 60e-6);
  const double degree = acos(-1.0) / 180.0;
  outcome o;
  BW_TRY(tear(bw_validation_comm(v), &c, &o));
  char extra[96];
  snprintf(extra, sizeof extra, "\"nodes\": %d, \"stress\": %.4g", a->nodes, stress);
  const double measured[7] = {o.crack.t_first,        o.crack.t_branch,      o.fork - c.shape.notch,
                              o.angle_first / degree, o.angle_last / degree, o.speed_mean,
                              o.crack.speed_max};
  const double reference[7] = {a->t_start,    a->t_branch,   a->l_branch, a->angle_first,
                               a->angle_last, a->speed_mean, 1580.0};
  for (int q = 0; q < 7; q++) {
    const double rows = 0.5 * c.shape.length / a->particles / 5e-3;
    const double angle = q == 3 || q == 4 ? atan(rows) / degree : 0.0;
    const bw_claim row = {claimed ? "branching as ADAPT's at the load its start belongs to"
                                  : "branching beside ADAPT's at the printed load",
                          names[claimed][q],
                          measured[q],
                          reference[q],
                          claimed && q < 6 ? 0.25 + angle / reference[q] : INFINITY,
                          BW_PUBLISHED,
                          q < 6 ? adapt : "Bowden et al. 1967, quoted in ADAPT figure 6.4",
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

static bw_status run(bw_validation *v)
{
  for (size_t q = 0; q < sizeof tables / sizeof *tables; q++) {
    BW_TRY(compare(v, &tables[q], 22e6, false));
    BW_TRY(compare(v, &tables[q], load_for_start(&tables[q], tables[q].t_start), true));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.crack_branching_22MPa", run);
}
