/* Loads: on which particles each acts, and what it does in a step; prescribed motion. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

double bw_scene__load_share(const bw_scene_load *l, double time)
{
  const bw_solid_ramp ramp = {.kind = l->smooth ? BW_SOLID_RAMP_SMOOTH : BW_SOLID_RAMP_LINEAR,
                              .start = l->start,
                              .duration = l->ramp};
  return bw_solid_ramp_value(&ramp, time);
}

void bw_scene__motion(const bw_scene_body *b, const double X0[3], double time, double X[3])
{
  const double turn = 2.0 * acos(-1.0) * b->swing.frequency * time;
  double at[3] = {X0[0], X0[1], X0[2]};
  if (b->has_rotation) {
    double axes[3][3];
    bw_shape_turn(b->rotation.axis, b->rotation.rate * time, axes);
    for (int k = 0; k < 3; k++) {
      at[k] = b->rotation.centre[k];
      /* Rows are the turned directions: the point's own coordinates along them. */
      for (int d = 0; d < 3; d++)
        at[k] += axes[d][k] * (X0[d] - b->rotation.centre[d]);
    }
  }
  for (int k = 0; k < 3; k++) {
    X[k] = at[k] + time * b->velocity[k];
    if (b->has_swing) X[k] += b->swing.amplitude[k] * sin(turn);
  }
}

void bw_scene__velocity(const bw_scene_body *b, const double X[3], double time, double V[3])
{
  const double w = 2.0 * acos(-1.0) * b->swing.frequency;
  double shift[3] = {0};
  for (int d = 0; d < 3; d++) {
    V[d] = b->velocity[d] + (b->has_swing ? w * b->swing.amplitude[d] * cos(w * time) : 0.0);
    shift[d] = time * b->velocity[d] + (b->has_swing ? b->swing.amplitude[d] * sin(w * time) : 0.0);
  }
  if (!b->has_rotation) return;
  /* rate e x r, with r from the axis, which has moved with the body. */
  const double *e = b->rotation.axis, f = b->rotation.rate / hypot(hypot(e[0], e[1]), e[2]);
  double r[3];
  for (int d = 0; d < 3; d++)
    r[d] = X[d] - shift[d] - b->rotation.centre[d];
  for (int d = 0; d < 3; d++)
    V[d] += f * (e[(d + 1) % 3] * r[(d + 2) % 3] - e[(d + 2) % 3] * r[(d + 1) % 3]);
}

/* Extent of the particles of a body, cells included, of all ranks. Collective. */
static void extent_of(const bw_scene *s, const bw_scene__solid *q, int b, double lower[3],
                      double upper[3])
{
  for (int d = 0; d < 3; d++)
    lower[d] = HUGE_VAL, upper[d] = -HUGE_VAL;
  for (size_t i = 0; i < q->n; i++) {
    if (bw_scene__body_of(q, i) != b) continue;
    const double half = 0.5 * bw_solid_spacing(q->solid, i);
    for (size_t d = 0; d < 3; d++) {
      lower[d] = fmin(lower[d], q->X0[3 * i + d] - half);
      upper[d] = fmax(upper[d], q->X0[3 * i + d] + half);
    }
  }
  bw_comm_min(s->comm, 3, lower);
  bw_comm_max(s->comm, 3, upper);
}

/* The particles of a load on this rank; *volume: theirs, of all ranks. Collective. */
static bw_status aim(bw_scene *s, bw_scene__acting *a, double *volume)
{
  const bw_scene_load *l = &s->config.loads[a->load];
  const bw_scene__solid *q = &s->solid[a->solid];
  const int b = bw_scene__body_named(&s->config, l->on);
  const double ds = bw_solid_settings(q->solid)->ds;
  double lower[3], upper[3], sum = 0;
  extent_of(s, q, b, lower, upper);
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&a->particle, q->n)));
  for (size_t i = 0; i < q->n; i++) {
    if (bw_scene__body_of(q, i) != b) continue;
    const double *x = q->X0 + 3 * i;
    if (l->has_where && !bw_scene__in_where(&l->where, s->planar, ds, lower, upper, x)) continue;
    a->particle[a->n++] = (int32_t)i;
    sum += bw_solid_volume_of(q->solid, i);
  }
  bw_comm_sum(s->comm, 1, &sum);
  BW_REQUIRE(
      sum > 0, BW_EINPUT,
      "loads.%d.where: it holds no particle of %s; its particles go from (%g, %g, %g) to (%g, "
      "%g, %g)",
      a->load, l->on, lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]);
  *volume = sum;
  return BW_OK;
}

/* Force density of a load when all of it acts. A side of one layer of particles has ds per volume
 * of area; more layers share it. */
static void set_push(const bw_scene *s, bw_scene__acting *a, double volume)
{
  const bw_scene_load *l = &s->config.loads[a->load];
  const bw_solid_config *c = bw_solid_settings(s->solid[a->solid].solid);
  const double depth = l->where.layers * c->ds;
  int d = 0, end = 0;
  (void)bw_scene__side_named(l->where.side, &d, &end);
  for (int k = 0; k < 3; k++) {
    const double value = l->value[k];
    a->push[k] = l->kind == BW_SCENE_TRACTION  ? value / depth
                 : l->kind == BW_SCENE_FORCE   ? value / volume
                 : l->kind == BW_SCENE_GRAVITY ? value
                                               : 0.0;
  }
  if (l->kind == BW_SCENE_PRESSURE) a->push[d] = (end == 0 ? 1.0 : -1.0) * l->value[0] / depth;
  if (s->planar) a->push[2] = 0.0;
}

bw_status bw_scene__loads_aim(bw_scene *s)
{
  for (int k = 0; k < s->n_acting; k++) {
    bw_scene__acting *a = &s->acting[k];
    double volume = 0.0;
    if (bw_scene__in_cracks(&s->config.loads[a->load])) continue; /* of another solid */
    bw_release(&a->particle);
    a->n = 0;
    BW_TRY(aim(s, a, &volume));
    set_push(s, a, volume);
  }
  return BW_OK;
}

bw_status bw_scene__loads_create(bw_scene *s)
{
  const double *g = s->config.gravity;
  const bool heavy = g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0;
  for (int k = 0; k < s->config.n_loads; k++) {
    bw_scene__acting *a = &s->acting[s->n_acting++];
    const int b = bw_scene__body_named(&s->config, s->config.loads[k].on);
    double volume = 0.0;
    *a = (bw_scene__acting){.load = k, .solid = s->solid_of[b]};
    if (bw_scene__in_cracks(&s->config.loads[k])) {
      BW_TRY(bw_scene__fill_cracks(s, a));
    } else {
      BW_TRY(aim(s, a, &volume));
      set_push(s, a, volume);
    }
    if (s->config.loads[k].kind == BW_SCENE_VELOCITY)
      s->solid[a->solid].moved = true;
    else
      s->solid[a->solid].pushed = true;
  }
  /* In a flow the weight is the coupler's, which knows that of the fluid displaced. */
  for (int q = 0; q < s->n_solids; q++) {
    s->solid[q].pushed = (s->solid[q].pushed || heavy) && !bw_scene__has_flow(&s->config);
    for (int k = 0; k < s->solid[q].n_bodies; k++)
      if (s->config.bodies[s->solid[q].body[k]].motion == BW_SCENE_PRESCRIBED ||
          s->rigid_of[s->solid[q].body[k]] >= 0)
        s->solid[q].moved = true;
  }
  return BW_OK;
}

void bw_scene__loads_destroy(bw_scene *s)
{
  for (int q = 0; q < s->n_acting; q++) {
    bw_release(&s->acting[q].particle);
    bw_solid_crack_destroy(&s->acting[q].crack);
  }
}

/* Collective. */
static bw_status push(bw_scene *s, int solid, double time)
{
  bw_scene__solid *q = &s->solid[solid];
  if (q->steady) return BW_OK;
  memset(q->F, 0, 3 * q->n * sizeof *q->F);
  q->steady = true;
  bw_solid_load_gravity(q->solid, s->config.gravity, q->F);
  for (int k = 0; k < s->n_acting; k++) {
    const bw_scene__acting *a = &s->acting[k];
    const bw_scene_load *l = &s->config.loads[a->load];
    if (a->solid != solid || l->kind == BW_SCENE_VELOCITY) continue;
    const double share = bw_scene__load_share(l, time);
    /* A crack goes on and opens: what fills it never rests. */
    q->steady = q->steady && time >= l->start + l->ramp && a->crack == NULL;
    if (a->crack != NULL) BW_TRY(bw_solid_crack_push(a->crack, share * l->value[0], q->F));
    for (size_t i = 0; i < a->n; i++) {
      const size_t p = (size_t)a->particle[i];
      const double weight = l->kind == BW_SCENE_GRAVITY ? bw_solid_density(q->solid, p) : 1.0;
      for (size_t d = 0; d < 3; d++)
        q->F[3 * p + d] += share * weight * a->push[d];
    }
  }
  bw_solid_set_force(q->solid, q->F);
  return BW_OK;
}

/* The velocity that brings prescribed particles where they belong at the end of the step. */
static void move(bw_scene *s, int solid, double dt)
{
  bw_scene__solid *q = &s->solid[solid];
  memset(q->V, 0, 3 * q->n * sizeof *q->V);
  for (size_t i = 0; i < q->n; i++) {
    const int b = bw_scene__body_of(q, i), rigid = s->rigid_of[b];
    const bw_scene_body *body = &s->config.bodies[b];
    double from[3], to[3];
    if (body->motion != BW_SCENE_PRESCRIBED && rigid < 0) continue;
    if (rigid >= 0) {
      /* The body is there already. */
      const bw_rigid_state now = bw_rigid_state_of(s->rigid, rigid);
      bw_scene__rigid_place(s, rigid, &s->rigid_before[rigid], q->X0 + 3 * i, from);
      bw_scene__rigid_place(s, rigid, &now, q->X0 + 3 * i, to);
    } else {
      bw_scene__motion(body, q->X0 + 3 * i, s->time, from);
      bw_scene__motion(body, q->X0 + 3 * i, s->time + dt, to);
    }
    for (int d = 0; d < (s->planar ? 2 : 3); d++)
      q->V[3 * i + (size_t)d] = (to[d] - from[d]) / dt;
  }
  for (int k = 0; k < s->n_acting; k++) {
    const bw_scene__acting *a = &s->acting[k];
    const bw_scene_load *l = &s->config.loads[a->load];
    if (a->solid != solid || l->kind != BW_SCENE_VELOCITY) continue;
    const double share = bw_scene__load_share(l, s->time + 0.5 * dt);
    for (size_t i = 0; i < a->n; i++)
      for (size_t d = 0; d < (s->planar ? 2 : 3); d++)
        q->V[3 * (size_t)a->particle[i] + d] = share * l->value[d];
  }
  bw_solid_set_prescribed(q->solid, q->V);
}

bw_status bw_scene__loads_apply(bw_scene *s, double dt)
{
  for (int q = 0; q < s->n_solids; q++) {
    /* Forces at the end of the step's first kick are those of its middle, to second order. */
    if (s->solid[q].pushed) BW_TRY(push(s, q, s->time + 0.5 * dt));
    if (s->solid[q].moved) move(s, q, dt);
  }
  return BW_OK;
}
