/* A pressure in cracks: the area it acts on, what it reaches, momentum, energy, restart.
 * BUILD modules=solid_tools
 * TEST ranks=1,3 */
#include "bw_solid_crack.h"
#include "pd_test.h"

#include <string.h>

static bw_solid_crack *fill(bw_solid *pd, const double lower[3], const double upper[3])
{
  const size_t n = bw_solid_count(pd);
  bw_solid_crack *crack = NULL;
  double *X0 = NULL;
  bool *source = NULL;
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_check_ok(BW_ALLOCATE(&source, n));
  bw_solid_get_reference(pd, X0);
  for (size_t i = 0; i < n; i++) {
    source[i] = true;
    for (size_t d = 0; d < 3; d++)
      source[i] = source[i] && X0[3 * i + d] >= lower[d] && X0[3 * i + d] <= upper[d];
  }
  bw_check_ok(bw_solid_crack_create(pd, source, &crack));
  bw_release(&X0);
  bw_release(&source);
  return crack;
}

static bw_solid_crack *fill_all(bw_solid *pd)
{
  return fill(pd, (double[3]){-99, -99, -99}, (double[3]){99, 99, 99});
}

/* Sums over all ranks: force on the particles above the plane normal.X = at, all force, all moment
 * about the origin. */
typedef struct {
  double above[3], force[3], moment[3];
} resultant;

static resultant push(bw_solid *pd, bw_solid_crack *crack, double pressure, const double normal[3],
                      double at)
{
  const size_t n = bw_solid_count(pd);
  resultant r = {{0}, {0}, {0}};
  double *F = NULL, *X = NULL, *X0 = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&X0, 3 * n));
  bw_solid_get_position(pd, X);
  bw_solid_get_reference(pd, X0);
  bw_check_ok(bw_solid_crack_push(crack, pressure, F));
  for (size_t i = 0; i < n; i++) {
    const double *x = X + 3 * i, *x0 = X0 + 3 * i;
    const double height = normal[0] * x0[0] + normal[1] * x0[1] + normal[2] * x0[2];
    for (size_t d = 0; d < 3; d++) {
      const size_t a = (d + 1) % 3, b = (d + 2) % 3;
      const double f = F[3 * i + d] * bw_solid_volume(pd);
      r.force[d] += f;
      r.above[d] += height > at ? f : 0;
      r.moment[d] += (x[a] * F[3 * i + b] - x[b] * F[3 * i + a]) * bw_solid_volume(pd);
    }
  }
  bw_comm_sum(bw_solid_comm(pd), 9, r.above);
  bw_release(&F);
  bw_release(&X);
  bw_release(&X0);
  return r;
}

static void part_a_little(const double X0[3], double u[3])
{
  u[0] = u[2] = 0, u[1] = X0[1] > 2 ? 1e-3 : 0;
}

/* By four spacings, and turned. */
static void part_and_turn(const double X0[3], double u[3])
{
  const double c = cos(0.7), s = sin(0.7), y = X0[1] + (X0[1] > 2 ? 2 : 0);
  u[0] = c * X0[0] - s * y - X0[0], u[1] = s * X0[0] + c * y - X0[1], u[2] = 0;
}

/* A body of 8 x 8 spacings that is cut through, periodic along the cut: the pressure acts on just
 * its area, whether the halves are near or far apart and turned, and the volume is what opened. */
static void cut_through(bw_pd_geometry geometry)
{
  const bool space = geometry == BW_PD_3D;
  bw_solid_config c = pd_soft(geometry);
  pd_body body = pd_box(8, 8, space ? 8 : 1);
  const double up[3] = {0, 1, 0}, near = 400 * BW_REAL_EPSILON;
  if (!space) c.thickness = 3;
  c.period[0] = 4, c.period[2] = space ? 4 : 0;
  const double area = space ? 16 : 4 * 3;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(
      bw_solid_precrack(pd, (double[3]){-9, 2, -9}, (double[3]){9, 2, -9}, (double[3]){-9, 2, 9}));
  bw_solid_crack *crack = fill_all(pd);
  bw_solid_crack_size size;
  pd_set(pd, part_a_little, NULL);
  bw_check_ok(bw_solid_crack_measure(crack, &size));
  bw_check_near(size.area, area, area * near);
  bw_check_near(size.volume, area * 1e-3, area * near);
  const resultant r = push(pd, crack, 7, up, 2);
  bw_check_near(r.above[1], 7 * area, 100 * area * near);
  bw_check_near(r.above[0], 0, 100 * area * near);
  bw_check_near(r.force[1], 0, 100 * near);
  bw_solid_crack_destroy(&crack);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}

START_TEST(it_acts_on_the_area)
{
  cut_through(BW_PD_PLANE_STRAIN);
  cut_through(BW_PD_3D);
}
END_TEST

/* The same without periods, where turning is allowed: force p A along the turned normal, but for
 * the ends, whose families are cut; momentum and its moment are nothing. */
START_TEST(wide_and_turned)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS);
  pd_body body = pd_box(60, 8, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const double up[3] = {0, 1, 0};
  bw_check_ok(bw_solid_precrack(pd, (double[3]){-1, 2, 0}, (double[3]){99, 2, 0}, NULL));
  bw_solid_crack *crack = fill_all(pd);
  bw_solid_crack_size size;
  const resultant before = push(pd, crack, 1, up, 2);
  pd_set(pd, part_and_turn, NULL);
  const resultant r = push(pd, crack, 1, up, 2);
  bw_check_ok(bw_solid_crack_measure(crack, &size));
  /* Of 60 columns three at either end have lost bonds. */
  bw_check_near(before.above[1], 30, 30 * 0.03);
  bw_check_near(r.above[0], -sin(0.7) * before.above[1], 30 * 0.01);
  bw_check_near(r.above[1], cos(0.7) * before.above[1], 30 * 0.01);
  bw_check_near(size.volume, 2 * size.area, 30 * 0.01);
  for (int d = 0; d < 3; d++) {
    bw_check_near(r.force[d], 0, 1e4 * BW_REAL_EPSILON);
    bw_check_near(r.moment[d], 0, 1e5 * BW_REAL_EPSILON);
  }
  bw_solid_crack_destroy(&crack);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* A cut along a diagonal of the lattice has its true length too. */
START_TEST(a_slanted_cut)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRAIN);
  pd_body body = pd_box(60, 60, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  bw_check_ok(bw_solid_precrack(pd, (double[3]){5, 5, 0}, (double[3]){25, 25, 0}, NULL));
  bw_solid_crack *crack = fill_all(pd);
  bw_solid_crack_size size;
  bw_check_ok(bw_solid_crack_measure(crack, &size));
  bw_check_near(size.area, 20 * sqrt(2), 20 * sqrt(2) * 0.02);
  const resultant r = push(pd, crack, 1, (double[3]){-1, 1, 0}, 0);
  bw_check_near(r.above[1] - r.above[0], sqrt(2) * size.area, 0.02 * size.area);
  bw_solid_crack_destroy(&crack);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* Two cracks in a row: the second is dry until what lies between is cut, and dry again where a
 * restart has mended it. */
START_TEST(what_is_joined)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRAIN);
  pd_body body = pd_box(60, 16, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  uint8_t *bits = NULL;
  bw_solid_crack_size one, both, again;
  bw_check_ok(BW_ALLOCATE(&bits, bw_solid_count(pd) * bw_solid_bits_bytes(pd)));
  bw_check_ok(bw_solid_precrack(pd, (double[3]){2, 4, 0}, (double[3]){10, 4, 0}, NULL));
  bw_check_ok(bw_solid_precrack(pd, (double[3]){18, 4, 0}, (double[3]){26, 4, 0}, NULL));
  bw_solid_crack *crack = fill(pd, (double[3]){0, 0, -9}, (double[3]){11, 9, 9});
  bw_check_ok(bw_solid_crack_measure(crack, &one));
  bw_check_near(one.area, 8, 0.5); /* ends break bonds beside them */
  bw_solid_get_bits(pd, bits);
  bw_check_ok(bw_solid_precrack(pd, (double[3]){10, 4, 0}, (double[3]){18, 4, 0}, NULL));
  bw_check_ok(bw_solid_crack_measure(crack, &both));
  bw_check_near(both.area, 24, 0.5);
  bw_check_ok(bw_solid_set_bits(pd, bits));
  bw_check_ok(bw_solid_crack_measure(crack, &again));
  ck_assert_int_eq(again.bonds, one.bonds);
  bw_solid_crack_destroy(&crack);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  bw_release(&bits);
}
END_TEST

static void steps(bw_solid *pd, bw_solid_crack *crack, int n)
{
  double *F = NULL;
  bw_check_ok(BW_ALLOCATE(&F, 3 * bw_solid_count(pd)));
  for (int q = 0; q < n; q++) {
    memset(F, 0, 3 * bw_solid_count(pd) * sizeof *F);
    bw_check_ok(bw_solid_crack_push(crack, 0.05, F));
    bw_solid_set_force(pd, F);
    bw_check_ok(bw_solid_step(pd, 0.3 * bw_solid_dt_max(pd)));
  }
  bw_release(&F);
}

static bw_solid *pressed(const bw_comm *comm, bw_solid_crack **crack)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRAIN);
  pd_body body = pd_box(40, 40, 1);
  c.G0 = 1e-3;
  bw_solid *pd = pd_make(comm, &c, &body);
  bw_check_ok(bw_solid_precrack(pd, (double[3]){7, 10, 0}, (double[3]){13, 10, 0}, NULL));
  *crack = fill_all(pd);
  pd_body_release(&body);
  return pd;
}

/* The crack runs: the same on any number of ranks and after a restart; work is energy, and the
 * body as a whole stays where it is. */
START_TEST(a_crack_that_runs)
{
  bw_comm *self = pd_alone();
  bw_solid_crack *a, *b, *of_restart;
  bw_solid *many = pressed(bw_check_world(), &a), *one = pressed(self, &b);
  bw_solid *restarted = pressed(bw_check_world(), &of_restart);
  steps(many, a, 60);
  pd_restart_from(many, restarted);
  steps(many, a, 60);
  steps(one, b, 120);
  steps(restarted, of_restart, 60);
  const bw_solid_ledger l = ledger_of(many), alone = ledger_of(one);
  ck_assert_int_gt(l.broken, 20);
  ck_assert_int_eq(l.broken, alone.broken);
  ck_assert_int_eq(l.broken - ledger_of(restarted).broken, 0);
  pd_check_same(many, one, bw_solid_get_position, 1e4 * BW_REAL_EPSILON);
  pd_check_same(many, restarted, bw_solid_get_position, 0);
  bw_check_near(l.kinetic + l.elastic + l.fracture, l.external, 0.02 * l.external);
  for (int d = 0; d < 2; d++)
    bw_check_near(l.momentum[d], 0, 1e4 * BW_REAL_EPSILON);
  bw_solid_crack_destroy(&a);
  bw_solid_crack_destroy(&b);
  bw_solid_crack_destroy(&of_restart);
  bw_solid_destroy(&many);
  bw_solid_destroy(&one);
  bw_solid_destroy(&restarted);
  bw_comm_destroy(&self);
}
END_TEST

START_TEST(refused)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRAIN);
  pd_body body = pd_box(8, 8, 1);
  bool source[64] = {false};
  bw_solid_crack *crack = NULL;
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  ck_assert_int_eq(bw_solid_crack_create(pd, source, &crack), BW_EINPUT);
  bw_solid_destroy(&pd);
  c.disorder = 0.2;
  pd = pd_make(bw_check_world(), &c, &body);
  source[0] = true;
  ck_assert_int_eq(bw_solid_crack_create(pd, source, &crack), BW_EINPUT);
  ck_assert_ptr_null(crack);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(it_acts_on_the_area), BW_TEST(wide_and_turned),
                                      BW_TEST(a_slanted_cut),       BW_TEST(what_is_joined),
                                      BW_TEST(a_crack_that_runs),   BW_TEST(refused)};
BW_CHECK_MAIN("solid_tools.crack_pressure", tests)
