/* Films between faces of points against lubrication theory; momentum, energy, what is refused.
 * TEST ranks=1 */
#include "bw_check.h"
#include "bw_film_net.h"

#include <math.h>
#include <string.h>

enum { MOST = 4000 };
static const double MU = 0.7, DS = 0.1, DEPTH = 2.0;

/* Surfaces of blocks, their particles of edge DS. */
typedef struct {
  size_t n;
  double X[3 * MOST], N[3 * MOST], H[MOST], A[MOST], mobility[MOST], V[3 * MOST];
} cloud;

static void add(cloud *c, const double X[3], const double N[3], double area, double mobility,
                const double V[3])
{
  const double size = sqrt(N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
  ck_assert_uint_lt(c->n, MOST);
  for (size_t d = 0; d < 3; d++) {
    c->X[3 * c->n + d] = X[d];
    c->N[3 * c->n + d] = N[d] / size;
    c->V[3 * c->n + d] = V[d];
  }
  c->H[c->n] = 0.5 * DS, c->A[c->n] = area, c->mobility[c->n++] = mobility;
}

/* A block of the plane, m particles long and four high, its face at y = 0 or below it, turned by
 * `turn` about the origin afterwards; V of all its points. */
static void add_block(cloud *c, int m, double shift, double face, bool above, double mobility,
                      double turn, const double V[3])
{
  const double sign = above ? -1.0 : 1.0;
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < m; i++) {
      const bool end = i == 0 || i == m - 1, lip = j == 0, back = j == 3;
      if (!end && !lip && !back) continue;
      const double x[2] = {(i - 0.5 * (m - 1)) * DS + shift, face - sign * (j + 0.5) * DS};
      const double n[2] = {i == 0 ? -1.0 : end ? 1.0 : 0.0, lip ? sign : back ? -sign : 0.0};
      const double cs = cos(turn), sn = sin(turn), corner = end && (lip || back) ? sqrt(2.0) : 1.0;
      add(c, (double[3]){cs * x[0] - sn * x[1], sn * x[0] + cs * x[1], 0.0},
          (double[3]){cs * n[0] - sn * n[1], sn * n[0] + cs * n[1], 0.0}, corner * DS * DEPTH,
          mobility, V);
    }
}

static bw_film_net *make(bool planar)
{
  bw_film_net_config c = bw_film_net_config_default();
  bw_film_net *w = NULL;
  c.mu = MU, c.limit = 3.0 * DS, c.full = 2.0 * DS, c.roughness = 1e-4 * DS, c.spacing = DS;
  c.planar = planar, c.depth = DEPTH;
  bw_check_ok(bw_film_net_create(&c, &w));
  return w;
}

static void find(bw_film_net *w, const cloud *c)
{
  bw_check_ok(bw_film_net_find(w, &(bw_film_points){c->n, c->X, c->N, c->H, c->A, c->mobility}));
}

/* The film at the velocities of the cloud, p = `left` at edges at x < 0, else `right`; F (n,3) what
 * it does. */
static void press(bw_film_net *w, const cloud *c, double dt, double left, double right, double F[])
{
  const int32_t *point = NULL;
  double edge[MOST];
  const size_t n = bw_film_net_edges(w, &point);
  for (size_t e = 0; e < n; e++)
    edge[e] = c->X[3 * point[e]] < 0.0 ? left : right;
  bw_check_ok(bw_film_net_press(w, dt, c->V, edge, (double[3]){0.0, 0.0, 0.0}));
  memset(F, 0, 3 * c->n * sizeof *F);
  bw_film_net_force(w, F);
}

/* Force on the points above y = 0 (turned back by -turn) along y, and the sums over all points. */
static double opening(const cloud *c, const double F[], double turn, double sum[3], double *moment)
{
  double up = 0.0;
  memset(sum, 0, 3 * sizeof *sum);
  *moment = 0.0;
  for (size_t i = 0; i < c->n; i++) {
    const double *f = F + 3 * i, *x = c->X + 3 * i;
    for (size_t d = 0; d < 3; d++)
      sum[d] += f[d];
    *moment += x[0] * f[1] - x[1] * f[0];
    if (cos(turn) * x[1] - sin(turn) * x[0] > 0.0) up += cos(turn) * f[1] - sin(turn) * f[0];
  }
  return up;
}

/* Plates of length L: mu V L^3/h^3 per depth, their points face to face or not, the lattices turned
 * or not. Momentum and angular momentum to round-off, as pressure acts along one line. */
START_TEST(plates_are_squeezed)
{
  const struct {
    double shift, turn;
  } cases[] = {{0.0, 0.0}, {0.3 * DS, 0.0}, {0.0, 0.4}, {0.2 * DS, 0.4}};
  const double h = 0.03, V = 0.2, L = 64 * DS;
  static cloud c;
  static double F[3 * MOST];
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_film_net *w = make(true);
    double sum[3], moment;
    const double turn = cases[q].turn, down[3] = {V * sin(turn), -V * cos(turn), 0.0};
    c.n = 0;
    add_block(&c, 64, 0.0, -0.5 * h, false, 0.0, turn, (double[3]){0.0});
    add_block(&c, 64, cases[q].shift, 0.5 * h, true, 0.0, turn, down);
    find(w, &c);
    press(w, &c, 1.0, 0.0, 0.0, F);
    const double up = opening(&c, F, turn, sum, &moment), theory = DEPTH * MU * V * pow(L / h, 3);
    /* Face to face L is that of the particles. Else ends are known to a third of a spacing:
     * 3/64. */
    bw_check_near(up / theory, 1.0, cases[q].shift == 0.0 ? 2e-3 : 0.05);
    bw_check_near(sum[0] / theory, 0.0, 1e-13);
    bw_check_near(sum[1] / theory, 0.0, 1e-13);
    /* Where ends overhang the normal leans: the shear there has a moment. */
    bw_check_near(moment / (theory * L), 0.0, cases[q].shift == 0.0 ? 1e-12 : 1e-8);
    /* Power of the force is what the film dissipates. */
    bw_check_near(up * V / bw_film_net_dissipation(w), 1.0, 1e-8);
    bw_film_net_destroy(&w);
  }
}
END_TEST

/* Square plates of edge L in space: 0.4217 mu V L^4/h^3, the series of a membrane under a uniform
 * load (S. Timoshenko and J. Goodier, Theory of Elasticity, section 109, k_1 = 0.1406 =
 * 0.4217/3). */
START_TEST(square_plates)
{
  enum { M = 24 };
  const double h = 0.03, V = 0.2, L = M * DS;
  static cloud c;
  static double F[3 * MOST];
  bw_film_net *w = make(false);
  double up = 0.0;
  c.n = 0;
  for (int side = 0; side < 2; side++)
    for (int k = 0; k < 2; k++)
      for (int j = 0; j < M; j++)
        for (int i = 0; i < M; i++) {
          const double sign = side == 0 ? 1.0 : -1.0;
          const double n[3] = {i == 0       ? -1.0
                               : i == M - 1 ? 1.0
                                            : 0.0,
                               k == 0 ? sign : 0.0,
                               j == 0       ? -1.0
                               : j == M - 1 ? 1.0
                                            : 0.0};
          const double open = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
          if (open == 0.0) continue;
          add(&c,
              (double[3]){(i - 0.5 * (M - 1)) * DS, -sign * (0.5 * h + (k + 0.5) * DS),
                          (j - 0.5 * (M - 1)) * DS},
              n, sqrt(open) * DS * DS, 0.0, (double[3]){0.0, side == 0 ? 0.0 : -V, 0.0});
        }
  find(w, &c);
  press(w, &c, 1.0, 0.0, 0.0, F);
  for (size_t i = 0; i < c.n; i++)
    if (c.X[3 * i + 1] > 0.0) up += F[3 * i + 1];
  /* L is known to a quarter of a spacing: 4 x 0.25/24. */
  bw_check_near(up / (MU * V * pow(L, 4) / pow(h, 3)), 0.4217, 0.042 * 0.4217);
  bw_film_net_destroy(&w);
}
END_TEST

/* A slit of 40 spacings and the pressure that drops by `drop` along it, solved; forces to F. */
static bw_film_net *slit(cloud *c, double h, double drop, double F[])
{
  const double still[3] = {0.0};
  bw_film_net *w = make(true);
  c->n = 0;
  add_block(c, 40, 0.0, -0.5 * h, false, 0.0, 0.0, still);
  add_block(c, 40, 0.0, 0.5 * h, true, 0.0, 0.0, still);
  find(w, c);
  press(w, c, 1.0, drop, 0.0, F);
  return w;
}

/* Flow along a slit: h^3 G/(12 mu) per depth. */
START_TEST(flow_along_a_slit)
{
  const double h = 0.02, drop = 3.0, L = 40 * DS;
  static cloud c;
  static double F[3 * MOST];
  bw_film_net *w = slit(&c, h, drop, F);
  const double theory = DEPTH * pow(h, 3) / (12.0 * MU) * drop / L;
  for (int q = -1; q < 2; q++) {
    const double x[3] = {1.03 * q, 0.0, 0.0}, n[3] = {1.0, 0.0, 0.0};
    bw_check_near(bw_film_net_flux(w, x, n) / theory, 1.0, 0.03);
  }
  bw_film_net_destroy(&w);
}
END_TEST

/* What a film brings: out of one end of a slit, in at the other, nothing in between and in all. */
START_TEST(what_a_film_brings)
{
  const double h = 0.02, drop = 3.0, L = 40 * DS, dt = 0.3;
  static cloud c;
  static double F[3 * MOST], moved[MOST];
  bw_film_net *w = slit(&c, h, drop, F);
  memset(moved, 0, sizeof moved);
  bw_film_net_bring(w, dt, moved);
  const double theory = dt * DEPTH * pow(h, 3) / (12.0 * MU) * drop / L;
  double left = 0.0, right = 0.0, within = 0.0;
  for (size_t s = 0; s < c.n; s++) {
    const double x = c.X[3 * s];
    if (fabs(x) < 0.4 * L)
      within = fmax(within, fabs(moved[s]));
    else if (x < 0.0)
      left += moved[s];
    else
      right += moved[s];
  }
  bw_check_near(left / theory, -1.0, 0.03);
  bw_check_near(left + right, 0.0, 1e-6 * theory);
  bw_check_near(within, 0.0, 1e-6 * theory);
  bw_film_net_destroy(&w);
}
END_TEST

/* One plate is free, rigid, and pushed: whatever the step, it takes the speed at which the film
 * bears the push. What holds it together is known from the step before, as a solid's forces are. */
START_TEST(a_stiff_film_is_stable)
{
  enum { M = 32 };
  const double h = 0.03, L = M * DS, push = 5.0, still[3] = {0.0};
  static cloud c;
  static double F[3 * MOST], inner[MOST];
  for (int q = 0; q < 3; q++) {
    const double dt = 1e-5 * pow(30.0, q); /* dt D/m: 0.25, 7.5, 220 */
    bw_film_net *w = make(true);
    c.n = 0;
    add_block(&c, M, 0.0, -0.5 * h, false, 0.0, 0.0, still);
    const size_t first = c.n;
    add_block(&c, M, 0.0, 0.5 * h, true, 1.0, 0.0, still);
    find(w, &c);
    memset(inner, 0, sizeof inner);
    const double n = (double)(c.n - first);
    double V = 0.0;
    for (int step = 0; step < 600; step++) {
      double mean = 0.0;
      for (size_t i = first; i < c.n; i++)
        c.V[3 * i + 1] = V + dt * (inner[i] - push / n);
      press(w, &c, dt, 0.0, 0.0, F);
      for (size_t i = first; i < c.n; i++) {
        c.V[3 * i + 1] += dt * F[3 * i + 1];
        mean += c.V[3 * i + 1] / n;
      }
      for (size_t i = first; i < c.n; i++)
        inner[i] += (mean - c.V[3 * i + 1]) / dt;
      V = mean;
    }
    bw_check_near(V / (-push * pow(h / L, 3) / (DEPTH * MU)), 1.0, 0.06);
    bw_film_net_destroy(&w);
  }
}
END_TEST

/* Plates that part: a film bears no more than its least pressure. */
START_TEST(a_film_cavitates)
{
  const double h = 0.02, least = -1.5, L = 40 * DS;
  static cloud c;
  static double F[3 * MOST];
  bw_film_net_config config = bw_film_net_config_default();
  bw_film_net *w = NULL;
  double sum[3], moment;
  config.mu = MU, config.limit = 3.0 * DS, config.full = 2.0 * DS, config.roughness = 1e-4 * DS;
  config.spacing = DS, config.planar = true, config.depth = DEPTH, config.least = least;
  bw_check_ok(bw_film_net_create(&config, &w));
  c.n = 0;
  add_block(&c, 40, 0.0, -0.5 * h, false, 0.0, 0.0, (double[3]){0.0});
  add_block(&c, 40, 0.0, 0.5 * h, true, 0.0, 0.0, (double[3]){0.0, 0.01, 0.0});
  find(w, &c);
  press(w, &c, 1.0, 0.0, 0.0, F);
  const bw_film_node *node = NULL;
  const size_t n = bw_film_net_nodes(w, &node);
  for (size_t a = 0; a < n; a++)
    ck_assert_double_ge(node[a].pressure, least);
  const double pull = opening(&c, F, 0.0, sum, &moment);
  /* Nearly all of it has cavitated. */
  bw_check_near(pull / (DEPTH * L * least), 1.0, 0.1);
  bw_film_net_destroy(&w);
}
END_TEST

/* Towards the limit the share goes to nothing, at half of the way it is half. */
START_TEST(shares)
{
  const double gaps[] = {1.9, 2.5, 2.999, 3.01}, share[] = {1.0, 0.5, 0.0, 0.0};
  static cloud c;
  for (int q = 0; q < 4; q++) {
    bw_film_net *w = make(true);
    const bw_film_node *node = NULL;
    c.n = 0;
    add_block(&c, 20, 0.0, 0.0, false, 0.0, 0.0, (double[3]){0.0});
    add_block(&c, 20, 0.0, gaps[q] * DS, true, 0.0, 0.0, (double[3]){0.0});
    find(w, &c);
    const size_t n = bw_film_net_nodes(w, &node);
    ck_assert_uint_eq(n > 0, gaps[q] < 3.0);
    for (size_t a = 0; a < n; a++) {
      bw_check_near(node[a].share, share[q], 0.03);
      /* Normals lean at the ends. */
      bw_check_near(node[a].gap / (gaps[q] * DS), 1.0, 0.01);
    }
    bw_film_net_destroy(&w);
  }
}
END_TEST

/* What another load does between both faces is taken out in the film's share, in opposite forces:
 * with a pressure of that load alone nothing is left of it. */
START_TEST(another_load_is_replaced)
{
  const double h = 0.02, still[3] = {0.0};
  static cloud c;
  static double F[3 * MOST], L[3 * MOST], T[3 * MOST];
  bw_film_net *w = make(true);
  c.n = 0;
  add_block(&c, 20, 0.0, -0.5 * h, false, 0.0, 0.0, still);
  add_block(&c, 20, 0.0, 0.5 * h, true, 0.0, 0.0, still);
  find(w, &c);
  memset(F, 0, sizeof F);
  memset(L, 0, sizeof L);
  const bw_film_node *node = NULL;
  const size_t n = bw_film_net_nodes(w, &node);
  for (size_t a = 0; a < n; a++) {
    const int32_t s = node[a].point;
    if (fabs(c.N[3 * s]) < 0.1) L[3 * s + 1] = -7.0 * DS * DEPTH * c.N[3 * s + 1];
  }
  bw_film_net_between(w, L, T);
  bw_film_net_replace(w, T, F);
  double sum = 0.0;
  for (size_t i = 0; i < c.n; i++) {
    const bool inner = fabs(c.X[3 * i]) < 0.3 && fabs(c.X[3 * i + 1]) < DS;
    sum += F[3 * i + 1];
    if (inner) bw_check_near(F[3 * i + 1] + L[3 * i + 1], 0.0, 1e-10);
  }
  bw_check_near(sum, 0.0, 1e-12);
  bw_film_net_destroy(&w);
}
END_TEST

START_TEST(bad_input_is_refused)
{
  const struct {
    const char *word;
    double mu, limit, full, roughness, least, spacing;
  } cases[] = {{"mu", 0, 3, 2, 1, 0, 1},    {"limit", 1, NAN, 2, 1, 0, 1},
               {"full", 1, 3, 3, 1, 0, 1},  {"roughness", 1, 3, 2, 4, 0, 1},
               {"least", 1, 3, 2, 1, 1, 1}, {"spacing", 1, 3, 2, 1, 0, 0}};
  for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
    bw_film_net_config c = bw_film_net_config_default();
    bw_film_net *w = NULL;
    c.mu = cases[q].mu, c.limit = cases[q].limit, c.full = cases[q].full;
    c.roughness = cases[q].roughness, c.least = cases[q].least, c.spacing = cases[q].spacing;
    bw_check_status(bw_film_net_create(&c, &w), BW_EINPUT);
    ck_assert_msg(strstr(bw_last_message(), cases[q].word) != NULL, "%s", bw_last_message());
    ck_assert_ptr_null(w);
  }
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(plates_are_squeezed),
                                      BW_TEST(square_plates),
                                      BW_TEST(flow_along_a_slit),
                                      BW_TEST(what_a_film_brings),
                                      BW_TEST(a_stiff_film_is_stable),
                                      BW_TEST(a_film_cavitates),
                                      BW_TEST(shares),
                                      BW_TEST(another_load_is_replaced),
                                      BW_TEST(bad_input_is_refused)};
BW_CHECK_MAIN("film_net", tests)
