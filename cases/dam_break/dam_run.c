/* The fluid of a tank, an interval of it, checkpoints. */
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "bw_number.h"
#include "dam_case.h"

#include <math.h>
#include <string.h>

/* Walls are so many spacings thick, of which the fluid sees three. */
static const double THICK = 4;

/* The tank starts from rest where it was built. */
static void shake(double t, void *context, double x[3], double v[3], double a[3])
{
  const dam_motion *m = context;
  const double w = 2 * acos(-1) / m->period;
  for (int k = 0; k < 3; k++) {
    x[k] = m->amplitude[k] * (cos(w * t) - 1);
    v[k] = -m->amplitude[k] * w * sin(w * t);
    a[k] = -m->amplitude[k] * w * w * cos(w * t);
  }
}

void dam_where(const dam_run *d, double x[3])
{
  double v[3], a[3];
  dam_motion m = d->config->motion;
  memset(x, 0, 3 * sizeof *x);
  if (d->config->has_motion) shake(bw_ulph_time(d->fluid), &m, x, v, a);
}

double dam_dt_max(dam_run *d)
{
  return d->both != NULL ? bw_coupler_particles_dt_max(d->both) : bw_ulph_dt_max(d->fluid);
}

void dam_box_shape(const double lower[3], const double upper[3], bw_shape *shape)
{
  *shape = (bw_shape){.kind = BW_SHAPE_BOX};
  memcpy(shape->lower, lower, sizeof shape->lower);
  memcpy(shape->upper, upper, sizeof shape->upper);
}

/* Water at rest below the top of its box. */
static void hydrostatic(const double x[3], void *context, double v[3], double *p)
{
  const dam_config *c = context;
  v[0] = v[1] = v[2] = *p = 0;
  for (int q = 0; q < c->n_water; q++) {
    const dam_box *b = &c->water[q];
    bool inside = true;
    for (int k = 0; k < (c->tank.size[2] > 0 ? 3 : 2); k++)
      inside = inside && x[k] >= b->lower[k] && x[k] < b->upper[k];
    if (inside) *p = c->fluid.density * c->fluid.gravity * (b->upper[1] - x[1]);
  }
}

bw_status dam_create(dam_run *d, const bw_ulph_config *fluid)
{
  const dam_config *c = d->config;
  const double t = THICK * fluid->dx, *size = c->tank.size, origin[3] = {0};
  bw_shape water[2 * DAM_BOXES], blocks[DAM_BOXES];
  int n_water = c->n_water;
  const bw_shape tank[2] = {
      {.lower = {-t, -t, -t}, .upper = {size[0] + t, size[1] + t, size[2] + t}},
      {.upper = {size[0], size[1] + 2 * t, size[2]}, .remove = true}};
  for (int q = 0; q < c->n_water; q++)
    dam_box_shape(c->water[q].lower, c->water[q].upper, &water[q]);
  /* No water where the solid is. */
  for (int q = 0; q < (c->has_solid ? c->solid.n_parts : 0); q++) {
    dam_box_shape(c->solid.parts[q].lower, c->solid.parts[q].upper, &water[n_water]);
    water[n_water++].remove = true;
  }
  for (int q = 0; q < c->n_obstacles; q++)
    dam_box_shape(c->obstacles[q].lower, c->obstacles[q].upper, &blocks[q]);
  /* Blocks that reach into the tank's walls are left to these there. */
  const bw_ulph_wall walls[2] = {
      {.count = 2, .shape = tank, .no_slip = c->tank.no_slip, .moves = c->has_motion},
      {.count = c->n_obstacles,
       .shape = blocks,
       .no_slip = c->tank.no_slip,
       .moves = c->has_motion}};
  bw_ulph_config with = *fluid;
  dam_config copy = *c;
  double *x = NULL;
  size_t n = 0;
  if (c->has_motion) with.motion = shake, with.motion_context = (void *)&c->motion;
  bw_status st = bw_ulph_fill(d->comm, &with, origin, n_water, water, &n, &x);
  const int n_walls = c->n_obstacles > 0 ? 2 : 1;
  BW_THEN(st, bw_ulph_create(d->comm, &with, n, x, n_walls, walls, &d->fluid));
  if (c->has_solid) BW_THEN(st, dam_solid_create(d, &with, n_walls, walls));
  BW_THEN(st, bw_ulph_start(d->fluid, c->hydrostatic ? hydrostatic : NULL, &copy));
  bw_release(&x);
  return st;
}

void dam_destroy(dam_run *d)
{
  bw_coupler_particles_destroy(&d->both);
  bw_ulph_destroy(&d->fluid);
  bw_solid_destroy(&d->solid);
}

int64_t dam_intervals(const dam_config *c)
{
  int64_t intervals = 0;
  /* Checked with the other times. */
  (void)bw_divides(c->time.end, c->output.sample_every, &intervals);
  return intervals;
}

/* Mean pressures are integrals over the interval. */
static void integrate(dam_run *d)
{
  double at[3], lower[3], upper[3];
  dam_where(d, at);
  for (int q = 0; q < d->config->n_gauges; q++) {
    const dam_gauge *g = &d->config->gauges[q];
    if (g->kind != DAM_PRESSURE) continue;
    for (int k = 0; k < 3; k++)
      lower[k] = g->lower[k] + at[k], upper[k] = g->upper[k] + at[k];
    d->pressure[q] += d->dt * bw_ulph_wall_pressure(d->fluid, lower, upper);
  }
  d->covered += d->dt;
}

/* The last step of an interval ends on its end to the last bit. */
bw_status dam_advance(dam_run *d)
{
  const double end = (double)(d->intervals + 1) * d->config->output.sample_every;
  for (double left = 2; left > 1;) {
    const double span = end - bw_ulph_time(d->fluid);
    left = fmax(1, ceil(span / dam_dt_max(d) * (1 - 1e-12)));
    d->dt = span / left;
    BW_TRY(d->both != NULL ? bw_coupler_particles_step(d->both, d->dt)
                           : bw_ulph_step(d->fluid, d->dt));
    integrate(d);
    /* What is left follows from the state, so that a checkpoint may be written here. */
    d->stopped = left > 1 && bw_case_stopping(d->run);
    if (d->stopped) return BW_OK;
  }
  d->intervals++;
  bw_ulph_set_time(d->fluid, end);
  return BW_OK;
}

/* ---- checkpoints ---- */
enum { PROGRESS = 4 };

/* Rows of this rank's particles, and their numbers. */
typedef struct {
  double *rows;
  int64_t *id;
} table;

static bw_status table_make(const bw_comm *comm, size_t n, table *t)
{
  *t = (table){NULL, NULL};
  bw_status st = BW_ALLOCATE(&t->rows, BW_ULPH_ROW * n);
  BW_THEN(st, BW_ALLOCATE(&t->id, n));
  return bw_comm_agree(comm, st);
}

static void table_release(table *t)
{
  bw_release(&t->rows);
  bw_release(&t->id);
}

static bw_status put(dam_run *d, bw_checkpoint *ck, table *t)
{
  const size_t n = bw_ulph_count(d->fluid);
  const double progress[PROGRESS] = {(double)d->intervals, d->dt, d->covered,
                                     (double)bw_history_rows(d->history)};
  double numbers[BW_ULPH_NUMBERS];
  bw_ulph_ids(d->fluid, t->id);
  bw_ulph_state_get(d->fluid, t->rows, numbers);
  BW_TRY(bw_checkpoint_put_case(ck, d->run));
  BW_TRY(bw_checkpoint_put_numbers(ck, "case/progress", PROGRESS, progress));
  BW_TRY(bw_checkpoint_put_numbers(ck, "case/pressure", DAM_GAUGES, d->pressure));
  if (d->both != NULL) return bw_coupler_particles_save(d->both, ck);
  BW_TRY(bw_checkpoint_put_numbers(ck, "fluid/numbers", BW_ULPH_NUMBERS, numbers));
  return bw_checkpoint_put_table(ck, "fluid/rows", bw_ulph_total(d->fluid), n, t->id, BW_ULPH_ROW,
                                 BW_CK_DOUBLE, t->rows);
}

bw_status dam_checkpoint(dam_run *d)
{
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  table t;
  bw_status st = table_make(d->comm, bw_ulph_count(d->fluid), &t);
  BW_THEN(st, bw_history_sync(d->comm, d->history));
  BW_THEN(st, bw_case_path(d->run, "checkpoint.h5", &path));
  BW_THEN(st, bw_checkpoint_create(d->comm, path, &ck));
  BW_THEN(st, put(d, ck, &t));
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  table_release(&t);
  return st;
}

static bw_status get(dam_run *d, bw_checkpoint *ck, size_t n, table *t, const char *path)
{
  double progress[PROGRESS], numbers[BW_ULPH_NUMBERS];
  BW_TRY(bw_checkpoint_get_numbers(ck, "case/progress", PROGRESS, progress));
  BW_TRY(bw_checkpoint_get_numbers(ck, "case/pressure", DAM_GAUGES, d->pressure));
  BW_REQUIRE(bw_to_int64(progress[0], &d->intervals) && bw_to_int64(progress[3], &d->rows),
             BW_EINPUT, "%s: 'case/progress' holds numbers that no run has", path);
  d->dt = progress[1], d->covered = progress[2];
  if (d->both != NULL) return bw_coupler_particles_restore(d->both, ck);
  BW_TRY(bw_checkpoint_get_numbers(ck, "fluid/numbers", BW_ULPH_NUMBERS, numbers));
  BW_TRY(bw_checkpoint_get_table(ck, "fluid/rows", bw_ulph_total(d->fluid), n, t->id, BW_ULPH_ROW,
                                 BW_CK_DOUBLE, t->rows));
  return bw_ulph_state_set(d->fluid, n, t->id, t->rows, numbers);
}

bw_status dam_restart(dam_run *d, const char *path)
{
  const int64_t total = bw_ulph_total(d->fluid), size = bw_comm_size(d->comm);
  const int64_t first = total * bw_comm_rank(d->comm) / size;
  const size_t n = (size_t)(total * (bw_comm_rank(d->comm) + 1) / size - first);
  bw_checkpoint *ck = NULL;
  table t;
  /* Any division will do: the fluid sends particles where they belong. */
  bw_status st = table_make(d->comm, n, &t);
  for (size_t i = 0; i < n && st == BW_OK; i++)
    t.id[i] = first + (int64_t)i;
  BW_THEN(st, bw_checkpoint_open(d->comm, path, &ck));
  BW_THEN(st, get(d, ck, n, &t, path));
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  table_release(&t);
  return st;
}
