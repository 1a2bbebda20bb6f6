/* The energy it takes to open a flat crack.
 *
 * Claim      Two halves drawn apart dissipate G0 per area (POROUS 3.25, ERRATA 1), up to the error
 * of the family sum. Reference  G0; and the sum 1/2 c0 alpha s0^2 sum |xi| Gamma xi_z over bonds
 * that cross a plane, written independently. Measured   the ledger's fracture energy over the area:
 * a column of one cell, periodic sideways, its halves moved apart by prescribed velocities in steps
 * of 1e-3 s0 ds until all broke. Tolerance  against the sum: 2.5e-3, of which 2e-3 is the overshoot
 * of one step (energy goes with the square of the stretch). Against G0: lattice_bound with p = 2
 * and the own cell. BUILD modules=pd_bond */
#include "bw_memory.h"
#include "bw_pd_bond.h"
#include "bw_validation.h"
#include "lattice_sum.h"

#include <stdio.h>

static const double E = 5, S0 = 1e-3;

typedef struct {
  const char *name;
  bw_pd_geometry geometry;
  double c0, G0; /* c0 delta^4 (3D) or c0 delta^3, over E; G0 over E s0^2 delta */
} setting;

/* 3.21 and 3.27. */
static const setting settings[] = {
    {"3d", BW_PD_3D, 12 / 3.14159265358979323846, 1.2},
    {"plane_stress", BW_PD_PLANE_STRESS, 9 / 3.14159265358979323846, 2.25 / 3.14159265358979323846},
    {"plane_strain", BW_PD_PLANE_STRAIN, 9.6 / 3.14159265358979323846,
     2.4 / 3.14159265358979323846}};

/* Bonds of a column that cross a plane normal to direction 1: |xi| times the number of planes. */
static double crossing(const double xi[3], const void *data)
{
  (void)data;
  const double r = sqrt(xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
  return xi[1] > 0 ? r * xi[1] : 0;
}

/* The column lies along direction 1; half its particles move up, half down. */
static bw_status column(const bw_comm *comm, const setting *s, double m, int height,
                        bw_pd_bond **pd)
{
  bw_pd_bond_config c = bw_pd_bond_config_default();
  c.geometry = s->geometry;
  c.ds = c.rho = 1;
  c.E = E;
  c.horizon_ratio = m;
  c.G0 = s->G0 * E * S0 * S0 * m;
  c.period[0] = 1;
  c.period[2] = s->geometry == BW_PD_3D ? 1 : 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * (size_t)height));
  BW_TRY(BW_ALLOCATE(&kind, (size_t)height));
  for (int32_t q = 0; q < height; q++) {
    site[3 * q + 1] = q;
    kind[q] = BW_PD_PRESCRIBED;
  }
  const bw_status st = bw_pd_bond_create(comm, &c, height, site, kind, pd);
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static bw_status open(bw_pd_bond *pd, int height, int64_t crossing_bonds)
{
  const size_t n = bw_pd_bond_count(pd);
  const double dt = 0.5 * bw_pd_bond_dt_max(pd), speed = 1e-3 * S0 / dt;
  double *V = NULL;
  BW_TRY(BW_ALLOCATE(&V, 3 * n));
  bw_pd_bond_get_reference(pd, V);
  for (size_t i = 0; i < n; i++) {
    V[3 * i] = V[3 * i + 2] = 0;
    V[3 * i + 1] = V[3 * i + 1] < 0.5 * height ? -speed : speed;
  }
  bw_pd_bond_set_prescribed(pd, V);
  bw_release(&V);
  for (int step = 0; step < 400000; step++) {
    BW_TRY(bw_pd_bond_step(pd, dt));
    if (step % 500 == 0 && bw_pd_bond_account(pd).broken >= crossing_bonds) return BW_OK;
  }
  return BW_FAIL(BW_EDIVERGED, "fracture_energy: the column did not come apart");
}

static double crossing_count(const double xi[3], const void *data)
{
  (void)data;
  return xi[1] > 0 ? xi[1] : 0;
}

/* Number of bonds through the plane: the family without fractions. */
static int64_t count_crossing(double m, bool planar)
{
  const int r = (int)(m + 1);
  double sum = 0;
  for (int z = planar ? 0 : -r; z <= (planar ? 0 : r); z++)
    for (int y = 1; y <= r; y++)
      for (int x = -r; x <= r; x++)
        if (x * x + y * y + z * z < (m + 0.5) * (m + 0.5))
          sum += crossing_count((double[]){x, y, z}, NULL);
  return (int64_t)sum;
}

static bw_status measure(bw_validation *v, const setting *s, double m)
{
  const bool planar = s->geometry != BW_PD_3D;
  const int height = 6 * (int)(m + 0.5);
  char quantity[80], extra[80];
  bw_pd_bond *pd = NULL;
  BW_TRY(column(bw_validation_comm(v), s, m, height, &pd));
  BW_TRY(open(pd, height, count_crossing(m, planar)));
  const double G = bw_pd_bond_account(pd).fracture; /* area 1 */
  bw_pd_bond_destroy(&pd);
  const double c0 = s->c0 * E / pow(m, planar ? 3 : 4), G0 = s->G0 * E * S0 * S0 * m;
  const double sum = 0.5 * c0 * S0 * S0 * lattice_alpha(m, planar, planar) *
                     lattice_sum(m, planar, planar, crossing, NULL);
  const double own_cell = planar ? 1 / (LATTICE_PI * m * m) : 3 / (4 * LATTICE_PI * m * m * m);
  snprintf(quantity, sizeof quantity, "G_%s", s->name);
  snprintf(extra, sizeof extra, "\"m\": %g", m);
  bw_validation_row(v, &(bw_claim){.claim = "opening a crack takes the sum over crossing bonds",
                                   .quantity = quantity,
                                   .measured = G,
                                   .reference = sum,
                                   .tolerance = 4e-3,
                                   .kind = BW_ANALYTIC,
                                   .source = "sum over crossing bonds, written independently",
                                   .extra = extra});
  bw_validation_row(v, &(bw_claim){.claim = "opening a crack takes G0 per area",
                                   .quantity = quantity,
                                   .measured = G,
                                   .reference = G0,
                                   .tolerance = lattice_bound(m, planar, 2) + own_cell,
                                   .kind = BW_ANALYTIC,
                                   .source = "POROUS 3.25-3.27, ERRATA 1",
                                   .extra = extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  for (int q = 0; q < 3; q++) {
    BW_TRY(measure(v, &settings[q], 3));
    BW_TRY(measure(v, &settings[q], q == 0 ? 5 : 6));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.fracture_energy", run);
}
