/* Material constants from the lattice's own sums instead of the integrals.
 *
 * Stiffness: 1/4 c0 sum |xi| Gamma dV, the energy density of a full family dilated by e, over e^2,
 * is that of elasticity. Fracture: every direction xi holds xi.n Gamma dV/2 of its bonds' energy
 * c0 s^2 |xi| per area of a plane normal to the lattice direction n, so
 *   G0 = 1/2 c0 s0^2 sum_{xi.n > 0} |xi| xi.n Gamma dV.
 * alpha = 1 but with the correction by tensor, whose factors refer to that c0 always.
 * V0 of the volume method is the full family's own volume: alpha = 1 in the bulk.
 * In a cloud every family differs: the sums are means over many, and of all directions n. */
#include "pd_bond.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* Fracture energy of bonds between two groups. */
double bw_pd_bond__joint_G0(const bw_pd_body_config *c, int g, int h)
{
  const double own = c->joint_G0[g][h];
  return g == h || isnan(own) ? fmin(c->material[g].G0, c->material[h].G0) : own;
}

double bw_pd_bond__joint_E(const bw_pd_body_config *c, int g, int h)
{
  const double a = c->material[g].E, b = c->material[h].E;
  return g == h ? a : 2 * a * b / (a + b);
}

/* With the fixed Poisson ratios 3 E, E/(1 - nu) = 3E/2 and 2 (lambda + mu) = 8E/5. */
double bw_pd_bond__classical_dilation(const bw_pd_body_config *c, double E)
{
  const double factor[] = {3, 1.5, 1.6};
  return factor[c->geometry] * E;
}

static void lattice_sums(bw_pd_body *pd)
{
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  const bw_pd_stencil *s = &pd->level[0].stencil;
  memset(&state->full, 0, sizeof state->full);
  for (int q = 0; q < s->same; q++) {
    /* Volume for V_0 (3.44), first moment for the stiffness. */
    const double w = s->fraction[q] * pd->level[0].dv, along = s->unit * s->offset[3 * q];
    state->full.volume += w;
    state->full.moment += w * s->r0[q];
    /* Bonds that cross a plane along the lattice, from one side. */
    state->full.crossing += along > 0 ? state->bulk[q] * w * s->r0[q] * along : 0;
  }
}

/* The mean of xi.n > 0 over all n is |xi|/pi in the plane and |xi|/4 in space. */
static bw_status cloud_sums(bw_pd_body *pd)
{
  const double ds = pd->level[0].ds;
  bw_pd_bond_full *full = &bw_pd_bond__own(pd)->full;
  /* No family of a cloud is the full one: means over many stand for it. */
  double mean[3];
  BW_TRY(bw_pd_body_cloud_means(pd, mean));
  full->volume = pd->level[0].dv * mean[0];
  full->moment = pd->level[0].dv * ds * mean[1];
  full->crossing = pd->level[0].dv * ds * ds * mean[2] / (pd->dimension == 3 ? 4 : PI);
  return BW_OK;
}

bw_status bw_pd_bond__full_family(bw_pd_body *pd)
{
  const bw_pd_bond_options *o = &bw_pd_bond__state(pd)->options;
  /* Nobody would read the sums. */
  if (o->calibration == BW_PD_CALIBRATION_NONE && o->surface_correction != BW_PD_SURFACE_TENSOR)
    return BW_OK;
  if (pd->config.disorder > 0) return cloud_sums(pd);
  lattice_sums(pd);
  return BW_OK;
}

/* After material and the sums. Between two groups both c0 and G0 c0 scale with their E, whose
 * harmonic mean the material has taken. */
void bw_pd_bond__calibrate(bw_pd_body *pd)
{
  const bw_pd_body_config *c = &pd->config;
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  /* V_0 of the volume method is that of the ball, as printed (3.44), or the family's own. */
  const bool lattice = state->options.calibration == BW_PD_CALIBRATION_LATTICE;
  const double d = pd->level[0].horizon;
  state->full_volume = pd->dimension == 3 ? 4.0 / 3 * PI * d * d * d : PI * d * d * c->thickness;
  /* Now alpha is 1 in the bulk. */
  if (lattice) state->full_volume = state->full.volume;
  for (int g = 0; g < c->n_group; g++)
    for (int h = 0; h < c->n_group; h++) {
      /* The factors by tensor are relative to this c0: that correction always takes it. */
      const double E = bw_pd_bond__joint_E(c, g, h);
      if (lattice || state->options.surface_correction == BW_PD_SURFACE_TENSOR)
        state->c0[g][h] = 4 * bw_pd_bond__classical_dilation(c, E) / state->full.moment;
      /* G0 = 1/2 c0 s0^2 sum, solved for s0. */
      if (lattice)
        state->s0[g][h] =
            sqrt(2 * bw_pd_bond__joint_G0(c, g, h) / (state->c0[g][h] * state->full.crossing));
    }
}
