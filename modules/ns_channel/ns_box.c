/* ns_box.c -- momentum balance of a box of cells, to round-off: the same fluxes as the sweep
 * (ns_momentum.c), summed over the faces of the box with the weights of RK3. What the balance
 * does not explain is what bodies did to the fluid inside. */
#include "ns_channel_internal.h"

enum { CONVECTION = 1, DIFFUSION = 2 };

/* Local index range of the box's points of component c on this rank, tangentially and along. */
typedef struct {
  int lo[3], hi[3];     /* owned points: lo < i <= hi */
  int begin[3], end[3]; /* of the whole box, local numbering */
} box_range;

static box_range range_of(const bw_ns_channel *ns, int c)
{
  const bw_grid_view *g = ns->g;
  box_range b;
  for (int d = 0; d < 3; d++) {
    /* The whole box in this rank's numbering; it may lie outside the rank's block. */
    b.begin[d] = ns->box.lo[d] - g->lo[d];
    b.end[d] = ns->box.hi[d] - g->lo[d];
    /* the face on a boundary is prescribed, not balanced */
    if (d == c && !g->periodic[d] && ns->box.hi[d] == g->n[d]) b.end[d]--;
    /* What of the box this rank owns; hi <= lo where it owns nothing. */
    b.lo[d] = b.begin[d] > 0 ? b.begin[d] : 0;
    b.hi[d] = b.end[d] < g->m[d] ? b.end[d] : g->m[d];
  }
  return b;
}

/* Area of the momentum cell of component c seen along d (d = c included), at row j. */
static double area(const bw_ns_channel *ns, int c, int d, int j)
{
  const double *h = ns->g->spacing;
  const double y = c == 1 ? ns->metrics.dyc[j] : ns->metrics.dyf[j];
  return d == 0 ? y * h[2] : d == 1 ? h[0] * h[2] : h[0] * y;
}

static double volume(const bw_ns_channel *ns, int c, int j)
{
  return ns->g->spacing[0] * area(ns, c, 0, j);
}

/* Momentum flux of component c in direction d between point `at` and the next one up. */
static double flux(const bw_ns_channel *ns, int c, int d, ptrdiff_t at, int j, int parts)
{
  const bw_grid_view *g = ns->g;
  const bw_ns_metrics *m = &ns->metrics;
  const bw_real *q = ns->u[c], *carrier = ns->u[d];
  /* The volume flux is the mean of two: halves, for v across x and z the two cells' shares. */
  const double below = c == 1 && d != 1 ? (double)m->below[j] : 0.5;
  const double spacing = d != 1 ? g->spacing[d] : c == 1 ? m->dyf[j + 1] : m->dyc[j];
  const double here = (double)q[at], up = (double)q[at + g->stride[d]];
  double f = 0.0;
  /* u_d u_c with plain means of the transported velocity: the scheme's own divergence form. */
  if (parts & CONVECTION)
    f += (below * (double)carrier[at] + (1.0 - below) * (double)carrier[at + g->stride[c]]) * 0.5 *
         (here + up);
  /* Minus nu du_c/dx_d, the second part of POROUS 3.74. */
  if (parts & DIFFUSION) f -= ns->config.nu * (up - here) / spacing;
  return f;
}

typedef double (*face_value)(const bw_ns_channel *ns, int c, int d, ptrdiff_t at, int j,
                             const void *what);

static double flux_value(const bw_ns_channel *ns, int c, int d, ptrdiff_t at, int j,
                         const void *what)
{
  return flux(ns, c, d, at, j, *(const int *)what);
}

/* Along its own direction the pressure of component c stands one point up, like its flux. */
static double pressure_value(const bw_ns_channel *ns, int c, int d, ptrdiff_t at, int j,
                             const void *what)
{
  (void)c, (void)j;
  return (double)((const bw_real *)what)[at + ns->g->stride[d]];
}

/* This rank's part of (sum over lower face - sum over upper face) of value dA. */
static double through(const bw_ns_channel *ns, int c, int d, face_value value, const void *what)
{
  const bw_grid_view *g = ns->g;
  const box_range b = range_of(ns, c);
  double sum = 0.0;
  /* A box one cell thick at a wall has no balanced face of the normal component. */
  if (b.begin[d] >= b.end[d]) return 0.0;
  for (int side = 0; side < 2; side++) {
    /* The flux at a face belongs to the rank that owns the cell inside the box beside it: no face
     * counts twice. */
    const int face = side == 0 ? b.begin[d] : b.end[d], cell = side == 0 ? face + 1 : face;
    if (cell < 1 || cell > g->m[d]) continue;
    /* Tangentially only the points that this rank owns, along d the one layer. */
    int from[3], to[3];
    for (int e = 0; e < 3; e++) {
      from[e] = e == d ? face : b.lo[e] + 1;
      to[e] = e == d ? face : b.hi[e];
    }
    double one = 0.0;
    for (int k = from[2]; k <= to[2]; k++)
      for (int j = from[1]; j <= to[1]; j++)
        for (int i = from[0]; i <= to[0]; i++)
          one += value(ns, c, d, bw_at(g, i, j, k), j, what) * area(ns, c, d, j);
    sum += side == 0 ? one : -one;
  }
  return sum;
}

static double momentum(const bw_ns_channel *ns, int c)
{
  const box_range b = range_of(ns, c);
  double sum = 0.0;
  for (int k = b.lo[2] + 1; k <= b.hi[2]; k++)
    for (int j = b.lo[1] + 1; j <= b.hi[1]; j++) {
      double row = 0.0;
      for (int i = b.lo[0] + 1; i <= b.hi[0]; i++)
        row += (double)ns->u[c][bw_at(ns->g, i, j, k)];
      sum += row * volume(ns, c, j);
    }
  return sum;
}

/* Of the cells of what is driven. */
static double driven_volume(const bw_ns_channel *ns)
{
  const int c = ns->config.forcing_axis;
  const box_range b = range_of(ns, c);
  if (b.hi[0] <= b.lo[0] || b.hi[2] <= b.lo[2]) return 0.0;
  double sum = 0.0;
  for (int j = b.lo[1] + 1; j <= b.hi[1]; j++)
    sum += volume(ns, c, j);
  return sum * (b.hi[0] - b.lo[0]) * (b.hi[2] - b.lo[2]);
}

void bw_ns__box_fluxes(bw_ns_channel *ns, int r, double dt, double gradient)
{
  bw_ns_box *box = &ns->box;
  if (!box->on) return;
  const double gamma_dt = bw_ns__gamma[r] * dt;
  for (int c = 0; c < ns->components; c++) {
    /* The momentum at the beginning is known from the last step unless the field was changed from
     * outside. */
    if (r == 0 && !box->known) box->momentum[c] = momentum(ns, c);
    if (r == 0) box->impulse[c] = box->flux[c] = 0.0;
    double now = 0.0;
    /* Where y is implicit its diffusion is booked apart, half before and half after the solve. */
    for (int d = 0; d < ns->components; d++) {
      const int parts = d == 1 && ns->config.viscous == BW_VISCOUS_IMPLICIT_Y
                            ? CONVECTION
                            : CONVECTION | DIFFUSION;
      now += through(ns, c, d, flux_value, &parts);
    }
    /* Weighted as RK3 weights right-hand sides: alpha_r N_r + beta_r N_{r-1} (ERRATA 5). */
    box->impulse[c] += dt * (bw_ns__alpha[r] * now + bw_ns__beta[r] * box->flux[c]);
    /* The old pressure acts in predict with gamma_r dt; the correction follows in projection. */
    box->impulse[c] += gamma_dt * through(ns, c, c, pressure_value, ns->p);
    box->flux[c] = now;
  }
  /* The gradient that drives the flow pushes every cell alike. */
  box->impulse[ns->config.forcing_axis] += gamma_dt * gradient * driven_volume(ns);
  box->known = true;
}

void bw_ns__box_diffusion(bw_ns_channel *ns, double weight)
{
  static const int parts = DIFFUSION;
  for (int c = 0; c < ns->components && ns->box.on; c++)
    ns->box.impulse[c] += weight * through(ns, c, 1, flux_value, &parts);
}

void bw_ns__box_projection(bw_ns_channel *ns, double gamma_dt, double shift)
{
  if (!ns->box.on) return;
  for (int c = 0; c < ns->components; c++)
    ns->box.impulse[c] += gamma_dt * through(ns, c, c, pressure_value, ns->phi);
  ns->box.impulse[ns->config.forcing_axis] += shift * driven_volume(ns);
}

void bw_ns__box_finish(bw_ns_channel *ns, double dt)
{
  bw_ns_box *box = &ns->box;
  for (int c = 0; c < ns->components && box->on; c++) {
    const double now = momentum(ns, c);
    /* What fluxes, pressure and forcing do not explain is what bodies did to the fluid inside. */
    box->force[c] = (now - box->momentum[c] - box->impulse[c]) / dt;
    box->momentum[c] = now;
  }
}

bw_status bw_ns_channel_watch_box(bw_ns_channel *ns, const int lo[3], const int hi[3])
{
  BW_REQUIRE(ns->config.viscous != BW_VISCOUS_IMPLICIT, BW_EINPUT,
             "ns_channel: the fluxes of a watched box are not known where the viscous term is "
             "implicit in all directions; use explicit or implicit_y");
  BW_REQUIRE(ns->config.eddy == BW_EDDY_NONE, BW_EINPUT,
             "ns_channel: a watched box knows no fluxes of an eddy viscosity; leave one of them "
             "out");
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(0 <= lo[d] && lo[d] < hi[d] && hi[d] <= ns->g->n[d], BW_EINPUT,
               "ns_channel: watched cells %d < i <= %d in direction %d are not a part of 1..%d",
               lo[d], hi[d], d, ns->g->n[d]);
  /* known is false: the momentum is summed anew before the next step. */
  ns->box = (bw_ns_box){.on = true};
  for (int d = 0; d < 3; d++)
    ns->box.lo[d] = lo[d], ns->box.hi[d] = hi[d];
  return BW_OK;
}

void bw_ns_channel_control_volume(bw_ns_channel *ns, double force[3])
{
  for (int d = 0; d < 3; d++)
    force[d] = ns->box.force[d];
  bw_comm_sum(ns->comm, 3, force);
}
