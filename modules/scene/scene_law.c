/* Materials of state-based laws: their words, and what a law is asked for. */
#include "bw_solid_words.h"
#include "scene_impl.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool find_elastic(const char *word, bw_pd_material_elastic *out)
{
  for (const bw_config_word *w = bw_solid_elastic_words; w->word != NULL; w++)
    if (strcmp(w->word, word) == 0) {
      *out = (bw_pd_material_elastic)w->value;
      return true;
    }
  return false;
}

static bw_status check_elastic(const bw_scene_material *m)
{
  bw_pd_material_elastic elastic;
  char words[120] = "";
  if (m->elastic[0] == '\0' || find_elastic(m->elastic, &elastic)) return BW_OK;
  size_t n = 0;
  for (const bw_config_word *w = bw_solid_elastic_words; w->word != NULL && n < sizeof words; w++)
    n += (size_t)snprintf(words + n, sizeof words - n, "%s%s", n > 0 ? ", " : "", w->word);
  return BW_FAIL(BW_EINPUT, "materials.%s.elastic = %s: must be one of %s", m->name, m->elastic,
                 words);
}

enum { NUMBERS = 5 };

/* Does something of the material know friction: its flow, or what breaks its bonds? */
static bool breaks_by_friction(const bw_scene_material *m)
{
  return m->breaks == BW_PD_STATE_BREAKS_BY_MOHR_COULOMB || m->breaks == BW_PD_STATE_BREAKS_BY_CONE;
}

/* Numbers that belong to one plastic law must not look as if they did something for another. */
static bw_status check_numbers(const bw_scene_material *m)
{
  static const struct {
    const char *key, *of;
    bool needed;
  } rows[NUMBERS] = {{"cohesion", "drucker_prager", true},
                     {"friction_angle", "drucker_prager", true},
                     {"dilation_angle", "drucker_prager", false},
                     {"yield_stress", "j2", true},
                     {"hardening", "j2", false}};
  const double numbers[NUMBERS] = {m->cohesion, m->friction_angle, m->dilation_angle,
                                   m->yield_stress, m->hardening};
  for (int q = 0; q < NUMBERS; q++) {
    const bool read = strcmp(m->plastic, rows[q].of) == 0 ||
                      (breaks_by_friction(m) && strcmp(rows[q].key, "friction_angle") == 0);
    BW_REQUIRE(read || isnan(numbers[q]), BW_EINPUT,
               "materials.%s.%s = %g: it belongs to plastic: %s; leave it out", m->name,
               rows[q].key, numbers[q], rows[q].of);
    BW_REQUIRE(!read || !rows[q].needed || !isnan(numbers[q]), BW_EINPUT,
               "materials.%s.%s is missing: plastic: %s needs it", m->name, rows[q].key,
               rows[q].of);
  }
  /* With NaN for what is left out: no dilation. */
  BW_REQUIRE(!(m->dilation_angle > m->friction_angle), BW_EINPUT,
             "materials.%s.dilation_angle = %g is above friction_angle = %g: such a material would "
             "give energy; take at most the friction",
             m->name, m->dilation_angle, m->friction_angle);
  return BW_OK;
}

const bw_scene_material *bw_scene__material_of(const bw_scene_config *c, int b)
{
  const bw_scene_body *body = &c->bodies[b];
  int m = bw_scene__material_named(c, body->material);
  for (int k = 0; k < body->n_shape && m < 0; k++)
    m = bw_scene__material_named(c, body->shape[k].material);
  return m >= 0 ? &c->materials[m] : NULL;
}

bool bw_scene__corrects_surfaces(const bw_scene_config *c)
{
  bool state = false;
  for (int b = 0; b < c->n_bodies; b++) {
    const bw_scene_material *m = bw_scene__material_of(c, b);
    if (!bw_scene__deforms(&c->bodies[b]) || m == NULL) continue;
    if (strcmp(m->law, "bond") == 0) return true;
    state = true;
  }
  return !state;
}

bool bw_scene__breaks_by_stretch(const bw_scene_material *m)
{
  return m->breaks == INT_MIN || m->breaks == BW_PD_STATE_BREAKS_BY_STRETCH;
}

/* Keys of one law must not look as if they did something in another. */
static bw_status check_keys(const bw_scene_material *m)
{
  const bool stretch = bw_scene__breaks_by_stretch(m);
  const struct {
    const char *key, *of;
    bool given;
  } rows[] = {{"influence", "ordinary", m->influence != INT_MIN},
              {"weight", "correspondence", m->weight != INT_MIN},
              {"breaks", "correspondence", m->breaks != INT_MIN},
              {"cone", "correspondence", m->cone != INT_MIN},
              {"stabilisation", "correspondence", !isnan(m->stabilisation)}};
  for (size_t q = 0; q < sizeof rows / sizeof *rows; q++)
    BW_REQUIRE(!rows[q].given || strcmp(m->law, rows[q].of) == 0, BW_EINPUT,
               "materials.%s.%s: it belongs to law: %s, this is %s; leave it out", m->name,
               rows[q].key, rows[q].of, m->law);
  BW_REQUIRE(stretch == isnan(m->limit), BW_EINPUT,
             "materials.%s.limit is %s: it belongs to breaks other than stretch, and they to it",
             m->name, stretch ? "given" : "missing");
  return BW_OK;
}

bw_status bw_scene__check_state(const bw_scene_material *m)
{
  const bool correspondence = strcmp(m->law, "correspondence") == 0;
  BW_REQUIRE(
      m->elastic[0] == '\0' || correspondence, BW_EINPUT,
      "materials.%s.elastic = %s: it belongs to law: correspondence, this is %s; leave it out",
      m->name, m->elastic, m->law);
  BW_REQUIRE(
      m->plastic[0] == '\0' || correspondence, BW_EINPUT,
      "materials.%s.plastic = %s: it belongs to law: correspondence, this is %s; leave it out",
      m->name, m->plastic, m->law);
  BW_TRY(check_elastic(m));
  BW_REQUIRE(m->plastic[0] == '\0' || strcmp(m->plastic, "drucker_prager") == 0 ||
                 strcmp(m->plastic, "j2") == 0,
             BW_EINPUT, "materials.%s.plastic = %s: must be one of drucker_prager, j2", m->name,
             m->plastic);
  BW_REQUIRE(!correspondence || !isnan(m->poisson_ratio), BW_EINPUT,
             "materials.%s.poisson_ratio is missing: law: correspondence has none of its own",
             m->name);
  BW_TRY(check_keys(m));
  return check_numbers(m);
}

/* Where a material yields, as the keys of its plastic law say. */
static bw_pd_material_yield yield_of(const bw_scene *s, const bw_scene_material *m)
{
  const double degree = acos(-1.0) / 180.0;
  const double dilation = isnan(m->dilation_angle) ? 0.0 : m->dilation_angle;
  /* In plane strain the cones that are Mohr-Coulomb's there. */
  const bw_pd_material_cone cone = m->cone != INT_MIN ? (bw_pd_material_cone)m->cone
                                   : s->config.plane != BW_SCENE_STRAIN
                                       ? BW_PD_MATERIAL_COMPRESSION_CONE
                                   : dilation > 0.0 ? BW_PD_MATERIAL_PLANE_ASSOCIATED
                                                    : BW_PD_MATERIAL_PLANE_ISOCHORIC;
  if (strcmp(m->plastic, "j2") == 0)
    return bw_pd_material_j2(m->yield_stress, isnan(m->hardening) ? 0.0 : m->hardening);
  return bw_pd_material_drucker_prager(cone, m->cohesion, m->friction_angle * degree,
                                       dilation * degree);
}

/* Options that a lattice has one of: those of its first material that deforms. */
static void set_options(const bw_scene_material *m, bw_pd_state_mixed_options *room)
{
  bw_pd_state_correspondence_options *o = &room->correspondence;
  if (m->influence != INT_MIN) room->ordinary.influence = (bw_pd_state_influence)m->influence;
  if (m->weight != INT_MIN) o->weight = (bw_pd_state_weight)m->weight;
  if (m->breaks != INT_MIN) o->breaks = (bw_pd_state_breaks)m->breaks;
  if (!isnan(m->limit)) o->limit = m->limit;
  if (!isnan(m->stabilisation)) o->stabilisation = m->stabilisation;
  if (breaks_by_friction(m)) o->friction = m->friction_angle * acos(-1.0) / 180.0;
}

/* Have two materials of a lattice the same of them? */
static bool agree(const bw_scene_material *a, const bw_scene_material *b)
{
  const bool limits = (isnan(a->limit) && isnan(b->limit)) || a->limit == b->limit;
  const bool same =
      (isnan(a->stabilisation) && isnan(b->stabilisation)) || a->stabilisation == b->stabilisation;
  const bool friction = !breaks_by_friction(a) || a->friction_angle == b->friction_angle;
  return a->influence == b->influence && a->weight == b->weight && a->breaks == b->breaks &&
         strcmp(a->elastic, b->elastic) == 0 && limits && same && friction;
}

/* What a group adds to the options; `first` of its law's materials gives what a lattice has one of.
 * */
static bw_status add_group(const bw_scene *s, const bw_scene_material *m, int g,
                           const bw_scene_material **first, bw_pd_state_mixed_options *room)
{
  if (*first == NULL) set_options(*first = m, room);
  BW_REQUIRE(agree(*first, m), BW_EINPUT,
             "materials.%s: another material of the same lattice, %s, differs in elastic, "
             "influence, weight, breaks, limit or stabilisation; a lattice has one of each",
             m->name, (*first)->name);
  if (m->elastic[0] != '\0') (void)find_elastic(m->elastic, &room->correspondence.elastic);
  if (m->plastic[0] != '\0') room->correspondence.yield[g] = yield_of(s, m);
  return BW_OK;
}

bw_status bw_scene__law_options(const bw_scene *s, const bw_scene__solid *q,
                                bw_pd_state_mixed_options *room, const void **options)
{
  const bw_scene_material *first[2] = {NULL, NULL}; /* ordinary, correspondence */
  bool still[BW_PD_GROUPS] = {false};
  *options = NULL;
  *room = bw_pd_state_mixed_options_default();
  for (int g = 0; g < q->n_groups; g++) {
    /* What does not deform is as stiff as what it holds, and does not yield. */
    still[g] = !bw_scene__deforms(&s->config.bodies[q->body_of[g]]);
    if (still[g]) continue;
    const bw_scene_material *m = &s->config.materials[q->material_of[g]];
    const bool correspondence = strcmp(m->law, "correspondence") == 0;
    if (!correspondence && strcmp(m->law, "ordinary") != 0) return BW_OK;
    room->correspondence_group[g] = correspondence;
    BW_TRY(add_group(s, m, g, &first[correspondence], room));
  }
  for (int g = 0; g < q->n_groups; g++)
    if (still[g]) room->correspondence_group[g] = first[0] == NULL;
  if (first[0] != NULL && first[1] != NULL)
    *options = room;
  else if (first[0] != NULL)
    *options = &room->ordinary;
  else if (first[1] != NULL)
    *options = &room->correspondence;
  return BW_OK;
}
