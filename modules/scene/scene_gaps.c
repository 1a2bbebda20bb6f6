/* What bodies leave of the way of a flow: a channel that they block, gaps that cells do not see. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_shape_surface.h"
#include <math.h>
#include <string.h>

/* Cells that are looked at, at most; larger grids are looked at through larger ones. */
static const double LOOKED_AT = 2e5;
/* Narrower than this, in cells, a gap is not resolved: markers take some 0.3 cells at each side,
 * and a slit 4 to 4.5 cells wide lets through a third too little (docs/extremes.md). */
static const double NARROW = 5.0;

/* All bodies, where each has a true surface. */
typedef struct {
  int n;
  bw_scene__shapes of[BW_SCENE_BODIES];
} bodies;

static bool is_inside(const bodies *all, bool planar, const double x[3])
{
  for (int b = 0; b < all->n; b++)
    if (bw_shape_distance(all->of[b].n, all->of[b].shape, planar, x) < 0.0) return true;
  return false;
}

/* Cells that are open, 1, and of them those that a flow from the lower side reaches, 2. */
typedef struct {
  int n[3];
  bool periodic[3];
  uint8_t *cell;
  int *front;
} cells;

static void mark_open(const bw_scene *s, const bodies *all, cells *c)
{
  for (int q = 0; q < c->n[0] * c->n[1] * c->n[2]; q++) {
    const int at[3] = {q % c->n[0], q / c->n[0] % c->n[1], q / c->n[0] / c->n[1]};
    double x[3];
    for (int d = 0; d < 3; d++)
      x[d] = (at[d] + 0.5) / c->n[d] * s->config.domain.length[d];
    c->cell[q] = is_inside(all, s->planar, x) ? 0 : 1;
  }
}

/* Is there a way of open cells, over their faces, from one side of `axis` to the other? */
static bool leads_through(cells *c, int axis)
{
  const int stride[3] = {1, c->n[0], c->n[0] * c->n[1]}, total = stride[2] * c->n[2];
  int waiting = 0;
  for (int q = 0; q < total; q++)
    if (q / stride[axis] % c->n[axis] == 0 && c->cell[q] == 1)
      c->cell[q] = 2, c->front[waiting++] = q;
  while (waiting > 0) {
    const int q = c->front[--waiting];
    if (q / stride[axis] % c->n[axis] == c->n[axis] - 1) return true;
    for (int d = 0; d < 3; d++)
      for (int way = -1; way <= 1; way += 2) {
        const int at = q / stride[d] % c->n[d], to = at + way;
        const bool beyond = to < 0 || to >= c->n[d];
        if (beyond && (!c->periodic[d] || d == axis)) continue;
        const int next = q + ((to + c->n[d]) % c->n[d] - at) * stride[d];
        if (c->cell[next] == 1) c->cell[next] = 2, c->front[waiting++] = next;
      }
  }
  return false;
}

/* The direction in which the flow has to get through; -1: none. */
static int stream_of(const bw_scene *s)
{
  for (int d = 0; d < 3; d++)
    if (s->flow.side[d][0].kind == BW_SIDE_INFLOW || s->flow.side[d][1].kind == BW_SIDE_INFLOW)
      return d;
  return s->config.fluid.has_forcing ? s->config.fluid.forcing.axis : -1;
}

static bw_status check_way(const bw_scene *s, const bodies *all, bw_log *log)
{
  const int axis = stream_of(s);
  const int *real = s->config.domain.cells;
  cells c = {0};
  double coarse = 1.0;
  if (axis < 0) return BW_OK;
  const double total = (double)real[0] * real[1] * real[2];
  if (total > LOOKED_AT) coarse = ceil(pow(total / LOOKED_AT, s->planar ? 0.5 : 1.0 / 3.0));
  /* Cells of the fluid, or larger ones where there are too many to look at. */
  for (int d = 0; d < 3; d++) {
    c.n[d] = (int)fmax(1.0, ceil(real[d] / coarse));
    c.periodic[d] = s->flow.side[d][0].kind == BW_SIDE_PERIODIC;
  }
  const size_t n = (size_t)c.n[0] * (size_t)c.n[1] * (size_t)c.n[2];
  bw_status st = BW_ALLOCATE(&c.cell, n);
  BW_THEN(st, BW_ALLOCATE(&c.front, n));
  if (st == BW_OK) mark_open(s, all, &c);
  const bool through = st != BW_OK || leads_through(&c, axis);
  bw_release(&c.cell);
  bw_release(&c.front);
  BW_TRY(st);
  /* Larger cells may close what is open, so that they only warn. */
  BW_REQUIRE(
      through || coarse > 1.0, BW_EINPUT,
      "bodies: they block the channel: no way of open cells leads from one side to the other "
      "along %c; leave an opening, or take the body out",
      "xyz"[axis]);
  if (!through)
    bw_log_warn(
        log,
        "bodies: seen through cells %g times as large no way leads along %c: they may block "
        "the channel",
        coarse, "xyz"[axis]);
  return BW_OK;
}

/* The least distance of body a's surface from body b. */
static bw_status distance_of(const bw_scene *s, const bodies *all, int a, int b, double *least)
{
  enum { ALONG = 24 };
  const bw_scene__shapes *p = &all->of[a], *q = &all->of[b];
  double extent = 0.0, *X = NULL, *N = NULL, *area = NULL;
  int64_t n = 0;
  *least = HUGE_VAL;
  for (int d = 0; d < (s->planar ? 2 : 3); d++)
    extent = fmax(extent, p->upper[d] - p->lower[d]);
  BW_TRY(bw_shape_points(p->n, p->shape, s->planar, extent / ALONG, &n, &X, &N, &area));
  for (int64_t i = 0; i < n; i++)
    *least = fmin(*least, bw_shape_distance(q->n, q->shape, s->planar, X + 3 * i));
  bw_release(&X);
  bw_release(&N);
  bw_release(&area);
  return BW_OK;
}

static void tell(const bw_scene *s, bw_log *log, int a, const char *other, double gap)
{
  const double h = bw_grid_look(s->grid)->spacing[0];
  /* What touches leaves no gap. */
  if (!(gap > 0.1 * h && gap < NARROW * h)) return;
  bw_log_warn(log,
              "between bodies.%s and %s is a gap of about %.1f cells: the flow in it is not "
              "resolved; take cells for at least %g, or close it",
              s->config.bodies[a].name, other, gap / h, NARROW);
}

static bw_status look_at_gaps(const bw_scene *s, const bodies *all, bw_log *log)
{
  for (int a = 0; a < all->n; a++) {
    for (int d = 0; d < (s->planar ? 2 : 3); d++)
      for (int end = 0; end < 2; end++) {
        char side[32];
        if (s->flow.side[d][end].kind != BW_SIDE_WALL) continue;
        snprintf(side, sizeof side, "the %s wall in %c", end == 0 ? "lower" : "upper", "xyz"[d]);
        tell(s, log, a, side,
             end == 0 ? all->of[a].lower[d] : s->config.domain.length[d] - all->of[a].upper[d]);
      }
    for (int b = 0; b < a; b++) {
      char other[BW_SCENE_NAME + 8];
      double gap = HUGE_VAL;
      BW_TRY(distance_of(s, all, a, b, &gap));
      snprintf(other, sizeof other, "bodies.%s", s->config.bodies[b].name);
      tell(s, log, a, other, gap);
    }
  }
  return BW_OK;
}

bw_status bw_scene__look_at_gaps(bw_scene *s, bw_log *log)
{
  bodies *all = NULL;
  bool known = true;
  if (s->grid == NULL || s->config.n_bodies == 0) return BW_OK;
  BW_TRY(bw_comm_agree(s->comm, BW_ALLOCATE(&all, 1)));
  bw_status st = BW_OK;
  for (int b = 0; b < s->config.n_bodies && st == BW_OK; b++) {
    st = bw_scene__shapes_make(&s->config, b, &all->of[all->n++]);
    known = known && all->of[b].analytic;
  }
  /* Images tell of their pores. */
  if (known) BW_THEN(st, check_way(s, all, log));
  if (known) BW_THEN(st, look_at_gaps(s, all, log));
  for (int b = 0; b < all->n; b++)
    bw_scene__shapes_release(&all->of[b]);
  bw_release(&all);
  return bw_comm_agree(s->comm, st);
}
