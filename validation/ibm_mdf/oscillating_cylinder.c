/* Claim: a cylinder swinging in still fluid feels the drag and the added mass that Duetsch et al.
 * found (KC = U T/d = 5, Re = U d/nu = 100).
 *
 *   F = -rho d c_d V |V|/2 - rho (pi d^2/4) c_a dV/dt        (Morison), V = -U cos(2 pi t/T)
 * Reference  c_d = 2.09, c_a = 1.45: H. Duetsch, F. Durst, S. Becker and H. Lienhart, J. Fluid
 *            Mech. 360 (1998) 249, from their computation.
 * Measured   the force on the cylinder from outside: -rho sum Q dV, which also moves the fluid
 *            inside (ERRATA 18), plus rho (pi d^2/4) dV/dt for that; and the probes' force. Both
 *            coefficients by least squares over the last of three periods (the sixth differs by
 *            1 %). Box with walls at rest; steps of 0.09 h/U: with twice as long ones c_a is 0.5 %
 *            higher (the memory of the forcing follows the motion some steps late).
 * Tolerance  the force that markers give is that on a body of (c_a + 1) times the displaced mass,
 *            from which one displaced mass is taken: 0.1 h of doubt about the wall is 0.4 h/d of
 *            the area and 0.4 (h/d) (1 + 1/c_a) of c_a (4.5 % at 15 cells, where the layer
 *            sqrt(2 nu/w) of 0.126 d has two cells), and 0.2 h/d of c_d. Walls 8 d away add
 *            2/16^2 = 0.8 % to c_a (concentric potential flow), 1.5 % for the step, three digits
 *            and not knowing how they fitted. Probes: what they miss on a steady cylinder (README
 *            of probe), 7 % of the friction at 15 cells, and what the markers have.
 * BUILD modules=ns_channel,probe
 * TEST  ranks=1,2 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_probe.h"
#include "bw_validation.h"

#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846, KC = 5.0, RE = 100.0;
enum { SIDE = 16, PERIODS = 3 }; /* of the box, in d */

enum { MARKERS, PROBES, ROUTES };

typedef struct {
  body_flow flow;
  body_surface markers, wall;
  bw_probe *probe;
  double *traction, *accel;
  double h, radius; /* radius: of the markers */
} swing;

static void destroy(swing *s)
{
  bw_release(&s->traction);
  bw_release(&s->accel);
  bw_probe_destroy(&s->probe);
  body_surface_free(&s->markers);
  body_surface_free(&s->wall);
  body_flow_destroy(&s->flow);
}

/* The step shrinks with the cells: 0.09 h/U. */
static int steps_per_period(int cells)
{
  return 800 * cells / 15;
}

static bw_status make(const bw_comm *comm, int cells, swing *s)
{
  const bw_ibm_mdf_config body = bw_ibm_mdf_config_default();
  const body_box box = {
      .n = {SIDE * cells, SIDE * cells, 1}, .h = 1.0 / cells, .nu = 1.0 / RE, .body = body};
  bw_probe_config probe = bw_probe_config_default();
  probe.rho = 1.0, probe.nu = box.nu, probe.profile = BW_PROBE_QUADRATIC;
  s->h = box.h;
  s->radius = 0.5; /* markers on the true surface */
  BW_TRY(body_flow_box(comm, &box, &s->flow));
  s->flow.dt = KC / steps_per_period(cells);
  BW_TRY(body_surface_alloc(comm, body_circle_size(s->radius, s->h), &s->markers));
  BW_TRY(body_surface_alloc(comm, body_circle_size(0.5, s->h), &s->wall));
  BW_TRY(BW_ALLOCATE(&s->traction, 3 * s->wall.n));
  BW_TRY(BW_ALLOCATE(&s->accel, 3 * s->wall.n));
  return bw_probe_create(s->flow.grid, &probe, &s->probe);
}

static void move(body_surface *s, size_t n, const double centre[2], double R, double h, double V)
{
  body_circle(s, 0, n, centre, R, h);
  for (size_t q = 0; q < s->n; q++)
    s->V[3 * q] = V;
}

static double probe_force(swing *s, double A)
{
  double F = 0.0;
  for (size_t q = 0; q < s->wall.n; q++)
    s->accel[3 * q] = A;
  bw_probe_set_velocity(s->probe, s->wall.V, NULL);
  bw_probe_traction(s->probe, bw_ns_channel_velocity(s->flow.fluid), s->flow.pressure, s->accel,
                    s->traction, NULL);
  for (size_t q = 0; q < s->wall.n; q++)
    F += PI / (double)s->wall.n * s->traction[3 * q];
  bw_comm_sum(bw_grid_comm(s->flow.grid), 1, &F);
  return F;
}

/* One step, the cylinder where it is at its end. motion: V and dV/dt in the middle of the step,
 * where the mean force of the step belongs. */
static bw_status step(swing *s, double F[ROUTES], double motion[2])
{
  const double w = 2.0 * PI / KC, t = bw_ns_channel_time(s->flow.fluid), end = t + s->flow.dt;
  const double middle = 0.5 * (t + end), V = -cos(w * end), half = 0.5 * SIDE;
  const double centre[2] = {half - sin(w * end) / w, half + 0.3 * s->h};
  move(&s->markers, body_circle_size(s->radius, s->h), centre, s->radius, s->h, V);
  move(&s->wall, body_circle_size(0.5, s->h), centre, 0.5, s->h, V);
  BW_TRY(body_move_markers(&s->flow, &s->markers));
  BW_TRY(body_flow_step(&s->flow));
  BW_TRY(bw_probe_set_points(s->probe, s->wall.n, s->wall.X, s->wall.N));
  motion[0] = -cos(w * middle), motion[1] = w * sin(w * middle);
  const bw_ibm_mdf_report r =
      bw_ibm_mdf_measure(s->flow.body, bw_ns_channel_velocity(s->flow.fluid));
  F[MARKERS] = -r.total_force[0] / s->h + 0.25 * PI * motion[1];
  F[PROBES] = probe_force(s, w * sin(w * end));
  return BW_OK;
}

/* Normal equations of F = -c_d V|V|/2 - c_a (pi/4) dV/dt. */
typedef struct {
  double aa, ab, bb, aF, bF, most;
} morison;

static void add(morison *m, const double motion[2], double F)
{
  const double a = -0.5 * motion[0] * fabs(motion[0]), b = -0.25 * PI * motion[1];
  m->aa += a * a, m->ab += a * b, m->bb += b * b, m->aF += a * F, m->bF += b * F;
  m->most = fmax(m->most, fabs(F));
}

static void rows(bw_validation *v, int cells, int route, const morison *m)
{
  static const char *const name[ROUTES] = {"markers", "probes"};
  const double det = m->aa * m->bb - m->ab * m->ab;
  const double other = 0.023 + (route == MARKERS ? 0.0 : 0.07), h = 1.0 / cells;
  const struct {
    const char *quantity;
    double measured, reference, tolerance;
  } row[] = {
      {"c_d", (m->aF * m->bb - m->bF * m->ab) / det, 2.09, 0.2 * h + other},
      {"c_a", (m->bF * m->aa - m->aF * m->ab) / det, 1.45, 0.4 * h * (1.0 + 1.0 / 1.45) + other},
      {"largest_force", 2.0 * m->most, 0.0, INFINITY}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
    char claim[64], extra[64];
    snprintf(claim, sizeof claim, "%s by %s, %d cells", row[q].quantity, name[route], cells);
    snprintf(extra, sizeof extra, "\"route\": \"%s\", \"cells_per_diameter\": %d", name[route],
             cells);
    bw_validation_row(v, &(bw_claim){claim, row[q].quantity, row[q].measured, row[q].reference,
                                     row[q].tolerance, BW_PUBLISHED, "Duetsch et al. 1998", extra});
  }
}

static bw_status one_grid(bw_validation *v, int cells)
{
  const int steps = steps_per_period(cells);
  swing s = {0};
  morison fit[ROUTES];
  memset(fit, 0, sizeof fit);
  bw_status st = make(bw_validation_comm(v), cells, &s);
  for (int q = 0; st == BW_OK && q < PERIODS * steps; q++) {
    double F[ROUTES], motion[2];
    st = step(&s, F, motion);
    for (int r = 0; r < ROUTES && st == BW_OK && q >= (PERIODS - 1) * steps; r++)
      add(&fit[r], motion, F[r]);
  }
  for (int r = 0; r < ROUTES && st == BW_OK; r++)
    rows(v, cells, r, &fit[r]);
  destroy(&s);
  return st;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(one_grid(v, 15));
  return bw_validation_full(v) ? one_grid(v, 30) : BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.oscillating_cylinder", run);
}
