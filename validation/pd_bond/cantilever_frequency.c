/* First natural frequency of a cantilever.
 *
 * Claim      A cantilever swings with the frequency of beam theory within 1 %: without surface
 *            correction in the limit of a thin skin (lattice calibration), with the correction
 *            `tensor` at a height of 8 horizons. Other corrections stiffen the skin, where bending
 *            is carried, by more than it lacks: reported beside.
 * Reference  Timoshenko's beam, clamped and free, k = 5/6: the first root of the end
 *            conditions, found here by integration of the beam's equations (Runge-Kutta of
 *            fourth order, 400 steps) and bisection; its slender limit 1.8751^2 sqrt(EI/(rho A
 *            L^4)) is checked. For the limit E is that of the family at m = 3, 1.0243 times the
 *            one asked for (pd_bond.stiffness), from sums written independently
 *            (lattice_sum.h).
 * Measured   plane stress, L = 8 h (tensor: 16 h, as the clamp acts within a horizon, which at 8 h
 *            is another half percent), h = 12 and 24 ds (full: 48 too); started with a velocity in
 *            the shape of the first mode of Euler's beam; zeros of the velocity in that shape
 *            after a quarter and three quarters of a period. Limit: 2 w(24) - w(12), as the error
 * is of order one in delta/h (pd_bond.convergence). Tolerance  1 %, a goal; tensor: (delta/h)^2/4
 * = 0.4 % of bending (pd_bond.skin), the clamp's place to delta/2, (delta/2)/L 2 = 0.8 %: together
 * 1 % or a little more. The slender limit: shear and rotation shift it by (h/L)^2, 1e-5 at L = 400
 * h; the integration by less; 1e-4.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"
#include "lattice_sum.h"

static const double E = 5, RHO = 2, SPEED = 1e-6;

/* State of the beam (w, psi, M, V): its slope along x for the frequency squared. Height 1, width 1.
 */
static void beam_slope(double omega2, const double y[4], double d[4])
{
  const double ei = E / 12, kga = 5.0 / 6 * E / (2 * (1 + 1.0 / 3));
  d[0] = y[1] + y[3] / kga;
  d[1] = y[2] / ei;
  d[2] = -y[3] - RHO / 12 * omega2 * y[1];
  d[3] = -RHO * omega2 * y[0];
}

static void beam_integrate(double omega2, double length, double y[4])
{
  enum { N = 400 };
  const double h = length / N, part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
  for (int q = 0; q < N; q++) {
    double slope[4] = {0}, sum[4] = {0}, at[4];
    for (int s = 0; s < 4; s++) {
      for (int k = 0; k < 4; k++)
        at[k] = y[k] + part[s] * h * slope[k];
      beam_slope(omega2, at, slope);
      for (int k = 0; k < 4; k++)
        sum[k] += weight[s] * slope[k];
    }
    for (int k = 0; k < 4; k++)
      y[k] += h / 6 * sum[k];
  }
}

/* Moment and shear force at the free end vanish for some of both at the clamp. */
static double beam_determinant(double omega, double length)
{
  double a[4] = {0, 0, 1, 0}, b[4] = {0, 0, 0, 1};
  beam_integrate(omega * omega, length, a);
  beam_integrate(omega * omega, length, b);
  return a[2] * b[3] - a[3] * b[2];
}

static double beam_frequency(double length)
{
  const double euler = 1.8751041 * 1.8751041 * sqrt(E / 12 / RHO) / (length * length);
  double low = 0.5 * euler, high = 1.2 * euler; /* the second is above 6 euler */
  for (int q = 0; q < 60; q++) {
    const double middle = 0.5 * (low + high);
    if (beam_determinant(low, length) * beam_determinant(middle, length) <= 0)
      high = middle;
    else
      low = middle;
  }
  return low;
}

static int gripped(const int32_t site[3], const void *data)
{
  return site[0] < *(const int *)data ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

typedef struct {
  double grip, length;
} beam;

/* First mode of Euler's beam. */
static void shape(const double X0[3], double V[3], const void *data)
{
  const beam *b = data;
  const double k = 1.8751041, x = k * (X0[0] - b->grip) / b->length;
  const double ratio = (cosh(k) + cos(k)) / (sinh(k) + sin(k));
  V[0] = V[2] = 0;
  V[1] = x > 0 ? SPEED * (cosh(x) - cos(x) - ratio * (sinh(x) - sin(x))) : 0;
}

/* Part of the velocity that has the shape of the first mode: ripples do not cross zero with it. */
static double modal(const bw_solid *pd, const beam *b, const body_rows *r)
{
  double sum = 0, first[3];
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    shape(r->X0 + 3 * i, first, b);
    sum += first[1] * r->V[3 * i + 1];
  }
  bw_comm_sum(bw_solid_comm(pd), 1, &sum);
  return sum;
}

static bw_status swing(bw_solid *pd, const beam *b, double *omega)
{
  body_rows r;
  double zero[2], before = 1;
  int found = 0;
  BW_TRY(body_rows_make(pd, &r));
  BW_TRY(bw_solid_load_velocity(pd, shape, b));
  const double dt = 0.8 * bw_solid_dt_max(pd);
  bw_status st = BW_OK;
  for (int64_t step = 0; found < 2 && st == BW_OK; step++) {
    st = bw_solid_step(pd, dt);
    if (step % 8 != 0) continue; /* some thousand steps a period */
    bw_solid_get_velocity(pd, r.V);
    const double now = modal(pd, b, &r);
    if (step > 0 && before * now <= 0)
      zero[found++] = dt * ((double)step + 1 - 8 * now / (now - before));
    before = now;
  }
  *omega = found == 2 ? 3.14159265358979323846 / (zero[1] - zero[0]) : NAN;
  body_rows_release(&r);
  return st;
}

static double fourth(const double xi[3], const void *data)
{
  const double d = xi[*(const int *)data];
  const double r2 = xi[0] * xi[0] + xi[1] * xi[1];
  return xi[0] * xi[0] * d * d / (r2 * sqrt(r2));
}

/* Young's modulus along the lattice over E, the bulk modulus (C_11 + C_12)/2 = 3E/4 being exact. */
static double family_young(double m)
{
  const int x = 0, y = 1;
  const double s11 = lattice_sum(m, true, true, fourth, &x);
  const double s12 = lattice_sum(m, true, true, fourth, &y);
  return 1.5 / (s11 + s12) * (s11 * s11 - s12 * s12) / s11;
}

static void claim(bw_validation *v, const char *quantity, const char *extra, double measured,
                  double reference, double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "a cantilever swings as in beam theory",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "Timoshenko beam; Euler-Bernoulli",
                                   .extra = extra});
}

/* *scaled <- frequency for height 1. */
static bw_status measure(bw_validation *v, int h, bw_pd_surface_correction surface, bool calibrated,
                         double *scaled)
{
  static const char *const correction[] = {"none", "volume", "energy", "tensor"};
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  const double m = 3;
  const bool tensor = surface == BW_PD_SURFACE_TENSOR;
  const int grip = 3, slender = tensor ? 16 : 8;
  const beam b = {grip, slender * h};
  double omega;
  char extra[160];
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E, c.horizon_ratio = m;
  c.surface_correction = surface;
  c.calibration = calibrated ? BW_PD_CALIBRATION_LATTICE : BW_PD_CALIBRATION_NONE;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){grip + slender * h, h, 1}, gripped, &grip,
                   &pd));
  BW_TRY(swing(pd, &b, &omega));
  bw_solid_destroy(&pd);
  snprintf(extra, sizeof extra,
           "\"surface_correction\": \"%s\", \"calibration\": \"%s\", \"height_over_horizon\": %g, "
           "\"length_over_height\": %d",
           correction[surface], calibrated ? "lattice" : "none", h / m, slender);
  *scaled = omega * h;
  claim(v, "omega", extra, *scaled, beam_frequency(slender),
        tensor && h >= 8 * m ? 0.01 : INFINITY);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  double coarse, fine, other;
  claim(v, "slender_beam", NULL, beam_frequency(400),
        1.8751041 * 1.8751041 * sqrt(E / 12 / RHO) / 160000, 1e-4);
  BW_TRY(measure(v, 12, BW_PD_SURFACE_NONE, true, &coarse));
  BW_TRY(measure(v, 24, BW_PD_SURFACE_NONE, true, &fine));
  claim(v, "omega_limit", "\"m\": 3", 2 * fine - coarse, sqrt(family_young(3)) * beam_frequency(8),
        0.01);
  BW_TRY(measure(v, 24, BW_PD_SURFACE_VOLUME, true, &other));
  BW_TRY(measure(v, 24, BW_PD_SURFACE_ENERGY, true, &other));
  BW_TRY(measure(v, 24, BW_PD_SURFACE_TENSOR, true, &other));
  if (!bw_validation_full(v)) return BW_OK;
  BW_TRY(measure(v, 24, BW_PD_SURFACE_VOLUME, false, &other));
  for (int k = 0; k < 4; k++)
    BW_TRY(measure(v, 48, (bw_pd_surface_correction)k, true, &other));
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.cantilever_frequency", run);
}
