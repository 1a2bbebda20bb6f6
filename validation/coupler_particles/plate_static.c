/* Claim      A plate that is the floor of a tank bends under the water as plane elasticity says.
 * Reference  Finite elements with nine nodes by another program, finite strain (shared/reference/
 *            ulph/fsi_static.csv): 1 x 0.05 m, nu = 0.34, both ends clamped, -6.610e-5 m under 2 m
 *            of water and -4.46e-6 m by its own weight at E = 67.5 GPa. Both are linear in the load
 *            over E.
 * Measured   Water 0.4 (1) m deep, 5 (10) layers, fluid as fine as the plate. E is a hundredth of
 *            it, so that the solid has fewer sub-steps; the plate bends by 0.04 (0.08) of its
 *            thickness then, and stretching it stiffens it by less than 0.2 %. Mean of the
 *            middle two columns over the last half of 0.2 s; sound in the water damps it.
 * Tolerance  5 % at 5 layers, 2 % at 10: what the layers of the solid give (pd_state.cantilever).
 * BUILD modules=shape,solid
 * TEST  ranks=1 */
#include "wet.h"

static bw_status run(bw_validation *v)
{
  const int layers = bw_validation_full(v) ? 10 : 5, clamp = 4;
  const double h = 0.05, dx = h / layers, depth = bw_validation_full(v) ? 1 : 0.4, soft = 100;
  wet_scene s = wet_water(dx, sqrt(wet_g * depth));
  wet w;
  double mean = 0, u[2];
  const double t = 4 * dx;
  wet_rubber(&s, dx, 2700, 67.5e9 / soft, 0.34);
  s.surface = depth;
  s.n_fluid = 1, s.in_fluid[0] = wet_box(0, 0, 1, depth);
  /* Two walls that stand on what clamps the plate. */
  s.n_wall = 2;
  s.in_wall[0] = wet_box(-t, 0, 0, 1.2 * depth), s.in_wall[1] = wet_box(1, 0, 1 + t, 1.2 * depth);
  s.n_solid = 2;
  s.in_solid[0] = wet_box(-clamp * dx, -h, 1 + clamp * dx, 0);
  s.in_solid[0].particle_kind = BW_PD_PRESCRIBED;
  s.in_solid[1] = wet_box(0, -h, 1, 0);
  bw_status st = wet_make(bw_validation_comm(v), &s, &w);
  for (int q = 1; q <= 40 && st == BW_OK; q++) {
    st = wet_run(&w, 0.005 * q);
    const double lower[2] = {0.5 - dx, -h}, upper[2] = {0.5 + dx, 0};
    if (st == BW_OK) wet_moved(&w, lower, upper, u);
    if (q > 20) mean += u[1] / 20;
  }
  if (st == BW_OK) {
    bw_validation_row(v, &(bw_claim){.claim = "a plate bends under water",
                                     .quantity = "deflection_over_reference",
                                     .measured = mean / soft / (-6.610e-5 * depth / 2 - 4.46e-6),
                                     .reference = 1,
                                     .tolerance = layers == 5 ? 0.05 : 0.02,
                                     .kind = BW_INDEPENDENT_CODE,
                                     .source = "finite elements"});
    const bw_coupler_particles_report r = bw_coupler_particles_measure(w.coupler);
    bw_validation_row(v, &(bw_claim){.claim = "the force on the plate is the water's weight",
                                     .quantity = "force_now",
                                     .measured = r.force[1] / (-1000 * wet_g * depth),
                                     .reference = 1,
                                     .tolerance = INFINITY,
                                     .kind = BW_ANALYTIC,
                                     .source = "rho g H L"});
    wet_book(v, &w, 1e-3);
  }
  wet_free(&w);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler_particles.plate_static", run);
}
