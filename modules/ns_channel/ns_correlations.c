/* ns_correlations.c -- planes gathered, correlated by direct sums, transformed on request. */
#include "bw_ns_correlations.h"

#include "bw_memory.h"
#include "ns_channel_internal.h"
#include <math.h>
#include <string.h>

struct bw_ns_correlations {
  bw_ns_channel *ns; /* borrowed */
  const bw_grid_view *g;
  int planes, *row;
  int lags[2];     /* n/2 + 1 along x and z */
  size_t of_plane; /* numbers of a plane: [component]{mean, x lags, z lags} */
  double *sum;     /* [plane][of_plane] over samples */
  double *now;     /* the same of the present field */
  double *field;   /* [component][n2][n0] of one plane */
  double *twice;   /* (2 n0): a row and its periodic continuation */
  long samples;
};

bw_status bw_ns_correlations_create(bw_ns_channel *ns, int planes, const int rows[],
                                    bw_ns_correlations **out)
{
  *out = NULL;
  const bw_grid_view *g = ns->g;
  BW_REQUIRE(g->periodic[0] && g->periodic[2] && g->n[2] > 1, BW_EINPUT,
             "ns_correlations: x and z must be periodic and the box three-dimensional");
  for (int p = 0; p < planes; p++)
    BW_REQUIRE(rows[p] >= 1 && rows[p] <= g->n[1], BW_EINPUT,
               "ns_correlations: plane %d is row %d, possible are 1 to %d", p, rows[p], g->n[1]);
  bw_ns_correlations *c = NULL;
  bw_status st = bw_allocate(1, sizeof *c, &c);
  /* By symmetry lags go to half the period only. */
  if (st == BW_OK) {
    c->ns = ns, c->g = g, c->planes = planes;
    c->lags[0] = g->n[0] / 2 + 1, c->lags[1] = g->n[2] / 2 + 1;
    c->of_plane = 3 * (size_t)(1 + c->lags[0] + c->lags[1]);
    const size_t size = (size_t)planes * c->of_plane, section = (size_t)g->n[0] * (size_t)g->n[2];
    st = BW_ALLOCATE(&c->row, (size_t)planes);
    BW_THEN(st, BW_ALLOCATE(&c->sum, size));
    BW_THEN(st, BW_ALLOCATE(&c->now, size));
    BW_THEN(st, BW_ALLOCATE(&c->field, 3 * section));
    BW_THEN(st, BW_ALLOCATE(&c->twice, 2 * (size_t)g->n[0]));
  }
  if (st == BW_OK) memcpy(c->row, rows, (size_t)planes * sizeof *rows);
  /* An allocation may have failed on one rank alone. */
  st = bw_comm_agree(ns->comm, st);
  if (st != BW_OK) bw_ns_correlations_destroy(&c);
  *out = c;
  return st;
}

void bw_ns_correlations_destroy(bw_ns_correlations **c)
{
  if (*c == NULL) return;
  bw_release(&(*c)->row);
  bw_release(&(*c)->sum);
  bw_release(&(*c)->now);
  bw_release(&(*c)->field);
  bw_release(&(*c)->twice);
  bw_release(c);
}

/* The whole plane on all ranks. */
static void gather(bw_ns_correlations *c, int row)
{
  const bw_grid_view *g = c->g;
  const int j = row - g->lo[1], n = g->n[0];
  const size_t section = (size_t)n * (size_t)g->n[2];
  /* Each rank writes its own part into zeros, so that the sum over ranks is the plane. */
  memset(c->field, 0, 3 * section * sizeof *c->field);
  for (int a = 0; a < 3 && j >= 1 && j <= g->m[1]; a++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int i = 1; i <= n; i++)
        c->field[(size_t)a * section + (size_t)(k + g->lo[2] - 1) * (size_t)n + (size_t)(i - 1)] =
            (double)c->ns->u[a][bw_at(g, i, j, k)];
  for (size_t a = 0; a < 3; a++)
    bw_comm_sum(c->ns->comm, section, c->field + a * section);
}

static double dot(int n, const double *restrict a, const double *restrict b)
{
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* Plane sums of one component over all points: mean, then products with lags in x, then in z. */
static void correlate(const bw_ns_correlations *c, const double *field, double *out)
{
  const int nx = c->g->n[0], nz = c->g->n[2];
  const double share = 1.0 / ((double)nx * nz);
  double *x = out + 1, *z = out + 1 + c->lags[0];
  for (int k = 0; k < nz; k++) {
    const double *row = field + (size_t)k * (size_t)nx;
    /* The row and its continuation stand one behind the other: a lag is an offset, without
     * modulo. */
    memcpy(c->twice, row, (size_t)nx * sizeof *row);
    memcpy(c->twice + nx, row, (size_t)nx * sizeof *row);
    /* R(r) needs the mean, too: <a(x) a(x + r)> - <a>^2. */
    for (int i = 0; i < nx; i++)
      out[0] += share * row[i];
    for (int r = 0; r < c->lags[0]; r++)
      x[r] += share * dot(nx, row, c->twice + r);
    for (int r = 0; r < c->lags[1]; r++)
      z[r] += share * dot(nx, row, field + (size_t)((k + r) % nz) * (size_t)nx);
  }
}

void bw_ns_correlations_sample(bw_ns_correlations *c)
{
  const size_t size = (size_t)c->planes * c->of_plane, one = c->of_plane / 3;
  const size_t section = (size_t)c->g->n[0] * (size_t)c->g->n[2];
  const int rank = bw_comm_rank(c->ns->comm), ranks = bw_comm_size(c->ns->comm);
  memset(c->now, 0, size * sizeof *c->now);
  for (int p = 0; p < c->planes; p++) {
    /* All ranks need the whole plane, but only one correlates it: planes are dealt out in turn. */
    gather(c, c->row[p]);
    if (p % ranks != rank) continue;
    for (size_t a = 0; a < 3; a++)
      correlate(c, c->field + a * section, c->now + (size_t)p * c->of_plane + a * one);
  }
  /* The others hold zeros for a plane, so the sum makes all ranks alike. */
  bw_comm_sum(c->ns->comm, size, c->now);
  for (size_t q = 0; q < size; q++)
    c->sum[q] += c->now[q];
  c->samples++;
}

long bw_ns_correlations_samples(const bw_ns_correlations *c)
{
  return c->samples;
}

void bw_ns_correlations_get(const bw_ns_correlations *c, int plane, int component, int direction,
                            double out[])
{
  const size_t one = c->of_plane / 3;
  const double *s = c->sum + (size_t)plane * c->of_plane + (size_t)component * one;
  const double share = c->samples > 0 ? 1.0 / (double)c->samples : 0.0, mean = s[0] * share;
  const int along = direction == 0 ? 0 : 1;
  const double *of = s + 1 + (along == 1 ? c->lags[0] : 0);
  /* The square of the mean is taken off last, from sums over all samples. */
  for (int r = 0; r < c->lags[along]; r++)
    out[r] = of[r] * share - mean * mean;
}

/* R is even and has the period n: its discrete Fourier transform is real, and E_m = E_-m are
 * added. */
void bw_ns_correlations_spectrum(const bw_ns_correlations *c, int plane, int component,
                                 int direction, double out[])
{
  const int n = c->g->n[direction], lags = c->lags[direction == 0 ? 0 : 1];
  const size_t one = c->of_plane / 3;
  const double *s = c->sum + (size_t)plane * c->of_plane + (size_t)component * one;
  const double share = c->samples > 0 ? 1.0 / (double)c->samples : 0.0, mean = s[0] * share;
  const double *of = s + 1 + (direction == 0 ? 0 : c->lags[0]), two_pi = 2.0 * acos(-1.0);
  /* E_m is the cosine transform of R, so that sum_m E_m = R(0) exactly. */
  for (int m = 0; m < lags; m++) {
    double sum = 0.0;
    for (int r = 0; r < lags; r++) {
      /* Lags r and n - r are the same; r = 0 and r = n/2 have no twin. */
      const double twin = r == 0 || 2 * r == n ? 1.0 : 2.0;
      sum += twin * (of[r] * share - mean * mean) *
             cos(two_pi * (double)(((long)m * r) % n) / (double)n);
    }
    out[m] = sum / n * (m == 0 || 2 * m == n ? 1.0 : 2.0);
  }
}

/* ---- state: planes, lags, samples, rows, sums ---- */
enum { HEAD = 4 };

size_t bw_ns_correlations_state_size(const bw_ns_correlations *c)
{
  return HEAD + (size_t)c->planes * (1 + c->of_plane);
}

void bw_ns_correlations_get_state(const bw_ns_correlations *c, double x[])
{
  x[0] = c->planes, x[1] = c->lags[0], x[2] = c->lags[1], x[3] = (double)c->samples;
  for (int p = 0; p < c->planes; p++)
    x[HEAD + p] = c->row[p];
  memcpy(x + HEAD + c->planes, c->sum, (size_t)c->planes * c->of_plane * sizeof *x);
}

bw_status bw_ns_correlations_set_state(bw_ns_correlations *c, const double x[])
{
  BW_REQUIRE(x[0] == c->planes && x[1] == c->lags[0] && x[2] == c->lags[1] && x[3] >= 0, BW_EINPUT,
             "ns_correlations: the state has %g planes, %g and %g lags; here are %d, %d and %d",
             x[0], x[1], x[2], c->planes, c->lags[0], c->lags[1]);
  for (int p = 0; p < c->planes; p++)
    BW_REQUIRE(x[HEAD + p] == c->row[p], BW_EINPUT,
               "ns_correlations: plane %d of the state is row %g, here %d", p, x[HEAD + p],
               c->row[p]);
  /* The state fits: heights and lags are those of this object. */
  c->samples = (long)x[3];
  memcpy(c->sum, x + HEAD + c->planes, (size_t)c->planes * c->of_plane * sizeof *x);
  return BW_OK;
}
