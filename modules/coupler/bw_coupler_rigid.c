/* Rigid bodies in the fluid: markers on their surface, load, motion. */
#include "bw_coupler_rigid.h"
#include "bw_memory.h"
#include "rigid_films.h"
#include "rigid_impl.h"

#include <math.h>
#include <string.h>

bw_coupler_rigid_config bw_coupler_rigid_config_default(void)
{
  return (bw_coupler_rigid_config){.rho = NAN,
                                   .nu = NAN,
                                   .virtual_mass = 1.0,
                                   .body = bw_ibm_mdf_config_default(),
                                   .films = {.limit = NAN, .roughness = NAN, .least = -INFINITY}};
}

static bw_status check(const bw_coupler_rigid_config *c, const bw_grid_view *g, const bw_rigid *r)
{
  const double h = fmax(g->spacing[0], fmax(g->spacing[1], g->n[2] == 1 ? 0.0 : g->spacing[2]));
  BW_REQUIRE(c->rho > 0.0, BW_EINPUT, "rigid bodies in a fluid: rho = %g: must be > 0", c->rho);
  BW_REQUIRE(c->nu > 0.0, BW_EINPUT, "rigid bodies in a fluid: nu = %g: must be > 0", c->nu);
  BW_REQUIRE(c->virtual_mass >= 0.0, BW_EINPUT,
             "rigid bodies in a fluid: virtual_mass = %g: must not be negative", c->virtual_mass);
  BW_REQUIRE(c->body.memory > 0.0, BW_EINPUT,
             "rigid bodies in a fluid: memory = %g of the forcing: must be > 0 on a true surface",
             c->body.memory);
  for (int q = 0; q < bw_rigid_count(r); q++)
    BW_REQUIRE(bw_rigid_radius(r, q) >= 2.0 * h, BW_EINPUT,
               "rigid body %d is %g wide, fewer than four cells of %g: refine the grid", q,
               2.0 * bw_rigid_radius(r, q), h);
  return BW_OK;
}

static bw_status check_points(const bw_coupler_rigid *c)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const double h = fmax(g->spacing[0], g->spacing[1]);
  const double *area = bw_rigid_point_area(c->rigid);
  const double most = g->n[2] == 1 ? 1.5 * h * g->spacing[2] : 2.25 * h * h;
  double largest = 0.0;
  for (size_t i = 0; i < c->n; i++)
    largest = fmax(largest, area[i]);
  bw_comm_max(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 1, &largest);
  BW_REQUIRE(largest <= most, BW_EINPUT,
             "rigid bodies in a fluid: a surface point stands for an area of %g, more than %g: "
             "fluid would leak through; give bodies a spacing of about %g",
             largest, most, h);
  return BW_OK;
}

/* For the markers, which know no fluid. */
static void set_ghosts(void *fluid)
{
  bw_ns_channel_ghosts(fluid);
}

static bw_status make_arrays(bw_coupler_rigid *c)
{
  const size_t bodies = (size_t)bw_rigid_count(c->rigid);
  bw_status st = BW_ALLOCATE(&c->X, 3 * c->n);
  BW_THEN(st, BW_ALLOCATE(&c->V, 3 * c->n));
  BW_THEN(st, BW_ALLOCATE(&c->N, 3 * c->n));
  BW_THEN(st, BW_ALLOCATE(&c->M, 3 * c->n));
  BW_THEN(st, BW_ALLOCATE(&c->Q, 3 * c->n));
  BW_THEN(st, BW_ALLOCATE(&c->dV, c->n));
  BW_THEN(st, BW_ALLOCATE(&c->seen, c->n));
  BW_THEN(st, BW_ALLOCATE(&c->closed, c->n));
  BW_THEN(st, BW_ALLOCATE(&c->inside, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->load, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->hydro, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->scratch, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->acting, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->marked, 3 * c->n));
  return st;
}

bw_status bw_coupler_rigid_create(const bw_coupler_rigid_config *config, bw_ns_channel *fluid,
                                  bw_rigid *rigid, bw_coupler_rigid **out)
{
  bw_grid *grid = bw_ns_channel_grid(fluid);
  const bw_grid_view *g = bw_grid_look(grid);
  bw_coupler_rigid *c = NULL;
  *out = NULL;
  BW_TRY(check(config, g, rigid));
  bw_status st = BW_ALLOCATE(&c, 1);
  BW_TRY(bw_comm_agree(bw_grid_comm(grid), st));
  c->config = *config, c->fluid = fluid, c->rigid = rigid;
  c->n = bw_rigid_points(rigid);
  st = bw_comm_agree(bw_grid_comm(grid), make_arrays(c));
  BW_THEN(st, check_points(c));
  BW_THEN(st, bw_ibm_mdf_create(grid, &config->body, &c->ibm));
  if (config->films.on)
    BW_THEN(st, bw_coupler__films_create(&config->films, config->rho * config->nu, fluid, rigid,
                                         &c->films));
  if (st != BW_OK) {
    bw_coupler_rigid_destroy(&c);
    return st;
  }
  bw_ibm_mdf_set_ghosts(c->ibm, set_ghosts, fluid);
  /* Volume of a marker: its area times the spacing (ERRATA 17). */
  const double h = cbrt(g->spacing[0] * g->spacing[1] * g->spacing[2]);
  const double flat = sqrt(g->spacing[0] * g->spacing[1]);
  for (size_t i = 0; i < c->n; i++)
    c->dV[i] = bw_rigid_point_area(rigid)[i] * (g->n[2] == 1 ? flat : h);
  *out = c;
  return BW_OK;
}

void bw_coupler_rigid_destroy(bw_coupler_rigid **coupler)
{
  bw_coupler_rigid *c = *coupler;
  if (c == NULL) return;
  bw_ibm_mdf_destroy(&c->ibm);
  bw_coupler__films_destroy(&c->films);
  bw_release(&c->closed);
  void *const arrays[] = {&c->seen,    &c->X,      &c->V,      &c->N,    &c->dV,
                          &c->M,       &c->Q,      &c->inside, &c->load, &c->hydro,
                          &c->scratch, &c->acting, &c->marked};
  for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
    bw_release(arrays[a]);
  bw_release(coupler);
}

/* Does any body move? The same on all ranks. */
static bool moves(const bw_rigid *r)
{
  for (int q = 0; q < bw_rigid_count(r); q++) {
    const bw_rigid_state s = bw_rigid_state_of(r, q);
    for (int d = 0; d < 3; d++)
      if (s.velocity[d] != 0.0 || s.spin[d] != 0.0) return true;
  }
  return false;
}

/* Which closed surface each marker lies on: that of its body, unless a film keeps some of that
 * body's markers back. What is inside then presses on the gap, where nothing holds it.
 * Collective. */
static void find_closed(bw_coupler_rigid *c)
{
  const int *body = bw_rigid_point_body(c->rigid), bodies = bw_rigid_count(c->rigid);
  double *open = c->scratch;
  memset(open, 0, (size_t)bodies * sizeof *open);
  for (size_t i = 0; i < c->n; i++)
    if (c->seen[i] < c->dV[i]) open[body[i]] = 1.0;
  bw_comm_max(bw_grid_comm(bw_ns_channel_grid(c->fluid)), (size_t)bodies, open);
  for (size_t i = 0; i < c->n; i++)
    c->closed[i] = open[body[i]] > 0.0 ? -1 : body[i];
}

/* Markers where the bodies are, with a memory or without. */
static bw_status place(bw_coupler_rigid *c, const double *memory)
{
  bw_rigid_surface(c->rigid, c->X, c->V, c->N);
  memcpy(c->seen, c->dV, c->n * sizeof *c->seen);
  if (c->films != NULL) {
    bw_coupler__films_retract(c->films, c->n, c->N, c->X, c->seen);
    for (size_t i = 0; i < c->n; i++)
      c->seen[i] *= c->dV[i];
  }
  BW_TRY(bw_ibm_mdf_set_markers(c->ibm, c->n, c->X, c->V, c->seen, memory));
  c->placed = true;
  BW_TRY(bw_ibm_mdf_set_normals(c->ibm, c->N, c->config.nu));
  find_closed(c);
  return bw_ibm_mdf_close(c->ibm, bw_rigid_count(c->rigid), c->closed, c->N);
}

bw_status bw_coupler_rigid_begin(bw_coupler_rigid *c)
{
  /* What is to be taken out of the reaction: the fluid inside now, against that after the step. */
  bw_coupler__rigid_inside(c, 0.0, c->inside);
  /* What is placed by a restart is not placed again: what it remembers would round. */
  const bool stays = c->fresh || (c->placed && !moves(c->rigid));
  c->fresh = false;
  if (!stays && c->placed) bw_ibm_mdf_memory(c->ibm, c->M);
  if (!stays) BW_TRY(place(c, c->placed ? c->M : NULL));
  /* Behind that, as the pressure inside goes out of the memory by the normals of now. */
  bw_ibm_mdf_begin_step(c->ibm);
  return BW_OK;
}

void bw_coupler_rigid_get_state(bw_coupler_rigid *c, double M[], double load[])
{
  memset(M, 0, 3 * c->n * sizeof *M);
  /* Of markers that were placed with a memory it is that one: they have let pressure out of it. */
  if (c->fresh)
    memcpy(M, c->M, 3 * c->n * sizeof *M);
  else if (c->placed)
    bw_ibm_mdf_memory(c->ibm, M);
  memcpy(load, c->load, 6 * (size_t)bw_rigid_count(c->rigid) * sizeof *load);
}

bw_status bw_coupler_rigid_set_state(bw_coupler_rigid *c, const double M[], const double load[])
{
  memcpy(c->load, load, 6 * (size_t)bw_rigid_count(c->rigid) * sizeof *load);
  memcpy(c->M, M, 3 * c->n * sizeof *M);
  c->fresh = true;
  return place(c, c->M);
}

void bw_coupler_rigid_force(bw_coupler_rigid *c, double dt)
{
  bw_ibm_mdf_force(c->ibm, bw_ns_channel_velocity(c->fluid), dt);
}

/* hydro (bodies,6): force and torque of the fluid outside over the step. Collective. */
static void find_force(bw_coupler_rigid *c, double dt)
{
  const int n = bw_rigid_count(c->rigid);
  const double rho = c->config.rho;
  double *F = c->scratch, *T = c->scratch + 3 * (ptrdiff_t)n;
  bw_ibm_mdf_marker_force(c->ibm, c->Q);
  for (size_t i = 0; i < 3 * c->n; i++)
    c->Q[i] *= -rho;
  bw_rigid_sum(c->rigid, c->Q, F, T);
  for (int q = 0; q < n; q++)
    for (int d = 0; d < 3; d++) {
      c->hydro[6 * q + d] = F[3 * q + d];
      c->hydro[6 * q + 3 + d] = T[3 * q + d];
    }
  /* The reaction moves the fluid inside, too: that is no force on the body. It goes with the body:
   * over a place that stands still, what the body comes to cover would count as pushed. */
  bw_coupler__rigid_inside(c, dt, c->scratch);
  for (int i = 0; i < 6 * n; i++)
    c->hydro[i] += rho * (c->scratch[i] - c->inside[i]) / dt;
}

bw_rigid *bw_coupler__rigid_set(const bw_coupler_rigid *c)
{
  return c->rigid;
}

const double *bw_coupler__rigid_acting(const bw_coupler_rigid *c)
{
  return c->acting;
}

double *bw_coupler__rigid_scratch(bw_coupler_rigid *c)
{
  return c->scratch;
}

bw_status bw_coupler__rigid_find_load(bw_coupler_rigid *c, double dt)
{
  const int n = bw_rigid_count(c->rigid);
  find_force(c, dt);
  for (int q = 0; q < n; q++) {
    const bw_rigid_state s = bw_rigid_state_of(c->rigid, q);
    const double displaced = c->config.rho * s.volume;
    const double w = s.mass / (s.mass + c->config.virtual_mass * displaced);
    for (int d = 0; d < 6; d++) {
      const double weight = d < 3 ? (s.mass - displaced) * c->config.gravity[d] : 0.0;
      const double F = c->hydro[6 * q + d] + weight;
      /* (m + m_v) A = F + m_v A before, with m A the load. */
      c->load[6 * q + d] += w * (F - c->load[6 * q + d]);
      c->acting[(d < 3 ? 0 : 3 * n) + 3 * q + d % 3] = c->load[6 * q + d];
    }
  }
  if (c->films == NULL) return BW_OK;
  return bw_coupler__films_brake(c->films, dt, c->acting, c->acting + 3 * (ptrdiff_t)n);
}

bw_status bw_coupler_rigid_advance(bw_coupler_rigid *c, double dt)
{
  BW_TRY(bw_coupler__rigid_find_load(c, dt));
  bw_rigid_load(c->rigid, c->acting, c->acting + 3 * (ptrdiff_t)bw_rigid_count(c->rigid));
  /* Springs and contact may ask for shorter steps than the fluid. */
  const double parts = fmax(1.0, ceil(dt / bw_rigid_dt_max(c->rigid)));
  BW_REQUIRE(parts <= 1e5, BW_ECFL,
             "rigid bodies: a step of %g takes %g of the bodies': softer springs or contact", dt,
             parts);
  for (double k = 0.0; k < parts; k++)
    BW_TRY(bw_rigid_step(c->rigid, dt / parts));
  return BW_OK;
}

bw_status bw_coupler_rigid_step(bw_coupler_rigid *c, double dt)
{
  BW_TRY(bw_ns_channel_check(c->fluid, dt));
  BW_TRY(bw_coupler_rigid_begin(c));
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(c->fluid, r, dt);
    bw_coupler_rigid_force(c, dt);
    bw_ns_channel_project(c->fluid, r, dt);
  }
  /* u and p at t + dt around the bodies at t. */
  BW_TRY(bw_ns_channel_check(c->fluid, dt));
  return bw_coupler_rigid_advance(c, dt);
}

double bw_coupler_rigid_film_energy(const bw_coupler_rigid *c)
{
  return c->films == NULL ? 0.0 : bw_coupler__films_taken(c->films);
}

double bw_coupler_rigid_film_gap(const bw_coupler_rigid *c)
{
  return c->films == NULL ? INFINITY : bw_coupler__films_gap(c->films);
}

void bw_coupler_rigid_set_film_energy(bw_coupler_rigid *c, double energy)
{
  if (c->films != NULL) bw_coupler__films_count(c->films, energy);
}

bw_status bw_coupler_rigid_measure(bw_coupler_rigid *c, bw_coupler_rigid_report report[])
{
  const size_t n = (size_t)bw_rigid_count(c->rigid);
  double *sum = c->scratch; /* lack^2 dA, dA, |lack.n| dA of each body */
  memset(sum, 0, 3 * n * sizeof *sum);
  bw_ibm_mdf_lack_of(c->ibm, bw_ns_channel_velocity(c->fluid), c->Q);
  for (size_t i = 0; i < c->n; i++) {
    const size_t q = (size_t)bw_rigid_point_body(c->rigid)[i];
    const double area = bw_rigid_point_area(c->rigid)[i], *lack = c->Q + 3 * i;
    double normal = 0.0;
    for (size_t d = 0; d < 3; d++) {
      sum[3 * q] += lack[d] * lack[d] * area;
      normal += lack[d] * c->N[3 * i + d];
    }
    sum[3 * q + 1] += area;
    sum[3 * q + 2] += 0.5 * fabs(normal) * area;
  }
  bw_comm_sum(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 3 * n, sum);
  for (size_t q = 0; q < n; q++) {
    memcpy(report[q].force, c->hydro + 6 * q, sizeof report[q].force);
    memcpy(report[q].torque, c->hydro + 6 * q + 3, sizeof report[q].torque);
    report[q].slip = sqrt(sum[3 * q] / sum[3 * q + 1]);
    report[q].flux = sum[3 * q + 2];
    memset(report[q].film, 0, sizeof report[q].film);
    report[q].braking = 0.0;
    if (c->films != NULL)
      report[q].braking = bw_coupler__films_of(c->films, (int)q, report[q].film);
  }
  return BW_OK;
}
