/* The step: kick, drift, kick, with one evaluation of the forces. */
#include "ulph_internal.h"

/* Steps beyond this many dx/c0 are refused: the symbol of the operators on a lattice allows 2.6. */
static const double LONGEST = 2.4;

/* Own fluid as the sweeps see it. */
static void fill_near(bw_ulph *u)
{
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    bw_ulph__near *n = u->near + u->fluid.slot_own[i];
    memcpy(n->x, p->x, sizeof n->x);
    memcpy(n->v, p->v, sizeof n->v);
    n->rho = p->rho;
    n->V = p->m / p->rho;
  }
  bw_ulph__send(&u->fluid, sizeof *u->near, u->near);
}

/* Walls and faces as they are now, for lists of who is near. */
static void fill_standing(bw_ulph *u, bw_ulph__kind *kind)
{
  for (size_t i = 0; i < kind->own; i++)
    memcpy(u->near[kind->slot_own[i]].x, u->own[kind->first + i].x, sizeof u->near->x);
  bw_ulph__send(kind, sizeof *u->near, u->near);
}

/* Who is near, as soon as two that were not may have met. */
static void find_near(bw_ulph *u)
{
  if (u->strayed < 0.5 * u->near_skin) return;
  fill_standing(u, &u->wall);
  fill_standing(u, &u->face);
  bw_ulph__keep_near(u);
  bw_ulph__dry(u);
}

void bw_ulph__evaluate(bw_ulph *u, double dt)
{
  fill_near(u);
  find_near(u);
  /* Walls show their velocities, which the dilation of the fluid needs ... */
  bw_ulph__shade_velocity(u);
  bw_ulph__first(u, dt);
  bw_ulph__send(&u->fluid, sizeof *u->far, u->far);
  /* ... and then the pressure of the fluid's new density: an older one would feed sound. */
  bw_ulph__shade_pressure(u);
  bw_ulph__second(u, dt);
  bw_ulph__load_faces(u);
}

/* to += dt book */
static void add(bw_ulph__book *to, double dt, const bw_ulph__book *book)
{
  double *sum = (double *)to;
  const double *more = (const double *)book;
  for (size_t k = 0; k < sizeof *book / sizeof *more; k++)
    sum[k] += dt * more[k];
}

void bw_ulph__join_books(bw_ulph *u)
{
  enum { EACH = sizeof u->rate / sizeof(double) };
  double both[2 * EACH];
  memcpy(both, &u->rate, sizeof u->rate);
  memcpy(both + EACH, &u->jump, sizeof u->jump);
  bw_comm_sum(u->comm, 2 * EACH, both);
  memcpy(&u->rate, both, sizeof u->rate);
  memcpy(&u->jump, both + EACH, sizeof u->jump);
}

/* The first half of the kick, and the drift. The torque of a force on a particle that has been
 * shifted since it was found belongs to the shifting. */
static void kick_and_drift(bw_ulph *u, double dt)
{
  double *turn = u->jump.turn[PUSH_SHIFTING];
  for (size_t i = 0; i < u->fluid.own; i++) {
    bw_ulph__particle *p = u->own + i;
    for (int k = 0; k < 3; k++) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      turn[k] += 0.5 * dt * p->m *
                 (p->shift[a] * (p->a[b] + u->config.gravity[b]) -
                  p->shift[b] * (p->a[a] + u->config.gravity[a]));
    }
    for (int k = 0; k < 3; k++)
      p->v[k] += 0.5 * dt * (p->a[k] + u->config.gravity[k]);
    for (int k = 0; k < 3; k++)
      p->x[k] += dt * p->v[k];
  }
}

void bw_ulph__mark_places(bw_ulph *u)
{
  const bw_ulph__kind *kinds[] = {&u->fluid, &u->face};
  for (int k = 0; k < 2; k++)
    for (size_t i = kinds[k]->first; i < kinds[k]->first + kinds[k]->own; i++)
      memcpy(u->own[i].at, u->own[i].x, sizeof u->own[i].at);
}

static double moved(const bw_ulph__particle *p)
{
  double far = 0;
  for (int k = 0; k < 3; k++)
    far += (p->x[k] - p->at[k]) * (p->x[k] - p->at[k]);
  return far;
}

/* Squares of the largest move of fluid and of faces since the lists were made, of the largest
 * speeds of both and of the largest shift; and 1 where something has become no number or faster
 * than sound. */
enum { FLUID, FACES, SPEED, SHIFT, WRONG, LOOKS };

static void look(const bw_ulph *u, double found[LOOKS])
{
  const double c2 = u->config.c0 * u->config.c0;
  memset(found, 0, LOOKS * sizeof *found);
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    const double v2 = bw_ulph__dot(p->v, p->v), far = moved(p);
    const double shift = bw_ulph__dot(p->shift, p->shift);
    if (far > found[FLUID]) found[FLUID] = far;
    if (v2 > found[SPEED]) found[SPEED] = v2;
    if (shift > found[SHIFT]) found[SHIFT] = shift;
    if (!(v2 < c2 && p->rho > 0)) found[WRONG] = 1;
  }
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++) {
    const double *v = u->body.v + 3 * bw_ulph__body_particle(u->own + i);
    found[FACES] = fmax(found[FACES], moved(u->own + i));
    found[SPEED] = fmax(found[SPEED], bw_ulph__dot(v, v));
  }
  bw_comm_max(u->comm, LOOKS, found);
}

/* New lists when two that were just out of reach may have met, or when bodies, whose surface is
 * found with the lists, have moved a tenth of dx. */
static bw_status keep_lists(bw_ulph *u, double dt, const double before[3])
{
  double found[LOOKS], built[3] = {0}, v[3], a[3], walls = 0, step = 0;
  look(u, found);
  BW_REQUIRE(found[WRONG] == 0, BW_EDIVERGED,
             "ulph: at t = %g a particle is faster than sound, %g, or its density is not positive: "
             "raise speed (and with it c0), or take shorter steps",
             u->time, u->config.c0);
  if (u->config.motion != NULL)
    u->config.motion(u->time_built, u->config.motion_context, built, v, a);
  for (int k = 0; k < 3; k++) {
    walls += (u->wall_x[k] - built[k]) * (u->wall_x[k] - built[k]);
    step += (u->wall_x[k] - before[k]) * (u->wall_x[k] - before[k]);
  }
  u->strayed += fmax(dt * sqrt(found[SPEED]) + sqrt(found[SHIFT]), sqrt(step));
  const double most = 0.25 * u->skin * u->skin, turned = 0.01 * u->config.dx * u->config.dx;
  if (found[FLUID] < most && walls < most && found[FACES] < fmin(most, turned)) return BW_OK;
  bw_ulph__mark_places(u);
  u->time_built = u->time;
  BW_TRY(bw_ulph__rebuild(u));
  bw_ulph__move_walls(u, u->time);
  return BW_OK;
}

double bw_ulph_dt_max(bw_ulph *u)
{
  const bw_ulph_config *c = &u->config;
  double most[2] = {0, 0};
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    double a[3];
    for (int k = 0; k < 3; k++)
      a[k] = p->a[k] + c->gravity[k];
    most[0] = fmax(most[0], bw_ulph__dot(p->v, p->v));
    most[1] = fmax(most[1], bw_ulph__dot(a, a));
  }
  bw_comm_max(u->comm, 2, most);
  double dt = c->step_share * c->dx / (c->c0 + sqrt(most[0]));
  if (most[1] > 0) dt = fmin(dt, 0.25 * sqrt(c->dx / sqrt(most[1])));
  if (u->mu_t > 0) dt = fmin(dt, 0.125 * c->dx * c->dx * c->rho0 / u->mu_t);
  return dt;
}

bw_status bw_ulph_step(bw_ulph *u, double dt)
{
  if (!u->started) BW_TRY(bw_ulph_start(u, NULL, NULL));
  BW_REQUIRE(dt > 0 && dt <= LONGEST * u->config.dx / u->config.c0, BW_ECFL,
             "ulph: dt = %g at t = %g is not within 0 and %g dx/c0 = %g", dt, u->time, LONGEST,
             LONGEST * u->config.dx / u->config.c0);
  add(&u->book, 0.5 * dt, &u->rate);
  memset(&u->jump, 0, sizeof u->jump);
  bw_ulph__book_bodies(u, 0.5 * dt);
  kick_and_drift(u, dt);
  u->time += dt;
  const double walls[3] = {u->wall_x[0], u->wall_x[1], u->wall_x[2]};
  bw_ulph__move_walls(u, u->time);
  /* Velocities belong to the middle of the step now, places to its end. */
  BW_TRY(keep_lists(u, dt, walls));
  bw_ulph__evaluate(u, dt);
  bw_ulph__book_bodies(u, 0.5 * dt);
  /* All of the book is the same on every rank from here on, so that a restart has the same bits. */
  bw_ulph__join_books(u);
  add(&u->book, 0.5 * dt, &u->rate);
  add(&u->book, 1, &u->jump);
  u->steps++;
  return BW_OK;
}

double bw_ulph_time(const bw_ulph *u)
{
  return u->time;
}

void bw_ulph_set_time(bw_ulph *u, double t)
{
  u->time = t;
}

int64_t bw_ulph_steps(const bw_ulph *u)
{
  return u->steps;
}

int64_t bw_ulph_rebuilds(const bw_ulph *u)
{
  return u->rebuilds;
}
