/* Bonds are broken at random until none is left.
 *
 * Claim      However few bonds a particle of a state-based body has left, momentum, angular
 *            momentum and the energy book are kept, and nothing is infinite.
 * Reference  conservation of momentum and energy. Without bonds nothing is elastic.
 * Measured   shaken, free clouds of 8 x 6 x 5 and 9 x 7 particles; each of 400 rounds of three
 *            steps cuts a four-hundredth of the bonds, drawn by the places of their ends; the last
 *            round cuts what is left. Steps of 0.01 of the intact body's largest.
 * Tolerance  1e-13 of what all particles carry for momenta. 1e-4 of the first energy for the book:
 *            steps are so short that Verlet's swing is below that also where few bonds make a
 *            particle ten times as stiff.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "pd_law.h"
#include "pd_walk.h"
#include "state.h"

enum { ROUNDS = 400 };

static void shaken(const double x[3], double V[3], const void *data)
{
  V[0] = 0.02 * sin(2 * x[0] + x[1]);
  V[1] = 0.02 * cos(3 * x[1]);
  V[2] = *(const bool *)data ? 0 : 0.02 * sin(x[2] * x[0]);
}

/* A number from 0 to 1 of a pair of particles, the same from both ends. */
static double drawn(int64_t a, int64_t b)
{
  uint64_t x = (uint64_t)(a < b ? a : b) * 0x9e3779b97f4a7c15u + (uint64_t)(a < b ? b : a);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return (double)((x ^ (x >> 31)) >> 11) / 9007199254740992.0;
}

/* Cuts the bonds whose number is below `share`. */
static void cut(bw_solid *solid, double share)
{
  bw_pd_body *pd = bw_solid_body(solid);
  for (size_t q = 0; q < pd->bonds.n_block; q++) {
    bw_pd_block *block = &pd->bonds.block[q];
    for (bw_pd_walk b = bw_pd_walk_of(pd, block, block->mask); bw_pd_walk_next(&b);)
      if (drawn(pd->points.id[pd->points.occupant[b.h]], pd->points.id[pd->points.occupant[b.l]]) <
          share)
        bw_pd_body_cut(pd, block, b.slot, b.lane);
  }
  pd->current = false;
}

static bw_status to_none(bw_validation *v, const bw_solid_config *c, const char *extra)
{
  const bool planar = c->geometry != BW_PD_3D;
  bw_solid *pd = NULL;
  bw_solid_ledger first, e;
  double worst = 0, drift = 0;
  BW_TRY(body_make(bw_validation_comm(v), c, planar ? (int[3]){9, 7, 1} : (int[3]){8, 6, 5}, NULL,
                   NULL, &pd));
  BW_TRY(bw_solid_load_velocity(pd, shaken, &planar));
  BW_TRY(bw_solid_account(pd, &first));
  const double dt = 0.01 * bw_solid_dt_max(pd),
               scale = sqrt(2 * first.kinetic * c->rho * bw_solid_volume(pd)) *
                       (double)bw_solid_total(pd);
  for (int round = 1; round <= ROUNDS; round++) {
    cut(pd, (double)round / ROUNDS);
    for (int step = 0; step < 3; step++)
      BW_TRY(bw_solid_step(pd, dt));
    BW_TRY(bw_solid_account(pd, &e));
    worst = fmax(worst, fabs((e.kinetic + e.elastic + e.fracture) / first.kinetic - 1));
    for (int k = 0; k < 3; k++) {
      drift = fmax(drift, fabs(e.momentum[k] - first.momentum[k]) / scale);
      drift = fmax(drift, fabs(e.angular[k] - first.angular[k]) / (8 * c->ds * scale));
    }
    /* A number that is none compares with nothing. */
    if (!isfinite(e.kinetic + e.elastic + e.fracture)) worst = NAN;
  }
  state_claim(v, "the book closes whatever is left", "departure", worst, 0, 1e-4, BW_CONSERVATION,
              "conservation of energy", extra);
  state_claim(v, "momenta are kept whatever is left", "drift", drift, 0, 1e-13, BW_CONSERVATION,
              "conservation of momentum", extra);
  state_claim(v, "without bonds nothing is elastic", "elastic", e.elastic, 0, 0, BW_CONSERVATION,
              "no bonds", extra);
  state_claim(v, "all bonds are gone", "intact", (double)(e.bonds - e.broken), 0, 0,
              BW_CONSERVATION, "count", extra);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  bw_solid_config c = bw_solid_config_default();
  c.ds = 0.5, c.rho = 2, c.E = 3, c.nu = 0.4, c.horizon_ratio = 2, c.disorder = 0.2;
  c.law = &bw_pd_state_correspondence_law;
  BW_TRY(to_none(v, &c, "\"law\": \"correspondence\", \"dimension\": 3"));
  c.law = &bw_pd_state_ordinary_law;
  BW_TRY(to_none(v, &c, "\"law\": \"ordinary\", \"dimension\": 3"));
  c.geometry = BW_PD_PLANE_STRAIN;
  BW_TRY(to_none(v, &c, "\"law\": \"ordinary\", \"dimension\": 2"));
  c.law = &bw_pd_state_correspondence_law;
  return to_none(v, &c, "\"law\": \"correspondence\", \"dimension\": 2");
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.break_to_none", run);
}
