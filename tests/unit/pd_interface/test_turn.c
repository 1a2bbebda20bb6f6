/* The spin of a surface: that of a body that turns and moves, whatever else it is.
 * TEST ranks=1,2,3,4 */
#include "body.h"

static void check_spin(bool planar, const bw_shape *shape, const double spin[3], double scale)
{
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_pd_bond_config c = body_config(planar);
  body b = body_create(1, shape, &c, &ic);
  const size_t n = bw_pd_bond_count(b.pd);
  double *X = NULL, *V = NULL, *found = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&found, 3 * n));
  bw_pd_bond_get_reference(b.pd, X);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      const size_t e = (d + 1) % 3, f = (d + 2) % 3;
      V[3 * i + d] = 0.3 + spin[e] * X[3 * i + f] - spin[f] * X[3 * i + e];
    }
  bw_pd_bond_set_state(b.pd, X, V);
  bw_check_ok(bw_pd_interface_update(b.pi));
  bw_pd_interface_turn(b.pi, found);
  for (size_t q = 0; q < 3 * bw_pd_interface_surface(b.pi).n; q++)
    bw_check_near(found[q], scale * spin[q % 3], 1e4 * BW_REAL_EPSILON);
  bw_release(&X);
  bw_release(&V);
  bw_release(&found);
  body_destroy(&b);
}

START_TEST(rigid_rotation_is_exact)
{
  const bw_shape block = {.kind = BW_SHAPE_BOX, .upper = {6, 5, 4}},
                 sheet = {.kind = BW_SHAPE_BOX, .upper = {7, 7, 1}},
                 disc = {.kind = BW_SHAPE_CYLINDER, .centre = {5, 5}, .radius = 4, .axis = 2};
  check_spin(false, &block, (double[3]){0.2, -0.1, 0.4}, 1.0);
  check_spin(false, &sheet, (double[3]){0.2, -0.1, 0.4}, 1.0);
  check_spin(true, &disc, (double[3]){0.0, 0.0, 0.4}, 1.0);
}
END_TEST

/* About a rod's own axis, and for a lone particle, there is nothing to tell: zero, not noise. */
START_TEST(no_inertia_no_spin)
{
  const bw_shape rod = {.kind = BW_SHAPE_BOX, .upper = {7, 1, 1}},
                 pair = {.kind = BW_SHAPE_BOX, .upper = {2, 1, 1}},
                 lone = {.kind = BW_SHAPE_BOX, .upper = {1, 1, 1}};
  check_spin(false, &rod, (double[3]){0.2, 0.0, 0.0}, 0.0);
  check_spin(false, &pair, (double[3]){0.2, 0.1, 0.3}, 0.0);
  check_spin(false, &lone, (double[3]){0.2, 0.1, 0.3}, 0.0);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(rigid_rotation_is_exact),
                                      BW_TEST(no_inertia_no_spin)};
BW_CHECK_MAIN("pd_interface.turn", tests)
