/* What the fluid around drives films between particles with, and what they do to the solid. */
#include "bw_kernel_delta.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

/* ---- the fluid around ---- */

/* Own edges as probe points, with the acceleration of their particles over the step. */
static size_t place_probes(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  const double drive[3] = {bw_ns_channel_driving(c->fluid)};
  size_t n = 0;
  bw_solid_get_velocity(c->solid, f->v);
  for (size_t e = 0; e < f->n_edges; e++) {
    const int32_t s = f->edge_point[e];
    if (!bw_coupler__film_own(f, s)) continue;
    const size_t p = (size_t)f->list[s].particle;
    for (size_t d = 0; d < 3; d++) {
      f->probe_X[3 * n + d] = f->X[3 * s + (ptrdiff_t)d] + f->H[s] * f->N[3 * s + (ptrdiff_t)d];
      f->probe_N[3 * n + d] = f->N[3 * s + (ptrdiff_t)d];
      f->probe_A[3 * n + d] = (f->v[3 * p + d] - c->V_before[3 * p + d]) / dt - drive[d];
    }
    f->probe_of[n++] = (int32_t)e;
  }
  return n;
}

/* f->edge: the pressure of each edge on all ranks; NaN where a probe has no room. Collective. */
static bw_status read_edges(bw_coupler *c, double dt, double relaxation)
{
  bw_coupler__solid_films *f = c->films;
  BW_TRY(bw_coupler__find_obstacles(c));
  const size_t n = place_probes(c, dt);
  BW_TRY(bw_probe_set_points(c->probe, n, f->probe_X, f->probe_N));
  bw_probe_traction(c->probe, bw_ns_channel_velocity(c->fluid), bw_coupler__read_pressure(c),
                    f->probe_A, f->traction, f->flag);
  memset(f->edge, 0, f->n_edges * sizeof *f->edge);
  for (size_t q = 0; q < n; q++) {
    const double *t = f->traction + 3 * q, *N = f->probe_N + 3 * q;
    double *kept = f->edge_p + f->list[f->edge_point[f->probe_of[q]]].particle;
    const bool room = f->flag[q] != BW_PROBE_BLOCKED;
    const double p = -(t[0] * N[0] + t[1] * N[1] + t[2] * N[2]);
    *kept = !room ? NAN : isnan(*kept) ? p : *kept + relaxation * (p - *kept);
    f->edge[f->probe_of[q]] = *kept;
  }
  /* One rank has each; NaN comes through the sum. */
  bw_comm_sum(bw_solid_comm(c->solid), f->n_edges, f->edge);
  return BW_OK;
}

/* Rows of the used points of all ranks, each from the rank that has it: values (particles,3) by
 * particle or, where a row is given, by that. Collective. */
static void tell_used(bw_coupler *c, const double value[], const int32_t row[], double out[])
{
  bw_coupler__solid_films *f = c->films;
  double *packed = f->F; /* scratch */
  memset(packed, 0, 3 * f->n_used * sizeof *packed);
  for (size_t u = 0; u < f->n_used; u++) {
    if (!bw_coupler__film_own(f, f->used[u])) continue;
    const int32_t p = f->list[f->used[u]].particle, at = row == NULL ? p : row[p];
    if (at >= 0) memcpy(packed + 3 * u, value + 3 * (ptrdiff_t)at, 3 * sizeof *packed);
  }
  bw_comm_sum(bw_solid_comm(c->solid), 3 * f->n_used, packed);
  for (size_t u = 0; u < f->n_used; u++)
    memcpy(out + 3 * (ptrdiff_t)f->used[u], packed + 3 * u, 3 * sizeof *out);
}

void bw_coupler__solid_films_tell(bw_coupler *c, const double value[])
{
  tell_used(c, value, NULL, c->films->V);
}

/* F of the used points to nothing. */
static void clear_used(bw_coupler__solid_films *f)
{
  for (size_t u = 0; u < f->n_used; u++)
    memset(f->F + 3 * (ptrdiff_t)f->used[u], 0, 3 * sizeof *f->F);
}

/* p at x by the cells around it, on the rank that owns it; elsewhere 0. */
static double pressure_at(const bw_coupler *c, const double x[3])
{
  const bw_grid *grid = bw_ns_channel_grid(c->fluid);
  const bw_grid_view *g = bw_grid_look(grid);
  const bw_real *p = bw_coupler__read_pressure(c);
  int i[3] = {1, 1, 1};
  double part[3] = {0.0, 0.0, 0.0}, sum = 0.0;
  if (bw_grid_owner(grid, x) != bw_comm_rank(bw_grid_comm(grid))) return 0.0;
  for (int d = 0; d < 3; d++) {
    if (g->n[d] == 1) continue;
    const double turns = g->periodic[d] ? floor(x[d] / g->length[d]) : 0.0;
    const double s = (x[d] - turns * g->length[d]) / g->spacing[d] + 0.5 - g->lo[d];
    i[d] = (int)floor(s);
    part[d] = s - floor(s);
  }
  for (int corner = 0; corner < 8; corner++) {
    double weight = 1.0;
    int at[3];
    for (int d = 0; d < 3; d++) {
      const int up = corner >> d & 1;
      weight *= up ? part[d] : 1.0 - part[d];
      at[d] = i[d] + up;
    }
    if (weight > 0.0) sum += weight * (double)p[bw_at(g, at[0], at[1], at[2])];
  }
  return c->config.rho * sum;
}

/* f->T of a load by the reaction. Markers' forces on one face alone are no stress: the fluid inside
 * the body presses from behind. The momentum of the half space beyond the middle of the gap gives
 * the force across: p there, and what kernels spread of either face's force across it (a wall has
 * no markers). Also where faces have no markers yet: then those outside bear what the fluid inside
 * presses with. */
static void find_across(bw_coupler *c)
{
  bw_coupler__solid_films *f = c->films;
  const double radius = bw_kernel_delta_get(c->config.kernel)->radius;
  for (size_t a = 0; a < f->n_nodes; a++) {
    const bw_film_node *node = f->node + a;
    double middle[3];
    for (size_t d = 0; d < 3; d++)
      middle[d] = f->X[3 * (size_t)node->point + d] +
                  (f->H[node->point] + 0.5 * node->gap) * node->normal[d];
    f->p_mid[a] = pressure_at(c, middle);
  }
  bw_comm_sum(bw_solid_comm(c->solid), f->n_nodes, f->p_mid);
  for (size_t a = 0; a < f->n_nodes; a++) {
    const double away = fmin(1.0, 0.5 * f->node[a].gap / (c->h * radius));
    const double spread = f->spread[(int)(away * BW_COUPLER__SPREAD)];
    for (size_t d = 0; d < 3; d++)
      f->T[3 * a + d] = (f->node[a].wall ? 1.0 : 2.0) * spread * f->T[3 * a + d] +
                        f->p_mid[a] * f->node[a].normal[d];
  }
}

bw_status bw_coupler__solid_films_replace(bw_coupler *c, double dt, double relaxation)
{
  bw_coupler__solid_films *f = c->films;
  if (!bw_coupler__solid_films_any(c)) return BW_OK;
  BW_TRY(read_edges(c, dt, relaxation));
  tell_used(c, c->force, f->row, f->L);
  bw_film_net_between(f->net, f->L, f->T);
  if (c->config.load == BW_LOAD_REACTION) find_across(c);
  clear_used(f);
  bw_film_net_replace(f->net, f->T, f->F);
  for (size_t u = 0; u < f->n_used; u++) {
    const int32_t s = f->used[u];
    if (!bw_coupler__film_own(f, s)) continue;
    for (ptrdiff_t d = 0; d < 3; d++)
      c->load[3 * f->list[s].particle + d] += f->F[3 * s + d];
  }
  if (c->config.films.flux && c->config.load == BW_LOAD_REACTION) bw_coupler__solid_films_bear(c);
  return BW_OK;
}

/* ---- what they do ---- */

void bw_coupler__solid_films_base(bw_coupler *c, const double F[])
{
  bw_coupler__solid_films *f = c->films;
  memcpy(f->base, F, 3 * c->n * sizeof *f->base);
  /* What the last step has brought is on the grid now. */
  memset(f->carried, 0, c->n * sizeof *f->carried);
  /* From now on the solid's force is that, without films. */
  memset(f->density, 0, 3 * c->n * sizeof *f->density);
}

bw_status bw_coupler__solid_films_press(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  if (!bw_coupler__solid_films_any(c)) return BW_OK;
  const double drive[3] = {c->config.rho * bw_ns_channel_driving(c->fluid)};
  double *ahead = f->a;
  /* V* = V + dt a, a without what films do now. */
  bw_solid_get_position(c->solid, f->before);
  bw_solid_get_velocity(c->solid, f->v);
  bw_solid_get_acceleration(c->solid, ahead);
  for (size_t i = 0; i < 3 * c->n; i++) {
    const double own = f->density[i] / bw_solid_density(c->solid, i / 3);
    const bool held = (bw_solid_kind(c->solid)[i / 3] & BW_PD_PRESCRIBED) != 0;
    ahead[i] = f->v[i] + dt * (held ? 0.0 : ahead[i] - own);
  }
  tell_used(c, ahead, NULL, f->V);
  BW_TRY(bw_film_net_press(f->net, dt, f->V, f->edge, drive));
  if (c->config.films.flux) bw_coupler__solid_films_bring(c, dt);
  clear_used(f);
  bw_film_net_force(f->net, f->F);
  memset(f->density, 0, 3 * c->n * sizeof *f->density);
  for (size_t u = 0; u < f->n_used; u++) {
    const int32_t s = f->used[u];
    if (!bw_coupler__film_own(f, s)) continue;
    const size_t p = (size_t)f->list[s].particle;
    for (size_t d = 0; d < 3; d++)
      f->density[3 * p + d] = f->F[3 * s + (ptrdiff_t)d] / bw_solid_volume_of(c->solid, p);
  }
  for (size_t i = 0; i < 3 * c->n; i++)
    ahead[i] = f->base[i] + f->density[i];
  bw_solid_set_force(c->solid, ahead);
  return BW_OK;
}

/* As the solid's kicks book it: half a step with the mean of the velocities before and in its
 * middle, half a step with that in the middle and after. */
void bw_coupler__solid_films_book(bw_coupler *c, double dt)
{
  bw_coupler__solid_films *f = c->films;
  double *after = f->a, *X = c->X;
  if (!bw_coupler__solid_films_any(c)) return;
  bw_solid_get_velocity(c->solid, after);
  bw_solid_get_position(c->solid, X);
  for (size_t i = 0; i < 3 * c->n; i++) {
    const double middle = (X[i] - f->before[i]) / dt;
    c->work.film -= 0.25 * dt * bw_solid_volume_of(c->solid, i / 3) * f->density[i] *
                    (f->v[i] + 2.0 * middle + after[i]);
  }
}

void bw_coupler__solid_films_look(const bw_coupler *c, bw_coupler_report *r)
{
  const bw_coupler__solid_films *f = c->films;
  r->film_nodes = f == NULL ? 0 : (int64_t)f->n_nodes;
  r->film_gap = INFINITY, r->film_pressure = 0.0;
  for (int64_t a = 0; a < r->film_nodes; a++) {
    r->film_gap = fmin(r->film_gap, f->node[a].gap);
    r->film_pressure = fmax(r->film_pressure, fabs(f->node[a].pressure));
  }
}

void bw_coupler__solid_films_add(const bw_coupler *c, double load[])
{
  for (size_t i = 0; i < 3 * c->n; i++)
    load[i] += bw_solid_volume_of(c->solid, i / 3) * c->films->density[i];
}

double bw_coupler_film_energy(const bw_coupler *c)
{
  double sum = c->work.film;
  bw_comm_sum(bw_solid_comm(c->solid), 1, &sum);
  return sum;
}

double bw_coupler_film_gap(const bw_coupler *c)
{
  bw_coupler_report r;
  bw_coupler__solid_films_look(c, &r);
  return r.film_gap;
}

double bw_coupler_film_flux(const bw_coupler *c, const double x[3], const double n[3])
{
  return c->films == NULL ? 0.0 : bw_film_net_flux(c->films->net, x, n);
}
