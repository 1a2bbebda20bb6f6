/* What a tank writes: log, history.csv, VTK files. */
#include "bw_memory.h"
#include "bw_vtk.h"
#include "dam_case.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the set-up ---- */
void dam_describe(const dam_run *d, const bw_ulph_config *fluid, bw_ulph *sample, double water,
                  double walls, double bytes)
{
  bw_log *log = bw_case_log(d->run);
  const double share = d->config->has_solid ? bw_coupler_particles_config_default().step_share : 1;
  const double steps = d->config->time.end / (share * bw_ulph_dt_max(sample));
  const double c0 = bw_ulph_c0(sample);
  bw_log_info(log, "%d dimensions, %.0f particles of water, %.0f of walls, %g apart",
              fluid->dimensions, water, walls, fluid->dx);
  bw_log_info(log, "sound %g, 1/%.3g of it is the largest speed expected, %g", c0,
              c0 / fluid->speed, fluid->speed);
  bw_log_info(log, "kinematic viscosity: physical %.3g, artificial %.3g", fluid->mu / fluid->rho0,
              bw_ulph_artificial_nu(sample));
  /* A microsecond per particle and step: one core of a server. */
  bw_log_info(log,
              "about %.0f steps, %.2g s on one core; memory about %.3g MiB for each of %d ranks",
              steps, steps * water * 1e-6, bytes / 1048576.0, bw_comm_size(d->comm));
}

/* ---- history.csv ---- */
static const char *const fixed[] = {"time[T]",
                                    "kinetic_energy[-]",
                                    "potential_energy[-]",
                                    "compression_energy[-]",
                                    "work_of_walls[-]",
                                    "lost_by_viscosity[-]",
                                    "lost_by_artificial_viscosity[-]",
                                    "lost_by_diffusion[-]",
                                    "given_by_tension_cure[-]",
                                    "given_by_shifting[-]",
                                    "given_by_wall_images[-]",
                                    "energy_gap[-]",
                                    "mass[-]",
                                    "outside[-]",
                                    "front[L]",
                                    "height[L]",
                                    "dt[T]"};
enum {
  FIXED = sizeof fixed / sizeof *fixed,
  COLUMNS = FIXED + DAM_GAUGES + DAM_SOLID_COLUMNS,
  WIDE = DAM_NAME + 16
};

static const char *unit_of(int kind)
{
  return kind == DAM_PRESSURE ? "M/(L T2)" : "L";
}

bw_status dam_open_history(dam_run *d)
{
  const char *names[COLUMNS];
  char text[DAM_GAUGES][WIDE];
  for (int q = 0; q < FIXED; q++)
    names[q] = fixed[q];
  for (int q = 0; q < d->config->n_gauges; q++) {
    const dam_gauge *g = &d->config->gauges[q];
    snprintf(text[q], WIDE, "%s[%s]", g->name, unit_of(g->kind));
    names[FIXED + q] = text[q];
  }
  int n = FIXED + d->config->n_gauges;
  for (int q = 0; q < DAM_SOLID_COLUMNS && d->both != NULL; q++)
    names[n++] = dam_solid_columns[q];
  return bw_case_history(d->run, n, names, bw_ulph_time(d->fluid), d->rows, &d->history);
}

/* -INFINITY, where there is no water, is an empty cell. */
static double reach(const dam_run *d, int axis, const double lower[3], const double upper[3])
{
  const double most = bw_ulph_reach(d->fluid, axis, lower, upper);
  return isfinite(most) ? most : NAN;
}

static double gauge(const dam_run *d, int number, const double at[3])
{
  const dam_gauge *g = &d->config->gauges[number];
  double x[3], lower[3], upper[3];
  for (int k = 0; k < 3; k++) {
    x[k] = g->at[k] + at[k];
    lower[k] = g->lower[k] + at[k], upper[k] = g->upper[k] + at[k];
  }
  const double width = g->width > 0 ? g->width : 2 * d->config->fluid.spacing;
  if (g->kind == DAM_ASIDE || g->kind == DAM_UP) return dam_moved(d, g, g->kind == DAM_UP);
  if (g->kind == DAM_DEPTH) return bw_ulph_depth(d->fluid, x, width);
  /* The start has no interval to average over. */
  if (g->kind == DAM_PRESSURE && d->covered > 0) return d->pressure[number] / d->covered;
  if (g->kind == DAM_PRESSURE) return bw_ulph_wall_pressure(d->fluid, lower, upper);
  return reach(d, g->kind == DAM_FRONT ? 0 : 1, lower, upper);
}

bw_status dam_sample(dam_run *d)
{
  const bw_ulph_ledger l = bw_ulph_account(d->fluid);
  const double *size = d->config->tank.size;
  /* Energies are over the first one, so that they need no unit. */
  const double unit = l.first != 0 ? fabs(l.first) : 1;
  double at[3], lower[3], upper[3];
  dam_where(d, at);
  for (int k = 0; k < 3; k++)
    lower[k] = at[k], upper[k] = at[k] + (k == 1 ? 1e30 : size[k]);
  const double outside = (double)bw_ulph_outside(d->fluid, lower, upper);
  double row[COLUMNS] = {bw_ulph_time(d->fluid),
                         l.kinetic / unit,
                         l.potential / unit,
                         l.compression / unit,
                         l.walls / unit,
                         l.viscous / unit,
                         l.artificial / unit,
                         l.diffusion / unit,
                         l.tension / unit,
                         l.shifting / unit,
                         l.ghosts / unit,
                         l.gap / unit,
                         l.mass,
                         outside,
                         reach(d, 0, lower, upper),
                         reach(d, 1, lower, upper),
                         d->dt};
  for (int q = 0; q < d->config->n_gauges; q++)
    row[FIXED + q] = gauge(d, q, at);
  if (d->both != NULL) BW_TRY(dam_solid_row(d, unit, row + FIXED + d->config->n_gauges));
  bw_history_append(d->history, row);
  memset(d->pressure, 0, sizeof d->pressure);
  d->covered = 0;
  BW_REQUIRE(outside <= 0.01 * (double)bw_ulph_total(d->fluid), BW_EDIVERGED,
             "at t = %g %.0f of %lld particles have left the tank through its walls: take smaller "
             "steps (time.step_share) or more particles",
             bw_ulph_time(d->fluid), outside, (long long)bw_ulph_total(d->fluid));
  return BW_OK;
}

/* ---- pictures ---- */
bw_status dam_write_points(dam_run *d, const char *name, size_t n, const double x[], int count,
                           const bw_vtk_array array[])
{
  char file[64], pvd[64], *path = NULL, *series = NULL;
  snprintf(file, sizeof file, "%s-%08lld.vtp", name, (long long)bw_ulph_steps(d->fluid));
  snprintf(pvd, sizeof pvd, "%s.pvd", name);
  bw_status st = bw_case_path(d->run, file, &path);
  BW_THEN(st, bw_case_path(d->run, pvd, &series));
  BW_THEN(st, bw_vtk_write_points(d->comm, path, bw_ulph_time(d->fluid), n, x, count, array));
  BW_THEN(st, bw_vtk_series_add(d->comm, series, bw_ulph_time(d->fluid), file));
  bw_release(&path);
  bw_release(&series);
  return st;
}

typedef void reader(const bw_ulph *u, bw_ulph_field field, double out[]);

/* Points with velocity, pressure and, for water, density and surface, as NAME.pvd. */
static bw_status picture(dam_run *d, const char *name, size_t n, reader *read, int count)
{
  static const bw_ulph_field field[] = {BW_ULPH_VELOCITY, BW_ULPH_PRESSURE, BW_ULPH_DENSITY,
                                        BW_ULPH_SURFACE};
  static const char *const words[] = {"velocity", "pressure", "density", "surface"};
  double *x = NULL, *data[4] = {NULL};
  bw_vtk_array array[4];
  bw_status st = BW_ALLOCATE(&x, 3 * n);
  for (int q = 0; q < count; q++) {
    BW_THEN(st, BW_ALLOCATE(&data[q], (q == 0 ? 3 : 1) * n));
    if (st == BW_OK) read(d->fluid, field[q], data[q]);
    array[q] = (bw_vtk_array){words[q], BW_VTK_FLOAT64, q == 0 ? 3 : 1, data[q]};
  }
  if (st == BW_OK) read(d->fluid, BW_ULPH_POSITION, x);
  st = bw_comm_agree(d->comm, st);
  BW_THEN(st, dam_write_points(d, name, n, x, count, array));
  bw_release(&x);
  for (int q = 0; q < count; q++)
    bw_release(&data[q]);
  return st;
}
bw_status dam_picture(dam_run *d)
{
  BW_TRY(picture(d, "water", bw_ulph_count(d->fluid), bw_ulph_read, 4));
  BW_TRY(picture(d, "walls", bw_ulph_wall_count(d->fluid), bw_ulph_read_wall, 2));
  return d->both != NULL ? dam_solid_picture(d) : BW_OK;
}
