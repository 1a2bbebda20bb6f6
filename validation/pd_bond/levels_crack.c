/* A crack in a plate that is fine where it runs: in a band that was told, or as it finds its way.
 *
 * Claim      The notched glass plate of crack_branching, pulled by 12 MPa, breaks alike whether all
 *            of it is fine or only a band that its crack stays in: the first bond and the arrival
 *            at the far edge come at the same times, the crack's way is the same until it forks,
 *            and fracture takes the same energy. Nothing breaks outside the band (the run would
 *            end). So it does where levels follow the crack, and where nothing else is told.
 * Reference  the same plate, fine everywhere: where particles are fine both are the same lattice.
 * Tolerance  1 % for the first bond, 2 % for the arrival, 5 % for the energy at the end: after the
 *            fork, at 15 mm, small differences grow. Where levels follow 2 % for the first bond and
 *            for the way to 12 mm; what comes after the fork has no claim: fine plates that are
 *            pulled evenly, and with three in a thousand more above, arrive 6 % apart themselves.
 *            One fine spacing sideways for the tip until it has come 12 mm. Work against kinetic,
 *            elastic and fracture energy 1 % (as in crack_branching_12MPa). Beside that, without
 *            a claim: how much faster, and the most that counts of particles (over time) allow;
 *            what changes of levels took.
 * --full: particles of 0.25 mm in a plate of 1 mm, two levels.
 * BUILD modules=solid
 * TEST  ranks=1 */
#include "bw_memory.h"
#include "bw_solid_levels.h"
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
  double end;           /* of the story [s] */
  double lost;          /* work not found again, over the work */
  double regrid;        /* energy that changes of levels took, over fracture */
  double seconds;       /* processor time of the steps, and of looks and changes of levels ... */
  double adapting;      /* ... of the latter alone */
  double particles;     /* in the mean over time */
  double changes;       /* of levels */
} story;

/* How a plate is fine. */
typedef enum { EVERYWHERE, BAND, FOLLOWED } way;

/* Sites of a plate with this spacing. */
static bw_status plate(const bw_comm *comm, int levels, way how, bw_solid **pd)
{
  const double ds = how == EVERYWHERE ? ldexp(COARSE, -levels) : COARSE;
  const int nx = (int)lround(LENGTH / ds), ny = (int)lround(HEIGHT / ds);
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRESS;
  c.ds = ds;
  c.rho = 2440;
  c.E = 72e9;
  c.G0 = 135;
  c.surface_correction = BW_PD_SURFACE_TENSOR;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  if (how == FOLLOWED) {
    c.finer.refine.level = levels;
  }
  if (how == BAND) {
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
static void pull(const bw_solid *pd, double above, const double X0[], double F[])
{
  for (size_t i = 0; i < bw_solid_count(pd); i++) {
    const double y = X0[3 * i + 1];
    if (y > HEIGHT - COARSE) F[3 * i + 1] = above * PULL / COARSE;
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

/* What is asked of a plate by particle. */
typedef struct {
  size_t n;
  double above;            /* pull of the upper edge over that of the lower one */
  int64_t events;          /* before any bond broke: new levels count, too */
  double *X0, *F, *damage; /* (n,3), (n,3), (n) */
} crowd;

static void release(crowd *c)
{
  bw_release(&c->X0);
  bw_release(&c->F);
  bw_release(&c->damage);
}

/* Places and tractions of the particles that there are now. */
static bw_status gather(bw_solid *pd, crowd *c)
{
  release(c);
  c->n = bw_solid_count(pd);
  c->events = bw_solid_events(pd);
  BW_TRY(BW_ALLOCATE(&c->X0, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->F, 3 * c->n));
  BW_TRY(BW_ALLOCATE(&c->damage, c->n));
  bw_solid_get_reference(pd, c->X0);
  pull(pd, c->above, c->X0, c->F);
  bw_solid_set_force(pd, c->F);
  return BW_OK;
}

/* One step; before it levels follow. */
static bw_status advance(bw_solid *pd, double dt, crowd *c, story *o)
{
  bool changed = false;
  const clock_t began = clock();
  bw_status st = bw_solid_adapt(pd, &changed);
  if (changed) BW_THEN(st, gather(pd, c));
  const clock_t adapted = clock();
  o->changes += changed;
  BW_THEN(st, bw_solid_step(pd, dt));
  o->adapting += (double)(adapted - began) / CLOCKS_PER_SEC;
  o->seconds += (double)(clock() - began) / CLOCKS_PER_SEC;
  return st;
}

static bw_status follow(bw_solid *pd, double dt, double end, crowd *c, story *o)
{
  bw_solid_ledger book = {0};
  const int64_t steps = llround(end / dt), every = steps / SAMPLES;
  o->first = o->edge = NAN;
  o->end = end;
  bw_status st = gather(pd, c);
  for (int64_t q = 1; q <= steps && st == BW_OK; q++) {
    double tip[2];
    st = advance(pd, dt, c, o);
    o->particles += (double)bw_solid_total(pd) / (double)steps;
    const double t = (double)q * dt;
    if (isnan(o->first) && bw_solid_events(pd) > c->events) o->first = t;
    if (q % every != 0 || q / every > SAMPLES) continue;
    look(pd, c->X0, c->damage, tip);
    o->tip[q / every - 1] = tip[0];
    o->side[q / every - 1] = tip[1];
    if (isnan(o->edge) && tip[0] > LENGTH - 2.5 * COARSE) o->edge = t;
  }
  BW_THEN(st, bw_solid_account(pd, &book));
  o->fracture = book.fracture;
  o->regrid = book.regrid / book.fracture;
  o->lost =
      (book.external - book.kinetic - book.elastic - book.fracture - book.regrid) / book.external;
  return st;
}

static bw_status tear(const bw_comm *comm, int levels, way how, double above, story *o)
{
  bw_solid *pd = NULL;
  crowd c = {.above = above};
  bw_status st = plate(comm, levels, how, &pd);
  /* The same step for all: 50 ns at 1 mm are usual. */
  BW_THEN(st, follow(pd, ldexp(50e-9, -levels), 50e-6, &c, o));
  release(&c);
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

/* Until it has come 12 mm: farthest apart sideways, at the same places along the way. */
static double ways_apart(const story *all, const story *some)
{
  double apart = 0;
  for (int q = 0, r = 0; q < SAMPLES && all->tip[q] < LENGTH / 2 + 0.012; q++) {
    while (r + 1 < SAMPLES && some->tip[r] < all->tip[q])
      r++;
    apart = fmax(apart, fabs(all->side[q] - some->side[r]));
  }
  return apart;
}

/* When the tip has come so far. */
static double time_of(const story *o, double come)
{
  int q = 0;
  while (q < SAMPLES && o->tip[q] < LENGTH / 2 + come)
    q++;
  return q < SAMPLES ? o->end * (q + 1) / SAMPLES : NAN;
}

static void compare(bw_validation *v, int levels, const char *name, const story *some,
                    const story *all, bool followed)
{
  const double after = followed ? INFINITY : 1; /* the fork: reported alone */
  char extra[128];
  snprintf(extra, sizeof extra, "\"fine\": \"%s\", \"levels\": %d, \"nodes\": %.0f", name,
           levels + 1, some->particles);
  claim(v, "the first bond breaks when it did", "t_first", some->first, all->first,
        followed ? 0.02 : 0.01, extra);
  claim(v, "the crack comes 12 mm when it did", "t_12mm", time_of(some, 0.012), time_of(all, 0.012),
        0.02, extra);
  claim(v, "the way is the same until it forks", "ways_apart_in_spacings",
        ways_apart(all, some) / ldexp(COARSE, -levels), 0, 1.0 + 1e-6, extra);
  claim(v, "the crack arrives when it did", "t_edge", some->edge, all->edge, 0.02 * after, extra);
  claim(v, "fracture takes the same energy", "fracture", some->fracture, all->fracture,
        0.05 * after, extra);
  claim(v, "work is found again", "energy_error", some->lost, 0, 0.01, extra);
  claim(v, "how much faster", "speed_up", all->seconds / some->seconds,
        all->particles / some->particles, INFINITY, extra);
  if (!followed) return;
  claim(v, "what changes of levels take", "regrid_over_fracture", some->regrid, 0, INFINITY, extra);
  claim(v, "how often levels change", "changes", some->changes, 0, INFINITY, extra);
  claim(v, "part of the time that takes", "adapting", some->adapting / some->seconds, 0, INFINITY,
        extra);
  const double cells = LENGTH * HEIGHT / (COARSE * COARSE);
  claim(v, "part of the plate that is fine", "fine",
        (some->particles - cells) / (all->particles - cells), 0, INFINITY, extra);
}

static bw_status run(bw_validation *v)
{
  const int levels = bw_validation_full(v) ? 2 : 1;
  const bw_comm *comm = bw_validation_comm(v);
  story band = {0}, followed = {0}, all = {0}, uneven = {0};
  BW_TRY(tear(comm, levels, EVERYWHERE, 1, &all));
  BW_TRY(tear(comm, levels, EVERYWHERE, 1.003, &uneven));
  BW_TRY(tear(comm, levels, BAND, 1, &band));
  BW_TRY(tear(comm, levels, FOLLOWED, 1, &followed));
  compare(v, levels, "band", &band, &all, false);
  compare(v, levels, "followed", &followed, &all, true);
  claim(v, "how far apart fine plates arrive", "t_edge", uneven.edge, all.edge, INFINITY,
        "\"fine\": \"all\"");
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.levels_crack", run);
}
