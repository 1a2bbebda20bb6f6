/* pd_fragment_internal.h -- shared by the sources of fragments only. */
#pragma once
#include "bw_exchange.h"
#include "bw_pd_interface.h"

typedef struct {
  int64_t label;    /* smallest id of the piece */
  int32_t image[3]; /* X + image period is beside the label's particle */
  int32_t rank;     /* that has the label's particle: the piece is its */
} bw_pd_fragment__tag;

/* The own particles of this rank: which piece each is in, where it is and how it moves. */
typedef struct {
  const bw_comm *comm;
  size_t n;                       /* own particles */
  const bw_pd_fragment__tag *tag; /* (n) */
  const int32_t *parent;          /* (n) of the union; a root is its own */
  const double *X, *V;            /* (n,3) [L], [L/T] */
  double period[3];               /* [L] */
  const double *weight;           /* (n) mass over that of a particle of the first group */
  double mass;                    /* of a particle of the first group [M] */
} bw_pd_fragment__particles;

/* out->own, n and total. Collective. */
bw_status bw_pd_fragment__measure(const bw_pd_fragment__particles *p,
                                  bw_pd_fragments *out) BW_MUST_CHECK;

/* out->largest from own of all ranks. Collective. */
void bw_pd_fragment__find_largest(const bw_comm *comm, bw_pd_fragments *out);

/* Does a come before b: more particles, or as many and the smaller label. Local. */
bool bw_pd_fragment__before(const bw_pd_fragment *a, const bw_pd_fragment *b);
