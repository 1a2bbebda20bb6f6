/* The surface of bodies that are finer in places: who is surface, normals and areas by each
 * particle's own spacing, spin, walls, fragments.
 * BUILD modules=shape
 * TEST ranks=1,3 */
#include "body.h"
#include <math.h>

static const bw_shape cube[] = {{.kind = BW_SHAPE_BOX, .upper = {10, 9, 8}}};
static const bw_shape ball[] = {{.kind = BW_SHAPE_SPHERE, .centre = {0.2, -0.3, 0.1}, .radius = 5}};
static const bw_shape plate[] = {{.kind = BW_SHAPE_BOX, .upper = {24, 16, 1}}};
static const bw_shape disc[] = {
    {.kind = BW_SHAPE_CYLINDER, .centre = {0.3, -0.2, 0}, .radius = 15, .axis = 2}};
static const bw_shape ring[] = {
    {.kind = BW_SHAPE_CYLINDER, .centre = {0.3, -0.2, 0}, .radius = 15, .axis = 2},
    {.kind = BW_SHAPE_CYLINDER, .remove = true, .centre = {2, 1, 0}, .radius = 7.5, .axis = 2}};

/* Bodies with finer particles at an edge, in a corner, along a skin, over half a round body. Cells
 * are split as wholes: a finer half keeps the steps of the coarse lattice, two of its own cells. */
typedef struct {
  const char *name;
  int count;
  const bw_shape *shape;
  bool planar;
  int boxes;
  bw_pd_box box[2];
} place;
static const place places[] = {
    {"plate, edge", 1, plate, true, 1, {{1, {9, 10, -1}, {15, 17, 1}}}},
    {"plate, corner, two levels", 1, plate, true, 1, {{2, {-1, -1, -1}, {4, 3, 1}}}},
    {"plate, skin",
     1,
     plate,
     true,
     2,
     {{1, {-1, -1, -1}, {25, 2, 1}}, {1, {-1, 14, -1}, {25, 17, 1}}}},
    {"disc, half", 1, disc, true, 1, {{1, {0.5, -20, -1}, {20, 20, 1}}}},
    {"ring, half", 2, ring, true, 1, {{1, {0.5, -20, -1}, {20, 20, 1}}}},
    {"cube, corner", 1, cube, false, 1, {{1, {6, 5, 4}, {11, 11, 11}}}},
    {"ball, half", 1, ball, false, 1, {{1, {0.5, -20, -20}, {20, 20, 20}}}}, /* the last */
};
enum { PLACES = sizeof places / sizeof *places };

static body make(const place *p, const bw_pd_interface_config *ic)
{
  bw_solid_config c = body_config(p->planar);
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.finer.n = p->boxes;
  memcpy(c.finer.box, p->box, sizeof p->box);
  return body_create(p->count, p->shape, &c, ic);
}

/* Sides of a particle beyond which there is nothing of the body. */
static int open_sides(const body *b, const double X[3], double ds, bool planar)
{
  int open = 0;
  for (int d = 0; d < (planar ? 2 : 3); d++)
    for (int side = -1; side <= 1; side += 2) {
      int at[3];
      for (int e = 0; e < 3; e++)
        at[e] = planar && e == 2 ? 0 : (int)floor(X[e] + (e == d ? side * 0.75 * ds : 0.0));
      open += !body_has(b, at);
    }
  return open;
}

/* As in bodies of one level, the surface is the particles with an open side, on both sides of
 * every jump. */
START_TEST(surface_is_the_particles_with_an_open_side)
{
  for (int q = 0; q < PLACES; q++) {
    const bw_pd_interface_config ic = bw_pd_interface_config_default();
    body b = make(&places[q], &ic);
    const bool *surface = bw_pd_interface_is_surface(b.pi);
    const size_t n = bw_solid_count(b.pd);
    double *X = NULL, wrong = 0.0, fine = 0.0;
    bw_check_ok(BW_ALLOCATE(&X, 3 * n));
    bw_solid_get_reference(b.pd, X);
    for (size_t h = 0; h < n; h++) {
      const double ds = bw_solid_spacing(b.pd, h);
      wrong += surface[h] != (open_sides(&b, X + 3 * h, ds, places[q].planar) > 0);
      fine += surface[h] && ds < 1.0;
    }
    ck_assert_msg(body_sum(wrong) == 0.0, "%s: %g wrong", places[q].name, body_sum(wrong));
    ck_assert_double_gt(body_sum(fine), 0.0);
    bw_release(&X);
    body_destroy(&b);
  }
}
END_TEST

/* Flat faces: beside a jump the centroid of 3.45 is a sum over cells of two sizes, off by their
 * quadrature; half of the goal of 5 degrees. Farther than the coarse horizon from jumps and edges
 * normals are exact, on fine and coarse particles. Heights are half of each one's spacing. */
START_TEST(flat_faces_have_their_normals_and_heights)
{
  const bw_shape long_plate[] = {{.kind = BW_SHAPE_BOX, .upper = {60, 16, 1}}};
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const place p = {"", 1, long_plate, true, 1, {{1, {20, 10, -1}, {40, 17, 1}}}};
  body b = make(&p, &ic);
  const bw_pd_surface s = bw_pd_interface_surface(b.pi);
  int fine = 0, coarse = 0;
  for (size_t q = 0; q < s.n; q++) {
    const double *x = &s.X[3 * q], *n = &s.N[3 * q];
    const double ds = bw_solid_spacing(b.pd, (size_t)s.particle[q]);
    if (x[1] < 15 || x[0] < 6 || x[0] > 54) continue;
    ck_assert_double_gt(n[1], cos(2.5 * acos(-1.0) / 180.0));
    bw_check_near(s.H[q], 0.5 * ds, 0.03 * ds);
    bw_check_near(s.A[q], ds, 1e-3 * ds);
    /* Fits reach two families far. */
    const double jump = fmin(fabs(x[0] - 20), fabs(x[0] - 40));
    if (jump < 8) continue;
    bw_check_near(n[1], 1.0, 1e-6); /* a tenth of a degree */
    fine += ds < 1, coarse += ds == 1;
  }
  ck_assert_int_eq((int)body_sum(fine), 8);
  ck_assert_int_eq((int)body_sum(coarse), 2 * 6);
  body_destroy(&b);
}
END_TEST

/* sum A n = 0, and sum A n.x (x on the surface) each time the volume: 1 and 6 % of the magnitudes,
 * as in bodies of one level (test_surface.c); of round ones halves of different steps differ by
 * their areas' 3 %. */
START_TEST(areas_close_the_body)
{
  for (int r = 0; r < PLACES - 1; r++) { /* a ball of five spacings is too rough */
    const place *p = &places[r];
    const bw_pd_interface_config ic = bw_pd_interface_config_default();
    body b = make(p, &ic);
    const bw_pd_surface s = bw_pd_interface_surface(b.pi);
    double sum[4][3] = {{0}};
    for (size_t q = 0; q < s.n; q++)
      for (int d = 0; d < 3; d++) {
        const double n = s.N[3 * q + (size_t)d], middle = b.low[d] + 0.5 * b.size[d];
        const double x = s.X[3 * q + (size_t)d] + s.H[q] * n - middle;
        sum[0][d] += s.A[q] * n, sum[1][d] += s.A[q] * fabs(n);
        sum[2][d] += s.A[q] * n * x, sum[3][d] += s.A[q] * fabs(n * x);
      }
    bw_comm_sum(bw_check_world(), 12, sum[0]);
    const double closed = p->shape->kind == BW_SHAPE_BOX ? 0.01 : 0.03;
    for (int d = 0; d < (p->planar ? 2 : 3); d++) {
      ck_assert_msg(fabs(sum[0][d]) < closed * sum[1][d], "%s: open by %g of %g", p->name,
                    sum[0][d], sum[1][d]);
      ck_assert_msg(fabs(sum[2][d] - (double)b.n) < 0.06 * sum[3][d],
                    "%s, direction %d: %g, not %g; magnitude %g", p->name, d, sum[2][d],
                    (double)b.n, sum[3][d]);
    }
    body_destroy(&b);
  }
}
END_TEST

/* A plate between two walls, finer along one of them or at one end: no surface at the walls,
 * and no part of a normal along them. */
START_TEST(walls_are_no_surface)
{
  bw_pd_interface_config ic = bw_pd_interface_config_default();
  ic.walled[1][0] = ic.walled[1][1] = true;
  ic.lower[1] = 0.0, ic.upper[1] = 16.0;
  const place row[] = {{"", 1, plate, true, 1, {{1, {-1, -1, -1}, {25, 5, 1}}}},
                       {"", 1, plate, true, 1, {{1, {-1, -1, -1}, {8, 17, 1}}}}};
  for (int q = 0; q < 2; q++) {
    body b = make(&row[q], &ic);
    const bw_pd_surface s = bw_pd_interface_surface(b.pi);
    double area = 0.0;
    for (size_t k = 0; k < s.n; k++) {
      ck_assert_msg(s.X[3 * k] < 1 || s.X[3 * k] > 23, "x = %g is not a side", s.X[3 * k]);
      if (q == 1) bw_check_near(fabs(s.N[3 * k]), 1.0, 1e-12);
      area += s.A[k];
    }
    bw_check_near(body_sum(area), 2 * 16, q == 1 ? 1e-12 : 0.01);
    body_destroy(&b);
  }
}
END_TEST

/* A crack through both levels opens where its gap is wide for the particles there: 3.42 is counted
 * in each one's own horizon. The upper part is a fragment of half the mass. */
START_TEST(cracks_open_by_each_horizon)
{
  const place p = {"", 1, plate, true, 1, {{1, {12, -1, -1}, {25, 17, 1}}}};
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = make(&p, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(bw_solid_precrack(b.pd, (double[3]){-1, 8, 0}, (double[3]){25, 8, 0}, NULL));
  for (int step = 0; step < 3; step++) {
    const double gap = (double[]){0.0, 0.75, 1.5}[step]; /* a spacing opens it (test_opening.c) */
    bw_solid_get_reference(b.pd, X);
    for (size_t h = 0; h < n; h++)
      if (X[3 * h + 1] > 8) X[3 * h + 1] += gap;
    bw_solid_set_state(b.pd, X, V);
    bw_check_ok(bw_pd_interface_update(b.pi));
    const bw_pd_surface s = bw_pd_interface_surface(b.pi);
    double faces[2] = {0, 0};
    for (size_t q = 0; q < s.n; q++) {
      const double *x = &s.X[3 * q], ds = bw_solid_spacing(b.pd, (size_t)s.particle[q]);
      const bool lip = fabs(x[1] - 8 - (x[1] > 8 ? gap : 0)) < ds && x[0] > 1 && x[0] < 23;
      if (lip) faces[ds < 1] += s.A[q];
      if (lip && fabs(x[0] - 12) > 4 && fabs(x[0] - 12) < 7)
        bw_check_near(s.N[3 * q + 1], x[1] > 8 ? -1 : 1, 0.02);
    }
    bw_comm_sum(bw_check_world(), 2, faces);
    bw_check_near(faces[1], step > 0 ? 22.0 : 0.0, 1e-9); /* both lips of 11 */
    bw_check_near(faces[0], step > 1 ? 22.0 : 0.0, 1e-9);
  }
  bw_pd_fragments f;
  bw_check_ok(bw_pd_interface_fragments(b.pi, NULL, &f));
  ck_assert_int_eq(f.total, 2);
  bw_check_near(f.largest[0].mass, 24 * 8, 1e-9);
  bw_check_near(f.largest[1].mass, 24 * 8, 1e-9);
  bw_pd_fragment_release(&f);
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}
END_TEST

/* A crack along a jump: neither lip is open before it gapes, as partners beyond the own horizon
 * tell nothing, and both are when it does by more than the coarse horizon asks for. */
START_TEST(cracks_along_a_jump_are_closed_at_first)
{
  const place p = {"", 1, plate, true, 1, {{1, {-1, 8, -1}, {25, 17, 1}}}};
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = make(&p, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(bw_solid_precrack(b.pd, (double[3]){-1, 8, 0}, (double[3]){25, 8, 0}, NULL));
  for (int gapes = 0; gapes < 2; gapes++) {
    const double gap = 1.5 * gapes;
    bw_solid_get_reference(b.pd, X);
    for (size_t h = 0; h < n; h++)
      if (X[3 * h + 1] > 8) X[3 * h + 1] += gap;
    bw_solid_set_state(b.pd, X, V);
    bw_check_ok(bw_pd_interface_update(b.pi));
    const bw_pd_surface s = bw_pd_interface_surface(b.pi);
    double lips = 0.0;
    for (size_t q = 0; q < s.n; q++) {
      const double *x = &s.X[3 * q], y = x[1] - (x[1] > 8 ? gap : 0);
      const double ds = bw_solid_spacing(b.pd, (size_t)s.particle[q]);
      if (x[0] > 1 && x[0] < 23 && fabs(y - 8) < ds) lips += s.A[q];
    }
    bw_check_near(body_sum(lips), gapes ? 2 * 22.0 : 0.0, 1e-9);
  }
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}
END_TEST

/* The area of the reference shape: flat faces have theirs, jump or none. Normals 2.5 degrees off,
 * on a coarse horizon either way of both jumps and on all between, would take 1e-3 of 18. */
START_TEST(the_shape_keeps_its_area)
{
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const place alike = {"", 1, plate, true, 0, {{0}}};
  body one = make(&alike, &ic), some = make(&places[0], &ic);
  const double lost =
      bw_pd_interface_reference_area(one.pi) - bw_pd_interface_reference_area(some.pi);
  ck_assert_msg(fabs(lost) < 0.02, "%g of %g", lost, bw_pd_interface_reference_area(one.pi));
  body_destroy(&one);
  body_destroy(&some);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(surface_is_the_particles_with_an_open_side),
    BW_TEST(flat_faces_have_their_normals_and_heights),
    BW_TEST(areas_close_the_body),
    BW_TEST(walls_are_no_surface),
    BW_TEST(cracks_open_by_each_horizon),
    BW_TEST(cracks_along_a_jump_are_closed_at_first),
    BW_TEST(the_shape_keeps_its_area),
};
BW_CHECK_MAIN("pd_interface.surface_levels", tests)
