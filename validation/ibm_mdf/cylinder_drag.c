/* Claim: three independent routes give the drag of a confined cylinder, and with the markers on its
 * true surface it is the true one (FSI, table 1; ERRATA 21, 23, 24).
 *
 * Reference  an independent finite-element solution for the same domain (8 d x 4 d, cylinder in
 *            the middle): data/confined_cylinder; FSI's printed figures are reported beside.
 * Measured   force of the markers; momentum balance of a box of 2 d; normal probes on the nominal
 *            surface. Steady: the drag changes by less than 1e-5 per d/U_b (forces that hardly move
 *            the fluid, pressure of the inside against the outside, are found within 36 d/U_b only
 *            and are worth 4e-4 of the drag, 2e-3 where markers are not retracted). 15 cells across
 *            the cylinder at Re_d 20 and 25 and 30 at 20; --full: 60 cells, every kernel and 1 to 8
 *            iterations at 15 and 30 cells, drag against retraction; Re_d 40 and 50 on three grids,
 *            whose order is reported.
 * Tolerance  reaction and box: identical up to round-off of the accumulated fluxes, 1e4 eps.
 *            reaction with markers on the true surface: 0.3 %, a goal set before; the reference is
 *            good for 0.1 %, and (h/R)^2 at 15 cells is 1.8 %.
 *            reaction with retracted markers: 0.1 h of doubt about where the smeared wall is
 *            (Breugem 2012 has 0.2 to 0.4 best, by shape) moves the drag as 0.2 h/d of blockage
 *            and size do, 1.6 % at 15 cells; with errors of the grid 0.3 h/d: 2, 1 and 0.5 %.
 *            Three routes: probes within 3 % of the other two from 30 cells on, a goal set before.
 *            Order with retraction: reported; what is left is what the reference is good for, 1e-3.
 *            Not retracted: at least half as much too high as 0.3 h would take off, 0.35 h/d.
 *            Probes: friction is 35 % of this drag (the reference's wall table); the parabola
 *            loses (dl/delta)^2/2 of it, delta = d/sqrt(Re), and gives 5 % too much where nothing
 *            else is wrong (validation/probe/plates). Reported beside: probes after one iteration,
 *            whose slip, 3 to 4 % of U_b, they take for shear; and the documents' linear profile,
 *            whose error has to be first order in dl (--full).
 * BUILD modules=ns_channel,probe
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/cylinder_flow.h"
#include "bw_validation.h"

#include <stdio.h>
#include <string.h>

static const double STEADY = 1.0e-5, LATEST = 90.0, FRICTION_SHARE = 0.35;

/* Cd of the reference for a domain. */
static bw_status reference(const cylinder_config *c, double *Cd)
{
  enum { COLUMNS = 5, MOST = 32 };
  double table[MOST][COLUMNS]; /* blockage, Re_d, d before, d behind, Cd */
  int rows = 0;
  BW_TRY(bw_validation_table("confined_cylinder/confined_cylinder.csv", COLUMNS, MOST, table[0],
                             &rows));
  *Cd = NAN;
  for (int q = 0; q < rows; q++) {
    const double *r = table[q];
    if (r[0] == c->blockage && r[1] == c->reynolds && r[2] == c->upstream && r[3] == c->downstream)
      *Cd = r[4];
  }
  BW_REQUIRE(isfinite(*Cd), BW_EINPUT, "no reference for Re_d %g, %g d before, %g d behind",
             c->reynolds, c->upstream, c->downstream);
  return BW_OK;
}

/* Steady drag of one configuration, and the pressure inside that its markers remember. */
static bw_status steady_drag(const bw_comm *comm, const cylinder_config *c, cylinder_drag *drag,
                             double *inside)
{
  cylinder_flow f;
  bw_status st = cylinder_create(comm, c, &f);
  double last = HUGE_VAL;
  bool steady = false;
  for (double t = 1.0; st == BW_OK && !steady && t <= LATEST; t += 1.0) {
    st = cylinder_advance(&f, 1.0);
    if (st != BW_OK) break;
    *drag = cylinder_measure(&f);
    steady = fabs(drag->reaction - last) < STEADY * fabs(drag->reaction);
    last = drag->reaction;
  }
  if (st == BW_OK) *inside = body_pressure_inside(&f.flow, &f.markers);
  cylinder_destroy(&f);
  if (st == BW_OK && !steady)
    st = BW_FAIL(BW_EDIVERGED, "the drag is not steady after %g d/U_b", LATEST);
  return st;
}

typedef struct {
  const char *quantity;
  double measured, reference, tolerance;
  bw_claim_kind kind;
  const char *source;
} row;

/* All rows of one configuration; `claimed`: hold the drags to their tolerances. error: of the
 * reaction and of the linear probes. */
static bw_status one_case(bw_validation *v, const cylinder_config *c, bool claimed, double error[2])
{
  double Cd = NAN, inside = NAN;
  cylinder_drag d = {0};
  BW_TRY(reference(c, &Cd));
  BW_TRY(steady_drag(bw_validation_comm(v), c, &d, &inside));
  const double over = c->probe_length / c->cells_per_diameter * sqrt(c->reynolds);
  const double second = 0.5 * over * over + 0.05, none = INFINITY, cells = c->cells_per_diameter;
  const bool no_slip = c->memory > 0.0 || c->n_iter > 1;
  const double doubt = isnan(c->retraction) ? 0.003 : 0.3 / cells;
  const double round_off = 1.0e4 * BW_REAL_EPSILON; /* sums over 120 faces, 3 sub-steps */
  static const char fem[] = "independent finite elements, data/confined_cylinder";
  const row rows[] = {
      {"Cd_reaction", d.reaction, Cd, claimed ? doubt : none, BW_INDEPENDENT_CODE, fem},
      {"Cd_control_volume", d.control_volume, d.reaction, round_off, BW_CONSERVATION,
       "momentum balance of the box against the force of the markers"},
      {"Cd_probe", d.probe[1], Cd, claimed && no_slip ? FRICTION_SHARE * second : none,
       BW_INDEPENDENT_CODE, fem},
      {"Cd_probe_linear", d.probe[0], Cd, none, BW_INDEPENDENT_CODE, fem},
      {"probe_off", d.probe[1] / d.reaction - 1.0, 0.0,
       claimed && no_slip && cells >= 30 ? 0.03 : none, BW_CONSERVATION,
       "three routes to one force: probes against reaction and box"},
      {"slip", d.slip, 0.0, none, BW_ANALYTIC, "no slip, in U_b"},
      {"pressure_inside", inside, 0.0, round_off, BW_CONSERVATION,
       "what markers remember of a closed surface moves nothing (bw_ibm_mdf_close)"}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++) {
    const char *kernel = bw_kernel_delta_get((bw_kernel_delta_id)c->kernel)->name;
    char claim[128], extra[256];
    const bool on_surface = isnan(c->retraction);
    const double back = on_surface ? 0.0 : c->retraction;
    snprintf(claim, sizeof claim, "%s, %d cells, %s %.2f, N_s %d, memory %.2g, %s",
             rows[q].quantity, c->cells_per_diameter, on_surface ? "true surface" : "retraction",
             back, c->n_iter, c->memory, kernel);
    snprintf(extra, sizeof extra,
             "\"Re_d\": %g, \"cells_per_diameter\": %d, \"retraction\": %g, "
             "\"true_surface\": %s, \"n_iter\": %d, \"memory\": %g, \"kernel\": \"%s\", "
             "\"upstream\": %g, \"downstream\": %g",
             c->reynolds, c->cells_per_diameter, back, on_surface ? "true" : "false", c->n_iter,
             c->memory, kernel, c->upstream, c->downstream);
    bw_validation_row(v, &(bw_claim){claim, rows[q].quantity, rows[q].measured, rows[q].reference,
                                     rows[q].tolerance, rows[q].kind, rows[q].source, extra});
  }
  error[0] = d.reaction / Cd - 1.0;
  error[1] = d.probe[0] / Cd - 1.0;
  return BW_OK;
}

/* The drag without retraction is too high; FSI's own figures, its place of the cylinder and markers
 * not printed, beside. */
static bw_status not_retracted(bw_validation *v, cylinder_config c, double error[2])
{
  const bool more = c.reynolds > 20.0;
  const double fsi = more ? 5.5 / 5.0 - 1.0 : 6.0 / 5.5 - 1.0;
  char extra[96];
  c.retraction = 0.0;
  BW_TRY(one_case(v, &c, false, error));
  snprintf(extra, sizeof extra, "\"Re_d\": %g, \"cells_per_diameter\": %d", c.reynolds,
           c.cells_per_diameter);
  bw_validation_row(v, &(bw_claim){"excess of the drag without retraction", "excess", error[0], fsi,
                                   INFINITY, BW_PUBLISHED, "FSI, table 1 (15 cells)", extra});
  const double least = 0.35 / c.cells_per_diameter;
  bw_validation_row(v, &(bw_claim){"without retraction the drag is too high", "excess_missing",
                                   fmax(least - error[0], 0.0), 0.0, 0.0, BW_INDEPENDENT_CODE,
                                   "independent finite elements, data/confined_cylinder", extra});
  return BW_OK;
}

/* As well as we know: on the true surface, or retracted where there is no memory. */
static bw_status as_known(bw_validation *v, cylinder_config c, double error[2])
{
  c.retraction = c.memory > 0.0 ? NAN
                                : bw_ibm_mdf_retraction(&(bw_ibm_mdf_config){
                                      .kernel = (bw_kernel_delta_id)c.kernel, .n_iter = c.n_iter});
  return one_case(v, &c, true, error);
}

/* Drag against retraction: the best one is where the error vanishes. */
static bw_status sweep(bw_validation *v, cylinder_config c, double step, double *best)
{
  double last = NAN, error[2];
  *best = NAN;
  for (int q = 0; q * step < 0.61; q++) {
    c.retraction = q * step;
    BW_TRY(one_case(v, &c, false, error));
    if (q > 0 && last > 0.0 && error[0] <= 0.0) *best = (q - 1 + last / (last - error[0])) * step;
    last = error[0];
  }
  char extra[128];
  snprintf(extra, sizeof extra, "\"kernel\": \"%s\", \"n_iter\": %d, \"cells_per_diameter\": %d",
           bw_kernel_delta_get((bw_kernel_delta_id)c.kernel)->name, c.n_iter, c.cells_per_diameter);
  bw_validation_row(v, &(bw_claim){"retraction of no error", "best_retraction", *best, 0.3,
                                   INFINITY, BW_PUBLISHED, "Breugem 2012 (spheres, Roma)", extra});
  return BW_OK;
}

/* Without memory: every kernel and number of iterations, at the table's retraction and around
 * it. */
static bw_status kernels(bw_validation *v, cylinder_config c)
{
  double best = NAN, error[2];
  c.memory = 0.0;
  for (c.kernel = 0; c.kernel < BW_KERNEL_COUNT; c.kernel++)
    for (c.n_iter = 1; c.n_iter <= 8; c.n_iter *= 2)
      for (c.cells_per_diameter = 15; c.cells_per_diameter <= 30; c.cells_per_diameter *= 2) {
        BW_TRY(as_known(v, c, error));
        if (c.cells_per_diameter == 15) BW_TRY(sweep(v, c, 0.1, &best));
      }
  return BW_OK;
}

static void order_row(bw_validation *v, const char *claim, double coarse, double fine, double doubt)
{
  const double order = bw_validation_order(2.0, fabs(coarse), 1.0, fabs(fine));
  bw_validation_row(v, &(bw_claim){claim, "order", order, 1.0, doubt, BW_ORDER,
                                   "error is a fixed number of spacings", NULL});
}

/* Re_d 40 and 50, for which there is no reference: what three grids say of each other. */
static bw_status refined(bw_validation *v, cylinder_config c)
{
  double Cd[3], inside = NAN;
  char extra[96];
  c.retraction = NAN;
  for (int q = 0; q < 3; q++) {
    cylinder_drag d = {0};
    c.cells_per_diameter = 15 << q;
    BW_TRY(steady_drag(bw_validation_comm(v), &c, &d, &inside));
    Cd[q] = d.reaction;
  }
  const double order = log2(fabs((Cd[0] - Cd[1]) / (Cd[1] - Cd[2])));
  snprintf(extra, sizeof extra, "\"Re_d\": %g, \"Cd_15\": %.6g, \"Cd_30\": %.6g, \"Cd_60\": %.6g",
           c.reynolds, Cd[0], Cd[1], Cd[2]);
  bw_validation_row(v, &(bw_claim){"drag on three grids, true surface", "order", order, 2.0,
                                   INFINITY, BW_ORDER, "15, 30, 60 cells", extra});
  return BW_OK;
}

/* The documents' variations: finer grids, kernels, iterations. */
static bw_status full(bw_validation *v, cylinder_config c)
{
  double with[3][2], without[3][2], unused[2]; /* 15, 30, 60 cells; [reaction, linear probe] */
  BW_TRY(kernels(v, c));
  for (int q = 0; q < 3; q++) {
    c.cells_per_diameter = 15 << q;
    BW_TRY(as_known(v, c, with[q]));
    BW_TRY(not_retracted(v, c, without[q]));
  }
  for (int q = 0; q < 2; q++) {
    order_row(v, "without retraction the error is first order", without[q][0], without[q + 1][0],
              0.3);
    order_row(v, "with retraction", with[q][0], with[q + 1][0], INFINITY);
    order_row(v, "the linear profile is first order", with[q][1], with[q + 1][1], 0.3);
  }
  for (c.reynolds = 40.0; c.reynolds <= 50.0; c.reynolds += 10.0)
    BW_TRY(refined(v, c));
  c.reynolds = 25.0;
  BW_TRY(as_known(v, c, unused));
  c.cells_per_diameter = 15, c.reynolds = 20.0, c.upstream = 10.0, c.downstream = 25.0;
  return as_known(v, c, unused);
}

static bw_status run(bw_validation *v)
{
  cylinder_config c = cylinder_config_default();
  double error[2], best = NAN;
  c.reynolds = 20.0;
  if (bw_validation_full(v)) BW_TRY(full(v, c));
  for (c.reynolds = 20.0; c.reynolds <= 25.0; c.reynolds += 5.0) {
    BW_TRY(as_known(v, c, error));
    BW_TRY(not_retracted(v, c, error));
  }
  c.reynolds = 20.0;
  if (bw_validation_full(v)) return BW_OK;
  BW_TRY(sweep(v, c, 0.2, &best));
  c.cells_per_diameter = 30;
  BW_TRY(as_known(v, c, error));
  c.reynolds = 25.0;
  return as_known(v, c, error);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.cylinder_drag", run);
}
