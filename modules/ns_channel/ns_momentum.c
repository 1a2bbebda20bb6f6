/* ns_momentum.c -- one sweep over memory: right-hand sides of u, v, w and the explicit update.
 *
 * Fluxes of momentum are evaluated once, on the upper faces of each momentum cell:
 *   along its own component  ((q + q_up)/2)^2 - nu (q_up - q)/d
 *   across                   c (q + q_up)/2   - nu (q_up - q)/d
 * with c the volume flux through that face, averaged from the two pressure cells it belongs to
 * (halves; in y the heights' shares), so that <u, N(u)> = 0 where div u = 0, also on a stretched
 * grid. A row needs only its upper neighbours and the fluxes kept from the lower ones; so u can
 * be overwritten in place, row by row: no second copy of the velocity exists. (Where all of the
 * viscous term is implicit, u stays and the change goes elsewhere: ns_factored.c.) */
#include "ns_channel_internal.h"

/* carrier: sum of two velocities; c: 1/4 (times 1/d for scaled fluxes); e: nu/d. */
BW_NS_INLINE bw_real flux(bw_real carrier, bw_real q, bw_real up, bw_real c, bw_real e)
{
  return carrier * (q + up) * c - (up - q) * e;
}

typedef struct {          /* scalars of one row; fluxes in x and z are scaled by 1/dx, 1/dz */
  bw_real cx, ex, cz, ez; /* 1/(4 dx), nu/dx^2, 1/(4 dz), nu/dz^2 */
  bw_real ey_u, ey_v;     /* nu/d above in y for u, w and for v */
  bw_real rdyf, rdyc;     /* height of the row's cells: u, w and v */
  bw_real below2, above2; /* twice the shares */
  bw_real dy_u, dy_v;     /* implicit in y: kappa/d above in y for u, w and for v */
  bw_real alpha, beta, gx, gy, gz, source[3];
} row_scalars;

typedef struct { /* row (j, k), j + 1 (n), k + 1 (t): [i] is cell i */
  bw_real *u, *v, *w, *un, *vn, *wn, *ut, *vt, *wt;
  const bw_real *p, *pn, *pt;
  bw_real *ru, *rv, *rw, *du, *dv, *dw;
} row_pointers;

/* fxu, fxv, fxw for i = 0..n and the y flux of w above. */
BW_NS_INLINE void x_fluxes(int n, bool planar, const row_scalars *restrict c,
                           const bw_real *restrict u, const bw_real *restrict un,
                           const bw_real *restrict ut, const bw_real *restrict v,
                           const bw_real *restrict vt, const bw_real *restrict w,
                           const bw_real *restrict wn, bw_real *restrict fxu, bw_real *restrict fxv,
                           bw_real *restrict fxw, bw_real *restrict gyw)
{
  const bw_real cx = c->cx, ex = c->ex, below2 = c->below2, above2 = c->above2;
  const bw_real quarter = (bw_real)0.25, ey = c->ey_u;
  /* Fluxes through the right faces, from the velocity before any update of this row. */
  for (int i = 0; i <= n; i++) {
    fxu[i] = flux(u[i] + u[i + 1], u[i], u[i + 1], cx, ex);
    fxv[i] = flux(below2 * u[i] + above2 * un[i], v[i], v[i + 1], cx, ex);
    /* The y flux of w is taken here, too, as update_v overwrites the v that carries it. */
    if (!planar) {
      fxw[i] = flux(u[i] + ut[i], w[i], w[i + 1], cx, ex);
      gyw[i] = flux(v[i] + vt[i], w[i], wn[i], quarter, ey);
    }
  }
}

/* What a finished right-hand side does: R_prev is read after stage 0, kept before stage 2. */
#define BW_UPDATE(q, out, R, dp)                                                                   \
  do {                                                                                             \
    bw_real change_ = alpha * rhs + (dp);                                                          \
    if (viscous == BW_VISCOUS_IMPLICIT_Y) change_ += diffused * rdy;                               \
    if (stage > 0) change_ += beta * (R)[i];                                                       \
    if (stage < 2) (R)[i] = rhs;                                                                   \
    if (viscous == BW_VISCOUS_IMPLICIT)                                                            \
      (out)[i] = change_;                                                                          \
    else                                                                                           \
      (q)[i] += change_;                                                                           \
  } while (0)

BW_NS_INLINE void update_u(int n, bool planar, int stage, bw_ns_viscous viscous,
                           const row_scalars *restrict c, bw_real *restrict u,
                           const bw_real *restrict un, const bw_real *restrict ut,
                           const bw_real *restrict v, const bw_real *restrict w,
                           const bw_real *restrict p, const bw_real *restrict fx,
                           bw_real *restrict fy, bw_real *restrict fz, bw_real *restrict dy,
                           bw_real *restrict R, bw_real *restrict out)
{
  const bw_real quarter = (bw_real)0.25, ey = c->ey_u, cz = c->cz, ez = c->ez, rdy = c->rdyf;
  const bw_real alpha = c->alpha, beta = c->beta, gx = c->gx, source = c->source[0];
  /* R(u) = -div(u u) + nu lap u (POROUS 3.74) as differences of fluxes. */
  for (int i = 1; i <= n; i++) {
    const bw_real y = flux(v[i] + v[i + 1], u[i], un[i], quarter, ey);
    bw_real rhs = (fx[i - 1] - fx[i]) + (fy[i] - y) * rdy;
    /* The upper flux is the next row's lower one: it is kept, as u below is overwritten. */
    fy[i] = y;
    bw_real diffused = 0;
    /* kappa D_yy u, the part of the diffusion with the old velocity. */
    if (viscous == BW_VISCOUS_IMPLICIT_Y) {
      const bw_real d = (un[i] - u[i]) * c->dy_u;
      diffused = d - dy[i];
      dy[i] = d;
    }
    /* The same in z; kept for the next plane of the tile. */
    if (!planar) {
      const bw_real z = flux(w[i] + w[i + 1], u[i], ut[i], cz, ez);
      rhs += fz[i] - z;
      fz[i] = z;
    }
    /* POROUS 3.70: u[i] becomes u*; where all is implicit, its change goes to `out`. */
    BW_UPDATE(u, out, R, gx * (p[i] - p[i + 1]) + source);
  }
}

BW_NS_INLINE void update_v(int n, bool planar, int stage, bw_ns_viscous viscous,
                           const row_scalars *restrict c, bw_real *restrict v,
                           const bw_real *restrict vn, const bw_real *restrict vt,
                           const bw_real *restrict w, const bw_real *restrict wn,
                           const bw_real *restrict p, const bw_real *restrict pn,
                           const bw_real *restrict fx, bw_real *restrict fy, bw_real *restrict fz,
                           bw_real *restrict dy, bw_real *restrict R, bw_real *restrict out)
{
  const bw_real quarter = (bw_real)0.25, ey = c->ey_v, cz = c->cz, ez = c->ez, rdy = c->rdyc;
  const bw_real below2 = c->below2, above2 = c->above2;
  const bw_real alpha = c->alpha, beta = c->beta, gy = c->gy, source = c->source[1];
  /* As for u; volume fluxes across x and z have the shares of the two cells they belong to. */
  for (int i = 1; i <= n; i++) {
    const bw_real y = flux(v[i] + vn[i], v[i], vn[i], quarter, ey);
    bw_real rhs = (fx[i - 1] - fx[i]) + (fy[i] - y) * rdy;
    fy[i] = y;
    bw_real diffused = 0;
    /* The diffusion in y of the old velocity. */
    if (viscous == BW_VISCOUS_IMPLICIT_Y) {
      const bw_real d = (vn[i] - v[i]) * c->dy_v;
      diffused = d - dy[i];
      dy[i] = d;
    }
    /* In z the carrier w is the mean of two rows, which are not updated yet. */
    if (!planar) {
      const bw_real z = flux(below2 * w[i] + above2 * wn[i], v[i], vt[i], cz, ez);
      rhs += fz[i] - z;
      fz[i] = z;
    }
    BW_UPDATE(v, out, R, gy * (p[i] - pn[i]) + source);
  }
}

BW_NS_INLINE void update_w(int n, int stage, bw_ns_viscous viscous, const row_scalars *restrict c,
                           bw_real *restrict w, const bw_real *restrict wn,
                           const bw_real *restrict wt, const bw_real *restrict p,
                           const bw_real *restrict pt, const bw_real *restrict fx,
                           const bw_real *restrict y, bw_real *restrict fy, bw_real *restrict fz,
                           bw_real *restrict dy, bw_real *restrict R, bw_real *restrict out)
{
  const bw_real cz = c->cz, ez = c->ez, rdy = c->rdyf;
  const bw_real alpha = c->alpha, beta = c->beta, gz = c->gz, source = c->source[2];
  /* Last of the three, as u and v of this cell need the old w. */
  for (int i = 1; i <= n; i++) {
    const bw_real z = flux(w[i] + wt[i], w[i], wt[i], cz, ez);
    const bw_real rhs = (fx[i - 1] - fx[i]) + (fy[i] - y[i]) * rdy + (fz[i] - z);
    fy[i] = y[i];
    bw_real diffused = 0;
    if (viscous == BW_VISCOUS_IMPLICIT_Y) {
      const bw_real d = (wn[i] - w[i]) * c->dy_u;
      diffused = d - dy[i];
      dy[i] = d;
    }
    fz[i] = z;
    BW_UPDATE(w, out, R, gz * (p[i] - pt[i]) + source);
  }
}

/* Fluxes through the top of the row below the first one / of the plane below the first one. */
static void first_y_fluxes(int n, bool planar, const row_scalars *c, const row_pointers *q,
                           bw_real *const fy[3], bw_real *const dy[3])
{
  const bw_real quarter = (bw_real)0.25;
  /* Row 0 is a halo or a side: its upper fluxes are the first row's lower ones. */
  for (int i = 1; i <= n; i++) {
    fy[0][i] = flux(q->v[i] + q->v[i + 1], q->u[i], q->un[i], quarter, c->ey_u);
    fy[1][i] = flux(q->v[i] + q->vn[i], q->v[i], q->vn[i], quarter, c->ey_v);
    if (!planar) fy[2][i] = flux(q->v[i] + q->vt[i], q->w[i], q->wn[i], quarter, c->ey_u);
    /* Diffusion in y of the explicit half is kept apart from the flux. */
    if (dy == NULL) continue;
    dy[0][i] = (q->un[i] - q->u[i]) * c->dy_u;
    dy[1][i] = (q->vn[i] - q->v[i]) * c->dy_v;
    if (!planar) dy[2][i] = (q->wn[i] - q->w[i]) * c->dy_u;
  }
}

static void first_z_fluxes(int n, const row_scalars *c, const row_pointers *q, bw_real *const fz[3])
{
  for (int i = 1; i <= n; i++) {
    fz[0][i] = flux(q->w[i] + q->w[i + 1], q->u[i], q->ut[i], c->cz, c->ez);
    fz[1][i] = flux(c->below2 * q->w[i] + c->above2 * q->wn[i], q->v[i], q->vt[i], c->cz, c->ez);
    fz[2][i] = flux(q->w[i] + q->wt[i], q->w[i], q->wt[i], c->cz, c->ez);
  }
}

static row_scalars scalars_of_row(const bw_ns_sweep *s, int j)
{
  const bw_ns_metrics *m = s->metrics;
  const bw_real quarter = (bw_real)0.25, nu = s->nu,
                nu_y = s->viscous == BW_VISCOUS_EXPLICIT ? nu : 0;
  row_scalars c = {.cx = quarter * m->rdx,
                   .ex = nu * m->rdx * m->rdx,
                   .cz = quarter * m->rdz,
                   .ez = nu * m->rdz * m->rdz,
                   .ey_u = nu_y * m->rdyc[j],
                   .ey_v = nu_y * m->rdyf[j + 1],
                   .dy_u = s->kappa * m->rdyc[j],
                   .dy_v = s->kappa * m->rdyf[j + 1],
                   .rdyf = m->rdyf[j],
                   .rdyc = m->rdyc[j],
                   .below2 = 2 * m->below[j],
                   .above2 = 2 * m->above[j],
                   .alpha = s->alpha_dt,
                   .beta = s->beta_dt,
                   .gx = s->gamma_dt * m->rdx,
                   .gy = s->gamma_dt * m->rdyc[j],
                   .gz = s->gamma_dt * m->rdz,
                   .source = {s->source[0], s->source[1], s->source[2]}};
  return c;
}

static row_pointers pointers_of_row(const bw_ns_sweep *s, bool planar, int j, int k)
{
  const bw_grid_view *g = s->g;
  const ptrdiff_t at = bw_at(g, 0, j, k), n = at + g->stride[1], t = at + g->stride[2];
  bw_real *const *u = s->u, *const *R = s->R, *const *d = s->change;
  row_pointers q = {.u = u[0] + at,
                    .v = u[1] + at,
                    .un = u[0] + n,
                    .vn = u[1] + n,
                    .ut = u[0] + t,
                    .vt = u[1] + t,
                    .p = s->p + at,
                    .pn = s->p + n,
                    .pt = s->p + t,
                    .ru = R[0] + at,
                    .rv = R[1] + at,
                    .du = d[0] + at,
                    .dv = d[1] + at};
  if (planar) return q;
  q.w = u[2] + at, q.wn = u[2] + n, q.wt = u[2] + t, q.rw = R[2] + at, q.dw = d[2] + at;
  return q;
}

BW_NS_INLINE void one_row(const bw_ns_sweep *s, bool planar, int stage, bw_ns_viscous viscous,
                          int j, int k, int j0)
{
  const row_scalars c = scalars_of_row(s, j);
  const row_pointers q = pointers_of_row(s, planar, j, k);
  const int n = s->g->m[0];
  const ptrdiff_t y = (ptrdiff_t)(k - 1) * (n + 1), z = (ptrdiff_t)(j - j0) * (n + 1);
  bw_real *const *fx = s->fx;
  x_fluxes(n, planar, &c, q.u, q.un, q.ut, q.v, q.vt, q.w, q.wn, fx[0], fx[1], fx[2], fx[3]);
  update_u(n, planar, stage, viscous, &c, q.u, q.un, q.ut, q.v, q.w, q.p, fx[0], s->fy[0] + y,
           s->fz[0] + z, s->dy[0] + y, q.ru, q.du);
  update_v(n, planar, stage, viscous, &c, q.v, q.vn, q.vt, q.w, q.wn, q.p, q.pn, fx[1],
           s->fy[1] + y, s->fz[1] + z, s->dy[1] + y, q.rv, q.dv);
  if (!planar)
    update_w(n, stage, viscous, &c, q.w, q.wn, q.wt, q.p, q.pt, fx[2], fx[3], s->fy[2] + y,
             s->fz[2] + z, s->dy[2] + y, q.rw, q.dw);
}

/* Tiles in y, all planes of a tile in turn: the rows of two planes and the tile's fluxes stay in
 * the second-level cache. y fluxes pass from tile to tile per plane. */
BW_NS_INLINE void all_rows(const bw_ns_sweep *s, bool planar, int stage, bw_ns_viscous viscous)
{
  const bw_grid_view *g = s->g;
  const int n = g->m[0];
  /* y fluxes below the first row, of all planes, while every velocity is still old. */
  for (int k = 1; k <= g->m[2]; k++) {
    const row_scalars c = scalars_of_row(s, 0);
    const row_pointers q = pointers_of_row(s, planar, 0, k);
    const ptrdiff_t y = (ptrdiff_t)(k - 1) * (n + 1);
    first_y_fluxes(n, planar, &c, &q, (bw_real *[]){s->fy[0] + y, s->fy[1] + y, s->fy[2] + y},
                   viscous == BW_VISCOUS_IMPLICIT_Y
                       ? (bw_real *[]){s->dy[0] + y, s->dy[1] + y, s->dy[2] + y}
                       : NULL);
  }
  /* Tile by tile; z fluxes below the first plane come from the halo plane 0. */
  for (int j0 = 1; j0 <= g->m[1]; j0 += s->tile) {
    const int end = j0 + s->tile <= g->m[1] ? j0 + s->tile : g->m[1] + 1;
    for (int j = j0; j < end && !planar; j++) {
      const row_scalars c = scalars_of_row(s, j);
      const row_pointers q = pointers_of_row(s, planar, j, 0);
      const ptrdiff_t z = (ptrdiff_t)(j - j0) * (n + 1);
      first_z_fluxes(n, &c, &q, (bw_real *[]){s->fz[0] + z, s->fz[1] + z, s->fz[2] + z});
    }
    /* Plane by plane upwards: a row needs only old values above and kept fluxes below. */
    for (int k = 1; k <= g->m[2]; k++)
      for (int j = j0; j < end; j++)
        one_row(s, planar, stage, viscous, j, k, j0);
  }
}

#define BW_SWEEP(name, planar, viscous)                                                            \
  static void name##_0(const bw_ns_sweep *s)                                                       \
  {                                                                                                \
    all_rows(s, planar, 0, viscous);                                                               \
  }                                                                                                \
  static void name##_1(const bw_ns_sweep *s)                                                       \
  {                                                                                                \
    all_rows(s, planar, 1, viscous);                                                               \
  }                                                                                                \
  static void name##_2(const bw_ns_sweep *s)                                                       \
  {                                                                                                \
    all_rows(s, planar, 2, viscous);                                                               \
  }
BW_SWEEP(space, false, BW_VISCOUS_EXPLICIT)
BW_SWEEP(space_y, false, BW_VISCOUS_IMPLICIT_Y)
BW_SWEEP(space_all, false, BW_VISCOUS_IMPLICIT)
BW_SWEEP(plane, true, BW_VISCOUS_EXPLICIT)
BW_SWEEP(plane_y, true, BW_VISCOUS_IMPLICIT_Y)
BW_SWEEP(plane_all, true, BW_VISCOUS_IMPLICIT)

void bw_ns__momentum_sweep(const bw_ns_sweep *s, int stage)
{
  /* One instance per dimension, viscous term and stage: no branch is left in the inner loops. */
  static void (*const sweep[2][3][BW_NS_STAGES])(const bw_ns_sweep *) = {
      {[BW_VISCOUS_EXPLICIT] = {space_0, space_1, space_2},
       [BW_VISCOUS_IMPLICIT_Y] = {space_y_0, space_y_1, space_y_2},
       [BW_VISCOUS_IMPLICIT] = {space_all_0, space_all_1, space_all_2}},
      {[BW_VISCOUS_EXPLICIT] = {plane_0, plane_1, plane_2},
       [BW_VISCOUS_IMPLICIT_Y] = {plane_y_0, plane_y_1, plane_y_2},
       [BW_VISCOUS_IMPLICIT] = {plane_all_0, plane_all_1, plane_all_2}}};
  sweep[s->g->n[2] == 1][s->viscous][stage](s);
}

/* About 14 rows per j are alive (velocity of two planes, p, R, fluxes): a quarter of a megabyte
 * of them fits the second-level cache of every processor of the last ten years. */
int bw_ns__momentum_tile(const bw_grid_view *g)
{
  enum { ALIVE_ROWS = 14, BUDGET = 512 * 1024 };
  if (g->n[2] == 1) return 1; /* nothing is kept from plane to plane */
  const int tile = (int)(BUDGET / (ALIVE_ROWS * sizeof(bw_real) * (size_t)g->m[0]));
  return tile < 4 ? 4 : tile < g->m[1] ? tile : g->m[1];
}

size_t bw_ns__momentum_scratch(const bw_ns_sweep *s)
{
  const size_t per_plane = s->viscous == BW_VISCOUS_IMPLICIT_Y ? 6 : 3;
  return (size_t)(s->g->m[0] + 1) * (4 + per_plane * (size_t)s->g->m[2] + 3 * (size_t)s->tile);
}

void bw_ns__momentum_place(bw_ns_sweep *s, bw_real *scratch)
{
  const size_t row = (size_t)(s->g->m[0] + 1), planes = row * (size_t)s->g->m[2];
  /* One buffer, cut in the order of momentum_scratch. */
  for (int q = 0; q < 4; q++, scratch += row)
    s->fx[q] = scratch;
  for (int q = 0; q < 3; q++, scratch += planes)
    s->fy[q] = scratch;
  for (int q = 0; q < 3; q++, scratch += row * (size_t)s->tile)
    s->fz[q] = scratch;
  for (int q = 0; q < 3; q++)
    s->dy[q] = s->viscous == BW_VISCOUS_IMPLICIT_Y ? scratch + (size_t)q * planes : s->fy[q];
}
