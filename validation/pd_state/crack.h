/* crack.h -- a crack that is driven bond by bond through a body at rest, and what that costs. */
#pragma once
#include "pd_law.h"
#include "pd_walk.h"
#include "state.h"

static const double CRACK_STRAIN = 1e-5; /* of the states whose energy is taken */

/* A body with prescribed particles, and its displacement at rest for a load of 1. */
typedef struct {
  bw_solid *pd;
  body_rows r;
  double *U;   /* (n,3) rows of prescribed particles are the load of 1 */
  double left; /* uniform strain that a load of 1 makes beside that, which limits leave out: 0 */
} crack_body;

/* Which cell of a box is what: kind, or a negative number where there is none; and its group. */
typedef int (*crack_choice)(const int32_t site[3], const void *data, uint8_t *group);

/* A body of `size` cells; group 0 breaks, group 1 is the same material and does not. In space it is
 * periodic along the crack's front, which is z. */
static inline bw_status crack_make(const bw_comm *comm, bw_solid_config *c, const int size[3],
                                   crack_choice choice, const void *data, crack_body *b)
{
  const size_t cells = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
  int32_t *site = NULL;
  uint8_t *kind = NULL, *group = NULL;
  int64_t n = 0;
  c->more.n = 1;
  c->more.material[0] = (bw_pd_material){c->rho, c->E, c->choice.poisson_ratio, INFINITY};
  c->more.joint_G0[0][1] = c->more.joint_G0[1][0] = INFINITY;
  if (c->geometry == BW_PD_3D) c->period[2] = size[2] * c->ds;
  bw_status st = BW_ALLOCATE(&site, 3 * cells);
  BW_THEN(st, BW_ALLOCATE(&kind, cells));
  BW_THEN(st, BW_ALLOCATE(&group, cells));
  for (size_t q = 0; st == BW_OK && q < cells; q++) {
    int32_t *s = site + 3 * n;
    s[0] = (int32_t)(q % (size_t)size[0]);
    s[1] = (int32_t)(q / (size_t)size[0] % (size_t)size[1]);
    s[2] = (int32_t)(q / (size_t)size[0] / (size_t)size[1]);
    const int what = choice(s, data, &group[n]);
    if (what >= 0) kind[n++] = (uint8_t)what;
  }
  BW_THEN(st, bw_solid_create(comm, c, &(bw_pd_sites){n, site, kind, group}, &b->pd));
  bw_release(&site);
  bw_release(&kind);
  bw_release(&group);
  BW_TRY(st);
  BW_TRY(body_rows_make(b->pd, &b->r));
  return BW_ALLOCATE(&b->U, 3 * bw_solid_count(b->pd));
}

static inline void crack_release(crack_body *b)
{
  bw_release(&b->U);
  body_rows_release(&b->r);
  bw_solid_destroy(&b->pd);
}

/* A flat cut through y between two places along x, through all of the depth. */
static inline bw_status crack_cut(crack_body *b, double from, double to, double y)
{
  const bool space = bw_solid_settings(b->pd)->geometry == BW_PD_3D;
  const double z = space ? -100 : 0;
  return bw_solid_precrack(b->pd, (double[3]){from, y, z}, (double[3]){to, y, z},
                           space ? (double[3]){from, y, 100} : NULL);
}

/* Rest with the bonds there are, from where U was. */
static inline bw_status crack_rest(crack_body *b)
{
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  how.tolerance = 1e-6;
  return bw_solid_static_linear(b->pd, &how, b->U, &report);
}

static inline void crack_load(crack_body *b, double load)
{
  for (size_t k = 0; k < 3 * bw_solid_count(b->pd); k++)
    b->r.X[k] = b->r.X0[k] + load * b->U[k];
  bw_solid_set_state(b->pd, b->r.X, b->r.V);
}

/* Elastic energy at rest for a load of 1; small: a load of small strain. */
static inline bw_status crack_energy(crack_body *b, double small, double *energy)
{
  bw_solid_ledger e;
  crack_load(b, small);
  BW_TRY(bw_solid_account(b->pd, &e));
  *energy = e.elastic / (small * small);
  return BW_OK;
}

/* Whether the law finds a bond beyond its limit at a load; breaks: it goes. */
static inline bw_status crack_beyond(crack_body *b, double load, bool breaks, bool *found)
{
  bw_pd_body *pd = bw_solid_body(b->pd);
  for (size_t k = 0; k < 3 * bw_solid_count(b->pd); k++)
    b->r.X[k] = b->r.X0[k] + load * (b->U[k] - b->left * b->r.X0[k]);
  bw_solid_set_state(b->pd, b->r.X, b->r.V);
  BW_TRY(bw_solid_evaluate(b->pd));
  bw_pd_body_internal_force(pd, true, false);
  *found = pd->bonds.n_hit > 0;
  if (breaks) *found = bw_pd_body_break_hits(pd);
  pd->current = false;
  return BW_OK;
}

/* The load at which the next bond goes, found by halving from around `load`; it is broken. */
static inline bw_status crack_advance(crack_body *b, double *load)
{
  double low = 0, high = *load;
  bool found = false;
  for (int q = 0; q < 60 && !found; q++, high *= found ? 1 : 1.5)
    BW_TRY(crack_beyond(b, high, false, &found));
  for (int q = 0; q < 60 && high - low > 1e-7 * high; q++) {
    const double a = 0.5 * (low + high);
    BW_TRY(crack_beyond(b, a, false, &found));
    if (found)
      high = a;
    else
      low = a;
  }
  *load = high;
  /* Mirrored bonds differ in rounding: both go. */
  BW_TRY(crack_beyond(b, high * (1 + 1e-6), true, &found));
  BW_REQUIRE(found, BW_EDIVERGED, "nothing breaks at a load of %g", high);
  return BW_OK;
}

/* How far broken bonds reach along x. */
static inline double crack_tip(const crack_body *b)
{
  const bw_pd_body *pd = bw_solid_body(b->pd);
  double most = 0;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    for (bw_pd_walk w = bw_pd_walk_families(pd, &pd->bonds.block[q]); bw_pd_walk_next(&w);) {
      double X0[3];
      if (w.slot->mask >> w.lane & 1) continue;
      bw_pd_body_reference(pd, bw_pd_walk_owner(&w), X0);
      most = fmax(most, X0[0] + 0.5 * w.rest.xi[0]);
    }
  return most;
}

/* A material and law to drive a crack through. */
typedef struct {
  bw_pd_geometry geometry;
  int law;      /* of bw_solid_law_row */
  int weight;   /* influence (ordinary) or weight (correspondence) */
  double nu, m; /* Poisson's ratio, horizon ratio */
} crack_material;

/* E = 5, ds = 1; lam is lam* in plane stress. */
static inline bw_solid_config crack_config(const crack_material *a, double *lam, double *mu)
{
  bw_solid_config c = bw_solid_config_default();
  state_lame(a->geometry, 5, a->nu, lam, mu);
  c.geometry = a->geometry, c.ds = c.rho = 1, c.E = 5, c.horizon_ratio = a->m;
  c.choice.law = a->law, c.choice.poisson_ratio = a->nu;
  c.choice.weight = c.choice.influence = a->weight;
  return c;
}

static inline void crack_words(const crack_material *a, char *out, size_t room, const char *more)
{
  static const char *const name[] = {"space", "plane_stress", "plane_strain"};
  static const char *const word[2][2] = {{"constant", "inverse"}, {"cubic", "uniform"}};
  const bool ordinary = a->law == BW_SOLID_ORDINARY;
  snprintf(out, room,
           "\"law\": \"%s\", \"weight\": \"%s\", \"geometry\": \"%s\", \"nu\": %g, "
           "\"m\": %g%s",
           ordinary ? "ordinary" : "correspondence", word[!ordinary][a->weight], name[a->geometry],
           a->nu, a->m, more);
}
