/* ns_config.c -- defaults, and every contradiction that a configuration can hold. */
#include "ns_channel_internal.h"

#include <math.h>

static const char *const direction_name[] = {"x", "y", "z"};
static const char *const end_name[] = {"lower", "upper"};

bw_ns_channel_config bw_ns_channel_config_default(void)
{
  bw_ns_channel_config c = {
      .nu = (double)NAN, .viscous = BW_VISCOUS_EXPLICIT, .eddy_constant = 0.325};
  for (int d = 0; d < 3; d++)
    for (int s = 0; s < 2; s++)
      c.side[d][s] = (bw_ns_side){
          .kind = BW_SIDE_WALL, .profile = BW_PROFILE_UNIFORM, .bulk_velocity = (double)NAN};
  return c;
}

/* A laminar profile needs a section that has one: walls at rest, free slip or periodicity around
 * the side, and at least one wall. */
static bw_status section_check(const bw_grid_view *g, const bw_ns_channel_config *c, int d, int s)
{
  bool wall = false;
  /* All sides around the inflow must have a steady laminar flow between them. */
  for (int e = 0; e < (g->n[2] == 1 ? 2 : 3); e++)
    for (int q = 0; q < 2 && e != d; q++) {
      const bw_ns_side *around = &c->side[e][q];
      const double *v = around->velocity;
      const bool at_rest = around->kind == BW_SIDE_WALL && around->profile == BW_PROFILE_UNIFORM &&
                           v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
      wall |= at_rest;
      BW_REQUIRE(at_rest || around->kind == BW_SIDE_FREE_SLIP || around->kind == BW_SIDE_PERIODIC,
                 BW_EINPUT,
                 "ns_channel: %s %s side: around a Poiseuille inflow there are walls at rest, free "
                 "slip or periodic sides; the %s %s one is none of them; use a callback",
                 direction_name[d], end_name[s], direction_name[e], end_name[q]);
    }
  /* Without a wall Poisson's equation for the profile has no solution (nothing balances the
   * gradient). */
  BW_REQUIRE(wall, BW_EINPUT,
             "ns_channel: %s %s side: a Poiseuille inflow needs walls at rest beside it; make the "
             "inflow uniform, or give it a wall",
             direction_name[d], end_name[s]);
  return BW_OK;
}

static bw_status inflow_check(const bw_grid_view *g, const bw_ns_channel_config *c, int d, int s)
{
  const bw_ns_side *side = &c->side[d][s];
  const char *dn = direction_name[d], *sn = end_name[s];
  if (side->profile == BW_PROFILE_CALLBACK)
    BW_REQUIRE(side->function != NULL, BW_EINPUT,
               "ns_channel: %s %s side: a callback inflow needs side.function", dn, sn);
  if (side->profile != BW_PROFILE_POISEUILLE) return BW_OK;
  BW_REQUIRE(isfinite(side->bulk_velocity), BW_EINPUT,
             "ns_channel: %s %s side: side.bulk_velocity of the Poiseuille inflow is %g; "
             "give a finite velocity",
             dn, sn, side->bulk_velocity);
  return section_check(g, c, d, s);
}

static bw_status side_check(const bw_grid_view *g, const bw_ns_channel_config *c, int d, int s)
{
  const bw_ns_side *side = &c->side[d][s];
  const char *dn = direction_name[d], *sn = end_name[s];
  BW_REQUIRE((side->kind == BW_SIDE_PERIODIC) == g->periodic[d], BW_EINPUT,
             "ns_channel: %s %s side is %speriodic but the grid is %speriodic in %s; make both "
             "the same",
             dn, sn, side->kind == BW_SIDE_PERIODIC ? "" : "not ", g->periodic[d] ? "" : "not ",
             dn);
  /* A value that is not finite would only be noticed steps later, as a divergence. */
  for (int q = 0; q < 3; q++)
    BW_REQUIRE(isfinite(side->velocity[q]), BW_EINPUT,
               "ns_channel: %s %s side: velocity[%d] is %g; give a finite velocity", dn, sn, q,
               side->velocity[q]);
  /* No volume may pass a wall: the projection has zero normal gradient there. */
  if (side->kind == BW_SIDE_WALL)
    BW_REQUIRE(side->velocity[d] == 0.0, BW_EINPUT,
               "ns_channel: %s %s side: a wall moves tangentially only, but velocity[%d] is %g; "
               "use an inflow for blowing",
               dn, sn, d, side->velocity[d]);
  if (side->kind == BW_SIDE_WALL && side->profile == BW_PROFILE_CALLBACK)
    BW_REQUIRE(side->function != NULL, BW_EINPUT,
               "ns_channel: %s %s side: a callback wall needs side.function", dn, sn);
  if (side->kind == BW_SIDE_INFLOW) BW_TRY(inflow_check(g, c, d, s));
  return BW_OK;
}

/* Net volume that uniform and Poiseuille inflows bring per area must leave. */
static bw_status balance_check(const bw_grid_view *g, const bw_ns_channel_config *c)
{
  bool inflow = false, outflow = false, callback = false;
  double net = 0.0, gross = 0.0;
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &c->side[d][s];
      outflow |= side->kind == BW_SIDE_OUTFLOW;
      if (side->kind != BW_SIDE_INFLOW) continue;
      inflow = true;
      callback |= side->profile == BW_PROFILE_CALLBACK;
      /* Callbacks can only be integrated once they are called; uniform and laminar inflows are
       * known now. */
      const double area = g->length[(d + 1) % 3] * g->length[(d + 2) % 3];
      const double normal =
          side->profile == BW_PROFILE_POISEUILLE ? side->bulk_velocity : side->velocity[d];
      net += (s == 0 ? area : -area) * normal;
      gross += area * fabs(normal);
    }
  /* Volume is conserved to round-off, so a set-up that cannot conserve it is refused here. */
  BW_REQUIRE(inflow || !outflow, BW_EINPUT,
             "ns_channel: there is an outflow but no inflow; name the side that feeds it");
  BW_REQUIRE(!callback || outflow, BW_EINPUT,
             "ns_channel: a callback inflow needs an outflow side that takes what enters");
  BW_REQUIRE(outflow || fabs(net) <= 1e-12 * gross, BW_EINPUT,
             "ns_channel: %g more volume enters than leaves; add an outflow side", net);
  BW_REQUIRE(
      !outflow || net > 0.0 || callback, BW_EINPUT,
      "ns_channel: net inflow is %g; an outflow needs a positive one (velocities count along "
      "+x, +y, +z: through an upper side fluid enters with a negative one)",
      net);
  return BW_OK;
}

bw_status bw_ns__config_check(const bw_grid_view *g, const bw_ns_channel_config *c)
{
  BW_REQUIRE(isfinite(c->nu) && c->nu > 0.0, BW_EINPUT,
             "ns_channel: nu is %g; give a kinematic viscosity > 0", c->nu);
  /* WALE looks at the gradient of three components; turbulence in a plane is none. */
  BW_REQUIRE(c->eddy == BW_EDDY_NONE || g->n[2] > 1, BW_EINPUT,
             "ns_channel: an eddy viscosity in two dimensions, where there is no turbulence to "
             "model; give more than one cell in z, or leave it out");
  BW_REQUIRE(isfinite(c->eddy_constant) && c->eddy_constant >= 0.0, BW_EINPUT,
             "ns_channel: eddy_constant is %g; give a number >= 0, such as 0.325",
             c->eddy_constant);
  /* In two dimensions nothing is asked of z. */
  for (int d = 0; d < (g->n[2] == 1 ? 2 : 3); d++) {
    BW_REQUIRE(g->n[d] >= 2, BW_EINPUT, "ns_channel: %d cell in %s; at least 2 are needed", g->n[d],
               direction_name[d]);
    for (int s = 0; s < 2; s++)
      BW_TRY(side_check(g, c, d, s));
  }
  BW_REQUIRE(c->forcing_axis >= 0 && c->forcing_axis < (g->n[2] == 1 ? 2 : 3), BW_EINPUT,
             "ns_channel: forcing_axis = %d: give 0, 1 or, in three dimensions, 2",
             c->forcing_axis);
  /* Forcing drives a flow that closes in itself; elsewhere the sides drive it. */
  if (c->forcing != BW_FORCING_NONE) {
    BW_REQUIRE(g->periodic[c->forcing_axis], BW_EINPUT,
               "ns_channel: forcing needs periodic %s; between inflow and outflow the pressure "
               "drives the flow, and nothing passes walls",
               direction_name[c->forcing_axis]);
    BW_REQUIRE(isfinite(c->forcing_value), BW_EINPUT,
               "ns_channel: forcing_value is %g; give a bulk velocity or a gradient",
               c->forcing_value);
  }
  return balance_check(g, c);
}

bw_status bw_ns_channel_config_check(const bw_grid_config *grid, const bw_ns_channel_config *config)
{
  /* The check reads only sizes and periodicity, so it needs no grid to exist. */
  bw_grid_view g = {.n = {0}};
  for (int d = 0; d < 3; d++)
    g.n[d] = grid->n[d], g.length[d] = grid->length[d], g.periodic[d] = grid->periodic[d];
  return bw_ns__config_check(&g, config);
}
