/* specimen_run.h -- the plates of cases/notched_plate and cases/crack_branching, broken once, for
 * the claims about them. */
#pragma once
#include "../../cases/notched_plate/specimen.c" /* the case's own plate, not a second one */
#include "../../cases/notched_plate/specimen_crack.c"
#include "../../cases/notched_plate/specimen_input.c"
#include "../../cases/notched_plate/specimen_plan.c"
#include "bw_validation.h"
#include <stdio.h>
#include <stdlib.h>

/* The plate of cases/NAME.yaml with some keys changed. Collective. */
static bw_status specimen_read(const bw_comm *comm, const char *name, int n,
                               const char *const changes[], specimen_config *c)
{
  char path[1024];
  const char *root = getenv("BW_SOURCE_DIR");
  snprintf(path, sizeof path, "%s/cases/%s.yaml", root != NULL ? root : ".", name);
  *c = specimen_default();
  return bw_config_load(comm, path, specimen_fields, n, changes, sizeof *c, c);
}

/* Energy not found again, over the work. Collective. */
static bw_status specimen_residual(specimen *p, double *residual)
{
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(p->solid, &e));
  *residual = (e.external - e.kinetic - e.elastic - e.fracture - e.damping) / e.external;
  return BW_OK;
}

/* Run it to its end; `p` has to be destroyed by the caller. Collective. */
static bw_status specimen_break(const bw_comm *comm, const specimen_config *c, specimen *p)
{
  BW_TRY(specimen_create(comm, c, p));
  while (!specimen_done(p))
    BW_TRY(specimen_step(p));
  return BW_OK;
}
