/* Claim: normal probes give the pressure and the friction around a confined cylinder.
 *
 * Reference  an independent finite-element solution, Re_d = 20, blockage 0.25, long channel (10 d
 *            before, 25 d behind): data/confined_cylinder/confined_cylinder_wall.csv.
 * Measured   pressure less its mean around the cylinder, and shear stress, at the surface points
 *            of the upper half; largest difference over the largest value of the reference.
 *            Markers retracted by 0.3 h. 15 cells per diameter, 30 too with --full; probes of 1 to
 *            4 h.
 * Tolerance  with d = 1, dl the probe's length, delta = 1/sqrt(Re) the thickness of the layer:
 *            friction, parabola: (dl/delta)^2/2 for the cubic term it leaves out, and 2 (0.1 h)/dl
 *            for 0.1 h of doubt about where the smeared wall is. Pressure: what lies between tip
 *            and wall at the shoulder, (dl/2) u_e^2/(1/2 + dl) with u_e = 1.17 (reference's own
 *            scale: 2 x 1.5 U_b 4/3 of the gap's mean, at dl = 0.13), as if the step from the tip
 *            to the wall were all wrong. Reported beside: dl = h, whose tip lies in the layer over
 *            which the kernel smears the jump of the pressure; and the linear profile, first order:
 *            in the thin layer at the front it loses most of the friction.
 * BUILD modules=ns_channel,ibm_mdf
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/cylinder_flow.h"
#include "bw_validation.h"

#include <stdio.h>
#include <string.h>

enum { ROWS = 37 }; /* every five degrees */
typedef struct {
  double theta[ROWS], dp[ROWS], tau[ROWS];
} wall_table;

static bw_status read_reference(wall_table *w)
{
  double table[ROWS][3];
  int rows = 0;
  BW_TRY(bw_validation_table("confined_cylinder/confined_cylinder_wall.csv", 3, ROWS, table[0],
                             &rows));
  BW_REQUIRE(rows == ROWS, BW_EINPUT, "the reference has %d rows, %d are needed", rows, ROWS);
  for (int q = 0; q < ROWS; q++) {
    w->theta[q] = table[q][0];
    w->dp[q] = table[q][1];
    w->tau[q] = table[q][2];
  }
  return BW_OK;
}

/* Linear between the rows: 5 degrees leave out at most 0.003 of the range. */
static double at(const wall_table *w, const double value[ROWS], double theta)
{
  int q = (int)(theta / 5.0);
  if (q > ROWS - 2) q = ROWS - 2;
  return value[q] + (value[q + 1] - value[q]) * (theta - w->theta[q]) / 5.0;
}

typedef struct {
  double dp, tau;            /* largest error over the reference's largest value */
  double pressure, friction; /* parts of Cd */
} wall_error;

/* Pressure and shear stress at a surface point, and its angle; false on the lower half. */
static bool stress(const cylinder_flow *f, size_t q, double *theta, double *p, double *tau)
{
  const double *n = f->wall.N + 3 * q, *t = f->traction + 3 * q;
  *theta = atan2(n[1], -n[0]) * 180.0 / acos(-1.0);
  *p = -(t[0] * n[0] + t[1] * n[1]);
  *tau = t[0] * n[1] - t[1] * n[0];
  return n[1] > 0.0;
}

static wall_error compare(const cylinder_flow *f, const wall_table *w)
{
  wall_error e = {0};
  double theta, p, tau, shift = 0.0, count = 0.0;
  for (size_t q = 0; q < f->wall.n; q++) {
    const double *n = f->wall.N + 3 * q;
    const bool upper = stress(f, q, &theta, &p, &tau);
    e.pressure -= 2.0 * p * n[0] * f->area / f->h; /* per 0.5 rho U_b^2 d */
    e.friction += 2.0 * tau * n[1] * f->area / f->h;
    if (upper) shift += p - at(w, w->dp, theta), count += 1.0;
  }
  for (size_t q = 0; q < f->wall.n; q++) {
    if (!stress(f, q, &theta, &p, &tau)) continue;
    e.dp = fmax(e.dp, fabs(p - shift / count - at(w, w->dp, theta)));
    e.tau = fmax(e.tau, fabs(tau - at(w, w->tau, theta)));
  }
  double most[2] = {0.0, 0.0};
  for (int q = 0; q < ROWS; q++) {
    most[0] = fmax(most[0], fabs(w->dp[q]));
    most[1] = fmax(most[1], fabs(w->tau[q]));
  }
  e.dp /= most[0];
  e.tau /= most[1];
  return e;
}

/* Cd_p and Cd_f of the reference: trapezoids over its table. */
static void reference_parts(const wall_table *w, double part[2])
{
  part[0] = part[1] = 0.0;
  for (int q = 0; q < ROWS; q++) {
    const double theta = w->theta[q] * acos(-1.0) / 180.0;
    const double step = acos(-1.0) / 36.0 * (q == 0 || q == ROWS - 1 ? 0.5 : 1.0);
    part[0] += 2.0 * w->dp[q] * cos(theta) * step; /* both halves; d/2 per radian; over 0.5 */
    part[1] += 2.0 * w->tau[q] * sin(theta) * step;
  }
}

/* length: of the probes, in spacings. */
static void rows(bw_validation *v, const cylinder_flow *f, const wall_table *w, bool parabola,
                 double length)
{
  const cylinder_config *c = &f->config;
  const wall_error e = compare(f, w);
  const double dl = length * f->h, over = dl * sqrt(c->reynolds);
  const double friction = 0.5 * over * over + 2.0 * 0.1 / length;
  const double pressure = 0.5 * dl * 1.17 * 1.17 / (0.5 + dl) / 3.33;
  const bool claimed = parabola && length >= 1.5;
  double part[2];
  reference_parts(w, part);
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } row[] = {{"pressure_max_error", e.dp, 0.0, pressure},
             {"friction_max_error", e.tau, 0.0, friction},
             {"Cd_pressure", e.pressure, part[0], pressure * 3.33 / part[0] * acos(-1.0)},
             {"Cd_friction", e.friction, part[1], friction}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
    char claim[96], extra[96];
    const char *profile = parabola ? "quadratic" : "linear";
    snprintf(claim, sizeof claim, "%s, %d cells, %s profile of %g h", row[q].quantity,
             c->cells_per_diameter, profile, length);
    snprintf(extra, sizeof extra,
             "\"cells_per_diameter\": %d, \"profile\": \"%s\", \"probe_length\": %g",
             c->cells_per_diameter, profile, length);
    bw_validation_row(v, &(bw_claim){claim, row[q].quantity, row[q].measured, row[q].reference,
                                     claimed ? row[q].tolerance : INFINITY, BW_INDEPENDENT_CODE,
                                     "independent finite elements, data/confined_cylinder", extra});
  }
}

static bw_status one_probe(bw_validation *v, cylinder_flow *f, const wall_table *w,
                           bw_probe_profile profile, double length)
{
  bw_probe *probe = NULL;
  bw_probe_config config = bw_probe_config_default();
  config.rho = 1.0, config.nu = 1.0 / f->config.reynolds;
  config.length = length, config.profile = profile;
  bw_status st = bw_probe_create(f->flow.grid, &config, &probe);
  BW_THEN(st, bw_probe_set_points(probe, f->wall.n, f->wall.X, f->wall.N));
  if (st == BW_OK) {
    bw_probe_traction(probe, bw_ns_channel_velocity(f->flow.fluid), f->flow.pressure, NULL,
                      f->traction, NULL);
    rows(v, f, w, profile == BW_PROBE_QUADRATIC, length);
  }
  bw_probe_destroy(&probe);
  return st;
}

static bw_status one_grid(bw_validation *v, const wall_table *w, int cells)
{
  static const double lengths[] = {1.0, 1.5, 2.0, 3.0, 4.0};
  cylinder_config c = cylinder_config_default();
  cylinder_flow f;
  c.reynolds = 20.0, c.upstream = 10.0, c.downstream = 25.0, c.cells_per_diameter = cells;
  bw_status st = cylinder_create(bw_validation_comm(v), &c, &f);
  BW_THEN(st, cylinder_advance(&f, 20.0)); /* the drag has settled to 1e-5 after 13 */
  for (int p = BW_PROBE_PROFILES - 1; p >= 0; p--)
    for (size_t q = 0; q < sizeof lengths / sizeof *lengths; q++)
      BW_THEN(st, one_probe(v, &f, w, (bw_probe_profile)p, lengths[q]));
  cylinder_destroy(&f);
  return st;
}

static bw_status run(bw_validation *v)
{
  wall_table w = {{0.0}, {0.0}, {0.0}};
  BW_TRY(read_reference(&w));
  BW_TRY(one_grid(v, &w, 15));
  return bw_validation_full(v) ? one_grid(v, &w, 30) : BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "probe.cylinder_wall", run);
}
