/* ns_limit.c -- which steps are allowed: convection as it is and as walls, inflows and forcing
 * will make it, explicit viscosity, and what the factored implicit scheme still damps. */
#include "ns_channel_internal.h"

#include <math.h>

/* Real and imaginary axis limits of every three-stage third-order Runge-Kutta method:
 * |1 + z + z^2/2 + z^3/6| <= 1. The ellipse through both lies inside the stability region. */
static const double imaginary_limit = 1.7320508;

/* An implicit term takes a little of the real axis from what is explicit beside it: with its rate
 * anything from 0 on, the largest multiplier of all modes on and within the ellipse is 1 up to 2.47
 * (ERRATA 37). */
static double real_limit(const bw_ns_channel *ns)
{
  return ns->config.viscous == BW_VISCOUS_EXPLICIT ? 2.5127453 : 2.47;
}

/* ---- viscosity ---- */

/* Largest eigenvalues of nu D_xx, nu D_yy, nu D_zz, by Gershgorin: 4 nu/dx^2 where uniform, in y
 * the largest row sum of u's and v's second difference. Collective. */
static void diffusion_rates(const bw_ns_channel *ns, double rate[3])
{
  const bw_grid_view *g = ns->g;
  double y = 0.0;
  /* Row sums of |D_yy|, first of u and w (in cells), then of v (on faces). */
  for (int j = 1; j <= g->m[1]; j++) {
    const double *f = ns->metrics.dyf, *c = ns->metrics.dyc;
    y = fmax(y, 2.0 * (1.0 / c[j] + 1.0 / c[j - 1]) / f[j]);
    y = fmax(y, 2.0 * (1.0 / f[j] + 1.0 / f[j + 1]) / c[j]);
  }
  /* All ranks have to choose the same step: the thinnest cells of all of them count. */
  bw_comm_max(ns->comm, 1, &y);
  rate[0] = ns->config.nu * 4.0 / (g->spacing[0] * g->spacing[0]);
  rate[1] = ns->config.nu * y;
  rate[2] = ns->components == 3 ? ns->config.nu * 4.0 / (g->spacing[2] * g->spacing[2]) : 0.0;
}

/* What a step of the factored scheme leaves of the wave whose rates of diffusion are z[d]/dt. */
static double left_of_wave(const double z[3])
{
  double all = 1.0;
  for (int r = 0; r < BW_NS_STAGES; r++) {
    double sum = 0.0, product = 1.0;
    for (int d = 0; d < 3; d++)
      sum += z[d], product *= 1.0 + bw_ns__new[r] * z[d];
    all *= 1.0 - bw_ns__gamma[r] * sum / product;
  }
  return fabs(all);
}

/* Do all waves that are the shortest in two or three directions, and smooth in the others, decay
 * in dt as fast as the wave that fills the box? Of what a sub-step leaves one can show that it is
 * largest at such corners. */
static bool short_waves_decay(const bw_ns_channel *ns, const double rate[3], double dt)
{
  const double pi = acos(-1.0), *L = ns->g->length;
  double slowest = 0.0, worst = 0.0;
  for (int d = 0; d < ns->components; d++)
    slowest += ns->config.nu * pi * pi / (L[d] * L[d]);
  for (int corner = 1; corner < 1 << ns->components; corner++) {
    double z[3];
    /* One direction alone is damped in any step. */
    if ((corner & (corner - 1)) == 0) continue;
    for (int d = 0; d < 3; d++)
      z[d] = corner & 1 << d ? rate[d] * dt : 0.0;
    worst = fmax(worst, left_of_wave(z));
  }
  return log(worst) <= -slowest * dt;
}

/* The longest step in which they do: about the box's length times the spacing over nu, beyond the
 * convective limit unless the box's Reynolds number is of order 1 or less. In longer ones noise of
 * the cells would outlive the flow itself. */
static double damping_step(const bw_ns_channel *ns, const double rate[3])
{
  double below = 1.0 / (rate[0] + rate[1] + rate[2]), above = 2.0 * below;
  while (short_waves_decay(ns, rate, above))
    below = above, above *= 2.0;
  for (int q = 0; q < 30; q++) {
    const double middle = 0.5 * (below + above);
    *(short_waves_decay(ns, rate, middle) ? &below : &above) = middle;
  }
  return below;
}

void bw_ns__limits_create(bw_ns_channel *ns)
{
  const bw_ns_viscous viscous = ns->config.viscous;
  double rate[3];
  diffusion_rates(ns, rate);
  ns->damping_step = viscous == BW_VISCOUS_IMPLICIT ? damping_step(ns, rate) : INFINITY;
  /* Only what is explicit limits the step by stability. */
  ns->viscous_rate = viscous == BW_VISCOUS_IMPLICIT     ? 0.0
                     : viscous == BW_VISCOUS_IMPLICIT_Y ? rate[0] + rate[2]
                                                        : rate[0] + rate[1] + rate[2];
}

/* ---- convection ---- */

/* 1/spacing of component c at row `row` (of y) beside side (d, s). The component along y beside a
 * side normal to x or z is slowed by the sides in y: near their corner it is below (2/pi)
 * atan(2 y/dn) of the side's, so that thin cells there are not passed at full speed. */
static double crossings(const bw_ns_channel *ns, int d, int c, int row)
{
  const bw_grid_view *g = ns->g;
  if (c != 1) return 1.0 / g->spacing[c];
  const double one = (double)ns->metrics.rdyf[row];
  if (d == 1 || g->periodic[1]) return one;
  const int at = row + g->lo[1];
  const double y = fmin(g->y_face[at], g->length[1] - g->y_face[at - 1]);
  return one * fmin(1.0, 4.0 / acos(-1.0) * y / g->spacing[d]);
}

/* Largest sum |u_c|/dx_c of what side (d, s) prescribes, over its cells on this rank. */
static double side_rate(const bw_ns_channel *ns, int d, int s)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_plane *p = &ns->plane[d][s];
  const int t0 = bw_ns__tangent(d, 0), t1 = bw_ns__tangent(d, 1);
  double most = 0.0;
  for (int b = 1; b <= g->m[t1]; b++)
    for (int a = 1; a <= g->m[t0]; a++) {
      const ptrdiff_t at = (ptrdiff_t)(b - p->low[1]) * p->extent[0] + (a - p->low[0]);
      const int row = t0 == 1 ? a : t1 == 1 ? b : s == 0 ? 1 : g->m[1];
      double sum = 0.0;
      for (int c = 0; c < ns->components; c++) {
        const double u =
            p->value[c] != NULL ? (double)p->value[c][at] : ns->config.side[d][s].velocity[c];
        sum += fabs(u) * crossings(ns, d, c, row);
      }
      most = fmax(most, sum);
    }
  return most;
}

/* The rate of convection that walls and inflows will bring about where the fluid is at rest yet;
 * this rank's share. */
static double prescribed_rate(const bw_ns_channel *ns)
{
  double most = 0.0;
  for (int d = 0; d < ns->components; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side_kind kind = ns->config.side[d][s].kind;
      if (ns->plane[d][s].here && (kind == BW_SIDE_WALL || kind == BW_SIDE_INFLOW))
        most = fmax(most, side_rate(ns, d, s));
    }
  return most;
}

/* All ranks: the largest rate of convection, NaN when a value anywhere is not finite. */
static double courant_everywhere(bw_ns_channel *ns)
{
  if (ns->courant_known) return ns->courant_all;
  /* A maximum drops NaN, so whether all is finite travels as a number of its own. */
  const bool finite = isfinite(ns->courant);
  double worst[3] = {finite ? fmax(ns->courant, prescribed_rate(ns)) : 0.0, finite ? 0.0 : 1.0,
                     ns->eddy.rate};
  bw_comm_max(ns->comm, 3, worst);
  ns->courant_all = worst[1] > 0.0 ? (double)NAN : worst[0];
  ns->eddy_all = worst[2];
  ns->courant_known = true;
  return ns->courant_all;
}

/* 1/dt^2 by convection. A given flow rate is reached within the step. A given gradient g may add
 * g dt to the velocity: dt (g dt)/dx stays below the imaginary limit, too. */
static double convective(bw_ns_channel *ns)
{
  const double value = fabs(ns->config.forcing_value) / ns->g->spacing[ns->config.forcing_axis];
  double c = courant_everywhere(ns), push = 0.0;
  if (ns->config.forcing == BW_FORCING_FLOW_RATE && value > c) c = value;
  if (ns->config.forcing == BW_FORCING_GRADIENT) push = value / imaginary_limit;
  return c * c / (imaginary_limit * imaginary_limit) + push;
}

/* 1/dt by what is explicit of the viscous term and of an eddy viscosity, whose rate has become
 * known with the Courant number. */
static double diffusive(const bw_ns_channel *ns)
{
  return (ns->viscous_rate + ns->eddy_all) / real_limit(ns);
}

double bw_ns_channel_dt_max(bw_ns_channel *ns)
{
  const double c = convective(ns), v = diffusive(ns);
  return fmin(1.0 / sqrt(c + v * v), ns->damping_step);
}

/* ---- the check around a step ---- */

/* First point (component, then k, j, i) that is not finite. */
static bw_status not_finite(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  const double n0 = g->n[0] + 1, n1 = g->n[1] + 1, n2 = g->n[2] + 1;
  /* Component and cell as one number, so that a minimum over ranks names the first place. */
  double first = INFINITY;
  for (int c = 0; c < ns->components; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++)
          if (!isfinite(ns->u[c][bw_at(g, i, j, k)]))
            first = fmin(first, ((c * n2 + k + g->lo[2]) * n1 + j + g->lo[1]) * n0 + i);
  bw_comm_min(ns->comm, 1, &first);
  /* All velocities are finite, only their sum over the directions was not. */
  if (!isfinite(first))
    return BW_FAIL(BW_EDIVERGED,
                   "ns_channel: sum |u_i|/dx_i overflows at "
                   "t = %g; the step was too long",
                   ns->time);
  /* Taken apart again for the message. */
  const int i = (int)fmod(first, n0), j = (int)fmod(floor(first / n0), n1);
  const int k = (int)fmod(floor(first / (n0 * n1)), n2), c = (int)floor(first / (n0 * n1 * n2));
  return BW_FAIL(BW_EDIVERGED,
                 "ns_channel: velocity component %c is not finite at cell (%d, %d, %d), "
                 "t = %g; look at what was forced there, or shorten the step",
                 "uvw"[c], i, j, k, ns -> time);
}

bw_status bw_ns_channel_check(bw_ns_channel *ns, double dt)
{
  const double c = courant_everywhere(ns);
  if (!isfinite(c)) return not_finite(ns);
  /* The field is finite. Does the step fit it? */
  const double limit = bw_ns_channel_dt_max(ns);
  BW_REQUIRE(isfinite(dt) && dt >= 0.0, BW_EINPUT, "ns_channel: dt = %g; give a step > 0", dt);
  BW_REQUIRE(dt <= limit * (1.0 + 1e-12), BW_ECFL,
             "ns_channel: dt = %g at t = %g is over the limit %g (convective %g, with the speed of "
             "walls and inflows; viscous %g); use a step below it",
             dt, ns->time, limit, 1.0 / sqrt(convective(ns)),
             fmin(1.0 / diffusive(ns), ns->damping_step));
  return BW_OK;
}
