/* A disordered cloud: particles off their sites.
 *
 * Every particle is `disorder` ds from its site, in a direction drawn by a hash of the site (of its
 * home, where a direction is periodic) and the seed: it depends on nothing else, so that it is the
 * same on any number of ranks. Of all laws with the same largest offset, which is what widens the
 * stencil, this one spreads most: it takes a part J0(2 pi disorder) of the lattice's first Fourier
 * peaks to be left in the plane, 0 at 0.3827, and sin(2 pi disorder)/(2 pi disorder) in space.
 * Sites stay what blocks, slots and the stencil are made of; the stencil holds all directions in
 * which sites can be in each other's reach. */
#include "bw_memory.h"
#include "pd_bond_internal.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* The last step of splitmix64 (Steele, Lea & Flood 2014): every bit of x moves every bit. */
static uint64_t mix(uint64_t x)
{
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

/* Evenly from 0 .. 1; `which` numbers the draws of one site. */
static double uniform(const bw_pd_bond_config *c, const int32_t site[3], uint64_t which)
{
  uint64_t x = mix((uint64_t)(uint32_t)c->disorder_seed + (which << 32));
  for (int k = 0; k < 3; k++)
    x = mix((x + 0x9e3779b97f4a7c15u) ^ (uint64_t)(uint32_t)site[k]);
  return (double)(x >> 11) * 0x1p-53;
}

/* The site itself, or the one of its images nearest to 0 from above. */
static void home(const bw_pd_bond_config *c, const int32_t site[3], int32_t at[3])
{
  for (int k = 0; k < 3; k++) {
    const int32_t p = (int32_t)lround(c->period[k] / c->ds);
    at[k] = p == 0 ? site[k] : (site[k] % p + p) % p;
  }
}

/* From the site to its particle, in lattice axes [ds]. */
static void offset(const bw_pd_bond_config *c, const int32_t site[3], double y[3])
{
  int32_t at[3];
  home(c, site, at);
  const double angle = 2 * PI * uniform(c, at, 0);
  const double z = c->geometry == BW_PD_3D ? 2 * uniform(c, at, 1) - 1 : 0;
  const double across = c->disorder * sqrt(1 - z * z);
  y[0] = across * cos(angle), y[1] = across * sin(angle), y[2] = c->disorder * z;
}

bw_status bw_pd_bond__scatter(bw_pd_bond *pd)
{
  const bw_pd_bond_config *c = &pd->config;
  for (int k = 0; k < 3; k++)
    BW_TRY(bw_pd_bond__storage_array(pd->n_storage, &pd->shift[k]));
  for (size_t e = 0; e < pd->n_extended; e++) {
    double y[3];
    offset(c, pd->site + 3 * e, y);
    for (int k = 0; k < 3; k++)
      pd->shift[k][pd->place[e]] =
          (bw_real)(c->ds * (c->axes[0][k] * y[0] + c->axes[1][k] * y[1] + c->axes[2][k] * y[2]));
  }
  return BW_OK;
}

/* Gamma at a distance in ds: 3.33 with ERRATA 2, of the true distance. */
static double fraction(const bw_pd_bond_config *c, double r)
{
  if (c->volume_fraction == BW_PD_FRACTION_NONE) return 1;
  return fmax(0, fmin(1, c->horizon_ratio - r + 0.5));
}

bw_pd_rest bw_pd_bond__apart(const bw_pd_bond *pd, int direction, const double h[3],
                             const double l[3])
{
  bw_pd_rest rest;
  double r2 = 0;
  for (int k = 0; k < 3; k++) {
    rest.xi[k] = pd->stencil.xi[3 * direction + k] + (l[k] - h[k]);
    r2 += rest.xi[k] * rest.xi[k];
  }
  rest.r0 = sqrt(r2);
  rest.fraction = fraction(&pd->config, rest.r0 / pd->config.ds);
  return rest;
}

bw_pd_rest bw_pd_bond__rest_of_cloud(const bw_pd_bond *pd, int direction, int32_t h, int32_t l)
{
  double a[3], b[3];
  for (int k = 0; k < 3; k++)
    a[k] = (double)pd->shift[k][h], b[k] = (double)pd->shift[k][l];
  return bw_pd_bond__apart(pd, direction, a, b);
}

/* A cube (2D: square) of sites with all that is in reach of those in its middle. */
typedef struct {
  int side, margin;
  double *y; /* (side, side, side or 1; 3) places off the sites [ds] */
} sample;

static size_t row_of(const sample *s, const int32_t site[3])
{
  return (size_t)(site[0] + s->side * (site[1] + s->side * site[2]));
}

static bw_status draw(const bw_pd_bond *pd, int middle, sample *s)
{
  const bool planar = pd->dimension == 2;
  s->margin = pd->stencil.reach;
  s->side = middle + 2 * s->margin;
  const int layers = planar ? 1 : s->side;
  bw_pd_bond_config endless = pd->config;
  endless.period[0] = endless.period[1] = endless.period[2] = 0;
  BW_TRY(BW_ALLOCATE(&s->y, 3 * (size_t)(s->side * s->side * layers)));
  int32_t x[3];
  for (x[2] = 0; x[2] < layers; x[2]++)
    for (x[1] = 0; x[1] < s->side; x[1]++)
      for (x[0] = 0; x[0] < s->side; x[0]++)
        offset(&endless, x, s->y + 3 * row_of(s, x));
  return BW_OK;
}

static void add_family(const bw_pd_bond *pd, const sample *s, const int32_t site[3], double sum[3])
{
  const double *here = s->y + 3 * row_of(s, site), reach = bw_pd_bond__family_reach(&pd->config);
  for (int q = 0; q < pd->stencil.n; q++) {
    const int32_t *o = pd->stencil.offset + 3 * q;
    const int32_t at[3] = {site[0] + o[0], site[1] + o[1], site[2] + o[2]};
    const double *there = s->y + 3 * row_of(s, at);
    double r2 = 0;
    for (int k = 0; k < 3; k++)
      r2 += (o[k] + there[k] - here[k]) * (o[k] + there[k] - here[k]);
    const double r = sqrt(r2), gamma = r < reach ? fraction(&pd->config, r) : 0;
    sum[0] += gamma, sum[1] += gamma * r, sum[2] += gamma * r2;
  }
}

bw_status bw_pd_bond__cloud_means(const bw_pd_bond *pd, double mean[3])
{
  enum { SQUARE = 60, CUBE = 15 }; /* 3600 and 3375 families: means are known to 1e-3 */
  const bool planar = pd->dimension == 2;
  const int middle = planar ? SQUARE : CUBE;
  sample s;
  mean[0] = mean[1] = mean[2] = 0;
  BW_TRY(draw(pd, middle, &s));
  int32_t x[3];
  for (int q = 0; q < middle * middle * (planar ? 1 : middle); q++) {
    x[0] = s.margin + q % middle;
    x[1] = s.margin + q / middle % middle;
    x[2] = planar ? 0 : s.margin + q / (middle * middle);
    add_family(pd, &s, x, mean);
  }
  for (int k = 0; k < 3; k++)
    mean[k] /= middle * middle * (planar ? 1.0 : middle);
  bw_release(&s.y);
  return BW_OK;
}
