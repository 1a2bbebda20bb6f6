/* Claim: a crack that has to run straight is drawn to the lattice's weak directions, those of the
 * bonds, and the more bonds there are the less (ADAPT chapter 5). cases/notched_plate/
 * turned_lattice.yaml; quick form at twice ADAPT's spacing, --full at both.
 *
 * A lattice turned by a has weak directions at a - w to the notch, w = 0, 18.435, 26.565, 45
 * degrees at m = 3 (ADAPT 5.2; its fifth, 30.964, is the corner of the cell (3,2) that its
 * IPA-Hybrid families reach into, no bond here). ADAPT figure 5.10 and text: the crack follows a -
 * 0 at 5 and 10 degrees, a - 26.565 at 20 (not the nearer 18.435) and at 30, a - 45 at 40.
 * Tolerances. "followed" is the path's angle over that of its weak direction; ADAPT draws it as 1
 * and prints no figure. Load and lattice pull against each other, so that a path is a staircase of
 * both; it counts as followed from 0.3 on, 1.0 to 3 degrees: more than half a spacing at each end
 * of the 0.145 m fitted can turn it, ds/0.145 m = 0.8 degrees (0.4 at 1 mm); hence 1 +- 0.7.
 * m = 6 at 10 degrees is "horizontal" in ADAPT's table 5.2. It has bonds at 9.46 and 11.31 degrees,
 * 0.54 above and 1.31 below the right way: 1.31 degrees and that of the spacing.
 * A lattice turned the other way gives the mirror image (the sum of both angles), and one along the
 * notch (m = 3) leaves it straight: that of the spacing.
 * In clouds (disorder 0.38, m = 3, --full) the part of the angle towards the weak direction the
 * lattice's crack follows has a mean of 0 within three times its own scatter over the root of the
 * number of runs: a cloud does not know where its sites' axes are.
 * The ordinary law (nu = 0.22, --full) does the same by less: reported but for m = 6.
 *
 * BUILD modules=solid_tools,pd_interface
 * TEST  ranks=2 timeout=7200 */
#include "specimen_run.h"

enum { TURNS = 6 };
static const double turns[TURNS] = {0, 5, 10, 20, 30, 40};
static const double weak[TURNS] = {0, 0, 0, 26.565051177, 26.565051177, 45}; /* that is followed */

typedef struct {
  double angle, width, t_start, t_end, reach, residual;
} outcome;

typedef struct {
  double turn, m, spacing; /* [deg], [-], [mm] */
  bool slow;               /* load raised to twice as much within 3e-3 s: ADAPT 5.1.2 */
  double disorder;         /* a cloud; at 0.9 MPa instead of 0.8, which stops in some of them */
  int seed;
  bool ordinary; /* the ordinary law, nu = 0.22 */
} variant;

static bw_status tear(const bw_comm *comm, const variant *q, outcome *o)
{
  specimen_config c;
  specimen p;
  BW_TRY(specimen_read(comm, "notched_plate/turned_lattice", 0, NULL, &c));
  c.shape.lattice_angle = q->turn;
  c.solid.horizon_ratio = q->m;
  c.time.step *= q->spacing;
  c.shape.particles = (int)lround(c.shape.particles / q->spacing);
  if (q->ordinary) c.solid.choice.law = BW_SOLID_ORDINARY, c.solid.choice.poisson_ratio = 0.22;
  for (int k = 0; q->slow && k < c.n_loads; k++)
    c.loads[k].rise = 3e-3, c.loads[k].value[1] *= 2.0;
  if (q->slow) c.time.end = 3.6e-3;
  if (q->disorder > 0.0) {
    c.solid.disorder = q->disorder, c.solid.disorder_seed = q->seed;
    c.solid.volume_fraction = BW_PD_FRACTION_LINEAR;
    for (int k = 0; k < c.n_loads; k++)
      c.loads[k].value[1] *= 0.9 / 0.8;
  }
  memset(&p, 0, sizeof p);
  bw_status st = specimen_break(comm, &c, &p);
  bw_pd_crack_line line = {0, NAN, NAN};
  double residual = NAN;
  BW_THEN(st, specimen_fit(&p, &line));
  BW_THEN(st, specimen_residual(&p, &residual));
  if (st == BW_OK) {
    *o = (outcome){line.angle * 180.0 / acos(-1.0),
                   line.width,
                   p.crack.t_start,
                   p.crack.t_end,
                   p.crack.reach,
                   residual};
  }
  specimen_destroy(&p);
  return st;
}

static void add(bw_validation *v, const char *claim, const char *quantity, double measured,
                double reference, double tolerance, const variant *q)
{
  char extra[160];
  snprintf(extra, sizeof extra,
           "\"turn\": %g, \"m\": %g, \"spacing\": %g, \"load\": \"%s\", \"disorder\": %g, \"law\": "
           "\"%s\"",
           q->turn, q->m, 1e-3 * q->spacing, q->slow ? "slow" : "sudden", q->disorder,
           q->ordinary ? "ordinary" : "bond");
  const bw_claim row = {claim,     quantity,     measured,          reference,
                        tolerance, BW_PUBLISHED, "ADAPT chapter 5", extra};
  if (!isnan(measured) || isfinite(tolerance)) (void)bw_validation_row(v, &row);
}

/* What half a spacing at both ends turns a path of 0.145 m by [deg]. */
static double spacing_turn(const variant *q)
{
  return atan(1e-3 * q->spacing / 0.145) * 180.0 / acos(-1.0);
}

/* One run and its rows; the angle goes to *angle. */
static bw_status study(bw_validation *v, const variant *q, double *angle)
{
  outcome o;
  BW_TRY(tear(bw_validation_comm(v), q, &o));
  *angle = o.angle;
  add(v, "angle of the path [deg]", "angle", o.angle, 0.0, INFINITY, q);
  add(v, "how far it got [m]", "reach", o.reach, 0.2, INFINITY, q);
  add(v, "when it started [s]", "t_start", o.t_start, 560e-6, INFINITY, q);
  for (int k = 1; k < TURNS; k++)
    if (turns[k] == fabs(q->turn) && q->m == 3.0) {
      const double sign = q->turn > 0.0 ? 1.0 : -1.0;
      add(v, "the path follows the weak direction", "followed",
          sign * o.angle / (turns[k] - weak[k]), 1.0, q->slow || q->ordinary ? INFINITY : 0.7, q);
    }
  if (q->m == 6.0 && q->turn == 10.0 && !q->slow)
    add(v, "at m = 6 it runs straight", "straight", o.angle, 0.0, 1.31 + spacing_turn(q), q);
  if (q->m == 3.0 && q->turn == 0.0 && !q->slow)
    add(v, "the lattice along the notch leaves it straight", "aligned", o.angle, 0.0,
        spacing_turn(q), q);
  add(v, "energy not accounted for, of the work", "energy_error", o.residual, 0.0, 0.01, q);
  return BW_OK;
}

/* Three clouds for each turn at m = 3. */
static bw_status clouds(bw_validation *v)
{
  enum { SEEDS = 3 };
  double sum = 0.0, squares = 0.0;
  const double runs = (TURNS - 1) * SEEDS;
  for (int k = 1; k < TURNS; k++)
    for (int seed = 0; seed < SEEDS; seed++) {
      const variant q = {turns[k], 3.0, 2.0, false, 0.38, seed, false};
      outcome o;
      BW_TRY(tear(bw_validation_comm(v), &q, &o));
      const double towards = turns[k] > weak[k] ? o.angle : -o.angle;
      add(v, "angle of the path in a cloud [deg]", "angle_cloud", o.angle, 0.0, INFINITY, &q);
      sum += towards, squares += towards * towards;
    }
  const double scatter = sqrt((squares - sum * sum / runs) / (runs - 1.0));
  const variant all = {0.0, 3.0, 2.0, false, 0.38, 0, false};
  add(v, "clouds do not draw the path to their sites' weak directions [deg, all turns]",
      "pull_cloud", sum / runs, 0.0, 3.0 * scatter / sqrt(runs), &all);
  return BW_OK;
}

/* ADAPT's tables at one spacing [mm]. */
static bw_status everything(bw_validation *v, double spacing, bool slow, bool ordinary,
                            double m_last)
{
  for (double m = 3.0; m <= m_last; m += 1.0)
    for (int k = slow ? 1 : 0; k < TURNS; k++) {
      const variant q = {turns[k], m, spacing, slow, 0.0, 0, ordinary};
      double angle;
      BW_TRY(study(v, &q, &angle));
    }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const variant quick[] = {{10, 3, 2, false, 0, 0, false},
                                  {-10, 3, 2, false, 0, 0, false},
                                  {10, 6, 2, false, 0, 0, false},
                                  {20, 3, 2, false, 0, 0, false}};
  double angle[4];
  for (int q = 0; q < 4; q++)
    BW_TRY(study(v, &quick[q], &angle[q]));
  add(v, "a lattice turned the other way gives the mirror image", "mirror", angle[0] + angle[1],
      0.0, spacing_turn(&quick[1]), &quick[1]);
  if (!bw_validation_full(v)) return BW_OK;
  BW_TRY(clouds(v));
  BW_TRY(everything(v, 2.0, false, true, 6.0));
  BW_TRY(everything(v, 2.0, false, false, 8.0));
  BW_TRY(everything(v, 2.0, true, false, 8.0));
  return everything(v, 1.0, false, false, 8.0);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.grid_orientation", run);
}
