/* A drag on some particles towards given velocities, of whoever loads the solid. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

bw_status bw_solid_set_drag(bw_solid *s, size_t n, const int32_t particle[], const double k[],
                            const double V[])
{
  bw_solid__drag *d = &s->drag;
  /* Room for all particles the first time; later calls allocate nothing. */
  if (n > 0 && d->particle == NULL) {
    const size_t room = s->body->n;
    BW_TRY(BW_ALLOCATE(&d->particle, room));
    BW_TRY(BW_ALLOCATE(&d->k, room));
    BW_TRY(BW_ALLOCATE(&d->rate, room));
    BW_TRY(BW_ALLOCATE(&d->towards, 3 * room));
    BW_TRY(BW_ALLOCATE(&d->before, 3 * room));
    BW_TRY(BW_ALLOCATE(&d->other, 3 * room));
    BW_TRY(BW_ALLOCATE(&d->impulse, 3 * room));
  }
  d->n = 0;
  d->work = 0;
  d->dt = 0; /* the rates are still to be found */
  /* Held and retired particles feel no force. */
  for (size_t q = 0; q < n; q++) {
    if (s->body->held.mobile[particle[q]] == 0) continue;
    d->particle[d->n] = particle[q];
    d->k[d->n] = k[q];
    for (size_t c = 0; c < 3; c++) {
      d->towards[3 * d->n + c] = V[3 * q + c];
      d->impulse[3 * d->n + c] = 0;
    }
    d->n++;
  }
  return BW_OK;
}

double bw_solid_get_drag(const bw_solid *s, double impulse[])
{
  const bw_solid__drag *d = &s->drag;
  memset(impulse, 0, 3 * s->body->n * sizeof *impulse);
  for (size_t q = 0; q < d->n; q++)
    memcpy(impulse + 3 * (size_t)d->particle[q], d->impulse + 3 * q, 3 * sizeof *impulse);
  return d->work;
}

void bw_solid__drag_release(bw_solid__drag *d)
{
  bw_release(&d->particle);
  bw_release(&d->k);
  bw_release(&d->rate);
  bw_release(&d->towards);
  bw_release(&d->before);
  bw_release(&d->other);
  bw_release(&d->impulse);
}

/* The part of v - V that k alone would take within dt, spread over it: however large k dt is, no
 * more than all of it. Successive steps have the same dt, so the exponentials are rarely needed. */
static void find_rates(const bw_pd_body *pd, bw_solid__drag *d, double dt)
{
  for (size_t q = 0; q < d->n; q++) {
    const double rho = bw_pd_body_material(pd, (size_t)d->particle[q])->rho;
    d->rate[q] = -expm1(-d->k[q] * dt / rho) / dt;
  }
  d->dt = dt;
}

/* f += -rate (v - V). */
void bw_solid__drag_on(bw_solid *s, double dt)
{
  bw_solid__drag *d = &s->drag;
  bw_pd_body *pd = s->body;
  if (dt != d->dt) find_rates(pd, d, dt);
  for (size_t q = 0; q < d->n; q++) {
    const size_t i = (size_t)d->particle[q];
    for (int c = 0; c < pd->dimension; c++) {
      const size_t at = 3 * q + (size_t)c;
      d->before[at] = (double)pd->v[c][i];
      d->other[at] = (double)pd->load.f[c][i];
      pd->load.f[c][i] += (bw_real)(-d->rate[q] * (d->before[at] - d->towards[at]));
    }
  }
}

/* f is that of set_force again; what the drag did within dt is booked. */
void bw_solid__drag_off(bw_solid *s, double dt)
{
  bw_solid__drag *d = &s->drag;
  bw_pd_body *pd = s->body;
  for (size_t q = 0; q < d->n; q++) {
    const size_t i = (size_t)d->particle[q];
    const double rho = bw_pd_body_material(pd, i)->rho, mass = rho * bw_pd_body_level(pd, i)->dv;
    for (int c = 0; c < pd->dimension; c++) {
      const size_t at = 3 * q + (size_t)c;
      const double f = (double)pd->load.f[c][i] - d->other[at];
      pd->load.f[c][i] = (bw_real)d->other[at];
      d->impulse[at] += dt * rho * f;
      d->work += dt * mass * f * 0.5 * (d->before[at] + (double)pd->v[c][i]);
    }
  }
}
