/* probe_internal.h -- shared by the sources of probe only. */
#pragma once
#include "bw_exchange.h"
#include "bw_probe.h"

enum { PROBE_CENTRE, PROBE_FACE, PROBE_PLACES }; /* where nodes sit in one direction */
enum { PROBE_WIDTH = 4 };                        /* nodes per direction, padded with zeros */
enum { PROBE_BATCH = 16 };                       /* tips whose weights are made together */

/* Weights of one direction: the tip itself, mean and difference over (tip - h/2, tip + h/2). At the
 * tip the kernel's for the linear profile. The kernel adds half its second moment times the
 * Laplacian, and that costs an order of h where the wall is curved (du/dn/R): for the quadratic
 * profile the tip is read from the parabola through the nearest nodes. */
typedef struct {
  _Alignas(PROBE_WIDTH * sizeof(double)) double at[PROBE_WIDTH];
  double mean[PROBE_WIDTH], slope[PROBE_WIDTH]; /* slope [1/L] */
  int first;                                    /* lowest local node */
} bw_probe__weights;

typedef struct {
  bw_probe__weights w[PROBE_PLACES][3];
} bw_probe__tip;

/* A field and its gradient at a tip. */
typedef struct {
  double value, grad[3];
} bw_probe__sample;

/* What travels to the tip's rank, and what comes back. */
typedef struct {
  double tip[3], normal[3];
} bw_probe__item;

typedef struct {
  double value, slope; /* at the tip, and its derivative along n */
} bw_probe__along;

typedef struct {
  bw_probe__along p, u[3]; /* p over rho [L^2/T^2], u [L/T] */
  double gtn[3];           /* (grad u)^T.n [1/T] */
} bw_probe__reply;

/* Tips that travel together to the ranks of their cells. */
typedef struct {
  size_t n, room;
  size_t *from;            /* (n) index of the point, rising */
  int *to;                 /* (n) rank */
  bw_probe__item *item;    /* (n) */
  bw_probe__reply *answer; /* (n) */
  uint16_t *seen;          /* (n) obstacles along the normal, look_along */
  unsigned char *read;     /* (n) 1: this is the tip that traction reads */
  size_t before;           /* n of the plan ... */
  bool changed;            /* ... and whether the ranks are no longer those of the plan */
  bw_exchange *plan;       /* NULL before the first route */

  size_t held, held_room;
  bw_probe__item *received; /* (held) */
  bw_probe__reply *reply;   /* (held) */
  uint16_t *seen_here;      /* (held) */
} bw_probe__tips;

enum {
  PROBE_LONGEST, /* the longest probe of every point that fits the box */
  PROBE_NEAR,    /* looks for obstacles where the longest does not see */
  PROBE_SHORTER, /* probes of points whose longest has an obstacle before it */
  PROBE_SETS
};

struct bw_probe {
  bw_grid *grid; /* borrowed */
  const bw_grid_view *g;
  const bw_kernel_delta *kernel;
  double h, full, rho, nu; /* full: dl of a free probe [L] */
  bw_probe_profile profile;
  bool in_the_way;          /* there are obstacles ... */
  unsigned char *obstacles; /* ... (cells with halos) 1: solid; NULL before the first */
  const double *V, *spin;   /* borrowed, NULL: at rest */

  size_t n, room;      /* points of this rank */
  double *normal;      /* (n,3) */
  double *length;      /* (n) dl; 0 when blocked */
  unsigned char *flag; /* (n) */
  bw_probe__tips tips[PROBE_SETS];
};

/* The weights of n <= PROBE_BATCH tips, which lie in cells of this rank. Pure. */
void bw_probe__weigh(const bw_probe *probe, size_t n, const bw_probe__item item[],
                     bw_probe__tip tip[]);

/* f and grad f at a tip. component 0..2: a velocity; 3: a scalar. Pure. */
bw_probe__sample bw_probe__evaluate(const bw_probe *probe, const bw_real *f, int component,
                                    const bw_probe__tip *tip);

/* Everything the surface needs from n tips. Pure. */
void bw_probe__at_tips(const bw_probe *probe, bw_real *const u[3], const bw_real *p, size_t n,
                       const bw_probe__item item[], bw_probe__reply reply[]);
