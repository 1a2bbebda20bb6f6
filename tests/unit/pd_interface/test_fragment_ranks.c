/* Fragments that lie over many ranks, against a search through all bonds on one: labels, sums, the
 * order of the list, and that no rank holds more pieces than particles.
 * TEST ranks=1,2,3,4
 * BUILD modules=shape */
#include "body.h"

#include <math.h>

/* A bond that holds, as one of its ends sees it. */
typedef struct {
  int64_t id, other;
  double way[3]; /* to the other end, where it acts */
} edge;
typedef struct {
  int64_t id;
  double X[3], V[3];
} node;

/* All particles and bonds on this rank, and the pieces that a search finds: (n) by id. */
typedef struct {
  size_t n, n_edge;
  edge *edges;
  node *nodes;
  int64_t *label;
  int (*image)[3];
} brute;

static int by_id(const void *a, const void *b)
{
  const node *p = a, *q = b;
  return (p->id > q->id) - (p->id < q->id);
}

static void gather_all(body *b, brute *w)
{
  const size_t n = bw_solid_count(b->pd);
  const bw_pd_extended all = bw_solid_get_extended(b->pd);
  const int most = bw_solid_max_family(b->pd);
  double *X = NULL, *V = NULL;
  node *nodes = NULL;
  edge *edges = NULL;
  bw_pd_link *link = NULL;
  void *out = NULL;
  size_t n_edge = 0, bytes = 0;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&nodes, n));
  bw_check_ok(BW_ALLOCATE(&edges, n * (size_t)most));
  bw_check_ok(BW_ALLOCATE(&link, (size_t)most));
  bw_solid_get_position(b->pd, X);
  bw_solid_get_velocity(b->pd, V);
  for (size_t h = 0; h < n; h++) {
    nodes[h].id = all.id[h];
    memcpy(nodes[h].X, X + 3 * h, sizeof nodes[h].X);
    memcpy(nodes[h].V, V + 3 * h, sizeof nodes[h].V);
    const int family = bw_solid_links(b->pd, h, link);
    for (int q = 0; q < family; q++) {
      const size_t l = (size_t)link[q].neighbour;
      if (!link[q].intact) continue;
      edge *e = &edges[n_edge++];
      e->id = all.id[h], e->other = all.id[l];
      for (size_t d = 0; d < 3; d++)
        e->way[d] = (double)all.X[3 * l + d] - (double)all.X[3 * h + d];
    }
  }
  bw_check_ok(bw_comm_allgather(bw_check_world(), n * sizeof *nodes, nodes, &bytes, &out));
  w->nodes = out, w->n = bytes / sizeof *nodes;
  bw_check_ok(bw_comm_allgather(bw_check_world(), n_edge * sizeof *edges, edges, &bytes, &out));
  w->edges = out, w->n_edge = bytes / sizeof *edges;
  qsort(w->nodes, w->n, sizeof *w->nodes, by_id);
  bw_release(&X), bw_release(&V), bw_release(&nodes), bw_release(&edges), bw_release(&link);
}

/* The lowest label goes along bonds until none changes, with the image beside that particle. */
static void search(brute *w, const double period[3])
{
  bw_check_ok(BW_ALLOCATE(&w->label, w->n));
  bw_check_ok(BW_ALLOCATE(&w->image, w->n));
  for (size_t q = 0; q < w->n; q++)
    w->label[q] = (int64_t)q;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t k = 0; k < w->n_edge; k++) {
      const edge *e = &w->edges[k];
      if (w->label[e->id] >= w->label[e->other]) continue;
      w->label[e->other] = w->label[e->id];
      for (int d = 0; d < 3; d++) {
        const double at = w->nodes[e->id].X[d] + w->image[e->id][d] * period[d] + e->way[d];
        if (period[d] > 0)
          w->image[e->other][d] = (int)lround((at - w->nodes[e->other].X[d]) / period[d]);
      }
      changed = true;
    }
  }
}

/* The piece of that label, but for its spin. */
static bw_pd_fragment piece_of(const brute *w, int64_t label, const bw_solid_config *c)
{
  bw_pd_fragment f = {.label = label};
  for (size_t q = 0; q < w->n; q++) {
    if (w->label[q] != label) continue;
    f.particles++;
    for (int d = 0; d < 3; d++) {
      f.centre[d] += w->nodes[q].X[d] + w->image[q][d] * c->period[d];
      f.velocity[d] += w->nodes[q].V[d];
    }
  }
  for (int d = 0; d < 3; d++)
    f.centre[d] /= (double)f.particles, f.velocity[d] /= (double)f.particles;
  f.mass = c->rho * (double)f.particles; /* ds = 1 */
  return f;
}

typedef struct {
  const brute *w;
  const bw_solid_config *c;
  bw_pd_fragment last;
  int64_t seen, particles;
} visitor;

/* Sums of up to 5000 numbers up to 60: round-off by their number would be 1e-10, by its root 1e-12.
 */
static const double ROUND_OFF = 1e4 * BW_REAL_EPSILON;

static void look(void *context, size_t n, const bw_pd_fragment piece[])
{
  visitor *v = context;
  ck_assert_uint_le(n, 1000 * (size_t)bw_comm_size(bw_check_world()));
  for (size_t q = 0; q < n; q++) {
    const bw_pd_fragment *f = &piece[q];
    const bw_pd_fragment r = piece_of(v->w, f->label, v->c);
    ck_assert_int_eq(f->particles, r.particles);
    bw_check_near(f->mass, r.mass, ROUND_OFF * r.mass);
    for (int d = 0; d < 3; d++) {
      bw_check_near(f->centre[d], r.centre[d], 60 * ROUND_OFF);
      bw_check_near(f->velocity[d], r.velocity[d], ROUND_OFF);
    }
    if (v->seen > 0)
      ck_assert(f->particles < v->last.particles ||
                (f->particles == v->last.particles && f->label > v->last.label));
    v->last = *f;
    v->seen++, v->particles += f->particles;
  }
}

/* Compares the pieces of b with those that the search finds; returns how many there are. */
static int64_t check(body *b)
{
  const bw_solid_config *c = bw_solid_settings(b->pd);
  const size_t n = bw_solid_count(b->pd);
  const int64_t *id = bw_solid_id(b->pd);
  brute w = {0};
  bw_pd_fragments f;
  int64_t *label = NULL, wanted = 0;
  bw_check_ok(BW_ALLOCATE(&label, n));
  gather_all(b, &w);
  search(&w, c->period);
  bw_check_ok(bw_pd_interface_fragments(b->pi, label, &f));
  for (size_t h = 0; h < n; h++)
    ck_assert_int_eq(label[h], w.label[id[h]]);
  for (size_t q = 0; q < w.n; q++)
    wanted += w.label[q] == (int64_t)q;
  ck_assert_int_eq(f.total, wanted);

  bool *mine = NULL; /* the labels of a rank's pieces are its own particles, each once */
  bw_check_ok(BW_ALLOCATE(&mine, w.n));
  for (size_t h = 0; h < n; h++)
    mine[id[h]] = true;
  for (size_t q = 0; q < f.n; q++) {
    ck_assert(mine[f.own[q].label]);
    mine[f.own[q].label] = false;
  }
  ck_assert_uint_le(f.n, n);
  ck_assert_double_eq(body_sum((double)f.n), (double)wanted);

  visitor all = {.w = &w, .c = c}, largest = all;
  bw_check_ok(bw_pd_fragment_visit(bw_check_world(), &f, look, &all));
  const bool first = bw_comm_rank(bw_check_world()) == 0;
  ck_assert_int_eq(all.seen, first ? wanted : 0);
  ck_assert_int_eq(all.particles, first ? (int64_t)w.n : 0);
  ck_assert_uint_eq(f.n_largest, wanted < BW_PD_FRAGMENT_LARGEST ? wanted : BW_PD_FRAGMENT_LARGEST);
  look(&largest, f.n_largest, f.largest); /* those of all ranks, on every one */
  if (f.n > 0) ck_assert_int_le(f.own[0].particles, f.largest[0].particles);
  int64_t more = 0; /* than the last of the largest */
  for (size_t q = 0; q < w.n; q++)
    more += w.label[q] == (int64_t)q &&
            piece_of(&w, (int64_t)q, c).particles > f.largest[f.n_largest - 1].particles;
  ck_assert_int_le(more, BW_PD_FRAGMENT_LARGEST - 1);
  bw_pd_fragment_release(&f);
  ck_assert_ptr_null(f.own);
  bw_release(&label), bw_release(&mine);
  bw_release(&w.edges), bw_release(&w.nodes), bw_release(&w.label), bw_release(&w.image);
  return wanted;
}

/* Velocities that tell particles apart, of order 1. */
static void set_moving(body *b)
{
  const size_t n = bw_solid_count(b->pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_position(b->pd, X);
  for (size_t h = 0; h < n; h++)
    for (size_t d = 0; d < 3; d++)
      V[3 * h + d] = sin(1.0 + 0.7 * (double)bw_solid_id(b->pd)[h] + 2.0 * (double)d);
  bw_solid_set_state(b->pd, X, V);
  bw_release(&X), bw_release(&V);
}

static body plate(int nx, int ny, bool around)
{
  bw_solid_config c = body_config(true);
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_shape shape[] = {{.kind = BW_SHAPE_BOX, .upper = {nx, ny, 1}}};
  c.period[0] = around ? nx : 0.0;
  body b = body_create(1, shape, &c, &ic);
  set_moving(&b);
  return b;
}

static void cut(body *b, double x0, double y0, double x1, double y1)
{
  const double from[3] = {x0, y0, 0}, to[3] = {x1, y1, 0};
  bw_check_ok(bw_solid_precrack(b->pd, from, to, NULL));
}

/* One strip that runs to and fro through the blocks of all ranks, eight times; then cut in the
 * middle. */
START_TEST(a_strip_that_winds_through_all_ranks)
{
  body b = plate(40, 40, false);
  for (int q = 1; q < 8; q++) /* a gap of five spacings, right and left in turn */
    cut(&b, q % 2 == 1 ? -1 : 5, 5 * q, q % 2 == 1 ? 35 : 41, 5 * q);
  ck_assert_int_eq(check(&b), 1);
  cut(&b, 20, 15, 20, 20);
  ck_assert_int_eq(check(&b), 2);
  body_destroy(&b);
}
END_TEST

/* Chords at all angles: pieces of every size; then on a plate that is closed around, with one cut
 * from edge to edge: pieces lie across the seam and none meets itself. */
START_TEST(pieces_of_every_size)
{
  for (int around = 0; around < 2; around++) {
    body b = plate(40, 30, around == 1);
    cut(&b, 11.3, -1, 11.3, 31);
    for (int q = 0; q < 9; q++) {
      const double angle = 0.35 * q, x = 4.0 * q + 3.0, y = 3.0 * (q * 7 % 9) + 3.0;
      const double reach = around == 1 ? 12.0 : 60.0;
      cut(&b, x - reach * cos(angle), y - reach * sin(angle), x + reach * cos(angle),
          y + reach * sin(angle));
    }
    const int64_t pieces = check(&b);
    ck_assert_int_ge(pieces, around == 1 ? 2 : 20);
    body_destroy(&b);
  }
}
END_TEST

/* Every particle is a piece: more on each rank than are handed over at a time. */
START_TEST(dust)
{
  const bw_solid_config c = body_config(false);
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_shape shape[] = {{.kind = BW_SHAPE_BOX, .upper = {20, 16, 15}}};
  body b = body_create(1, shape, &c, &ic);
  uint8_t *bits = NULL;
  set_moving(&b);
  bw_check_ok(BW_ALLOCATE(&bits, bw_solid_count(b.pd) * bw_solid_bits_bytes(b.pd)));
  bw_check_ok(bw_solid_set_bits(b.pd, bits));
  ck_assert_int_eq(check(&b), 20 * 16 * 15);
  bw_release(&bits);
  body_destroy(&b);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_strip_that_winds_through_all_ranks),
    BW_TEST(pieces_of_every_size),
    BW_TEST(dust),
};
BW_CHECK_MAIN("pd_interface.fragment_ranks", tests)
