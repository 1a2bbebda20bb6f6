/* The objects of a box flow, its start, an interval of it, checkpoints. */
#include "box_case.h"
#include "bw_checkpoint.h"
#include "bw_memory.h"

#include <math.h>

bw_status box_create(box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                     const bw_ns_channel_config *fluid)
{
  const char *path = b->config->domain.faces;
  bw_grid_config g = *grid;
  double *faces = NULL;
  /* A table of faces takes the place of the stretching. */
  if (path[0] != 0) {
    BW_TRY(bw_grid_read_table(comm, path, g.n[1], g.length[1], &faces));
    g.y_stretch = BW_STRETCH_TABLE, g.y_table = faces;
  }
  const bw_status st = bw_grid_create(comm, &g, &b->grid);
  bw_release(&faces);
  BW_TRY(st);
  return bw_ns_channel_create(b->grid, fluid, &b->fluid);
}

void box_destroy(box_run *b)
{
  bw_ns_channel_destroy(&b->fluid);
  bw_grid_destroy(&b->grid);
}

int64_t box_intervals(const box_config *c)
{
  return llround(c->time.end / c->output.sample_every);
}

/* The uniform velocity and vortices u_theta = swirl s exp((1 - s^2)/2), s = r/radius. */
static void start_velocity(const double x[3], double t, void *context, double u[3])
{
  const box_start *start = context;
  (void)t;
  for (int d = 0; d < 3; d++)
    u[d] = start->velocity[d];
  /* Vortices are added; the solver projects the sum. */
  for (int q = 0; q < start->n_vortices; q++) {
    const box_vortex *v = &start->vortices[q];
    const double a = (x[0] - v->centre[0]) / v->radius, b = (x[1] - v->centre[1]) / v->radius;
    const double f = v->swirl * exp(0.5 * (1.0 - a * a - b * b));
    u[0] -= b * f;
    u[1] += a * f;
  }
}

bw_status box_start_field(box_run *b)
{
  box_start start = b->config->start;
  return bw_ns_channel_set_velocity(b->fluid, start_velocity, &start, 0.0);
}

/* The last step of an interval ends on its end to the last bit. */
bw_status box_advance(box_run *b)
{
  const box_time *time = &b->config->time;
  const double end = (double)(b->intervals + 1) * b->config->output.sample_every;
  for (int64_t left = 1; left > 0; left--, b->steps++) {
    const double span = end - bw_ns_channel_time(b->fluid);
    const double longest =
        isnan(time->step) ? time->limit_share * bw_ns_channel_dt_max(b->fluid) : time->step;
    /* at least one: at rest an implicit viscous term sets no limit */
    /* As few steps as the limit allows, of equal length over what is left. */
    left = (int64_t)fmax(1.0, ceil(span / longest * (1.0 - 1e-12)));
    b->dt = span / (double)left;
    BW_TRY(bw_ns_channel_step(b->fluid, b->dt));
  }
  b->intervals++;
  /* Exactly the end: rounding does not add up over intervals. */
  bw_ns_channel_set_time(b->fluid, end);
  return BW_OK;
}

/* ---- checkpoints ---- */
enum { FIELDS = 4, NUMBERS = 5 };
static const char *const field_name[FIELDS] = {"fluid/u", "fluid/v", "fluid/w", "fluid/p"};

static void list_fields(const box_run *b, bw_real *field[FIELDS])
{
  for (int d = 0; d < 3; d++)
    field[d] = bw_ns_channel_velocity(b->fluid)[d];
  field[3] = bw_ns_channel_pressure(b->fluid);
}

bw_status box_checkpoint(box_run *b)
{
  const double numbers[NUMBERS] = {(double)b->intervals, (double)b->steps,
                                   b->config->output.sample_every, bw_ns_channel_gradient(b->fluid),
                                   b->dt};
  bw_real *field[FIELDS];
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  list_fields(b, field);
  bw_status st = bw_case_path(b->run, "checkpoint.h5", &path);
  BW_THEN(st, bw_checkpoint_create(bw_grid_comm(b->grid), path, &ck));
  BW_THEN(st, bw_checkpoint_put_text(ck, "case/name", "box_flow"));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "case/progress", NUMBERS, numbers));
  /* w does not exist in two dimensions. */
  for (int q = 0; q < FIELDS && st == BW_OK; q++)
    if (field[q] != NULL)
      st = bw_checkpoint_put_field(ck, field_name[q], b->grid, q % 3, q < 3, field[q]);
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  bw_release(&path);
  return st;
}

bw_status box_restart(box_run *b, const char *path)
{
  double numbers[NUMBERS];
  bw_real *field[FIELDS];
  bw_checkpoint *ck = NULL;
  list_fields(b, field);
  BW_TRY(bw_checkpoint_open(bw_grid_comm(b->grid), path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "case/progress", NUMBERS, numbers);
  /* Another interval would mean other steps. */
  if (st == BW_OK && numbers[2] != b->config->output.sample_every)
    st = BW_FAIL(BW_EINPUT, "%s was written with output.sample_every = %g, not %g; keep it", path,
                 numbers[2], b->config->output.sample_every);
  for (int q = 0; q < FIELDS && st == BW_OK; q++)
    if (field[q] != NULL)
      st = bw_checkpoint_get_field(ck, field_name[q], b->grid, q % 3, q < 3, field[q]);
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  if (st != BW_OK) return st;
  /* Fields are read; numbers and halos complete the state. */
  b->intervals = (int64_t)numbers[0], b->steps = (int64_t)numbers[1], b->dt = numbers[4];
  bw_ns_channel_set_gradient(b->fluid, numbers[3]);
  bw_ns_channel_set_time(b->fluid, numbers[0] * numbers[2]);
  bw_ns_channel_refresh(b->fluid);
  return BW_OK;
}
