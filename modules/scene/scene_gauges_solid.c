/* What gauges see of the solids. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_pd_crack.h"
#include "bw_solid_levels.h"
#include "pd_law.h"
#include <math.h>
#include <string.h>

/* What is cracked before anything happens, where a crack is followed; of a solid whose levels have
 * changed by what its pre-cracks cut in the particles that there are now. Collective. */
bw_status bw_scene__note_cut(bw_scene *s, int solid)
{
  bw_scene__solid *q = &s->solid[solid];
  double *cracked = NULL;
  if (!bw_scene__asked(s, "crack_tip")) return BW_OK;
  bw_release(&q->cut);
  bw_status st = BW_ALLOCATE(&cracked, q->n);
  BW_THEN(st, BW_ALLOCATE(&q->cut, q->n));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK && bw_solid_settings(q->solid)->finer.refine.level > 0)
    bw_solid_get_precut(q->solid, cracked);
  else if (st == BW_OK)
    bw_solid_get_damage(q->solid, cracked);
  for (size_t i = 0; st == BW_OK && i < q->n; i++)
    q->cut[i] = cracked[i] > BW_PD_CRACK_LEVEL;
  bw_release(&cracked);
  return st;
}

bw_status bw_scene__note_cuts(bw_scene *s)
{
  for (int k = 0; k < s->n_solids; k++)
    BW_TRY(bw_scene__note_cut(s, k));
  return BW_OK;
}

/* Volume of a particle over that of the coarsest: means are of volume. */
double bw_scene__share(const bw_scene__solid *p, size_t i)
{
  return bw_solid_volume_of(p->solid, i) / bw_solid_volume(p->solid);
}

/* Mean of a vector over the particles of a gauge. Collective. */
static void mean_vector(bw_scene *s, const bw_scene__aim *aim, const char *word, double value[3])
{
  memset(value, 0, 3 * sizeof *value);
  for (int q = 0; q < s->n_solids; q++) {
    bw_scene__solid *p = &s->solid[q];
    if (strcmp(word, "velocity") == 0)
      bw_solid_get_velocity(p->solid, p->V);
    else
      bw_solid_get_position(p->solid, p->V);
    const double origin = strcmp(word, "displacement") == 0 ? 1.0 : 0.0;
    for (int k = 0; k < aim->n[q]; k++)
      for (size_t d = 0; d < 3; d++) {
        const size_t at = 3 * (size_t)aim->particle[q][k] + d;
        const double share = bw_scene__share(p, (size_t)aim->particle[q][k]) / aim->count;
        value[d] += (p->V[at] - origin * p->X0[at]) * share;
      }
  }
  bw_comm_sum(s->comm, 3, value);
}

/* Mean and largest damage of the particles of a gauge. Collective. */
static bw_status damage_of(bw_scene *s, const bw_scene__aim *aim, double value[2])
{
  value[0] = value[1] = 0.0;
  for (int q = 0; q < s->n_solids; q++) {
    double *damage = NULL;
    BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&damage, s->solid[q].n)));
    bw_solid_get_damage(s->solid[q].solid, damage);
    for (int k = 0; k < aim->n[q]; k++) {
      value[0] += damage[aim->particle[q][k]] *
                  bw_scene__share(&s->solid[q], (size_t)aim->particle[q][k]) / aim->count;
      value[1] = fmax(value[1], damage[aim->particle[q][k]]);
    }
    bw_release(&damage);
  }
  bw_comm_sum(s->comm, 1, &value[0]);
  bw_comm_max(s->comm, 1, &value[1]);
  return BW_OK;
}

/* What the held particles bear: the internal and contact forces on them, which whoever holds them
 * balances. Collective. */
static bw_status support_of(bw_scene *s, const bw_scene__aim *aim, double value[3])
{
  memset(value, 0, 3 * sizeof *value);
  for (int q = 0; q < s->n_solids; q++) {
    bw_solid *solid = s->solid[q].solid;
    const bw_pd_body *pd = bw_solid_body(solid);
    /* Forces at the start are made by the first step: here they may be still to come. */
    if (!pd->current && s->assembly == NULL) BW_TRY(bw_solid_evaluate(solid));
    for (int k = 0; k < aim->n[q]; k++) {
      const size_t i = (size_t)aim->particle[q][k];
      const double mass = bw_solid_density(solid, i) * bw_solid_volume_of(solid, i);
      for (int d = 0; d < pd->dimension; d++)
        value[d] += mass * (double)(pd->a[d][i] + pd->load.extra[d][i]);
    }
  }
  bw_comm_sum(s->comm, 3, value);
  return BW_OK;
}

/* Farthest cracked particle joined to the origin. Collective. */
static bw_status tip_of(bw_scene *s, const bw_scene_gauge_config *g, const bw_scene__aim *aim,
                        double value[4])
{
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  value[0] = g->origin[0], value[1] = g->origin[1], value[2] = g->origin[2], value[3] = 0.0;
  for (int q = 0; q < s->n_solids; q++) {
    const bw_scene__solid *p = &s->solid[q];
    double ds = HUGE_VAL;
    double *damage = NULL, *own = NULL;
    bw_pd_crack crack = {0};
    bw_status st = BW_ALLOCATE(&damage, p->n);
    BW_THEN(st, BW_ALLOCATE(&own, p->n));
    st = bw_comm_agree(s->comm, st);
    if (st == BW_OK) {
      bw_solid_get_damage(p->solid, damage);
      /* What was cut at the start is no part of the crack that is followed. */
      for (int k = 0; k < aim->n[q]; k++) {
        const int32_t i = aim->particle[q][k];
        ds = fmin(ds, bw_solid_spacing(p->solid, (size_t)i)); /* cracks are in the finest */
        own[i] = p->cut != NULL && p->cut[i] ? 0.0 : damage[i];
      }
    }
    bw_comm_min(s->comm, 1, &ds);
    BW_THEN(st, bw_pd_crack_collect(s->comm, &look, p->n, p->X0, own, &crack));
    BW_THEN(st, bw_pd_crack_join(&crack, g->origin[0], g->origin[1], 3.0 * ds));
    double tip[2];
    const double reach =
        st == BW_OK ? bw_pd_crack_reach(&crack, g->origin[0], g->origin[1], tip) : NAN;
    if (reach > value[3]) value[0] = tip[0], value[1] = tip[1], value[3] = reach;
    bw_pd_crack_release(&crack);
    bw_release(&damage);
    bw_release(&own);
    BW_TRY(st);
  }
  return BW_OK;
}

/* Does the solid hold one of the bodies of a gauge? */
static bool names_solid(const bw_scene *s, const bw_scene_gauge_config *g, int q)
{
  if (g->body[0] == '\0') return true;
  for (int k = 0; k < s->solid[q].n_bodies; k++)
    if (bw_scene__listed(g->body, s->config.bodies[s->solid[q].body[k]].name)) return true;
  return false;
}

static bw_status fragments_of(bw_scene *s, const bw_scene_gauge_config *g, double *count)
{
  *count = 0.0;
  for (int q = 0; q < s->n_solids; q++) {
    if (!names_solid(s, g, q)) continue;
    const bw_pd_interface_config config = bw_pd_interface_config_default();
    bw_pd_fragments pieces = {0};
    /* The coupler has one already. */
    if (s->coupler == NULL && s->interface[q] == NULL)
      BW_TRY(bw_pd_interface_create(s->solid[q].solid, &config, &s->interface[q]));
    bw_pd_interface *surface =
        s->coupler != NULL ? bw_coupler_edit_interface(s->coupler) : s->interface[q];
    const bw_status st = bw_pd_interface_fragments(surface, NULL, &pieces);
    *count += (double)pieces.total;
    bw_pd_fragment_release(&pieces);
    BW_TRY(st);
  }
  return BW_OK;
}

/* Rigid bodies in the books: their own energies in place of those of the particles that follow
 * them, and in place of the work that moves those. Collective. */
static bw_status add_rigid(bw_scene *s, bw_solid_ledger *sum)
{
  for (int q = 0; q < s->n_solids; q++) {
    bw_solid_ledger one;
    if (s->solid[q].n_bodies > 1 || s->rigid_of[s->solid[q].body[0]] < 0) continue;
    BW_TRY(bw_solid_account(s->solid[q].solid, &one));
    sum->kinetic -= one.kinetic;
    sum->external -= one.external;
  }
  const bw_rigid_energy e = bw_rigid_energy_of(s->rigid);
  sum->kinetic += e.kinetic;
  sum->elastic += e.spring;
  sum->contact += e.contact;
  sum->damping += e.rubbed;
  sum->external -= e.weight - s->rigid_weight;
  return BW_OK;
}

/* The books of the solids that a gauge names. Collective. */
static bw_status book_of(bw_scene *s, const bw_scene_gauge_config *g, bw_solid_ledger *sum)
{
  const bool all = g->body[0] == '\0';
  *sum = (bw_solid_ledger){0};
  if (all && s->assembly != NULL) BW_TRY(bw_solid_assembly_account(s->assembly, sum));
  if (all && s->rigid != NULL) BW_TRY(add_rigid(s, sum));
  if (all && s->assembly != NULL) return BW_OK;
  for (int q = 0; q < s->n_solids; q++) {
    bw_solid_ledger one;
    if (!names_solid(s, g, q)) continue;
    BW_TRY(bw_solid_account(s->solid[q].solid, &one));
    sum->kinetic += one.kinetic;
    sum->elastic += one.elastic;
    sum->contact += one.contact;
    sum->fracture += one.fracture;
    sum->damping += one.damping;
    sum->external += one.external;
    sum->plastic += one.plastic;
    sum->regrid += one.regrid;
    sum->broken += one.broken;
  }
  return BW_OK;
}

/* Area and volume of the cracks that loads fill. Collective. */
static bw_status filled_of(bw_scene *s, const bw_scene_gauge_config *g,
                           const bw_scene__quantity *what, double value[])
{
  bw_solid_crack_size size;
  BW_TRY(bw_scene__measure_cracks(s, g->body, &size));
  value[0] = strcmp(what->word, "filled_area") == 0 ? size.area : size.volume;
  return BW_OK;
}

bw_status bw_scene__measure_solid(bw_scene *s, int gauge, const bw_scene__quantity *what,
                                  double value[BW_SCENE__COMPONENTS])
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  const bw_scene__aim *aim = &s->aim[gauge];
  bw_solid_ledger book;
  if (strcmp(what->word, "failure") == 0) return bw_scene__failure(s, g, aim, value, NULL);
  if (strcmp(what->word, "failure_place") == 0) return bw_scene__failure(s, g, aim, NULL, value);
  if (what->source == BW_SCENE__OF_PLACE && what->vector) {
    mean_vector(s, aim, what->word, value);
    return BW_OK;
  }
  if (strcmp(what->word, "damage") == 0) return damage_of(s, aim, value);
  if (strcmp(what->word, "force_on_support") == 0) return support_of(s, aim, value);
  if (strcmp(what->word, "crack_tip") == 0) return tip_of(s, g, aim, value);
  if (strncmp(what->word, "filled_", 7) == 0) return filled_of(s, g, what, value);
  if (strcmp(what->word, "fragments") == 0) return fragments_of(s, g, value);
  /* What is left comes from the books. */
  BW_TRY(book_of(s, g, &book));
  const double energy[8] = {book.kinetic, book.elastic,  book.contact, book.fracture,
                            book.damping, book.external, book.plastic, book.regrid};
  if (strcmp(what->word, "broken_bonds") == 0)
    value[0] = (double)book.broken;
  else
    memcpy(value, energy, sizeof energy);
  return BW_OK;
}
