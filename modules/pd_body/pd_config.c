/* What may be asked for, and the levels that follow. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <stdio.h>

static const double MOST_DISORDER = 0.4; /* neighbours stay 0.2 ds apart */

double bw_pd_body_natural_poisson(bw_pd_geometry geometry)
{
  return geometry == BW_PD_PLANE_STRESS ? 1.0 / 3 : 0.25; /* ERRATA 14 */
}

/* Required positive numbers, by name. */
static bw_status positive(const char *name, double value, bool infinite_allowed)
{
  BW_REQUIRE(!isnan(value), BW_EINPUT, "solid: %s is not set; it is required", name);
  BW_REQUIRE(value > 0 && (infinite_allowed || isfinite(value)), BW_EINPUT,
             "solid: %s = %g must be positive", name, value);
  return BW_OK;
}

/* The same of a group; the first one's keys have no prefix. */
static bw_status positive_of(int group, const char *key, double value, bool infinite_allowed)
{
  char name[32];
  if (group == 0) return positive(key, value, infinite_allowed);
  snprintf(name, sizeof name, "more[%d].%s", group - 1, key);
  return positive(name, value, infinite_allowed);
}

/* Both ends of a bond have to decide alike whether it breaks. */
static bw_status check_joints(const bw_pd_body_config *c)
{
  for (int g = 0; g < c->n_group; g++)
    for (int h = 0; h < c->n_group; h++) {
      const double G0 = c->joint_G0[g][h], back = c->joint_G0[h][g];
      if (g == h || (isnan(G0) && isnan(back))) continue;
      BW_REQUIRE(G0 > 0 && G0 == back, BW_EINPUT,
                 "solid: joint_G0[%d][%d] = %g and joint_G0[%d][%d] = %g must be positive and the "
                 "same; leave both out for the smaller G0 of the two groups",
                 g, h, G0, h, g, back);
    }
  return BW_OK;
}

static bw_status check_positive(const bw_pd_body_config *c)
{
  BW_TRY(positive("ds", c->ds, false));
  BW_REQUIRE(c->n_group >= 1 && c->n_group <= BW_PD_GROUPS, BW_EINPUT,
             "solid: n_group = %d must be from 1 to %d", c->n_group, (int)BW_PD_GROUPS);
  for (int g = 0; g < c->n_group; g++) {
    BW_TRY(positive_of(g, "rho", c->material[g].rho, false));
    BW_TRY(positive_of(g, "E", c->material[g].E, false));
  }
  BW_TRY(positive("thickness", c->thickness, false));
  for (int g = 0; g < c->n_group; g++)
    BW_TRY(positive_of(g, "G0", c->material[g].G0, true));
  BW_TRY(check_joints(c));
  BW_TRY(positive("horizon_ratio", c->horizon_ratio, false));
  BW_REQUIRE(c->horizon_ratio >= 1 && c->horizon_ratio <= 12, BW_EINPUT,
             "solid: horizon_ratio = %g is outside 1 .. 12; 3 is usual", c->horizon_ratio);
  return BW_OK;
}

static bw_status check_lattice(const bw_pd_body_config *c)
{
  /* Turned axes have to stay a lattice of cubes: unit vectors at right angles, to rounding. */
  const bool planar = c->geometry != BW_PD_3D;
  for (int a = 0; a < 3; a++) {
    BW_REQUIRE(isfinite(c->origin[a]), BW_EINPUT, "solid: origin[%d] is not finite", a);
    for (int b = 0; b < 3; b++) {
      double dot = 0;
      for (int k = 0; k < 3; k++)
        dot += c->axes[a][k] * c->axes[b][k];
      BW_REQUIRE(fabs(dot - (a == b)) < 1e-12, BW_EINPUT,
                 "solid: axes rows %d and %d have the product %g; they must be unit vectors at "
                 "right angles",
                 a, b, dot);
    }
    /* Across a period the lattice has to meet itself. */
    const double cells = c->period[a] / c->ds;
    BW_REQUIRE(c->period[a] >= 0 && fabs(cells - round(cells)) < 1e-6, BW_EINPUT,
               "solid: period[%d] = %g is %g ds; it must be a whole number of ds", a, c->period[a],
               cells);
  }
  /* A plane body is one layer: nothing turns out of it, nothing repeats across it. */
  BW_REQUIRE(!planar || (c->axes[2][2] == 1 && c->period[2] == 0), BW_EINPUT,
             "solid: in 2D the third axis is (0,0,1) and not periodic; found axes[2][2] = %g, "
             "period[2] = %g",
             c->axes[2][2], c->period[2]);
  return BW_OK;
}

/* The cells of a cloud are no cubes: only the linear fraction knows nothing of their shape. */
static bw_status check_fraction(const bw_pd_body_config *c)
{
  /* With more of it two neighbours could start nearly in the same place. */
  BW_REQUIRE(c->disorder >= 0 && c->disorder <= MOST_DISORDER, BW_EINPUT,
             "solid: disorder = %g must be from 0 (a lattice) to %g spacings", c->disorder,
             MOST_DISORDER);
  /* Nearest neighbours have to be family wherever both went. */
  BW_REQUIRE(c->disorder == 0 || 1 + 2 * c->disorder < bw_pd_body_family_reach(c), BW_EINPUT,
             "solid: disorder = %g moves neighbours %g spacings apart, out of the family's reach "
             "of %g; use less of it or a larger horizon_ratio",
             c->disorder, 1 + 2 * c->disorder, bw_pd_body_family_reach(c));
  BW_REQUIRE(c->disorder == 0 || c->volume_fraction != BW_PD_FRACTION_EXACT, BW_EINPUT,
             "solid: volume_fraction = exact is of cells on a lattice; with disorder = %g use "
             "linear (the default) or none",
             c->disorder);
  /* In space the share is the part of the cube inside the ball (ERRATA 2). */
  BW_REQUIRE((unsigned)c->volume_fraction <= BW_PD_FRACTION_DEFAULT &&
                 !(c->geometry == BW_PD_3D && c->disorder == 0 &&
                   c->volume_fraction == BW_PD_FRACTION_LINEAR),
             BW_EINPUT,
             "solid: volume_fraction = %d; on a lattice the linear one is of 2D only, use exact "
             "or none in 3D",
             (int)c->volume_fraction);
  return BW_OK;
}

/* A box has an extent, a level, and finer cells where the horizon does not reach across itself. */
static bw_status check_boxes(const bw_pd_body_config *c)
{
  const int axes = c->geometry == BW_PD_3D ? 3 : 2;
  BW_REQUIRE(c->finer.n >= 0 && c->finer.n <= BW_PD_BOXES, BW_EINPUT,
             "solid: %d boxes of levels; 0 to %d can be given", c->finer.n, (int)BW_PD_BOXES);
  BW_REQUIRE((unsigned)c->finer.jump <= BW_PD_JUMP_ONE_SIDED, BW_EINPUT,
             "solid: jump = %d is unknown", (int)c->finer.jump);
  for (int b = 0; b < c->finer.n; b++) {
    const bw_pd_box *box = &c->finer.box[b];
    BW_REQUIRE(box->level >= 1 && box->level <= BW_PD_FINEST, BW_EINPUT,
               "solid: levels[%d].level = %d must be from 1 (half the spacing) to %d", b,
               box->level, (int)BW_PD_FINEST);
    for (int k = 0; k < axes; k++)
      BW_REQUIRE(box->lower[k] < box->upper[k], BW_EINPUT,
                 "solid: levels[%d] reaches from %g to %g in direction %d: lower must be less than "
                 "upper",
                 b, box->lower[k], box->upper[k], k);
  }
  BW_REQUIRE(bw_pd_body_finest(c) == 0 || c->disorder == 0, BW_EINPUT,
             "solid: disorder = %g with levels: a cloud has one level; leave one of them out",
             c->disorder);
  return BW_OK;
}

bw_status bw_pd_body_check(const bw_pd_body_config *c)
{
  BW_TRY(check_positive(c));
  BW_REQUIRE((unsigned)c->geometry <= BW_PD_PLANE_STRAIN, BW_EINPUT, "solid: geometry = %d",
             (int)c->geometry);
  BW_TRY(check_fraction(c));
  BW_REQUIRE((unsigned)c->family_reach <= BW_PD_REACH_HORIZON, BW_EINPUT,
             "solid: family_reach = %d is unknown", (int)c->family_reach);
  BW_TRY(check_boxes(c));
  return check_lattice(c);
}

bw_status bw_pd_body_levels(bw_pd_body *pd)
{
  bw_pd_body_config *c = &pd->config;
  const bool planar = c->geometry != BW_PD_3D;
  pd->dimension = planar ? 2 : 3;
  /* The default is resolved here: whoever reads the configuration later sees what is used. */
  if (c->volume_fraction == BW_PD_FRACTION_DEFAULT)
    c->volume_fraction = planar || c->disorder > 0 ? BW_PD_FRACTION_LINEAR : BW_PD_FRACTION_EXACT;
  /* What others read of a spacing or a volume they read here. */
  pd->finest = bw_pd_body_finest(c);
  BW_TRY(BW_ALLOCATE(&pd->level, (size_t)pd->finest + 1));
  for (int l = 0; l <= pd->finest; l++) {
    const double ds = ldexp(c->ds, -l), half = c->family_reach == BW_PD_REACH_HORIZON ? 0 : 0.5;
    const int shrinks = c->finer.same_horizon ? 0 : l;
    pd->level[l] = (bw_pd_level){.ds = ds,
                                 .stiff = ldexp(1, (pd->dimension + 1) * shrinks),
                                 .stretch = sqrt(ldexp(1, shrinks)),
                                 .horizon = ldexp(c->horizon_ratio * c->ds, -shrinks),
                                 .reach = ds * (ldexp(c->horizon_ratio, l - shrinks) + half),
                                 .dv = ds * ds * (planar ? c->thickness : ds),
                                 .area = ds * (planar ? c->thickness : ds)};
  }
  return BW_OK;
}
