/* What others see of a solid and set: most of it is the body's. */
#include "solid_internal.h"

#include <math.h>

void bw_solid_enable_breakage(bw_solid *s, bool on)
{
  s->body->breakage = on;
}

bool bw_solid_breaks(const bw_solid *s)
{
  return s->body->breakage;
}

void bw_solid_set_damping(bw_solid *s, double pair, double mean, double absolute)
{
  bw_pd_body_set_damping(s->body, pair, mean, absolute);
}

bw_status bw_solid_set_G0(bw_solid *s, double G0)
{
  BW_REQUIRE(G0 > 0, BW_EINPUT, "solid: G0 = %g must be positive", G0);
  s->config.G0 = s->body->config.material[0].G0 = G0;
  s->body->law->constants(s->body);
  /* A law that stiffens up to its limit has another stable step with another limit. */
  return s->body->law->bound(s->body);
}

void bw_solid_set_force(bw_solid *s, const double F[])
{
  bw_pd_body_set_force(s->body, F);
}

void bw_solid_set_prescribed(bw_solid *s, const double V[])
{
  bw_pd_body_set_prescribed(s->body, V);
}

bw_status bw_solid_set_walls(bw_solid *s, int n, const bw_pd_wall wall[])
{
  BW_REQUIRE(n == 0 || s->contact != NULL, BW_EINPUT, "solid: walls need contact = true");
  return s->contact == NULL ? BW_OK : bw_pd_contact_set_walls(s->contact, n, wall);
}

size_t bw_solid_list_bytes(const bw_solid *s)
{
  return bw_pd_body_list_bytes(s->body);
}

size_t bw_solid_count(const bw_solid *s)
{
  return s->body->n;
}

int64_t bw_solid_total(const bw_solid *s)
{
  return s->body->points.total;
}

const int64_t *bw_solid_id(const bw_solid *s)
{
  return s->body->points.id;
}

const uint8_t *bw_solid_kind(const bw_solid *s)
{
  return s->body->points.kind;
}

const bw_solid_config *bw_solid_settings(const bw_solid *s)
{
  return &s->config;
}

const bw_comm *bw_solid_comm(const bw_solid *s)
{
  return s->body->comm;
}

bw_pd_body *bw_solid_body(const bw_solid *s)
{
  return s->body;
}

double bw_solid_horizon(const bw_solid *s)
{
  return s->body->level[0].horizon;
}

double bw_solid_micromodulus(const bw_solid *s)
{
  return s->body->law->micromodulus(s->body, 0);
}

double bw_solid_critical_stretch(const bw_solid *s)
{
  return s->body->law == &bw_pd_bond_law ? bw_pd_bond_law_critical_stretch(s->body, 0) : NAN;
}

double bw_solid_volume(const bw_solid *s)
{
  return s->body->level[0].dv;
}

int bw_solid_level(const bw_solid *s, size_t i)
{
  return (int)(bw_pd_body_level(s->body, i) - s->body->level);
}

int bw_solid_group(const bw_solid *s, size_t i)
{
  return s->body->points.group[i];
}

double bw_solid_density(const bw_solid *s, size_t i)
{
  return bw_pd_body_material(s->body, i)->rho;
}

double bw_solid_horizon_of(const bw_solid *s, size_t i)
{
  return bw_pd_body_level(s->body, i)->horizon;
}

double bw_solid_volume_of(const bw_solid *s, size_t i)
{
  return bw_pd_body_level(s->body, i)->dv;
}

double bw_solid_spacing(const bw_solid *s, size_t i)
{
  return bw_pd_body_level(s->body, i)->ds;
}

void bw_solid_get_reference(const bw_solid *s, double X0[])
{
  bw_pd_body_get_reference(s->body, X0);
}

void bw_solid_get_position(const bw_solid *s, double X[])
{
  bw_pd_body_get_position(s->body, X);
}

void bw_solid_get_velocity(const bw_solid *s, double V[])
{
  bw_pd_body_get_velocity(s->body, V);
}

void bw_solid_get_acceleration(const bw_solid *s, double A[])
{
  bw_pd_body_get_acceleration(s->body, A);
}

void bw_solid_get_damage(const bw_solid *s, double damage[])
{
  bw_pd_body_get_damage(s->body, damage);
}

void bw_solid_get_broken(const bw_solid *s, uint16_t broken[])
{
  bw_pd_body_get_broken(s->body, broken);
}

void bw_solid_set_state(bw_solid *s, const double X[], const double V[])
{
  bw_pd_body_set_state(s->body, X, V);
}

int64_t bw_solid_events(const bw_solid *s)
{
  return s->body->bonds.events;
}

int64_t bw_solid_revision(const bw_solid *s)
{
  return s->body->revision;
}

int bw_solid_max_family(const bw_solid *s)
{
  return s->body->directions;
}

int bw_solid_links(const bw_solid *s, size_t h, bw_pd_link link[])
{
  return bw_pd_body_links(s->body, h, link);
}

const double *bw_solid_stencil_offset(const bw_solid *s, int slot)
{
  return s->body->level[0].stencil.xi + 3 * slot;
}

double bw_solid_stencil_fraction(const bw_solid *s, int slot)
{
  return s->body->level[0].stencil.fraction[slot];
}

int bw_solid_finest(const bw_solid *s)
{
  return s->body->finest;
}

int bw_solid_directions(const bw_solid *s, int level)
{
  return s->body->level[level].stencil.n;
}

bw_solid_direction bw_solid_leads(const bw_solid *s, int level, int slot)
{
  const bw_pd_stencil *stencil = &s->body->level[level].stencil;
  const double *xi = stencil->xi + 3 * slot;
  return (bw_solid_direction){{xi[0], xi[1], xi[2]}, stencil->volume[slot], stencil->other[slot]};
}

bw_pd_extended bw_solid_get_extended(bw_solid *s)
{
  return bw_pd_body_get_extended(s->body);
}

void bw_solid_get_place(const bw_solid *s, size_t extended, double X0[3])
{
  bw_pd_body_reference(s->body, extended, X0);
}

bw_pd_motion bw_solid_get_motion(bw_solid *s, bool velocity)
{
  return bw_pd_body_get_motion(s->body, velocity);
}

void bw_solid_fill_extended(bw_solid *s, size_t bytes, const void *own, void *all)
{
  bw_pd_body_fill_extended(s->body, bytes, own, all);
}

void bw_solid_sum_extended(bw_solid *s, double *all)
{
  bw_pd_body_sum_extended(s->body, all);
}
