/* What the fluid does to the surface, read beside it.
 *
 * Where the surface is smooth a probe stands on each particle along its normal. On ridges and edges
 * the pressure on one side is not that on the other: there a probe stands on every open side for
 * the pressure (the part of the traction along the side's normal), and one along the particle's
 * normal for the friction (the part across it), which the sides of a step do not know: they are no
 * walls that the fluid flows along. Sheets have whole probes on both sides. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"

#include <string.h>

enum { WHOLE, PRESSURE, FRICTION }; /* part of the traction that bears */

/* Arrays and how many numbers of each a probe has. */
enum { N_ARRAYS = 8 };
static void list_arrays(bw_coupler__probes *p, double **array[N_ARRAYS], size_t width[N_ARRAYS])
{
  double **const all[N_ARRAYS] = {&p->X,     &p->N,        &p->V, &p->spin,
                                  &p->accel, &p->traction, &p->A, &p->H};
  static const size_t wide[N_ARRAYS] = {3, 3, 3, 3, 3, 3, 1, 1};
  memcpy(array, all, sizeof all);
  memcpy(width, wide, sizeof wide);
}

bw_status bw_coupler__probes_create(bw_coupler *c)
{
  bw_coupler__probes *p = &c->probes;
  double **array[N_ARRAYS];
  size_t width[N_ARRAYS];
  list_arrays(p, array, width);
  p->n = 0;
  /* A probe for each side, and one for the friction. */
  p->room = bw_pd_interface_most_sides(c->interface) + c->n;
  for (int q = 0; q < N_ARRAYS; q++)
    BW_TRY(BW_ALLOCATE(array[q], width[q] * p->room));
  BW_TRY(BW_ALLOCATE(&p->point, p->room));
  BW_TRY(BW_ALLOCATE(&p->flag, p->room));
  BW_TRY(BW_ALLOCATE(&p->part, p->room));
  return BW_ALLOCATE(&p->moment, 3 * c->n);
}

void bw_coupler__probes_release(bw_coupler *c)
{
  bw_coupler__probes *p = &c->probes;
  double **array[N_ARRAYS];
  size_t width[N_ARRAYS];
  list_arrays(p, array, width);
  for (int q = 0; q < N_ARRAYS; q++)
    bw_release(array[q]);
  bw_release(&p->point);
  bw_release(&p->flag);
  bw_release(&p->part);
  bw_release(&p->moment);
  p->n = p->room = 0;
}

/* One more probe, H from the centre of the point's particle along N. */
static void add(bw_coupler *c, size_t point, const double N[3], double A, double H, int part)
{
  bw_coupler__probes *p = &c->probes;
  for (size_t d = 0; d < 3; d++) {
    const double centre = c->root[3 * point + d] - c->height[point] * c->normal[3 * point + d];
    p->X[3 * p->n + d] = centre + H * N[d];
  }
  memcpy(p->N + 3 * p->n, N, 3 * sizeof *N);
  p->A[p->n] = A, p->H[p->n] = H;
  p->part[p->n] = (unsigned char)part;
  p->point[p->n++] = (int32_t)point;
}

/* The sides of the surface points: both lists go by rising rows of the interface. Collective. */
static void find_sides(bw_coupler *c)
{
  const bw_pd_sides s = bw_pd_interface_sides(c->interface);
  size_t point = 0;
  c->probes.n = 0;
  for (size_t q = 0; q < s.n; q++) {
    while (point < c->n_surface && c->row[point] < s.row[q])
      point++;
    if (point == c->n_surface) break;
    if (c->row[point] != s.row[q]) continue; /* beyond a side of the box */
    const bool first = q == 0 || s.row[q] != s.row[q - 1];
    if (s.step[q] && first)
      add(c, point, c->normal + 3 * point, c->area[point], c->height[point], FRICTION);
    add(c, point, s.N + 3 * q, s.A[q], s.H[q], s.step[q] ? PRESSURE : WHOLE);
  }
}

/* Velocity and spin of the surface at the probes' roots; its acceleration over the last step, which
 * is smoother than that of the last sub-step, with the lattice's acoustics, less what drives the
 * fluid: with that alone fluid would fall along without pressure. Collective. */
static void find_motion(bw_coupler *c, double dt)
{
  bw_coupler__probes *p = &c->probes;
  double drive[3] = {0.0, 0.0, 0.0};
  drive[bw_ns_channel_settings(c->fluid)->forcing_axis] = bw_ns_channel_driving(c->fluid);
  bw_coupler__know_motion(c);
  for (size_t q = 0; q < p->n; q++) {
    const size_t point = (size_t)p->point[q], h = (size_t)c->particle[point];
    const double *spin = c->turn + 3 * (size_t)c->row[point];
    memcpy(p->spin + 3 * q, spin, 3 * sizeof *spin);
    /* V + H spin x N */
    bw_coupler__moment(p->H[q], spin, p->N + 3 * q, p->V + 3 * q);
    for (size_t d = 0; d < 3; d++) {
      p->V[3 * q + d] += c->V[3 * h + d];
      /* dU/dt of ERRATA 19, less the force per mass that p does not hold (ERRATA 31). */
      const double a = c->held ? 0.0 : (c->V[3 * h + d] - c->V_before[3 * h + d]) / dt;
      p->accel[3 * q + d] = a - drive[d];
    }
  }
}

/* The part of a probe's traction that bears, times its area. */
static void force_of(const bw_coupler__probes *p, size_t q, double force[3])
{
  const double *t = p->traction + 3 * q, *N = p->N + 3 * q;
  const double along = t[0] * N[0] + t[1] * N[1] + t[2] * N[2];
  for (int d = 0; d < 3; d++) {
    const double normal = along * N[d];
    const double share[] = {[WHOLE] = t[d], [PRESSURE] = normal, [FRICTION] = t[d] - normal};
    force[d] = share[p->part[q]] * p->A[q];
  }
}

/* t A per surface particle, and the moments about its centre. */
static void gather(bw_coupler *c)
{
  const bw_coupler__probes *p = &c->probes;
  memset(c->force, 0, 3 * c->n_surface * sizeof *c->force);
  memset(p->moment, 0, 3 * c->n_surface * sizeof *p->moment);
  memset(c->force_probe, 0, sizeof c->force_probe);
  for (size_t q = 0; q < p->n; q++) {
    const size_t point = (size_t)p->point[q];
    double force[3], moment[3];
    force_of(p, q, force);
    bw_coupler__moment(p->H[q], p->N + 3 * q, force, moment);
    for (size_t d = 0; d < 3; d++) {
      c->force[3 * point + d] += force[d];
      p->moment[3 * point + d] += moment[d];
      c->force_probe[d] += force[d]; /* the second of the three routes */
    }
  }
}

const bw_real *bw_coupler__read_pressure(const bw_coupler *c)
{
  return c->p_mean_known ? c->p_mean : bw_ns_channel_pressure(c->fluid);
}

bw_status bw_coupler__probe_force(bw_coupler *c, double dt)
{
  bw_coupler__probes *p = &c->probes;
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  /* Obstacles before points: setting points decides which probes are shortened. */
  BW_TRY(bw_coupler__find_obstacles(c));
  find_sides(c);
  BW_TRY(bw_probe_set_points(c->probe, p->n, p->X, p->N));
  find_motion(c, dt);
  bw_probe_set_velocity(c->probe, p->V, p->spin);
  /* t on each root (POROUS 3.83 to 3.94), from the pressure that acted over the step. */
  bw_probe_traction(c->probe, u, bw_coupler__read_pressure(c), p->accel, p->traction, p->flag);
  bw_timer_work(c->timer, BW_PART_PROBES, (double)p->n);
  gather(c);
  return BW_OK;
}
