/* pd_contact_between.h -- state of the contact between bodies, shared by its sources.
 *
 * A row of the lists below is a particle that may be near another body: own ones first, then what
 * other ranks sent. `kind` of a row numbers bodies, levels and groups in one: the law of a pair
 * follows from the kinds of both. */
#pragma once
#include "bw_particles_cells.h"
#include "bw_pd_contact_between.h"
#include "pd_contact.h"

typedef struct {
  int32_t body, particle;
} bw_pd_between_row;

/* Bodies and the kinds of their particles (pd_contact.h) in one numbering. */
typedef struct {
  int n;
  int *first;      /* (n_body) of a body's first kind */
  int *body;       /* (n) */
  bw_pd_pair *law; /* (n, n) owner's kind, other's; reach 0: the same body */
} bw_pd_between_kinds;

struct bw_pd_contact_between {
  int n_body;
  bw_pd_body **body;    /* (n_body) borrowed */
  bw_real **u_built[3]; /* (n_body)(n of the body) displacement at the last search [L] */
  double reach, skin;   /* the largest r_c; of the search [L] */
  double period[3];     /* of space [L], 0: not periodic */
  bw_pd_between_kinds kinds;
  double closest; /* least distance of a pair over its reach so far */
  bool built;
  int64_t revision; /* of all bodies that the arrays are for */

  size_t n_mine, n_theirs, n_sent, n_busy;
  bw_pd_between_row *mine; /* (n_mine) */
  bw_pd_between_row *sent; /* (n_sent) of each item of the plan */
  bw_exchange *plan;
  double *send, *y;   /* (n_sent,3); (n_mine + n_theirs,3) present positions [L] */
  int32_t *kind;      /* (n_mine + n_theirs) */
  size_t *pair_start; /* (n_mine + 1) */
  int32_t *pair;      /* index into y */
  int32_t *busy;      /* (n_busy) those of mine that have pairs */
};

/* pd_contact_between_search.c. Collective. */
bw_status bw_pd_contact__between_search(bw_pd_contact_between *c) BW_MUST_CHECK;
void bw_pd_contact__between_release(bw_pd_contact_between *c); /* the lists of a search. Local. */
