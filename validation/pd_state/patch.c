/* The patch test of the correspondence law.
 *
 * Claim      Under a homogeneous deformation every particle of a disordered cloud, at faces, edges
 *            and corners too, has the stress of the closed form; a block of soil that is compressed
 *            has the stress of Drucker-Prager.
 * Reference  sigma = F S F^T/J with S = lam tr(E) 1 + 2 mu E (St. Venant-Kirchhoff); sigma = (mu (F
 *            F^T - 1) + lam ln J 1)/J (neo-Hookean); Hencky, sides held: (lam + 2 mu) ln(a)/a;
 *            oedometer to the strain e: -(K e + (2/sqrt3)(k + 3 alpha K e)).
 * Measured   clouds with disorder 0.3: 8 x 7 x 6 particles, 9 x 8 in plane strain and stress; the
 *            largest error of any component at any particle over the largest stress. Soil: all
 *            particles are moved to the strain in 1000 steps.
 * Tolerance  1e-10: the sums of a family of 250 bonds are rounded to 1e-14 of displacements, which
 *            are some ten times the strain's own. Soil: 1e-6, as the point's 1e-8 of 2000 steps,
 *            and displacements are added up in 1000 steps.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "state.h"

static const double E = 5, NU = 0.3;
static const char CLAIM[] = "stress of a homogeneous deformation at every particle";

/* Cauchy stress (9) of F by the closed forms. */
static void closed(bw_pd_material_elastic elastic, const double F[9], double lam, double mu,
                   double sigma[9])
{
  double B[9], C[9], S[9], FS[9], trace = 0;
  const double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                   F[2] * (F[3] * F[7] - F[4] * F[6]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      B[3 * i + j] = C[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) {
        B[3 * i + j] += F[3 * i + k] * F[3 * j + k];
        C[3 * i + j] += F[3 * k + i] * F[3 * k + j];
      }
    }
  for (int k = 0; k < 3; k++)
    trace += 0.5 * (C[4 * k] - 1);
  for (int q = 0; q < 9; q++)
    S[q] = mu * (C[q] - (q % 4 == 0)) + (q % 4 == 0 ? lam * trace : 0);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      FS[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        FS[3 * i + j] += F[3 * i + k] * S[3 * k + j];
    }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double *s = &sigma[3 * i + j];
      *s = (mu * (B[3 * i + j] - (i == j)) + (i == j ? lam * log(J) : 0)) / J;
      if (elastic != BW_PD_MATERIAL_SAINT_VENANT) continue;
      *s = 0;
      for (int k = 0; k < 3; k++)
        *s += FS[3 * i + k] * F[3 * j + k] / J;
    }
}

/* Largest error of r->stress against sigma (9) over all particles, over the largest |sigma|;
 * planar: components in the plane. */
static double worst(const bw_solid *pd, const body_rows *r, const double sigma[9], bool planar)
{
  static const int component[6] = {0, 4, 8, 5, 2, 1};
  double error = 0, size = 0;
  for (int q = 0; q < 9; q++)
    size = fmax(size, fabs(sigma[q]));
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    for (int k = 0; k < 6; k++) {
      if (planar && k != 0 && k != 1 && k != 5) continue;
      const double e = fabs(r->stress[6 * i + (size_t)k] - sigma[component[k]]);
      error = e >= error ? e : isnan(e) ? INFINITY : error;
    }
  bw_comm_max(bw_solid_comm(pd), 1, &error);
  return error / size;
}

static bw_status cloud(bw_validation *v, bw_pd_geometry geometry, bw_pd_material_elastic elastic,
                       double disorder, double m, const double H[9])
{
  const bool planar = geometry != BW_PD_3D;
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  double F[9], sigma[9] = {0}, lam, mu;
  char extra[120];
  o.elastic = elastic;
  c.geometry = geometry, c.ds = 0.5, c.rho = 1, c.E = E, c.nu = NU, c.horizon_ratio = m;
  c.disorder = disorder, c.law = &bw_pd_state_correspondence_law, c.law_options = &o;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){8, 7, planar ? 1 : 6}, NULL, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    for (size_t k = 0; k < 3; k++) {
      r.X[3 * i + k] = r.X0[3 * i + k];
      for (size_t j = 0; j < 3; j++)
        r.X[3 * i + k] += H[3 * k + j] * r.X0[3 * i + j];
    }
  bw_solid_set_state(pd, r.X, r.V);
  bw_solid_stress_compute(pd, NULL, r.stress);
  for (int q = 0; q < 9; q++)
    F[q] = H[q] + (q % 4 == 0);
  state_lame(BW_PD_3D, E, NU, &lam, &mu);
  closed(elastic, F, lam, mu, sigma);
  if (elastic == BW_PD_MATERIAL_HENCKY) {
    /* Stretched along x alone. */
    memset(sigma, 0, sizeof sigma);
    sigma[0] = (lam + 2 * mu) * log(F[0]) / F[0];
    sigma[4] = sigma[8] = lam * log(F[0]) / F[0];
  }
  static const char *const name[] = {"linear", "svk", "neo_hookean", "hencky"};
  snprintf(extra, sizeof extra, "\"elastic\": \"%s\", \"planar\": %s, \"disorder\": %g, \"m\": %g",
           name[elastic], planar ? "true" : "false", disorder, m);
  state_claim(v, CLAIM, "largest_error", worst(pd, &r, sigma, planar), 0, 1e-10, BW_ANALYTIC,
              "closed form", extra);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static int held(const int32_t site[3], const void *data)
{
  (void)site, (void)data;
  return BW_PD_PRESCRIBED;
}

/* Soil of ULPH's Table 4 with the cone of plane strain without dilation, compressed along x. */
static bw_status soil(bw_validation *v)
{
  enum { STEPS = 1000 };
  const double young = 30e6, nu = 0.25, e = 0.01, shrink = -expm1(-e);
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  double lam, mu;
  o.yield[0] =
      bw_pd_material_drucker_prager(BW_PD_MATERIAL_PLANE_ISOCHORIC, 5e3, 13 * STATE_PI / 180, 0);
  c.ds = 0.1, c.rho = 2500, c.E = young, c.nu = nu, c.horizon_ratio = 2, c.disorder = 0.3;
  c.law = &bw_pd_state_correspondence_law, c.law_options = &o;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){6, 5, 5}, held, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  const double dt = 0.5 * bw_solid_dt_max(pd);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    r.V[3 * i] = -shrink * r.X0[3 * i] / (STEPS * dt);
  bw_solid_set_prescribed(pd, r.V);
  for (int step = 0; step < STEPS; step++)
    BW_TRY(bw_solid_step(pd, dt));
  bw_solid_stress_compute(pd, NULL, r.stress);
  state_lame(BW_PD_3D, young, nu, &lam, &mu);
  const double K = lam + 2 * mu / 3, k = o.yield[0].k, pressure = k + 3 * o.yield[0].alpha * K * e;
  double sigma[9] = {0};
  sigma[0] = -(K * e + 2 / sqrt(3) * pressure);
  sigma[4] = sigma[8] = -(K * e - pressure / sqrt(3));
  state_claim(v, CLAIM, "oedometer_largest_error", worst(pd, &r, sigma, false), 0, 1e-6,
              BW_ANALYTIC, "closed form", NULL);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const double space[9] = {0.2, -0.1, 0.05, 0.15, -0.1, 0.1, -0.05, 0.12, 0.25};
  static const double plane[9] = {0.2, -0.1, 0, 0.15, -0.1}, along[9] = {0.5};
  static const double m[] = {2, 3};
  for (int q = 0; q < 2; q++) {
    BW_TRY(cloud(v, BW_PD_3D, BW_PD_MATERIAL_SAINT_VENANT, 0.3, m[q], space));
    BW_TRY(cloud(v, BW_PD_3D, BW_PD_MATERIAL_NEO_HOOKEAN, 0.3, m[q], space));
    BW_TRY(cloud(v, BW_PD_3D, BW_PD_MATERIAL_HENCKY, 0.3, m[q], along));
    BW_TRY(cloud(v, BW_PD_PLANE_STRAIN, BW_PD_MATERIAL_SAINT_VENANT, 0.3, m[q], plane));
    BW_TRY(cloud(v, BW_PD_PLANE_STRAIN, BW_PD_MATERIAL_NEO_HOOKEAN, 0.3, m[q], plane));
  }
  BW_TRY(cloud(v, BW_PD_3D, BW_PD_MATERIAL_NEO_HOOKEAN, 0, 1.5, space));
  return soil(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.patch", run);
}
