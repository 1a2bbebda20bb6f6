/* solid_internal.h -- the solid: a body, its contact, its integrator and its book. */
#pragma once
#include "bw_pd_material.h"
#include "bw_solid.h"
#include "bw_solid_levels.h"
#include "bw_solid_outside.h"
#include "pd_law.h"

enum {
  BW_SOLID__ROW = 13
}; /* of a restart: u, v, a, damping, the bits below; then the law's fields */
enum { BW_SOLID__GONE = 1, BW_SOLID__STALE = 2 }; /* is retired; a is not that of u and v */

/* What has gone where since the start, of this rank. */
typedef struct {
  double damping;     /* dissipated [M L^2/T^2] */
  double external;    /* work of forces and prescribed motion [M L^2/T^2] */
  double regrid;      /* taken by changes of levels [M L^2/T^2] */
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

/* A pre-crack as it was asked for. */
typedef struct {
  double a[3], b[3], c[3];
} bw_solid__precrack;

/* Of a solid whose levels change. */
typedef struct {
  bw_pd_map map;         /* of the body as it is */
  uint8_t *least;        /* (cells) level that boxes ask for, with belts */
  uint8_t *age;          /* (cells) looks since a fine cell was needed, up to 255 */
  bw_pd_sites given;     /* what this rank gave to create, owned: */
  int32_t *site;         /* (given.n,3) */
  uint8_t *kind, *group; /* (given.n); NULL: none were given */
  int n_cut;
  bw_solid__precrack *cut; /* (n_cut) pre-cracks so far */
  uint16_t *precut;        /* (n) bonds of the own particles that they cut */
  double since, dt;        /* since the last look; the last step [T] */
  double frequency2;       /* bound of the squared largest one where all is fine [1/T^2] */
  int64_t changes;         /* so far */
} bw_solid__levels;

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
  bw_solid_outside outside; /* who NULL: nobody */
  double *outside_X;        /* (n,3) for it */
  bw_solid__levels *levels; /* NULL: they stay as they are */
  bw_solid_book book;
};

/* solid_body.c: a body by the solid's configuration, its levels by a map (NULL: by its boxes); and
 * what the solid keeps per particle of its body, contact too. Collective. */
bw_status bw_solid__body(const bw_solid *s, const bw_comm *comm, const bw_pd_sites *given,
                         const bw_pd_map *map, bw_pd_body **out) BW_MUST_CHECK;
bw_status bw_solid__own_arrays(bw_solid *s) BW_MUST_CHECK;
void bw_solid__release_own_arrays(bw_solid *s);

/* solid_levels.c */
/* The levels of a solid that is being made, from its boxes; before its body. Collective. */
bw_status bw_solid__levels_create(bw_solid *s, const bw_comm *comm,
                                  const bw_pd_sites *given) BW_MUST_CHECK;
void bw_solid__levels_release(bw_solid *s);
void bw_solid__levels_bound(bw_solid *s); /* frequency2, once the first body stands. Local. */
/* The time of a step counts; BW_EINPUT where a look is overdue. Local. */
bw_status bw_solid__levels_time(bw_solid *s, double dt) BW_MUST_CHECK;
bool bw_solid__levels_due(const bw_solid *s); /* would the next step be one too many? Local. */
/* flag (cells) <- bits of what is in each cell, of all ranks: those of bw_pd_levels_look and these.
 * BW_EDIVERGED where a bond has broken above the finest level. Collective. */
enum { BW_SOLID__OCCUPIED = 4, BW_SOLID__SCAR = 8 };
bw_status bw_solid__levels_scan(const bw_solid *s, uint8_t flag[]) BW_MUST_CHECK;
/* Sets flag where `bit` of scan is within `width` cells. BW_EMEM. Local. */
bw_status bw_solid__levels_around(const bw_solid *s, const uint8_t scan[], int bit, int width,
                                  uint8_t flag[]) BW_MUST_CHECK;

/* solid_regrid.c: a body of another map in place of that of the solid, which takes the cells of the
 * map over. Collective. */
bw_status bw_solid__remap(bw_solid *s, bw_pd_map *now) BW_MUST_CHECK;

/* solid_cut.c: the bonds of a pre-crack, booked; of all so far in a new body. Collective. */
bw_status bw_solid__cut(bw_solid *s, const double a[3], const double b[3],
                        const double c[3]) BW_MUST_CHECK;
bw_status bw_solid__cut_again(bw_solid *s) BW_MUST_CHECK;

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
void bw_solid__renew_kinds(bw_solid *s); /* what follows from kinds. Collective. */
/* Who is retired by the rows of a restart, each of so many numbers. Collective. */
void bw_solid__retire_rows(bw_solid *s, size_t width, const double rows[]);
