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

static inline void store(row r, double *p)
{
  memcpy(p, &r, sizeof r);
}

/* Three weights from node `by` = 0, 1, 2 of a window on. */
static inline row window(const double w[3], int by)
{
  if (by == 0) return (row){w[0], w[1], w[2], 0.0};
  return by == 1 ? (row){0.0, w[0], w[1], w[2]} : (row){0.0, 0.0, w[0], w[1]};
}

/* Weights at one position s of one direction: of the kernel, from node `first` on. */
typedef struct {
  double s, w[3];
  int first;
} point_weights;

/* The parabola through the three nodes nearest to s: moments 1, 0, 0. */
static inline point_weights parabola(double s)
{
  /* The middle node is the nearest one: r is at most half a cell. */
  const double nearest = floor(s + 0.5), r = s - nearest;
  return (point_weights){.s = s,
                         .w = {0.5 * r * (r - 1.0), 1.0 - r * r, 0.5 * r * (r + 1.0)},
                         .first = (int)nearest - 1};
}

/* Weights of direction d. The average over the stencil's four edges along a direction of
 * differences is the product of one slope and two means; both ends of a difference are a cell
 * apart, so that the lower end's weights are the upper end's, one node on. Kernels of two nodes
 * would leave the halo with a window of four: there it begins a node lower. */
static inline void combine(const bw_probe *probe, int d, const point_weights *tip,
                           const point_weights *lower, bw_probe__weights *w)
{
  const bw_grid_view *g = probe->g;
  const int highest = g->m[d] + g->halo[d] - PROBE_WIDTH + 1;
  /* The window of four nodes must end within the halo. */
  w->first = lower->first < highest ? lower->first : highest;
  const int by = lower->first - w->first;
  const row down = window(lower->w, by), up = window(lower->w, by + 1);
  /* Mean and difference quotient over one cell, as weights. */
  store(0.5 * (up + down), w->mean);
  store((up - down) * (1.0 / g->spacing[d]), w->slope);
  const point_weights at = probe->profile == BW_PROBE_QUADRATIC ? parabola(tip->s) : *tip;
  store(window(at.w, at.first - w->first), w->at);
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
  double s[LINES][PROBE_BATCH] = {{0.0}}, w[BW_KERNEL_MAX_SUPPORT][LINES][PROBE_BATCH] = {{{0.0}}};
  int first[LINES][PROBE_BATCH];
  /* Places of the whole batch, in cells of this rank. */
  for (size_t i = 0; i < n; i++)
    for (int d = 0; d < dims; d++) {
      const double local = item[i].tip[d] / g->spacing[d] - g->lo[d];
      s[d][i] = fmin(fmax(local, 0.0), (double)g->m[d]);
      s[3 + d][i] = s[d][i] + 0.5;
    }
  /* One call for all, as the kernel's roots are vectorised. */
  bw_kernel_delta_weights(probe->kernel, LINES * PROBE_BATCH, s[0], first[0], w[0][0]);
  for (size_t i = 0; i < n; i++) {
    for (int d = 0; d < dims; d++) {
      /* The lower end of a face's stencil is a centre's place, and the other way round. */
      const int e = 3 + d;
      const point_weights face = {s[d][i], {w[0][d][i], w[1][d][i], w[2][d][i]}, first[d][i]};
      point_weights centre = {s[e][i], {w[0][e][i], w[1][e][i], w[2][e][i]}, first[e][i]};
      combine(probe, d, &centre, &face, &tip[i].w[PROBE_CENTRE][d]);
      /* Half a cell below the face is the centre of one node less. */
      centre.first--;
      combine(probe, d, &face, &centre, &tip[i].w[PROBE_FACE][d]);
    }
    if (dims == 2) tip[i].w[PROBE_CENTRE][2] = tip[i].w[PROBE_FACE][2] = one_cell;
  }
}

static inline const bw_probe__weights *weights_of(const bw_probe__tip *tip, int component, int d)
{
  return &tip->w[d == component ? PROBE_FACE : PROBE_CENTRE][d];
}

/* Offset of the first node of a component's window. */
static inline ptrdiff_t corner_of(const bw_grid_view *g, int component, const bw_probe__tip *tip)
{
  return bw_at(g, weights_of(tip, component, 0)->first, weights_of(tip, component, 1)->first,
               weights_of(tip, component, 2)->first);
}

bw_probe__sample bw_probe__evaluate(const bw_probe *probe, const bw_real *f, int component,
                                    const bw_probe__tip *tip)
{
  const bw_grid_view *g = probe->g;
  const int depth = g->n[2] == 1 ? 1 : PROBE_WIDTH;
  const bw_probe__weights *x = weights_of(tip, component, 0), *y = weights_of(tip, component, 1);
  const bw_probe__weights *z = weights_of(tip, component, 2);
  const bw_real *corner = f + corner_of(g, component, tip);
  row at = {0}, dx = {0}, dy = {0}, dz = {0};
  /* POROUS 3.83, 3.84 and their differences: value and three derivatives share every read. */
  for (int k = 0; k < depth; k++) {
    row at_y = {0}, mean_y = {0}, slope_y = {0};
    /* Along y; x stays a vector until the end. */
    for (int j = 0; j < PROBE_WIDTH; j++) {
      const row v = load_field(corner + k * g->stride[2] + j * g->stride[1]);
      at_y += y->at[j] * v;
      mean_y += y->mean[j] * v;
      slope_y += y->slope[j] * v;
    }
    /* Along z: means in the directions across a difference, its slope along it. */
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

/* Rows of a batch are asked for before the first is needed: tips lie scattered. */
static void fetch(const bw_probe *probe, const bw_real *f, int component, const bw_probe__tip *tip)
{
  const bw_grid_view *g = probe->g;
  const bw_real *corner = f + corner_of(g, component, tip);
  for (int k = 0; k < (g->n[2] == 1 ? 1 : PROBE_WIDTH); k++)
    for (int j = 0; j < PROBE_WIDTH; j++)
      __builtin_prefetch(corner + k * g->stride[2] + j * g->stride[1]);
}

static bw_probe__reply at_tip(const bw_probe *probe, bw_real *const u[3], const bw_real *p,
                              const double n[3], const bw_probe__tip *tip)
{
  const bw_probe__sample s = bw_probe__evaluate(probe, p, 3, tip);
  bw_probe__reply r = {.p = along_normal(&s, n)};
  /* (grad u)^T.n for the linear profile, slopes along n for both. */
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
    /* Weights of the batch, ... */
    bw_probe__weigh(probe, some, item + q, tip);
    /* ... its rows asked for, as tips lie scattered in memory, ... */
    for (size_t i = 0; i < some; i++) {
      fetch(probe, p, 3, &tip[i]);
      for (int c = 0; c < 3 && u[c] != NULL; c++)
        fetch(probe, u[c], c, &tip[i]);
    }
    /* ... and read when they have come. */
    for (size_t i = 0; i < some; i++)
      reply[q + i] = at_tip(probe, u, p, item[q + i].normal, &tip[i]);
  }
}
