/* Claim: between two turning circles of markers there is circular Couette flow: torque, velocity.
 *
 *   u_theta = A r + B/r,  A = (W2 R2^2 - W1 R1^2)/D,  B = (W1 - W2) R1^2 R2^2/D,  D = R2^2 - R1^2,
 * and the torque on the inner circle per depth and density is 4 pi nu B (closed form).
 * Measured   R1 = 1/2, R2 = 1, centre off the nodes, markers pulled out of the fluid by
 *            bw_ibm_mdf_retraction; steady. Torque: sum of X x Q dV over the inner markers, and
 *            of x x t over probes on the nominal surface (which turns: V and spin). Velocity:
 *            every u and v 1.5 h inside the gap, rms, over the larger wall speed.
 * Tolerance  torque: 0.1 h of doubt about either radius (validation/ibm_mdf/cylinder_drag):
 *            d ln B/d R1 = 2/R1 + 2 R1/D = 5.3 and d ln B/d R2 = 2/R2 - 2 R2/D = -0.7 give 0.6 h.
 *            An outer circle that turns drives the fluid outside as well; a sheet of force cannot
 *            tell its sides apart, and the shear outside, some 3 times the one inside, shifts the
 *            wall by as much as its own: 1 h more. Probes: beside that what 0.1 h does over their
 *            lever, 2 x 0.1/2, as in cylinder_drag. Velocity: 0.1 h of doubt times the wall's
 *            shear (du/dr <= 2.7 of the wall speed), 0.3 h.
 * BUILD modules=ns_channel,probe
 * TEST  ranks=1,2 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_probe.h"
#include "bw_validation.h"

#include <stdio.h>

static const double R1 = 0.5, R2 = 1.0, SIDE = 2.5, NU = 0.05, SETTLED = 1.5;
static const double CENTRE[2] = {1.2537, 1.2471};

typedef struct {
  double W[2];         /* rates of rotation, inner and outer */
  double retraction;   /* of the markers; NaN: none, they stand on the true surface */
  double outside;      /* what shear outside adds to the tolerance [1/h] */
  const char *turning; /* which circle does */
} motion;

typedef struct {
  body_flow flow;
  body_surface markers; /* inner, then outer */
  size_t inner;
  double h;
} couette;

/* Start: the solution in the gap, rigid rotation within, rest outside. */
static void exact(const double x[3], double t, void *context, double u[3])
{
  const motion *m = context;
  const double dx = x[0] - CENTRE[0], dy = x[1] - CENTRE[1], r2 = dx * dx + dy * dy;
  const double ring = R2 * R2 - R1 * R1;
  const double A = (m->W[1] * R2 * R2 - m->W[0] * R1 * R1) / ring;
  const double B = (m->W[0] - m->W[1]) * R1 * R1 * R2 * R2 / ring;
  const double rate = r2 < R1 * R1 ? m->W[0] : r2 > R2 * R2 ? 0.0 : A + B / r2;
  (void)t;
  u[0] = -rate * dy, u[1] = rate * dx, u[2] = 0.0;
}

static bw_status make_fluid(const bw_comm *comm, int cells, motion *m, couette *c)
{
  const int n = (int)lround(SIDE * cells);
  const body_box box = {.n = {n, n, 1},
                        .h = 1.0 / cells,
                        .nu = NU,
                        .periodic = {true, true, true},
                        .body = bw_ibm_mdf_config_default()};
  c->h = box.h;
  BW_TRY(body_flow_box(comm, &box, &c->flow));
  c->flow.dt = 0.5 * bw_ns_channel_dt_max(c->flow.fluid);
  return bw_ns_channel_set_velocity(c->flow.fluid, exact, m, 0.0);
}

static void turn(body_surface *s, size_t from, size_t to, double W)
{
  for (size_t q = from; q < to && q < s->n; q++) {
    s->V[3 * q] = -W * (s->X[3 * q + 1] - CENTRE[1]);
    s->V[3 * q + 1] = W * (s->X[3 * q] - CENTRE[0]);
  }
}

static bw_status make_walls(const bw_comm *comm, const motion *m, couette *c)
{
  const double back = isnan(m->retraction) ? 0.0 : c->h * m->retraction;
  if (!isnan(m->retraction)) c->flow.nu = 0.0;
  const size_t inner = body_circle_size(R1 - back, c->h), outer = body_circle_size(R2 + back, c->h);
  c->inner = inner;
  BW_TRY(body_surface_alloc(comm, inner + outer, &c->markers));
  body_circle(&c->markers, 0, inner, CENTRE, R1 - back, c->h);
  body_circle(&c->markers, inner, outer, CENTRE, R2 + back, c->h);
  c->markers.n_closed = 2;
  for (size_t q = inner; q < c->markers.n; q++)
    c->markers.closed[q] = 1;
  turn(&c->markers, 0, inner, m->W[0]);
  turn(&c->markers, inner, inner + outer, m->W[1]);
  return body_set_markers(&c->flow, &c->markers);
}

/* Of force f (n,3) at the first n points, about the centre. */
static double torque(const body_surface *s, size_t n, const double f[])
{
  double sum = 0.0;
  for (size_t q = 0; q < n && q < s->n; q++)
    sum += (s->X[3 * q] - CENTRE[0]) * f[3 * q + 1] - (s->X[3 * q + 1] - CENTRE[1]) * f[3 * q];
  return sum;
}

static bw_status marker_torque(const bw_comm *comm, couette *c, double *T)
{
  double *QdV = NULL;
  const bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&QdV, 3 * c->markers.n));
  if (st == BW_OK) {
    bw_ibm_mdf_marker_force(c->flow.body, QdV);
    *T = torque(&c->markers, c->inner, QdV) / c->h; /* on the fluid, per depth */
    bw_comm_sum(comm, 1, T);
  }
  bw_release(&QdV);
  return st;
}

static bw_status probe_torque(const bw_comm *comm, const motion *m, couette *c, double *T)
{
  const size_t n = body_circle_size(R1, c->h);
  body_surface wall = {0};
  bw_probe *probe = NULL;
  bw_probe_config config = bw_probe_config_default();
  double *spin = NULL, *traction = NULL;
  config.rho = 1.0, config.nu = NU, config.profile = BW_PROBE_QUADRATIC;
  bw_status st = body_surface_alloc(comm, n, &wall);
  BW_THEN(st, BW_ALLOCATE(&spin, 3 * wall.n));
  BW_THEN(st, BW_ALLOCATE(&traction, 3 * wall.n));
  st = bw_comm_agree(comm, st);
  BW_THEN(st, bw_probe_create(c->flow.grid, &config, &probe));
  if (st == BW_OK) {
    body_circle(&wall, 0, n, CENTRE, R1, c->h);
    turn(&wall, 0, n, m->W[0]);
    for (size_t q = 0; q < wall.n; q++)
      spin[3 * q + 2] = m->W[0];
    st = bw_probe_set_points(probe, wall.n, wall.X, wall.N);
  }
  if (st == BW_OK) {
    bw_probe_set_velocity(probe, wall.V, spin);
    bw_probe_traction(probe, bw_ns_channel_velocity(c->flow.fluid), c->flow.pressure, NULL,
                      traction, NULL);
    *T = -torque(&wall, wall.n, traction) * 2.0 * acos(-1.0) * R1 / (double)n;
    bw_comm_sum(comm, 1, T);
  }
  bw_probe_destroy(&probe);
  bw_release(&spin);
  bw_release(&traction);
  body_surface_free(&wall);
  return st;
}

/* rms over the velocity points of the gap. */
static double velocity_error(couette *c, motion *m)
{
  const bw_grid_view *g = bw_grid_look(c->flow.grid);
  bw_real *const *u = bw_ns_channel_velocity(c->flow.fluid);
  double sum[2] = {0.0, 0.0};
  for (int d = 0; d < 2; d++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        const double x[3] = {(i - (d == 0 ? 0.0 : 0.5)) * c->h,
                             (j + g->lo[1] - (d == 1 ? 0.0 : 0.5)) * c->h, 0.0};
        const double r = hypot(x[0] - CENTRE[0], x[1] - CENTRE[1]);
        double want[3];
        if (r < R1 + 1.5 * c->h || r > R2 - 1.5 * c->h) continue;
        exact(x, 0.0, m, want);
        const double e = (double)u[d][bw_at(g, i, j, 1)] - want[d];
        sum[0] += e * e, sum[1] += 1.0;
      }
  bw_comm_sum(bw_grid_comm(c->flow.grid), 2, sum);
  return sqrt(sum[0] / sum[1]) / fmax(fabs(m->W[0]) * R1, fabs(m->W[1]) * R2);
}

typedef struct {
  double torque, probe, velocity;
} outcome;

static bw_status settle(const bw_comm *comm, int cells, motion *m, outcome *o)
{
  couette c = {0};
  bw_status st = make_fluid(comm, cells, m, &c);
  BW_THEN(st, make_walls(comm, m, &c));
  while (st == BW_OK && bw_ns_channel_time(c.flow.fluid) < SETTLED)
    st = body_flow_step(&c.flow);
  BW_THEN(st, marker_torque(comm, &c, &o->torque));
  BW_THEN(st, probe_torque(comm, m, &c, &o->probe));
  if (st == BW_OK) o->velocity = velocity_error(&c, m);
  body_surface_free(&c.markers);
  body_flow_destroy(&c.flow);
  return st;
}

static bw_status one_case(bw_validation *v, int cells, motion *m, outcome *o)
{
  const double B = (m->W[0] - m->W[1]) * R1 * R1 * R2 * R2 / (R2 * R2 - R1 * R1);
  const double T = 4.0 * acos(-1.0) * NU * B, h = 1.0 / cells;
  const bool claimed = isnan(m->retraction);
  BW_TRY(settle(bw_validation_comm(v), cells, m, o));
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } row[] = {{"torque", o->torque, T, (0.6 + m->outside) * h},
             {"torque_probe", o->probe, T, (0.6 + m->outside) * h + 0.1},
             {"velocity_error", o->velocity, 0.0, (0.3 + m->outside) * h}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
    char claim[96], extra[96];
    snprintf(claim, sizeof claim, "%s, %s turns, %d cells over 2 R1%s", row[q].quantity, m->turning,
             cells, claimed ? "" : ", not retracted");
    snprintf(extra, sizeof extra, "\"turning\": \"%s\", \"cells_per_diameter\": %d", m->turning,
             cells);
    bw_validation_row(v, &(bw_claim){claim, row[q].quantity, row[q].measured, row[q].reference,
                                     claimed ? row[q].tolerance : INFINITY, BW_ANALYTIC,
                                     "circular Couette flow", extra});
  }
  o->torque = fabs(o->torque / T - 1.0);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const int coarse = 16, fine = bw_validation_full(v) ? 64 : 32;
  motion inner = {{1.0, 0.0}, NAN, 0.0, "inner"}, outer = {{0.0, 1.0}, NAN, 1.0, "outer"};
  motion both = {{1.0, -0.5}, NAN, 1.0, "both"}, unmoved = {{1.0, 0.0}, 0.0, 0.0, "inner"};
  motion *const all[] = {&inner, &outer, &both, &unmoved};
  outcome o[2];
  for (int q = 0; q < 4; q++)
    for (int cells = coarse; cells <= fine; cells *= 2) {
      o[0] = o[1];
      BW_TRY(one_case(v, cells, all[q], &o[1]));
      if (cells == fine && all[q] == &unmoved) {
        const double order = bw_validation_order(2.0, o[0].torque, 1.0, o[1].torque);
        bw_validation_row(v, &(bw_claim){"without retraction the torque is first order", "order",
                                         order, 1.0, 0.3, BW_ORDER,
                                         "a wall displaced by a fixed part of h", NULL});
      }
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.couette", run);
}
