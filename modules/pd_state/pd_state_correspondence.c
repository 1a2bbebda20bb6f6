/* The correspondence law as a row of the table of laws. */
#include "pd_state_correspondence.h"
#include "bw_memory.h"

#include <string.h>

bw_pd_state_correspondence_options bw_pd_state_correspondence_options_default(void)
{
  bw_pd_state_correspondence_options o = {.weight = BW_PD_STATE_CUBIC,
                                          .elastic = BW_PD_MATERIAL_NEO_HOOKEAN,
                                          .stabilisation = 4.0 / 3,
                                          .breaks = BW_PD_STATE_BREAKS_BY_STRETCH,
                                          .limit = INFINITY};
  for (int g = 0; g < BW_PD_GROUPS; g++)
    o.yield[g].k = INFINITY;
  return o;
}

static bw_pd_state_correspondence_options resolved(const void *options)
{
  return options == NULL ? bw_pd_state_correspondence_options_default()
                         : *(const bw_pd_state_correspondence_options *)options;
}

static bw_status check_yield(const bw_pd_material_yield *y, int g)
{
  BW_REQUIRE(y->k > 0 && y->alpha >= 0 && y->dilatancy >= 0 && y->hardening >= 0 &&
                 isfinite(y->alpha * y->dilatancy * y->hardening),
             BW_EINPUT,
             "solid: yield of group %d: strength %g must be positive, slope %g, dilatancy %g and "
             "hardening %g 0 or more",
             g, y->k, y->alpha, y->dilatancy, y->hardening);
  return BW_OK;
}

static bw_status check(const bw_pd_body_config *c, const void *options)
{
  const bw_pd_state_correspondence_options o = resolved(options);
  BW_TRY(bw_pd_state__check_poisson(c));
  BW_REQUIRE((unsigned)o.weight <= BW_PD_STATE_UNIFORM &&
                 (unsigned)o.elastic < BW_PD_MATERIAL_ENERGIES &&
                 (unsigned)o.breaks <= BW_PD_STATE_BREAKS_BY_CONE,
             BW_EINPUT, "solid: weight = %d, elastic = %d or breaks = %d is unknown", (int)o.weight,
             (int)o.elastic, (int)o.breaks);
  BW_REQUIRE(o.stabilisation >= 0 && isfinite(o.stabilisation), BW_EINPUT,
             "solid: stabilisation = %g must be 0 or more; 4/3 keeps shear waves to fourth order",
             o.stabilisation);
  BW_REQUIRE(o.breaks == BW_PD_STATE_BREAKS_BY_STRETCH || (o.limit > 0 && isfinite(o.limit)),
             BW_EINPUT, "solid: limit = %g of stress or flow must be positive", o.limit);
  bool breakable = o.breaks != BW_PD_STATE_BREAKS_BY_STRETCH;
  for (int g = 0; g < c->n_group; g++) {
    BW_TRY(check_yield(&o.yield[g], g));
    breakable |= isfinite(c->material[g].G0);
  }
  /* With eight neighbours a broken bond leaves too little of K, and cracks follow the lattice. */
  BW_REQUIRE(!breakable || c->horizon_ratio >= 2, BW_EINPUT,
             "solid: horizon_ratio = %g; a correspondence solid that breaks needs 2 or more, one "
             "that does not (no G0) 1.5",
             c->horizon_ratio);
  return BW_OK;
}

/* Sums over the stencil's sites, which of a cloud stand for what its families have: tr K/d, and the
 * springs' first moment. */
static void full_family(const bw_pd_body *pd, const bw_pd_level *level, double *kappa,
                        double *moment)
{
  const bw_pd_stencil *s = &level->stencil;
  *kappa = *moment = 0;
  for (int q = 0; q < s->n; q++) {
    if (!(s->r0[q] < level->reach)) continue;
    const double w = bw_pd_correspondence_weight(pd, level, s->r0[q]) * s->fraction[q] * level->dv;
    *kappa += w * s->r0[q] * s->r0[q] / pd->dimension;
    *moment += w * s->r0[q];
  }
}

static bw_status fields(bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const int d = pd->dimension;
  /* What neighbours read in the second pass. */
  BW_TRY(bw_pd_body_add_field(pd, 0, false, &o->beta));
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++)
      BW_TRY(bw_pd_body_add_field(pd, 0, false, &o->B[3 * i + j]));
  if (o->options.breaks != BW_PD_STATE_BREAKS_BY_STRETCH)
    BW_TRY(bw_pd_body_add_field(pd, 0, false, &o->measure));
  for (int q = 0; q < 6; q++)
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &o->inverse[q]));
  if (o->remembers) {
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &o->whole));
    BW_TRY(bw_pd_body_add_field(pd, -1, true, &o->lately));
  }
  for (int q = 0; q < BW_PD_REMEMBERED && o->remembers; q++) {
    BW_TRY(bw_pd_body_add_field(pd, -1, true, &o->accepted[q]));
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &o->trial[q]));
  }
  return BW_ALLOCATE(&o->cut, pd->bonds.n_block);
}

/* No family at the start may lie in a plane: named by its particle. Collective. */
static bw_status check_families(const bw_pd_body *pd)
{
  int64_t first = INT64_MAX;
  for (size_t i = 0; i < pd->n; i++)
    if (bw_pd_correspondence_of(pd)->beta[pd->points.place[i]] < 0 && pd->points.id[i] < first)
      first = pd->points.id[i];
  double least = (double)first;
  bw_comm_min(pd->comm, 1, &least);
  BW_REQUIRE(
      least >= 9e18, BW_EINPUT,
      "solid: the neighbours of particle %.0f do not span the %s, which correspondence needs; "
      "take a larger horizon_ratio than %g, a finer spacing where the body is thin, or the law "
      "bond or ordinary",
      least, pd->dimension == 3 ? "space" : "plane", pd->config.horizon_ratio);
  return BW_OK;
}

static void constants(bw_pd_body *pd);

static bw_status prepare(bw_pd_body *pd, const void *options)
{
  bw_status st = BW_ALLOCATE((bw_pd_correspondence **)&pd->state, 1);
  if (st == BW_OK) {
    bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
    o->options = resolved(options);
    for (int g = 0; g < pd->config.n_group; g++)
      o->remembers |= isfinite(o->options.yield[g].k);
    st = fields(pd);
  }
  BW_TRY(bw_comm_agree(pd->comm, st));
  bw_pd_state__resolve_poisson(&pd->config);
  constants(pd);
  bw_pd_state__shapes(pd);
  return check_families(pd);
}

/* s0 of a joint on level 0 from its G0: the stretch that breaks a bond as long as the horizon. */
static double stretch(const bw_pd_body *pd, int g, int h)
{
  const bw_pd_body_config *c = &pd->config;
  const bool uniform = bw_pd_correspondence_of(pd)->options.weight == BW_PD_STATE_UNIFORM;
  const double nu = 0.5 * (c->material[g].nu + c->material[h].nu);
  const double a = c->material[g].E, b = c->material[h].E, E = 2 * a * b / (a + b);
  /* In plane stress the body in plane strain that has the same mu and the same lam in the plane. */
  const double strain = bw_pd_state__strain_poisson(c->geometry, nu);
  const double factor =
      bw_pd_state__correspondence_crack(c, uniform, strain) * E * (1 + strain) / (1 + nu);
  return sqrt(bw_pd_state__joint_G0(c, g, h) / (factor * pd->level[0].horizon));
}

static void row_constants(bw_pd_body *pd, const bw_pd_level *level, int g, int h)
{
  const bw_pd_stencil *s = &level->stencil;
  const bool cloud = pd->config.disorder > 0;
  const double s0 = bw_pd_correspondence_of(pd)->s0[g][h] * level->stretch;
  const double excess = s0 * sqrt(level->horizon); /* over sqrt(|xi|) [sqrt(L)] */
  bw_real *row = bw_pd_state__row(pd, level, g, h);
  for (int q = 0; q < s->n; q++, row += BW_PD_ROW) {
    const double r0 = cloud ? 1 : s->r0[q];
    row[BW_PD_STIFFNESS] =
        (bw_real)(cloud ? level->dv
                        : bw_pd_correspondence_weight(pd, level, r0) * s->fraction[q] * level->dv);
    row[BW_PD_LIMIT2] = (bw_real)(cloud ? excess : pow(r0 + excess * sqrt(r0), 2));
  }
}

static void constants(bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_body_config *c = &pd->config;
  const bw_pd_material_plane plane = (bw_pd_material_plane)c->geometry; /* in the same order */
  static const double dilation[] = {3, 1.5, 1.6}; /* energy of bonds, over E e^2 */
  double moment[BW_PD_FINEST + 1];
  for (int l = 0; l <= pd->finest; l++)
    full_family(pd, &pd->level[l], &o->kappa[l], &moment[l]);
  o->breakable = o->options.breaks != BW_PD_STATE_BREAKS_BY_STRETCH;
  for (int g = 0; g < c->n_group; g++) {
    const bw_pd_material *m = &c->material[g];
    o->material[g] = bw_pd_material_elastic_point(plane, o->options.elastic, m->E, m->nu);
    o->material[g].yield = o->options.yield[g];
    o->material[g].own = o->options.own;
    memcpy(o->material[g].parameter, o->options.parameter, sizeof o->options.parameter);
    o->small[g] = bw_pd_material_elastic_point(plane, BW_PD_MATERIAL_LINEAR, m->E, m->nu);
    for (int l = 0; l <= pd->finest; l++)
      o->spring[l][g] = 2 * dilation[c->geometry] * m->E / moment[l];
    for (int h = 0; h < c->n_group; h++) {
      o->s0[g][h] = stretch(pd, g, h);
      o->breakable |= isfinite(o->s0[g][h]);
      for (int l = 0; l <= pd->finest; l++)
        row_constants(pd, &pd->level[l], g, h);
    }
  }
  /* beta follows mu: all shapes are made anew at the next pass. */
  o->seen = -1;
}

/* A remembered H is that of the bonds that hold: it jumps with them, the stress does not. */
static void forget_lane(bw_pd_body *pd, const bw_pd_block *block, int lane)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  const bw_pd_state_family f = bw_pd_state__family(pd, block, lane, NULL);
  double H[9] = {0};
  if (f.spans) bw_pd_state__gradient(pd, block, lane, &f, NULL, H);
  /* In the plane F33 is the material's own. */
  for (int q = 0; q < (pd->dimension == 3 ? 9 : 8); q++)
    o->accepted[q][block->first + lane] = (bw_real)H[q];
}

void bw_pd_state__forget(bw_pd_body *pd, const bw_pd_block *block, uint8_t changed)
{
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (changed >> lane & 1 && bw_pd_correspondence_of(pd)->remembers) forget_lane(pd, block, lane);
}

/* Both ends see the same numbers. */
bool bw_pd_state__correspondence_beyond(const bw_pd_body *pd, const bw_pd_level *level,
                                        const bw_pd_walk *b)
{
  const bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  double y[3];
  const double s = bw_pd_walk_present(b, y) / b->rest.r0 - 1;
  if (o->measure != NULL) return s > 0 && (double)o->measure[b->h] + (double)o->measure[b->l] > 2;
  const double s0 = o->s0[bw_pd_body_group_at(pd, b->h)][bw_pd_body_group_at(pd, b->l)];
  return s > level->stretch * s0 * sqrt(level->horizon / b->rest.r0);
}

static bool breaks(bw_pd_body *pd, bw_pd_block *block)
{
  const bw_pd_level *level = bw_pd_body_level_of(pd, block);
  uint8_t changed = 0;
  for (bw_pd_walk b = bw_pd_walk_of(pd, block, (uint8_t)~block->gone); bw_pd_walk_next(&b);) {
    if (!bw_pd_state__correspondence_beyond(pd, level, &b) || bw_pd_walk_unbreakable(&b)) continue;
    bw_pd_body_cut(pd, block, b.slot, b.lane);
    changed |= (uint8_t)(1u << b.lane);
  }
  bw_pd_state__forget(pd, block, changed);
  return changed != 0;
}

static void destroy(bw_pd_body *pd)
{
  bw_pd_correspondence *o = bw_pd_correspondence_of(pd);
  if (o == NULL) return;
  for (int q = 0; q < 6; q++)
    bw_pd_body_release_storage_array(&o->inverse[q]);
  for (int q = 0; q < BW_PD_REMEMBERED; q++)
    bw_pd_body_release_storage_array(&o->trial[q]);
  bw_pd_body_release_storage_array(&o->whole);
  bw_release(&o->cut);
  bw_release(&pd->state);
}

static const bw_pd_law_key keys[] = {
    {"young_modulus", "Pa", "Young's modulus, above 0; required"},
    {"poisson_ratio", "",
     "Poisson's ratio, -1 .. 0.4999; default that of bonds: 1/4, 1/3 in plane stress"},
    {"fracture_energy", "J/m2", "energy of a cut per area, above 0; default: it does not break"},
    {"weight", "",
     "weight of a neighbour: cubic (falls to 0 at the horizon) or uniform; default "
     "cubic"},
    {"elastic", "", "energy: linear, saint_venant, neo_hookean or hencky; default neo_hookean"},
    {"stabilisation", "", "beta kappa/mu, 0 or more; default 4/3"},
    {"breaks", "",
     "bonds break by stretch (of fracture_energy; longer ones at less), stress, flow, energy, "
     "mises, "
     "mohr_coulomb or drucker_prager; default stretch"},
    {"limit", "Pa or 1",
     "stress, of Mohr-Coulomb and Drucker-Prager cohesion, or factor of plastic flow, that a pair "
     "bears"},
    {"friction_angle", "deg", "of breaks: mohr_coulomb and drucker_prager"},
    {NULL, NULL, NULL}};

const bw_pd_law bw_pd_state_correspondence_law = {
    .name = "correspondence",
    .keys = keys,
    .check = check,
    .prepare = prepare,
    .constants = constants,
    .n_sweep = 2,
    .sweep = {bw_pd_state__deform, bw_pd_state__force},
    .breaks = breaks,
    .accept = bw_pd_state__accept,
    .bond_energy = bw_pd_state__bond_energy,
    .energy = bw_pd_state__energy,
    .dissipated = bw_pd_state__dissipated,
    .bound = bw_pd_state__bound,
    .tangent = bw_pd_state__tangent,
    .rows = bw_pd_state__rows,
    .virial = bw_pd_state__virial,
    .micromodulus = bw_pd_state__micromodulus,
    .destroy = destroy};
