/* Claim: a plate whose skin alone is fine bends in a stream as one that is fine everywhere.
 *
 * Set-up     the elastic plate on the wall of a channel of bending_plate_fem (Re 40, E* 73000), 10
 *            cells high, three times: 16 particles across; 8 across; 8 across with two columns on
 *            either face split in two each way, so that the surface is that of the first one.
 *            --full: 40 cells and twice as many particles.
 * Measured   tip of the plate and force on it when it rests, over those of the plate that is fine
 *            everywhere, loaded by probes, with --full by the reaction as well; the same of the
 *            coarse one, for comparison.
 * Tolerance  2 %: what is asked of levels in a flow. Beside a jump single families have moduli off
 *            by a fifth (README of pd_bond), in a plate with jumps along it up to 0.2 x 2 d1/width,
 *            d1 the coarse horizon: 10 % with 8 particles across, 5 % with 16. The rows cantilever
 *            (--full: of both) tell what is left of it without the flow.
 * BUILD modules=coupler,shape
 * TEST  ranks=1 timeout=1800 */
#include "bw_validation.h"
#include "cantilever.h"

#include <stdio.h>

static const double RE = 40.0, E_STAR = 73000.0, TOL = 0.02;

typedef struct {
  const char *name;
  int across, skin; /* particles; columns of them that are split on either side */
} plate;
enum { FINE, SKIN, COARSE, PLATES };
static const plate plates[PLATES] = {{"fine", 16, 0}, {"skin", 8, 2}, {"coarse", 8, 0}};

/* `more` times as many particles across. */
static bending_config set_up(const plate *p, int more, int cells, bw_coupler_load_kind load)
{
  bending_config c = bending_config_default();
  c.channel = (bending_channel){5.0, 1.5, {5 * cells, cells * 3 / 2}};
  c.fluid = (bending_fluid){.density = 1.0, .viscosity = 1.0 / RE, .bulk_velocity = 1.0};
  c.plate.front = 1.5;
  c.plate.thickness = 0.1;
  c.plate.height = 1.0;
  c.plate.particles_across = more * p->across;
  c.plate.skin = p->skin;
  c.plate.horizon_ratio = 2.0;
  c.plate.surface_correction = BW_PD_SURFACE_TENSOR;
  c.plate.young_modulus = E_STAR;
  c.plate.density = 40.0;
  c.plate.damping_absolute = 12.0 * c.plate.density; /* about critical for the first mode, 9 */
  c.coupling.load = load;
  c.coupling.load_relaxation = 0.03;
  return c;
}

static bw_status run_to_rest(const bw_comm *comm, const bending_config *c, bending_measure *m)
{
  const double dt = 0.24 * (c->channel.height / c->channel.cells[1]) / 3.0; /* u < 3 */
  bending_flow f;
  bw_status st = bending_create(comm, c, &f);
  for (double t = 0.0; st == BW_OK && t < 3.0; t += dt) {
    bw_coupler_hold_solid(f.coupler, t < 0.2);
    st = bw_coupler_step(f.coupler, dt);
  }
  BW_THEN(st, bending_look(&f, m));
  if (st == BW_OK && m->kinetic > 1e-4 * m->elastic)
    st = BW_FAIL(BW_EDIVERGED, "the plate does not rest: kinetic %g, elastic %g", m->kinetic,
                 m->elastic);
  bending_destroy(&f);
  return st;
}

static void row(bw_validation *v, const char *quantity, const char *how, const plate *p,
                double measured, double reference)
{
  char text[128];
  snprintf(text, sizeof text, "%s, %s, over the fine plate's%s", quantity, p->name, how);
  bw_validation_row(v, &(bw_claim){text, quantity, measured / reference, 1.0,
                                   p == &plates[SKIN] ? TOL : INFINITY, BW_ORDER,
                                   "the plate that is fine everywhere", NULL});
}

/* The plates without a flow, under one load. */
static bw_status bend_alone(bw_validation *v, int more)
{
  cantilever_result alone[PLATES] = {{0}};
  char how[64];
  snprintf(how, sizeof how, ", %d coarse particles across", more * plates[COARSE].across);
  for (int q = 0; q < PLATES; q++) {
    const bending_config c = set_up(&plates[q], more, 40, BW_LOAD_PROBES);
    BW_TRY(cantilever_bend(bw_validation_comm(v), &c.plate, 0.01, &alone[q]));
    if (q != FINE) row(v, "cantilever", how, &plates[q], alone[q].tip, alone[FINE].tip);
  }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const char *const how[] = {
      [BW_LOAD_REACTION] = ", load by reaction", [BW_LOAD_PROBES] = ", load by probes"};
  const bool full = bw_validation_full(v);
  const int cells = full ? 40 : 10, more = full ? 2 : 1;
  for (int k = 1; k <= more && full; k++)
    BW_TRY(bend_alone(v, k));
  for (int load = 0; load < (full ? 2 : 1); load++) {
    bending_measure m[PLATES];
    for (int q = 0; q < PLATES; q++) {
      const bending_config c = set_up(&plates[q], more, cells, (bw_coupler_load_kind)load);
      BW_TRY(run_to_rest(bw_validation_comm(v), &c, &m[q]));
      if (q == FINE) continue;
      row(v, "tip_x", how[load], &plates[q], m[q].tip[0], m[FINE].tip[0]);
      row(v, "force_x", how[load], &plates[q], m[q].box[0], m[FINE].box[0]);
    }
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.refined_skin", run);
}
