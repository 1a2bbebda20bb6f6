/* beam.h -- strips clamped at one end: lattices, loads, and what their ends do. */
#pragma once
#include "state.h"

/* A strip of `length` x `height` cells of size 1 clamped by columns beside it, its lower end at y =
 * 0, its clamped end at x = clamp. */
typedef struct {
  int length, height, clamp;
  bw_solid *pd;
  body_rows r;
} beam;

static inline int beam_clamped(const int32_t site[3], const void *data)
{
  return site[0] < ((const beam *)data)->clamp ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

/* Correspondence in a plane with these options; m = 1.5 reaches no further than the horizon. */
static inline bw_solid_config beam_material(bw_pd_geometry geometry, double E, double nu, double m,
                                            const bw_pd_state_correspondence_options *o)
{
  bw_solid_config c = bw_solid_config_default();
  c.geometry = geometry, c.ds = c.rho = 1, c.E = E, c.nu = nu, c.horizon_ratio = m;
  if (m < 2) c.family_reach = BW_PD_REACH_HORIZON;
  c.law = &bw_pd_state_correspondence_law, c.law_options = o;
  return c;
}

static inline bw_status beam_make(const bw_comm *comm, const bw_solid_config *c, beam *b)
{
  b->clamp = (int)ceil(c->horizon_ratio + 0.5);
  BW_TRY(body_make(comm, c, (int[3]){b->clamp + b->length, b->height, 1}, beam_clamped, b, &b->pd));
  return body_rows_make(b->pd, &b->r);
}

static inline void beam_release(beam *b)
{
  body_rows_release(&b->r);
  bw_solid_destroy(&b->pd);
}

/* The force F along y on the last column, half a cell before the end, to r.F: evenly or as a
 * parabola over the height. */
static inline void beam_load(beam *b, double F, bool parabola)
{
  double sum = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < bw_solid_count(b->pd); i++) {
      const double y = b->r.X0[3 * i + 1] / b->height - 0.5;
      const double share = parabola ? 1.5 * (1 - 4 * y * y) - 0.5 / (b->height * b->height) : 1;
      if (b->r.X0[3 * i] < b->clamp + b->length - 1) continue;
      if (pass == 0) sum += share;
      if (pass == 1) b->r.F[3 * i + 1] = F * share / (sum * bw_solid_volume(b->pd));
    }
  bw_solid_set_force(b->pd, b->r.F);
}

/* Mean of a component of rows (n,3) over the column whose middle is half a cell after `x` from the
 * clamp. */
static inline double beam_column(const beam *b, int x, const double rows[], int k)
{
  const double far = 1e9;
  return body_mean(b->pd, b->r.X0, (double[3]){b->clamp + x, -far, -far},
                   (double[3]){b->clamp + x + 1, far, far}, rows + k, 3);
}
