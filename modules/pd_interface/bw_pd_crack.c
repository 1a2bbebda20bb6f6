/* Cracked particles of all ranks; branches, fork and angle of a crack along a line. */
#include "bw_pd_crack.h"
#include "bw_memory.h"
#include <math.h>
#include <stdlib.h>

enum { MOST_BRANCHES = 32 };

bw_pd_crack_config bw_pd_crack_config_default(void)
{
  return (bw_pd_crack_config){
      .level = BW_PD_CRACK_LEVEL, .along = {1.0, 0.0, 0.0}, .across = {0.0, 1.0, 0.0}};
}

static double component(const double x[3], const double e[3])
{
  return x[0] * e[0] + x[1] * e[1] + x[2] * e[2];
}

typedef struct {
  double s, t;
} point;

static int by_place(const void *a, const void *b)
{
  const point *p = a, *q = b;
  if (p->s != q->s) return p->s < q->s ? -1 : 1;
  return (p->t > q->t) - (p->t < q->t);
}

static bw_status own_points(const bw_pd_crack_config *config, size_t count, const double X0[],
                            const double damage[], size_t *n, point **out)
{
  *n = 0;
  /* Counted first, so that one array of the right size is enough. */
  for (size_t h = 0; h < count; h++)
    *n += damage[h] > config->level;
  BW_TRY(BW_ALLOCATE(out, *n));
  size_t k = 0;
  for (size_t h = 0; h < count; h++)
    if (damage[h] > config->level)
      (*out)[k++] = (point){.s = component(&X0[3 * h], config->along),
                            .t = component(&X0[3 * h], config->across)};
  return BW_OK;
}

bw_status bw_pd_crack_collect(const bw_comm *comm, const bw_pd_crack_config *config, size_t n,
                              const double X0[], const double damage[], bw_pd_crack *out)
{
  *out = (bw_pd_crack){0};
  size_t mine = 0, bytes = 0;
  point *own = NULL;
  void *gathered = NULL;
  bw_status st = bw_comm_agree(comm, own_points(config, n, X0, damage, &mine, &own));
  /* Every rank gets the whole crack, which is thin: a list of all is affordable. */
  BW_THEN(st, bw_comm_allgather(comm, mine * sizeof *own, own, &bytes, &gathered));
  point *all = gathered;
  const size_t found = bytes / sizeof *all;
  BW_THEN(st, BW_ALLOCATE(&out->s, found));
  BW_THEN(st, BW_ALLOCATE(&out->t, found));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    /* Sorted by place, so that the list does not depend on ranks, and sections are ranges of it. */
    qsort(all, found, sizeof *all, by_place);
    out->n = found;
    for (size_t q = 0; q < found; q++)
      out->s[q] = all[q].s, out->t[q] = all[q].t;
  } else {
    bw_pd_crack_release(out);
  }
  bw_release(&own);
  bw_release(&gathered);
  return st;
}

void bw_pd_crack_release(bw_pd_crack *crack)
{
  bw_release(&crack->s);
  bw_release(&crack->t);
  crack->n = 0;
}

/* First point with s >= limit. */
static size_t first_from(const bw_pd_crack *c, double limit)
{
  size_t low = 0, high = c->n;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (c->s[middle] < limit)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Smallest t above `from` in the section a .. b; NAN when there is none. */
static double next_across(const bw_pd_crack *c, size_t a, size_t b, double from)
{
  double best = INFINITY;
  for (size_t q = a; q < b; q++)
    if (c->t[q] > from && c->t[q] < best) best = c->t[q];
  return isfinite(best) ? best : NAN;
}

int bw_pd_crack_branches(const bw_pd_crack *crack, double station, double half, double gap,
                         int most, double middle[])
{
  const double tie = 1e-6 * half; /* particles on the section's edge count once, on both sides */
  /* The section is a range of the list, which rises in s. */
  const size_t a = first_from(crack, station - half - tie);
  const size_t b = first_from(crack, station + half + tie);
  int branches = 0;
  double sum = 0.0, members = 0.0;
  double before = -INFINITY, t = next_across(crack, a, b, before);
  /* Through the section by rising t; a gap begins a new branch. */
  while (!isnan(t)) {
    if (branches == 0 || t - before > gap) {
      branches++;
      sum = members = 0.0;
    }
    sum += t;
    members += 1.0;
    if (middle != NULL && branches <= most) middle[branches - 1] = sum / members;
    before = t;
    t = next_across(crack, a, b, before);
  }
  return branches;
}

double bw_pd_crack_fork(const bw_pd_crack *crack, double from, double step, int run, double gap)
{
  if (crack->n == 0) return NAN;
  int forked = 0;
  /* A fork counts when several sections in a row have it: a single cracked neighbour does not. */
  for (int k = 0; from + k * step <= crack->s[crack->n - 1] + 0.5 * step; k++) {
    const double s = from + k * step;
    forked = bw_pd_crack_branches(crack, s, 0.5 * step, gap, 0, NULL) >= 2 ? forked + 1 : 0;
    if (forked == run) return s - (run - 1) * step;
  }
  return NAN;
}

/* Least-squares slope dt/ds. */
static double slope(int n, double sum_s, double sum_t, double sum_ss, double sum_st)
{
  return (n * sum_st - sum_s * sum_t) / (n * sum_ss - sum_s * sum_s);
}

double bw_pd_crack_angle(const bw_pd_crack *crack, double a, double b, double step, double gap)
{
  int n = 0;
  double s1 = 0.0, s2 = 0.0, low_t = 0.0, low_st = 0.0, high_t = 0.0, high_st = 0.0;
  for (int k = 0; a + k * step <= b; k++) {
    const double s = a + k * step;
    double middle[MOST_BRANCHES];
    const int m = bw_pd_crack_branches(crack, s, 0.5 * step, gap, MOST_BRANCHES, middle);
    /* Only forked sections tell an angle. */
    if (m < 2 || m > MOST_BRANCHES) continue;
    n++;
    s1 += s, s2 += s * s;
    /* Sums of two straight lines, the lowest and the highest branch. */
    low_t += middle[0], low_st += s * middle[0];
    high_t += middle[m - 1], high_st += s * middle[m - 1];
  }
  if (n < 3) return NAN;
  return atan(slope(n, s1, high_t, s2, high_st)) - atan(slope(n, s1, low_t, s2, low_st));
}
