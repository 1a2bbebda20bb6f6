/* assembly_scene.h -- a plate turned by 17 degrees and a ball of another spacing and material above
 * it, in a set: for the tests of contact between bodies. */
#pragma once
#include "bw_solid_assembly.h"
#include "pd_test.h"

#include <string.h>

static const double TURN = 17 * 3.14159265358979323846 / 180;

static inline void turn_about_y(bw_solid_config *c, double angle)
{
  const double axes[3][3] = {{cos(angle), 0, -sin(angle)}, {0, 1, 0}, {sin(angle), 0, cos(angle)}};
  memcpy(c->axes, axes, sizeof axes);
}

static inline pd_body ball_sites(int radius)
{
  const int side = 2 * radius + 1;
  pd_body b = pd_box(side, side, side);
  int64_t kept = 0;
  for (int64_t q = 0; q < b.n; q++) {
    const int32_t *s = b.site + 3 * q;
    const double r2 = pow(s[0] - radius, 2) + pow(s[1] - radius, 2) + pow(s[2] - radius, 2);
    if (r2 > (radius + 0.3) * (radius + 0.3)) continue;
    memmove(b.site + 3 * kept++, s, 3 * sizeof *s);
  }
  b.n = kept;
  return b;
}

/* A plate turned by 17 degrees and a ball of spacing 0.7 above it. */
typedef struct {
  bw_solid *plate, *ball;
  bw_solid_assembly *set;
} scene;

static double speed[3];

static inline void thrown(const double X0[3], double v[3])
{
  (void)X0;
  memcpy(v, speed, sizeof speed);
}

static inline bw_solid_config plate_config(void)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.ds = 1;
  c.rho = 8;
  c.E = 40;
  turn_about_y(&c, TURN);
  /* The middle of the plate's upper face is at the origin. */
  const double half[3] = {6, 6, 3};
  for (int k = 0; k < 3; k++)
    c.origin[k] = 0;
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++)
      c.origin[k] -= c.axes[a][k] * half[a];
  return c;
}

static inline bw_solid_config ball_config(double height)
{
  bw_solid_config c = pd_soft(BW_PD_3D);
  c.ds = 0.7;
  c.rho = 3;
  c.E = 7;
  const double middle = 0.7 * 3.5;
  const double at[3] = {0.3, -0.2, height};
  for (int k = 0; k < 3; k++)
    c.origin[k] = at[k] - middle;
  return c;
}

static inline scene throw_ball(const bw_comm *comm, bw_solid_config plate, bw_solid_config ball,
                               uint8_t kind, double v)
{
  scene s = {0};
  pd_body flat = pd_box(12, 12, 3), round = ball_sites(3);
  memset(flat.kind, kind, (size_t)flat.n);
  s.plate = pd_make(comm, &plate, &flat);
  s.ball = pd_make(comm, &ball, &round);
  bw_check_ok(bw_solid_assembly_create(2, (bw_solid *[]){s.plate, s.ball}, &s.set));
  memcpy(speed, (double[]){0.1 * v, 0.05 * v, -v}, sizeof speed);
  pd_set(s.ball, NULL, thrown);
  pd_body_release(&flat);
  pd_body_release(&round);
  return s;
}

static inline void scene_release(scene *s)
{
  bw_solid_assembly_destroy(&s->set);
  bw_solid_destroy(&s->plate);
  bw_solid_destroy(&s->ball);
}

static inline bw_solid_ledger book(const scene *s)
{
  bw_solid_ledger l = {0};
  bw_check_ok(bw_solid_assembly_account(s->set, &l));
  return l;
}

static inline double energy(const bw_solid_ledger *l)
{
  return l->kinetic + l->elastic + l->contact + l->retired + l->damping + l->fracture - l->external;
}

static inline void steps(const scene *s, int n, double dt)
{
  for (int q = 0; q < n; q++)
    bw_check_ok(bw_solid_assembly_step(s->set, dt));
}

/* Upward momentum of the ball. */
static inline double upward(const scene *s)
{
  return ledger_of(s->ball).momentum[2];
}

static const double THROW = 0.15; /* some 0.12 of the plate's wave speed */
static const double HEIGHT = 3; /* of the ball's middle: its lowest particle is 0.9 over the face */
static const double FLIGHT = 27; /* there and back again */
