#include "bw_memory.h"
#include "bw_solid_load.h"
#include "pd_law.h"

#include <math.h>

double bw_solid_ramp_value(const bw_solid_ramp *ramp, double time)
{
  /* A step has no duration to divide by: it has been dealt with when x is asked for. */
  if (time < ramp->start) return 0;
  if (time >= ramp->start + ramp->duration) return 1;
  const double x = (time - ramp->start) / ramp->duration;
  return ramp->kind == BW_SOLID_RAMP_SMOOTH ? x * x * (3 - 2 * x) : x;
}

static void prescribe(bw_pd_body *pd, double factor, const double field[])
{
  /* Only those that listen; the row of the own particle is read. */
  for (size_t q = 0; q < pd->held.n; q++)
    for (size_t k = 0; k < 3; k++)
      pd->held.velocity[3 * q + k] = factor * field[3 * (size_t)pd->held.particle[q] + k];
}

void bw_solid_load_displace(bw_solid *s, const bw_solid_ramp *ramp, double time, double dt,
                            const double U[])
{
  /* The step goes straight from one place to the next: no error adds up. */
  prescribe(bw_solid_body(s),
            (bw_solid_ramp_value(ramp, time + dt) - bw_solid_ramp_value(ramp, time)) / dt, U);
}

void bw_solid_load_move(bw_solid *s, const bw_solid_ramp *ramp, double time, double dt,
                        const double V[])
{
  prescribe(bw_solid_body(s), bw_solid_ramp_value(ramp, time + 0.5 * dt), V);
}

static bool in_box(const bw_pd_body *pd, size_t i, const double lower[3], const double upper[3])
{
  /* By reference places, so that the same particles are loaded all the time. */
  double X0[3];
  bool in = (pd->points.kind[i] & BW_PD_PRESCRIBED) == 0;
  bw_pd_body_reference(pd, i, X0);
  for (int k = 0; k < pd->dimension; k++)
    in = in && X0[k] >= lower[k] && X0[k] < upper[k];
  return in;
}

static int level_of(const bw_pd_body *pd, size_t i)
{
  return (int)(bw_pd_body_level(pd, i) - pd->level);
}

/* Faces of cells of a level that one of level 0 has room for. */
static int64_t faces(const bw_pd_body *pd, int level)
{
  return (int64_t)1 << (pd->dimension - 1) * level;
}

bw_status bw_solid_load_traction(const bw_solid *s, const double lower[3], const double upper[3],
                                 double area, const double traction[3], double F[])
{
  const bw_pd_body *pd = bw_solid_body(s);
  BW_REQUIRE(area > 0 && isfinite(area), BW_EINPUT,
             "solid_load_traction: area = %g must be positive", area);
  /* Counted over all ranks: each gets the same share of the whole force; finer ones by the face of
   * their cell, of which a cell of level 0 has `faces`. */
  int64_t chosen = 0;
  for (size_t i = 0; i < pd->n; i++)
    chosen += in_box(pd, i, lower, upper) ? faces(pd, pd->finest) / faces(pd, level_of(pd, i)) : 0;
  bw_comm_sum_int(pd->comm, 1, &chosen);
  BW_REQUIRE(chosen > 0, BW_EINPUT,
             "solid_load_traction: no free particle has its place in the box %g %g %g .. %g %g %g",
             lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]);
  for (size_t i = 0; i < pd->n; i++)
    for (int k = 0; k < pd->dimension && in_box(pd, i, lower, upper); k++) /* sum F dV = t A */
      F[3 * i + (size_t)k] += traction[k] * area *
                              ((double)faces(pd, pd->finest) / (double)faces(pd, level_of(pd, i))) /
                              ((double)chosen * bw_pd_body_level(pd, i)->dv);
  return BW_OK;
}

void bw_solid_load_gravity(const bw_solid *s, const double g[3], double F[])
{
  const bw_pd_body *pd = bw_solid_body(s);
  for (size_t i = 0; i < pd->n; i++)
    for (int k = 0; k < pd->dimension; k++)
      F[3 * i + (size_t)k] += bw_pd_body_material(pd, i)->rho * g[k];
}

bw_status bw_solid_load_velocity(bw_solid *s, bw_solid_load_field field, const void *data)
{
  const bw_pd_body *pd = bw_solid_body(s);
  /* The state is set as a whole: places are read and given back unchanged. */
  double *X = NULL, *V = NULL, X0[3];
  bw_status st = BW_ALLOCATE(&X, 3 * pd->n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * pd->n));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) {
    bw_solid_get_position(s, X);
    for (size_t i = 0; i < pd->n; i++) {
      bw_pd_body_reference(pd, i, X0);
      field(X0, V + 3 * i, data);
    }
    bw_solid_set_state(s, X, V);
  }
  bw_release(&X);
  bw_release(&V);
  return st;
}

bw_status bw_solid_load_launch(bw_solid *s, const double velocity[3], const double spin[3],
                               const double centre[3])
{
  const bw_pd_body *pd = bw_solid_body(s);
  /* About present places: a body that has moved is launched from where it is. */
  double *X = NULL, *V = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * pd->n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * pd->n));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) {
    bw_solid_get_position(s, X);
    for (size_t i = 0; i < pd->n; i++)
      for (size_t k = 0; k < 3; k++) {
        /* spin x (X - centre). */
        const size_t a = (k + 1) % 3, b = (k + 2) % 3;
        V[3 * i + k] = velocity[k] + spin[a] * (X[3 * i + b] - centre[b]) -
                       spin[b] * (X[3 * i + a] - centre[a]);
      }
    bw_solid_set_state(s, X, V);
  }
  bw_release(&X);
  bw_release(&V);
  return st;
}
