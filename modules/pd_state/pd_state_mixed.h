/* pd_state_mixed.h -- state of a body of both laws. */
#pragma once
#include "pd_state_correspondence.h"
#include "pd_state_ordinary.h"

enum { BW_PD_ORDINARY_LAW, BW_PD_CORRESPONDENCE_LAW, BW_PD_MIXED_LAWS };

/* pd_state_mixed_sweep.c */

/* The laws in that order. */
extern const bw_pd_law *const bw_pd_state__mixed_laws[BW_PD_MIXED_LAWS];

/* A law as it finds the body. */
typedef struct {
  void *state;                    /* pd->state */
  bw_real *row[BW_PD_FINEST + 1]; /* kernel rows of each level, put in place of the body's */
  bool *holds, *touches;          /* (n_block) owners of the law; they or their neighbours */
} bw_pd_mixed_part;

typedef struct {
  bw_pd_state_mixed_options options;
  bw_pd_mixed_part part[BW_PD_MIXED_LAWS];
  bw_real *other[3]; /* (n) acceleration by the ordinary law where the other adds its own */
  double *kx;        /* (n,3) */
  uint32_t *hit;     /* (n_block) */
  bool *marked;      /* (n_block) */
} bw_pd_mixed;

/* The law of the particle at a place. */
static inline int bw_pd_mixed_law_at(const bw_pd_body *pd, const bw_pd_mixed *m, int32_t place)
{
  return m->options.correspondence_group[bw_pd_body_group_at(pd, place)] ? BW_PD_CORRESPONDENCE_LAW
                                                                         : BW_PD_ORDINARY_LAW;
}

/* From here to `leave` the body is as the law knows it. */
bw_pd_mixed *bw_pd_state__mixed_enter(const bw_pd_body *pd, int law);
void bw_pd_state__mixed_leave(const bw_pd_body *pd, bw_pd_mixed *m, int law);

/* The passes. */
void bw_pd_state__mixed_deform(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);
void bw_pd_state__mixed_force(bw_pd_body *pd, size_t first, size_t last, bool check, bool damping);
