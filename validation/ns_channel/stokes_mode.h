/* stokes_mode.h -- Stokes flow between walls at y = 0 and 1: its slowest mode with a wave number
 * k = 2 pi in x, with y from the centre and h = 1/2:
 *   u = psi_y, v = -psi_x, psi = [cos q y/cos q h - cosh k y/cosh k h] cos k x e^(-s t),
 *   q tan q h = -k tanh k h, s = nu (q^2 + k^2):
 * psi_yy - k^2 psi obeys the heat equation, psi and psi_y vanish at the walls. */
#pragma once
#include "flow.h"

static const double stokes_pi = 3.141592653589793;

typedef struct {
  double k, q, rate, amplitude;
} stokes_mode;

/* Of an amplitude where convection is below 1e-6 of the rest. */
static inline stokes_mode stokes_slowest(double nu)
{
  stokes_mode m = {.k = 2.0 * stokes_pi, .amplitude = 1e-6};
  double low = stokes_pi * (1.0 + 1e-12), high = 2.0 * stokes_pi; /* q h in (pi/2, pi) */
  for (int i = 0; i < 100; i++) {
    m.q = 0.5 * (low + high);
    *(m.q * tan(0.5 * m.q) < -m.k * tanh(0.5 * m.k) ? &low : &high) = m.q;
  }
  m.rate = nu * (m.q * m.q + m.k * m.k);
  return m;
}

static inline void stokes_velocity(const double x[3], double t, void *context, double u[3])
{
  const stokes_mode *m = context;
  const double y = x[1] - 0.5, f = m->amplitude * exp(-m->rate * t);
  const double c = cos(0.5 * m->q), ch = cosh(0.5 * m->k);
  u[0] = f * cos(m->k * x[0]) * (-m->q * sin(m->q * y) / c - m->k * sinh(m->k * y) / ch);
  u[1] = f * m->k * sin(m->k * x[0]) * (cos(m->q * y) / c - cosh(m->k * y) / ch);
  u[2] = 0.0;
}

/* Largest u at t = 0. */
static inline double stokes_largest(stokes_mode *m)
{
  double most = 0.0, u[3];
  for (int j = 0; j <= 1000; j++) {
    stokes_velocity((double[3]){0.0, j / 1000.0, 0.0}, 0.0, m, u);
    most = fmax(most, fabs(u[0]));
  }
  return most;
}
