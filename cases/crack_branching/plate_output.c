#include "plate_output.h"
#include "bw_memory.h"
#include "bw_pd_bond_words.h"
#include "bw_vtk.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>

#define V BW_CONFIG_VALUE
static const bw_config_field shape_fields[] = {
    V(plate_shape, length, BW_REQUIRED, BW_ABOVE(0), "m", "of the plate, along the crack"),
    V(plate_shape, height, BW_REQUIRED, BW_ABOVE(0), "m", "between the pulled edges"),
    V(plate_shape, notch, BW_REQUIRED, BW_AT_LEAST(0), "m", "from the left edge, at mid height"),
    V(plate_shape, particles, BW_REQUIRED, BW_AT_LEAST(10), "", "along the length"), BW_CONFIG_END};

static const bw_config_field solid_fields[] = {
    V(plate_solid, young_modulus, BW_REQUIRED, BW_ABOVE(0), "Pa", "Young's modulus"),
    V(plate_solid, density, BW_REQUIRED, BW_ABOVE(0), "kg/m3", "density"),
    V(plate_solid, fracture_energy, BW_REQUIRED, BW_ABOVE(0), "J/m2", "G0"),
    V(plate_solid, horizon_ratio, BW_OPTIONAL, BW_FROM_TO(1.5, 10), "", "horizon over spacing"),
    BW_CONFIG_WORD(plate_solid, surface_correction, BW_OPTIONAL, bw_pd_bond_correction_words,
                   "stiffness of bonds near edges"),
    BW_CONFIG_WORD(plate_solid, volume_fraction, BW_OPTIONAL, bw_pd_bond_fraction_words,
                   "part of a partner within the horizon"),
    BW_CONFIG_WORD(plate_solid, family_reach, BW_OPTIONAL, bw_pd_bond_reach_words,
                   "who is a partner"),
    BW_CONFIG_WORD(plate_solid, integrator, BW_OPTIONAL, bw_pd_bond_integrator_words, "in time"),
    V(plate_solid, damping_pair, BW_OPTIONAL, BW_AT_LEAST(0), "N s/m7", "pairwise damping k_d"),
    BW_CONFIG_END};

static const bw_config_field load_fields[] = {
    V(plate_load, stress, BW_REQUIRED, BW_ANY, "Pa", "pull on the two long edges"),
    V(plate_load, rows, BW_OPTIONAL, BW_AT_LEAST(1), "", "of particles that take it"),
    BW_CONFIG_END};

static const bw_config_field time_fields[] = {
    V(plate_time, step, BW_REQUIRED, BW_ABOVE(0), "s", "time step"),
    V(plate_time, end, BW_REQUIRED, BW_ABOVE(0), "s", "end"), BW_CONFIG_END};

static const bw_config_field output_fields[] = {
    V(plate_files, sample_every, BW_OPTIONAL, BW_AT_LEAST(1), "steps", "rows of history.csv"),
    V(plate_files, picture_every, BW_OPTIONAL, BW_AT_LEAST(1), "steps", "damage-*.vtp"),
    BW_CONFIG_END};

const bw_config_field crack_case_fields[] = {
    BW_CONFIG_MAP(crack_case, shape, shape_fields, "the plate"),
    BW_CONFIG_MAP(crack_case, solid, solid_fields, "the material"),
    BW_CONFIG_MAP(crack_case, load, load_fields, "what tears it"),
    BW_CONFIG_MAP(crack_case, time, time_fields, "how long"),
    BW_CONFIG_MAP(crack_case, output, output_fields, "files"),
    BW_CONFIG_END};
#undef V

crack_case crack_case_default(void)
{
  return (crack_case){.shape = {.length = NAN, .height = NAN, .notch = NAN, .particles = INT_MIN},
                      .solid = {.young_modulus = NAN,
                                .density = NAN,
                                .fracture_energy = NAN,
                                .horizon_ratio = 3.0,
                                .surface_correction = BW_PD_SURFACE_VOLUME,
                                .volume_fraction = BW_PD_FRACTION_LINEAR,
                                .family_reach = BW_PD_REACH_HALF_CELL,
                                .integrator = BW_PD_VERLET},
                      .load = {.stress = NAN, .rows = 1},
                      .time = {.step = NAN, .end = NAN},
                      .output = {.sample_every = 10, .picture_every = 100}};
}

plate_config crack_case_plate(const crack_case *c)
{
  return (plate_config){.shape = c->shape, .solid = c->solid, .load = c->load, .time = c->time};
}

void plate_describe(const plate *p, bw_log *log)
{
  const plate_solid *s = &p->config.solid;
  bw_log_info(log, "%lld particles of %g m, horizon %g m, %lld bonds",
              (long long)bw_pd_bond_total(p->solid), p->ds, bw_pd_bond_horizon(p->solid),
              (long long)bw_pd_bond_account(p->solid).bonds);
  bw_log_info(log, "bonds break at a stretch of %.4g; sound travels at %.0f m/s (sqrt(E/rho))",
              bw_pd_bond_critical_stretch(p->solid), sqrt(s->young_modulus / s->density));
  bw_log_info(log, "time step %g s of at most %.3g s, %.0f steps", p->config.time.step,
              bw_pd_bond_dt_max(p->solid), ceil(p->config.time.end / p->config.time.step - 1e-9));
}

static const double WINDOW = 2e-6; /* [s] of the speed in the history, as in ADAPT 6.1 */
enum { COLUMNS = 9 };
static const char *const columns[COLUMNS] = {
    "time[s]",    "crack_tip_x[m]", "tip_speed_2us[m/s]", "broken_bonds[-]", "kinetic[J]",
    "elastic[J]", "fracture[J]",    "external[J]",        "residual[J]"};

bw_status plate_open_history(const plate *p, const bw_case *run, bw_history **out)
{
  char *path = NULL;
  bw_status st = bw_case_path(run, "history.csv", &path);
  BW_THEN(st, bw_history_create(p->comm, path, COLUMNS, columns, NAN, out));
  bw_release(&path);
  return st;
}

void plate_sample(plate *p, bw_history *history)
{
  const bw_pd_bond_ledger e = bw_pd_bond_account(p->solid);
  const double spent = e.kinetic + e.elastic + e.fracture + e.damping;
  const double speed = bw_pd_crack_speed_at(&p->track, WINDOW, p->time);
  const double row[COLUMNS] = {p->time,   p->crack.tip, speed,      (double)e.broken,  e.kinetic,
                               e.elastic, e.fracture,   e.external, e.external - spent};
  bw_history_append(history, row);
}

static bw_status write_particles(plate *p, const char *path)
{
  double *X = NULL, *U = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * p->n);
  BW_THEN(st, BW_ALLOCATE(&U, 3 * p->n));
  st = bw_comm_agree(p->comm, st);
  if (st == BW_OK) {
    bw_pd_bond_get_position(p->solid, X);
    bw_pd_bond_get_damage(p->solid, p->damage);
    for (size_t i = 0; i < 3 * p->n; i++)
      U[i] = X[i] - p->X0[i];
    const bw_vtk_array arrays[] = {{"damage", BW_VTK_FLOAT64, 1, p->damage},
                                   {"displacement", BW_VTK_FLOAT64, 3, U}};
    st = bw_vtk_write_points(p->comm, path, p->n, X, 2, arrays);
  }
  bw_release(&X);
  bw_release(&U);
  return st;
}

bw_status plate_picture(plate *p, const bw_case *run)
{
  char name[64], *path = NULL, *series = NULL;
  snprintf(name, sizeof name, "damage-%06lld.vtp", (long long)p->steps);
  bw_status st = bw_case_path(run, name, &path);
  BW_THEN(st, bw_case_path(run, "damage.pvd", &series));
  BW_THEN(st, write_particles(p, path));
  BW_THEN(st, bw_vtk_series_add(p->comm, series, p->time, name));
  bw_release(&path);
  bw_release(&series);
  return st;
}

static const char *or_never(double x, char text[16])
{
  if (isnan(x))
    snprintf(text, 16, "(never)");
  else
    snprintf(text, 16, "%.2f", x);
  return text;
}

bw_status plate_summary(plate *p, bw_log *log)
{
  const plate_crack *c = &p->crack;
  const double notch = p->config.shape.notch, length = p->config.shape.length;
  int branches = 0;
  double fork = NAN;
  char text[3][16];
  BW_TRY(plate_branches(p, 0.5 * (c->tip + (c->tip < length ? notch : length)), &branches, &fork));
  if (!isnan(fork)) BW_TRY(plate_branches(p, 0.5 * (fork + c->tip), &branches, &fork));
  bw_log_info(log, "first bond broken %s us, crack leaves the notch %s us, at the edge %s us",
              or_never(1e6 * c->t_first, text[0]), or_never(1e6 * c->t_start, text[1]),
              or_never(1e6 * c->t_edge, text[2]));
  bw_log_info(log, "branches %d, forks %s mm past the notch, first seen %s us", branches,
              or_never(1e3 * (fork - notch), text[0]), or_never(1e6 * c->t_branch, text[1]));
  const double stop = isnan(c->t_edge) ? p->time : c->t_edge;
  bw_log_info(log, "tip speed at most %.0f m/s over 2 us, %.0f over 4 us, mean %s m/s",
              plate_speed(p, 2e-6), plate_speed(p, 4e-6),
              or_never((c->tip - p->notch_tip) / (stop - c->t_start), text[0]));
  return BW_OK;
}
