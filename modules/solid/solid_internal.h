/* solid_internal.h -- the solid: a body, its contact, its integrator and its book. */
#pragma once
#include "bw_pd_material.h"
#include "bw_solid.h"
#include "pd_law.h"

enum {
  BW_SOLID__ROW = 13
}; /* of a restart: u, v, a, damping, the bits below; then the law's fields */
enum { BW_SOLID__GONE = 1, BW_SOLID__STALE = 2 }; /* is retired; a is not that of u and v */

/* What has gone where since the start, of this rank. */
typedef struct {
  double damping;     /* dissipated [M L^2/T^2] */
  double external;    /* work of forces and prescribed motion [M L^2/T^2] */
  double retired;     /* elastic energy that went with retired particles [M L^2/T^2] */
  double wall[3];     /* impulse on the walls [M L/T] */
  int64_t precracked; /* bonds cut by pre-cracks, from both ends */
} bw_solid_book;

/* bw_solid_set_drag, of the particles that can move. */
typedef struct {
  size_t n;            /* of them */
  int32_t *particle;   /* (n) own particles */
  double *k, *towards; /* (n) [M/(L^3 T)], (n,3) [L/T] */
  double *rate, dt;    /* (n) what takes part of v - towards per time [1/T], in a step of dt [T] */
  double *before, *other; /* (n,3) v and f at the beginning of a step, without the drag */
  double *impulse, work;  /* (n,3) [M/(L^2 T)], [M L^2/T^2]: since it was set */
} bw_solid__drag;

struct bw_solid {
  bw_solid_config config; /* as it was asked for, defaults resolved */
  bw_pd_body *body;
  bw_pd_contact *contact;             /* NULL: none */
  bw_real *v_before[3], *a_before[3]; /* (n) RK3's previous stage */
  bool loaded;                        /* load.extra may differ from zero */
  bool restored;                      /* a was given by set_restart */
  int64_t evaluated;                  /* raised when the forces were: what a set added is gone */
  int64_t shared; /* evaluated when a set added its contact last; -1: not yet, 0: in no set */
  size_t n_retired;
  int32_t *retired; /* (n_retired of n) own particles */
  bw_solid__drag drag;
  bw_solid_book book;
};

/* solid_step.c, the pieces of a Verlet step: begin, leap, evaluate, land, end. begin is collective
 * and its status the same on all ranks; leap: BW_EDIVERGED when a particle moved more than a
 * horizon. */
bw_status bw_solid__begin(bw_solid *s) BW_MUST_CHECK;
bw_status bw_solid__leap(bw_solid *s, double dt) BW_MUST_CHECK;
void bw_solid__land(bw_solid *s, double dt);
bw_status bw_solid__end(bw_solid *s) BW_MUST_CHECK;
/* Forces at the present u (and v for damping). Collective. */
bw_status bw_solid__evaluate(bw_solid *s, bool check) BW_MUST_CHECK;

/* solid_law.c: room for the options of a law of the table. */
typedef union {
  bw_pd_bond_options bond;
  bw_pd_state_ordinary_options ordinary;
  bw_pd_state_correspondence_options correspondence;
} bw_solid_options;
/* The law's options by `choice`, in `store`; NULL for a law that is not of the table. */
const void *bw_solid__law_options(const bw_solid_config *config, const bw_pd_law *law,
                                  bw_solid_options *store);
/* solid_drag.c: the drag joins the external force at the beginning of a step of dt and leaves it at
 * its end. Local. */
void bw_solid__drag_on(bw_solid *s, double dt);
void bw_solid__drag_off(bw_solid *s, double dt);
void bw_solid__drag_release(bw_solid__drag *d);

/* solid_retire.c */
/* Who is retired by the rows of a restart, each of so many numbers. Collective. */
void bw_solid__retire_rows(bw_solid *s, size_t width, const double rows[]);
