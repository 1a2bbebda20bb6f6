/* The state of a scene in a checkpoint. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_number.h"
#include "bw_solid_levels.h"
#include <limits.h>
#include <math.h>

enum { NUMBERS = 7, FIELDS = 4 };
static const char *const field_name[FIELDS] = {"fluid/u", "fluid/v", "fluid/w", "fluid/p"};

static void list_fields(bw_scene *s, bw_real *field[FIELDS])
{
  for (int d = 0; d < 3; d++)
    field[d] = bw_ns_channel_velocity(s->fluid)[d];
  field[3] = bw_ns_channel_pressure(s->fluid);
}

static bw_status save_fluid(bw_scene *s, bw_checkpoint *ck)
{
  bw_real *field[FIELDS];
  const double gradient = bw_ns_channel_gradient(s->fluid);
  list_fields(s, field);
  for (int q = 0; q < FIELDS; q++)
    if (field[q] != NULL)
      BW_TRY(bw_checkpoint_put_field(ck, field_name[q], s->grid, q % 3, q < 3, field[q]));
  BW_TRY(bw_checkpoint_put_numbers(ck, "fluid/gradient", 1, &gradient));
  if (s->markers == NULL) return BW_OK;
  /* What markers remember; all of them are on rank 0. */
  double count = (double)s->inner.n;
  bw_comm_sum(s->comm, 1, &count);
  bw_ibm_mdf_memory(s->markers, s->inner.M);
  return bw_checkpoint_put_numbers(ck, "fluid/memory", 3 * (int)count, s->inner.M);
}

static bw_status restore_fluid(bw_scene *s, bw_checkpoint *ck)
{
  bw_real *field[FIELDS];
  double gradient = 0.0, count = (double)s->inner.n;
  list_fields(s, field);
  for (int q = 0; q < FIELDS; q++)
    if (field[q] != NULL)
      BW_TRY(bw_checkpoint_get_field(ck, field_name[q], s->grid, q % 3, q < 3, field[q]));
  BW_TRY(bw_checkpoint_get_numbers(ck, "fluid/gradient", 1, &gradient));
  bw_ns_channel_set_gradient(s->fluid, gradient);
  bw_ns_channel_set_time(s->fluid, s->time);
  bw_ns_channel_refresh(s->fluid);
  if (s->markers == NULL) return BW_OK;
  bw_comm_sum(s->comm, 1, &count);
  double *M = NULL;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&M, 3 * (size_t)count));
  BW_THEN(st, bw_checkpoint_get_numbers(ck, "fluid/memory", 3 * (int)count, M));
  for (size_t i = 0; st == BW_OK && i < 3 * s->inner.n; i++)
    s->inner.M[i] = M[i];
  bw_release(&M);
  BW_THEN(st, bw_scene__surfaces_restore(s));
  return st;
}

/* The levels of one solid, where they change: before its rows. */
static bw_status levels_state(bw_scene *s, int q, bw_checkpoint *ck, bool read)
{
  bw_solid *solid = s->solid[q].solid;
  const size_t n = bw_solid_levels_numbers(solid);
  char name[48];
  double *state = NULL;
  if (n == 0) return BW_OK;
  snprintf(name, sizeof name, "solid%d/levels", q);
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&state, n));
  if (st == BW_OK && !read) {
    bw_solid_get_levels(solid, state);
    st = bw_checkpoint_put_numbers(ck, name, (int)n, state);
  } else if (st == BW_OK) {
    st = bw_checkpoint_get_numbers(ck, name, (int)n, state);
    BW_THEN(st, bw_solid_set_levels(solid, state));
    BW_THEN(st, bw_scene__solid_renew(s, q));
  }
  bw_release(&state);
  return st;
}

/* Rows, sums and bonds of one solid; `read`: the way back. */
static bw_status solid_state(bw_scene *s, int q, bw_checkpoint *ck, bool read)
{
  BW_TRY(levels_state(s, q, ck, read));
  bw_solid *solid = s->solid[q].solid;
  const size_t n = s->solid[q].n, width = bw_solid_restart_row(solid);
  const size_t bytes = bw_solid_bits_bytes(solid);
  const int64_t total = bw_solid_total(solid), *id = bw_solid_id(solid);
  char rows_name[48], sums_name[48], bits_name[48];
  double *rows = NULL, sums[BW_SOLID_RESTART_SUMS];
  uint8_t *bits = NULL;
  /* Solids have no names of their own: a restart finds them by their number, which follows from the
   * scene. */
  snprintf(rows_name, sizeof rows_name, "solid%d/rows", q);
  snprintf(sums_name, sizeof sums_name, "solid%d/sums", q);
  snprintf(bits_name, sizeof bits_name, "solid%d/bonds", q);
  bw_status st = BW_ALLOCATE(&rows, n * width);
  BW_THEN(st, BW_ALLOCATE(&bits, n * bytes));
  st = bw_comm_agree(s->comm, st);
  /* Rows go by global id, so that any number of ranks may read them. */
  if (st == BW_OK && !read) {
    bw_solid_get_restart(solid, rows, sums);
    bw_solid_get_bits(solid, bits);
    st = bw_checkpoint_put_table(ck, rows_name, total, n, id, (int)width, BW_CK_DOUBLE, rows);
    BW_THEN(st, bw_checkpoint_put_numbers(ck, sums_name, BW_SOLID_RESTART_SUMS, sums));
    BW_THEN(st,
            bw_checkpoint_put_table(ck, bits_name, total, n, id, (int)bytes, BW_CK_UINT8, bits));
  } else if (st == BW_OK) {
    st = bw_checkpoint_get_table(ck, rows_name, total, n, id, (int)width, BW_CK_DOUBLE, rows);
    BW_THEN(st, bw_checkpoint_get_numbers(ck, sums_name, BW_SOLID_RESTART_SUMS, sums));
    BW_THEN(st,
            bw_checkpoint_get_table(ck, bits_name, total, n, id, (int)bytes, BW_CK_UINT8, bits));
    /* What was read is the state from here on. */
    BW_THEN(st, bw_solid_set_bits(solid, bits));
    BW_THEN(st, bw_solid_set_restart(solid, rows, sums));
    s->solid[q].steady = false;
  }
  bw_release(&rows);
  bw_release(&bits);
  return st;
}

/* What films of rigid bodies have taken; older files do not have it. */
static bw_status film_energy(bw_scene *s, bw_checkpoint *ck, bool read)
{
  static const char name[] = "rigid/film_energy";
  double taken = bw_coupler_rigid_film_energy(s->floats);
  if (!read) return bw_checkpoint_put_numbers(ck, name, 1, &taken);
  if (!bw_checkpoint_has(ck, name)) return BW_OK;
  BW_TRY(bw_checkpoint_get_numbers(ck, name, 1, &taken));
  bw_coupler_rigid_set_film_energy(s->floats, taken);
  return BW_OK;
}

bw_status bw_scene_save(bw_scene *s, bw_checkpoint *ck)
{
  const double numbers[NUMBERS] = {s->time,
                                   (double)s->steps,
                                   (double)s->phase,
                                   (double)s->phase_steps,
                                   s->phase_start,
                                   s->settled_energy,
                                   s->dt};
  BW_TRY(bw_checkpoint_put_numbers(ck, "scene/time", NUMBERS, numbers));
  if (s->coupler != NULL) {
    BW_TRY(bw_coupler_save(s->coupler, ck));
    if (s->floats == NULL) return BW_OK;
    BW_TRY(bw_scene__rigid_save(s, ck));
    return film_energy(s, ck, false);
  }
  if (s->water != NULL) return bw_scene__water_save(s, ck);
  if (s->fluid != NULL) BW_TRY(save_fluid(s, ck));
  if (s->rigid != NULL) BW_TRY(bw_scene__rigid_save(s, ck));
  if (s->floats != NULL) BW_TRY(film_energy(s, ck, false));
  for (int q = 0; q < s->n_solids; q++)
    BW_TRY(solid_state(s, q, ck, false));
  return BW_OK;
}

bw_status bw_scene_restore(bw_scene *s, bw_checkpoint *ck)
{
  double numbers[NUMBERS];
  int64_t phase = 0;
  BW_TRY(bw_checkpoint_get_numbers(ck, "scene/time", NUMBERS, numbers));
  BW_REQUIRE(
      bw_to_int64(numbers[1], &s->steps) && bw_to_int64(numbers[2], &phase) &&
          bw_to_int64(numbers[3], &s->phase_steps) && phase >= 0 && phase <= s->config.n_phases,
      BW_EINPUT, "the checkpoint's 'scene/time' holds numbers that this scene does not have");
  s->time = numbers[0];
  s->phase = (int)phase;
  /* A phase whose end has been moved since goes on. */
  while (s->phase > 0 && s->time < s->config.phases[s->phase - 1].until.time &&
         isnan(s->config.phases[s->phase - 1].until.settled) &&
         s->config.phases[s->phase - 1].until.steps == INT_MIN)
    s->phase--;
  s->phase_start = numbers[4];
  s->dt = numbers[6];
  /* What the phase allows, then the state: damping belongs to the forces that are restored. */
  BW_TRY(bw_scene__phase_begin(s));
  s->settled_energy = numbers[5];
  if (s->coupler != NULL) {
    BW_TRY(bw_coupler_load(s->coupler, ck));
    if (s->floats == NULL) return BW_OK;
    BW_TRY(bw_scene__rigid_restore(s, ck));
    return film_energy(s, ck, true);
  }
  if (s->water != NULL) return bw_scene__water_restore(s, ck);
  if (s->fluid != NULL) BW_TRY(restore_fluid(s, ck));
  if (s->rigid != NULL) BW_TRY(bw_scene__rigid_restore(s, ck));
  if (s->floats != NULL) BW_TRY(film_energy(s, ck, true));
  for (int q = 0; q < s->n_solids; q++)
    BW_TRY(solid_state(s, q, ck, true));
  return BW_OK;
}
