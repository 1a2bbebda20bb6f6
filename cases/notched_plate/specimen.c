/* A plate under load: its sites, its material, its loads, a step. */
#include "specimen.h"
#include "bw_memory.h"
#include <math.h>
#include <string.h>

static const double TIE = 1e-9; /* of ds: sites on an edge do not depend on rounding */

/* Distance from the edge a load acts on, and the place along it. */
static void edge_place(const specimen_config *c, int edge, const double x[3], double *depth,
                       double *along)
{
  const double depths[4] = {x[0], c->shape.length - x[0], x[1], c->shape.height - x[1]};
  *depth = depths[edge];
  *along = edge == SPECIMEN_LEFT || edge == SPECIMEN_RIGHT ? x[1] : x[0];
}

bool specimen_loaded(const specimen *p, const specimen_load *load, const double x[3])
{
  double depth, along;
  edge_place(&p->config, load->edge, x, &depth, &along);
  /* Sites on the border of the rows or of the loaded part are outside it. */
  const double tie = TIE * p->ds;
  return depth < load->rows * p->ds - tie && along > load->from + tie && along < load->to - tie;
}

bool specimen_inside(const specimen *p, int n_holes, const double x[3])
{
  const specimen_shape *s = &p->config.shape;
  const double tie = TIE * p->ds;
  if (x[0] < -tie || x[0] >= s->length - tie || x[1] < -tie || x[1] >= s->height - tie)
    return false;
  for (int q = 0; q < n_holes; q++) {
    const specimen_hole *o = &p->config.holes[q];
    if (hypot(x[0] - o->centre[0], x[1] - o->centre[1]) < o->radius - tie) return false;
  }
  return true;
}

static uint8_t loads_at(const specimen *p, const double x[3])
{
  uint8_t loads = 0;
  for (int q = 0; q < p->config.n_loads; q++)
    if (specimen_loaded(p, &p->config.loads[q], x)) loads |= (uint8_t)(1u << q);
  return loads;
}

static uint8_t kind_of(const specimen *p, uint8_t loads)
{
  uint8_t kind = BW_PD_FREE;
  for (int q = 0; q < p->config.n_loads; q++) {
    const specimen_load *load = &p->config.loads[q];
    if (loads >> q & 1 && load->kind == SPECIMEN_VELOCITY) kind |= BW_PD_PRESCRIBED;
    if (loads >> q & 1 && load->unbreakable) kind |= BW_PD_UNBREAKABLE;
  }
  return kind;
}

bw_solid_config specimen_material(const specimen *p)
{
  const specimen_solid *s = &p->config.solid;
  const specimen_shape *shape = &p->config.shape;
  /* The lattice's axes, turned; the plate itself is not. */
  const double turn = shape->lattice_angle * acos(-1.0) / 180.0;
  const double e[2] = {cos(turn), sin(turn)};
  bw_solid_config c = bw_solid_config_default();
  c.geometry = (bw_pd_geometry)s->geometry;
  c.ds = p->ds;
  c.thickness = shape->thickness;
  c.horizon_ratio = s->horizon_ratio;
  c.rho = s->density;
  c.E = s->young_modulus;
  c.G0 = s->fracture_energy;
  c.surface_correction = (bw_pd_surface_correction)s->surface_correction;
  c.volume_fraction = (bw_pd_volume_fraction)s->volume_fraction;
  c.family_reach = (bw_pd_family_reach)s->family_reach;
  c.integrator = (bw_solid_integrator)s->integrator;
  c.disorder = s->disorder;
  c.disorder_seed = s->disorder_seed;
  c.contact = s->contact;
  /* Rows of a rotation in the plane. */
  c.axes[0][0] = e[0], c.axes[0][1] = e[1];
  c.axes[1][0] = -e[1], c.axes[1][1] = e[0];
  const double half[2] = {0.5 * shape->length, 0.5 * shape->height};
  for (int d = 0; d < 2; d++) /* the middle of the plate stays where it is */
    c.origin[d] = half[d] - half[0] * c.axes[0][d] - half[1] * c.axes[1][d];
  return c;
}

/* Where the middle of a site lies in the plane. */
void specimen_place(const bw_solid_config *c, int i, int j, double x[2])
{
  const double at[2] = {(i + 0.5) * c->ds, (j + 0.5) * c->ds};
  for (int d = 0; d < 2; d++)
    x[d] = c->origin[d] + at[0] * c->axes[0][d] + at[1] * c->axes[1][d];
}

/* This rank's part of the plate's sites: an equal part of the rows along x, all of which are
 * numbered with y before z. Written when site is not NULL. Returns how many. Local. */
static int64_t scan(const specimen *p, const bw_solid_config *c, int32_t *site, uint8_t *kind)
{
  const specimen_shape *s = &p->config.shape;
  const int columns = (int)lround(s->length / p->ds), rows = (int)lround(s->height / p->ds);
  /* A turned lattice needs sites far beyond its own rows and columns to cover the corners. */
  const int over = s->lattice_angle == 0.0 ? 0 : columns + rows;
  const int layers = c->geometry == BW_PD_3D ? (int)lround(s->thickness / p->ds) : 1;
  const int64_t rank = bw_comm_rank(p->comm), ranks = bw_comm_size(p->comm);
  const int64_t in_layer = rows + 2 * (int64_t)over, all = layers * in_layer;
  int64_t n = 0;
  for (int64_t row = all * rank / ranks; row < all * (rank + 1) / ranks; row++)
    for (int i = -over; i < columns + over; i++) {
      const int j = (int)(row % in_layer) - over, k = (int)(row / in_layer);
      double x[3] = {0.0, 0.0, 0.0};
      specimen_place(c, i, j, x);
      /* Outside the plate, or in a hole. */
      if (!specimen_inside(p, p->config.n_holes, x)) continue;
      if (site != NULL) {
        site[3 * n] = i, site[3 * n + 1] = j, site[3 * n + 2] = k;
        kind[n] = kind_of(p, loads_at(p, x));
      }
      n++;
    }
  return n;
}

static bw_status cut_notches(specimen *p)
{
  for (int q = 0; q < p->config.n_notches; q++) {
    const specimen_notch *k = &p->config.notches[q];
    const double below = -p->ds, above = p->config.shape.thickness + p->ds;
    /* A line in the plane; in three dimensions a rectangle through the thickness. */
    const bool solid = p->config.solid.geometry == BW_PD_3D;
    const double z = solid ? below : 0.0;
    const double a[3] = {k->from[0], k->from[1], z}, b[3] = {k->to[0], k->to[1], z};
    const double c[3] = {k->from[0], k->from[1], above};
    BW_TRY(bw_solid_precrack(p->solid, a, b, solid ? c : NULL));
  }
  return BW_OK;
}

/* Which loads act on this rank's particles. Those of a cloud are off their sites, by less than half
 * a spacing, so that the site is the nearest one; it, not the particle, decides. Collective. */
static bw_status own_loads(specimen *p, const bw_solid_config *c)
{
  double *X = NULL;
  p->n = bw_solid_count(p->solid);
  bw_status st = BW_ALLOCATE(&p->loads, p->n);
  BW_THEN(st, BW_ALLOCATE(&X, 3 * p->n));
  st = bw_comm_agree(p->comm, st);
  if (st == BW_OK) bw_solid_get_reference(p->solid, X);
  for (size_t h = 0; st == BW_OK && h < p->n; h++) {
    const double r[2] = {X[3 * h] - c->origin[0], X[3 * h + 1] - c->origin[1]};
    int site[2];
    for (int a = 0; a < 2; a++)
      site[a] = (int)floor((r[0] * c->axes[a][0] + r[1] * c->axes[a][1]) / c->ds);
    double x[3] = {0.0, 0.0, 0.0};
    specimen_place(c, site[0], site[1], x);
    p->loads[h] = loads_at(p, x);
  }
  bw_release(&X);
  return st;
}

static bw_status make_solid(specimen *p)
{
  const bw_solid_config c = specimen_material(p);
  /* Counted first, then listed: each rank lists its part alone. */
  const int64_t n = scan(p, &c, NULL, NULL);
  int64_t all = n;
  bw_comm_sum_int(p->comm, 1, &all);
  BW_REQUIRE(all > 0, BW_EINPUT, "the plate holds no particle: shape.thickness = %g, spacing %g",
             p->config.shape.thickness, p->ds);
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * (size_t)n);
  BW_THEN(st, BW_ALLOCATE(&kind, (size_t)n));
  st = bw_comm_agree(p->comm, st);
  if (st == BW_OK) (void)scan(p, &c, site, kind);
  /* The solid brings every particle to the rank that owns it. */
  BW_THEN(st, bw_solid_create(p->comm, &c, &(bw_pd_sites){n, site, kind, NULL}, &p->solid));
  bw_release(&site);
  bw_release(&kind);
  BW_THEN(st, own_loads(p, &c));
  BW_THEN(st, cut_notches(p));
  return st;
}

/* Body force per stress of each traction [1/m]: the loaded part of the edge over the volume of the
 * particles that take it, rows ds on a lattice along the edge. Collective. */
static void share_tractions(specimen *p)
{
  const specimen_shape *s = &p->config.shape;
  const bool solid = p->config.solid.geometry == BW_PD_3D;
  const double depth = solid ? p->ds * round(s->thickness / p->ds) : s->thickness;
  int64_t count[SPECIMEN_LOADS] = {0};
  /* Who takes the load, on all ranks. */
  for (int q = 0; q < p->config.n_loads; q++)
    for (size_t h = 0; h < p->n; h++)
      count[q] += p->loads[h] >> q & 1;
  bw_comm_sum_int(p->comm, SPECIMEN_LOADS, count);
  for (int q = 0; q < p->config.n_loads; q++) {
    const specimen_load *load = &p->config.loads[q];
    const bool upright = load->edge == SPECIMEN_LEFT || load->edge == SPECIMEN_RIGHT;
    const double length = upright ? s->height : s->length;
    /* Loaded length times depth is the area; its force is shared equally by volume. */
    const double part = fmin(load->to, length) - fmax(load->from, 0.0);
    const double volume = (double)count[q] * bw_solid_volume(p->solid);
    p->share[q] = count[q] > 0 ? part * depth / volume : 0.0;
  }
}

/* Body force at the present time; nothing to do once all of it acts. */
static void apply_traction(specimen *p)
{
  memset(p->F, 0, 3 * p->n * sizeof *p->F);
  p->rising = false;
  for (int q = 0; q < p->config.n_loads; q++) {
    const specimen_load *load = &p->config.loads[q];
    if (load->kind != SPECIMEN_TRACTION) continue;
    /* Share of the final value at this time. */
    const double part = load->rise > 0.0 ? fmin(1.0, p->time / load->rise) : 1.0;
    p->rising = p->rising || part < 1.0;
    for (size_t h = 0; h < p->n; h++)
      if (p->loads[h] >> q & 1)
        for (size_t d = 0; d < 2; d++)
          p->F[3 * h + d] += part * load->value[d] * p->share[q];
  }
  bw_solid_set_force(p->solid, p->F);
}

/* Velocities that are held and those given at the start. */
static bw_status apply_velocity(specimen *p)
{
  double *X = NULL, *V = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * p->n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * p->n));
  st = bw_comm_agree(p->comm, st);
  if (st == BW_OK) {
    /* Held velocities and those given at the start; all others begin at rest. */
    for (int q = 0; q < p->config.n_loads; q++) {
      const specimen_load *load = &p->config.loads[q];
      for (size_t h = 0; load->kind != SPECIMEN_TRACTION && h < p->n; h++)
        if (p->loads[h] >> q & 1) V[3 * h] = load->value[0], V[3 * h + 1] = load->value[1];
    }
    bw_solid_get_position(p->solid, X);
    bw_solid_set_state(p->solid, X, V);
    bw_solid_set_prescribed(p->solid, V);
  }
  bw_release(&X);
  bw_release(&V);
  return st;
}

bw_status specimen_create(const bw_comm *comm, const specimen_config *config, specimen *p)
{
  BW_TRY(specimen_begin(comm, config, p));
  p->crack = (specimen_crack){{NAN, NAN}, 0.0, NAN, NAN, NAN, NAN, 0.0};
  /* Particles and cut notches; nothing acts yet. */
  BW_TRY(make_solid(p));
  bw_status st = BW_ALLOCATE(&p->X0, 3 * p->n);
  BW_THEN(st, BW_ALLOCATE(&p->damage, p->n));
  BW_THEN(st, BW_ALLOCATE(&p->notched, p->n));
  BW_THEN(st, BW_ALLOCATE(&p->F, 3 * p->n));
  p->track.step = 0.5 * p->ds;
  BW_THEN(st, bw_pd_crack_track_note(&p->track, 0.0, 0.0));
  BW_TRY(bw_comm_agree(comm, st));
  bw_solid_get_reference(p->solid, p->X0);
  /* Loads at t = 0. */
  share_tractions(p);
  apply_traction(p);
  BW_TRY(apply_velocity(p));
  /* What the notches cracked is no part of the crack that is followed. */
  bw_solid_get_damage(p->solid, p->damage);
  for (size_t h = 0; h < p->n; h++)
    p->notched[h] = p->damage[h] > BW_PD_CRACK_LEVEL;
  p->events = bw_solid_events(p->solid);
  for (int d = 0; d < 2; d++)
    p->crack.tip[d] = config->follow.from[d];
  return BW_OK;
}

bool specimen_done(const specimen *p)
{
  const double stop = p->crack.t_end + p->config.time.after; /* NaN: it goes on to time.end */
  return p->time > p->config.time.end - 1e-6 * p->config.time.step || p->time >= stop;
}

bw_status specimen_step(specimen *p)
{
  BW_TRY(bw_solid_step(p->solid, p->config.time.step));
  p->steps++;
  p->time = (double)p->steps * p->config.time.step;
  /* A load that is complete need not be told again. */
  if (p->rising) apply_traction(p);
  if (p->steps % p->config.follow.every == 0) BW_TRY(specimen_look(p));
  return BW_OK;
}

void specimen_destroy(specimen *p)
{
  bw_solid_destroy(&p->solid);
  bw_release(&p->X0);
  bw_release(&p->loads);
  bw_release(&p->damage);
  bw_release(&p->notched);
  bw_release(&p->F);
  bw_pd_crack_track_release(&p->track);
}
