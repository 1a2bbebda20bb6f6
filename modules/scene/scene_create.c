/* A scene from its configuration: read, create, destroy, which blocks run and why. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

bw_status bw_scene_read(const bw_comm *comm, const char *path, int n_overrides,
                        const char *const overrides[], bw_scene_config *c)
{
  BW_TRY(bw_config_load(comm, path, bw_scene_fields, n_overrides, overrides, sizeof *c, c));
  bw_scene_resolve(c);
  return bw_comm_agree(comm, bw_scene_check(c));
}

void bw_scene_destroy(bw_scene **scene)
{
  bw_scene *s = *scene;
  if (s == NULL) return;
  bw_scene__gauges_destroy(s);
  bw_scene__rigid_destroy(s);
  bw_scene__fluid_destroy(s);
  bw_scene__water_destroy(s);
  bw_scene__solids_destroy(s);
  bw_release(scene);
}

bool bw_scene__asked(const bw_scene *s, const char *quantity)
{
  for (int q = 0; q < s->config.n_gauges; q++)
    if (bw_scene__listed(s->config.gauges[q].of, quantity)) return true;
  return false;
}

bool bw_scene__balances(const bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  for (int q = 0; q < c->n_gauges && s->grid != NULL && c->n_bodies > 0; q++)
    if (bw_scene__listed(c->gauges[q].of, "force") &&
        bw_scene__force_holds(c, &c->gauges[q], BW_SCENE__BY_BOX))
      return true;
  return false;
}

/* The box whose momentum is balanced: the bodies with as much room around them as they are wide,
 * where there is as much. */
static bw_status watch_box(bw_scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  int lo[3], hi[3];
  for (int b = 0; b < s->config.n_bodies; b++) {
    bw_scene__shapes shapes;
    const bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
    for (int d = 0; d < 3; d++) {
      lower[d] = fmin(lower[d], shapes.lower[d]);
      upper[d] = fmax(upper[d], shapes.upper[d]);
    }
    bw_scene__shapes_release(&shapes);
    BW_TRY(st);
  }
  for (int d = 0; d < 3; d++) {
    const double room = fmax(4.0 * g->spacing[d], 0.5 * (upper[d] - lower[d]));
    const int least = g->periodic[d] || g->n[d] < 3 ? 0 : 1;
    lo[d] = (int)fmin(fmax(0.0, round((lower[d] - room) / g->spacing[d])), g->n[d] - 1.0);
    hi[d] = (int)fmax(fmin((double)g->n[d], round((upper[d] + room) / g->spacing[d])), 1.0);
    /* Sides through which the fluid comes and goes are not faces of the box. */
    const bw_ns_side *side = s->flow.side[d];
    if (side[0].kind != BW_SIDE_WALL && lo[d] < least) lo[d] = least;
    if (side[1].kind != BW_SIDE_WALL && hi[d] > g->n[d] - least) hi[d] = g->n[d] - least;
    if (g->n[d] == 1) lo[d] = 0, hi[d] = 1;
  }
  return s->planned ? BW_OK : bw_ns_channel_watch_box(s->fluid, lo, hi);
}

static void find_speed(bw_scene *s)
{
  for (int b = 0; b < s->config.n_bodies; b++) {
    const bw_scene_body *body = &s->config.bodies[b];
    if (body->motion != BW_SCENE_PRESCRIBED) continue;
    double v[3] = {0}, lower[3], upper[3];
    bw_scene__shapes shapes;
    if (bw_scene__shapes_make(&s->config, b, &shapes) == BW_OK) {
      memcpy(lower, shapes.lower, sizeof lower);
      memcpy(upper, shapes.upper, sizeof upper);
      const double turn = body->has_rotation ? fabs(body->rotation.rate) : 0.0;
      double reach = 0.0;
      for (int d = 0; d < 2 && turn > 0.0; d++)
        reach = fmax(reach, fmax(fabs(lower[d] - body->rotation.centre[d]),
                                 fabs(upper[d] - body->rotation.centre[d])));
      for (int d = 0; d < 3; d++)
        v[d] = fabs(body->velocity[d]) + turn * reach +
               (body->has_swing
                    ? 2.0 * acos(-1.0) * body->swing.frequency * fabs(body->swing.amplitude[d])
                    : 0.0);
    }
    bw_scene__shapes_release(&shapes);
    s->speed = fmax(s->speed, v[0] + v[1] + v[2]);
  }
}

static bw_status build(bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  const bool flow = bw_scene__has_fluid(c);
  if (flow) BW_TRY(bw_scene__fluid_create(s));
  find_speed(s);
  BW_TRY(bw_scene__rigid_create(s));
  BW_TRY(bw_scene__solids_create(s));
  if (bw_scene__has_particles(c)) BW_TRY(bw_scene__water_create(s));
  if (s->fluid != NULL && s->n_solids > 0) BW_TRY(bw_scene__coupled_create(s));
  if (flow && s->n_solids == 0 && s->rigid == NULL && c->n_bodies > 0)
    BW_TRY(bw_scene__surfaces_create(s));
  if (bw_scene__balances(s)) BW_TRY(watch_box(s));
  BW_TRY(bw_scene__gauges_create(s));
  return bw_scene__phase_begin(s);
}

bw_status bw_scene__create(const bw_comm *comm, const bw_scene_config *config, bw_log *log,
                           bool planned, bw_scene **out)
{
  bw_scene *s = NULL;
  *out = NULL;
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&s, 1)));
  s->config = *config;
  s->comm = comm;
  s->log = log;
  s->planned = planned;
  s->watched = true;
  s->settled_energy = NAN;
  bw_scene_resolve(&s->config);
  s->planar = bw_scene__planar(&s->config);
  s->alive = bw_scene__any_deforms(&s->config);
  for (int b = 0; b < s->config.n_bodies; b++)
    s->alive = s->alive || s->config.bodies[b].motion == BW_SCENE_PRESCRIBED ||
               (s->config.bodies[b].motion == BW_SCENE_RIGID && !bw_scene__has_fluid(&s->config));
  bw_status st = bw_comm_agree(comm, bw_scene_check(&s->config));
  BW_THEN(st, build(s));
  if (st != BW_OK) bw_scene_destroy(&s);
  *out = s;
  return st;
}

bw_status bw_scene_create(const bw_comm *comm, const bw_scene_config *config, bw_log *log,
                          bw_scene **out)
{
  return bw_scene__create(comm, config, log, false, out);
}

const bw_scene_config *bw_scene_settings(const bw_scene *s)
{
  return &s->config;
}

static void block(FILE *out, bool runs, const char *name, const char *yes, const char *no)
{
  fprintf(out, "  %-4s %-24s %s\n", runs ? "runs" : "-", name, runs ? yes : no);
}

void bw_scene_blocks(const bw_scene *s, FILE *out)
{
  const bool flow = s->grid != NULL, water = s->water != NULL, rigid = s->rigid != NULL,
             solids = s->n_solids > 0;
  const bool markers = flow && s->config.n_bodies > 0;
  const bool coupled = flow && solids, force = bw_scene__asked(s, "force");
  bool contact =
      !flow && !water && s->n_solids > 1 && strcmp(s->config.contact.between, "none") != 0;
  for (int q = 0; q < s->n_solids; q++)
    contact = contact || s->solid[q].contact;
  const bool joined = rigid && flow && solids && strcmp(s->config.contact.between, "none") != 0;
  const bool meet = contact || joined || (rigid && isfinite(bw_rigid_dt_max(s->rigid)));
  /* Fields and particles first: the other blocks stand on them. */
  block(out, flow, "fluid, pressure", "the scene has a fluid on a grid",
        water ? "the fluid is of particles" : "no fluid");
  block(out, water, "fluid of particles", "fluid.model: particles",
        flow ? "the fluid is on a grid" : "no fluid");
  block(out, s->planar == false, "third dimension", "plane: none",
        flow || water ? "one cell in z" : "plane: stress or strain");
  block(out, solids, "particles, bonds",
        rigid   ? "a body deforms, others are what it meets"
        : water ? "a body moves in the fluid"
                : "a body deforms, or is an image in a flow",
        s->config.n_bodies == 0 ? "no body"
        : water                 ? "no body moves: they are walls of the fluid"
                                : "no body deforms: they have true surfaces");
  block(out, solids && s->alive, "solid steps", "a body deforms or is moved",
        "nothing of particles moves");
  block(out, rigid, "rigid bodies", "a body moves as one piece", "no body is rigid");
  block(out, meet, "contact", "bodies, or pieces of one, can meet",
        solids || rigid ? "contact: none, or nothing can meet" : "no particles");
  /* What is between fluid and bodies, and what gauges alone ask for. */
  block(out, water && solids, "loads by particles", "a body is in a fluid of particles",
        water ? "no body, or walls of the fluid alone" : "no fluid of particles");
  block(out, markers, "markers", "bodies are in a flow", "no body in a flow on a grid");
  block(out, coupled || (markers && !rigid && force), "probes",
        coupled ? "they load the solid" : "a gauge reads the force",
        "nobody reads the force by them");
  block(out, !isnan(s->config.fluid.film_roughness), "films", "fluid.film_roughness is given",
        "fluid.film_roughness is not given");
  block(out, bw_scene__balances(s), "momentum balance", "a gauge reads the force on all bodies",
        "no gauge reads it");
  block(out, bw_scene__asked(s, "fragments"), "fragments", "a gauge counts them",
        "no gauge counts them");
}
