/* What pushes the particles from outside, by where they are; solid_step.c calls it. */
#include "bw_memory.h"
#include "solid_internal.h"

void bw_solid_forget_outside(bw_solid *s)
{
  s->body->current = false;
  s->outside = (bw_solid_outside){.who = NULL};
  bw_release(&s->outside_X);
}

bw_status bw_solid_set_outside(bw_solid *s, const bw_solid_outside *outside)
{
  bw_solid_forget_outside(s);
  BW_REQUIRE(s->config.integrator == BW_SOLID_VERLET, BW_EINPUT,
             "solid: integrator = rk3, but something pushes the particles from outside, which goes "
             "with the steps of verlet; use that");
  BW_REQUIRE(s->levels == NULL, BW_EINPUT,
             "solid: refine.level is given, but something pushes the particles from outside, which "
             "does not follow a change of them; leave refine out");
  BW_TRY(bw_comm_agree(s->body->comm, BW_ALLOCATE(&s->outside_X, 3 * s->body->n)));
  s->outside = *outside;
  return BW_OK;
}

void bw_solid_push(bw_solid *s, size_t i, const double F[3])
{
  bw_pd_body *pd = s->body;
  const double mass = bw_solid_density(s, i) * bw_solid_volume_of(s, i);
  for (int k = 0; k < pd->dimension; k++)
    pd->load.extra[k][i] += (bw_real)(F[k] / mass);
}

bw_status bw_solid_make_ready(bw_solid *s)
{
  return s->body->current ? BW_OK : bw_solid_evaluate(s);
}

double bw_solid_contact_force(const bw_solid *s, size_t i)
{
  return bw_pd_contact_force_of(s->body, i);
}
