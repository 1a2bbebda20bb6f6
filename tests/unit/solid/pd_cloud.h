/* pd_cloud.h -- a disordered cloud and its pairs, for the tests of the solid. */
#pragma once
#include "pd_test.h"

static const double DISORDER = 0.3;

static inline bw_solid_config cloudy(bw_pd_geometry geometry)
{
  bw_solid_config c = pd_soft(geometry);
  c.disorder = DISORDER;
  return c;
}

/* Rows by global id, on all ranks. */
static inline double *rows_of(const bw_solid *pd, pd_getter get)
{
  double *all = NULL;
  bw_check_ok(BW_ALLOCATE(&all, 3 * (size_t)bw_solid_total(pd)));
  pd_gather(pd, get, all);
  return all;
}

/* b - a, the nearest image. */
static inline double apart(const bw_solid_config *c, const double a[3], const double b[3],
                           double d[3])
{
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = b[k] - a[k];
    if (c->period[k] > 0) d[k] -= c->period[k] * round(d[k] / c->period[k]);
    r2 += d[k] * d[k];
  }
  return sqrt(r2);
}
