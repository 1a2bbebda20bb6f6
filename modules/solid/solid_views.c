/* What others see of a solid and set: most of it is the body's. */
#include "solid_internal.h"

#include <math.h>

void bw_pd_bond_enable_breakage(bw_pd_bond *s, bool on)
{
  s->body->breakage = on;
}

void bw_pd_bond_set_damping(bw_pd_bond *s, double pair, double mean, double absolute)
{
  bw_pd_body_set_damping(s->body, pair, mean, absolute);
}

void bw_pd_bond_set_G0(bw_pd_bond *s, double G0)
{
  s->config.G0 = s->body->config.material[0].G0 = G0;
  s->body->law->constants(s->body);
}

void bw_pd_bond_set_force(bw_pd_bond *s, const double F[])
{
  bw_pd_body_set_force(s->body, F);
}

void bw_pd_bond_set_prescribed(bw_pd_bond *s, const double V[])
{
  bw_pd_body_set_prescribed(s->body, V);
}

bw_status bw_pd_bond_set_walls(bw_pd_bond *s, int n, const bw_pd_wall wall[])
{
  BW_REQUIRE(n == 0 || s->contact != NULL, BW_EINPUT, "pd_bond: walls need contact = true");
  return s->contact == NULL ? BW_OK : bw_pd_contact_set_walls(s->contact, n, wall);
}

size_t bw_pd_bond_list_bytes(const bw_pd_bond *s)
{
  return bw_pd_body_list_bytes(s->body);
}

size_t bw_pd_bond_count(const bw_pd_bond *s)
{
  return s->body->n;
}

int64_t bw_pd_bond_total(const bw_pd_bond *s)
{
  return s->body->points.total;
}

const int64_t *bw_pd_bond_id(const bw_pd_bond *s)
{
  return s->body->points.id;
}

const uint8_t *bw_pd_bond_kind(const bw_pd_bond *s)
{
  return s->body->points.kind;
}

const bw_pd_bond_config *bw_pd_bond_settings(const bw_pd_bond *s)
{
  return &s->config;
}

const bw_comm *bw_pd_bond_comm(const bw_pd_bond *s)
{
  return s->body->comm;
}

bw_status bw_pd_bond_evaluate(bw_pd_bond *s)
{
  return bw_comm_agree(s->body->comm, bw_solid__evaluate(s, false));
}

bw_pd_body *bw_pd_bond_body(const bw_pd_bond *s)
{
  return s->body;
}

double bw_pd_bond_horizon(const bw_pd_bond *s)
{
  return s->body->level->horizon;
}

double bw_pd_bond_micromodulus(const bw_pd_bond *s)
{
  return s->body->law->micromodulus(s->body, 0);
}

double bw_pd_bond_critical_stretch(const bw_pd_bond *s)
{
  return s->body->law == &bw_pd_bond_law ? bw_pd_bond_law_critical_stretch(s->body, 0) : NAN;
}

double bw_pd_bond_volume(const bw_pd_bond *s)
{
  return s->body->level->dv;
}

void bw_pd_bond_get_reference(const bw_pd_bond *s, double X0[])
{
  bw_pd_body_get_reference(s->body, X0);
}

void bw_pd_bond_get_position(const bw_pd_bond *s, double X[])
{
  bw_pd_body_get_position(s->body, X);
}

void bw_pd_bond_get_velocity(const bw_pd_bond *s, double V[])
{
  bw_pd_body_get_velocity(s->body, V);
}

void bw_pd_bond_get_acceleration(const bw_pd_bond *s, double A[])
{
  bw_pd_body_get_acceleration(s->body, A);
}

void bw_pd_bond_get_damage(const bw_pd_bond *s, double damage[])
{
  bw_pd_body_get_damage(s->body, damage);
}

void bw_pd_bond_get_broken(const bw_pd_bond *s, uint16_t broken[])
{
  bw_pd_body_get_broken(s->body, broken);
}

void bw_pd_bond_set_state(bw_pd_bond *s, const double X[], const double V[])
{
  bw_pd_body_set_state(s->body, X, V);
}

int64_t bw_pd_bond_events(const bw_pd_bond *s)
{
  return s->body->bonds.events;
}

int64_t bw_pd_bond_revision(const bw_pd_bond *s)
{
  return s->body->revision;
}

int bw_pd_bond_max_family(const bw_pd_bond *s)
{
  return s->body->level->stencil.n;
}

int bw_pd_bond_links(const bw_pd_bond *s, size_t h, bw_pd_link link[])
{
  return bw_pd_body_links(s->body, h, link);
}

const double *bw_pd_bond_stencil_offset(const bw_pd_bond *s, int slot)
{
  return s->body->level->stencil.xi + 3 * slot;
}

double bw_pd_bond_stencil_fraction(const bw_pd_bond *s, int slot)
{
  return s->body->level->stencil.fraction[slot];
}

bw_pd_extended bw_pd_bond_get_extended(bw_pd_bond *s)
{
  return bw_pd_body_get_extended(s->body);
}

void bw_pd_bond_get_place(const bw_pd_bond *s, size_t extended, double X0[3])
{
  bw_pd_body_reference(s->body, extended, X0);
}

bw_pd_motion bw_pd_bond_get_motion(bw_pd_bond *s, bool velocity)
{
  return bw_pd_body_get_motion(s->body, velocity);
}

void bw_pd_bond_fill_extended(bw_pd_bond *s, size_t bytes, const void *own, void *all)
{
  bw_pd_body_fill_extended(s->body, bytes, own, all);
}

void bw_pd_bond_sum_extended(bw_pd_bond *s, double *all)
{
  bw_pd_body_sum_extended(s->body, all);
}
