/* What is known of a piece: sums over its particles, rank by rank, added up on the rank it belongs
 * to.
 *
 * Two rounds: particles, places and velocities first; then, when the centre has come back to all
 * ranks that have a part of the piece, angular momentum and inertia about it. */
#include "bw_memory.h"
#include "pd_fragment_internal.h"

#include <stdlib.h>
#include <string.h>

typedef bw_pd_fragment__particles particles;

/* A part of a piece, or the whole. First round: X, V sums, then means; second: L and I. */
typedef struct {
  int64_t label, particles;
  int64_t order; /* keeps sums in order of ranks */
  int64_t rank;  /* that the piece belongs to */
  double weight; /* mass over that of a particle of the first group */
  double X[3], V[3], L[3], I[6];
} piece;

/* One round: the parts on this rank, the parts that came to it, and what they make. */
typedef struct {
  bw_exchange *plan; /* from the rank of a part to that of the piece */
  size_t n, n_came, n_whole;
  piece *part;  /* (n) by label */
  piece *came;  /* (n_came) in order of ranks */
  piece *whole; /* (n_whole <= n_came) by label */
} merger;

static int by_label(const void *a, const void *b)
{
  const piece *p = a, *q = b;
  if (p->label != q->label) return p->label < q->label ? -1 : 1;
  return (p->order > q->order) - (p->order < q->order);
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

static void placed(const particles *p, size_t h, double x[3])
{
  for (size_t d = 0; d < 3; d++)
    x[d] = p->X[3 * h + d] + (double)p->tag[h].image[d] * p->period[d];
}

/* The parts that are on this rank, with their sums of positions and velocities. */
static bw_status sum_parts(const particles *p, merger *m)
{
  size_t roots = 0, k = 0;
  for (size_t h = 0; h < p->n; h++)
    roots += (size_t)p->parent[h] == h;
  BW_TRY(BW_ALLOCATE(&m->part, roots));
  for (size_t h = 0; h < p->n; h++)
    if ((size_t)p->parent[h] == h)
      m->part[k++] = (piece){.label = p->tag[h].label, .rank = p->tag[h].rank};
  m->n = merge(roots, m->part);
  for (size_t h = 0; h < p->n; h++) {
    piece *sum = find(m->n, m->part, p->tag[h].label);
    const double weight = p->weight[h];
    double x[3];
    placed(p, h, x);
    sum->particles++;
    sum->weight += weight;
    for (size_t d = 0; d < 3; d++)
      sum->X[d] += weight * x[d], sum->V[d] += weight * p->V[3 * h + d];
  }
  return BW_OK;
}

/* Angular momentum and inertia (xx yy zz xy xz yz) of the parts about the pieces' centres, over the
 * mass of a particle of the first group; X and V of the parts are those of the whole pieces'
 * centres by now. */
static void sum_moments(const particles *p, merger *m)
{
  for (size_t h = 0; h < p->n; h++) {
    piece *sum = find(m->n, m->part, p->tag[h].label);
    double x[3], v[3];
    placed(p, h, x);
    for (size_t d = 0; d < 3; d++)
      x[d] -= sum->X[d], v[d] = p->V[3 * h + d] - sum->V[d];
    const double weight = p->weight[h];
    sum->L[0] += weight * (x[1] * v[2] - x[2] * v[1]);
    sum->L[1] += weight * (x[2] * v[0] - x[0] * v[2]);
    sum->L[2] += weight * (x[0] * v[1] - x[1] * v[0]);
    sum->I[0] += weight * (x[1] * x[1] + x[2] * x[2]);
    sum->I[1] += weight * (x[0] * x[0] + x[2] * x[2]);
    sum->I[2] += weight * (x[0] * x[0] + x[1] * x[1]);
    sum->I[3] -= weight * (x[0] * x[1]);
    sum->I[4] -= weight * (x[0] * x[2]);
    sum->I[5] -= weight * (x[1] * x[2]);
  }
}

/* The way of each part to the rank of its piece, and room for what arrives. Collective. */
static bw_status plan_ways(const bw_comm *comm, merger *m)
{
  int *destination = NULL;
  bw_status st = BW_ALLOCATE(&destination, m->n);
  for (size_t q = 0; st == BW_OK && q < m->n; q++)
    destination[q] = (int)m->part[q].rank;
  st = bw_comm_agree(comm, st);
  BW_THEN(st, bw_exchange_create(comm, m->n, destination, &m->plan));
  bw_release(&destination);
  if (st != BW_OK) return st;
  m->n_came = bw_exchange_received(m->plan);
  st = BW_ALLOCATE(&m->came, m->n_came);
  BW_THEN(st, BW_ALLOCATE(&m->whole, m->n_came));
  return bw_comm_agree(comm, st);
}

/* Parts of all ranks become the pieces of this one. Collective. */
static void add_up(merger *m)
{
  bw_exchange_forward(m->plan, sizeof *m->part, m->part, m->came);
  memcpy(m->whole, m->came, m->n_came * sizeof *m->came);
  m->n_whole = merge(m->n_came, m->whole);
}

/* The centres of the pieces to all parts, whose sums they replace. Collective. */
static void tell_centres(merger *m)
{
  for (size_t q = 0; q < m->n_whole; q++)
    for (int d = 0; d < 3; d++) {
      m->whole[q].X[d] /= m->whole[q].weight;
      m->whole[q].V[d] /= m->whole[q].weight;
    }
  for (size_t q = 0; q < m->n_came; q++)
    m->came[q] = *find(m->n_whole, m->whole, m->came[q].label);
  bw_exchange_backward(m->plan, sizeof *m->part, m->came, m->part);
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

static int by_size(const void *a, const void *b)
{
  return bw_pd_fragment__before(a, b) ? -1 : 1; /* no two have the same label */
}

/* First round: what is in `own` but for the spin; it is in the order of labels. */
static bw_status list_pieces(const particles *p, const merger *m, bw_pd_fragments *out)
{
  BW_TRY(BW_ALLOCATE(&out->own, m->n_whole));
  out->n = m->n_whole;
  for (size_t q = 0; q < m->n_whole; q++) {
    bw_pd_fragment *f = &out->own[q];
    f->label = m->whole[q].label;
    f->particles = m->whole[q].particles;
    f->mass = p->mass * m->whole[q].weight;
    memcpy(f->centre, m->whole[q].X, sizeof f->centre);
    memcpy(f->velocity, m->whole[q].V, sizeof f->velocity);
  }
  return BW_OK;
}

static bw_status merge_all(const particles *p, merger *m, bw_pd_fragments *out)
{
  BW_TRY(bw_comm_agree(p->comm, sum_parts(p, m)));
  BW_TRY(plan_ways(p->comm, m));
  add_up(m);
  tell_centres(m);
  BW_TRY(bw_comm_agree(p->comm, list_pieces(p, m, out)));
  /* Every part knows the centre of its piece: moments about it can be summed the same way. */
  sum_moments(p, m);
  add_up(m);
  for (size_t q = 0; q < m->n_whole; q++) /* the same labels in the same order */
    solve_spin(&m->whole[q], out->own[q].spin);
  qsort(out->own, out->n, sizeof *out->own, by_size);
  out->total = (int64_t)out->n;
  bw_comm_sum_int(p->comm, 1, &out->total);
  return BW_OK;
}

bw_status bw_pd_fragment__measure(const particles *p, bw_pd_fragments *out)
{
  merger m = {0};
  const bw_status st = merge_all(p, &m, out);
  bw_exchange_destroy(&m.plan);
  bw_release(&m.part);
  bw_release(&m.came);
  bw_release(&m.whole);
  return st;
}
