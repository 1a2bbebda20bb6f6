/* Particles on a lattice are divided over ranks: values go to the copies that neighbours need, and
 * what is added to copies comes back to their owners. Every pair pushes apart; the sum is zero.
 * BUILD modules=particles
 * TEST  ranks=1,2,4 */
#include "bw_memory.h"
#include "bw_particles_copies.h"
#include "bw_particles_halo.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { X = 12, Y = 9, Z = 7 };
static const int32_t forward[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; /* each pair is met once */

typedef struct {
  bw_particles_partition *partition;
  size_t n;
  int32_t *site;         /* (n,3) own */
  bw_particles_map near; /* site -> own particle or copy */
  bw_particles_copies *copies;
} crowd;

static int32_t find(const void *near, const void *site)
{
  return bw_particles_map_get(near, site);
}

/* Each rank knows a part of the sites, any part, and gets those that it owns. */
static bw_status divide(const bw_comm *world, crowd *c)
{
  const int rank = bw_comm_rank(world), size = bw_comm_size(world);
  int32_t some[X * Y * Z][3];
  size_t n_some = 0;
  for (int32_t q = rank; q < X * Y * Z; q += size, n_some++)
    memcpy(some[n_some], (int32_t[3]){q % X, q / X % Y, q / X / Y}, sizeof some[0]);
  BW_TRY(bw_particles_partition_create(world, n_some, some[0], &c->partition));
  BW_TRY(bw_comm_agree(world, BW_ALLOCATE(&c->site, 3 * X * Y * Z)));
  for (int32_t q = 0; q < X * Y * Z; q++) { /* few sites: all are tried; else bw_exchange.h */
    const int32_t site[3] = {q % X, q / X % Y, q / X / Y};
    if (bw_particles_partition_owner(c->partition, site) == rank)
      memcpy(c->site + 3 * c->n++, site, sizeof site);
  }
  return BW_OK;
}

static bw_status meet(const bw_comm *world, crowd *c)
{
  bw_particles_lattice lattice = {.partition = c->partition, .n_offset = 3, .offset = forward[0]};
  bw_particles_halo halo = {0}; /* places beside own particles that others occupy */
  BW_TRY(bw_comm_agree(world, bw_particles_map_create_own(c->n, c->site, 1, &c->near)));
  bw_status st = bw_particles_halo_create(world, &lattice, c->n, c->site, &c->near, &halo);
  const bw_particles_question ask = {halo.n,    halo.owner, sizeof(int32_t[3]),
                                     halo.home, find,       &c->near};
  BW_THEN(st, bw_particles_copies_create(world, c->n, &ask, sizeof(double), &c->copies));
  bw_particles_halo_destroy(&halo);
  return st;
}

/* all, force (n + copies): a force of the product of both values between each two neighbours. */
static void push(const crowd *c, const double all[], double force[])
{
  for (size_t i = 0; i < c->n; i++)
    for (int q = 0; q < 3; q++) {
      const int32_t *s = c->site + 3 * i, *o = forward[q];
      const int32_t place[3] = {s[0] + o[0], s[1] + o[1], s[2] + o[2]};
      const int32_t j = bw_particles_map_get(&c->near, place); /* own, a copy, or nobody */
      if (j < 0) continue;
      force[i] -= all[i] * all[j];
      force[j] += all[i] * all[j];
    }
}

static bw_status run(const bw_comm *world, crowd *c)
{
  double *all = NULL, *force = NULL, sum[2] = {0};
  BW_TRY(divide(world, c));
  BW_TRY(meet(world, c));
  const size_t n_all = c->n + bw_particles_copies_count(c->copies);
  bw_status st = BW_ALLOCATE(&all, n_all);
  BW_THEN(st, BW_ALLOCATE(&force, n_all));
  st = bw_comm_agree(world, st);
  if (st == BW_OK) {
    for (size_t i = 0; i < c->n; i++)
      all[i] = 1 + c->site[3 * i] % 3;
    bw_particles_copies_values(c->copies, sizeof *all, all, all); /* own first, then copies */
    push(c, all, force);
    bw_particles_copies_sum(c->copies, 1, force); /* added where they are owned */
    for (size_t i = 0; i < c->n; i++)
      sum[0] += force[i], sum[1] += fabs(force[i]);
    bw_comm_sum(world, 2, sum);
    if (bw_comm_rank(world) == 0) printf("sum of forces %g, of magnitudes %g\n", sum[0], sum[1]);
    if (!(sum[0] == 0 && sum[1] > 0)) st = BW_FAIL(BW_EDIVERGED, "forces do not cancel");
  }
  bw_release(&all);
  bw_release(&force);
  return st;
}

int main(int argc, char **argv)
{
  bw_comm *world;
  crowd c = {0};
  if (bw_init(&argc, &argv, &world) != BW_OK) return 1;
  const bw_status st = run(world, &c);
  bw_particles_copies_destroy(&c.copies);
  bw_particles_map_destroy(&c.near);
  bw_particles_partition_destroy(&c.partition);
  bw_release(&c.site);
  return bw_finish(&world, st);
}
