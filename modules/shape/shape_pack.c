/* Random sequential addition. */
#include "bw_memory.h"
#include "bw_shape_pack.h"

#include <gsl/gsl_rng.h>
#include <limits.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

bw_shape_pack_config bw_shape_pack_config_default(void)
{
  return (bw_shape_pack_config){.lower = {NAN, NAN, NAN},
                                .upper = {NAN, NAN, NAN},
                                .radius_min = NAN,
                                .radius_max = NAN,
                                .fraction = NAN,
                                .seed = 1,
                                .max_attempts = 100000};
}

static double ball_volume(const bw_shape_pack_config *c, double r)
{
  return c->planar ? PI * r * r : 4.0 / 3 * PI * r * r * r;
}

static int dims_of(const bw_shape_pack_config *c)
{
  return c->planar ? 2 : 3;
}

static bw_status check(const bw_shape_pack_config *c, double *box)
{
  *box = 1;
  BW_REQUIRE(c->radius_min > 0 && isfinite(c->radius_max) && c->radius_max >= c->radius_min,
             BW_EINPUT, "pack: radius_min = %g, radius_max = %g must be positive and in order",
             c->radius_min, c->radius_max);
  BW_REQUIRE(isfinite(c->gap), BW_EINPUT, "pack: gap = %g is not finite", c->gap);
  for (int d = 0; d < dims_of(c); d++) {
    BW_REQUIRE(isfinite(c->lower[d]) && isfinite(c->upper[d]) && c->upper[d] > c->lower[d],
               BW_EINPUT, "pack: lower[%d] = %g has to be below upper[%d] = %g", d, c->lower[d], d,
               c->upper[d]);
    *box *= c->upper[d] - c->lower[d];
    BW_REQUIRE(!c->periodic[d] || c->upper[d] - c->lower[d] > 2 * c->radius_max + c->gap, BW_EINPUT,
               "pack: the periodic side %d is %g long; a ball of radius %g would meet itself", d,
               c->upper[d] - c->lower[d], c->radius_max);
  }
  BW_REQUIRE(c->fraction > 0 && isfinite(c->fraction), BW_EINPUT,
             "pack: fraction = %g must be positive", c->fraction);
  BW_REQUIRE(c->max_attempts > 0, BW_EINPUT, "pack: max_attempts = %d must be positive",
             c->max_attempts);
  BW_REQUIRE(c->fraction * *box / ball_volume(c, c->radius_min) < INT_MAX / 64, BW_EINPUT,
             "pack: balls of radius %g are too many for this box", c->radius_min);
  return BW_OK;
}

/* Is the ball clear of the first n? */
static bool clear_of(const bw_shape_pack_config *c, const bw_shape *ball, int n,
                     const bw_shape *all)
{
  for (int q = 0; q < n; q++) {
    /* Centres nearer than both radii and the gap touch. */
    const double reach = ball->radius + all[q].radius + c->gap;
    double squared = 0;
    for (int d = 0; d < dims_of(c); d++) {
      double z = fabs(ball->centre[d] - all[q].centre[d]);
      const double side = c->upper[d] - c->lower[d];
      /* The nearest image along each side. */
      if (c->periodic[d] && z > 0.5 * side) z = side - z;
      squared += z * z;
    }
    if (reach > 0 && squared < reach * reach) return false;
  }
  return true;
}

static bool place(const bw_shape_pack_config *c, gsl_rng *rng, int n, bw_shape *all)
{
  /* The radius is drawn once; attempts move the ball, or small ones would be preferred. */
  const double span = c->radius_max - c->radius_min;
  bw_shape ball = {.kind = BW_SHAPE_SPHERE, .radius = c->radius_min + span * gsl_rng_uniform(rng)};
  for (int attempt = 0; attempt < c->max_attempts; attempt++) {
    for (int d = 0; d < dims_of(c); d++)
      ball.centre[d] = c->lower[d] + (c->upper[d] - c->lower[d]) * gsl_rng_uniform(rng);
    if (!clear_of(c, &ball, n, all)) continue;
    all[n] = ball;
    return true;
  }
  return false;
}

/* Images of ball q over the periodic sides it reaches across, after the first n; returns n. */
static int images(const bw_shape_pack_config *c, int q, int n, bw_shape *all)
{
  /* Which sides it reaches across, and so where its image is. */
  int direction[3] = {0};
  for (int d = 0; d < dims_of(c); d++) {
    if (!c->periodic[d]) continue;
    if (all[q].centre[d] - all[q].radius < c->lower[d]) direction[d] = 1;
    if (all[q].centre[d] + all[q].radius > c->upper[d]) direction[d] = -1;
  }
  /* A side, an edge or a corner: every combination of these directions is an image. */
  for (int corner = 1; corner < 8; corner++) {
    bw_shape image = all[q];
    bool real = true;
    for (int d = 0; d < 3; d++) {
      if (!(corner >> d & 1)) continue;
      real = real && direction[d] != 0;
      image.centre[d] += direction[d] * (c->upper[d] - c->lower[d]);
    }
    if (real) all[n++] = image;
  }
  return n;
}

bw_status bw_shape_pack_spheres(const bw_shape_pack_config *c, int *balls, int *count,
                                bw_shape **shape)
{
  double box, filled = 0;
  bw_shape *all = NULL;
  *balls = *count = 0;
  *shape = NULL;
  BW_TRY(check(c, &box));
  /* The smallest balls would be the most; each may have seven images over periodic sides. */
  const double most = ceil(c->fraction * box / ball_volume(c, c->radius_min)) + 1;
  BW_TRY(BW_ALLOCATE(&all, 8 * (size_t)most));
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  bw_status st = rng != NULL ? BW_OK : BW_FAIL(BW_EMEM, "pack: no memory for random numbers");
  if (rng != NULL) gsl_rng_set(rng, (unsigned long)c->seed);
  int n = 0;
  /* The fraction is reached by the ball that steps over it. */
  while (st == BW_OK && filled < c->fraction * box) {
    if (place(c, rng, n, all))
      filled += ball_volume(c, all[n++].radius);
    else
      st = BW_FAIL(BW_EINPUT,
                   "pack: no place for a ball after %d attempts at the fraction %.4f, %.4f was "
                   "asked; random addition ends near 0.38 in space and 0.54 in the plane",
                   c->max_attempts, filled / box, c->fraction);
  }
  if (rng != NULL) gsl_rng_free(rng);
  if (st != BW_OK) {
    bw_release(&all);
    return st;
  }
  /* Images come after the balls, so that those are the first of the list. */
  *balls = *count = n;
  for (int q = 0; q < n; q++)
    *count = images(c, q, *count, all);
  *shape = all;
  return BW_OK;
}
