/* Normals: told in the reference shape, from what holds together now.
 *
 * 3.45 sees the steps of the lattice: a terrace longer than the family looks flat. Smoothed, a
 * linear function of the two coordinates along the surface is fitted to the normals 3.45 of the
 * surface particles that h has intact bonds with, and its value at h is taken, PASSES times. A mean
 * would bend towards where more of them are; a linear function does not. Normals more than 60
 * degrees apart do not meet, but the rounding of an edge by 3.45 itself is spread farther: for
 * smooth bodies. */
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

enum { PASSES = 2 };

/* A stand-in where the neighbours balance: the middle of the lowest group of empty sectors (one
 * of the sides of a sheet), or of the lowest one when they surround the particle. */
static void guess_normal(const bw_pd_interface__stencil *s, uint32_t empty, double n[3])
{
  const uint32_t group = bw_pd_interface__group(s, empty);
  double sum[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  int lowest = -1;
  for (int k = 0; k < s->sectors; k++) {
    if (!(group >> (unsigned)k & 1u)) continue;
    if (lowest < 0) lowest = k;
    for (int d = 0; d < 3; d++)
      sum[d] += s->direction[k][d];
  }
  for (int d = 0; d < 3; d++)
    squared += sum[d] * sum[d];
  for (int d = 0; d < 3; d++)
    n[d] = squared > 1e-6 ? sum[d] / sqrt(squared) : s->direction[lowest][d];
}

void bw_pd_interface__tell_normal(bw_pd_interface *pi, size_t h, uint32_t empty)
{
  double *n = &pi->normal[3 * h];
  const bool known = n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0;
  if (!bw_pd_interface__normal_of(pi, n) && !known) guess_normal(&pi->stencil, empty, n);
}

static void cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++)
    c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Weights 1, s, t of the members of a fit whose sum of weight x (1, s, t) is (1, 0, 0). */
static bool fit_weights(double m[3][3], double y[3])
{
  double c[3];
  const double more = 1e-6 * (m[1][1] + m[2][2]); /* a line of members has no slope across */
  m[1][1] += more, m[2][2] += more;
  cross(m[1], m[2], c);
  const double det = dot(m[0], c);
  for (int d = 0; d < 3; d++)
    y[d] = c[d] / det;
  return det > 0.0;
}

/* Two unit vectors along the surface. */
static void tangents(const double n[3], double t[2][3])
{
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (fabs(n[d]) < fabs(n[least])) least = d;
  double e[3] = {0.0, 0.0, 0.0};
  e[least] = 1.0;
  cross(n, e, t[0]);
  const double length = sqrt(dot(t[0], t[0]));
  for (int d = 0; d < 3; d++)
    t[0][d] /= length;
  cross(n, t[0], t[1]);
}

/* Is the partner one of the surface that looks about the same way? */
static bool meets(const bw_pd_interface *pi, const bw_pd_interface__near *near, const double n[3])
{
  return near->cross == 0 && near->partner >= 0 &&
         dot(n, &pi->all_normal[3 * (size_t)near->partner]) > 0.5;
}

/* The fit at h, to out; as it was where too few meet. */
static void fit(const bw_pd_interface *pi, size_t h, double out[3])
{
  const bw_pd_interface__near *near = &pi->pool[pi->row[h]];
  const double *n = &pi->all_normal[3 * h];
  const size_t count = pi->stale[h] ? 0 : pi->row_n[h];
  double t[2][3], m[3][3] = {{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, y[3], sum[3];
  tangents(n, t);
  for (size_t q = 0; q < count; q++) {
    if (!meets(pi, &near[q], n)) continue;
    const double *xi = &pi->stencil.xi[3 * near[q].slot];
    const double f[3] = {1.0, dot(t[0], xi), dot(t[1], xi)};
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        m[a][b] += f[a] * f[b];
  }
  memcpy(out, n, 3 * sizeof *out);
  if (m[0][0] < 5.0 || !fit_weights(m, y)) return;
  for (int d = 0; d < 3; d++)
    sum[d] = y[0] * n[d];
  for (size_t q = 0; q < count; q++) {
    if (!meets(pi, &near[q], n)) continue;
    const double *xi = &pi->stencil.xi[3 * near[q].slot];
    const double weight = y[0] + y[1] * dot(t[0], xi) + y[2] * dot(t[1], xi);
    for (size_t d = 0; d < 3; d++)
      sum[d] += weight * pi->all_normal[3 * (size_t)near[q].partner + d];
  }
  const double length = sqrt(dot(sum, sum));
  for (int d = 0; d < 3 && length > 0.5; d++)
    out[d] = sum[d] / length;
}

void bw_pd_interface__settle_normals(bw_pd_interface *pi)
{
  memset(pi->own_normal, 0, 3 * pi->n * sizeof *pi->own_normal);
  for (size_t row = 0; row < pi->n_list; row++)
    memcpy(&pi->own_normal[3 * pi->list[row]], &pi->normal[3 * pi->list[row]], 3 * sizeof(double));
  for (int pass = 0; pi->config.smooth_normals && pass < PASSES; pass++) {
    bw_pd_bond_fill_extended(pi->pd, 3 * sizeof(double), pi->own_normal, pi->all_normal);
    for (size_t row = 0; row < pi->n_list; row++)
      fit(pi, (size_t)pi->list[row], &pi->own_normal[3 * pi->list[row]]);
  }
}
