/* Rigid bodies in the fluid: markers on their surface, load, motion. */
#include "bw_coupler_rigid.h"
#include "bw_memory.h"
#include "rigid_films.h"

#include <math.h>
#include <string.h>

struct bw_coupler_rigid {
  bw_coupler_rigid_config config;
  bw_ns_channel *fluid; /* borrowed */
  bw_rigid *rigid;      /* borrowed */
  bw_ibm_mdf *ibm;
  bw_coupler__films *films; /* NULL: none */
  size_t n;                 /* markers of this rank */
  bool placed;
  double *X, *V, *N, *dV; /* (n,3), dV (n) */
  double *seen;           /* (n) of dV what the grid sees: films keep sides away from other faces */
  double *M, *Q;          /* (n,3) M memory, Q force of a step, then lack */
  double *inside;         /* (bodies,6) int (u - U) dV, its moment at the beginning */
  double *load;           /* (bodies,6) as the bodies have it: relaxed, with weight */
  double *hydro;          /* (bodies,6) of the fluid in the last step */
  double *scratch;        /* (bodies,6) */
};

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
  BW_THEN(st, BW_ALLOCATE(&c->inside, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->load, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->hydro, 6 * bodies));
  BW_THEN(st, BW_ALLOCATE(&c->scratch, 6 * bodies));
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
  void *const arrays[] = {&c->seen, &c->X,      &c->V,    &c->N,     &c->dV,     &c->M,
                          &c->Q,    &c->inside, &c->load, &c->hydro, &c->scratch};
  for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
    bw_release(arrays[a]);
  bw_release(coupler);
}

/* Cells lo <= i <= hi of this rank in direction d that the ball of radius R about x may reach; with
 * the ball across a periodic side all of them. */
static void reach(const bw_grid_view *g, int d, double x, double R, int lo[3], int hi[3])
{
  const double h = g->spacing[d], from = (x - R) / h, to = (x + R) / h;
  lo[d] = 1, hi[d] = g->m[d];
  if (g->n[d] == 1 || (g->periodic[d] && (from < 1.0 || to > g->n[d] - 1.0))) return;
  lo[d] = (int)fmax(1.0, floor(from) - g->lo[d]);
  hi[d] = (int)fmin(g->m[d], ceil(to) + 1.0 - g->lo[d]);
}

/* int (u - U) dV over body q where it is, or will be after dt at its present velocity and spin, and
 * its moment about the centre there, into sum (6): component d of the velocity in the cells of its
 * own points, by the share of each that is inside. U is the body's own motion, which does not
 * change in a step: without it the shares, whose sum changes as the body passes through the cells,
 * would push. Local. */
static void add_inside(const bw_coupler_rigid *c, int q, double dt, double sum[6])
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  const bw_rigid_state s = bw_rigid_state_of(c->rigid, q);
  const double R = bw_rigid_radius(c->rigid, q) + g->spacing[0];
  const double volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  const int dims = g->n[2] == 1 ? 2 : 3;
  int lo[3], hi[3];
  double X[3];
  for (int d = 0; d < 3; d++) {
    X[d] = s.position[d] + dt * s.velocity[d];
    reach(g, d, X[d], R, lo, hi);
  }
  for (int d = 0; d < dims; d++)
    for (int k = lo[2]; k <= hi[2]; k++)
      for (int j = lo[1]; j <= hi[1]; j++)
        for (int i = lo[0]; i <= hi[0]; i++) {
          const int cell[3] = {i, j, k};
          double x[3], r[3] = {0.0, 0.0, 0.0};
          /* From the centre to the nearest image of the point. */
          for (int e = 0; e < dims; e++) {
            r[e] = (cell[e] + g->lo[e] - (e == d ? 0.0 : 0.5)) * g->spacing[e] - X[e];
            if (g->periodic[e]) r[e] -= g->length[e] * round(r[e] / g->length[e]);
          }
          /* The shape is known where it is now: back from there, and turned back. */
          for (int e = 0; e < 3; e++)
            x[e] =
                s.position[e] + r[e] -
                dt * (s.spin[(e + 1) % 3] * r[(e + 2) % 3] - s.spin[(e + 2) % 3] * r[(e + 1) % 3]);
          const double away = bw_rigid_distance(c->rigid, q, x) / g->spacing[0];
          const double share = fmin(1.0, fmax(0.0, 0.5 - away)) * volume;
          if (share == 0.0) continue;
          /* (r x u e_d): e_e gets r_f u_d by the cyclic sign. */
          const int a = (d + 1) % 3, b = (d + 2) % 3;
          const double own = s.velocity[d] + s.spin[a] * r[b] - s.spin[b] * r[a];
          const double momentum = share * ((double)u[d][bw_at(g, i, j, k)] - own);
          sum[d] += momentum;
          sum[3 + a] += r[b] * momentum;
          sum[3 + b] -= r[a] * momentum;
        }
}

/* The same of all bodies, over all ranks. Collective. */
static void measure_inside(const bw_coupler_rigid *c, double dt, double sum[])
{
  const int n = bw_rigid_count(c->rigid);
  memset(sum, 0, 6 * (size_t)n * sizeof *sum);
  for (int q = 0; q < n; q++)
    add_inside(c, q, dt, sum + 6 * (ptrdiff_t)q);
  bw_comm_sum(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 6 * (size_t)n, sum);
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
  return bw_ibm_mdf_close(c->ibm, bw_rigid_count(c->rigid), bw_rigid_point_body(c->rigid), c->N);
}

bw_status bw_coupler_rigid_begin(bw_coupler_rigid *c)
{
  /* What is to be taken out of the reaction: the fluid inside now, against that after the step. */
  measure_inside(c, 0.0, c->inside);
  bw_ibm_mdf_begin_step(c->ibm);
  if (c->placed && !moves(c->rigid)) return BW_OK;
  if (c->placed) bw_ibm_mdf_memory(c->ibm, c->M);
  return place(c, c->placed ? c->M : NULL);
}

void bw_coupler_rigid_get_state(bw_coupler_rigid *c, double M[], double load[])
{
  memset(M, 0, 3 * c->n * sizeof *M);
  if (c->placed) bw_ibm_mdf_memory(c->ibm, M);
  memcpy(load, c->load, 6 * (size_t)bw_rigid_count(c->rigid) * sizeof *load);
}

bw_status bw_coupler_rigid_set_state(bw_coupler_rigid *c, const double M[], const double load[])
{
  memcpy(c->load, load, 6 * (size_t)bw_rigid_count(c->rigid) * sizeof *load);
  return place(c, M);
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
  measure_inside(c, dt, c->scratch);
  for (int i = 0; i < 6 * n; i++)
    c->hydro[i] += rho * (c->scratch[i] - c->inside[i]) / dt;
}

bw_status bw_coupler_rigid_advance(bw_coupler_rigid *c, double dt)
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
      c->scratch[(d < 3 ? 0 : 3 * n) + 3 * q + d % 3] = c->load[6 * q + d];
    }
  }
  if (c->films != NULL)
    BW_TRY(bw_coupler__films_brake(c->films, dt, c->scratch, c->scratch + 3 * (ptrdiff_t)n));
  bw_rigid_load(c->rigid, c->scratch, c->scratch + 3 * (ptrdiff_t)n);
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
