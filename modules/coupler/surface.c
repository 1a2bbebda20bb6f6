/* Where the fluid meets the solid: markers, probe points, and the load they bring. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

/* Particles beyond a side of the box (ghost layers under a wall, fragments that left) do not
 * meet the fluid. */
bool bw_coupler__within_box(const bw_grid_view *g, const double x[3])
{
  for (int d = 0; d < 3; d++)
    if (!g->periodic[d] && (g->halo[d] > 0 || g->n[d] > 1) && !(x[d] > 0.0 && x[d] < g->length[d]))
      return false;
  return true;
}

/* Over the grid's spacing; a retraction is off by 6 c^2 h^2/R^2 of the resistance at most, 2e-4. */
static const double BENT = 0.02;

/* How far outside its particle's centre surface point q is, or its marker. Markers that know their
 * normal stand on the surface, others sit inside it (ERRATA 21). */
static double outside(const bw_coupler *c, size_t q, bool marker)
{
  const bool inside = marker && isnan(c->side[3 * q]);
  return c->height[q] - (inside ? c->config.retraction * c->h : 0.0);
}

void bw_coupler__know_motion(bw_coupler *c)
{
  if (c->motion_known) return;
  bw_pd_interface_turn(c->interface, c->turn);
  bw_solid_get_velocity(c->solid, c->V);
  c->motion_known = true;
}

void bw_coupler__marker_velocity(bw_coupler *c, double V[])
{
  bw_coupler__know_motion(c);
  for (size_t q = 0; q < c->n_surface; q++) {
    /* V + out spin x N: a surface that turns moves faster than its particles' centres. */
    const double *spin = c->turn + 3 * (size_t)c->row[q], *v = c->V + 3 * (size_t)c->particle[q];
    bw_coupler__moment(outside(c, q, true), spin, c->normal + 3 * q, V + 3 * q);
    for (size_t d = 0; d < 3; d++)
      V[3 * q + d] += v[d];
  }
}

void bw_coupler__tell_surface(bw_coupler *c, const double V[])
{
  double *before = c->scratch[2];
  /* What the markers do now; the difference is put on the particles' velocities. */
  bw_coupler__marker_velocity(c, before);
  for (size_t q = 0; q < c->n_surface; q++)
    for (size_t d = 0; d < 3; d++)
      c->V[3 * (size_t)c->particle[q] + d] += V[3 * q + d] - before[3 * q + d];
}

/* Which particles have lost a bond. */
static void look_at_bonds(bw_coupler *c)
{
  if (c->events == bw_solid_events(c->solid)) return;
  bw_solid_get_broken(c->solid, c->broken);
  c->events = bw_solid_events(c->solid);
}

/* Surface particles inside the box: probe roots on the nominal surface, the mean of their open
 * sides; markers there too, or `retraction` grid spacings inside. */
static void place(bw_coupler *c)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_pd_surface s = bw_pd_interface_surface(c->interface);
  size_t n = 0;
  look_at_bonds(c);
  for (size_t q = 0; q < s.n; q++) {
    const double *X = s.X + 3 * q, *N = s.N + 3 * q;
    /* Ghost layers and what has left do not meet the fluid. */
    if (!bw_coupler__within_box(g, X)) continue;
    c->particle[n] = s.particle[q];
    c->height[n] = s.H[q];
    c->closed[n] = c->body[s.particle[q]];
    /* A normal is of use where it is one, and where there is memory: what pushes across a ridge
     * would pass for shear. Where nearly nothing bends a retraction does the same. */
    const bool bent = s.bend[q] * c->h > BENT;
    const bool sided = c->on_surface && bent && c->broken[c->particle[n]] == 0;
    for (int d = 0; d < 3; d++)
      c->side[3 * n + d] = sided ? N[d] : NAN;
    const double out = outside(c, n, false), in = outside(c, n, true);
    for (int d = 0; d < 3; d++) {
      c->root[3 * n + d] = X[d] + out * N[d];
      c->marker_X[3 * n + d] = X[d] + in * N[d];
      c->normal[3 * n + d] = N[d];
    }
    /* Rows of the surface are thinned out to those inside, which remember where they came from. */
    c->area[n] = s.A[q];
    c->marker_dV[n] = s.A[q] * c->h; /* ERRATA 17 */
    c->row[n++] = (int32_t)q;
  }
  c->n_surface = n;
  /* The surface has moved: its velocities are those of now. */
  c->motion_known = false;
  bw_coupler__marker_velocity(c, c->marker_V);
}

bw_status bw_coupler__follow_surface(bw_coupler *c)
{
  /* Who is surface, where, with which normal. */
  BW_TRY(bw_pd_interface_update(c->interface));
  if (c->revision != bw_solid_revision(c->solid)) BW_TRY(bw_coupler__renew(c));
  /* Markers, roots, velocities of those inside the box. */
  place(c);
  if (c->block > 1) BW_TRY(bw_coupler__blocks_follow(c));
  /* Handed over when the next step begins: until then the old forces can be asked for. */
  c->markers_moved = true;
  if (c->films != NULL) BW_TRY(bw_coupler__solid_films_follow(c));
  bw_timer_work(c->timer, BW_PART_SURFACE, (double)c->n);
  return BW_OK;
}

/* The memory of the surface points: that of their particles, or a part of it, or none. */
static void place_memory(bw_coupler *c)
{
  for (size_t q = 0; q < c->n_surface; q++) {
    const size_t p = (size_t)c->particle[q];
    const double keeps = bw_coupler__solid_films_keep(c, p);
    for (size_t d = 0; d < 3; d++)
      c->marker_M[3 * q + d] = keeps * c->M[3 * p + d];
  }
}

bw_status bw_coupler__place_markers(bw_coupler *c)
{
  if (!c->markers_moved) return BW_OK;
  const bw_coupler__blocks *b = &c->blocks;
  c->markers_moved = false;
  place_memory(c);
  if (c->films != NULL) BW_TRY(bw_coupler__solid_films_aim(c));
  c->handed = c->block > 1 ? b->n : c->n_surface;
  if (c->block > 1) {
    bw_coupler__blocks_gather_memory(c);
    BW_TRY(bw_ibm_mdf_set_markers(c->ibm, b->n, b->X, b->V, b->dV, b->M));
  } else
    BW_TRY(bw_ibm_mdf_set_markers(c->ibm, c->n_surface, c->marker_X, c->marker_V, c->marker_dV,
                                  c->marker_M));
  if (c->on_surface)
    BW_TRY(bw_ibm_mdf_set_normals(c->ibm, c->block > 1 ? b->N : c->side, c->config.nu));
  return c->block > 1 ? bw_ibm_mdf_close(c->ibm, c->n_bodies, b->body, b->out)
                      : bw_ibm_mdf_close(c->ibm, c->n_bodies, c->closed, c->normal);
}

void bw_coupler__remember(bw_coupler *c)
{
  if (c->config.memory == 0.0) return;
  if (c->block > 1) {
    bw_coupler__blocks_memory(c);
    c->markers_moved = true; /* shared out and summed again it rounds, as after a restart */
  } else
    bw_ibm_mdf_memory(c->ibm, c->marker_M);
  /* What is no surface (any more), or out of the box, has nothing to remember. */
  memset(c->M, 0, 3 * c->n * sizeof *c->M);
  for (size_t q = 0; q < c->n_surface; q++)
    memcpy(c->M + 3 * (size_t)c->particle[q], c->marker_M + 3 * q, 3 * sizeof *c->M);
}

/* Cells (with halos) that probes on the surface, wherever it moves in a step, can read: its
 * bounding box and a tip, half a stencil, a kernel and a cell on either side. */
void bw_coupler__find_reach(bw_coupler *c)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  double far[6] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
  /* Largest coordinates and largest negative ones: one maximum over ranks for both. */
  for (size_t q = 0; q < c->n_surface; q++)
    for (int d = 0; d < 3; d++) {
      far[d] = fmax(far[d], c->root[3 * q + d]);
      far[3 + d] = fmax(far[3 + d], -c->root[3 * q + d]);
    }
  bw_comm_max(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 6, far);
  for (int d = 0; d < 3; d++) {
    /* A probe from any side of a particle, and three cells for half a stencil, the kernel and what
     * it moves in a step. */
    const double h = g->spacing[d], ds = bw_solid_settings(c->solid)->ds;
    const double more = (c->config.probe_length * c->h + ds) / h + 3.0;
    const int lowest = 1 - g->halo[d], highest = g->m[d] + g->halo[d];
    const double from = floor(-far[3 + d] / h - more), to = ceil(far[d] / h + more);
    /* A box that crosses a periodic seam is seen from both ends: the whole direction. */
    const bool around = g->periodic[d] && (from < 1.0 || to > g->n[d]); /* seen from both ends */
    const bool none = !(from <= to);
    c->reach[d][0] = none || around ? lowest : (int)fmax(lowest, from - g->lo[d]);
    c->reach[d][1] = none ? lowest - 1 : around ? highest : (int)fmin(highest, to - g->lo[d]);
  }
}

void bw_coupler__reaction_force(bw_coupler *c)
{
  /* A block's force goes back to its members. */
  if (c->block > 1) {
    bw_coupler__blocks_reaction(c);
    return;
  }
  bw_ibm_mdf_marker_force(c->ibm, c->force);
  for (size_t q = 0; q < 3 * c->n_surface; q++)
    c->force[q] *= -c->config.rho; /* ERRATA 18 */
}

void bw_coupler__count_work(bw_coupler *c, double dt)
{
  for (size_t q = 0; q < 3 * c->n_surface; q++) /* a block's shares meet its mean velocity */
    c->work.given += dt * c->force[q] * c->marker_V[q];
}

/* Power of the load that the particles do not feel in this step, as the fluid was told they move.
 */
static double power_held_back(const bw_coupler *c)
{
  double sum = 0.0;
  for (size_t i = 0; i < 3 * c->n; i++)
    sum += (c->load[i] - bw_solid_volume_of(c->solid, i / 3) * c->F[i]) * c->V[i];
  return sum;
}

void bw_coupler__moment(double out, const double N[3], const double force[3], double moment[3])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    moment[d] = out * (N[e] * force[f] - N[f] * force[e]);
  }
}

/* c->load: the forces of the surface points, or of their markers, on the particles: force, moment
 * and power are the same. */
void bw_coupler__carry_force(bw_coupler *c, bool marker)
{
  memset(c->load, 0, 3 * c->n * sizeof *c->load);
  memset(c->moment, 0, 3 * c->n * sizeof *c->moment);
  /* F on the particle and the moment out N x F on its row of the interface; of probes the sum over
   * their sides. */
  for (size_t q = 0; q < c->n_surface; q++) {
    const double *N = c->normal + 3 * q, *force = c->force + 3 * q;
    double *load = c->load + 3 * (size_t)c->particle[q],
           *moment = c->moment + 3 * (size_t)c->row[q];
    const double out = outside(c, q, marker);
    memcpy(load, force, 3 * sizeof *load);
    if (marker)
      bw_coupler__moment(out, N, force, moment);
    else
      memcpy(moment, c->probes.moment + 3 * q, 3 * sizeof *moment);
  }
  memcpy(c->flow, c->load, 3 * c->n * sizeof *c->flow);
  /* Moments become couples on the line elements that tell the spin: power stays what it is. */
  bw_pd_interface_twist(c->interface, c->moment, c->load);
}

/* F_h = t A_h / V_h: POROUS 3.96 with the sign of ERRATA 10, relaxed (bw_coupler.h):
 * F' <- (1 - w) F' + w F, whose first part the step before has left in c->F; what F' keeps back of
 * F is booked. */
void bw_coupler__relax_load(bw_coupler *c, double dt, double relaxation)
{
  for (size_t i = 0; i < 3 * c->n; i++)
    c->F[i] += relaxation * c->load[i] / bw_solid_volume_of(c->solid, i / 3);
  /* c->V: how the surface moves, as the fluid was told. */
  c->book.load = 0.0;
  for (size_t i = 0; i < 3 * c->n; i++)
    c->book.load += dt * c->load[i] * c->V[i];
  c->work.loaded += c->book.load;
  if (c->config.count_work) c->work.late += dt * power_held_back(c);
}
