/* Claim: three routes give the drag of a sphere held on the axis of a square channel in slow
 * laminar flow, and with the markers on the true surface it is the true one, to second order.
 *
 *   F = 6 pi mu a K U,  U the mean velocity of the channel, K(d/H)
 * Reference  fundamental solutions for an infinite channel, data/sphere_in_channel; their
 *            program gives the known series of a sphere in a tube to 5e-7.
 * Measured   d = 1, nu = 1; walls in y and z, periodic in x, two heights long, at a fixed rate of
 *            flow, Re = U d/nu = 0.05 (K gains order Re^2). Markers one per h^2 on a spiral. Force
 *            of the markers; momentum balance of a box of 1.5 d; probes on the nominal surface (p
 *            is without the gradient that drives the flow: its share g V is added).
 *            H = 2 d at 8, 12, 16 cells per diameter; --full: 24 cells, H = 4 d, half the step,
 *            a box of three heights (disturbances die as exp(-4.2 x/H)).
 * Tolerance  box: identical up to round-off of the accumulated fluxes, as in cylinder_drag.
 *            reaction: markers and fluid see everything through the kernel, whose second moment
 *            m2 = 0.29 h^2 adds (m2/2) lap u to a velocity: with lap u = 28.5 U/H^2 of the stream
 *            about 0.6 (h/a)^2/(H/d)^2 of the drag, twice (read and spread), as much again for
 *            the walls' answer, and the fluid's operators are of second order with a constant of
 *            that size: 0.6 (h/a)^2, 3.75 % with 8 cells. The order between 8 and 16 cells is 2 to
 *            0.3. Not retracted and without knowing its side: a first-order error.
 *            probes: that, and what their formulas lose on Stokes' exact flow about a lone sphere,
 *            14, 8, 5 and 3 % with 8 to 24 cells (applied to the reference's own flow in the
 *            channel they lose 13.2, 7.8, 5.2 and 2.8 %).
 * BUILD modules=ns_channel,probe
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_probe.h"
#include "bw_validation.h"

#include <stdio.h>

enum { MOST = 16 };
static const double PI = 3.14159265358979323846, RE = 0.05;
static const double STEADY = 1.0e-4, PAUSE = 0.02, LATEST = 1.0; /* change per PAUSE H^2/nu */

typedef struct {
  int cells;         /* per diameter */
  double heights;    /* H/d */
  double length;     /* of the box [H] */
  double retraction; /* of the markers [h]; NaN: none, they stand on the true surface */
  double step;       /* of the largest stable one */
} set_up;

typedef struct {
  body_flow flow;
  bw_probe *probe;
  body_surface wall; /* points on the nominal surface */
  double *traction;  /* (n,3) there */
  double *drive;     /* (n,3) less the acceleration that drives the fluid: p is without it */
  double h;
} scene;

/* Over 6 pi mu a U; slip over U. */
typedef struct {
  double reaction, control_volume, probe, slip;
} drag;

static void scene_destroy(scene *s)
{
  body_surface_free(&s->wall);
  bw_release(&s->traction);
  bw_release(&s->drive);
  bw_probe_destroy(&s->probe);
  body_flow_destroy(&s->flow);
}

static bw_status make_flow(const bw_comm *comm, const set_up *b, const bw_ibm_mdf_config *body,
                           scene *s)
{
  const int across = (int)lround(b->heights * b->cells), along = (int)lround(b->length * across);
  const body_box box = {.n = {along, across, across},
                        .h = s->h,
                        .nu = 1.0,
                        .periodic = {true, false, false},
                        .forcing = BW_FORCING_FLOW_RATE,
                        .forcing_value = RE,
                        .body = *body};
  BW_TRY(body_flow_box(comm, &box, &s->flow));
  s->flow.dt = b->step * bw_ns_channel_dt_max(s->flow.fluid);
  const int x = along / 2, y = across / 2, off = 3 * b->cells / 4;
  return bw_ns_channel_watch_box(s->flow.fluid, (int[3]){x - off, y - off, y - off},
                                 (int[3]){x + off, y + off, y + off});
}

/* Off the nodes along the channel, on its axis across. */
static bw_status surface(const bw_comm *comm, const set_up *b, double R, double h, body_surface *s)
{
  const double H = b->heights, centre[3] = {0.5 * b->length * H + 0.37 * h, 0.5 * H, 0.5 * H};
  BW_TRY(body_surface_alloc(comm, body_sphere_size(R, h), s));
  body_sphere(s, centre, R, h);
  return BW_OK;
}

static bw_status make_probes(const bw_comm *comm, const set_up *b, scene *s)
{
  bw_probe_config config = bw_probe_config_default();
  config.rho = config.nu = 1.0;
  config.profile = BW_PROBE_QUADRATIC;
  BW_TRY(surface(comm, b, 0.5, s->h, &s->wall));
  BW_TRY(BW_ALLOCATE(&s->traction, 3 * s->wall.n));
  BW_TRY(BW_ALLOCATE(&s->drive, 3 * s->wall.n));
  BW_TRY(bw_probe_create(s->flow.grid, &config, &s->probe));
  return bw_probe_set_points(s->probe, s->wall.n, s->wall.X, s->wall.N);
}

static bw_status make(const bw_comm *comm, const set_up *b, scene *s)
{
  const bw_ibm_mdf_config body = bw_ibm_mdf_config_default();
  const bool on_surface = isnan(b->retraction);
  const double back = on_surface ? 0.0 : b->retraction;
  body_surface markers = {0};
  *s = (scene){.h = 1.0 / b->cells};
  BW_TRY(make_flow(comm, b, &body, s));
  if (!on_surface) s->flow.nu = 0.0;
  bw_status st = surface(comm, b, 0.5 - back * s->h, s->h, &markers);
  BW_THEN(st, body_set_markers(&s->flow, &markers));
  body_surface_free(&markers);
  BW_THEN(st, make_probes(comm, b, s));
  return st;
}

static drag measure(scene *s)
{
  const double unit = 3.0 * PI * RE;
  bw_real *const *u = bw_ns_channel_velocity(s->flow.fluid);
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(s->flow.body, u);
  drag d = {.reaction = -r.total_force[0] / unit, .slip = r.slip_after / RE};
  double box[3];
  bw_ns_channel_control_volume(s->flow.fluid, box);
  d.control_volume = -box[0] / unit;
  const double driving = bw_ns_channel_driving(s->flow.fluid);
  for (size_t q = 0; q < s->wall.n; q++)
    s->drive[3 * q] = -driving;
  bw_probe_traction(s->probe, u, s->flow.pressure, s->drive, s->traction, NULL);
  for (size_t q = 0; q < s->wall.n; q++)
    d.probe += s->traction[3 * q] * s->wall.dV[q] / s->h / unit;
  bw_comm_sum(bw_grid_comm(s->flow.grid), 1, &d.probe);
  d.probe += driving * PI / 6.0 / unit;
  return d;
}

static bw_status steady_drag(const bw_comm *comm, const set_up *b, drag *d)
{
  scene s;
  bw_status st = make(comm, b, &s);
  const double pause = PAUSE * b->heights * b->heights;
  double last = HUGE_VAL;
  bool steady = false;
  for (int q = 1; st == BW_OK && !steady && q * PAUSE < LATEST; q++) {
    while (st == BW_OK && bw_ns_channel_time(s.flow.fluid) < q * pause)
      st = body_flow_step(&s.flow);
    if (st != BW_OK) break;
    *d = measure(&s);
    steady = fabs(d->reaction - last) < STEADY * fabs(d->reaction);
    last = d->reaction;
  }
  scene_destroy(&s);
  if (st == BW_OK && !steady)
    st = BW_FAIL(BW_EDIVERGED, "the drag is not steady after %g H^2/nu", LATEST);
  return st;
}

/* K of the reference and d ln(a K)/d ln a, from the rows d/H, K, slip. */
static bw_status reference(double heights, double *K, double *slope)
{
  double table[MOST][3];
  int rows = 0, q = 0;
  BW_TRY(bw_validation_table("sphere_in_channel/square_channel.csv", 3, MOST, table[0], &rows));
  while (q < rows && fabs(table[q][0] * heights - 1.0) > 1e-3)
    q++;
  BW_REQUIRE(q > 0 && q + 1 < rows, BW_EINPUT, "no reference for H = %g d", heights);
  const double *below = table[q - 1], *above = table[q + 1];
  *K = table[q][1];
  *slope = 1.0 + log(above[1] / below[1]) / log(above[0] / below[0]);
  return BW_OK;
}

/* What probes of the length q a lose of the drag in Stokes' flow about a sphere: parabolas for the
 * velocity, the trapezium for the pressure (bw_probe.h). Over U/a, mu U/a: along the wall u_t, g_t,
 * normal to it u_n, g_n and the curvature; each has the weight 2/3 or 1/3 of the drag at 3/2. */
static double probe_loss(double q)
{
  const double r = 1.0 + q, r2 = r * r, r3 = r * r2;
  const double u_t = 1.0 - 0.75 / r - 0.25 / r3, slope_t = 0.75 / r2 + 0.75 / (r * r3);
  const double u_n = 1.0 - 1.5 / r + 0.5 / r3, slope_n = 1.5 / r2 - 1.5 / (r * r3);
  const double g_t = 2.0 * u_t / q - slope_t, g_n = 2.0 * u_n / q - slope_n;
  const double curvature = 2.0 * (slope_n * q - u_n) / (q * q);
  const double p = 1.5 / r2 + 0.5 * q * (curvature + 3.0 / r3);
  return 1.0 - (2.0 * g_t + p + 2.0 * g_n) / 4.5;
}

/* All rows of one configuration; error: of the reaction. */
static bw_status one_case(bw_validation *v, const set_up *b, double *error)
{
  const bool claimed = isnan(b->retraction);
  double K = NAN, slope = NAN;
  drag d = {0};
  BW_TRY(reference(b->heights, &K, &slope));
  BW_TRY(steady_drag(bw_validation_comm(v), b, &d));
  *error = d.reaction / K - 1.0;
  const double radius = 0.5 * b->cells, doubt = 0.6 / (radius * radius);
  const double loss = probe_loss(bw_probe_config_default().length / radius);
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
    bw_claim_kind kind;
    const char *source;
  } rows[] = {{"K_reaction", d.reaction, K, claimed ? doubt : INFINITY, BW_INDEPENDENT_CODE,
               "fundamental solutions, data/sphere_in_channel"},
              {"K_control_volume", d.control_volume, d.reaction, 1.0e4 * BW_REAL_EPSILON,
               BW_CONSERVATION, "momentum balance of the box against the force of the markers"},
              {"K_probe", d.probe, K, claimed ? slope * 0.1 / radius + 0.01 + loss : INFINITY,
               BW_INDEPENDENT_CODE, "fundamental solutions, data/sphere_in_channel"},
              {"wall_off", *error / slope * radius, 0.0, INFINITY, BW_INDEPENDENT_CODE,
               "by how many h the sphere seems larger"},
              {"slip", d.slip, 0.0, INFINITY, BW_ANALYTIC, "no slip, in U"}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++) {
    char claim[120], extra[120];
    snprintf(claim, sizeof claim, "%s, H = %g d, %d cells%s%s%s", rows[q].quantity, b->heights,
             b->cells, claimed ? "" : ", not retracted", b->step < 0.5 ? ", half the step" : "",
             b->length > 2.0 ? ", longer box" : "");
    snprintf(extra, sizeof extra, "\"heights\": %g, \"cells_per_diameter\": %d, \"retracted\": %s",
             b->heights, b->cells, claimed ? "true" : "false");
    bw_validation_row(v, &(bw_claim){claim, rows[q].quantity, rows[q].measured, rows[q].reference,
                                     rows[q].tolerance, rows[q].kind, rows[q].source, extra});
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const int finest = bw_validation_full(v) ? 24 : 16;
  const set_up narrow = {8, 2.0, 2.0, NAN, 0.5};
  double error, bare[2], coarse = NAN;
  for (set_up b = narrow; b.cells <= finest; b.cells += b.cells < 16 ? 4 : 8) {
    BW_TRY(one_case(v, &b, &error));
    if (b.cells == 8) coarse = error;
    if (b.cells == 16)
      bw_validation_row(v, &(bw_claim){"on the true surface the error is of second order", "order",
                                       bw_validation_order(2.0, fabs(coarse), 1.0, fabs(error)),
                                       2.0, 0.15, BW_ORDER, "(h/a)^2, bw_ibm_mdf.h", NULL});
  }
  for (int q = 0; q < 2; q++)
    BW_TRY(one_case(v, &(set_up){8 + 8 * q, 2.0, 2.0, 0.0, 0.5}, bare + q));
  bw_validation_row(v, &(bw_claim){"not retracted the drag is too high, to first order", "order",
                                   bw_validation_order(2.0, bare[0], 1.0, bare[1]), 1.0, 0.3,
                                   BW_ORDER, "the wall is a fixed number of spacings off", NULL});
  if (!bw_validation_full(v)) return BW_OK;
  for (int cells = 8; cells <= 12; cells += 4)
    BW_TRY(one_case(v, &(set_up){cells, 4.0, 2.0, NAN, 0.5}, &error));
  BW_TRY(one_case(v, &(set_up){16, 2.0, 2.0, NAN, 0.25}, &error));
  return one_case(v, &(set_up){8, 2.0, 3.0, NAN, 0.5}, &error);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.sphere_channel", run);
}
