/* The front of a step-loaded bar.
 *
 * Claim      A traction switched on at the end of a bar sends a front along it at the speed of
 *            the plane wave; behind it particles move with t/(rho c); the front is about as
 *            wide as a horizon and hardly spreads.
 * Reference  1D wave equation: c = sqrt(M/rho), M = 6/5 E (uniaxial strain: 3D, plane strain),
 *            9/8 E (plane stress); velocity t/(rho c).
 * Measured   a bar one cell wide, periodic sideways, with lattice calibration (so M is known to
 *            the family's anisotropy); place where the velocity passes half of t/(rho c) at two
 *            times; the speed is their distance over the time; mean velocity of the stretch
 *            between 0.3 and 0.7 of the way; width from 90 % to 10 % of it.
 * Tolerance  speed: half the anisotropy of the family sum at that m (below 1 %; lattice_sum.h)
 *            plus the half-value's wander in the dispersive front, half a horizon in the
 *            distance of travel. Velocity: the same anisotropy plus the ripple behind the front
 *            that dispersion leaves, averaged over some 30 horizons, 1 %. Width: no claim but
 *            below 6 horizons (a front of the third-order dispersion k^3 grows like the cube
 *            root of time: with b = 1/24 .. 1/25, (3 b c t/delta)^(1/3) = 1.9 delta after 60
 *            delta, times 2.8 from 90 % to 10 % of the integral of the Airy function).
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"
#include "lattice_sum.h"

enum { LONG = 600 };
static const double E = 5, RHO = 2, TRACTION = 1e-5;

static const struct {
  bw_pd_geometry geometry;
  const char *name;
  double modulus; /* over E */
} settings[] = {{BW_PD_3D, "3d", 1.2},
                {BW_PD_PLANE_STRESS, "plane_stress", 1.125},
                {BW_PD_PLANE_STRAIN, "plane_strain", 1.2}};

/* Distance from the loaded end where the velocity (n particles in a row) last exceeds `level`. */
static double place(const double velocity[], int n, double level)
{
  int q = n - 1;
  while (q > 0 && velocity[q] < level)
    q--;
  const double next = q + 1 < n ? velocity[q + 1] : 0;
  return q + 0.5 + (velocity[q] - level) / (velocity[q] - next);
}

/* Velocity along the bar of all ranks. */
static bw_status profile(const bw_solid *pd, body_rows *r, double velocity[LONG])
{
  for (int q = 0; q < LONG; q++)
    velocity[q] = 0;
  bw_solid_get_velocity(pd, r->V);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    velocity[bw_solid_id(pd)[i]] = r->V[3 * i];
  bw_comm_sum(bw_solid_comm(pd), LONG, velocity);
  return BW_OK;
}

/* M/E of the calibrated family: uniaxial over isotropic energy (which is exact). */
static double uniaxial(const double xi[3], const void *data)
{
  (void)data;
  const double r = sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
  return xi[0] * xi[0] * xi[0] * xi[0] / (r * r * r);
}

static double dilation(const double xi[3], const void *data)
{
  (void)data;
  return sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
}

static double anisotropy(bw_pd_geometry g, double m, double modulus)
{
  static const double isotropic[] = {3, 1.5, 1.6};
  const bool planar = g != BW_PD_3D;
  const double family = 2 * isotropic[g] * lattice_sum(m, planar, planar, uniaxial, NULL) /
                        lattice_sum(m, planar, planar, dilation, NULL);
  return fabs(family / modulus - 1);
}

static void claim(bw_validation *v, const char *what, const char *name, double m, double measured,
                  double reference, double tolerance)
{
  char quantity[80], extra[80];
  snprintf(quantity, sizeof quantity, "%s_%s", what, name);
  snprintf(extra, sizeof extra, "\"m\": %g", m);
  bw_validation_row(v, &(bw_claim){.claim = "a step of traction travels as in the wave equation",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "1D wave equation, nu fixed by bonds",
                                   .extra = extra});
}

static bw_status measure(bw_validation *v, int which, double m)
{
  const bw_pd_geometry g = settings[which].geometry;
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  c.geometry = g, c.horizon_ratio = m, c.calibration = BW_PD_CALIBRATION_LATTICE;
  c.ds = 1, c.rho = RHO, c.E = E;
  c.period[1] = 1, c.period[2] = g == BW_PD_3D ? 1 : 0;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){LONG, 1, 1}, NULL, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  BW_TRY(bw_solid_load_traction(pd, (double[3]){0, -9, -9}, (double[3]){1, 9, 9}, 1,
                                (double[3]){TRACTION, 0, 0}, r.F));
  bw_solid_set_force(pd, r.F);

  const double speed = sqrt(settings[which].modulus * E / RHO), behind = TRACTION / (RHO * speed);
  double velocity[LONG], at[2], ahead = 0, tail = 0, mean = 0;
  const double dt = 0.5 * bw_solid_dt_max(pd);
  const int steps = (int)(0.4 * LONG / speed / dt);
  for (int half = 0; half < 2; half++) {
    for (int q = 0; q < steps; q++)
      BW_TRY(bw_solid_step(pd, dt));
    BW_TRY(profile(pd, &r, velocity));
    at[half] = place(velocity, LONG, 0.5 * behind);
    tail = place(velocity, LONG, 0.9 * behind), ahead = place(velocity, LONG, 0.1 * behind);
  }
  const int from = (int)(0.3 * at[1]), to = (int)(0.7 * at[1]);
  for (int q = from; q < to; q++)
    mean += velocity[q] / (to - from);
  const double error = anisotropy(g, m, settings[which].modulus), way = at[1] - at[0];
  const char *name = settings[which].name;
  claim(v, "speed", name, m, way / (steps * dt), speed, 0.5 * error + 0.5 * m / way);
  claim(v, "velocity_behind", name, m, mean, behind, 0.5 * error + 0.01);
  claim(v, "width_over_horizon", name, m, (ahead - tail) / m, 0, 6);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int q = 0; q < 3; q++) {
    BW_TRY(measure(v, q, 3));
    BW_TRY(measure(v, q, 5));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.bar_front", run);
}
