/* Speeds of plane waves.
 *
 * Claim      Long plane waves travel with the P and S speeds of elasticity, slowed down by the
 *            dispersion of the bond model.
 * Reference  sqrt((lambda + 2 mu)/rho), sqrt(mu/rho) (plane stress: sqrt(E/(rho (1 - nu^2)))),
 * times the root of 1 - b (k delta)^2 from the expansion of 1 - cos(k xi) under the family
 *            integral: b = 10/252 (P, 3D), 1/42 (S, 3D), 1/24 (P, 2D).
 * Measured   frequency of a standing wave in a body periodic in all directions, from the times at
 *            which the velocity's projection on the wave crosses zero. The body is one cell wide.
 * Tolerance  half of the relative error of the modulus that the family sum gives, written
 *            independently (lattice_sum.h) and known before the run, plus 5e-4 for its midpoint
 *            fractions, plus the next term of the expansion, below (k delta)^4/1000, plus Verlet's
 *            (w dt)^2/24, below 1e-4.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_validation.h"
#include "lattice_sum.h"

#include <stdio.h>

static const double E = 5, RHO = 2;

typedef struct {
  const char *name;
  bw_pd_geometry geometry;
  int direction;     /* of the motion; the wave goes along 0 */
  double modulus;    /* over E */
  double dispersion; /* b */
} wave;

static const wave waves[] = {{"p_3d", BW_PD_3D, 0, 1.2, 10.0 / 252},
                             {"s_3d", BW_PD_3D, 2, 0.4, 1.0 / 42},
                             {"p_plane_stress", BW_PD_PLANE_STRESS, 0, 1.125, 1.0 / 24},
                             {"p_plane_strain", BW_PD_PLANE_STRAIN, 0, 1.2, 1.0 / 24}};

static bw_status make(const bw_comm *comm, const wave *w, double m, int length, bw_solid **pd)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = w->geometry;
  c.ds = 1;
  c.rho = RHO;
  c.E = E;
  c.horizon_ratio = m;
  c.period[0] = length;
  c.period[1] = 1;
  c.period[2] = w->geometry == BW_PD_3D ? 1 : 0;
  int32_t *site = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * (size_t)length));
  for (int32_t q = 0; q < length; q++)
    site[3 * q] = q;
  const bw_status st = bw_solid_create_same(comm, &c, length, site, NULL, pd);
  bw_release(&site);
  return st;
}

/* Projection of the velocity on the wave; sets the state when `start`. X0, V: (n,3). */
static double projection(bw_solid *pd, const wave *w, double k, bool start, double X0[], double V[])
{
  const size_t n = bw_solid_count(pd);
  double sum = 0;
  bw_solid_get_reference(pd, X0);
  if (!start) bw_solid_get_velocity(pd, V);
  for (size_t i = 0; i < n; i++) {
    double *v = &V[3 * i + (size_t)w->direction];
    if (start) *v = 1e-6 * sin(k * X0[3 * i]);
    sum += *v * sin(k * X0[3 * i]);
  }
  if (start) bw_solid_set_state(pd, X0, V);
  bw_comm_sum(bw_solid_comm(pd), 1, &sum);
  return sum;
}

/* Frequency from the first and the fifth zero: two periods. */
static bw_status frequency(bw_solid *pd, const wave *w, double k, double *omega)
{
  double *X0 = NULL, *V = NULL, zero[5] = {0};
  BW_TRY(BW_ALLOCATE(&X0, 3 * bw_solid_count(pd)));
  BW_TRY(BW_ALLOCATE(&V, 3 * bw_solid_count(pd)));
  double before = projection(pd, w, k, true, X0, V);
  const double dt = 0.25 * bw_solid_dt_max(pd);
  bw_status st = BW_OK;
  for (int64_t step = 0, found = 0; found < 5 && st == BW_OK; step++) {
    st = bw_solid_step(pd, dt);
    const double now = projection(pd, w, k, false, X0, V);
    if (before * now <= 0) zero[found++] = dt * ((double)step + before / (before - now));
    before = now;
  }
  *omega = 4 * LATTICE_PI / (zero[4] - zero[0]);
  bw_release(&X0);
  bw_release(&V);
  return st;
}

typedef struct {
  int direction;
} polarisation;

/* xi_x^2 xi_d^2/|xi|^3 */
static double stiffness(const double xi[3], const void *data)
{
  const double d = xi[((const polarisation *)data)->direction];
  const double r2 = xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2];
  return xi[0] * xi[0] * d * d / (r2 * sqrt(r2));
}

/* Long-wave modulus of the family over E: 1/2 c0 alpha times that sum; c0 of 3.21. */
static double family_modulus(const wave *w, double m)
{
  const bool planar = w->geometry != BW_PD_3D;
  const double c0[] = {12 / (LATTICE_PI * pow(m, 4)), 9 / (LATTICE_PI * pow(m, 3)),
                       9.6 / (LATTICE_PI * pow(m, 3))};
  const polarisation p = {w->direction};
  return 0.5 * c0[w->geometry] * lattice_alpha(m, planar, planar) *
         lattice_sum(m, planar, planar, stiffness, &p);
}

static bw_status measure(bw_validation *v, const wave *w, double m, int length)
{
  bw_solid *pd = NULL;
  double omega;
  char quantity[80], extra[80];
  const double k = 2 * LATTICE_PI / length, kd = k * m;
  BW_TRY(make(bw_validation_comm(v), w, m, length, &pd));
  BW_TRY(frequency(pd, w, k, &omega));
  bw_solid_destroy(&pd);
  const double modulus = fabs(family_modulus(w, m) / w->modulus - 1);
  snprintf(quantity, sizeof quantity, "speed_%s", w->name);
  snprintf(extra, sizeof extra, "\"m\": %g, \"spacings_per_wave\": %d", m, length);
  bw_validation_row(
      v, &(bw_claim){.claim = "long waves have the speed of elasticity",
                     .quantity = quantity,
                     .measured = omega / k,
                     .reference = sqrt(w->modulus * E / RHO * (1 - w->dispersion * kd * kd)),
                     .tolerance = 0.5 * modulus + 5e-4 + kd * kd * kd * kd / 1000 + 1e-4,
                     .kind = BW_ANALYTIC,
                     .source = "elastic moduli with nu fixed by bonds, dispersion expanded",
                     .extra = extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int q = 0; q < 4; q++) {
    BW_TRY(measure(v, &waves[q], 3, 40));
    BW_TRY(measure(v, &waves[q], 6, 80));
    BW_TRY(measure(v, &waves[q], 3, 20));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.wave_speed", run);
}
