/* Flat cuts through the bonds. */
#include "solid_internal.h"

#include <math.h>

static const double TOUCH = 1e-9; /* crack edges reach this far beyond their ends, in ds */

/* A flat cut: corner a, edges e1 and e2 (2D: e2 out of the plane and endless). */
typedef struct {
  double a[3], e1[3], e2[3], normal[3];
  bool planar;
  double margin1, margin2; /* TOUCH in units of the edges */
} cut;

static double dot(const double x[3], const double y[3])
{
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

static void cross(const double x[3], const double y[3], double z[3])
{
  for (int k = 0; k < 3; k++)
    z[k] = x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
}

static bw_status make_cut(const bw_pd_body *pd, const double a[3], const double b[3],
                          const double c[3], cut *out)
{
  const bool planar = pd->dimension == 2;
  BW_REQUIRE(planar || c != NULL, BW_EINPUT,
             "solid_precrack: in 3D a crack is a parallelogram; give its third corner c");
  /* In the plane the second edge is the direction across: the parallelogram stands upright. */
  for (int k = 0; k < 3; k++) {
    out->a[k] = a[k];
    out->e1[k] = planar && k == 2 ? 0 : b[k] - a[k];
    out->e2[k] = planar ? k == 2 : c[k] - a[k];
  }
  cross(out->e1, out->e2, out->normal);
  const double area = sqrt(dot(out->normal, out->normal)), ds = pd->level[0].ds;
  BW_REQUIRE(area > 0 && isfinite(area), BW_EINPUT,
             "solid_precrack: the crack at (%g, %g, %g) has no extent", a[0], a[1], a[2]);
  for (int k = 0; k < 3; k++)
    out->normal[k] /= area;
  /* Ends belong to the crack, to rounding. */
  out->planar = planar;
  out->margin1 = TOUCH * ds / sqrt(dot(out->e1, out->e1));
  out->margin2 = TOUCH * ds / sqrt(dot(out->e2, out->e2));
  return BW_OK;
}

/* Whether the straight line from p to q meets the cut. A point on the cut's plane counts as
 * above it, so a crack through a row of particles separates them from the row below only. */
static bool crosses(const cut *c, double ds, const double p[3], const double q[3])
{
  double d[2], x[3];
  const double *end[2] = {p, q};
  /* Which side of the plane the ends are on. */
  for (int side = 0; side < 2; side++) {
    for (int k = 0; k < 3; k++)
      x[k] = end[side][k] - c->a[k];
    d[side] = dot(c->normal, x);
  }
  const bool above_p = d[0] > -TOUCH * ds, above_q = d[1] > -TOUCH * ds;
  if (above_p == above_q) return false;
  /* Where the line meets the plane ... */
  const double t = fmax(0, fmin(1, d[0] / (d[0] - d[1])));
  for (int k = 0; k < 3; k++)
    x[k] = p[k] + t * (q[k] - p[k]) - c->a[k];
  /* ... and that point in coordinates along the two edges, which need not be at right angles. */
  const double g11 = dot(c->e1, c->e1), g12 = dot(c->e1, c->e2), g22 = dot(c->e2, c->e2);
  const double b1 = dot(c->e1, x), b2 = dot(c->e2, x), det = g11 * g22 - g12 * g12;
  const double s1 = (b1 * g22 - b2 * g12) / det, s2 = (b2 * g11 - b1 * g12) / det;
  return s1 >= -c->margin1 && s1 <= 1 + c->margin1 &&
         (c->planar || (s2 >= -c->margin2 && s2 <= 1 + c->margin2));
}

/* The bond from the end that is first in lattice order, so that both ends decide alike. */
static void ends(const bw_pd_body *pd, const bw_pd_block *block, const bw_pd_slot *slot, int lane,
                 double p[3], double q[3])
{
  const bool forward =
      bw_pd_body_is_first(&bw_pd_body_level_of(pd, block)->stencil, slot->direction);
  bw_pd_body_reference(pd, (size_t)bw_pd_body_owner(block, lane), forward ? p : q);
  bw_pd_body_reference(pd, (size_t)pd->points.occupant[slot->base + lane], forward ? q : p);
}

/* The crack has an image in every period. */
static bool crosses_image(const bw_pd_body *pd, const cut *c, const double p[3], const double q[3])
{
  const bw_pd_body_config *g = &pd->config;
  /* Bonds across a period are met by the crack's image there. */
  int image[3];
  const int reach[3] = {g->period[0] > 0, g->period[1] > 0, g->period[2] > 0};
  for (image[2] = -reach[2]; image[2] <= reach[2]; image[2]++)
    for (image[1] = -reach[1]; image[1] <= reach[1]; image[1]++)
      for (image[0] = -reach[0]; image[0] <= reach[0]; image[0]++) {
        cut moved = *c;
        for (int d = 0; d < 3; d++)
          for (int k = 0; k < 3; k++)
            moved.a[k] += image[d] * g->period[d] * g->axes[d][k];
        if (crosses(&moved, pd->level[0].ds, p, q)) return true;
      }
  return false;
}

/* Lanes of a block whose bonds may reach the plane of the cut, or one of its images. */
static uint8_t in_reach(const bw_pd_body *pd, const bw_pd_block *block, const cut *c)
{
  const bw_pd_body_config *g = &pd->config;
  const bw_pd_stencil *s = &bw_pd_body_level_of(pd, block)->stencil;
  const double reach = s->unit * s->reach * sqrt(3.0) + 2 * g->disorder * g->ds;
  uint8_t out = 0;
  if (g->period[0] > 0 || g->period[1] > 0 || g->period[2] > 0) return block->mask;
  for (int lane = 0; lane < BW_PD_LANES; lane++) {
    double x[3];
    if (!(block->mask >> lane & 1)) continue;
    bw_pd_body_reference(pd, (size_t)bw_pd_body_owner(block, lane), x);
    for (int k = 0; k < 3; k++)
      x[k] -= c->a[k];
    if (fabs(dot(c->normal, x)) < reach) out |= (uint8_t)(1u << lane);
  }
  return out;
}

static void cut_block(bw_solid *s, bw_pd_block *block, const cut *c)
{
  bw_pd_body *pd = s->body;
  const uint8_t near = in_reach(pd, block, c);
  if (near == 0) return;
  for (uint32_t q = block->slot; q < block[1].slot; q++) {
    bw_pd_slot *slot = &pd->bonds.slot[q];
    for (int lane = 0; lane < BW_PD_LANES; lane++) {
      if (!((slot->mask & near) >> lane & 1)) continue;
      double x[3], y[3];
      /* Where the particles began: a pre-crack is cut into the unloaded shape. */
      ends(pd, block, slot, lane, x, y);
      if (!crosses_image(pd, c, x, y)) continue;
      bw_pd_body_cut(pd, block, slot, lane);
      /* Cut, not broken by stretch: the ledger tells them apart. */
      s->book.precracked++;
      if (s->levels != NULL) s->levels->precut[bw_pd_body_owner(block, lane)]++;
    }
  }
}

bw_status bw_solid__cut(bw_solid *s, const double a[3], const double b[3], const double c[3])
{
  bw_pd_body *pd = s->body;
  cut crack;
  BW_TRY(bw_comm_agree(pd->comm, make_cut(pd, a, b, c, &crack)));
  /* What a bond held when it was cut is booked at the present places of both ends. */
  bw_pd_body_refresh(pd, false);
  for (size_t q = 0; q < pd->bonds.n_block; q++)
    cut_block(s, &pd->bonds.block[q], &crack);
  /* Forces of the cut bonds are still in the acceleration: it is evaluated anew. */
  pd->current = false;
  return BW_OK;
}

bw_status bw_solid__cut_again(bw_solid *s)
{
  for (int q = 0; q < s->levels->n_cut; q++) {
    const bw_solid__precrack *x = &s->levels->cut[q];
    BW_TRY(bw_solid__cut(s, x->a, x->b, x->c));
  }
  return BW_OK;
}
