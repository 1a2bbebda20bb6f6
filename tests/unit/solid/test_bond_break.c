/* Breaking: threshold, irreversibility, kinds, pre-cracks; the energy that goes.
 * TEST ranks=1,2,3,4 */
#include "pd_test.h"

static bw_solid *pair(double G0, uint8_t kind)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.G0 = G0;
  pd_body two = pd_box(2, 1, 1);
  two.kind[0] = kind;
  bw_solid *pd = pd_make(bw_check_world(), &c, &two);
  pd_body_release(&two);
  return pd;
}

static double stretch; /* of the pair in the next call of set */

static void pull(const double X0[3], double u[3])
{
  u[0] = X0[0] > 0.5 ? 0.5 * stretch : 0;
}

static int64_t broken_after_step(bw_solid *pd, double s)
{
  stretch = s;
  pd_set(pd, pull, NULL);
  pd_steps(pd, 1, 1e-6);
  return ledger_of(pd).broken;
}

/* s0 = sqrt(5 G0/(6 E delta)) (ERRATA 1): E = 3, delta = 1.5. */
START_TEST(bonds_break_beyond_s0_in_tension_only_and_for_good)
{
  bw_solid *pd = pair(0.002, 0);
  const double s0 = sqrt(5 * 0.002 / (6 * 3 * 1.5));
  bw_check_near(bw_solid_critical_stretch(pd), s0, 1e-12);
  ck_assert_int_eq(broken_after_step(pd, -2 * s0), 0);
  ck_assert_int_eq(broken_after_step(pd, 0.999 * s0), 0);
  bw_solid_enable_breakage(pd, false);
  ck_assert_int_eq(broken_after_step(pd, 1.5 * s0), 0);
  bw_solid_enable_breakage(pd, true);
  ck_assert_int_eq(bw_solid_events(pd), 0);
  const double elastic = ledger_of(pd).elastic;
  ck_assert_double_gt(elastic, 0);
  ck_assert_int_eq(broken_after_step(pd, 1.001 * s0), 1);
  ck_assert_int_eq(broken_after_step(pd, 0), 1);
  ck_assert_int_eq(broken_after_step(pd, 0.5 * s0), 1);
  const bw_solid_ledger l = ledger_of(pd);
  ck_assert_double_eq(l.elastic, 0);
  bw_check_near(l.fracture / elastic, pow(1.001 / 1.5, 2), 1e4 * BW_REAL_EPSILON + 1e-5);
  double damage[2];
  bw_solid_get_damage(pd, damage);
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    ck_assert_double_eq(damage[i], 1);
  int64_t events = bw_solid_events(pd);
  bw_comm_sum_int(bw_check_world(), 1, &events);
  ck_assert_int_eq(events, 2); /* one per side */
  bw_solid_destroy(&pd);
}
END_TEST

START_TEST(unbreakable_at_one_end_is_enough)
{
  bw_solid *pd = pair(0.002, BW_PD_UNBREAKABLE);
  ck_assert_int_eq(broken_after_step(pd, 3 * bw_solid_critical_stretch(pd)), 0);
  bw_solid_destroy(&pd);
  pd = pair(0.002, BW_PD_PRESCRIBED);
  ck_assert_int_eq(broken_after_step(pd, 3 * bw_solid_critical_stretch(pd)), 1);
  bw_check_ok(bw_solid_set_G0(pd, 0.01));
  bw_check_near(bw_solid_critical_stretch(pd), sqrt(5 * 0.01 / (6 * 3 * 1.5)), 1e-12);
  bw_solid_destroy(&pd);
}
END_TEST

/* What breaks holds during the step and is gone from the force of the next. */
START_TEST(bonds_are_checked_at_the_end_of_a_step)
{
  bw_solid *pd = pair(0.002, 0);
  double A[6], V[6];
  stretch = 2 * bw_solid_critical_stretch(pd);
  pd_set(pd, pull, NULL);
  pd_steps(pd, 1, 1e-3);
  pd_gather(pd, bw_solid_get_velocity, V);
  pd_gather(pd, bw_solid_get_acceleration, A);
  ck_assert_double_gt(V[0], 0); /* it pulled */
  ck_assert_double_eq(A[0], 0); /* it does no more */
  pd_steps(pd, 1, 1e-3);
  double later[6];
  pd_gather(pd, bw_solid_get_velocity, later);
  ck_assert_double_eq(later[0], V[0]);
  bw_solid_destroy(&pd);
}
END_TEST

/* Bonds of a plane lattice a x b that go from one side of a line to the other, by enumeration. */
typedef bool (*upper_side)(int x, int y);

static int64_t count_separated(int a, int b, upper_side up)
{
  int64_t n = 0;
  for (int y = 0; y < b; y++)
    for (int x = 0; x < a; x++)
      for (int dy = -3; dy <= 3; dy++)
        for (int dx = -3; dx <= 3; dx++) {
          const int X = x + dx, Y = y + dy;
          if (dx * dx + dy * dy > 12 || X < 0 || Y < 0 || X >= a || Y >= b) continue;
          n += up(x, y) != up(X, Y);
        }
  return n / 2;
}

static bool above_row_3(int x, int y)
{
  return y >= 4 + 0 * x;
}

static bool above_diagonal(int x, int y)
{
  return y > x;
}

static int64_t cut_all(double ax, double ay, double bx, double by, double az)
{
  bw_solid_config c = pd_soft(BW_PD_PLANE_STRESS);
  c.G0 = 1;
  pd_body body = pd_box(12, 9, 1);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const bw_solid_ledger before = ledger_of(pd);
  bw_check_ok(bw_solid_precrack(pd, (double[]){ax, ay, az}, (double[]){bx, by, az}, NULL));
  const bw_solid_ledger after = ledger_of(pd);
  ck_assert_int_eq(after.broken, 0); /* not since the start */
  bw_solid_destroy(&pd);
  pd_body_release(&body);
  return before.bonds - after.bonds;
}

START_TEST(precracks_cut_what_crosses_them)
{
  const int64_t row = count_separated(12, 9, above_row_3);
  ck_assert_int_eq(cut_all(-1, 2, 7, 2, 0), row);       /* between the rows 3 and 4 */
  ck_assert_int_eq(cut_all(7, 2, -1, 2, 0.3), row);     /* the other way round */
  ck_assert_int_eq(cut_all(-1, 2.25, 7, 2.25, 0), row); /* through row 4, which counts above */
  ck_assert_int_eq(cut_all(-1, -0.75, 6.5, 6.75, 0), count_separated(12, 9, above_diagonal));
  ck_assert_int_eq(cut_all(-5, 2, -4, 2, 0), 0);
}
END_TEST

/* A bond crosses the half line left of x = tip where the straight line between the particles
 * does; the rest of the bonds over the line stay. Counted here with the line's equation. */
START_TEST(precracks_end_at_their_tips)
{
  const double tip = 1.99;
  int64_t expected = 0;
  for (int y = 0; y < 9; y++)
    for (int x = 0; x < 12; x++)
      for (int dy = 1; dy <= 3; dy++)
        for (int dx = -3; dx <= 3; dx++) {
          if (dx * dx + dy * dy > 12 || x + dx < 0 || x + dx >= 12 || y > 3 || y + dy < 4 ||
              y + dy >= 9)
            continue;
          const double t = (2 - (y + 0.5) * 0.5) / (0.5 * dy);
          expected += (x + 0.5) * 0.5 + t * dx * 0.5 <= tip;
        }
  ck_assert_int_eq(cut_all(-1, 2, tip, 2, 0), expected);
  ck_assert_int_gt(expected, 0);
}
END_TEST

/* 3D: a square window inside a block; bonds through the plane inside the window only. */
START_TEST(precracks_in_space)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  pd_body body = pd_box(8, 6, 7);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  const int64_t before = ledger_of(pd).bonds;
  const double a[] = {0.9, 0.8, 1.5}, b[] = {2.9, 0.8, 1.5}, d[] = {0.9, 2.1, 1.5};
  bw_check_ok(bw_solid_precrack(pd, a, b, d));
  bw_check_ok(bw_solid_precrack(pd, a, d, b)); /* again: nothing is left */
  int64_t expected = 0;
  for (int64_t q = 0; q < body.n; q++)
    for (int dz = 1; dz <= 3; dz++)
      for (int dy = -3; dy <= 3; dy++)
        for (int dx = -3; dx <= 3; dx++) {
          const int32_t *s = body.site + 3 * q;
          const int X = s[0] + dx, Y = s[1] + dy, Z = s[2] + dz;
          if (dx * dx + dy * dy + dz * dz > 12 || X < 0 || Y < 0 || X > 7 || Y > 5 || Z > 6)
            continue;
          const double t = (3 - (s[2] + 0.5)) / dz;
          const double x = 0.5 * (s[0] + 0.5 + t * dx), y = 0.5 * (s[1] + 0.5 + t * dy);
          expected += s[2] < 3 && Z >= 3 && x >= 0.9 && x <= 2.9 && y >= 0.8 && y <= 2.1;
        }
  ck_assert_int_eq(before - ledger_of(pd).bonds, expected);
  bw_check_status(bw_solid_precrack(pd, a, b, NULL), BW_EINPUT);
  bw_check_status(bw_solid_precrack(pd, a, a, d), BW_EINPUT);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

/* A body torn apart keeps its energy in the book; the work of breaking never is negative. */
static void burst(const double X0[3], double v[3])
{
  v[0] = 0.4 * (X0[0] - 1.5) + 0.02 * sin(9 * X0[1]);
  v[1] = 0.3 * (X0[1] - 1.25);
  v[2] = 0;
}

START_TEST(fracture_energy_is_booked)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.G0 = 0.005;
  pd_body body = pd_box(6, 5, 4);
  bw_solid *pd = pd_make(bw_check_world(), &c, &body);
  pd_set(pd, NULL, burst);
  const double start = pd_energy(pd), dt = 0.02 * bw_solid_dt_max(pd);
  const bw_solid_ledger first = ledger_of(pd);
  double fracture = 0;
  for (int q = 0; q < 400; q++) {
    pd_steps(pd, 1, dt);
    const double now = ledger_of(pd).fracture;
    ck_assert_double_ge(now, fracture);
    fracture = now;
  }
  const bw_solid_ledger l = ledger_of(pd);
  ck_assert_int_gt(l.broken, 100);
  /* Verlet's own error, (w dt)^2/8 = 2e-4 of the elastic energy, and as much per broken bond */
  bw_check_near(pd_energy(pd) / start, 1, 1e-3);
  for (int k = 0; k < 3; k++)
    bw_check_near(l.momentum[k], first.momentum[k], 1e4 * BW_REAL_EPSILON);
  bw_solid_destroy(&pd);
  pd_body_release(&body);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(bonds_break_beyond_s0_in_tension_only_and_for_good),
                                      BW_TEST(unbreakable_at_one_end_is_enough),
                                      BW_TEST(bonds_are_checked_at_the_end_of_a_step),
                                      BW_TEST(precracks_cut_what_crosses_them),
                                      BW_TEST(precracks_end_at_their_tips),
                                      BW_TEST(precracks_in_space),
                                      BW_TEST(fracture_energy_is_booked)};
BW_CHECK_MAIN("pd_bond.break", tests)
