/* Pieces connected by intact bonds, across ranks and periodic directions.
 *
 * Each rank joins its own particles (union-find), then labels travel through the copies until
 * none changes: as many exchanges as a piece crosses borders of ranks. Beside the label goes the
 * image a particle is in: the multiple of the periods that brings it to the piece's own place. */
#include "bw_memory.h"
#include "bw_pd_interface.h"
#include "pd_interface_internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int64_t label;
  int32_t image[3]; /* X + image period is beside the label's particle */
} tag;

typedef struct {
  int32_t own, copy;
  int32_t image[3]; /* copy's place = its owner's X + image period */
} cross_bond;

typedef struct {
  bw_solid *pd;
  size_t n, n_all, n_cross;
  double period[3];
  int32_t *parent; /* (n) */
  tag *own, *all;  /* (n) and (n_all) */
  tag *of_root;    /* (n) rows of roots */
  cross_bond *cross;
  double *X, *V, *all_X; /* (n,3), (n,3), (n_all,3) not shifted */
} joiner;

/* What a rank knows of one piece, in two rounds: sums, then moments about the common centre. */
typedef struct {
  int64_t label, particles;
  int64_t order; /* keeps sums in order of ranks */
  double
      weight; /* mass over that of a particle of the first group: a whole number with one group */
  double X[3], V[3], L[3], I[6]; /* sums with that weight */
} piece;

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
  for (int pass = 0; pass < 2; pass++) { /* count the bonds to copies, then list them */
    size_t found = 0;
    for (size_t h = 0; h < j->n; h++) {
      const int family = bw_solid_links(j->pd, h, link);
      for (int q = 0; q < family; q++) {
        if (!link[q].intact) continue;
        if ((size_t)link[q].neighbour >= j->n) {
          if (pass == 1)
            j->cross[found] = (cross_bond){.own = (int32_t)h, .copy = link[q].neighbour};
          found++;
        } else if (pass == 0) {
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
    j->of_root[h].label = INT64_MAX;
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
      for (int d = 0; d < 3; d++)
        mine->image[d] = theirs->image[d] - c->image[d];
      changed = 1;
    }
    bw_comm_max_int(bw_solid_comm(j->pd), 1, &changed);
  }
}

static int by_label(const void *a, const void *b)
{
  const piece *p = a, *q = b;
  if (p->label != q->label) return p->label < q->label ? -1 : 1;
  return (p->order > q->order) - (p->order < q->order);
}

static int by_size(const void *a, const void *b)
{
  const bw_pd_fragment *p = a, *q = b;
  if (p->particles != q->particles) return p->particles > q->particles ? -1 : 1;
  return (p->label > q->label) - (p->label < q->label);
}

/* Sort and add up pieces of the same label; returns how many are left. */
static size_t merge(size_t n, piece list[])
{
  if (n == 0) return 0;
  for (size_t q = 0; q < n; q++)
    list[q].order = (int64_t)q;
  qsort(list, n, sizeof *list, by_label);
  size_t last = 0;
  for (size_t q = 1; q < n; q++) {
    if (list[q].label != list[last].label) {
      list[++last] = list[q];
      continue;
    }
    piece *sum = &list[last];
    sum->particles += list[q].particles;
    sum->weight += list[q].weight;
    for (int d = 0; d < 3; d++) {
      sum->X[d] += list[q].X[d];
      sum->V[d] += list[q].V[d];
      sum->L[d] += list[q].L[d];
    }
    for (int d = 0; d < 6; d++)
      sum->I[d] += list[q].I[d];
  }
  return last + 1;
}

static piece *find(size_t n, piece list[], int64_t label)
{
  const piece key = {.label = label};
  size_t low = 0, high = n;
  while (low + 1 < high) {
    const size_t middle = (low + high) / 2;
    if (list[middle].label <= key.label)
      low = middle;
    else
      high = middle;
  }
  return &list[low];
}

/* All ranks' pieces, merged, in place of this rank's. Collective. */
static bw_status share(const bw_comm *comm, size_t *n, piece **list)
{
  size_t bytes = 0;
  void *all = NULL;
  BW_TRY(bw_comm_allgather(comm, *n * sizeof(piece), *list, &bytes, &all));
  bw_release(list);
  *list = all;
  *n = merge(bytes / sizeof(piece), *list);
  return BW_OK;
}

static void placed(const joiner *j, size_t h, double x[3])
{
  for (size_t d = 0; d < 3; d++)
    x[d] = j->X[3 * h + d] + (double)j->own[h].image[d] * j->period[d];
}

/* Density of own particle h over that of the first group. */
static double weight_of(const joiner *j, size_t h)
{
  return bw_solid_density(j->pd, h) / bw_solid_settings(j->pd)->rho;
}

/* The pieces of this rank's particles with their sums of positions and velocities. */
static bw_status sum_pieces(const joiner *j, const double V[], size_t *n, piece **out)
{
  size_t roots = 0;
  for (size_t h = 0; h < j->n; h++)
    roots += (size_t)j->parent[h] == h;
  BW_TRY(BW_ALLOCATE(out, roots));
  size_t k = 0;
  for (size_t h = 0; h < j->n; h++)
    if ((size_t)j->parent[h] == h) (*out)[k++].label = j->own[h].label;
  *n = merge(roots, *out);
  for (size_t h = 0; h < j->n; h++) {
    piece *p = find(*n, *out, j->own[h].label);
    const double weight = weight_of(j, h);
    double x[3];
    placed(j, h, x);
    p->particles++;
    p->weight += weight;
    for (size_t d = 0; d < 3; d++)
      p->X[d] += weight * x[d], p->V[d] += weight * V[3 * h + d];
  }
  return BW_OK;
}

/* Angular momentum and inertia (xx yy zz xy xz yz) about the pieces' centres over the mass of a
 * particle of the first group; `mean` holds the centres and velocities of all pieces. */
static bw_status sum_moments(const joiner *j, const double V[], size_t n_mean, piece mean[],
                             size_t *n, piece **out)
{
  BW_TRY(BW_ALLOCATE(out, n_mean));
  for (size_t q = 0; q < n_mean; q++)
    (*out)[q].label = mean[q].label;
  for (size_t h = 0; h < j->n; h++) {
    /* Everything is relative to the centre and its velocity, so that moments are those of the piece. */
    const piece *c = find(n_mean, mean, j->own[h].label);
    piece *p = &(*out)[c - mean];
    const double weight = weight_of(j, h);
    double x[3], v[3];
    placed(j, h, x);
    for (size_t d = 0; d < 3; d++)
      x[d] -= c->X[d], v[d] = V[3 * h + d] - c->V[d];
    p->L[0] += weight * (x[1] * v[2] - x[2] * v[1]);
    p->L[1] += weight * (x[2] * v[0] - x[0] * v[2]);
    p->L[2] += weight * (x[0] * v[1] - x[1] * v[0]);
    p->I[0] += weight * (x[1] * x[1] + x[2] * x[2]);
    p->I[1] += weight * (x[0] * x[0] + x[2] * x[2]);
    p->I[2] += weight * (x[0] * x[0] + x[1] * x[1]);
    p->I[3] -= weight * (x[0] * x[1]);
    p->I[4] -= weight * (x[0] * x[2]);
    p->I[5] -= weight * (x[1] * x[2]);
    p->particles++;
  }
  size_t kept = 0; /* those with particles here */
  for (size_t q = 0; q < n_mean; q++)
    if ((*out)[q].particles > 0) (*out)[kept++] = (*out)[q];
  *n = kept;
  return BW_OK;
}

/* spin of I spin = L. An axis without inertia (a rod's own) has L = 0 as well; the part 1e-10 of
 * the trace added to I makes that 0/0 a 0 and changes the others by 1e-10. */
static void solve_spin(const piece *p, double spin[3])
{
  const double more = 1e-10 * (p->I[0] + p->I[1] + p->I[2]);
  const double a = p->I[0] + more, b = p->I[1] + more, c = p->I[2] + more;
  const double d = p->I[3], e = p->I[4], f = p->I[5];
  const double inverse[3][3] = {{b * c - f * f, e * f - d * c, d * f - e * b},
                                {e * f - d * c, a * c - e * e, d * e - a * f},
                                {d * f - e * b, d * e - a * f, a * b - d * d}};
  const double det = a * inverse[0][0] + d * inverse[0][1] + e * inverse[0][2];
  for (int q = 0; q < 3; q++)
    spin[q] =
        det > 0.0
            ? (inverse[q][0] * p->L[0] + inverse[q][1] * p->L[1] + inverse[q][2] * p->L[2]) / det
            : 0.0;
}

static bw_status measure(const joiner *j, const double V[], size_t *n, bw_pd_fragment **out)
{
  const bw_comm *comm = bw_solid_comm(j->pd);
  const double mass = bw_solid_settings(j->pd)->rho * bw_solid_volume(j->pd);
  size_t n_mean = 0, n_moment = 0;
  piece *mean = NULL, *moment = NULL;
  /* First round: centres and velocities of the pieces, the same list on all ranks. */
  bw_status st = bw_comm_agree(comm, sum_pieces(j, V, &n_mean, &mean));
  BW_THEN(st, bw_comm_agree(comm, share(comm, &n_mean, &mean)));
  for (size_t q = 0; st == BW_OK && q < n_mean; q++)
    for (int d = 0; d < 3; d++) {
      mean[q].X[d] /= mean[q].weight;
      mean[q].V[d] /= mean[q].weight;
    }
  /* Second round: moments about those centres. */
  if (st == BW_OK) st = bw_comm_agree(comm, sum_moments(j, V, n_mean, mean, &n_moment, &moment));
  BW_THEN(st, bw_comm_agree(comm, share(comm, &n_moment, &moment)));
  BW_THEN(st, bw_comm_agree(comm, BW_ALLOCATE(out, n_mean)));
  for (size_t q = 0; st == BW_OK && q < n_mean; q++) { /* the same labels in the same order */
    bw_pd_fragment *f = &(*out)[q];
    f->label = mean[q].label;
    f->particles = mean[q].particles;
    f->mass = mass * mean[q].weight;
    memcpy(f->centre, mean[q].X, sizeof f->centre);
    memcpy(f->velocity, mean[q].V, sizeof f->velocity);
    solve_spin(&moment[q], f->spin);
  }
  if (st == BW_OK) {
    qsort(*out, n_mean, sizeof **out, by_size);
    *n = n_mean;
  }
  bw_release(&mean);
  bw_release(&moment);
  return st;
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
  for (size_t h = 0; h < j->n; h++)
    j->parent[h] = (int32_t)h;
  return join_own(j);
}

bw_status bw_pd_interface_fragments(bw_pd_interface *pi, int64_t label[], size_t *n,
                                    bw_pd_fragment **fragment)
{
  *n = 0;
  *fragment = NULL;
  const bw_pd_extended all = bw_solid_get_extended(pi->pd);
  joiner j = {.pd = pi->pd, .n = pi->n, .n_all = all.n};
  memcpy(j.period, bw_solid_settings(pi->pd)->period, sizeof j.period);
  bw_status st = bw_comm_agree(bw_solid_comm(pi->pd), prepare(&j));
  if (st == BW_OK) {
    bw_solid_get_position(pi->pd, j.X);
    bw_solid_get_velocity(pi->pd, j.V);
    find_images(&j, all.X);
    spread_labels(&j, bw_solid_id(pi->pd));
    for (size_t h = 0; label != NULL && h < j.n; h++)
      label[h] = j.own[h].label;
    st = measure(&j, j.V, n, fragment);
  }
  bw_release(&j.parent);
  bw_release(&j.own);
  bw_release(&j.of_root);
  bw_release(&j.all);
  bw_release(&j.cross);
  bw_release(&j.X);
  bw_release(&j.V);
  bw_release(&j.all_X);
  return st;
}
