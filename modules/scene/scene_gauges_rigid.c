/* What gauges see of rigid bodies. */
#include "scene_impl.h"

#include <math.h>
#include <string.h>

/* The body of a gauge that names one. */
static int body_of(const bw_scene *s, const bw_scene_gauge_config *g)
{
  char name[BW_SCENE_NAME];
  const char *rest = g->body;
  (void)bw_scene__next_name(&rest, name);
  return bw_scene__body_named(&s->config, name);
}

/* The centre of mass, or the point of the body that was at `nearest` at the start. */
static void place_of(const bw_scene *s, const bw_scene_gauge_config *g, int q, double X0[3],
                     double X[3], double V[3])
{
  const bw_rigid_state now = bw_rigid_state_of(s->rigid, q);
  double r[3];
  memcpy(X0, bw_scene__given(g->nearest) ? g->nearest : s->rigid_start[q].position, 3 * sizeof *X0);
  bw_scene__rigid_place(s, q, &now, X0, X);
  for (int d = 0; d < 3; d++)
    r[d] = X[d] - now.position[d];
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    V[d] = now.velocity[d] + now.spin[e] * r[f] - now.spin[f] * r[e];
  }
}

/* Turn since the start as angle times axis: sin(angle) axis is the skew part of Q. */
static void turn_of(const bw_rigid_state *a, double value[3])
{
  const double(*Q)[3] = (const double(*)[3])a->turn;
  const double axis[3] = {0.5 * (Q[2][1] - Q[1][2]), 0.5 * (Q[0][2] - Q[2][0]),
                          0.5 * (Q[1][0] - Q[0][1])};
  const double sine = hypot(hypot(axis[0], axis[1]), axis[2]);
  const double cosine = 0.5 * (Q[0][0] + Q[1][1] + Q[2][2] - 1.0);
  const double scale = sine > 1e-12 ? atan2(sine, cosine) / sine : 1.0;
  for (int d = 0; d < 3; d++)
    value[d] = scale * axis[d];
}

/* What a body bears on its springs, dampers and where it is held: there all that acts on it.
 * fluid (3): the force of the flow on it, with weight and buoyancy. */
static void add_support(const bw_scene *s, int b, const double fluid[3], double value[3])
{
  const bw_scene_body *body = &s->config.bodies[b];
  const bw_scene_rigid *r = &body->rigid;
  const int q = s->rigid_of[b];
  const bw_rigid_state a = bw_rigid_state_of(s->rigid, q);
  char wrong[BW_SCENE_NAME];
  unsigned bits = 63;
  if (body->motion == BW_SCENE_RIGID) (void)bw_scene__held_bits(r->held, &bits, wrong);
  for (int d = 0; d < 3; d++) {
    const double off = a.position[d] - s->rigid_start[q].position[d];
    if (bits >> d & 1)
      value[d] += a.force[d] + s->rigid_load[3 * q + d] + fluid[d];
    else
      value[d] += r->stiffness[d] * off + r->damping[d] * a.velocity[d];
  }
}

/* Sums over the bodies of a gauge: of the flow's force, of its torque, of what supports bear.
 * Collective. */
static bw_status sum_of(bw_scene *s, const bw_scene_gauge_config *g, const char *word,
                        double value[3])
{
  bw_coupler_rigid_report report[BW_SCENE_BODIES] = {0};
  const bool support = strcmp(word, "force_on_support") == 0;
  const double *gravity = s->config.gravity;
  /* The flow's force is that of the last step. */
  if (s->floats != NULL && s->steps > 0) BW_TRY(bw_coupler_rigid_measure(s->floats, report));
  if (!support && (s->floats == NULL || s->steps == 0)) return BW_OK;
  memset(value, 0, 3 * sizeof *value);
  for (int b = 0; b < s->config.n_bodies; b++) {
    if (!bw_scene__listed(g->body, s->config.bodies[b].name)) continue;
    const bw_coupler_rigid_report *r = &report[s->rigid_of[b]];
    double fluid[3] = {0};
    const bw_rigid_state a = bw_rigid_state_of(s->rigid, s->rigid_of[b]);
    const bool heavy = s->floats != NULL && s->config.bodies[b].motion == BW_SCENE_RIGID;
    for (int d = 0; d < 3; d++)
      fluid[d] = r->force[d] + r->film[d] +
                 (heavy ? (a.mass - s->config.fluid.density * a.volume) * gravity[d] : 0.0);
    if (support) add_support(s, b, fluid, value);
    for (int d = 0; d < 3 && !support; d++)
      value[d] +=
          strcmp(word, "torque") == 0 ? r->torque[d] + r->film[3 + d] : r->force[d] + r->film[d];
  }
  return BW_OK;
}

bw_status bw_scene__measure_rigid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS])
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  if (what->source == BW_SCENE__OF_BODIES || strcmp(what->word, "torque") == 0)
    return sum_of(s, g, what->word, value);
  const int q = s->rigid_of[body_of(s, g)];
  const bw_rigid_state now = bw_rigid_state_of(s->rigid, q);
  double X0[3], X[3], V[3];
  place_of(s, g, q, X0, X, V);
  if (strcmp(what->word, "turn") == 0) turn_of(&now, value);
  for (int d = 0; d < 3; d++) {
    if (strcmp(what->word, "displacement") == 0) value[d] = X[d] - X0[d];
    if (strcmp(what->word, "position") == 0) value[d] = X[d];
    if (strcmp(what->word, "velocity") == 0) value[d] = V[d];
    if (strcmp(what->word, "spin") == 0) value[d] = now.spin[d];
  }
  return BW_OK;
}
