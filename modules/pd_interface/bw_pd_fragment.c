/* Pieces connected by intact bonds, across ranks and periodic directions.
 *
 * Each rank joins its own particles (union-find), then labels travel through the copies until
 * none changes: as many exchanges as a piece crosses borders of ranks. Beside the label goes the
 * image a particle is in: the multiple of the periods that brings it to the piece's own place. */
#include "bw_memory.h"
#include "pd_fragment_internal.h"
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

typedef bw_pd_fragment__tag tag;

typedef struct {
  int32_t own, copy;
  int32_t image[3]; /* copy's place = its owner's X + image period */
} cross_bond;

typedef struct {
  bw_solid *pd;
  bool broken; /* do bonds join that do not hold? */
  size_t n, n_all, n_cross;
  double period[3];
  int32_t *parent; /* (n) */
  tag *own, *all;  /* (n) and (n_all) */
  tag *of_root;    /* (n) rows of roots */
  cross_bond *cross;
  double *X, *V, *all_X; /* (n,3), (n,3), (n_all,3) not shifted */
  double *weight;        /* (n) mass over that of a particle of the first group and of level 0 */
} joiner;

static int32_t root_of(int32_t parent[], int32_t h)
{
  while (parent[h] != h) {
    parent[h] = parent[parent[h]];
    h = parent[h];
  }
  return h;
}

/* Union of own particles; the root is the lowest index. Bonds to copies are listed. */
static bw_status join_own(joiner *j)
{
  bw_pd_link *link = NULL;
  BW_TRY(BW_ALLOCATE(&link, (size_t)bw_solid_max_family(j->pd)));
  /* Bonds within the rank join at once; those to copies wait until the others have joined
   * theirs. */
  for (int pass = 0; pass < 2; pass++) { /* count the bonds to copies, then list them */
    size_t found = 0;
    for (size_t h = 0; h < j->n; h++) {
      const int family = bw_solid_links(j->pd, h, link);
      for (int q = 0; q < family; q++) {
        if (!link[q].intact && !j->broken) continue;
        if ((size_t)link[q].neighbour >= j->n) {
          if (pass == 1)
            j->cross[found] = (cross_bond){.own = (int32_t)h, .copy = link[q].neighbour};
          found++;
        } else if (pass == 0) {
          /* The lower one stays: a root is its piece's first particle, in whatever order. */
          const int32_t a = root_of(j->parent, (int32_t)h),
                        b = root_of(j->parent, link[q].neighbour);
          j->parent[a > b ? a : b] = a > b ? b : a;
        }
      }
    }
    if (pass == 1) break;
    j->n_cross = found;
    const bw_status st = BW_ALLOCATE(&j->cross, found);
    if (st != BW_OK) {
      bw_release(&link);
      return st;
    }
  }
  bw_release(&link);
  return BW_OK;
}

/* Images of the copies, from where they act and where their owners have them. Collective. */
static void find_images(joiner *j, const bw_real *acting)
{
  bw_solid_fill_extended(j->pd, 3 * sizeof(double), j->X, j->all_X);
  for (size_t q = 0; q < j->n_cross; q++)
    for (size_t d = 0; d < 3; d++) {
      const size_t at = 3 * (size_t)j->cross[q].copy + d;
      if (j->period[d] > 0.0)
        j->cross[q].image[d] = (int32_t)lround(((double)acting[at] - j->all_X[at]) / j->period[d]);
    }
}

/* Send labels through the copies until none changes. Own particles of one root share a place
 * (they are joined directly), so that a root has one image. Collective. */
static void spread_labels(joiner *j, const int64_t id[])
{
  for (size_t h = 0; h < j->n; h++)
    j->of_root[h] = (tag){.label = INT64_MAX, .rank = bw_comm_rank(bw_solid_comm(j->pd))};
  for (size_t h = 0; h < j->n; h++) {
    tag *t = &j->of_root[root_of(j->parent, (int32_t)h)];
    if (id[h] < t->label) t->label = id[h];
  }
  int64_t changed = 1;
  while (changed != 0) {
    changed = 0;
    for (size_t h = 0; h < j->n; h++)
      j->own[h] = j->of_root[root_of(j->parent, (int32_t)h)];
    bw_solid_fill_extended(j->pd, sizeof(tag), j->own, j->all);
    for (size_t q = 0; q < j->n_cross; q++) {
      const cross_bond *c = &j->cross[q];
      tag *mine = &j->of_root[root_of(j->parent, c->own)];
      const tag *theirs = &j->all[c->copy];
      if (theirs->label >= mine->label) continue;
      mine->label = theirs->label;
      mine->rank = theirs->rank;
      for (int d = 0; d < 3; d++)
        mine->image[d] = theirs->image[d] - c->image[d];
      changed = 1;
    }
    bw_comm_max_int(bw_solid_comm(j->pd), 1, &changed);
  }
}

static bw_status prepare(joiner *j)
{
  BW_TRY(BW_ALLOCATE(&j->parent, j->n));
  BW_TRY(BW_ALLOCATE(&j->own, j->n));
  BW_TRY(BW_ALLOCATE(&j->of_root, j->n));
  BW_TRY(BW_ALLOCATE(&j->all, j->n_all));
  BW_TRY(BW_ALLOCATE(&j->X, 3 * j->n));
  BW_TRY(BW_ALLOCATE(&j->V, 3 * j->n));
  BW_TRY(BW_ALLOCATE(&j->all_X, 3 * j->n_all));
  BW_TRY(BW_ALLOCATE(&j->weight, j->n));
  for (size_t h = 0; h < j->n; h++)
    j->weight[h] = bw_solid_density(j->pd, h) / bw_solid_settings(j->pd)->rho *
                   (bw_solid_volume_of(j->pd, h) / bw_solid_volume(j->pd));
  for (size_t h = 0; h < j->n; h++)
    j->parent[h] = (int32_t)h;
  return join_own(j);
}

static void forget(joiner *j)
{
  bw_release(&j->parent);
  bw_release(&j->own);
  bw_release(&j->of_root);
  bw_release(&j->all);
  bw_release(&j->cross);
  bw_release(&j->X);
  bw_release(&j->V);
  bw_release(&j->all_X);
  bw_release(&j->weight);
}

static bw_status measure(joiner *j, bw_pd_fragments *out)
{
  bw_pd_fragment__particles p = {.comm = bw_solid_comm(j->pd),
                                 .n = j->n,
                                 .tag = j->own,
                                 .parent = j->parent,
                                 .X = j->X,
                                 .V = j->V,
                                 .weight = j->weight,
                                 .mass = bw_solid_settings(j->pd)->rho * bw_solid_volume(j->pd)};
  memcpy(p.period, j->period, sizeof p.period);
  BW_TRY(bw_pd_fragment__measure(&p, out));
  bw_pd_fragment__find_largest(p.comm, out);
  return BW_OK;
}

/* Labels and measures, each where it is asked for. */
static bw_status find(bw_pd_interface *pi, bool broken, int64_t label[], bw_pd_fragments *out)
{
  const bw_pd_extended all = bw_solid_get_extended(pi->pd);
  joiner j = {.pd = pi->pd, .broken = broken, .n = bw_solid_count(pi->pd), .n_all = all.n};
  memcpy(j.period, bw_solid_settings(pi->pd)->period, sizeof j.period);
  bw_status st = bw_comm_agree(bw_solid_comm(pi->pd), prepare(&j));
  if (st == BW_OK) {
    bw_solid_get_position(pi->pd, j.X);
    bw_solid_get_velocity(pi->pd, j.V);
    find_images(&j, all.X);
    spread_labels(&j, bw_solid_id(pi->pd));
    for (size_t h = 0; label != NULL && h < j.n; h++)
      label[h] = j.own[h].label;
    if (out != NULL) st = measure(&j, out);
  }
  forget(&j);
  return st;
}

bw_status bw_pd_interface_fragments(bw_pd_interface *pi, int64_t label[], bw_pd_fragments *out)
{
  if (out != NULL) *out = (bw_pd_fragments){0};
  return find(pi, false, label, out);
}

bw_status bw_pd_interface_bodies(bw_pd_interface *pi, int64_t label[])
{
  return find(pi, true, label, NULL);
}
