/* pd_bond_contact.h -- state of the contact between particles that no bond joins, and with walls.
 *
 * Two kinds of pairs. Family pairs whose bond broke are found where their slots are: no search.
 * All others start further apart than the horizon; a cell search lists those nearer than reach +
 * skin, anew when something moved by half the skin since. So the force is one of positions and
 * broken bonds alone. Positions are in lattice axes, where periods act. */
#pragma once
#include "pd_bond_internal.h"

typedef struct {
  int32_t particle;
  int8_t wall;
  bool held; /* by an intact bond across the wall: does not meet it */
} bw_pd_near;

struct bw_pd_contact {
  double reach, skin; /* r_c = ds [L] */
  double closest;     /* least distance of a pair over its reach, in the forces so far */
  bool built;
  bw_real *u_built[3]; /* (n) displacement at the last search */

  size_t n_mine, n_theirs, n_sent;
  int32_t *mine; /* (n_mine) own particles */
  int32_t *sent; /* (n_sent) own particle of each item of the plan */
  bw_exchange *plan;
  double *send, *y;   /* (n_sent,3); (n_mine + n_theirs,3) present positions */
  int32_t *site;      /* (n_mine + n_theirs,3) */
  double *shift;      /* (n_mine + n_theirs,3) from the site, in a cloud; else NULL */
  size_t *pair_start; /* (n_mine + 1) */
  int32_t *pair;      /* index into y */
  size_t n_busy;
  int32_t *busy; /* (n_busy) those of mine that have pairs */

  size_t n_near;
  bw_pd_near *near;      /* (n_near) own particles near walls, at the last search */
  int64_t events;        /* of pd when `held` was found */
  bw_pd_bond_link *link; /* (stencil) scratch */
};

/* What a pair does to h at the distance r = sqrt(r2), d from h to l: adds its acceleration to
 * sum[] and returns half of its energy over rho dV. */
typedef struct {
  double reach, k; /* k_c dV/rho */
  double closest;  /* least r/reach met */
} bw_pd_law;
double bw_pd_contact__repel(bw_pd_law *law, const double d[3], double r2, double sum[3]);

double bw_pd_contact__stiffness(const bw_pd_bond *pd); /* k_c dV/rho */

/* pd_bond_wall.c. act returns energy over rho dV; with force adds to extra and sets wall_force. */
bw_status bw_pd_contact__wall_search(bw_pd_bond *pd);
bw_status bw_pd_contact__wall_update(bw_pd_bond *pd);
double bw_pd_contact__wall_act(bw_pd_bond *pd, bw_pd_law *law, bool force);

void bw_pd_contact__position(const bw_pd_bond *pd, size_t i, double y[3]);
bw_status bw_pd_contact__search(bw_pd_bond *pd); /* Collective. */
void bw_pd_contact__forget(bw_pd_contact *c);

/* y_l - y_h with the nearest image. */
static inline void bw_pd_contact__difference(const bw_pd_bond *pd, const double h[3],
                                             const double l[3], double d[3])
{
  for (int k = 0; k < 3; k++) {
    const double p = pd->config.period[k];
    d[k] = l[k] - h[k];
    if (p > 0 && d[k] > 0.5 * p) d[k] -= p * (double)(int64_t)(d[k] / p + 0.5);
    if (p > 0 && d[k] < -0.5 * p) d[k] += p * (double)(int64_t)(-d[k] / p + 0.5);
  }
}
