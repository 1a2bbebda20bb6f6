/* A cantilever that bends far, in correspondence.
 *
 * Claim      Under a dead load at its end a strip of L/H = 20 moves as in finite-strain elasticity.
 * Reference  finite elements with nine nodes and finite strains (another program, numpy), St.
 *            Venant-Kirchhoff, plane strain, nu = 0.3: v/L = 0.162111, 0.301770, 0.493903 and u/L =
 *            -0.015914, -0.056450, -0.160875 at F L^2/E'I = 0.5, 1, 2. Beyond, the elastica (v/L =
 *            0.713792 at 5), which neither stretches nor shears: reported.
 * Measured   relaxation of 10 layers, weights of 1.5 spacings; L is where the load acts, half a
 *            cell before the end.
 * Tolerance  1 % of v; u, which is v^2 in size, 2 %.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "beam.h"

static bw_status deflect(bw_validation *v, beam *b, double load, double want_v, double want_u,
                         double tolerance)
{
  const double E = 5, nu = 0.3, L = b->length - 0.5, H = b->height;
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  char extra[80];
  how.tolerance = 1e-5;
  beam_load(b, load * E / (1 - nu * nu) * H * H * H / 12 / (L * L), false);
  BW_TRY(bw_solid_static_relax(b->pd, &how, &report));
  bw_solid_get_position(b->pd, b->r.X);
  for (size_t k = 0; k < 3 * bw_solid_count(b->pd); k++)
    b->r.X[k] -= b->r.X0[k];
  snprintf(extra, sizeof extra, "\"load\": %g, \"layers\": %d, \"evaluations\": %lld", load,
           b->height, (long long)report.iterations);
  const char *source = isinf(tolerance) ? "elastica" : "finite elements, finite strain";
  state_claim(v, "large deflections are those of elasticity", "v_over_L",
              beam_column(b, b->length - 1, b->r.X, 1) / L, want_v, tolerance, BW_INDEPENDENT_CODE,
              source, extra);
  state_claim(v, "large deflections are those of elasticity", "u_over_L",
              beam_column(b, b->length - 1, b->r.X, 0) / L, want_u, 2 * tolerance,
              BW_INDEPENDENT_CODE, source, extra);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  o.elastic = BW_PD_MATERIAL_SAINT_VENANT;
  const bw_solid_config c = beam_material(BW_PD_PLANE_STRAIN, 5, 0.3, 1.5, &o);
  const int layers = 10;
  beam b = {.length = 20 * layers, .height = layers};
  BW_TRY(beam_make(bw_validation_comm(v), &c, &b));
  if (bw_validation_full(v)) {
    BW_TRY(deflect(v, &b, 0.5, 0.162111, -0.015914, 0.01));
    BW_TRY(deflect(v, &b, 1, 0.301770, -0.056450, 0.01));
  }
  BW_TRY(deflect(v, &b, 2, 0.493903, -0.160875, 0.01));
  if (bw_validation_full(v)) BW_TRY(deflect(v, &b, 5, 0.713792, -0.387628, INFINITY));
  beam_release(&b);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.large_deflection", run);
}
