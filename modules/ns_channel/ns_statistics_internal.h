/* ns_statistics_internal.h -- shared by the sources of the statistics only. */
#pragma once
#include "bw_ns_statistics.h"

/* Arrays [moment][row], rows = n1 + 1. */
struct bw_ns_statistics {
  bw_ns_channel *ns; /* borrowed */
  const bw_grid_view *g;
  double nu;
  int rows;
  size_t size;    /* moments x rows */
  double *now;    /* plane means of the present field */
  double *batch;  /* [BW_NS_BATCHES][size]: sums over samples */
  double *work;   /* (2 size): mean moments, folded, while profiles are made */
  double *value;  /* (rows) */
  bw_real *no_w;  /* stands for w in 2D, zero */
  long per_batch; /* samples of a full batch */
  int full;       /* batches that have them */
  long in_last;   /* samples in batch `full` */
};

/* Sums over this rank's points into the rows of [moment][rows] it has. Local. */
void bw_ns__moments(const bw_grid_view *g, bw_real *const u[3], const bw_real *p, int rows,
                    double sum[]);
