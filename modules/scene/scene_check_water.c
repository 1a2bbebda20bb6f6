/* What a run would refuse of a fluid of particles. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_ns_channel.h"
#include "bw_shape_surface.h"
#include "scene_check.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool bw_scene__is_open(const bw_scene_config *c, int d, int end)
{
  char name[BW_SCENE_NAME];
  int at, side, most = 1;
  for (const char *rest = c->domain.open; bw_scene__next_name(&rest, name);)
    if (bw_scene__side_named(name, &at, &side) && at == d && side == end) return true;
  if (c->domain.open[0] != '\0') return false;
  /* Left out: the side that the weight points away from most. */
  for (int k = 0; k < 3; k++)
    if (fabs(c->gravity[k]) > fabs(c->gravity[most])) most = k;
  return d == most && c->gravity[d] != 0.0 && end == (c->gravity[d] < 0.0);
}

bool bw_scene__is_wall(const bw_scene_config *c, int b)
{
  if (!bw_scene__has_particles(c) || c->bodies[b].motion != BW_SCENE_FIXED) return false;
  for (int a = 0; a < c->n_bodies; a++)
    if (bw_scene__joined(c, a, b)) return false;
  return true;
}

/* Keys of a flow on a grid must not look as if they did something here. */
static bw_status check_no_grid(const bw_scene_config *c)
{
  const bw_scene_fluid *f = &c->fluid;
  const struct {
    const char *key, *remedy;
    bool given;
  } rows[] = {{"fluid.sides", "its box has walls; domain.open names sides without", f->has_sides},
              {"fluid.forcing", "gravity drives it", f->has_forcing},
              {"fluid.film_roughness", "its particles fill the gaps", !isnan(f->film_roughness)},
              {"fluid.film_limit", "its particles fill the gaps", !isnan(f->film_limit)},
              {"fluid.film_least", "its particles fill the gaps", !isnan(f->film_least)},
              {"fluid.film_flux", "its particles fill the gaps", f->film_flux != 0},
              {"fluid.eddy", "it has a viscosity of its own", f->eddy != BW_EDDY_NONE},
              {"fluid.start.developed", "there is no inflow", f->start.developed},
              {"fluid.start.vortices", "it starts from velocity", f->start.n_vortices > 0},
              {"fluid.start.file", "it starts from velocity", f->start.file[0] != '\0'},
              {"domain.stretch", "particles are evenly apart", c->domain.stretch != 0.0}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    BW_REQUIRE(!rows[q].given, BW_EINPUT, "%s: not with fluid.model: particles (%s); leave it out",
               rows[q].key, rows[q].remedy);
  return BW_OK;
}

/* Places of particles are cubes that fill the box; what is open are sides of it. */
static bw_status check_box(const bw_scene_config *c)
{
  const bool flat = bw_scene__planar(c);
  const double h = c->domain.length[1] / c->domain.cells[1];
  char name[BW_SCENE_NAME];
  int d, end;
  for (int k = 0; k < (flat ? 2 : 3); k++)
    BW_REQUIRE(fabs(c->domain.length[k] / c->domain.cells[k] / h - 1.0) < 1e-6, BW_EINPUT,
               "domain.cells[%d] = %d: the places of particles are cubes; %g would give the "
               "spacing %g of y",
               k, c->domain.cells[k], c->domain.length[k] / h, h);
  for (const char *rest = c->domain.open; bw_scene__next_name(&rest, name);)
    BW_REQUIRE(strcmp(name, "none") == 0 || bw_scene__side_named(name, &d, &end), BW_EINPUT,
               "domain.open = %s: must be of x_lower, x_upper, y_lower, y_upper, z_lower, z_upper, "
               "or none",
               name);
  BW_REQUIRE(!flat || c->gravity[2] == 0.0, BW_EINPUT,
             "gravity[2] = %g: the scene has two dimensions; give 0", c->gravity[2]);
  return BW_OK;
}

/* The fluid is in the box. */
static bw_status check_shape(const bw_scene_config *c)
{
  bw_scene__shapes s;
  const double h = c->domain.length[1] / c->domain.cells[1];
  const double tie = 1e-9 * c->domain.length[1];
  BW_REQUIRE(c->fluid.n_shape > 0, BW_EINPUT,
             "fluid.shape is missing: where the particles of the fluid are at first, as {box: "
             "{from: ..., to: ...}}");
  bw_status st = bw_scene__shapes_make(c, BW_SCENE__FLUID, &s);
  for (int d = 0; st == BW_OK && d < (bw_scene__planar(c) ? 2 : 3); d++)
    if (!(s.lower[d] >= -tie && s.upper[d] <= c->domain.length[d] + tie && s.lower[d] < s.upper[d]))
      st = BW_FAIL(BW_EINPUT,
                   "fluid.shape: it goes from %g to %g along %c, in a box from 0 to %g; keep it "
                   "inside, or enlarge domain.length",
                   s.lower[d], s.upper[d], "xyz"[d], c -> domain.length[d]);
    else if (s.upper[d] - s.lower[d] < h * (1.0 - 1e-9))
      st = BW_FAIL(BW_EINPUT,
                   "fluid.shape: it is %g thick along %c, thinner than a particle: they are %g "
                   "apart; enlarge it, or take more domain.cells",
                   s.upper[d] - s.lower[d], "xyz"[d], h);
  bw_scene__shapes_release(&s);
  return st;
}

/* A body that stands still is a wall of the fluid: three layers of it are seen. */
static bw_status check_wall(const bw_scene_config *c, int b)
{
  const double h = c->domain.length[1] / c->domain.cells[1];
  bw_scene__shapes s;
  bw_status st = bw_scene__shapes_make(c, b, &s);
  for (int d = 0; st == BW_OK && d < (bw_scene__planar(c) ? 2 : 3); d++)
    if (s.upper[d] - s.lower[d] < 3.0 * h * (1.0 - 1e-9))
      st = BW_FAIL(BW_EINPUT,
                   "bodies.%s.shape: it is %g thick along %c; a fixed body in a fluid of particles "
                   "is at least 3 spacings thick, %g",
                   c->bodies[b].name, s.upper[d] - s.lower[d], "xyz"[d], 3.0 * h);
  bw_scene__shapes_release(&s);
  return st;
}

/* ---- ways of prescribed bodies ---- */

/* Points of a body along each direction of its extent, and moments of its way. */
enum { POINTS = 12, MOMENTS = 1000 };

/* A body on its way: its points at one moment. */
typedef struct {
  int n;
  double at[POINTS * POINTS * POINTS][3]; /* where they begin [L] */
  double X[POINTS * POINTS * POINTS][3];  /* where they are [L] */
} way;

static void place_points(const bw_scene__shapes *s, bool flat, double tie, way *w)
{
  const int edge[3] = {POINTS, POINTS, flat ? 1 : POINTS};
  for (int q = 0; q < edge[0] * edge[1] * edge[2]; q++) {
    const int index[3] = {q % POINTS, q / POINTS % POINTS, q / POINTS / POINTS};
    double *x = w->at[w->n];
    for (int d = 0; d < 3; d++)
      x[d] = s->lower[d] + (s->upper[d] - s->lower[d]) * index[d] / (POINTS - 1);
    if (flat) x[2] = 0.0;
    w->n += bw_shape_distance(s->n, s->shape, flat, x) <= tie;
  }
}

/* What stands in the way: a fixed body, or (wall NULL) a closed side of the box. */
typedef struct {
  const bw_scene__shapes *wall;
  int d, end;
  char name[BW_SCENE_NAME + 24];
} obstacle;

/* How deep the points are in it [L]. */
static double depth_in(const bw_scene_config *c, const obstacle *o, const way *w)
{
  double depth = -HUGE_VAL;
  for (int i = 0; i < w->n; i++) {
    const double *X = w->X[i];
    if (o->wall != NULL)
      depth = fmax(depth, -bw_shape_distance(o->wall->n, o->wall->shape, bw_scene__planar(c), X));
    else
      depth = fmax(depth, o->end == 0 ? -X[o->d] : X[o->d] - c->domain.length[o->d]);
  }
  return depth;
}

/* What begins in a wall moves in it as a rod in its hole; what gets into one squeezes the water
 * between them until the run breaks off. */
static bw_status follow(const bw_scene_config *c, const bw_scene_body *body, const obstacle *o,
                        way *w)
{
  const double h = c->domain.length[1] / c->domain.cells[1];
  const double end = c->phases[c->n_phases - 1].until.time;
  for (int q = 0; q <= MOMENTS; q++) {
    const double time = q == 0 ? 0.0 : end * q / MOMENTS;
    for (int i = 0; i < w->n; i++)
      bw_scene__motion(body, w->at[i], time, w->X[i]);
    const double depth = depth_in(c, o, w);
    if (q == 0 && depth > 1e-6 * h) return BW_OK;
    BW_REQUIRE(depth <= h, BW_EINPUT,
               "bodies.%s: by t = %g its motion brings it into %s by more than a spacing, %g, and "
               "the water between has no way out: change its motion or its place, or end earlier",
               body->name, time, o->name, h);
    if (!isfinite(end)) return BW_OK; /* of a run that ends otherwise nobody knows how far */
  }
  return BW_OK;
}

static bw_status meet_sides(const bw_scene_config *c, const bw_scene_body *body, way *w)
{
  for (int q = 0; q < (bw_scene__planar(c) ? 4 : 6); q++) {
    obstacle o = {.d = q / 2, .end = q % 2};
    if (bw_scene__is_open(c, o.d, o.end)) continue;
    snprintf(o.name, sizeof o.name, "the closed side %c_%s", "xyz"[o.d],
             o.end == 0 ? "lower" : "upper");
    BW_TRY(follow(c, body, &o, w));
  }
  return BW_OK;
}

/* Images have no distance: they are not looked at. */
static bw_status meet_bodies(const bw_scene_config *c, const bw_scene_body *body, way *w)
{
  bw_scene__shapes *wall = NULL;
  bw_status st = BW_ALLOCATE(&wall, 1);
  for (int k = 0; k < c->n_bodies && st == BW_OK; k++) {
    if (!bw_scene__is_wall(c, k)) continue;
    obstacle o = {.wall = wall};
    snprintf(o.name, sizeof o.name, "bodies.%s", c->bodies[k].name);
    st = bw_scene__shapes_make(c, k, wall);
    if (st == BW_OK && wall->analytic) st = follow(c, body, &o, w);
    bw_scene__shapes_release(wall);
  }
  bw_release(&wall);
  return st;
}

static bw_status check_way(const bw_scene_config *c, int b)
{
  const double tie = 1e-6 * c->domain.length[1] / c->domain.cells[1];
  bw_scene__shapes s;
  way *w = NULL;
  bw_status st = bw_scene__shapes_make(c, b, &s);
  BW_THEN(st, BW_ALLOCATE(&w, 1));
  if (st == BW_OK && s.analytic) {
    place_points(&s, bw_scene__planar(c), tie, w);
    st = meet_sides(c, &c->bodies[b], w);
    BW_THEN(st, meet_bodies(c, &c->bodies[b], w));
  }
  bw_scene__shapes_release(&s);
  bw_release(&w);
  return st;
}

static bw_status check_bodies(const bw_scene_config *c)
{
  for (int b = 0; b < c->n_bodies; b++) {
    const bw_scene_body *body = &c->bodies[b];
    BW_REQUIRE(body->motion != BW_SCENE_RIGID, BW_EINPUT,
               "bodies.%s.motion = rigid: in a fluid of particles: not in this build; make it "
               "elastic and stiff",
               body->name);
    if (bw_scene__is_wall(c, b)) BW_TRY(check_wall(c, b));
    if (body->motion == BW_SCENE_PRESCRIBED) BW_TRY(check_way(c, b));
    BW_REQUIRE(bw_scene__is_wall(c, b) || !c->domain.has_shake, BW_EINPUT,
               "domain.shake: walls that are shaken do not move bodies.%s with them; leave one of "
               "the two out",
               body->name);
  }
  return BW_OK;
}

bw_status bw_scene__check_water(const bw_scene_config *c)
{
  BW_TRY(check_no_grid(c));
  BW_TRY(check_box(c));
  BW_TRY(check_shape(c));
  return check_bodies(c);
}
