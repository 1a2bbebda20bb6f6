/* Is it still physics? Invariants that no step looks at by itself, every hundred steps; what is not
 * finite, or too fast for its step, ends in the step where it happens.
 *
 * - The flow is free of divergence.
 * - Velocities do not change their sign from cell to cell and grow: of what a second difference
 *   sees, D = u[i-1] - 2 u[i] + u[i+1], the wave of two cells has D^2/16 = u^2, noise 3/8 of it.
 * - Energies of all solids add up (bw_solid_ledger), to the order of their integrator.
 * - Particles in contact do not come so near that they may pass through. */
#include "scene_impl.h"

#include <math.h>

enum { LOOK_EVERY = 100 };
static const double OPEN = 1e-3;   /* divergence; projection leaves round-off, 1e-5 in single */
static const double RIPPLED = 0.6; /* of the energy in the wave of two cells: more than noise has */
static const double GROWN = 1.5;   /* of a look over the one before */
static const double DOUBTFUL = 0.1, WRONG = 0.5; /* of the energies, what does not add up */

/* Energy of u along direction d in the wave of two cells, and all of it; this rank's share. */
static void ripple(const bw_grid_view *g, const bw_real *u, int d, double sum[2])
{
  const ptrdiff_t step = d == 0 ? 1 : g->stride[d];
  /* The cells beside the ends of the block have neighbours that need not be filled. */
  const int first[3] = {d == 0 ? 2 : 1, d == 1 ? 2 : 1, d == 2 ? 2 : 1};
  for (int k = first[2]; k <= g->m[2] - first[2] + 1; k++)
    for (int j = first[1]; j <= g->m[1] - first[1] + 1; j++)
      for (int i = first[0]; i <= g->m[0] - first[0] + 1; i++) {
        const ptrdiff_t at = bw_at(g, i, j, k);
        const double here = (double)u[at];
        const double D = (double)u[at - step] - 2.0 * here + (double)u[at + step];
        sum[0] += D * D / 16.0;
        sum[1] += here * here;
      }
}

/* The largest share of a component in a direction, and the energy in that wave. Collective. */
static void rippled(bw_scene *s, double *share, double *energy)
{
  bw_real *const *u = bw_ns_channel_velocity(s->fluid);
  const bw_grid_view *g = bw_grid_look(s->grid);
  const int dims = s->planar ? 2 : 3;
  double sum[18] = {0}, all = 0.0;
  for (int c = 0; c < dims; c++)
    for (int d = 0; d < dims; d++)
      ripple(g, u[c], d, sum + 2 * (3 * c + d));
  bw_comm_sum(s->comm, 18, sum);
  for (int q = 0; q < 9; q++)
    all = fmax(all, sum[2 * q + 1]);
  *share = *energy = 0.0;
  for (int q = 0; q < 9; q++)
    /* What is nothing beside the rest of the flow is round-off. */
    if (sum[2 * q] > RIPPLED * sum[2 * q + 1] && sum[2 * q] > 1e-6 * all && sum[2 * q] > *energy)
      *share = sum[2 * q] / sum[2 * q + 1], *energy = sum[2 * q];
}

static bw_status look_at_fluid(bw_scene *s)
{
  double share = 0.0, energy = 0.0;
  const double open = bw_ns_channel_divergence(s->fluid), before = s->sound.ripple;
  BW_REQUIRE(open <= OPEN, BW_EDIVERGED,
             "the flow is no physics any more at t = %g: its divergence is %.3g of velocity over "
             "cell; something wrote into the field, or the pressure is not solved",
             s->time, open);
  rippled(s, &share, &energy);
  s->sound.ripple = energy;
  BW_REQUIRE(
      !(before > 0.0 && energy > GROWN * before), BW_EDIVERGED,
      "the flow is no physics any more at t = %g: %.0f %% of the energy of a velocity change "
      "their sign from cell to cell, %.3g times as much as %d steps before; take smaller "
      "steps or more cells",
      s->time, 100.0 * share, energy / before, LOOK_EVERY);
  return BW_OK;
}

/* What the energies of all solids, which pass some to each other, come to; how large they are. */
static bw_status look_at_energy(bw_scene *s, double held, double spent, double external)
{
  bw_scene__energies *e = &s->sound.energies;
  const double total = held + spent - external;
  if (!e->known) e->start = total, e->known = true;
  e->most = fmax(e->most, fmax(held + fabs(spent), fabs(external)));
  const double off = fabs(total - e->start);
  const char *way = total > e->start ? "comes from nowhere" : "is gone";
  static const char *const remedy =
      "take smaller steps (numerics.step_share, in a flow numerics.solid_share)";
  BW_REQUIRE(off <= WRONG * e->most, BW_EDIVERGED,
             "the solids are no physics any more at t = %g: of their energy, %.3g at most, %.3g "
             "%s; %s",
             s->time, e->most, off, way, remedy);
  if (off <= DOUBTFUL * e->most || e->told) return BW_OK;
  e->told = true;
  s->sound.doubts++;
  bw_log_warn(s->log, "at t = %g energies of the solids do not add up: of %.3g %.3g %s; %s",
              s->time, e->most, off, way, remedy);
  return BW_OK;
}

static void look_at_contact(bw_scene *s, const bw_solid_ledger *book)
{
  if (!(book->closest < BW_SOLID_TOO_CLOSE) || s->sound.close) return;
  s->sound.close = true;
  s->sound.doubts++;
  bw_log_warn(s->log,
              "at t = %g particles in contact have come to %.2g of their spacing: some may have "
              "passed between others; take a smaller spacing or a slower impact",
              s->time, book->closest);
}

static bw_status look_at_solids(bw_scene *s)
{
  double held = 0.0, spent = 0.0, external = 0.0;
  for (int q = 0; q < (s->assembly != NULL ? 1 : s->n_solids); q++) {
    bw_solid_ledger b;
    BW_TRY(s->assembly != NULL ? bw_solid_assembly_account(s->assembly, &b)
                               : bw_solid_account(s->solid[q].solid, &b));
    held += b.kinetic + b.elastic + b.contact + b.retired;
    spent += b.damping + b.fracture + b.plastic + b.regrid;
    external += b.external;
    look_at_contact(s, &b);
  }
  return look_at_energy(s, held, spent, external);
}

bw_status bw_scene__look(bw_scene *s)
{
  /* The first step is looked at, too: what there is at the start is what has to stay. */
  if (s->steps % LOOK_EVERY != 1) return BW_OK;
  if (s->fluid != NULL) BW_TRY(look_at_fluid(s));
  /* Rigid bodies that touch a solid have part of its energies. */
  if (s->n_solids == 0 || !s->alive || s->rigid != NULL) return BW_OK;
  /* What stands still is set back to where it was, which no book knows. */
  if (s->config.phases[s->phase].hold[0] == '\0') return look_at_solids(s);
  s->sound.energies.known = false;
  return BW_OK;
}
