/* What --check tells of a scene that it has not made: particles, memory, pores. */
#include "scene_impl.h"

#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape_pores.h"
#include "bw_shape_way.h"
#include <math.h>
#include <string.h>

static void lattice_of(const bw_scene *s, const bw_solid_config *config, bw_shape_lattice *out)
{
  *out = (bw_shape_lattice){.ds = config->ds, .planar = s->planar};
  memcpy(out->origin, config->origin, sizeof out->origin);
  memcpy(out->axes, config->axes, sizeof out->axes);
}

/* ---- particles ---- */

bw_status bw_scene__count_body(bw_scene *s, int b, const bw_shape_lattice *lattice, double *n)
{
  static const double walked = 2e7; /* sites of the range: a second */
  enum { SAMPLES = 64 };
  bw_scene__shapes shapes;
  int64_t lo[3], hi[3], one = 0;
  *n = 0.0;
  bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
  BW_THEN(st, bw_shape_range(shapes.n, shapes.shape, lattice, lo, hi));
  if (st == BW_OK) {
    const double rows = (double)(hi[1] - lo[1]) * (double)(hi[2] - lo[2]);
    const double all = rows * (double)(hi[0] - lo[0]);
    const int samples = all > walked ? SAMPLES : 1;
    /* As many parts as make the samples together what may be walked through. */
    const double parts = samples > 1 ? fmin(rows, fmin(1e9, samples * ceil(all / walked))) : 1.0;
    for (int k = 0; k < samples && st == BW_OK; k++) {
      st = bw_shape_count(shapes.n, shapes.shape, lattice,
                          samples > 1 ? (int)floor((k + 0.5) / samples * parts) : 0, (int)parts,
                          &one);
      *n += (double)one * parts / samples;
    }
  }
  bw_scene__shapes_release(&shapes);
  return bw_scene__of_body(&s->config, b, st);
}

bw_status bw_scene__count_sites(bw_scene *s, const bw_scene__solid *q,
                                const bw_solid_config *config, double *n)
{
  bw_status st = BW_OK;
  bw_shape_lattice lattice;
  lattice_of(s, config, &lattice);
  *n = 0.0;
  for (int k = 0; k < q->n_bodies && st == BW_OK; k++) {
    double one = 0.0;
    st = bw_scene__count_body(s, q->body[k], &lattice, &one);
    *n += one;
  }
  return bw_comm_agree(s->comm, st);
}

/* ---- pores ---- */

static bool has_pores(const bw_scene_body *b)
{
  /* A rigid image is a grain. */
  if (b->motion == BW_SCENE_RIGID) return false;
  for (int p = 0; p < b->n_shape; p++)
    if (b->shape[p].has_image || b->shape[p].has_pores) return true;
  return false;
}

/* Sites counted from the first cell of the body's box. */
static bw_status tell_pores(bw_scene *s, int b, int64_t n, int32_t *site, const int64_t cells[3],
                            bw_log *log)
{
  const bw_shape_pores_box box = {.cells = {cells[0], cells[1], cells[2]}};
  bool through[3];
  double porosity = 0.0;
  bw_shape_pores p;
  for (int axis = 0; axis < 3; axis++) {
    const bw_shape_way_box ask = {.cells = {cells[0], cells[1], cells[2]}, .axis = axis};
    bw_shape_way way;
    BW_TRY(bw_shape_find_way(s->comm, &ask, n, site, &way));
    through[axis] = way.through;
    porosity = (double)way.open / ((double)cells[0] * (double)cells[1] * (double)cells[2]);
  }
  bw_log_info(log,
              "pores      bodies.%s: porosity %.4f in its box; connected along x: %s, y: %s, z: %s",
              s->config.bodies[b].name, porosity, through[0] ? "yes" : "no",
              through[1] ? "yes" : "no", through[2] ? "yes" : "no");
  BW_TRY(bw_shape_find_pores(s->comm, &box, n, site, &p));
  if (!p.known) return BW_OK;
  bw_log_info(log,
              "           estimates, in particles: pores %.1f, the largest %.1f; throats of the "
              "widest ways along x, y, z: %.1f, %.1f, %.1f",
              p.typical, p.largest, p.throat[0], p.throat[1], p.throat[2]);
  /* Said once, of the narrowest. */
  int worst = 0;
  for (int d = 1; d < 3; d++)
    if (p.throat[worst] == 0.0 || (p.throat[d] > 0.0 && p.throat[d] < p.throat[worst])) worst = d;
  if (s->grid != NULL && p.throat[worst] > 0.0 && p.throat[worst] < 5.0)
    bw_log_warn(log,
                "bodies.%s: the widest way along %c has a throat of about %.1f cells; probes need "
                "5 there (numerics.load: reaction does not), and the flow in it is not resolved",
                s->config.bodies[b].name, "xyz"[worst], p.throat[worst]);
  return BW_OK;
}

/* Of one body, at the spacing of its particles, where a rank can hold it. */
static bw_status find_pores(bw_scene *s, int b, bw_log *log)
{
  const bw_scene_body *body = &s->config.bodies[b];
  bw_scene__shapes shapes;
  bw_shape_lattice lattice = {.ds = body->spacing, .planar = s->planar};
  int64_t lo[3], hi[3], cells[3], n = 0;
  double all = 1.0;
  int32_t *site = NULL;
  uint8_t *kind = NULL, *group = NULL;
  bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
  for (int d = 0; st == BW_OK && d < 3; d++)
    lattice.origin[d] = s->config.has_domain ? 0.0 : shapes.lower[d];
  BW_THEN(st, bw_shape_range(shapes.n, shapes.shape, &lattice, lo, hi));
  for (int d = 0; st == BW_OK && d < 3; d++) {
    /* The box is that of the shapes: its centres between the two ends. */
    lo[d] = (int64_t)ceil((shapes.lower[d] - lattice.origin[d]) / lattice.ds - 0.5 - 1e-9);
    hi[d] = (int64_t)ceil((shapes.upper[d] - lattice.origin[d]) / lattice.ds - 0.5 - 1e-9);
    cells[d] = hi[d] > lo[d] ? hi[d] - lo[d] : 1;
    all *= (double)cells[d];
  }
  st = bw_comm_agree(s->comm, st);
  const bool fits = st == BW_OK && all <= (double)BW_SHAPE_PORES_MOST;
  if (fits)
    st = bw_shape_fill_shared(s->comm, shapes.n, shapes.shape, &lattice, &n, &site, &kind, &group);
  for (int64_t i = 0; st == BW_OK && i < 3 * n; i++)
    site[i] = (int32_t)(site[i] - lo[i % 3]);
  if (fits) BW_THEN(st, tell_pores(s, b, n, site, cells, log));
  if (st == BW_OK && !fits)
    bw_log_info(log, "pores      bodies.%s: its box has more than %lld particles: not estimated",
                body->name, (long long)BW_SHAPE_PORES_MOST);
  bw_scene__shapes_release(&shapes);
  bw_release(&site);
  bw_release(&kind);
  bw_release(&group);
  return st;
}

/* ---- memory, steps ---- */

/* Sub-steps of solids in a flow, as the coupler counts them. */
static bw_status check_substeps(bw_scene *s, bw_log *log)
{
  const bw_scene__solid *q = &s->solid[0];
  const double dt = bw_scene__limit(s), share = s->config.numerics.solid_share;
  const double limit = s->sketched ? q->sample.dt_max : bw_solid_dt_max(q->solid);
  const double n = fmax(1.0, ceil(dt / (share * limit)));
  BW_REQUIRE(n <= BW_COUPLER_MOST_SUBSTEPS, BW_EINPUT,
             "a step of %g takes %.3g solid sub-steps, more than %d: numerics.step: a shorter one, "
             "or a softer or heavier solid, or larger particles",
             dt, n, BW_COUPLER_MOST_SUBSTEPS);
  bw_log_info(log, "coupling   about %.0f sub-steps of the solid in a step of %.3g", n, dt);
  return BW_OK;
}

bw_status bw_scene__plan_describe(bw_scene *s, bw_log *log)
{
  const int ranks = bw_comm_size(s->comm);
  double bytes = s->grid != NULL ? s->flow_plan.bytes : s->water != NULL ? s->water->bytes : 0.0;
  /* The scene, and what was read of it. */
  bytes += 2.0 * sizeof *s;
  const double field =
      s->grid != NULL ? sizeof(bw_real) * (double)bw_grid_look(s->grid)->size : 0.0;
  for (int q = 0; q < s->n_solids; q++)
    bytes += (s->sketched ? s->solid[q].sites : (double)bw_solid_total(s->solid[q].solid)) *
             s->solid[q].sample.bytes / ranks;
  /* The coupler holds two fields, and what acts at the particles' surface; markers one. */
  if (s->grid != NULL && s->config.n_bodies > 0) bytes += (s->n_solids > 0 ? 2.0 : 1.0) * field;
  bw_comm_max(s->comm, 1, &bytes);
  for (int b = 0; b < s->config.n_bodies && !s->planar; b++)
    if (has_pores(&s->config.bodies[b])) BW_TRY(find_pores(s, b, log));
  if (bw_scene__has_flow(&s->config) && s->n_solids > 0 && s->alive) BW_TRY(check_substeps(s, log));
  bw_log_info(log,
              "memory     about %.3g MiB for each of %d ranks, a third more while it is built and "
              "written",
              bytes / 1048576.0, ranks);
  if (s->sketched)
    bw_log_info(log,
                "           more than %d particles: places of gauges and loads, and bodies "
                "nearer than a horizon, are looked at when it runs",
                BW_SCENE__MADE);
  return BW_OK;
}
