/* Values and gradients at a tip: tensor products of one-dimensional weights. */
#include "probe_internal.h"

#include <math.h>

/* Parabola through the three nodes nearest to s: moments 1, 0, 0. */
static void lagrange(double s, int first, double at[PROBE_WIDTH])
{
  const int nearest = (int)floor(s + 0.5);
  const double r = s - nearest, value[3] = {0.5 * r * (r - 1.0), 1.0 - r * r, 0.5 * r * (r + 1.0)};
  for (int q = 0; q < PROBE_WIDTH; q++) {
    const int node = first + q - nearest + 1;
    at[q] = node >= 0 && node < 3 ? value[node] : 0.0;
  }
}

/* Weights of direction d. The average over the stencil's four edges along a direction of
 * differences is the product of one slope and two means; both ends of a difference are a cell
 * apart, so that the lower end's weights are the upper end's, one node on. */
static void weights_of(const bw_probe *probe, const double x[3], int place, int d,
                       bw_probe__weights *w)
{
  const bw_grid_view *g = probe->g;
  const bw_kernel_delta *k = probe->kernel;
  const double h = g->spacing[d];
  const double local = fmin(fmax(x[d] / h - g->lo[d], 0.0), (double)g->m[d]);
  const double s = local + (place == PROBE_CENTRE ? 0.5 : 0.0);
  const int highest = g->m[d] + g->halo[d] - PROBE_WIDTH + 1;
  int first = (int)floor(s - 0.5 - k->radius) + 1;
  if (first > highest) first = highest;
  double end[PROBE_WIDTH + 1];
  for (int q = 0; q <= PROBE_WIDTH; q++)
    end[q] = k->phi(s + 0.5 - (double)(first + q));
  w->first = first;
  for (int q = 0; q < PROBE_WIDTH; q++) {
    w->at[q] = k->phi(s - (double)(first + q));
    w->mean[q] = 0.5 * (end[q] + end[q + 1]);
    w->slope[q] = (end[q] - end[q + 1]) / h;
  }
  if (probe->profile == BW_PROBE_QUADRATIC) lagrange(s, first, w->at);
}

void bw_probe__weigh(const bw_probe *probe, const double x[3], bw_probe__tip *tip)
{
  static const bw_probe__weights one_cell = {.first = 1, .at = {1.0}, .mean = {1.0}};
  const int dims = probe->g->n[2] == 1 ? 2 : 3;
  for (int place = 0; place < PROBE_PLACES; place++) {
    for (int d = 0; d < dims; d++)
      weights_of(probe, x, place, d, &tip->w[place][d]);
    if (dims == 2) tip->w[place][2] = one_cell;
  }
}

/* Four nodes of x at once. Explicit, because compilers give up on rows of four in nested loops. */
typedef double row __attribute__((vector_size(PROBE_WIDTH * sizeof(double))));

static inline row load(const bw_real *p)
{
  return (row){(double)p[0], (double)p[1], (double)p[2], (double)p[3]};
}

static double dot(row a, const double b[PROBE_WIDTH])
{
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

bw_probe__sample bw_probe__evaluate(const bw_probe *probe, const bw_real *f, int component,
                                    const bw_probe__tip *tip)
{
  const bw_grid_view *g = probe->g;
  const int depth = g->n[2] == 1 ? 1 : PROBE_WIDTH;
  const bw_probe__weights *w[3];
  for (int d = 0; d < 3; d++)
    w[d] = &tip->w[d == component ? PROBE_FACE : PROBE_CENTRE][d];

  row at = {0}, dx = {0}, dy = {0}, dz = {0};
  for (int k = 0; k < depth; k++)
    for (int j = 0; j < PROBE_WIDTH; j++) {
      const row v = load(f + bw_at(g, w[0]->first, w[1]->first + j, w[2]->first + k));
      at += w[1]->at[j] * w[2]->at[k] * v;
      dx += w[1]->mean[j] * w[2]->mean[k] * v;
      dy += w[1]->slope[j] * w[2]->mean[k] * v;
      dz += w[1]->mean[j] * w[2]->slope[k] * v;
    }
  return (bw_probe__sample){
      .value = dot(at, w[0]->at),
      .grad = {dot(dx, w[0]->slope), dot(dy, w[0]->mean), dot(dz, w[0]->mean)}};
}

static bw_probe__along along_normal(const bw_probe__sample *s, const double n[3])
{
  bw_probe__along a = {.value = s->value};
  for (int d = 0; d < 3; d++)
    a.slope += s->grad[d] * n[d];
  return a;
}

bw_probe__reply bw_probe__at_tip(const bw_probe *probe, bw_real *const u[3], const bw_real *p,
                                 const bw_probe__item *item)
{
  bw_probe__tip tip;
  bw_probe__weigh(probe, item->tip, &tip);
  const bw_probe__sample s = bw_probe__evaluate(probe, p, 3, &tip);
  bw_probe__reply r = {.p = along_normal(&s, item->normal)};
  for (int c = 0; c < 3 && u[c] != NULL; c++) {
    const bw_probe__sample v = bw_probe__evaluate(probe, u[c], c, &tip);
    r.u[c] = along_normal(&v, item->normal);
    for (int d = 0; d < 3; d++)
      r.gtn[d] += v.grad[d] * item->normal[c]; /* (du_c/dx_d) n_c */
  }
  return r;
}
