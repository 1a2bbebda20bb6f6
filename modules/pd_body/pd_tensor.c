/* What is made of tensors at particles: strain, principal values, von Mises. */
#include "bw_pd_tensor.h"

#include <gsl/gsl_eigen.h>
#include <math.h>

/* Rows of six as 3 x 3. */
static const int PLACE[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

void bw_pd_tensor_strain(size_t n, const double F[], double strain[])
{
  for (size_t i = 0; i < n; i++)
    for (int a = 0; a < 3; a++)
      /* C = F^T F is symmetric: six numbers are all there is of it. */
      for (int b = a; b < 3; b++) {
        double c = 0;
        for (int k = 0; k < 3; k++)
          c += F[9 * i + (size_t)(3 * k + a)] * F[9 * i + (size_t)(3 * k + b)];
        strain[6 * i + (size_t)PLACE[a][b]] = 0.5 * (c - (a == b));
      }
}

bw_status bw_pd_tensor_principal(size_t n, const double tensor[], double value[],
                                 double direction[])
{
  double m[9], v[3], axes[9];
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
  BW_REQUIRE(work != NULL, BW_EMEM, "solid: no memory for a 3 x 3 eigenvalue problem");
  for (size_t i = 0; i < n; i++) {
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        m[3 * a + b] = tensor[6 * i + (size_t)PLACE[a][b]];
    /* GSL overwrites the matrix, which is why it is copied. */
    gsl_matrix_view matrix = gsl_matrix_view_array(m, 3, 3);
    gsl_matrix_view vectors = gsl_matrix_view_array(axes, 3, 3);
    gsl_vector_view values = gsl_vector_view_array(v, 3);
    gsl_eigen_symmv(&matrix.matrix, &values.vector, &vectors.matrix, work);
    gsl_eigen_symmv_sort(&values.vector, &vectors.matrix, GSL_EIGEN_SORT_VAL_DESC);
    for (size_t a = 0; a < 3; a++) {
      value[3 * i + a] = v[a];
      for (size_t k = 0; direction != NULL && k < 3; k++)
        direction[9 * i + 3 * a + k] = axes[3 * k + a]; /* GSL: in columns */
    }
  }
  gsl_eigen_symmv_free(work);
  return BW_OK;
}

void bw_pd_tensor_von_mises(size_t n, const double stress[], double von_mises[])
{
  for (size_t i = 0; i < n; i++) {
    const double *s = stress + 6 * i;
    /* Differences of the diagonal: the mean pressure drops out. */
    const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    von_mises[i] =
        sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
  }
}

void bw_pd_tensor_add_dyad(double factor, const double xi[3], double r0, double t[BW_PD_SYMMETRIC])
{
  static const int a[] = {0, 1, 2, 1, 0, 0}, b[] = {0, 1, 2, 2, 2, 1};
  for (int q = 0; q < BW_PD_SYMMETRIC; q++)
    t[q] += factor * xi[a[q]] * xi[b[q]] / (r0 * r0);
}
