/* Energy density of the bulk under uniform strain.
 *
 * Claim      A body under uniform strain stores the energy density of classical elasticity with the
 *            Poisson ratio that bonds fix (ERRATA 14), up to the error of the family sum.
 * Reference  1/2 sigma : eps (isotropic, uniaxial strain, shear); and the family sum written
 *            independently (lattice_sum.h).
 * Measured   the ledger's elastic energy of blocks of a, a+1 by b, b+1 (by c, c+1): the mixed
 *            difference is the energy of one interior particle, free of surfaces and edges.
 * Tolerance  against the family sum: 1e-3, the error of its midpoint fractions. Against elasticity:
 *            the error of the family sum itself, known before the run, plus the same 1e-3; and it
 * has to fall like m^-2: the mass of a cell cut by the horizon sits at its centre, off the inner
 * part's centroid by 1/12 of a spacing on average, which is (1/m^2)/3 of the isotropic energy in
 * space and /4 in the plane, where the own cell that alpha makes up for adds 1/(pi m^2). The order
 * is taken between m = 3 and 8; sums over a lattice scatter about the trend, by 0.5 in the order
 * between these two.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_validation.h"
#include "lattice_sum.h"

#include <stdio.h>

static const double E = 7, STRAIN = 1e-6;

typedef struct {
  const char *name;
  double eps[3][3]; /* in the plane of the first two directions for 2D */
} strain;

static const strain strains[] = {{"isotropic", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                 {"uniaxial", {{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}},
                                 {"shear", {{0, 0.5, 0}, {0.5, 0, 0}, {0, 0, 0}}}};

typedef struct {
  bw_pd_geometry geometry;
  const char *name;
  double lambda, mu; /* over E; plane stress: the reduced lambda */
} material;

/* nu = 1/4: lambda = mu = 2/5; plane stress with nu = 1/3: mu = 3/8, lambda = 2 mu nu/(1 - nu). */
static const material materials[] = {{BW_PD_3D, "3d", 0.4, 0.4},
                                     {BW_PD_PLANE_STRESS, "plane_stress", 0.375, 0.375},
                                     {BW_PD_PLANE_STRAIN, "plane_strain", 0.4, 0.4}};

static double classical(const material *m, const strain *s)
{
  const int d = m->geometry == BW_PD_3D ? 3 : 2;
  double trace = 0, square = 0;
  for (int i = 0; i < d; i++) {
    trace += s->eps[i][i];
    for (int j = 0; j < d; j++)
      square += s->eps[i][j] * s->eps[i][j];
  }
  return E * (0.5 * m->lambda * trace * trace + m->mu * square);
}

/* |xi| stretch^2 = (xi.eps.xi)^2/|xi|^3 */
static double bond_energy(const double xi[3], const void *data)
{
  const strain *s = data;
  double along = 0, r2 = 0;
  for (int i = 0; i < 3; i++) {
    r2 += xi[i] * xi[i];
    for (int j = 0; j < 3; j++)
      along += xi[i] * s->eps[i][j] * xi[j];
  }
  return along * along / (r2 * sqrt(r2));
}

/* 1/4 c0 alpha sum: c0 of 3.21 for spacing 1 and thickness 1. */
static double family_sum(const material *g, double m, const strain *s)
{
  const bool planar = g->geometry != BW_PD_3D;
  const double c0[] = {12 * E / (LATTICE_PI * pow(m, 4)), 9 * E / (LATTICE_PI * pow(m, 3)),
                       48 * E / (5 * LATTICE_PI * pow(m, 3))};
  return 0.25 * c0[g->geometry] * lattice_alpha(m, planar, planar) *
         lattice_sum(m, planar, planar, bond_energy, s);
}

static bw_status block_energy(const bw_comm *comm, const material *g, double m, const strain *s,
                              const int size[3], double *energy)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = g->geometry;
  c.ds = c.rho = 1;
  c.E = E;
  c.horizon_ratio = m;
  const int64_t n = (int64_t)size[0] * size[1] * size[2];
  int32_t *site = NULL;
  bw_solid *pd = NULL;
  double *X = NULL, *V = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * (size_t)n));
  for (int64_t q = 0; q < n; q++) {
    site[3 * q] = (int32_t)(q % size[0]);
    site[3 * q + 1] = (int32_t)(q / size[0] % size[1]);
    site[3 * q + 2] = (int32_t)(q / size[0] / size[1]);
  }
  BW_TRY(bw_solid_create_same(comm, &c, n, site, NULL, &pd));
  const size_t mine = bw_solid_count(pd);
  BW_TRY(BW_ALLOCATE(&X, 3 * mine));
  BW_TRY(BW_ALLOCATE(&V, 3 * mine));
  bw_solid_get_reference(pd, X);
  for (size_t i = 0; i < mine; i++) {
    const double x[3] = {X[3 * i], X[3 * i + 1], X[3 * i + 2]};
    for (size_t k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++)
        X[3 * i + k] += STRAIN * s->eps[k][j] * x[j];
  }
  bw_solid_set_state(pd, X, V);
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  *energy = e.elastic / (STRAIN * STRAIN);
  bw_solid_destroy(&pd);
  bw_release(&site);
  bw_release(&X);
  bw_release(&V);
  return BW_OK;
}

/* The mixed difference over blocks of which every edge is past four reaches or one longer. */
static bw_status bulk_energy(const bw_comm *comm, const material *g, double m, const strain *s,
                             double *energy)
{
  const int d = g->geometry == BW_PD_3D ? 3 : 2, edge = 4 * (int)(m + 0.5) + 1;
  *energy = 0;
  for (int corner = 0; corner < 1 << d; corner++) {
    int size[3] = {edge, edge, d == 3 ? edge : 1}, sign = d % 2 == 0 ? 1 : -1;
    for (int k = 0; k < d; k++)
      if (corner >> k & 1) size[k]++, sign = -sign;
    double one;
    BW_TRY(block_energy(comm, g, m, s, size, &one));
    *energy += sign * one;
  }
  return BW_OK;
}

static bw_status measure(bw_validation *v, const material *g, double m, const strain *s,
                         double *error)
{
  char quantity[80], extra[80];
  double energy;
  BW_TRY(bulk_energy(bw_validation_comm(v), g, m, s, &energy));
  const double sum = family_sum(g, m, s), elastic = classical(g, s);
  *error = fabs(energy / elastic - 1);
  snprintf(quantity, sizeof quantity, "energy_%s_%s", g->name, s->name);
  snprintf(extra, sizeof extra, "\"m\": %g", m);
  bw_validation_row(v, &(bw_claim){.claim = "bulk energy density is the family sum",
                                   .quantity = quantity,
                                   .measured = energy,
                                   .reference = sum,
                                   .tolerance = 1e-3,
                                   .kind = BW_ANALYTIC,
                                   .source = "family sum, written independently",
                                   .extra = extra});
  bw_validation_row(v, &(bw_claim){.claim = "bulk energy density is that of elasticity",
                                   .quantity = quantity,
                                   .measured = energy,
                                   .reference = elastic,
                                   .tolerance = fabs(sum / elastic - 1) + 1e-3,
                                   .kind = BW_ANALYTIC,
                                   .source = "1/2 sigma : eps, nu fixed by bonds",
                                   .extra = extra});
  return BW_OK;
}

/* Isotropic strain: the one of the derivation. */
static bw_status order(bw_validation *v, const material *g)
{
  double coarse, fine;
  char quantity[80];
  BW_TRY(measure(v, g, 3, &strains[0], &coarse));
  BW_TRY(measure(v, g, 8, &strains[0], &fine));
  snprintf(quantity, sizeof quantity, "order_%s", g->name);
  bw_validation_row(v, &(bw_claim){.claim = "the error falls with the square of the spacing",
                                   .quantity = quantity,
                                   .measured = bw_validation_order(8, coarse, 3, fine),
                                   .reference = 2,
                                   .tolerance = 0.25,
                                   .kind = BW_ORDER,
                                   .source = "centroids of cut cells"});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int g = 0; g < 3; g++) {
    double error;
    if (g > 0 || bw_validation_full(v)) BW_TRY(order(v, &materials[g]));
    for (int q = g > 0 ? 1 : 0; q < 3; q++)
      for (double m = 3; m < (g == 0 ? 4 : 9); m += 2.5)
        BW_TRY(measure(v, &materials[g], m, &strains[q], &error));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.uniform_strain", run);
}
