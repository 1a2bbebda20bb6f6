/* What others see and set. */
#include "pd_bond_internal.h"

void bw_pd_bond_enable_breakage(bw_pd_bond *pd, bool on)
{
  pd->breakage = on;
}

void bw_pd_bond_set_damping(bw_pd_bond *pd, double pair, double mean, double absolute)
{
  if (pd->damping_pair == pair && pd->damping_mean == mean && pd->damping_absolute == absolute)
    return; /* forces, and those of a restart, stay valid */
  pd->damping_pair = pair;
  pd->damping_mean = mean;
  pd->damping_absolute = absolute;
  pd->current = false;
}

void bw_pd_bond_set_G0(bw_pd_bond *pd, double G0)
{
  pd->config.G0 = G0;
  bw_pd_bond__material(pd);
  bw_pd_bond__calibrate(pd);
  bw_pd_bond__constants(pd);
}

void bw_pd_bond_set_force(bw_pd_bond *pd, const double F[])
{
  for (int k = 0; k < pd->dimension; k++)
    for (size_t i = 0; i < pd->n; i++)
      pd->f[k][i] = (bw_real)(F[3 * i + (size_t)k] / pd->config.rho);
}

void bw_pd_bond_set_prescribed(bw_pd_bond *pd, const double V[])
{
  for (size_t q = 0; q < pd->n_prescribed; q++)
    for (int k = 0; k < pd->dimension; k++)
      pd->prescribed_v[3 * q + (size_t)k] = V[3 * (size_t)pd->prescribed[q] + (size_t)k];
}

size_t bw_pd_bond_list_bytes(const bw_pd_bond *pd)
{
  const size_t factors = pd->alpha != NULL ? BW_PD_LANES * sizeof *pd->alpha : 0;
  return pd->n_slot * (sizeof *pd->slot + factors) + (pd->n_block + 1) * sizeof *pd->block;
}

size_t bw_pd_bond_count(const bw_pd_bond *pd)
{
  return pd->n;
}

int64_t bw_pd_bond_total(const bw_pd_bond *pd)
{
  return pd->total;
}

const int64_t *bw_pd_bond_id(const bw_pd_bond *pd)
{
  return pd->id;
}

const uint8_t *bw_pd_bond_kind(const bw_pd_bond *pd)
{
  return pd->kind;
}

const bw_pd_bond_config *bw_pd_bond_settings(const bw_pd_bond *pd)
{
  return &pd->config;
}

const bw_comm *bw_pd_bond_comm(const bw_pd_bond *pd)
{
  return pd->comm;
}

double bw_pd_bond_horizon(const bw_pd_bond *pd)
{
  return pd->horizon;
}

double bw_pd_bond_micromodulus(const bw_pd_bond *pd)
{
  return pd->c0;
}

double bw_pd_bond_critical_stretch(const bw_pd_bond *pd)
{
  return pd->s0;
}

double bw_pd_bond_volume(const bw_pd_bond *pd)
{
  return pd->dv;
}

void bw_pd_bond_get_reference(const bw_pd_bond *pd, double X0[])
{
  for (size_t i = 0; i < pd->n; i++)
    bw_pd_bond__reference(pd, i, X0 + 3 * i);
}

void bw_pd_bond_get_position(const bw_pd_bond *pd, double X[])
{
  bw_pd_bond_get_reference(pd, X);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      X[3 * i + k] += (double)pd->u[k][pd->place[i]];
}

void bw_pd_bond_get_velocity(const bw_pd_bond *pd, double V[])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      V[3 * i + k] = (double)pd->v[k][i];
}

void bw_pd_bond_get_acceleration(const bw_pd_bond *pd, double A[])
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      A[3 * i + k] = (double)(pd->mobile[i] * (pd->a[k][i] + pd->extra[k][i] + pd->f[k][i]));
}

/* Velocities of the prescribed particles follow a state given from outside. */
void bw_pd_bond__adopt_prescribed(bw_pd_bond *pd)
{
  for (size_t q = 0; q < pd->n_prescribed; q++)
    for (size_t k = 0; k < 3; k++)
      pd->prescribed_v[3 * q + k] = (double)pd->v[k][pd->prescribed[q]];
}

void bw_pd_bond_set_state(bw_pd_bond *pd, const double X[], const double V[])
{
  double X0[3];
  for (size_t i = 0; i < pd->n; i++) {
    bw_pd_bond__reference(pd, i, X0);
    for (int k = 0; k < pd->dimension; k++) {
      pd->u[k][pd->place[i]] = (bw_real)(X[3 * i + (size_t)k] - X0[k]);
      pd->v[k][i] = (bw_real)V[3 * i + (size_t)k];
    }
  }
  bw_pd_bond__adopt_prescribed(pd);
  bw_pd_bond__refresh(pd, false);
  pd->current = false;
}

int64_t bw_pd_bond_events(const bw_pd_bond *pd)
{
  return pd->events;
}
