/* A program's own settings from a YAML file and the command line, by one table.
 * BUILD modules=core
 * TEST  ranks=2 */
#include "bw_config.h"
#include <math.h>
#include <string.h>

typedef struct {
  double nu;
  int n[3];
  int inflow;
} my_case;

static const bw_config_word inflows[] = {{"uniform", 0, ""}, {"poiseuille", 1, ""}, {0}};
static const bw_config_field keys[] = {
    BW_CONFIG_VALUE(my_case, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
    BW_CONFIG_VALUE(my_case, n, BW_REQUIRED, BW_AT_LEAST(1), "", "cells in x, y, z"),
    BW_CONFIG_WORD(my_case, inflow, BW_OPTIONAL, inflows, "profile of the velocity at x = 0"),
    BW_CONFIG_END};

/* `path`: a case file, or NULL; `set`: "key=value" of the command line. */
static bw_status read(const bw_comm *world, const char *path, int n, const char *const set[],
                      my_case *c)
{
  *c = (my_case){.nu = NAN, .n = {64, 64, 1}}; /* NAN: has to be given */
  BW_TRY(bw_config_load(world, path, keys, n, set, sizeof *c, c));
  if (bw_comm_rank(world) == 0) bw_config_help(keys, c, stdout);
  return BW_OK;
}

static bw_status demonstrate(const bw_comm *world)
{
  static const char *const right[] = {"nu=0.01", "n=[128, 64, 64]", "inflow=poiseuille"};
  static const char *const wrong[] = {"nu=-1", "inflw=uniform"};
  my_case c;
  BW_TRY(read(world, NULL, 3, right, &c));
  BW_REQUIRE(c.nu == 0.01 && c.n[0] == 128 && c.inflow == 1, BW_EINPUT, "read something else");
  const bw_status st = read(world, NULL, 2, wrong, &c);
  BW_REQUIRE(st == BW_EINPUT && strstr(bw_last_message(), "did you mean inflow?") != NULL,
             BW_EINPUT, "a slip went through");
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  bw_status st = bw_init(&argc, &argv, &world);
  BW_THEN(st, demonstrate(world));
  return bw_finish(&world, st);
}
