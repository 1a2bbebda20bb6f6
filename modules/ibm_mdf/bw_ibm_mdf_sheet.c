/* What a sheet of regularised forces does to the wall that it stands for. */
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

double bw_ibm_mdf_retraction(const bw_ibm_mdf_config *config)
{
  enum { COLUMNS = 4 }; /* 1, 2, 4, 8 iterations and more */
  static const double table[BW_KERNEL_COUNT][COLUMNS] = {
      [BW_KERNEL_ROMA3] = {0.33, 0.30, 0.28, 0.28},
      [BW_KERNEL_PESKIN4] = {0.48, 0.44, 0.42, 0.41},
      [BW_KERNEL_HAT2] = {0.26, 0.24, 0.23, 0.23},
  };
  /* Without slip: data/forcing_sheet/sheet_displacement.csv, the mean over the normals of a
   * cylinder and that over those of a sphere, which differ by less than 0.01. */
  static const double no_slip[BW_KERNEL_COUNT] = {
      [BW_KERNEL_ROMA3] = 0.28,
      [BW_KERNEL_PESKIN4] = 0.39,
      [BW_KERNEL_HAT2] = 0.19,
  };
  if (config->memory > 0.0) return no_slip[config->kernel];
  /* The columns double: n_iter from 2, 4, 8 on. */
  int column = 0;
  while (column < COLUMNS - 1 && config->n_iter >= 2 << column)
    column++;
  return table[config->kernel][column];
}

/* By how many spacings a flat sheet of this normal stops the fluid outside itself: the straight
 * line in n_x^4 + n_y^4 + n_z^4 through data/forcing_sheet/sheet_displacement.csv. */
static double displacement(bw_kernel_delta_id kernel, const double n[3])
{
  static const struct {
    double at_zero, slope;
  } line[BW_KERNEL_COUNT] = {
      [BW_KERNEL_ROMA3] = {0.3095, -0.0435},
      [BW_KERNEL_PESKIN4] = {0.408, -0.027},
      [BW_KERNEL_HAT2] = {0.233, -0.066},
  };
  double n4 = 0.0;
  for (int d = 0; d < 3; d++)
    n4 += n[d] * n[d] * n[d] * n[d];
  return line[kernel].at_zero + line[kernel].slope * n4;
}

static bw_status check_normals(const bw_ibm_mdf *ib, const double N[], double nu)
{
  BW_REQUIRE(ib->beta > 0.0, BW_EINPUT,
             "markers on the true surface need memory > 0: their shear is what they remember");
  BW_REQUIRE(nu > 0.0, BW_EINPUT, "markers on the true surface: viscosity = %g: must be > 0", nu);
  for (size_t i = 0; i < ib->n; i++) {
    const double *n = N + 3 * i, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    BW_REQUIRE(isnan(n[0]) || fabs(length - 1.0) < 1e-6, BW_EINPUT,
               "marker %zu: the normal must have the length 1 (or NaN for none), found %g", i,
               length);
  }
  return BW_OK;
}

bw_status bw_ibm_mdf_set_normals(bw_ibm_mdf *ib, const double N[], double nu)
{
  const bw_grid_view *g = ib->g;
  BW_TRY(bw_comm_agree(bw_grid_comm(ib->grid), check_normals(ib, N, nu)));
  if (ib->plan == NULL) return BW_OK;
  /* The way that the markers went, then their order by cell. */
  for (size_t i = 0; i < ib->n_sent; i++)
    memcpy(ib->answer + 3 * i, N + 3 * ib->sent_from[i], 3 * sizeof *N);
  bw_exchange_forward(ib->plan, 3 * sizeof *N, ib->answer, ib->reply);
  const double h2 = pow(ib->cell_volume, 2.0 / 3.0);
  for (size_t m = 0; m < ib->held; m++) {
    double *n = ib->N + 3 * m;
    memcpy(n, ib->reply + 3 * (size_t)ib->order[m], 3 * sizeof *n);
    /* A flat box has no third direction, and its sheets are lines. */
    if (g->n[2] == 1) n[2] = 0.0;
    const bool has = !isnan(n[0]) && !isnan(ib->M[3 * m]) && ib->dV[m] > 0.0;
    for (int d = 0; d < 3; d++)
      n[d] = has ? n[d] : 0.0;
    ib->along[m] = has ? displacement(ib->kernel_id, n) * h2 / nu : 0.0;
  }
  ib->sided = true;
  return BW_OK;
}
