/* Who is near whom: points in bins as wide as a film may reach. */
#include "bw_memory.h"
#include "film_net_internal.h"

#include <math.h>

enum { MOST = 512 }; /* bins each way */

double bw_film_net__reach(const bw_film_net *w)
{
  /* Two heights of half a spacing lie between centres. */
  const double ds = w->config.spacing;
  return hypot(w->config.limit + (FILM_NET_BEYOND + 1.0) * ds, FILM_NET_REACH * ds);
}

static int bin_along(const bw_film_net *w, int d, double x)
{
  const int n = w->bins[d], i = (int)floor((x - w->low[d]) / w->wide[d]);
  if (w->config.period[d] > 0.0) return (i % n + n) % n;
  return i < 0 ? 0 : i < n ? i : n - 1;
}

static size_t bin_at(const bw_film_net *w, const int i[3])
{
  return ((size_t)i[2] * (size_t)w->bins[1] + (size_t)i[1]) * (size_t)w->bins[0] + (size_t)i[0];
}

static void lay_out(bw_film_net *w)
{
  for (int d = 0; d < 3; d++) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t s = 0; s < w->n; s++) {
      low = fmin(low, w->X[3 * s + (size_t)d]);
      high = fmax(high, w->X[3 * s + (size_t)d]);
    }
    const bool around = w->config.period[d] > 0.0;
    w->low[d] = around ? 0.0 : w->n > 0 ? low : 0.0;
    const double length = around ? w->config.period[d] : w->n > 0 ? high - low : 0.0;
    w->bins[d] = (int)fmin(MOST, fmax(1.0, floor(length / bw_film_net__reach(w))));
    w->wide[d] = length > 0.0 ? length / w->bins[d] : 1.0;
  }
}

bw_status bw_film_net__sort(bw_film_net *w)
{
  lay_out(w);
  const size_t bins = (size_t)w->bins[0] * (size_t)w->bins[1] * (size_t)w->bins[2];
  if (bins > w->room_head) {
    w->room_head = 0;
    bw_release(&w->head);
    BW_TRY(BW_ALLOCATE(&w->head, bins));
    w->room_head = bins;
  }
  for (size_t b = 0; b < bins; b++)
    w->head[b] = -1;
  /* From the last to the first, so that lists rise. */
  for (size_t s = w->n; s-- > 0;) {
    int i[3];
    for (int d = 0; d < 3; d++)
      i[d] = bin_along(w, d, w->X[3 * s + (size_t)d]);
    const size_t b = bin_at(w, i);
    w->next[s] = w->head[b];
    w->head[b] = (int32_t)s;
  }
  return BW_OK;
}

/* First and last of the bins beside and at i, each once, also around a seam. */
static void beside(const bw_film_net *w, int d, int i, int range[2])
{
  const bool around = w->config.period[d] > 0.0;
  const int n = w->bins[d];
  range[0] = i - 1, range[1] = i + 1;
  if (!around) {
    range[0] = range[0] < 0 ? 0 : range[0];
    range[1] = range[1] < n ? range[1] : n - 1;
  } else if (n < 3) {
    range[0] = 0, range[1] = n - 1;
  }
}

size_t bw_film_net__around(const bw_film_net *w, const double x[3], double radius)
{
  int range[3][2];
  double way[3];
  size_t n = 0;
  for (int d = 0; d < 3; d++)
    beside(w, d, bin_along(w, d, x[d]), range[d]);
  for (int k = range[2][0]; k <= range[2][1]; k++)
    for (int j = range[1][0]; j <= range[1][1]; j++)
      for (int i = range[0][0]; i <= range[0][1]; i++) {
        const int at[3] = {(i + w->bins[0]) % w->bins[0], (j + w->bins[1]) % w->bins[1],
                           (k + w->bins[2]) % w->bins[2]};
        for (int32_t s = w->head[bin_at(w, at)]; s >= 0; s = w->next[s]) {
          film_net__between(w, x, w->X + 3 * (ptrdiff_t)s, way);
          if (film_net__dot(way, way) < radius * radius) w->near[n++] = s;
        }
      }
  return n;
}
