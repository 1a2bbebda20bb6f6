/* Bodies that hit each other do not pass through each other, up to a speed; beyond it is told.
 *
 * Claim      Two squares thrown at each other, with bonds that break, keep their particles
 *            apart: no particle of one comes nearer to one of the other than the load explains,
 *            at 2, 10 and 30 % of the wave speed, and none ends on the far side. Their energy is
 *            kept.
 *            Bodies that meet with their rows between each other's, the weakest way for contact
 *            of points, part again at up to 0.8 (squares) and 0.2 (cubes) of the wave speed each;
 *            at 1.0 and 0.3 they get locked into each other, and the account says so: `closest` is
 *            below BW_SOLID_TOO_CLOSE.
 *            Bodies that burst at half the wave speed make no energy, although their debris flies
 *            through what was buried in the other.
 * Reference  contact force 15 c0 (1 - d/ds) dV on a volume ds^3, POROUS 3.40 with ERRATA 3: a
 *            face of particles bears the pressure 15 c0 ds^2 t dV/t (1 - d/ds) = 1.59 E (1 -
 *            d/ds) at m = 3 in plane stress; the wave that stops the bodies needs rho c v = 9/8
 *            E v/c. Between rows the pressure has a maximum, 1.17 E in the plane, 0.34 E in
 *            space (two and four neighbours at (ds/r - 1) x/r): 1.04 and 0.28 c if the load comes
 *            slowly, half of it if at once.
 * Measured   least distance of any two particles of different bodies, every 4 steps; pairs in
 *            the wrong order at the end: one of the left body right of one of the right body,
 *            less than ds beside it.
 * Tolerance  none below 1 - 2 x 0.71 v/c, twice the static value, as a load that comes at once
 *            overshoots by at most two; plus 2 % of ds for particles that meet between rows.
 *            Energy: at half the step that resolves contact, w dt = 1/2, Verlet is off by up to
 *            (w dt)^2/8 = 3 % of the contact energy, which is half of the whole at most.
 *            Debris: a bond that breaks in a step is booked with what it stores at the end, F ds/2
 *            more than Verlet took for it (the half kick that is missing): at most the energy of
 *            fracture. Verlet at w dt = 1/5: 0.5 % of what contact stored at most.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "body.h"

enum { EDGE = 14, CUBE = 8, GAP = 3 };
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

static double least_distance(const bw_solid *pd, body_rows *r)
{
  const size_t n = bw_solid_count(pd);
  const double middle = EDGE + 0.5 * GAP;
  double least = 1e9;
  bw_solid_get_position(pd, r->X);
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

static double energy_of(const bw_solid_ledger *e)
{
  return e->kinetic + e->elastic + e->contact + e->fracture;
}

static bw_status measure(bw_validation *v, double mach)
{
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E, c.contact = true;
  c.G0 = E * 3 * 1e-4; /* s0 near 1.2 % */
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){2 * EDGE + GAP, EDGE, 1}, two_squares, NULL,
                   &pd));
  BW_TRY(body_rows_make(pd, &r));
  const double speed = sqrt(1.125 * E / RHO), given = mach * speed;
  BW_TRY(bw_solid_load_velocity(pd, towards, &given));
  const double dt = 0.5 * bw_solid_dt_contact(pd), end = GAP / given + 4 * EDGE / speed;
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  const double start = energy_of(&e);
  double least = 1e9, mean[2];
  for (int64_t step = 1; (double)step * dt < end; step++) {
    BW_TRY(bw_solid_step(pd, dt));
    if (step % 4 == 0) least = fmin(least, least_distance(pd, &r));
  }
  BW_TRY(bw_solid_account(pd, &e));
  const double middle = EDGE + 0.5 * GAP, far = 1e9;
  mean[0] =
      body_mean(pd, r.X0, (double[3]){-far, -far, -far}, (double[3]){middle, far, far}, r.X, 3);
  mean[1] =
      body_mean(pd, r.X0, (double[3]){middle, -far, -far}, (double[3]){far, far, far}, r.X, 3);
  char extra[100];
  snprintf(extra, sizeof extra, "\"speed_over_c\": %g, \"broken\": %lld", mach,
           (long long)e.broken);
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
  claim.quantity = "energy_kept", claim.measured = energy_of(&e) / start;
  claim.reference = 1, claim.tolerance = 0.015, claim.kind = BW_CONSERVATION;
  claim.source = "conservation of energy";
  bw_validation_row(v, &claim);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static int two_cubes(const int32_t site[3], const void *data)
{
  (void)data;
  return site[0] >= CUBE && site[0] < CUBE + GAP ? -1 : BW_PD_FREE;
}

/* The right body is moved by half a spacing across, both are thrown. */
static void set_up_between_rows(bw_solid *pd, body_rows *r, double middle, double speed)
{
  const bool space = bw_solid_settings(pd)->geometry == BW_PD_3D;
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    const bool right = r->X0[3 * i] > middle;
    r->X[3 * i] = r->X0[3 * i];
    r->X[3 * i + 1] = r->X0[3 * i + 1] + (right ? 0.5 : 0);
    r->X[3 * i + 2] = r->X0[3 * i + 2] + (right && space ? 0.5 : 0);
    r->V[3 * i] = right ? -speed : speed;
    r->V[3 * i + 1] = r->V[3 * i + 2] = 0;
  }
  bw_solid_set_state(pd, r->X, r->V);
}

static int64_t in_wrong_order(const bw_solid *pd, body_rows *r, double middle)
{
  const size_t n = bw_solid_count(pd);
  int64_t pairs = 0;
  bw_solid_get_position(pd, r->X);
  for (size_t a = 0; a < n; a++)
    for (size_t b = 0; b < n && r->X0[3 * a] < middle; b++)
      pairs += r->X0[3 * b] > middle && r->X[3 * a] > r->X[3 * b] &&
               fabs(r->X[3 * a + 1] - r->X[3 * b + 1]) < 1 &&
               fabs(r->X[3 * a + 2] - r->X[3 * b + 2]) < 1;
  return pairs;
}

static bw_status between_rows(bw_validation *v, bw_pd_geometry geometry, double mach, bool holds)
{
  const bool space = geometry == BW_PD_3D;
  const int edge = space ? CUBE : EDGE;
  const double middle = edge + 0.5 * GAP, speed = sqrt((space ? 1.2 : 1.125) * E / RHO);
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  c.geometry = geometry, c.ds = 1, c.rho = RHO, c.E = E, c.contact = true;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){2 * edge + GAP, edge, space ? edge : 1},
                   space ? two_cubes : two_squares, NULL, &pd));
  BW_TRY(body_rows_make(pd, &r));
  set_up_between_rows(pd, &r, middle, mach * speed);
  const double dt = 0.2 * bw_solid_dt_contact(pd), end = GAP / (mach * speed) + 8 * edge / speed;
  for (int64_t step = 1; (double)step * dt < end; step++)
    BW_TRY(bw_solid_step(pd, dt));
  const int64_t pairs = in_wrong_order(pd, &r, middle);
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  const double closest = e.closest;
  char extra[100];
  snprintf(extra, sizeof extra, "\"speed_over_c\": %g, \"dimensions\": %d, \"closest\": %.3f", mach,
           space ? 3 : 2, closest);
  bw_claim claim = {.claim = "bodies that meet between their rows part again, or it is told",
                    .quantity = holds ? "pairs_in_wrong_order" : "told",
                    .measured = holds ? (double)pairs : closest < BW_SOLID_TOO_CLOSE,
                    .reference = holds ? 0 : pairs > 0,
                    .kind = BW_ANALYTIC,
                    .source = "pressure of the contact law between rows against rho c v",
                    .extra = extra};
  bw_validation_row(v, &claim);
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

/* Squares that burst, thrown at each other row on row or between rows. */
static bw_status debris(bw_validation *v, bool between)
{
  const double middle = EDGE + 0.5 * GAP, speed = sqrt(1.125 * E / RHO), given = 0.5 * speed;
  bw_solid_config c = bw_solid_config_default();
  bw_solid *pd = NULL;
  body_rows r;
  c.geometry = BW_PD_PLANE_STRESS, c.ds = 1, c.rho = RHO, c.E = E, c.contact = true;
  c.G0 = E * 3 * 1e-4;
  BW_TRY(body_make(bw_validation_comm(v), &c, (int[3]){2 * EDGE + GAP, EDGE, 1}, two_squares, NULL,
                   &pd));
  BW_TRY(body_rows_make(pd, &r));
  if (between)
    set_up_between_rows(pd, &r, middle, given);
  else
    BW_TRY(bw_solid_load_velocity(pd, towards, &given));
  const double dt = 0.2 * bw_solid_dt_contact(pd), end = 3 * (GAP / given + 4 * EDGE / speed);
  bw_solid_ledger e;
  BW_TRY(bw_solid_account(pd, &e));
  const double start = energy_of(&e);
  double most = 1, stored = 0;
  for (int64_t step = 1; (double)step * dt < end; step++) {
    BW_TRY(bw_solid_step(pd, dt));
    BW_TRY(bw_solid_account(pd, &e));
    stored = fmax(stored, e.contact / start);
    most = fmax(most, energy_of(&e) / start);
  }
  char extra[160];
  snprintf(extra, sizeof extra,
           "\"speed_over_c\": 0.5, \"between_rows\": %s, \"broken\": %lld, \"closest\": %.3f",
           between ? "true" : "false", (long long)e.broken, e.closest);
  bw_validation_row(v, &(bw_claim){"debris at half the wave speed makes no energy", "energy_growth",
                                   most - 1, 0, e.fracture / start + 0.005 * stored,
                                   BW_CONSERVATION, "conservation of energy", extra});
  body_rows_release(&r);
  bw_solid_destroy(&pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_REQUIRE(bw_comm_size(bw_validation_comm(v)) == 1, BW_EINPUT,
             "contact_gap: compares all particles with all; run it on one rank");
  BW_TRY(measure(v, 0.02));
  BW_TRY(measure(v, 0.1));
  BW_TRY(measure(v, 0.3));
  const double plane[] = {0.1, 0.3, 0.8, 1.0}, space[] = {0.05, 0.1, 0.2, 0.3};
  for (int q = 0; q < 4; q++) {
    BW_TRY(between_rows(v, BW_PD_PLANE_STRESS, plane[q], q < 3));
    BW_TRY(between_rows(v, BW_PD_3D, space[q], q < 3));
  }
  BW_TRY(debris(v, false));
  return debris(v, true);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.contact_gap", run);
}
