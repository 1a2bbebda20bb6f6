/* Recursive coordinate bisection whose cuts are found by counting over ranks. */
#include "bw_particles_partition.h"
#include "bw_memory.h"
#include "bw_particles_order.h"
#include "particles_key.h"

/* Between the ranks b and b + 1 there is exactly one cut, so cuts are numbered by the rank below.
 * Particles whose key is less than `key` are below it. */
typedef struct {
  int slowest; /* the axis that is cut across; -1: there were no particles to divide */
  uint64_t key;
} cut;

struct bw_particles_partition {
  int parts;
  int64_t total;
  int32_t lower[3]; /* of the box of all sites: keys count from there */
  cut *cuts;        /* (parts - 1) */
  int64_t *count;   /* (parts) particles of each rank */
};

/* Particles that still have to be divided among the ranks first .. first + parts - 1. */
typedef struct {
  int first, parts;
  int64_t n;          /* of all ranks */
  int slowest;        /* axis order of its keys */
  size_t begin, end;  /* its keys on this rank */
  size_t open, close; /* those of them that lie between low and high of the search */
  size_t middle;      /* those of them before it are below the pivot */
  bw_particles__selection s;
} group;

typedef struct {
  const bw_comm *comm;
  bw_particles_partition *p;
  uint64_t *key; /* of this rank's sites, those of a group together */
  int n_group;
  group *groups, *next; /* (parts) of this depth of the tree, and of the next */
  int64_t *shared;      /* (parts,6) numbers that are reduced over ranks */
} work;

/* The axes of a key by the slowest one. */
static const int key_axes[3][3] = {{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};

/* Lower corner and size of the box of all sites. */
static bw_status find_box(const bw_comm *comm, size_t n, const int32_t site[],
                          bw_particles_partition *p)
{
  int32_t lower[3], upper[3];
  int64_t corner[6], total = (int64_t)n;
  bw_particles_extent(n, site, lower, upper);
  /* Lower corners with their sign turned: one reduction by the largest value serves both. A rank
   * without sites has no say. */
  for (int k = 0; k < 3; k++) {
    corner[k] = n > 0 ? -(int64_t)lower[k] : INT64_MIN;
    corner[3 + k] = n > 0 ? (int64_t)upper[k] : INT64_MIN;
  }
  bw_comm_max_int(comm, 6, corner);
  bw_comm_sum_int(comm, 1, &total);
  p->total = total;
  for (int k = 0; k < 3 && total > 0; k++) {
    const int64_t size = corner[3 + k] + corner[k] + 1;
    BW_REQUIRE(size <= BW_PARTICLES_MOST + 1, BW_EINPUT,
               "particles: sites reach over %lld steps in direction %d; the limit is 2^21 = %d: "
               "take a wider spacing, or leave out those that are far away",
               (long long)size, k, BW_PARTICLES_MOST + 1);
    p->lower[k] = (int32_t)-corner[k];
  }
  return BW_OK;
}

/* With z slowest, as the first group's axis order says. */
static void make_keys(const bw_particles_partition *p, size_t n, const int32_t site[],
                      uint64_t key[])
{
  for (size_t q = 0; q < n; q++) {
    int64_t above[3];
    for (size_t k = 0; k < 3; k++)
      above[k] = (int64_t)site[3 * q + k] - p->lower[k];
    key[q] = bw_particles__key(key_axes[2], above);
  }
}

/* Boxes of all groups over all ranks, in shared (n_group,6): the lower corner with its sign turned,
 * so that both corners are largest values. */
static void find_boxes(work *w)
{
  for (int q = 0; q < w->n_group; q++) {
    /* A rank without keys of a group leaves the corners to the others. */
    const group *g = &w->groups[q];
    int64_t *corner = w->shared + 6 * (size_t)q, above[3];
    for (int k = 0; k < 6; k++)
      corner[k] = INT64_MIN;
    for (size_t i = g->begin; i < g->end; i++) {
      bw_particles__unkey(key_axes[g->slowest], w->key[i], above);
      for (int k = 0; k < 3; k++) {
        corner[k] = -above[k] > corner[k] ? -above[k] : corner[k];
        corner[3 + k] = above[k] > corner[3 + k] ? above[k] : corner[3 + k];
      }
    }
  }
  bw_comm_max_int(w->comm, 6 * w->n_group, w->shared);
}

static int longest_axis(const int64_t corner[6])
{
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (corner[3 + k] + corner[k] > corner[3 + axis] + corner[axis]) axis = k;
  return axis;
}

/* Keys of a group with its longest axis slowest, and the search for its cut begun. */
static void begin_search(work *w, group *g, const int64_t corner[6])
{
  const int slowest = longest_axis(corner), *axes = key_axes[slowest];
  const int64_t least[3] = {-corner[0], -corner[1], -corner[2]};
  /* Keys are made anew only where the longest axis is another one than before. */
  int64_t above[3];
  for (size_t i = g->begin; i < g->end && slowest != g->slowest; i++) {
    bw_particles__unkey(key_axes[g->slowest], w->key[i], above);
    w->key[i] = bw_particles__key(axes, above);
  }
  g->slowest = slowest;
  /* All keys of the group are still between the bounds. */
  g->open = g->begin;
  g->close = g->end;
  g->s = bw_particles__select(bw_particles__cut_index(g->n, g->parts / 2, g->parts),
                              bw_particles__key(axes, least), bw_particles__key(axes, corner + 3));
}

/* Exchange keys in begin .. end until those below the pivot come first; returns where they end. */
static size_t divide(uint64_t key[], size_t begin, size_t end, uint64_t pivot)
{
  for (;;) {
    /* Both ends walk towards each other and exchange what is on the wrong side. */
    while (begin < end && key[begin] < pivot)
      begin++;
    while (begin < end && key[end - 1] >= pivot)
      end--;
    if (begin == end) return begin;
    const uint64_t high = key[begin];
    key[begin++] = key[--end];
    key[end] = high;
  }
}

/* Divide this rank's open keys of each group about its pivot; shared[q]: how many of all its keys
 * of group q are below. Returns whether a search goes on. */
static bool count_below(work *w)
{
  bool going = false;
  for (int q = 0; q < w->n_group; q++) {
    group *g = &w->groups[q];
    w->shared[q] = 0;
    if (bw_particles__selected(&g->s)) continue;
    going = true;
    g->middle = divide(w->key, g->open, g->close, bw_particles__pivot(&g->s));
    w->shared[q] = (int64_t)(g->middle - g->begin);
  }
  return going;
}

/* The cuts of all groups. Keys are divided in place, as in quickselect; only those between the
 * bounds of the search are looked at again, so that all rounds together cost a few passes. */
static void search(work *w)
{
  /* The bounds are the same on all ranks, so all leave this loop in the same round. */
  while (count_below(w)) {
    bw_comm_sum_int(w->comm, w->n_group, w->shared);
    for (int q = 0; q < w->n_group; q++) {
      group *g = &w->groups[q];
      if (bw_particles__selected(&g->s)) continue;
      /* Every rank counts the same sums, so that all narrow alike. */
      if (bw_particles__narrow(&g->s, w->shared[q]))
        g->open = g->middle;
      else
        g->close = g->middle;
    }
  }
}

/* A group that one rank shall own, or that is empty, is done; others are divided at the next depth.
 */
static void put_group(work *w, int *n_next, group g)
{
  if (g.parts == 1)
    w->p->count[g.first] = g.n;
  else if (g.n == 0)
    w->p->cuts[g.first + g.parts / 2 - 1].slowest = -1;
  else
    w->next[(*n_next)++] = g;
}

/* Cuts of this depth of the tree are noted, their sides become the groups of the next. */
static void next_depth(work *w)
{
  int n_next = 0;
  for (int q = 0; q < w->n_group; q++) {
    const group *g = &w->groups[q];
    const int left = g->parts / 2;
    group below = *g, above = *g;
    w->p->cuts[g->first + left - 1] = (cut){g->slowest, g->s.low};
    /* Keys from `open` on are not below the cut. Without two particles on a site s.below is what
     * the search was for. */
    below.parts = left;
    below.n = g->s.below;
    below.end = g->open;
    above.first += left;
    above.parts -= left;
    above.n -= g->s.below;
    above.begin = g->open;
    put_group(w, &n_next, below);
    put_group(w, &n_next, above);
  }
  group *done = w->groups;
  w->groups = w->next;
  w->next = done;
  w->n_group = n_next;
}

static void bisect(work *w, size_t n)
{
  int n_next = 0;
  /* All particles are one group of all ranks; each depth of the tree halves the groups' ranks. */
  const group all = {.parts = w->p->parts, .slowest = 2, .n = w->p->total, .end = n};
  put_group(w, &n_next, all);
  group *first = w->next;
  w->next = w->groups;
  w->groups = first;
  for (w->n_group = n_next; w->n_group > 0; next_depth(w)) {
    find_boxes(w);
    for (int q = 0; q < w->n_group; q++)
      begin_search(w, &w->groups[q], w->shared + 6 * (size_t)q);
    search(w);
  }
}

static bw_status allocate(work *w, size_t n)
{
  const size_t parts = (size_t)w->p->parts;
  BW_TRY(BW_ALLOCATE(&w->p->cuts, parts - 1));
  BW_TRY(BW_ALLOCATE(&w->p->count, parts));
  BW_TRY(BW_ALLOCATE(&w->key, n));
  BW_TRY(BW_ALLOCATE(&w->groups, parts));
  BW_TRY(BW_ALLOCATE(&w->next, parts));
  return BW_ALLOCATE(&w->shared, 6 * parts);
}

static bw_status partition(bw_particles_partition *p, const bw_comm *comm, size_t n,
                           const int32_t site[])
{
  /* Room first: nothing that follows can fail on one rank alone. */
  work w = {.comm = comm, .p = p};
  p->parts = bw_comm_size(comm);
  bw_status st = bw_comm_agree(comm, allocate(&w, n));
  if (st == BW_OK) st = find_box(comm, n, site, p); /* the same on all ranks */
  if (st == BW_OK) {
    make_keys(p, n, site, w.key);
    bisect(&w, n);
  }
  bw_release(&w.key);
  bw_release(&w.groups);
  bw_release(&w.next);
  bw_release(&w.shared);
  return st;
}

bw_status bw_particles_partition_create(const bw_comm *comm, size_t n, const int32_t site[],
                                        bw_particles_partition **out)
{
  bw_particles_partition *p = NULL;
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&p, 1));
  if (st == BW_OK) st = partition(p, comm, n, site);
  if (st != BW_OK) bw_particles_partition_destroy(&p);
  *out = p;
  return st;
}

void bw_particles_partition_destroy(bw_particles_partition **partition_)
{
  if (*partition_ == NULL) return;
  bw_release(&(*partition_)->cuts);
  bw_release(&(*partition_)->count);
  bw_release(partition_);
}

int bw_particles_partition_owner(const bw_particles_partition *p, const int32_t site[3])
{
  /* Places beyond the box belong to whoever owns its border. */
  int64_t above[3];
  for (int k = 0; k < 3; k++) {
    const int64_t a = (int64_t)site[k] - p->lower[k];
    above[k] = a < 0 ? 0 : a > BW_PARTICLES_MOST ? BW_PARTICLES_MOST : a;
  }
  /* Down the tree: each cut halves the ranks in question. */
  int first = 0;
  for (int parts = p->parts, left = parts / 2; parts > 1; left = parts / 2) {
    const cut *c = &p->cuts[first + left - 1];
    if (c->slowest < 0) break;
    if (bw_particles__key(key_axes[c->slowest], above) < c->key) {
      parts = left;
    } else {
      first += left;
      parts -= left;
    }
  }
  return first;
}

int64_t bw_particles_partition_count(const bw_particles_partition *p, int rank)
{
  return p->count[rank];
}

int64_t bw_particles_partition_total(const bw_particles_partition *p)
{
  return p->total;
}
