/* The bond law as a row of the table of laws: what it refuses, its constants, its members. */
#include "bw_memory.h"
#include "pd_bond.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
enum { AROUND = 3 }; /* families that a change of levels is felt through */

static bw_status check(const bw_pd_body_config *c, const void *options)
{
  const bw_pd_bond_options *o = (const bw_pd_bond_options *)options;
  /* A network of central bonds has one Poisson's ratio, whatever its constants (ERRATA 14). */
  const double nu = bw_pd_body_natural_poisson(c->geometry);
  for (int g = 0; g < c->n_group; g++)
    BW_REQUIRE(
        isnan(c->material[g].nu) || fabs(c->material[g].nu - nu) < 1e-9, BW_EINPUT,
        "solid: nu = %g, but bonds fix it to %s in this geometry (ERRATA 14); leave nu out or "
        "set it to that",
        c->material[g].nu, c->geometry == BW_PD_PLANE_STRESS ? "1/3" : "1/4");
  BW_REQUIRE((unsigned)o->surface_correction <= BW_PD_SURFACE_TENSOR, BW_EINPUT,
             "solid: surface_correction = %d is unknown", (int)o->surface_correction);
  BW_REQUIRE(o->surface_correction != BW_PD_SURFACE_TENSOR || c->disorder == 0, BW_EINPUT,
             "solid: surface_correction = tensor is of lattices; with disorder = %g use energy",
             c->disorder);
  BW_REQUIRE(bw_pd_body_finest(c) == 0 || o->surface_correction == BW_PD_SURFACE_NONE ||
                 o->surface_correction == BW_PD_SURFACE_TENSOR,
             BW_EINPUT,
             "solid: surface_correction = %s with levels: a factor per particle knows one level; "
             "use tensor or none",
             o->surface_correction == BW_PD_SURFACE_VOLUME ? "volume" : "energy");
  BW_REQUIRE(!c->finer.same_horizon || (o->surface_correction == BW_PD_SURFACE_NONE &&
                                        c->finer.jump != BW_PD_JUMP_BALANCED),
             BW_EINPUT,
             "solid: finer.same_horizon with surface_correction or finer.jump = balanced: their "
             "factors are of families alike on all levels; take none, and dual or one_sided");
  BW_REQUIRE((unsigned)o->calibration <= BW_PD_CALIBRATION_LATTICE, BW_EINPUT,
             "solid: calibration = %d is unknown", (int)o->calibration);
  return BW_OK;
}

/* POROUS 3.21 and 3.27 with ERRATA 1; both are proportional to E and G0/E, so that bonds between
 * two groups have those of the harmonic mean of the two E. */
void bw_pd_bond__material(bw_pd_body *pd)
{
  bw_pd_body_config *c = &pd->config;
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  const double d = pd->level[0].horizon, t = c->thickness;
  for (int g = 0; g < c->n_group; g++)
    for (int h = 0; h < c->n_group; h++) {
      /* A column per geometry: space, plane stress, plane strain. */
      const double E = bw_pd_bond__joint_E(c, g, h);
      const double micromodulus[] = {12 * E / (PI * d * d * d * d), 9 * E / (PI * t * d * d * d),
                                     48 * E / (5 * PI * t * d * d * d)};
      const double stretch2[] = {5 / (6 * E * d), 4 * PI / (9 * E * d), 5 * PI / (12 * E * d)};
      state->c0[g][h] = micromodulus[c->geometry];
      state->s0[g][h] = sqrt(stretch2[c->geometry] * bw_pd_bond__joint_G0(c, g, h));
    }
  for (int g = 0; g < c->n_group; g++)
    /* Whoever left it out reads here what it is. */
    c->material[g].nu = bw_pd_body_natural_poisson(c->geometry);
}

/* What of a kernel row is the law's, once c0 and s0 are known. */
static void row_constants(const bw_pd_body *pd, const bw_pd_level *level, int g, int h,
                          bw_real row[])
{
  static const double factor[] = {1, 2, 0.5, BW_PD_ALPHA_UNIT}; /* none; volume: 2/(w+w); energy:
                                                             (g+g)/2; tensor: whole numbers */
  const bw_pd_bond_state *state = bw_pd_bond__state(pd);
  const bw_pd_stencil *s = &level->stencil;
  const bool cloud = pd->config.disorder > 0;
  for (int q = 0; q < s->n; q++, row += BW_PD_ROW) {
    /* In a cloud length and Gamma are the bond's own: here they are 1. */
    const double r0 = cloud ? 1 : s->r0[q], gamma = cloud ? 1 : s->fraction[q];
    /* Between levels constants are told by the coarser end. */
    const bw_pd_level *other = pd->level + s->other[q],
                      *coarser = bw_pd_level_coarser(level, other);
    const double c0 = state->c0[g][h] * coarser->stiff;
    /* Where levels change nothing breaks but in the finest: that is what a stretch is beside. */
    const double s0 = state->s0[g][h] * (pd->mapped ? pd->level[pd->finest].stretch
                                                    : coarser->stretch * sqrt(s->tough[q]));
    const double limit = r0 * (1 + s0);
    /* Acceleration of the owner per change of length, with what every bond shares of alpha. */
    row[BW_PD_STIFFNESS] = (bw_real)(factor[state->options.surface_correction] * c0 * gamma *
                                     other->dv / (pd->config.material[g].rho * r0));
    row[BW_PD_LIMIT2] = (bw_real)(limit * limit);
  }
}

static void constants(bw_pd_body *pd)
{
  const int groups = pd->config.n_group;
  /* s0 may have changed alone, but c0 and s0 belong together: both are made anew. */
  bw_pd_bond__material(pd);
  bw_pd_bond__calibrate(pd);
  bw_pd_bond__own(pd)->breakable = false;
  for (int g = 0; g < groups; g++)
    for (int h = 0; h < groups; h++) {
      /* Without a finite s0 the sweeps need not compare lengths. */
      if (isfinite(bw_pd_bond__state(pd)->s0[g][h])) bw_pd_bond__own(pd)->breakable = true;
      for (int l = 0; l <= pd->finest; l++) {
        const bw_pd_level *level = &pd->level[l];
        row_constants(pd, level, g, h,
                      level->row + (size_t)((g * groups + h) * level->stencil.n) * BW_PD_ROW);
      }
    }
}

static bool has_jumps(const bw_pd_body *pd)
{
  return pd->finest > 0 && pd->config.finer.jump == BW_PD_JUMP_BALANCED;
}

/* Those of the surface, then those of bonds near jumps, which change them. Collective. */
static bw_status make_factors(bw_pd_body *pd, const bw_pd_bond_change *change)
{
  if (bw_pd_bond__state(pd)->options.surface_correction == BW_PD_SURFACE_TENSOR)
    BW_TRY(bw_pd_bond__tensor(pd, change));
  return has_jumps(pd) ? bw_pd_bond__levels(pd, change) : BW_OK;
}

static bw_status prepare(bw_pd_body *pd, const void *options)
{
  const int directions = pd->level->stencil.same;
  bw_pd_bond_state *state = NULL;
  bw_status st = BW_ALLOCATE(&state, 1);
  /* The body destroys what stands of a state, also after a failure. */
  pd->state = state;
  if (st == BW_OK) {
    state->options = *(const bw_pd_bond_options *)options;
    st = BW_ALLOCATE(&state->bulk, (size_t)directions);
    BW_THEN(st, bw_pd_body_storage_array(pd->points.n_storage, &state->w));
  }
  /* Until the correction by tensor says otherwise a full family is not corrected. */
  for (int q = 0; q < directions && st == BW_OK; q++)
    state->bulk[q] = 1;
  /* The factors of a body's surface refer to the full family's sums, and the tensor's factors
   * change what a full family holds: in this order. */
  BW_THEN(st, bw_pd_bond__full_family(pd));
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_pd_bond__material(pd);
  bw_pd_bond__calibrate(pd);
  BW_TRY(bw_pd_bond__surface_factors(pd));
  /* Multipliers that go on when levels change are fields of the body. */
  if (pd->mapped && state->options.surface_correction == BW_PD_SURFACE_TENSOR) {
    st = bw_pd_bond__tensor_room(pd);
    BW_THEN(st, bw_pd_bond__levels_room(pd));
    BW_TRY(bw_comm_agree(pd->comm, st));
  }
  return pd->config.finer.later ? BW_OK : make_factors(pd, NULL);
}

/* Multipliers may change up to AROUND families from a change of levels. Collective. */
static bw_status find_near(const bw_pd_body *pd, bw_pd_bond_change *change)
{
  const size_t places = pd->points.n_storage;
  bw_real *before = NULL;
  bw_status st = bw_pd_body_storage_array(places, &change->near);
  BW_THEN(st, bw_pd_body_storage_array(places, &before));
  st = bw_comm_agree(pd->comm, st);
  for (size_t i = 0; i < pd->n && st == BW_OK; i++)
    change->near[pd->points.place[i]] = change->fresh[i];
  for (int layer = 0; layer < AROUND && st == BW_OK; layer++) {
    bw_pd_body_fill_places(pd, change->near);
    memcpy(before, change->near, places * sizeof *before);
    bw_pd_bond__mark_neighbours(pd, before, change->near);
  }
  if (st == BW_OK) bw_pd_body_fill_places(pd, change->near);
  bw_pd_body_release_storage_array(&before);
  return st;
}

static bw_status settle(bw_pd_body *pd, const bool fresh[])
{
  bw_pd_bond_change change = {.fresh = fresh};
  /* Without multipliers that went on factors follow from the levels alone. */
  if (bw_pd_bond__state(pd)->n_lambda == 0) return fresh != NULL ? make_factors(pd, NULL) : BW_OK;
  if (fresh == NULL) {
    BW_TRY(bw_pd_bond__tensor_adopt(pd));
    return has_jumps(pd) ? bw_pd_bond__levels_adopt(pd) : BW_OK;
  }
  bw_status st = find_near(pd, &change);
  if (st == BW_OK) st = make_factors(pd, &change);
  bw_pd_body_release_storage_array(&change.near);
  return st;
}

static void destroy(bw_pd_body *pd)
{
  bw_pd_bond_state *state = bw_pd_bond__own(pd);
  if (state == NULL) return;
  bw_release(&state->bulk);
  bw_pd_body_release_storage_array(&state->w);
  bw_release(&pd->state);
}

double bw_pd_bond_law_micromodulus(const bw_pd_body *pd, int group)
{
  return bw_pd_bond__state(pd)->c0[group][group];
}

double bw_pd_bond_law_critical_stretch(const bw_pd_body *pd, int group)
{
  return bw_pd_bond__state(pd)->s0[group][group];
}

static const bw_pd_law_key keys[] = {
    {"surface_correction", "", "factor of bonds whose families a surface has cut"},
    {"calibration", "", "constants from integrals over the ball or from the lattice's sums"},
    {NULL, NULL, NULL}};

const bw_pd_law bw_pd_bond_law = {.name = "bond",
                                  .keys = keys,
                                  .check = check,
                                  .prepare = prepare,
                                  .settle = settle,
                                  .constants = constants,
                                  .n_sweep = 1,
                                  .sweep = {bw_pd_bond__force},
                                  .damps = true,
                                  .levels = true,
                                  .breaks = bw_pd_bond__breaks,
                                  .bond_energy = bw_pd_bond__bond_energy,
                                  .energy = bw_pd_bond__energy,
                                  .bound = bw_pd_bond__bound,
                                  .tangent = bw_pd_bond__tangent,
                                  .rows = bw_pd_bond__rows,
                                  .virial = bw_pd_bond__virial,
                                  .micromodulus = bw_pd_bond_law_micromodulus,
                                  .destroy = destroy};
