/* ibm_mdf_internal.h -- shared by the sources of ibm_mdf only. */
#pragma once
#include "bw_exchange.h"
#include "bw_ibm_mdf.h"

#include <math.h>

enum { IBM_CENTRE, IBM_FACE, IBM_PLACES }; /* where nodes sit in one direction */
enum { IBM_WIDTH = 4 };                    /* weights per direction, padded with zeros */
enum { IBM_BLOCKS = 5 };                   /* blocks of a line whose halos a support can meet */
enum { IBM_AHEAD = 12 };                   /* markers whose nodes are fetched early */

/* Weights of one marker, per place and direction. Component c uses the face weights in direction c
 * and the centre weights in the others. In x four nodes are always read: a row is one vector. */
typedef struct {
  _Alignas(4 * sizeof(bw_real)) bw_real w[IBM_PLACES][3][IBM_WIDTH];
} bw_ibm_mdf__weights;

/* Offset of the lowest node of each component; bit IBM_WIDTH (3 place + d) + q of keep: node q is
 * no ghost beyond a physical boundary (such nodes are read but never written). */
typedef struct {
  int32_t at[3];
  uint32_t keep;
} bw_ibm_mdf__nodes;
#define IBM_KEEP_ALL 0xFFFFFFu

/* What a kernel works on: markers in a field. There are IBM_AHEAD nodes more than markers. */
typedef struct {
  size_t begin, end;
  const bw_ibm_mdf__weights *weights;
  const bw_ibm_mdf__nodes *nodes;
  ptrdiff_t row, plane; /* strides of the field */
} bw_ibm_mdf__stencils;

/* U (m,3) = interpolated u, begin <= m < end; component 2 is zero in 2D. Pure. */
typedef void (*bw_ibm_mdf__interpolate_fn)(const bw_ibm_mdf__stencils *s, bw_real *const u[3],
                                           bw_real *restrict U);
/* u += sum F phi, F (m,3) already times dV/h^3; nodes beyond physical boundaries get nothing. */
typedef void (*bw_ibm_mdf__spread_fn)(const bw_ibm_mdf__stencils *s, const bw_real *restrict F,
                                      bw_real *const u[3]);

bw_ibm_mdf__interpolate_fn bw_ibm_mdf__interpolator(int support, bool flat);
bw_ibm_mdf__spread_fn bw_ibm_mdf__spreader(int support, bool flat);

/* What travels to the marker's rank: place in cells from the lower corner of the box, periodic
 * directions wrapped. */
typedef struct {
  double s[3], v[3], m[3], volume;
} bw_ibm_mdf__item;

/* The same place, in cells from the lower corner of the block that it is for. */
typedef struct {
  double s[3];
} bw_ibm_mdf__place;

/* Blocks of one direction whose cells or halos a marker of this block may reach, this block first:
 * seen from this one they begin at start[] cells and have size[]. Between low and high a marker
 * reaches no other. */
typedef struct {
  int n, coord[IBM_BLOCKS];
  double start[IBM_BLOCKS], size[IBM_BLOCKS], low, high;
} bw_ibm_mdf__blocks;

/* Which closed surface a marker lies on (-1: none), and its normal. */
typedef struct {
  double N[3];
  int64_t surface;
} bw_ibm_mdf__wet;

struct bw_ibm_mdf {
  bw_grid *grid; /* borrowed */
  const bw_grid_view *g;
  const bw_kernel_delta *kernel;
  bw_kernel_delta_id kernel_id;
  int n_iter, call;   /* iterations; calls of force since begin_step */
  double beta, share; /* of memory; of what is missing, that an iteration gives */
  bw_ibm_mdf_ghosts_fn ghosts;
  void *ghosts_of;
  double cell_volume;
  bw_ibm_mdf__blocks blocks[3];
  bw_ibm_mdf__interpolate_fn interpolate;
  bw_ibm_mdf__spread_fn spread;

  /* as handed over by the caller: n markers, of which n_sent lie in the box */
  size_t n, n_sent, room;
  size_t *sent_from;      /* (n_sent) index in the caller's arrays */
  int *destination;       /* (n_sent) rank */
  bw_ibm_mdf__item *item; /* (n_sent) */
  double *answer;         /* (n_sent,3) */
  bw_exchange *plan;      /* NULL before the first set */

  /* as held here: sorted by cell; order[m] is the place of marker m among the received */
  size_t held, held_room;
  bw_ibm_mdf__item *received;              /* (held) */
  unsigned *order, *swap, *key, *key_swap; /* (held) */
  bw_ibm_mdf__place *place;                /* (held) */
  size_t *layer;  /* (m[2] + 1) first marker of each layer of cells in z, and the end */
  double *V, *dV; /* (held,3), (held) */
  double *QdV;    /* (held,3) since begin_step */
  double *M;      /* (held,3) memory; the first of three NaN: none */
  double *N;      /* (held,3) normals, zero where there is none */
  double *along;  /* (held) displacement h^2/nu [T]: slip per force in the surface */
  bool sided;     /* are there normals? */
  bw_ibm_mdf__wet *wet, *wet_sent; /* (held), (n_sent): where closed surfaces are told */
  double *enclosed;                /* (surfaces,2) scratch */
  int surfaces, surfaces_room;     /* closed ones; 0: nobody told */
  double *reply;                   /* (held,3) in the order received */

  /* images: of markers held here for other blocks (or this one, over a periodic side) ... */
  size_t cast, cast_room;
  unsigned *cast_from;          /* (cast) marker */
  int *cast_to;                 /* (cast) rank */
  bw_ibm_mdf__place *cast_item; /* (cast) */
  bw_real *cast_F;              /* (cast,3) */
  bw_exchange *image_plan;      /* NULL before the first set */
  /* ... and those of others in this block, whose stencils follow those of the held markers */
  size_t images, stencil_room;
  bw_ibm_mdf__place *image;     /* (images) */
  bw_ibm_mdf__weights *weights; /* (held + images) */
  bw_ibm_mdf__nodes *nodes;     /* (held + images) */
  bw_real *U;                   /* (held + images,3) scratch: velocity, then force */

  int64_t markers, outside; /* over all ranks */
  double slip_sum;          /* sum |V-U|^2 over held markers before the last force */
  bool measured;            /* has the growth of the first set been? */
  bw_ibm_mdf_cost cost;
};

/* Grow-only array of `count` items; contents are lost. */
#define IBM_RENEW(pointer, count)                                                                  \
  do {                                                                                             \
    bw_release(pointer);                                                                           \
    BW_TRY(BW_ALLOCATE(pointer, count));                                                           \
  } while (0)

/* Place in cells from the block's lower edge, kept inside the block against rounding. */
static inline double bw_ibm_mdf__local(const bw_grid_view *g, const double s[3], int d)
{
  const double local = s[d] - g->lo[d], m = g->m[d];
  return local < 0.0 ? 0.0 : local > m ? m : local;
}

/* lack (3): what U of held marker m lacks of the velocity that it should read: V, and where it
 * knows its side, V - along F_t/dV. F_t is the part in the surface of F, the force of this step if
 * its sub-steps to come bring what memory says. Returns lack's component along the normal.
 * Local. */
static inline double bw_ibm_mdf__lack(const bw_ibm_mdf *ib, size_t m, double lack[3])
{
  /* 1 less the sum of gamma up to the present sub-step, which is in QdV. */
  static const double rest[4] = {7.0 / 15, 1.0 / 3, 0.0, 0.0};
  const double *V = ib->V + 3 * m, *Q = ib->QdV + 3 * m, *M = ib->M + 3 * m, *N = ib->N + 3 * m;
  double F[3], F_n = 0.0, lack_n = 0.0;
  for (size_t c = 0; c < 3; c++)
    lack[c] = V[c] - (double)ib->U[3 * m + c];
  if (!ib->sided || ib->along[m] == 0.0) return 0.0;
  for (size_t c = 0; c < 3; c++) {
    F[c] = (Q[c] + rest[ib->call < 3 ? ib->call : 3] * M[c]) / ib->dV[m];
    F_n += N[c] * F[c];
  }
  for (size_t c = 0; c < 3; c++) {
    lack[c] -= ib->along[m] * (F[c] - F_n * N[c]);
    lack_n += N[c] * lack[c];
  }
  return lack_n;
}

/* Takes the pressure inside closed surfaces out of M (bw_ibm_mdf_close). Collective. */
void bw_ibm_mdf__drain(bw_ibm_mdf *ib);

/* Which blocks a marker's support can reach, for every place in this one. Local. */
void bw_ibm_mdf__find_blocks(bw_ibm_mdf *ib);

/* List the images of the held markers and send their places; room for the stencils of all.
 * Collective. */
bw_status bw_ibm_mdf__cast_images(bw_ibm_mdf *ib) BW_MUST_CHECK;

/* Does the forcing iteration of these markers converge? BW_EINPUT when it grows. Collective. */
bw_status bw_ibm_mdf__check_growth(bw_ibm_mdf *ib) BW_MUST_CHECK;

/* U of the images from U of their markers. Collective. */
void bw_ibm_mdf__give_images(bw_ibm_mdf *ib);

/* Weights and nodes of held markers and images. Local. */
void bw_ibm_mdf__weigh(bw_ibm_mdf *ib);
