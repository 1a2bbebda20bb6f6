/* bw_kernel_delta.h -- regularised delta functions, one row of a table each.
 *
 * delta_h(x) = prod_d phi(x_d/h_d)/h_d   (POROUS 3.76-3.78, ERRATA 16; Roma et al. 1999).
 * For every shift t: sum_i phi(t-i) = 1, sum_i (t-i) phi(t-i) = 0, sum_i phi(t-i)^2 = C
 * (C = 1/2 for Roma's, 3/8 for Peskin's; not constant for the hat). */
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which kernel. */
typedef enum {
  BW_KERNEL_ROMA3,   /* support 3 cells; the default */
  BW_KERNEL_PESKIN4, /* support 4 cells */
  BW_KERNEL_HAT2,    /* support 2 cells, linear interpolation */
  BW_KERNEL_COUNT    /* how many there are */
} bw_kernel_delta_id;

/* For arrays that take the weights of any kernel. */
enum { BW_KERNEL_MAX_SUPPORT = 4 /* the largest `support` */ };

/* A kernel: a row of the table; static storage. */
typedef struct {
  const char *name;        /* "roma3": the word used in YAML */
  int support;             /* nodes per direction that can be non-zero */
  double radius;           /* phi(r) = 0 for |r| >= radius, in cells */
  double sum_of_squares;   /* C; 0 when it depends on the shift */
  double (*phi)(double r); /* r in cells [-]; even */
  /* weight[q n + i] = phi(s[i] - (first[i] + q)), q < support; see bw_kernel_delta_weights */
  void (*weigh)(size_t n, const double s[], int first[], double weight[]);
} bw_kernel_delta;

/* The row of a kernel; never NULL for a valid id. Local. */
const bw_kernel_delta *bw_kernel_delta_get(bw_kernel_delta_id id);

/* The weights of n positions along one direction each, many at once. s[n]: positions in cells
 * measured so that node i sits at i; first[n]: the lowest node of the support; node first[i] + q
 * has weight[q n + i], q = 0..support-1. Local. */
void bw_kernel_delta_weights(const bw_kernel_delta *kernel, size_t n, const double s[], int first[],
                             double weight[]);

#ifdef __cplusplus
}
#endif
