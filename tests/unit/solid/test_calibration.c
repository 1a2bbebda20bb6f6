/* Constants from the lattice's sums: exact bulk modulus and fracture energy.
 * TEST ranks=1,2,3 */
#include "pd_test.h"

static double SCALE;

static void dilate(const double X0[3], double u[3])
{
  for (int k = 0; k < 3; k++)
    u[k] = SCALE * X0[k];
}

static void dilate_plane(const double X0[3], double u[3])
{
  u[0] = SCALE * X0[0], u[1] = SCALE * X0[1];
}

/* Mixed difference of the energies of boxes of a and a + 1 per edge: one bulk particle's. */
static double bulk(const bw_solid_config *c)
{
  const int d = c->geometry == BW_PD_3D ? 3 : 2, a = 4 * (int)(c->horizon_ratio + 0.5) + 1;
  double sum = 0;
  for (int corner = 0; corner < 1 << d; corner++) {
    int size[3] = {a, a, d == 3 ? a : 1}, sign = d == 2 ? 1 : -1;
    for (int k = 0; k < d; k++)
      if (corner >> k & 1) size[k]++, sign = -sign;
    pd_body box = pd_box(size[0], size[1], size[2]);
    bw_solid *pd = pd_make(bw_check_world(), c, &box);
    pd_set(pd, d == 3 ? dilate : dilate_plane, NULL);
    sum += sign * ledger_of(pd).elastic;
    bw_solid_destroy(&pd);
    pd_body_release(&box);
  }
  return sum;
}

/* Energy density of a dilation e: 9/2 K e^2 = 3 E e^2 (nu = 1/4), E e^2/(1 - nu) = 3/2 E e^2 (1/3),
 * 2 (lambda + mu) e^2 = 8/5 E e^2. In every surface correction, with all kinds of fraction. */
START_TEST(bulk_modulus_is_exact)
{
  if (BW_REAL_EPSILON > 1e-10) return; /* a difference of large numbers */
  const double want[] = {3, 1.5, 1.6};
  SCALE = 1e-2;
  for (int g = 0; g < 3; g++)
    for (int surface = 0; surface < 3; surface++) {
      bw_solid_config c = pd_soft((bw_pd_geometry)g);
      c.horizon_ratio = g == 0 ? 2 : 3;
      c.calibration = BW_PD_CALIBRATION_LATTICE;
      c.surface_correction = (bw_pd_surface_correction)surface;
      const double dv = g == 0 ? 0.125 : 0.25;
      bw_check_near(bulk(&c) / (3 * want[g] * SCALE * SCALE * dv), 1, 1e-7);
      c.calibration = BW_PD_CALIBRATION_NONE;
      if (surface != BW_PD_SURFACE_ENERGY) /* which makes it exact by itself */
        ck_assert_double_gt(fabs(bulk(&c) / (3 * want[g] * SCALE * SCALE * dv) - 1), 0.01);
    }
}
END_TEST

/* All bonds of a column one cell wide, cut by a plane, at s0: G0 of its cross-section. The energy
 * comes from micromodulus and stretch seen from outside, bond by bond. */
START_TEST(fracture_energy_is_exact)
{
  for (int g = 0; g < 3; g++) {
    bw_solid_config c = pd_soft((bw_pd_geometry)g);
    c.G0 = 7;
    c.calibration = BW_PD_CALIBRATION_LATTICE;
    pd_body one = pd_box(1, 1, 1);
    bw_solid *pd = pd_make(bw_check_world(), &c, &one);
    const double c0 = bw_solid_micromodulus(pd), dv = bw_solid_volume(pd);
    for (int turn = 0; turn < 2; turn++) {
      const double s0 = bw_solid_critical_stretch(pd);
      double energy = 0; /* of the bonds from one column's particles, stacked below the plane */
      for (int q = 0; q < bw_solid_max_family(pd); q++) {
        const double *xi = bw_solid_stencil_offset(pd, q);
        const double r = sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
        for (int below = 0; below < 4; below++) /* particles 0, 1, .. spacings under the top one */
          if (xi[1] > (below + 0.5) * 0.5)
            energy += 0.5 * c0 * s0 * s0 * r * bw_solid_stencil_fraction(pd, q) * dv * dv;
      }
      bw_check_near(energy / (dv / 0.5), turn == 0 ? 7 : 21, 1e-9); /* area dv/ds */
      bw_check_ok(bw_solid_set_G0(pd, 21));
    }
    bw_solid_destroy(&pd);
    pd_body_release(&one);
  }
}
END_TEST

START_TEST(unknown_calibration_is_refused)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body one = pd_box(1, 1, 1);
  bw_solid *pd = NULL;
  c.calibration = (bw_pd_calibration)7;
  bw_check_status(bw_solid_create_same(bw_check_world(), &c, 1, one.site, NULL, &pd), BW_EINPUT);
  pd_body_release(&one);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(bulk_modulus_is_exact),
                                      BW_TEST(fracture_energy_is_exact),
                                      BW_TEST(unknown_calibration_is_refused)};
BW_CHECK_MAIN("pd_bond.calibration", tests)
