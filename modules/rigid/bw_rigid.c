/* The set of bodies: made, told, shown. */
#include "bw_memory.h"
#include "rigid_internal.h"

#include <math.h>
#include <string.h>

bw_rigid_config bw_rigid_config_default(void)
{
  return (bw_rigid_config){.depth = 1.0, .spacing = NAN, .safety = 0.2};
}

static bw_status check_config(const bw_rigid_config *c, int n)
{
  BW_REQUIRE(n >= 1, BW_EINPUT, "rigid: %d bodies: at least one", n);
  BW_REQUIRE(c->spacing > 0.0 && isfinite(c->spacing), BW_EINPUT,
             "rigid: spacing = %g of the surface points: must be > 0", c->spacing);
  BW_REQUIRE(c->depth > 0.0, BW_EINPUT, "rigid: depth = %g: must be > 0", c->depth);
  BW_REQUIRE(c->stiffness >= 0.0 && c->gap >= 0.0, BW_EINPUT,
             "rigid: stiffness = %g and gap = %g of the contact must not be negative", c->stiffness,
             c->gap);
  BW_REQUIRE(c->friction >= 0.0 && c->friction <= 10.0, BW_EINPUT,
             "rigid: friction = %g of the contact must lie in [0, 10]", c->friction);
  BW_REQUIRE(c->safety > 0.0 && c->safety <= 1.0, BW_EINPUT,
             "rigid: safety = %g of the step: must lie in (0, 1]", c->safety);
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(!(c->walled[d][0] && c->walled[d][1]) || c->upper[d] > c->lower[d], BW_EINPUT,
               "rigid: the walls along direction %d are at %g and %g", d, c->lower[d], c->upper[d]);
  return BW_OK;
}

/* Which turns are free: a row of `turns`. */
static bw_status find_turns(const bw_rigid_config *c, int q, const bw_rigid_body *ask,
                            bw_rigid__body *b)
{
  int free = 0;
  b->turns = RIGID_TOLD;
  for (int d = 0; d < 3; d++) {
    const bool held = ask->held[3 + d] || (c->planar && d < 2);
    b->held[d] = ask->held[d] || (c->planar && d == 2);
    if (!held) b->turns = d;
    free += !held;
  }
  BW_REQUIRE(free != 2, BW_EINPUT,
             "rigid body %d: two free turns are no hinge: hold none, two or all three", q);
  if (free == 3) b->turns = RIGID_FREE;
  for (int d = 0; d < 6; d++)
    BW_REQUIRE(ask->stiffness[d] >= 0.0 && ask->damping[d] >= 0.0, BW_EINPUT,
               "rigid body %d: stiffness and damping of its springs must not be negative", q);
  const double *k = ask->stiffness + 3;
  BW_REQUIRE(free != 3 || (k[0] == k[1] && k[1] == k[2]), BW_EINPUT,
             "rigid body %d: springs against the turn of a body that turns freely must be alike "
             "about all axes, found %g, %g, %g",
             q, k[0], k[1], k[2]);
  return BW_OK;
}

static bw_status make_body(const bw_rigid_config *c, int q, const bw_rigid_body *ask,
                           bw_rigid__body *b)
{
  BW_REQUIRE(ask->count >= 1, BW_EINPUT, "rigid body %d has no shape", q);
  BW_TRY(find_turns(c, q, ask, b));
  BW_TRY(BW_ALLOCATE(&b->shape, (size_t)ask->count));
  b->count = ask->count;
  memcpy(b->shape, ask->shape, (size_t)ask->count * sizeof *b->shape);
  BW_TRY(bw_rigid__mass(c, q, ask, b));
  memcpy(b->stiffness, ask->stiffness, sizeof b->stiffness);
  memcpy(b->damping, ask->damping, sizeof b->damping);
  memcpy(b->X, b->start, sizeof b->X);
  memcpy(b->R, b->axes, sizeof b->R);
  return BW_OK;
}

bw_status bw_rigid_create(const bw_comm *comm, const bw_rigid_config *config, int n,
                          const bw_rigid_body body[], bw_rigid **out)
{
  bw_rigid *r = NULL;
  *out = NULL;
  BW_TRY(check_config(config, n));
  bw_status st = BW_ALLOCATE(&r, 1);
  if (st == BW_OK) {
    r->comm = comm, r->config = *config, r->n = n;
    st = BW_ALLOCATE(&r->body, (size_t)n);
  }
  BW_THEN(st, BW_ALLOCATE(&r->sum, 12 * (size_t)n + 1));
  for (int q = 0; q < n; q++)
    BW_THEN(st, make_body(config, q, &body[q], &r->body[q]));
  BW_THEN(st, bw_rigid__make_points(r));
  st = bw_comm_agree(comm, st);
  if (st != BW_OK) {
    bw_rigid_destroy(&r);
    return st;
  }
  for (int q = 0; q < n; q++)
    bw_rigid_set_motion(r, q, body[q].velocity, body[q].spin);
  /* Of the fastest swing: 1/w. */
  r->lag = isfinite(bw_rigid_dt_max(r)) ? bw_rigid_dt_max(r) / (2.0 * config->safety) : 0.0;
  /* The first half kick needs them. */
  bw_rigid__forces(r);
  *out = r;
  return BW_OK;
}

void bw_rigid_destroy(bw_rigid **rigid)
{
  bw_rigid *r = *rigid;
  if (r == NULL) return;
  for (int q = 0; r->body != NULL && q < r->n; q++)
    bw_release(&r->body[q].shape);
  bw_release(&r->body);
  bw_release(&r->sum);
  bw_release(&r->id);
  bw_release(&r->of);
  bw_release(&r->area);
  bw_release(&r->y);
  bw_release(&r->m);
  bw_release(rigid);
}

int bw_rigid_count(const bw_rigid *r)
{
  return r->n;
}

double bw_rigid_time(const bw_rigid *r)
{
  return r->time;
}

const bw_comm *bw_rigid_comm(const bw_rigid *r)
{
  return r->comm;
}

bw_rigid_state bw_rigid_state_of(const bw_rigid *r, int q)
{
  const bw_rigid__body *b = &r->body[q];
  bw_rigid_state s = {.mass = b->mass, .volume = b->volume};
  memcpy(s.inertia, b->inertia, sizeof s.inertia);
  memcpy(s.position, b->X, sizeof s.position);
  memcpy(s.velocity, b->V, sizeof s.velocity);
  memcpy(s.spin, b->W, sizeof s.spin);
  memcpy(s.force, b->f, sizeof s.force);
  memcpy(s.torque, b->t, sizeof s.torque);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      s.turn[i][j] = rigid_dot(b->R[i], b->axes[j]);
  return s;
}

void bw_rigid_set_motion(bw_rigid *r, int q, const double velocity[3], const double spin[3])
{
  bw_rigid__body *b = &r->body[q];
  double M[3];
  memcpy(b->V, velocity, sizeof b->V);
  memcpy(b->W, spin, sizeof b->W);
  /* L = R I R^T W. */
  rigid_turn_back((const double(*)[3])b->R, b->W, M);
  for (int a = 0; a < 3; a++)
    M[a] *= b->inertia[a];
  rigid_turn((const double(*)[3])b->R, M, b->L);
}

void bw_rigid_load(bw_rigid *r, const double F[], const double T[])
{
  for (int q = 0; q < r->n; q++) {
    memcpy(r->body[q].F, F + 3 * q, sizeof r->body[q].F);
    memcpy(r->body[q].T, T + 3 * q, sizeof r->body[q].T);
  }
}

double bw_rigid_dt_max(const bw_rigid *r)
{
  double fastest = 0.0; /* (2/dt)^2 */
  for (int q = 0; q < r->n; q++) {
    const bw_rigid__body *b = &r->body[q];
    const double least = fmin(b->inertia[0], fmin(b->inertia[1], b->inertia[2]));
    const double contact = 0.5 * r->config.stiffness * b->area;
    /* What is held moves by no force. */
    for (int d = 0; d < 3; d++) {
      if (!b->held[d]) fastest = fmax(fastest, (b->stiffness[d] + contact) / b->mass);
      if (b->turns == RIGID_FREE || b->turns == d)
        fastest = fmax(fastest, (b->stiffness[3 + d] + contact * b->radius * b->radius) / least);
    }
  }
  return fastest > 0.0 ? r->config.safety * 2.0 / sqrt(fastest) : HUGE_VAL;
}

void bw_rigid_save(const bw_rigid *r, double row[])
{
  for (int q = 0; q < r->n; q++) {
    const bw_rigid__body *b = &r->body[q];
    double *to = row + (ptrdiff_t)BW_RIGID_ROW * q;
    memcpy(to, b->X, sizeof b->X);
    memcpy(to + 3, b->V, sizeof b->V);
    memcpy(to + 6, b->R, sizeof b->R);
    memcpy(to + 15, b->L, sizeof b->L);
    memcpy(to + 18, b->W, sizeof b->W);
    memcpy(to + 21, b->angle, sizeof b->angle);
  }
}

void bw_rigid_restore(bw_rigid *r, double time, const double row[])
{
  for (int q = 0; q < r->n; q++) {
    bw_rigid__body *b = &r->body[q];
    const double *from = row + (ptrdiff_t)BW_RIGID_ROW * q;
    memcpy(b->X, from, sizeof b->X);
    memcpy(b->V, from + 3, sizeof b->V);
    memcpy(b->R, from + 6, sizeof b->R);
    memcpy(b->L, from + 15, sizeof b->L);
    memcpy(b->W, from + 18, sizeof b->W);
    memcpy(b->angle, from + 21, sizeof b->angle);
  }
  r->time = time;
  bw_rigid__forces(r);
}

void bw_rigid_set_rubbed(bw_rigid *r, double rubbed)
{
  r->rubbed = rubbed;
}
