/* The spin of a surface: that of a body that turns and moves, whatever else it is. Its normals
 * turn.
 * BUILD modules=shape
 * TEST ranks=1,2,3,4 */
#include "body.h"
#include <math.h>

static const double turned[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}};
/* With the corner at the origin twice as fine. */
static bw_solid_config finer(bool planar)
{
  bw_solid_config c = body_config(planar);
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.finer.n = 1;
  c.finer.box[0] = (bw_pd_box){1, {-1, -1, -1}, {3, 3, 3}};
  return c;
}

static const double turned_in_plane[3][3] = {{0.8, -0.6, 0}, {0.6, 0.8, 0}, {0, 0, 1}};

/* Of a body that has turned already. */
static void check_spin(const bw_solid_config *c, const bw_shape *shape, const double spin[3],
                       double scale)
{
  const double(*R)[3] = c->geometry != BW_PD_3D ? turned_in_plane : turned;
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(1, shape, c, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL, *found = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&found, 3 * n));
  bw_solid_get_reference(b.pd, V);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++)
      X[3 * i + d] = R[d][0] * V[3 * i] + R[d][1] * V[3 * i + 1] + R[d][2] * V[3 * i + 2];
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      const size_t e = (d + 1) % 3, f = (d + 2) % 3;
      V[3 * i + d] = 0.3 + spin[e] * X[3 * i + f] - spin[f] * X[3 * i + e];
    }
  bw_solid_set_state(b.pd, X, V);
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
  const bw_solid_config space = body_config(false), plane = body_config(true);
  const bw_shape block = {.kind = BW_SHAPE_BOX, .upper = {6, 5, 4}},
                 sheet = {.kind = BW_SHAPE_BOX, .upper = {7, 7, 1}},
                 disc = {.kind = BW_SHAPE_CYLINDER, .centre = {5, 5}, .radius = 4, .axis = 2};
  check_spin(&space, &block, (double[3]){0.2, -0.1, 0.4}, 1.0);
  check_spin(&space, &sheet, (double[3]){0.2, -0.1, 0.4}, 1.0);
  check_spin(&plane, &disc, (double[3]){0.0, 0.0, 0.4}, 1.0);
  const bw_solid_config space2 = finer(false), plane2 = finer(true);
  check_spin(&space2, &block, (double[3]){0.2, -0.1, 0.4}, 1.0);
  check_spin(&plane2, &disc, (double[3]){0.0, 0.0, 0.4}, 1.0);
}
END_TEST

/* About a rod's own axis, and for a lone particle, there is nothing to tell: zero, not noise. */
START_TEST(no_inertia_no_spin)
{
  const bw_solid_config space = body_config(false), plane = body_config(true);
  const bw_shape rod = {.kind = BW_SHAPE_BOX, .upper = {7, 1, 1}},
                 pair = {.kind = BW_SHAPE_BOX, .upper = {2, 1, 1}},
                 lone = {.kind = BW_SHAPE_BOX, .upper = {1, 1, 1}};
  check_spin(&space, &rod, (double[3]){0.2, 0.0, 0.0}, 0.0);
  check_spin(&plane, &rod, (double[3]){0.0, 0.0, 0.4}, 1.0); /* in a plane there is */
  check_spin(&space, &pair, (double[3]){0.2, 0.1, 0.3}, 0.0);
  check_spin(&space, &lone, (double[3]){0.2, 0.1, 0.3}, 0.0);
}
END_TEST

/* Random moments and velocities: what bears the moments has no resultant, their sum as moment, and
 * their power. */
static void check_twist(const bw_solid_config *c, const bw_shape *shape)
{
  const bool planar = c->geometry != BW_PD_3D;
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(1, shape, c, &ic);
  const size_t n = bw_solid_count(b.pd), rows = bw_pd_interface_surface(b.pi).n;
  double *X = NULL, *V = NULL, *M = NULL, *spin = NULL, *F = NULL, sum[2][7] = {{0.0}};
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&F, 3 * n));
  bw_check_ok(BW_ALLOCATE(&M, 3 * rows));
  bw_check_ok(BW_ALLOCATE(&spin, 3 * rows));
  bw_solid_get_reference(b.pd, V);
  for (size_t i = 0; i < 3 * n; i++)
    X[i] = V[i] + (i % 3 == 2 && planar ? 0.0 : 0.05 * sin(3.0 * V[i]));
  for (size_t i = 0; i < 3 * n; i++)
    V[i] = i % 3 == 2 && planar ? 0.0 : cos(17.0 * X[i] + 5.0 * X[3 * (i / 3)]);
  bw_solid_set_state(b.pd, X, V);
  bw_check_ok(bw_pd_interface_update(b.pi));
  const bw_pd_surface s = bw_pd_interface_surface(b.pi);
  for (size_t q = 0; q < 3 * rows; q++)
    M[q] = q % 3 < 2 && planar ? 0.0 : sin(7.0 * s.X[3 * (q / 3)] + (double)(q % 3));
  bw_pd_interface_turn(b.pi, spin);
  bw_pd_interface_twist(b.pi, M, F);
  for (size_t q = 0; q < 3 * rows; q++)
    sum[0][3 + q % 3] += M[q], sum[0][6] += M[q] * spin[q];
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      const size_t e = 3 * i + (d + 1) % 3, f = 3 * i + (d + 2) % 3;
      sum[1][d] += F[3 * i + d];
      sum[1][3 + d] += X[e] * F[f] - X[f] * F[e];
      sum[1][6] += F[3 * i + d] * V[3 * i + d];
    }
  bw_comm_sum(bw_check_world(), 14, sum[0]);
  ck_assert_double_gt(fabs(sum[0][6]), 1e-3);
  for (int q = 0; q < 7; q++)
    ck_assert_double_lt(fabs(sum[1][q] - sum[0][q]), 1e4 * BW_REAL_EPSILON);
  bw_release(&X);
  bw_release(&V);
  bw_release(&F);
  bw_release(&M);
  bw_release(&spin);
  body_destroy(&b);
}

START_TEST(moments_are_borne_as_the_surface_turns)
{
  const bw_solid_config space = body_config(false), plane = body_config(true);
  const bw_shape block = {.kind = BW_SHAPE_BOX, .upper = {6, 5, 4}},
                 sheet = {.kind = BW_SHAPE_BOX, .upper = {7, 7, 1}},
                 disc = {.kind = BW_SHAPE_CYLINDER, .centre = {5, 5}, .radius = 4, .axis = 2},
                 beam = {.kind = BW_SHAPE_BOX, .upper = {7, 1, 1}};
  check_twist(&space, &block);
  check_twist(&space, &sheet);
  check_twist(&plane, &disc);
  check_twist(&plane, &beam);
  const bw_solid_config space2 = finer(false), plane2 = finer(true);
  check_twist(&space2, &block);
  check_twist(&plane2, &disc);
}
END_TEST

/* Velocities that alternate from site to site, the lattice's shortest wave. */
START_TEST(the_shortest_wave_is_no_rotation)
{
  const bw_shape block = {.kind = BW_SHAPE_BOX, .upper = {6, 5, 4}};
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_solid_config c = body_config(false);
  body b = body_create(1, &block, &c, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL, *found = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&found, 3 * n));
  bw_solid_get_reference(b.pd, X);
  for (size_t i = 0; i < n; i++) {
    const int sum = (int)floor(X[3 * i]) + (int)floor(X[3 * i + 1]) + (int)floor(X[3 * i + 2]);
    V[3 * i] = sum % 2 ? 1.0 : -1.0, V[3 * i + 1] = -0.3 * V[3 * i], V[3 * i + 2] = 2.0 * V[3 * i];
  }
  bw_solid_set_state(b.pd, X, V);
  bw_check_ok(bw_pd_interface_update(b.pi));
  bw_pd_interface_turn(b.pi, found);
  for (size_t q = 0; q < 3 * bw_pd_interface_surface(b.pi).n; q++)
    bw_check_near(found[q], 0.0, 1e4 * BW_REAL_EPSILON);
  bw_release(&X);
  bw_release(&V);
  bw_release(&found);
  body_destroy(&b);
}
END_TEST

/* x = F X: normals of a material surface go with the cofactors of F (Nanson), whatever the body. */
static void check_normals(bool planar, const bw_shape *shape, const double F[3][3])
{
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_solid_config c = body_config(planar);
  body b = body_create(1, shape, &c, &ic);
  const bw_pd_surface s = bw_pd_interface_surface(b.pi);
  const size_t n = bw_solid_count(b.pd), rows = s.n;
  double *X = NULL, *V = NULL, *before = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&before, 3 * rows));
  memcpy(before, s.N, 3 * rows * sizeof *before);
  bw_solid_get_reference(b.pd, V);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++)
      X[3 * i + d] = F[d][0] * V[3 * i] + F[d][1] * V[3 * i + 1] + F[d][2] * V[3 * i + 2];
  memset(V, 0, 3 * n * sizeof *V);
  bw_solid_set_state(b.pd, X, V);
  bw_check_ok(bw_pd_interface_update(b.pi));
  for (size_t q = 0; q < rows; q++) {
    double want[3], length = 0.0;
    for (int d = 0; d < 3; d++) {
      want[d] = 0.0;
      for (int k = 0; k < 3; k++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3, l = (k + 1) % 3, m = (k + 2) % 3;
        want[d] += (F[e][l] * F[f][m] - F[e][m] * F[f][l]) * before[3 * q + (size_t)k];
      }
      length += want[d] * want[d];
    }
    for (size_t d = 0; d < 3; d++)
      bw_check_near(s.N[3 * q + d], want[d] / sqrt(length), 1e4 * BW_REAL_EPSILON);
  }
  bw_release(&X);
  bw_release(&V);
  bw_release(&before);
  body_destroy(&b);
}

START_TEST(normals_go_with_the_body)
{
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 5};
  const bw_shape sheet = {.kind = BW_SHAPE_BOX, .upper = {8, 6, 1}};
  const double skewed[3][3] = {{1.1, 0.2, 0.0}, {0.0, 0.9, -0.1}, {0.1, 0.0, 1.0}};
  const double plane[3][3] = {{0.6, -0.8, 0.0}, {1.0, 0.6, 0.0}, {0.0, 0.0, 1.0}};
  check_normals(false, &ball, turned);
  check_normals(false, &ball, skewed);
  check_normals(false, &sheet, turned);
  const bw_shape disc = {.kind = BW_SHAPE_CYLINDER, .centre = {1, 2, 0.5}, .radius = 6, .axis = 2};
  check_normals(true, &disc, plane);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(rigid_rotation_is_exact), BW_TEST(no_inertia_no_spin),
                                      BW_TEST(moments_are_borne_as_the_surface_turns),
                                      BW_TEST(the_shortest_wave_is_no_rotation),
                                      BW_TEST(normals_go_with_the_body)};
BW_CHECK_MAIN("pd_interface.turn", tests)
