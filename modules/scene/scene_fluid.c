/* The fluid of a scene: its grid, sides, first velocity. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

static const char *const direction_name[] = {"x", "y", "z"};
static const char *const end_name[] = {"lower", "upper"};

void bw_scene__fluid_destroy(bw_scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_scene__surfaces_destroy(s);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
  for (int d = 0; d < 3; d++)
    for (int end = 0; end < 2; end++)
      bw_release(&s->ramped[d][end]);
}

/* The direction across a stream along d in which it has two walls, when that is the only one; -1:
 * another section. */
static int plane_channel(const bw_scene_config *c, int d)
{
  const bw_scene_pair *pair[3] = {&c->fluid.sides.x, &c->fluid.sides.y, &c->fluid.sides.z};
  int across = -1, n = 0;
  for (int k = 0; k < 3; k++) {
    if (k == d || (k == 2 && c->domain.cells[2] == 1)) continue;
    if (pair[k]->lower.kind == BW_SIDE_PERIODIC) continue;
    const bool walls = pair[k]->lower.kind == BW_SIDE_WALL && pair[k]->upper.kind == BW_SIDE_WALL;
    across = k;
    n += walls ? 1 : 2;
  }
  return n == 1 ? across : -1;
}

/* What the callbacks of the sides need: the scene and which side it is. */
typedef struct {
  const bw_scene_config *c;
  const bw_scene_side *side;
  int d, across;
} side_context;

/* (1 - cos(pi t/T))/2 until T. */
static double risen(double ramp, double t)
{
  return t >= ramp ? 1.0 : 0.5 * (1.0 - cos(acos(-1.0) * t / ramp));
}

static void ramped(const double x[3], double t, void *context, double u[3])
{
  const side_context *q = context;
  const double share = risen(q->side->ramp, t);
  for (int k = 0; k < 3; k++)
    u[k] = share * q->side->velocity[k];
  if (q->side->profile != BW_PROFILE_POISEUILLE) return;
  const double y = x[q->across] / q->c->domain.length[q->across];
  u[q->d] = share * 6.0 * q->side->mean * y * (1.0 - y);
}

/* The laminar profile of the inflow at the lower x side, without its ramp. */
static void start_velocity(const double x[3], double t, void *context, double u[3])
{
  const bw_scene_config *c = context;
  const bw_scene_start *start = &c->fluid.start;
  (void)t;
  for (int d = 0; d < 3; d++)
    u[d] = start->velocity[d];
  if (start->developed) {
    const int across = plane_channel(c, 0);
    const double y = x[across] / c->domain.length[across];
    u[0] += 6.0 * c->fluid.sides.x.lower.mean * y * (1.0 - y);
  }
  for (int q = 0; q < start->n_vortices; q++) {
    const bw_scene_vortex *v = &start->vortices[q];
    const double a = (x[0] - v->centre[0]) / v->radius, b = (x[1] - v->centre[1]) / v->radius;
    const double f = v->swirl * exp(0.5 * (1.0 - a * a - b * b));
    u[0] -= b * f;
    u[1] += a * f;
  }
}

static double rate_at(bw_scene *s, double x, double y)
{
  double u[3], sum = 0.0;
  const double at[3] = {x, y, 0.0};
  start_velocity(at, 0.0, &s->config, u);
  for (int d = 0; d < (s->planar ? 2 : 3); d++)
    sum += fabs(u[d]) / bw_grid_look(s->grid)->spacing[d];
  return sum;
}

double bw_scene__start_rate(bw_scene *s)
{
  enum { ROUND = 64 }; /* places around a vortex: the largest is met to 0.1 % */
  const bw_scene_start *start = &s->config.fluid.start;
  const double *length = s->config.domain.length;
  double most = rate_at(s, 0.5 * length[0], 0.5 * length[1]);
  for (int q = 0; q < ROUND * start->n_vortices; q++) {
    const bw_scene_vortex *v = &start->vortices[q / ROUND];
    const double turn = 2.0 * acos(-1.0) * q / ROUND;
    const double x = v->centre[0] + v->radius * cos(turn);
    const double y = v->centre[1] + v->radius * sin(turn);
    if (x >= 0.0 && x <= length[0] && y >= 0.0 && y <= length[1])
      most = fmax(most, rate_at(s, x, y));
  }
  return most;
}

/* A key that has no meaning for this kind of side is refused, not ignored. */
static bw_status check_side(const bw_scene_config *c, const bw_scene_side *q, int d, int s)
{
  const char *dn = direction_name[d], *sn = end_name[s];
  const bool moves = q->velocity[0] != 0.0 || q->velocity[1] != 0.0 || q->velocity[2] != 0.0;
  const bool laminar = q->profile == BW_PROFILE_POISEUILLE, inflow = q->kind == BW_SIDE_INFLOW;
  BW_REQUIRE(
      inflow || (!laminar && isnan(q->mean)), BW_EINPUT,
      "fluid.sides.%s.%s: profile and mean belong to an inflow, this is none; leave them out", dn,
      sn);
  BW_REQUIRE(!inflow || laminar == isfinite(q->mean), BW_EINPUT,
             "fluid.sides.%s.%s: mean is %s; give it with profile: poiseuille, and velocity with "
             "uniform",
             dn, sn, laminar ? "missing" : "given without profile: poiseuille");
  BW_REQUIRE(!moves || q->kind == BW_SIDE_WALL || (inflow && !laminar), BW_EINPUT,
             "fluid.sides.%s.%s.velocity: it belongs to a wall or a uniform inflow; leave it out",
             dn, sn);
  BW_REQUIRE(q->kind != BW_SIDE_WALL || q->velocity[d] == 0.0, BW_EINPUT,
             "fluid.sides.%s.%s.velocity[%d] = %g: a wall moves in its own plane; give 0", dn, sn,
             d, q->velocity[d]);
  BW_REQUIRE(c->domain.cells[2] > 1 || q->velocity[2] == 0.0, BW_EINPUT,
             "fluid.sides.%s.%s.velocity[2] = %g: the scene has two dimensions; give 0", dn, sn,
             q->velocity[2]);
  /* Along the axis; through the lower side it has to be positive to come in. */
  const double speed = laminar ? q->mean : q->velocity[d];
  BW_REQUIRE(
      !inflow || (s == 0 ? speed > 0.0 : speed < 0.0), BW_EINPUT,
      "fluid.sides.%s.%s: nothing comes in through this inflow, %s is %g along %s; give a %s "
      "one (fluid leaves through an outflow)",
      dn, sn, laminar ? "mean" : "velocity", speed, dn, s == 0 ? "positive" : "negative");
  BW_REQUIRE(
      q->ramp == 0.0 || !laminar || plane_channel(c, d) >= 0, BW_EINPUT,
      "fluid.sides.%s.%s.ramp = %g: a poiseuille inflow that rises needs a plane channel, two "
      "walls across it, in this build; leave it out",
      dn, sn, q->ramp);
  return BW_OK;
}

static bw_status set_side(bw_scene *s, const bw_scene_side *q, int d, int end, bw_ns_side *side)
{
  const bw_scene_config *c = &s->config;
  BW_TRY(check_side(c, q, d, end));
  *side = (bw_ns_side){.kind = (bw_ns_side_kind)q->kind,
                       .profile = (bw_ns_profile)q->profile,
                       .bulk_velocity = q->mean};
  memcpy(side->velocity, q->velocity, sizeof side->velocity);
  s->speed = fmax(s->speed, 1.5 * fabs(isnan(q->mean) ? 0.0 : q->mean));
  for (int k = 0; k < 3; k++)
    s->speed = fmax(s->speed, fabs(q->velocity[k]));
  if (q->ramp == 0.0) return BW_OK;
  /* What rises is a function of time. */
  side_context *context = NULL;
  BW_TRY(BW_ALLOCATE(&context, 1));
  *context = (side_context){c, q, d, plane_channel(c, d)};
  s->ramped[d][end] = context;
  side->profile = BW_PROFILE_CALLBACK;
  side->function = ramped;
  side->context = context;
  return BW_OK;
}

static bw_status set_sides(bw_scene *s, bw_grid_config *grid, bw_ns_channel_config *fluid)
{
  const bw_scene_sides *sides = &s->config.fluid.sides;
  const bw_scene_pair *pair[3] = {&sides->x, &sides->y, &sides->z};
  const bool flat = grid->n[2] == 1;
  BW_REQUIRE(flat != sides->has_z, BW_EINPUT,
             "fluid.sides.z is %s, but domain.cells has %d in z; %s",
             sides->has_z ? "given" : "missing", grid->n[2],
             flat ? "leave it out in two dimensions" : "give its lower and upper");
  for (int d = 0; d < (flat ? 2 : 3); d++) {
    const bool lower = pair[d]->lower.kind == BW_SIDE_PERIODIC;
    BW_REQUIRE(lower == (pair[d]->upper.kind == BW_SIDE_PERIODIC), BW_EINPUT,
               "fluid.sides.%s: one is periodic and one is not; make both or neither",
               direction_name[d]);
    grid->periodic[d] = lower;
    BW_TRY(set_side(s, &pair[d]->lower, d, 0, &fluid->side[d][0]));
    BW_TRY(set_side(s, &pair[d]->upper, d, 1, &fluid->side[d][1]));
  }
  if (!flat) return BW_OK;
  /* One cell in z is a periodic direction of its own. */
  grid->periodic[2] = true;
  fluid->side[2][0].kind = fluid->side[2][1].kind = BW_SIDE_PERIODIC;
  return BW_OK;
}

static bw_status configure(bw_scene *s, bw_grid_config *grid, bw_ns_channel_config *fluid)
{
  const bw_scene_config *c = &s->config;
  const bw_scene_fluid *f = &c->fluid;
  *grid = bw_grid_config_default();
  *fluid = bw_ns_channel_config_default();
  memcpy(grid->n, c->domain.cells, sizeof grid->n);
  memcpy(grid->length, c->domain.length, sizeof grid->length);
  if (c->domain.stretch > 0.0)
    grid->y_stretch = BW_STRETCH_TANH, grid->y_stretch_strength = c->domain.stretch;
  /* Markers and probes reach two cells; values between cells one. */
  grid->halo = c->n_bodies > 0 ? 2 : 1;
  fluid->nu = f->viscosity;
  fluid->eddy = (bw_ns_eddy)f->eddy;
  fluid->viscous = (bw_ns_viscous)c->numerics.viscous;
  if (f->has_forcing) {
    fluid->forcing = (bw_ns_forcing)f->forcing.kind;
    fluid->forcing_value = f->forcing.value;
    fluid->forcing_axis = f->forcing.axis;
    if (fluid->forcing == BW_FORCING_FLOW_RATE)
      s->speed = fmax(s->speed, 1.5 * fabs(f->forcing.value));
  }
  BW_REQUIRE(
      !f->start.developed || plane_channel(c, 0) >= 0, BW_EINPUT,
      "fluid.start.developed: the inflow is not that of a plane channel, two walls across it; "
      "start from rest");
  BW_TRY(set_sides(s, grid, fluid));
  return bw_ns_channel_config_check(grid, fluid);
}

bw_status bw_scene__fluid_create(bw_scene *s)
{
  bw_grid_config grid;
  BW_TRY(bw_comm_agree(s->comm, configure(s, &grid, &s->flow)));
  BW_TRY((s->planned ? bw_grid_plan : bw_grid_create)(s->comm, &grid, &s->grid));
  if (s->planned) return bw_ns_channel_plan(s->grid, &s->flow, &s->flow_plan);
  BW_TRY(bw_ns_channel_create(s->grid, &s->flow, &s->fluid));
  return bw_ns_channel_set_velocity(s->fluid, start_velocity, &s->config, 0.0);
}
