/* Cracks that open: when their faces become surface, with which normals and areas.
 * BUILD modules=shape
 * TEST ranks=1,2,3,4 */
#include "body.h"
#include "pd_body.h"
#include "pd_interface_internal.h"

/* A block cut by a crack between y = 5 and y = 6 (no face there before it opens). */
typedef struct {
  body b;
  double *X, *V;
  size_t n;
} cracked;

static const double cut = 6.0;

static cracked cracked_create(bool planar)
{
  const bw_shape block[] = {{.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {11, 12, 11}}};
  bw_solid_config c = body_config(planar);
  c.thickness = 0.5;
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  cracked k = {.b = body_create(1, block, &c, &ic)};
  const double a[3] = {-1, cut, -1}, across[3] = {12, cut, -1}, deep[3] = {-1, cut, 12};
  bw_check_ok(bw_solid_precrack(k.b.pd, a, across, planar ? NULL : deep));
  k.n = bw_solid_count(k.b.pd);
  bw_check_ok(BW_ALLOCATE(&k.X, 3 * k.n));
  bw_check_ok(BW_ALLOCATE(&k.V, 3 * k.n));
  return k;
}

static void cracked_destroy(cracked *k)
{
  bw_release(&k->X);
  bw_release(&k->V);
  body_destroy(&k->b);
}

/* Move the upper half by `gap` along y (and turn everything by `angle` about z). */
static void open_crack(cracked *k, double gap, double angle)
{
  bw_solid_get_reference(k->b.pd, k->X);
  for (size_t h = 0; h < k->n; h++) {
    double *x = &k->X[3 * h];
    if (x[1] > cut) x[1] += gap;
    const double y[2] = {cos(angle) * x[0] - sin(angle) * x[1],
                         sin(angle) * x[0] + cos(angle) * x[1]};
    x[0] = y[0], x[1] = y[1];
  }
  bw_solid_set_state(k->b.pd, k->X, k->V);
  bw_check_ok(bw_pd_interface_update(k->b.pi));
}

static int on_surface(const cracked *k)
{
  return (int)body_sum((double)bw_pd_interface_surface(k->b.pi).n);
}

/* Is the direction (i, j > 0, l) in the sector? 2D: 0 the side's own, within 22.5 degrees of y; 1
 * the diagonal next to it. 3D: 0 a quarter of the side's pyramid, borders included. */
static bool in_sector(bool planar, int sector, int i, int j, int l)
{
  const double steep = 2.414213562; /* tan 67.5 degrees */
  if (!planar) return i >= 0 && l >= 0 && i <= j && l <= j;
  return sector == 0 ? steep * abs(i) < j : i > 0 && j < steep * i && i < steep * j;
}

/* Gap at which the mean of |partner - particle| over the broken bonds reaches the horizon (3) in
 * as many sectors as it takes: 2D two neighbouring ones, 3D one. By enumeration. */
static double expected_gap(bool planar)
{
  double widest = 0.0;
  for (int sector = 0; sector < (planar ? 2 : 1); sector++) {
    double low = 0.0, high = 3.0;
    for (int it = 0; it < 60; it++) {
      const double g = 0.5 * (low + high);
      double sum = 0.0, members = 0.0;
      for (int i = -3; i <= 3; i++)
        for (int j = 1; j <= 3; j++)
          for (int l = planar ? 0 : -3; l <= (planar ? 0 : 3); l++) {
            if (i * i + j * j + l * l > 12 || !in_sector(planar, sector, i, j, l)) continue;
            sum += sqrt(i * i + (j + g) * (j + g) + l * l);
            members += 1.0;
          }
      if (sum / members > 3.0)
        high = g;
      else
        low = g;
    }
    widest = fmax(widest, low);
  }
  return widest;
}

START_TEST(crack_faces_appear_when_the_gap_is_wide_enough)
{
  for (int planar = 0; planar < 2; planar++) {
    cracked k = cracked_create(planar);
    const int start = planar ? 11 * 12 - 9 * 10 : 11 * 12 * 11 - 9 * 10 * 9;
    const int faces = planar ? 2 * 9 : 2 * 9 * 9; /* those that were no surface before */
    ck_assert_int_eq(on_surface(&k), start);
    const double gap = expected_gap(planar);
    ck_assert_msg(gap > 0.5 && gap < 2.0, "gap %g", gap);
    open_crack(&k, 0.0, 0.0);
    ck_assert_int_eq(on_surface(&k), start);
    open_crack(&k, gap - 0.01, 0.0);
    ck_assert_int_eq(on_surface(&k), start);
    open_crack(&k, gap + 0.01, 0.0);
    ck_assert_int_eq(on_surface(&k), start + faces);
    open_crack(&k, gap + 0.01, 2.0); /* turning the body changes nothing */
    ck_assert_int_eq(on_surface(&k), start + faces);
    open_crack(&k, 0.1, 0.0); /* and a gap that closed is no surface for the fluid */
    ck_assert_int_eq(on_surface(&k), start);
    cracked_destroy(&k);
  }
}
END_TEST

START_TEST(crack_faces_have_opposite_normals_and_their_area)
{
  for (int planar = 0; planar < 2; planar++) {
    cracked k = cracked_create(planar);
    const double angle = 0.7;
    open_crack(&k, 4.0, angle);
    const bw_pd_surface s = bw_pd_interface_surface(k.b.pi);
    double *X0 = NULL;
    bw_check_ok(BW_ALLOCATE(&X0, 3 * k.n));
    bw_solid_get_reference(k.b.pd, X0);
    double upper = 0.0, lower = 0.0;
    for (size_t q = 0; q < s.n; q++) {
      const double *x = &X0[3 * s.particle[q]], *n = &s.N[3 * q];
      if (fabs(x[1] - cut) > 1.0 || fabs(x[0] - 5.5) > 2.1) continue;
      if (!planar && fabs(x[2] - 5.5) > 2.1) continue;
      const double along = -sin(angle) * n[0] + cos(angle) * n[1]; /* the turned y */
      bw_check_near(along, x[1] > cut ? -1.0 : 1.0, 1e-6);
      bw_check_near(s.A[q], planar ? 0.5 : 1.0, 1e-12);
      upper += x[1] > cut, lower += x[1] < cut;
    }
    ck_assert_int_eq((int)body_sum(upper), planar ? 5 : 25);
    ck_assert_int_eq((int)body_sum(lower), planar ? 5 : 25);
    bw_release(&X0);
    cracked_destroy(&k);
  }
}
END_TEST

/* Positions are those of the particles; rows rise; flags say the same. */
START_TEST(rows_agree_with_the_solid)
{
  cracked k = cracked_create(false);
  open_crack(&k, 2.5, 0.1);
  const bw_pd_surface s = bw_pd_interface_surface(k.b.pi);
  const bool *is = bw_pd_interface_is_surface(k.b.pi);
  size_t marked = 0;
  for (size_t h = 0; h < k.n; h++)
    marked += is[h];
  ck_assert_uint_eq(marked, s.n);
  for (size_t q = 0; q < s.n; q++) {
    const size_t h = (size_t)s.particle[q];
    ck_assert(is[h] && (q == 0 || s.particle[q] > s.particle[q - 1]));
    for (size_t d = 0; d < 3; d++)
      bw_check_near(s.X[3 * q + d], k.X[3 * h + d], 1e-5); /* bw_real may be float */
  }
  cracked_destroy(&k);
}
END_TEST

/* A foot held beyond the wall: when the block comes off it, its underside is surface. */
START_TEST(a_block_torn_from_its_foot_shows_its_underside)
{
  const bw_shape shape[] = {
      {.kind = BW_SHAPE_BOX, .lower = {0, 0, 0}, .upper = {9, 9, 9}},
      {.kind = BW_SHAPE_BOX, .lower = {0, -3, 0}, .upper = {9, 0, 9}, .particle_kind = 1}};
  const bw_solid_config c = body_config(false);
  bw_pd_interface_config ic = bw_pd_interface_config_default();
  ic.walled[1][0] = true;
  ic.lower[1] = 0.0;
  body b = body_create(2, shape, &c, &ic);
  const int standing = 9 * 9 * 9 - 7 * 8 * 7, all = 9 * 9 * 9 - 7 * 7 * 7;
  ck_assert_int_eq((int)body_sum((double)bw_pd_interface_surface(b.pi).n), standing);
  const double p[3] = {-1, 0, -1}, q[3] = {10, 0, -1}, r[3] = {-1, 0, 10};
  bw_check_ok(bw_solid_precrack(b.pd, p, q, r));
  double *X = NULL, *V = NULL;
  const size_t n = bw_solid_count(b.pd);
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  for (int opened = 0; opened < 2; opened++) {
    bw_solid_get_reference(b.pd, X);
    for (size_t h = 0; h < n; h++)
      if (X[3 * h + 1] > 0.0) X[3 * h + 1] += opened ? 2.0 : 0.1;
    bw_solid_set_state(b.pd, X, V);
    bw_check_ok(bw_pd_interface_update(b.pi));
    ck_assert_int_eq((int)body_sum((double)bw_pd_interface_surface(b.pi).n),
                     opened ? all : standing);
  }
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}
END_TEST

/* What an update finds by following changes is what a look at everything finds, to the last bit:
 * after cuts in all directions, moves of the pieces, and off the wall and back. */
static void check_following(const bw_shape *shape)
{
  const bw_solid_config c = body_config(false);
  bw_pd_interface_config ic = bw_pd_interface_config_default();
  ic.walled[1][0] = true;
  ic.lower[1] = 0.0;
  body b = body_create(1, shape, &c, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  const double gap[] = {0.0, 1.5, 0.3, 3.5, 6.5, 0.0};
  for (int q = 0; q < 6; q++) {
    const double at = 2.0 + q, e = 20.0; /* cut q: a plane normal to direction q % 3, half deep */
    double p[3] = {-e, -e, -e}, r[3] = {e, e, e}, t[3] = {-e, -e, e};
    p[q % 3] = r[q % 3] = t[q % 3] = at;
    const int f = (q % 3 + 1) % 3, g = (q % 3 + 2) % 3;
    r[f] = q % 2 ? 5.0 : e, r[g] = -e; /* p-r along f, p-t along g */
    t[f] = -e, t[g] = e;
    bw_check_ok(bw_solid_precrack(b.pd, p, r, t));
    bw_solid_get_reference(b.pd, X);
    for (size_t h = 0; h < n; h++) {
      for (size_t d = 0; d < 3; d++)
        if (X[3 * h + d] > 4.0) X[3 * h + d] += gap[q];
      X[3 * h + 1] += q == 4 ? 4.0 : 0.0; /* all of it off the wall, once */
    }
    bw_solid_set_state(b.pd, X, V);
    bw_check_ok(bw_pd_interface_update(b.pi));
    bw_pd_interface *anew = NULL;
    bw_check_ok(bw_pd_interface_create(b.pd, &ic, &anew));
    const bw_pd_surface one = bw_pd_interface_surface(b.pi), two = bw_pd_interface_surface(anew);
    ck_assert_uint_eq(one.n, two.n);
    for (size_t row = 0; row < one.n; row++) {
      ck_assert_int_eq(one.particle[row], two.particle[row]);
      ck_assert_double_eq(one.A[row], two.A[row]);
      for (size_t d = 0; d < 3; d++)
        ck_assert_double_eq(one.N[3 * row + d], two.N[3 * row + d]);
    }
    /* Change comes to h from copies and images, which do not know h: it has to look by itself. */
    for (size_t row = 0; row < one.n; row++) {
      const size_t h = (size_t)one.particle[row];
      bool looks = false;
      for (size_t s = 0; s < b.pi->rows.row_n[h]; s++) {
        const bw_pd_interface__near *near = &b.pi->rows.pool[b.pi->rows.row[h] + s];
        looks = looks || near->cross != 0 || near->partner >= (int32_t)n;
      }
      ck_assert(b.pi->fit.border[h] == looks);
    }
    bw_pd_interface_destroy(&anew);
  }
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}

START_TEST(following_agrees_with_looking_anew)
{
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {10, 10, 10}};
  const bw_shape ball = {.kind = BW_SHAPE_SPHERE, .centre = {9, 9.5, 9}, .radius = 9};
  /* Three particles from a border between ranks one sees a single particle of the other. */
  const bw_shape row = {.kind = BW_SHAPE_BOX, .upper = {24, 1, 1}};
  check_following(&row);
  check_following(&box);
  check_following(&ball); /* smooth, but for its cuts */
}
END_TEST

/* When the solid says that its set of particles has changed everything is told anew: of the same
 * particles the same. */
START_TEST(another_set_of_particles_is_told_anew)
{
  cracked k = cracked_create(false);
  open_crack(&k, 4.0, 0.3);
  const bw_pd_surface before = bw_pd_interface_surface(k.b.pi);
  double *N = NULL, *A = NULL;
  bw_check_ok(BW_ALLOCATE(&N, 3 * before.n));
  bw_check_ok(BW_ALLOCATE(&A, before.n));
  memcpy(N, before.N, 3 * before.n * sizeof *N);
  memcpy(A, before.A, before.n * sizeof *A);
  bw_pd_body_touch(bw_solid_body(k.b.pd));
  ck_assert_int_eq(bw_solid_revision(k.b.pd), 1);
  bw_check_ok(bw_pd_interface_update(k.b.pi));
  const bw_pd_surface after = bw_pd_interface_surface(k.b.pi);
  ck_assert_uint_eq(after.n, before.n);
  for (size_t q = 0; q < after.n; q++) {
    bw_check_near(after.A[q], A[q], 1e3 * BW_REAL_EPSILON);
    for (size_t d = 0; d < 3; d++)
      bw_check_near(after.N[3 * q + d], N[3 * q + d], 1e3 * BW_REAL_EPSILON);
  }
  bw_release(&N);
  bw_release(&A);
  cracked_destroy(&k);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(another_set_of_particles_is_told_anew),
    BW_TEST(crack_faces_appear_when_the_gap_is_wide_enough),
    BW_TEST(crack_faces_have_opposite_normals_and_their_area),
    BW_TEST(rows_agree_with_the_solid),
    BW_TEST(a_block_torn_from_its_foot_shows_its_underside),
    BW_TEST(following_agrees_with_looking_anew),
};
BW_CHECK_MAIN("pd_interface.opening", tests)
