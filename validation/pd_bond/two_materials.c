/* A bar of two halves: modulus and stress at rest, a pulse in passing, two densities.
 *
 * Claim      Each half keeps its own modulus, the stress does not change at the joint, and a long
 *            pulse has its own speed in each half and is thrown back by the joint as impedances
 *            say.
 * Reference  Bar in tension: strain = sigma/E of each half. Waves: c = sqrt(M/rho), M = 9 E/8
 *            (plane stress, held sideways by periods), times the root of the family's own modulus
 *            over M (lattice_sum.h) and of 1 - (k delta)^2/24, k = 1/width of the pulse; the
 *            momentum of the pulse thrown back is (Z2 - Z1)/(Z2 + Z1) of the one that came, Z = rho
 *            c, and turned.
 * Measured   displacements and stress of the linear solve (correction by tensor) in windows one
 *            width of the bar and more away from the joint and the ends; mean stress of particles
 *            over every cross-section near the joint but further from it than a horizon, and over
 *            all within two horizons; centroids of kinetic energy of the pulse before and after the
 *            joint at two times each; momentum of the first half before and after.
 * Tolerance  modulus and stress in the windows 1 %, asked for. Cross-sections near the joint 2 %:
 *            the skin of the free faces is some 3 % (pd_bond.uniform_stress), not the same in both
 *            materials, on a fifth of the height. Within a horizon of the joint a particle's stress
 *            is no flux of momentum: a bond across gives half of its virial to either end, however
 *            soft that end's own bonds are (-17 and +20 %); the mean over both sides is 1.
 *            Speeds and the momentum thrown back: 5e-4 for the midpoint fractions of lattice_sum.h
 *            (pd_bond.wave_speed), plus 3e-4: the next term of the dispersion and Verlet's error.
 *            Both halves have the same relative error of their modulus, so that Z2/Z1 has none, and
 *            dispersion takes nothing of the integral over a whole pulse. Momentum in all: 1e4
 *            roundings.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1,2 */
#include "body.h"
#include "lattice_sum.h"

static const double E = 5, RHO = 2, E2 = 25, RHO2 = 6;

static bw_solid_config halves(void)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E;
  c.more.n = 1;
  c.more.material[0] = (bw_pd_material){.rho = RHO2, .E = E2, .nu = NAN, .G0 = INFINITY};
  return c;
}

/* `half` columns of each material, `wide` rows; the first and the last `held` columns are
 * prescribed. */
static bw_status make(const bw_comm *comm, const bw_solid_config *c, int half, int wide, int held,
                      bw_solid **out)
{
  const int64_t n = bw_comm_rank(comm) == 0 ? 2 * (int64_t)half * wide : 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL, *group = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * (size_t)n);
  BW_THEN(st, BW_ALLOCATE(&kind, (size_t)n));
  BW_THEN(st, BW_ALLOCATE(&group, (size_t)n));
  for (int64_t q = 0; st == BW_OK && q < n; q++) {
    const int x = (int)(q % (2 * half));
    site[3 * q] = x, site[3 * q + 1] = (int32_t)(q / (2 * half));
    kind[q] = x < held || x >= 2 * half - held ? BW_PD_PRESCRIBED : BW_PD_FREE;
    group[q] = x >= half;
  }
  st = bw_comm_agree(comm, st);
  const bw_pd_sites given = {.n = n, .site = site, .kind = kind, .group = group};
  BW_THEN(st, bw_solid_create(comm, c, &given, out));
  bw_release(&site);
  bw_release(&kind);
  bw_release(&group);
  return st;
}

static void claim(bw_validation *v, const char *quantity, double measured, double reference,
                  double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "two materials in one bar keep their own laws",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "elasticity of bars, waves at a joint"});
}

enum { HALF = 90, WIDE = 20, HELD = 3, BESIDE = 4 };

static double column_mean(const bw_solid *s, const body_rows *r, double from, double to,
                          const double value[], size_t stride)
{
  const double far = 1e9;
  return body_mean(s, r->X0, (double[3]){from, -far, -far}, (double[3]){to, far, far}, value,
                   stride);
}

/* Strain of a window from the mean displacements of its first and last column. */
static double strain(const bw_solid *s, const body_rows *r, int from, int to)
{
  return (column_mean(s, r, to, to + 1, r->F, 3) - column_mean(s, r, from, from + 1, r->F, 3)) /
         (to - from);
}

static bw_status tension(bw_validation *v)
{
  bw_solid_config c = halves();
  bw_solid *s = NULL;
  body_rows r;
  c.surface_correction = BW_PD_SURFACE_TENSOR;
  BW_TRY(make(bw_validation_comm(v), &c, HALF, WIDE, HELD, &s));
  BW_TRY(body_rows_make(s, &r));
  const double pull = 1e-5;
  for (size_t i = 0; i < bw_solid_count(s); i++)
    r.X[3 * i] = r.X0[3 * i] > HALF ? pull * HALF : -pull * HALF;
  BW_TRY(body_at_rest(s, &r));
  for (size_t i = 0; i < 3 * bw_solid_count(s); i++)
    r.F[i] = r.X[i] - r.X0[i];
  /* Equilibrium: the same stress in every free cross-section, that of the windows in the middle. */
  const int a = 2 * WIDE, b = HALF - WIDE;
  const double left = column_mean(s, &r, a, b, r.stress, 6);
  const double right = column_mean(s, &r, 2 * HALF - b, 2 * HALF - a, r.stress, 6);
  claim(v, "E_of_first_half", left / strain(s, &r, a, b - 1), E, 0.01 * E);
  claim(v, "E_of_second_half", right / strain(s, &r, 2 * HALF - b, 2 * HALF - a - 1), E2,
        0.01 * E2);
  claim(v, "stress_of_second_over_first_half", right / left, 1, 0.01);
  double least = INFINITY, most = -INFINITY;
  for (int x = HALF - WIDE; x < HALF + WIDE; x++) {
    if (x >= HALF - BESIDE && x < HALF + BESIDE) continue;
    const double mean = column_mean(s, &r, x, x + 1, r.stress, 6) / left;
    least = fmin(least, mean), most = fmax(most, mean);
  }
  claim(v, "least_stress_near_the_joint", least, 1, 0.02);
  claim(v, "largest_stress_near_the_joint", most, 1, 0.02);
  claim(v, "stress_at_the_joint",
        column_mean(s, &r, HALF - 2 * BESIDE, HALF + 2 * BESIDE, r.stress, 6) / left, 1, 0.02);
  body_rows_release(&r);
  bw_solid_destroy(&s);
  return BW_OK;
}

/* xi_x^4/|xi|^3 */
static double stiffness(const double xi[3], const void *data)
{
  (void)data;
  const double x2 = xi[0] * xi[0], r2 = x2 + xi[1] * xi[1] + xi[2] * xi[2];
  return x2 * x2 / (r2 * sqrt(r2));
}

/* Long-wave modulus of the family over that of elasticity. */
static double family_modulus(void)
{
  return 0.5 * 9 / (LATTICE_PI * 27) * lattice_alpha(3, true, true) *
         lattice_sum(3, true, true, stiffness, NULL) / 1.125;
}

typedef struct {
  double middle, width, speed;
} pulse;

static double shape(double x, const pulse *p)
{
  const double z = (x - p->middle) / p->width;
  return 1e-6 * exp(-z * z);
}

/* v = f, u = -integral of f/c: a pulse that goes to the right only. */
static void start(bw_solid *s, body_rows *r, const pulse *p)
{
  for (size_t i = 0; i < bw_solid_count(s); i++) {
    const double x = r->X0[3 * i];
    r->V[3 * i] = shape(x, p);
    r->X[3 * i] =
        x - 1e-6 / p->speed * p->width * 0.5 * sqrt(LATTICE_PI) * erf((x - p->middle) / p->width);
    r->X[3 * i + 1] = r->X0[3 * i + 1], r->X[3 * i + 2] = r->X0[3 * i + 2];
  }
  bw_solid_set_state(s, r->X, r->V);
}

/* Of one half: momentum, and the centroid of its kinetic energy. */
static void half_sums(const bw_solid *s, body_rows *r, int which, double *momentum, double *centre)
{
  double sum[3] = {0};
  bw_solid_get_velocity(s, r->V);
  for (size_t i = 0; i < bw_solid_count(s); i++) {
    if (bw_solid_group(s, i) != which) continue;
    const double v = r->V[3 * i];
    sum[0] += bw_solid_density(s, i) * v;
    sum[1] += v * v;
    sum[2] += v * v * r->X0[3 * i];
  }
  bw_comm_sum(bw_solid_comm(s), 3, sum);
  *momentum = sum[0] * bw_solid_volume(s);
  *centre = sum[2] / sum[1];
}

/* Steps until `*time` is about `until`. */
static bw_status go(bw_solid *s, double dt, double until, double *time)
{
  for (; *time < until - 0.5 * dt; *time += dt)
    BW_TRY(bw_solid_step(s, dt));
  return BW_OK;
}

enum { LONG = 900 };

static bw_status waves(bw_validation *v)
{
  bw_solid_config c = halves();
  bw_solid *s = NULL;
  body_rows r;
  c.period[1] = 1;
  BW_TRY(make(bw_validation_comm(v), &c, LONG, 1, 0, &s));
  BW_TRY(body_rows_make(s, &r));
  /* A slow and a fast half: the second pulse is c2/c1 as wide. Dispersion is that of k =
   * 1/width. */
  const double ratio = family_modulus(), c1 = sqrt(1.125 * E / RHO * ratio);
  const double c2 = sqrt(1.125 * E2 / RHO2 * ratio);
  const pulse p = {0.35 * LONG, 60, c1};
  const double slow1 = 1 - 9 / (p.width * p.width) / 48, dt = 0.3 * bw_solid_dt_max(s);
  const double slow2 = 1 - 9 / pow(p.width * c2 / c1, 2) / 48;
  const double until[] = {0.3 * LONG / c1, LONG / c1, LONG / c1 + 0.2 * LONG / c2};
  double time = 0, came, back, passed, P, x0, x1, y0, y1, skip;
  start(s, &r, &p);
  half_sums(s, &r, 0, &came, &x0);
  BW_TRY(go(s, dt, until[0], &time));
  half_sums(s, &r, 0, &P, &x1);
  const double measured1 = (x1 - x0) / time;
  BW_TRY(go(s, dt, until[1], &time));
  const double then = time;
  half_sums(s, &r, 0, &back, &skip);
  half_sums(s, &r, 1, &passed, &y0);
  BW_TRY(go(s, dt, until[2], &time));
  half_sums(s, &r, 1, &P, &y1);
  const double error = 8e-4;
  claim(v, "speed_in_first_half", measured1, c1 * slow1, error * c1);
  claim(v, "speed_in_second_half", (y1 - y0) / (time - then), c2 * slow2, error * c2);
  const double Z1 = RHO * c1, Z2 = RHO2 * c2;
  claim(v, "momentum_thrown_back", -back / came, (Z2 - Z1) / (Z2 + Z1), error);
  claim(v, "momentum_kept", (back + passed) / came, 1, 1e4 * BW_REAL_EPSILON);
  body_rows_release(&r);
  bw_solid_destroy(&s);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(tension(v));
  return waves(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.two_materials", run);
}
