/* Claim: what markers spread into halo cells reaches the owners, nothing is lost or doubled, and
 * spreading over blocks is the exact transpose of interpolating over blocks.
 * Reference: equality of two sums over all ranks: <update f, g> = <f, reduce g>, and the sum of g
 * before and after reduce where every direction is periodic (no ghost beyond a boundary).
 * Tolerance: the sums have N terms of random sign; their round-off grows as sqrt(N) epsilon
 * |f||g|: below 1e-13 of the sum of absolute values for N up to 1e6 (double).
 * TEST ranks=1,2,4
 * BUILD modules=grid */
#include "bw_grid.h"
#include "bw_memory.h"
#include "bw_validation.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>

static void noise(bw_real *f, size_t n, uint64_t seed)
{
  for (size_t q = 0; q < n; q++) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    f[q] = (bw_real)((double)(seed >> 11) / 9007199254740992.0 - 0.5);
  }
}

typedef struct {
  double update, reduce, magnitude; /* <update f, g>, <f, reduce g>, sum |terms| */
  double before, after;             /* sum of g */
} sums;

static void add_up(const bw_grid_view *v, const bw_real *f, const bw_real *uf, const bw_real *g,
                   const bw_real *rg, sums *s)
{
  for (int k = 1 - v->halo[2]; k <= v->m[2] + v->halo[2]; k++)
    for (int j = 1 - v->halo[1]; j <= v->m[1] + v->halo[1]; j++)
      for (int i = 1 - v->halo[0]; i <= v->m[0] + v->halo[0]; i++) {
        const ptrdiff_t at = bw_at(v, i, j, k);
        s->update += (double)uf[at] * (double)g[at];
        s->reduce += (double)f[at] * (double)rg[at];
        s->magnitude += fabs((double)uf[at] * (double)g[at]);
        s->before += (double)g[at];
        s->after += (double)rg[at];
      }
}

static bw_status measure(const bw_comm *comm, const bw_grid_config *c, sums *s)
{
  bw_grid *grid = NULL;
  bw_real *f[4] = {NULL, NULL, NULL, NULL}; /* f, update f, g, reduce g */
  bw_status st = bw_grid_create(comm, c, &grid);
  for (int q = 0; q < 4; q++)
    BW_THEN(st, bw_field_create(grid, &f[q]));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    const bw_grid_view *v = bw_grid_look(grid);
    const uint64_t rank = (uint64_t)bw_comm_rank(comm);
    for (int q = 0; q < 4; q++)
      noise(f[q], v->size, 77 + 1000 * rank + (uint64_t)(q / 2));
    bw_halo_update(grid, 1, &f[1]);
    bw_halo_reduce(grid, 1, &f[3]);
    double x[5];
    add_up(v, f[0], f[1], f[2], f[3], s);
    x[0] = s->update, x[1] = s->reduce, x[2] = s->magnitude, x[3] = s->before, x[4] = s->after;
    bw_comm_sum(comm, 5, x);
    *s = (sums){x[0], x[1], x[2], x[3], x[4]};
  }
  for (int q = 0; q < 4; q++)
    bw_release(&f[q]);
  bw_grid_destroy(&grid);
  return st;
}

static bw_status run(bw_validation *v)
{
  const int n = bw_validation_full(v) ? 64 : 20;
  const double tolerance = 1e-13 * BW_REAL_EPSILON / 2.22e-16;
  double adjoint = 0, lost = 0;
  for (int q = 0; q < 32; q++) {
    bw_grid_config c = bw_grid_config_default();
    for (int d = 0; d < 3; d++) {
      c.n[d] = n + 3 * d;
      c.length[d] = 1;
      c.periodic[d] = (q >> d & 1) != 0;
    }
    if (q & 16) c.n[2] = 1;
    c.halo = q & 8 ? 2 : 1;
    sums s = {0};
    BW_TRY(measure(bw_validation_comm(v), &c, &s));
    const double difference = fabs(s.update - s.reduce) / s.magnitude;
    if (!(difference <= adjoint)) adjoint = difference;
    const double change = fabs(s.before - s.after) / s.magnitude;
    if ((q & 7) == 7 && !(change <= lost)) lost = change;
  }
  bw_validation_row(v, &(bw_claim){.claim = "halo reduce is the adjoint of halo update",
                                   .quantity = "relative_difference_of_inner_products",
                                   .measured = adjoint,
                                   .reference = 0,
                                   .tolerance = tolerance,
                                   .kind = BW_CONSERVATION,
                                   .source = "definition of the adjoint"});
  bw_validation_row(v, &(bw_claim){.claim = "halo reduce loses and doubles nothing",
                                   .quantity = "relative_change_of_the_sum",
                                   .measured = lost,
                                   .reference = 0,
                                   .tolerance = tolerance,
                                   .kind = BW_CONSERVATION,
                                   .source = "conservation of the sum"});
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "grid.halo", run);
}
