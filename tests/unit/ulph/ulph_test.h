/* ulph_test.h -- small fluids: a cloud with a surface all round, a tank. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_ulph.h"
#include "ulph_internal.h"

#include <string.h>

/* What an evaluation has left of the fluid particle i of this rank. */
#define ULPH_BETWEEN(u, i, what) ((u)->between[(i) / BW_ULPH_LANES].what[(i) % BW_ULPH_LANES])

/* In [-1, 1), from a number alone (splitmix64, Steele, Lea & Flood 2014). */
static inline double noise(uint64_t key)
{
  uint64_t z = key * UINT64_C(0x9E3779B97F4A7C15) + UINT64_C(0x632BE59BD9B4E019);
  z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
  return 2 * ((double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0) - 1;
}

static inline bw_ulph_config ulph_still(int d)
{
  bw_ulph_config c = bw_ulph_config_default();
  c.dimensions = d, c.dx = 1, c.rho0 = 2, c.speed = 1;
  c.alpha = c.alpha_wall = c.delta = c.shifting = 0;
  c.tension_cure = false;
  return c;
}

/* n^d particles, each moved by up to a fifth of dx; every rank of comm passes its share. */
static inline bw_ulph *ulph_cloud(const bw_comm *comm, const bw_ulph_config *c, int n)
{
  const int rank = bw_comm_rank(comm), size = bw_comm_size(comm), deep = c->dimensions == 3 ? n : 1;
  const int total = n * n * deep, first = total * rank / size, last = total * (rank + 1) / size;
  double *x = NULL;
  bw_ulph *u = NULL;
  bw_check_ok(BW_ALLOCATE(&x, 3 * (size_t)(last - first)));
  for (int q = first; q < last; q++) {
    const int site[3] = {q % n, q / n % n, q / n / n};
    for (int k = 0; k < c->dimensions; k++)
      x[3 * (q - first) + k] = (site[k] + 0.2 * noise((uint64_t)(3 * q + k))) * c->dx;
  }
  bw_check_ok(bw_ulph_create(comm, c, (size_t)(last - first), x, 0, NULL, &u));
  bw_release(&x);
  return u;
}

/* Water of n x n (x 6) particles in a corner of a tank three times as long; the rest is as in
 * validation/ulph/tank.h. */
static inline bw_ulph *ulph_dam(const bw_comm *comm, int d, int n, double shifting)
{
  bw_ulph_config c = bw_ulph_config_default();
  c.dimensions = d, c.dx = 1.0 / n, c.rho0 = 1000, c.speed = 6.3, c.gravity[1] = -9.81;
  c.shifting = shifting;
  const double wide = 6 * c.dx, thick = 4 * c.dx, origin[3] = {0};
  const bw_shape water = {.kind = BW_SHAPE_BOX, .upper = {1, 1, wide}};
  const bw_shape wall[2] = {{.kind = BW_SHAPE_BOX,
                             .lower = {-thick, -thick, -thick},
                             .upper = {3 + thick, 2, wide + thick}},
                            {.kind = BW_SHAPE_BOX, .remove = true, .upper = {3, 9, wide}}};
  const bw_ulph_wall walls = {.count = 2, .shape = wall};
  size_t count = 0;
  double *x = NULL;
  bw_ulph *u = NULL;
  bw_check_ok(bw_ulph_fill(comm, &c, origin, 1, &water, &count, &x));
  bw_check_ok(bw_ulph_create(comm, &c, count, x, 1, &walls, &u));
  bw_release(&x);
  return u;
}

/* Rows of all particles in the order of their numbers, on every rank. */
static inline double *ulph_all(const bw_comm *comm, const bw_ulph *u, double numbers[])
{
  const size_t n = bw_ulph_count(u), total = (size_t)bw_ulph_total(u);
  double *rows = NULL, *all = NULL;
  int64_t *id = NULL;
  bw_check_ok(BW_ALLOCATE(&rows, BW_ULPH_ROW * n));
  bw_check_ok(BW_ALLOCATE(&all, BW_ULPH_ROW * total));
  bw_check_ok(BW_ALLOCATE(&id, n));
  bw_ulph_ids(u, id);
  bw_ulph_state_get(u, rows, numbers);
  for (size_t i = 0; i < n; i++)
    memcpy(all + BW_ULPH_ROW * id[i], rows + BW_ULPH_ROW * i, BW_ULPH_ROW * sizeof *rows);
  bw_comm_sum(comm, BW_ULPH_ROW * total, all);
  bw_release(&rows);
  bw_release(&id);
  return all;
}

static inline void ulph_advance(bw_ulph *u, int steps)
{
  for (int q = 0; q < steps; q++)
    bw_check_ok(bw_ulph_step(u, bw_ulph_dt_max(u)));
}
