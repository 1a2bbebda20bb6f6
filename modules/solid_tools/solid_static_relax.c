/* Adaptive dynamic relaxation. */
#include "bw_memory.h"
#include "solid_static.h"

#include <math.h>
#include <string.h>

bw_solid_static_config bw_solid_static_config_default(void)
{
  return (bw_solid_static_config){.tolerance = 1e-6, .max_iterations = 100000};
}

bw_status bw_solid_static__check(const bw_solid *s, const bw_solid_static_config *c)
{
  BW_REQUIRE(c->tolerance > 0 && c->tolerance < 1, BW_EINPUT,
             "solid_static: tolerance = %g must be above 0 and below 1", c->tolerance);
  BW_REQUIRE(c->max_iterations > 0, BW_EINPUT, "solid_static: max_iterations = %d must be positive",
             c->max_iterations);
  BW_REQUIRE(
      !bw_solid_settings(s)->contact, BW_EINPUT,
      "solid_static: the body has contact, which the fictitious masses do not bound; create it "
      "without");
  return BW_OK;
}

double bw_solid_static__residual(double free2, double F2, double reaction2,
                                 bw_solid_static_scale *s)
{
  /* Measured by loads and reactions, or by where it began when there are neither. */
  s->scale = fmax(sqrt(fmax(F2, reaction2)), s->floor);
  if (s->first < 0) s->first = sqrt(free2);
  if (s->scale == 0) s->scale = s->first;
  return s->scale > 0 ? sqrt(free2) / s->scale : 0;
}

typedef struct {
  double *mass;    /* (n) */
  double *v, *acc; /* (n,3) of the fictitious body; acc of the last evaluation */
} relaxation;

enum { FREE, EXTERNAL, REACTION, VKV, VMV, SUMS };

/* acc from the present force, and the sums; started: acc holds that of the step before. */
static void measure(const bw_pd_body *pd, relaxation *x, bool started, double sum[SUMS])
{
  memset(sum, 0, SUMS * sizeof *sum);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      /* L + F: the residual on free rows, the reaction on prescribed ones. */
      const double rho = bw_pd_body_material(pd, i)->rho;
      const double f = rho * (double)pd->load.f[k][i], r = rho * (double)pd->a[k][i] + f;
      const double mobile = (double)pd->held.mobile[i], v = x->v[3 * i + k];
      const double acc = mobile * r / x->mass[i];
      sum[FREE] += mobile * r * r;
      sum[EXTERNAL] += mobile * f * f;
      sum[REACTION] += (1 - mobile) * r * r;
      /* K v without K: the change of the force during the last step, which was v long. */
      if (started) sum[VKV] -= x->mass[i] * v * (acc - x->acc[3 * i + k]);
      sum[VMV] += x->mass[i] * v * v;
      x->acc[3 * i + k] = acc;
    }
  bw_comm_sum(pd->comm, SUMS, sum);
}

/* v from acc with the damping of the sums, u += v. */
static void advance(bw_pd_body *pd, relaxation *x, bool started, const double sum[SUMS])
{
  /* Critical damping of the motion that there is: twice its Rayleigh frequency. */
  double c = sum[VKV] > 0 && sum[VMV] > 0 ? 2 * sqrt(sum[VKV] / sum[VMV]) : 0;
  c = fmin(c, 1.9); /* below the limit 2 of the scheme */
  /* Central differences with unit step; the first one starts from rest. */
  const double keep = (2 - c) / (2 + c), push = started ? 2 / (2 + c) : 0.5;
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < (size_t)pd->dimension; k++) {
      double *v = &x->v[3 * i + k];
      *v = keep * *v + push * x->acc[3 * i + k];
      pd->u[k][pd->points.place[i]] += (bw_real)*v;
    }
}

/* One equilibrium with the bonds there are. */
static bw_status settle(bw_solid *s, const bw_solid_static_config *config, relaxation *x,
                        double floor, bw_solid_static_report *report, double *scale)
{
  bw_pd_body *pd = bw_solid_body(s);
  double sum[SUMS];
  bw_solid_static_scale by = {.floor = floor, .first = -1};
  /* At rest, with the masses of the bonds that hold now. */
  memset(x->v, 0, 3 * pd->n * sizeof *x->v);
  pd->law->rows(pd, x->mass);
  /* Every pass measures the state before it moves it: the last one is at rest to the tolerance. */
  for (int q = 0; q < config->max_iterations; q++) {
    BW_TRY(bw_solid_evaluate(s));
    report->iterations++;
    measure(pd, x, q > 0, sum);
    report->residual = bw_solid_static__residual(sum[FREE], sum[EXTERNAL], sum[REACTION], &by);
    *scale = by.scale;
    if (report->residual <= config->tolerance) return BW_OK;
    if (!isfinite(report->residual)) break;
    advance(pd, x, q > 0, sum);
  }
  return BW_FAIL(
      BW_EDIVERGED,
      "solid_static_relax: the residual is %g after %lld evaluations, %g was asked; is the "
      "body held, and the load one it can bear?",
      report->residual, (long long)report->iterations, config->tolerance);
}

/* Breaks what is beyond s0; returns how many bonds of all ranks. */
static int64_t break_all(bw_pd_body *pd)
{
  /* At rest: nothing has moved since the evaluation, so that lengths are known. */
  int64_t before = pd->bonds.events;
  bw_pd_body_internal_force(pd, true, false);
  bw_pd_body_break_hits(pd);
  int64_t broken = pd->bonds.events - before;
  /* Both ends count, here or elsewhere. */
  bw_comm_sum_int(pd->comm, 1, &broken);
  return broken / 2;
}

static void at_rest(bw_pd_body *pd)
{
  for (int k = 0; k < 3; k++)
    memset(pd->v[k], 0, pd->n * sizeof(bw_real));
  /* Velocities have changed, and with them damping. */
  pd->current = false;
}

bw_status bw_solid_static_relax(bw_solid *s, const bw_solid_static_config *config,
                                bw_solid_static_report *report)
{
  /* What the caller set is put back at the end: damping, and velocities are zero. */
  bw_pd_body *pd = bw_solid_body(s);
  relaxation x = {0};
  double scale = 0;
  *report = (bw_solid_static_report){.residual = NAN};
  bw_status st = bw_solid_static__check(s, config);
  BW_THEN(st, BW_ALLOCATE(&x.mass, pd->n));
  BW_THEN(st, BW_ALLOCATE(&x.v, 3 * pd->n));
  BW_THEN(st, BW_ALLOCATE(&x.acc, 3 * pd->n));
  st = bw_comm_agree(pd->comm, st);
  const double damping[3] = {pd->damping.pair, pd->damping.mean, pd->damping.absolute};
  if (st == BW_OK) {
    at_rest(pd);
    pd->damping.pair = pd->damping.mean = pd->damping.absolute = 0;
    /* Each break changes the equilibrium: again until nothing breaks any more. */
    for (bool again = true; again && st == BW_OK;) {
      st = settle(s, config, &x, scale, report, &scale);
      if (st == BW_OK && pd->law->accept != NULL) pd->law->accept(pd);
      const int64_t broken = st == BW_OK && config->breaks ? break_all(pd) : 0;
      report->broken += broken;
      again = broken > 0;
    }
    at_rest(pd);
    pd->damping.pair = damping[0], pd->damping.mean = damping[1], pd->damping.absolute = damping[2];
  }
  bw_release(&x.mass);
  bw_release(&x.v);
  bw_release(&x.acc);
  return st;
}
