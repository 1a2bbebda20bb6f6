/* Contact of particles with true surfaces. */
#include "rigid_touch.h"
#include "bw_memory.h"

#include <math.h>
#include <string.h>

struct bw_coupler__touch {
  bw_solid *solid;  /* borrowed */
  bw_rigid *rigid;  /* borrowed */
  double period[3]; /* [L], 0: none */
  size_t n;         /* particles of this rank */
  double *X;        /* (n,3) scratch */
  double *load;     /* (6 bodies) of the last evaluation, of all ranks */
  double energy;    /* of the last evaluation, of this rank [M L^2/T^2] */
  double closest;   /* least y/(ds/2) so far, of this rank */
  double rate2;     /* w^2 of the stiffest pair [1/T^2] */
};

/* A particle near a surface. */
typedef struct {
  double X[3];      /* its place, or that of its image nearest to the body [L] */
  double y, reach;  /* distance of the surface, and that at which they touch [L] */
  double normal[3]; /* of the surface */
} bw_coupler__spot;

/* Does own particle i, at X, touch body q? */
static bool touches(const bw_coupler__touch *t, size_t i, int q, const double X[3],
                    bw_coupler__spot *at)
{
  const bw_rigid_state s = bw_rigid_state_of(t->rigid, q);
  const bool planar = bw_solid_settings(t->solid)->geometry != BW_PD_3D;
  const double far = bw_rigid_radius(t->rigid, q);
  double r2 = 0.0;
  at->reach = 0.5 * bw_solid_spacing(t->solid, i);
  for (int d = 0; d < 3; d++) {
    double r = planar && d == 2 ? 0.0 : X[d] - s.position[d];
    if (t->period[d] > 0.0) r -= t->period[d] * round(r / t->period[d]);
    at->X[d] = s.position[d] + r;
    r2 += r * r;
  }
  if (r2 > (far + at->reach) * (far + at->reach)) return false;
  at->y = bw_rigid_distance(t->rigid, q, at->X);
  if (!(at->y < at->reach)) return false;
  bw_rigid_normal(t->rigid, q, at->X, at->normal);
  return true;
}

static bw_status inside(const bw_coupler__touch *t, size_t i, int q, const double X[3])
{
  return BW_FAIL(BW_EDIVERGED,
                 "solid: particle %lld at (%g, %g, %g) was thrown into rigid body %d; its speed or "
                 "dt is too large",
                 (long long)bw_solid_id(t->solid)[i], X[0], X[1], X[2], q);
}

/* The pair: -force joins the load of the body, energy is added. */
static void meet(bw_coupler__touch *t, size_t i, int q, const bw_coupler__spot *at, double force[3])
{
  const int n = bw_rigid_count(t->rigid);
  const bw_rigid_state s = bw_rigid_state_of(t->rigid, q);
  const double k = bw_solid_contact_force(t->solid, i), ds = 2.0 * at->reach, r = 2.0 * at->y;
  const double push = k * (ds / r - 1.0);
  double from[3];
  for (int d = 0; d < 3; d++) {
    force[d] = push * at->normal[d];
    from[d] = at->X[d] - s.position[d];
    t->load[3 * q + d] -= force[d];
  }
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    t->load[3 * (n + q) + d] -= from[e] * force[f] - from[f] * force[e];
  }
  t->energy += 0.5 * k * (ds * log(ds / r) - ds + r);
  t->closest = fmin(t->closest, r / ds);
}

/* All pairs; `pushed`: the solid that feels them, NULL: none. Collective. */
static bw_status evaluate(bw_coupler__touch *t, bw_solid *pushed, const double X[])
{
  const size_t bodies = (size_t)bw_rigid_count(t->rigid);
  const uint8_t *kind = bw_solid_kind(t->solid);
  bw_status st = BW_OK;
  memset(t->load, 0, 6 * bodies * sizeof *t->load);
  t->energy = 0.0;
  for (size_t i = 0; i < t->n; i++)
    for (int q = 0; q < (int)bodies && !(kind[i] & BW_PD_RETIRED); q++) {
      bw_coupler__spot at;
      double force[3];
      if (!touches(t, i, q, X + 3 * i, &at)) continue;
      if (at.y <= 0.0) {
        st = st == BW_OK ? inside(t, i, q, at.X) : st;
        continue;
      }
      meet(t, i, q, &at, force);
      if (pushed != NULL) bw_solid_push(pushed, i, force);
    }
  bw_comm_sum(bw_solid_comm(t->solid), 6 * bodies, t->load);
  return st;
}

/* For bw_solid_outside. */
static bw_status push(void *who, bw_solid *solid, const double X[])
{
  return evaluate(who, solid, X);
}

static double energy(const void *who)
{
  const bw_coupler__touch *t = who;
  return t->energy;
}

static double closest(const void *who)
{
  const bw_coupler__touch *t = who;
  return t->closest;
}

bw_status bw_coupler__touch_feel(bw_coupler__touch *t)
{
  bw_solid_get_position(t->solid, t->X);
  return bw_comm_agree(bw_solid_comm(t->solid), evaluate(t, NULL, t->X));
}

const double *bw_coupler__touch_load(const bw_coupler__touch *t)
{
  return t->load;
}

double bw_coupler__touch_time(const bw_coupler__touch *t)
{
  return 1.0 / sqrt(t->rate2);
}

/* At first touch dF/dy = 2 k_c dV^2/ds: of the particle alone, and of a body that is touched by
 * particles on half of its surface. Collective. */
static void find_rate(bw_coupler__touch *t)
{
  const bool planar = bw_solid_settings(t->solid)->geometry != BW_PD_3D;
  const double depth = planar ? bw_solid_settings(t->solid)->thickness : 0.0;
  double most[2] = {0.0, 0.0}, body = 0.0; /* stiffness over mass; stiffness per area */
  for (size_t i = 0; i < t->n; i++) {
    const double ds = bw_solid_spacing(t->solid, i);
    const double stiff = 2.0 * bw_solid_contact_force(t->solid, i) / ds;
    const double mass = bw_solid_density(t->solid, i) * bw_solid_volume_of(t->solid, i);
    most[0] = fmax(most[0], stiff / mass);
    most[1] = fmax(most[1], stiff / (ds * (planar ? depth : ds)));
  }
  bw_comm_max(bw_solid_comm(t->solid), 2, most);
  for (int q = 0; q < bw_rigid_count(t->rigid); q++)
    body = fmax(body,
                0.5 * most[1] * bw_rigid_area(t->rigid, q) / bw_rigid_state_of(t->rigid, q).mass);
  t->rate2 = most[0] + body;
}

/* They may touch from the start, not pierce each other: the nearest one is named. Collective. */
static bw_status check_room(bw_coupler__touch *t)
{
  double least = INFINITY, X[3] = {0.0, 0.0, 0.0};
  bw_status st = BW_OK;
  int body = 0;
  bw_solid_get_position(t->solid, t->X);
  for (size_t i = 0; i < t->n; i++)
    for (int q = 0; q < bw_rigid_count(t->rigid); q++) {
      bw_coupler__spot at;
      if (!touches(t, i, q, t->X + 3 * i, &at) || at.y / at.reach >= least) continue;
      least = at.y / at.reach, body = q;
      memcpy(X, t->X + 3 * i, sizeof X);
    }
  if (least < BW_SOLID_TOO_CLOSE)
    st = BW_FAIL(BW_EINPUT,
                 "rigid body %d: the particle of another body at (%g, %g, %g) is %.2g of half its "
                 "spacing from its surface, at least %g; move one of the two by half a spacing",
                 body, X[0], X[1], X[2], least, BW_SOLID_TOO_CLOSE);
  return bw_comm_agree(bw_solid_comm(t->solid), st);
}

bw_status bw_coupler__touch_create(bw_solid *solid, bw_rigid *rigid, const double period[3],
                                   bw_coupler__touch **out)
{
  bw_coupler__touch *t = NULL;
  *out = NULL;
  BW_TRY(bw_comm_agree(bw_solid_comm(solid), BW_ALLOCATE(&t, 1)));
  t->solid = solid, t->rigid = rigid, t->n = bw_solid_count(solid), t->closest = INFINITY;
  memcpy(t->period, period, sizeof t->period);
  bw_status st = BW_ALLOCATE(&t->X, 3 * t->n);
  BW_THEN(st, BW_ALLOCATE(&t->load, 6 * (size_t)bw_rigid_count(rigid)));
  st = bw_comm_agree(bw_solid_comm(solid), st);
  BW_THEN(st, check_room(t));
  if (st == BW_OK) find_rate(t);
  const bw_solid_outside outside = {.who = t, .push = push, .energy = energy, .closest = closest};
  BW_THEN(st, bw_solid_set_outside(solid, &outside));
  if (st != BW_OK) {
    bw_release(&t->X);
    bw_release(&t->load);
    bw_release(&t);
  }
  *out = t;
  return st;
}

void bw_coupler__touch_destroy(bw_coupler__touch **touch)
{
  bw_coupler__touch *t = *touch;
  if (t == NULL) return;
  bw_solid_forget_outside(t->solid);
  bw_release(&t->X);
  bw_release(&t->load);
  bw_release(touch);
}
