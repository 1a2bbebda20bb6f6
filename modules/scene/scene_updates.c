/* What a run costs, in numbers that no machine changes: updates of cells, markers and particles,
 * one for each of the fluid's three sub-steps and of the solids' sub-steps. --check promises them
 * from the first step, the run counts them. Seconds depend on machine and ranks: no promise. */
#include "scene_impl.h"

#include <math.h>

enum { STAGES = 3 }; /* of RK3 */

/* Sub-steps of solids in a flow, as the coupler counts them, in a step; 1 without a flow. */
static double substeps(const bw_scene *s, double dt)
{
  const bw_scene__solid *q = &s->solid[0];
  if (s->grid == NULL || s->n_solids == 0 || !s->alive) return 1.0;
  const double limit = s->sketched ? q->sample.dt_max : bw_solid_dt_max(q->solid);
  /* A predictor goes through them twice. */
  const double passes = s->config.numerics.predictor ? 2.0 : 1.0;
  return passes * fmax(1.0, ceil(dt / (s->config.numerics.solid_share * limit)));
}

static double particles(const bw_scene *s)
{
  double n = 0.0;
  for (int q = 0; q < s->n_solids && s->alive; q++)
    n += s->sketched ? s->solid[q].sites : (double)bw_solid_total(s->solid[q].solid);
  return n;
}

bw_scene__cost bw_scene__cost_of_step(const bw_scene *s, double dt)
{
  bw_scene__cost c = {.particles = particles(s) * substeps(s, dt)};
  if (s->water != NULL) c.particles += s->water->sites + s->water->walls;
  if (s->grid == NULL) return c;
  const bw_grid_view *g = bw_grid_look(s->grid);
  c.cells = (double)STAGES * g->n[0] * g->n[1] * g->n[2];
  c.markers = (double)STAGES * (double)s->n_markers;
  return c;
}

void bw_scene__cost_add(bw_scene *s, double dt)
{
  const bw_scene__cost step = bw_scene__cost_of_step(s, dt);
  s->cost.cells += step.cells;
  s->cost.markers += step.markers;
  s->cost.particles += step.particles;
}

void bw_scene__cost_tell(const bw_scene *s, const bw_scene__cost *c, const char *how, bw_log *log)
{
  const bool deforms = s->grid != NULL && s->n_solids > 0;
  bw_log_info(log, "cost       %s%.4g updates of cells, %.4g of markers%s, %.4g of particles", how,
              c->cells, c->markers, deforms ? " on what does not deform" : "", c->particles);
}
