/* A cylinder that stands in a channel: markers hold the fluid on its surface, probes read the
 * stress there. The force of the markers is the momentum that a box of fluid around it loses, to
 * round-off; the probes' stress adds up to the same force, to what eight cells per diameter allow.
 * BUILD modules=ns_channel,probe,ibm_mdf
 * TEST  ranks=1,2 */
#include "bw_ibm_mdf.h"
#include "bw_ns_channel.h"
#include "bw_probe.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 8, POINTS = 25 }; /* per diameter; around the cylinder */
static const double h = 1.0 / CELLS,
                    pi = 3.141592653589793; /* diameter, bulk velocity, density 1 */

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_ibm_mdf *body;
  bw_probe *probe;
} scene;

/* n = POINTS on rank 0, none on others: who hands points over does not matter. */
static size_t circle(const bw_comm *world, double radius, double X[], double N[])
{
  for (size_t q = 0; q < POINTS; q++) {
    const double c = cos(2 * pi * (double)q / POINTS), s = sin(2 * pi * (double)q / POINTS);
    const double n[3] = {c, s, 0.0}, x[3] = {3 + radius * c, 2 + radius * s, 0.5 * h};
    memcpy(N + 3 * q, n, sizeof n), memcpy(X + 3 * q, x, sizeof x);
  }
  return bw_comm_rank(world) == 0 ? POINTS : 0;
}

static bw_status make_fluid(const bw_comm *world, scene *s)
{
  bw_grid_config box = bw_grid_config_default();
  box.n[0] = 8 * CELLS, box.n[1] = 4 * CELLS, box.n[2] = 1;
  box.length[0] = 8, box.length[1] = 4, box.length[2] = h;
  box.periodic[2] = true;
  box.halo = 2; /* markers and probes reach two cells */
  bw_ns_channel_config flow = bw_ns_channel_config_default();
  flow.nu = 1.0 / 20;
  flow.side[0][0] =
      (bw_ns_side){.kind = BW_SIDE_INFLOW, .profile = BW_PROFILE_POISEUILLE, .bulk_velocity = 1.0};
  flow.side[0][1].kind = BW_SIDE_OUTFLOW;
  flow.side[2][0].kind = flow.side[2][1].kind = BW_SIDE_PERIODIC;
  BW_TRY(bw_grid_create(world, &box, &s->grid));
  return bw_ns_channel_create(s->grid, &flow, &s->fluid);
}

static bw_status hold_body(const bw_comm *world, scene *s)
{
  static const double rest[3 * POINTS];
  static const int around[POINTS]; /* all on surface 0, which encloses a body */
  double X[3 * POINTS], N[3 * POINTS], dV[POINTS];
  bw_ibm_mdf_config forcing = bw_ibm_mdf_config_default(); /* Roma's kernel, with memory */
  const double radius = 0.5 - bw_ibm_mdf_retraction(&forcing) * h;
  const size_t n = circle(world, radius, X, N);
  for (size_t q = 0; q < POINTS; q++)
    dV[q] = 2 * pi * radius / POINTS * h * h; /* arc times depth, times the grid spacing */
  BW_TRY(bw_ibm_mdf_create(s->grid, &forcing, &s->body));
  BW_TRY(bw_ibm_mdf_set_markers(s->body, n, X, rest, dV, NULL));
  return bw_ibm_mdf_close(s->body, 1, around, N); /* the memory holds no pressure inside */
}

static bw_status step(scene *s, double dt)
{
  bw_ibm_mdf_begin_step(s->body);
  for (int r = 0; r < 3; r++) {
    bw_ns_channel_predict(s->fluid, r, dt);
    bw_ibm_mdf_force(s->body, bw_ns_channel_velocity(s->fluid), dt); /* the full dt in each */
    bw_ns_channel_project(s->fluid, r, dt);
  }
  return bw_ns_channel_check(s->fluid, dt);
}

/* Drag by the probes: the sum of traction times area. */
static bw_status read_stress(const bw_comm *world, scene *s, double *drag)
{
  double X[3 * POINTS], N[3 * POINTS], traction[3 * POINTS];
  bw_probe_config probes = bw_probe_config_default();
  probes.rho = 1.0, probes.nu = 1.0 / 20, probes.profile = BW_PROBE_QUADRATIC;
  const size_t n = circle(world, 0.5, X, N); /* the surface itself, normals into the fluid */
  BW_TRY(bw_probe_create(s->grid, &probes, &s->probe));
  BW_TRY(bw_probe_set_points(s->probe, n, X, N));
  bw_probe_traction(s->probe, bw_ns_channel_velocity(s->fluid), bw_ns_channel_pressure(s->fluid),
                    NULL, traction, NULL);
  *drag = 0.0;
  for (size_t q = 0; q < n; q++)
    *drag += traction[3 * q] * pi / POINTS * h;
  bw_comm_sum(world, 1, drag);
  return BW_OK;
}

static bw_status simulate(const bw_comm *world, scene *s)
{
  double box[3], probes = 0.0;
  BW_TRY(make_fluid(world, s));
  BW_TRY(hold_body(world, s));
  BW_TRY(bw_ns_channel_watch_box(s->fluid, (int[3]){16, 8, 0}, (int[3]){32, 24, 1}));
  const double dt = 0.02;
  while (bw_ns_channel_time(s->fluid) < 10.0)
    BW_TRY(step(s, dt));
  const bw_ibm_mdf_report r = bw_ibm_mdf_measure(s->body, bw_ns_channel_velocity(s->fluid));
  bw_ns_channel_control_volume(s->fluid, box);
  BW_TRY(read_stress(world, s, &probes));
  const double markers = -r.total_force[0] * 2 / h; /* Cd = 2 D/(rho U_b^2 d depth) */
  if (bw_comm_rank(world) == 0)
    printf("Cd: markers %.4f, box %.4f, probes %.4f; slip %.1e U_b\n", markers, -box[0] * 2 / h,
           probes * 2 / h, r.slip_after);
  BW_REQUIRE(fabs(r.total_force[0] - box[0]) < 1e-6 * fabs(box[0]), BW_EDIVERGED,
             "force of the markers %g is not the box's, %g", r.total_force[0], box[0]);
  BW_REQUIRE(fabs(probes * 2 / h / markers - 1) < 0.2, BW_EDIVERGED, "probes see %g of %g",
             probes * 2 / h, markers);
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world = NULL;
  scene s = {NULL, NULL, NULL, NULL};
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  const bw_status status = simulate(world, &s);
  bw_probe_destroy(&s.probe);
  bw_ibm_mdf_destroy(&s.body);
  bw_ns_channel_destroy(&s.fluid);
  bw_grid_destroy(&s.grid);
  return bw_finish(&world, status);
}
