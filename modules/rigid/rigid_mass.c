/* Mass, centre of mass and principal axes of shapes, by Gauss' theorem over their surface. */
#include "bw_memory.h"
#include "rigid_internal.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

/* Integrals over a body: 1, x_i, x_i x_j. */
typedef struct {
  double volume, first[3], second[3][3];
} moments;

/* Of `dims` directions, about `about`, from n points with normals N and areas A. */
static moments integrate(int dims, const double about[3], int64_t n, const double X[],
                         const double N[], const double A[])
{
  moments m = {.volume = 0.0};
  for (int64_t q = 0; q < n; q++)
    for (int i = 0; i < dims; i++) {
      /* div (x_i e_i) = 1, div (x_i^2/2 e_i) = x_i, div (x_i^3/3 e_i) = x_i^2 */
      const double x = X[3 * q + i] - about[i], flux = N[3 * q + i] * A[q];
      m.volume += x * flux / dims;
      m.first[i] += x * x * flux / 2.0;
      for (int j = 0; j < dims; j++)
        m.second[i][j] +=
            i == j ? x * x * x * flux / 3.0 : x * x * (X[3 * q + j] - about[j]) * flux / 2.0;
    }
  return m;
}

/* Largest and smallest extent of the shapes [L]. */
static bw_status measure(const bw_rigid_config *c, const bw_rigid_body *ask, double extent[2])
{
  const bw_shape_lattice lattice =
      bw_shape_lattice_straight(c->spacing, (double[3]){0.0, 0.0, 0.0}, c->planar);
  int64_t lo[3], hi[3];
  BW_TRY(bw_shape_range(ask->count, ask->shape, &lattice, lo, hi));
  extent[0] = 0.0, extent[1] = HUGE_VAL;
  for (int d = 0; d < (c->planar ? 2 : 3); d++) {
    const double size = (double)(hi[d] - lo[d]) * c->spacing;
    extent[0] = fmax(extent[0], size);
    extent[1] = fmin(extent[1], size);
  }
  return BW_OK;
}

/* Volume, centre and inertia per density, of unit depth where it is planar. */
static bw_status fill(const bw_rigid_config *c, int q, const bw_rigid_body *ask, bw_rigid__body *b,
                      double inertia[3][3])
{
  enum { ALONG = 150, ACROSS = 6 }; /* points over the largest and the smallest extent */
  double extent[2], *X = NULL, *N = NULL, *A = NULL;
  int64_t n = 0;
  BW_TRY(measure(c, ask, extent));
  BW_REQUIRE(c->spacing <= extent[1] / 3.0, BW_EINPUT,
             "rigid body %d: spacing = %g of its surface points is more than a third of its least "
             "extent; take a smaller one",
             q, c->spacing);
  BW_TRY(bw_shape_points(ask->count, ask->shape, c->planar,
                         fmin(extent[0] / ALONG, extent[1] / ACROSS), &n, &X, &N, &A));
  /* About a point of the body, lest small bodies far away lose digits. */
  const int dims = c->planar ? 2 : 3;
  const moments m = integrate(dims, X, n, X, N, A);
  const double about[3] = {X[0], X[1], c->planar ? 0.0 : X[2]};
  b->area = 0.0;
  for (int64_t p = 0; p < n; p++)
    b->area += A[p];
  bw_release(&X);
  bw_release(&N);
  bw_release(&A);
  BW_REQUIRE(m.volume > 0.0, BW_EINPUT, "rigid body %d: its shapes enclose the volume %g", q,
             m.volume);
  b->volume = m.volume;
  /* Steiner: to the centre; from second moments to inertia. */
  double S[3][3] = {{0.0}}, trace = 0.0;
  for (int i = 0; i < 3; i++) {
    b->start[i] = about[i] + m.first[i] / m.volume;
    for (int j = 0; j < 3; j++)
      S[i][j] = 0.5 * (m.second[i][j] + m.second[j][i]) - m.first[i] * m.first[j] / m.volume;
    trace += S[i][i];
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      inertia[i][j] = (i == j ? trace : 0.0) - S[i][j];
  return BW_OK;
}

/* Principal moments and axes, right-handed. */
static bw_status principal(double inertia[3][3], bw_rigid__body *b)
{
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
  gsl_vector_view value = gsl_vector_view_array(b->inertia, 3);
  gsl_matrix_view axes = gsl_matrix_view_array(b->axes[0], 3, 3);
  gsl_matrix_view from = gsl_matrix_view_array(inertia[0], 3, 3);
  if (work == NULL) return BW_FAIL(BW_EMEM, "rigid: no memory for the principal axes");
  gsl_eigen_symmv(&from.matrix, &value.vector, &axes.matrix, work);
  gsl_eigen_symmv_free(work);
  /* Columns are the axes; the third one follows from the other two. */
  double c[3][3];
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++)
      c[a][d] = b->axes[d][a];
  rigid_cross(c[0], c[1], c[2]);
  for (int d = 0; d < 3; d++)
    b->axes[d][2] = c[2][d];
  return BW_OK;
}

bw_status bw_rigid__mass(const bw_rigid_config *config, int q, const bw_rigid_body *ask,
                         bw_rigid__body *b)
{
  double inertia[3][3];
  BW_TRY(fill(config, q, ask, b, inertia));
  const double depth = config->planar ? config->depth : 1.0;
  b->volume *= depth;
  b->area *= depth;
  b->mass = ask->density > 0.0 ? ask->density * b->volume : ask->mass;
  for (int i = 0; i < 3; i++) {
    if (ask->density <= 0.0) b->start[i] = ask->centre[i];
    for (int j = 0; j < 3; j++)
      inertia[i][j] =
          ask->density > 0.0 ? inertia[i][j] * ask->density * depth : ask->inertia[i][j];
  }
  /* A planar body turns about z alone. */
  for (int i = 0; i < 3 && config->planar; i++)
    for (int j = 0; j < 3; j++)
      inertia[i][j] = i == j ? inertia[2][2] : 0.0;
  BW_REQUIRE(b->mass > 0.0 && isfinite(b->mass), BW_EINPUT,
             "rigid body %d: mass = %g: give a density or a mass > 0", q, b->mass);
  BW_TRY(principal(inertia, b));
  for (int i = 0; i < 3; i++)
    BW_REQUIRE(b->inertia[i] > 0.0 && isfinite(b->inertia[i]), BW_EINPUT,
               "rigid body %d: a principal moment of inertia is %g: they must be > 0", q,
               b->inertia[i]);
  return BW_OK;
}
