/* The recipe of a step, and its book. */
#include "bw_coupler_particles.h"
#include "bw_memory.h"
#include "coupler_particles_internal.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* The part of what the virtual mass keeps that comes back with each load. */
static const double BACK = 0.1;

bw_coupler_particles_config bw_coupler_particles_config_default(void)
{
  return (bw_coupler_particles_config){.solid_safety = 0.8, .virtual_mass = 0.5, .step_share = 0.4};
}

/* ---- creating ---- */
static bw_status check(const bw_coupler_particles_config *q, const bw_ulph_config *f,
                       const bw_solid *solid)
{
  const bool planar = bw_solid_settings(solid)->geometry != BW_PD_3D;
  BW_REQUIRE(q->solid_safety > 0 && q->solid_safety <= 1, BW_EINPUT,
             "coupler_particles: solid_safety is %g; it must be above 0 and at most 1",
             q->solid_safety);
  BW_REQUIRE(q->virtual_mass >= 0 && q->virtual_mass <= 10, BW_EINPUT,
             "coupler_particles: virtual_mass is %g; it must be at least 0 and at most 10",
             q->virtual_mass);
  BW_REQUIRE(q->step_share > 0 && q->step_share <= 1, BW_EINPUT,
             "coupler_particles: step_share is %g; it must be above 0 and at most 1",
             q->step_share);
  const bw_solid_finer *finer = &bw_solid_settings(solid)->finer;
  BW_REQUIRE(finer->n == 0 && finer->refine.level == 0, BW_EINPUT,
             "coupler_particles: a body in a fluid of particles has one spacing; leave levels out");
  static const double least = 1e-6, most = 1e9;
  const double density = bw_solid_settings(solid)->rho / f->rho0;
  BW_REQUIRE(density >= least && density <= most, BW_EINPUT,
             "coupler_particles: the solid is %.3g times as dense as the fluid, %g: from %g to %g "
             "times is possible, beyond which rounding hides what one does to the other",
             density, f->rho0, least, most);
  BW_REQUIRE(planar == (f->dimensions == 2), BW_EINPUT,
             "coupler_particles: the fluid has %d dimensions and the solid %d; take the same",
             f->dimensions, planar ? 2 : 3);
  return BW_OK;
}

static bw_status make_arrays(bw_coupler_particles *c)
{
  BW_TRY(BW_ALLOCATE(&c->F, 3 * c->total));
  BW_TRY(BW_ALLOCATE(&c->area, c->total));
  BW_TRY(BW_ALLOCATE(&c->x, 3 * c->total));
  BW_TRY(BW_ALLOCATE(&c->v, 3 * c->total));
  BW_TRY(BW_ALLOCATE(&c->next, 3 * c->total));
  BW_TRY(BW_ALLOCATE(&c->X, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->density, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->load, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->owed, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->kept, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->k, c->n));
  return BW_ALLOCATE(&c->wet, c->n);
}

void bw_coupler_particles__join(const bw_coupler_particles *c, const double own[], double all[])
{
  const int64_t *id = bw_solid_id(c->solid);
  memset(all, 0, 3 * c->total * sizeof *all);
  for (size_t i = 0; i < c->n; i++)
    memcpy(all + 3 * id[i], own + 3 * i, 3 * sizeof *all);
  bw_comm_sum(bw_solid_comm(c->solid), 3 * c->total, all);
}

/* The solid's particles become a body of the fluid. */
static bw_status enter(bw_coupler_particles *c, int n_walls, const bw_ulph_wall wall[])
{
  double *volume = c->area; /* not used before the first step */
  bw_solid_get_position(c->solid, c->X);
  bw_coupler_particles__join(c, c->X, c->x);
  for (size_t i = 0; i < c->total; i++)
    volume[i] = bw_solid_volume(c->solid) / c->thickness;
  return bw_ulph_add_body(c->fluid, (int64_t)c->total, volume, c->x,
                          bw_solid_settings(c->solid)->ds, c->config.no_slip, n_walls, wall);
}

bw_status bw_coupler_particles_create(const bw_coupler_particles_config *config,
                                      const bw_ulph_config *fluid_config, bw_ulph *fluid,
                                      bw_solid *solid, int n_walls, const bw_ulph_wall wall[],
                                      bw_coupler_particles **out)
{
  const bw_comm *comm = bw_solid_comm(solid);
  bw_coupler_particles *c = NULL;
  *out = NULL;
  BW_TRY(check(config, fluid_config, solid));
  BW_TRY(bw_comm_agree(comm, BW_ALLOCATE(&c, 1)));
  c->config = *config, c->fluid = fluid, c->solid = solid;
  c->rho0 = fluid_config->rho0;
  c->thickness = fluid_config->dimensions == 2 ? bw_solid_settings(solid)->thickness : 1;
  c->n = bw_solid_count(solid), c->total = (size_t)bw_solid_total(solid);
  bw_status st = bw_comm_agree(comm, make_arrays(c));
  BW_THEN(st, enter(c, n_walls, wall));
  if (st != BW_OK) bw_coupler_particles_destroy(&c);
  *out = c;
  return st;
}

void bw_coupler_particles_destroy(bw_coupler_particles **coupler)
{
  bw_coupler_particles *c = *coupler;
  if (c == NULL) return;
  double **const all[] = {&c->F,       &c->area, &c->x,    &c->v,    &c->next, &c->X,
                          &c->density, &c->load, &c->owed, &c->kept, &c->k};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_release(&c->wet);
  bw_release(coupler);
}

void bw_coupler_particles_hold(bw_coupler_particles *c, bool held)
{
  c->held = held;
}

/* ---- a step ---- */
static double substeps(const bw_coupler_particles *c, double dt)
{
  /* The squares of frequencies add: bonds and contact. */
  const double rate = hypot(1 / bw_solid_dt_max(c->solid), 1 / bw_solid_dt_contact(c->solid));
  return fmax(1, ceil(dt * rate / c->config.solid_safety));
}

int bw_coupler_particles_substeps(const bw_coupler_particles *c, double dt)
{
  const double n = substeps(c, dt);
  return n < (double)INT_MAX ? (int)n : INT_MAX;
}

bw_status bw_coupler_particles_check_substeps(const bw_coupler_particles *c, double dt)
{
  const double n = substeps(c, dt);
  BW_REQUIRE(n <= BW_COUPLER_PARTICLES_MOST_SUBSTEPS, BW_EINPUT,
             "a step of %g takes %.3g sub-steps of the solid, more than %d: take a softer, heavier "
             "or less damped solid, or larger particles",
             dt, n, BW_COUPLER_PARTICLES_MOST_SUBSTEPS);
  return BW_OK;
}

double bw_coupler_particles_dt_max(bw_coupler_particles *c)
{
  return c->config.step_share * bw_ulph_dt_max(c->fluid);
}

/* Forces on this rank's particles: the fluid's with what is owed, and weight. */
static void set_load(bw_coupler_particles *c, double dt)
{
  const int64_t *id = bw_solid_id(c->solid);
  for (size_t i = 0; i < c->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const size_t at = 3 * i + k;
      const double back = BACK * c->kept[at];
      c->load[at] = c->thickness * c->F[3 * (size_t)id[i] + k] + c->owed[at] / dt;
      c->owed[at] -= dt * c->load[at];
      c->load[at] += back / dt;
      c->kept[at] -= back;
      c->density[at] = c->load[at] / bw_solid_volume_of(c->solid, i) +
                       bw_solid_density(c->solid, i) * c->config.gravity[k];
    }
  bw_solid_set_force(c->solid, c->density);
}

/* The virtual mass: a drag towards the velocities at the beginning. */
static bw_status resist(bw_coupler_particles *c, double dt)
{
  const int64_t *id = bw_solid_id(c->solid);
  const double mass = c->config.virtual_mass * c->rho0 * bw_ulph_c0(c->fluid) * dt * c->thickness;
  double *towards = c->density; /* the force has been set */
  size_t n = 0;
  bw_solid_get_velocity(c->solid, c->X);
  for (size_t i = 0; i < c->n && mass > 0; i++) {
    const double area = c->area[id[i]];
    if (area <= 0) continue;
    c->k[n] = mass * area / (dt * bw_solid_volume_of(c->solid, i));
    memcpy(towards + 3 * n, c->X + 3 * i, 3 * sizeof *towards);
    c->wet[n++] = (int32_t)i;
  }
  return bw_comm_agree(bw_solid_comm(c->solid),
                       bw_solid_set_drag(c->solid, n, c->wet, c->k, towards));
}

/* The solid goes through the step; what it has received is booked. */
static bw_status advance_solid(bw_coupler_particles *c, double dt)
{
  const int64_t *id = bw_solid_id(c->solid);
  const uint8_t *kind = bw_solid_kind(c->solid);
  BW_TRY(bw_coupler_particles_check_substeps(c, dt));
  const int n = bw_coupler_particles_substeps(c, dt);
  set_load(c, dt);
  BW_TRY(resist(c, dt));
  for (int q = 0; q < n; q++)
    BW_TRY(bw_solid_step(c->solid, dt / n));
  double *impulse = c->density; /* per volume, of the drag */
  c->received += bw_solid_get_drag(c->solid, impulse);
  bw_solid_get_position(c->solid, c->X);
  for (size_t i = 0; i < c->n; i++) {
    /* Held particles give their load to whoever holds them. */
    const bool moves = (kind[i] & (BW_PD_PRESCRIBED | BW_PD_RETIRED)) == 0;
    for (size_t k = 0; k < 3; k++) {
      const size_t at = 3 * i + k;
      const double moved = c->X[at] - c->x[3 * (size_t)id[i] + k];
      const double taken = impulse[at] * bw_solid_volume_of(c->solid, i);
      if (moves) c->received += c->load[at] * moved;
      c->impulse[k] += dt * c->load[at] + taken;
      c->kept[at] -= taken;
    }
  }
  return BW_OK;
}

/* New places and mean velocities of all, told to the fluid. */
static void tell(bw_coupler_particles *c, double dt)
{
  bw_coupler_particles__join(c, c->X, c->next);
  for (size_t q = 0; q < 3 * c->total; q++) {
    c->v[q] = c->held ? 0 : (c->next[q] - c->x[q]) / dt;
    c->x[q] = c->next[q];
  }
  bw_ulph_move_body(c->fluid, c->x, c->v);
}

/* The fluid's half kick with the forces F: its impulse is owed to the solid; its work. */
static void give(bw_coupler_particles *c, double half)
{
  const int64_t *id = bw_solid_id(c->solid);
  for (size_t i = 0; i < c->n && !c->held; i++)
    for (size_t k = 0; k < 3; k++) {
      const size_t at = 3 * (size_t)id[i] + k;
      const double impulse = half * c->thickness * c->F[at];
      c->owed[3 * i + k] += impulse;
      c->late -= impulse * c->v[at];
    }
}

bw_status bw_coupler_particles_step(bw_coupler_particles *c, double dt)
{
  /* The forces of the start, or of a restart. */
  if (!c->known) bw_ulph_body_force(c->fluid, c->F, c->area);
  c->known = true;
  const double received = c->received;
  if (!c->held) BW_TRY(advance_solid(c, dt));
  tell(c, dt);
  give(c, 0.5 * dt);
  BW_TRY(bw_ulph_step(c->fluid, dt));
  bw_ulph_body_force(c->fluid, c->F, c->area);
  give(c, 0.5 * dt);
  c->late += c->received - received;
  return BW_OK;
}

bw_coupler_particles_report bw_coupler_particles_measure(const bw_coupler_particles *c)
{
  bw_coupler_particles_report r = {.given = -c->thickness * bw_ulph_account(c->fluid).bodies};
  double sum[8] = {c->late, c->received, c->impulse[0], c->impulse[1], c->impulse[2]};
  for (size_t q = 0; q < 3 * c->n; q++)
    sum[5 + q % 3] += c->owed[q] + c->kept[q];
  bw_comm_sum(bw_solid_comm(c->solid), 8, sum);
  r.late = sum[0], r.received = sum[1];
  for (size_t k = 0; k < 3; k++)
    r.impulse[k] = sum[2 + k], r.pending[k] = sum[5 + k];
  for (size_t i = 0; i < c->total; i++) {
    r.wetted += c->thickness * c->area[i];
    for (size_t k = 0; k < 3; k++)
      r.force[k] += c->thickness * c->F[3 * i + k];
  }
  return r;
}

void bw_coupler_particles_load(const bw_coupler_particles *c, double F[])
{
  const int64_t *id = bw_solid_id(c->solid);
  for (size_t i = 0; i < c->n; i++)
    for (size_t k = 0; k < 3; k++)
      F[3 * i + k] = c->thickness * c->F[3 * (size_t)id[i] + k];
}

void bw_coupler_particles_pressure(const bw_coupler_particles *c, double p[])
{
  const int64_t *id = bw_solid_id(c->solid);
  bw_ulph_body_pressure(c->fluid, c->next);
  for (size_t i = 0; i < c->n; i++)
    p[i] = c->next[id[i]];
}
