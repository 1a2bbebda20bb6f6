/* A film: its configuration, what it resists and what drives it. */
#include "bw_film.h"
#include "bw_memory.h"
#include "film_internal.h"

#include <math.h>
#include <string.h>

bw_film_config bw_film_config_default(void)
{
  return (bw_film_config){
      .mu = (double)NAN, .limit = (double)NAN, .roughness = (double)NAN, .depth = 1.0, .cells = 32};
}

static bw_status check(const bw_film_config *c)
{
  BW_REQUIRE(c->mu > 0.0, BW_EINPUT,
             "film: mu is %g; a film needs a viscosity above 0: without one leave films out",
             c->mu);
  BW_REQUIRE(c->limit > 0.0, BW_EINPUT, "film: limit is %g; give a gap above 0", c->limit);
  BW_REQUIRE(c->roughness > 0.0 && c->roughness <= c->limit, BW_EINPUT,
             "film: roughness is %g; give one above 0 and at most the limit %g: rougher faces have "
             "no film that the grid does not see",
             c->roughness, c->limit);
  BW_REQUIRE(c->depth > 0.0, BW_EINPUT, "film: depth is %g; give one above 0", c->depth);
  BW_REQUIRE(c->cells >= 8 && c->cells <= 512, BW_EINPUT, "film: cells is %d; give 8 to 512",
             c->cells);
  return BW_OK;
}

/* All arrays of doubles. */
#define ARRAYS(f)                                                                                  \
  {                                                                                                \
    &(f)->z[0], &(f)->z[1], &(f)->h, &(f)->wide, &(f)->g[0], &(f)->g[1], &(f)->k[0], &(f)->k[1],   \
        &(f)->edge[0][0], &(f)->edge[0][1], &(f)->edge[1][0], &(f)->edge[1][1], &(f)->p,           \
        &(f)->rhs, &(f)->r, &(f)->q, &(f)->d, &(f)->diagonal                                       \
  }

bw_status bw_film_create(const bw_film_config *config, bw_film **out)
{
  bw_film *f = NULL;
  *out = NULL;
  BW_TRY(check(config));
  BW_TRY(BW_ALLOCATE(&f, 1));
  f->config = *config;
  f->n[0] = config->cells, f->n[1] = config->planar ? 1 : config->cells;
  double **const array[] = ARRAYS(f);
  bw_status st = BW_ALLOCATE(&f->film, film_cells(f));
  for (int d = 0; d < 2; d++) {
    BW_THEN(st, BW_ALLOCATE(&f->at[d], (size_t)f->n[d]));
    BW_THEN(st, BW_ALLOCATE(&f->width[d], (size_t)f->n[d]));
  }
  for (size_t q = 0; q < sizeof array / sizeof *array; q++)
    BW_THEN(st, BW_ALLOCATE(array[q], film_cells(f)));
  if (st != BW_OK)
    bw_film_destroy(&f);
  else
    *out = f;
  return st;
}

void bw_film_destroy(bw_film **film)
{
  bw_film *f = *film;
  if (f == NULL) return;
  double **const array[] = ARRAYS(f);
  for (size_t q = 0; q < sizeof array / sizeof *array; q++)
    bw_release(array[q]);
  for (int d = 0; d < 2; d++) {
    bw_release(&f->at[d]);
    bw_release(&f->width[d]);
  }
  bw_release(&f->film);
  bw_release(film);
}

/* Of a cell: from the origin to the middle of its gap, and its area times g, in space. */
typedef struct {
  double r[3], g[3], area;
} spot;

static spot spot_of(const bw_film *f, int i, int j)
{
  const size_t at = (size_t)i + (size_t)f->n[0] * (size_t)j;
  const double middle = 0.5 * (f->z[0][at] + f->z[1][at]), s = f->at[0][i], t = f->at[1][j];
  spot c = {.area = film_area(f, i, j)};
  for (int d = 0; d < 3; d++) {
    c.r[d] = s * f->axes[0][d] + t * f->axes[1][d] + middle * f->axes[2][d];
    c.g[d] = c.area * (f->axes[2][d] + f->g[0][at] * f->axes[0][d] + f->g[1][at] * f->axes[1][d]);
  }
  return c;
}

/* U at a spot of the unit twist e: a velocity along e, or a spin about e - 3. */
static void motion(const spot *c, int e, double U[3])
{
  U[0] = U[1] = U[2] = 0.0;
  if (e < 3) {
    U[e] = 1.0;
    return;
  }
  const int a = (e - 3 + 1) % 3, b = (e - 3 + 2) % 3;
  U[b] = c->r[a], U[a] = -c->r[b];
}

/* wrench (6) += sign times that of the force F at a spot. */
static void add_wrench(const spot *c, const double F[3], double sign, double wrench[6])
{
  for (int d = 0; d < 3; d++) {
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    wrench[d] += sign * F[d];
    wrench[3 + d] += sign * (c->r[a] * F[b] - c->r[b] * F[a]);
  }
}

/* rhs: what the unit twist e squeezes out of every cell. */
static void set_source(bw_film *f, int e)
{
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++) {
      const size_t at = (size_t)i + (size_t)f->n[0] * (size_t)j;
      const spot c = spot_of(f, i, j);
      double U[3];
      motion(&c, e, U);
      f->rhs[at] = f->film[at] ? -(U[0] * c.g[0] + U[1] * c.g[1] + U[2] * c.g[2]) : 0.0;
    }
}

/* wrench (6) += sign times that of the pressure. */
static void add_pressure(const bw_film *f, double sign, double wrench[6])
{
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++) {
      const size_t at = (size_t)i + (size_t)f->n[0] * (size_t)j;
      const spot c = spot_of(f, i, j);
      const double F[3] = {f->p[at] * c.g[0], f->p[at] * c.g[1], f->p[at] * c.g[2]};
      if (f->film[at]) add_wrench(&c, F, sign, wrench);
    }
}

/* wrench (6) += sign times that of the shear, -mu U_t/h, of the unit twist e. */
static void add_shear(const bw_film *f, int e, const double h[], double sign, double wrench[6])
{
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++) {
      const size_t at = (size_t)i + (size_t)f->n[0] * (size_t)j;
      const spot c = spot_of(f, i, j);
      double U[3], F[3];
      if (!f->film[at]) continue;
      motion(&c, e, U);
      const double *n = f->axes[2], along = U[0] * n[0] + U[1] * n[1] + U[2] * n[2];
      for (int d = 0; d < 3; d++)
        F[d] = -f->config.mu * c.area / h[at] * (U[d] - along * n[d]);
      add_wrench(&c, F, sign, wrench);
    }
}

/* Is the unit twist one of the plane's? */
static bool lives(const bw_film *f, int e)
{
  return !f->config.planar || e < 2 || e == 5;
}

/* D += sign times the resistance of the film of gaps h. */
static bw_status add_resistance(bw_film *f, const double h[], double sign, double D[6][6])
{
  bw_film__conduct(f, h);
  for (int e = 0; e < 6; e++) {
    if (!lives(f, e)) continue;
    double wrench[6] = {0.0};
    set_source(f, e);
    memset(f->p, 0, film_cells(f) * sizeof *f->p);
    BW_TRY(bw_film__solve(f));
    add_pressure(f, 1.0, wrench);
    add_shear(f, e, h, 1.0, wrench);
    for (int d = 0; d < 6; d++)
      if (lives(f, d)) D[d][e] -= sign * wrench[d];
  }
  return BW_OK;
}

bw_status bw_film_resistance(bw_film *f, bool lacking, double D[6][6])
{
  memset(D, 0, 36 * sizeof D[0][0]);
  BW_TRY(add_resistance(f, f->h, 1.0, D));
  return lacking ? add_resistance(f, f->wide, -1.0, D) : BW_OK;
}

/* ---- driven by the pressure around it ---- */

/* The pressure at the edges of the film, as a source, and where the solve starts from. */
static void set_edges(bw_film *f, double (*pressure)(const void *, const double[3]),
                      const void *context)
{
  memset(f->p, 0, film_cells(f) * sizeof *f->p);
  memset(f->rhs, 0, film_cells(f) * sizeof *f->rhs);
  for (int j = 0; j < f->n[1]; j++)
    for (int i = 0; i < f->n[0]; i++)
      for (int d = 0; d < 2; d++)
        for (int end = 0; end < 2; end++) {
          const size_t at = (size_t)i + (size_t)f->n[0] * (size_t)j;
          double place[2] = {f->at[0][i], f->at[1][j]}, x[3];
          if (f->edge[d][end][at] == 0.0) continue;
          place[d] += (end - 0.5) * f->width[d][d == 0 ? i : j];
          film_point(f, place[0], place[1], 0.5 * (f->z[0][at] + f->z[1][at]), x);
          f->rhs[at] += f->edge[d][end][at] * pressure(context, x);
        }
}

/* flux[d] += sign times what flows along d through the middle of the patch. */
static void add_flux(const bw_film *f, double sign, double flux[2])
{
  for (int d = 0; d < (f->config.planar ? 1 : 2); d++) {
    const int middle = f->n[d] / 2 - 1;
    const size_t stride = d == 0 ? 1 : (size_t)f->n[0];
    for (int q = 0; q < f->n[1 - d]; q++) {
      const size_t at = d == 0 ? (size_t)middle + (size_t)f->n[0] * (size_t)q
                               : (size_t)q + (size_t)f->n[0] * (size_t)middle;
      flux[d] += sign * f->k[d][at] * (f->p[at] - f->p[at + stride]);
    }
  }
}

bw_status bw_film_pressure(bw_film *f, bool lacking,
                           double (*pressure)(const void *context, const double x[3]),
                           const void *context, double wrench[6], double flux[2])
{
  memset(wrench, 0, 6 * sizeof *wrench);
  flux[0] = flux[1] = 0.0;
  for (int q = 0; q < (lacking ? 2 : 1); q++) {
    bw_film__conduct(f, q == 0 ? f->h : f->wide);
    set_edges(f, pressure, context);
    BW_TRY(bw_film__solve(f));
    add_pressure(f, q == 0 ? 1.0 : -1.0, wrench);
    add_flux(f, q == 0 ? 1.0 : -1.0, flux);
  }
  return BW_OK;
}
