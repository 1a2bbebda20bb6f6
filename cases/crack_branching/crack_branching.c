/* A crack in a glass plate runs from its notch and branches (FSI section 3, figures 2 and 3).
 *
 * Run:   build/bin/crack_branching cases/crack_branching/crack_branching.yaml --out out/crack
 * BUILD modules=solid,solid_tools,pd_interface,vtk case=notched_plate */
#include "specimen_main.h"

int main(int argc, char **argv)
{
  return specimen_main(argc, argv, "crack_branching",
                       "a crack that branches in a notched glass plate");
}
