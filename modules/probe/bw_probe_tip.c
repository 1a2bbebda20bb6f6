/* Values and gradients at a tip: tensor products of one-dimensional weights. */
#include "probe_internal.h"

#include <math.h>

/* Weights of direction d; returns the lowest local node. The average over the stencil's four
 * edges along a direction of differences is the product of one slope and two means. */
static int weights_of(const bw_probe *probe, const double x[3], int place, int d,
                      bw_probe__weights *w)
{
  const bw_grid_view *g = probe->g;
  const bw_kernel_delta *k = probe->kernel;
  const double h = g->spacing[d];
  const double local = fmin(fmax(x[d] / h - g->lo[d], 0.0), (double)g->m[d]);
  const double s = local + (place == PROBE_CENTRE ? 0.5 : 0.0);
  int first = (int)floor(s - 0.5 - k->radius) + 1;
  if (first > g->m[d] + g->halo[d] - PROBE_WIDTH + 1)
    first = g->m[d] + g->halo[d] - PROBE_WIDTH + 1;
  w->square = 0.0;
  for (int q = 0; q < PROBE_WIDTH; q++) {
    const double r = s - (double)(first + q), above = k->phi(r + 0.5), below = k->phi(r - 0.5);
    w->at[q] = k->phi(r);
    w->mean[q] = 0.5 * (above + below);
    w->slope[q] = (above - below) / h;
    w->square += w->at[q] * r * r * h * h;
  }
  return first;
}

static double dot(const double a[PROBE_WIDTH], const double b[PROBE_WIDTH])
{
  return a[0] * b[0] + a[1] * b[1] + (a[2] * b[2] + a[3] * b[3]);
}

bw_probe__sample bw_probe__evaluate(const bw_probe *probe, const bw_real *f, int component,
                                    const double x[3])
{
  const bw_grid_view *g = probe->g;
  const int depth = g->n[2] == 1 ? 1 : PROBE_WIDTH;
  bw_probe__weights w[3] = {{.at = {0}}, {.at = {0}}, {.at = {1.0}, .mean = {1.0}}};
  int first[3] = {1, 1, 1};
  for (int d = 0; d < (depth == 1 ? 2 : 3); d++)
    first[d] = weights_of(probe, x, d == component ? PROBE_FACE : PROBE_CENTRE, d, &w[d]);

  double sum[4][PROBE_WIDTH] = {{0.0}};
  for (int k = 0; k < depth; k++)
    for (int j = 0; j < PROBE_WIDTH; j++) {
      const bw_real *row = f + bw_at(g, first[0], first[1] + j, first[2] + k);
      const double factor[4] = {w[1].at[j] * w[2].at[k], w[1].mean[j] * w[2].mean[k],
                                w[1].slope[j] * w[2].mean[k], w[1].mean[j] * w[2].slope[k]};
      for (int q = 0; q < PROBE_WIDTH; q++)
        for (int a = 0; a < 4; a++)
          sum[a][q] += factor[a] * (double)row[q];
    }
  bw_probe__sample s = {
      .value = dot(sum[0], w[0].at),
      .grad = {dot(sum[1], w[0].slope), dot(sum[2], w[0].mean), dot(sum[3], w[0].mean)}};
  for (int d = 0; d < 3; d++)
    s.square[d] = w[d].square;
  return s;
}

/* First moments vanish, so of ((x - tip).n)^2 only the squares of each direction remain; its slope
 * is exactly 0, because the two ends of a difference are a whole cell apart: same weights. */
static bw_probe__along along_normal(const bw_probe__sample *s, const double n[3])
{
  bw_probe__along a = {.value = s->value};
  for (int d = 0; d < 3; d++) {
    a.slope += s->grad[d] * n[d];
    a.square += s->square[d] * n[d] * n[d];
  }
  return a;
}

bw_probe__reply bw_probe__at_tip(const bw_probe *probe, bw_real *const u[3], const bw_real *p,
                                 const bw_probe__item *item)
{
  const bw_probe__sample s = bw_probe__evaluate(probe, p, 3, item->tip);
  bw_probe__reply r = {.p = along_normal(&s, item->normal)};
  for (int c = 0; c < 3 && u[c] != NULL; c++) {
    const bw_probe__sample v = bw_probe__evaluate(probe, u[c], c, item->tip);
    r.u[c] = along_normal(&v, item->normal);
    for (int d = 0; d < 3; d++)
      r.gtn[d] += v.grad[d] * item->normal[c]; /* (du_c/dx_d) n_c */
  }
  return r;
}
