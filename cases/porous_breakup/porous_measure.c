/* The columns of history.csv: pressure drop, damage, fragments, energies, forces, masses. */
#include "bw_memory.h"
#include "porous_case.h"

#include <math.h>

const char *const porous_columns[COL_COUNT] = {
    [COL_TIME] = "time[s]",
    [COL_PHASE] = "phase[-]",
    [COL_DROP] = "pressure_drop_over_p0[-]",
    [COL_POROSITY] = "porosity[-]",
    [COL_PERMEABILITY] = "permeability[m2]",
    [COL_BROKEN] = "broken_bonds[-]",
    [COL_BROKEN_FRACTION] = "broken_bond_fraction[-]",
    [COL_DAMAGE_MEAN] = "damage_mean[-]",
    [COL_DAMAGE_MAX] = "damage_max[-]",
    [COL_FRAGMENTS] = "fragments[-]",
    [COL_DETACHED] = "detached_mass_fraction[-]",
    [COL_LARGEST] = "largest_fragment[particles]",
    [COL_FRAGMENT_SPEED] = "fragment_speed_max_over_U_b[-]",
    [COL_KINETIC] = "energy_kinetic[J]",
    [COL_ELASTIC] = "energy_elastic[J]",
    [COL_DAMPING] = "dissipated_by_damping[J]",
    [COL_FRACTURE] = "dissipated_by_fracture[J]",
    [COL_EXTERNAL] = "work_of_fluid[J]",
    [COL_REACTION] = "force_reaction_x[N]",
    [COL_REACTION + 1] = "force_reaction_y[N]",
    [COL_REACTION + 2] = "force_reaction_z[N]",
    [COL_PROBE] = "force_probe_x[N]",
    [COL_PROBE + 1] = "force_probe_y[N]",
    [COL_PROBE + 2] = "force_probe_z[N]",
    [COL_BOX] = "force_control_volume_x[N]",
    [COL_BOX + 1] = "force_control_volume_y[N]",
    [COL_BOX + 2] = "force_control_volume_z[N]",
    [COL_SLIP] = "slip_rms_over_U_b[-]",
    [COL_BLOCKED] = "probes_blocked[-]",
    [COL_DISPLACEMENT] = "displacement_max_over_h[-]",
    [COL_GIVEN] = "work_given_by_fluid[J]",
    [COL_LATE] = "work_held_back_by_relaxation[J]",
    [COL_INSIDE] = "solid_mass_inside[kg]",
    [COL_OUT] = "solid_mass_passing_out[kg]",
    [COL_LEFT] = "solid_mass_left[kg]",
    [COL_WALLS] = "impulse_on_walls_x[N s]",
    [COL_WALLS + 1] = "impulse_on_walls_y[N s]",
    [COL_WALLS + 2] = "impulse_on_walls_z[N s]",
    [COL_LEAK] = "leak_over_flux_past[-]",
    [COL_TORTUOSITY] = "tortuosity[-]",
};

/* Mean of p/rho over the plane of cells i. */
static double plane_mean(porous_run *p, int i)
{
  const bw_grid_view *g = bw_grid_look(p->grid);
  const bw_real *pressure = bw_ns_channel_pressure(p->fluid);
  double sum = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      sum += pressure[bw_at(g, i, j, k)];
  bw_comm_sum(p->comm, 1, &sum);
  return sum / ((double)g->n[1] * g->n[2]);
}

/* From the last cells before the front face to the first cells behind the back face. */
double porous_pressure_drop(porous_run *p)
{
  const porous_config *q = p->config;
  const double h = q->domain.length[0] / q->domain.cells[0], U = q->fluid.bulk_velocity;
  const int front = (int)floor(q->medium.front / h + 0.5);
  const int back = (int)floor((q->medium.front + q->medium.length) / h + 0.5) + 1;
  return (plane_mean(p, front) - plane_mean(p, back)) / (U * U);
}

/* Once per tenth of h/U_b: has the pressure drop stopped changing? */
static const double SETTLED_AFTER = 0.1; /* t0 between two looks at whether a phase has settled */

bool porous_settled(porous_run *p, double drop)
{
  const porous_config *q = p->config;
  const double t0 = q->domain.length[1] / q->fluid.bulk_velocity;
  const double elapsed = bw_ns_channel_time(p->fluid) - p->last_drop_time;
  if (elapsed < SETTLED_AFTER * t0) return false;
  /* Relative change per h/U_b. */
  const double change = fabs(drop - p->last_drop) / fabs(drop) * t0 / elapsed;
  p->last_drop = drop;
  p->last_drop_time = bw_ns_channel_time(p->fluid);
  return change < porous_phase_of(q, p->phase)->settled;
}

bool porous_sample_due(const porous_run *p)
{
  const porous_config *q = p->config;
  const porous_phase *f = porous_phase_of(q, p->phase);
  const double t0 = q->domain.length[1] / q->fluid.bulk_velocity;
  /* After the coming step, with half a step to spare against rounding. */
  const double elapsed = bw_ns_channel_time(p->fluid) + 1.5 * f->time_step - p->last_drop_time;
  return (p->step + 1) % q->output.sample_every == 0 || p->step + 1 >= f->steps ||
         elapsed >= SETTLED_AFTER * t0; /* the phase may end */
}

/* Void share of the medium's first box: its volume less the particles that are in it now. */
static void measure_particles(porous_run *p, const double X[], const double X0[],
                              const double damage[], double row[])
{
  const porous_config *q = p->config;
  const double *L = q->domain.length, volume = bw_solid_volume(p->solid);
  const double lower = q->medium.front, upper = lower + q->medium.length;
  double sums[3] = {0, 0, 0}, most[2] = {0, 0};
  for (size_t i = 0; i < bw_solid_count(p->solid); i++) {
    const double *x = X + 3 * i;
    double d2 = 0.0;
    for (int d = 0; d < 3; d++)
      d2 += (x[d] - X0[3 * i + d]) * (x[d] - X0[3 * i + d]);
    most[1] = fmax(most[1], d2);
    /* From here on the medium alone. */
    /* The clamped layers are not part of the medium. */
    if (X0[3 * i + 1] < 0.0 || X0[3 * i + 1] > L[1]) continue;
    sums[0] += x[0] > lower && x[0] < upper && x[1] > 0.0 && x[1] < L[1];
    sums[1] += damage[i];
    sums[2] += 1.0;
    most[0] = fmax(most[0], damage[i]);
  }
  bw_comm_sum(p->comm, 3, sums);
  bw_comm_max(p->comm, 2, most);
  row[COL_POROSITY] = 1.0 - sums[0] * volume / (p->length * L[1] * L[2]);
  row[COL_DAMAGE_MEAN] = sums[1] / sums[2];
  row[COL_DAMAGE_MAX] = most[0];
  row[COL_DISPLACEMENT] = sqrt(most[1]) / L[1];
}

/* The labels of the pieces that the walls hold, floor and ceiling: the same one until a crack parts
 * them. A slab is one piece, as its bonds do not break. Without a slab the largest piece counts as
 * held. Collective. */
static void find_held(porous_run *p, const bw_pd_fragments *all, const int64_t label[],
                      int64_t held[2])
{
  const size_t n = bw_solid_count(p->solid);
  const uint8_t *kind = bw_solid_kind(p->solid);
  const double most = (double)bw_solid_total(p->solid);
  double smallest = most, largest = -1.0; /* label of a held particle, over all ranks */
  for (size_t i = 0; i < n; i++) {
    if (!(kind[i] & BW_PD_PRESCRIBED)) continue;
    smallest = fmin(smallest, (double)label[i]);
    largest = fmax(largest, (double)label[i]);
  }
  bw_comm_min(p->comm, 1, &smallest);
  bw_comm_max(p->comm, 1, &largest);
  held[0] = (int64_t)smallest, held[1] = (int64_t)largest;
  if (largest < 0.0) held[0] = held[1] = all->total > 0 ? all->largest[0].label : 0;
}

/* Pieces that no wall holds. label (n): scratch. */
static bw_status measure_fragments(porous_run *p, int64_t label[], double row[])
{
  bw_pd_fragments all;
  int64_t held[2];
  BW_TRY(bw_pd_interface_fragments(bw_coupler_edit_interface(p->coupler), label, &all));
  find_held(p, &all, label, held);
  double detached = 0.0, most[2] = {0.0, 0.0}; /* most particles, highest speed */
  /* How much has come off, the largest and the fastest piece: of this rank's, then of all. */
  for (size_t q = 0; q < all.n; q++) {
    const double *v = all.own[q].velocity;
    if (all.own[q].label == held[0] || all.own[q].label == held[1]) continue;
    detached += (double)all.own[q].particles;
    most[0] = fmax(most[0], (double)all.own[q].particles);
    most[1] = fmax(most[1], sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  bw_comm_sum(p->comm, 1, &detached);
  bw_comm_max(p->comm, 2, most);
  const double kept = held[0] == held[1] ? 1.0 : 2.0;
  row[COL_FRAGMENTS] = fmax(0.0, (double)all.total - kept);
  row[COL_DETACHED] = detached / (double)bw_solid_total(p->solid);
  row[COL_LARGEST] = most[0];
  row[COL_FRAGMENT_SPEED] = most[1] / p->config->fluid.bulk_velocity;
  bw_pd_fragment_release(&all);
  return BW_OK;
}

static bw_status measure_solid(porous_run *p, double row[])
{
  const size_t n = bw_solid_count(p->solid);
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  /* Warned once: from here on contact may have been overrun. */
  if (e.closest < BW_SOLID_TOO_CLOSE && !p->warned)
    bw_log_warn(bw_case_log(p->run),
                "pieces hit each other so hard that particles came within %.2f of a spacing: they "
                "may pass through each other from here on",
                e.closest);
  p->warned = p->warned || e.closest < BW_SOLID_TOO_CLOSE;
  double *X = NULL, *X0 = NULL, *damage = NULL;
  int64_t *label = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&label, n));
  BW_THEN(st, BW_ALLOCATE(&X0, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&damage, n));
  st = bw_comm_agree(p->comm, st);
  /* The ledger and what the particles show. */
  if (st == BW_OK) {
    bw_solid_get_position(p->solid, X);
    bw_solid_get_reference(p->solid, X0);
    bw_solid_get_damage(p->solid, damage);
    measure_particles(p, X, X0, damage, row);
    row[COL_BROKEN] = (double)e.broken;
    row[COL_BROKEN_FRACTION] = (double)e.broken / (double)e.bonds;
    row[COL_KINETIC] = e.kinetic;
    row[COL_ELASTIC] = e.elastic;
    row[COL_DAMPING] = e.damping;
    row[COL_FRACTURE] = e.fracture;
    row[COL_EXTERNAL] = e.external;
    for (int d = 0; d < 3; d++)
      row[COL_WALLS + d] = e.wall[d];
    st = measure_fragments(p, label, row);
  }
  bw_release(&X);
  bw_release(&X0);
  bw_release(&damage);
  bw_release(&label);
  return st;
}

/* Darcy, POROUS 2.4 and 6.2: k = Q L mu / (S dp). NaN where no flow was measured: before the first
 * step, and while the unsteady pressure falls against the stream. */
static double permeability(const porous_run *p, double drop)
{
  const porous_config *q = p->config;
  if (!(drop > 0.0)) return NAN; /* nor before the first step */
  const double U = q->fluid.bulk_velocity, p0 = q->fluid.density * U * U;
  const double mu = q->fluid.density * q->fluid.viscosity;
  return U * p->length * mu / (drop * p0); /* Q/S = U_b: the medium fills the section */
}

/* Of the stream through the medium's first box, where it stood or stands. */
static double tortuosity(porous_run *p)
{
  const porous_config *q = p->config;
  const double lower[3] = {q->medium.front, 0.0, 0.0};
  const double upper[3] = {q->medium.front + p->length, q->domain.length[1], q->domain.length[2]};
  return bw_ns_channel_tortuosity(p->fluid, 0, lower, upper);
}

bw_status porous_measure(porous_run *p, double row[COL_COUNT])
{
  bw_coupler_report r;
  /* Forces by three routes, slip, masses. */
  BW_TRY(bw_coupler_measure(p->coupler, &r));
  row[COL_TIME] = bw_ns_channel_time(p->fluid);
  row[COL_PHASE] = p->phase + 1;
  row[COL_DROP] = bw_ns_channel_time(p->fluid) > 0.0 ? porous_pressure_drop(p) : NAN;
  row[COL_PERMEABILITY] = permeability(p, row[COL_DROP]);
  row[COL_SLIP] = r.slip_rms / p->config->fluid.bulk_velocity;
  row[COL_LEAK] = r.leak;
  row[COL_TORTUOSITY] = tortuosity(p);
  bw_coupler_warn_slip(p->coupler, &r, bw_case_log(p->run));
  bw_coupler_warn_load(p->coupler, &r, bw_case_log(p->run));
  row[COL_BLOCKED] = (double)r.probes_blocked;
  row[COL_GIVEN] = r.work_given;
  row[COL_LATE] = r.work_late;
  row[COL_INSIDE] = r.mass_inside;
  row[COL_OUT] = r.mass_out;
  row[COL_LEFT] = r.mass_left;
  p->imbalance = r.imbalance;
  for (int d = 0; d < 3; d++) {
    row[COL_REACTION + d] = r.force_reaction[d];
    row[COL_PROBE + d] = r.force_probe[d];
    row[COL_BOX + d] = r.force_control_volume[d];
  }
  return measure_solid(p, row);
}
