/* ns_step.c -- the recipe: predict, project, and the checks around a step. */
#include "ns_channel_internal.h"

/* Low-storage RK3 (ERRATA 5): gamma = alpha + beta. */
const double bw_ns__alpha[BW_NS_STAGES] = {8.0 / 15.0, 5.0 / 12.0, 3.0 / 4.0};
const double bw_ns__beta[BW_NS_STAGES] = {0.0, -17.0 / 60.0, -5.0 / 12.0};
const double bw_ns__gamma[BW_NS_STAGES] = {8.0 / 15.0, 2.0 / 15.0, 1.0 / 3.0};
const double bw_ns__end[BW_NS_STAGES] = {8.0 / 15.0, 2.0 / 3.0, 1.0};

/* Shares of gamma_r of an implicit term with the old and with the new velocity. Second order in
 * time asks for sum gamma_r (new_r - old_r) = 0 only; so the middle one may be backward Euler,
 * which takes stiff modes away within a step, where the trapezoidal rule in all three would only
 * turn their sign (ERRATA 38). */
const double bw_ns__old[BW_NS_STAGES] = {17.0 / 60.0, 0.0, 1.0 / 6.0};
const double bw_ns__new[BW_NS_STAGES] = {1.0 / 4.0, 2.0 / 15.0, 1.0 / 6.0};

/* Seconds since *mark are added to *sum; *mark moves on. */
static void lap(double *mark, double *sum)
{
  const double now = bw_wall_time();
  *sum += now - *mark;
  *mark = now;
}

static void velocity_halos(bw_ns_channel *ns)
{
  bw_halo_update(ns->grid, ns->components, ns->u);
  bw_ns__ghosts_velocity(ns);
}

/* p = sum of p^, and p^ has all its halos: no message. */
static void pressure_halos(bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  const int *h = g->halo, *m = g->m;
  for (int k = 1 - h[2]; k <= m[2] + h[2]; k++)
    for (int j = 1 - h[1]; j <= m[1] + h[1]; j++) {
      /* Of a row inside only its two ends are halo; rows outside are halo altogether. */
      const bool inside = 1 <= j && j <= m[1] && 1 <= k && k <= m[2];
      const ptrdiff_t at = bw_at(g, 0, j, k);
      for (int i = 1 - h[0]; i <= m[0] + h[0]; i = inside && i == 0 ? m[0] + 1 : i + 1)
        ns->p[at + i] += ns->phi[at + i];
    }
}

static void all_halos(bw_ns_channel *ns)
{
  bw_real *field[4] = {ns->p, ns->u[0], ns->u[1], ns->u[2]};
  bw_halo_update(ns->grid, 1 + ns->components, field);
  bw_ns__ghosts_velocity(ns);
  bw_ns__ghosts_scalar(ns, ns->p);
}

/* `faces`: of the halos only what a divergence reads. */
static void predict(bw_ns_channel *ns, int r, double dt, bool faces)
{
  const double gamma_dt = bw_ns__gamma[r] * dt;
  /* A constant flow rate starts from the gradient of the sub-step before; project corrects it. */
  const bw_ns_forcing forcing = ns->config.forcing;
  const double gradient = forcing == BW_FORCING_GRADIENT    ? ns->config.forcing_value
                          : forcing == BW_FORCING_FLOW_RATE ? ns->gradient
                                                            : 0.0;
  double mark = bw_wall_time();
  /* Sub-step r: u* = u + dt (alpha_r R + beta_r R_prev - gamma_r grad p) + source (POROUS 3.70). */
  bw_ns_sweep *s = &ns->sweep;
  s->alpha_dt = (bw_real)(bw_ns__alpha[r] * dt);
  s->beta_dt = (bw_real)(bw_ns__beta[r] * dt);
  s->gamma_dt = (bw_real)gamma_dt;
  s->kappa = (bw_real)(bw_ns__old[r] * dt * ns->config.nu);
  for (int d = 0; d < 3; d++)
    s->source[d] = d == ns->config.forcing_axis ? (bw_real)(gamma_dt * gradient) : 0;
  /* Books the mean gradient of the step, weighted as pressure is. */
  if (r == 0) ns->applying = 0.0;
  ns->applying += bw_ns__gamma[r] * gradient;

  /* Side values at the end of the sub-step; what leaves is carried out by the old velocity. */
  const bw_ns_viscous viscous = ns->config.viscous;
  const double influx = bw_ns__inflow(ns, ns->time + bw_ns__end[r] * dt);
  bw_ns__outflow_advance(ns, gamma_dt, influx);
  /* The watched box sums the fluxes that the sweep is about to use. */
  bw_ns__box_fluxes(ns, r, dt, gradient);
  if (viscous == BW_VISCOUS_IMPLICIT_Y) bw_ns__box_diffusion(ns, bw_ns__old[r] * dt);
  lap(&mark, &ns->cost.boundary);
  /* u is u* afterwards, but for what is implicit and for faces on sides. */
  bw_ns__eddy_force(ns);
  bw_ns__momentum_sweep(s, r);
  bw_ns__eddy_add(ns, r, dt);
  /* The solve in y takes the new v on the sides as its boundary values. */
  if (viscous == BW_VISCOUS_IMPLICIT_Y) {
    bw_ns__faces(ns);
    bw_ns__implicit_solve(ns, bw_ns__new[r] * dt * ns->config.nu);
  }
  if (viscous == BW_VISCOUS_IMPLICIT) bw_ns__factored_solve(ns, r, dt);
  /* From here on u* meets the sides; it is not free of divergence. */
  bw_ns__faces(ns);
  lap(&mark, &ns->cost.momentum);
  /* Who only projects reads one layer of normal velocities; a body reads all of the halos. */
  if (faces)
    bw_halo_update_faces(ns->grid, ns->u);
  else
    velocity_halos(ns);
  /* The implicit part of the diffusion, with the new velocity. */
  if (viscous == BW_VISCOUS_IMPLICIT_Y) bw_ns__box_diffusion(ns, bw_ns__new[r] * dt);
  lap(&mark, &ns->cost.halo);
}

void bw_ns_channel_predict(bw_ns_channel *ns, int r, double dt)
{
  predict(ns, r, dt, false);
}

void bw_ns_channel_ghosts(bw_ns_channel *ns)
{
  bw_ns__ghosts_velocity(ns);
}

/* This rank's sum of the driven component times dy, where it is not u, whose sum divergence
 * gives. */
static double sum_along(const bw_ns_channel *ns)
{
  const bw_grid_view *g = ns->g;
  const bw_real *q = ns->u[ns->config.forcing_axis];
  double sum = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++) {
      const ptrdiff_t at = bw_at(g, 0, j, k);
      double row = 0.0;
      for (int i = 1; i <= g->m[0]; i++)
        row += (double)q[at + i];
      sum += ns->metrics.dyf[j] * row;
    }
  return sum;
}

static void add_along(bw_ns_channel *ns, double shift)
{
  const bw_grid_view *g = ns->g;
  bw_real *q = ns->u[ns->config.forcing_axis];
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++)
        q[bw_at(g, i, j, k)] += (bw_real)shift;
}

/* Uniform change of the driven component that the constant flow rate still needs; sum: this rank's
 * sum of it times dy. */
static double flow_rate_shift(bw_ns_channel *ns, double sum)
{
  const bw_grid_view *g = ns->g;
  bw_comm_sum(ns->comm, 1, &sum);
  const double bulk = sum / ((double)g->n[0] * g->n[2] * g->length[1]);
  return ns->config.forcing_value - bulk;
}

/* phi: divergence -> p^ ; then u, p. `fresh`: halos and faces of u* are those of predict. */
static void project(bw_ns_channel *ns, int r, double dt, bool fresh)
{
  const double gamma_dt = bw_ns__gamma[r] * dt;
  const bool flow_rate = ns->config.forcing == BW_FORCING_FLOW_RATE;
  const bool along_x = ns->config.forcing_axis == 0;
  double mark = bw_wall_time(), shift = 0.0;
  /* A body has changed u* since predict. */
  if (!fresh) {
    bw_ns__faces(ns); /* a body may have spread onto them */
    velocity_halos(ns);
    lap(&mark, &ns->cost.halo);
  }
  /* phi <- div u* over gamma_r dt, the right side of lap p^ (POROUS 3.71). The sum gives the bulk
   * velocity. */
  const double sum =
      bw_ns__divergence(ns->g, &ns->metrics, ns->u, 1.0 / gamma_dt, flow_rate && along_x, ns->phi);
  /* What enters the box inside is what div u ends with. */
  bw_ns__sources_take(ns, 1.0 / gamma_dt, ns->phi);
  /* The change that the flow rate still needs is uniform, hence without divergence. */
  if (flow_rate) {
    shift = flow_rate_shift(ns, along_x ? sum : sum_along(ns));
    if (!along_x) add_along(ns, shift);
    ns->applying += shift / dt;
    /* A velocity that was just set may have another bulk: that jump is no gradient. */
    if (!ns->impulsive) ns->gradient += shift / gamma_dt;
    ns->impulsive = false;
  }
  lap(&mark, &ns->cost.correct);
  /* phi: p^. */
  bw_poisson_solve(ns->poisson, ns->phi);
  lap(&mark, &ns->cost.poisson);
  /* grad p^ on the upper faces of the block needs the neighbour's p^; at sides it is zero. */
  bw_halo_update(ns->grid, 1, &ns->phi);
  bw_ns__ghosts_scalar(ns, ns->phi);
  lap(&mark, &ns->cost.halo);
  /* The watched box books p^ and the shift before they are spent. */
  bw_ns__box_projection(ns, gamma_dt, shift);
  /* u <- u* - gamma_r dt grad p^, p <- p + p^ (POROUS 3.72, 3.73): from here on div u = 0, or
   * what the sources give. */
  ns->courant = bw_ns__correct(ns->g, &ns->metrics, ns->u, ns->p, ns->phi, gamma_dt,
                               along_x ? shift : 0.0, r == BW_NS_STAGES - 1);
  ns->courant_known = false;
  lap(&mark, &ns->cost.correct);
  /* Everything is valid again: interior, halos, ghosts. */
  velocity_halos(ns);
  pressure_halos(ns);
  lap(&mark, &ns->cost.halo);
  bw_ns__eddy_update(ns);
  lap(&mark, &ns->cost.momentum);
  ns->cost.substeps++;
  /* The step ends with the third sub-step: its balance, mean gradient and time. */
  if (r < BW_NS_STAGES - 1) return;
  bw_ns__box_finish(ns, dt);
  ns->applied = ns->applying;
  ns->time += dt;
}

void bw_ns_channel_project(bw_ns_channel *ns, int r, double dt)
{
  project(ns, r, dt, false);
}

bw_status bw_ns_channel_step(bw_ns_channel *ns, double dt)
{
  BW_REQUIRE(dt > 0.0, BW_EINPUT, "ns_channel: dt = %g; give a step > 0", dt);
  /* An impossible step is refused before it spoils the field. */
  BW_TRY(bw_ns_channel_check(ns, dt));
  for (int r = 0; r < BW_NS_STAGES; r++) {
    predict(ns, r, dt, !ns->box.on); /* no body: nobody looks at u* */
    project(ns, r, dt, true);
  }
  /* Is the result finite? A step of 0 is within every limit. */
  return bw_ns_channel_check(ns, 0.0);
}

void bw_ns_channel_refresh(bw_ns_channel *ns)
{
  /* Planes first: those of time, then what leaves from the fields themselves. */
  bw_ns__inflow(ns, ns->time);
  bw_ns__outflow_capture(ns);
  bw_ns__faces(ns);
  all_halos(ns);
  /* What a step would have left behind is found anew, to the same bits. */
  ns->courant = bw_ns__courant(ns->g, &ns->metrics, ns->u);
  bw_ns__eddy_update(ns);
  ns->courant_known = false;
  ns->box.known = false;
}

static void sample(bw_ns_channel *ns, bw_ns_velocity_fn function, void *context, double t)
{
  const bw_grid_view *g = ns->g;
  for (int c = 0; c < ns->components; c++) /* from the lower face on: an outflow keeps it */
    for (int k = c == 2 ? 0 : 1; k <= g->m[2]; k++)
      for (int j = c == 1 ? 0 : 1; j <= g->m[1]; j++)
        for (int i = c == 0 ? 0 : 1; i <= g->m[0]; i++) {
          const int y = j + g->lo[1];
          double u[3] = {0, 0, 0};
          /* Each component at its own staggered point. */
          const double x[3] = {(c == 0 ? i : i - 0.5) * g->spacing[0],
                               c == 1 ? g->y_face[y] : g->y_centre[y],
                               (k + g->lo[2] - (c == 2 ? 0.0 : 0.5)) * g->spacing[2]};
          if (function != NULL) function(x, t, context, u);
          ns->u[c][bw_at(g, i, j, k)] = (bw_real)u[c];
        }
}

static void zero(const bw_grid_view *g, bw_real *field)
{
  for (size_t q = 0; q < g->size; q++)
    field[q] = 0;
}

bw_status bw_ns_channel_set_velocity(bw_ns_channel *ns, bw_ns_velocity_fn function, void *context,
                                     double t)
{
  ns->time = t;
  ns->gradient = ns->applied = 0.0;
  ns->impulsive = true;
  /* As given: neither free of divergence nor in balance at the sides. */
  sample(ns, function, context, t);
  /* The outflow takes what the function has there, shifted to balance the inflow. */
  const double influx = bw_ns__inflow(ns, t);
  bw_ns__outflow_capture(ns);
  bw_ns__outflow_balance(ns, influx);
  bw_ns__faces(ns);
  for (int pass = 0; pass < 2; pass++) { /* the second takes away the round-off of the first */
    velocity_halos(ns);
    /* A projection with gamma dt = 1: only the velocity is wanted of it. */
    bw_ns__divergence(ns->g, &ns->metrics, ns->u, 1.0, false, ns->phi);
    bw_poisson_solve(ns->poisson, ns->phi);
    bw_halo_update(ns->grid, 1, &ns->phi);
    bw_ns__ghosts_scalar(ns, ns->phi);
    bw_ns__correct(ns->g, &ns->metrics, ns->u, ns->p, ns->phi, 1.0, 0.0, false);
  }
  /* p has gathered the two corrections, which are no pressure. */
  zero(ns->g, ns->p);
  /* Halos, ghosts and the Courant number of the projected field. */
  bw_ns_channel_refresh(ns);
  for (int d = 0; d < 3; d++)
    ns->box.force[d] = 0.0;
  return bw_ns_channel_check(ns, 0.0);
}
