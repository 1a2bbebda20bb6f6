/* Normal probes: exact tractions of linear fields, signs, order at a curved profile, flags.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_probe.h"

#include <string.h>

enum { POINTS = 60 };
static const double RHO = 2.5, NU = 0.3;
static const double ROUND_OFF = 1000.0 * BW_REAL_EPSILON; /* gradients divide by h ~ 0.3 */

typedef struct {
  bw_grid *grid;
  const bw_grid_view *g;
  bw_real *u[3], *p;
  bw_probe *probe;
} fixture;

typedef double (*field_fn)(int c, const double x[3]); /* c = 0..2 velocity, 3 pressure/density */

static void make(fixture *f, const bw_comm *comm, const int n[3], double h, bool periodic,
                 bw_probe_profile profile)
{
  bw_grid_config grid = bw_grid_config_default();
  bw_probe_config probe = bw_probe_config_default();
  *f = (fixture){.grid = NULL};
  for (int d = 0; d < 3; d++) {
    grid.n[d] = n[d];
    grid.length[d] = n[d] * h;
    grid.periodic[d] = periodic;
  }
  grid.halo = 2;
  probe.rho = RHO, probe.nu = NU, probe.profile = profile;
  bw_check_ok(bw_grid_create(comm, &grid, &f->grid));
  f->g = bw_grid_look(f->grid);
  for (int d = 0; d < (n[2] == 1 ? 2 : 3); d++)
    bw_check_ok(bw_field_create(f->grid, &f->u[d]));
  bw_check_ok(bw_field_create(f->grid, &f->p));
  bw_check_ok(bw_probe_create(f->grid, &probe, &f->probe));
}

static void drop(fixture *f)
{
  bw_probe_destroy(&f->probe);
  for (int d = 0; d < 3; d++)
    bw_release(&f->u[d]);
  bw_release(&f->p);
  bw_grid_destroy(&f->grid);
}

/* Ghosts included. */
static void fill(const fixture *f, field_fn function)
{
  const bw_grid_view *g = f->g;
  for (int c = 0; c < 4; c++) {
    bw_real *a = c == 3 ? f->p : f->u[c];
    for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2] && a != NULL; k++)
      for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
        for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++) {
          const int cell[3] = {i, j, k};
          double x[3];
          for (int d = 0; d < 3; d++)
            x[d] = (cell[d] + g->lo[d] - (c == d ? 0.0 : 0.5)) * g->spacing[d];
          a[bw_at(g, i, j, k)] = (bw_real)function(c, x);
        }
  }
}

/* In [0, 1), from the key alone. */
static double number(unsigned key)
{
  unsigned z = key * 2654435761u + 12345u;
  z = (z ^ (z >> 15)) * 2246822519u;
  z = (z ^ (z >> 13)) * 3266489917u;
  return (double)((z ^ (z >> 16)) & 0xFFFFFFu) / 16777216.0;
}

/* Point q with its normal, `margin` cells inside the box; z normal zero in 2D. */
static void scatter(const fixture *f, unsigned q, double margin, double x[3], double n[3])
{
  const double polar = f->u[2] == NULL ? 0.0 : 2.0 * number(8 * q) - 1.0;
  const double angle = 6.283185307179586 * number(8 * q + 1);
  n[0] = sqrt(1.0 - polar * polar) * cos(angle);
  n[1] = sqrt(1.0 - polar * polar) * sin(angle);
  n[2] = polar;
  for (unsigned d = 0; d < 3; d++) {
    const double edge = margin * f->g->spacing[d];
    x[d] = edge + (f->g->length[d] - 2.0 * edge) * number(8 * q + 2 + d);
  }
}

static const double G[3][3] = {{0.7, -0.2, 0.4}, {0.1, -0.9, -0.6}, {-0.8, 0.3, 0.2}};
static const double GRAD_P[3] = {0.6, -1.1, 0.9};

static double linear(int c, const double x[3])
{
  const double *a = c == 3 ? GRAD_P : G[c];
  return 0.4 * (c - 1) + a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
}

/* In 2D nothing depends on z. */
static double linear_flat(int c, const double x[3])
{
  const double y[3] = {x[0], x[1], 0.0};
  return linear(c, y);
}

/* t = -p n + mu (G + G^T) n with p the wall's, when DU/Dt = -grad p/rho; else p is off by
 * dl/2 times the difference of the two slopes. */
static void expected(bool flat, const double X[3], const double n[3], const double A[3], double dl,
                     double t[3])
{
  const int dims = flat ? 2 : 3;
  double p = (flat ? linear_flat : linear)(3, X), error = 0.0;
  for (int d = 0; d < dims; d++)
    error += (GRAD_P[d] + A[d]) * n[d];
  p += 0.5 * dl * error;
  for (int c = 0; c < 3; c++) {
    t[c] = -RHO * p * n[c];
    for (int d = 0; d < dims && c < dims; d++)
      t[c] += RHO * NU * (G[c][d] + G[d][c]) * n[d];
  }
}

START_TEST(linear_fields_give_exact_tractions)
{
  static const int sizes[2][3] = {{14, 12, 10}, {14, 12, 1}};
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  for (int t = 0; t < 4; t++) {
    const bool flat = t % 2 == 1, quadratic = t >= 2;
    double X[POINTS][3], N[POINTS][3], A[POINTS][3], V[POINTS][3], got[POINTS][3], want[3];
    unsigned char flag[POINTS];
    fixture f;
    make(&f, comm, sizes[flat], 0.3, false, quadratic ? BW_PROBE_QUADRATIC : BW_PROBE_LINEAR);
    fill(&f, flat ? linear_flat : linear);
    for (unsigned q = 0; q < POINTS; q++) {
      scatter(&f, q + 1000u * (unsigned)me, 2.5, X[q], N[q]);
      for (int c = 0; c < 3; c++) { /* half the points: DU/Dt = -grad p/rho */
        A[q][c] = quadratic || q % 2 == 0 ? -GRAD_P[c] : 0.3 * c + 0.1;
        V[q][c] = (flat ? linear_flat : linear)(c, X[q]);
      }
    }
    bw_check_ok(bw_probe_set_points(f.probe, POINTS, X[0], N[0]));
    bw_probe_set_velocity(f.probe, V[0]);
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

/* Over the plane distance = 0: u = (3 eta - 2 eta^2) along the wall + 0.5; dp/dn = 0.7 there. */
static double slanted(int c, const double x[3])
{
  const double eta = distance(x);
  if (c == 3) return 2.0 + 0.7 * eta - 1.1 * eta * eta;
  return 0.5 + (3.0 * eta - 2.0 * eta * eta) * SLIDE[c];
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
    bw_probe_set_velocity(f.probe, V);
    bw_probe_traction(f.probe, f.u, f.p, A, t, &flag);
    ck_assert_int_eq(flag, BW_PROBE_FREE);
    for (int c = 0; c < 3; c++)
      bw_check_near(t[c], RHO * (-2.0 * SLANT[c] + NU * 3.0 * SLIDE[c]), 5.0 * ROUND_OFF);
  }
  drop(&f);
}
END_TEST

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
      bw_probe_set_velocity(f.probe, V);
      bw_probe_traction(f.probe, f.u, f.p, NULL, t, NULL);
      for (int c = 0; c < 2; c++)
        bw_check_near(t[c], 0.0, ROUND_OFF);
    }
    drop(&f);
  }
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

/* Looking at a wall of the box from d cells: the stencil ends half a cell beyond the tip, so
 * dl = 2 h needs 2.5 cells and dl = h needs 1.5. */
START_TEST(box_sides_shorten_and_block)
{
  static const int n[3] = {10, 12, 8};
  static const struct {
    double distance;
    unsigned char flag;
  } row[] = {{2.6, BW_PROBE_FREE},
             {2.4, BW_PROBE_SHORTENED},
             {1.6, BW_PROBE_SHORTENED},
             {1.4, BW_PROBE_BLOCKED},
             {0.5, BW_PROBE_BLOCKED}};
  fixture f;
  make(&f, bw_check_world(), n, 0.3, false, BW_PROBE_LINEAR);
  fill(&f, linear);
  for (int d = 0; d < 3; d++)
    for (int q = 0; q < 5; q++) {
      double X[3] = {1.5, 1.7, 1.2}, N[3] = {0.0, 0.0, 0.0}, A[3], t[3], want[3];
      unsigned char flag = 99;
      N[d] = 1.0;
      X[d] = f.g->length[d] - row[q].distance * 0.3;
      for (int c = 0; c < 3; c++)
        A[c] = -GRAD_P[c];
      bw_check_ok(bw_probe_set_points(f.probe, 1, X, N));
      bw_probe_traction(f.probe, f.u, f.p, A, t, &flag);
      ck_assert_int_eq(flag, row[q].flag);
      expected(false, X, N, A, 0.6, want);
      for (int c = 0; c < 3; c++)
        bw_check_near(t[c], flag == BW_PROBE_BLOCKED ? 0.0 : want[c], ROUND_OFF);
    }
  drop(&f);
}
END_TEST

/* Another solid fills x > 1.8; a point looks at it across a gap. */
START_TEST(obstacles_shorten_and_block)
{
  static const int n[3] = {12, 12, 8};
  static const struct {
    double gap;
    unsigned char flag;
  } row[] = {{3.0, BW_PROBE_FREE},
             {2.2, BW_PROBE_FREE},
             {1.8, BW_PROBE_SHORTENED},
             {1.2, BW_PROBE_SHORTENED},
             {0.8, BW_PROBE_BLOCKED}};
  fixture f;
  bw_real *solid = NULL;
  make(&f, bw_check_world(), n, 0.3, true, BW_PROBE_LINEAR);
  bw_check_ok(bw_field_create(f.grid, &solid));
  for (int k = 1; k <= f.g->m[2]; k++)
    for (int j = 1; j <= f.g->m[1]; j++)
      for (int i = 7; i <= 10; i++)
        solid[bw_at(f.g, i, j, k)] = 1;
  bw_halo_update(f.grid, 1, &solid);
  double X[5][3], N[5][3], t[5][3];
  unsigned char flag[5];
  for (int q = 0; q < 5; q++) {
    memcpy(X[q], (double[3]){1.8 - 0.3 * row[q].gap, 0.7 * q, 0.5 * q}, sizeof X[q]);
    memcpy(N[q], (double[3]){1.0, 0.0, 0.0}, sizeof N[q]);
  }
  for (int there = 1; there >= 0; there--) {
    bw_probe_set_obstacles(f.probe, there ? solid : NULL);
    bw_check_ok(bw_probe_set_points(f.probe, 5, X[0], N[0]));
    bw_probe_traction(f.probe, f.u, f.p, NULL, t[0], flag);
    for (int q = 0; q < 5; q++)
      ck_assert_int_eq(flag[q], there ? row[q].flag : BW_PROBE_FREE);
  }
  bw_release(&solid);
  drop(&f);
}
END_TEST

START_TEST(bad_input_is_refused_on_all_ranks)
{
  static const int n[3] = {8, 8, 8};
  const bw_comm *comm = bw_check_world();
  const bool last = bw_comm_rank(comm) == bw_comm_size(comm) - 1;
  fixture f;
  make(&f, comm, n, 0.3, true, BW_PROBE_LINEAR);
  double X[3] = {1.0, 1.0, 1.0}, N[3] = {0.0, last ? 1.1 : 1.0, 0.0};
  bw_check_status(bw_probe_set_points(f.probe, 1, X, N), BW_EINPUT);
  N[1] = 1.0;
  X[0] = last ? NAN : 1.0;
  bw_check_status(bw_probe_set_points(f.probe, 1, X, N), BW_EINPUT);
  X[0] = 1.0;
  bw_check_ok(bw_probe_set_points(f.probe, last ? 1 : 0, X, N));

  bw_probe *probe = NULL;
  bw_probe_config c = bw_probe_config_default();
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT); /* rho is required */
  c.rho = 1.0;
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT); /* nu is required */
  c.nu = 1.0;
  c.kernel = BW_KERNEL_PESKIN4; /* reaches beyond the halo */
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT);
  c.kernel = BW_KERNEL_HAT2;
  c.length = 0.5;
  bw_check_status(bw_probe_create(f.grid, &c, &probe), BW_EINPUT);
  c.length = 1.5;
  bw_check_ok(bw_probe_create(f.grid, &c, &probe));
  bw_probe_destroy(&probe);
  drop(&f);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(linear_fields_give_exact_tractions),
                                      BW_TEST(signs_are_physical),
                                      BW_TEST(wall_shear_of_a_parabola_is_exact_to_its_order),
                                      BW_TEST(parabolas_over_a_slanted_wall_are_exact),
                                      BW_TEST(rigid_rotation_feels_no_shear),
                                      BW_TEST(the_answer_does_not_depend_on_ranks),
                                      BW_TEST(box_sides_shorten_and_block),
                                      BW_TEST(obstacles_shorten_and_block),
                                      BW_TEST(bad_input_is_refused_on_all_ranks)};
BW_CHECK_MAIN("probe", tests)
