/* Correlations and spectra of fields whose modes are known.
 * TEST ranks=1,2,4 */
#include "bw_ns_correlations.h"
#include "ns_support.h"

static const double box[3] = {3.0, 2.0, 1.5};
static const bool channel[3] = {true, false, true};
static const int rows[2] = {3, 7};

static double two_pi(void)
{
  return 2.0 * acos(-1.0);
}

static bw_ns_channel *make(int nx, int nz, bw_ns_correlations **c)
{
  const int n[3] = {nx, 9, nz};
  const bw_ns_channel_config config = ns_config(channel, 0.1);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, channel, 0, 1), &config);
  bw_check_ok(bw_ns_correlations_create(ns, 2, rows, c));
  return ns;
}

static void end(bw_ns_channel **ns, bw_ns_correlations **c)
{
  bw_ns_correlations_destroy(c);
  bw_ns_correlations_destroy(c);
  ns_free(ns);
}

/* Component a in row j: level, mode 2 + a along x and 1 + a along z, amplitudes by row. */
static void fill(bw_ns_channel *ns, double level)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  bw_real *const *u = bw_ns_channel_velocity(ns);
  for (int a = 0; a < 3; a++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int y = j + g->lo[1];
          const double x = two_pi() * i / g->n[0], z = two_pi() * (k + g->lo[2]) / g->n[2];
          u[a][bw_at(g, i, j, k)] = (bw_real)(level + y + (0.5 * y + a) * cos((2 + a) * x + 0.3) +
                                              0.7 * cos((1 + a) * z + 0.1 * y));
        }
}

static void check_modes(int nx, int nz)
{
  bw_ns_correlations *c = NULL;
  bw_ns_channel *ns = make(nx, nz, &c);
  double r[64], e[64];
  fill(ns, 0.0);
  bw_ns_correlations_sample(c);
  bw_ns_correlations_sample(c);
  ck_assert_int_eq(bw_ns_correlations_samples(c), 2);
  for (int p = 0; p < 2; p++)
    for (int a = 0; a < 3; a++) {
      const double amplitude = 0.5 * rows[p] + a;
      const double ex = 0.5 * amplitude * amplitude, ez = 0.5 * 0.7 * 0.7;
      for (int d = 0; d < 3; d += 2) {
        const int n = d == 0 ? nx : nz, mode = (d == 0 ? 2 : 1) + a;
        const double here = d == 0 ? ex : ez, other = d == 0 ? ez : ex;
        bw_ns_correlations_get(c, p, a, d, r);
        bw_ns_correlations_spectrum(c, p, a, d, e);
        for (int q = 0; q <= n / 2; q++) {
          bw_check_near(r[q], here * cos(two_pi() * mode * q / n) + other, NS_TOLERANCE(1e-12));
          const double want = q == mode ? here : q == 0 ? other : 0.0; /* other: constant along d */
          bw_check_near(e[q], want, NS_TOLERANCE(1e-12));
        }
      }
    }
  end(&ns, &c);
}

START_TEST(modes_even)
{
  check_modes(12, 10);
}
END_TEST

START_TEST(modes_odd)
{
  check_modes(11, 9);
}
END_TEST

/* Levels that change from sample to sample are fluctuations too: variance 2/3 of -1, 0, 1. */
START_TEST(time_counts)
{
  bw_ns_correlations *c = NULL;
  bw_ns_channel *ns = make(12, 10, &c);
  double r[8];
  for (int q = -1; q <= 1; q++) {
    fill(ns, q);
    bw_ns_correlations_sample(c);
  }
  bw_ns_correlations_get(c, 0, 0, 2, r);
  const double a = 0.5 * rows[0];
  bw_check_near(r[0], 2.0 / 3.0 + 0.5 * a * a + 0.5 * 0.49, NS_TOLERANCE(1e-12));
  end(&ns, &c);
}
END_TEST

/* The spectrum of anything adds up to the variance, in both directions the same. */
START_TEST(parseval)
{
  bw_ns_correlations *c = NULL;
  bw_ns_channel *ns = make(12, 10, &c);
  double r[8], e[8], seed = 3.0;
  bw_check_ok(bw_ns_channel_set_velocity(ns, ns_noise, &seed, 0.0));
  bw_ns_correlations_sample(c);
  for (int a = 0; a < 3; a++) {
    double sum[2] = {0.0, 0.0}, variance[2];
    for (int d = 0; d < 2; d++) {
      bw_ns_correlations_get(c, 1, a, 2 * d, r);
      bw_ns_correlations_spectrum(c, 1, a, 2 * d, e);
      for (int m = 0; m <= (d == 0 ? 6 : 5); m++) {
        ck_assert(e[m] > -NS_TOLERANCE(1e-12));
        sum[d] += e[m];
      }
      variance[d] = r[0];
    }
    ck_assert(variance[0] > 0.01);
    bw_check_near(sum[0], variance[0], NS_TOLERANCE(1e-12));
    bw_check_near(sum[1], variance[0], NS_TOLERANCE(1e-12));
    bw_check_near(variance[1], variance[0], NS_TOLERANCE(1e-12));
  }
  end(&ns, &c);
}
END_TEST

START_TEST(restart)
{
  bw_ns_correlations *whole = NULL, *after = NULL;
  bw_ns_channel *ns = make(12, 10, &whole);
  bw_check_ok(bw_ns_correlations_create(ns, 2, rows, &after));
  const size_t n = bw_ns_correlations_state_size(whole);
  double *x = NULL, *y = NULL;
  bw_check_ok(BW_ALLOCATE(&x, n));
  bw_check_ok(BW_ALLOCATE(&y, n));
  for (int q = 0; q < 5; q++) {
    fill(ns, 0.1 * q);
    bw_ns_correlations_sample(whole);
    if (q > 1) bw_ns_correlations_sample(after);
    if (q != 1) continue;
    bw_ns_correlations_get_state(whole, x);
    bw_check_ok(bw_ns_correlations_set_state(after, x));
  }
  bw_ns_correlations_get_state(whole, x);
  bw_ns_correlations_get_state(after, y);
  ck_assert_int_eq(memcmp(x, y, n * sizeof *x), 0);
  x[4] += 1.0; /* another row */
  bw_check_status(bw_ns_correlations_set_state(after, x), BW_EINPUT);
  bw_release(&x);
  bw_release(&y);
  bw_ns_correlations_destroy(&after);
  end(&ns, &whole);
}
END_TEST

START_TEST(refuses)
{
  const int n[3] = {8, 9, 8}, bad[1] = {10};
  bw_ns_correlations *c = NULL;
  const bw_ns_channel_config config = ns_config(channel, 0.1);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, channel, 0, 1), &config);
  bw_check_status(bw_ns_correlations_create(ns, 1, bad, &c), BW_EINPUT);
  ck_assert_ptr_null(c);
  ns_free(&ns);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(modes_even), BW_TEST(modes_odd), BW_TEST(time_counts),
                                      BW_TEST(parseval),   BW_TEST(restart),   BW_TEST(refuses)};
BW_CHECK_MAIN("ns_correlations", tests)
