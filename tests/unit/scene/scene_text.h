/* scene_text.h -- scenes of a few lines, for tests. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "scene_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The scene of a text, written to a file of this number of ranks. NULL when it is refused. */
static inline bw_scene *scene_of(const char *text)
{
  bw_comm *world = bw_check_world();
  bw_scene_config *c = NULL;
  bw_scene *scene = NULL;
  char path[128];
  /* Tests of several programs may run at once. */
  const char *program = strrchr(__BASE_FILE__, '/') + 1;
  snprintf(path, sizeof path, "%s_np%d.yaml", program, bw_comm_size(world));
  if (bw_comm_rank(world) == 0) {
    FILE *out = fopen(path, "w");
    ck_assert_ptr_nonnull(out);
    fputs(text, out);
    ck_assert_int_eq(fclose(out), 0);
  }
  bw_comm_barrier(world);
  bw_check_ok(BW_ALLOCATE(&c, 1));
  bw_scene_config_default(c);
  bw_status st = bw_scene_read(world, path, 0, NULL, c);
  if (st == BW_OK) st = bw_scene_create(world, c, NULL, &scene);
  bw_release(&c);
  return st == BW_OK ? scene : NULL;
}

/* The same, which has to be taken. */
static inline bw_scene *made(const char *text)
{
  bw_scene *scene = scene_of(text);
  ck_assert_msg(scene != NULL, "%s", bw_last_message());
  return scene;
}

/* Steps to the end. */
static inline void run(bw_scene *scene)
{
  while (!bw_scene_done(scene))
    bw_check_ok(bw_scene_step(scene, INFINITY));
}

static inline double gauge(bw_scene *scene, const char *name)
{
  double value = NAN;
  bw_check_ok(bw_scene_gauge(scene, name, &value));
  return value;
}

/* The state of a scene in a checkpoint, and a scene that goes on from it. */
static inline bw_scene *again(bw_scene *s, const char *text)
{
  bw_comm *world = bw_check_world();
  bw_checkpoint *ck = NULL;
  const char *program = strrchr(__BASE_FILE__, '/') + 1;
  char path[128];
  snprintf(path, sizeof path, "%s_np%d.h5", program, bw_comm_size(world));
  bw_check_ok(bw_checkpoint_create(world, path, &ck));
  bw_check_ok(bw_scene_save(s, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  bw_scene *other = made(text);
  bw_check_ok(bw_checkpoint_open(world, path, &ck));
  bw_check_ok(bw_scene_restore(other, ck));
  bw_check_ok(bw_checkpoint_close(&ck));
  return other;
}

/* Runs through, and again from a checkpoint at `until`: gauges at the end agree to the last bit. */
static inline void check_restart(const char *text, double until, const char *const names[])
{
  bw_scene *s = made(text);
  while (bw_scene_time(s) < until)
    bw_check_ok(bw_scene_step(s, until));
  bw_scene *other = again(s, text);
  run(s);
  run(other);
  for (int q = 0; names[q] != NULL; q++)
    bw_check_near(gauge(other, names[q]), gauge(s, names[q]), 0.0);
  bw_scene_destroy(&s);
  bw_scene_destroy(&other);
}

/* Angular momentum about z and the origin, of one solid and one rigid body. */
static inline double angular_momentum(bw_scene *s, int solid, int body)
{
  const bw_rigid_state b = bw_rigid_state_of(s->rigid, body);
  bw_solid_ledger book;
  bw_check_ok(bw_solid_account(s->solid[solid].solid, &book));
  return book.angular[2] + b.inertia[2] * b.spin[2] +
         b.mass * (b.position[0] * b.velocity[1] - b.position[1] * b.velocity[0]);
}
