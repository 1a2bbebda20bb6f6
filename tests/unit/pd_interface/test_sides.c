/* Where edges, ridges and sheets meet the fluid: the open sides of their particles.
 * BUILD modules=shape
 * TEST ranks=1,2,3 */
#include "body.h"

#include <math.h>

static const bw_shape brick[] = {
    {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {6, 5, 4}},
};
static const bw_shape sheet[] = {
    {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {12, 1, 9}},
};
static const bw_shape strip[] = {
    {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {9, 3, 1}},
};
static const bw_shape porous[] = {
    {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {16, 32, 16}},
    {.kind = BW_SHAPE_PORES_SC, .remove = true, .centre = {8, 8, 8}, .radius = 9.32, .pitch = 16},
};

/* Turned by one radian about the direction (1, 2, 2)/3, in the plane about z. */
static void turn(bool planar, const double x[3], double y[3])
{
  const double third = 1.0 / 3.0, c = cos(1.0), s = sin(1.0);
  const double e[3] = {planar ? 0.0 : third, planar ? 0.0 : 2.0 * third, planar ? 1.0 : 2 * third};
  const double along = e[0] * x[0] + e[1] * x[1] + e[2] * x[2];
  for (int d = 0; d < 3; d++) {
    const int p = (d + 1) % 3, q = (d + 2) % 3;
    y[d] = c * x[d] + s * (e[p] * x[q] - e[q] * x[p]) + (1.0 - c) * along * e[d];
  }
}

static void turn_body(body *b, bool planar)
{
  const size_t n = bw_solid_count(b->pd);
  double *X = NULL, *V = NULL, x[3];
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_reference(b->pd, X);
  for (size_t h = 0; h < n; h++) {
    memcpy(x, X + 3 * h, sizeof x);
    turn(planar, x, X + 3 * h);
  }
  bw_solid_set_state(b->pd, X, V);
  bw_check_ok(bw_pd_interface_update(b->pi));
  bw_release(&X);
  bw_release(&V);
}

/* sum A N and sum A N.x over the body's sides, x on the surface; the area. */
static void sums(body *b, double net[3], double *volume, double *area)
{
  const bw_pd_surface s = bw_pd_interface_surface(b->pi);
  const bw_pd_sides sides = bw_pd_interface_sides(b->pi);
  double all[5] = {0.0};
  ck_assert_uint_le(sides.n, bw_pd_interface_most_sides(b->pi));
  for (size_t q = 0; q < sides.n; q++) {
    const double *N = sides.N + 3 * q, *X = s.X + 3 * (size_t)sides.row[q];
    ck_assert(q == 0 || sides.row[q] >= sides.row[q - 1]);
    all[4] += sides.A[q];
    for (int d = 0; d < 3; d++) {
      all[d] += sides.A[q] * N[d];
      all[3] += sides.A[q] * N[d] * (X[d] + sides.H[q] * N[d]);
    }
  }
  bw_comm_sum(bw_check_world(), 5, all);
  memcpy(net, all, 3 * sizeof *net);
  *volume = all[3], *area = all[4];
}

/* A body of flat sides, as thin as it may be, is closed and has its area and volume to round-off
 * (Gauss: sum A N.x = dims V), and so it is when it has turned. */
START_TEST(bricks_and_sheets_are_closed)
{
  const struct {
    const bw_shape *shape;
    bool planar;
    double area;
  } row[] = {
      {brick, false, 2 * (30 + 24 + 20)}, {sheet, false, 2 * (108 + 12 + 9)}, {strip, true, 24}};
  for (size_t r = 0; r < sizeof row / sizeof *row; r++) {
    const bw_solid_config c = body_config(row[r].planar);
    const bw_pd_interface_config ic = bw_pd_interface_config_default();
    body b = body_create(1, row[r].shape, &c, &ic);
    for (int turned = 0; turned < 2; turned++) {
      double net[3], volume, area;
      if (turned == 1) turn_body(&b, row[r].planar);
      sums(&b, net, &volume, &area);
      for (int d = 0; d < 3; d++)
        bw_check_near(net[d], 0.0, 1e4 * BW_REAL_EPSILON * row[r].area);
      bw_check_near(area, row[r].area, 1e-10 * row[r].area);
      bw_check_near(volume / (row[r].planar ? 2.0 : 3.0), (double)b.n,
                    1e4 * BW_REAL_EPSILON * row[r].area);
    }
    body_destroy(&b);
  }
}
END_TEST

/* A medium of pores: what is smooth has one point, ridges have their sides; closed to the hundredth
 * of its area and 6 % of its volume, as the surface itself is (test_surface). */
START_TEST(pores_are_closed)
{
  const bw_solid_config c = body_config(false);
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(2, porous, &c, &ic);
  const bw_pd_sides sides = bw_pd_interface_sides(b.pi);
  double net[3], volume, area;
  ck_assert_double_gt(body_sum((double)sides.n), body_sum((double)bw_pd_interface_surface(b.pi).n));
  sums(&b, net, &volume, &area);
  for (int d = 0; d < 3; d++)
    bw_check_near(net[d], 0.0, 0.01 * area);
  bw_check_near(volume / 3.0, (double)b.n, 0.06 * (double)b.n);
  body_destroy(&b);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(bricks_and_sheets_are_closed),
                                      BW_TEST(pores_are_closed)};
BW_CHECK_MAIN("pd_interface.sides", tests)
