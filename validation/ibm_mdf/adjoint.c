/* Claim: spreading is the adjoint of interpolation, and keeps force and torque.
 *
 *   sum F.U(u) dV over markers = sum u.q h^3 over cells  for random u and F   (power is passed on)
 *   sum q h^3 = sum F dV,  sum x x q h^3 = sum X x F dV                       (POROUS 3.5.1, 3-4)
 * Reference  the identities themselves; they hold for any kernel with the zeroth and first moment.
 * Measured   3000 random markers in a 24 x 20 x 28 box of unequal spacings, every kernel, dV = half
 * a cell each (clusters of hats with more would make forcing grow, and are refused); the difference
 * over the sum of the absolute terms. Tolerance  n terms of either sign lose about sqrt(n) eps; n =
 * 13440 cells gives 1e-14, a factor of ten is allowed. One wrong node weight would show at 1e-3.
 * BUILD modules=ibm_mdf
 * TEST  ranks=1,2 */
#include "bw_ibm_mdf.h"
#include "bw_memory.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

enum { MARKERS = 3000 };

typedef struct {
  bw_grid *grid;
  const bw_grid_view *g;
  bw_real *u[3], *q[3];
  size_t n;
  double *X, *F, *U, *dV;
} set_up;

static double number(uint64_t *state) /* xorshift, [-1, 1) */
{
  *state ^= *state << 13, *state ^= *state >> 7, *state ^= *state << 17;
  return (double)(*state >> 11) / 4503599627370496.0 - 1.0;
}

/* All ranks draw the same markers and keep every size-th. */
static bw_status markers(set_up *s, const bw_comm *comm)
{
  uint64_t seed = 88172645463325252u;
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  BW_TRY(BW_ALLOCATE(&s->X, 3 * MARKERS));
  BW_TRY(BW_ALLOCATE(&s->F, 3 * MARKERS));
  BW_TRY(BW_ALLOCATE(&s->U, 3 * MARKERS));
  BW_TRY(BW_ALLOCATE(&s->dV, MARKERS));
  for (int m = 0; m < MARKERS; m++) {
    double x[3], f[3];
    for (int d = 0; d < 3; d++) { /* three cells from the seam, where x is not unique */
      const double half = 0.5 * s->g->length[d];
      x[d] = half + (half - 3.0 * s->g->spacing[d]) * number(&seed);
      f[d] = number(&seed);
    }
    if (m % size != me) continue;
    for (int d = 0; d < 3; d++)
      s->X[3 * s->n + d] = x[d], s->F[3 * s->n + d] = f[d];
    s->dV[s->n++] = 0.5 * s->g->spacing[0] * s->g->spacing[1] * s->g->spacing[2];
  }
  return BW_OK;
}

static bw_status build(set_up *s, const bw_comm *comm)
{
  bw_grid_config c = bw_grid_config_default();
  static const int n[3] = {24, 20, 28};
  for (int d = 0; d < 3; d++)
    c.n[d] = n[d], c.length[d] = n[d] * (0.1 + 0.02 * d), c.periodic[d] = true;
  c.halo = 2;
  BW_TRY(bw_grid_create(comm, &c, &s->grid));
  s->g = bw_grid_look(s->grid);
  for (int d = 0; d < 3; d++) {
    BW_TRY(bw_field_create(s->grid, &s->u[d]));
    BW_TRY(bw_field_create(s->grid, &s->q[d]));
    uint64_t seed = 1234567u + (uint64_t)(d + 3 * bw_comm_rank(comm));
    for (size_t a = 0; a < s->g->size; a++)
      s->u[d][a] = (bw_real)number(&seed);
  }
  bw_halo_update(s->grid, 3, s->u);
  return markers(s, comm);
}

/* sum[0] power at markers, [1] on the grid, [2] scale; force and torque: [3..8], [9..14]. */
static void add_markers(const set_up *s, double sum[15])
{
  for (size_t m = 0; m < s->n; m++) {
    const double *x = s->X + 3 * m, *F = s->F + 3 * m, dV = s->dV[m];
    for (int c = 0; c < 3; c++) {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      sum[0] += F[c] * s->U[3 * m + c] * dV;
      sum[2] += fabs(F[c] * s->U[3 * m + c]) * dV;
      sum[3 + c] += F[c] * dV;
      sum[6 + c] += (x[a] * F[b] - x[b] * F[a]) * dV;
    }
  }
}

static void add_cells(const set_up *s, double sum[15])
{
  const bw_grid_view *g = s->g;
  const double volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  for (int c = 0; c < 3; c++)
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const int cell[3] = {i, j, k}, a = (c + 1) % 3, b = (c + 2) % 3;
          const double q = (double)s->q[c][bw_at(g, i, j, k)] * volume;
          double x[3];
          for (int d = 0; d < 3; d++)
            x[d] = (cell[d] + g->lo[d] - (c == d ? 0.0 : 0.5)) * g->spacing[d];
          sum[1] += q * (double)s->u[c][bw_at(g, i, j, k)];
          sum[9 + c] += q;
          sum[12 + b] -= x[a] * q; /* e_a x e_c = -e_b */
          sum[12 + a] += x[b] * q; /* e_b x e_c = e_a */
        }
}

static bw_status one_kernel(bw_validation *v, set_up *s, bw_kernel_delta_id id)
{
  static const char *const quantity[3] = {"power", "force", "torque"};
  bw_ibm_mdf *ib = NULL;
  bw_ibm_mdf_config c = bw_ibm_mdf_config_default();
  double sum[15] = {0.0}, error[3] = {0.0};
  c.kernel = id;
  BW_TRY(bw_ibm_mdf_create(s->grid, &c, &ib));
  BW_TRY(bw_ibm_mdf_set_markers(ib, s->n, s->X, s->F, s->dV, NULL));
  for (int d = 0; d < 3; d++)
    for (size_t a = 0; a < s->g->size; a++)
      s->q[d][a] = 0;
  bw_ibm_mdf_interpolate(ib, s->u, s->U);
  bw_ibm_mdf_spread(ib, s->F, s->q);
  add_markers(s, sum);
  add_cells(s, sum);
  bw_comm_sum(bw_validation_comm(v), 15, sum);
  error[0] = fabs(sum[0] - sum[1]) / sum[2];
  for (int d = 0; d < 3; d++) { /* scale: MARKERS dV, and that times the box */
    const double scale = MARKERS * s->g->spacing[0] * s->g->spacing[1] * s->g->spacing[2];
    error[1] = fmax(error[1], fabs(sum[3 + d] - sum[9 + d]) / scale);
    error[2] = fmax(error[2], fabs(sum[6 + d] - sum[12 + d]) / (scale * s->g->length[2]));
  }
  for (int q = 0; q < 3; q++) {
    char claim[80], extra[64];
    snprintf(claim, sizeof claim, "%s is passed on, %s", quantity[q],
             bw_kernel_delta_get(id)->name);
    snprintf(extra, sizeof extra, "\"kernel\": \"%s\"", bw_kernel_delta_get(id)->name);
    bw_validation_row(v, &(bw_claim){claim, quantity[q], error[q], 0.0,
                                     sizeof(bw_real) == 8 ? 1.0e-13 : 1.0e-5, BW_CONSERVATION,
                                     "identity of adjoint operators", extra});
  }
  bw_ibm_mdf_destroy(&ib);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  set_up s = {.grid = NULL};
  bw_status st = build(&s, bw_validation_comm(v));
  for (int id = 0; st == BW_OK && id < BW_KERNEL_COUNT; id++)
    st = one_kernel(v, &s, (bw_kernel_delta_id)id);
  for (int d = 0; d < 3; d++) {
    bw_release(&s.u[d]);
    bw_release(&s.q[d]);
  }
  bw_release(&s.X);
  bw_release(&s.F);
  bw_release(&s.U);
  bw_release(&s.dV);
  bw_grid_destroy(&s.grid);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.adjoint", run);
}
