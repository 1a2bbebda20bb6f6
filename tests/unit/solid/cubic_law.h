/* cubic_law.h -- springs with a cubic term: a law that is no part of Breakwater, by its socket.
 *
 * A bond of stretch s = (r - |xi|)/|xi| stores w = c |xi| (s^2/2 + beta s^4/4) per volume of both
 * ends, pulls with f = dw/dr = c (s + beta s^3), and breaks for good at s > s0. */
#pragma once
#define BW_PD_SPRING cubic_spring
#include "bw_memory.h"
#include "pd_springs.h"

typedef struct {
  double beta; /* of the cubic term, 0 or more [-] */
  double s0;   /* critical stretch [-] */
  double c;    /* micromodulus, from E and the horizon [M/(L^5 T^2)] */
} cubic_state;

static bw_pd_spring cubic_spring(const bw_pd_body *pd, const bw_pd_walk *b, double r)
{
  const cubic_state *law = (const cubic_state *)pd->state;
  const double s = r / b->rest.r0 - 1, s2 = s * s;
  return (bw_pd_spring){.force = law->c * s * (1 + law->beta * s2),
                        .energy = law->c * b->rest.r0 * s2 * (0.5 + 0.25 * law->beta * s2),
                        .stiffness = law->c / b->rest.r0 * (1 + 3 * law->beta * s2),
                        .steepest = law->c / b->rest.r0 * (1 + 3 * law->beta * law->s0 * law->s0),
                        .beyond = s > law->s0};
}

static bw_status cubic_check(const bw_pd_body_config *config, const void *options)
{
  const cubic_state *o = (const cubic_state *)options;
  BW_REQUIRE(config->geometry == BW_PD_3D && config->n_group == 1, BW_EINPUT,
             "cubic: only in three dimensions and of one material");
  BW_REQUIRE(o->beta >= 0 && o->s0 > 0 && isfinite(o->beta * o->s0), BW_EINPUT,
             "cubic: beta = %g must be 0 or more, s0 = %g positive, both finite", o->beta, o->s0);
  return BW_OK;
}

static bw_status cubic_prepare(bw_pd_body *pd, const void *options)
{
  const bw_status st = BW_ALLOCATE((cubic_state **)&pd->state, 1);
  if (st == BW_OK) *(cubic_state *)pd->state = *(const cubic_state *)options;
  return bw_comm_agree(pd->comm, st);
}

/* That of bonds with the same energy at small strain (POROUS 3.21). */
static void cubic_constants(bw_pd_body *pd)
{
  ((cubic_state *)pd->state)->c =
      12 * pd->config.material[0].E / (3.14159265358979323846 * pow(pd->level->horizon, 4));
}

static double cubic_micromodulus(const bw_pd_body *pd, int group)
{
  (void)group; /* there is one */
  return ((const cubic_state *)pd->state)->c;
}

static void cubic_destroy(bw_pd_body *pd)
{
  bw_release(&pd->state);
}

static const bw_pd_law_key cubic_keys[] = {
    {"beta", "", "factor of the cubic term"}, {"s0", "", "critical stretch"}, {NULL, NULL, NULL}};
static const bw_pd_law cubic_law = {.name = "cubic",
                                    .keys = cubic_keys,
                                    .check = cubic_check,
                                    .prepare = cubic_prepare,
                                    .constants = cubic_constants,
                                    .n_sweep = 1,
                                    .sweep = {bw_pd_springs_sweep},
                                    .breaks = bw_pd_springs_breaks,
                                    .bond_energy = bw_pd_springs_bond_energy,
                                    .energy = bw_pd_springs_energy,
                                    .bound = bw_pd_springs_bound,
                                    .tangent = bw_pd_springs_tangent,
                                    .rows = bw_pd_springs_rows,
                                    .virial = bw_pd_springs_virial,
                                    .micromodulus = cubic_micromodulus,
                                    .destroy = cubic_destroy};
