/* Motion and loads as others see and set them. */
#include "pd_body.h"

void bw_pd_body_set_damping(bw_pd_body *pd, double pair, double mean, double absolute)
{
  if (pd->damping.pair == pair && pd->damping.mean == mean && pd->damping.absolute == absolute)
    return; /* forces, and those of a restart, stay valid */
  /* Damping is part of the acceleration: it is evaluated anew. */
  pd->damping.pair = pair;
  pd->damping.mean = mean;
  pd->damping.absolute = absolute;
  pd->current = false;
}

void bw_pd_body_set_force(bw_pd_body *pd, const double F[])
{
  /* Kernels add accelerations: the density is divided out once here. */
  for (int k = 0; k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++)
      pd->load.f[k][i] = (bw_real)(F[3 * i + (size_t)k] / bw_pd_body_material(pd, i)->rho);
}

void bw_pd_body_set_prescribed(bw_pd_body *pd, const double V[])
{
  for (size_t q = 0; q < pd->held.n; q++)
    for (int k = 0; k < pd->dimension; k++)
      pd->held.velocity[3 * q + (size_t)k] = V[3 * (size_t)pd->held.particle[q] + (size_t)k];
}

size_t bw_pd_body_list_bytes(const bw_pd_body *pd)
{
  const size_t factors = pd->bonds.factor != NULL ? BW_PD_LANES * sizeof *pd->bonds.factor : 0;
  return pd->bonds.n_slot * (sizeof *pd->bonds.slot + factors) +
         (pd->bonds.n_block + 1) * sizeof *pd->bonds.block;
}

void bw_pd_body_get_reference(const bw_pd_body *pd, double X0[])
{
  for (size_t i = 0; i < pd->n; i++)
    bw_pd_body_reference(pd, i, X0 + 3 * i);
}

void bw_pd_body_get_position(const bw_pd_body *pd, double X[])
{
  bw_pd_body_get_reference(pd, X);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      X[3 * i + k] += (double)pd->u[k][pd->points.place[i]];
}

void bw_pd_body_get_velocity(const bw_pd_body *pd, double V[])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      V[3 * i + k] = (double)pd->v[k][i];
}

void bw_pd_body_get_acceleration(const bw_pd_body *pd, double A[])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      A[3 * i + k] =
          (double)(pd->held.mobile[i] * (pd->a[k][i] + pd->load.extra[k][i] + pd->load.f[k][i]));
}

/* Velocities of the prescribed particles follow a state given from outside. */
void bw_pd_body_adopt_prescribed(bw_pd_body *pd)
{
  for (size_t q = 0; q < pd->held.n; q++)
    for (size_t k = 0; k < 3; k++)
      pd->held.velocity[3 * q + k] = (double)pd->v[k][pd->held.particle[q]];
}

void bw_pd_body_set_state(bw_pd_body *pd, const double X[], const double V[])
{
  double X0[3];
  for (size_t i = 0; i < pd->n; i++) {
    bw_pd_body_reference(pd, i, X0);
    for (int k = 0; k < pd->dimension; k++) {
      pd->u[k][pd->points.place[i]] = (bw_real)(X[3 * i + (size_t)k] - X0[k]);
      pd->v[k][i] = (bw_real)V[3 * i + (size_t)k];
    }
  }
  /* Prescribed particles go on as they move now, until told otherwise. */
  bw_pd_body_adopt_prescribed(pd);
  /* Copies follow at once; forces wait until somebody needs them. */
  bw_pd_body_refresh(pd, false);
  pd->current = false;
}

void bw_pd_body_touch(bw_pd_body *pd)
{
  pd->revision++;
  pd->current = false;
}
