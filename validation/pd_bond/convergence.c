/* Convergence of a plate in tension and of a cantilever to classical elasticity.
 *
 * Claim      With m fixed, elongation and deflection go with the horizon to those of a body
 *            that has the family's own modulus (delta-convergence, order 1: a skin one horizon
 *            thick is too soft), and that modulus to the one asked for with m
 *            (pd_bond.stiffness); with the horizon fixed they settle as the lattice is refined
 *            (m-convergence).
 * Reference  plate: t/E; cantilever with an end load: P a^3/(3EI) + P a/(k G A), k = 5/6
 *            (Timoshenko), a from the clamp to the resultant of the load; plane stress, nu =
 *            1/3. For the orders E is that of the family at m = 3, from sums written
 *            independently (lattice_sum.h).
 * Measured   linear small-strain solve (conjugate gradients), no surface correction, lattice
 *            calibration: the bulk modulus is exact. Both bodies are 6 times as long as high;
 *            the grip is prescribed, one reach thick.
 * Tolerance  orders: 1 with 0.25 either way: the error is a (delta/h) (1 + b delta/h) with b
 *            delta/h at most 0.19 between the two finest (b = 1: the skin's part of the
 *            height), and the clamp adds its own length of order delta. m-convergence: the
 *            steps between lattices shrink.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"
#include "lattice_sum.h"

static const double E = 5, FAR = 1e9;
enum { SLENDER = 6 };

typedef struct {
  double elongation, deflection; /* over those of elasticity */
} result;

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
  const double factor = 1.5 / (s11 + s12);
  return factor * (s11 * s11 - s12 * s12) / s11;
}

static int gripped(const int32_t site[3], const void *data)
{
  return site[0] < *(const int *)data ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

/* Mean displacement of the section's particles nearest to x. */
static double moved(const bw_solid *pd, const body_rows *r, double x, size_t k)
{
  return body_mean(pd, r->X0, (double[3]){x - 0.5, -FAR, -FAR}, (double[3]){x + 0.5, FAR, FAR},
                   r->X + k, 3);
}

static bw_status solve(bw_solid *pd, body_rows *r, double grip, double length, double h,
                       double layer, size_t direction)
{
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  double traction[3] = {0};
  traction[direction] = 1e-6;
  for (size_t q = 0; q < 3 * bw_solid_count(pd); q++)
    r->F[q] = r->X[q] = 0;
  BW_TRY(bw_solid_load_traction(pd, (double[3]){grip + length - layer, -FAR, -FAR},
                                (double[3]){FAR, FAR, FAR}, h, traction, r->F));
  bw_solid_set_force(pd, r->F);
  config.tolerance = 1e-6;
  return bw_solid_static_linear(pd, &config, r->X, &report);
}

/* h lattice steps high, horizon m steps. */
static bw_status measure(const bw_comm *comm, int h, double m, result *out)
{
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  const int grip = (int)(m + 0.5), length = SLENDER * h, layer = (int)m;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = c.rho = 1, c.E = E, c.horizon_ratio = m;
  c.surface_correction = BW_PD_SURFACE_NONE, c.calibration = BW_PD_CALIBRATION_LATTICE;
  BW_TRY(body_make(comm, &c, (int[3]){grip + length, h, 1}, gripped, &grip, &pd));
  BW_TRY(body_rows_make(pd, &r));
  const double p = 1e-6, a = length - 0.5 * layer;
  BW_TRY(solve(pd, &r, grip, length, h, layer, 0));
  const double from = grip + length / 3 + 0.5, to = grip + 2 * length / 3 + 0.5;
  out->elongation = (moved(pd, &r, to, 0) - moved(pd, &r, from, 0)) / ((to - from) * p / E);
  BW_TRY(solve(pd, &r, grip, length, h, layer, 1));
  /* between the two sections beside the resultant */
  const double tip = 0.5 * (moved(pd, &r, grip + a - 0.5, 1) + moved(pd, &r, grip + a + 0.5, 1));
  const double bending = 4 * p * h * a * a * a / (E * h * h * h);
  const double shear = p * h * a / (5.0 / 6 * E / (2 * (1 + 1.0 / 3)) * h);
  out->deflection = tip / (bending + shear);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static void claim(bw_validation *v, const char *quantity, const char *extra, double measured,
                  double reference, double tolerance, bw_claim_kind kind)
{
  bw_validation_row(v, &(bw_claim){.claim = "a plate and a cantilever converge to elasticity",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = kind,
                                   .source = "t/E; Timoshenko beam",
                                   .extra = extra});
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  const int n = full ? 4 : 3;
  result r[4];
  char extra[80];
  for (int q = 0; q < n; q++) {
    BW_TRY(measure(bw_validation_comm(v), 8 << q, 3, &r[q]));
    snprintf(extra, sizeof extra, "\"m\": 3, \"height_over_horizon\": %g", (8 << q) / 3.0);
    claim(v, "plate_elongation", extra, r[q].elongation, 1, INFINITY, BW_ANALYTIC);
    claim(v, "cantilever_deflection", extra, r[q].deflection, 1, INFINITY, BW_ANALYTIC);
  }
  const double limit = 1 / family_young(3);
  const result *a = &r[n - 2], *b = &r[n - 1];
  claim(v, "order_plate", NULL,
        bw_validation_order(2, fabs(a->elongation - limit), 1, fabs(b->elongation - limit)), 1,
        0.25, BW_ORDER);
  claim(v, "order_cantilever", NULL,
        bw_validation_order(2, fabs(a->deflection - limit), 1, fabs(b->deflection - limit)), 1,
        0.25, BW_ORDER);
  claim(v, "family_modulus", "\"m\": 3", 1 / limit, 1, INFINITY, BW_ANALYTIC);
  for (int q = 0; q < 3; q++) { /* h = 5 delta */
    const int m = 2 << q;
    BW_TRY(measure(bw_validation_comm(v), 5 * m, m, &r[q]));
    snprintf(extra, sizeof extra, "\"m\": %d, \"height_over_horizon\": 5", m);
    claim(v, "plate_elongation", extra, r[q].elongation, 1, INFINITY, BW_ANALYTIC);
    claim(v, "cantilever_deflection", extra, r[q].deflection, 1, INFINITY, BW_ANALYTIC);
  }
  claim(v, "plate_settles", NULL,
        fabs(r[2].elongation - r[1].elongation) < fabs(r[1].elongation - r[0].elongation), 1, 0,
        BW_ORDER);
  claim(v, "cantilever_settles", NULL,
        fabs(r[2].deflection - r[1].deflection) < fabs(r[1].deflection - r[0].deflection), 1, 0,
        BW_ORDER);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.convergence", run);
}
