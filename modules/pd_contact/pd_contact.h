/* pd_contact.h -- state of the contact between particles that no bond joins, and with walls.
 *
 * Two kinds of pairs. Family pairs whose bond broke are found where their slots are: no search.
 * All others start further apart than the horizon; a cell search lists those nearer than reach +
 * skin, anew when something moved by half the skin since. So the force is one of positions and
 * broken bonds alone. Positions are in lattice axes, where periods act. What a particle brings into
 * a pair follows from its kind: its level and its group in one number. */
#pragma once
#include "bw_pd_contact.h"
#include "pd_law.h"

enum { BW_PD_CONTACT_STIFFNESS = 15 }; /* k_c/c: Macek & Silling 2007 */

typedef struct {
  int32_t particle;
  int8_t wall;
  bool held; /* by an intact bond across the wall: does not meet it */
} bw_pd_near;

/* What a pair does to h at the distance r = sqrt(r2), d from h to l: adds its acceleration to
 * sum[] and returns half of its energy over rho dV of the first group. */
typedef struct {
  double reach;   /* r_c [L] */
  double k;       /* k_c dV of l/rho of h */
  double weight;  /* mass of h over that of the first group on level 0 */
  double closest; /* least r/reach met */
} bw_pd_pair;

/* Candidates of this rank and those that others sent, and the pairs of the last search. */
typedef struct {
  size_t n_mine, n_theirs, n_sent;
  int32_t *mine; /* (n_mine) own particles */
  int32_t *sent; /* (n_sent) own particle of each item of the plan */
  bw_exchange *plan;
  double *send, *y;   /* (n_sent,3); (n_mine + n_theirs,3) present positions */
  int32_t *site;      /* (n_mine + n_theirs,3) */
  uint8_t *kind;      /* (n_mine + n_theirs) */
  double *shift;      /* (n_mine + n_theirs,3) from the site, in a cloud; else NULL */
  size_t *pair_start; /* (n_mine + 1) */
  int32_t *pair;      /* index into y */
  size_t n_busy;
  int32_t *busy; /* (n_busy) those of mine that have pairs */
} bw_pd_search;

struct bw_pd_contact {
  bw_pd_body *pd;      /* borrowed */
  double reach, skin;  /* the largest r_c; of the search [L] */
  double closest;      /* least distance of a pair over its reach, in the forces so far */
  int kinds;           /* levels times groups */
  bw_pd_pair *law;     /* (kinds, kinds) owner's kind, other's */
  bool built;          /* there is a search that holds */
  int64_t revision;    /* of the body that the arrays are for */
  bw_real *u_built[3]; /* (n) displacement at the last search */
  bw_pd_search found;

  size_t n_near;
  bw_pd_near *near; /* (n_near) own particles near walls, at the last search */
  int64_t events;   /* of pd when `held` was found */
  bw_pd_link *link; /* (stencil) scratch */
  int n_wall;
  bw_pd_wall wall[BW_PD_WALLS];
  double wall_force[3]; /* on the walls, of this rank, at the last evaluation [M L/T^2] */
};

/* pd_contact_pair.c: the push of a pair, see there. */
double bw_pd_contact__repel(bw_pd_pair *pair, const double d[3], double r2, double sum[3]);
/* The pair law of a particle of kind a with one of kind b. */
bw_pd_pair bw_pd_contact__pair(const bw_pd_contact *c, int a, int b);
/* Kind of an own particle or a copy; the row of the table of levels, and the group, of a kind. */
static inline uint8_t bw_pd_contact__kind(const bw_pd_body *pd, size_t e)
{
  const int level = (int)(bw_pd_body_level(pd, e) - pd->level);
  return (uint8_t)(level * pd->config.n_group + pd->points.group[e]);
}
static inline const bw_pd_level *bw_pd_contact__level(const bw_pd_body *pd, int kind)
{
  return pd->level + kind / pd->config.n_group;
}
/* What a particle of kind a of p feels of one of kind b of q, another body or the same. */
bw_pd_pair bw_pd_contact__law(const bw_pd_body *p, int a, const bw_pd_body *q, int b);

/* pd_contact_wall.c. act returns energy as repel does; with force adds to extra, sets
 * wall_force. */
bw_status bw_pd_contact__wall_search(bw_pd_contact *c) BW_MUST_CHECK;
bw_status bw_pd_contact__wall_update(bw_pd_contact *c) BW_MUST_CHECK;
double bw_pd_contact__wall_act(bw_pd_contact *c, bool force);

/* Present position, in space and in lattice axes. */
void bw_pd_contact__place(const bw_pd_body *pd, size_t i, double X[3]);
void bw_pd_contact__position(const bw_pd_body *pd, size_t i, double y[3]);
bw_status bw_pd_contact__search(bw_pd_contact *c) BW_MUST_CHECK; /* Collective. */

/* pd_contact_partners.c. Partners of all candidates one after the other; grows. Local. */
typedef struct {
  size_t n, room;   /* used, and how many there is room for */
  int32_t *partner; /* (room); the caller's */
} bw_pd_partners;
bw_status bw_pd_contact__append(bw_pd_partners *list, int32_t partner) BW_MUST_CHECK;
/* *busy (n_busy) <- candidates whose row start[q] .. start[q + 1] is not empty; the caller's. */
bw_status bw_pd_contact__busy(size_t n, const size_t start[], size_t *n_busy,
                              int32_t **busy) BW_MUST_CHECK;
/* pd_contact_share.c: from the candidates in mine: sent, plan, and y, site, kind, shift of own and
 * others. BW_EMEM. Collective. */
bw_status bw_pd_contact__share(bw_pd_contact *c) BW_MUST_CHECK;
void bw_pd_contact__release(bw_pd_contact *c);

/* y_l - y_h with the nearest image. */
static inline void bw_pd_contact__difference(const bw_pd_body *pd, const double h[3],
                                             const double l[3], double d[3])
{
  for (int k = 0; k < 3; k++) {
    const double p = pd->config.period[k];
    d[k] = l[k] - h[k];
    if (p > 0 && d[k] > 0.5 * p) d[k] -= p * (double)(int64_t)(d[k] / p + 0.5);
    if (p > 0 && d[k] < -0.5 * p) d[k] += p * (double)(int64_t)(-d[k] / p + 0.5);
  }
}
