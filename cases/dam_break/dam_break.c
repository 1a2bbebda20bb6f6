/* Water in a tank, of particles: dam breaks, sloshing, water at rest, with blocks, gauges, and a
 * solid that bends, breaks or floats.
 *
 * Goes on after an interruption with --restart OUT/checkpoint-last.h5, to the last bit, on any
 * number of ranks.
 * Run:   mpirun -n 2 build/bin/dam_break cases/dam_break/dam_break.yaml --out out/dam_break
 * BUILD modules=scene */
#include "bw_memory.h"
#include "dam_case.h"

static bw_status simulate(const bw_comm *comm, void *config, bw_case *run)
{
  bw_scene_config *scene = NULL;
  bw_status st = bw_comm_agree(comm, dam_check(config));
  BW_THEN(st, bw_comm_agree(comm, BW_ALLOCATE(&scene, 1)));
  if (st == BW_OK) {
    bw_scene_config_default(scene);
    dam_to_scene(config, scene);
    st = bw_scene_run(comm, scene, run);
  }
  bw_release(&scene);
  return st;
}

int main(int argc, char **argv)
{
  dam_config config = dam_config_default();
  const bw_case_about about = {"dam_break", "water of particles in a tank, and a solid in it",
                               dam_fields, sizeof config, bw_checkpoint_read_case};
  return bw_case_main(argc, argv, &about, &config, simulate);
}
