/* Stress at particles under a uniform load.
 *
 * Claim      A bar drawn by tractions t at its ends, at rest, has sigma_xx = t in the bulk, in
 *            2D and 3D; its sides are kept from moving by periodicity, so sigma_yy = t nu/(1 -
 *            nu) (plane stress: nu t), which is t/3 for the Poisson ratios that bonds fix. With
 *            free sides the mean of sigma_xx over a cross-section is t for every surface
 *            correction.
 * Reference  equilibrium: the force through every cross-section is t times the area; Hooke.
 * Measured   mean of the collapsed stress tensor over the middle of the bar, at rest by dynamic
 *            relaxation. Beside it, without a claim, the middle of the free bar: its skin, two
 *            horizons thick, is softer or stiffer than the bulk, which carries the difference.
 * Tolerance  1 % in the bulk, the goal of the module; sigma_yy that of the lattice's anisotropy
 *            in addition: the sum over the family of xi_x^2 xi_y^2/|xi|^3 over that of
 *            xi_x^4/|xi|^3, written independently (lattice_sum.h), known before the run. The
 *            section's mean: the residual 1e-5 of the relaxation times 10, as errors of 24
 *            columns may add up.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"
#include "lattice_sum.h"

enum { LONG = 48, WIDE_2D = 24, WIDE_3D = 12 };
static const double E = 5, TRACTION = 5e-5, FAR = 1e9;
static const char *const names[] = {"3d", "plane_stress", "plane_strain"};
static const char *const corrections[] = {"none", "volume", "energy"};

/* The bar at rest with its stress in r. */
static bw_status pull(const bw_comm *comm, bw_pd_geometry geometry,
                      bw_pd_surface_correction surface, bool held, bw_solid **pd, body_rows *r)
{
  const bool solid = geometry == BW_PD_3D;
  const int w = solid ? WIDE_3D : WIDE_2D, size[3] = {LONG, w, solid ? w : 1};
  bw_solid_config c = bw_solid_config_default();
  bw_solid_static_config config = bw_solid_static_config_default();
  bw_solid_static_report report;
  c.geometry = geometry, c.surface_correction = surface;
  c.ds = c.rho = 1, c.E = E;
  if (held) c.period[1] = w, c.period[2] = solid ? w : 0;
  BW_TRY(body_make(comm, &c, size, NULL, NULL, pd));
  BW_TRY(body_rows_make(*pd, r));
  const double layer = 3;
  for (int end = 0; end < 2; end++)
    BW_TRY(bw_solid_load_traction(*pd, (double[3]){end == 0 ? 0 : LONG - layer, -FAR, -FAR},
                                  (double[3]){end == 0 ? layer : LONG, FAR, FAR}, w * size[2],
                                  (double[3]){end == 0 ? -TRACTION : TRACTION, 0, 0}, r->F));
  bw_solid_set_force(*pd, r->F);
  config.tolerance = 1e-5;
  BW_TRY(bw_solid_static_relax(*pd, &config, &report));
  bw_solid_stress_compute(*pd, NULL, r->stress);
  return BW_OK;
}

/* xi_x^2 xi_d^2/|xi|^3 */
static double fourth(const double xi[3], const void *data)
{
  const double d = xi[*(const int *)data];
  const double r2 = xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2];
  return xi[0] * xi[0] * d * d / (r2 * sqrt(r2));
}

static bw_status bulk(bw_validation *v, bw_pd_geometry geometry, bw_pd_surface_correction surface)
{
  static const char *const component[] = {"xx", "yy", "zz", "yz", "xz", "xy"};
  static const double want[3][6] = {{1, 1. / 3, 1. / 3}, {1, 1. / 3}, {1, 1. / 3, 1. / 3}};
  const int x = 0, y = 1;
  const bool planar = geometry != BW_PD_3D;
  const double ratio =
      lattice_sum(3, planar, planar, fourth, &y) / lattice_sum(3, planar, planar, fourth, &x);
  bw_solid *pd = NULL;
  body_rows r;
  char quantity[80], extra[80];
  BW_TRY(pull(bw_validation_comm(v), geometry, surface, true, &pd, &r));
  snprintf(extra, sizeof extra, "\"surface_correction\": \"%s\"", corrections[surface]);
  for (size_t k = 0; k < 6; k++) {
    snprintf(quantity, sizeof quantity, "sigma_%s_%s", component[k], names[geometry]);
    const double got = body_mean(pd, r.X0, (double[3]){LONG / 2 - 2, -FAR, -FAR},
                                 (double[3]){LONG / 2 + 2, FAR, FAR}, r.stress + k, 6);
    bw_validation_row(v, &(bw_claim){.claim = "stress of the bulk is the traction and Hooke's",
                                     .quantity = quantity,
                                     .measured = got / TRACTION,
                                     .reference = want[geometry][k],
                                     .tolerance = 0.01 + (k > 0 ? fabs(3 * ratio - 1) : 0),
                                     .kind = BW_ANALYTIC,
                                     .source = "equilibrium; Hooke, nu fixed by bonds",
                                     .extra = extra});
  }
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status section(bw_validation *v, bw_pd_geometry geometry,
                         bw_pd_surface_correction surface)
{
  const double w = geometry == BW_PD_3D ? WIDE_3D : WIDE_2D;
  bw_solid *pd = NULL;
  body_rows r;
  char quantity[80], extra[80];
  BW_TRY(pull(bw_validation_comm(v), geometry, surface, false, &pd, &r));
  snprintf(extra, sizeof extra, "\"surface_correction\": \"%s\"", corrections[surface]);
  for (int middle = 0; middle < 2; middle++) {
    const double skin = middle == 1 ? 0.4 * w : -FAR;
    const double z = middle == 1 && geometry == BW_PD_3D ? skin : -FAR;
    const double got = body_mean(pd, r.X0, (double[3]){LONG / 2 - 2, skin, z},
                                 (double[3]){LONG / 2 + 2, w - skin, w - z}, r.stress, 6);
    snprintf(quantity, sizeof quantity, "free_bar_%s_%s", middle ? "middle" : "section",
             names[geometry]);
    bw_validation_row(v,
                      &(bw_claim){.claim = "stress of a cross-section is the force over its area",
                                  .quantity = quantity,
                                  .measured = got / TRACTION,
                                  .reference = 1,
                                  .tolerance = middle ? INFINITY : 1e-4,
                                  .kind = BW_ANALYTIC,
                                  .source = "equilibrium of the bar",
                                  .extra = extra});
  }
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int g = 0; g < 3; g++)
    for (int s = 0; s < 3; s++) {
      BW_TRY(bulk(v, (bw_pd_geometry)g, (bw_pd_surface_correction)s));
      BW_TRY(section(v, (bw_pd_geometry)g, (bw_pd_surface_correction)s));
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.uniform_stress", run);
}
