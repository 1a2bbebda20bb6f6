/* From a choice of plain numbers to a law's options. */
#include "solid_internal.h"

#include <math.h>

static const double RADIAN = 3.14159265358979323846 / 180;

bw_solid_law_choice bw_solid_law_choice_default(void)
{
  const bw_pd_state_correspondence_options o = bw_pd_state_correspondence_options_default();
  return (bw_solid_law_choice){.law = BW_SOLID_BOND,
                               .poisson_ratio = NAN,
                               .influence = BW_PD_STATE_CONSTANT,
                               .weight = (int)o.weight,
                               .elastic = (int)o.elastic,
                               .stabilisation = o.stabilisation,
                               .breaks = (int)o.breaks,
                               .limit = NAN,
                               .plastic = BW_SOLID_ELASTIC,
                               .yield_stress = NAN,
                               .hardening = NAN,
                               .cohesion = NAN,
                               .friction_angle = NAN,
                               .dilation_angle = NAN,
                               .cone = BW_PD_MATERIAL_PLANE_ISOCHORIC};
}

/* A number that something needs, and that is there for nothing else. */
static bw_status needed(const char *key, double value, bool asked, const char *by, bool positive)
{
  BW_REQUIRE(asked || isnan(value), BW_EINPUT,
             "solid: %s = %g is read only with %s; leave it out or choose that", key, value, by);
  BW_REQUIRE(!asked || !positive || (value > 0 && isfinite(value)), BW_EINPUT,
             "solid: %s = %g must be given and positive with %s", key, value, by);
  return BW_OK;
}

/* An angle of friction or dilation, 0 .. below 90 degrees. */
static bw_status angle(const char *key, double value)
{
  BW_REQUIRE(isnan(value) || (value >= 0 && value < 90), BW_EINPUT,
             "solid: %s = %g must be from 0 to below 90 degrees", key, value);
  return BW_OK;
}

/* Whether bonds break by a criterion that knows friction. */
static bool breaks_by_friction(const bw_solid_law_choice *c)
{
  return c->breaks == BW_PD_STATE_BREAKS_BY_MOHR_COULOMB || c->breaks == BW_PD_STATE_BREAKS_BY_CONE;
}

static bw_status check_plastic(const bw_solid_law_choice *c)
{
  const bool j2 = c->plastic == BW_SOLID_J2, cone = c->plastic == BW_SOLID_DRUCKER_PRAGER;
  const bool friction = cone || breaks_by_friction(c);
  BW_TRY(needed("yield_stress", c->yield_stress, j2, "plastic: j2", true));
  BW_TRY(needed("hardening", c->hardening, j2, "plastic: j2", false));
  BW_TRY(needed("cohesion", c->cohesion, cone, "plastic: drucker_prager", true));
  BW_TRY(needed("friction_angle", c->friction_angle, friction,
                "plastic: drucker_prager, breaks: mohr_coulomb or drucker_prager", false));
  BW_TRY(needed("dilation_angle", c->dilation_angle, cone, "plastic: drucker_prager", false));
  BW_TRY(angle("friction_angle", c->friction_angle));
  BW_TRY(angle("dilation_angle", c->dilation_angle));
  BW_REQUIRE(!friction || !isnan(c->friction_angle), BW_EINPUT,
             "solid: friction_angle must be given with plastic: drucker_prager and with breaks: "
             "mohr_coulomb or drucker_prager");
  BW_REQUIRE(!(c->dilation_angle > c->friction_angle), BW_EINPUT,
             "solid: dilation_angle = %g is above friction_angle = %g; such a material would give "
             "energy",
             c->dilation_angle, c->friction_angle);
  BW_REQUIRE(!(c->hardening < 0), BW_EINPUT,
             "solid: hardening = %g must be 0 or more; what softens has no width of its own",
             c->hardening);
  return BW_OK;
}

bw_status bw_solid_law_check(const bw_solid_law_choice *c)
{
  const bool correspondence = c->law == BW_SOLID_CORRESPONDENCE;
  BW_REQUIRE(c->law >= BW_SOLID_BOND && c->law <= BW_SOLID_CORRESPONDENCE, BW_EINPUT,
             "solid: law = %d is unknown", c->law);
  BW_REQUIRE(c->law != BW_SOLID_BOND || isnan(c->poisson_ratio) ||
                 fabs(c->poisson_ratio - 0.25) < 1e-9 || fabs(c->poisson_ratio - 1.0 / 3) < 1e-9,
             BW_EINPUT,
             "solid: poisson_ratio = %g, but bonds fix it to 1/4, in plane stress 1/3; choose law: "
             "ordinary or correspondence",
             c->poisson_ratio);
  BW_REQUIRE(correspondence || c->plastic == BW_SOLID_ELASTIC, BW_EINPUT,
             "solid: plastic is read only with law: correspondence");
  BW_REQUIRE(correspondence || c->breaks == BW_PD_STATE_BREAKS_BY_STRETCH, BW_EINPUT,
             "solid: breaks is read only with law: correspondence");
  BW_TRY(needed("limit", c->limit, c->breaks != BW_PD_STATE_BREAKS_BY_STRETCH,
                "breaks: other than stretch", true));
  BW_REQUIRE(c->breaks != BW_PD_STATE_BREAKS_BY_FLOW || c->plastic != BW_SOLID_ELASTIC, BW_EINPUT,
             "solid: breaks: flow, but nothing flows; choose plastic: j2 or drucker_prager");
  return check_plastic(c);
}

static bw_pd_material_yield yield_of(const bw_solid_law_choice *c)
{
  if (c->plastic == BW_SOLID_J2)
    return bw_pd_material_j2(c->yield_stress, isnan(c->hardening) ? 0 : c->hardening);
  if (c->plastic == BW_SOLID_DRUCKER_PRAGER)
    return bw_pd_material_drucker_prager((bw_pd_material_cone)c->cone, c->cohesion,
                                         c->friction_angle * RADIAN,
                                         isnan(c->dilation_angle) ? 0 : c->dilation_angle * RADIAN);
  return (bw_pd_material_yield){.k = INFINITY};
}

const void *bw_solid__law_options(const bw_solid_config *c, const bw_pd_law *law,
                                  bw_solid_options *store)
{
  const bw_solid_law_choice *choice = &c->choice;
  if (law == &bw_pd_bond_law) {
    store->bond = (bw_pd_bond_options){c->surface_correction, c->calibration};
    return &store->bond;
  }
  if (law == &bw_pd_state_ordinary_law) {
    store->ordinary.influence = (bw_pd_state_influence)choice->influence;
    return &store->ordinary;
  }
  if (law != &bw_pd_state_correspondence_law) return NULL; /* one of somebody's own */
  store->correspondence = bw_pd_state_correspondence_options_default();
  store->correspondence.weight = (bw_pd_state_weight)choice->weight;
  store->correspondence.elastic = (bw_pd_material_elastic)choice->elastic;
  store->correspondence.stabilisation = choice->stabilisation;
  store->correspondence.breaks = (bw_pd_state_breaks)choice->breaks;
  if (!isnan(choice->limit)) store->correspondence.limit = choice->limit;
  if (breaks_by_friction(choice)) store->correspondence.friction = choice->friction_angle * RADIAN;
  /* One body, one way to yield; groups differ in E, nu and G0. */
  for (int g = 0; g < BW_PD_GROUPS; g++)
    store->correspondence.yield[g] = yield_of(choice);
  return &store->correspondence;
}
