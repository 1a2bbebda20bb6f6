/* film_internal.h -- shared by the sources of film only. */
#pragma once
#include "bw_film.h"
#include <stddef.h>

struct bw_film {
  bw_film_config config;
  int n[2];                     /* cells each way; the second is 1 of a line */
  double origin[3], axes[3][3]; /* rows: along the patch, along it, normal */
  double *at[2], *width[2];     /* (n) of each way: middles from the origin, widths of cells [L] */
  double gap;
  bool *film;         /* (n0 n1) does this cell have both faces? */
  double *z[2];       /* heights of a, b */
  double *h, *wide;   /* gap; gap as the grid feels it */
  double *g[2];       /* -d(z_a + z_b)/2 along the two directions */
  double *k[2];       /* conductance of the edge above a cell, along each direction */
  double *edge[2][2]; /* of its edge to what is no film, [direction][lower, upper]; 0: none */
  double *p, *rhs, *r, *q, *d; /* solve: pressure, source, residual, product, direction */
  double *diagonal;
};

static inline size_t film_cells(const bw_film *f)
{
  return (size_t)f->n[0] * (size_t)f->n[1];
}

/* Point of space at (s, t) along the patch and z above it. */
static inline void film_point(const bw_film *f, double s, double t, double z, double x[3])
{
  for (int d = 0; d < 3; d++)
    x[d] = f->origin[d] + s * f->axes[0][d] + t * f->axes[1][d] + z * f->axes[2][d];
}

/* Area of cell (i, j). */
static inline double film_area(const bw_film *f, int i, int j)
{
  return f->width[0][i] * (f->config.planar ? f->config.depth : f->width[1][j]);
}

/* Conductances of all edges for gaps h (cells). */
void bw_film__conduct(bw_film *f, const double h[]);
/* p of all cells from rhs, for the conductances there are; p is where it starts from. */
bw_status bw_film__solve(bw_film *f) BW_MUST_CHECK;
