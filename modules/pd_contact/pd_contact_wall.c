/* Walls: a particle is pushed by its own image in the plane, with the law of contact.
 *
 * At a distance y from the plane the image is r = 2 y away: the force is that of a pair at r, the
 * energy half of a pair's (the image holds the other half), and dW/dy = -force. So a body meets a
 * wall as it would meet its mirror image head on. A particle that began nearer than ds/2 touches
 * where it began. */
#include "bw_memory.h"
#include "pd_contact.h"

#include <math.h>

static double distance(const bw_pd_wall *w, const double X[3])
{
  return w->normal[0] * X[0] + w->normal[1] * X[1] + w->normal[2] * X[2] - w->offset;
}

/* Of particle i from the wall, now and at first (X0). */
typedef struct {
  double now, first, X[3];
} gap;

static gap gap_of(const bw_pd_body *pd, const bw_pd_wall *w, int32_t i)
{
  /* The distance it began with bounds the reach of the contact. */
  gap g;
  bw_pd_body_reference(pd, (size_t)i, g.X);
  g.first = distance(w, g.X);
  for (int k = 0; k < 3; k++)
    g.X[k] += (double)pd->u[k][pd->points.place[i]];
  g.now = distance(w, g.X);
  return g;
}

/* Does an intact bond join particle i to a prescribed one that started beyond the plane? */
static bool is_held(const bw_pd_body *pd, const bw_pd_wall *w, bw_pd_link link[], int32_t i)
{
  /* Such a particle stands on a foundation: the bond presses it, not the wall. */
  const int n = bw_pd_body_links(pd, (size_t)i, link);
  for (int q = 0; q < n; q++) {
    double X0[3];
    bw_pd_body_reference(pd, (size_t)link[q].neighbour, X0);
    const bool fixed = pd->points.kind[link[q].neighbour] & BW_PD_PRESCRIBED;
    if (link[q].intact && fixed && distance(w, X0) < 0) return true;
  }
  return false;
}

/* Particles that may touch a wall before one has moved by half the skin. */
bw_status bw_pd_contact__wall_search(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  /* A particle meets its image at twice its distance. */
  const double far = 0.5 * (c->reach + c->skin);
  bw_release(&c->near);
  c->n_near = 0;
  for (int pass = 0; pass < 2; pass++) {
    size_t n = 0;
    for (int w = 0; w < c->n_wall; w++)
      for (size_t i = 0; i < pd->n; i++) {
        /* Who is prescribed or retired passes. */
        if (pd->held.mobile[i] == 0 || !(gap_of(pd, &c->wall[w], (int32_t)i).now < far)) continue;
        if (pass == 1) c->near[n] = (bw_pd_near){(int32_t)i, (int8_t)w, true};
        n++;
      }
    if (pass == 0) BW_TRY(BW_ALLOCATE(&c->near, n));
    c->n_near = n;
  }
  /* Who is held by bonds is found at the next update. */
  c->events = -1;
  return BW_OK;
}

/* Lets go of those that lost their last bond across; a particle beyond a wall is an error. */
bw_status bw_pd_contact__wall_update(bw_pd_contact *c)
{
  const bw_pd_body *pd = c->pd;
  /* Bonds only break, but for a restart: without an event nobody was let go. */
  const bool changed = c->events != pd->bonds.events;
  c->events = pd->bonds.events;
  for (size_t q = 0; q < c->n_near; q++) {
    bw_pd_near *p = &c->near[q];
    const bw_pd_wall *w = &c->wall[p->wall];
    const gap g = gap_of(pd, w, p->particle);
    if (p->held && changed) p->held = is_held(pd, w, c->link, p->particle);
    /* The force would push it further out. */
    BW_REQUIRE(p->held || g.now > 0, BW_EDIVERGED,
               "solid: particle %lld at (%g, %g, %g) was thrown through the wall with the normal "
               "(%g, %g, %g); its speed or dt is too large",
               (long long)pd->points.id[p->particle], g.X[0], g.X[1], g.X[2], w->normal[0],
               w->normal[1], w->normal[2]);
  }
  return BW_OK;
}

double bw_pd_contact__wall_act(bw_pd_contact *c, bool force)
{
  bw_pd_body *pd = c->pd;
  double energy = 0, on_walls[3] = {0};
  for (size_t q = 0; q < c->n_near; q++) {
    const bw_pd_wall *w = &c->wall[c->near[q].wall];
    const int32_t i = c->near[q].particle;
    double to_image[3], sum[3] = {0};
    if (c->near[q].held) continue;
    /* The image moves with the particle: its own displacement is all that is needed. */
    const gap g = gap_of(pd, w, i);
    const int kind = bw_pd_contact__kind(pd, (size_t)i);
    bw_pd_pair pair = bw_pd_contact__pair(c, kind, kind);
    /* Who began nearer than ds/2 touches where it began, or it would be pushed off at rest. */
    pair.reach = fmin(pair.reach, 2 * g.first);
    for (int k = 0; k < 3; k++)
      to_image[k] = -2 * g.now * w->normal[k];
    energy += bw_pd_contact__repel(&pair, to_image, 4 * g.now * g.now, sum);
    c->closest = pair.closest;
    /* What the particle gets the wall gets with the other sign. */
    const double mass =
        bw_pd_body_material(pd, (size_t)i)->rho * bw_pd_body_level(pd, (size_t)i)->dv;
    for (int k = 0; force && k < 3; k++) {
      pd->load.extra[k][i] += (bw_real)sum[k];
      on_walls[k] -= mass * sum[k];
    }
  }
  /* Replaced, not added: the force of this evaluation. */
  for (int k = 0; force && k < 3; k++)
    c->wall_force[k] = on_walls[k];
  return energy;
}

static bw_status check_wall(const bw_pd_wall *w)
{
  const double *n = w->normal, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  BW_REQUIRE(fabs(length - 1) < 1e-12 && isfinite(w->offset), BW_EINPUT,
             "solid: the normal (%g, %g, %g) of a wall must be a unit vector, its offset %g "
             "finite",
             n[0], n[1], n[2], w->offset);
  return BW_OK;
}

/* No free particle may stand or have begun beyond a wall, but for one that a bond holds. */
static bw_status check_room(const bw_pd_contact *c, const bw_pd_wall *w)
{
  const bw_pd_body *pd = c->pd;
  bw_status st = BW_OK;
  for (size_t i = 0; i < pd->n && st == BW_OK; i++) {
    const gap g = gap_of(pd, w, (int32_t)i);
    /* Now and at first: the reach of who began beyond would be negative. */
    if (pd->held.mobile[i] == 0 || fmin(g.now, g.first) > 0) continue;
    if (is_held(pd, w, c->link, (int32_t)i)) continue;
    st = BW_FAIL(BW_EINPUT,
                 "solid: particle %lld at (%g, %g, %g) is free and beyond the wall with the "
                 "normal (%g, %g, %g) by %g: move the body, or hold what stands under a wall",
                 (long long)pd->points.id[i], g.X[0], g.X[1], g.X[2], w->normal[0], w->normal[1],
                 w->normal[2], -fmin(g.now, g.first));
  }
  return bw_comm_agree(pd->comm, st);
}

bw_status bw_pd_contact_set_walls(bw_pd_contact *c, int n, const bw_pd_wall wall[])
{
  BW_REQUIRE(n >= 0 && n <= BW_PD_WALLS, BW_EINPUT, "solid: %d walls; at most %d", n, BW_PD_WALLS);
  for (int w = 0; w < n; w++) {
    BW_TRY(check_wall(&wall[w]));
    BW_TRY(check_room(c, &wall[w]));
  }
  for (int w = 0; w < n; w++)
    c->wall[w] = wall[w];
  c->n_wall = n;
  /* Lists and forces are those of the old walls. */
  c->built = false;
  c->pd->current = false;
  return BW_OK;
}
