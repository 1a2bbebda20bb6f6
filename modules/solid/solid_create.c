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
  c.finer.refine = (bw_solid_refine){.at = 0.6, .coarsen_at = 0.2, .buffer = 1.25, .ahead = 2};
  for (int g = 0; g < BW_PD_GROUPS; g++)
    for (int h = 0; h < BW_PD_GROUPS; h++)
      c.more.joint_G0[g][h] = NAN;
  return c;
}

static bw_status check_refine(const bw_solid_finer *f)
{
  const bw_solid_refine *r = &f->refine;
  if (r->level == 0) return BW_OK;
  BW_REQUIRE(r->level >= 1 && r->level <= BW_PD_FINEST, BW_EINPUT,
             "solid: refine.level = %d must be from 1 (half the spacing) to %d", r->level,
             (int)BW_PD_FINEST);
  BW_REQUIRE(!f->same_horizon, BW_EINPUT,
             "solid: finer.same_horizon with refine.level = %d: levels that change shrink the "
             "horizon, too; leave it out",
             r->level);
  BW_REQUIRE((unsigned)r->trigger <= BW_PD_LEVELS_DAMAGE, BW_EINPUT,
             "solid: refine.trigger = %d is unknown", (int)r->trigger);
  BW_REQUIRE(r->at > 0 && r->at < 1, BW_EINPUT,
             "solid: refine.at = %g must be between 0 and 1, where bonds break", r->at);
  BW_REQUIRE(r->coarsen_at >= 0 && r->coarsen_at < r->at, BW_EINPUT,
             "solid: refine.coarsen_at = %g must be from 0 to less than refine.at = %g",
             r->coarsen_at, r->at);
  BW_REQUIRE(
      r->buffer > 1 && r->buffer <= 100, BW_EINPUT,
      "solid: refine.buffer = %g horizons must be more than 1, which is what bonds of coarse "
      "particles reach, and at most 100",
      r->buffer);
  BW_REQUIRE(r->ahead >= 0 && r->ahead <= 100, BW_EINPUT,
             "solid: refine.ahead = %g horizons must be from 0 to 100", r->ahead);
  for (int b = 0; b < f->n; b++)
    BW_REQUIRE(f->box[b].level <= r->level, BW_EINPUT,
               "solid: levels[%d].level = %d is finer than refine.level = %d; make that larger", b,
               f->box[b].level, r->level);
  return BW_OK;
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
  BW_TRY(check_refine(&c->finer));
  const bool levels = c->finer.n > 0 || c->finer.refine.level > 0;
  BW_REQUIRE(c->finer.refine.level == 0 || !c->contact, BW_EINPUT,
             "solid: contact with refine.level = %d: contact does not follow levels that change; "
             "leave one of them out",
             c->finer.refine.level);
  BW_REQUIRE(
      !levels || (c->damping.pair == 0 && c->damping.mean == 0), BW_EINPUT,
      "solid: damping.pair = %g, damping.mean = %g with levels: between neighbours they damp "
      "each level differently; use damping.absolute",
      c->damping.pair, c->damping.mean);
  /* A particle may meet another one and its image, but not itself. */
  for (int a = 0; a < 3; a++)
    BW_REQUIRE(c->period[a] == 0 || !c->contact || c->period[a] / c->ds > 3.5, BW_EINPUT,
               "solid: period[%d] = %g with contact needs at least 4 ds", a, c->period[a]);
  return BW_OK;
}

static bw_status build(bw_solid *s, const bw_comm *comm, const bw_pd_sites *given)
{
  bw_solid_config *c = &s->config;
  if (c->finer.refine.level > 0) BW_TRY(bw_solid__levels_create(s, comm, given));
  BW_TRY(bw_solid__body(s, comm, given, s->levels != NULL ? &s->levels->map : NULL, &s->body));
  c->nu = s->body->config.material[0].nu;
  c->volume_fraction = s->body->config.volume_fraction;
  BW_TRY(bw_comm_agree(comm, bw_solid__own_arrays(s)));
  if (s->levels != NULL) bw_solid__levels_bound(s);
  return BW_OK;
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
  bw_solid__release_own_arrays(s);
  bw_pd_body_destroy(&s->body);
  bw_solid__drag_release(&s->drag);
  bw_solid__levels_release(s);
  bw_release(&s->outside_X);
  bw_release(solid);
}
