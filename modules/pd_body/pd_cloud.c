/* A disordered cloud: particles off their sites.
 *
 * Every particle starts `disorder` ds from its site, in a direction drawn by a hash of the site (of
 * its home, where a direction is periodic) and the seed. Then neighbours nearer than 0.9 ds push
 * each other apart, four times by half of what they lack, nobody further than disorder ds from its
 * site. All sites of space take part, occupied or not: a place depends on the site and the seed
 * alone, so that it is the same on any number of ranks. In the plane at 0.38 the nearest neighbour
 * is at 0.88 +- 0.04 ds (0.64 +- 0.21 without pushing) and 0.36 of the lattice's first Fourier
 * peaks is left (0.01: J0(2 pi disorder)), which costs some of the lattice's pull on cracks coming
 * back and gains that families are alike: paths wander half as much.
 * Sites stay what blocks, slots and the stencil are made of; the stencil holds all directions in
 * which sites can be in each other's reach. */
#include "bw_memory.h"
#include "pd_body.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double NEAREST = 0.9; /* [ds] */
enum { SWEEPS = 4, TILE = 16 };

/* The last step of splitmix64 (Steele, Lea & Flood 2014): every bit of x moves every bit. */
static uint64_t mix(uint64_t x)
{
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

/* Evenly from 0 .. 1; `which` numbers the draws of one site. */
static double uniform(const bw_pd_body_config *c, const int32_t site[3], uint64_t which)
{
  /* Seed and coordinates go through the hash one by one, so that no two sites share a draw. */
  uint64_t x = mix((uint64_t)(uint32_t)c->disorder_seed + (which << 32));
  for (int k = 0; k < 3; k++)
    x = mix((x + 0x9e3779b97f4a7c15u) ^ (uint64_t)(uint32_t)site[k]);
  /* 53 bits are what a double holds. */
  return (double)(x >> 11) * 0x1p-53;
}

/* The site itself, or the one of its images nearest to 0 from above. */
static void home(const bw_pd_body_config *c, const int32_t site[3], int32_t at[3])
{
  for (int k = 0; k < 3; k++) {
    const int32_t p = (int32_t)lround(c->period[k] / c->ds);
    at[k] = p == 0 ? site[k] : (site[k] % p + p) % p;
  }
}

/* From the site to its particle before it is pushed, in lattice axes [ds]. */
static void offset(const bw_pd_body_config *c, const int32_t site[3], double y[3])
{
  int32_t at[3];
  home(c, site, at);
  /* Evenly over the circle, or over the sphere by Archimedes: z is even in -1 .. 1. */
  const double angle = 2 * PI * uniform(c, at, 0);
  const double z = c->geometry == BW_PD_3D ? 2 * uniform(c, at, 1) - 1 : 0;
  const double across = c->disorder * sqrt(1 - z * z);
  y[0] = across * cos(angle), y[1] = across * sin(angle), y[2] = c->disorder * z;
}

/* A box of sites and the places of their particles off them. */
typedef struct {
  int32_t lower[3];
  int size[3];
  double *y, *before; /* (sites,3) x fastest [ds]; before: of the last sweep */
} field;

static size_t row_at(const field *f, const int32_t site[3])
{
  size_t row = 0;
  for (int k = 2; k >= 0; k--)
    row = row * (size_t)f->size[k] + (size_t)(site[k] - f->lower[k]);
  return row;
}

/* Calls of x fastest over the sites at least `margin` away from the sides of the box (2D: of the
 * one layer). Returns whether there is a next site. */
static void first_site(const field *f, int margin, int32_t site[3])
{
  for (int k = 0; k < 3; k++)
    site[k] = f->lower[k] + (f->size[k] > 1 ? margin : 0);
}

static bool next_site(const field *f, int margin, int32_t site[3])
{
  for (int k = 0; k < 3; k++) {
    const int m = f->size[k] > 1 ? margin : 0;
    if (++site[k] < f->lower[k] + f->size[k] - m) return true;
    site[k] = f->lower[k] + m;
  }
  return false;
}

/* What the neighbours of a site nearer than NEAREST push its particle by. */
static void push(const field *f, const int32_t site[3], double out[3])
{
  /* Places of the sweep before: the order of the sites does not matter. */
  const double *here = f->before + 3 * row_at(f, site);
  const int rz = f->size[2] > 1;
  out[0] = out[1] = out[2] = 0;
  for (int z = -rz; z <= rz; z++)
    for (int y = -1; y <= 1; y++)
      for (int x = -1; x <= 1; x++) {
        const int32_t o[3] = {x, y, z}, there[3] = {site[0] + x, site[1] + y, site[2] + z};
        const double *other = f->before + 3 * row_at(f, there);
        double d[3], r2 = 0;
        for (int k = 0; k < 3; k++)
          d[k] = o[k] + (other[k] - here[k]), r2 += d[k] * d[k];
        if (!(r2 < NEAREST * NEAREST) || r2 == 0) continue; /* 0: itself */
        /* Half of what is lacking; the other one does the other half. */
        const double r = sqrt(r2), part = 0.5 * (NEAREST - r) / r;
        for (int k = 0; k < 3; k++)
          out[k] -= part * d[k];
      }
}

static void sweep_field(const bw_pd_body_config *c, field *f)
{
  const size_t all = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
  int32_t site[3];
  /* Everybody is pushed from where all stood after the last sweep. */
  memcpy(f->before, f->y, 3 * all * sizeof *f->y);
  first_site(f, 1, site);
  do {
    /* A particle stays within its disorder of the site, so that the stencil holds all partners. */
    double *y = f->y + 3 * row_at(f, site), p[3], r2 = 0;
    push(f, site, p);
    for (int k = 0; k < 3; k++)
      y[k] += p[k], r2 += y[k] * y[k];
    for (int k = 0; k < 3 && r2 > c->disorder * c->disorder; k++)
      y[k] *= c->disorder / sqrt(r2);
  } while (next_site(f, 1, site));
}

/* The places of the sites lower .. lower + size - 1, in a box with a margin of SWEEPS. */
static bw_status make_field(const bw_pd_body_config *c, const int32_t lower[3], int size, field *f)
{
  const bool planar = c->geometry != BW_PD_3D;
  for (int k = 0; k < 3; k++) {
    /* A push travels one site per sweep: within the margin places are not final, inside they
     * are. */
    const bool flat = planar && k == 2;
    f->lower[k] = flat ? 0 : lower[k] - SWEEPS;
    f->size[k] = flat ? 1 : size + 2 * SWEEPS;
  }
  const size_t all = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
  BW_TRY(BW_ALLOCATE(&f->y, 3 * all));
  BW_TRY(BW_ALLOCATE(&f->before, 3 * all));
  int32_t site[3];
  /* Drawn without regard to each other ... */
  first_site(f, 0, site);
  do
    offset(c, site, f->y + 3 * row_at(f, site));
  while (next_site(f, 0, site));
  /* ... then pushed apart. */
  for (int q = 0; q < SWEEPS; q++)
    sweep_field(c, f);
  return BW_OK;
}

static void release_field(field *f)
{
  bw_release(&f->y);
  bw_release(&f->before);
}

/* Extended particles by tiles of TILE sites each way. */
typedef struct {
  bw_particles_map number; /* tile -> number */
  int32_t n;               /* tiles */
  int32_t *head, *next;    /* (n_extended) first of a tile, next of its tile; -1: none */
} tiling;

static void tile_of(const int32_t site[3], int32_t tile[3])
{
  for (int k = 0; k < 3; k++)
    tile[k] = (site[k] - (site[k] < 0 ? TILE - 1 : 0)) / TILE;
}

static bw_status make_tiles(const bw_pd_body *pd, tiling *t)
{
  /* The box of all tiles bounds the map's keys. */
  int32_t lower[3] = {INT32_MAX, INT32_MAX, INT32_MAX};
  int32_t upper[3] = {INT32_MIN, INT32_MIN, INT32_MIN}, tile[3], found;
  for (size_t e = 0; e < pd->n_extended; e++) {
    tile_of(pd->points.site + 3 * e, tile);
    for (int k = 0; k < 3; k++) {
      lower[k] = tile[k] < lower[k] ? tile[k] : lower[k];
      upper[k] = tile[k] > upper[k] ? tile[k] : upper[k];
    }
  }
  /* At most as many tiles as particles; each holds a list of its own. */
  BW_TRY(BW_ALLOCATE(&t->head, pd->n_extended));
  BW_TRY(BW_ALLOCATE(&t->next, pd->n_extended));
  if (pd->n_extended == 0) return BW_OK;
  /* Occupied tiles only: empty space costs nothing. */
  BW_TRY(bw_particles_map_create(64, lower, upper, &t->number));
  for (size_t e = 0; e < pd->n_extended; e++) {
    tile_of(pd->points.site + 3 * e, tile);
    BW_TRY(bw_particles_map_put(&t->number, tile, t->n, &found));
    if (found < 0) t->head[t->n] = -1, found = t->n++;
    t->next[e] = t->head[found];
    t->head[found] = (int32_t)e;
  }
  return BW_OK;
}

static bw_status scatter_tile(bw_pd_body *pd, const tiling *t, int32_t number)
{
  const bw_pd_body_config *c = &pd->config;
  int32_t lower[3];
  field f = {0};
  /* The tile's own sites with a margin around: the same places wherever tiles begin. */
  tile_of(pd->points.site + 3 * (size_t)t->head[number], lower);
  for (int k = 0; k < 3; k++)
    lower[k] *= TILE;
  const bw_status st = make_field(c, lower, TILE, &f);
  /* From lattice axes in spacings to lengths in space. */
  for (int32_t e = t->head[number]; e >= 0 && st == BW_OK; e = t->next[e]) {
    const double *y = f.y + 3 * row_at(&f, pd->points.site + 3 * (size_t)e);
    /* Laid out like displacements, so that a sweep loads both alike. */
    for (int k = 0; k < 3; k++)
      pd->points.shift[k][pd->points.place[e]] =
          (bw_real)(c->ds * (c->axes[0][k] * y[0] + c->axes[1][k] * y[1] + c->axes[2][k] * y[2]));
  }
  release_field(&f);
  return st;
}

bw_status bw_pd_body_scatter(bw_pd_body *pd)
{
  tiling t = {.n = 0};
  for (int k = 0; k < 3; k++)
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &pd->points.shift[k]));
  /* Tile by tile: no field of all sites is ever held. */
  bw_status st = make_tiles(pd, &t);
  for (int32_t q = 0; q < t.n && st == BW_OK; q++)
    st = scatter_tile(pd, &t, q);
  bw_particles_map_destroy(&t.number);
  bw_release(&t.head);
  bw_release(&t.next);
  return st;
}

/* Gamma at a distance in ds: 3.33 with ERRATA 2, of the true distance. */
static double fraction(const bw_pd_body_config *c, double r)
{
  if (c->volume_fraction == BW_PD_FRACTION_NONE) return 1;
  return fmax(0, fmin(1, c->horizon_ratio - r + 0.5));
}

bw_pd_rest bw_pd_body_apart(const bw_pd_body *pd, int direction, const double h[3],
                            const double l[3])
{
  bw_pd_rest rest;
  /* What the two ends are off their sites by changes the bond between the sites. */
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    rest.xi[k] = pd->level->stencil.xi[3 * direction + k] + (l[k] - h[k]);
    r2 += rest.xi[k] * rest.xi[k];
  }
  rest.r0 = sqrt(r2);
  rest.fraction = fraction(&pd->config, rest.r0 / pd->level->ds);
  return rest;
}

bw_pd_rest bw_pd_body_rest_of_cloud(const bw_pd_body *pd, int direction, int32_t h, int32_t l)
{
  double a[3], b[3];
  for (int k = 0; k < 3; k++)
    a[k] = (double)pd->points.shift[k][h], b[k] = (double)pd->points.shift[k][l];
  return bw_pd_body_apart(pd, direction, a, b);
}

static void add_family(const bw_pd_body *pd, const field *f, const int32_t site[3], double sum[3])
{
  /* All directions in which sites can be family; whether they are, the places tell. */
  const double *here = f->y + 3 * row_at(f, site), reach = bw_pd_body_family_reach(&pd->config);
  for (int q = 0; q < pd->level->stencil.n; q++) {
    const int32_t *o = pd->level->stencil.offset + 3 * q;
    const int32_t at[3] = {site[0] + o[0], site[1] + o[1], site[2] + o[2]};
    const double *there = f->y + 3 * row_at(f, at);
    double r2 = 0;
    for (int k = 0; k < 3; k++)
      r2 += (o[k] + there[k] - here[k]) * (o[k] + there[k] - here[k]);
    const double r = sqrt(r2), gamma = r < reach ? fraction(&pd->config, r) : 0;
    sum[0] += gamma, sum[1] += gamma * r, sum[2] += gamma * r2;
  }
}

bw_status bw_pd_body_cloud_means(const bw_pd_body *pd, double mean[3])
{
  enum { SQUARE = 60, CUBE = 15 }; /* 3600 and 3375 families: means are known to 1e-3 */
  const int side = (pd->dimension == 2 ? SQUARE : CUBE) + 2 * pd->level->stencil.reach;
  /* A sample without sides: every family in it is full. */
  bw_pd_body_config endless = pd->config;
  endless.period[0] = endless.period[1] = endless.period[2] = 0;
  field f = {0};
  mean[0] = mean[1] = mean[2] = 0;
  const bw_status st = make_field(&endless, (int32_t[3]){0, 0, 0}, side, &f);
  if (st == BW_OK) {
    /* Sites whose whole family has its final place. */
    const int margin = SWEEPS + pd->level->stencil.reach;
    double families = 0;
    int32_t site[3];
    first_site(&f, margin, site);
    do {
      add_family(pd, &f, site, mean);
      families++;
    } while (next_site(&f, margin, site));
    /* Sums over families become means of one. */
    for (int k = 0; k < 3; k++)
      mean[k] /= families;
  }
  release_field(&f);
  return st;
}
