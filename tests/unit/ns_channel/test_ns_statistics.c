/* Statistics of fields whose moments are known in closed form, on a stretched grid and any ranks.
 * TEST ranks=1,2,4 */
#include "bw_ns_statistics.h"
#include "ns_support.h"
#include <complex.h>

static const int cells[3] = {12, 9, 10};
static const double box[3] = {3.0, 2.0, 1.5};
static const bool channel[3] = {true, false, true};
static const double nu = 0.3, alpha = 0.4, beta = 1.1;

static double pi(void)
{
  return acos(-1.0);
}

/* Profiles without any symmetry. */
static double mean_u(double y)
{
  return 0.3 + y * (2.2 - y);
}
static double mean_w(double y)
{
  return 0.2 * y * y - 0.1;
}
static double mean_p(double y)
{
  return 1.0 + 0.4 * y + 0.1 * y * y;
}
static double amp_u(double y)
{
  return 0.5 + 0.3 * y;
}
static double amp_v(double y)
{
  return 0.2 + 0.1 * y * y;
}
static double amp_w(double y)
{
  return 0.4 - 0.1 * y;
}
static double amp_p(double y)
{
  return 0.1 + 0.2 * y;
}

typedef double (*field_fn)(int c, double y, int i, int k); /* c = 0..3: u, v, w, p */

static void fill(bw_ns_channel *ns, field_fn value)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  bw_real *const *u = bw_ns_channel_velocity(ns);
  for (int c = 0; c < 4; c++) {
    bw_real *f = c < 3 ? u[c] : bw_ns_channel_pressure(ns);
    for (int k = 1; f != NULL && k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int y = j + g->lo[1];
          f[bw_at(g, i, j, k)] =
              (bw_real)value(c, c == 1 ? g->y_face[y] : g->y_centre[y], i, k + g->lo[2]);
        }
  }
  bw_ns_channel_refresh(ns);
}

static bw_ns_channel *make(const int n[3], bw_ns_statistics **s)
{
  const bw_ns_channel_config c = ns_config(channel, nu);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, channel, 1.2, 1), &c);
  bw_check_ok(bw_ns_statistics_create(ns, s));
  return ns;
}

static void end(bw_ns_channel **ns, bw_ns_statistics **s)
{
  bw_ns_statistics_destroy(s);
  bw_ns_statistics_destroy(s);
  ns_free(ns);
}

/* One wave along x and z; v and w run ahead of u by alpha and beta. */
static double wave(int c, double y, int i, int k)
{
  const double x = (c == 0 ? i : i - 0.5) / cells[0], z = (c == 2 ? k : k - 0.5) / cells[2];
  const double phase = 2.0 * pi() * (x + z);
  if (c == 0) return mean_u(y) + amp_u(y) * cos(phase);
  if (c == 1) return amp_v(y) * cos(phase + alpha);
  if (c == 2) return mean_w(y) + amp_w(y) * cos(phase + beta);
  return mean_p(y) + amp_p(y) * cos(phase);
}

static bw_ns_estimate *profile(bw_ns_statistics *s, bw_ns_profile_kind kind, bool fold)
{
  static bw_ns_estimate row[64];
  bw_ns_statistics_profile(s, kind, fold, row);
  return row;
}

static const double tolerance = 1e-12; /* round-off of fourth powers of order 100, 120 terms */
#define NEAR(got, want) bw_check_near(got, want, NS_TOLERANCE(tolerance))

START_TEST(wave_at_centres)
{
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(cells, &s);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  fill(ns, wave);
  bw_ns_statistics_sample(s);
  const double dx = box[0] / cells[0], dz = box[2] / cells[2];
  const double kx = 2.0 * pi() / box[0], kz = 2.0 * pi() / box[2];
  const double sx = 2.0 / dx * sin(0.5 * kx * dx), sz = 2.0 / dz * sin(0.5 * kz * dz);
  double p = 0.0;
  for (int j = 1; j <= cells[1]; j++)
    p += mean_p(g->y_centre[j]) * (g->y_face[j] - g->y_face[j - 1]) / box[1];
  for (int j = 1; j <= cells[1]; j++) {
    const double y = g->y_centre[j], a = amp_u(y), c = amp_w(y);
    const double complex o = I * (a * sz - c * sx * cexp(I * beta));
    NEAR(profile(s, BW_NS_PROFILE_U, false)[j].mean, mean_u(y));
    NEAR(profile(s, BW_NS_PROFILE_W, false)[j].mean, mean_w(y));
    NEAR(profile(s, BW_NS_PROFILE_P, false)[j].mean, mean_p(y) - p);
    NEAR(profile(s, BW_NS_PROFILE_U_RMS, false)[j].mean, a / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_W_RMS, false)[j].mean, c / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_P_RMS, false)[j].mean, amp_p(y) / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_UW, false)[j].mean,
         0.5 * a * c * cos(beta) * cos(0.5 * kx * dx) * cos(0.5 * kz * dz));
    NEAR(profile(s, BW_NS_PROFILE_OY_RMS, false)[j].mean, cabs(o) / sqrt(2.0));
    bw_check_near(profile(s, BW_NS_PROFILE_U_SKEWNESS, false)[j].mean, 0.0, NS_TOLERANCE(1e-10));
    bw_check_near(profile(s, BW_NS_PROFILE_U_FLATNESS, false)[j].mean, 1.5, NS_TOLERANCE(1e-10));
    NEAR(bw_ns_statistics_moment(s, BW_NS_MOMENT_UU, j), mean_u(y) * mean_u(y) + 0.5 * a * a);
  }
  end(&ns, &s);
}
END_TEST

START_TEST(wave_at_faces)
{
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(cells, &s);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  fill(ns, wave);
  bw_ns_statistics_sample(s);
  const double dx = box[0] / cells[0], dz = box[2] / cells[2];
  const double hx = pi() * dx / box[0], hz = pi() * dz / box[2]; /* half a cell in the wave */
  for (int j = 1; j < cells[1]; j++) {
    const double y = g->y_face[j], lo = g->y_centre[j], hi = g->y_centre[j + 1], h = hi - lo;
    const double b = amp_v(y), a = 0.5 * (amp_u(lo) + amp_u(hi)), c = 0.5 * (amp_w(lo) + amp_w(hi));
    const double du = (mean_u(hi) - mean_u(lo)) / h, uv = 0.5 * a * b * cos(alpha) * cos(hx);
    const double da = (amp_u(hi) - amp_u(lo)) / h, dc = (amp_w(hi) - amp_w(lo)) / h;
    const double complex ahead = cexp(I * alpha);
    const double complex ox = dc * cexp(I * beta) - I * b * 2.0 / dz * sin(hz) * ahead;
    const double complex oz = I * b * 2.0 / dx * sin(hx) * ahead - da;
    NEAR(profile(s, BW_NS_PROFILE_V, false)[j].mean, 0.0);
    NEAR(profile(s, BW_NS_PROFILE_V_RMS, false)[j].mean, b / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_UV, false)[j].mean, uv);
    NEAR(profile(s, BW_NS_PROFILE_VW, false)[j].mean, 0.5 * b * c * cos(alpha - beta) * cos(hz));
    NEAR(profile(s, BW_NS_PROFILE_OX_RMS, false)[j].mean, cabs(ox) / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_OZ_RMS, false)[j].mean, cabs(oz) / sqrt(2.0));
    NEAR(profile(s, BW_NS_PROFILE_SHEAR, false)[j].mean, nu * du);
    NEAR(profile(s, BW_NS_PROFILE_TOTAL, false)[j].mean, nu * du - uv);
    NEAR(bw_ns_statistics_moment(s, BW_NS_MOMENT_OX, j), (mean_w(hi) - mean_w(lo)) / h);
    bw_check_near(profile(s, BW_NS_PROFILE_V_FLATNESS, false)[j].mean, 1.5, NS_TOLERANCE(1e-10));
  }
  /* walls at rest: mirrored ghosts, v = 0 */
  const double shear[2] = {bw_ns_channel_side(ns, 1, 0).stress[0],
                           bw_ns_channel_side(ns, 1, 1).stress[0]};
  const double first = g->y_centre[1], last = g->y_centre[cells[1]];
  NEAR(shear[0], nu * mean_u(first) / first);
  NEAR(shear[1], nu * mean_u(last) / (box[1] - last));
  NEAR(profile(s, BW_NS_PROFILE_SHEAR, false)[0].mean, shear[0]);
  NEAR(profile(s, BW_NS_PROFILE_SHEAR, false)[cells[1]].mean, -shear[1]);
  NEAR(profile(s, BW_NS_PROFILE_UV, false)[0].mean, 0.0);
  end(&ns, &s);
}
END_TEST

/* k and its budget; rows whose faces are not walls. */
START_TEST(wave_budget)
{
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(cells, &s);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  fill(ns, wave);
  bw_ns_statistics_sample(s);
  const double dx = box[0] / cells[0], dz = box[2] / cells[2];
  const double sx = 2.0 / dx * sin(pi() * dx / box[0]), sz = 2.0 / dz * sin(pi() * dz / box[2]);
  const double cx = cos(pi() * dx / box[0]), cz = cos(pi() * dz / box[2]);
  double k[16], face[16], produced[16], pressure[16];
  for (int j = 1; j <= cells[1]; j++) {
    const double y = g->y_centre[j], a = amp_u(y), c = amp_w(y);
    const double lo = j > 1 ? amp_v(g->y_face[j - 1]) : 0.0;
    const double hi = j < cells[1] ? amp_v(g->y_face[j]) : 0.0;
    k[j] = 0.25 * (a * a + c * c + 0.5 * (lo * lo + hi * hi));
    NEAR(profile(s, BW_NS_PROFILE_K, false)[j].mean, k[j]);
  }
  for (int j = 1; j < cells[1]; j++) {
    const double lo = g->y_centre[j], hi = g->y_centre[j + 1], h = hi - lo;
    const double b = amp_v(g->y_face[j]), da = (amp_u(hi) - amp_u(lo)) / h;
    const double dc = (amp_w(hi) - amp_w(lo)) / h, c = 0.5 * (amp_w(lo) + amp_w(hi));
    face[j] = 0.5 * (da * da + dc * dc + b * b * (sx * sx + sz * sz));
    produced[j] =
        -0.25 * (amp_u(lo) + amp_u(hi)) * b * cos(alpha) * cx * (mean_u(hi) - mean_u(lo)) / h -
        0.5 * b * c * cos(alpha - beta) * cz * (mean_w(hi) - mean_w(lo)) / h;
    pressure[j] = 0.25 * (amp_p(lo) + amp_p(hi)) * b * cos(alpha);
  }
  for (int j = 2; j < cells[1]; j++) {
    const double y = g->y_centre[j], a = amp_u(y), c = amp_w(y);
    const double dy = g->y_face[j] - g->y_face[j - 1];
    const double db = (amp_v(g->y_face[j]) - amp_v(g->y_face[j - 1])) / dy;
    const double inside = 0.5 * ((a * a + c * c) * (sx * sx + sz * sz) + db * db);
    NEAR(profile(s, BW_NS_PROFILE_DISSIPATION, false)[j].mean,
         -nu * (inside + 0.5 * (face[j - 1] + face[j])));
    NEAR(profile(s, BW_NS_PROFILE_PRODUCTION, false)[j].mean,
         0.5 * (produced[j - 1] + produced[j]));
    NEAR(profile(s, BW_NS_PROFILE_PRESSURE_TRANSPORT, false)[j].mean,
         -(pressure[j] - pressure[j - 1]) / dy);
    NEAR(profile(s, BW_NS_PROFILE_TURBULENT_TRANSPORT, false)[j].mean, 0.0);
    NEAR(profile(s, BW_NS_PROFILE_VISCOUS_DIFFUSION, false)[j].mean,
         nu *
             ((k[j + 1] - k[j]) / (g->y_centre[j + 1] - y) -
              (k[j] - k[j - 1]) / (y - g->y_centre[j - 1])) /
             dy);
  }
  end(&ns, &s);
}
END_TEST

/* Of mean 0, square 3, cube 6, fourth power 21 over four points. */
static double lopsided(int c, double y, int i, int k)
{
  const double s = (c == 1 ? k : i + k) % 4 == 0 ? 3.0 : -1.0;
  return (c == 1 ? y - 0.7 : c == 0 ? mean_u(y) : 0.1) + (c == 2 ? -s : s);
}

START_TEST(skewness_and_fold)
{
  const int n[3] = {12, 9, 8};
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(n, &s);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  fill(ns, lopsided);
  bw_ns_statistics_sample(s);
  const double skew = 2.0 / sqrt(3.0), flat = 7.0 / 3.0, round = NS_TOLERANCE(1e-11);
  for (int j = 1; j < n[1]; j++) {
    bw_check_near(profile(s, BW_NS_PROFILE_U_SKEWNESS, false)[j].mean, skew, round);
    bw_check_near(profile(s, BW_NS_PROFILE_V_SKEWNESS, false)[j].mean, skew, round);
    bw_check_near(profile(s, BW_NS_PROFILE_W_SKEWNESS, false)[j].mean, -skew, round);
    bw_check_near(profile(s, BW_NS_PROFILE_U_FLATNESS, false)[j].mean, flat, round);
    bw_check_near(profile(s, BW_NS_PROFILE_V_FLATNESS, false)[j].mean, flat, round);
    bw_check_near(profile(s, BW_NS_PROFILE_W_FLATNESS, false)[j].mean, flat, round);
    /* halves averaged: u as it is, v with its sign */
    const double here = mean_u(g->y_centre[j]), there = mean_u(g->y_centre[n[1] + 1 - j]);
    NEAR(profile(s, BW_NS_PROFILE_U, true)[j].mean, 0.5 * (here + there));
    NEAR(profile(s, BW_NS_PROFILE_V, true)[j].mean, g->y_face[j] - 0.5 * box[1]);
    NEAR(profile(s, BW_NS_PROFILE_V, false)[j].mean, g->y_face[j] - 0.7);
    NEAR(profile(s, BW_NS_PROFILE_SHEAR, true)[j].mean,
         -profile(s, BW_NS_PROFILE_SHEAR, true)[n[1] - j].mean);
  }
  end(&ns, &s);
}
END_TEST

/* v, u, w all with the lopsided numbers along z: <v'u'u'> = 6 b, <v'v'v'> = 6 b^3, and
 * <v'w'w'> = 2 b, as v is averaged over k and k + 1 while w stands between. */
static double alike(int c, double y, int i, int k)
{
  const double s = k % 4 == 0 ? 3.0 : -1.0;
  (void)i;
  return c == 0 ? mean_u(y) + s : c == 1 ? amp_v(y) * s : c == 2 ? mean_w(y) + s : s;
}

START_TEST(triple_products)
{
  const int n[3] = {12, 9, 8};
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(n, &s);
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(ns));
  fill(ns, alike);
  bw_ns_statistics_sample(s);
  for (int j = 1; j <= n[1]; j++) {
    double flux[2];
    for (int q = 0; q < 2; q++) {
      const int f = j - 1 + q;
      const double b = f == 0 || f == n[1] ? 0.0 : amp_v(g->y_face[f]);
      flux[q] = 0.5 * (6.0 * b * b * b + 6.0 * b + 2.0 * b);
    }
    const double dy = g->y_face[j] - g->y_face[j - 1];
    bw_check_near(profile(s, BW_NS_PROFILE_TURBULENT_TRANSPORT, false)[j].mean,
                  -(flux[1] - flux[0]) / dy, NS_TOLERANCE(1e-11));
  }
  end(&ns, &s);
}
END_TEST

static double level; /* of `uniform`: the one number that changes from sample to sample */
static double uniform(int c, double y, int i, int k)
{
  (void)y, (void)i, (void)k;
  return c == 0 ? level : 0.0;
}

static void sample_levels(bw_ns_channel *ns, bw_ns_statistics *s, int from, int to)
{
  for (int q = from; q < to; q++) {
    level = q;
    fill(ns, uniform);
    bw_ns_statistics_sample(s);
  }
}

/* u = 0, 1, 2, ..: after 41 samples ten batches of four are full, with means 1.5 + 4 b. */
START_TEST(batches)
{
  bw_ns_statistics *s = NULL;
  bw_ns_channel *ns = make(cells, &s);
  ck_assert(isnan(profile(s, BW_NS_PROFILE_U, false)[1].interval));
  sample_levels(ns, s, 0, 41);
  ck_assert_int_eq(bw_ns_statistics_samples(s), 41);
  ck_assert_int_eq(bw_ns_statistics_batches(s), 10);
  /* variance of n equidistant numbers 4 apart: 16 n (n + 1)/12, over n for the mean; t(9) = 2.262
   */
  const double interval = 2.262 * sqrt(16.0 * 11.0 / 12.0);
  NEAR(profile(s, BW_NS_PROFILE_U, false)[3].mean, 20.0);
  NEAR(profile(s, BW_NS_PROFILE_U, false)[3].interval, interval);
  NEAR(profile(s, BW_NS_PROFILE_U_RMS, false)[3].mean, sqrt((41.0 * 41.0 - 1.0) / 12.0));
  bw_ns_statistics_reset(s);
  ck_assert_int_eq(bw_ns_statistics_samples(s), 0);
  sample_levels(ns, s, 5, 6);
  NEAR(profile(s, BW_NS_PROFILE_U, false)[3].mean, 5.0);
  end(&ns, &s);
}
END_TEST

/* Interrupted in the middle of a batch, and not: the same bits. */
START_TEST(restart)
{
  bw_ns_statistics *whole = NULL, *before = NULL, *after = NULL;
  bw_ns_channel *ns = make(cells, &whole);
  bw_check_ok(bw_ns_statistics_create(ns, &before));
  bw_check_ok(bw_ns_statistics_create(ns, &after));
  const size_t n = bw_ns_statistics_state_size(whole);
  double *x = NULL, *y = NULL;
  bw_check_ok(BW_ALLOCATE(&x, n));
  bw_check_ok(BW_ALLOCATE(&y, n));
  for (int q = 0; q < 45; q++) {
    double seed = q;
    bw_check_ok(bw_ns_channel_set_velocity(ns, ns_noise, &seed, 0.0));
    bw_ns_statistics_sample(whole);
    bw_ns_statistics_sample(q < 23 ? before : after);
    if (q != 22) continue;
    bw_ns_statistics_get_state(before, x);
    bw_check_ok(bw_ns_statistics_set_state(after, x));
  }
  bw_ns_statistics_get_state(whole, x);
  bw_ns_statistics_get_state(after, y);
  ck_assert_int_eq(memcmp(x, y, n * sizeof *x), 0);
  ck_assert_int_eq(bw_ns_statistics_samples(after), 45);
  x[0] += 1.0;
  bw_check_status(bw_ns_statistics_set_state(after, x), BW_EINPUT);
  bw_release(&x);
  bw_release(&y);
  bw_ns_statistics_destroy(&before);
  bw_ns_statistics_destroy(&after);
  end(&ns, &whole);
}
END_TEST

START_TEST(two_dimensions)
{
  const int n[3] = {12, 9, 1};
  bw_ns_statistics *s = NULL;
  const bw_ns_channel_config c = ns_config(channel, nu);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), n, box, channel, 0, 1), &c);
  bw_check_ok(bw_ns_statistics_create(ns, &s));
  level = 2.5;
  fill(ns, uniform);
  bw_ns_statistics_sample(s);
  NEAR(profile(s, BW_NS_PROFILE_U, false)[4].mean, 2.5);
  NEAR(profile(s, BW_NS_PROFILE_W_RMS, false)[4].mean, 0.0);
  NEAR(profile(s, BW_NS_PROFILE_OY_RMS, false)[4].mean, 0.0);
  end(&ns, &s);
}
END_TEST

START_TEST(refuses_what_has_no_plane)
{
  const bool open[3] = {false, false, true};
  bw_ns_statistics *s = NULL;
  const bw_ns_channel_config c = ns_config(open, nu);
  bw_ns_channel *ns = ns_solver(ns_grid(bw_check_world(), cells, box, open, 0, 1), &c);
  bw_check_status(bw_ns_statistics_create(ns, &s), BW_EINPUT); /* and no object is made */
  ck_assert_ptr_null(s);
  ns_free(&ns);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(wave_at_centres), BW_TEST(wave_at_faces),     BW_TEST(wave_budget),
    BW_TEST(triple_products), BW_TEST(skewness_and_fold), BW_TEST(batches),
    BW_TEST(restart),         BW_TEST(two_dimensions),    BW_TEST(refuses_what_has_no_plane)};
BW_CHECK_MAIN("ns_statistics", tests)
