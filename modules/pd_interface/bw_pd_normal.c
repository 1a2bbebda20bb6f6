/* Normals, told in the reference shape from what holds together now.
 *
 * 3.45 sees the steps of the lattice: a terrace longer than the family looks flat, a step of one ds
 * moves the centroid by 6 degrees. Where the surface is smooth normals vary linearly along it over
 * a horizon, and their fit is better than each: a linear function of the two coordinates along the
 * surface, through the normals of the surface particles that h has intact bonds with (a mean would
 * bend towards the side with more of them), of those once more.
 * Where is it smooth? What a first fit of all gives is linear to SMOOTH: a second fit leaves at
 * most 4 degrees rms on balls, cylinders, discs of any radius from two horizons on, at least 4.8
 * beside the edge of a cube, 10 and more on the ridges between pores. The others keep 3.45, which
 * keeps edges and areas closed, and are not seen by the fits that count. Images in a wall take
 * part. Only what changed is told anew, so that this is a function of the bonds that hold. */
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

static const double SMOOTH = 0.07; /* rms [rad] */

/* A stand-in where the neighbours balance: the middle of the lowest group of empty sectors (one
 * of the sides of a sheet), or of the lowest one when they surround the particle. */
static void guess_normal(const bw_pd_interface__stencil *s, uint32_t empty, double n[3])
{
  const uint32_t group = bw_pd_interface__group(s, empty);
  double sum[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  int lowest = -1;
  /* Sum over the group of neighbouring empty sectors, the lowest of all. */
  for (int k = 0; k < s->sectors; k++) {
    if (!(group >> (unsigned)k & 1u)) continue;
    if (lowest < 0) lowest = k;
    /* Sectors all around add up to nothing: then the lowest alone. */
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
  const double *first = &pi->first_normal[3 * h];
  /* POROUS 3.45 over what holds now. */
  if (bw_pd_interface__normal_of(pi, h, n)) return;
  /* The partners balance (a sheet): what it looked like before anything broke, or a guess. */
  if (first[0] != 0.0 || first[1] != 0.0 || first[2] != 0.0)
    memcpy(n, first, 3 * sizeof *n);
  else
    guess_normal(pi->stencil, empty, n);
}

static void cross(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++)
    c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* Two unit vectors along the surface. Which way they point is without effect: the fit is taken at
 * h, where both coordinates are zero. */
static void tangents(const double n[3], double t[2][3])
{
  int least = 0;
  /* The axis least along n is never parallel to it. */
  for (int d = 1; d < 3; d++)
    if (fabs(n[d]) < fabs(n[least])) least = d;
  double e[3] = {0.0, 0.0, 0.0};
  e[least] = 1.0;
  cross(n, e, t[0]);
  const double length = sqrt(bw_pd_interface__dot(t[0], t[0]));
  for (int d = 0; d < 3; d++)
    t[0][d] /= length;
  cross(n, t[0], t[1]);
}

/* Sums over the surface particles about h that look about the same way; f = 1, s, t along it. */
typedef struct {
  double ff[3][3], fn[3][3]; /* f_a f_b; f_a n */
} fit_sums;

void bw_pd_interface__partner_normal(const bw_pd_interface__near *near, const double all[],
                                     double n[3])
{
  for (unsigned d = 0; d < 3; d++) {
    const double value = all[3 * (size_t)near->partner + d];
    n[d] = (near->cross >> (2 * d) & 3u) != 0 ? -value : value;
  }
}

static void sum_fit(const bw_pd_interface *pi, size_t h, const double all[], fit_sums *sums)
{
  const bw_pd_interface__near *near = &pi->rows.pool[pi->rows.row[h]];
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  const double *n = &all[3 * h];
  const size_t count = pi->rows.stale[h] ? 0 : pi->rows.row_n[h];
  double t[2][3], other[3];
  tangents(n, t);
  *sums = (fit_sums){{{1.0}}, {{n[0], n[1], n[2]}}}; /* h itself */
  for (size_t q = 0; q < count; q++) {
    /* A wall without a mirror image has no normal. */
    if (near[q].partner < 0) continue;
    bw_pd_interface__partner_normal(&near[q], all, other);
    if (!(bw_pd_interface__dot(n, other) > 0.5))
      continue; /* 60 degrees; 0 where there is no surface */
    /* Reference places: the fit is a function of the bonds that hold, not of how the body moved. */
    const double *xi = &s->xi[3 * near[q].slot];
    const double f[3] = {1.0, bw_pd_interface__dot(t[0], xi), bw_pd_interface__dot(t[1], xi)};
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        sums->ff[a][b] += f[a] * f[b];
        sums->fn[a][b] += f[a] * other[b];
      }
  }
}

/* The fit at h, to value; its slope along the surface to *bend. Returns its rms residual; INFINITY,
 * and value as it was: no fit. */
static double solve_fit(fit_sums *sums, int dims, double value[3], double *bend)
{
  double(*m)[3] = sums->ff, inverse[3][3], c[3][3] = {{0.0}}, explained = 0.0;
  const double members = m[0][0], more = 1e-6 * (m[1][1] + m[2][2]);
  m[1][1] += more, m[2][2] += more; /* a line of members has no slope across */
  /* Inverse of the symmetric 3 x 3 matrix by cofactors. */
  for (int a = 0; a < 3; a++)
    cross(m[(a + 1) % 3], m[(a + 2) % 3], inverse[a]);
  const double det = bw_pd_interface__dot(m[0], inverse[0]);
  /* Too few neighbours look the same way. */
  if (members < 5.0 || !(det > 0.0)) return INFINITY;
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++)
      for (int d = 0; d < 3; d++)
        c[a][d] += inverse[a][b] / det * sums->fn[b][d];
    /* Residual of a least-squares fit: sum of squares less what the fit explains. */
    explained += bw_pd_interface__dot(c[a], sums->fn[a]);
  }
  *bend = sqrt(bw_pd_interface__dot(c[1], c[1]) + bw_pd_interface__dot(c[2], c[2]));
  /* c[0] is the value at h itself. */
  const double length = sqrt(bw_pd_interface__dot(c[0], c[0]));
  if (!(length > 0.5)) return INFINITY;
  for (int d = 0; d < 3; d++)
    value[d] = c[0][d] / length;
  return sqrt(fmax(members - explained, 0.0) / (members - dims));
}

/* Row h of an array becomes n; a change is noted. */
static void put(bw_pd_interface *pi, double rows[], size_t h, const double n[3])
{
  double *row = &rows[3 * h];
  pi->fit.changed[h] = pi->fit.changed[h] || row[0] != n[0] || row[1] != n[1] || row[2] != n[2];
  memcpy(row, n, 3 * sizeof *row);
}

/* Partners know each other, but for copies and images. */
void bw_pd_interface__spread_change(bw_pd_interface *pi)
{
  /* Changes on other ranks reach h through its copies. */
  bw_solid_fill_extended(pi->pd, sizeof *pi->fit.changed, pi->fit.changed, pi->fit.changed);
  memcpy(pi->fit.touched, pi->fit.changed, pi->n * sizeof *pi->fit.touched);
  for (size_t h = 0; h < pi->n; h++) {
    const bw_pd_interface__near *near = &pi->rows.pool[pi->rows.row[h]];
    const size_t count = pi->fit.changed[h] || pi->fit.border[h] ? pi->rows.row_n[h] : 0;
    for (size_t q = 0; q < count; q++) {
      const int32_t l = near[q].partner;
      if (l < 0) continue;
      if (pi->fit.changed[l]) pi->fit.touched[h] = true;
      /* Own partners know h as theirs, so one direction is enough; copies and images do not. */
      if (pi->fit.changed[h] && (size_t)l < pi->n) pi->fit.touched[l] = true;
    }
  }
}

/* What the fits at `from` give, to `to`; none where there is none. To judge: 3.45 where they leave
 * no more than SMOOTH, none elsewhere. */
static void fit_all(bw_pd_interface *pi, double from[], double to[], bool judge)
{
  const double none[3] = {0.0, 0.0, 0.0};
  /* Normals of copies, and who has to be told anew. */
  bw_solid_fill_extended(pi->pd, 3 * sizeof *from, from, from);
  bw_pd_interface__spread_change(pi);
  for (size_t h = 0; h < pi->n; h++) {
    const bool there = bw_pd_interface__dot(&from[3 * h], &from[3 * h]) > 0.0;
    double n[3];
    fit_sums sums;
    /* Nothing near it has changed: its fit is what it was. */
    if (!pi->fit.touched[h]) continue;
    memcpy(n, there ? &pi->normal[3 * h] : none, sizeof n);
    if (there) sum_fit(pi, h, from, &sums);
    double bend = 0.0;
    const double rms = there ? solve_fit(&sums, pi->stencil->dims, n, &bend) : INFINITY;
    pi->fit.bend[h] = bend; /* that of the last pass stays */
    /* First judgement: where the fit of a fit is rough, the
     * particle keeps 3.45 and is not seen any more. */
    put(pi, to, h, !judge ? n : rms <= SMOOTH ? &pi->normal[3 * h] : none);
  }
}

bool bw_pd_interface__is_smooth(const bw_pd_interface *pi, size_t h)
{
  const double *n = &pi->fit.told[BW_PD_INTERFACE__PASSES][3 * h];
  return bw_pd_interface__dot(n, n) > 0.0;
}

void bw_pd_interface__settle_normals(bw_pd_interface *pi)
{
  const double none[3] = {0.0, 0.0, 0.0};
  /* Pass 0: 3.45 of all surface particles, nothing elsewhere. */
  for (size_t h = 0; h < pi->n; h++)
    put(pi, pi->fit.told[0], h, pi->surface[h] ? &pi->normal[3 * h] : none);
  /* Fit, fit of the fit with judgement, and again two fits of those that are smooth. */
  for (int pass = 0; pass < BW_PD_INTERFACE__PASSES; pass++)
    fit_all(pi, pi->fit.told[pass], pi->fit.told[pass + 1], pass == 1);
  /* The last fit where there is one, else 3.45. */
  for (size_t h = 0; h < pi->n; h++) {
    const double *n = &pi->fit.told[BW_PD_INTERFACE__PASSES][3 * h];
    memcpy(&pi->fit.own_normal[3 * h],
           bw_pd_interface__dot(n, n) > 0.0 ? n : &pi->fit.told[0][3 * h], 3 * sizeof *n);
  }
}
