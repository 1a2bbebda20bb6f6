/* The state of a coupled run: remembered in memory, written to and read from checkpoints. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "rigid_joined.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

enum { N_FIELDS = 4 };
static const char memory_name[] = "solid/memory_of_forcing", body_name[] = "solid/body";
static const char more_work_name[] = "solid/work_of_load";
static const char film_name[] = "solid/film_edge", film_work_name[] = "solid/work_of_films";
static const char brought_name[] = "solid/film_brought";
static const char felt_name[] = "solid/load_felt", lag_name[] = "solid/ahead_of_told";
static const char choice_name[] = "solid/relaxation_chosen";
static const char load_name[] = "solid/load_carried_over", old_load_name[] = "solid/load";
static const char *const field_name[N_FIELDS] = {"fluid/u", "fluid/v", "fluid/w", "fluid/p"};

void bw_coupler__state_release(bw_coupler__state *s)
{
  for (int q = 0; q < N_FIELDS; q++)
    bw_release(&s->field[q]);
  bw_release(&s->rows);
  bw_release(&s->bits);
  bw_release(&s->V_before);
  bw_release(&s->F);
  bw_release(&s->felt);
  bw_release(&s->lag);
  bw_release(&s->M);
  bw_release(&s->bodies);
  bw_release(&s->edge);
  bw_release(&s->carried);
  s->filled = false;
}

static void list_fields(const bw_coupler *c, bw_real *field[N_FIELDS])
{
  bw_real *const *u = bw_ns_channel_velocity(c->fluid);
  for (int d = 0; d < 3; d++)
    field[d] = u[d];
  field[3] = bw_ns_channel_pressure(c->fluid);
}

bw_status bw_coupler__state_create_solid(const bw_coupler *c, bw_coupler__state *s)
{
  BW_TRY(BW_ALLOCATE(&s->rows, bw_solid_restart_row(c->solid) * c->n));
  BW_TRY(BW_ALLOCATE(&s->bits, c->n * bw_solid_bits_bytes(c->solid)));
  BW_TRY(BW_ALLOCATE(&s->V_before, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&s->F, 3 * c->n));
  if (c->felt != NULL) BW_TRY(BW_ALLOCATE(&s->felt, 3 * c->n));
  if (c->lag != NULL) BW_TRY(BW_ALLOCATE(&s->lag, 3 * c->n));
  BW_TRY(bw_coupler__joined_room(c, &s->bodies));
  if (c->films != NULL) {
    BW_TRY(BW_ALLOCATE(&s->edge, c->n));
    BW_TRY(BW_ALLOCATE(&s->carried, c->n));
  }
  return BW_ALLOCATE(&s->M, 3 * c->n);
}

bw_status bw_coupler__state_create(const bw_coupler *c, bw_coupler__state *s)
{
  bw_real *field[N_FIELDS];
  list_fields(c, field);
  /* In two dimensions there is no w. */
  for (int q = 0; q < N_FIELDS; q++)
    if (field[q] != NULL) BW_TRY(bw_field_create(bw_ns_channel_grid(c->fluid), &s->field[q]));
  return bw_coupler__state_create_solid(c, s);
}

void bw_coupler__state_capture_solid(const bw_coupler *c, bw_coupler__state *s)
{
  /* Motion and ledger as its restart wants them, and which bonds hold. */
  bw_solid_get_restart(c->solid, s->rows, s->sums);
  bw_solid_get_bits(c->solid, s->bits);
  /* The relaxed load and the velocity before belong to the state: both act in the next step. */
  memcpy(s->V_before, c->V_before, 3 * c->n * sizeof *s->V_before);
  memcpy(s->F, c->F, 3 * c->n * sizeof *s->F);
  memcpy(s->M, c->M, 3 * c->n * sizeof *s->M);
  if (c->felt != NULL) memcpy(s->felt, c->felt, 3 * c->n * sizeof *s->felt);
  if (c->lag != NULL) memcpy(s->lag, c->lag, 3 * c->n * sizeof *s->lag);
  bw_coupler__joined_capture(c, s->bodies);
  if (c->films != NULL) {
    memcpy(s->edge, bw_coupler__solid_films_edge(c), c->n * sizeof *s->edge);
    memcpy(s->carried, bw_coupler__solid_films_carried(c), c->n * sizeof *s->carried);
  }
}

void bw_coupler__state_capture(const bw_coupler *c, bw_coupler__state *s)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_real *field[N_FIELDS];
  /* Fields with their halos, so that nothing has to be exchanged on the way back. */
  list_fields(c, field);
  for (int q = 0; q < N_FIELDS; q++)
    if (field[q] != NULL) memcpy(s->field[q], field[q], g->size * sizeof *field[q]);
  /* What else the fluid goes on from: time, and the gradient of a constant flow rate. */
  s->fluid_numbers[0] = bw_ns_channel_time(c->fluid);
  s->fluid_numbers[1] = bw_ns_channel_gradient(c->fluid);
  /* Work is kept as the sum of all ranks, which a restart may divide otherwise. */
  const double work[BW_COUPLER__WORKS] = {c->work.given, c->work.late, c->work.loaded,
                                          c->work.received, c->work.film};
  memcpy(s->work, work, sizeof work);
  bw_comm_sum(bw_solid_comm(c->solid), BW_COUPLER__WORKS, s->work);
  bw_coupler__state_capture_solid(c, s);
  bw_coupler__get_choice(c, s->choice);
  s->filled = true;
}

/* All ranks have room to keep a state, or none has. */
static bw_status make_room(bw_coupler *c)
{
  if (c->kept.rows != NULL) return BW_OK;
  const bw_status st = bw_comm_agree(bw_grid_comm(bw_ns_channel_grid(c->fluid)),
                                     bw_coupler__state_create(c, &c->kept));
  if (st != BW_OK) bw_coupler__state_release(&c->kept);
  return st;
}

bw_status bw_coupler_keep(bw_coupler *c)
{
  BW_TRY(make_room(c));
  bw_coupler__state_capture(c, &c->kept);
  return BW_OK;
}

/* Which body it is: how many particles, and its fingerprint in two halves, which doubles hold. */
static void body_numbers(const bw_coupler *c, double numbers[3])
{
  const uint64_t print = bw_solid_fingerprint(c->solid);
  numbers[0] = (double)bw_solid_total(c->solid);
  numbers[1] = (double)(print >> 32);
  numbers[2] = (double)(print & UINT32_MAX);
}

static bw_status same_body(const bw_coupler *c, bw_checkpoint *ck)
{
  double here[3], there[3];
  body_numbers(c, here);
  BW_TRY(bw_checkpoint_get_numbers(ck, body_name, 3, there));
  BW_REQUIRE(memcmp(here, there, sizeof here) == 0, BW_EINPUT,
             "coupler: the checkpoint is of another solid: %.0f particles there, %.0f here, or at "
             "other places; build the one that it was written with",
             there[0], here[0]);
  return BW_OK;
}

static bw_status write_state(const bw_coupler *c, const bw_coupler__state *s, bw_checkpoint *ck)
{
  const bw_grid *grid = bw_ns_channel_grid(c->fluid);
  const int64_t total = bw_solid_total(c->solid), *id = bw_solid_id(c->solid);
  double body[3];
  body_numbers(c, body);
  BW_TRY(bw_checkpoint_put_numbers(ck, body_name, 3, body));
  /* Fields by global cells, particles by id: any number of ranks can read them. */
  for (int q = 0; q < N_FIELDS; q++)
    if (s->field[q] != NULL)
      BW_TRY(bw_checkpoint_put_field(ck, field_name[q], grid, q % 3, q < 3, s->field[q]));
  BW_TRY(bw_checkpoint_put_numbers(ck, "fluid/time_and_gradient", 2, s->fluid_numbers));
  BW_TRY(bw_checkpoint_put_numbers(ck, "solid/sums", BW_SOLID_RESTART_SUMS, s->sums));
  BW_TRY(bw_checkpoint_put_numbers(ck, "solid/work_of_fluid", 2, s->work));
  BW_TRY(bw_checkpoint_put_numbers(ck, more_work_name, 2, s->work + 2));
  BW_TRY(bw_checkpoint_put_numbers(ck, choice_name, BW_COUPLER__CHOICE, s->choice));
  /* Everything of the particles, as rows. */
  BW_TRY(bw_checkpoint_put_table(ck, "solid/rows", total, c->n, id,
                                 (int)bw_solid_restart_row(c->solid), BW_CK_DOUBLE, s->rows));
  BW_TRY(
      bw_checkpoint_put_table(ck, "solid/V_before", total, c->n, id, 3, BW_CK_DOUBLE, s->V_before));
  BW_TRY(bw_checkpoint_put_table(ck, load_name, total, c->n, id, 3, BW_CK_DOUBLE, s->F));
  if (c->config.predictor) {
    BW_TRY(bw_checkpoint_put_table(ck, felt_name, total, c->n, id, 3, BW_CK_DOUBLE, s->felt));
    BW_TRY(bw_checkpoint_put_table(ck, lag_name, total, c->n, id, 3, BW_CK_DOUBLE, s->lag));
  }
  BW_TRY(bw_checkpoint_put_table(ck, memory_name, total, c->n, id, 3, BW_CK_DOUBLE, s->M));
  if (c->films != NULL) {
    BW_TRY(bw_checkpoint_put_table(ck, film_name, total, c->n, id, 1, BW_CK_DOUBLE, s->edge));
    BW_TRY(bw_checkpoint_put_table(ck, brought_name, total, c->n, id, 1, BW_CK_DOUBLE, s->carried));
    BW_TRY(bw_checkpoint_put_numbers(ck, film_work_name, 1, s->work + 4));
  }
  return bw_checkpoint_put_table(ck, "solid/bonds", total, c->n, id,
                                 (int)bw_solid_bits_bytes(c->solid), BW_CK_UINT8, s->bits);
}

static bw_status read_state(const bw_coupler *c, bw_coupler__state *s, bw_checkpoint *ck)
{
  const bw_grid *grid = bw_ns_channel_grid(c->fluid);
  const int64_t total = bw_solid_total(c->solid), *id = bw_solid_id(c->solid);
  BW_TRY(same_body(c, ck));
  /* The mirror image of write_state, in the same order. */
  for (int q = 0; q < N_FIELDS; q++)
    if (s->field[q] != NULL)
      BW_TRY(bw_checkpoint_get_field(ck, field_name[q], grid, q % 3, q < 3, s->field[q]));
  BW_TRY(bw_checkpoint_get_numbers(ck, "fluid/time_and_gradient", 2, s->fluid_numbers));
  BW_TRY(bw_checkpoint_get_numbers(ck, "solid/sums", BW_SOLID_RESTART_SUMS, s->sums));
  BW_TRY(bw_checkpoint_get_numbers(ck, "solid/work_of_fluid", 2, s->work));
  s->work[2] = s->work[3] = s->work[4] = 0.0;
  if (bw_checkpoint_has(ck, more_work_name))
    BW_TRY(bw_checkpoint_get_numbers(ck, more_work_name, 2, s->work + 2));
  s->choice[0] = 0.0;
  if (bw_checkpoint_has(ck, choice_name))
    BW_TRY(bw_checkpoint_get_numbers(ck, choice_name, BW_COUPLER__CHOICE, s->choice));
  /* Rows find their particles by id. */
  BW_TRY(bw_checkpoint_get_table(ck, "solid/rows", total, c->n, id,
                                 (int)bw_solid_restart_row(c->solid), BW_CK_DOUBLE, s->rows));
  BW_TRY(
      bw_checkpoint_get_table(ck, "solid/V_before", total, c->n, id, 3, BW_CK_DOUBLE, s->V_before));
  /* Older files have the load itself, all but w of which is taken over. */
  const bool old = !bw_checkpoint_has(ck, load_name);
  BW_TRY(bw_checkpoint_get_table(ck, old ? old_load_name : load_name, total, c->n, id, 3,
                                 BW_CK_DOUBLE, s->F));
  for (size_t i = 0; old && i < 3 * c->n; i++)
    s->F[i] *= 1.0 - c->config.load_relaxation;
  /* Files of runs without a predictor tell the load but for what is new in a step. */
  if (c->felt != NULL) memcpy(s->felt, s->F, 3 * c->n * sizeof *s->felt);
  if (c->lag != NULL) memset(s->lag, 0, 3 * c->n * sizeof *s->lag);
  if (c->config.predictor && bw_checkpoint_has(ck, felt_name)) {
    BW_TRY(bw_checkpoint_get_table(ck, felt_name, total, c->n, id, 3, BW_CK_DOUBLE, s->felt));
    BW_TRY(bw_checkpoint_get_table(ck, lag_name, total, c->n, id, 3, BW_CK_DOUBLE, s->lag));
  }
  /* Files from before the memory go on without: it fills within some steps. */
  memset(s->M, 0, 3 * c->n * sizeof *s->M);
  if (bw_checkpoint_has(ck, memory_name))
    BW_TRY(bw_checkpoint_get_table(ck, memory_name, total, c->n, id, 3, BW_CK_DOUBLE, s->M));
  /* Films that begin with the restart know no pressure yet. */
  for (size_t i = 0; c->films != NULL && i < c->n; i++)
    s->edge[i] = NAN, s->carried[i] = 0.0;
  /* Particles that lost a bond had no memory, where what flows in films was not the grid's. */
  for (size_t i = 0; c->config.films.flux && i < 3 * c->n; i++)
    if (isnan(s->M[i])) s->M[i] = 0.0;
  if (c->films != NULL && bw_checkpoint_has(ck, film_name)) {
    BW_TRY(bw_checkpoint_get_table(ck, film_name, total, c->n, id, 1, BW_CK_DOUBLE, s->edge));
    BW_TRY(bw_checkpoint_get_numbers(ck, film_work_name, 1, s->work + 4));
  }
  if (c->films != NULL && bw_checkpoint_has(ck, brought_name))
    BW_TRY(bw_checkpoint_get_table(ck, brought_name, total, c->n, id, 1, BW_CK_DOUBLE, s->carried));
  return bw_checkpoint_get_table(ck, "solid/bonds", total, c->n, id,
                                 (int)bw_solid_bits_bytes(c->solid), BW_CK_UINT8, s->bits);
}

bw_status bw_coupler__state_restore_solid(bw_coupler *c, const bw_coupler__state *s)
{
  /* The solid goes on to the same bits; the load that acts on it is part of what follows. */
  BW_TRY(bw_solid_set_bits(c->solid, s->bits));
  BW_TRY(bw_solid_set_restart(c->solid, s->rows, s->sums));
  memcpy(c->V_before, s->V_before, 3 * c->n * sizeof *s->V_before);
  memcpy(c->F, s->F, 3 * c->n * sizeof *s->F);
  memcpy(c->M, s->M, 3 * c->n * sizeof *s->M);
  if (c->felt != NULL) memcpy(c->felt, s->felt, 3 * c->n * sizeof *s->felt);
  if (c->lag != NULL) memcpy(c->lag, s->lag, 3 * c->n * sizeof *s->lag);
  if (c->films != NULL) {
    memcpy(bw_coupler__solid_films_edge(c), s->edge, c->n * sizeof *s->edge);
    memcpy(bw_coupler__solid_films_carried(c), s->carried, c->n * sizeof *s->carried);
  }
  return bw_coupler__joined_restore(c, bw_ns_channel_time(c->fluid), s->bodies);
}

bw_status bw_coupler__state_restore(bw_coupler *c, const bw_coupler__state *s)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(c->fluid));
  bw_real *field[N_FIELDS];
  list_fields(c, field);
  for (int q = 0; q < N_FIELDS; q++)
    if (field[q] != NULL) memcpy(field[q], s->field[q], g->size * sizeof *field[q]);
  /* Numbers before refresh, which makes halos and the Courant number of this time. */
  bw_ns_channel_set_time(c->fluid, s->fluid_numbers[0]);
  bw_ns_channel_set_gradient(c->fluid, s->fluid_numbers[1]);
  bw_ns_channel_refresh(c->fluid);
  /* Nothing that was derived from the other state may be used. */
  c->p_mean_known = c->stepped = c->motion_known = false;
  return bw_coupler__state_restore_solid(c, s);
}

bw_status bw_coupler_save(bw_coupler *c, bw_checkpoint *ck)
{
  BW_TRY(bw_coupler_keep(c));
  return write_state(c, &c->kept, ck);
}

bw_status bw_coupler_save_kept(bw_coupler *c, bw_checkpoint *ck)
{
  BW_REQUIRE(c->kept.filled, BW_EINPUT, "coupler: no state has been kept that could be saved");
  return write_state(c, &c->kept, ck);
}

bw_status bw_coupler_load(bw_coupler *c, bw_checkpoint *ck)
{
  const bw_comm *comm = bw_grid_comm(bw_ns_channel_grid(c->fluid));
  BW_TRY(make_room(c));
  /* Read as a whole first: a bad file leaves fluid and solid as they were. */
  BW_TRY(read_state(c, &c->kept, ck));
  bw_coupler__joined_capture(c, c->kept.bodies); /* whoever saved the bodies sets them later */
  c->kept.filled = true;
  /* Work was saved as the sum of all ranks: one of them gets it. */
  const double own = bw_comm_rank(comm) == 0 ? 1.0 : 0.0;
  c->work = (bw_coupler__work){own * c->kept.work[0], own * c->kept.work[1], own * c->kept.work[2],
                               own * c->kept.work[3], own * c->kept.work[4]};
  memset(c->book.window, 0, sizeof c->book.window); /* windows begin anew */
  c->book.steps = 0;
  bw_coupler__adopt_choice(c, c->kept.choice);
  BW_TRY(bw_coupler__state_restore(c, &c->kept));
  c->steps = BW_COUPLER__START;
  /* The surface follows from bonds and places. */
  return bw_coupler__follow_surface(c);
}
