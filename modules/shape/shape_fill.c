/* The sites of a lattice that are inside a body, part by part. */
#include "bw_comm.h"
#include "bw_memory.h"
#include "shape_internal.h"

#include <math.h>
#include <string.h>

typedef bw_shape__region region;

/* Rows of a region: first <= number < first + count. */
typedef struct {
  int64_t first, count;
} row_range;

static void centre_of(const region *g, const int64_t at[3], double x[3])
{
  if (!g->turned) {
    for (int d = 0; d < g->dims; d++)
      x[d] = g->origin[d] + ((double)at[d] + 0.5) * g->ds;
    return;
  }
  for (int d = 0; d < g->dims; d++) {
    x[d] = g->origin[d];
    for (int a = 0; a < g->dims; a++)
      x[d] += ((double)at[a] + 0.5) * g->ds * g->axes[a][d];
  }
}

/* ---- evaluation ---- */

/* Endless shapes end with the space of the others; along x, y, z the range of sites says so. */
static bool beyond(const region *g, const double x[3])
{
  bool out = false;
  for (int d = 0; d < g->dims; d++) {
    const double tie = BW_SHAPE__TIE * g->ds;
    out = out || x[d] < g->space.lower[d] - tie || x[d] >= g->space.upper[d] - tie;
  }
  return out;
}

/* The shape that decides about x, or NULL where nothing is: the last one that holds it. */
static const bw_shape *decides(const region *g, double tie, const double x[3])
{
  const bw_shape *last = NULL;
  double y[3];
  for (int q = 0; q < g->count; q++) {
    const bw_shape *s = &g->shape[q];
    if (s->remove && last == NULL) continue; /* nothing there to take away */
    const bool in = bw_shape__rows[s->kind].inside(s, g->dims, tie, bw_shape__own(s, x, y));
    if (in != s->outside) last = s->remove ? NULL : s;
  }
  return last;
}

/* Where sites are written; `site` NULL: they are counted only. */
typedef struct {
  int64_t n;
  int32_t *site;
  uint8_t *kind, *group;
} site_list;

static void put(site_list *list, const int64_t at[3], const bw_shape *s)
{
  if (list->site != NULL) {
    for (int d = 0; d < 3; d++)
      list->site[3 * list->n + d] = (int32_t)at[d];
    list->kind[list->n] = s->particle_kind;
    if (list->group != NULL) list->group[list->n] = s->particle_group;
  }
  list->n++;
}

static void scan_row(const region *g, int64_t row, site_list *list)
{
  const int64_t across = g->hi[1] - g->lo[1];
  int64_t at[3] = {0, g->lo[1] + row % across, g->lo[2] + row / across};
  double x[3] = {0.0, 0.0, 0.0};
  for (at[0] = g->lo[0]; at[0] < g->hi[0]; at[0]++) {
    centre_of(g, at, x);
    if (g->turned && beyond(g, x)) continue;
    const bw_shape *s = decides(g, BW_SHAPE__TIE * g->ds, x);
    if (s != NULL) put(list, at, s);
  }
}

static int64_t scan(const region *g, row_range rows, site_list *list)
{
  list->n = 0;
  for (int64_t q = 0; q < rows.count; q++)
    scan_row(g, rows.first + q, list);
  return list->n;
}

/* Open masks read the layers that these rows meet: those between the corners of the rows' box. */
static bw_status hold_masks(const region *g, row_range rows)
{
  if (rows.count == 0 || g->hi[0] == g->lo[0]) return BW_OK;
  const int64_t across = g->hi[1] - g->lo[1];
  const int64_t k[2] = {rows.first / across, (rows.first + rows.count - 1) / across};
  int64_t box[2][3] = {{g->lo[0], g->lo[1], g->lo[2] + k[0]},
                       {g->hi[0] - 1, g->hi[1] - 1, g->lo[2] + k[1]}};
  /* Within one layer of sites the rows need only their own piece of it. */
  if (k[0] == k[1]) {
    box[0][1] = g->lo[1] + rows.first % across;
    box[1][1] = box[0][1] + rows.count - 1;
  }
  for (int q = 0; q < g->count; q++) {
    const bw_shape *s = &g->shape[q];
    if (s->kind != BW_SHAPE_MASK || s->mask->source == NULL) continue;
    /* Depth in the mask is linear in the place, so that corners bound it, turned or not. */
    double least = INFINITY, most = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
      const int64_t at[3] = {box[corner & 1][0], box[corner >> 1 & 1][1], box[corner >> 2][2]};
      double x[3] = {0.0, 0.0, 0.0}, y[3];
      centre_of(g, at, x);
      const double z = bw_shape__own(s, x, y)[2];
      least = fmin(least, (z - s->mask->lower[2]) / s->mask->spacing[2]);
      most = fmax(most, (z - s->mask->lower[2]) / s->mask->spacing[2]);
    }
    if (g->dims == 2) least = most = 0.0;
    /* A centre near the face of two layers may round into either. */
    const double size = (double)s->mask->size[2];
    const int64_t from = (int64_t)fmin(fmax(floor(least - 1e-6), 0.0), size);
    const int64_t to = (int64_t)fmin(fmax(floor(most + 1e-6) + 1.0, 0.0), size);
    BW_TRY(bw_shape_mask_hold(s->mask, from, to > from ? to - from : 0));
  }
  return BW_OK;
}

static bw_status no_site(double ds)
{
  return BW_FAIL(BW_EINPUT,
                 "shapes: no site of spacing %g is inside the body; it is thinner than ds or all "
                 "of it was removed",
                 ds);
}

static bw_status rows_of_part(const region *g, int part, int parts, row_range *rows)
{
  BW_REQUIRE(parts > 0 && part >= 0 && part < parts, BW_EINPUT,
             "shapes: there is no part %d of %d; parts are 0 .. parts-1", part, parts);
  bw_shape_part(g->lo, g->hi, part, parts, &rows->first, &rows->count);
  return BW_OK;
}

bw_status bw_shape_count(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                         int part, int parts, int64_t *n)
{
  region g;
  row_range rows;
  site_list counted = {0};
  *n = 0;
  BW_TRY(bw_shape__region_make(count, shape, lattice, &g));
  BW_TRY(rows_of_part(&g, part, parts, &rows));
  BW_TRY(hold_masks(&g, rows));
  *n = scan(&g, rows, &counted);
  return parts == 1 && *n == 0 ? no_site(g.ds) : BW_OK;
}

/* Room for `found` sites, then the sites. */
static bw_status write_rows(const region *g, row_range rows, int64_t found, bool grouped,
                            site_list *list)
{
  bw_status st = BW_ALLOCATE(&list->site, 3 * (size_t)found);
  BW_THEN(st, BW_ALLOCATE(&list->kind, (size_t)found));
  if (grouped) BW_THEN(st, BW_ALLOCATE(&list->group, (size_t)found));
  if (st == BW_OK) scan(g, rows, list);
  return st;
}

/* A list to the caller, or nothing after a failure. */
static bw_status hand_over(bw_status st, site_list *list, int64_t *n, int32_t **site,
                           uint8_t **kind, uint8_t **group)
{
  if (st != BW_OK) {
    bw_release(&list->site);
    bw_release(&list->kind);
    bw_release(&list->group);
    list->n = 0;
  }
  *n = list->n;
  *site = list->site;
  *kind = list->kind;
  if (group != NULL) *group = list->group;
  return st;
}

bw_status bw_shape_fill(int count, const bw_shape shape[], const bw_shape_lattice *lattice,
                        int part, int parts, int64_t *n, int32_t **site, uint8_t **kind,
                        uint8_t **group)
{
  region g;
  row_range rows = {0};
  site_list list = {0};
  bw_status st = bw_shape__region_make(count, shape, lattice, &g);
  BW_THEN(st, rows_of_part(&g, part, parts, &rows));
  BW_THEN(st, hold_masks(&g, rows));
  /* Counted first, so that the list has exactly the room that it needs. */
  const int64_t found = st == BW_OK ? scan(&g, rows, &list) : 0;
  if (st == BW_OK && found == 0 && parts == 1) st = no_site(g.ds);
  BW_THEN(st, write_rows(&g, rows, found, group != NULL, &list));
  return hand_over(st, &list, n, site, kind, group);
}

/* ---- over ranks ---- */

/* Sites in each of these rows: inside (rows). */
static int64_t count_rows(const region *g, row_range rows, uint32_t inside[])
{
  int64_t all = 0;
  for (int64_t q = 0; q < rows.count; q++) {
    site_list one = {0};
    scan_row(g, rows.first + q, &one);
    inside[q] = (uint32_t)one.n;
    all += one.n;
  }
  return all;
}

/* First rows of all parts, cut (parts + 1): part r begins where r of `parts` equal shares of all
 * particles lie before it. Every cut is seen by the one rank that counted its row. Collective. */
static void cut_evenly(const bw_comm *comm, row_range rows, const uint32_t inside[], int64_t mine,
                       int64_t all, int64_t cut[])
{
  const int parts = bw_comm_size(comm);
  int64_t before = bw_comm_prefix_sum(comm, mine);
  int next = 1;
  for (int64_t q = 0; q < rows.count; q++) {
    for (; next < parts; next++) {
      const int64_t share = all / parts * next + all % parts * next / parts;
      if (share >= before + inside[q]) break; /* cut in a later row, or by a later rank */
      /* A rank with the shares of lower ranks still before it leaves those to them. */
      if (share >= before) cut[next] = rows.first + q;
    }
    before += inside[q];
  }
  bw_comm_max_int(comm, parts + 1, cut);
}

/* Count an even part of the rows, agree where to cut, and take this rank's own rows. Collective. */
static bw_status share_rows(const bw_comm *comm, const region *g, row_range *mine)
{
  const int rank = bw_comm_rank(comm), size = bw_comm_size(comm);
  row_range rows = {0};
  uint32_t *inside = NULL;
  int64_t *cut = NULL;
  bw_status st = rows_of_part(g, rank, size, &rows);
  BW_THEN(st, hold_masks(g, rows));
  BW_THEN(st, BW_ALLOCATE(&inside, (size_t)rows.count));
  BW_THEN(st, BW_ALLOCATE(&cut, (size_t)size + 1));
  st = bw_comm_agree(comm, st);
  int64_t all = 0;
  /* From here on the ranks go on together, or not at all. */
  if (st == BW_OK) {
    const int64_t counted = all = count_rows(g, rows, inside);
    bw_comm_sum_int(comm, 1, &all);
    cut[size] = (g->hi[1] - g->lo[1]) * (g->hi[2] - g->lo[2]);
    cut_evenly(comm, rows, inside, counted, all, cut);
    *mine = (row_range){cut[rank], cut[rank + 1] - cut[rank]};
  }
  if (st == BW_OK && all == 0) st = no_site(g->ds);
  bw_release(&inside);
  bw_release(&cut);
  return st;
}

bw_status bw_shape_fill_shared(const bw_comm *comm, int count, const bw_shape shape[],
                               const bw_shape_lattice *lattice, int64_t *n, int32_t **site,
                               uint8_t **kind, uint8_t **group)
{
  region g;
  row_range rows = {0};
  site_list list = {0};
  bw_status st = bw_comm_agree(comm, bw_shape__region_make(count, shape, lattice, &g));
  BW_THEN(st, share_rows(comm, &g, &rows));
  if (st == BW_OK) {
    /* All ranks come here or none: share_rows ends alike everywhere. */
    st = hold_masks(&g, rows);
    if (st == BW_OK) scan(&g, rows, &list);
    BW_THEN(st, write_rows(&g, rows, list.n, group != NULL, &list));
    st = bw_comm_agree(comm, st);
  }
  return hand_over(st, &list, n, site, kind, group);
}
