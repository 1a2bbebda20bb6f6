/* Bodies that hit each other do not pass through each other.
 *
 * Claim      Two squares thrown at each other, with bonds that break, keep their particles
 *            apart: no particle of one comes nearer to one of the other than the load explains,
 *            at 2, 10 and 30 % of the wave speed, and none ends on the far side.
 * Reference  contact force 15 c0 (1 - d/ds) dV on a volume ds^3, POROUS 3.40 with ERRATA 3: a
 *            face of particles bears the pressure 15 c0 ds^2 t dV/t (1 - d/ds) = 1.59 E (1 -
 *            d/ds) at m = 3 in plane stress; the wave that stops the bodies needs rho c v = 9/8
 *            E v/c.
 * Measured   least distance of any two particles of different bodies, every 4 steps.
 * Tolerance  none below 1 - 2 x 0.71 v/c, twice the static value, as a load that comes at once
 *            overshoots by at most two; plus 2 % of ds for particles that meet between rows.
 * BUILD modules=pd_bond */
#include "body.h"

enum { EDGE = 14, GAP = 3 };
static const double E = 5, RHO = 2;

static int two_squares(const int32_t site[3], const void *data)
{
  (void)data;
  return site[0] >= EDGE && site[0] < EDGE + GAP ? -1 : BW_PD_FREE;
}

static void towards(const double X0[3], double V[3], const void *data)
{
  V[0] = X0[0] < EDGE + 0.5 * GAP ? *(const double *)data : -*(const double *)data;
  V[1] = V[2] = 0;
}

static double least_distance(const bw_pd_bond *pd, body_rows *r)
{
  const size_t n = bw_pd_bond_count(pd);
  const double middle = EDGE + 0.5 * GAP;
  double least = 1e9;
  bw_pd_bond_get_position(pd, r->X);
  for (size_t a = 0; a < n; a++) {
    if (r->X0[3 * a] > middle) continue;
    for (size_t b = 0; b < n; b++) {
      if (r->X0[3 * b] < middle) continue;
      const double x = r->X[3 * a] - r->X[3 * b], y = r->X[3 * a + 1] - r->X[3 * b + 1];
      least = fmin(least, x * x + y * y);
    }
  }
  return sqrt(least);
}

static bw_status measure(bw_validation *v, double mach)
{
  bw_pd_bond_config c = bw_pd_bond_config_default();
  bw_pd_bond *pd = NULL;
  body_rows r;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E, c.contact = true;
  c.G0 = E * 3 * 1e-4; /* s0 near 1.2 % */
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){2 * EDGE + GAP, EDGE, 1}, two_squares, NULL,
                   &pd));
  BW_TRY(body_rows_make(pd, &r));
  const double speed = sqrt(1.125 * E / RHO), given = mach * speed;
  BW_TRY(bw_pd_load_velocity(pd, towards, &given));
  const double dt = 0.25 * bw_pd_bond_dt_max(pd), end = GAP / given + 4 * EDGE / speed;
  double least = 1e9, mean[2];
  for (int64_t step = 1; (double)step * dt < end; step++) {
    BW_TRY(bw_pd_bond_step(pd, dt));
    if (step % 4 == 0) least = fmin(least, least_distance(pd, &r));
  }
  const double middle = EDGE + 0.5 * GAP, far = 1e9;
  mean[0] =
      body_mean(pd, r.X0, (double[3]){-far, -far, -far}, (double[3]){middle, far, far}, r.X, 3);
  mean[1] =
      body_mean(pd, r.X0, (double[3]){middle, -far, -far}, (double[3]){far, far, far}, r.X, 3);
  char extra[100];
  snprintf(extra, sizeof extra, "\"speed_over_c\": %g, \"broken\": %lld", mach,
           (long long)bw_pd_bond_account(pd).broken);
  bw_claim claim = {.claim = "bodies that collide do not interpenetrate",
                    .quantity = "approach_beyond_bound",
                    .measured = fmax(0, 1 - 2 * 0.71 * mach - least),
                    .reference = 0,
                    .tolerance = 0.02,
                    .kind = BW_ANALYTIC,
                    .source = "pressure of the contact law against rho c v",
                    .extra = extra};
  bw_validation_row(v, &claim);
  claim.quantity = "least_distance", claim.measured = least, claim.reference = 1;
  claim.tolerance = INFINITY;
  bw_validation_row(v, &claim);
  claim.quantity = "bodies_apart", claim.measured = mean[1] - mean[0] > EDGE - 1;
  claim.tolerance = 0;
  bw_validation_row(v, &claim);
  body_rows_release(&r);
  bw_pd_bond_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_REQUIRE(bw_comm_size(bw_validation_comm(v)) == 1, BW_EINPUT,
             "contact_gap: compares all particles with all; run it on one rank");
  BW_TRY(measure(v, 0.02));
  BW_TRY(measure(v, 0.1));
  return measure(v, 0.3);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.contact_gap", run);
}
