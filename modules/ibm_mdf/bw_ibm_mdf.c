#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

bw_ibm_mdf_config bw_ibm_mdf_config_default(void)
{
  return (bw_ibm_mdf_config){.kernel = BW_KERNEL_ROMA3, .n_iter = 2};
}

double bw_ibm_mdf_retraction(const bw_ibm_mdf_config *config)
{
  enum { COLUMNS = 4 }; /* 1, 2, 4, 8 iterations and more */
  static const double table[BW_KERNEL_COUNT][COLUMNS] = {
      [BW_KERNEL_ROMA3] = {0.33, 0.30, 0.28, 0.28},
      [BW_KERNEL_PESKIN4] = {0.48, 0.44, 0.42, 0.41},
      [BW_KERNEL_HAT2] = {0.26, 0.24, 0.23, 0.23},
  };
  int column = 0;
  while (column < COLUMNS - 1 && config->n_iter >= 2 << column)
    column++;
  return table[config->kernel][column];
}

bw_status bw_ibm_mdf_create(bw_grid *grid, const bw_ibm_mdf_config *config, bw_ibm_mdf **out)
{
  const bw_grid_view *g = bw_grid_look(grid);
  *out = NULL;
  BW_REQUIRE(config->n_iter >= 1, BW_EINPUT, "n_iter: at least 1 forcing iteration, found %d",
             config->n_iter);
  BW_REQUIRE((int)config->kernel >= 0 && config->kernel < BW_KERNEL_COUNT, BW_EINPUT,
             "kernel: no row %d in the table of %d", (int)config->kernel, (int)BW_KERNEL_COUNT);
  BW_REQUIRE(g->uniform_y, BW_EINPUT,
             "the immersed boundary needs one spacing per direction: y must not be stretched");
  BW_REQUIRE(g->halo[0] == 2 && g->halo[1] == 2 && (g->n[2] == 1 || g->halo[2] == 2), BW_EINPUT,
             "the immersed boundary needs a grid with halo 2, found %d", g->halo[0]);

  bw_ibm_mdf *ib = NULL;
  bw_status st = BW_ALLOCATE(&ib, 1);
  BW_TRY(bw_comm_agree(bw_grid_comm(grid), st));
  ib->grid = grid;
  ib->g = g;
  ib->kernel = bw_kernel_delta_get(config->kernel);
  ib->n_iter = config->n_iter;
  ib->cell_volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  ib->interpolate = bw_ibm_mdf__interpolator(ib->kernel->support, g->n[2] == 1);
  ib->spread = bw_ibm_mdf__spreader(ib->kernel->support, g->n[2] == 1);
  *out = ib;
  return BW_OK;
}

void bw_ibm_mdf_destroy(bw_ibm_mdf **ib)
{
  if (*ib == NULL) return;
  bw_ibm_mdf *b = *ib;
  bw_exchange_destroy(&b->plan);
  void *const arrays[] = {&b->sent_from, &b->destination, &b->item, &b->answer,   &b->received,
                          &b->order,     &b->swap,        &b->key,  &b->key_swap, &b->stencil,
                          &b->V,         &b->dV,          &b->QdV,  &b->reply,    &b->U};
  for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
    bw_release(arrays[a]);
  bw_release(ib);
}

/* Spread U (held,3, times dV/h^3) onto u. What falls into halos travels to its owners: the halos
 * are zeroed first, so that the reduction adds nothing but the spread, and refreshed after. */
static void spread_and_update(bw_ibm_mdf *ib, bw_real *const u[3])
{
  const int components = u[2] == NULL ? 2 : 3;
  bw_ibm_mdf__clear_halos(ib->g, u);
  ib->spread(ib->held, ib->stencil, ib->g->stride, ib->U, u);
  bw_halo_reduce(ib->grid, components, u);
  bw_halo_update(ib->grid, components, u);
}

/* U <- (V - U) dV/h^3, QdV += (V - U) dV/dt; returns sum |V - U|^2. */
static double velocity_to_force(bw_ibm_mdf *ib, int components, double dt)
{
  double slip = 0.0;
  for (size_t m = 0; m < ib->held; m++) {
    const double dV = ib->dV[m], share = dV / ib->cell_volume;
    for (int c = 0; c < components; c++) {
      const double lack = ib->V[3 * m + c] - (double)ib->U[3 * m + c];
      slip += lack * lack;
      ib->QdV[3 * m + c] += lack * dV / dt;
      ib->U[3 * m + c] = (bw_real)(lack * share);
    }
  }
  return slip;
}

void bw_ibm_mdf_force(bw_ibm_mdf *ib, bw_real *const u[3], double dt)
{
  if (ib->markers == ib->outside) return;
  for (int s = 0; s < ib->n_iter; s++) {
    ib->interpolate(ib->held, ib->stencil, ib->g->stride, u, ib->U);
    const double slip = velocity_to_force(ib, u[2] == NULL ? 2 : 3, dt);
    if (s == 0) ib->slip_sum = slip;
    spread_and_update(ib, u);
  }
}

void bw_ibm_mdf_begin_step(bw_ibm_mdf *ib)
{
  if (ib->held > 0) memset(ib->QdV, 0, 3 * ib->held * sizeof *ib->QdV);
}

/* held (sorted) values in reply's order -> the caller's array; markers outside get zero. */
static void return_to_caller(bw_ibm_mdf *ib, double out[])
{
  if (ib->n > 0) memset(out, 0, 3 * ib->n * sizeof *out);
  if (ib->plan == NULL) return;
  bw_exchange_backward(ib->plan, 3 * sizeof *ib->reply, ib->reply, ib->answer);
  for (size_t i = 0; i < ib->n_sent; i++)
    memcpy(out + 3 * ib->sent_from[i], ib->answer + 3 * i, 3 * sizeof *out);
}

void bw_ibm_mdf_marker_force(bw_ibm_mdf *ib, double QdV[])
{
  for (size_t m = 0; m < ib->held; m++)
    memcpy(ib->reply + 3 * (size_t)ib->order[m], ib->QdV + 3 * m, 3 * sizeof *QdV);
  return_to_caller(ib, QdV);
}

void bw_ibm_mdf_interpolate(bw_ibm_mdf *ib, bw_real *const u[3], double U[])
{
  ib->interpolate(ib->held, ib->stencil, ib->g->stride, u, ib->U);
  for (size_t m = 0; m < ib->held; m++)
    for (int c = 0; c < 3; c++)
      ib->reply[3 * (size_t)ib->order[m] + c] = (double)ib->U[3 * m + c];
  return_to_caller(ib, U);
}

void bw_ibm_mdf_spread(bw_ibm_mdf *ib, const double F[], bw_real *const u[3])
{
  if (ib->plan == NULL) return;
  for (size_t i = 0; i < ib->n_sent; i++)
    memcpy(ib->answer + 3 * i, F + 3 * ib->sent_from[i], 3 * sizeof *F);
  bw_exchange_forward(ib->plan, 3 * sizeof *F, ib->answer, ib->reply);
  for (size_t m = 0; m < ib->held; m++)
    for (int c = 0; c < 3; c++)
      ib->U[3 * m + c] =
          (bw_real)(ib->reply[3 * (size_t)ib->order[m] + c] * ib->dV[m] / ib->cell_volume);
  spread_and_update(ib, u);
}

bw_ibm_mdf_report bw_ibm_mdf_measure(bw_ibm_mdf *ib, bw_real *const u[3])
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  const int components = u[2] == NULL ? 2 : 3;
  double sum[5] = {ib->slip_sum, 0.0, 0.0, 0.0, 0.0};
  double most[3] = {(double)ib->held, -HUGE_VAL, -HUGE_VAL}; /* held, dV/h^3, -dV/h^3 */
  ib->interpolate(ib->held, ib->stencil, ib->g->stride, u, ib->U);
  for (size_t m = 0; m < ib->held; m++) {
    const double volume = ib->dV[m] / ib->cell_volume;
    most[1] = fmax(most[1], volume);
    most[2] = fmax(most[2], -volume);
    for (int c = 0; c < components; c++) {
      const double lack = ib->V[3 * m + c] - (double)ib->U[3 * m + c];
      sum[1] += lack * lack;
      sum[2 + c] += ib->QdV[3 * m + c];
    }
  }
  bw_comm_sum(comm, 5, sum);
  bw_comm_max(comm, 3, most);
  const double inside = (double)(ib->markers - ib->outside);
  const double per_marker = inside > 0.0 ? 1.0 / inside : 0.0;
  return (bw_ibm_mdf_report){.slip_before = sqrt(sum[0] * per_marker),
                             .slip_after = sqrt(sum[1] * per_marker),
                             .total_force = {sum[2], sum[3], sum[4]},
                             .markers = ib->markers,
                             .outside = ib->outside,
                             .imbalance = most[0] * bw_comm_size(comm) * per_marker,
                             .spacing_min = inside > 0.0 ? -most[2] : 0.0,
                             .spacing_max = inside > 0.0 ? most[1] : 0.0};
}
