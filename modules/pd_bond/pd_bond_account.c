/* The energy book: sums over particles, bonds and ranks. */
#include "pd_bond_contact.h"

#include <math.h>

/* Kinetic energy and momenta of this rank: book[0], [1..3], [4..6]. */
static void motion(const bw_pd_bond *pd, double book[7])
{
  const double mass = pd->config.rho * pd->dv;
  for (size_t i = 0; i < pd->n; i++) {
    double X[3], p[3];
    bw_pd_bond__reference(pd, i, X);
    for (int k = 0; k < 3; k++) {
      X[k] += (double)pd->u[k][pd->place[i]];
      p[k] = mass * (double)pd->v[k][i];
      book[0] += 0.5 * p[k] * (double)pd->v[k][i];
      book[1 + k] += p[k];
    }
    for (int k = 0; k < 3; k++)
      book[4 + k] += X[(k + 1) % 3] * p[(k + 2) % 3] - X[(k + 2) % 3] * p[(k + 1) % 3];
  }
}

/* Forces and contact pairs of the present state. A step that failed on one rank alone leaves ranks
 * that differ in whether theirs are: all evaluate when one has to. */
static bw_status bring_up_to_date(bw_pd_bond *pd)
{
  int64_t stale = !pd->current;
  bw_comm_max_int(pd->comm, 1, &stale);
  if (stale) BW_TRY(bw_comm_agree(pd->comm, bw_pd_bond__evaluate(pd, false)));
  if (!pd->config.contact) return BW_OK;
  return bw_comm_agree(pd->comm, bw_pd_bond__contact_update(pd));
}

bw_status bw_pd_bond_account(bw_pd_bond *pd, bw_pd_bond_ledger *out)
{
  double book[16] = {0};
  int64_t count[3] = {pd->bonds_directed, 0, pd->precracked};
  BW_TRY(bring_up_to_date(pd));
  motion(pd, book);
  book[7] = bw_pd_bond__elastic(pd);
  if (pd->config.contact) book[8] = bw_pd_bond__contact_energy(pd);
  book[9] = pd->done_damping;
  book[10] = pd->done_fracture;
  book[11] = pd->done_external;
  for (size_t q = 0; q < pd->n_slot; q++)
    count[1] += __builtin_popcount((unsigned)(pd->slot[q].family & ~pd->slot[q].mask));
  book[12] = pd->done_retired;
  for (int k = 0; k < 3; k++)
    book[13 + k] = pd->done_wall[k];
  double closest = pd->config.contact ? pd->contact->closest : INFINITY;
  bw_comm_min(pd->comm, 1, &closest);
  bw_comm_sum(pd->comm, 16, book);
  bw_comm_sum_int(pd->comm, 3, count);
  *out = (bw_pd_bond_ledger){.kinetic = book[0],
                             .momentum = {book[1], book[2], book[3]},
                             .angular = {book[4], book[5], book[6]},
                             .elastic = book[7],
                             .contact = book[8],
                             .closest = closest,
                             .damping = book[9],
                             .fracture = book[10],
                             .external = book[11],
                             .retired = book[12],
                             .wall = {book[13], book[14], book[15]},
                             .bonds = (count[0] - count[2]) / 2,
                             .broken = (count[1] - count[2]) / 2};
  return BW_OK;
}
