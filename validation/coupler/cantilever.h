/* cantilever.h -- the plate alone, without fluid, under a uniform load: its stiffness.
 *
 * Plane strain, Euler-Bernoulli with Timoshenko's shear (solid mechanics textbooks):
 *   w_tip = q L^4/(8 E' I) + q L^2/(2 k G A),  E' = E/(1 - nu^2), I = b^3/12, k = 5/6, nu = 1/4. */
#pragma once
#include "../../cases/bending_plate/bending_flow.h"

typedef struct {
  double tip, theory; /* deflection over the height [-] */
} cantilever_result;

/* The plate of p, held at its foot, under a load that bends it by `deflection` heights in
 * Euler-Bernoulli's theory; damped until it rests. Collective. */
static inline bw_status cantilever_bend(const bw_comm *comm, const bending_plate *p,
                                        double deflection, cantilever_result *out)
{
  const double nu = 0.25, L = p->height, b = p->thickness;
  const double stiff = p->young_modulus / (1.0 - nu * nu) * b * b * b / 12.0;
  const double shear = 5.0 / 6.0 * p->young_modulus / (2.0 * (1.0 + nu)) * b;
  const double q = deflection * L * 8.0 * stiff / (L * L * L * L);
  const double omega = 3.516 * sqrt(stiff / (p->density * b * L * L * L * L)); /* first mode */
  bending_flow f = {.comm = comm, .h = b, .config = {.plate = *p}};
  f.config.plate.damping_absolute = 2.0 * omega * p->density; /* critical */
  double *F = NULL, tip[2];
  bw_status st = bending_make_solid(&f);
  BW_THEN(st, BW_ALLOCATE(&F, 3 * f.n));
  for (size_t i = 0; st == BW_OK && i < f.n; i++)
    F[3 * i] = f.X0[3 * i + 1] > 0.0 ? q / b : 0.0;
  if (st == BW_OK) bw_solid_set_force(f.solid, F);
  /* exp(-14)(1 + 14) = 1e-5 of the deflection is left */
  const double dt = st == BW_OK ? 0.9 * bw_solid_dt_max(f.solid) : 1.0;
  for (double t = 0.0; st == BW_OK && t < 14.0 / omega; t += dt)
    st = bw_solid_step(f.solid, dt);
  if (st == BW_OK) {
    bending_tip(&f, tip);
    out->tip = tip[0] / L;
    out->theory = (q * L * L * L * L / (8.0 * stiff) + q * L * L / (2.0 * shear)) / L;
  }
  bw_release(&F);
  bending_destroy(&f);
  return st;
}
