/* ns_outflow.c -- the velocity normal to outflow sides: carried out by the bulk velocity U_c =
 * influx / outflow area, then shifted uniformly so that what enters leaves. What happens where it
 * points inwards is in ns_boundary.c. */
#include "ns_channel_internal.h"

#include <math.h>

/* value <- (1 - weight) value + weight u_n of layer `index`. */
static void plane_from_field(bw_ns_channel *ns, int d, int s, int index, bw_real weight)
{
  const bw_ns_walk w = bw_ns__walk(ns, d, s, index);
  bw_real *value = ns->plane[d][s].value[d];
  for (int b = 0; b < w.p->extent[1]; b++)
    for (int a = 0; a < w.p->extent[0]; a++) {
      /* An upwind step is a blend of what the side has with the layer inside. */
      bw_real *v = &value[b * w.p->extent[0] + a];
      *v = (1 - weight) * *v + weight * ns->u[d][w.base + a * w.step0 + b * w.step1];
    }
}

static bool outflow_here(const bw_ns_channel *ns, int d, int s)
{
  return ns->config.side[d][s].kind == BW_SIDE_OUTFLOW && ns->plane[d][s].here;
}

void bw_ns__outflow_capture(bw_ns_channel *ns)
{
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++)
      if (outflow_here(ns, d, s)) plane_from_field(ns, d, s, bw_ns__face_index(ns, d, s), 1);
}

void bw_ns__outflow_balance(bw_ns_channel *ns, double influx)
{
  if (ns->outflow_area <= 0.0) return;
  double out = 0.0;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++)
      if (outflow_here(ns, d, s)) out += bw_ns__side_flux(ns, d, s);
  /* All outflows together must take what enters, wherever they are. */
  bw_comm_sum(ns->comm, 1, &out);
  const bw_real shift = (bw_real)((influx - out) / ns->outflow_area); /* outwards */
  /* Every outflow is shifted by the same velocity, outwards. */
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_plane *p = &ns->plane[d][s];
      for (size_t q = 0; outflow_here(ns, d, s) && q < bw_ns__plane_size(p); q++)
        p->value[d][q] += s == 0 ? -shift : shift;
    }
}

/* Where fluid comes back (u_n inwards) the wind blows from outside, where it is taken to be at
 * rest: du_n/dt + u_n (u_n - 0)/dn = 0, implicit. Without it jets that enter at the bulk velocity's
 * slow pace feed the flow inside: the energy of a vortex of swirl 10 U_c grows a thousandfold. */
static void slow_reentry(bw_ns_channel *ns, int d, int s, bw_real dt_over_dn)
{
  const bw_ns_plane *p = &ns->plane[d][s];
  const bw_real inwards = s == 0 ? dt_over_dn : -dt_over_dn;
  for (size_t q = 0; q < bw_ns__plane_size(p); q++) {
    /* c > 0: fluid comes back. Backward Euler cannot overshoot rest. */
    const bw_real c = inwards * p->value[d][q];
    p->value[d][q] /= 1 + (c > 0 ? c : 0);
  }
}

/* Upwind, Euler over the sub-step: u_n <- u_n - c (u_n - u_inside), c = U_c dt/dn clipped to 1. */
void bw_ns__outflow_advance(bw_ns_channel *ns, double dt, double influx)
{
  if (ns->outflow_area <= 0.0) return;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      if (!outflow_here(ns, d, s)) continue;
      const int face = bw_ns__face_index(ns, d, s);
      const double dn = d == 1 ? ns->metrics.dyf[s == 0 ? 1 : face] : ns->g->spacing[d];
      /* Beyond c = 1 upwinding would be unstable; then the side takes the value inside. */
      const double c = fmax(0.0, fmin(1.0, influx / ns->outflow_area * dt / dn));
      /* The face as the last projection left it, then convected. */
      plane_from_field(ns, d, s, face, 1);
      plane_from_field(ns, d, s, s == 0 ? 1 : face - 1, (bw_real)c);
      slow_reentry(ns, d, s, (bw_real)(dt / dn));
    }
  /* Carried velocities do not balance the inflow: without this div u = 0 has no solution. */
  bw_ns__outflow_balance(ns, influx);
}
