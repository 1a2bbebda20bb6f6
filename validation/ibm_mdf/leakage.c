/* Claim: a sheet of markers across the flow stops it, whatever their number, up to a spacing.
 *
 * A sheet across a box that is periodic and driven by a constant gradient G: what still flows is
 * the leak, over G H^2/(12 nu), the flow between walls H apart (H = 12 h, the width of the box).
 * Markers of dV = spacing h^2 (their share of the sheet), evenly spaced, off the nodes.
 * Reference  the sheet with markers one spacing apart of the same program: the claim is that
 *            neither more markers nor fewer, up to a limit, change its leak. That leak is the
 *            slip that N_s iterations leave (of the order of G dt), reported.
 * Measured   steady; spacings 0.25 to 4 h, N_s 1 to 8, kernels; steps of half the viscous limit.
 * Tolerance  denser: 1e-3 of the leak, the sums of kernels over dense markers are constant to
 *            their smoothness. Wider: 5e-4 of the reference flow more than at one spacing, up to
 *            1.5 h (roma3), 2 h (peskin4), 1 h (hat2). Refused: markers whose volume is that of
 *            spacing h but which are a fifth of it apart (largest eigenvalue 5/2 by the sum of
 *            their kernels for roma3, above 2), and the hat at 4 h (4 sum phi^2 up to 4).
 * BUILD modules=ns_channel
 * TEST  ranks=1,2 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_validation.h"

#include <stdio.h>

enum { LENGTH = 24, WIDTH = 12, MOST = 200 }; /* cells; MOST: hundreds of steps */
static const double G = 1.0e-4,
                    STEADY =
                        1.0e-6 + 10.0 * BW_REAL_EPSILON; /* h = nu = 1; change of U per 100 steps */
static const double spacings[] = {1.0, 0.25, 0.5, 1.5, 2.0, 3.0, 4.0};
enum { SPACINGS = sizeof spacings / sizeof *spacings };

static bw_status make(const bw_comm *comm, bw_kernel_delta_id kernel, int n_iter, double spacing,
                      double dV, body_flow *f)
{
  const body_box box = {.n = {LENGTH, WIDTH, 1},
                        .h = 1.0,
                        .nu = 1.0,
                        .periodic = {true, true, true},
                        .forcing = BW_FORCING_GRADIENT,
                        .forcing_value = G,
                        .body = {.kernel = kernel, .n_iter = n_iter}};
  BW_TRY(body_flow_box(comm, &box, f));
  f->dt = 0.5 * bw_ns_channel_dt_max(f->fluid);
  body_surface s = {0};
  BW_TRY(body_surface_alloc(comm, (size_t)lround(WIDTH / spacing), &s));
  for (size_t q = 0; q < s.n; q++) {
    s.X[3 * q] = 11.3, s.X[3 * q + 1] = ((double)q + 0.37) * spacing, s.X[3 * q + 2] = 0.5;
    s.dV[q] = dV;
  }
  s.n_closed = 0; /* a sheet */
  const bw_status st = body_set_markers(f, &s);
  body_surface_free(&s);
  return st;
}

/* Flow through the sheet over that between walls; status: that of setting the markers. */
static bw_status leak(const bw_comm *comm, bw_kernel_delta_id kernel, int n_iter, double spacing,
                      double dV, double *ratio)
{
  body_flow f = {0};
  double last = HUGE_VAL, U = 0.0;
  bw_status st = make(comm, kernel, n_iter, spacing, dV, &f);
  for (int turn = 0; st == BW_OK && fabs(U - last) > STEADY * fabs(U); turn++) {
    if (turn == MOST)
      st = BW_FAIL(BW_EDIVERGED, "the leak is not steady after %d steps", 100 * MOST);
    last = U;
    for (int q = 0; q < 100 && st == BW_OK; q++)
      st = body_flow_step(&f);
    if (st == BW_OK) U = bw_ns_channel_summary(f.fluid).bulk_velocity;
  }
  *ratio = U / (G * WIDTH * WIDTH / 12.0);
  body_flow_destroy(&f);
  return st;
}

static void row(bw_validation *v, bw_kernel_delta_id kernel, int n_iter, double spacing,
                double measured, double reference)
{
  static const double widest[BW_KERNEL_COUNT] = {
      [BW_KERNEL_ROMA3] = 1.5, [BW_KERNEL_PESKIN4] = 2.0, [BW_KERNEL_HAT2] = 1.0};
  const double more = 5.0e-4 / reference; /* as a part of the reference leak */
  const double tolerance = spacing <= 1.0 ? 1.0e-3 : spacing <= widest[kernel] ? more : INFINITY;
  const char *name = bw_kernel_delta_get(kernel)->name;
  char claim[80], extra[96];
  snprintf(claim, sizeof claim, "leak, markers %.2f h apart, %s, N_s %d", spacing, name, n_iter);
  snprintf(extra, sizeof extra, "\"kernel\": \"%s\", \"n_iter\": %d, \"spacing\": %g", name, n_iter,
           spacing);
  bw_validation_row(v, &(bw_claim){claim, "leak", measured, reference, tolerance, BW_CONSERVATION,
                                   "one spacing apart", extra});
}

static bw_status one_kernel(bw_validation *v, bw_kernel_delta_id kernel, int n_iter)
{
  double reference = NAN, ratio = NAN;
  for (int q = 0; q < SPACINGS; q++) {
    if (kernel == BW_KERNEL_HAT2 && spacings[q] > 2.0) continue; /* refused, see below */
    BW_TRY(leak(bw_validation_comm(v), kernel, n_iter, spacings[q], spacings[q], &ratio));
    if (q == 0) reference = ratio;
    row(v, kernel, n_iter, spacings[q], ratio, reference);
  }
  return BW_OK;
}

static void refused(bw_validation *v, const char *claim, bw_kernel_delta_id kernel, double spacing,
                    double dV)
{
  double ratio = NAN;
  const bw_status st = leak(bw_validation_comm(v), kernel, 2, spacing, dV, &ratio);
  bw_validation_row(v, &(bw_claim){claim, "status", (double)st, (double)BW_EINPUT, 0.0,
                                   BW_CONSERVATION, "largest eigenvalue above 2", NULL});
}

static bw_status run(bw_validation *v)
{
  for (int k = 0; k < BW_KERNEL_COUNT; k++)
    for (int n = 1; n <= 8; n *= bw_validation_full(v) ? 2 : 4)
      BW_TRY(one_kernel(v, (bw_kernel_delta_id)k, n));
  refused(v, "five times too much volume is refused", BW_KERNEL_ROMA3, 0.2, 1.0);
  refused(v, "the hat with markers 4 h apart is refused", BW_KERNEL_HAT2, 4.0, 4.0);
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.leakage", run);
}
