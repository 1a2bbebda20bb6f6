/* Where and when would it break? Gauges of an elastic state against what breaks.
 *
 * Claim      A rule's own gauge, read before anything has broken, gives the load of the first bond.
 *            Every other gauge is ranked by how well it tells the particles that are among the
 *            first to lose a bond from the others, and the order in which they do.
 * Reference  the load of the rule's own run. A gauge that tells nothing has half of the area under
 *            its curve.
 * Measured   three porous plates in plane strain, correspondence, nu = 0.25, m = 2, periodic along
 *            x and drawn along y: round pores apart, small ones that overlap, grains that overlap.
 *            The elastic state is that of the linear solve. In the run of a rule the load is raised
 *            until a bond breaks, the plate comes to rest, and so on until the asked number has
 *            broken. Area under the curve of true against false positives over all particles; rank
 *            correlation of 1/gauge with the load at which a particle lost its first bond. Curves
 *            go to failure.csv, which tools/plot_failure.py draws. quick: one plate, 30 bonds;
 *            full: 100 bonds, all three.
 * Tolerance  own gauge: 1e-3, the strain, and the tolerance of the solves. Areas and correlations
 *            are what the study is for: reported.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 timeout=3600 */
#include "../pd_state/crack.h"
#include "bw_solid_failure.h"

#include <stdlib.h>

enum { GAUGES = BW_SOLID_FAILURE_GAUGES, GRIP = 3, MEDIA = 3, RULES = 6, DISCS = 400 };
static const double FRICTION = 30, /* degrees */
    LIMIT = 5e-5;                  /* of all rules, for E = 5 */

/* A medium: discs that are pores, or grains. */
typedef struct {
  const char *name;
  bool grains;
  int discs;
  double radius; /* [cells] */
  int side;      /* of the plate [cells] */
  double centre[DISCS][2];
} medium;

/* From 0 to 1, the same on every machine. */
static double drawn(uint64_t *state)
{
  *state += 0x9e3779b97f4a7c15u;
  uint64_t x = *state;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return (double)((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

static medium medium_of(int which, int side)
{
  static const struct {
    const char *name;
    bool grains;
    double radius, part; /* of the area that the discs would cover one by one */
  } kind[MEDIA] = {{"round pores", false, 4, 0.2},
                   {"overlapping pores", false, 2.5, 0.3},
                   {"grains", true, 5, 2}};
  medium m = {.name = kind[which].name,
              .grains = kind[which].grains,
              .radius = kind[which].radius,
              .side = side};
  const double area = 3.14159265358979 * m.radius * m.radius;
  m.discs = (int)(kind[which].part * side * side / area);
  uint64_t state = (uint64_t)which + 1;
  for (int q = 0; q < m.discs; q++)
    for (int tries = 0; tries < 1000; tries++) {
      m.centre[q][0] = side * drawn(&state), m.centre[q][1] = side * drawn(&state) + GRIP;
      /* Only the first medium keeps its pores apart. */
      bool apart = true;
      for (int j = 0; j < q && which == 0; j++)
        apart = hypot(remainder(m.centre[q][0] - m.centre[j][0], side),
                      m.centre[q][1] - m.centre[j][1]) > 2 * m.radius + 4;
      if (apart) break;
    }
  return m;
}

/* Solid or void; grips are whole. The plate goes on at its sides. */
static bool solid_at(const medium *m, int x, int y)
{
  bool inside = false;
  for (int q = 0; q < m->discs && !inside; q++) {
    const double dx = remainder(x + 0.5 - m->centre[q][0], m->side);
    inside = hypot(dx, y + 0.5 - m->centre[q][1]) < m->radius;
  }
  return y < GRIP || y >= m->side + GRIP || inside == m->grains;
}

/* A cell counts when a square of three cells around some neighbour of it is all solid: no hairs. */
static int choose(const int32_t site[3], const void *data, uint8_t *group)
{
  const medium *m = data;
  bool thick = false;
  for (int cx = -1; cx <= 1 && !thick; cx++)
    for (int cy = -1; cy <= 1 && !thick; cy++) {
      thick = true;
      for (int dx = -1; dx <= 1 && thick; dx++)
        for (int dy = -1; dy <= 1 && thick; dy++) {
          const int y = site[1] + cy + dy;
          thick = y >= 0 && y < m->side + 2 * GRIP && solid_at(m, site[0] + cx + dx, y);
        }
    }
  const bool grip = site[1] < GRIP || site[1] >= m->side + GRIP;
  *group = 0;
  return !thick && !grip ? -1 : grip ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

/* A rule, its gauge, and its limit for a body of E = 5. */
typedef struct {
  int breaks, gauge;
} rule;

static const rule rules[RULES] = {
    {BW_PD_STATE_BREAKS_BY_STRETCH, BW_SOLID_FAILURE_STRETCH},
    {BW_PD_STATE_BREAKS_BY_STRESS, BW_SOLID_FAILURE_RANKINE},
    {BW_PD_STATE_BREAKS_BY_ENERGY, BW_SOLID_FAILURE_ENERGY},
    {BW_PD_STATE_BREAKS_BY_MISES, BW_SOLID_FAILURE_MISES},
    {BW_PD_STATE_BREAKS_BY_MOHR_COULOMB, BW_SOLID_FAILURE_MOHR_COULOMB},
    {BW_PD_STATE_BREAKS_BY_CONE, BW_SOLID_FAILURE_CONE}};

static bw_status make(const bw_comm *comm, const medium *m, int breaks, crack_body *b)
{
  const crack_material a = {BW_PD_PLANE_STRAIN, BW_SOLID_CORRESPONDENCE, 0, 0.25, 2};
  double lam, mu;
  bw_solid_config c = crack_config(&a, &lam, &mu);
  c.choice.breaks = breaks;
  c.period[0] = m->side;
  c.G0 = 1e-9;
  if (breaks != BW_PD_STATE_BREAKS_BY_STRETCH) c.choice.limit = LIMIT;
  if (breaks >= BW_PD_STATE_BREAKS_BY_MOHR_COULOMB) c.choice.friction_angle = FRICTION;
  BW_TRY(crack_make(comm, &c, (int[3]){m->side, m->side + 2 * GRIP, 1}, choose, m, b));
  for (size_t i = 0; i < bw_solid_count(b->pd); i++)
    if (bw_solid_kind(b->pd)[i] & BW_PD_PRESCRIBED)
      b->U[3 * i + 1] = b->r.X0[3 * i + 1] > 0.5 * m->side + GRIP ? 1 : 0;
  return BW_OK;
}

/* What the elastic state tells, for a load of 1. */
typedef struct {
  double *used;         /* (n, GAUGES) */
  double first[GAUGES]; /* load of the first bond by the mean of its ends; stretch, griffith: 0 */
} foresight;

/* The largest mean of a bond's ends, over bonds that are stretched. On one rank ids are rows of the
 * list of sites, and an image has the id of its particle. */
static bw_status first_loads(const crack_body *b, foresight *f)
{
  const bw_pd_body *pd = bw_solid_body(b->pd);
  double most[GAUGES] = {0}, y[3];
  size_t *own = NULL;
  BW_TRY(BW_ALLOCATE(&own, pd->n));
  for (size_t i = 0; i < pd->n; i++)
    own[pd->points.id[i]] = i;
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    for (bw_pd_walk w = bw_pd_walk_of(pd, &pd->bonds.block[q], pd->bonds.block[q].mask);
         bw_pd_walk_next(&w);) {
      const size_t h = bw_pd_walk_owner(&w);
      const size_t l = own[pd->points.id[pd->points.occupant[w.l]]];
      if (!(bw_pd_walk_present(&w, y) > w.rest.r0)) continue;
      for (size_t g = 0; g < BW_SOLID_FAILURE_STRETCH; g++)
        most[g] = fmax(most[g], 0.5 * (f->used[GAUGES * h + g] + f->used[GAUGES * l + g]));
    }
  for (int g = 0; g < BW_SOLID_FAILURE_STRETCH; g++)
    f->first[g] = 1 / most[g];
  bw_release(&own);
  return BW_OK;
}

/* All gauges of the elastic state, by the limits of the rules. */
static bw_status foresee(const bw_comm *comm, const medium *m, foresight *f)
{
  crack_body b = {0};
  BW_TRY(make(comm, m, BW_PD_STATE_BREAKS_BY_STRETCH, &b));
  const size_t n = bw_solid_count(b.pd);
  BW_TRY(BW_ALLOCATE(&f->used, GAUGES * n));
  BW_TRY(crack_rest(&b));
  crack_load(&b, CRACK_STRAIN);
  bw_solid_strength k = bw_solid_strength_of(b.pd);
  k.tension = k.yield = k.cohesion = LIMIT, k.friction = FRICTION * STATE_PI / 180;
  k.stretch = 1, k.G0 = 1, k.flaw = 3;
  BW_TRY(bw_solid_failure_compute(b.pd, &k, f->used));
  BW_TRY(bw_solid_failure_griffith(b.pd, &k, 0.1, f->used));
  /* Gauges go with the load. */
  for (size_t q = 0; q < GAUGES * n; q++)
    f->used[q] /= CRACK_STRAIN;
  BW_TRY(first_loads(&b, f));
  crack_release(&b);
  return BW_OK;
}

/* What happened to each particle in a run. */
typedef struct {
  size_t n;
  double *lost; /* (n) the load at which it lost its first bond; INFINITY: it has not */
  bool *may;    /* (n) it could have */
  double first; /* the load of the first bond */
} run_of;

static bw_status drive(const bw_comm *comm, const medium *m, int breaks, int64_t bonds, run_of *r)
{
  crack_body b = {0};
  double *damage = NULL, load = 1e-5;
  BW_TRY(make(comm, m, breaks, &b));
  r->n = bw_solid_count(b.pd);
  BW_TRY(BW_ALLOCATE(&r->lost, r->n));
  BW_TRY(BW_ALLOCATE(&r->may, r->n));
  BW_TRY(BW_ALLOCATE(&damage, r->n));
  for (size_t i = 0; i < r->n; i++) {
    r->lost[i] = INFINITY;
    r->may[i] = !(bw_solid_kind(b.pd)[i] & BW_PD_PRESCRIBED);
  }
  for (int q = 0; bw_solid_events(b.pd) < 2 * bonds; q++) {
    BW_TRY(crack_rest(&b));
    BW_TRY(crack_advance(&b, &load));
    if (q == 0) r->first = load;
    bw_solid_get_damage(b.pd, damage);
    for (size_t i = 0; i < r->n; i++)
      if (damage[i] > 0 && !isfinite(r->lost[i])) r->lost[i] = load;
  }
  bw_release(&damage);
  crack_release(&b);
  return BW_OK;
}

/* A particle's gauge and whether it was among the first. */
typedef struct {
  double score;
  bool hit;
} ranked;

static int larger_first(const void *a, const void *b)
{
  const double p = ((const ranked *)a)->score, q = ((const ranked *)b)->score;
  return p > q ? -1 : p < q;
}

/* The area under the curve of true over false positives, which is written as it is walked. */
static bw_status area_of(const run_of *r, const double used[], int gauge, FILE *out,
                         const char *head, double *area)
{
  ranked *row = NULL;
  size_t n = 0, hits = 0;
  BW_TRY(BW_ALLOCATE(&row, r->n));
  for (size_t i = 0; i < r->n; i++) {
    if (!r->may[i]) continue;
    row[n++] = (ranked){used[GAUGES * i + (size_t)gauge], isfinite(r->lost[i])};
    hits += isfinite(r->lost[i]);
  }
  qsort(row, n, sizeof *row, larger_first);
  size_t at[2] = {0}, before[2] = {0};
  *area = 0;
  for (size_t q = 0; q < n; q++) {
    at[row[q].hit]++;
    /* Ties are walked at once. */
    if (q + 1 < n && row[q + 1].score == row[q].score) continue;
    *area += 0.5 * (double)(at[1] + before[1]) * (double)(at[0] - before[0]);
    if (out != NULL && (at[1] != before[1] || q + 1 == n))
      fprintf(out, "%s,%s,%.6f,%.6f\n", head, bw_solid_failure_name[gauge],
              (double)at[0] / (double)(n - hits), (double)at[1] / (double)hits);
    before[0] = at[0], before[1] = at[1];
  }
  *area /= (double)hits * (double)(n - hits);
  bw_release(&row);
  return BW_OK;
}

/* Spearman's correlation of 1/gauge with the load of the first bond, over those that lost one. */
static double order_of(const run_of *r, const double used[], int gauge)
{
  double sum[5] = {0};
  for (size_t i = 0; i < r->n; i++) {
    if (!isfinite(r->lost[i]) || !r->may[i]) continue;
    double rank[2] = {0};
    /* A rank counts those before, and ties by half. */
    for (size_t j = 0; j < r->n; j++) {
      if (!isfinite(r->lost[j]) || !r->may[j]) continue;
      const double a = used[GAUGES * j + (size_t)gauge], b = used[GAUGES * i + (size_t)gauge];
      rank[0] += (a > b) + 0.5 * (a == b);
      rank[1] += (r->lost[j] < r->lost[i]) + 0.5 * (r->lost[j] == r->lost[i]);
    }
    sum[0]++, sum[1] += rank[0], sum[2] += rank[0] * rank[0];
    sum[3] += rank[0] * rank[1], sum[4] += rank[1] * rank[1];
  }
  /* Means of both ranks are the same: half of one more than there are. */
  const double mean = sum[1] / sum[0];
  return (sum[3] / sum[0] - mean * mean) /
         sqrt((sum[2] / sum[0] - mean * mean) * (sum[4] / sum[0] - mean * mean));
}

/* One rule's run, judged by all gauges. */
static bw_status judge(bw_validation *v, const medium *m, const rule *by, const foresight *f,
                       int64_t bonds, FILE *out)
{
  run_of r = {0};
  char head[80], extra[160];
  BW_TRY(drive(bw_validation_comm(v), m, by->breaks, bonds, &r));
  snprintf(head, sizeof head, "%s,%s", m->name, bw_solid_failure_name[by->gauge]);
  snprintf(extra, sizeof extra, "\"medium\": \"%s\", \"rule\": \"%s\"", m->name,
           bw_solid_failure_name[by->gauge]);
  if (by->gauge < BW_SOLID_FAILURE_STRETCH)
    state_claim(v, "a rule's own gauge gives its first load", "load", r.first / f->first[by->gauge],
                1, 1e-3, BW_ANALYTIC, "proportional load", extra);
  for (int g = 0; g < GAUGES; g++) {
    double area;
    BW_TRY(area_of(&r, f->used, g, out, head, &area));
    snprintf(extra, sizeof extra,
             "\"medium\": \"%s\", \"rule\": \"%s\", \"gauge\": \"%s\", \"own\": %s, "
             "\"order\": %.3f",
             m->name, bw_solid_failure_name[by->gauge], bw_solid_failure_name[g],
             g == by->gauge ? "true" : "false", order_of(&r, f->used, g));
    state_claim(v, "gauges tell where it breaks", "area", area, 1, INFINITY, BW_ANALYTIC,
                "all told apart", extra);
  }
  bw_release(&r.lost);
  bw_release(&r.may);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const bool full = bw_validation_full(v);
  char path[512];
  snprintf(path, sizeof path, "%s/failure.csv", bw_validation_folder(v));
  FILE *out = fopen(path, "w");
  BW_REQUIRE(out != NULL, BW_EIO, "cannot write %s", path);
  fprintf(out, "medium,rule,gauge,false_positives,true_positives\n");
  bw_status st = BW_OK;
  for (int which = 0; which < (full ? MEDIA : 1) && st == BW_OK; which++) {
    const medium m = medium_of(which, full ? 56 : 40);
    foresight f = {0};
    st = foresee(bw_validation_comm(v), &m, &f);
    for (int q = 0; q < (full ? RULES : 3) && st == BW_OK; q++)
      st = judge(v, &m, &rules[q], &f, full ? 100 : 30, out);
    bw_release(&f.used);
  }
  fclose(out);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "solid_tools.failure", run);
}
