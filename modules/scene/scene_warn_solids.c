/* Where a solid will be poor, said before it runs. */
#include "scene_impl.h"

#include <math.h>
#include <string.h>

/* Tip of a cantilever ten times as long as high, plane stress, nu = 1/3, slowly loaded, over that
 * of Timoshenko's beam, of 2, 3 and 4 particles across. */
static const struct {
  const char *law;
  double horizon_ratio; /* up to this one */
  const char *bends;
} thin[] = {{"bond", HUGE_VAL, "2.6, 1.5, 1.3"},
            {"ordinary", HUGE_VAL, "1.04, 1.11, 1.07"},
            {"correspondence", 1.75, "0.82, 0.96, 0.99"},
            {"correspondence", HUGE_VAL, "0.30, 0.76, 0.98"}};

void bw_scene__warn_layers(const bw_scene *s, int b, double layers, bw_log *log)
{
  const bw_scene_material *m = bw_scene__material_of(&s->config, b);
  size_t q = 0;
  if (!(layers < 3.5) || m == NULL) return;
  while (strcmp(thin[q].law, m->law) != 0 ||
         s->config.numerics.horizon_ratio > thin[q].horizon_ratio)
    if (++q == sizeof thin / sizeof *thin) return;
  bw_log_warn(log,
              "bodies.%s is %.2g particles thick: bending and cracks need four or more (beams of "
              "2, 3, 4 bent %s times as much as they should); take a smaller spacing",
              s->config.bodies[b].name, layers, thin[q].bends);
}

/* The limits of bonds of state-based laws are from a table of what cracks cost. */
static void warn_of_cracks(const bw_scene *s, int b, bw_log *log)
{
  enum { MOST_PLANE = 4, MOST_SPACE = 3 };
  static const double least_nu = -0.2, most_nu = 0.45;
  const bw_scene_body *body = &s->config.bodies[b];
  const bw_scene_material *m = bw_scene__material_of(&s->config, b);
  if (body->motion != BW_SCENE_BREAKABLE || m == NULL) return;
  if (strcmp(m->law, "bond") == 0 || !bw_scene__breaks_by_stretch(m)) return;
  /* Small strains of plane stress are those of plane strain with this one. */
  const bool stress = s->config.plane == BW_SCENE_STRESS;
  const double nu = stress ? m->poisson_ratio / (1 + m->poisson_ratio) : m->poisson_ratio;
  const int most = s->planar ? MOST_PLANE : MOST_SPACE;
  if (s->config.numerics.horizon_ratio > most)
    bw_log_warn(log,
                "numerics.horizon_ratio = %g: what cracks of law %s cost was measured from 2 to "
                "%d and is taken from there (law ordinary at 6 in a plane: 13 %% less than asked)",
                s->config.numerics.horizon_ratio, m->law, most);
  if (nu < least_nu || nu > most_nu)
    bw_log_warn(log,
                "materials.%s.poisson_ratio = %g: what cracks of law %s cost was measured from %g "
                "to %g%s and is taken from there",
                m->name, m->poisson_ratio, m->law, least_nu, most_nu,
                stress ? " (of nu/(1 + nu))" : "");
}

/* Does a load drive particles of this body? */
static bool is_driven(const bw_scene_config *c, const bw_scene_body *body)
{
  for (int k = 0; k < c->n_loads; k++)
    if (c->loads[k].kind == BW_SCENE_VELOCITY && strcmp(c->loads[k].on, body->name) == 0)
      return true;
  return false;
}

/* A specimen that is held at one end and drawn at the other bears the same on both. */
static void warn_of_supports(const bw_scene *s, const bw_scene_gauge_config *g, bw_log *log)
{
  const int b = bw_scene__body_named(&s->config, g->body);
  if (!bw_scene__listed(g->of, "force_on_support") || g->has_region) return;
  if (b < 0 || bw_scene__given(g->nearest)) return;
  const bw_scene_body *body = &s->config.bodies[b];
  if (body->n_held > 0 && is_driven(&s->config, body))
    bw_log_warn(log,
                "gauges.%s: the held and the driven particles of %s are added up, and at rest "
                "bear nothing together; give a region around one of them",
                g->name, body->name);
}

void bw_scene__warn_solids(const bw_scene *s, bw_log *log)
{
  for (int b = 0; b < s->config.n_bodies; b++)
    warn_of_cracks(s, b, log);
  for (int k = 0; k < s->config.n_gauges; k++)
    warn_of_supports(s, &s->config.gauges[k], log);
}
