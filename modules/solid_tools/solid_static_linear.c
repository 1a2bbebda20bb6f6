/* Conjugate gradients on the small-strain operator of the bonds that hold. */
#include "bw_memory.h"
#include "solid_static.h"

#include <math.h>
#include <string.h>

typedef struct {
  double *mass;         /* (n) preconditioner */
  double *r, *p, *kp;   /* (n,3): F - K u on all rows, direction, K p */
  bw_real *const *copy; /* storage: p and its copies, in the arrays of the velocity's copies */
} solver;

/* kp = K x. Collective. */
static void product(bw_pd_body *pd, const solver *s, const double x[])
{
  /* Families reach over ranks: x of the copies first. */
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < pd->n; i++)
      s->copy[k][pd->points.place[i]] = (bw_real)x[3 * i + (size_t)k];
    bw_pd_body_fill_places(pd, s->copy[k]);
  }
  pd->law->tangent(pd, s->copy, s->kp);
}

/* Norms squared for the residual and r.r/m of the free rows. Collective. */
static void norms(const bw_pd_body *pd, const solver *s, double sum[4])
{
  memset(sum, 0, 4 * sizeof *sum);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      /* Residual on free rows, reactions on prescribed ones: both go into the measure. */
      const double mobile = (double)pd->held.mobile[i], r = s->r[3 * i + k];
      const double f = bw_pd_body_material(pd, i)->rho * (double)pd->load.f[k][i];
      sum[0] += mobile * r * r;
      sum[1] += mobile * f * f;
      sum[2] += (1 - mobile) * r * r;
      sum[3] += mobile * r * r / s->mass[i];
    }
  bw_comm_sum(pd->comm, 4, sum);
}

static double dot(const bw_pd_body *pd, const double a[], const double b[])
{
  /* Rows of prescribed particles are zero in p: all may be summed. */
  double sum = 0;
  for (size_t q = 0; q < 3 * pd->n; q++)
    sum += a[q] * b[q];
  bw_comm_sum(pd->comm, 1, &sum);
  return sum;
}

/* p = r/m + beta p on the free rows, 0 on the prescribed ones. */
static void turn(const bw_pd_body *pd, const solver *s, double beta)
{
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      /* The preconditioner is diagonal; directions leave prescribed rows alone. */
      double *p = &s->p[3 * i + k];
      *p = (double)pd->held.mobile[i] * s->r[3 * i + k] / s->mass[i] + beta * *p;
    }
}

static bw_status iterate(bw_pd_body *pd, const bw_solid_static_config *config, const solver *s,
                         double U[], bw_solid_static_report *report)
{
  double sum[4], before = 0;
  bw_solid_static_scale by = {.first = -1};
  /* r = F - K U, with the prescribed displacements in U. */
  pd->law->rows(pd, s->mass);
  product(pd, s, U);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      s->r[3 * i + k] =
          bw_pd_body_material(pd, i)->rho * (double)pd->load.f[k][i] - s->kp[3 * i + k];
  /* Conjugate gradients: r.r/m tells how much of the old direction is kept. */
  for (int q = 0; q <= config->max_iterations; q++) {
    norms(pd, s, sum);
    report->residual = bw_solid_static__residual(sum[0], sum[1], sum[2], &by);
    if (report->residual <= config->tolerance) return BW_OK;
    if (!isfinite(report->residual)) break;
    turn(pd, s, q > 0 ? sum[3] / before : 0);
    before = sum[3];
    product(pd, s, s->p);
    report->iterations++;
    /* The step that minimises the energy along p. */
    const double step = sum[3] / dot(pd, s->p, s->kp);
    for (size_t x = 0; x < 3 * pd->n; x++) {
      U[x] += step * s->p[x];
      s->r[x] -= step * s->kp[x];
    }
  }
  return BW_FAIL(
      BW_EDIVERGED,
      "solid_static_linear: the residual is %g after %lld products, %g was asked; is the "
      "body held?",
      report->residual, (long long)report->iterations, config->tolerance);
}

bw_status bw_solid_static_linear(bw_solid *solid, const bw_solid_static_config *config, double U[],
                                 bw_solid_static_report *report)
{
  bw_pd_body *pd = bw_solid_body(solid);
  /* The arrays of the copies' velocities serve as storage: no step is going on. */
  solver s = {.copy = pd->vs};
  *report = (bw_solid_static_report){.residual = NAN};
  bw_status st = bw_solid_static__check(solid, config);
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
