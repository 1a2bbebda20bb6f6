/* What a coupler tells before its first step, and the steps that it refuses.
 * TEST ranks=1,2
 * BUILD case=bending_plate modules=shape,vtk */
#include "bending_flow.h"
#include "bw_check.h"

#include <string.h>

/* A plate of 2 x 10 particles in a channel of 20 x 10 cells. */
static bending_config small_plate(void)
{
  bending_config c = bending_config_default();
  c.channel.length = 2.0, c.channel.height = 1.0;
  c.channel.cells[0] = 20, c.channel.cells[1] = 10;
  c.fluid.density = c.fluid.bulk_velocity = 1.0;
  c.fluid.viscosity = 0.1;
  c.plate.front = 0.8, c.plate.thickness = 0.2, c.plate.height = 0.5;
  c.plate.particles_across = 4;
  c.plate.young_modulus = 1e3, c.plate.density = 10.0;
  return c;
}

START_TEST(markers_are_there_before_the_first_step)
{
  const bending_config c = small_plate();
  bending_flow f;
  bending_measure before, after;
  bw_check_ok(bending_create(bw_check_world(), &c, &f));
  bw_check_ok(bending_look(&f, &before));
  /* Sides and free end of 0.2 x 0.5 hold at least a marker per cell of 0.1. */
  ck_assert_int_ge(before.markers, 12);
  ck_assert_double_eq(before.reaction[0], 0.0); /* nothing has acted yet */
  bw_check_ok(bw_coupler_step(f.coupler, 1e-3));
  bw_check_ok(bending_look(&f, &after));
  ck_assert_int_eq(after.markers, before.markers);
  bending_destroy(&f);
}
END_TEST

START_TEST(sub_steps_without_end_are_refused)
{
  const bending_config c = small_plate();
  bending_flow f;
  bw_check_ok(bending_create(bw_check_world(), &c, &f));
  bw_check_ok(bw_coupler_check_substeps(f.coupler, 1e-3));
  const double one = 1e3 / bw_coupler_substeps(f.coupler, 1e3);
  bw_check_ok(bw_coupler_check_substeps(f.coupler, 0.99e6 * one));
  bw_check_status(bw_coupler_check_substeps(f.coupler, 4e6 * one), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "solid sub-steps"));
  ck_assert_int_eq(bw_coupler_substeps(f.coupler, 1e30), INT_MAX);
  bw_check_status(bw_coupler_check_substeps(f.coupler, NAN), BW_EINPUT);
  bending_destroy(&f);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(markers_are_there_before_the_first_step),
                                      BW_TEST(sub_steps_without_end_are_refused)};
BW_CHECK_MAIN("coupler.start", tests)
