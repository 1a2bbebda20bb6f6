/* The largest frequency of a body, by Lanczos' method on its tangent stiffness.
 *
 * With A = (rho V)^(-1/2) V K (rho V)^(-1/2), V volumes, and a start q_1,
 *   beta_(j+1) q_(j+1) = A q_j - alpha_j q_j - beta_j q_(j-1),  alpha_j = q_j.A q_j
 * makes a tridiagonal matrix whose largest eigenvalue rises to that of A from below (C. Lanczos,
 * J. Res. Natl. Bur. Stand. 45 (1950) 255). Without orthogonalising anew the largest one is found
 * all the same. The start is drawn from the places, so that it is the same on any number of ranks;
 * the result is rounded up to six digits so that the order of its sums does not show. */
#include "bw_memory.h"
#include "pd_state.h"

#include <gsl/gsl_eigen.h>
#include <string.h>

enum { PRODUCTS = 40 };
static const double MARGIN = 0.95; /* of the step: what 40 products leave, and strains to come */

typedef struct {
  double *q, *before, *next; /* (n,3) */
  bw_real *copy[3];          /* storage */
  double alpha[PRODUCTS], beta[PRODUCTS];
} lanczos;

/* Volume over that of level 0. Between particles of different volumes K is symmetric as a force,
 * not as its density. */
static double volume(const bw_pd_body *pd, size_t i)
{
  return bw_pd_body_level(pd, i)->dv / pd->level->dv;
}

static double density(const bw_pd_body *pd, size_t i)
{
  return bw_pd_body_material(pd, i)->rho;
}

static double dot(const bw_pd_body *pd, const double a[], const double b[])
{
  double sum = 0;
  for (size_t k = 0; k < 3 * pd->n; k++)
    sum += a[k] * b[k];
  bw_comm_sum(pd->comm, 1, &sum);
  return sum;
}

/* next = A q. Collective. */
static void product(const bw_pd_body *pd, lanczos *z)
{
  for (int k = 0; k < 3; k++) {
    for (size_t i = 0; i < pd->n; i++)
      z->copy[k][pd->points.place[i]] =
          (bw_real)(z->q[3 * i + (size_t)k] / sqrt(density(pd, i) * volume(pd, i)));
    bw_pd_body_fill_places(pd, z->copy[k]);
  }
  pd->law->tangent(pd, z->copy, z->next);
  for (size_t i = 0; i < pd->n; i++)
    for (size_t k = 0; k < 3; k++)
      z->next[3 * i + k] *= volume(pd, i) / sqrt(density(pd, i) * volume(pd, i));
}

/* A number from -1 to 1 that depends on a particle's id alone. */
static double drawn(int64_t id, int k)
{
  uint64_t x = ((uint64_t)id * 3 + (uint64_t)k + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return (double)(int64_t)(x ^ (x >> 31)) / 9.3e18;
}

static void start(const bw_pd_body *pd, lanczos *z)
{
  for (size_t i = 0; i < pd->n; i++)
    for (int k = 0; k < pd->dimension; k++)
      z->q[3 * i + (size_t)k] = drawn(pd->points.id[i], k);
  const double norm = sqrt(dot(pd, z->q, z->q));
  for (size_t k = 0; k < 3 * pd->n; k++)
    z->q[k] /= norm;
}

/* Fills alpha and beta; returns how many. Collective. */
static int recur(const bw_pd_body *pd, lanczos *z)
{
  double beta = 0, first = 0;
  start(pd, z);
  for (int j = 0; j < PRODUCTS; j++) {
    product(pd, z);
    z->alpha[j] = dot(pd, z->q, z->next);
    for (size_t k = 0; k < 3 * pd->n; k++)
      z->next[k] -= z->alpha[j] * z->q[k] + beta * z->before[k];
    beta = sqrt(dot(pd, z->next, z->next));
    z->beta[j] = beta;
    if (j == 0) first = fmax(fabs(z->alpha[0]), beta);
    /* A small body is exhausted: what is left is rounding. */
    if (!(beta > 1e3 * BW_REAL_EPSILON * first)) return j + 1;
    memcpy(z->before, z->q, 3 * pd->n * sizeof *z->q);
    for (size_t k = 0; k < 3 * pd->n; k++)
      z->q[k] = z->next[k] / beta;
  }
  return PRODUCTS;
}

/* The largest eigenvalue of the tridiagonal matrix. */
static bw_status largest(const lanczos *z, int n, double *most)
{
  gsl_matrix *T = gsl_matrix_calloc((size_t)n, (size_t)n);
  gsl_vector *value = gsl_vector_alloc((size_t)n);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc((size_t)n);
  const bool room = T != NULL && value != NULL && work != NULL;
  for (size_t j = 0; room && j < (size_t)n; j++) {
    gsl_matrix_set(T, j, j, z->alpha[j]);
    if (j + 1 == (size_t)n) continue;
    gsl_matrix_set(T, j + 1, j, z->beta[j]);
    gsl_matrix_set(T, j, j + 1, z->beta[j]);
  }
  const bool done = room && gsl_eigen_symm(T, value, work) == 0;
  *most = done ? gsl_vector_max(value) : 0;
  if (work != NULL) gsl_eigen_symm_free(work);
  if (value != NULL) gsl_vector_free(value);
  if (T != NULL) gsl_matrix_free(T);
  BW_REQUIRE(done, BW_EMEM, "solid: no memory for the largest frequency");
  return BW_OK;
}

/* A little more, to six digits. */
static double rounded_up(double x)
{
  if (!(x > 0)) return 0;
  const double unit = pow(10, floor(log10(x)) - 5);
  return ceil(x / unit * (1 + 1e-9)) * unit;
}

/* The largest eigenvalue of A [1/T^2]. BW_EMEM. Collective. */
static bw_status eigenvalue(const bw_pd_body *pd, double *most)
{
  lanczos z = {0};
  bw_status st = BW_ALLOCATE(&z.q, 3 * pd->n);
  BW_THEN(st, BW_ALLOCATE(&z.before, 3 * pd->n));
  BW_THEN(st, BW_ALLOCATE(&z.next, 3 * pd->n));
  for (int k = 0; k < 3; k++)
    BW_THEN(st, bw_pd_body_storage_array(pd->points.n_storage, &z.copy[k]));
  st = bw_comm_agree(pd->comm, st);
  if (st == BW_OK) st = bw_comm_agree(pd->comm, largest(&z, recur(pd, &z), most));
  bw_release(&z.q);
  bw_release(&z.before);
  bw_release(&z.next);
  for (int k = 0; k < 3; k++)
    bw_pd_body_release_storage_array(&z.copy[k]);
  return st;
}

bw_status bw_pd_state__bound(bw_pd_body *pd)
{
  double most = 0;
  BW_TRY(eigenvalue(pd, &most));
  pd->frequency2 = rounded_up(most / (MARGIN * MARGIN));
  return BW_OK;
}

void bw_pd_state__rows(const bw_pd_body *pd, double row[])
{
  double most = pd->frequency2;
  /* Families that have lost bonds may be stiffer than they were: looked at again where some have,
   * on any rank. Without memory the old bound has to do. */
  int64_t events = pd->bonds.events;
  bw_comm_max_int(pd->comm, 1, &events);
  double now = 0;
  if (events > 0 && eigenvalue(pd, &now) == BW_OK) most = fmax(most, now / (MARGIN * MARGIN));
  for (size_t i = 0; i < pd->n; i++)
    row[i] = 0.25 * most * density(pd, i) + 1e-300;
}
