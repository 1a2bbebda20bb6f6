/* Bodies that do not deform, in a fluid alone: markers and probe points on their true surface.
 *
 * A step (as in bw_ibm_mdf.h and bw_ns_channel.h): the body is where it is at the end of the step;
 * predict, force no slip at the markers, project, three times. What pressure acted over the step is
 * sum gamma_r p_r, which the probes read.
 * Markers stand `retraction` cells inside the surface: on the surface of the same body with shapes
 * that are added smaller, and shapes that are taken away larger, by that much. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_shape_surface.h"
#include <math.h>
#include <string.h>

static void release_points(bw_scene__points *p)
{
  bw_release(&p->body);
  bw_release(&p->X0);
  bw_release(&p->N0);
  bw_release(&p->area);
  bw_release(&p->X);
  bw_release(&p->N);
  bw_release(&p->V);
  bw_release(&p->M);
}

void bw_scene__surfaces_destroy(bw_scene *s)
{
  release_points(&s->inner);
  release_points(&s->wall);
  bw_release(&s->pressure);
  bw_probe_destroy(&s->probe);
  bw_ibm_mdf_destroy(&s->markers);
}

/* The shape with its surface moved inward by r, outward where it is taken away. */
static bw_status shrink(bw_shape *q, bool planar, double r)
{
  const double by = q->remove != q->outside ? -r : r;
  if (q->kind != BW_SHAPE_BOX) {
    q->radius -= by;
    BW_REQUIRE(q->radius > 0.0, BW_EINPUT, "it is thinner than two cells; use a finer grid");
    return BW_OK;
  }
  for (int d = 0; d < (planar ? 2 : 3); d++) {
    q->lower[d] += by, q->upper[d] -= by;
    BW_REQUIRE(q->lower[d] < q->upper[d], BW_EINPUT,
               "it is thinner along %c than two cells; use a finer grid", "xyz"[d]);
  }
  return BW_OK;
}

static bw_status append(bw_scene__points *p, int body, size_t n, const double *X, const double *N,
                        const double *area, double depth)
{
  bw_scene__points all = {.n = p->n + n};
  bw_status st = BW_ALLOCATE(&all.body, all.n);
  BW_THEN(st, BW_ALLOCATE(&all.X0, 3 * all.n));
  BW_THEN(st, BW_ALLOCATE(&all.N0, 3 * all.n));
  BW_THEN(st, BW_ALLOCATE(&all.area, all.n));
  if (st != BW_OK) {
    release_points(&all);
    return st;
  }
  for (size_t i = 0; i < p->n; i++)
    all.body[i] = p->body[i], all.area[i] = p->area[i];
  for (size_t i = 0; i < 3 * p->n; i++)
    all.X0[i] = p->X0[i], all.N0[i] = p->N0[i];
  for (size_t i = 0; i < n; i++)
    all.body[p->n + i] = body, all.area[p->n + i] = depth * area[i];
  memcpy(all.X0 + 3 * p->n, X, 3 * n * sizeof *X);
  memcpy(all.N0 + 3 * p->n, N, 3 * n * sizeof *N);
  release_points(p);
  *p = all;
  return BW_OK;
}

/* Points of one body, `inside` of its surface. In two dimensions they lie in the middle of the
 * cell. */
static bw_status add_body(const bw_scene *s, int b, double inside, double h, bw_scene__points *p)
{
  bw_scene__shapes shapes;
  int64_t n = 0;
  double *X = NULL, *N = NULL, *area = NULL;
  bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
  for (int k = 0; st == BW_OK && inside != 0.0 && k < shapes.n; k++)
    st = shrink(&shapes.shape[k], s->planar, inside);
  BW_THEN(st, bw_shape_points(shapes.n, shapes.shape, s->planar, h, &n, &X, &N, &area));
  if (st == BW_EINPUT)
    st = BW_FAIL(BW_EINPUT, "bodies.%s.shape: %s", s->config.bodies[b].name, bw_last_message());
  for (int64_t i = 0; st == BW_OK && s->planar && i < n; i++)
    X[3 * i + 2] = 0.5 * s->config.domain.length[2];
  BW_THEN(st, append(p, b, (size_t)n, X, N, area, s->planar ? s->config.domain.length[2] : 1.0));
  bw_scene__shapes_release(&shapes);
  bw_release(&X);
  bw_release(&N);
  bw_release(&area);
  return st;
}

static bw_status make_points(bw_scene *s, double inside, bw_scene__points *p)
{
  const double h = bw_grid_look(s->grid)->spacing[0];
  bw_status st = BW_OK;
  for (int b = 0; b < s->config.n_bodies && bw_comm_rank(s->comm) == 0 && st == BW_OK; b++)
    st = add_body(s, b, inside, h, p);
  BW_THEN(st, BW_ALLOCATE(&p->X, 3 * p->n));
  BW_THEN(st, BW_ALLOCATE(&p->N, 3 * p->n));
  BW_THEN(st, BW_ALLOCATE(&p->V, 3 * p->n));
  BW_THEN(st, BW_ALLOCATE(&p->M, 3 * p->n));
  return bw_comm_agree(s->comm, st);
}

/* Places, normals and velocities at a time; velocities are those of the motion there. */
static void place(const bw_scene *s, bw_scene__points *p, double time)
{
  for (size_t i = 0; i < p->n; i++) {
    const bw_scene_body *b = &s->config.bodies[p->body[i]];
    const double *X0 = p->X0 + 3 * i, *N0 = p->N0 + 3 * i;
    double *X = p->X + 3 * i, *V = p->V + 3 * i, *N = p->N + 3 * i;
    memcpy(X, X0, 3 * sizeof *X);
    memcpy(N, N0, 3 * sizeof *N);
    if (b->motion != BW_SCENE_PRESCRIBED) continue;
    double tip[3], end[3];
    for (int d = 0; d < 3; d++)
      tip[d] = X0[d] + N0[d];
    bw_scene__motion(b, X0, time, X);
    bw_scene__motion(b, tip, time, end);
    for (int d = 0; d < 3; d++)
      N[d] = end[d] - X[d];
    bw_scene__velocity(b, X, time, V);
  }
}

/* For bw_ibm_mdf_set_ghosts. */
static void ghosts(void *fluid)
{
  bw_ns_channel_ghosts(fluid);
}

/* The markers as they stand in `inner`, with a memory or without. Collective. */
static bw_status hand_over(bw_scene *s, const double *memory)
{
  const double h = bw_grid_look(s->grid)->spacing[0];
  const bw_scene__points *p = &s->inner;
  double *dV = NULL;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&dV, p->n));
  for (size_t i = 0; st == BW_OK && i < p->n; i++)
    dV[i] = p->area[i] * h;
  BW_THEN(st, bw_ibm_mdf_set_markers(s->markers, p->n, p->X, p->V, dV, memory));
  bw_release(&dV);
  BW_THEN(st, bw_ibm_mdf_close(s->markers, s->config.n_bodies, p->body, p->N));
  return st;
}

bw_status bw_scene__surfaces_create(bw_scene *s)
{
  const bw_scene_numerics *n = &s->config.numerics;
  const double h = bw_grid_look(s->grid)->spacing[0];
  bw_ibm_mdf_config config = bw_ibm_mdf_config_default();
  config.kernel = (bw_kernel_delta_id)n->kernel;
  config.n_iter = n->forcing_iterations;
  config.memory = n->memory;
  const double retraction = isnan(n->retraction) ? bw_ibm_mdf_retraction(&config) : n->retraction;
  BW_TRY(make_points(s, retraction * h, &s->inner));
  if (s->planned) return BW_OK;
  BW_TRY(bw_ibm_mdf_create(s->grid, &config, &s->markers));
  bw_ibm_mdf_set_ghosts(s->markers, ghosts, s->fluid);
  for (int b = 0; b < s->config.n_bodies; b++)
    s->moving = s->moving || s->config.bodies[b].motion == BW_SCENE_PRESCRIBED;
  place(s, &s->inner, 0.0);
  BW_TRY(hand_over(s, NULL));
  BW_TRY(bw_comm_agree(s->comm, bw_field_create(s->grid, &s->pressure)));
  /* Probes only where somebody reads the force. */
  if (!bw_scene__asked(s, "force")) return BW_OK;
  bw_probe_config probe = bw_probe_config_default();
  probe.rho = s->config.fluid.density;
  probe.nu = s->config.fluid.viscosity;
  probe.length = n->probe_length;
  probe.profile = (bw_probe_profile)n->probe_profile;
  BW_TRY(make_points(s, 0.0, &s->wall));
  BW_TRY(bw_probe_create(s->grid, &probe, &s->probe));
  place(s, &s->wall, 0.0);
  return bw_probe_set_points(s->probe, s->wall.n, s->wall.X, s->wall.N);
}

/* After a restart: markers where they were, with the memory in inner.M. */
bw_status bw_scene__surfaces_restore(bw_scene *s)
{
  place(s, &s->inner, s->time);
  return hand_over(s, s->inner.M);
}

bw_status bw_scene__surfaces_step(bw_scene *s, double dt)
{
  static const double gamma[3] = {8.0 / 15.0, 2.0 / 15.0, 1.0 / 3.0}; /* bw_ns_channel.h */
  const bw_real *p = bw_ns_channel_pressure(s->fluid);
  bw_real *const *u = bw_ns_channel_velocity(s->fluid);
  const size_t size = bw_grid_look(s->grid)->size;
  BW_TRY(bw_ns_channel_check(s->fluid, dt));
  if (s->moving) {
    bw_ibm_mdf_memory(s->markers, s->inner.M);
    place(s, &s->inner, s->time + dt);
    BW_TRY(hand_over(s, s->inner.M));
  }
  bw_ibm_mdf_begin_step(s->markers);
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(s->fluid, r, dt);
    /* No slip, with the full dt (ERRATA 18). */
    bw_ibm_mdf_force(s->markers, u, dt);
    bw_ns_channel_project(s->fluid, r, dt);
    for (size_t q = 0; s->probe != NULL && q < size; q++)
      s->pressure[q] = (r == 0 ? 0 : s->pressure[q]) + (bw_real)gamma[r] * p[q];
  }
  return BW_OK;
}

/* Forces on one body, all ranks: by the markers' reaction and by the probes. Collective. */
static bw_status forces(bw_scene *s, double value[6], const char *names)
{
  const double rho = s->config.fluid.density;
  double *Q = NULL;
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&Q, 3 * s->inner.n)));
  bw_ibm_mdf_marker_force(s->markers, Q);
  for (size_t i = 0; i < s->inner.n; i++)
    for (size_t d = 0; d < 3; d++)
      if (bw_scene__listed(names, s->config.bodies[s->inner.body[i]].name))
        value[d] -= rho * Q[3 * i + d];
  bw_release(&Q);
  /* Where the surface is now, with its velocity. */
  place(s, &s->wall, s->time);
  BW_TRY(bw_probe_set_points(s->probe, s->wall.n, s->wall.X, s->wall.N));
  bw_probe_set_velocity(s->probe, s->wall.V, NULL);
  bw_probe_traction(s->probe, bw_ns_channel_velocity(s->fluid), s->pressure, NULL, s->wall.M, NULL);
  for (size_t i = 0; i < s->wall.n; i++)
    for (size_t d = 0; d < 3; d++)
      if (bw_scene__listed(names, s->config.bodies[s->wall.body[i]].name))
        value[3 + d] += s->wall.area[i] * s->wall.M[3 * i + d];
  bw_comm_sum(s->comm, 6, value);
  return BW_OK;
}

bw_status bw_scene__surface_force(bw_scene *s, const char *names,
                                  double value[BW_SCENE__COMPONENTS])
{
  double box[3];
  memset(value, 0, BW_SCENE__COMPONENTS * sizeof *value);
  BW_TRY(forces(s, value, names));
  /* The box is around all bodies: it says something of them together. */
  bw_ns_channel_control_volume(s->fluid, box);
  bool all = true;
  for (int b = 0; b < s->config.n_bodies; b++)
    all = all && bw_scene__listed(names, s->config.bodies[b].name);
  for (int d = 0; d < 3; d++)
    value[6 + d] = all ? -s->config.fluid.density * box[d] : NAN;
  return BW_OK;
}
