/* Gauges of failure: uniform tension, a virtual crack against one that is cut, the list on any
 * number of ranks, and rules that break where their own gauge is 1.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_solid_failure.h"
#include "bw_solid_static.h"
#include "pd_law.h"
#include "pd_test.h"

enum { NX = 24, NY = 11, GAUGES = BW_SOLID_FAILURE_GAUGES };
static const double E = 3, SMALL = 1e-5;

/* A strip that is pulled along x by a strain SMALL, of one of the laws; everything about it. */
typedef struct {
  bw_solid *pd;
  double *U, *X0, *X, *V, *used;
} strip;

static bw_solid_config material(int law, int thick)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = thick > 1 ? BW_PD_3D : BW_PD_PLANE_STRAIN;
  c.ds = c.rho = 1, c.E = E, c.horizon_ratio = 2;
  c.choice.law = law;
  c.choice.poisson_ratio = law == BW_SOLID_BOND ? NAN : 0.3;
  return c;
}

static void rest(strip *s, double strain)
{
  bw_solid_static_config how = bw_solid_static_config_default();
  bw_solid_static_report report;
  how.tolerance = 1e-8;
  for (size_t i = 0; i < bw_solid_count(s->pd); i++)
    s->U[3 * i] = strain * (s->X0[3 * i] - 0.5 * NX);
  bw_check_ok(bw_solid_static_linear(s->pd, &how, s->U, &report));
  for (size_t x = 0; x < 3 * bw_solid_count(s->pd); x++)
    s->X[x] = s->X0[x] + s->U[x];
  bw_solid_set_state(s->pd, s->X, s->V);
}

static strip pulled(const bw_solid_config *c, int thick, bool neck)
{
  strip s = {0};
  pd_body body = pd_box(NX, NY, thick);
  int64_t n_left = 0;
  for (int64_t q = 0; q < body.n; q++) {
    const int32_t *site = body.site + 3 * q;
    /* A neck in the middle is where it is weakest. */
    if (neck && abs(site[0] - NX / 2) < 2 && (site[1] < 3 || site[1] >= NY - 3)) continue;
    body.kind[n_left] = site[0] < 3 || site[0] >= NX - 3 ? BW_PD_PRESCRIBED : BW_PD_FREE;
    for (int k = 0; k < 3; k++)
      body.site[3 * n_left + k] = site[k];
    n_left++;
  }
  body.n = n_left;
  s.pd = pd_make(bw_check_world(), c, &body);
  pd_body_release(&body);
  const size_t n = bw_solid_count(s.pd);
  double **rows[] = {&s.U, &s.X0, &s.X, &s.V};
  for (int q = 0; q < 4; q++)
    bw_check_ok(BW_ALLOCATE(rows[q], 3 * n));
  bw_check_ok(BW_ALLOCATE(&s.used, GAUGES * n));
  bw_solid_get_reference(s.pd, s.X0);
  rest(&s, SMALL);
  return s;
}

static void release(strip *s)
{
  double **rows[] = {&s->U, &s->X0, &s->X, &s->V, &s->used};
  for (int q = 0; q < 5; q++)
    bw_release(rows[q]);
  bw_solid_destroy(&s->pd);
}

/* The gauge of the particle at a place, on all ranks. */
static double at(const strip *s, const double x[3], int gauge)
{
  double most = -INFINITY;
  for (size_t i = 0; i < bw_solid_count(s->pd); i++)
    if (fabs(s->X0[3 * i] - x[0]) + fabs(s->X0[3 * i + 1] - x[1]) + fabs(s->X0[3 * i + 2] - x[2]) <
        0.1)
      most = fmax(most, s->used[GAUGES * i + (size_t)gauge]);
  bw_comm_max(bw_check_world(), 1, &most);
  return most;
}

static double elastic(bw_solid *pd)
{
  bw_solid_ledger e;
  bw_check_ok(bw_solid_account(pd, &e));
  return e.elastic;
}

/* A crack that is cut for good, across x at a place, of `length`; in space a square. */
static void cut(bw_solid *pd, const double x[3], double length, bool space)
{
  const double h = 0.5 * length, z = space ? x[2] - h : 0;
  const double a[3] = {x[0], x[1] - h, z}, b[3] = {x[0], x[1] + h, z};
  const double c[3] = {x[0], x[1] - h, x[2] + h};
  bw_check_ok(bw_solid_precrack(pd, a, b, space ? c : NULL));
}

START_TEST(virtual_cracks_release_what_cut_ones_do)
{
  for (int law = BW_SOLID_BOND; law <= BW_SOLID_CORRESPONDENCE; law++)
    for (int thick = 1; thick <= (law == BW_SOLID_ORDINARY ? 5 : 1); thick += 4) {
      const bw_solid_config c = material(law, thick);
      strip s = pulled(&c, thick, true);
      bw_solid_strength k = bw_solid_strength_of(s.pd);
      k.G0 = 1, k.flaw = 3;
      const double before = elastic(s.pd);
      bw_check_ok(bw_solid_failure_griffith(s.pd, &k, 0.4, s.used));
      const double x[3] = {NX / 2 + 0.5, NY / 2 + 0.5, thick > 1 ? thick / 2 + 0.5 : 0};
      const double used = at(&s, x, BW_SOLID_FAILURE_GRIFFITH);
      /* Nothing has happened to the body. */
      ck_assert_int_eq(bw_solid_events(s.pd), 0);
      bw_check_near(elastic(s.pd) / before, 1, 1e-14);
      cut(s.pd, x, 3, thick > 1);
      rest(&s, SMALL);
      const double released = (before - elastic(s.pd)) / (thick > 1 ? 9 : 3);
      ck_assert_double_gt(released, 0);
      /* What conjugate gradients leave, 0.02 squared; the strain. */
      bw_check_near(used * used / released, 1, 2e-3);
      release(&s);
    }
}
END_TEST

START_TEST(uniform_tension)
{
  const bw_solid_config c = material(BW_SOLID_CORRESPONDENCE, 1);
  strip s = pulled(&c, 1, false);
  bw_solid_strength k = bw_solid_strength_of(s.pd);
  /* In the middle sigma = E' e, and sigma_zz = nu sigma; limits are those of the mean strain. */
  const double sigma = E / (1 - 0.09) * SMALL, x[3] = {NX / 2 + 0.5, NY / 2 + 0.5, 0};
  k.tension = k.yield = k.cohesion = sigma, k.friction = 0, k.stretch = SMALL;
  bw_check_ok(bw_solid_failure_compute(s.pd, &k, s.used));
  const double rankine = at(&s, x, BW_SOLID_FAILURE_RANKINE);
  /* Grips hold the width of the ends, so that the middle gives way a little more: 7 % here. */
  bw_check_near(rankine, 1, 0.08);
  /* What they leave of sigma_yy there is 2 %. */
  bw_check_near(at(&s, x, BW_SOLID_FAILURE_ENERGY) / rankine, sqrt(1 - 0.09), 0.02);
  bw_check_near(at(&s, x, BW_SOLID_FAILURE_MISES) / rankine, sqrt(1 - 0.3 + 0.09), 0.02);
  bw_check_near(at(&s, x, BW_SOLID_FAILURE_MOHR_COULOMB) / rankine, 0.5, 0.02);
  bw_check_near(at(&s, x, BW_SOLID_FAILURE_STRETCH) / rankine, 1, 0.02);
  k.yield = -1;
  bw_check_status(bw_solid_failure_compute(s.pd, &k, s.used), BW_EINPUT);
  k.flaw = 0;
  bw_check_status(bw_solid_failure_griffith(s.pd, &k, 0.9, s.used), BW_EINPUT);
  release(&s);
}
END_TEST

START_TEST(the_list_begins_with_the_largest)
{
  const bw_solid_config c = material(BW_SOLID_ORDINARY, 1);
  strip s = pulled(&c, 1, false);
  bw_solid_strength k = bw_solid_strength_of(s.pd);
  bw_solid_failure_place list[5];
  int n;
  k.tension = E;
  bw_check_ok(bw_solid_failure_compute(s.pd, &k, s.used));
  bw_check_ok(bw_solid_failure_list(s.pd, s.used, BW_SOLID_FAILURE_RANKINE, 5, list, &n));
  ck_assert_int_eq(n, 5);
  double most = 0;
  for (size_t i = 0; i < bw_solid_count(s.pd); i++)
    most = fmax(most, s.used[GAUGES * i]);
  bw_comm_max(bw_check_world(), 1, &most);
  ck_assert_double_eq(list[0].used, most);
  for (int q = 0; q < 5; q++) {
    bw_check_near(list[q].load * list[q].used, 1, 1e-14);
    ck_assert_double_eq(at(&s, list[q].X0, BW_SOLID_FAILURE_RANKINE), list[q].used);
    if (q > 0) ck_assert(list[q].used <= list[q - 1].used);
  }
  /* What is not asked for is in no list. */
  bw_check_ok(bw_solid_failure_list(s.pd, s.used, BW_SOLID_FAILURE_MISES, 5, list, &n));
  ck_assert_int_eq(n, 0);
  release(&s);
}
END_TEST

/* Whether the law finds a bond beyond its limit when the strip is pulled `load` times as far. */
static bool breaks(strip *s, double load)
{
  bw_pd_body *pd = bw_solid_body(s->pd);
  for (size_t x = 0; x < 3 * bw_solid_count(s->pd); x++)
    s->X[x] = s->X0[x] + load * s->U[x];
  bw_solid_set_state(s->pd, s->X, s->V);
  bw_check_ok(bw_solid_evaluate(s->pd));
  bw_pd_body_internal_force(pd, true, false);
  double hit = pd->bonds.n_hit > 0;
  bw_comm_max(bw_check_world(), 1, &hit);
  return hit > 0;
}

START_TEST(rules_break_where_their_gauge_is_one)
{
  static const int rule[] = {BW_PD_STATE_BREAKS_BY_STRESS, BW_PD_STATE_BREAKS_BY_ENERGY,
                             BW_PD_STATE_BREAKS_BY_MISES, BW_PD_STATE_BREAKS_BY_MOHR_COULOMB,
                             BW_PD_STATE_BREAKS_BY_CONE};
  for (int q = 0; q < 5; q++) {
    bw_solid_config c = material(BW_SOLID_CORRESPONDENCE, 1);
    c.choice.breaks = rule[q], c.choice.limit = 2 * E * SMALL;
    if (q > 2) c.choice.friction_angle = 20;
    strip s = pulled(&c, 1, false);
    bw_solid_strength k = bw_solid_strength_of(s.pd);
    k.tension = k.yield = k.cohesion = c.choice.limit;
    k.friction = 20 * acos(-1.0) / 180;
    bw_check_ok(bw_solid_failure_compute(s.pd, &k, s.used));
    /* A bond breaks by the mean of its ends: between the largest number, and half of that. */
    double most = 0;
    for (size_t i = 0; i < bw_solid_count(s.pd); i++)
      most = fmax(most, s.used[GAUGES * i + (size_t)q]);
    bw_comm_max(bw_check_world(), 1, &most);
    ck_assert(!breaks(&s, 0.999 / most));
    ck_assert(breaks(&s, 1.2 / most));
    release(&s);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(virtual_cracks_release_what_cut_ones_do), BW_TEST(uniform_tension),
    BW_TEST(the_list_begins_with_the_largest), BW_TEST(rules_break_where_their_gauge_is_one)};
BW_CHECK_MAIN("solid_tools: gauges of failure", tests)
