/* What is read: views of particles, and gauges of the whole. */
#include "ulph_internal.h"

size_t bw_ulph_count(const bw_ulph *u)
{
  return u->fluid.own;
}

size_t bw_ulph_wall_count(const bw_ulph *u)
{
  return u->wall.own;
}

int64_t bw_ulph_total(const bw_ulph *u)
{
  return u->total;
}

void bw_ulph_ids(const bw_ulph *u, int64_t id[])
{
  for (size_t i = 0; i < u->fluid.own; i++)
    id[i] = u->own[i].id;
}

void bw_ulph_read(const bw_ulph *u, bw_ulph_field field, double out[])
{
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    for (size_t k = 0; k < 3; k++) {
      if (field == BW_ULPH_POSITION) out[3 * i + k] = p->x[k];
      if (field == BW_ULPH_VELOCITY) out[3 * i + k] = p->v[k];
      if (field == BW_ULPH_FORCE) out[3 * i + k] = p->m * p->a[k];
    }
    if (field == BW_ULPH_DENSITY) out[i] = p->rho;
    if (field == BW_ULPH_PRESSURE) out[i] = p->p;
    if (field == BW_ULPH_SURFACE) out[i] = p->surface;
    if (field == BW_ULPH_MASS) out[i] = p->m;
  }
}

void bw_ulph_read_wall(const bw_ulph *u, bw_ulph_field field, double out[])
{
  for (size_t i = 0; i < u->wall.own; i++) {
    const bw_ulph__particle *p = u->own + u->wall.first + i;
    for (size_t k = 0; k < 3; k++) {
      if (field == BW_ULPH_POSITION) out[3 * i + k] = p->x[k];
      if (field == BW_ULPH_VELOCITY) out[3 * i + k] = u->moves[p->wall] ? u->wall_v[k] : 0;
      if (field == BW_ULPH_FORCE) out[3 * i + k] = 0;
    }
    if (field == BW_ULPH_DENSITY || field == BW_ULPH_SURFACE || field == BW_ULPH_MASS) out[i] = 0;
    if (field == BW_ULPH_PRESSURE) out[i] = p->p;
  }
}

/* Half-open, as boxes of shapes; z does not matter in 2D. */
static bool within(const bw_ulph *u, const double x[3], const double lower[3],
                   const double upper[3])
{
  bool inside = true;
  for (int k = 0; k < u->config.dimensions; k++)
    inside = inside && x[k] >= lower[k] && x[k] < upper[k];
  return inside;
}

double bw_ulph_depth(const bw_ulph *u, const double x[3], double width)
{
  /* Hats at a distance of their half-width add up to 1: those of a lattice, for a whole number. */
  const double wide = u->config.dx * ceil(width / u->config.dx * (1 - 1e-9));
  double depth = 0;
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    double hat = fmax(0, 1 - fabs(p->x[0] - x[0]) / wide) / wide;
    if (u->config.dimensions == 3) hat *= fmax(0, 1 - fabs(p->x[2] - x[2]) / wide) / wide;
    depth += hat * p->m / p->rho;
  }
  bw_comm_sum(u->comm, 1, &depth);
  return depth;
}

double bw_ulph_reach(const bw_ulph *u, int axis, const double lower[3], const double upper[3])
{
  double most = -INFINITY;
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    if (!p->lone && within(u, p->x, lower, upper))
      most = fmax(most, p->x[axis] + 0.5 * u->config.dx);
  }
  bw_comm_max(u->comm, 1, &most);
  return most;
}

double bw_ulph_wall_pressure(const bw_ulph *u, const double lower[3], const double upper[3])
{
  double sum[2] = {0, 0};
  for (size_t i = 0; i < u->wall.own; i++) {
    const bw_ulph__particle *p = u->own + u->wall.first + i;
    if (p->depth > u->config.dx || !within(u, p->x, lower, upper)) continue;
    sum[0] += p->p;
    sum[1] += 1;
  }
  bw_comm_sum(u->comm, 2, sum);
  return sum[1] > 0 ? sum[0] / sum[1] : NAN;
}

void bw_ulph_wall_force(const bw_ulph *u, double force[3])
{
  memcpy(force, u->wall_force, sizeof u->wall_force);
  bw_comm_sum(u->comm, 3, force);
}

int64_t bw_ulph_outside(const bw_ulph *u, const double lower[3], const double upper[3])
{
  int64_t n = 0;
  for (size_t i = 0; i < u->fluid.own; i++)
    n += !within(u, u->own[i].x, lower, upper);
  bw_comm_sum_int(u->comm, 1, &n);
  return n;
}
