/* The gauge of failure: where a body would break first, and at how many times the present load. */
#include "bw_solid_failure.h"
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

/* Without strengths it is the stretch of bonds, which break by it. */
static int decides(const bw_scene_gauge_config *g)
{
  return g->has_strength ? g->strength.by : BW_SOLID_FAILURE_STRETCH;
}

/* The numbers of a criterion: which it needs, and which must not look as if they did something. */
static bw_status check_numbers(const bw_scene_gauge_config *g)
{
  const bw_scene_strength *n = &g->strength;
  const int by = n->by;
  const bool tension = by == BW_SOLID_FAILURE_RANKINE || by == BW_SOLID_FAILURE_ENERGY;
  const bool angle = by == BW_SOLID_FAILURE_MOHR_COULOMB || by == BW_SOLID_FAILURE_CONE;
  const struct {
    const char *key;
    double given;
    bool needed;
  } rows[] = {{"tension", n->tension, tension},
              {"yield", n->yield, by == BW_SOLID_FAILURE_MISES},
              {"cohesion", n->cohesion, angle},
              {"friction_angle", n->friction_angle, angle},
              {"flaw", n->flaw, by == BW_SOLID_FAILURE_GRIFFITH}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++) {
    BW_REQUIRE(!rows[q].needed || !isnan(rows[q].given), BW_EINPUT,
               "gauges.%s.strength.%s is missing: by: %s needs it", g->name, rows[q].key,
               bw_solid_failure_name[by]);
    BW_REQUIRE(rows[q].needed || isnan(rows[q].given), BW_EINPUT,
               "gauges.%s.strength.%s = %g: by: %s does not read it; leave it out", g->name,
               rows[q].key, rows[q].given, bw_solid_failure_name[by]);
  }
  return BW_OK;
}

bw_status bw_scene__check_failure(const bw_scene_config *c, const bw_scene_gauge_config *g)
{
  const int by = decides(g);
  const bool breaks = by == BW_SOLID_FAILURE_STRETCH || by == BW_SOLID_FAILURE_GRIFFITH;
  char name[BW_SCENE_NAME];
  if (g->has_strength) BW_TRY(check_numbers(g));
  for (const char *rest = g->body; bw_scene__next_name(&rest, name);) {
    const int b = bw_scene__body_named(c, name);
    if (b < 0) continue; /* said by check_gauge */
    BW_REQUIRE(bw_scene__deforms(&c->bodies[b]), BW_EINPUT,
               "gauges.%s.body = %s: it does not deform, and nothing in it fails; leave it out",
               g->name, name);
    BW_REQUIRE(!breaks || c->bodies[b].motion == BW_SCENE_BREAKABLE, BW_EINPUT,
               "gauges.%s: %s is that of a fracture energy, and bodies.%s is elastic; make it "
               "breakable (phases.breaking: false keeps it whole), or give strength.by",
               g->name, bw_solid_failure_name[by], name);
  }
  return BW_OK;
}

/* used (n): the share of its strength that each particle of a solid uses, 0 where the gauge does
 * not look. Collective. */
static bw_status shares(bw_scene__solid *q, const bw_scene_gauge_config *g, int n,
                        const int32_t looked[], double used[], double kept[])
{
  const int by = decides(g);
  bw_solid_strength k = bw_solid_strength_of(q->solid);
  if (g->has_strength) {
    k.tension = g->strength.tension, k.yield = g->strength.yield;
    k.cohesion = g->strength.cohesion, k.flaw = g->strength.flaw;
    k.friction = g->strength.friction_angle * acos(-1.0) / 180.0;
  }
  BW_TRY(bw_solid_failure_compute(q->solid, &k, used));
  /* A half of the largest stress is where cracks are tried. */
  if (by == BW_SOLID_FAILURE_GRIFFITH) BW_TRY(bw_solid_failure_griffith(q->solid, &k, 0.5, used));
  for (int i = 0; i < n; i++)
    kept[looked[i]] = used[(size_t)looked[i] * BW_SOLID_FAILURE_GAUGES + (size_t)by];
  for (size_t i = 0; i < q->n; i++)
    used[i * BW_SOLID_FAILURE_GAUGES + (size_t)by] = kept[i];
  return BW_OK;
}

bw_status bw_scene__failure(bw_scene *s, const bw_scene_gauge_config *g, const bw_scene__aim *aim,
                            double *load, double place[3])
{
  double most = 0.0;
  for (int q = 0; q < s->n_solids; q++) {
    bw_solid_failure_place first;
    double *used = NULL, *kept = NULL;
    int found = 0;
    bw_status st = BW_ALLOCATE(&used, s->solid[q].n * BW_SOLID_FAILURE_GAUGES);
    BW_THEN(st, BW_ALLOCATE(&kept, s->solid[q].n));
    st = bw_comm_agree(s->comm, st);
    BW_THEN(st, shares(&s->solid[q], g, aim->n[q], aim->particle[q], used, kept));
    BW_THEN(st, bw_solid_failure_list(s->solid[q].solid, used, (bw_solid_failure_gauge)decides(g),
                                      1, &first, &found));
    /* The first of all solids; where nothing is loaded the row stays empty. */
    if (st == BW_OK && found > 0 && first.used > most) {
      most = first.used;
      if (load != NULL) *load = first.load;
      if (place != NULL) memcpy(place, first.X0, sizeof first.X0);
    }
    bw_release(&used);
    bw_release(&kept);
    BW_TRY(st);
  }
  return BW_OK;
}
