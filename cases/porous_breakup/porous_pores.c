/* What --check tells of the pores. */
#include "bw_memory.h"
#include "bw_shape_pores.h"
#include "bw_shape_way.h"
#include "porous_body.h"

#include <math.h>

/* Narrower than this, in cells, probes see too little of a throat (README). */
static const double NARROW = 5.0;

/* The sites that lie in the medium's box, counted from its first cell; the box's cells. */
static bw_status sites_within(const porous_config *q, int64_t n, const int32_t site[],
                              int64_t cells[3], int64_t first[3], int64_t *inside, int32_t **out)
{
  const bw_shape box = porous_box(q);
  const double h = q->domain.length[1] / q->domain.cells[1];
  for (int d = 0; d < 3; d++) {
    /* Centres between the sides, as the lattice is filled. */
    first[d] = (int64_t)ceil(box.lower[d] / h - 0.5 - 1e-9);
    cells[d] = (int64_t)ceil(box.upper[d] / h - 0.5 - 1e-9) - first[d];
    cells[d] = cells[d] > 0 ? cells[d] : 1;
  }
  *inside = 0;
  BW_TRY(BW_ALLOCATE(out, 3 * (size_t)n));
  for (int64_t k = 0; k < n; k++) {
    bool in = true;
    for (int d = 0; d < 3; d++) {
      const int64_t at = site[3 * k + d] - first[d];
      in = in && at >= 0 && at < cells[d];
      (*out)[3 * *inside + d] = (int32_t)at;
    }
    *inside += in;
  }
  return BW_OK;
}

static void tell_throat(const porous_config *q, const bw_shape_pores *p, const int64_t first[3],
                        bw_log *log)
{
  const double h = q->domain.length[1] / q->domain.cells[1];
  const int64_t *at = p->at[0];
  if (!(p->throat[0] > 0.0 && p->throat[0] < NARROW)) return;
  bw_log_warn(
      log,
      "the widest way along the stream has a throat of about %.1f cells at x = %g, y = %g, "
      "z = %g m: probes need %g cells there (coupling.load: reaction does not), and the flow "
      "in it is not resolved; take more cells, or wider pores",
      p->throat[0], ((double)(first[0] + at[0]) + 0.5) * h, ((double)(first[1] + at[1]) + 0.5) * h,
      ((double)(first[2] + at[2]) + 0.5) * h, NARROW);
}

/* Ways along each axis, by the flood that needs no rank to hold the whole. */
static bw_status find_ways(const bw_comm *comm, const int64_t cells[3], int64_t n,
                           const int32_t site[], bool through[3], double *porosity)
{
  for (int axis = 0; axis < 3; axis++) {
    bw_shape_way way;
    bw_shape_way_box box = {.cells = {cells[0], cells[1], cells[2]}, .axis = axis};
    box.periodic[2] = axis != 2;
    BW_TRY(bw_shape_find_way(comm, &box, n, site, &way));
    through[axis] = way.through;
    *porosity = (double)way.open / ((double)cells[0] * (double)cells[1] * (double)cells[2]);
  }
  return BW_OK;
}

static bw_status tell(const bw_comm *comm, const porous_config *q, const int64_t cells[3],
                      const int64_t first[3], int64_t n, const int32_t site[], bw_log *log)
{
  bool through[3];
  double porosity = 0.0;
  bw_shape_pores p;
  BW_TRY(find_ways(comm, cells, n, site, through, &porosity));
  bw_log_info(
      log, "pores      porosity %.4f in the medium's box; connected along x: %s, y: %s, z: %s",
      porosity, through[0] ? "yes" : "no", through[1] ? "yes" : "no", through[2] ? "yes" : "no");
  const bw_shape_pores_box box = {.cells = {cells[0], cells[1], cells[2]},
                                  .periodic = {false, false, true},
                                  .wall = {false, true, false}};
  BW_TRY(bw_shape_find_pores(comm, &box, n, site, &p));
  if (p.known)
    bw_log_info(
        log,
        "           estimates, in cells: pores %.1f, the largest %.1f; throats of the widest "
        "ways along x, y, z: %.1f, %.1f, %.1f",
        p.typical, p.largest, p.throat[0], p.throat[1], p.throat[2]);
  else
    bw_log_info(log,
                "           sizes of pores are not estimated: the box has more than %lld cells",
                (long long)BW_SHAPE_PORES_MOST);
  tell_throat(q, &p, first, log);
  return BW_OK;
}

bw_status porous_tell_pores(const bw_comm *comm, const porous_config *q, int64_t n,
                            const int32_t site[], bw_case *run)
{
  int64_t cells[3], first[3], inside = 0;
  int32_t *within = NULL;
  bw_status st = bw_comm_agree(comm, sites_within(q, n, site, cells, first, &inside, &within));
  BW_THEN(st, tell(comm, q, cells, first, inside, within, bw_case_log(run)));
  bw_release(&within);
  return st;
}
