/* The object, its walls, and the surface of the reference shape. */
#include "bw_pd_interface.h"
#include "bw_memory.h"
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

bw_pd_interface_config bw_pd_interface_config_default(void)
{
  bw_pd_interface_config c = {.threshold = 1.0, .n_empty = 0};
  for (int d = 0; d < 3; d++)
    c.lower[d] = c.upper[d] = NAN; /* asked for where there is a wall */
  return c;
}

static bw_status check_config(const bw_pd_interface_config *c, int sectors, double disorder)
{
  BW_REQUIRE(isfinite(c->threshold) && c->threshold > 0.0, BW_EINPUT,
             "interface: threshold = %g has to be positive (1 is the horizon)", c->threshold);
  BW_REQUIRE(c->area == BW_PD_AREA_OPEN_SIDES || c->area == BW_PD_AREA_EQUAL, BW_EINPUT,
             "interface: area = %d is neither open sides nor equal", (int)c->area);
  BW_REQUIRE(c->n_empty >= 0 && c->n_empty <= sectors, BW_EINPUT,
             "interface: n_empty = %d has to be 1 to %d, or 0 for the default", c->n_empty,
             sectors);
  /* Mirroring needs partners where the lattice has them. */
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(disorder == 0 || (!c->walled[d][0] && !c->walled[d][1]), BW_EINPUT,
               "interface: walled[%d] needs a solid on a lattice, which a wall can mirror; it has "
               "disorder = %g",
               d, disorder);
  for (int d = 0; d < 3; d++)
    for (int side = 0; side < 2; side++)
      BW_REQUIRE(!c->walled[d][side] || isfinite(side ? c->upper[d] : c->lower[d]), BW_EINPUT,
                 "interface: walled[%d][%d] needs %s[%d], the place of the wall", d, side,
                 side ? "upper" : "lower", d);
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(!c->walled[d][0] || !c->walled[d][1] || c->upper[d] > c->lower[d], BW_EINPUT,
               "interface: upper[%d] = %g has to be above lower[%d] = %g", d, c->upper[d], d,
               c->lower[d]);
  return BW_OK;
}

static bw_status allocate_arrays(bw_pd_interface *pi)
{
  enum { ROWS = BW_PD_INTERFACE__ROWS };
  /* Everything an update may need, so that none allocates (but for rows of new crack faces). */
  const size_t n = pi->n, slots = (size_t)bw_solid_max_family(pi->pd);
  bw_status st = BW_ALLOCATE(&pi->surface, n);
  BW_THEN(st, BW_ALLOCATE(&pi->first, n));
  BW_THEN(st, BW_ALLOCATE(&pi->wall.outside, n));
  BW_THEN(st, BW_ALLOCATE(&pi->wall.leans, n));
  BW_THEN(st, BW_ALLOCATE(&pi->wall.off, n));
  BW_THEN(st, BW_ALLOCATE(&pi->watch.broken, n));
  BW_THEN(st, BW_ALLOCATE(&pi->watch.fresh, n));
  BW_THEN(st, BW_ALLOCATE(&pi->watch.undecided, n));
  BW_THEN(st, BW_ALLOCATE(&pi->watch.gap, n));
  BW_THEN(st, BW_ALLOCATE(&pi->rows.row, n));
  BW_THEN(st, BW_ALLOCATE(&pi->rows.row_n, n));
  BW_THEN(st, BW_ALLOCATE(&pi->rows.row_room, n));
  BW_THEN(st, BW_ALLOCATE(&pi->rows.stale, n));
  BW_THEN(st, BW_ALLOCATE(&pi->wall.leaning, n));
  /* Surface lists with room for all particles. */
  BW_THEN(st, BW_ALLOCATE(&pi->now.list, n));
  BW_THEN(st, BW_ALLOCATE(&pi->X0, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->normal, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->first_normal, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.position, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.list_normal, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.area, n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.height, n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.smooth, n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.bend, n));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.bend, n));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.side, pi->n_extended));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.lift, n));
  BW_THEN(st, BW_ALLOCATE(&pi->area_first, n));
  BW_THEN(st, BW_ALLOCATE(&pi->sides.open, n));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.own_normal, 3 * n));
  /* Normals of copies too: fits reach across ranks. */
  for (int pass = 0; pass <= BW_PD_INTERFACE__PASSES; pass++)
    BW_THEN(st, BW_ALLOCATE(&pi->fit.told[pass], 3 * pi->n_extended));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.changed, pi->n_extended));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.touched, n));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.border, n));
  BW_THEN(st, BW_ALLOCATE(&pi->fit.borne, 3 * pi->n_extended));
  BW_THEN(st, BW_ALLOCATE(&pi->anchor, 6 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->steps, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->now.lines, n / ROWS + 1));
  if (bw_solid_settings(pi->pd)->disorder > 0)
    BW_THEN(st, BW_ALLOCATE(&pi->now.off_lattice, 9 * (n + ROWS)));
  /* Scratch of the particle that is resolved. */
  BW_THEN(st, BW_ALLOCATE(&pi->seen.link, slots));
  BW_THEN(st, BW_ALLOCATE(&pi->seen.state, slots));
  BW_THEN(st, BW_ALLOCATE(&pi->seen.near, slots));
  BW_THEN(st, BW_ALLOCATE(&pi->seen.place, 3 * slots));
  return st;
}

/* Who is beyond a wall, and whose family reaches there. */
static void place_walls(bw_pd_interface *pi)
{
  const bw_pd_interface_config *c = &pi->config;
  for (size_t h = 0; h < pi->n; h++) {
    const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
    const double reach = s->reach * s->unit, tie = 1e-6 * s->ds;
    for (int d = 0; d < 3; d++)
      for (int side = 0; side < 2; side++) {
        if (!c->walled[d][side]) continue;
        const double x = pi->X0[3 * h + (size_t)d];
        const double height = side ? c->upper[d] - x : x - c->lower[d];
        /* Ghost layers beyond the wall are never surface; who reaches over it leans on it. */
        pi->wall.outside[h] = pi->wall.outside[h] || height < -tie;
        pi->wall.leans[h] = pi->wall.leans[h] || height < reach + tie;
      }
    pi->wall.leans[h] = pi->wall.leans[h] && !pi->wall.outside[h];
    if (pi->wall.leans[h]) pi->wall.leaning[pi->wall.n_leaning++] = (int32_t)h;
  }
}

/* The reference shape: its surface and its area, whatever has broken or moved since, so that a
 * restart finds the same. Collective. */
static void measure_reference(bw_pd_interface *pi)
{
  double total[2] = {0.0, 0.0};
  /* Every particle with all its bonds, whatever has broken since. */
  for (size_t h = 0; h < pi->n; h++) {
    bw_pd_interface__resolve(pi, h, true);
    pi->first[h] = pi->surface[h] = bw_pd_interface__judge(pi, h, NULL);
    if (!pi->wall.outside[h]) total[0] += bw_pd_interface__open_area(pi, h);
  }
  /* Normals 3.45 of that surface, then their fits where it is smooth. */
  bw_pd_interface__renew(pi, true);
  memcpy(pi->first_normal, pi->normal, 3 * pi->n * sizeof *pi->normal);
  bw_pd_interface__settle_normals(pi);
  /* Areas need the final normals: open sides projected on them. */
  for (size_t row = 0; row < pi->now.n_list; row++) {
    const size_t h = (size_t)pi->now.list[row];
    double n[3];
    bw_pd_interface__resolve(pi, h, true);
    const double facing = bw_pd_interface__facing_area(pi, h, &pi->fit.own_normal[3 * h]);
    const bool known = bw_pd_interface__normal_of(pi, h, n); /* else a sheet open on both sides */
    const double side = bw_pd_interface__side_area(pi, h);
    pi->sides.open[h] = (uint8_t)bw_pd_interface__open_sides(pi, h);
    pi->area_first[h] = known ? fmax(facing, 0.25 * side) : side; /* a ridge is a marker, too */
    total[1] += 1.0;
  }
  /* Area of the shape and number of its surface particles, on all ranks. */
  bw_comm_sum(bw_solid_comm(pi->pd), 2, total);
  pi->area_total = total[0];
  /* POROUS's choice: all alike. */
  for (size_t h = 0; pi->config.area == BW_PD_AREA_EQUAL && h < pi->n; h++)
    pi->area_first[h] = total[0] / total[1];
}

static bw_status build(bw_pd_interface *pi)
{
  const int levels = bw_solid_finest(pi->pd) + 1;
  BW_TRY(BW_ALLOCATE(&pi->stencil, (size_t)levels));
  pi->n_stencil = levels;
  for (int l = 0; l < levels; l++)
    BW_TRY(bw_pd_interface__stencil_create(pi->pd, l, &pi->stencil[l]));
  BW_TRY(check_config(&pi->config, pi->stencil->sectors, bw_solid_settings(pi->pd)->disorder));
  if (pi->config.n_empty == 0) pi->config.n_empty = pi->stencil->dims == 2 ? 2 : 1;
  return allocate_arrays(pi);
}

/* All that follows from the set of particles. Collective. */
static bw_status establish(bw_pd_interface *pi)
{
  bw_solid *pd = pi->pd;
  pi->revision = bw_solid_revision(pd);
  pi->n = bw_solid_count(pd);
  pi->n_extended = bw_solid_get_extended(pd).n;
  BW_TRY(bw_comm_agree(bw_solid_comm(pd), build(pi)));
  bw_solid_get_reference(pd, pi->X0);
  place_walls(pi);
  /* The reference shape first, as if nothing had broken ... */
  memset(pi->rows.stale, true, pi->n * sizeof *pi->rows.stale);
  measure_reference(pi);
  BW_TRY(bw_comm_agree(bw_solid_comm(pd), bw_pd_interface__sides_create(pi)));
  /* ... then the present one, which may be that of a restart. */
  memset(pi->rows.stale, true, pi->n * sizeof *pi->rows.stale);
  pi->fresh_start = true;
  return BW_OK;
}

static void release_all(bw_pd_interface *p)
{
  /* May be half built: what was never allocated is NULL. */
  for (int l = 0; l < p->n_stencil; l++)
    bw_pd_interface__stencil_release(&p->stencil[l]);
  bw_release(&p->stencil);
  void **array[] = {(void **)&p->surface,
                    (void **)&p->first,
                    (void **)&p->wall.outside,
                    (void **)&p->wall.leans,
                    (void **)&p->watch.broken,
                    (void **)&p->watch.fresh,
                    (void **)&p->watch.undecided,
                    (void **)&p->watch.gap,
                    (void **)&p->rows.row,
                    (void **)&p->rows.row_n,
                    (void **)&p->rows.row_room,
                    (void **)&p->rows.stale,
                    (void **)&p->seen.near,
                    (void **)&p->now.lines,
                    (void **)&p->anchor,
                    (void **)&p->rows.pool,
                    (void **)&p->wall.leaning,
                    (void **)&p->now.list,
                    (void **)&p->X0,
                    (void **)&p->normal,
                    (void **)&p->first_normal,
                    (void **)&p->now.position,
                    (void **)&p->steps,
                    (void **)&p->now.area,
                    (void **)&p->now.height,
                    (void **)&p->now.smooth,
                    (void **)&p->now.bend,
                    (void **)&p->fit.bend,
                    (void **)&p->fit.side,
                    (void **)&p->fit.lift,
                    (void **)&p->now.list_normal,
                    (void **)&p->seen.link,
                    (void **)&p->seen.state,
                    (void **)&p->seen.place,
                    (void **)&p->wall.off,
                    (void **)&p->area_first,
                    (void **)&p->sides.open,
                    (void **)&p->sides.row,
                    (void **)&p->sides.N,
                    (void **)&p->sides.A,
                    (void **)&p->sides.H,
                    (void **)&p->sides.step,
                    (void **)&p->fit.own_normal,
                    (void **)&p->fit.touched,
                    (void **)&p->fit.border,
                    (void **)&p->fit.changed,
                    (void **)&p->now.off_lattice,
                    (void **)&p->fit.borne};
  for (size_t q = 0; q < sizeof array / sizeof *array; q++)
    bw_release(array[q]);
  for (int pass = 0; pass <= BW_PD_INTERFACE__PASSES; pass++)
    bw_release(&p->fit.told[pass]);
}

bw_status bw_pd_interface__rebuild(bw_pd_interface *pi)
{
  const bw_pd_interface asked = {.pd = pi->pd, .config = pi->config};
  release_all(pi);
  *pi = asked;
  return establish(pi);
}

bw_status bw_pd_interface_create(bw_solid *pd, const bw_pd_interface_config *config,
                                 bw_pd_interface **out)
{
  *out = NULL;
  bw_pd_interface *pi = NULL;
  bw_status st = bw_comm_agree(bw_solid_comm(pd), BW_ALLOCATE(&pi, 1));
  if (st == BW_OK) {
    pi->pd = pd;
    pi->config = *config;
    st = establish(pi);
  }
  if (st != BW_OK) {
    bw_pd_interface_destroy(&pi);
    return st;
  }
  *out = pi;
  return bw_pd_interface_update(pi);
}

void bw_pd_interface_destroy(bw_pd_interface **pi)
{
  if (pi == NULL || *pi == NULL) return;
  release_all(*pi);
  bw_release(pi);
}

bw_pd_surface bw_pd_interface_surface(const bw_pd_interface *pi)
{
  return (bw_pd_surface){.n = pi->now.n_list,
                         .particle = pi->now.list,
                         .X = pi->now.position,
                         .N = pi->now.list_normal,
                         .A = pi->now.area,
                         .H = pi->now.height,
                         .bend = pi->now.bend,
                         .smooth = pi->now.smooth};
}

const bool *bw_pd_interface_is_surface(const bw_pd_interface *pi)
{
  return pi->surface;
}

double bw_pd_interface_reference_area(const bw_pd_interface *pi)
{
  return pi->area_total;
}
