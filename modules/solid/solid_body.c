/* The body of a solid, and what the solid keeps per particle of it. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

static bw_pd_body_config body_config(const bw_solid_config *c)
{
  bw_pd_body_config b = {.geometry = c->geometry,
                         .ds = c->ds,
                         .thickness = c->thickness,
                         .horizon_ratio = c->horizon_ratio,
                         .volume_fraction = c->volume_fraction,
                         .family_reach = c->family_reach,
                         .disorder = c->disorder,
                         .disorder_seed = c->disorder_seed,
                         .n_group = 1 + c->more.n,
                         .material = {{.rho = c->rho, .E = c->E, .nu = c->nu, .G0 = c->G0}}};
  b.finer.n = c->finer.n;
  b.finer.jump = c->finer.jump;
  b.finer.same_horizon = c->finer.same_horizon;
  memcpy(b.finer.box, c->finer.box, sizeof b.finer.box);
  /* Two ways to say it: the number beside E, or that of the choice. */
  if (isnan(c->nu)) b.material[0].nu = c->choice.poisson_ratio;
  /* Group 0 is the configuration's own material; `more` follow it. */
  memcpy(b.origin, c->origin, sizeof b.origin);
  memcpy(b.axes, c->axes, sizeof b.axes);
  memcpy(b.period, c->period, sizeof b.period);
  memcpy(b.joint_G0, c->more.joint_G0, sizeof b.joint_G0);
  for (int g = 0; g < c->more.n; g++)
    b.material[1 + g] = c->more.material[g];
  return b;
}

bw_status bw_solid__own_arrays(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  /* Room for all: retiring allocates nothing. */
  BW_TRY(BW_ALLOCATE(&s->retired, pd->n));
  if (s->levels != NULL) BW_TRY(BW_ALLOCATE(&s->levels->precut, pd->n));
  if (s->config.contact) BW_TRY(bw_pd_contact_create(pd, &s->contact));
  for (int k = 0; k < 3 && s->config.integrator == BW_SOLID_RK3; k++) {
    BW_TRY(BW_ALLOCATE(&s->v_before[k], pd->n));
    BW_TRY(BW_ALLOCATE(&s->a_before[k], pd->n));
  }
  return BW_OK;
}

void bw_solid__release_own_arrays(bw_solid *s)
{
  bw_pd_contact_destroy(&s->contact);
  bw_release(&s->retired);
  if (s->levels != NULL) bw_release(&s->levels->precut);
  for (int k = 0; k < 3; k++) {
    bw_release(&s->v_before[k]);
    bw_release(&s->a_before[k]);
  }
}

bw_status bw_solid__body(const bw_solid *s, const bw_comm *comm, const bw_pd_sites *given,
                         const bw_pd_map *map, bw_pd_body **out)
{
  const bw_solid_config *c = &s->config;
  bw_pd_body_config body = body_config(c);
  const bw_pd_law *law = c->law != NULL ? c->law : bw_solid_laws[c->choice.law];
  bw_solid_options store;
  const void *options =
      c->law_options != NULL ? c->law_options : bw_solid__law_options(c, law, &store);
  /* The boxes are in the map. */
  body.finer.map = map;
  body.finer.later = s->body != NULL;
  if (map != NULL) body.finer.n = 0;
  BW_TRY(bw_pd_body_create(comm, &body, law, options, given, out));
  bw_pd_body_set_damping(*out, c->damping.pair, c->damping.mean, c->damping.absolute);
  return BW_OK;
}
