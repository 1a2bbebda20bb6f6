/* The pressure inside closed surfaces, which no memory may hold. */
#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

static bw_status check(const bw_ibm_mdf *ib, int surfaces, const int surface[], const double N[])
{
  for (size_t i = 0; i < ib->n; i++) {
    const double *n = N + 3 * i, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    BW_REQUIRE(surface[i] >= -1 && surface[i] < surfaces, BW_EINPUT,
               "marker %zu: surface %d of %d: must be one of them, or -1", i, surface[i], surfaces);
    BW_REQUIRE(surface[i] < 0 || fabs(length - 1.0) < 1e-6, BW_EINPUT,
               "marker %zu: the normal of a closed surface must have the length 1, found %g", i,
               length);
  }
  return BW_OK;
}

static bw_status reserve(bw_ibm_mdf *ib, int surfaces)
{
  if (surfaces <= ib->surfaces_room) return BW_OK;
  ib->surfaces_room = 0;
  IBM_RENEW(&ib->enclosed, 2 * (size_t)surfaces);
  ib->surfaces_room = surfaces;
  return BW_OK;
}

bw_status bw_ibm_mdf_close(bw_ibm_mdf *ib, int surfaces, const int surface[], const double N[])
{
  bw_status st = check(ib, surfaces, surface, N);
  BW_THEN(st, reserve(ib, surfaces));
  BW_TRY(bw_comm_agree(bw_grid_comm(ib->grid), st));
  if (ib->plan == NULL || ib->beta == 0.0) return BW_OK;
  for (size_t i = 0; i < ib->n_sent; i++) {
    bw_ibm_mdf__wet *w = &ib->wet_sent[i];
    memcpy(w->N, N + 3 * ib->sent_from[i], sizeof w->N);
    w->surface = surface[ib->sent_from[i]];
  }
  /* The way that the markers went; `order` leads from their order by cell to that of arrival. */
  bw_exchange_forward(ib->plan, sizeof *ib->wet, ib->wet_sent, ib->wet);
  ib->surfaces = surfaces;
  bw_ibm_mdf__drain(ib);
  return BW_OK;
}

/* The closed surface that held marker m is on, if it has a memory of it, else NULL. */
static const bw_ibm_mdf__wet *closed(const bw_ibm_mdf *ib, size_t m)
{
  const bw_ibm_mdf__wet *w = &ib->wet[ib->order[m]];
  return w->surface < 0 || isnan(ib->M[3 * m]) ? NULL : w;
}

void bw_ibm_mdf__drain(bw_ibm_mdf *ib)
{
  if (ib->surfaces == 0) return;
  double *sum = ib->enclosed; /* of M.N and of dV */
  memset(sum, 0, 2 * (size_t)ib->surfaces * sizeof *sum);
  for (size_t m = 0; m < ib->held; m++) {
    const bw_ibm_mdf__wet *w = closed(ib, m);
    if (w == NULL) continue;
    const double *M = ib->M + 3 * m;
    sum[2 * w->surface] += M[0] * w->N[0] + M[1] * w->N[1] + M[2] * w->N[2];
    sum[2 * w->surface + 1] += ib->dV[m];
  }
  bw_comm_sum(bw_grid_comm(ib->grid), 2 * (size_t)ib->surfaces, sum);
  for (size_t m = 0; m < ib->held; m++) {
    const bw_ibm_mdf__wet *w = closed(ib, m);
    if (w == NULL || sum[2 * w->surface + 1] == 0.0) continue;
    const double jump = ib->dV[m] * sum[2 * w->surface] / sum[2 * w->surface + 1];
    for (size_t d = 0; d < 3; d++)
      ib->M[3 * m + d] -= jump * w->N[d];
  }
}
