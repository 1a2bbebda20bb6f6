/* Claim: the plate of Kalthoff and Winkler, struck between its notches, cracks as in ADAPT section
 * 6.2 and in the experiment: at about 24e-6 s, at 68 degrees to the notch, slower than 0.75 of the
 * Rayleigh speed, and symmetrically. cases/notched_plate/notched_plate.yaml.
 *
 * Families as ADAPT's (PA-PDLAMMPS: partners within the horizon alone); quick: its coarse spacing
 * of 2 mm for the start, its finer one of 1 mm for path and speed.
 * Tolerances. Angle: 3 degrees; ADAPT prints 68 and about 70 for the experiment, and a path whose
 * ends are off by one spacing each way over the 70 mm fitted is off by 1.6 degrees. Start: 10 %;
 * ADAPT prints "about 24" for a grid of 2 mm that it refines to 1 mm at 15.3e-6 s, and the two
 * grids alone differ by 2e-6 s here. Speed: over 5.46e-6 s, three of
 * ADAPT's windows, between two arrivals of the tip at a particle (bw_pd_crack_speed), in which it
 * makes 8 spacings or more; over one window, two to four spacings, it is reported beside ADAPT's
 * 1981 m/s. The limit is one-sided: the row is the excess over 0.75 x 2799 m/s, and has to be 0.
 * Symmetry: the lattice is symmetric about the plate's middle, and so is the load: the broken
 * bonds of both halves are the same to rounding, which a crack can amplify: the tips of both
 * cracks, two spacings.
 * Energy: 1 %, (dt/dt_max)^2/8 of Verlet at dt/dt_max = 0.35 as in crack_branching_12MPa.
 * --full: spacing 0.5 mm, families with half a cell more, m = 4, a turned lattice, an edge that is
 * thrown instead of pushed (ADAPT's "initial speed"; nothing breaks); reported beside, rows without
 * a number left out.
 *
 * BUILD modules=solid_tools,pd_interface
 * TEST  ranks=2 timeout=3600 */
#include "specimen_run.h"

static const char adapt[] = "ADAPT section 6.2";
static const double RAYLEIGH = 2799.2; /* [m/s] ADAPT section 6.2 */

typedef struct {
  double angle, width, lower_tip, upper_tip, t_start, t_end, speed, speed_adapt, residual;
} outcome;

/* The lower crack's distance from its notch. */
static bw_status measure(specimen *p, outcome *o)
{
  const double degree = acos(-1.0) / 180.0;
  bw_pd_crack_line line;
  BW_TRY(specimen_fit(p, &line));
  o->angle = line.angle / degree;
  o->width = line.width / p->ds;
  o->t_start = p->crack.t_start;
  o->t_end = p->crack.t_end;
  o->speed = specimen_speed(p, 5.46e-6);
  o->speed_adapt = specimen_speed(p, 1.82e-6);
  BW_TRY(specimen_residual(p, &o->residual));
  o->upper_tip = p->crack.reach;
  specimen_follow *f = &p->config.follow;
  const double height = p->config.shape.height, upper = f->upper[1], lower = f->lower[1];
  f->from[1] = height - f->from[1];
  f->lower[1] = height - upper;
  f->upper[1] = height - lower;
  bw_pd_crack crack;
  BW_TRY(specimen_find(p, &crack));
  o->lower_tip = bw_pd_crack_reach(&crack, f->from[0], f->from[1], NULL);
  bw_pd_crack_release(&crack);
  return BW_OK;
}

static bw_status strike(const bw_comm *comm, int n, const char *const changes[], outcome *o)
{
  specimen_config c;
  specimen p;
  BW_TRY(specimen_read(comm, "notched_plate/notched_plate", n, changes, &c));
  memset(&p, 0, sizeof p);
  bw_status st = specimen_break(comm, &c, &p);
  BW_THEN(st, measure(&p, o));
  specimen_destroy(&p);
  return st;
}

static void record(bw_validation *v, const char *how, bool claim_start, bool claim_path,
                   const outcome *o, double spacing)
{
  char extra[96];
  snprintf(extra, sizeof extra, "\"run\": \"%s\"", how);
  const double limit = 0.75 * RAYLEIGH;
  const double path = claim_path ? 1.0 : INFINITY, start = claim_start ? 1.0 : INFINITY;
  const bw_claim rows[] = {
      {"the crack runs at 68 degrees", "angle", o->angle, 68.0, path * 3.0 / 68.0, BW_PUBLISHED,
       adapt, extra},
      {"the crack starts when ADAPT's does", "t_start", o->t_start, 24e-6, start * 0.1,
       BW_PUBLISHED, adapt, extra},
      {"the crack is slower than 0.75 of the Rayleigh speed: excess", "speed_max",
       fmax(0.0, o->speed - limit), 0.0, claim_path ? 0.0 : INFINITY, BW_PUBLISHED,
       "ADAPT section 6.2; Belytschko et al. 2003", extra},
      {"highest speed over 5.46e-6 s, of the limit", "speed_over_limit", o->speed, limit, INFINITY,
       BW_PUBLISHED, adapt, extra},
      {"highest speed over 1.82e-6 s", "speed_max_1.82us", o->speed_adapt, 1981.0, INFINITY,
       BW_PUBLISHED, adapt, extra},
      {"how far the crack got [m]", "reach", o->upper_tip, 0.08, INFINITY, BW_PUBLISHED, adapt,
       extra},
      {"both cracks reach equally far", "asymmetry", (o->upper_tip - o->lower_tip) / spacing, 0.0,
       path * 2.0, BW_ANALYTIC, "symmetry of the plate", extra},
      {"work equals kinetic, elastic and fracture energy", "energy_error", o->residual, 0.0,
       path * 0.01, BW_CONSERVATION, "first law", extra},
  };
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    if (isfinite(rows[q].measured) || isfinite(rows[q].tolerance))
      (void)bw_validation_row(v, &rows[q]);
}

static bw_status vary(bw_validation *v)
{
  static const struct {
    const char *how;
    double spacing;
    int n;
    const char *change[5];
  } other[] = {
      {"0.5 mm", 0.5e-3, 3, {"shape.particles=200", "time.step=50e-9", "follow.every=4"}},
      {"half_cell", 1e-3, 2, {"solid.family_reach=half_cell", "solid.horizon_ratio=3"}},
      {"m = 4", 1e-3, 1, {"solid.horizon_ratio=4.01"}},
      {"no volume fraction", 1e-3, 1, {"solid.volume_fraction=none"}},
      {"energy correction", 1e-3, 1, {"solid.surface_correction=energy"}},
      {"dt 35e-9", 1e-3, 1, {"time.step=35e-9"}},
      {"lattice at 5 degrees", 1e-3, 1, {"shape.lattice_angle=5"}},
      {"edge thrown, not pushed", 1e-3, 1, {"loads.0.kind=start"}},
  };
  for (size_t q = 0; q < sizeof other / sizeof *other; q++) {
    outcome o;
    BW_TRY(strike(bw_validation_comm(v), other[q].n, other[q].change, &o));
    record(v, other[q].how, false, false, &o, other[q].spacing);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const char *const coarse[] = {"shape.particles=50"};
  outcome o;
  BW_TRY(strike(bw_validation_comm(v), 1, coarse, &o));
  record(v, "2 mm", true, false, &o, 2e-3);
  BW_TRY(strike(bw_validation_comm(v), 0, NULL, &o));
  record(v, "1 mm", true, true, &o, 1e-3);
  return bw_validation_full(v) ? vary(v) : BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.kalthoff_winkler", run);
}
