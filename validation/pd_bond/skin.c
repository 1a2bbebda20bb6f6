/* Bodies that are skin nearly throughout: their elasticity, their bending, what it takes to cut
 * them, for every surface correction.
 *
 * Claim      With the correction `tensor` a plate as thin as 2.7 horizons has the moduli and the
 *            Poisson ratios of elasticity, and a thin cantilever bends as in beam theory but for
 *            terms of second order in delta/h and of first order in delta/L.
 * Reference  isotropic elasticity, nu = 1/4; Timoshenko's beam in plane strain under its own
 *            uniform load, k = 5/6.
 * Measured   at rest (linear solve), m = 3, calibration by the lattice. Plate: 36 x 36 x 8
 *            particles (full: 4, 6 and 12 too) with tractions on its narrow sides, strains of the
 *            middle third: pulled one way, both ways, sheared. Cantilever: 8 and 20 (full: 40)
 *            particles high, L = 16 h, tip. Cut: a strip strained to s0 in all directions, then
 *            cut across; energy over area.
 * Tolerance  plate: the residual of the conditions at flat faces after the factors' 60 sweeps is
 *            1 % (pd_bond_tensor.c; an independent program for infinite plates finds E -0.1 %, nu
 *            -0.9 %), and as much again for the narrow sides a horizon away from the middle: 2 %.
 *            Cantilever: the outermost bonds lie (1/2 to 1) ds under the faces and bonds feel the
 *            mean strain of their ends, so the second moment of the section lacks about
 *            (delta/h)^2/2 (the same program: 0.35 to 0.42); the clamp acts within a horizon, so
 *            that its place is known to delta/2 and the tip to 4 (delta/2)/L. What a correction
 *            by one number per particle does is reported beside, without a claim.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 timeout=3600 */
#include "body.h"

#include <string.h>

static const double E = 5, NU = 0.25, STRAIN = 1e-6, FAR = 1e9, M = 3;
enum { CORRECTIONS = BW_PD_SURFACE_TENSOR + 1, SIDE = 36 };
static const char *const correction[] = {"none", "volume", "energy", "tensor"};

static void claim(bw_validation *v, const char *quantity, int surface, int layers, double measured,
                  double reference, double tolerance, const char *source)
{
  char extra[120];
  snprintf(extra, sizeof extra, "\"surface_correction\": \"%s\", \"layers\": %d",
           correction[surface], layers);
  bw_validation_row(v,
                    &(bw_claim){"bodies that are all skin are elastic", quantity, measured,
                                reference, surface == BW_PD_SURFACE_TENSOR ? tolerance : INFINITY,
                                BW_ANALYTIC, source, extra});
}

static bw_solid_config material(bw_pd_geometry geometry, int surface)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = geometry;
  c.ds = c.rho = 1;
  c.E = E;
  c.horizon_ratio = M;
  c.surface_correction = (bw_pd_surface_correction)surface;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  return c;
}

static bw_status rest(bw_solid *pd, body_rows *r)
{
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  config.tolerance = 1e-5;
  memset(r->X, 0, 3 * bw_solid_count(pd) * sizeof *r->X);
  bw_solid_set_force(pd, r->F);
  return bw_solid_static_linear(pd, &config, r->X, &report);
}

/* Mean of displacement k over the middle third's section of one layer at `at` along direction d. */
static double section(const bw_solid *pd, const body_rows *r, size_t d, double at, size_t k)
{
  double lower[3] = {SIDE / 3, SIDE / 3, -FAR}, upper[3] = {2 * SIDE / 3, 2 * SIDE / 3, FAR};
  lower[d] = at, upper[d] = at + 1;
  return body_mean(pd, r->X0, lower, upper, r->X + k, 3);
}

/* Strain du_k/dx_d of the middle; across the plate from face to face. */
static double slope(const bw_solid *pd, const body_rows *r, size_t d, int layers, size_t k)
{
  const double a = d == 2 ? 0 : SIDE / 3, b = d == 2 ? layers - 1 : 2 * SIDE / 3 - 1;
  return (section(pd, r, d, b, k) - section(pd, r, d, a, k)) / (b - a);
}

/* Tractions E STRAIN times stress[d] on the outermost layers of the narrow sides normal to d. A
 * shear is balanced by the sides it meets, whose layers are SIDE - 1 apart: no stress beyond. */
static bw_status pull(bw_solid *pd, body_rows *r, int layers, const double stress[2][2])
{
  memset(r->F, 0, 3 * bw_solid_count(pd) * sizeof *r->F);
  for (int d = 0; d < 2; d++)
    for (int end = -1; end <= 1; end += 2) {
      double lower[3] = {-FAR, -FAR, -FAR}, upper[3] = {FAR, FAR, FAR}, t[3] = {0};
      if (end < 0) upper[d] = 1;
      if (end > 0) lower[d] = SIDE - 1;
      for (int k = 0; k < 2; k++)
        t[k] = end * E * STRAIN * stress[d][k] * (k == d ? SIDE : SIDE - 1);
      BW_TRY(bw_solid_load_traction(pd, lower, upper, layers, t, r->F));
    }
  return rest(pd, r);
}

static bw_status plate(bw_validation *v, int surface, int layers)
{
  static const double one[2][2] = {{1, 0}, {0, 0}}, two[2][2] = {{1, 0}, {0, 1}};
  static const double shear[2][2] = {{0, 1}, {1, 0}};
  const char source[] = "isotropic elasticity, nu = 1/4";
  const double tolerance = layers == 8 ? 0.02 : INFINITY;
  const bw_solid_config c = material(BW_PD_3D, surface);
  bw_solid *pd = NULL;
  body_rows r;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){SIDE, SIDE, layers}, NULL, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  BW_TRY(pull(pd, &r, layers, one));
  const double along = slope(pd, &r, 0, layers, 0);
  claim(v, "plate_young", surface, layers, STRAIN / along, 1, tolerance, source);
  claim(v, "plate_nu", surface, layers, -slope(pd, &r, 1, layers, 1) / along, NU, tolerance,
        source);
  claim(v, "plate_nu_thickness", surface, layers, -slope(pd, &r, 2, layers, 2) / along, NU,
        tolerance, source);
  BW_TRY(pull(pd, &r, layers, two));
  claim(v, "plate_biaxial", surface, layers, STRAIN / slope(pd, &r, 0, layers, 0), 1 / (1 - NU),
        tolerance, source);
  BW_TRY(pull(pd, &r, layers, shear));
  claim(v, "plate_shear", surface, layers,
        STRAIN / (slope(pd, &r, 0, layers, 1) + slope(pd, &r, 1, layers, 0)), 0.5 / (1 + NU),
        tolerance, source);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static int gripped(const int32_t site[3], const void *data)
{
  (void)data;
  return site[0] < M ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

static bw_status cantilever(bw_validation *v, int surface, int h)
{
  const bw_solid_config c = material(BW_PD_PLANE_STRAIN, surface);
  const int L = 16 * h;
  const double q = 1e-9, at = L - 0.5; /* force density; middle of the last column */
  const double bend = E / (1 - NU * NU) * h * h / 12.0, slide = 5.0 / 6 * E / (2 * (1 + NU));
  const double theory = q * at * at * (6.0 * L * L - 4 * L * at + at * at) / (24 * bend) +
                        q * (L * at - at * at / 2) / slide;
  bw_solid *pd = NULL;
  body_rows r;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){(int)M + L, h, 1}, gripped, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    r.F[3 * i + 1] = q;
  BW_TRY(rest(pd, &r));
  const double tip = body_mean(pd, r.X0, (double[3]){M + L - 1, -FAR, -FAR},
                               (double[3]){FAR, FAR, FAR}, r.X + 1, 3);
  claim(v, "cantilever_tip", surface, h, tip / theory, 1, 0.5 * M * M / (h * h) + 2 * M / L,
        "Timoshenko beam");
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

/* Energy of the bonds across the middle of a strip, all at s0, over G0 and the height. */
static bw_status cut(bw_validation *v, int surface, int h)
{
  const double s0 = 1e-3;
  bw_solid_config c = material(BW_PD_PLANE_STRESS, surface);
  bw_solid *pd = NULL;
  body_rows r;
  c.G0 = 1;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){24, h, 1}, NULL, NULL, &pd));
  BW_TRY(bw_solid_set_G0(pd, s0 * s0 / pow(bw_solid_critical_stretch(pd), 2)));
  BW_TRY(body_rows_make(pd, &r));
  for (size_t i = 0; i < 3 * bw_solid_count(pd); i++)
    r.X[i] = r.X0[i] * (1 + s0);
  bw_solid_set_state(pd, r.X, r.V);
  BW_TRY(bw_solid_precrack(pd, (double[3]){12, 0, 0}, (double[3]){12, h, 0}, NULL));
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  claim(v, "cut_energy", surface, h, e.fracture / (bw_solid_settings(pd)->G0 * h), 1, INFINITY,
        "G0");
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const int layers[] = {8, 4, 6, 12}, heights[] = {8, 20, 40}, strips[] = {4, 8, 24};
  const bool full = bw_validation_full(v);
  for (int s = 0; s < CORRECTIONS; s++) {
    for (int q = 0; q < (full ? 4 : 1); q++)
      BW_TRY(plate(v, s, layers[q]));
    for (int q = 0; q < (full ? 3 : 2); q++)
      BW_TRY(cantilever(v, s, heights[q]));
    for (int q = 0; q < 3; q++)
      BW_TRY(cut(v, s, strips[q]));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.skin", run);
}
