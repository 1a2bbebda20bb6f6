/* ibm_mdf_internal.h -- shared by the sources of ibm_mdf only. */
#pragma once
#include "bw_exchange.h"
#include "bw_ibm_mdf.h"

enum { IBM_CENTRE, IBM_FACE, IBM_PLACES }; /* where nodes sit in one direction */
enum { IBM_WIDTH = 4 };                    /* weights per direction, padded with zeros */

/* The nodes and weights of one marker. Component c uses the face weights in direction c and the
 * centre weights in the others. In x four nodes are always read, so that a row is one vector. */
typedef struct {
  _Alignas(4 * sizeof(bw_real)) bw_real w[IBM_PLACES][3][IBM_WIDTH];
  ptrdiff_t at[3];                   /* offset of the stencil's lowest node, per component */
  unsigned char keep[IBM_PLACES][3]; /* bit q: node q is no ghost beyond a physical boundary */
  unsigned char cut;                 /* some node is */
} bw_ibm_mdf__stencil;

/* U (n,3) = interpolated u; component 2 is zero in 2D. Pure. */
typedef void (*bw_ibm_mdf__interpolate_fn)(size_t n, const bw_ibm_mdf__stencil s[],
                                           const ptrdiff_t stride[3], bw_real *const u[3],
                                           bw_real *restrict U);
/* u += sum F phi, F (n,3) already times dV/h^3; nodes beyond physical boundaries get nothing. */
typedef void (*bw_ibm_mdf__spread_fn)(size_t n, const bw_ibm_mdf__stencil s[],
                                      const ptrdiff_t stride[3], const bw_real *restrict F,
                                      bw_real *const u[3]);

bw_ibm_mdf__interpolate_fn bw_ibm_mdf__interpolator(int support, bool flat);
bw_ibm_mdf__spread_fn bw_ibm_mdf__spreader(int support, bool flat);

typedef struct {
  double x[3], v[3], volume;
} bw_ibm_mdf__item; /* what travels to the marker's rank */

struct bw_ibm_mdf {
  bw_grid *grid; /* borrowed */
  const bw_grid_view *g;
  const bw_kernel_delta *kernel;
  int n_iter;
  double cell_volume;
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
  bw_ibm_mdf__stencil *stencil;            /* (held) */
  double *V, *dV;                          /* (held,3), (held) */
  double *QdV;                             /* (held,3) since begin_step */
  double *reply;                           /* (held,3) in the order received */
  bw_real *U;                              /* (held,3) scratch: velocity, then force */

  int64_t markers, outside; /* over all ranks */
  double slip_sum;          /* sum |V-U|^2 over held markers before the last force */
};

/* Room for n handed over and held kept markers; contents are lost when it grows. Local. */
bw_status bw_ibm_mdf__reserve(bw_ibm_mdf *ib, size_t n, size_t held) BW_MUST_CHECK;

/* Sort the received markers by cell and compute stencils, V, dV. Local. */
void bw_ibm_mdf__place(bw_ibm_mdf *ib);

/* Zero the halo cells that bw_halo_reduce moves: all that an exchange reaches, so not those
 * beyond a physical boundary alone. Local. */
void bw_ibm_mdf__clear_halos(const bw_grid_view *g, bw_real *const u[3]);
