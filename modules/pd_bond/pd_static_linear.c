/* Conjugate gradients on the small-strain operator of the bonds that hold. */
#include "bw_memory.h"
#include "pd_static.h"

#include <math.h>
#include <string.h>

typedef struct {
  double *mass;         /* (n) preconditioner */
  double *r, *p, *kp;   /* (n,3): F - K u on all rows, direction, K p */
  bw_real *const *copy; /* storage: p and its copies, in the arrays of the velocity's copies */
} solver;

/* kp of one block: sum of k xi (x) xi.(p_h - p_l), k = c0 alpha Gamma V/|xi|^3. */
static void block_product(const bw_pd_bond *pd, const solver *s, const bw_pd_block *block)
{
  double sum[BW_PD_LANES][3] = {{0}};
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    const bw_pd_slot *slot = &pd->slot[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!(slot->mask >> lane & 1)) continue;
      const int32_t h = block->first + lane, l = slot->base + lane;
      const bw_pd_rest rest = bw_pd_bond__rest(pd, slot->direction, h, l);
      double along = 0;
      for (int k = 0; k < 3; k++)
        along += rest.xi[k] * ((double)s->copy[k][h] - (double)s->copy[k][l]);
      along *= pd->c0 * rest.fraction * pd->dv / (rest.r0 * rest.r0 * rest.r0) *
               bw_pd_bond__alpha(pd, block, slot, lane);
      for (int k = 0; k < 3; k++)
        sum[lane][k] += along * rest.xi[k];
    }
  }
  for (int lane = 0; lane < BW_PD_LANES; lane++)
    if (block->mask >> lane & 1)
      memcpy(s->kp + 3 * (size_t)bw_pd_bond__owner(block, lane), sum[lane], sizeof sum[lane]);
}

/* kp = K x. Collective. */
static void product(bw_pd_bond *pd, const solver *s, const double x[])
{
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < pd->n; i++)
      s->copy[k][pd->place[i]] = (bw_real)x[3 * i + (size_t)k];
    bw_pd_bond__fill_places(pd, s->copy[k]);
  }
  for (size_t b = 0; b < pd->n_block; b++)
    block_product(pd, s, &pd->block[b]);
}

/* Norms squared for the residual and r.r/m of the free rows. Collective. */
static void norms(const bw_pd_bond *pd, const solver *s, double sum[4])
{
  memset(sum, 0, 4 * sizeof *sum);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      const double mobile = (double)pd->mobile[i], r = s->r[3 * i + k];
      const double f = pd->config.rho * (double)pd->f[k][i];
      sum[0] += mobile * r * r;
      sum[1] += mobile * f * f;
      sum[2] += (1 - mobile) * r * r;
      sum[3] += mobile * r * r / s->mass[i];
    }
  bw_comm_sum(pd->comm, 4, sum);
}

static double dot(const bw_pd_bond *pd, const double a[], const double b[])
{
  double sum = 0;
  for (size_t q = 0; q < 3 * pd->n; q++)
    sum += a[q] * b[q];
  bw_comm_sum(pd->comm, 1, &sum);
  return sum;
}

/* p = r/m + beta p on the free rows, 0 on the prescribed ones. */
static void turn(const bw_pd_bond *pd, const solver *s, double beta)
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      double *p = &s->p[3 * i + k];
      *p = (double)pd->mobile[i] * s->r[3 * i + k] / s->mass[i] + beta * *p;
    }
}

static bw_status iterate(bw_pd_bond *pd, const bw_pd_static_config *config, const solver *s,
                         double U[], bw_pd_static_report *report)
{
  double sum[4], before = 0;
  bw_pd_static_scale by = {.first = -1};
  bw_pd_static__masses(pd, s->mass);
  product(pd, s, U);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      s->r[3 * i + k] = pd->config.rho * (double)pd->f[k][i] - s->kp[3 * i + k];
  for (int q = 0; q <= config->max_iterations; q++) {
    norms(pd, s, sum);
    report->residual = bw_pd_static__residual(sum[0], sum[1], sum[2], &by);
    if (report->residual <= config->tolerance) return BW_OK;
    if (!isfinite(report->residual)) break;
    turn(pd, s, q > 0 ? sum[3] / before : 0);
    before = sum[3];
    product(pd, s, s->p);
    report->iterations++;
    const double step = sum[3] / dot(pd, s->p, s->kp);
    for (size_t x = 0; x < 3 * pd->n; x++) {
      U[x] += step * s->p[x];
      s->r[x] -= step * s->kp[x];
    }
  }
  return BW_FAIL(BW_EDIVERGED,
                 "pd_static_linear: the residual is %g after %lld products, %g was asked; is the "
                 "body held?",
                 report->residual, (long long)report->iterations, config->tolerance);
}

bw_status bw_pd_static_linear(bw_pd_bond *pd, const bw_pd_static_config *config, double U[],
                              bw_pd_static_report *report)
{
  solver s = {.copy = pd->vs};
  *report = (bw_pd_static_report){.residual = NAN};
  bw_status st = bw_pd_static__check(pd, config);
  BW_THEN(st, BW_ALLOCATE(&s.mass, pd->n));
  BW_THEN(st, BW_ALLOCATE(&s.r, 3 * pd->n));
  BW_THEN(st, BW_ALLOCATE(&s.p, 3 * pd->n));
  BW_THEN(st, BW_ALLOCATE(&s.kp, 3 * pd->n));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) {
    st = iterate(pd, config, &s, U, report);
    pd->current = false; /* the velocity's copies were used */
  }
  bw_release(&s.mass);
  bw_release(&s.r);
  bw_release(&s.p);
  bw_release(&s.kp);
  return st;
}
