/* bw_particles_cells.h -- moving points sorted into cells, to find those that are near each other.
 *
 * Space is divided into equal boxes with edges of at least the distance that is looked for; in a
 * periodic direction a whole number of them fills the period. The cell of a point is hashed into a
 * bucket; a bucket is a linked list of its points, the last inserted first. So all points nearer
 * than the edge to a point lie in the cell of that point and the 26 around it, and memory does not
 * depend on how far points fly. Positions are (n,3) [L]; all functions are local.
 * Life     create -> { of, around, near, reading the lists }* -> destroy; made anew when points
 *          have moved.
 * Limits   n below 2^31. Cells are numbered to 10^9 either way of the first point; what is further
 *          away counts to the outermost cell. A point that has no position (a coordinate that is
 *          not a number) is in no list. */
#pragma once
#include "bw_status.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Open, so that a search can go through the lists by itself; only read it. All bytes 0: empty, to
 * be destroyed and nothing else. */
typedef struct {
  size_t n;         /* points */
  double edge[3];   /* of a cell [L] */
  double lower[3];  /* lower corner of cell (0,0,0) [L] */
  double period[3]; /* [L], 0: not periodic */
  double least;     /* the distance that create was told [L] */
  int32_t count[3]; /* cells in a periodic direction, 0: not periodic */
  size_t buckets;   /* a power of two */
  int32_t *head;    /* (buckets) last point inserted in a bucket, -1: none */
  int32_t *next;    /* (n) point inserted before it in the same bucket, -1: none */
  int32_t *cell;    /* (n,3) cell of a point */
} bw_particles_cells;

/* Sort n points into cells with edges of at least `least` [L] > 0. period[k] [L]: positions that
 * differ by it in direction k are the same place; 0: not periodic. A period shorter than `least` is
 * one cell. y (n,3) is read during the call only. *cells owns memory afterwards, also after a
 * failure: destroy it. BW_EINPUT for `least` or a period that is not finite or has the wrong sign
 * and for 2^31 points or more, BW_EMEM. */
bw_status bw_particles_cells_create(size_t n, const double y[], double least,
                                    const double period[3],
                                    bw_particles_cells *cells) BW_MUST_CHECK;

/* Release the memory of *cells and empty it. */
void bw_particles_cells_destroy(bw_particles_cells *cells);

/* The cell of any position. */
void bw_particles_cells_of(const bw_particles_cells *cells, const double y[3], int32_t cell[3]);

/* out (returned number, 3): the cell itself and those around it, every one once, axis 0 fastest. */
int bw_particles_cells_around(const bw_particles_cells *cells, const int32_t cell[3],
                              int32_t out[27][3]);

/* Points nearer than `r` to the position x, of the points y (n,3) that the cells were made of; a
 * point exactly at x is one of them. *found: how many there are; near[]: their numbers, the first
 * `room` of them, cell by cell as `around` lists these. Of a point's images only the nearest
 * counts. BW_EINPUT unless 0 < r <= least. Nothing is allocated. */
bw_status bw_particles_cells_near(const bw_particles_cells *cells, const double y[],
                                  const double x[3], double r, size_t room, int32_t near[],
                                  size_t *found) BW_MUST_CHECK;

/* The bucket of a cell. */
static inline size_t bw_particles_cells_bucket(const bw_particles_cells *cells,
                                               const int32_t cell[3])
{
  const uint64_t key = (uint64_t)(uint32_t)cell[0] * 0x9e3779b97f4a7c15u ^
                       (uint64_t)(uint32_t)cell[1] * 0xc2b2ae3d27d4eb4fu ^
                       (uint64_t)(uint32_t)cell[2] * 0x165667b19e3779f9u;
  return (size_t)(key >> 24) & (cells->buckets - 1);
}

/* Is the point q of the bucket in this cell? Several cells may share a bucket. */
static inline bool bw_particles_cells_holds(const bw_particles_cells *cells, const int32_t cell[3],
                                            int32_t q)
{
  return memcmp(cells->cell + 3 * (size_t)q, cell, 3 * sizeof *cell) == 0;
}

/* d <- l - h [L], of the images of l the nearest; period[k] = 0: not periodic. */
static inline void bw_particles_difference(const double period[3], const double h[3],
                                           const double l[3], double d[3])
{
  for (int k = 0; k < 3; k++) {
    const double p = period[k];
    d[k] = l[k] - h[k];
    if (p > 0 && d[k] > 0.5 * p) d[k] -= p * floor(d[k] / p + 0.5);
    if (p > 0 && d[k] < -0.5 * p) d[k] += p * floor(-d[k] / p + 0.5);
  }
}

#ifdef __cplusplus
}
#endif
