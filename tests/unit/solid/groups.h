/* groups.h -- bodies of two groups of particles, for the tests of several materials in one body. */
#pragma once
#include "pd_test.h"

/* The group of a site. */
typedef uint8_t (*grouping)(const int32_t site[3]);

static inline uint8_t by_parity(const int32_t site[3])
{
  return (uint8_t)((site[0] + site[1] + site[2]) & 1);
}

static inline uint8_t by_half(const int32_t site[3])
{
  return site[0] >= 8;
}

/* All sites are given by the first rank: which rank gives them does not matter. */
static inline bw_solid *make(const bw_comm *comm, const bw_solid_config *c, const pd_body *body,
                             grouping of)
{
  bw_solid *s = NULL;
  uint8_t *group = NULL;
  const bool first = bw_comm_rank(comm) == 0;
  bw_check_ok(BW_ALLOCATE(&group, (size_t)body->n));
  for (int64_t q = 0; q < body->n; q++)
    group[q] = of(body->site + 3 * q);
  const bw_pd_sites given = {
      .n = first ? body->n : 0, .site = body->site, .kind = body->kind, .group = group};
  bw_check_ok(bw_solid_create(comm, c, &given, &s));
  bw_release(&group);
  return s;
}

/* The material of the second group of a config that has one. */
static inline bw_solid_config with_second(bw_solid_config c, double rho, double E, double G0)
{
  c.more.n = 1;
  c.more.material[0] = (bw_pd_material){.rho = rho, .E = E, .nu = NAN, .G0 = G0};
  return c;
}

/* The halves of the bar: E and density 1 : 5 and 1 : 3. */
static inline bw_solid_config two_halves(bw_pd_geometry geometry)
{
  const bw_solid_config c = pd_soft(geometry);
  return with_second(c, 3 * c.rho, 5 * c.E, c.G0);
}

/* A bar of two halves, 16 x 5 (x 4). */
static inline pd_body bar(bool planar)
{
  return pd_box(16, 5, planar ? 1 : 4);
}
