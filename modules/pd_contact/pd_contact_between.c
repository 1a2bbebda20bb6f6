/* Repulsion between bodies: who may push whom, and the forces of the pairs that a search has found.
 *
 * Every rank computes the force on its own particles. Both ends of a pair see the same distance and
 * the same constants, so that the two forces are opposite to the last bit, and half of the energy
 * is booked at either end. */
#include "pd_contact_between.h"
#include "bw_memory.h"

#include <math.h>

static const double SKIN = 0.5; /* of the search, in r_c: a new one after a move of r_c/4 */

/* What an own particle of kind a feels of one of kind b. */
static bw_pd_pair pair_law(const bw_pd_contact_between *c, int a, int b)
{
  const bw_pd_body *p = c->body[c->kinds.body[a]], *q = c->body[c->kinds.body[b]];
  if (p == q) return (bw_pd_pair){.closest = INFINITY};
  return bw_pd_contact__law(p, a - c->kinds.first[c->kinds.body[a]], q,
                            b - c->kinds.first[c->kinds.body[b]]);
}

/* Two bodies that can meet: in one space, of one dimension. */
static bw_status check_two(const bw_pd_body *p, const bw_pd_body *q, int number)
{
  BW_REQUIRE(p != q, BW_EINPUT, "contact: body %d is listed twice", number);
  BW_REQUIRE(p->comm == q->comm, BW_EINPUT,
             "contact: body %d was made with another communicator than the first; use one", number);
  BW_REQUIRE(
      p->config.geometry == q->config.geometry &&
          (p->dimension == 3 || p->config.thickness == q->config.thickness),
      BW_EINPUT,
      "contact: body %d has geometry = %d, thickness = %g, the first %d and %g; they must be "
      "the same",
      number, (int)q->config.geometry, q->config.thickness, (int)p->config.geometry,
      p->config.thickness);
  for (int k = 0; k < 3; k++)
    BW_REQUIRE(p->config.period[k] == q->config.period[k], BW_EINPUT,
               "contact: body %d has period[%d] = %g, the first %g; they must be the same", number,
               k, q->config.period[k], p->config.period[k]);
  return BW_OK;
}

/* A period is one of space, and longer than what two particles can reach. */
static bw_status check_period(const bw_pd_body *p, int number)
{
  for (int k = 0; k < 3; k++) {
    if (p->config.period[k] == 0) continue;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        BW_REQUIRE(
            p->config.axes[a][b] == (a == b), BW_EINPUT,
            "contact: body %d has period[%d] = %g and a turned lattice; periods are along the "
            "axes of space",
            number, k, p->config.period[k]);
    BW_REQUIRE(p->config.period[k] / p->level[0].ds > 3.5, BW_EINPUT,
               "contact: body %d has period[%d] = %g; contact needs at least 4 ds", number, k,
               p->config.period[k]);
  }
  return BW_OK;
}

static bw_status check(int n, bw_pd_body *const body[])
{
  BW_REQUIRE(n >= 1, BW_EINPUT, "contact: %d bodies; at least 1", n);
  for (int q = 0; q < n; q++) {
    BW_TRY(check_period(body[q], q));
    for (int p = 0; p < q; p++)
      BW_TRY(check_two(body[p], body[q], q));
  }
  return BW_OK;
}

static int kinds_of(const bw_pd_body *pd)
{
  return (pd->finest + 1) * pd->config.n_group;
}

static bw_status constants(bw_pd_contact_between *c)
{
  c->kinds.n = 0, c->reach = 0;
  bw_release(&c->kinds.body);
  bw_release(&c->kinds.law);
  for (int b = 0; b < c->n_body; b++) {
    c->kinds.first[b] = c->kinds.n;
    c->kinds.n += kinds_of(c->body[b]);
  }
  BW_TRY(BW_ALLOCATE(&c->kinds.body, (size_t)c->kinds.n));
  BW_TRY(BW_ALLOCATE(&c->kinds.law, (size_t)c->kinds.n * (size_t)c->kinds.n));
  for (int b = 0; b < c->n_body; b++)
    for (int g = 0; g < kinds_of(c->body[b]); g++)
      c->kinds.body[c->kinds.first[b] + g] = b;
  for (int a = 0; a < c->kinds.n; a++)
    for (int b = 0; b < c->kinds.n; b++) {
      c->kinds.law[a * c->kinds.n + b] = pair_law(c, a, b);
      c->reach = fmax(c->reach, c->kinds.law[a * c->kinds.n + b].reach);
    }
  c->skin = SKIN * c->reach;
  return BW_OK;
}

static int64_t revision_of(const bw_pd_contact_between *c)
{
  int64_t revision = 0;
  for (int b = 0; b < c->n_body; b++)
    revision += c->body[b]->revision;
  return revision;
}

/* What is as long as the bodies' lists. */
static bw_status arrays_of(bw_pd_contact_between *c)
{
  for (int b = 0; b < c->n_body; b++)
    for (int k = 0; k < 3; k++) {
      bw_release(&c->u_built[k][b]);
      BW_TRY(BW_ALLOCATE(&c->u_built[k][b], c->body[b]->n));
    }
  BW_TRY(constants(c));
  c->revision = revision_of(c);
  c->built = false;
  return BW_OK;
}

static bw_status build(bw_pd_contact_between *c, int n, bw_pd_body *const body[])
{
  BW_TRY(BW_ALLOCATE(&c->body, (size_t)n));
  BW_TRY(BW_ALLOCATE(&c->kinds.first, (size_t)n));
  for (int k = 0; k < 3; k++) {
    BW_TRY(BW_ALLOCATE(&c->u_built[k], (size_t)n));
    c->period[k] = body[0]->config.period[k];
  }
  c->n_body = n;
  for (int b = 0; b < n; b++)
    c->body[b] = body[b];
  c->closest = INFINITY;
  return arrays_of(c);
}

bw_status bw_pd_contact_between_create(int n, bw_pd_body *const body[], bw_pd_contact_between **out)
{
  bw_pd_contact_between *c = NULL;
  *out = NULL;
  /* The same answer on all ranks: what is looked at is. */
  BW_TRY(check(n, body));
  bw_status st = BW_ALLOCATE(&c, 1);
  BW_THEN(st, build(c, n, body));
  st = bw_comm_agree(body[0]->comm, st);
  if (st != BW_OK) bw_pd_contact_between_destroy(&c);
  *out = c;
  return st;
}

void bw_pd_contact_between_destroy(bw_pd_contact_between **between)
{
  bw_pd_contact_between *c = *between;
  if (c == NULL) return;
  bw_pd_contact__between_release(c);
  for (int k = 0; k < 3; k++) {
    for (int b = 0; b < c->n_body && c->u_built[k] != NULL; b++)
      bw_release(&c->u_built[k][b]);
    bw_release(&c->u_built[k]);
  }
  bw_release(&c->body);
  bw_release(&c->kinds.first);
  bw_release(&c->kinds.body);
  bw_release(&c->kinds.law);
  bw_release(between);
}

void bw_pd_contact_between_forget(bw_pd_contact_between *c)
{
  c->built = false;
}

/* Whether an own particle moved by half the skin since the last search (NaN counts). */
static bool moved(const bw_pd_contact_between *c, int b)
{
  const bw_pd_body *pd = c->body[b];
  const bw_real limit2 = (bw_real)(0.25 * c->skin * c->skin);
  int far = 0;
  for (size_t r = 0; r < pd->bonds.n_run; r++) {
    const bw_pd_run run = pd->bonds.run[r];
    const bw_real *x = pd->u[0] + run.place, *p = c->u_built[0][b] + run.own;
    const bw_real *y = pd->u[1] + run.place, *q = c->u_built[1][b] + run.own;
    const bw_real *z = pd->u[2] + run.place, *s = c->u_built[2][b] + run.own;
#pragma omp simd reduction(+ : far)
    for (int32_t i = 0; i < run.n; i++) {
      const bw_real dx = x[i] - p[i], dy = y[i] - q[i], dz = z[i] - s[i];
      far += !(dx * dx + dy * dy + dz * dz <= limit2);
    }
  }
  return far > 0;
}

static void remember(bw_pd_contact_between *c)
{
  for (int b = 0; b < c->n_body; b++)
    for (size_t i = 0; i < c->body[b]->n; i++)
      for (int k = 0; k < 3; k++)
        c->u_built[k][b][i] = c->body[b]->u[k][c->body[b]->points.place[i]];
  c->built = true;
}

/* Present positions of the rows in pairs, other ranks' too. */
static void positions(bw_pd_contact_between *c)
{
  for (size_t q = 0; q < c->n_sent; q++)
    bw_pd_contact__place(c->body[c->sent[q].body], (size_t)c->sent[q].particle, c->send + 3 * q);
  for (size_t q = 0; q < c->n_mine; q++)
    bw_pd_contact__place(c->body[c->mine[q].body], (size_t)c->mine[q].particle, c->y + 3 * q);
  bw_exchange_forward(c->plan, 3 * sizeof(double), c->send, c->y + 3 * c->n_mine);
}

bw_status bw_pd_contact_between_update(bw_pd_contact_between *c)
{
  const bw_comm *comm = c->body[0]->comm;
  /* Another set of particles: nothing that was listed holds. */
  if (c->revision != revision_of(c)) BW_TRY(bw_comm_agree(comm, arrays_of(c)));
  int64_t needed = !c->built;
  for (int b = 0; b < c->n_body && !needed; b++)
    needed = moved(c, b);
  bw_comm_max_int(comm, 1, &needed);
  if (needed) {
    BW_TRY(bw_pd_contact__between_search(c));
    remember(c);
  }
  positions(c);
  return BW_OK;
}

/* Pairs of this rank's particles; returns their halves of the energy. */
static double act(bw_pd_contact_between *c, bool force)
{
  double energy = 0;
  for (size_t b = 0; b < c->n_busy; b++) {
    const size_t q = (size_t)c->busy[b];
    double sum[3] = {0}, d[3];
    for (size_t p = c->pair_start[q]; p < c->pair_start[q + 1]; p++) {
      const size_t l = (size_t)c->pair[p];
      bw_pd_pair pair = c->kinds.law[c->kind[q] * c->kinds.n + c->kind[l]];
      bw_particles_difference(c->period, c->y + 3 * q, c->y + 3 * l, d);
      const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      energy += bw_pd_contact__repel(&pair, d, r2, sum);
      /* Two in one place push nowhere, but are as close as can be. */
      c->closest = fmin(c->closest, r2 == 0 ? 0 : pair.closest);
    }
    bw_pd_body *pd = c->body[c->mine[q].body];
    for (int k = 0; force && k < pd->dimension; k++)
      pd->load.extra[k][c->mine[q].particle] += (bw_real)sum[k];
  }
  return energy;
}

void bw_pd_contact_between_force(bw_pd_contact_between *c)
{
  act(c, true);
}

double bw_pd_contact_between_energy(bw_pd_contact_between *c)
{
  return act(c, false);
}

/* The stiffest pair against the lighter of the two. */
double bw_pd_contact_between_time(const bw_pd_contact_between *c)
{
  double most = 0;
  for (int a = 0; a < c->kinds.n; a++)
    for (int b = 0; b < c->kinds.n; b++) {
      const bw_pd_pair *p = &c->kinds.law[a * c->kinds.n + b],
                       *q = &c->kinds.law[b * c->kinds.n + a];
      if (p->reach > 0) most = fmax(most, (p->k + q->k) / p->reach);
    }
  return most > 0 ? 1 / sqrt(most) : INFINITY;
}

double bw_pd_contact_between_closest(const bw_pd_contact_between *c)
{
  return c->closest;
}

size_t bw_pd_contact_between_pairs(const bw_pd_contact_between *c)
{
  return c->pair_start == NULL ? 0 : c->pair_start[c->n_mine];
}
