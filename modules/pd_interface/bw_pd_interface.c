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

static bw_status check_config(const bw_pd_interface_config *c, int sectors)
{
  BW_REQUIRE(isfinite(c->threshold) && c->threshold > 0.0, BW_EINPUT,
             "interface: threshold = %g has to be positive (1 is the horizon)", c->threshold);
  BW_REQUIRE(c->area == BW_PD_AREA_OPEN_SIDES || c->area == BW_PD_AREA_EQUAL, BW_EINPUT,
             "interface: area = %d is neither open sides nor equal", (int)c->area);
  BW_REQUIRE(c->n_empty >= 0 && c->n_empty <= sectors, BW_EINPUT,
             "interface: n_empty = %d has to be 1 to %d, or 0 for the default", c->n_empty,
             sectors);
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
  const size_t n = pi->n, slots = (size_t)pi->stencil.slots;
  bw_status st = BW_ALLOCATE(&pi->surface, n);
  BW_THEN(st, BW_ALLOCATE(&pi->first, n));
  BW_THEN(st, BW_ALLOCATE(&pi->outside, n));
  BW_THEN(st, BW_ALLOCATE(&pi->leans, n));
  BW_THEN(st, BW_ALLOCATE(&pi->off, n));
  BW_THEN(st, BW_ALLOCATE(&pi->damaged, n));
  BW_THEN(st, BW_ALLOCATE(&pi->leaning, n));
  BW_THEN(st, BW_ALLOCATE(&pi->list, n));
  BW_THEN(st, BW_ALLOCATE(&pi->X0, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->normal, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->position, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->velocity, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->all_velocity, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->list_normal, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&pi->area, n));
  BW_THEN(st, BW_ALLOCATE(&pi->area_first, n));
  BW_THEN(st, BW_ALLOCATE(&pi->own_normal, pi->config.smooth_normals ? 3 * n : 0));
  BW_THEN(st, BW_ALLOCATE(&pi->all_normal, pi->config.smooth_normals ? 3 * pi->n_extended : 0));
  BW_THEN(st, BW_ALLOCATE(&pi->link, slots));
  BW_THEN(st, BW_ALLOCATE(&pi->state, slots));
  BW_THEN(st, BW_ALLOCATE(&pi->place, 3 * slots));
  return st;
}

/* Who is beyond a wall, and whose family reaches there. */
static void place_walls(bw_pd_interface *pi)
{
  const bw_pd_interface_config *c = &pi->config;
  const double reach = pi->stencil.reach * pi->stencil.ds, tie = 1e-6 * pi->stencil.ds;
  for (size_t h = 0; h < pi->n; h++) {
    for (int d = 0; d < 3; d++)
      for (int side = 0; side < 2; side++) {
        if (!c->walled[d][side]) continue;
        const double x = pi->X0[3 * h + (size_t)d];
        const double height = side ? c->upper[d] - x : x - c->lower[d];
        pi->outside[h] = pi->outside[h] || height < -tie;
        pi->leans[h] = pi->leans[h] || height < reach + tie;
      }
    pi->leans[h] = pi->leans[h] && !pi->outside[h];
    if (pi->leans[h]) pi->leaning[pi->n_leaning++] = (int32_t)h;
  }
}

/* A stand-in where the neighbours balance: the middle of the lowest group of empty sectors (one
 * of the sides of a sheet), or of the lowest one when they surround the particle. */
static void guess_normal(const bw_pd_interface__stencil *s, uint32_t empty, double n[3])
{
  const uint32_t group = bw_pd_interface__group(s, empty);
  double sum[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  int lowest = -1;
  for (int k = 0; k < s->sectors; k++) {
    if (!(group >> (unsigned)k & 1u)) continue;
    if (lowest < 0) lowest = k;
    for (int d = 0; d < 3; d++)
      sum[d] += s->direction[k][d];
  }
  for (int d = 0; d < 3; d++)
    squared += sum[d] * sum[d];
  for (int d = 0; d < 3; d++)
    n[d] = squared > 1e-6 ? sum[d] / sqrt(squared) : s->direction[lowest][d];
}

/* Surface or not, of the particle resolved last (h); renews the normal of those that are. */
static bool judge(bw_pd_interface *pi, size_t h)
{
  const bw_pd_interface__stencil *s = &pi->stencil;
  const uint32_t empty = bw_pd_interface__empty_sectors(pi);
  if (pi->outside[h] || !bw_pd_interface__is_open(s, empty, pi->config.n_empty)) return false;
  double *n = &pi->normal[3 * h];
  const bool known = n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0;
  if (!bw_pd_interface__normal(pi, n) && !known) guess_normal(s, empty, n);
  return true;
}

/* The reference shape: its surface and its area, whatever has broken or moved since, so that a
 * restart finds the same. Collective. */
static void measure_reference(bw_pd_interface *pi)
{
  const bw_pd_bond_config *c = bw_pd_bond_settings(pi->pd);
  const double ds = c->ds;
  pi->area_new = pi->stencil.dims == 2 ? ds * c->thickness : ds * ds;
  const double least = 0.25 * pi->area_new; /* ridges of one particle still are markers */
  double total[2] = {0.0, 0.0};
  for (size_t h = 0; h < pi->n; h++) {
    bw_pd_interface__resolve(pi, h, NULL);
    pi->first[h] = judge(pi, h);
    pi->surface[h] = pi->first[h];
    if (pi->outside[h]) continue;
    total[0] += bw_pd_interface__open_area(pi);
    if (!pi->first[h]) continue;
    double n[3] = {0.0, 0.0, 0.0};
    const bool known = bw_pd_interface__normal(pi, n); /* a sheet open on both sides: one of them */
    pi->area_first[h] = known ? fmax(bw_pd_interface__facing_area(pi, n), least) : pi->area_new;
    total[1] += 1.0;
  }
  bw_comm_sum(bw_pd_bond_comm(pi->pd), 2, total);
  pi->area_total = total[0];
  for (size_t h = 0; pi->config.area == BW_PD_AREA_EQUAL && h < pi->n; h++)
    pi->area_first[h] = total[0] / total[1];
}

/* Own particles with a broken bond, anew. */
static void list_damaged(bw_pd_interface *pi)
{
  pi->events = bw_pd_bond_events(pi->pd);
  pi->n_damaged = 0;
  for (size_t h = 0; h < pi->n; h++) {
    const int family = bw_pd_bond_links(pi->pd, h, pi->link);
    bool all = true;
    for (int q = 0; q < family; q++)
      all = all && pi->link[q].intact;
    if (!all) pi->damaged[pi->n_damaged++] = (int32_t)h;
  }
}

static bw_status build(bw_pd_interface *pi)
{
  BW_TRY(bw_pd_interface__stencil_create(pi->pd, &pi->stencil));
  BW_TRY(check_config(&pi->config, pi->stencil.sectors));
  if (pi->config.n_empty == 0) pi->config.n_empty = pi->stencil.dims == 2 ? 2 : 1;
  pi->opening = pi->config.threshold * bw_pd_bond_horizon(pi->pd);
  return allocate_arrays(pi);
}

bw_status bw_pd_interface_create(bw_pd_bond *pd, const bw_pd_interface_config *config,
                                 bw_pd_interface **out)
{
  *out = NULL;
  bw_pd_interface *pi = NULL;
  bw_status st = bw_comm_agree(bw_pd_bond_comm(pd), BW_ALLOCATE(&pi, 1));
  if (st == BW_OK) {
    pi->pd = pd;
    pi->config = *config;
    pi->n = bw_pd_bond_count(pd);
    pi->n_extended = bw_pd_bond_get_extended(pd).n;
    st = build(pi);
  }
  st = bw_comm_agree(bw_pd_bond_comm(pd), st);
  if (st != BW_OK) {
    bw_pd_interface_destroy(&pi);
    return st;
  }
  bw_pd_bond_get_reference(pd, pi->X0);
  place_walls(pi);
  measure_reference(pi);
  list_damaged(pi);
  *out = pi;
  return bw_pd_interface_update(pi);
}

void bw_pd_interface_destroy(bw_pd_interface **pi)
{
  if (pi == NULL || *pi == NULL) return;
  bw_pd_interface *p = *pi;
  bw_pd_interface__stencil_release(&p->stencil);
  void **array[] = {(void **)&p->surface,    (void **)&p->first,       (void **)&p->outside,
                    (void **)&p->leans,      (void **)&p->damaged,     (void **)&p->leaning,
                    (void **)&p->list,       (void **)&p->X0,          (void **)&p->normal,
                    (void **)&p->position,   (void **)&p->velocity,    (void **)&p->all_velocity,
                    (void **)&p->area,       (void **)&p->list_normal, (void **)&p->link,
                    (void **)&p->state,      (void **)&p->place,       (void **)&p->off,
                    (void **)&p->area_first, (void **)&p->own_normal,  (void **)&p->all_normal};
  for (size_t q = 0; q < sizeof array / sizeof *array; q++)
    bw_release(array[q]);
  bw_release(pi);
}

/* The rows of particle h at the end of the list; its normal is of the particle resolved last. */
static void append(bw_pd_interface *pi, size_t h, const bw_real *X)
{
  const size_t row = pi->n_list++;
  pi->list[row] = (int32_t)h;
  pi->area[row] = pi->first[h] ? pi->area_first[h] : pi->area_new;
  for (size_t d = 0; d < 3; d++) {
    pi->position[3 * row + d] = (double)X[3 * h + d];
    pi->velocity[3 * row + d] = pi->all_velocity[3 * h + d];
    pi->list_normal[3 * row + d] = pi->normal[3 * h + d];
  }
}

/* Only where something can have changed: broken bonds, and walls that were left or met again. */
static void follow_openings(bw_pd_interface *pi, const bw_real *X)
{
  for (size_t q = 0; q < pi->n_damaged; q++) {
    const size_t h = (size_t)pi->damaged[q];
    bw_pd_interface__resolve(pi, h, X);
    pi->surface[h] = judge(pi, h);
  }
  for (size_t q = 0; q < pi->n_leaning; q++) {
    const size_t h = (size_t)pi->leaning[q];
    const bool off = bw_pd_interface__moved_off(pi, h, X);
    if (off == pi->off[h]) continue;
    pi->off[h] = off;
    bw_pd_interface__resolve(pi, h, X);
    pi->surface[h] = judge(pi, h);
  }
}

/* Mean of the normals of the surface particles a surface particle has intact bonds with. Those
 * on the other side of a sheet or an edge look elsewhere (more than 60 degrees) and stay out.
 * Collective. */
static void smooth(bw_pd_interface *pi)
{
  memset(pi->own_normal, 0, 3 * pi->n * sizeof *pi->own_normal);
  for (size_t row = 0; row < pi->n_list; row++)
    memcpy(&pi->own_normal[3 * pi->list[row]], &pi->list_normal[3 * row], 3 * sizeof(double));
  bw_pd_bond_fill_extended(pi->pd, 3 * sizeof(double), pi->own_normal, pi->all_normal);
  for (size_t row = 0; row < pi->n_list; row++) {
    const size_t h = (size_t)pi->list[row];
    const double *mine = &pi->all_normal[3 * h];
    double sum[3] = {mine[0], mine[1], mine[2]}, squared = 0.0;
    const int family = bw_pd_bond_links(pi->pd, h, pi->link);
    for (int q = 0; q < family; q++) {
      const double *n = &pi->all_normal[3 * (size_t)pi->link[q].neighbour];
      const double cosine = mine[0] * n[0] + mine[1] * n[1] + mine[2] * n[2];
      if (!pi->link[q].intact || !(cosine > 0.5)) continue;
      for (int d = 0; d < 3; d++)
        sum[d] += n[d];
    }
    for (int d = 0; d < 3; d++)
      squared += sum[d] * sum[d];
    for (size_t d = 0; d < 3; d++)
      pi->list_normal[3 * row + d] = sum[d] / sqrt(squared);
  }
}

bw_status bw_pd_interface_update(bw_pd_interface *pi)
{
  const bw_pd_bond_extended all = bw_pd_bond_get_extended(pi->pd);
  bw_pd_bond_get_velocity(pi->pd, pi->all_velocity);
  if (bw_pd_bond_events(pi->pd) != pi->events) list_damaged(pi);
  follow_openings(pi, all.X);
  pi->n_list = 0;
  for (size_t h = 0; h < pi->n; h++) {
    if (!pi->surface[h]) continue;
    bw_pd_interface__resolve(pi, h, all.X);
    (void)bw_pd_interface__normal(pi, &pi->normal[3 * h]); /* the last one where it balances */
    append(pi, h, all.X);
  }
  if (pi->config.smooth_normals) smooth(pi);
  return BW_OK;
}

bw_pd_surface bw_pd_interface_surface(const bw_pd_interface *pi)
{
  return (bw_pd_surface){.n = pi->n_list,
                         .particle = pi->list,
                         .X = pi->position,
                         .V = pi->velocity,
                         .N = pi->list_normal,
                         .A = pi->area};
}

const bool *bw_pd_interface_is_surface(const bw_pd_interface *pi)
{
  return pi->surface;
}

double bw_pd_interface_reference_area(const bw_pd_interface *pi)
{
  return pi->area_total;
}
