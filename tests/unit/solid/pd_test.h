/* pd_test.h -- lattices, and states gathered by global id, for the tests of the solid. */
#pragma once
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_solid.h"
#include "ledger.h"

typedef struct {
  int64_t n;
  int32_t *site; /* (n,3) */
  uint8_t *kind; /* (n) */
} pd_body;

static inline pd_body pd_box(int nx, int ny, int nz)
{
  pd_body b = {.n = (int64_t)nx * ny * nz};
  bw_check_ok(BW_ALLOCATE(&b.site, 3 * (size_t)b.n));
  bw_check_ok(BW_ALLOCATE(&b.kind, (size_t)b.n));
  int32_t *s = b.site;
  for (int z = 0; z < nz; z++)
    for (int y = 0; y < ny; y++)
      for (int x = 0; x < nx; x++, s += 3)
        s[0] = x, s[1] = y, s[2] = z;
  return b;
}

static inline void pd_body_release(pd_body *b)
{
  bw_release(&b->site);
  bw_release(&b->kind);
}

/* A soft material in units near 1: rounding shows at the size of BW_REAL_EPSILON. */
static inline bw_solid_config pd_soft(bw_pd_geometry geometry)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = geometry;
  c.ds = 0.5;
  c.rho = 2;
  c.E = 3;
  return c;
}

static inline bw_solid *pd_make(const bw_comm *comm, const bw_solid_config *c, const pd_body *body)
{
  bw_solid *pd = NULL;
  bw_check_ok(bw_solid_create_same(comm, c, body->n, body->site, body->kind, &pd));
  return pd;
}

typedef void (*pd_getter)(const bw_solid *, double[]);

/* all (total,3) on every rank: the getter's rows by global id. */
static inline void pd_gather(const bw_solid *pd, pd_getter get, double all[])
{
  const size_t n = bw_solid_count(pd), total = (size_t)bw_solid_total(pd);
  double *mine = NULL;
  bw_check_ok(BW_ALLOCATE(&mine, 3 * n));
  get(pd, mine);
  for (size_t q = 0; q < 3 * total; q++)
    all[q] = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++)
      all[3 * (size_t)bw_solid_id(pd)[i] + k] = mine[3 * i + k];
  bw_comm_sum(bw_solid_comm(pd), (int)(3 * total), all);
  bw_release(&mine);
}

/* A field of space: what it writes from the reference position X0 of a particle. */
typedef void (*pd_field)(const double X0[3], double out[3]);

/* State from fields of the displacement and the velocity (NULL: zero). */
static inline void pd_set(bw_solid *pd, pd_field displacement, pd_field velocity)
{
  const size_t n = bw_solid_count(pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_reference(pd, X);
  for (size_t i = 0; i < n; i++) {
    double u[3] = {0};
    if (velocity != NULL) velocity(X + 3 * i, V + 3 * i);
    if (displacement != NULL) displacement(X + 3 * i, u);
    for (size_t k = 0; k < 3; k++)
      X[3 * i + k] += u[k];
  }
  bw_solid_set_state(pd, X, V);
  bw_release(&X);
  bw_release(&V);
}

static inline void pd_steps(bw_solid *pd, int n, double dt)
{
  for (int q = 0; q < n; q++)
    bw_check_ok(bw_solid_step(pd, dt));
}

/* Kinetic, elastic and contact energy and what left: constant but for the work of forces. */
static inline double pd_energy(bw_solid *pd)
{
  const bw_solid_ledger l = ledger_of(pd);
  return l.kinetic + l.elastic + l.contact + l.retired + l.damping + l.fracture - l.external;
}

/* Rows of a rank to rows of another division: through the global id, by a sum over ranks. */
static inline void pd_move_rows(const bw_solid *from, const bw_solid *to, size_t width,
                                const double rows[], double out[])
{
  const size_t total = (size_t)bw_solid_total(from);
  double *all = NULL;
  bw_check_ok(BW_ALLOCATE(&all, width * total));
  for (size_t i = 0; i < bw_solid_count(from); i++)
    for (size_t k = 0; k < width; k++)
      all[width * (size_t)bw_solid_id(from)[i] + k] = rows[width * i + k];
  bw_comm_sum(bw_solid_comm(from), (int)(width * total), all);
  for (size_t i = 0; i < bw_solid_count(to); i++)
    for (size_t k = 0; k < width; k++)
      out[width * i + k] = all[width * (size_t)bw_solid_id(to)[i] + k];
  bw_release(&all);
}

static inline void pd_restart_from(const bw_solid *from, bw_solid *to)
{
  const size_t n = bw_solid_count(from), m = bw_solid_count(to);
  const size_t bytes = bw_solid_bits_bytes(from), width = bw_solid_restart_row(from);
  double *rows = NULL, *moved = NULL, sums[BW_SOLID_RESTART_SUMS];
  uint8_t *bits = NULL;
  bw_check_ok(BW_ALLOCATE(&rows, (n + m) * (bytes + width)));
  bw_check_ok(BW_ALLOCATE(&moved, (n + m) * (bytes + width)));
  bw_check_ok(BW_ALLOCATE(&bits, (n + m) * bytes));
  bw_solid_get_restart(from, rows, sums);
  pd_move_rows(from, to, width, rows, moved);
  bw_check_ok(bw_solid_set_restart(to, moved, sums));
  bw_solid_get_bits(from, bits);
  for (size_t q = 0; q < n * bytes; q++)
    rows[q] = bits[q];
  pd_move_rows(from, to, bytes, rows, moved);
  for (size_t q = 0; q < m * bytes; q++)
    bits[q] = (uint8_t)moved[q];
  bw_check_ok(bw_solid_set_bits(to, bits));
  bw_release(&rows);
  bw_release(&moved);
  bw_release(&bits);
}

/* What `get` gives of two bodies, in the order of ids, is the same. Collective. */
static inline void pd_check_same(const bw_solid *a, const bw_solid *b, pd_getter get,
                                 double tolerance)
{
  const size_t n = (size_t)bw_solid_total(a);
  double *x = NULL, *y = NULL;
  bw_check_ok(BW_ALLOCATE(&x, 3 * n));
  bw_check_ok(BW_ALLOCATE(&y, 3 * n));
  pd_gather(a, get, x);
  pd_gather(b, get, y);
  for (size_t q = 0; q < 3 * n; q++)
    bw_check_near(x[q], y[q], tolerance);
  bw_release(&x);
  bw_release(&y);
}

static inline bw_comm *pd_alone(void)
{
  bw_comm *self = NULL;
  bw_check_ok(bw_comm_self(&self));
  return self;
}
