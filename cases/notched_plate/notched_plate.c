/* A notched plate that is pulled or struck: Kalthoff and Winkler's, one with a hole, one on a
 * turned lattice, one in three dimensions (ADAPT chapters 5 and 6).
 *
 * Run:   build/bin/notched_plate cases/notched_plate/notched_plate.yaml --out out/kalthoff
 * BUILD modules=solid,solid_tools,pd_interface,vtk */
#include "specimen_main.h"

int main(int argc, char **argv)
{
  return specimen_main(argc, argv, "notched_plate", "a notched plate that is pulled or struck");
}
