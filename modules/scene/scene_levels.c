/* Finer particles in the solids of a scene: where they are, and what follows when that changes. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_solid_levels.h"
#include <math.h>
#include <string.h>

/* Boxes of all bodies that share the lattice. */
static bw_status boxes_of(const bw_scene *s, const bw_scene__solid *q, bw_solid_config *c)
{
  for (int k = 0; k < q->n_bodies; k++) {
    const bw_scene_body *b = &s->config.bodies[q->body[k]];
    for (int r = 0; r < b->n_levels; r++) {
      BW_REQUIRE(c->finer.n < BW_PD_BOXES, BW_EINPUT,
                 "bodies.%s.levels: bodies that hold each other have more than %d boxes together; "
                 "join some",
                 b->name, (int)BW_PD_BOXES);
      bw_pd_box *box = &c->finer.box[c->finer.n++];
      box->level = b->levels[r].level;
      for (int d = 0; d < (s->planar ? 2 : 3); d++)
        box->lower[d] = b->levels[r].from[d], box->upper[d] = b->levels[r].to[d];
    }
  }
  return BW_OK;
}

/* Levels that change, of the body that asks for them. */
static bw_status refine_of(const bw_scene *s, const bw_scene__solid *q, bw_solid_config *c)
{
  for (int k = 0; k < q->n_bodies; k++) {
    const bw_scene_body *b = &s->config.bodies[q->body[k]];
    const bw_scene_refine *r = &b->refine;
    if (!b->has_refine) continue;
    BW_REQUIRE(c->finer.refine.level == 0, BW_EINPUT,
               "bodies.%s.refine: another body that it holds, or that holds it, says it already; "
               "say it once",
               b->name);
    BW_REQUIRE(!q->contact, BW_EINPUT,
               "bodies.%s.refine: contact does not follow levels that change; give self_contact: "
               "false, or contact: {between: none}",
               b->name);
    for (int l = 0; l < s->config.n_loads; l++)
      BW_REQUIRE(!bw_scene__in_cracks(&s->config.loads[l]), BW_EINPUT,
                 "bodies.%s.refine: loads.%d acts in cracks, which does not follow levels that "
                 "change; leave one of them out",
                 b->name, l);
    c->finer.refine = (bw_solid_refine){.level = r->level,
                                        .trigger = (bw_pd_levels_trigger)r->trigger,
                                        .at = r->at,
                                        .coarsen_at = r->coarsen_at,
                                        .buffer = r->buffer,
                                        .ahead = r->ahead};
  }
  return BW_OK;
}

bw_status bw_scene__levels_of(const bw_scene *s, const bw_scene__solid *q, bw_solid_config *c)
{
  BW_TRY(boxes_of(s, q, c));
  return refine_of(s, q, c);
}

bw_status bw_scene__solid_arrays(bw_scene *s, bw_scene__solid *q)
{
  bw_release(&q->X0);
  bw_release(&q->F);
  bw_release(&q->V);
  q->n = bw_solid_count(q->solid);
  bw_status st = BW_ALLOCATE(&q->X0, 3 * q->n);
  BW_THEN(st, BW_ALLOCATE(&q->F, 3 * q->n));
  BW_THEN(st, BW_ALLOCATE(&q->V, 3 * q->n));
  BW_TRY(bw_comm_agree(s->comm, st));
  bw_solid_get_reference(q->solid, q->X0);
  q->steady = false;
  return BW_OK;
}

bw_status bw_scene__solid_renew(bw_scene *s, int solid)
{
  BW_TRY(bw_scene__solid_arrays(s, &s->solid[solid]));
  BW_TRY(bw_scene__note_cut(s, solid));
  BW_TRY(bw_scene__loads_aim(s));
  return bw_scene__gauges_aim(s);
}

bw_status bw_scene__solids_adapt(bw_scene *s)
{
  for (int q = 0; q < s->n_solids; q++) {
    bool changed = false;
    BW_TRY(bw_solid_adapt(s->solid[q].solid, &changed));
    if (changed) BW_TRY(bw_scene__solid_renew(s, q));
  }
  return BW_OK;
}
