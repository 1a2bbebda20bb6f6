/* Building and destroying a solid: a body with its law, contact and integrator. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>
#include <string.h>

bw_solid_config bw_solid_config_default(void)
{
  bw_solid_config c = {.geometry = BW_PD_3D,
                       .ds = NAN,
                       .thickness = 1,
                       .horizon_ratio = 3,
                       .rho = NAN,
                       .E = NAN,
                       .nu = NAN,
                       .G0 = INFINITY,
                       .volume_fraction = BW_PD_FRACTION_DEFAULT,
                       .surface_correction = BW_PD_SURFACE_VOLUME,
                       .integrator = BW_SOLID_VERLET,
                       .choice = bw_solid_law_choice_default(),
                       .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int g = 0; g < BW_PD_GROUPS; g++)
    for (int h = 0; h < BW_PD_GROUPS; h++)
      c.more.joint_G0[g][h] = NAN;
  return c;
}

static bw_status check_config(const bw_solid_config *c)
{
  const double value[] = {c->damping.pair, c->damping.mean, c->damping.absolute};
  const char *name[] = {"damping.pair", "damping.mean", "damping.absolute"};
  /* What is the body's to refuse the body refuses: geometry, materials, lattice. */
  BW_REQUIRE((unsigned)c->integrator <= BW_SOLID_RK3, BW_EINPUT,
             "solid: integrator = %d is unknown", (int)c->integrator);
  BW_REQUIRE(c->more.n >= 0 && c->more.n < BW_PD_GROUPS, BW_EINPUT,
             "solid: more.n = %d must be from 0 to %d", c->more.n, BW_PD_GROUPS - 1);
  for (int q = 0; q < 3; q++)
    BW_REQUIRE(value[q] >= 0 && isfinite(value[q]), BW_EINPUT,
               "solid: %s = %g must be zero or positive", name[q], value[q]);
  BW_TRY(bw_solid_law_check(&c->choice));
  BW_REQUIRE(isnan(c->nu) || isnan(c->choice.poisson_ratio) || c->nu == c->choice.poisson_ratio,
             BW_EINPUT, "solid: nu = %g, but choice.poisson_ratio = %g; give one of them", c->nu,
             c->choice.poisson_ratio);
  const bool bonds = c->law == NULL && c->choice.law == BW_SOLID_BOND;
  BW_REQUIRE(bonds || c->law != NULL || c->surface_correction <= BW_PD_SURFACE_VOLUME, BW_EINPUT,
             "solid: surface_correction = %d is of bonds; families at faces are whole in a "
             "state-based law, leave it out",
             (int)c->surface_correction);
  BW_REQUIRE(
      c->finer.n == 0 || (c->damping.pair == 0 && c->damping.mean == 0), BW_EINPUT,
      "solid: damping.pair = %g, damping.mean = %g with levels: between neighbours they damp "
      "each level differently; use damping.absolute",
      c->damping.pair, c->damping.mean);
  /* A particle may meet another one and its image, but not itself. */
  for (int a = 0; a < 3; a++)
    BW_REQUIRE(c->period[a] == 0 || !c->contact || c->period[a] / c->ds > 3.5, BW_EINPUT,
               "solid: period[%d] = %g with contact needs at least 4 ds", a, c->period[a]);
  return BW_OK;
}

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
  b.finer = c->finer;
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

static bw_status own_arrays(bw_solid *s)
{
  bw_pd_body *pd = s->body;
  /* Room for all: retiring allocates nothing. */
  BW_TRY(BW_ALLOCATE(&s->retired, pd->n));
  if (s->config.contact) BW_TRY(bw_pd_contact_create(pd, &s->contact));
  for (int k = 0; k < 3 && s->config.integrator == BW_SOLID_RK3; k++) {
    BW_TRY(BW_ALLOCATE(&s->v_before[k], pd->n));
    BW_TRY(BW_ALLOCATE(&s->a_before[k], pd->n));
  }
  return BW_OK;
}

static bw_status build(bw_solid *s, const bw_comm *comm, const bw_pd_sites *given)
{
  bw_solid_config *c = &s->config;
  const bw_pd_body_config body = body_config(c);
  const bw_pd_law *law = c->law != NULL ? c->law : bw_solid_laws[c->choice.law];
  bw_solid_options store;
  const void *options =
      c->law_options != NULL ? c->law_options : bw_solid__law_options(c, law, &store);
  BW_TRY(bw_pd_body_create(comm, &body, law, options, given, &s->body));
  c->nu = s->body->config.material[0].nu;
  c->volume_fraction = s->body->config.volume_fraction;
  bw_pd_body_set_damping(s->body, c->damping.pair, c->damping.mean, c->damping.absolute);
  return bw_comm_agree(comm, own_arrays(s));
}

bw_status bw_solid_create(const bw_comm *comm, const bw_solid_config *config,
                          const bw_pd_sites *given, bw_solid **out)
{
  bw_solid *s = NULL;
  *out = NULL;
  bw_status st = BW_ALLOCATE(&s, 1);
  BW_THEN(st, check_config(config));
  /* One rank's refusal is everybody's. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    s->config = *config;
    st = build(s, comm, given);
  }
  if (st != BW_OK) bw_solid_destroy(&s);
  *out = s;
  return st;
}

bw_status bw_solid_create_same(const bw_comm *comm, const bw_solid_config *config, int64_t n,
                               const int32_t site[], const uint8_t kind[], bw_solid **out)
{
  const int64_t rank = bw_comm_rank(comm), size = bw_comm_size(comm);
  const int64_t all = n > 0 && site != NULL ? n : 0;
  /* In two parts, so that products of 64-bit numbers do not overflow. */
  const int64_t first = all / size * rank + all % size * rank / size;
  const int64_t last = all / size * (rank + 1) + all % size * (rank + 1) / size;
  const bw_pd_sites part = {.n = last - first,
                            .site = site == NULL ? NULL : site + 3 * first,
                            .kind = kind == NULL ? NULL : kind + first};
  return bw_solid_create(comm, config, &part, out);
}

void bw_solid_destroy(bw_solid **solid)
{
  bw_solid *s = *solid;
  if (s == NULL) return;
  bw_pd_contact_destroy(&s->contact);
  bw_pd_body_destroy(&s->body);
  bw_solid__drag_release(&s->drag);
  bw_release(&s->retired);
  for (int k = 0; k < 3; k++) {
    bw_release(&s->v_before[k]);
    bw_release(&s->a_before[k]);
  }
  bw_release(solid);
}
