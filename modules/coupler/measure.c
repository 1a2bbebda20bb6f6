/* What a step did: forces by three routes, slip, counts, and its cost by part. */
#include "bw_coupler.h"
#include "coupler_internal.h"

#include <math.h>

static void count_probes(const bw_coupler *c, int64_t count[2])
{
  count[0] = count[1] = 0;
  for (size_t q = 0; q < c->n_surface; q++) {
    count[0] += c->flag[q] == BW_PROBE_SHORTENED || c->flag[q] == BW_PROBE_CROWDED;
    count[1] += c->flag[q] == BW_PROBE_BLOCKED;
  }
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
                         .iterations = c->iterations,
                         .residual = c->residual,
                         .unconverged = c->unconverged};
  double box[3], mass[3];
  int64_t count[2];
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
  r.force_probe[0] += c->config.rho * bw_ns_channel_driving(c->fluid) * bw_coupler__wetted(c);
  bw_comm_sum(comm, 3, r.force_probe);
  bw_comm_sum(comm, 1, &r.surface_area);
  bw_comm_sum(comm, 1, &r.work_given);
  bw_comm_sum(comm, 1, &r.work_late);
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
