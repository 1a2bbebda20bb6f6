/* The book: energies, momentum, and what has changed them. */
#include "ulph_internal.h"

/* Energy of compression per mass, the integral of p/rho^2: c0^2 (ln(rho/rho0) + rho0/rho - 1). */
static double compression(const bw_ulph *u, double rho)
{
  const double eta = rho / u->config.rho0 - 1;
  return u->config.c0 * u->config.c0 * (log1p(eta) - eta / (1 + eta));
}

/* kinetic, potential, compression, mass of this rank. */
static void energies(const bw_ulph *u, double e[4])
{
  memset(e, 0, 4 * sizeof *e);
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    e[0] += 0.5 * p->m * bw_ulph__dot(p->v, p->v);
    e[1] -= p->m * bw_ulph__dot(p->x, u->config.gravity);
    e[2] += p->m * compression(u, p->rho);
    e[3] += p->m;
  }
}

double bw_ulph__energy(const bw_ulph *u)
{
  double e[4];
  energies(u, e);
  bw_comm_sum(u->comm, 4, e);
  return e[0] + e[1] + e[2];
}

static void momenta(const bw_ulph *u, double momentum[3], double spin[3])
{
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    for (int k = 0; k < 3; k++) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      momentum[k] += p->m * p->v[k];
      spin[k] += p->m * (p->x[a] * p->v[b] - p->x[b] * p->v[a]);
    }
  }
}

bw_ulph_ledger bw_ulph_account(const bw_ulph *u)
{
  bw_ulph_ledger l = {.first = u->first_energy};
  const bw_ulph__book book = u->book;
  double e[4];
  energies(u, e);
  momenta(u, l.momentum, l.spin);
  bw_comm_sum(u->comm, 4, e);
  bw_comm_sum(u->comm, 3, l.momentum);
  bw_comm_sum(u->comm, 3, l.spin);
  l.kinetic = e[0], l.potential = e[1], l.compression = e[2], l.mass = e[3];
  /* Lines by name; what they do not explain is the integrator's. */
  l.walls = book.line[LINE_WALLS], l.viscous = book.line[LINE_VISCOUS];
  l.artificial = book.line[LINE_ARTIFICIAL], l.diffusion = book.line[LINE_DIFFUSION];
  l.tension = book.line[LINE_TENSION], l.shifting = book.line[LINE_SHIFTING];
  l.ghosts = book.line[LINE_GHOSTS], l.bodies = book.line[LINE_BODIES];
  l.gap = e[0] + e[1] + e[2] - l.first;
  for (int k = 0; k < BW_ULPH__LINES; k++)
    l.gap -= book.line[k];
  memcpy(l.push, book.push, sizeof l.push);
  memcpy(l.turn, book.turn, sizeof l.turn);
  return l;
}
