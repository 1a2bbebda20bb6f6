/* The solids of a scene: which bodies share a lattice, their materials, cracks, and the set. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

void bw_scene__solids_destroy(bw_scene *s)
{
  bw_solid_assembly_destroy(&s->assembly);
  bw_scene__loads_destroy(s);
  for (int q = 0; q < s->n_solids; q++) {
    bw_pd_interface_destroy(&s->interface[q]);
    bw_solid_destroy(&s->solid[q].solid);
    bw_release(&s->solid[q].X0);
    bw_release(&s->solid[q].F);
    bw_release(&s->solid[q].V);
    bw_release(&s->solid[q].cut);
  }
}

int bw_scene__body_of(const bw_scene__solid *q, size_t i)
{
  return q->body_of[bw_solid_group(q->solid, i)];
}

/* Is a body one of particles? What deforms is; what does not where something can meet it. */
static bool has_particles(const bw_scene_config *c, int b)
{
  if (bw_scene__deforms(&c->bodies[b])) return true;
  if (bw_scene__has_particles(c)) return !bw_scene__is_wall(c, b);
  /* A rigid body in a flow has a true surface alone. */
  if (bw_scene__has_fluid(c) && c->bodies[b].motion == BW_SCENE_RIGID) return false;
  if (bw_scene__any_image(c)) return true; /* no true surface */
  if (!bw_scene__any_deforms(c)) return false;
  if (bw_scene__has_fluid(c) || strcmp(c->contact.between, "none") != 0) return true;
  for (int a = 0; a < c->n_bodies; a++)
    if (bw_scene__joined(c, a, b)) return true;
  return false;
}

/* Which bodies share a lattice: all in a flow; elsewhere those that hold each other. */
static void divide(bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  for (int b = 0; b < c->n_bodies; b++)
    s->solid_of[b] = -1;
  for (int b = 0; b < c->n_bodies; b++) {
    if (!has_particles(c, b)) continue;
    if (s->solid_of[b] < 0) s->solid_of[b] = bw_scene__has_flow(c) ? 0 : s->n_solids;
    const int mine = s->solid_of[b];
    s->n_solids = mine + 1 > s->n_solids ? mine + 1 : s->n_solids;
    /* Whoever is joined to this body comes to it, with all that it has already. */
    for (int a = 0; a < c->n_bodies; a++) {
      if (!has_particles(c, a) || !bw_scene__joined(c, a, b) || s->solid_of[a] == mine) continue;
      const int other = s->solid_of[a];
      for (int k = 0; k < c->n_bodies; k++)
        if (k == a || (other >= 0 && s->solid_of[k] == other)) s->solid_of[k] = mine;
    }
  }
  /* Numbers without gaps. */
  int n = 0, number[BW_SCENE_BODIES];
  for (int q = 0; q < s->n_solids; q++) {
    bool any = false;
    for (int b = 0; b < c->n_bodies; b++)
      any = any || s->solid_of[b] == q;
    number[q] = any ? n++ : -1;
  }
  s->n_solids = n;
  for (int b = 0; b < c->n_bodies; b++) {
    if (s->solid_of[b] < 0) continue;
    s->solid_of[b] = number[s->solid_of[b]];
    bw_scene__solid *q = &s->solid[s->solid_of[b]];
    q->body[q->n_bodies++] = b;
  }
}

/* The first body of a solid that deforms, else one of another solid, whose material is stiff
 * enough for a body that only stands in the way. */
static int model_of(const bw_scene *s, const bw_scene__solid *q)
{
  for (int k = 0; k < q->n_bodies; k++)
    if (bw_scene__deforms(&s->config.bodies[q->body[k]])) return q->body[k];
  for (int b = 0; b < s->config.n_bodies; b++)
    if (bw_scene__deforms(&s->config.bodies[b])) return b;
  return q->body[0];
}

static bw_status lattice_of(const bw_scene *s, const bw_scene__solid *q, bw_solid_config *c)
{
  const bw_scene_config *scene = &s->config;
  const int model = model_of(s, q), first = q->body[0];
  const int own =
      bw_scene__deforms(&scene->bodies[model]) && s->solid_of[model] == (int)(q - s->solid) ? model
                                                                                            : first;
  const bw_scene_body *b = &scene->bodies[own];
  for (int k = 0; k < q->n_bodies; k++) {
    const bw_scene_body *other = &scene->bodies[q->body[k]];
    BW_REQUIRE(other->spacing == b->spacing && other->turn == b->turn, BW_EINPUT,
               "bodies.%s.spacing = %g: bodies that share a flow, or of which one holds the other, "
               "share a lattice, and bodies.%s has %g; make them equal",
               other->name, other->spacing, b->name, b->spacing);
  }
  c->ds = b->spacing;
  const double z[3] = {0.0, 0.0, 1.0};
  if (b->turn != 0.0) bw_shape_turn(z, b->turn * acos(-1.0) / 180.0, c->axes);
  if (bw_scene__has_flow(scene)) return BW_OK; /* that of the fluid: from its corner */
  bw_scene__shapes shapes;
  const bw_status st = bw_scene__shapes_make(scene, own, &shapes);
  /* A box of whole spacings is filled from corner to corner. */
  for (int d = 0; d < (s->planar ? 2 : 3); d++)
    c->origin[d] = shapes.lower[d];
  bw_scene__shapes_release(&shapes);
  return st;
}

static void set_material(const bw_scene *s, int b, int m, bw_pd_material *out)
{
  const bw_scene_body *body = &s->config.bodies[b];
  const bw_scene_material *from = &s->config.materials[m];
  const bool breaks = body->motion == BW_SCENE_BREAKABLE;
  *out = (bw_pd_material){.rho = from->density,
                          .E = from->young_modulus,
                          .nu = from->poisson_ratio,
                          .G0 = breaks && !isnan(from->fracture_energy) ? from->fracture_energy
                                                                        : INFINITY};
}

/* Laws that one lattice can have: the same, or the two state-based ones. */
static bool may_meet(const char *a, const char *b)
{
  return strcmp(a, b) == 0 || (strcmp(a, "bond") != 0 && strcmp(b, "bond") != 0);
}

static bw_status materials_of(bw_scene *s, bw_scene__solid *q, bw_solid_config *c)
{
  const int model = model_of(s, q);
  const char *law = NULL;
  bool mixed = false;
  /* Nothing deforms: the numbers only have to be some. */
  if (!bw_scene__deforms(&s->config.bodies[model])) {
    c->rho = s->config.fluid.density;
    c->E = 1e-3 * c->rho * (s->speed > 0.0 ? s->speed * s->speed : 1.0);
    for (int g = 1; g < q->n_groups; g++)
      c->more.material[g - 1] = (bw_pd_material){c->rho, c->E, NAN, INFINITY};
    c->more.n = q->n_groups - 1;
    return BW_OK;
  }
  for (int g = 0; g < q->n_groups; g++) {
    const int b = q->body_of[g];
    const bool deforms = bw_scene__deforms(&s->config.bodies[b]);
    /* What does not move itself is as dense and stiff as what it holds or stops. */
    const int m = deforms ? q->material_of[g]
                          : bw_scene__material_named(&s->config, s->config.bodies[model].material);
    bw_pd_material material;
    set_material(s, deforms ? b : model, m, &material);
    const char *own = s->config.materials[m].law;
    BW_REQUIRE(law == NULL || may_meet(law, own), BW_EINPUT,
               "bodies.%s.material: its law is %s, but a body on the same lattice has %s; bonds "
               "meet no other law on one lattice: law: ordinary with poisson_ratio: 0.25 (1/3 in "
               "plane stress) is what they are, and meets correspondence",
               s->config.bodies[b].name, own, law);
    mixed |= law != NULL && strcmp(law, own) != 0;
    law = own;
    if (g == 0)
      c->rho = material.rho, c->E = material.E, c->nu = material.nu, c->G0 = material.G0;
    else
      c->more.material[g - 1] = material;
  }
  c->more.n = q->n_groups - 1;
  c->law = mixed ? &bw_pd_state_mixed_law : bw_solid_law_by_name(law);
  return BW_OK;
}

/* Do pieces of this solid meet each other? Those of a body that breaks do, and bodies in a flow
 * that nothing joins. */
static bool meets_itself(const bw_scene *s, const bw_scene__solid *q)
{
  const bw_scene_config *c = &s->config;
  if (strcmp(c->contact.between, "none") == 0) return false;
  for (int k = 0; k < q->n_bodies; k++) {
    const bw_scene_body *b = &c->bodies[q->body[k]];
    if (!bw_scene__deforms(b)) continue;
    if (b->self_contact) return true;
    for (int r = 0; r < q->n_bodies; r++)
      if (r != k && !bw_scene__joined(c, q->body[k], q->body[r])) return true;
  }
  return false;
}

static void settings_of(const bw_scene *s, const bw_scene__solid *q, bw_solid_config *c)
{
  static const bw_pd_geometry geometry[] = {[BW_SCENE_SPACE] = BW_PD_3D,
                                            [BW_SCENE_STRESS] = BW_PD_PLANE_STRESS,
                                            [BW_SCENE_STRAIN] = BW_PD_PLANE_STRAIN};
  const bw_scene_numerics *n = &s->config.numerics;
  *c = bw_solid_config_default();
  c->geometry = geometry[s->config.plane];
  c->thickness = s->config.thickness;
  c->horizon_ratio = n->horizon_ratio;
  c->volume_fraction = (bw_pd_volume_fraction)n->volume_fraction;
  c->surface_correction = (bw_pd_surface_correction)n->surface_correction;
  c->calibration = (bw_pd_calibration)n->calibration;
  c->family_reach = (bw_pd_family_reach)n->family_reach;
  c->integrator = (bw_solid_integrator)n->integrator;
  c->damping.mean = n->damping_mean;
  c->damping.pair = n->damping_pair;
  c->damping.absolute = n->damping_absolute;
  c->disorder = n->disorder;
  c->disorder_seed = n->disorder_seed;
  c->contact = q->contact;
  /* Bonds cross a periodic seam as the fluid does. */
  const bw_scene_sides *sides = &s->config.fluid.sides;
  const int kind[3] = {sides->x.lower.kind, sides->y.lower.kind, sides->z.lower.kind};
  for (int d = 0; bw_scene__has_fluid(&s->config) && d < (s->planar ? 2 : 3); d++)
    if (kind[d] == BW_SIDE_PERIODIC) c->period[d] = s->config.domain.length[d];
}

static bw_status cut_cracks(bw_scene *s, bw_scene__solid *q)
{
  for (int k = 0; k < q->n_bodies; k++) {
    const bw_scene_body *b = &s->config.bodies[q->body[k]];
    for (int r = 0; r < b->n_cracks; r++) {
      const bw_scene_crack *cut = &b->cracks[r];
      double c[3];
      for (int d = 0; d < 3; d++)
        c[d] = cut->from[d] + cut->along[d];
      BW_TRY(bw_solid_precrack(q->solid, cut->from, cut->to, s->planar ? NULL : c));
    }
  }
  return BW_OK;
}

/* Bodies in a flow are on one lattice: what is nearer than a horizon would be bonded. */
static bw_status check_bonds(bw_scene *s, bw_scene__solid *q)
{
  int strangers[2] = {-1, -1};
  bw_pd_link *link = NULL;
  uint8_t *group = NULL, *own = NULL;
  if (q->n_bodies < 2) return BW_OK;
  const size_t all = bw_solid_get_extended(q->solid).n;
  bw_status st = BW_ALLOCATE(&group, all);
  BW_THEN(st, BW_ALLOCATE(&own, q->n));
  BW_THEN(st, BW_ALLOCATE(&link, (size_t)bw_solid_max_family(q->solid)));
  st = bw_comm_agree(s->comm, st);
  /* Groups of particles tell their bodies; a partner may be another rank's. */
  for (size_t i = 0; st == BW_OK && i < q->n; i++)
    own[i] = (uint8_t)bw_solid_group(q->solid, i);
  if (st == BW_OK) bw_solid_fill_extended(q->solid, 1, own, group);
  for (size_t i = 0; st == BW_OK && i < q->n; i++) {
    const int n = bw_solid_links(q->solid, i, link);
    for (int k = 0; k < n; k++) {
      const int a = q->body_of[own[i]], b = q->body_of[group[link[k].neighbour]];
      const bool fine =
          a == b || bw_scene__joined(&s->config, a, b) ||
          (!bw_scene__deforms(&s->config.bodies[a]) && !bw_scene__deforms(&s->config.bodies[b]));
      if (!fine && link[k].intact) strangers[0] = a, strangers[1] = b;
    }
  }
  bw_release(&group);
  bw_release(&own);
  bw_release(&link);
  /* Only ranks where the two meet know of it: all agree. */
  if (st == BW_OK && strangers[0] >= 0)
    st = BW_FAIL(BW_EINPUT,
                 "bodies.%s and bodies.%s are nearer than a horizon, %g, and would be bonded; move "
                 "them apart, take a smaller spacing, or say that one holds the other: held: [{by: "
                 "NAME}]",
                 s->config.bodies[strangers[0]].name, s->config.bodies[strangers[1]].name,
                 bw_solid_horizon(q->solid));
  return bw_comm_agree(s->comm, st);
}

/* What the solid refuses in its own words, with the names that the file has for it. */
static bw_status named(const bw_scene *s, const bw_scene__solid *q, bw_status st)
{
  char words[1024];
  const bw_scene_body *b = &s->config.bodies[model_of(s, q)];
  if (st != BW_EINPUT) return st;
  snprintf(words, sizeof words, "%s", bw_last_message());
  return BW_FAIL(st, "bodies.%s, materials.%s: %s", b->name,
                 b->material[0] != '\0' ? b->material : "(none)", words);
}

/* How many particles, and what its material is like. */
static bw_status plan_solid(bw_scene *s, bw_scene__solid *q)
{
  bw_solid_config c;
  bw_pd_state_mixed_options room;
  q->contact = meets_itself(s, q);
  settings_of(s, q, &c);
  BW_TRY(lattice_of(s, q, &c));
  BW_TRY(bw_scene__count_sites(s, q, &c, &q->sites));
  bw_status st = bw_comm_agree(s->comm, bw_scene__sites_groups(s, q));
  BW_THEN(st, materials_of(s, q, &c));
  BW_THEN(st, bw_scene__law_options(s, q, &room, &c.law_options));
  BW_THEN(st, named(s, q, bw_solid_try(s->comm, &c, &q->sample)));
  return st;
}

static bw_status make_solid(bw_scene *s, bw_scene__solid *q)
{
  bw_solid_config c;
  bw_pd_state_mixed_options room;
  bw_scene__sites sites = {0};
  q->contact = meets_itself(s, q);
  settings_of(s, q, &c);
  BW_TRY(lattice_of(s, q, &c));
  /* Groups are numbered while sites are filled; materials follow them. */
  bw_status st = bw_scene__sites_make(s, q, &c, &sites);
  BW_THEN(st, materials_of(s, q, &c));
  BW_THEN(st, bw_scene__levels_of(s, q, &c));
  BW_THEN(st, bw_scene__law_options(s, q, &room, &c.law_options));
  const bw_pd_sites given = {sites.n, sites.site, sites.kind, sites.group};
  BW_THEN(st, named(s, q, bw_solid_create(s->comm, &c, &given, &q->solid)));
  bw_scene__sites_release(&sites);
  BW_TRY(st);
  BW_TRY(bw_scene__solid_arrays(s, q));
  BW_TRY(check_bonds(s, q));
  BW_TRY(cut_cracks(s, q));
  /* Tips of cracks are fine where levels change. */
  return bw_scene__solid_arrays(s, q);
}

/* Velocities at the start. */
static bw_status launch(bw_scene *s, bw_scene__solid *q)
{
  double *X = NULL;
  bool any = false;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&X, 3 * q->n));
  for (size_t i = 0; st == BW_OK && i < q->n; i++) {
    const bw_scene_body *b = &s->config.bodies[bw_scene__body_of(q, i)];
    double *V = q->V + 3 * i;
    bw_scene__velocity(b, q->X0 + 3 * i, 0.0, V);
    if (s->planar) V[2] = 0.0;
    any = any || V[0] != 0.0 || V[1] != 0.0 || V[2] != 0.0;
    if (bw_solid_kind(q->solid)[i] & BW_PD_PRESCRIBED) memset(V, 0, 3 * sizeof *V);
  }
  int64_t moving = any;
  bw_comm_sum_int(s->comm, 1, &moving);
  if (st == BW_OK && moving > 0) {
    bw_solid_get_position(q->solid, X);
    bw_solid_set_state(q->solid, X, q->V);
  }
  bw_release(&X);
  return st;
}

bw_status bw_scene__solids_create(bw_scene *s)
{
  bw_solid *solids[BW_SCENE_BODIES];
  double sites = 0.0;
  divide(s);
  for (int q = 0; q < s->n_solids && s->planned; q++) {
    BW_TRY(plan_solid(s, &s->solid[q]));
    sites += s->solid[q].sites;
  }
  s->sketched = sites > BW_SCENE__MADE;
  if (s->sketched) return BW_OK;
  for (int q = 0; q < s->n_solids; q++) {
    BW_TRY(make_solid(s, &s->solid[q]));
    BW_TRY(launch(s, &s->solid[q]));
    solids[q] = s->solid[q].solid;
  }
  const bool meet = strcmp(s->config.contact.between, "none") != 0;
  if (s->n_solids > 1 && meet) BW_TRY(bw_solid_assembly_create(s->n_solids, solids, &s->assembly));
  return bw_scene__loads_create(s);
}
