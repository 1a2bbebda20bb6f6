/* Values and gradients at a tip: tensor products of one-dimensional weights. */
#include "probe_internal.h"

#include <math.h>
#include <string.h>

/* Four nodes of x at once. Explicit, because compilers give up on rows of four in nested loops. */
typedef double row __attribute__((vector_size(PROBE_WIDTH * sizeof(double))));

static inline row load(const double *p)
{
  row r;
  memcpy(&r, p, sizeof r);
  return r;
}

static inline row load_field(const bw_real *p)
{
  return (row){(double)p[0], (double)p[1], (double)p[2], (double)p[3]};
}

static inline double sum(row a)
{
  return (a[0] + a[1]) + (a[2] + a[3]);
}

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

/* The kernel's weights at one position of one direction. */
typedef struct {
  double s, w[BW_KERNEL_MAX_SUPPORT];
  int first;
} point_weights;

/* Weights of direction d. The average over the stencil's four edges along a direction of
 * differences is the product of one slope and two means; both ends of a difference are a cell
 * apart, so that the lower end's weights are the upper end's, one node on. */
static void combine(const bw_probe *probe, int d, const point_weights *tip,
                    const point_weights *lower, bw_probe__weights *w)
{
  const bw_grid_view *g = probe->g;
  const int support = probe->kernel->support, highest = g->m[d] + g->halo[d] - PROBE_WIDTH + 1;
  const double per_h = 1.0 / g->spacing[d];
  double ends[2 * PROBE_WIDTH] = {0.0}; /* node first + q: upper end ends[q], lower ends[q + 1] */
  w->first = lower->first < highest ? lower->first : highest;
  for (int q = 0; q < support; q++)
    ends[1 + lower->first - w->first + q] = lower->w[q];
  const row up = load(ends), down = load(ends + 1);
  const row mean = 0.5 * (up + down), slope = per_h * (up - down);
  memcpy(w->mean, &mean, sizeof mean);
  memcpy(w->slope, &slope, sizeof slope);
  memset(w->at, 0, sizeof w->at);
  if (probe->profile == BW_PROBE_QUADRATIC)
    lagrange(tip->s, w->first, w->at);
  else
    memcpy(w->at + (tip->first - w->first), tip->w, (size_t)support * sizeof *w->at);
}

/* Of a tip the faces sit at s, the centres at s + 1/2; their stencils' lower ends half a cell
 * below. The weights at s and s + 1/2 are those at all four, up to a whole node. */
void bw_probe__weigh(const bw_probe *probe, size_t n, const bw_probe__item item[],
                     bw_probe__tip tip[])
{
  static const bw_probe__weights one_cell = {.first = 1, .at = {1.0}, .mean = {1.0}};
  enum { LINES = 6 };
  const bw_grid_view *g = probe->g;
  const int dims = g->n[2] == 1 ? 2 : 3;
  double s[LINES][PROBE_BATCH] = {{0.0}}, w[BW_KERNEL_MAX_SUPPORT][LINES][PROBE_BATCH];
  int first[LINES][PROBE_BATCH];
  for (size_t i = 0; i < n; i++)
    for (int d = 0; d < dims; d++) {
      const double local = item[i].tip[d] / g->spacing[d] - g->lo[d];
      s[d][i] = fmin(fmax(local, 0.0), (double)g->m[d]);
      s[3 + d][i] = s[d][i] + 0.5;
    }
  bw_kernel_delta_weights(probe->kernel, LINES * PROBE_BATCH, s[0], first[0], w[0][0]);
  for (size_t i = 0; i < n; i++) {
    for (int d = 0; d < dims; d++) {
      point_weights face = {.s = s[d][i], .first = first[d][i]};
      point_weights centre = {.s = s[3 + d][i], .first = first[3 + d][i]};
      for (int q = 0; q < probe->kernel->support; q++)
        face.w[q] = w[q][d][i], centre.w[q] = w[q][3 + d][i];
      combine(probe, d, &centre, &face, &tip[i].w[PROBE_CENTRE][d]);
      centre.first--;
      combine(probe, d, &face, &centre, &tip[i].w[PROBE_FACE][d]);
    }
    if (dims == 2) tip[i].w[PROBE_CENTRE][2] = tip[i].w[PROBE_FACE][2] = one_cell;
  }
}

bw_probe__sample bw_probe__evaluate(const bw_probe *probe, const bw_real *f, int component,
                                    const bw_probe__tip *tip)
{
  const bw_grid_view *g = probe->g;
  const int depth = g->n[2] == 1 ? 1 : PROBE_WIDTH;
  const bw_probe__weights *x = &tip->w[component == 0 ? PROBE_FACE : PROBE_CENTRE][0];
  const bw_probe__weights *y = &tip->w[component == 1 ? PROBE_FACE : PROBE_CENTRE][1];
  const bw_probe__weights *z = &tip->w[component == 2 ? PROBE_FACE : PROBE_CENTRE][2];
  const bw_real *corner = f + bw_at(g, x->first, y->first, z->first);
  row at = {0}, dx = {0}, dy = {0}, dz = {0};
  for (int k = 0; k < depth; k++) {
    row at_y = {0}, mean_y = {0}, slope_y = {0};
    for (int j = 0; j < PROBE_WIDTH; j++) {
      const row v = load_field(corner + k * g->stride[2] + j * g->stride[1]);
      at_y += y->at[j] * v;
      mean_y += y->mean[j] * v;
      slope_y += y->slope[j] * v;
    }
    at += z->at[k] * at_y;
    dx += z->mean[k] * mean_y;
    dy += z->mean[k] * slope_y;
    dz += z->slope[k] * mean_y;
  }
  return (bw_probe__sample){
      .value = sum(at * load(x->at)),
      .grad = {sum(dx * load(x->slope)), sum(dy * load(x->mean)), sum(dz * load(x->mean))}};
}

static bw_probe__along along_normal(const bw_probe__sample *s, const double n[3])
{
  bw_probe__along a = {.value = s->value};
  for (int d = 0; d < 3; d++)
    a.slope += s->grad[d] * n[d];
  return a;
}

static bw_probe__reply at_tip(const bw_probe *probe, bw_real *const u[3], const bw_real *p,
                              const double n[3], const bw_probe__tip *tip)
{
  const bw_probe__sample s = bw_probe__evaluate(probe, p, 3, tip);
  bw_probe__reply r = {.p = along_normal(&s, n)};
  for (int c = 0; c < 3 && u[c] != NULL; c++) {
    const bw_probe__sample v = bw_probe__evaluate(probe, u[c], c, tip);
    r.u[c] = along_normal(&v, n);
    for (int d = 0; d < 3; d++)
      r.gtn[d] += v.grad[d] * n[c]; /* (du_c/dx_d) n_c */
  }
  return r;
}

void bw_probe__at_tips(const bw_probe *probe, bw_real *const u[3], const bw_real *p, size_t n,
                       const bw_probe__item item[], bw_probe__reply reply[])
{
  bw_probe__tip tip[PROBE_BATCH];
  for (size_t q = 0; q < n; q += PROBE_BATCH) {
    const size_t some = n - q < PROBE_BATCH ? n - q : PROBE_BATCH;
    bw_probe__weigh(probe, some, item + q, tip);
    for (size_t i = 0; i < some; i++)
      reply[q + i] = at_tip(probe, u, p, item[q + i].normal, &tip[i]);
  }
}
