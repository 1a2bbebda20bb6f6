/* The surface of a mask: found once, from all of its voxels.
 *
 * Voxels say in or out, in steps. Their mean with the weights 1 4 6 4 1 along each axis, of
 * variance one voxel, falls through a plane surface as the normal distribution does, so that its
 * inverse gives back the distance: of any plane to a tenth of a voxel or two, staircase or not.
 * This holds within a voxel and a half; from there on a node takes the nearest of the places of
 * the surface that its neighbours know. What is curved comes out too small by the mean: all
 * distances are shifted by the one length that makes the volume that of the voxels. Edges are
 * rounded by a voxel. */
#include "shape_field.h"
#include "bw_memory.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

enum { PAD = BW_SHAPE__PAD };
static const double MOST = 1e8; /* voxels, all held: 3 GB while they are looked at */
static const double NEAR = 1.6; /* voxels around the surface in which the mean tells the distance */
static const double LOST = 0.15; /* of the volume, taken by the mean: what is this thin is lost */

/* While it is made: the mean of the voxels, nearest places (n,3) of the surface (NaN: not
 * known), and whether the mean has told the distance. */
typedef struct {
  bw_shape_field *f;
  size_t all;
  bw_shape_mask *mask;
  float *mean, *near;
  uint8_t *told;
} maker;

static size_t node(const bw_shape_field *f, int64_t i, int64_t j, int64_t k)
{
  return (size_t)(i + f->n[0] * (j + f->n[1] * k));
}

static int pad_of(const bw_shape_field *f, int d)
{
  return d < f->dims ? PAD : 0;
}

/* ---- pieces ---- */

/* Gives piece `number` to all voxels that touch voxel `from`, also at edges and corners. */
static int64_t flood(const bw_shape_mask *m, int64_t from, uint8_t number, uint8_t piece[],
                     int64_t stack[])
{
  int64_t waiting = 0, count = 0;
  piece[from] = number;
  stack[waiting++] = from;
  while (waiting > 0) {
    const int64_t q = stack[--waiting];
    const int64_t at[3] = {q % m->size[0], q / m->size[0] % m->size[1],
                           q / m->size[0] / m->size[1]};
    count++;
    for (int c = 0; c < 27; c++) {
      const int64_t to[3] = {at[0] + c % 3 - 1, at[1] + c / 3 % 3 - 1, at[2] + c / 9 - 1};
      bool fits = true;
      for (int d = 0; d < 3; d++)
        fits = fits && to[d] >= 0 && to[d] < m->size[d];
      const int64_t p = to[0] + m->size[0] * (to[1] + m->size[1] * to[2]);
      if (!fits || !m->solid[p] || piece[p] != 0) continue;
      piece[p] = number;
      stack[waiting++] = p;
    }
  }
  return count;
}

/* A rigid body is one piece. */
static bw_status check_pieces(const bw_shape_mask *m)
{
  const int64_t all = m->size[0] * m->size[1] * m->size[2];
  uint8_t *piece = NULL;
  int64_t *stack = NULL, largest = 0, solid = 0, pieces = 0;
  bw_status st = BW_ALLOCATE(&piece, (size_t)all);
  BW_THEN(st, BW_ALLOCATE(&stack, (size_t)all));
  for (int64_t q = 0; q < all && st == BW_OK; q++) {
    if (!m->solid[q] || piece[q] != 0) continue;
    const int64_t count = flood(m, q, 1, piece, stack);
    solid += count;
    largest = count > largest ? count : largest;
    pieces++;
  }
  bw_release(&piece);
  bw_release(&stack);
  BW_TRY(st);
  BW_REQUIRE(pieces > 0, BW_EINPUT, "surface: no voxel is solid; look at the threshold");
  BW_REQUIRE(pieces == 1, BW_EINPUT,
             "surface: its voxels are %lld pieces that do not touch, the largest with %.3g %% of "
             "them; a body is one piece: crop the image, or move the threshold",
             (long long)pieces, 100.0 * (double)largest / (double)solid);
  return BW_OK;
}

/* ---- the mean, and the distance that it tells ---- */

static void smooth(const bw_shape_field *f, float a[], float row[])
{
  static const float weight[5] = {1 / 16.0f, 4 / 16.0f, 6 / 16.0f, 4 / 16.0f, 1 / 16.0f};
  const int64_t stride[3] = {1, f->n[0], f->n[0] * f->n[1]};
  for (int d = 0; d < f->dims; d++) {
    const int e = (d + 1) % 3, g = (d + 2) % 3;
    for (int64_t p = 0; p < f->n[e]; p++)
      for (int64_t q = 0; q < f->n[g]; q++) {
        float *line = a + p * stride[e] + q * stride[g];
        for (int64_t i = 0; i < f->n[d]; i++)
          row[i] = line[i * stride[d]];
        for (int64_t i = 0; i < f->n[d]; i++) {
          float sum = 0;
          for (int64_t w = -2; w <= 2; w++)
            if (i + w >= 0 && i + w < f->n[d]) sum += weight[w + 2] * row[i + w];
          line[i * stride[d]] = sum;
        }
      }
  }
}

/* The mean of the voxels at the nodes. */
static bw_status find_mean(maker *m)
{
  const bw_shape_field *f = m->f;
  const int64_t *size = m->mask->size;
  const int64_t longest = (int64_t)fmax((double)f->n[0], fmax((double)f->n[1], (double)f->n[2]));
  float *row = NULL;
  BW_TRY(BW_ALLOCATE(&row, (size_t)longest));
  for (int64_t k = 0; k < size[2]; k++)
    for (int64_t j = 0; j < size[1]; j++)
      for (int64_t i = 0; i < size[0]; i++)
        m->mean[node(f, i + PAD, j + PAD, k + pad_of(f, 2))] =
            m->mask->solid[i + size[0] * (j + size[1] * k)] != 0 ? 1.0f : 0.0f;
  smooth(f, m->mean, row);
  bw_release(&row);
  return BW_OK;
}

/* Distance that the mean tells at a node, the place of the surface into x (3); NaN where it does
 * not. */
static double tell(const maker *m, const int64_t at[3], double x[3])
{
  const bw_shape_field *f = m->f;
  const int64_t stride[3] = {1, f->n[0], f->n[0] * f->n[1]};
  const size_t q = node(f, at[0], at[1], at[2]);
  double g[3] = {0.0, 0.0, 0.0}, size = 0.0, width = 0.0;
  for (int d = 0; d < f->dims; d++) {
    if (at[d] == 0 || at[d] == f->n[d] - 1) return NAN;
    g[d] = ((double)m->mean[q - (size_t)stride[d]] - (double)m->mean[q + (size_t)stride[d]]) /
           (2.0 * f->h[d]);
    size += g[d] * g[d];
  }
  const double mean = fmin(fmax((double)m->mean[q], 0.0), 1.0),
               voxels = -gsl_cdf_ugaussian_Pinv(mean);
  if (!(fabs(voxels) < NEAR) || size == 0.0) return NAN;
  /* The width of the mean along the normal: that of a voxel, which may be longer in one
   * direction. */
  for (int d = 0; d < f->dims; d++)
    width += g[d] * g[d] / size * f->h[d] * f->h[d];
  const double away = voxels * sqrt(width);
  for (int d = 0; d < 3; d++)
    x[d] = f->first[d] + f->h[d] * (double)at[d] - away * g[d] / sqrt(size);
  return away;
}

/* ---- from there on ---- */

/* Does the surface near the neighbour `from` lie nearer to the node than what it knows? */
static void learn(maker *m, const int64_t at[3], size_t q, size_t from)
{
  const bw_shape_field *f = m->f;
  const float *p = m->near + 3 * from;
  double squared = 0.0;
  if (isnan(p[0]) || m->told[q]) return;
  for (int d = 0; d < f->dims; d++) {
    const double way = f->first[d] + f->h[d] * (double)at[d] - (double)p[d];
    squared += way * way;
  }
  const double before = fabs((double)f->away[q]);
  if (!isnan(m->near[3 * q]) && before * before <= squared) return;
  memcpy(m->near + 3 * q, p, 3 * sizeof *p);
  f->away[q] = (float)copysign(sqrt(squared), (double)f->away[q]);
}

/* From the 13 neighbours that come before a node in its order, then from those that come behind. */
static void sweep(maker *m, bool back)
{
  const bw_shape_field *f = m->f;
  for (size_t s = 0; s < m->all; s++) {
    const size_t q = back ? m->all - 1 - s : s;
    const int64_t i = (int64_t)q;
    const int64_t at[3] = {i % f->n[0], i / f->n[0] % f->n[1], i / f->n[0] / f->n[1]};
    for (int c = 0; c < 13; c++) {
      int64_t to[3] = {at[0] + c % 3 - 1, at[1] + c / 3 % 3 - 1, at[2] + c / 9 - 1};
      bool fits = true;
      for (int d = 0; d < 3; d++) {
        if (back) to[d] = 2 * at[d] - to[d];
        fits = fits && to[d] >= 0 && to[d] < f->n[d];
      }
      if (fits) learn(m, at, q, node(f, to[0], to[1], to[2]));
    }
  }
}

/* Distances at all nodes. */
static void find_distances(maker *m)
{
  const bw_shape_field *f = m->f;
  for (size_t q = 0; q < m->all; q++) {
    const int64_t i = (int64_t)q;
    const int64_t at[3] = {i % f->n[0], i / f->n[0] % f->n[1], i / f->n[0] / f->n[1]};
    double x[3] = {NAN, NAN, NAN};
    const double away = tell(m, at, x);
    m->told[q] = (uint8_t)(isnan(away) ? 0 : 1);
    f->away[q] = isnan(away) ? (m->mean[q] < 0.5f ? INFINITY : -INFINITY) : (float)away;
    for (int d = 0; d < 3; d++)
      m->near[3 * q + (size_t)d] = isnan(away) ? NAN : (float)x[d];
  }
  for (int round = 0; round < 2; round++) {
    sweep(m, false);
    sweep(m, true);
  }
}

/* ---- the volume ---- */

/* Volume where the distances are negative, as nodes tell it [L^3 or L^2]. */
static double rough_volume(const maker *m, double cell, double h)
{
  double sum = 0.0;
  for (size_t q = 0; q < m->all; q++)
    sum += fmin(fmax(0.5 - (double)m->f->away[q] / h, 0.0), 1.0);
  return sum * cell;
}

/* Of the surface as its patches have it: volume by Gauss' theorem, and area. */
typedef struct {
  int dims;
  double volume, area;
} content;

static bw_status add_patch(void *to, const bw_shape__chart *c)
{
  content *all = to;
  double x[3], normal[3];
  c->map(c, 0.5, 0.5, x, normal);
  const double area = c->area(c, c->u, c->v);
  for (int d = 0; d < all->dims; d++)
    all->volume += x[d] * normal[d] * area / all->dims;
  all->area += area;
  return BW_OK;
}

/* Shifts the surface until it holds what the voxels hold. */
static bw_status keep_volume(maker *m)
{
  enum { TIMES = 2 };
  const bw_shape_field *f = m->f;
  const bw_shape image = {.kind = BW_SHAPE_MASK, .mask = m->mask};
  const int64_t all = m->mask->size[0] * m->mask->size[1] * m->mask->size[2];
  double solid = 0.0, cell = 1.0, h = INFINITY;
  for (int64_t q = 0; q < all; q++)
    solid += m->mask->solid[q] != 0;
  for (int d = 0; d < f->dims; d++)
    cell *= f->h[d], h = fmin(h, f->h[d]);
  BW_REQUIRE(fabs(rough_volume(m, cell, h) / (solid * cell) - 1.0) < LOST, BW_EINPUT,
             "surface: voxels that are fewer than about four in a row hold most of it, which tell "
             "no surface; take a finer image, or cells");
  m->mask->surface = m->f;
  bw_status st = BW_OK;
  for (int times = 0; times < TIMES && st == BW_OK; times++) {
    content now = {.dims = f->dims};
    st = bw_shape__charts_mask(&image, f->dims, NULL, h, add_patch, &now);
    for (size_t q = 0; q < m->all && now.area > 0.0; q++)
      f->away[q] -= (float)((solid * cell - now.volume) / now.area);
  }
  m->mask->surface = NULL;
  return st;
}

/* ---- the whole ---- */

static bw_status make(maker *m)
{
  BW_TRY(BW_ALLOCATE(&m->f->away, m->all));
  BW_TRY(BW_ALLOCATE(&m->mean, m->all));
  BW_TRY(BW_ALLOCATE(&m->near, 3 * m->all));
  BW_TRY(BW_ALLOCATE(&m->told, m->all));
  BW_TRY(find_mean(m));
  find_distances(m);
  return keep_volume(m);
}

bw_status bw_shape_mask_find_surface(bw_shape_mask *mask, bool planar)
{
  const double all = (double)mask->size[0] * (double)mask->size[1] * (double)mask->size[2];
  maker m = {.mask = mask};
  if (mask->surface != NULL) return BW_OK;
  BW_REQUIRE(!planar || mask->size[2] == 1, BW_EINPUT,
             "surface: the image has %lld layers, but the body has two dimensions; crop it to one",
             (long long)mask->size[2]);
  BW_REQUIRE(all <= MOST, BW_EINPUT,
             "surface: of %.3g voxels, at most %.3g: coarsen the image, or take larger cells", all,
             MOST);
  BW_TRY(bw_shape_mask_hold(mask, 0, mask->size[2]));
  BW_TRY(check_pieces(mask));
  BW_TRY(BW_ALLOCATE(&m.f, 1));
  m.f->dims = planar ? 2 : 3;
  m.all = 1;
  for (int d = 0; d < 3; d++) {
    m.f->n[d] = mask->size[d] + 2 * pad_of(m.f, d);
    m.f->h[d] = mask->spacing[d];
    m.f->first[d] = mask->lower[d] + (0.5 - pad_of(m.f, d)) * mask->spacing[d];
    m.all *= (size_t)m.f->n[d];
  }
  const bw_status st = make(&m);
  bw_release(&m.mean);
  bw_release(&m.near);
  bw_release(&m.told);
  if (st == BW_OK)
    mask->surface = m.f;
  else
    bw_shape__field_destroy(&m.f);
  return st;
}
