/* What may be asked for, and the material constants that follow. */
#include "pd_bond_internal.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const double MOST_DISORDER = 0.4; /* neighbours stay 0.2 ds apart */

bw_pd_bond_config bw_pd_bond_config_default(void)
{
  return (bw_pd_bond_config){.geometry = BW_PD_3D,
                             .ds = NAN,
                             .thickness = 1,
                             .horizon_ratio = 3,
                             .rho = NAN,
                             .E = NAN,
                             .nu = NAN,
                             .G0 = INFINITY,
                             .volume_fraction = BW_PD_FRACTION_DEFAULT,
                             .surface_correction = BW_PD_SURFACE_VOLUME,
                             .integrator = BW_PD_VERLET,
                             .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

static double natural_poisson(bw_pd_geometry geometry)
{
  return geometry == BW_PD_PLANE_STRESS ? 1.0 / 3 : 0.25; /* ERRATA 14 */
}

/* Required positive numbers, by name. */
static bw_status check_positive(const bw_pd_bond_config *c)
{
  const struct {
    const char *name;
    double value;
    bool infinite_allowed;
  } row[] = {{"ds", c->ds, false}, {"rho", c->rho, false},
             {"E", c->E, false},   {"thickness", c->thickness, false},
             {"G0", c->G0, true},  {"horizon_ratio", c->horizon_ratio, false}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
    BW_REQUIRE(!isnan(row[q].value), BW_EINPUT, "pd_bond: %s is not set; it is required",
               row[q].name);
    BW_REQUIRE(row[q].value > 0 && (row[q].infinite_allowed || isfinite(row[q].value)), BW_EINPUT,
               "pd_bond: %s = %g must be positive", row[q].name, row[q].value);
  }
  BW_REQUIRE(c->horizon_ratio >= 1 && c->horizon_ratio <= 12, BW_EINPUT,
             "pd_bond: horizon_ratio = %g is outside 1 .. 12; 3 is usual", c->horizon_ratio);
  return BW_OK;
}

static bw_status check_damping(const bw_pd_bond_config *c)
{
  const double value[] = {c->damping_pair, c->damping_mean, c->damping_absolute};
  const char *name[] = {"damping_pair", "damping_mean", "damping_absolute"};
  for (int q = 0; q < 3; q++)
    BW_REQUIRE(value[q] >= 0 && isfinite(value[q]), BW_EINPUT,
               "pd_bond: %s = %g must be zero or positive", name[q], value[q]);
  return BW_OK;
}

static bw_status check_lattice(const bw_pd_bond_config *c)
{
  const bool planar = c->geometry != BW_PD_3D;
  for (int a = 0; a < 3; a++) {
    BW_REQUIRE(isfinite(c->origin[a]), BW_EINPUT, "pd_bond: origin[%d] is not finite", a);
    for (int b = 0; b < 3; b++) {
      double dot = 0;
      for (int k = 0; k < 3; k++)
        dot += c->axes[a][k] * c->axes[b][k];
      BW_REQUIRE(fabs(dot - (a == b)) < 1e-12, BW_EINPUT,
                 "pd_bond: axes rows %d and %d have the product %g; they must be unit vectors at "
                 "right angles",
                 a, b, dot);
    }
    const double cells = c->period[a] / c->ds;
    BW_REQUIRE(c->period[a] >= 0 && fabs(cells - round(cells)) < 1e-6, BW_EINPUT,
               "pd_bond: period[%d] = %g is %g ds; it must be a whole number of ds", a,
               c->period[a], cells);
    BW_REQUIRE(c->period[a] == 0 || !c->contact || cells > 3.5, BW_EINPUT,
               "pd_bond: period[%d] = %g with contact needs at least 4 ds", a, c->period[a]);
  }
  BW_REQUIRE(!planar || (c->axes[2][2] == 1 && c->period[2] == 0), BW_EINPUT,
             "pd_bond: in 2D the third axis is (0,0,1) and not periodic; found axes[2][2] = %g, "
             "period[2] = %g",
             c->axes[2][2], c->period[2]);
  return BW_OK;
}

/* The cells of a cloud are no cubes: only the linear fraction knows nothing of their shape. */
static bw_status check_fraction(const bw_pd_bond_config *c)
{
  BW_REQUIRE(c->disorder >= 0 && c->disorder <= MOST_DISORDER, BW_EINPUT,
             "pd_bond: disorder = %g must be from 0 (a lattice) to %g spacings", c->disorder,
             MOST_DISORDER);
  BW_REQUIRE(c->disorder == 0 || 1 + 2 * c->disorder < bw_pd_bond__family_reach(c), BW_EINPUT,
             "pd_bond: disorder = %g moves neighbours %g spacings apart, out of the family's reach "
             "of %g; use less of it or a larger horizon_ratio",
             c->disorder, 1 + 2 * c->disorder, bw_pd_bond__family_reach(c));
  BW_REQUIRE(c->disorder == 0 || c->volume_fraction != BW_PD_FRACTION_EXACT, BW_EINPUT,
             "pd_bond: volume_fraction = exact is of cells on a lattice; with disorder = %g use "
             "linear (the default) or none",
             c->disorder);
  BW_REQUIRE((unsigned)c->volume_fraction <= BW_PD_FRACTION_DEFAULT &&
                 !(c->geometry == BW_PD_3D && c->disorder == 0 &&
                   c->volume_fraction == BW_PD_FRACTION_LINEAR),
             BW_EINPUT,
             "pd_bond: volume_fraction = %d; on a lattice the linear one is of 2D only, use exact "
             "or none in 3D",
             (int)c->volume_fraction);
  return BW_OK;
}

bw_status bw_pd_bond__check_config(const bw_pd_bond_config *c)
{
  BW_TRY(check_positive(c));
  BW_REQUIRE((unsigned)c->geometry <= BW_PD_PLANE_STRAIN, BW_EINPUT, "pd_bond: geometry = %d",
             (int)c->geometry);
  const double nu = natural_poisson(c->geometry);
  BW_REQUIRE(
      isnan(c->nu) || fabs(c->nu - nu) < 1e-9, BW_EINPUT,
      "pd_bond: nu = %g, but bonds fix it to %s in this geometry (ERRATA 14); leave nu out or "
      "set it to that",
      c->nu, c->geometry == BW_PD_PLANE_STRESS ? "1/3" : "1/4");
  BW_TRY(check_fraction(c));
  BW_REQUIRE((unsigned)c->surface_correction <= BW_PD_SURFACE_TENSOR, BW_EINPUT,
             "pd_bond: surface_correction = %d is unknown", (int)c->surface_correction);
  BW_REQUIRE(c->surface_correction != BW_PD_SURFACE_TENSOR || c->disorder == 0, BW_EINPUT,
             "pd_bond: surface_correction = tensor is of lattices; with disorder = %g use energy",
             c->disorder);
  BW_REQUIRE((unsigned)c->calibration <= BW_PD_CALIBRATION_LATTICE, BW_EINPUT,
             "pd_bond: calibration = %d is unknown", (int)c->calibration);
  BW_REQUIRE((unsigned)c->integrator <= BW_PD_RK3, BW_EINPUT, "pd_bond: integrator = %d is unknown",
             (int)c->integrator);
  BW_REQUIRE((unsigned)c->family_reach <= BW_PD_REACH_HORIZON, BW_EINPUT,
             "pd_bond: family_reach = %d is unknown", (int)c->family_reach);
  BW_TRY(check_damping(c));
  return check_lattice(c);
}

/* 3.21 and 3.27 with ERRATA 1; reference/solid_analytic.md has the same constants. */
void bw_pd_bond__material(bw_pd_bond *pd)
{
  bw_pd_bond_config *c = &pd->config;
  const double d = pd->horizon = c->horizon_ratio * c->ds, t = c->thickness;
  const bool planar = c->geometry != BW_PD_3D;
  const double micromodulus[] = {12 * c->E / (PI * d * d * d * d), 9 * c->E / (PI * t * d * d * d),
                                 48 * c->E / (5 * PI * t * d * d * d)};
  const double stretch2[] = {5 / (6 * c->E * d), 4 * PI / (9 * c->E * d), 5 * PI / (12 * c->E * d)};
  pd->dimension = planar ? 2 : 3;
  pd->c0 = micromodulus[c->geometry];
  pd->s0 = sqrt(stretch2[c->geometry] * c->G0);
  pd->dv = c->ds * c->ds * (planar ? t : c->ds);
  c->nu = natural_poisson(c->geometry);
  if (c->volume_fraction == BW_PD_FRACTION_DEFAULT)
    c->volume_fraction = planar || c->disorder > 0 ? BW_PD_FRACTION_LINEAR : BW_PD_FRACTION_EXACT;
}

/* The kernels' constants, once s0 is known. */
void bw_pd_bond__constants(bw_pd_bond *pd)
{
  static const double factor[] = {1, 2, 0.5, BW_PD_ALPHA_UNIT}; /* none; volume: 2/(w+w); energy:
                                                             (g+g)/2; tensor: whole numbers */
  const bw_pd_stencil *s = &pd->stencil;
  const bool cloud = pd->config.disorder > 0;
  for (int q = 0; q < s->n; q++) {
    bw_real *row = s->row + q * BW_PD_ROW;
    const double r0 = cloud ? 1 : s->r0[q], gamma = cloud ? 1 : s->fraction[q];
    const double limit = r0 * (1 + pd->s0);
    for (int k = 0; k < 3; k++)
      row[BW_PD_XI + k] = (bw_real)s->xi[3 * q + k];
    row[BW_PD_R0] = (bw_real)r0;
    row[BW_PD_MINUS_R0] = (bw_real)-r0;
    row[BW_PD_STIFFNESS] = (bw_real)(factor[pd->config.surface_correction] * pd->c0 * gamma *
                                     pd->dv / (pd->config.rho * r0));
    row[BW_PD_LIMIT2] = (bw_real)(limit * limit);
    row[BW_PD_WEIGHT] = (bw_real)(gamma * pd->dv);
  }
}
