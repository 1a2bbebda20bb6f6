/* The object: its parts, its arrays, what it shows. */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "coupler_internal.h"
#include "solid_films.h"

#include <math.h>
#include <string.h>

bw_coupler_config bw_coupler_config_default(void)
{
  return (bw_coupler_config){.rho = NAN,
                             .nu = NAN,
                             .kernel = BW_KERNEL_ROMA3,
                             .iterations = 1,
                             .memory = 0.2,
                             .retraction = NAN,
                             .probe_length = 2.0,
                             .probe_profile = BW_PROBE_QUADRATIC,
                             .solid_safety = 0.8,
                             .load_relaxation = NAN,
                             .virtual_mass = 1.0,
                             .coupling_iterations = 1,
                             .coupling_residual = 1e-4,
                             .check_book = true,
                             .films = {.limit = NAN, .roughness = NAN, .least = -INFINITY}};
}

/* Of solids in fluids, in reason: foam in mercury, osmium in a thin gas. */
static bw_status check_density(double rho, double solid)
{
  static const double least = 1e-6, most = 1e9;
  BW_REQUIRE(
      solid / rho >= least && solid / rho <= most, BW_EINPUT,
      "coupler: the solid's density is %g, %.3g times that of the fluid, %g: from %g to %g "
      "times is possible, beyond which rounding hides what one does to the other; check units",
      solid, solid / rho, rho, least, most);
  return BW_OK;
}

/* Loads and memories of a step go on by particles, which another set of levels does not keep. */
static bw_status check_solid(const bw_solid_config *s)
{
  BW_REQUIRE(s->finer.refine.level == 0, BW_EINPUT,
             "coupler: the solid has refine.level = %d: a flow does not follow levels that change; "
             "give boxes of levels that stay",
             s->finer.refine.level);
  return BW_OK;
}

static bw_status check_config(const bw_coupler_config *q, const bw_grid_view *g)
{
  /* Required values start as NaN, which fails every comparison. */
  BW_REQUIRE(q->rho > 0.0, BW_EINPUT, "coupler: rho = %g: the fluid's density must be > 0", q->rho);
  BW_REQUIRE(q->nu > 0.0, BW_EINPUT, "coupler: nu = %g: the viscosity must be > 0", q->nu);
  BW_REQUIRE(q->solid_safety > 0.0 && q->solid_safety <= 1.0, BW_EINPUT,
             "coupler: solid_safety = %g: must lie in (0, 1]", q->solid_safety);
  BW_REQUIRE(isnan(q->load_relaxation) || (q->load_relaxation > 0.0 && q->load_relaxation <= 1.0),
             BW_EINPUT, "coupler: load_relaxation = %g: must lie in (0, 1]", q->load_relaxation);
  BW_REQUIRE(q->virtual_mass >= 0.0 && q->virtual_mass <= 100.0, BW_EINPUT,
             "coupler: virtual_mass = %g: must lie in [0, 100]", q->virtual_mass);
  BW_REQUIRE(q->coupling_iterations >= 1, BW_EINPUT,
             "coupler: coupling_iterations = %d: at least 1 (explicit)", q->coupling_iterations);
  BW_REQUIRE(!q->predictor || q->coupling_iterations == 1, BW_EINPUT,
             "coupler: predictor with coupling_iterations = %d: repeated steps find the motion "
             "themselves; choose one of the two",
             q->coupling_iterations);
  BW_REQUIRE(q->coupling_residual > 0.0, BW_EINPUT,
             "coupler: coupling_residual = %g: must be > 0, 1e-4 or so", q->coupling_residual);
  BW_REQUIRE(isnan(q->retraction) || fabs(q->retraction) <= 2.0, BW_EINPUT,
             "coupler: retraction = %g grid spacings: must lie in [-2, 2]", q->retraction);
  BW_REQUIRE(q->marker_spacing >= 0.0 && q->marker_spacing <= 4.0, BW_EINPUT,
             "coupler: marker_spacing = %g grid spacings: must lie in [0, 4] (wider leaks)",
             q->marker_spacing);
  /* Markers and probes reach two cells. */
  BW_REQUIRE(g->uniform_y && g->halo[1] >= 2, BW_EINPUT,
             "coupler: the grid must be uniform in y and have a halo of 2 (has %d)", g->halo[1]);
  return BW_OK;
}

/* For the markers, which know no fluid. */
static void set_ghosts(void *fluid)
{
  bw_ns_channel_ghosts(fluid);
}

static bw_status create_parts(bw_coupler *c)
{
  bw_grid *grid = bw_ns_channel_grid(c->fluid);
  const bw_grid_view *g = bw_grid_look(grid);
  bw_ibm_mdf_config ibm = bw_ibm_mdf_config_default();
  bw_probe_config probe = bw_probe_config_default();
  bw_pd_interface_config surface = bw_pd_interface_config_default();
  ibm.kernel = c->config.kernel;
  ibm.n_iter = c->config.iterations;
  ibm.memory = c->config.memory;
  /* Left open: markers with memory stand on the surface; without they are retracted (ERRATA 21). */
  c->on_surface = isnan(c->config.retraction) && c->config.memory > 0.0;
  if (isnan(c->config.retraction)) c->config.retraction = bw_ibm_mdf_retraction(&ibm);
  probe.length = c->config.probe_length;
  probe.profile = c->config.probe_profile;
  probe.rho = c->config.rho;
  probe.nu = c->config.nu;
  /* The box of the fluid is that of the walls the solid leans on. */
  memcpy(surface.walled, c->config.walled, sizeof surface.walled);
  memcpy(surface.upper, g->length, sizeof surface.upper);
  memset(surface.lower, 0, sizeof surface.lower);
  BW_TRY(bw_ibm_mdf_create(grid, &ibm, &c->ibm));
  bw_ibm_mdf_set_ghosts(c->ibm, set_ghosts, c->fluid);
  if (c->config.coupling_iterations > 1 && c->config.load == BW_LOAD_REACTION)
    BW_TRY(bw_ibm_mdf_create(grid, &ibm, &c->inside_fluid));
  BW_TRY(bw_probe_create(grid, &probe, &c->probe));
  BW_TRY(bw_pd_interface_create(c->solid, &surface, &c->interface));
  return c->config.films.on ? bw_coupler__solid_films_create(c) : BW_OK;
}

/* The arrays with a row per particle, in one list for creation and release. */
enum { N_VECTORS = 26 };
static void list_vectors(bw_coupler *c, double **vector[N_VECTORS])
{
  double **const all[N_VECTORS] = {
      &c->F,          &c->V,        &c->V_before, &c->X,          &c->root_inside, &c->marker_X,
      &c->root,       &c->marker_V, &c->normal,   &c->marker_dV,  &c->area,        &c->scratch[0],
      &c->scratch[1], &c->force,    &c->turn,     &c->scratch[2], &c->load,        &c->moment,
      &c->M,          &c->marker_M, &c->book.X,   &c->book.V,     &c->book.change, &c->height,
      &c->side,       &c->flow};
  memcpy(vector, all, sizeof all);
}

static const bw_timer_part parts[BW_PART_COUNT] = {
    [BW_PART_MOMENTUM] = {"momentum", "cell and sub-step"},
    [BW_PART_POISSON] = {"Poisson", "cell and sub-step"},
    [BW_PART_FORCING] = {"forcing", "marker and iteration"},
    [BW_PART_PROBES] = {"probes", "probe"},
    [BW_PART_SOLID] = {"solid", "bond and evaluation"},
    [BW_PART_SURFACE] = {"surface", "particle"},
};

bw_timer *bw_coupler_timer(bw_coupler *c)
{
  return c->timer;
}

/* What has a row per particle. The surface can be no larger, so that it suffices until the set of
 * particles changes. */
static bw_status particle_arrays(bw_coupler *c)
{
  const size_t n = c->n = bw_solid_count(c->solid);
  double **vector[N_VECTORS];
  c->revision = bw_solid_revision(c->solid);
  list_vectors(c, vector);
  for (int q = 0; q < N_VECTORS; q++)
    BW_TRY(BW_ALLOCATE(vector[q], 3 * n));
  BW_TRY(bw_coupler__predictor_create(c));
  BW_TRY(BW_ALLOCATE(&c->particle, n));
  BW_TRY(BW_ALLOCATE(&c->particle_inside, n));
  BW_TRY(BW_ALLOCATE(&c->row, n));
  BW_TRY(BW_ALLOCATE(&c->broken, n));
  BW_TRY(BW_ALLOCATE(&c->body, n));
  BW_TRY(BW_ALLOCATE(&c->closed, n));
  BW_TRY(BW_ALLOCATE(&c->id, n));
  if (n > 0) memcpy(c->id, bw_solid_id(c->solid), n * sizeof *c->id);
  c->events = -1; /* not asked yet */
  BW_TRY(bw_coupler__probes_create(c));
  if (c->films != NULL) BW_TRY(bw_coupler__solid_films_rows(c));
  /* Iterations repeat a step from a state that has to be kept. */
  return c->config.coupling_iterations > 1 ? bw_coupler__iteration_create(c) : BW_OK;
}

static void release_particle_arrays(bw_coupler *c)
{
  double **vector[N_VECTORS];
  list_vectors(c, vector);
  for (int q = 0; q < N_VECTORS; q++)
    bw_release(vector[q]);
  bw_coupler__probes_release(c);
  bw_release(&c->particle);
  bw_release(&c->particle_inside);
  bw_release(&c->row);
  bw_release(&c->broken);
  bw_release(&c->body);
  bw_release(&c->closed);
  bw_release(&c->id);
  bw_release(&c->felt);
  bw_release(&c->lag);
  bw_coupler__state_release(&c->predicted);
  bw_coupler__state_release(&c->kept);
  bw_coupler__iteration_release(c);
  bw_coupler__blocks_release(&c->blocks);
  bw_coupler__bodies_release(c);
}

static bw_status create_arrays(bw_coupler *c)
{
  BW_TRY(bw_timer_create(BW_PART_COUNT, parts, &c->timer));
  BW_TRY(particle_arrays(c));
  BW_TRY(bw_field_create(bw_ns_channel_grid(c->fluid), &c->p_mean));
  return bw_field_create(bw_ns_channel_grid(c->fluid), &c->inside);
}

/* What a step takes over from the one before, (n,3) each, with the ids of the particles. */
enum { N_CARRIED = 5 };
typedef struct {
  size_t n;
  int64_t *id;
  double *of[N_CARRIED];
} carried;

static void list_carried(bw_coupler *c, double **of[N_CARRIED])
{
  double **const all[N_CARRIED] = {&c->F, &c->V_before, &c->M, &c->felt, &c->lag};
  memcpy(of, all, sizeof all);
}

/* Out of the coupler's arrays, which are to be released. */
static carried take(bw_coupler *c)
{
  carried k = {.n = c->n, .id = c->id};
  double **of[N_CARRIED];
  list_carried(c, of);
  c->id = NULL;
  for (int q = 0; q < N_CARRIED; q++) {
    k.of[q] = *of[q];
    *of[q] = NULL;
  }
  return k;
}

/* To the particles that are still here. Ids do not rise with the row, but particles that stay keep
 * their order as a rule: each search goes on behind the last find, around the end. */
static void give_back(bw_coupler *c, const carried *k)
{
  double **of[N_CARRIED];
  list_carried(c, of);
  size_t at = 0;
  for (size_t i = 0; i < c->n; i++) {
    size_t tried = 0;
    while (tried < k->n && k->id[at] != c->id[i])
      at = at + 1 < k->n ? at + 1 : 0, tried++;
    if (tried == k->n) continue;
    for (int q = 0; q < N_CARRIED; q++)
      if (k->of[q] != NULL) memcpy(*of[q] + 3 * i, k->of[q] + 3 * at, 3 * sizeof **of[q]);
  }
}

bw_status bw_coupler__renew(bw_coupler *c)
{
  const bw_comm *comm = bw_solid_comm(c->solid);
  carried k = take(c);
  release_particle_arrays(c);
  bw_status st = bw_comm_agree(comm, particle_arrays(c));
  /* Load and memory of particles that were not there are not known: they are found anew. */
  if (st == BW_OK) give_back(c, &k);
  bw_release(&k.id);
  for (int q = 0; q < N_CARRIED; q++)
    bw_release(&k.of[q]);
  if (st != BW_OK) return st;
  BW_TRY(bw_coupler__bodies_create(c));
  BW_TRY(bw_coupler__bodies_number(c));
  if (c->block > 1) BW_TRY(bw_coupler__blocks_create(c));
  c->n_surface = c->n_inside = 0;
  c->inside_known = c->motion_known = false;
  return BW_OK;
}

bw_status bw_coupler_create(const bw_coupler_config *config, bw_ns_channel *fluid, bw_solid *solid,
                            bw_coupler **out)
{
  const bw_grid *grid = bw_ns_channel_grid(fluid);
  const bw_grid_view *g = bw_grid_look(grid);
  bw_coupler *c = NULL;
  *out = NULL;
  BW_TRY(check_config(config, g));
  BW_TRY(check_density(config->rho, bw_solid_settings(solid)->rho));
  BW_TRY(check_solid(bw_solid_settings(solid)));
  bw_status st = BW_ALLOCATE(&c, 1);
  st = bw_comm_agree(bw_grid_comm(grid), st);
  if (st != BW_OK) return st;
  /* From here on destroy can take the object, whatever is missing. */
  c->config = *config;
  c->choice = (bw_coupler__choice){.open = isnan(config->load_relaxation),
                                   .limit = {.relaxation = NAN, .added = NAN}};
  /* Until it is chosen; iterated: of what earlier tries do not tell. */
  if (c->choice.open) c->config.load_relaxation = 0.1;
  c->fluid = fluid;
  c->solid = solid;
  /* A solid at rest in a flow that settles: what most runs begin with. */
  c->held = c->watched = true;
  c->h = g->spacing[0];
  /* Both ends of each bond are evaluated. */
  bw_solid_ledger ledger = {0};
  st = bw_solid_account(solid, &ledger);
  c->bonds = 2.0 * (double)ledger.bonds / bw_comm_size(bw_grid_comm(grid));
  BW_THEN(st, create_parts(c));
  BW_THEN(st, bw_comm_agree(bw_grid_comm(grid), create_arrays(c)));
  /* Whole particles share a marker; a spacing below one of theirs gives each its own. */
  const double ds = ldexp(bw_solid_settings(solid)->ds, -bw_solid_finest(solid));
  const double k = c->config.marker_spacing * c->h / ds;
  c->block = (int)fmin(1e9, fmax(1.0, floor(k + 1e-9)));
  BW_THEN(st, bw_coupler__bodies_create(c));
  BW_THEN(st, bw_coupler__bodies_number(c));
  if (st == BW_OK && c->block > 1) st = bw_coupler__blocks_create(c);
  /* Markers and probes stand where the solid is. */
  BW_THEN(st, bw_coupler__follow_surface(c));
  if (st != BW_OK) bw_coupler_destroy(&c);
  *out = c;
  return st;
}

void bw_coupler_destroy(bw_coupler **coupler)
{
  bw_coupler *c = *coupler;
  if (c == NULL) return;
  bw_coupler__touch_destroy(&c->touch);
  release_particle_arrays(c);
  bw_timer_destroy(&c->timer);
  bw_release(&c->p_mean);
  bw_release(&c->inside);
  bw_coupler__solid_films_destroy(&c->films);
  bw_pd_interface_destroy(&c->interface);
  bw_probe_destroy(&c->probe);
  bw_ibm_mdf_destroy(&c->ibm);
  bw_ibm_mdf_destroy(&c->inside_fluid);
  bw_release(coupler);
}

void bw_coupler_hold_solid(bw_coupler *c, bool held)
{
  c->held = held;
}

void bw_coupler_watch(bw_coupler *c, bool watched)
{
  c->watched = watched;
}

bw_pd_interface *bw_coupler_edit_interface(bw_coupler *c)
{
  return c->interface;
}

bw_ibm_mdf *bw_coupler_markers(bw_coupler *c)
{
  return c->ibm;
}
