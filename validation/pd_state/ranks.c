/* Bodies that break on several ranks and go on from a restart.
 *
 * Claim      A state-based body that breaks moves alike on any number of ranks and after a restart,
 *            the same bonds break, and its momenta stay.
 * Reference  the body on one rank; the body that was not stopped; conservation of momentum.
 * Measured   free, shaken blocks of 12 x 8 x 5 (9 x 7 in the plane), 60 steps of 0.3 of the
 *            largest; after 40 a second body takes over what a restart holds, and both go on.
 *            Elastic and yielding correspondence, the ordinary law, clouds. Differences of
 *            positions over the spacing, bonds that one body has and the other has not, momenta
 *            over what all particles carry.
 * Tolerance  broken: from a twentieth of the bonds to all but that (a twentieth is 0.9 of a half).
 *            Positions 1e-12: rounding of 120 evaluations. Bonds: none. After a restart: the same
 *            bits. Momenta: 1e-13 of what all particles carry (angular: times the body's length).
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1,4 */
#include "state.h"

enum { BEFORE = 40, AFTER = 20 };

/* The same body on all ranks, on each rank by itself, and restarted; bits of bonds and positions.
 * */
typedef struct {
  bw_solid *pd;
  double *X;
  uint8_t *bits;
} breaking;

static void shaken(const double x[3], double V[3], const void *data)
{
  const bool planar = *(const bool *)data;
  V[0] = 0.15 * sin(2 * x[0] + x[1]);
  V[1] = 0.1 * cos(3 * x[1]) + 0.05 * x[0];
  V[2] = planar ? 0 : 0.1 * sin(x[2] * x[0]);
}

static bw_status make(const bw_comm *comm, const bw_solid_config *c, breaking *b)
{
  const bool planar = c->geometry != BW_PD_3D;
  BW_TRY(body_make(comm, c, planar ? (int[3]){9, 7, 1} : (int[3]){12, 8, 5}, NULL, NULL, &b->pd));
  BW_TRY(bw_solid_load_velocity(b->pd, shaken, &planar));
  BW_TRY(BW_ALLOCATE(&b->X, 3 * bw_solid_count(b->pd)));
  return BW_ALLOCATE(&b->bits, bw_solid_count(b->pd) * bw_solid_bits_bytes(b->pd));
}

static void release(breaking *b)
{
  bw_release(&b->X);
  bw_release(&b->bits);
  bw_solid_destroy(&b->pd);
}

static bw_status steps(breaking *b, int n, double dt)
{
  for (int q = 0; q < n; q++)
    BW_TRY(bw_solid_step(b->pd, dt));
  bw_solid_get_position(b->pd, b->X);
  bw_solid_get_bits(b->pd, b->bits);
  return BW_OK;
}

/* Both are divided alike: rows go over as they are. */
static bw_status take_over(const breaking *from, breaking *to)
{
  double sums[BW_SOLID_RESTART_SUMS], *rows = NULL;
  BW_TRY(BW_ALLOCATE(&rows, bw_solid_count(from->pd) * bw_solid_restart_row(from->pd)));
  bw_solid_get_restart(from->pd, rows, sums);
  bw_status st = bw_solid_set_restart(to->pd, rows, sums);
  BW_THEN(st, bw_solid_set_bits(to->pd, from->bits));
  bw_release(&rows);
  return st;
}

/* Largest difference of positions, and how many bonds are not the same; b has all particles of a.
 * */
static bw_status compare(const breaking *a, const breaking *b, double *apart, double *bonds)
{
  const size_t bytes = bw_solid_bits_bytes(a->pd);
  size_t *row = NULL; /* of b, by id */
  double different = 0;
  BW_TRY(BW_ALLOCATE(&row, (size_t)bw_solid_total(a->pd)));
  for (size_t j = 0; j < bw_solid_count(b->pd); j++)
    row[bw_solid_id(b->pd)[j]] = j;
  *apart = 0;
  for (size_t i = 0; i < bw_solid_count(a->pd); i++) {
    const size_t j = row[bw_solid_id(a->pd)[i]];
    for (size_t k = 0; k < 3; k++)
      *apart = fmax(*apart, fabs(a->X[3 * i + k] - b->X[3 * j + k]));
    for (size_t q = 0; q < bytes; q++)
      for (int bit = 0; bit < 8; bit++)
        different += (a->bits[bytes * i + q] ^ b->bits[bytes * j + q]) >> bit & 1;
  }
  *apart /= bw_solid_settings(a->pd)->ds;
  bw_comm_max(bw_solid_comm(a->pd), 1, apart);
  bw_comm_sum(bw_solid_comm(a->pd), 1, &different);
  *bonds = different;
  bw_release(&row);
  return BW_OK;
}

static double drift(const bw_solid_config *c, const bw_solid_ledger *first,
                    const bw_solid_ledger *last, double scale)
{
  double worst = 0;
  for (int k = 0; k < 3; k++) {
    worst = fmax(worst, fabs(last->momentum[k] - first->momentum[k]) / scale);
    worst = fmax(worst, fabs(last->angular[k] - first->angular[k]) / (12 * c->ds * scale));
  }
  return worst;
}

static bw_status breaks(bw_validation *v, const bw_solid_config *c, const char *extra)
{
  breaking all = {0}, one = {0}, next = {0};
  bw_solid_ledger first, last;
  bw_comm *self = NULL;
  double apart, bonds, again, other;
  BW_TRY(bw_comm_self(&self));
  BW_TRY(make(bw_validation_comm(v), c, &all));
  BW_TRY(make(bw_validation_comm(v), c, &next));
  BW_TRY(make(self, c, &one));
  BW_TRY(bw_solid_account(all.pd, &first));
  const double dt = 0.3 * bw_solid_dt_max(one.pd);
  BW_TRY(steps(&all, BEFORE, dt));
  BW_TRY(take_over(&all, &next));
  BW_TRY(steps(&all, AFTER, dt));
  BW_TRY(steps(&next, AFTER, dt));
  BW_TRY(steps(&one, BEFORE + AFTER, dt));
  BW_TRY(bw_solid_account(all.pd, &last));
  BW_TRY(compare(&all, &one, &apart, &bonds));
  BW_TRY(compare(&all, &next, &again, &other));
  const double n = (double)bw_solid_total(all.pd);
  const double carried = sqrt(2 * first.kinetic * c->rho * bw_solid_volume(all.pd) * n);
  state_claim(v, "the body breaks in part", "broken_over_bonds",
              (double)last.broken / (double)last.bonds, 0.5, 0.9, BW_CONSERVATION, "count", extra);
  state_claim(v, "any number of ranks moves it alike", "positions", apart, 0, 1e-12,
              BW_CONSERVATION, "one rank", extra);
  state_claim(v, "any number of ranks breaks the same bonds", "bonds_that_differ", bonds, 0, 0,
              BW_CONSERVATION, "one rank", extra);
  state_claim(v, "a restart goes on as if nothing had been", "positions", again, 0, 0,
              BW_CONSERVATION, "the same run", extra);
  state_claim(v, "a restart breaks the same bonds", "bonds_that_differ", other, 0, 0,
              BW_CONSERVATION, "the same run", extra);
  state_claim(v, "momenta of a breaking body stay", "drift", drift(c, &first, &last, carried), 0,
              1e-13, BW_CONSERVATION, "conservation of momentum", extra);
  release(&all);
  release(&next);
  release(&one);
  bw_comm_destroy(&self);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  bw_solid_config c = bw_solid_config_default();
  c.ds = 0.5, c.rho = 2, c.E = 3, c.horizon_ratio = 2, c.G0 = 2e-2;
  c.choice.law = BW_SOLID_ORDINARY, c.choice.poisson_ratio = 0.4;
  BW_TRY(breaks(v, &c, "\"law\": \"ordinary\", \"dimension\": 3"));
  c.choice.law = BW_SOLID_CORRESPONDENCE;
  BW_TRY(breaks(v, &c, "\"law\": \"correspondence\", \"dimension\": 3"));
  c.geometry = BW_PD_PLANE_STRESS, c.disorder = 0.2;
  BW_TRY(breaks(v, &c, "\"law\": \"correspondence\", \"dimension\": 2, \"disorder\": 0.2"));
  c.geometry = BW_PD_3D, c.disorder = 0;
  c.choice.plastic = BW_SOLID_J2, c.choice.yield_stress = 0.05, c.choice.hardening = 0.3;
  c.choice.breaks = BW_PD_STATE_BREAKS_BY_FLOW, c.choice.limit = 0.1;
  return breaks(v, &c, "\"law\": \"correspondence\", \"dimension\": 3, \"plastic\": \"j2\"");
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.ranks", run);
}
