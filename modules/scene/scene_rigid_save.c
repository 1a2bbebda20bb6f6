/* Rigid bodies in a checkpoint. */
#include "scene_impl.h"

#include "bw_memory.h"

static bw_status fluid_state(bw_scene *s, bw_checkpoint *ck, bool read)
{
  const size_t n = bw_rigid_points(s->rigid), bodies = (size_t)bw_rigid_count(s->rigid);
  const int64_t *id = bw_rigid_point_id(s->rigid);
  int64_t all = (int64_t)n;
  double *M = NULL, *load = NULL;
  bw_comm_sum_int(s->comm, 1, &all);
  bw_status st = BW_ALLOCATE(&M, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&load, 6 * bodies));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK && !read) bw_coupler_rigid_get_state(s->floats, M, load);
  if (read) {
    BW_THEN(st, bw_checkpoint_get_numbers(ck, "rigid/fluid_load", 6 * (int)bodies, load));
    BW_THEN(st, bw_checkpoint_get_table(ck, "rigid/memory", all, n, id, 3, BW_CK_DOUBLE, M));
    BW_THEN(st, bw_coupler_rigid_set_state(s->floats, M, load));
  } else {
    BW_THEN(st, bw_checkpoint_put_numbers(ck, "rigid/fluid_load", 6 * (int)bodies, load));
    BW_THEN(st, bw_checkpoint_put_table(ck, "rigid/memory", all, n, id, 3, BW_CK_DOUBLE, M));
  }
  bw_release(&M);
  bw_release(&load);
  return st;
}

bw_status bw_scene__rigid_save(bw_scene *s, bw_checkpoint *ck)
{
  double row[BW_SCENE_BODIES * BW_RIGID_ROW];
  const int n = bw_rigid_count(s->rigid);
  bw_rigid_save(s->rigid, row);
  BW_TRY(bw_checkpoint_put_numbers(ck, "rigid/rows", n * BW_RIGID_ROW, row));
  BW_TRY(bw_checkpoint_put_numbers(ck, "rigid/load", 6 * n, s->rigid_load));
  const double rubbed = bw_rigid_energy_of(s->rigid).rubbed;
  BW_TRY(bw_checkpoint_put_numbers(ck, "rigid/rubbed", 1, &rubbed));
  return s->floats != NULL ? fluid_state(s, ck, false) : BW_OK;
}

bw_status bw_scene__rigid_restore(bw_scene *s, bw_checkpoint *ck)
{
  double row[BW_SCENE_BODIES * BW_RIGID_ROW];
  const int n = bw_rigid_count(s->rigid);
  BW_TRY(bw_checkpoint_get_numbers(ck, "rigid/rows", n * BW_RIGID_ROW, row));
  BW_TRY(bw_checkpoint_get_numbers(ck, "rigid/load", 6 * n, s->rigid_load));
  bw_rigid_restore(s->rigid, s->time, row);
  /* Files from before friction have none. */
  double rubbed = 0.0;
  if (bw_checkpoint_has(ck, "rigid/rubbed"))
    BW_TRY(bw_checkpoint_get_numbers(ck, "rigid/rubbed", 1, &rubbed));
  bw_rigid_set_rubbed(s->rigid, rubbed);
  return s->floats != NULL ? fluid_state(s, ck, true) : BW_OK;
}
