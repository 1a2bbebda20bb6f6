/* Where the film is: the nearest place of two faces, the patch around it, its heights. */
#include "film_internal.h"

#include <math.h>
#include <string.h>

enum { TRIES = 200 };            /* steps to the nearest place, along a normal, halvings */
static const double FAR = 3.0;   /* limits at which a film of faces that part ends */
static const double FINE = 1e-9; /* of the limit: where places and heights are good enough */

static double distance(const bw_film_face *face, const double x[3])
{
  return face->distance(face->context, x);
}

/* Gradient of the distance, a unit vector. */
static void outward(const bw_film *f, const bw_film_face *face, const double x[3], double n[3])
{
  const double eps = 1e-4 * f->config.limit;
  double size = 0.0;
  for (int d = 0; d < 3; d++) {
    double up[3] = {x[0], x[1], x[2]}, down[3] = {x[0], x[1], x[2]};
    up[d] += eps, down[d] -= eps;
    n[d] = f->config.planar && d == 2 ? 0.0 : distance(face, up) - distance(face, down);
    size += n[d] * n[d];
  }
  for (int d = 0; d < 3; d++)
    n[d] /= size > 0.0 ? sqrt(size) : 1.0;
}

static void shifted(const double x[3], const double e[3], double by, double out[3])
{
  for (int d = 0; d < 3; d++)
    out[d] = x[d] + by * e[d];
}

/* Normal of the film at x: between those of both faces, which face each other. */
static void find_normal(bw_film *f, const bw_film_face *a, const bw_film_face *b, const double x[3])
{
  double na[3], nb[3], size = 0.0;
  outward(f, a, x, na);
  outward(f, b, x, nb);
  for (int d = 0; d < 3; d++)
    size += (na[d] - nb[d]) * (na[d] - nb[d]);
  for (int d = 0; d < 3; d++)
    f->axes[2][d] = (na[d] - nb[d]) / sqrt(size);
}

/* Two directions across the normal; in the plane the second is z. */
static void find_axes(bw_film *f)
{
  const double *n = f->axes[2];
  int least = fabs(n[0]) < fabs(n[1]) ? 0 : 1;
  if (fabs(n[2]) < fabs(n[least])) least = 2;
  double e[3] = {0.0, 0.0, 0.0}, size = 0.0;
  /* From the axis of space that is most across it. */
  e[least] = 1.0;
  if (f->config.planar) e[0] = n[1], e[1] = -n[0], e[2] = 0.0;
  for (int d = 0; d < 3; d++) {
    f->axes[0][d] = e[d] - n[d] * (e[0] * n[0] + e[1] * n[1] + e[2] * n[2]);
    size += f->axes[0][d] * f->axes[0][d];
  }
  for (int d = 0; d < 3; d++)
    f->axes[0][d] /= sqrt(size);
  for (int d = 0; d < 3; d++) {
    const int p = (d + 1) % 3, q = (d + 2) % 3;
    f->axes[1][d] = n[p] * f->axes[0][q] - n[q] * f->axes[0][p];
  }
}

/* Sum of both distances at (s, t) across the normal: least between the nearest places. */
static double between(const bw_film *f, const bw_film_face *a, const bw_film_face *b, double s,
                      double t)
{
  double x[3];
  film_point(f, s, t, 0.0, x);
  return distance(a, x) + distance(b, x);
}

/* The step of Newton's method across the normal to where `between` is least, of one limit at most.
 * Along a direction in which the gap does not change there is none. */
static double newton(bw_film *f, const bw_film_face *a, const bw_film_face *b)
{
  const double e = 0.01 * f->config.limit, here = between(f, a, b, 0.0, 0.0);
  const double right = between(f, a, b, e, 0.0), left = between(f, a, b, -e, 0.0);
  const double up = between(f, a, b, 0.0, e), down = between(f, a, b, 0.0, -e);
  const double cross = between(f, a, b, e, e) + between(f, a, b, -e, -e) - between(f, a, b, e, -e) -
                       between(f, a, b, -e, e);
  /* Gradient times e, curvature times e^2, the least of which keeps what is flat where it is. */
  const double flat = 1e-9 * f->config.limit;
  const double gs = 0.5 * (right - left), gt = 0.5 * (up - down), hst = 0.25 * cross;
  const double hss = fmax(right + left - 2.0 * here, 0.0) + flat;
  const double htt = fmax(up + down - 2.0 * here, 0.0) + flat;
  const double det = fmax(hss * htt - hst * hst, 1e-3 * hss * htt);
  double s = -e * (htt * gs - hst * gt) / det, t = -e * (hss * gt - hst * gs) / det;
  if (f->config.planar) t = 0.0;
  const double size = hypot(s, t), most = fmin(1.0, f->config.limit / fmax(size, 1e-300));
  film_point(f, most * s, most * t, 0.0, f->origin);
  return most * size;
}

/* Origin and axes: to the middle of the gap along the normal, then across it, and so on. */
static void find_origin(bw_film *f, const bw_film_face *a, const bw_film_face *b, const double x[3])
{
  double moved = HUGE_VAL;
  memcpy(f->origin, x, sizeof f->origin);
  for (int q = 0; q < TRIES && moved > 1e-6 * f->config.limit; q++) {
    find_normal(f, a, b, f->origin);
    find_axes(f);
    const double up = 0.5 * (distance(b, f->origin) - distance(a, f->origin));
    shifted(f->origin, f->axes[2], up, f->origin);
    moved = fabs(up) + newton(f, a, b);
  }
}

/* Height of a face above (s, t), sought upwards (sign 1) or downwards from the other side of the
 * plane; NAN: none within FAR limits. By its distance, which is never more than the way to it. */
static double height(const bw_film *f, const bw_film_face *face, double sign, double s, double t)
{
  const double far = FAR * f->config.limit;
  double z = -far, x[3];
  for (int q = 0; q < TRIES && z <= far; q++) {
    film_point(f, s, t, sign * z, x);
    const double away = distance(face, x);
    if (fabs(away) < FINE * f->config.limit) return sign * z;
    z += away;
  }
  return NAN;
}

/* Gap at (s, t); NAN: no film. */
static double gap_at(const bw_film *f, const bw_film_face *a, const bw_film_face *b, double s,
                     double t, double z[2])
{
  z[0] = height(f, a, -1.0, s, t), z[1] = height(f, b, 1.0, s, t);
  return z[1] - z[0] <= FAR * f->config.limit ? z[1] - z[0] : (double)NAN;
}

/* How far along a direction of the patch the gap is at most `most`, 0 where it is more at once. */
static double reach(const bw_film *f, const bw_film_face *a, const bw_film_face *b, int d,
                    double sign, double most)
{
  double in = 0.0, out = 1e-3 * f->config.limit, z[2];
  bool found = false;
  /* Outwards until it ends, then halved. */
  for (int q = 0; q < TRIES && (!found || out - in > 1e-7 * out); q++) {
    const double s = found ? 0.5 * (in + out) : out;
    const double gap = gap_at(f, a, b, d == 0 ? sign * s : 0.0, d == 1 ? sign * s : 0.0, z);
    const bool here = gap <= most; /* false of NAN */
    if (!here)
      out = s, found = true;
    else if (found)
      in = s;
    else
      in = out, out *= 1.5;
  }
  return in;
}

/* Cells along a direction, from as far as the film reaches below to above: sinh(u), u in equal
 * steps, its length the distance in which the gap doubles; equal cells where it does not. */
static void grade(bw_film *f, const bw_film_face *a, const bw_film_face *b, int d)
{
  const double far = FAR * f->config.limit, twice = 2.0 * fmax(f->gap, f->config.roughness);
  const double below = reach(f, a, b, d, -1.0, far), above = reach(f, a, b, d, 1.0, far);
  const double near = fmin(reach(f, a, b, d, -1.0, twice), reach(f, a, b, d, 1.0, twice));
  const bool even = near >= fmin(below, above) || near <= 0.0;
  const double low = even ? -below : -asinh(below / near);
  const double high = even ? above : asinh(above / near);
  for (int i = 0; i < f->n[d]; i++) {
    double end[2];
    for (int q = 0; q < 2; q++) {
      const double u = low + (high - low) * (i + q) / f->n[d];
      end[q] = even ? u : near * sinh(u);
    }
    f->at[d][i] = 0.5 * (end[0] + end[1]);
    f->width[d][i] = end[1] - end[0];
  }
}

/* Slope of what `value` has along direction d at a cell, by the film's cells beside it. */
static double slope(const bw_film *f, const double value[], int d, int i, int j)
{
  const ptrdiff_t at = i + (ptrdiff_t)f->n[0] * j, stride = d == 0 ? 1 : f->n[0];
  const int place = d == 0 ? i : j;
  const bool up = place + 1 < f->n[d] && f->film[at + stride];
  const bool down = place > 0 && f->film[at - stride];
  if (!up && !down) return 0.0;
  const double above = up ? value[at + stride] : value[at];
  const double below = down ? value[at - stride] : value[at];
  return (above - below) / (f->at[d][place + up] - f->at[d][place - down]);
}

static void fill(bw_film *f, const bw_film_face *a, const bw_film_face *b)
{
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++) {
      const ptrdiff_t at = i + (ptrdiff_t)f->n[0] * j;
      double z[2];
      const double gap = gap_at(f, a, b, f->at[0][i], f->at[1][j], z);
      f->film[at] = !isnan(gap);
      f->z[0][at] = f->film[at] ? z[0] : 0.0, f->z[1][at] = f->film[at] ? z[1] : 0.0;
      f->h[at] = f->film[at] ? fmax(gap, f->config.roughness) : 1.0;
      f->wide[at] = fmax(f->h[at], f->config.limit);
    }
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++)
      for (int d = 0; d < 2; d++) {
        const ptrdiff_t at = i + (ptrdiff_t)f->n[0] * j;
        f->g[d][at] = f->film[at] && !(f->config.planar && d == 1)
                          ? -0.5 * (slope(f, f->z[0], d, i, j) + slope(f, f->z[1], d, i, j))
                          : 0.0;
      }
}

bool bw_film_place(bw_film *f, const bw_film_face *a, const bw_film_face *b, const double x[3])
{
  double z[2];
  find_origin(f, a, b, x);
  f->gap = gap_at(f, a, b, 0.0, 0.0, z);
  if (!(f->gap < f->config.limit)) return false;
  /* The patch ends where the faces do, or where they are far apart. */
  grade(f, a, b, 0);
  f->at[1][0] = 0.0, f->width[1][0] = 1.0;
  if (!f->config.planar) grade(f, a, b, 1);
  fill(f, a, b);
  return true;
}

bw_film_where bw_film_look(const bw_film *f)
{
  bw_film_where w = {.gap = f->gap};
  memcpy(w.origin, f->origin, sizeof w.origin);
  memcpy(w.normal, f->axes[2], sizeof w.normal);
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++)
      w.area += f->film[i + (ptrdiff_t)f->n[0] * j] ? film_area(f, i, j) : 0.0;
  return w;
}
