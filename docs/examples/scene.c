/* A scene from a file, stepped by a program: the deflection of a beam under load.
 * BUILD modules=scene
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_scene.h"

#include <math.h>
#include <stdlib.h>

/* The file is that of the template, made shorter and coarser. */
static bw_status bend(const bw_comm *comm, bw_scene_config *config)
{
  static const char *const changes[] = {"phases.0.until.time=0.002", "bodies.beam.spacing=4e-3",
                                        "loads.0.ramp=1e-3"};
  const char *source = getenv("BW_SOURCE_DIR");
  char path[1024];
  double tip = NAN;
  bw_scene *scene = NULL;
  snprintf(path, sizeof path, "%s/scenes/beam_under_load/beam_under_load.yaml",
           source != NULL ? source : ".");
  bw_status st = BW_OK;
  BW_TRY(bw_scene_read(comm, path, 3, changes, config));
  st = bw_scene_create(comm, config, NULL, &scene);
  while (st == BW_OK && !bw_scene_done(scene))
    st = bw_scene_step(scene, INFINITY);
  BW_THEN(st, bw_scene_gauge(scene, "tip.y", &tip));
  if (st == BW_OK && bw_comm_rank(comm) == 0) printf("the tip has moved by %.3g m\n", tip);
  bw_scene_destroy(&scene);
  return st;
}

int main(int argc, char **argv)
{
  bw_comm *comm = NULL;
  bw_scene_config *config = NULL;
  bw_status st = bw_init(&argc, &argv, &comm);
  BW_THEN(st, BW_ALLOCATE(&config, 1));
  if (st == BW_OK) {
    bw_scene_config_default(config);
    st = bend(comm, config);
  }
  bw_release(&config);
  return bw_finish(&comm, st);
}
