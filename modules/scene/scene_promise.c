/* What a setting of `accuracy` has been measured to give: the largest error over the scenes of a
 * kind with known answers, on the file's grid and on one twice as fine where that errs more
 * (tools/trade.py, docs/trade.md, docs/verification/trade). None is a bound for another scene. */
#include "scene_impl.h"

#include <math.h>
#include <string.h>

typedef enum { FIXED_IN_FLOW, DEFORMS_IN_FLOW, BONDS_ALONE, PARTICLES_ALONE, OTHER } kind;

typedef struct {
  const char *what;
  double error[3]; /* quick, standard, careful [-] */
  double fine;     /* cells or particles across what is thin, the most of the scenes; 0: none is */
} measured;

static const measured scenes[] = {
    [FIXED_IN_FLOW] = {"drags of a cylinder at Re 20 and of an array in slow flow",
                       {0.021, 0.021, 0.021},
                       15.0},
    [DEFORMS_IN_FLOW] = {"the tip of a plate bent by a stream", {0.067, 0.067, 0.067}, 8.0},
    [BONDS_ALONE] = {"deflection and frequency of clamped beams", {0.038, 0.038, 0.038}, 20.0},
    [PARTICLES_ALONE] = {
        "the front of a dam break of 20 particles' depth", {0.038, 0.038, 0.038}, 0.0}};

static kind kind_of(const bw_scene_config *c)
{
  bool bonds = true;
  if (bw_scene__has_particles(c)) return c->n_bodies == 0 ? PARTICLES_ALONE : OTHER;
  for (int q = 0; q < c->n_materials; q++)
    bonds = bonds && strcmp(c->materials[q].law, "bond") == 0;
  if (bw_scene__any_rigid(c) || !bonds || c->n_bodies == 0) return OTHER;
  if (!bw_scene__has_fluid(c)) return bw_scene__any_deforms(c) ? BONDS_ALONE : OTHER;
  return bw_scene__any_deforms(c) ? DEFORMS_IN_FLOW : FIXED_IN_FLOW;
}

/* Cells, or particles of what deforms, across the thinnest body. */
static double fineness(const bw_scene *s)
{
  const bw_scene_config *c = &s->config;
  double least = HUGE_VAL;
  for (int b = 0; b < c->n_bodies; b++) {
    bw_scene__shapes shapes;
    const bool solid = bw_scene__deforms(&c->bodies[b]);
    if (solid != bw_scene__any_deforms(c)) continue;
    const bw_status st = bw_scene__shapes_make(c, b, &shapes);
    const double unit = solid ? c->bodies[b].spacing : bw_grid_look(s->grid)->spacing[1];
    for (int d = 0; st == BW_OK && d < (s->planar ? 2 : 3); d++)
      least = fmin(least, (shapes.upper[d] - shapes.lower[d]) / unit);
    bw_scene__shapes_release(&shapes);
  }
  return least;
}

void bw_scene__promise(const bw_scene *s, FILE *out)
{
  const kind k = kind_of(&s->config);
  if (k == OTHER) {
    fprintf(out, "its error was not measured on a scene of this kind");
    return;
  }
  const double error = 100.0 * scenes[k].error[s->config.accuracy];
  fprintf(out, "error measured: %.2g %% in %s", error, scenes[k].what);
  const double across = scenes[k].fine > 0.0 ? fineness(s) : 0.0;
  if (across < 0.99 * scenes[k].fine)
    fprintf(out, "; this scene is coarser, %.2g across what is thin instead of %g", across,
            scenes[k].fine);
  else if (across > 1.01 * scenes[k].fine)
    fprintf(out, " with %g across what is thin; here %.3g", scenes[k].fine, across);
}
