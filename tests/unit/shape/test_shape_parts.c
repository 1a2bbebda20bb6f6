/* Bodies in parts: what the parts hold, joined in order, is the whole; lattices that are turned.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_memory.h"
#include "bw_shape.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 4 };
typedef struct {
  const char *name;
  int count;
  bw_shape shape[MOST];
  double ds;
  bool planar, turned;
} body;

static const bw_shape_frame leaning = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0.0}, {0.48, 0.64, 0.6}},
                                       {1, 2, 3}};

#define BOX(...)                                                                                   \
  {                                                                                                \
    .kind = BW_SHAPE_BOX, __VA_ARGS__                                                              \
  }
#define SPHERE(...)                                                                                \
  {                                                                                                \
    .kind = BW_SHAPE_SPHERE, __VA_ARGS__                                                           \
  }
static const body bodies[] = {
    {"box", 1, {BOX(.lower = {-2, 1, 3}, .upper = {5, 4, 9})}, 0.7, false, false},
    {"box, turned", 1, {BOX(.lower = {-2, 1, 3}, .upper = {5, 4, 9})}, 0.7, false, true},
    {"box with kinds and groups, a part removed, a part added again",
     4,
     {BOX(.upper = {9, 9, 9}, .particle_kind = 1),
      SPHERE(.centre = {4, 4, 4}, .radius = 4, .remove = true),
      SPHERE(.centre = {4, 4, 4}, .radius = 2, .particle_group = 3),
      BOX(.lower = {7, 7, 7}, .upper = {12, 9, 8}, .particle_kind = 2, .particle_group = 1)},
     0.9,
     false,
     false},
    {"ball cut to a box, turned",
     2,
     {SPHERE(.centre = {1, 2, 3}, .radius = 5),
      BOX(.lower = {-2, 0, 0}, .upper = {4, 9, 9}, .remove = true, .outside = true)},
     0.6,
     false,
     true},
    {"endless cylinder between boxes",
     3,
     {{.kind = BW_SHAPE_CYLINDER, .centre = {3, 3, 0}, .radius = 2, .axis = 2},
      BOX(.lower = {0, 0, -4}, .upper = {1, 1, -3}),
      BOX(.upper = {1, 1, 4})},
     0.5,
     false,
     false},
    {"endless cylinder between boxes, turned",
     3,
     {{.kind = BW_SHAPE_CYLINDER, .centre = {3, 3, 0}, .radius = 2, .axis = 2},
      BOX(.lower = {0, 0, -4}, .upper = {1, 1, -3}),
      BOX(.upper = {1, 1, 4})},
     0.5,
     false,
     true},
    {"all but a ball, ended by a box",
     2,
     {BOX(.upper = {6, 5, 4}), SPHERE(.centre = {3, 2, 2}, .radius = 2, .remove = true)},
     0.5,
     false,
     true},
    {"pores",
     2,
     {BOX(.upper = {8, 8, 8}),
      {.kind = BW_SHAPE_PORES_BCC,
       .remove = true,
       .radius = 1.5,
       .pitch = 4,
       .centre = {0.5, 0, 0}}},
     0.5,
     false,
     false},
    {"frame",
     2,
     {BOX(.lower = {0, 1, 2}, .upper = {5, 3, 6}, .frame = &leaning),
      SPHERE(.centre = {1, 2, 3}, .radius = 1.5, .remove = true)},
     0.4,
     false,
     false},
    {"disc with a hole",
     2,
     {{.kind = BW_SHAPE_CYLINDER, .centre = {0.1, 0.2, 9}, .radius = 5, .axis = 2},
      BOX(.lower = {-1, -1, 0}, .upper = {2, 1, 0}, .remove = true)},
     0.4,
     true,
     false},
    {"disc with a hole, turned",
     2,
     {{.kind = BW_SHAPE_CYLINDER, .centre = {0.1, 0.2, 9}, .radius = 5, .axis = 2},
      BOX(.lower = {-1, -1, 0}, .upper = {2, 1, 0}, .remove = true)},
     0.4,
     true,
     true},
    {"two specks far apart: most parts are empty",
     2,
     {BOX(.upper = {1, 1, 1}), BOX(.lower = {0, 0, 60}, .upper = {1, 1, 61})},
     0.5,
     false,
     false},
};
enum { BODIES = sizeof bodies / sizeof bodies[0] };

static bw_shape_lattice lattice_of(const body *b)
{
  const double origin[3] = {0.13, -0.21, 0.37}, z[3] = {0, 0, 1}, skew[3] = {1, -2, 0.5};
  bw_shape_lattice l = bw_shape_lattice_straight(b->ds, origin, b->planar);
  if (b->turned) bw_shape_turn(b->planar ? z : skew, 0.3, l.axes);
  return l;
}

typedef struct {
  int64_t n;
  int32_t *site;
  uint8_t *kind, *group;
} sites;

static void release(sites *s)
{
  bw_release(&s->site);
  bw_release(&s->kind);
  bw_release(&s->group);
}

static sites whole_of(int count, const bw_shape shape[], const bw_shape_lattice *l)
{
  sites s;
  bw_check_ok(bw_shape_fill(count, shape, l, 0, 1, &s.n, &s.site, &s.kind, &s.group));
  return s;
}

/* Rows at, at + 1, ... of the whole are these. */
static void check_piece(const char *name, const sites *whole, int64_t at, const sites *piece)
{
  ck_assert_msg(at + piece->n <= whole->n, "%s: parts hold more than the whole", name);
  const size_t n = (size_t)piece->n;
  ck_assert_msg(memcmp(whole->site + 3 * at, piece->site, 3 * n * sizeof *piece->site) == 0 &&
                    memcmp(whole->kind + at, piece->kind, n) == 0 &&
                    memcmp(whole->group + at, piece->group, n) == 0,
                "%s: rows from %lld are others than in the whole", name, (long long)at);
}

static void check_parts(const char *name, int count, const bw_shape shape[],
                        const bw_shape_lattice *l)
{
  sites whole = whole_of(count, shape, l);
  for (int parts = 1; parts <= 7; parts++) {
    int64_t at = 0, counted;
    for (int part = 0; part < parts; part++) {
      sites p;
      bw_check_ok(bw_shape_fill(count, shape, l, part, parts, &p.n, &p.site, &p.kind, &p.group));
      bw_check_ok(bw_shape_count(count, shape, l, part, parts, &counted));
      ck_assert_int_eq(counted, p.n);
      check_piece(name, &whole, at, &p);
      at += p.n;
      release(&p);
    }
    ck_assert_msg(at == whole.n, "%s: %d parts hold %lld of %lld", name, parts, (long long)at,
                  (long long)whole.n);
  }
  release(&whole);
}

/* The rank's own list is its piece of the whole; lists differ by no more than the longest row. */
static void check_shared(const char *name, int count, const bw_shape shape[],
                         const bw_shape_lattice *l)
{
  const bw_comm *comm = bw_check_world();
  sites whole = whole_of(count, shape, l), mine;
  bw_check_ok(
      bw_shape_fill_shared(comm, count, shape, l, &mine.n, &mine.site, &mine.kind, &mine.group));
  check_piece(name, &whole, bw_comm_prefix_sum(comm, mine.n), &mine);
  int64_t total = mine.n, row = 0, longest = 0;
  bw_comm_sum_int(comm, 1, &total);
  ck_assert_int_eq(total, whole.n);
  for (int64_t q = 1; q < whole.n; q++) {
    const int32_t *a = whole.site + 3 * q;
    row = a[1] == a[-2] && a[2] == a[-1] ? row + 1 : 0;
    if (row >= longest) longest = row + 1;
  }
  ck_assert_msg(llabs(mine.n - whole.n / bw_comm_size(comm)) <= longest + 1,
                "%s: %lld of %lld particles on one of %d ranks, rows of %lld", name,
                (long long)mine.n, (long long)whole.n, bw_comm_size(comm), (long long)longest);
  release(&whole);
  release(&mine);
}

START_TEST(parts_joined_are_the_whole)
{
  for (int q = 0; q < BODIES; q++) {
    const body *b = &bodies[q];
    const bw_shape_lattice l = lattice_of(b);
    check_parts(b->name, b->count, b->shape, &l);
    check_shared(b->name, b->count, b->shape, &l);
  }
}
END_TEST

/* What each part reads of an image is what it needs: on every rank, turned or not. */
START_TEST(images_are_read_by_layers)
{
  enum { N = 12 };
  char path[256];
  const char *folder = getenv("BW_BUILD_DIR");
  snprintf(path, sizeof path, "%s/parts_%d.raw", folder != NULL ? folder : ".", (int)getpid());
  FILE *file = fopen(path, "wb");
  ck_assert_ptr_nonnull(file);
  for (int q = 0; q < N * N * N; q++)
    fputc(q * q % 251, file);
  fclose(file);
  const bw_shape_voxels v = {.size = {N, N, N}, .lower = {1, 2, 3}, .spacing = {0.5, 0.4, 0.3}};
  bw_shape_mask *open = NULL, *read = NULL;
  bw_check_ok(bw_shape_mask_open_raw(path, &v, 0, 120, &open));
  bw_check_ok(bw_shape_mask_read_raw(path, &v, 0, 120, &read));
  for (int turned = 0; turned < 2; turned++) {
    const body about = {.ds = 0.21, .turned = turned == 1};
    const bw_shape_lattice l = lattice_of(&about);
    bw_shape a = {.kind = BW_SHAPE_MASK, .mask = open, .frame = turned ? &leaning : NULL};
    bw_shape b = a;
    b.mask = read;
    sites whole = whole_of(1, &b, &l), part;
    check_parts("image", 1, &a, &l);
    check_shared("image", 1, &a, &l);
    /* Few parts of many layers of sites, and parts of a few rows within one of them. */
    for (int parts = 4; parts <= 64; parts *= 16) {
      int64_t at = 0;
      for (int p = 0; p < parts; p++) {
        /* What is held already is kept: forget it, to see what a part asks for. */
        bw_shape_mask_destroy(&open);
        bw_check_ok(bw_shape_mask_open_raw(path, &v, 0, 120, &open));
        ck_assert_int_eq(open->held, 0);
        a.mask = open;
        bw_check_ok(
            bw_shape_fill(1, &a, &l, p, parts, &part.n, &part.site, &part.kind, &part.group));
        check_piece("image", &whole, at, &part);
        at += part.n;
        /* 12 layers in 4 parts: 3 and the ones that are cut */
        ck_assert(turned || parts > 4 || (open->held >= 3 && open->held <= 5));
        /* Two layers of sites at most, 0.42 of 0.3 each. */
        ck_assert(turned || parts == 4 || open->held <= 3);
        release(&part);
      }
      ck_assert_int_eq(at, whole.n);
    }
    release(&whole);
  }
  bw_shape_mask_destroy(&open);
  bw_shape_mask_destroy(&read);
  remove(path);
}
END_TEST

/* A site is solid where its true place is, here computed in the plainest way. */
START_TEST(turned_lattices_test_true_places)
{
  const bw_shape shape[] = {
      {.kind = BW_SHAPE_CYLINDER, .centre = {3, 3, 0}, .radius = 2, .axis = 2},
      BOX(.lower = {0, 0, -4}, .upper = {1, 1, -3}),
      BOX(.upper = {1, 1, 4})};
  const body b = {.ds = 0.5, .turned = true};
  const bw_shape_lattice l = lattice_of(&b);
  sites s = whole_of(3, shape, &l);
  int64_t found = 0;
  enum { REACH = 30 };
  for (int k = -REACH; k < REACH; k++)
    for (int j = -REACH; j < REACH; j++)
      for (int i = -REACH; i < REACH; i++) {
        double x[3];
        for (int d = 0; d < 3; d++)
          x[d] = l.origin[d] + l.ds * ((i + 0.5) * l.axes[0][d] + (j + 0.5) * l.axes[1][d] +
                                       (k + 0.5) * l.axes[2][d]);
        /* within the box around all that has an end: x and y of the cylinder, z of the boxes */
        const bool ball = hypot(x[0] - 3, x[1] - 3) <= 2 && x[2] >= -4 && x[2] < 4;
        const bool low = x[0] >= 0 && x[0] < 1 && x[1] >= 0 && x[1] < 1 && x[2] >= -4 && x[2] < -3;
        const bool up = x[0] >= 0 && x[0] < 1 && x[1] >= 0 && x[1] < 1 && x[2] >= 0 && x[2] < 4;
        if (!ball && !low && !up) continue;
        ck_assert_int_lt(found, s.n);
        ck_assert_int_eq(s.site[3 * found], i);
        ck_assert_int_eq(s.site[3 * found + 1], j);
        ck_assert_int_eq(s.site[3 * found + 2], k);
        found++;
      }
  ck_assert_int_eq(found, s.n);
  release(&s);
}
END_TEST

/* A body that is turned with its lattice keeps its sites, although their places are computed to
 * round-off only: faces and balls are told apart with a margin. */
START_TEST(a_body_turned_with_its_lattice_keeps_its_sites)
{
  const double about[3] = {0.3, -7, 2}, axis[3] = {0.2, -1, 3}, z[3] = {0, 0, 1};
  for (int q = 0; q < BODIES; q++) {
    const body *b = &bodies[q];
    if (b->turned || b->shape[0].frame != NULL) continue;
    if (b->shape[0].kind == BW_SHAPE_CYLINDER && !b->planar)
      continue; /* ends with a box in space */
    const bw_shape_lattice straight = bw_shape_lattice_straight(b->ds, about, b->planar);
    bw_shape_lattice turned = straight; /* turned about its own origin */
    bw_shape_frame frame = {.about = {about[0], about[1], about[2]}};
    bw_shape_turn(b->planar ? z : axis, 17 * acos(-1.0) / 180, frame.axes);
    memcpy(turned.axes, frame.axes, sizeof turned.axes);
    bw_shape shape[MOST];
    memcpy(shape, b->shape, sizeof shape);
    for (int k = 0; k < b->count; k++)
      shape[k].frame = &frame;
    sites s = whole_of(b->count, b->shape, &straight), t = whole_of(b->count, shape, &turned);
    ck_assert_msg(s.n == t.n, "%s: %lld sites, turned %lld", b->name, (long long)s.n,
                  (long long)t.n);
    check_piece(b->name, &s, 0, &t);
    release(&s);
    release(&t);
  }
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(parts_joined_are_the_whole),
    BW_TEST(images_are_read_by_layers),
    BW_TEST(turned_lattices_test_true_places),
    BW_TEST(a_body_turned_with_its_lattice_keeps_its_sites),
};
BW_CHECK_MAIN("shape.parts", tests)
