/* Normal probes: exact tractions of linear fields, signs, order at a curved profile.
 * TEST ranks=1,2,3,4 */
#include "probe_test.h"

/* How a surface turns whose points follow the linear field: dn/dt = -(G^T n) less its part along
 * n = spin x n. */
static void spin_of_linear(bool flat, const double n[3], double spin[3])
{
  const int dims = flat ? 2 : 3;
  double g[3] = {0.0, 0.0, 0.0};
  for (int c = 0; c < dims; c++)
    for (int d = 0; d < dims; d++)
      g[d] += G[c][d] * n[c];
  for (int c = 0; c < 3; c++)
    spin[c] = g[(c + 1) % 3] * n[(c + 2) % 3] - g[(c + 2) % 3] * n[(c + 1) % 3];
}

START_TEST(linear_fields_give_exact_tractions)
{
  static const int sizes[2][3] = {{14, 12, 10}, {14, 12, 1}};
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  for (int t = 0; t < 4; t++) {
    const bool flat = t % 2 == 1, quadratic = t >= 2;
    double X[POINTS][3], N[POINTS][3], A[POINTS][3], V[POINTS][3], W[POINTS][3], got[POINTS][3],
        want[3];
    unsigned char flag[POINTS];
    fixture f;
    make(&f, comm, sizes[flat], 0.3, false, quadratic ? BW_PROBE_QUADRATIC : BW_PROBE_LINEAR);
    fill(&f, flat ? linear_flat : linear);
    for (unsigned q = 0; q < POINTS; q++) {
      scatter(&f, q + 1000u * (unsigned)me, 2.5, X[q], N[q]);
      spin_of_linear(flat, N[q], W[q]);
      for (int c = 0; c < 3; c++) { /* half the points: DU/Dt = -grad p/rho */
        A[q][c] = quadratic || q % 2 == 0 ? -GRAD_P[c] : 0.3 * c + 0.1;
        V[q][c] = (flat ? linear_flat : linear)(c, X[q]);
      }
    }
    bw_check_ok(bw_probe_set_points(f.probe, POINTS, X[0], N[0]));
    bw_probe_set_velocity(f.probe, V[0], W[0]);
    bw_probe_traction(f.probe, f.u, f.p, A[0], got[0], flag);
    for (int q = 0; q < POINTS; q++) {
      expected(flat, X[q], N[q], A[q], 0.6, want);
      ck_assert_int_eq(flag[q], BW_PROBE_FREE);
      for (int c = 0; c < (flat ? 2 : 3); c++)
        bw_check_near(got[q][c], want[c], ROUND_OFF);
    }
    drop(&f);
  }
}
END_TEST

static double pushing(int c, const double x[3])
{
  (void)x;
  return c == 3 ? 1.5 : 0.0;
}
static double shearing(int c, const double x[3])
{
  return c == 0 ? 2.0 * x[1] : 0.0;
}
static double resting(int c, const double x[3])
{
  (void)c, (void)x;
  return 0.0;
}

/* By hand: pressure pushes against n; fluid sliding along +x above a floor (n = +y) drags it
 * along +x; a surface that accelerates into the fluid feels it resist. */
START_TEST(signs_are_physical)
{
  static const struct {
    field_fn field;
    double A[3], t[3];
  } row[] = {{pushing, {0, 0, 0}, {0.0, -2.5 * 1.5, 0.0}},
             {shearing, {0, 0, 0}, {2.5 * 0.3 * 2.0, 0.0, 0.0}},
             {resting, {0, 4.0, 0}, {0.0, -2.5 * 4.0 * 0.5 * 0.5, 0.0}}}; /* dl/2 = h = 0.25 */
  static const int n[3] = {8, 8, 8};
  const bw_comm *comm = bw_check_world();
  for (int q = 0; q < 3; q++) {
    const double X[3] = {1.03, 0.71, 0.9}, N[3] = {0.0, 1.0, 0.0};
    double t[3] = {0.0, 0.0, 0.0};
    const size_t mine = bw_comm_rank(comm) == bw_comm_size(comm) - 1 ? 1 : 0;
    fixture f;
    make(&f, comm, n, 0.25, false, BW_PROBE_LINEAR);
    fill(&f, row[q].field);
    bw_check_ok(bw_probe_set_points(f.probe, mine, X, N));
    bw_probe_traction(f.probe, f.u, f.p, row[q].A, t, NULL);
    for (int c = 0; c < 3 && mine > 0; c++)
      bw_check_near(t[c], row[q].t[c], ROUND_OFF);
    drop(&f);
  }
}
END_TEST

static double parabola(int c, const double x[3])
{
  return c == 0 ? x[1] * (4.0 - x[1]) : 0.0;
}

/* Wall shear of u = y (4 - y) over the floor y = 0 seen from points on it: du/dy = 4. A central
 * difference over h is exact for a parabola and the kernel adds the same second moment at both
 * ends, so the slope at the tip is 4 - 2 dl: the linear profile errs by 2 dl = 4 h. The quadratic
 * one is exact, for walls at any angle too (next test). */
START_TEST(wall_shear_of_a_parabola_is_exact_to_its_order)
{
  for (int refine = 0; refine < 2; refine++)
    for (int profile = 0; profile < 2; profile++) {
      const int cells = 8 << refine, n[3] = {cells, cells, 1};
      const double h = 4.0 / cells, N[3] = {0.0, 1.0, 0.0};
      fixture f;
      make(&f, bw_check_world(), n, h, false, (bw_probe_profile)profile);
      fill(&f, parabola);
      for (int q = 0; q <= 10; q++) {
        const double X[3] = {1.0 + 0.1 * h * q, 0.0, 0.1};
        double t[3];
        bw_check_ok(bw_probe_set_points(f.probe, 1, X, N));
        bw_probe_traction(f.probe, f.u, f.p, NULL, t, NULL);
        const double error = t[0] / (RHO * NU) - 4.0;
        if (profile == BW_PROBE_LINEAR)
          bw_check_near(error, -4.0 * h, ROUND_OFF / h);
        else
          bw_check_near(error, 0.0, ROUND_OFF / h);
      }
      drop(&f);
    }
}
END_TEST

static const double SLANT[3] = {0.48, 0.64, 0.6}; /* a unit normal */
static const double SLIDE[3] = {0.8, -0.6, 0.0};  /* a direction along the wall */

static double distance(const double x[3])
{
  return SLANT[0] * x[0] + SLANT[1] * x[1] + SLANT[2] * x[2] - 1.5;
}

static const double BEND = 1.5; /* eta^2 of the velocity along n: nu u_n'' = 2 nu BEND */

/* Over the plane distance = 0: u = (3 eta - 2 eta^2) along the wall + BEND eta^2 along n + 0.5;
 * dp/dn there is what holds against the wall's acceleration of 0.7 and what the bend pulls. */
static double slanted(int c, const double x[3])
{
  const double eta = distance(x);
  if (c == 3) return 2.0 + (0.7 + 2.0 * NU * BEND) * eta - 1.1 * eta * eta;
  return 0.5 + (3.0 * eta - 2.0 * eta * eta) * SLIDE[c] + BEND * eta * eta * SLANT[c];
}

START_TEST(parabolas_over_a_slanted_wall_are_exact)
{
  static const int n[3] = {14, 12, 10};
  fixture f;
  make(&f, bw_check_world(), n, 0.3, false, BW_PROBE_QUADRATIC);
  fill(&f, slanted);
  for (int q = 0; q < 10; q++) {
    const double V[3] = {0.5, 0.5, 0.5}, A[3] = {-0.7 * SLANT[0], -0.7 * SLANT[1], -0.7 * SLANT[2]};
    double X[3] = {0.9 + 0.05 * q, 0.8 - 0.03 * q, 0.0}, t[3];
    unsigned char flag;
    X[2] = -distance(X) / SLANT[2];
    bw_check_ok(bw_probe_set_points(f.probe, 1, X, SLANT));
    bw_probe_set_velocity(f.probe, V, NULL);
    bw_probe_traction(f.probe, f.u, f.p, A, t, &flag);
    ck_assert_int_eq(flag, BW_PROBE_FREE);
    for (int c = 0; c < 3; c++)
      bw_check_near(t[c], RHO * (-2.0 * SLANT[c] + NU * 3.0 * SLIDE[c]), 5.0 * ROUND_OFF);
  }
  drop(&f);
}
END_TEST

static const double SPIN[3] = {0.0, 0.0, 1.3};
static double spinning(int c, const double x[3])
{
  return c == 0 ? -1.3 * x[1] : c == 1 ? 1.3 * x[0] : 0.0;
}

/* Fluid and surface turning together as one rigid body: no viscous traction. */
START_TEST(rigid_rotation_feels_no_shear)
{
  static const int n[3] = {12, 12, 1};
  for (int profile = 0; profile < 2; profile++) {
    fixture f;
    make(&f, bw_check_world(), n, 0.3, false, (bw_probe_profile)profile);
    fill(&f, spinning);
    for (unsigned q = 0; q < 20; q++) {
      double X[3], N[3], V[3], t[3];
      scatter(&f, q, 2.5, X, N);
      for (int c = 0; c < 3; c++)
        V[c] = spinning(c, X);
      bw_check_ok(bw_probe_set_points(f.probe, 1, X, N));
      bw_probe_set_velocity(f.probe, V, SPIN);
      bw_probe_traction(f.probe, f.u, f.p, NULL, t, NULL);
      for (int c = 0; c < 2; c++)
        bw_check_near(t[c], 0.0, ROUND_OFF);
    }
    drop(&f);
  }
}
END_TEST

/* u = -y q, v = x q with q = (r - R)/r: nothing at r = R, du/dr = 1 there. */
enum { AROUND = 24 };
static const double RADIUS = 1.0, MIDDLE = 2.0;
static double around(int c, const double x[3])
{
  const double y[2] = {x[0] - MIDDLE, x[1] - MIDDLE}, r = hypot(y[0], y[1]);
  return c == 0 ? -y[1] * (r - RADIUS) / r : c == 1 ? y[0] * (r - RADIUS) / r : 0.0;
}

/* Flow around a curved wall at rest, u = r - R: the shear is mu, whatever the curvature. What the
 * profile leaves is second order in h; the gradient along the wall read at the tip would miss
 * u(tip)/r = 2 h/R of it, and the kernel's second moment at the tip h/(6 R). */
START_TEST(curved_walls_cost_no_order)
{
  double worst[2] = {0.0, 0.0};
  for (int refine = 0; refine < 2; refine++) {
    const int cells = 60 << refine, n[3] = {cells, cells, 1};
    const double h = 2.0 * MIDDLE / cells;
    fixture f;
    make(&f, bw_check_world(), n, h, false, BW_PROBE_QUADRATIC);
    fill(&f, around);
    for (int q = 0; q < AROUND; q++) {
      const double angle = 6.283185307179586 * q / AROUND;
      const double N[3] = {cos(angle), sin(angle), 0.0};
      const double X[3] = {MIDDLE + RADIUS * N[0], MIDDLE + RADIUS * N[1], 0.5 * h};
      double t[3];
      bw_check_ok(bw_probe_set_points(f.probe, 1, X, N));
      bw_probe_traction(f.probe, f.u, f.p, NULL, t, NULL);
      const double shear = (N[0] * t[1] - N[1] * t[0]) / (RHO * NU);
      worst[refine] = fmax(worst[refine], fabs(shear - 1.0));
    }
    ck_assert_double_le(worst[refine], h * h);
    drop(&f);
  }
  ck_assert_double_ge(worst[0], 3.0 * worst[1]); /* 4 when it is second order */
}
END_TEST

static void wavy_fields(const fixture *f)
{
  const bw_grid_view *g = f->g;
  bw_real *all[4] = {f->u[0], f->u[1], f->u[2], f->p};
  for (unsigned c = 0; c < 4; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int id = ((k + g->lo[2]) * g->n[1] + j + g->lo[1]) * g->n[0] + i;
          all[c][bw_at(g, i, j, k)] = (bw_real)number(4u * (unsigned)id + c);
        }
  bw_halo_update(f->grid, 4, all);
}

/* All ranks together against this rank alone; points on and beyond the periodic seams too. */
START_TEST(the_answer_does_not_depend_on_ranks)
{
  static const int n[3] = {10, 12, 8};
  bw_comm *self = NULL;
  fixture all, one;
  double X[POINTS][3], N[POINTS][3], t_all[POINTS][3], t_one[POINTS][3];
  bw_check_ok(bw_comm_self(&self));
  make(&all, bw_check_world(), n, 0.3, true, BW_PROBE_QUADRATIC);
  make(&one, self, n, 0.3, true, BW_PROBE_QUADRATIC);
  wavy_fields(&all);
  wavy_fields(&one);
  for (unsigned q = 0; q < POINTS; q++) {
    scatter(&all, q + 7u * (unsigned)bw_comm_rank(bw_check_world()), -3.0, X[q], N[q]);
    if (q % 7 == 0) X[q][q % 3] = 0.0;
  }
  bw_check_ok(bw_probe_set_points(all.probe, POINTS, X[0], N[0]));
  bw_check_ok(bw_probe_set_points(one.probe, POINTS, X[0], N[0]));
  bw_probe_traction(all.probe, all.u, all.p, NULL, t_all[0], NULL);
  bw_probe_traction(one.probe, one.u, one.p, NULL, t_one[0], NULL);
  for (int q = 0; q < POINTS; q++)
    for (int c = 0; c < 3; c++)
      bw_check_near(t_all[q][c], t_one[q][c], ROUND_OFF);
  drop(&all);
  drop(&one);
  bw_comm_destroy(&self);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(linear_fields_give_exact_tractions),
                                      BW_TEST(signs_are_physical),
                                      BW_TEST(wall_shear_of_a_parabola_is_exact_to_its_order),
                                      BW_TEST(parabolas_over_a_slanted_wall_are_exact),
                                      BW_TEST(rigid_rotation_feels_no_shear),
                                      BW_TEST(curved_walls_cost_no_order),
                                      BW_TEST(the_answer_does_not_depend_on_ranks)};
BW_CHECK_MAIN("probe", tests)
