/* Claim: a rigid cylinder goes with the fluid, and falls or rises in it, as Stokes flow has it,
 * however light it is.
 *
 * A free cylinder of a quarter of the channel's height on its centre line, Re = 0.1:
 *   fall       under its weight along a channel with closed ends: its speed, at twice, a tenth and
 *              a hundredth of the fluid's density (light ones rise);
 *   couette    as heavy as the fluid, between walls that move apart: its spin;
 *   poiseuille as heavy as the fluid, carried by the stream: its speed.
 * Reference  fundamental solutions, data/cylinder_in_channel; for the fall the same as Faxen's
 *            series to 3e-5. Unconfined the spin would be 1/2, the speed 1.5.
 * Measured   rigid, markers on the true surface, load by their reaction, default values; velocity
 *            and spin when they have settled (four times the slowest decay, (2 pi/H)^2 nu, of what
 *            a symmetric motion leaves), and by how much a step changes them then: what would swing
 *            from step to step has died.
 * Tolerance  fall: 2 %, a goal set before (for 16 cells).
 *            couette, poiseuille: what the body lags behind a point of the fluid, 3.6 and 3 %, goes
 *            with d^2; a wall off by (h/R)^2 of the radius is 2 (h/R)^2 of the lag: 0.5 % with 8
 *            cells. Change per step: the decay itself is exp(-4 pi^2 nu dt/H^2) a step, and after
 *            four times its length 2 % are left: 1e-4 of the speed.
 * BUILD modules=coupler,rigid,ns_channel
 * TEST  ranks=1,2 timeout=3600 */
#include "bw_coupler_rigid.h"
#include "bw_validation.h"
#include "cylinder_in_channel.h"

#include <math.h>
#include <stdio.h>

typedef struct {
  motion motion;
  int cells;      /* per diameter */
  double density; /* of the body, over the fluid's */
  double speed;   /* of fall for the unit force, of reference */
} set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_rigid *rigid;
  bw_coupler_rigid *coupler;
  double h, dt;
} scene;

static void destroy(scene *s)
{
  bw_coupler_rigid_destroy(&s->coupler);
  bw_rigid_destroy(&s->rigid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

static bw_status make(const bw_comm *comm, const set_up *b, scene *s)
{
  bw_rigid_config rigid = bw_rigid_config_default();
  bw_coupler_rigid_config c = bw_coupler_rigid_config_default();
  *s = (scene){.dt = NAN};
  s->h = 1.0 / b->cells;
  s->dt = 0.08 * s->h * s->h;
  BW_TRY(cylinder_fluid(comm, b->motion, b->cells, &s->grid, &s->fluid));
  const bw_grid_view *g = bw_grid_look(s->grid);
  const bw_shape cylinder = {.kind = BW_SHAPE_CYLINDER,
                             .centre = {0.5 * g->length[0], 0.5 * g->length[1], 0.0},
                             .radius = 0.5,
                             .axis = 2};
  const bw_rigid_body body = {.count = 1, .shape = &cylinder, .density = b->density};
  rigid.planar = true;
  rigid.depth = g->length[2];
  rigid.spacing = s->h;
  BW_TRY(bw_rigid_create(comm, &rigid, 1, &body, &s->rigid));
  c.rho = c.nu = 1.0;
  if (b->motion == FALL) /* (density - 1) g area = force; speed per force and depth given */
    c.gravity[0] = RE / (b->speed * (b->density - 1.0) * 0.25 * acos(-1.0));
  return bw_coupler_rigid_create(&c, s->fluid, s->rigid, &s->coupler);
}

/* Speed over that of reference's unit force or stream, or spin over the shear rate; its change in
 * the last step, over it. */
static bw_status measure(const bw_comm *comm, const set_up *b, double *out, double *change)
{
  scene s;
  bw_status st = make(comm, b, &s);
  const double end = 4.0 * HEIGHTS * HEIGHTS / (4.0 * acos(-1.0) * acos(-1.0));
  double before = 0.0;
  *out = 0.0;
  for (double t = 0.0; st == BW_OK && t < end; t += s.dt) {
    st = bw_coupler_rigid_step(s.coupler, s.dt);
    if (st != BW_OK) break;
    const bw_rigid_state body = bw_rigid_state_of(s.rigid, 0);
    before = *out;
    *out = b->motion == COUETTE ? -body.spin[2] / RE : body.velocity[0] / RE;
  }
  *change = fabs(*out - before) / fabs(*out);
  if (b->motion == FALL) *out *= b->speed;
  destroy(&s);
  return st;
}

static bw_status one_case(bw_validation *v, const set_up *b, double reference)
{
  double value = NAN, change = NAN;
  char text[96], extra[96];
  const double lag = 0.036 * 2.0 * 4.0 / (b->cells * b->cells);
  BW_TRY(measure(bw_validation_comm(v), b, &value, &change));
  snprintf(extra, sizeof extra, "\"cells_per_diameter\": %d, \"density_ratio\": %g", b->cells,
           b->density);
  snprintf(text, sizeof text, "%s, density ratio %g, %d cells per diameter", name[b->motion],
           b->density, b->cells);
  bw_validation_row(v, &(bw_claim){text, name[b->motion], value, reference,
                                   b->motion == FALL ? 0.02 : lag, BW_INDEPENDENT_CODE,
                                   "fundamental solutions, data/cylinder_in_channel", extra});
  snprintf(text, sizeof text, "%s, density ratio %g, %d cells: a step changes nothing",
           name[b->motion], b->density, b->cells);
  bw_validation_row(v, &(bw_claim){text, "change_per_step", change, 0.0, 1e-4, BW_ANALYTIC,
                                   "Stokes flow is steady", extra});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  double table[16][3], reference[MOTIONS] = {NAN, NAN, NAN};
  int rows = 0;
  BW_TRY(bw_validation_table("cylinder_in_channel/free_cylinder.csv", 3, 16, table[0], &rows));
  for (int q = 0; q < rows; q++)
    if (table[q][0] == 1.0 / HEIGHTS) reference[(int)table[q][1]] = table[q][2];
  static const double density[] = {2.0, 0.1, 0.01};
  for (int cells = 8; cells <= (bw_validation_full(v) ? 16 : 8); cells *= 2) {
    for (int q = 0; q < 3; q++)
      BW_TRY(one_case(v, &(set_up){FALL, cells, density[q], reference[FALL]}, reference[FALL]));
    for (int m = COUETTE; m < MOTIONS; m++)
      BW_TRY(one_case(v, &(set_up){(motion)m, cells, 1.0, reference[FALL]}, reference[m]));
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.rigid_fall", run);
}
