/* Pressure in cracks: which broken bonds are joined to the source, and what pushes them apart. */
#include "bw_memory.h"
#include "bw_solid_crack.h"

#include <math.h>
#include <string.h>

/* Of a particle: sums over its broken bonds of Gamma xi and of Gamma y. */
typedef struct {
  double before[3], now[3];
} normals;

struct bw_solid_crack {
  bw_solid *solid;
  size_t n, n_all;
  double per_bond;   /* C of the header [L^2] */
  int64_t events;    /* of this rank when the crack was last followed; -1: not yet */
  bool *source;      /* (n) */
  bool *wet, *all;   /* (n), (n_all) */
  uint16_t *broken;  /* (n) broken bonds */
  normals *own, *of; /* (n), (n_all) */
  bw_pd_link *link;  /* room for a family */
};

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* C = 2 d V/(sum Gamma |xi|). */
static double area_per_bond(const bw_solid *s)
{
  double sum = 0;
  for (int q = 0; q < bw_solid_max_family(s); q++) {
    const double *xi = bw_solid_stencil_offset(s, q);
    sum += bw_solid_stencil_fraction(s, q) * sqrt(dot(xi, xi));
  }
  return 2 * (bw_solid_settings(s)->geometry == BW_PD_3D ? 3 : 2) * bw_solid_volume(s) / sum;
}

static bw_status check(const bw_solid *s, const bool source[])
{
  const bw_solid_config *c = bw_solid_settings(s);
  int64_t some = 0;
  for (size_t i = 0; i < bw_solid_count(s); i++)
    some += source[i];
  bw_comm_sum_int(bw_solid_comm(s), 1, &some);
  BW_REQUIRE(
      c->finer.n == 0, BW_EINPUT,
      "solid_crack: a body with levels; a pressure in cracks needs particles of one spacing");
  BW_REQUIRE(c->disorder == 0, BW_EINPUT,
             "solid_crack: disorder is %g; a pressure in cracks needs a lattice, disorder 0",
             c->disorder);
  BW_REQUIRE(some > 0, BW_EINPUT,
             "solid_crack: the source touches no particle; cut a crack and give those beside it");
  return BW_OK;
}

/* Room for the copies, of which there may be others after a change of the body. Collective. */
static bw_status make_room(bw_solid_crack *c, size_t n_all)
{
  const bool enough = n_all <= c->n_all;
  bw_status st = BW_OK;
  if (!enough) {
    bw_release(&c->all);
    bw_release(&c->of);
    st = BW_ALLOCATE(&c->all, n_all);
    BW_THEN(st, BW_ALLOCATE(&c->of, n_all));
    c->n_all = st == BW_OK ? n_all : 0;
  }
  return bw_comm_agree(bw_solid_comm(c->solid), st);
}

bw_status bw_solid_crack_create(bw_solid *s, const bool source[], bw_solid_crack **out)
{
  *out = NULL;
  BW_TRY(check(s, source));
  bw_solid_crack *c = NULL;
  bw_status st = BW_ALLOCATE(&c, 1);
  if (st == BW_OK) {
    c->solid = s, c->n = bw_solid_count(s), c->events = -1, c->per_bond = area_per_bond(s);
    st = BW_ALLOCATE(&c->source, c->n);
    BW_THEN(st, BW_ALLOCATE(&c->wet, c->n));
    BW_THEN(st, BW_ALLOCATE(&c->broken, c->n));
    BW_THEN(st, BW_ALLOCATE(&c->own, c->n));
    BW_THEN(st, BW_ALLOCATE(&c->link, (size_t)bw_solid_max_family(s)));
  }
  st = bw_comm_agree(bw_solid_comm(s), st);
  if (st != BW_OK) {
    bw_solid_crack_destroy(&c);
    return st;
  }
  memcpy(c->source, source, c->n * sizeof *source);
  *out = c;
  return BW_OK;
}

void bw_solid_crack_destroy(bw_solid_crack **crack)
{
  bw_solid_crack *c = *crack;
  if (c == NULL) return;
  bw_release(&c->source);
  bw_release(&c->wet);
  bw_release(&c->all);
  bw_release(&c->broken);
  bw_release(&c->own);
  bw_release(&c->of);
  bw_release(&c->link);
  bw_release(crack);
}

/* ---- what is wet ---- */

/* Does a broken bond of particle i lead to a wet one? */
static bool is_reached(bw_solid_crack *c, size_t i)
{
  const int family = bw_solid_links(c->solid, i, c->link);
  for (int q = 0; q < family; q++)
    if (!c->link[q].intact && c->all[c->link[q].neighbour]) return true;
  return false;
}

/* The wet spreads over the rank's own particles until no broken bond leads on; returns whether it
 * spread at all. */
static bool spread(bw_solid_crack *c)
{
  bool any = false;
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < c->n; i++) {
      if (c->wet[i] || c->broken[i] == 0) continue;
      if (!c->source[i] && !is_reached(c, i)) continue;
      /* Later ones of this sweep see it already. */
      c->wet[i] = c->all[i] = more = any = true;
    }
  }
  return any;
}

/* Follows the crack to where bonds have broken since. Collective. */
static bw_status follow(bw_solid_crack *c)
{
  const bw_comm *comm = bw_solid_comm(c->solid);
  const int64_t events = bw_solid_events(c->solid);
  int64_t changed = events != c->events;
  BW_TRY(make_room(c, bw_solid_get_extended(c->solid).n));
  bw_comm_max_int(comm, 1, &changed);
  if (changed == 0) return BW_OK;
  /* From the source anew: what is wet is a function of the bonds that hold now. */
  memset(c->wet, 0, c->n * sizeof *c->wet);
  c->events = events;
  bw_solid_get_broken(c->solid, c->broken);
  while (changed != 0) {
    /* Other ranks, and images across periods, hear of what is wet here. */
    bw_solid_fill_extended(c->solid, sizeof *c->wet, c->wet, c->all);
    changed = spread(c);
    bw_comm_max_int(comm, 1, &changed);
  }
  return BW_OK;
}

/* ---- what pushes ---- */

static void vector_between(const bw_real *X, size_t from, size_t to, double y[3])
{
  for (size_t k = 0; k < 3; k++)
    y[k] = (double)X[3 * to + k] - (double)X[3 * from + k];
}

/* Directions of the crack at every wet particle and copy. Collective. */
static void find_normals(bw_solid_crack *c, const bw_real *X)
{
  memset(c->own, 0, c->n * sizeof *c->own);
  for (size_t i = 0; i < c->n; i++) {
    const int family = c->wet[i] ? bw_solid_links(c->solid, i, c->link) : 0;
    for (int q = 0; q < family; q++) {
      if (c->link[q].intact) continue;
      const double gamma = bw_solid_stencil_fraction(c->solid, c->link[q].slot);
      const double *xi = bw_solid_stencil_offset(c->solid, c->link[q].slot);
      double y[3];
      vector_between(X, i, (size_t)c->link[q].neighbour, y);
      for (int k = 0; k < 3; k++) {
        c->own[i].before[k] += gamma * xi[k];
        c->own[i].now[k] += gamma * y[k];
      }
    }
  }
  bw_solid_fill_extended(c->solid, sizeof *c->own, c->own, c->of);
}

/* A broken bond: along and across its crack, before and now. */
typedef struct {
  double y[3], length, area;    /* y, |y|, |a| */
  double cosine_before, cosine; /* of the bond and the crack's normal */
  double across_before, across; /* xi.N0, y.N */
} cut;

/* Part of v along the crack's normal, of which both ends have a sum. */
static double across(const double a[3], const double b[3], const double v[3])
{
  const double N[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]}, size = sqrt(dot(N, N));
  return size > 0 ? dot(N, v) / size : 0;
}

static cut cut_of(const bw_solid_crack *c, const bw_real *X, size_t i, const bw_pd_link *link)
{
  const size_t j = (size_t)link->neighbour;
  const double *xi = bw_solid_stencil_offset(c->solid, link->slot), size = sqrt(dot(xi, xi));
  cut b = {.area = c->per_bond * bw_solid_stencil_fraction(c->solid, link->slot)};
  vector_between(X, i, j, b.y);
  b.length = sqrt(dot(b.y, b.y));
  b.across_before = across(c->of[i].before, c->of[j].before, xi);
  b.across = across(c->of[i].now, c->of[j].now, b.y);
  b.cosine_before = b.across_before / size;
  b.cosine = b.length > 0 ? b.across / b.length : 0;
  return b;
}

/* q of the header: 1 where the crack is closed or has no direction. */
static double share_of(const cut *b)
{
  return b->cosine > b->cosine_before && b->cosine_before > 0 ? b->cosine_before / b->cosine : 1;
}

bw_status bw_solid_crack_push(bw_solid_crack *c, double pressure, double F[])
{
  BW_TRY(follow(c));
  const bw_pd_extended all = bw_solid_get_extended(c->solid);
  find_normals(c, all.X);
  const double per_volume = pressure / bw_solid_volume(c->solid);
  for (size_t i = 0; i < c->n; i++) {
    const int family = c->wet[i] ? bw_solid_links(c->solid, i, c->link) : 0;
    for (int q = 0; q < family; q++) {
      if (c->link[q].intact) continue;
      const cut b = cut_of(c, all.X, i, &c->link[q]);
      if (b.length == 0) continue;
      /* Away from the other end, which finds the opposite from the same numbers. */
      const double push = per_volume * b.area * share_of(&b) / b.length;
      for (size_t k = 0; k < 3; k++)
        F[3 * i + k] -= push * b.y[k];
    }
  }
  return BW_OK;
}

bw_status bw_solid_crack_measure(bw_solid_crack *c, bw_solid_crack_size *out)
{
  BW_TRY(follow(c));
  const bw_pd_extended all = bw_solid_get_extended(c->solid);
  find_normals(c, all.X);
  double sum[3] = {0}; /* ends of bonds, area, volume */
  for (size_t i = 0; i < c->n; i++) {
    const int family = c->wet[i] ? bw_solid_links(c->solid, i, c->link) : 0;
    for (int q = 0; q < family; q++) {
      if (c->link[q].intact) continue;
      const cut b = cut_of(c, all.X, i, &c->link[q]);
      const double area = b.area * fabs(b.cosine_before);
      sum[0] += 1;
      sum[1] += area;
      sum[2] += area * (b.across - b.across_before);
    }
  }
  /* Each end has counted its bonds. */
  bw_comm_sum(bw_solid_comm(c->solid), 3, sum);
  *out = (bw_solid_crack_size){
      .bonds = llround(0.5 * sum[0]), .area = 0.5 * sum[1], .volume = 0.5 * sum[2]};
  return BW_OK;
}

const bool *bw_solid_crack_wet(const bw_solid_crack *c)
{
  return c->wet;
}
