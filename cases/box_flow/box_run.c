/* The objects of a box flow, its start, an interval of it, checkpoints. */
#include "box_case.h"
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "bw_number.h"

#include <math.h>

typedef bw_status grid_maker(const bw_comm *, const bw_grid_config *, bw_grid **);

/* A grid made by `make`. A table of faces takes the place of the stretching. */
static bw_status make_grid(const box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                           grid_maker *make, bw_grid **out)
{
  const char *path = b->config->domain.faces;
  bw_grid_config g = *grid;
  double *faces = NULL;
  if (path[0] != 0) {
    BW_TRY(bw_grid_read_table(comm, path, g.n[1], g.length[1], &faces));
    g.y_stretch = BW_STRETCH_TABLE, g.y_table = faces;
  }
  const bw_status st = make(comm, &g, out);
  bw_release(&faces);
  return st;
}

bw_status box_plan(const box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                   bw_grid **plan)
{
  return make_grid(b, comm, grid, bw_grid_plan, plan);
}

bw_status box_create(box_run *b, const bw_comm *comm, const bw_grid_config *grid,
                     const bw_ns_channel_config *fluid)
{
  BW_TRY(make_grid(b, comm, grid, bw_grid_create, &b->grid));
  return bw_ns_channel_create(b->grid, fluid, &b->fluid);
}

void box_destroy(box_run *b)
{
  bw_ns_channel_destroy(&b->fluid);
  bw_grid_destroy(&b->grid);
}

int64_t box_intervals(const box_config *c)
{
  int64_t intervals = 0;
  /* Checked with the other times. */
  (void)bw_divides(c->time.end, c->output.sample_every, &intervals);
  return intervals;
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

/* As few steps as the limit allows, of equal length over what is left of the interval; at least
 * one, as the interval may be short. */
static bw_status steps_left(const box_run *b, double span, int64_t *left)
{
  const box_time *time = &b->config->time;
  const double now = bw_ns_channel_time(b->fluid);
  const double longest =
      isnan(time->step) ? time->limit_share * bw_ns_channel_dt_max(b->fluid) : time->step;
  const double count = fmax(1.0, ceil(span / longest * (1.0 - 1e-12)));
  /* A flow that has become so fast has diverged, whatever its numbers are. */
  BW_REQUIRE(
      bw_to_int64(count, left) && *left <= BW_MOST_STEPS && now + span / count > now, BW_EDIVERGED,
      "at t = %g the largest stable step is %.3g: %.3g steps to the next row of history.csv; "
      "the velocities are too large for the cells",
      now, longest, count);
  return BW_OK;
}

/* The last step of an interval ends on its end to the last bit. */
bw_status box_advance(box_run *b)
{
  const double end = (double)(b->intervals + 1) * b->config->output.sample_every;
  for (int64_t left = 2; left > 1;) {
    const double span = end - bw_ns_channel_time(b->fluid);
    BW_TRY(steps_left(b, span, &left));
    b->dt = span / (double)left;
    BW_TRY(bw_ns_channel_step(b->fluid, b->dt));
    b->steps++;
    /* What is left follows from field and time, so that a checkpoint may be written here. */
    b->stopped = left > 1 && bw_case_stopping(b->run);
    if (b->stopped) return BW_OK;
  }
  b->intervals++;
  /* Exactly the end: rounding does not add up over intervals. */
  bw_ns_channel_set_time(b->fluid, end);
  return BW_OK;
}

/* ---- checkpoints ---- */
enum { FIELDS = 4, NUMBERS = 6 };
static const char *const field_name[FIELDS] = {"fluid/u", "fluid/v", "fluid/w", "fluid/p"};

static void list_fields(const box_run *b, bw_real *field[FIELDS])
{
  for (int d = 0; d < 3; d++)
    field[d] = bw_ns_channel_velocity(b->fluid)[d];
  field[3] = bw_ns_channel_pressure(b->fluid);
}

bw_status box_checkpoint(box_run *b)
{
  const double numbers[NUMBERS] = {(double)b->intervals,
                                   (double)b->steps,
                                   bw_ns_channel_gradient(b->fluid),
                                   b->dt,
                                   bw_ns_channel_time(b->fluid),
                                   (double)bw_history_rows(b->history)};
  bw_real *field[FIELDS];
  char *path = NULL;
  bw_checkpoint *ck = NULL;
  list_fields(b, field);
  bw_status st = bw_history_sync(bw_grid_comm(b->grid), b->history);
  BW_THEN(st, bw_case_path(b->run, "checkpoint.h5", &path));
  BW_THEN(st, bw_checkpoint_create(bw_grid_comm(b->grid), path, &ck));
  BW_THEN(st, bw_checkpoint_put_case(ck, b->run));
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
  for (int q = 0; q < FIELDS && st == BW_OK; q++)
    if (field[q] != NULL)
      st = bw_checkpoint_get_field(ck, field_name[q], b->grid, q % 3, q < 3, field[q]);
  if (st == BW_OK) st = bw_checkpoint_close(&ck);
  bw_checkpoint_abandon(&ck);
  if (st != BW_OK) return st;
  /* Fields are read; numbers and halos complete the state. */
  BW_REQUIRE(bw_to_int64(numbers[0], &b->intervals) && bw_to_int64(numbers[1], &b->steps) &&
                 bw_to_int64(numbers[5], &b->rows),
             BW_EINPUT, "%s: 'case/progress' holds numbers that no run has", path);
  b->dt = numbers[3];
  bw_ns_channel_set_gradient(b->fluid, numbers[2]);
  bw_ns_channel_set_time(b->fluid, numbers[4]);
  bw_ns_channel_refresh(b->fluid);
  return BW_OK;
}
