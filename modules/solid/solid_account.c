/* The energy book: sums over particles, bonds and ranks. */
#include "solid_internal.h"

#include <math.h>

/* Kinetic energy and momenta of this rank: book[0], [1..3], [4..6]. */
static void motion(const bw_pd_body *pd, double book[7])
{
  for (size_t i = 0; i < pd->n; i++) {
    /* Retired particles count: they fly on with what they took along. */
    const double mass = bw_pd_body_material(pd, i)->rho * bw_pd_body_level(pd, i)->dv;
    double X[3], p[3];
    bw_pd_body_reference(pd, i, X);
    for (int k = 0; k < 3; k++) {
      X[k] += (double)pd->u[k][pd->points.place[i]];
      p[k] = mass * (double)pd->v[k][i];
      book[0] += 0.5 * p[k] * (double)pd->v[k][i];
      book[1 + k] += p[k];
    }
    for (int k = 0; k < 3; k++)
      book[4 + k] += X[(k + 1) % 3] * p[(k + 2) % 3] - X[(k + 2) % 3] * p[(k + 1) % 3];
  }
}

double bw_solid_held(const bw_solid *s)
{
  double book[7] = {0};
  motion(s->body, book);
  double held = book[0] + bw_pd_body_elastic(s->body);
  bw_comm_sum(s->body->comm, 1, &held);
  return held;
}

bw_status bw_solid_account(bw_solid *s, bw_solid_ledger *out)
{
  bw_pd_body *pd = s->body;
  /* One array, so that one sum over ranks does for all of them. */
  double book[18] = {0};
  int64_t count[3] = {pd->bonds.directed, 0, s->book.precracked};
  /* Energies are those of the present motion: forces and pairs have to be of it as well. */
  if (!pd->current) BW_TRY(bw_solid_evaluate(s));
  if (s->contact != NULL) BW_TRY(bw_comm_agree(pd->comm, bw_pd_contact_update(s->contact)));
  /* Present energies, then what has been booked step by step. */
  motion(pd, book);
  book[7] = bw_pd_body_elastic(pd);
  if (s->contact != NULL) book[8] = bw_pd_contact_energy(s->contact);
  if (s->outside.who != NULL) book[8] += s->outside.energy(s->outside.who);
  book[9] = s->book.damping;
  book[10] = pd->bonds.released;
  book[11] = s->book.external;
  /* Lost from either end; those that pre-cracks cut are taken off below. */
  for (size_t q = 0; q < pd->bonds.n_slot; q++)
    count[1] += __builtin_popcount((unsigned)(pd->bonds.slot[q].family & ~pd->bonds.slot[q].mask));
  book[12] = s->book.retired;
  for (int k = 0; k < 3; k++)
    book[13 + k] = s->book.wall[k];
  if (pd->law->dissipated != NULL) book[16] = pd->law->dissipated(pd);
  book[17] = s->book.regrid;
  /* Until here all is of this rank; after this all ranks know the same of all. */
  double closest = s->contact != NULL ? bw_pd_contact_closest(s->contact) : INFINITY;
  if (s->outside.who != NULL) closest = fmin(closest, s->outside.closest(s->outside.who));
  bw_comm_min(pd->comm, 1, &closest);
  bw_comm_sum(pd->comm, 18, book);
  bw_comm_sum_int(pd->comm, 3, count);
  /* Directed bonds were counted from both ends. */
  *out = (bw_solid_ledger){.kinetic = book[0],
                           .momentum = {book[1], book[2], book[3]},
                           .angular = {book[4], book[5], book[6]},
                           .elastic = book[7],
                           .contact = book[8],
                           .closest = closest,
                           .damping = book[9],
                           .fracture = book[10],
                           .external = book[11],
                           .retired = book[12],
                           .plastic = book[16],
                           .regrid = book[17],
                           .wall = {book[13], book[14], book[15]},
                           .bonds = (count[0] - count[2]) / 2,
                           .broken = (count[1] - count[2]) / 2};
  return BW_OK;
}
