/* Below the front: a block of bonds is dilated, and its energy is that of elasticity; then its two
 * halves, which no bond joins, are pushed into each other, and contact pushes them apart. For those
 * who write a law or a module of their own; programs use bw_solid.h (solid_only.c).
 * BUILD modules=pd_body,pd_bond,pd_contact
 * TEST  ranks=1,2 */
#include "bw_memory.h"
#include "bw_pd_bond_law.h"
#include "bw_pd_contact.h"
#include "pd_law.h"
#include <math.h>
#include <stdio.h>

enum {
  SIDE = 12,
  GAP = 5
}; /* sites: of a block; between the halves, beyond the reach of a family */

/* The rank's part of a block of SIDE^3 sites, cut in two by a gap (or none) along x. */
static bw_status block_of(const bw_comm *world, int gap, bw_pd_sites *part, int32_t **site)
{
  const int64_t all = SIDE * SIDE * SIDE, size = bw_comm_size(world), rank = bw_comm_rank(world);
  const int64_t first = all * rank / size, last = all * (rank + 1) / size;
  BW_TRY(BW_ALLOCATE(site, (size_t)(3 * (last - first))));
  for (int64_t q = first; q < last; q++) {
    int32_t *s = *site + 3 * (q - first);
    s[0] = (int32_t)(q % SIDE), s[1] = (int32_t)(q / SIDE % SIDE),
    s[2] = (int32_t)(q / SIDE / SIDE);
    if (s[0] >= SIDE / 2) s[0] += gap;
  }
  *part = (bw_pd_sites){.n = last - first, .site = *site};
  return BW_OK;
}

static bw_status make(const bw_comm *world, int gap, bw_pd_body **body)
{
  int32_t *site = NULL;
  bw_pd_sites part;
  BW_TRY(block_of(world, gap, &part, &site));
  const bw_pd_body_config config = {.ds = 1e-3,
                                    .thickness = 1,
                                    .horizon_ratio = 3,
                                    .volume_fraction = BW_PD_FRACTION_DEFAULT,
                                    .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                    .n_group = 1,
                                    .material = {{.rho = 2500, .E = 70e9, .nu = NAN, .G0 = 10}}};
  const bw_pd_bond_options bonds = {BW_PD_SURFACE_TENSOR, BW_PD_CALIBRATION_LATTICE};
  const bw_status st = bw_pd_body_create(world, &config, &bw_pd_bond_law, &bonds, &part, body);
  bw_release(&site);
  return st;
}

/* Elastic energy over that of elasticity, 3 E e^2 V with Poisson's ratio 1/4. */
static bw_status dilate(const bw_comm *world, double *ratio)
{
  const double e = 1e-4;
  bw_pd_body *body;
  double *X = NULL, *V = NULL;
  BW_TRY(make(world, 0, &body));
  BW_TRY(BW_ALLOCATE(&X, 3 * body->n));
  BW_TRY(BW_ALLOCATE(&V, 3 * body->n)); /* at rest */
  bw_pd_body_get_reference(body, X);
  for (size_t k = 0; k < 3 * body->n; k++)
    X[k] *= 1 + e;
  bw_pd_body_set_state(body, X, V);
  bw_pd_body_internal_force(body, false, false); /* L/rho is in body->a */
  double energy = bw_pd_body_elastic(body);      /* of this rank's ends of bonds */
  bw_comm_sum(world, 1, &energy);
  const double volume = (double)body->points.total * body->level->dv;
  *ratio = energy / (3 * body->config.material[0].E * e * e * volume);
  bw_release(&X), bw_release(&V);
  bw_pd_body_destroy(&body);
  return BW_OK;
}

/* Energy of contact, and the sum of its forces over the sum of their magnitudes along x. */
static bw_status meet(const bw_comm *world, double *energy, double *unbalanced)
{
  bw_pd_body *body;
  bw_pd_contact *contact;
  double force[2] = {0}; /* sum, sum of magnitudes */
  BW_TRY(make(world, GAP, &body));
  BW_TRY(bw_pd_contact_create(body, &contact));
  for (size_t i = 0; i < body->n; i++) /* the right half goes over the gap and a tenth of ds more */
    if (body->points.site[3 * i] >= SIDE / 2)
      body->u[0][body->points.place[i]] = (bw_real)(-(GAP + 0.1) * body->level->ds);
  bw_pd_body_refresh(body, false);         /* others' copies of it, too */
  BW_TRY(bw_pd_contact_update(contact));   /* who is near whom */
  bw_pd_contact_force(contact);            /* accelerations, added to body->load.extra */
  *energy = bw_pd_contact_energy(contact); /* of this rank's ends of pairs */
  for (size_t i = 0; i < body->n; i++) {
    force[0] += (double)body->load.extra[0][i];
    force[1] += fabs((double)body->load.extra[0][i]);
  }
  bw_comm_sum(world, 1, energy);
  bw_comm_sum(world, 2, force);
  *unbalanced = force[0] / force[1];
  bw_pd_contact_destroy(&contact);
  bw_pd_body_destroy(&body);
  return BW_OK;
}

static bw_status run(const bw_comm *world)
{
  double ratio, energy, unbalanced;
  BW_TRY(dilate(world, &ratio));
  BW_TRY(meet(world, &energy, &unbalanced));
  if (bw_comm_rank(world) == 0)
    printf("dilation: %.4f of elasticity's energy; contact: %.3g J, forces balance to %.1e\n",
           ratio, energy, fabs(unbalanced));
  BW_REQUIRE(fabs(ratio - 1) < 0.05, BW_EDIVERGED,
             "the energy is %g of elasticity's; edges and corners explain 0.05", ratio);
  BW_REQUIRE(energy > 0 && fabs(unbalanced) < 1e-5, BW_EDIVERGED,
             "contact stores %g J and is out of balance by %g", energy, unbalanced);
  return BW_OK;
}

int main(int argc, char **argv)
{
  bw_comm *world;
  return bw_init(&argc, &argv, &world) == BW_OK ? bw_finish(&world, run(world)) : 1;
}
