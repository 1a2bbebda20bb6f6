/* Claim: every forcing iteration removes a known part of the slip.
 *
 * A uniform stream meets markers at rest, one spacing apart (dV = area times h).
 * Reference  a flat sheet on the grid: the kernels of the sheet add up to 1 in its plane, and
 *            across it interpolation after spreading gives sum phi^2 = 1/2 (Roma), 3/8 (Peskin),
 *            wherever the sheet lies: the slip after N_s iterations is (1 - C)^N_s, exactly.
 *            For a sphere and a cylinder the same factor per iteration holds on average; it is
 *            measured and reported, and the claim is only that slip falls with every iteration.
 * Tolerance  flat sheet: round-off of N_s products.
 * BUILD modules=ibm_mdf
 * TEST  ranks=1,2 */
#include "bw_ibm_mdf.h"
#include "bw_memory.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

enum { CELLS = 24, MARKERS = 2 * CELLS * CELLS, MOST_ITERATIONS = 8 };
static const double PI = 3.14159265358979323846;

typedef struct {
  size_t n;
  double X[3 * MARKERS], V[3 * MARKERS], dV[MARKERS];
} marker_set;

static void add(marker_set *s, double x, double y, double z, double dV)
{
  s->X[3 * s->n] = x, s->X[3 * s->n + 1] = y, s->X[3 * s->n + 2] = z;
  s->dV[s->n++] = dV;
}

/* The plane y = 11.3 h. */
static void sheet(marker_set *s)
{
  for (int q = 0; q < CELLS * CELLS; q++)
    add(s, q % CELLS + 0.4, 11.3, q / CELLS + 0.1, 1.0); /* h = 1 */
}

/* Radius 7.5 h; markers on a spiral, evenly (as FSI's 15 cells across the cylinder). */
static void sphere(marker_set *s)
{
  const double R = 7.5, area = 4.0 * PI * R * R, golden = PI * (3.0 - sqrt(5.0));
  const int count = (int)(area + 0.5);
  for (int q = 0; q < count; q++) {
    const double z = 1.0 - (2.0 * q + 1.0) / count, r = sqrt(1.0 - z * z);
    add(s, 12.0 + R * r * cos(golden * q), 12.0 + R * r * sin(golden * q), 12.0 + R * z,
        area / count);
  }
}

static void cylinder(marker_set *s)
{
  const double R = 7.5;
  const int count = (int)(2.0 * PI * R + 0.5);
  for (int q = 0; q < count * CELLS; q++) {
    const double angle = 2.0 * PI * (q % count) / count;
    add(s, 12.0 + R * cos(angle), 12.0 + R * sin(angle), q / count + 0.3, 2.0 * PI * R / count);
  }
}

/* rms slip over its value before, after n_iter iterations. */
static bw_status slip_after(bw_grid *grid, const marker_set *s, bw_kernel_delta_id kernel,
                            int n_iter, double *ratio)
{
  bw_ibm_mdf *ib = NULL;
  bw_ibm_mdf_config c = bw_ibm_mdf_config_default();
  bw_real *u[3] = {NULL, NULL, NULL};
  const size_t mine = bw_comm_rank(bw_grid_comm(grid)) == 0 ? s->n : 0;
  bw_status st = BW_OK;
  c.kernel = kernel;
  c.n_iter = n_iter;
  c.memory = 0.0;
  for (int d = 0; d < 3; d++)
    BW_THEN(st, bw_field_create(grid, &u[d]));
  for (size_t a = 0; st == BW_OK && a < bw_grid_look(grid)->size; a++)
    u[0][a] = 1;
  BW_THEN(st, bw_ibm_mdf_create(grid, &c, &ib));
  BW_THEN(st, bw_ibm_mdf_set_markers(ib, mine, s->X, s->V, s->dV, NULL));
  if (st == BW_OK) {
    bw_ibm_mdf_force(ib, u, 1.0);
    const bw_ibm_mdf_report r = bw_ibm_mdf_measure(ib, u);
    *ratio = r.slip_after / r.slip_before;
  }
  bw_ibm_mdf_destroy(&ib);
  for (int d = 0; d < 3; d++)
    bw_release(&u[d]);
  return st;
}

typedef struct {
  const char *name;
  void (*make)(marker_set *s);
  bool exact;
} body;

static bw_status one_body(bw_validation *v, bw_grid *grid, const body *b, bw_kernel_delta_id kernel,
                          marker_set *s)
{
  const double left = 1.0 - bw_kernel_delta_get(kernel)->sum_of_squares;
  double last = 1.0, worst = 0.0;
  s->n = 0;
  b->make(s);
  for (int n = 1; n <= MOST_ITERATIONS; n *= 2) {
    double ratio = NAN;
    char claim[80], extra[96];
    BW_TRY(slip_after(grid, s, kernel, n, &ratio));
    snprintf(claim, sizeof claim, "%s, %s: slip left after %d", b->name,
             bw_kernel_delta_get(kernel)->name, n);
    snprintf(extra, sizeof extra, "\"body\": \"%s\", \"kernel\": \"%s\", \"n_iter\": %d", b->name,
             bw_kernel_delta_get(kernel)->name, n);
    bw_validation_row(v, &(bw_claim){claim, "slip_ratio", ratio, pow(left, n),
                                     b->exact ? 100.0 * BW_REAL_EPSILON : INFINITY, BW_ANALYTIC,
                                     "(1 - sum phi^2)^N_s of a flat sheet", extra});
    worst = fmax(worst, ratio / last);
    last = ratio;
  }
  char claim[80];
  snprintf(claim, sizeof claim, "%s, %s: slip falls every time", b->name,
           bw_kernel_delta_get(kernel)->name);
  bw_validation_row(v,
                    &(bw_claim){claim, "largest_ratio_of_successive", fmax(worst - 1.0, 0.0), 0.0,
                                0.0, BW_ORDER, "ratio below 1, excess over 1 reported", NULL});
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const body bodies[] = {
      {"sheet", sheet, true}, {"sphere", sphere, false}, {"cylinder", cylinder, false}};
  bw_grid *grid = NULL;
  bw_grid_config c = bw_grid_config_default();
  marker_set *s = NULL;
  for (int d = 0; d < 3; d++)
    c.n[d] = CELLS, c.length[d] = CELLS, c.periodic[d] = true;
  c.halo = 2;
  bw_status st = BW_ALLOCATE(&s, 1);
  BW_THEN(st, bw_grid_create(bw_validation_comm(v), &c, &grid));
  for (int k = BW_KERNEL_ROMA3; k <= BW_KERNEL_PESKIN4; k++)
    for (int b = 0; b < 3; b++)
      BW_THEN(st, one_body(v, grid, &bodies[b], (bw_kernel_delta_id)k, s));
  bw_release(&s);
  bw_grid_destroy(&grid);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.no_slip", run);
}
