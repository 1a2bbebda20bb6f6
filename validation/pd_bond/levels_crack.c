/* A crack in a plate that is fine where it runs.
 *
 * Claim      The notched glass plate of crack_branching, pulled by 12 MPa, breaks alike whether all
 *            of it is fine or only a band that its crack stays in: the first bond and the arrival
 *            at the far edge come at the same times, the crack's way is the same until it forks,
 *            and fracture takes the same energy. Nothing breaks outside the band (the run would
 *            end).
 * Reference  the same plate, fine everywhere: where particles are fine both are the same lattice.
 * Tolerance  1 % for the first bond, 2 % for the arrival and 5 % for the energy at the end: after
 *            the fork, at 15 mm, small differences grow and branches are compared by statistics
 *            alone. One fine spacing sideways for the tip until it has come 12 mm. Work against
 *            kinetic, elastic and fracture energy 1 % (as in crack_branching_12MPa).
 *            Beside, without a claim: how much faster, and the most that counts of particles allow.
 * --full: particles of 0.25 mm in a plate of 1 mm, two levels.
 * BUILD modules=solid
 * TEST  ranks=1 */
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static const double LENGTH = 0.1, HEIGHT = 0.04, PULL = 12e6, COARSE = 1e-3;
enum { SAMPLES = 400 }; /* moments at which the tip is looked at */

typedef struct {
  double first, edge;   /* times [s]: of the first bond, of the crack's arrival; NaN: never */
  double tip[SAMPLES];  /* farthest damaged particle's x [m] */
  double side[SAMPLES]; /* and its y */
  double fracture;      /* energy [J] */
  double lost;          /* work not found again, over the work */
  double seconds;       /* processor time of the steps */
  double particles;
} story;

/* Sites of a plate with this spacing. */
static bw_status plate(const bw_comm *comm, int levels, bool everywhere, bw_solid **pd)
{
  const double ds = everywhere ? ldexp(COARSE, -levels) : COARSE;
  const int nx = (int)lround(LENGTH / ds), ny = (int)lround(HEIGHT / ds);
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRESS;
  c.ds = ds;
  c.rho = 2440;
  c.E = 72e9;
  c.G0 = 135;
  c.surface_correction = BW_PD_SURFACE_TENSOR;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  if (!everywhere) {
    c.finer.n = 2;
    c.finer.box[0] = (bw_pd_box){levels, {0.042, 0.012}, {0.072, 0.028}};
    c.finer.box[1] = (bw_pd_box){levels, {0.068, 0.003}, {0.11, 0.037}}; /* where it has forked */
  }
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = BW_ALLOCATE(&site, 3 * (size_t)nx * (size_t)ny);
  BW_THEN(st, BW_ALLOCATE(&kind, (size_t)nx * (size_t)ny));
  for (int q = 0; q < nx * ny && st == BW_OK; q++) {
    /* A coarse horizon under the pulled edges keeps its bonds: nothing is torn off there. */
    const double y = (q / nx + 0.5) * ds;
    site[3 * q] = q % nx, site[3 * q + 1] = q / nx;
    kind[q] = fmin(y, HEIGHT - y) < 3 * COARSE ? BW_PD_UNBREAKABLE : BW_PD_FREE;
  }
  BW_THEN(st, bw_solid_create_same(comm, &c, (int64_t)nx * ny, site, kind, pd));
  bw_release(&site);
  bw_release(&kind);
  BW_THEN(st, bw_solid_precrack(*pd, (double[]){-1e-3, HEIGHT / 2, 0},
                                (double[]){LENGTH / 2, HEIGHT / 2, 0}, NULL));
  return st;
}

/* Tractions of the two long edges, in the outermost millimetre: the same force whatever is there.
 */
static void pull(const bw_solid *pd, const double X0[], double F[])
{
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    const double y = X0[3 * i + 1];
    if (y > HEIGHT - COARSE) F[3 * i + 1] = PULL / COARSE;
    if (y < COARSE) F[3 * i + 1] = -PULL / COARSE;
  }
}

/* The farthest particle ahead of the notch with a third of its family gone. */
static void look(const bw_solid *pd, const double X0[], double damage[], double tip[2])
{
  bw_solid_get_damage(pd, damage);
  tip[0] = LENGTH / 2, tip[1] = HEIGHT / 2;
  for (size_t i = 0; i < bw_solid_count(pd); i++)
    if (damage[i] > 0.35 && X0[3 * i] > tip[0]) tip[0] = X0[3 * i], tip[1] = X0[3 * i + 1];
}

static bw_status follow(bw_solid *pd, double dt, double end, double X0[], double F[],
                        double damage[], story *o)
{
  bw_solid_ledger book = {0};
  bw_status st = BW_OK;
  const int64_t steps = llround(end / dt);
  o->first = o->edge = NAN;
  bw_solid_get_reference(pd, X0);
  pull(pd, X0, F);
  bw_solid_set_force(pd, F);
  const int64_t before = bw_solid_events(pd);
  const clock_t began = clock();
  for (int64_t q = 1; q <= steps && st == BW_OK; q++) {
    double tip[2];
    st = bw_solid_step(pd, dt);
    const double t = (double)q * dt;
    if (isnan(o->first) && bw_solid_events(pd) > before) o->first = t;
    if (q % (steps / SAMPLES) != 0 || q / (steps / SAMPLES) > SAMPLES) continue;
    look(pd, X0, damage, tip);
    o->tip[q / (steps / SAMPLES) - 1] = tip[0];
    o->side[q / (steps / SAMPLES) - 1] = tip[1];
    if (isnan(o->edge) && tip[0] > LENGTH - 2.5 * COARSE) o->edge = t;
  }
  o->seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
  o->particles = (double)bw_solid_total(pd);
  BW_TRY(st);
  BW_TRY(bw_solid_account(pd, &book));
  o->fracture = book.fracture;
  o->lost = (book.external - book.kinetic - book.elastic - book.fracture) / book.external;
  return BW_OK;
}

static bw_status tear(const bw_comm *comm, int levels, bool everywhere, story *o)
{
  bw_solid *pd = NULL;
  double *X0 = NULL, *F = NULL, *damage = NULL;
  bw_status st = plate(comm, levels, everywhere, &pd);
  if (st == BW_OK) {
    const size_t n = bw_solid_count(pd);
    st = BW_ALLOCATE(&X0, 3 * n);
    BW_THEN(st, BW_ALLOCATE(&F, 3 * n));
    BW_THEN(st, BW_ALLOCATE(&damage, n));
    /* The same step for both: 50 ns at 1 mm are usual. */
    BW_THEN(st, follow(pd, ldexp(50e-9, -levels), 50e-6, X0, F, damage, o));
  }
  bw_release(&X0);
  bw_release(&F);
  bw_release(&damage);
  bw_solid_destroy(&pd);
  return st;
}

static void claim(bw_validation *v, const char *what, const char *quantity, double measured,
                  double reference, double tolerance, const char *extra)
{
  bw_validation_row(v, &(bw_claim){.claim = what,
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_CONSERVATION,
                                   .source = "the same plate, fine everywhere",
                                   .extra = extra});
}

static bw_status run(bw_validation *v)
{
  const int levels = bw_validation_full(v) ? 2 : 1;
  const bw_comm *comm = bw_validation_comm(v);
  story band = {0}, all = {0};
  char extra[64];
  BW_TRY(tear(comm, levels, false, &band));
  BW_TRY(tear(comm, levels, true, &all));
  snprintf(extra, sizeof extra, "\"levels\": %d, \"nodes\": %.0f", levels + 1, band.particles);
  /* Until it has come 12 mm: farthest apart sideways, at the same places along the way. */
  double apart = 0;
  for (int q = 0, r = 0; q < SAMPLES && all.tip[q] < LENGTH / 2 + 0.012; q++) {
    while (r + 1 < SAMPLES && band.tip[r] < all.tip[q])
      r++;
    apart = fmax(apart, fabs(all.side[q] - band.side[r]));
  }
  claim(v, "the first bond breaks when it did", "t_first", band.first, all.first, 0.01, extra);
  claim(v, "the crack arrives when it did", "t_edge", band.edge, all.edge, 0.02, extra);
  claim(v, "the way is the same until it forks", "ways_apart_in_spacings",
        apart / ldexp(COARSE, -levels), 0, 1.0 + 1e-6, extra);
  claim(v, "fracture takes the same energy", "fracture", band.fracture, all.fracture, 0.05, extra);
  claim(v, "work is found again", "energy_error", band.lost, 0, 0.01, extra);
  claim(v, "how much faster", "speed_up", all.seconds / band.seconds,
        all.particles / band.particles, INFINITY, extra);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.levels_crack", run);
}
