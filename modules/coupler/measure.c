/* What a step did: forces by three routes, slip, counts, and its cost by part. */
#include "bw_coupler.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void count_probes(const bw_coupler *c, int64_t count[2])
{
  count[0] = count[1] = 0;
  for (size_t q = 0; q < c->probes.n; q++) {
    const unsigned char flag = c->probes.flag[q];
    count[0] += flag == BW_PROBE_SHORTENED || flag == BW_PROBE_CROWDED;
    count[1] += flag == BW_PROBE_BLOCKED;
  }
}

/* The largest speed that a side's function gives now, on the faces beside this rank's cells. */
static double speed_of_function(const bw_coupler *c, int d, int s)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  const bw_ns_side *side = &bw_ns_channel_settings(c->fluid)->side[d][s];
  const int e = (d + 1) % 3, f = (d + 2) % 3;
  const double t = bw_ns_channel_time(c->fluid);
  double most = 0.0, x[3], u[3] = {0.0, 0.0, 0.0};
  x[d] = s == 0 ? 0.0 : g->length[d];
  for (int k = 1; k <= g->m[f]; k++)
    for (int j = 1; j <= g->m[e]; j++) {
      x[e] = (g->lo[e] + j - 0.5) * g->spacing[e];
      x[f] = (g->lo[f] + k - 0.5) * g->spacing[f];
      side->function(x, t, side->context, u);
      most = fmax(most, sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
    }
  return most;
}

/* The largest speed that drives the fluid: of inflows, walls, a given flow rate, bodies; the mean
 * of the fluid where nothing of this moves. Collective. */
double bw_coupler__reference_speed(bw_coupler *c)
{
  const bw_ns_channel_config *fluid = bw_ns_channel_settings(c->fluid);
  double most = fluid->forcing == BW_FORCING_FLOW_RATE ? fabs(fluid->forcing_value) : 0.0;
  for (int d = 0; d < 3; d++)
    for (int s = 0; s < 2; s++) {
      const bw_ns_side *side = &fluid->side[d][s];
      if (side->kind != BW_SIDE_WALL && side->kind != BW_SIDE_INFLOW) continue;
      const double *v = side->velocity;
      most = fmax(most, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
      if (side->profile == BW_PROFILE_POISEUILLE) most = fmax(most, fabs(side->bulk_velocity));
      if (side->profile == BW_PROFILE_CALLBACK) most = fmax(most, speed_of_function(c, d, s));
    }
  for (size_t q = 0; q < c->n_surface; q++) {
    const double *v = c->marker_V + 3 * q;
    most = fmax(most, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  bw_comm_max(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 1, &most);
  return most > 0.0 ? most : fabs(bw_ns_channel_summary(c->fluid).bulk_velocity);
}

/* Through the surface over past it. Collective. */
static double measure_leak(bw_coupler *c, double speed)
{
  const bw_comm *comm = bw_grid_comm(bw_ns_channel_grid(c->fluid));
  double *U = c->moment, sum[4] = {0.0}; /* scratch; through, frontal areas */
  /* Markers that are not those of the present surface tell nothing about it. */
  double other = c->handed != (c->block > 1 ? c->blocks.n : c->n_surface);
  bw_comm_max(comm, 1, &other);
  if (other > 0.0) return NAN;
  if (c->block > 1)
    bw_coupler__blocks_velocity(c, U);
  else
    bw_ibm_mdf_interpolate(c->ibm, bw_ns_channel_velocity(c->fluid), U);
  for (size_t q = 0; q < c->n_surface; q++) {
    double through = 0.0;
    for (size_t d = 0; d < 3; d++) {
      through += (U[3 * q + d] - c->marker_V[3 * q + d]) * c->normal[3 * q + d];
      sum[1 + d] += fabs(c->normal[3 * q + d]) * c->area[q];
    }
    sum[0] += fabs(through) * c->area[q];
  }
  bw_comm_sum(comm, 4, sum);
  const double past = speed * fmax(sum[1], fmax(sum[2], sum[3]));
  return past > 0.0 ? sum[0] / past : 0.0;
}

void bw_coupler_get_load(const bw_coupler *c, double load[])
{
  if (c->n > 0) memcpy(load, c->load, 3 * c->n * sizeof *load);
  if (c->films != NULL) bw_coupler__solid_films_add(c, load);
}

enum { IN_A_ROW = 5 }; /* reports */

static bool much_slip(const bw_coupler *c)
{
  static const double MUCH = 0.02; /* 2 % of slip cost some 2 % of the force in narrow gaps */
  return c->slip_last[0] > MUCH || c->slip_last[1] > MUCH;
}

static void tell_slip(bw_coupler *c, bw_log *log)
{
  char start[64] = "";
  /* A body that swings is held back by a memory (docs/verification/coupler). */
  const bool memory = c->config.memory == 0.0 && c->config.coupling_iterations == 1;
  if (c->steps < BW_COUPLER__START)
    snprintf(start, sizeof start, "run longer (%lld steps are a start), ", (long long)c->steps);
  c->slip_above = -1;
  bw_log_warn(log,
              "slip at the markers is %.1f %% of the flow, %.1f %% of it passes through the "
              "surface: forces come out too low; %stake smaller steps%s or more forcing iterations",
              100.0 * c->slip_last[0], 100.0 * c->slip_last[1], start,
              memory ? ", a memory of the forcing (coupling.memory, in scenes numerics.memory: 0.2)"
                     : "");
}

void bw_coupler_warn_slip(bw_coupler *c, const bw_coupler_report *r, bw_log *log)
{
  /* Where all has come to rest the speeds of the moment are next to nothing: those that the run has
   * had say what slip is small. */
  const double share = c->speed_most > 0.0 ? c->speed / c->speed_most : 1.0;
  c->slip_last[0] = share * r->slip, c->slip_last[1] = share * r->leak;
  if (c->slip_above < 0 || c->steps < BW_COUPLER__START) return;
  c->slip_above = much_slip(c) ? c->slip_above + 1 : 0;
  if (c->slip_above == IN_A_ROW) tell_slip(c, log);
}

void bw_coupler_warn_end(bw_coupler *c, bw_log *log)
{
  /* Where nothing was stepped nothing is new. */
  if (c->steps > 0 && c->slip_above >= 0 && much_slip(c)) tell_slip(c, log);
}

void bw_coupler_warn_load(bw_coupler *c, const bw_coupler_report *r, bw_log *log)
{
  static const double MANY =
      1.0 / 3.0; /* of the probes: what they miss is then told by the forces */
  const uint8_t *kind = bw_solid_kind(c->solid);
  double count[2] = {0.0, (double)c->probes.n}; /* held particles, probes */
  if (c->load_told || c->held || c->config.load != BW_LOAD_PROBES) return;
  c->load_told = true;
  for (size_t i = 0; i < c->n; i++)
    count[0] += (kind[i] & BW_PD_PRESCRIBED) != 0;
  bw_comm_sum(bw_solid_comm(c->solid), 2, count);
  if (count[0] == 0.0)
    bw_log_warn(log,
                "nothing holds the solid, and probes load it: free bodies then move by a fifth "
                "too fast; take coupling.load: reaction");
  const double missed = (double)(r->probes_shortened + r->probes_blocked);
  if (missed > MANY * count[1])
    bw_log_warn(log,
                "%.0f %% of the probes have no room of coupling.probe_length = %g cells: what they "
                "load is too little; take coupling.load: reaction, or more cells in the gaps",
                100.0 * missed / count[1], c->config.probe_length);
}

bw_status bw_coupler_measure(bw_coupler *c, bw_coupler_report *out)
{
  const bw_comm *comm = bw_grid_comm(bw_ns_channel_grid(c->fluid));
  /* Before the first step the markers are those it will begin with. */
  if (!c->stepped) BW_TRY(bw_coupler__place_markers(c));
  const bw_ibm_mdf_report ibm = bw_ibm_mdf_measure(c->ibm, bw_ns_channel_velocity(c->fluid));
  bw_coupler_report r = {.slip_rms = ibm.slip_after,
                         .markers = ibm.markers,
                         .markers_outside = ibm.outside,
                         .imbalance = ibm.imbalance,
                         .work_given = c->work.given,
                         .work_late = c->work.late,
                         .work_unseen = c->work.given - c->work.loaded,
                         .work_received = c->work.received,
                         .work_film = c->work.film,
                         .iterations = c->iterations,
                         .residual = c->residual,
                         .unconverged = c->unconverged,
                         .relaxation = c->config.load_relaxation,
                         .relaxation_limit = c->choice.limit.relaxation};
  double box[3], mass[3];
  int64_t count[2];
  const double speed = bw_coupler__reference_speed(c);
  c->speed = speed;
  c->speed_most = fmax(c->speed_most, speed);
  r.slip = speed > 0.0 ? r.slip_rms / speed : 0.0;
  r.leak = measure_leak(c, speed);
  /* Probes that load the solid were read in the step; others are read now, if p is known. */
  const bool probed = !c->held && c->config.load == BW_LOAD_PROBES; /* in the step itself */
  const bool known = probed || c->p_mean_known || !c->stepped;
  if (!probed && known) BW_TRY(bw_coupler__probe_force(c, c->checked_dt));
  /* Three routes: markers (ERRATA 18), probes, momentum of a box. */
  bw_ns_channel_control_volume(c->fluid, box);
  for (int d = 0; d < 3; d++) {
    r.force_reaction[d] = -c->config.rho * ibm.total_force[d];
    r.force_control_volume[d] = -c->config.rho * box[d];
    r.force_probe[d] = known ? c->force_probe[d] : NAN;
  }
  /* This rank's shares; the sums over ranks follow. */
  for (size_t q = 0; q < c->n_surface; q++)
    r.surface_area += c->area[q];
  /* The pressure that probes see lacks the gradient that drives the fluid (ERRATA 31). */
  r.force_probe[bw_ns_channel_settings(c->fluid)->forcing_axis] +=
      c->config.rho * bw_ns_channel_driving(c->fluid) * bw_coupler__wetted(c);
  bw_comm_sum(comm, 3, r.force_probe);
  bw_comm_sum(comm, 1, &r.surface_area);
  bw_comm_sum(comm, 1, &r.work_given);
  bw_comm_sum(comm, 1, &r.work_late);
  bw_comm_sum(comm, 1, &r.work_unseen);
  bw_comm_sum(comm, 1, &r.work_received);
  bw_comm_sum(comm, 1, &r.work_film);
  bw_coupler__solid_films_look(c, &r);
  /* What is inside, passing out and gone. */
  bw_coupler__count_mass(c, mass);
  r.mass_inside = mass[0], r.mass_out = mass[1], r.mass_left = mass[2];
  count_probes(c, count);
  bw_comm_sum_int(comm, 2, count);
  r.probes_shortened = count[0];
  r.probes_blocked = count[1];
  *out = r;
  return BW_OK;
}

/* Of a held solid, which nothing loads: read now. */
static bw_status read_flow(bw_coupler *c, bool probed)
{
  if (probed)
    BW_TRY(bw_coupler__probe_force(c, c->checked_dt));
  else
    bw_coupler__reaction_force(c);
  memset(c->flow, 0, 3 * c->n * sizeof *c->flow);
  for (size_t q = 0; q < c->n_surface; q++)
    memcpy(c->flow + 3 * (size_t)c->particle[q], c->force + 3 * q, 3 * sizeof *c->flow);
  return BW_OK;
}

bw_status bw_coupler_force_on(bw_coupler *c, const bool on[], double force[3])
{
  const bool probed = c->config.load == BW_LOAD_PROBES;
  const bool known = !c->held || !probed || c->p_mean_known || !c->stepped;
  double wet = 0.0;
  force[0] = force[1] = force[2] = 0.0;
  if (!c->stepped) BW_TRY(bw_coupler__place_markers(c));
  if (c->held && known) BW_TRY(read_flow(c, probed));
  for (size_t i = 0; i < c->n; i++) {
    if (!on[i]) continue;
    for (size_t d = 0; d < 3; d++)
      force[d] += c->flow[3 * i + d];
    wet += bw_solid_volume_of(c->solid, i);
  }
  /* The pressure that probes see lacks the gradient that drives the fluid (ERRATA 31). */
  if (probed)
    force[bw_ns_channel_settings(c->fluid)->forcing_axis] +=
        c->config.rho * bw_ns_channel_driving(c->fluid) * wet;
  bw_comm_sum(bw_grid_comm(bw_ns_channel_grid(c->fluid)), 3, force);
  for (int d = 0; d < 3 && !known; d++)
    force[d] = NAN;
  return BW_OK;
}
