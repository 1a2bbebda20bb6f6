/* Films against lubrication theory, what keeps momentum and energy, what is refused.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_film.h"

#include <math.h>

/* ---- faces ---- */

/* A ball or a disc. */
typedef struct {
  double centre[3], radius;
  bool planar;
} ball;

static double of_ball(const void *context, const double x[3])
{
  const ball *b = context;
  double r2 = 0.0;
  for (int d = 0; d < (b->planar ? 2 : 3); d++)
    r2 += (x[d] - b->centre[d]) * (x[d] - b->centre[d]);
  return sqrt(r2) - b->radius;
}

/* A block [-half, half] in x (and z), below or above a height. */
typedef struct {
  double half, height;
  bool above, planar;
} block;

static double of_block(const void *context, const double x[3])
{
  const block *b = context;
  const double up = b->above ? b->height - x[1] : x[1] - b->height;
  double out[3] = {fabs(x[0]) - b->half, up, b->planar ? -HUGE_VAL : fabs(x[2]) - b->half};
  const double most = fmax(out[0], fmax(out[1], out[2]));
  if (most <= 0.0) return most;
  double r2 = 0.0;
  for (int d = 0; d < 3; d++)
    r2 += out[d] > 0.0 ? out[d] * out[d] : 0.0;
  return sqrt(r2);
}

static const double MU = 0.7, DEPTH = 2.0;

static bw_film *make(bool planar, double limit, int cells)
{
  bw_film_config c = bw_film_config_default();
  bw_film *f = NULL;
  c.mu = MU, c.limit = limit, c.roughness = 1e-6 * limit, c.planar = planar, c.depth = DEPTH;
  c.cells = cells;
  bw_check_ok(bw_film_create(&c, &f));
  return f;
}

static void place(bw_film *f, const bw_film_face *a, const bw_film_face *b, const double x[3])
{
  ck_assert(bw_film_place(f, a, b, x));
}

/* Plates of length L in the plane, squeezed: mu V L^3/h^3 per depth. Slid: mu U L/h. The same with
 * what the grid carries taken off: nothing at the limit. */
START_TEST(plates)
{
  const double L = 2.0, h = 0.03, limit = 0.1;
  bw_film *f = make(true, limit, 48);
  const block low = {0.5 * L, 0.0, false, true}, high = {0.5 * L, h, true, true};
  const block there = {0.5 * L, limit * (1.0 - 1e-9), true, true};
  const bw_film_face a = {of_block, &low}, b = {of_block, &high}, c = {of_block, &there};
  double D[6][6];
  place(f, &a, &b, (double[3]){0.1, 0.01, 0.0});
  bw_check_ok(bw_film_resistance(f, false, D));
  bw_check_near(bw_film_look(f).gap, h, 1e-8);
  bw_check_near(bw_film_look(f).area, L * DEPTH, 1e-6);
  /* Cells of finite size: 1/(2 n^2). */
  bw_check_near(D[1][1], DEPTH * MU * pow(L / h, 3), 5e-4 * DEPTH * MU * pow(L / h, 3));
  bw_check_near(D[0][0], DEPTH * MU * L / h, 1e-5 * DEPTH * MU * L / h);
  bw_check_ok(bw_film_resistance(f, true, D));
  const double lacks = DEPTH * MU * (pow(L / h, 3) - pow(L / limit, 3));
  bw_check_near(D[1][1], lacks, 5e-4 * lacks);
  place(f, &a, &c, (double[3]){0.1, 0.01, 0.0});
  bw_check_ok(bw_film_resistance(f, true, D));
  bw_check_near(D[1][1], 0.0, 1e-6 * DEPTH * MU * pow(L / limit, 3));
  ck_assert(!bw_film_place(f, &a, &(bw_film_face){of_block, &(block){1.0, 0.11, true, true}},
                           (double[3]){0.1, 0.01, 0.0}));
  bw_film_destroy(&f);
}
END_TEST

/* A cylinder towards a plate, in the plane: 3 sqrt(2) pi mu V (R/h)^(3/2) (G. B. Jeffery, Proc. R.
 * Soc. A 101 (1922) 169, near contact), a sphere 6 pi mu V R^2/h (H. Brenner, Chem. Eng. Sci. 16
 * (1961) 242, the same), two spheres with R^2/4 in place of R^2; errors of the next order are part
 * of h/R. */
START_TEST(round_bodies)
{
  const double pi = acos(-1.0), R = 1.0;
  for (int q = 0; q < 3; q++) {
    const double h = 2e-3 * pow(2.5, q);
    double D[6][6];
    bw_film *line = make(true, 40.0 * h, 96), *patch = make(false, 40.0 * h, 96);
    const block floor2 = {99.0, 0.0, false, true}, floor3 = {99.0, 0.0, false, false};
    const ball disc = {{0.3, R + h, 0.0}, R, true}, sphere = {{0.3, R + h, 0.2}, R, false};
    const ball below = {{0.3, -R, 0.2}, R, false};
    const bw_film_face a = {of_block, &floor2}, b = {of_ball, &disc}, c = {of_block, &floor3};
    const bw_film_face d = {of_ball, &sphere}, e = {of_ball, &below};
    const double start[3] = {0.2, 0.1, 0.1};
    place(line, &a, &b, start);
    bw_check_near(bw_film_look(line).gap, h, 1e-7);
    bw_check_near(bw_film_look(line).origin[0], 0.3, 1e-5);
    bw_check_ok(bw_film_resistance(line, false, D));
    const double cylinder = 3.0 * sqrt(2.0) * pi * DEPTH * MU * pow(R / h, 1.5);
    bw_check_near(D[1][1], cylinder, 0.04 * cylinder);
    place(patch, &c, &d, start);
    bw_check_ok(bw_film_resistance(patch, false, D));
    const double wall = 6.0 * pi * MU * R * R / h;
    bw_check_near(D[1][1], wall, 0.06 * wall);
    place(patch, &e, &d, start);
    bw_check_ok(bw_film_resistance(patch, false, D));
    bw_check_near(D[1][1], 0.25 * wall, 0.06 * 0.25 * wall);
    bw_film_destroy(&line);
    bw_film_destroy(&patch);
  }
}
END_TEST

/* Two spheres askew: the resistance is symmetric and takes energy whatever they do; so does what
 * the grid lacks. */
START_TEST(symmetric_and_positive)
{
  bw_film *f = make(false, 0.2, 32);
  const ball one = {{0.0, 0.0, 0.0}, 1.0, false}, other = {{1.1, 0.9, 0.7}, 0.55, false};
  const bw_film_face a = {of_ball, &one}, b = {of_ball, &other};
  double D[6][6];
  place(f, &a, &b, (double[3]){1.0, 0.5, 0.5});
  for (int lacking = 0; lacking < 2; lacking++) {
    bw_check_ok(bw_film_resistance(f, lacking == 1, D));
    for (int i = 0; i < 6; i++)
      for (int j = 0; j < 6; j++)
        bw_check_near(D[i][j], D[j][i], 1e-6 * (D[i][i] + D[j][j]));
    for (int q = 0; q < 20; q++) {
      double twist[6], power = 0.0;
      for (int i = 0; i < 6; i++)
        twist[i] = sin(1.7 * q + 2.3 * i);
      for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
          power += twist[i] * D[i][j] * twist[j];
      ck_assert_double_gt(power, 0.0);
    }
  }
  bw_film_destroy(&f);
}
END_TEST

static double rising(const void *context, const double x[3])
{
  return *(const double *)context * x[0];
}

/* Cubic law: a pressure that falls by G per length drives h^3 G/(12 mu) through a slit; its faces
 * feel the mean pressure, which is nothing. */
START_TEST(cubic_law)
{
  const double L = 2.0, h = 0.05, G = -3.0;
  bw_film *f = make(true, 0.2, 48);
  const block low = {0.5 * L, 0.0, false, true}, high = {0.5 * L, h, true, true};
  const bw_film_face a = {of_block, &low}, b = {of_block, &high};
  double wrench[6], flux[2];
  place(f, &a, &b, (double[3]){0.1, 0.01, 0.0});
  bw_check_ok(bw_film_pressure(f, false, rising, &G, wrench, flux));
  /* The patch's direction may be that of -x. */
  bw_check_near(fabs(flux[0]), DEPTH * pow(h, 3) * 3.0 / (12.0 * MU), 1e-6);
  bw_check_near(wrench[1], 0.0, 1e-3 * L);
  bw_film_destroy(&f);
}
END_TEST

/* A gap that closes: the film is that of the roughness. */
START_TEST(roughness)
{
  bw_film_config c = bw_film_config_default();
  bw_film *f = NULL;
  const double L = 1.0;
  double D[6][6];
  c.mu = MU, c.limit = 0.1, c.roughness = 0.01, c.planar = true;
  bw_check_ok(bw_film_create(&c, &f));
  for (int q = 0; q < 2; q++) {
    const block low = {0.5 * L, 0.0, false, true},
                high = {0.5 * L, q == 0 ? 0.005 : -0.002, true, true};
    const bw_film_face a = {of_block, &low}, b = {of_block, &high};
    place(f, &a, &b, (double[3]){0.1, 0.0, 0.0});
    bw_check_ok(bw_film_resistance(f, false, D));
    bw_check_near(D[1][1], MU * 1e6, 1e-3 * MU * 1e6);
  }
  bw_film_destroy(&f);
}
END_TEST

static void refuse(bw_film_config c)
{
  bw_film *f = NULL;
  ck_assert_int_eq(bw_film_create(&c, &f), BW_EINPUT);
  ck_assert_ptr_null(f);
}

START_TEST(refused)
{
  bw_film_config c = bw_film_config_default();
  c.limit = 0.1, c.roughness = 0.01;
  refuse(c); /* no viscosity */
  c.mu = 1.0, c.roughness = 0.2;
  refuse(c);
  c.roughness = 0.01, c.limit = 0.0;
  refuse(c);
  c.limit = 0.1, c.cells = 2;
  refuse(c);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(plates),    BW_TEST(round_bodies),
                                      BW_TEST(cubic_law), BW_TEST(symmetric_and_positive),
                                      BW_TEST(roughness), BW_TEST(refused)};
BW_CHECK_MAIN("film", tests)
