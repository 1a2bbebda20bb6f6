/* The algebra. Between two separators X- (row before this rank's first) and X+ (this rank's
 * last row), elimination downward leaves x_j = f'_j - c'_j x_{j+1} - l'_j X-, and the first row,
 * carried along, x_first = F - L X- - G x_{j+1}. The separator's own row then reads
 *   -lower l' X- + (diagonal + shift - lower c') X+ + upper x_first(next rank) = scale f - lower f'
 * with x_first of the next rank taken from its F, L, G: a system over the separators, tridiagonal
 * (cyclic if the line is). The rank without separator (the last one, not cyclic) only gives F, L.
 * Pinning: the line's matrix has the constants as null space and a right-hand side without mean.
 * Its diagonal is -(lower + upper) in each row. Doubling the last one makes it regular; the sum of
 * all rows, weighted so that the matrix drops out, says x_n = 0: the equations are met unchanged.
 */
#include "bw_tridiagonal.h"
#include "bw_memory.h"
#include "grid_internal.h"

#include <string.h>

enum { SUB, DIAGONAL, RIGHT, NEXT_F, NEXT_L, NEXT_G, PLANES }; /* what a rank tells of a line */
enum { BEFORE, OWN, ANSWERS };                                 /* the separators it is told */
enum { N = BW_TRIDIAGONAL_LINES };

struct bw_tridiagonal {
  bw_grid *grid;
  int d; /* direction of the lines */
  size_t lines;
  int n, lo;           /* rows of all ranks, before this rank's */
  int ranks, me, rows; /* in direction d; rows of this rank */
  int inner;           /* rows between the separators: rows - 1, or rows */
  bool cyclic;
  bw_real *lower, *diagonal, *upper; /* (n) */
  bw_real *pivot;                    /* (rows, N) reciprocals */
  bw_real *zero;                     /* (N) zeros */
  /* The lines are dealt out in consecutive portions. A portion of c lines is [PLANES][c] on the
   * way to its solver and [ANSWERS][c] back. */
  size_t *portion;                     /* (ranks+1) first line of each rank's portion */
  size_t *tell_start, *tell_count;     /* (ranks) in `tell` */
  size_t *hear_start, *hear_count;     /* in `hear`: [ranks][PLANES][my portion] */
  size_t *reply_start, *reply_count;   /* in `reply`: [ranks][ANSWERS][my portion] */
  size_t *answer_start, *answer_count; /* in `answer` */
  bw_real *tell, *hear, *reply, *answer;
  bw_real *work; /* (ranks, 3, N) */
};

/* Counts of `planes` numbers per line with everyone: mine of all portions, all of my portion. */
static void count(const bw_tridiagonal *t, size_t planes, size_t *all_start, size_t *all_count,
                  size_t *mine_start, size_t *mine_count)
{
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  for (int p = 0; p < t->ranks; p++) {
    all_start[p] = planes * t->portion[p];
    all_count[p] = planes * (t->portion[p + 1] - t->portion[p]);
    mine_start[p] = planes * mine * (size_t)p;
    mine_count[p] = planes * mine;
  }
}

static bw_status build(bw_tridiagonal *t)
{
  const bw_grid_view *v = bw_grid_look(t->grid);
  const size_t r = (size_t)v->ranks[t->d], n = (size_t)v->n[t->d];
  size_t **const table[] = {&t->portion,     &t->tell_start,   &t->tell_count,
                            &t->hear_start,  &t->hear_count,   &t->reply_start,
                            &t->reply_count, &t->answer_start, &t->answer_count};
  t->n = v->n[t->d], t->lo = v->lo[t->d];
  t->ranks = v->ranks[t->d];
  t->me = v->coord[t->d];
  t->rows = v->m[t->d];
  for (size_t q = 0; q < sizeof table / sizeof *table; q++)
    BW_TRY(BW_ALLOCATE(table[q], r + 1));
  for (size_t p = 0; p <= r; p++)
    t->portion[p] = t->lines * p / r;
  count(t, PLANES, t->tell_start, t->tell_count, t->hear_start, t->hear_count);
  count(t, ANSWERS, t->answer_start, t->answer_count, t->reply_start, t->reply_count);
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  BW_TRY(BW_ALLOCATE(&t->lower, n));
  BW_TRY(BW_ALLOCATE(&t->diagonal, n));
  BW_TRY(BW_ALLOCATE(&t->upper, n));
  BW_TRY(BW_ALLOCATE(&t->pivot, (size_t)t->rows * N));
  BW_TRY(BW_ALLOCATE(&t->zero, N));
  BW_TRY(BW_ALLOCATE(&t->work, r * 3 * N));
  if (r == 1 && !v->periodic[t->d]) return BW_OK; /* never coupled */
  BW_TRY(BW_ALLOCATE(&t->tell, PLANES * t->lines));
  BW_TRY(BW_ALLOCATE(&t->hear, PLANES * mine * r));
  BW_TRY(BW_ALLOCATE(&t->reply, ANSWERS * mine * r));
  return BW_ALLOCATE(&t->answer, ANSWERS * t->lines);
}

bw_status bw_tridiagonal_create(bw_grid *grid, int d, size_t lines, bw_tridiagonal **out)
{
  bw_tridiagonal *t = NULL;
  bw_status st = BW_ALLOCATE(&t, 1);
  if (st == BW_OK) {
    t->grid = grid, t->d = d;
    t->lines = lines;
    st = build(t);
  }
  st = bw_comm_agree(bw_grid_comm(grid), st);
  if (st != BW_OK) bw_tridiagonal_destroy(&t);
  *out = t;
  return st;
}

void bw_tridiagonal_destroy(bw_tridiagonal **tridiagonal)
{
  bw_tridiagonal *t = *tridiagonal;
  if (t == NULL) return;
  bw_release(&t->lower);
  bw_release(&t->diagonal);
  bw_release(&t->upper);
  bw_release(&t->pivot);
  bw_release(&t->zero);
  bw_release(&t->portion);
  bw_release(&t->tell_start);
  bw_release(&t->tell_count);
  bw_release(&t->hear_start);
  bw_release(&t->hear_count);
  bw_release(&t->reply_start);
  bw_release(&t->reply_count);
  bw_release(&t->answer_start);
  bw_release(&t->answer_count);
  bw_release(&t->tell);
  bw_release(&t->hear);
  bw_release(&t->reply);
  bw_release(&t->answer);
  bw_release(&t->work);
  bw_release(tridiagonal);
}

void bw_tridiagonal_set(bw_tridiagonal *t, const double lower[], const double diagonal[],
                        const double upper[], bool cyclic)
{
  BW_ASSERT(cyclic || (lower[0] == 0 && upper[t->n - 1] == 0));
  BW_ASSERT(!cyclic || t->tell != NULL);
  for (int j = 0; j < t->n; j++) {
    t->lower[j] = (bw_real)lower[j];
    t->diagonal[j] = (bw_real)diagonal[j];
    t->upper[j] = (bw_real)upper[j];
  }
  t->cyclic = cyclic;
  t->inner = cyclic || t->me < t->ranks - 1 ? t->rows - 1 : t->rows;
}

bool bw_tridiagonal_coupled(const bw_tridiagonal *t)
{
  return t->cyclic || t->ranks > 1;
}

size_t bw_tridiagonal_volume(const bw_tridiagonal *t)
{
  size_t n = 0;
  for (int p = 0; p < t->ranks; p++)
    if (p != t->me) n += t->tell_count[p] + t->reply_count[p];
  return bw_tridiagonal_coupled(t) ? n * sizeof(bw_real) : 0;
}

/* ---- kernels: one row of n lines ---- */

/* pivot = 1 / (b + shift - ac pivot_before); f = (scale f - a f_before) pivot. */
static void eliminate(int n, bw_real a, bw_real b, bw_real ac, bw_real scale,
                      const bw_real *restrict shift, const bw_real *restrict pivot_before,
                      const bw_real *restrict f_before, bw_real *restrict pivot,
                      bw_real *restrict f)
{
#pragma omp simd
  for (int q = 0; q < n; q++) {
    const bw_real r = (bw_real)1 / (b + shift[q] - ac * pivot_before[q]);
    pivot[q] = r;
    f[q] = (scale * f[q] - a * f_before[q]) * r;
  }
}

static void substitute(int n, bw_real c, const bw_real *restrict pivot,
                       const bw_real *restrict x_after, bw_real *restrict f)
{
#pragma omp simd
  for (int q = 0; q < n; q++)
    f[q] -= c * pivot[q] * x_after[q];
}

/* State of the downward elimination of n lines, see the head. */
typedef struct {
  bw_real f[N], c[N], l[N], F[N], L[N], G[N];
} carried;

static void carry(int n, bw_real a, bw_real b, bw_real c, bw_real scale,
                  const bw_real *restrict shift, const bw_real *restrict f, carried *restrict s)
{
#pragma omp simd
  for (int q = 0; q < n; q++) {
    const bw_real r = (bw_real)1 / (b + shift[q] - a * s->c[q]);
    const bw_real f_row = (scale * f[q] - a * s->f[q]) * r, l_row = -a * s->l[q] * r;
    const bw_real c_row = c * r;
    s->f[q] = f_row;
    s->l[q] = l_row;
    s->c[q] = c_row;
    s->F[q] -= s->G[q] * f_row;
    s->L[q] -= s->G[q] * l_row;
    s->G[q] *= -c_row;
  }
}

/* ---- batches ---- */

/* The shift of local row j: the pinned lines differ in the last row of all. */
static const bw_real *row_shift(const bw_tridiagonal *t, const bw_tridiagonal_batch *b, int j,
                                bw_real pinned[N])
{
  const int at = t->lo + j;
  if (b->pinned == 0 || at != t->n - 1) return b->shift;
  memcpy(pinned, b->shift, (size_t)b->n * sizeof *pinned);
  for (int q = 0; q < b->pinned; q++)
    pinned[q] -= t->lower[at] + t->upper[at];
  return pinned;
}

/* Copy n numbers of plane `which` of lines first.. between the portions and a plain array. */
static void to_portions(const bw_tridiagonal *t, int which, size_t first, int n,
                        const bw_real *from)
{
  for (int p = 0; p < t->ranks; p++) {
    const size_t lo = t->portion[p], hi = t->portion[p + 1], end = first + (size_t)n;
    const size_t a = first > lo ? first : lo, z = end < hi ? end : hi;
    if (a < z)
      memcpy(t->tell + t->tell_start[p] + (hi - lo) * (size_t)which + (a - lo), from + (a - first),
             (z - a) * sizeof *from);
  }
}

static void from_portions(const bw_tridiagonal *t, int which, size_t first, int n, bw_real *to)
{
  for (int p = 0; p < t->ranks; p++) {
    const size_t lo = t->portion[p], hi = t->portion[p + 1], end = first + (size_t)n;
    const size_t a = first > lo ? first : lo, z = end < hi ? end : hi;
    if (a < z)
      memcpy(to + (a - first),
             t->answer + t->answer_start[p] + (hi - lo) * (size_t)which + (a - lo),
             (z - a) * sizeof *to);
  }
}

void bw_tridiagonal_reduce(bw_tridiagonal *t, const bw_tridiagonal_batch *b, const bw_real *f)
{
  const int n = b->n, lo = t->lo;
  bw_real pinned[N];
  carried s = {.f = {0}};
  for (int q = 0; q < n; q++) {
    s.l[q] = -1; /* no row yet: the row before is X-, the first row the one to come */
    s.G[q] = -1;
  }
  for (int j = 0; j < t->inner; j++)
    carry(n, t->lower[lo + j], t->diagonal[lo + j], t->upper[lo + j], b->scale,
          row_shift(t, b, j, pinned), f + j * b->pitch, &s);
  const bw_real u = t->upper[(lo + t->n - 1) % t->n];
  for (int q = 0; q < n; q++) {
    s.F[q] *= u;
    s.L[q] *= u;
    s.G[q] *= u;
  }
  to_portions(t, NEXT_F, b->first, n, s.F);
  to_portions(t, NEXT_L, b->first, n, s.L);
  to_portions(t, NEXT_G, b->first, n, s.G);
  if (t->inner == t->rows) return;
  const int last = t->rows - 1;
  const bw_real a = t->lower[lo + last], d = t->diagonal[lo + last];
  const bw_real *shift = row_shift(t, b, last, pinned), *f_last = f + last * b->pitch;
  for (int q = 0; q < n; q++) {
    s.f[q] = b->scale * f_last[q] - a * s.f[q];
    s.c[q] = d + shift[q] - a * s.c[q];
    s.l[q] *= -a;
  }
  to_portions(t, RIGHT, b->first, n, s.f);
  to_portions(t, DIAGONAL, b->first, n, s.c);
  to_portions(t, SUB, b->first, n, s.l);
}

void bw_tridiagonal_finish(bw_tridiagonal *t, const bw_tridiagonal_batch *b, bw_real *f)
{
  const int n = b->n, lo = t->lo;
  bw_real pinned[N], before[N];
  const bw_real *f_before = t->zero, *pivot_before = t->zero;
  if (bw_tridiagonal_coupled(t)) {
    from_portions(t, BEFORE, b->first, n, before);
    f_before = before;
  }
  for (int j = 0; j < t->inner; j++) {
    const bw_real a = t->lower[lo + j], c_before = j == 0 ? 0 : t->upper[lo + j - 1];
    bw_real *pivot = t->pivot + (size_t)j * N, *row = f + j * b->pitch;
    eliminate(n, a, t->diagonal[lo + j], a * c_before, b->scale, row_shift(t, b, j, pinned),
              pivot_before, f_before, pivot, row);
    pivot_before = pivot;
    f_before = row;
  }
  if (t->inner < t->rows) from_portions(t, OWN, b->first, n, f + t->inner * b->pitch);
  for (int j = (t->inner < t->rows ? t->inner : t->rows - 1) - 1; j >= 0; j--)
    substitute(n, t->upper[lo + j], t->pivot + (size_t)j * N, f + (j + 1) * b->pitch,
               f + j * b->pitch);
}

/* ---- the systems of separators ---- */

/* Plane `which` that rank p told of lines q0.. of my portion. */
static const bw_real *told(const bw_tridiagonal *t, int p, int which, size_t q0)
{
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  return t->hear + t->hear_start[p] + (size_t)which * mine + q0;
}

/* Coefficients of separator p in line q: sub X_{p-1} + dia X_p + sup X_{p+1} = right. */
typedef struct {
  bw_real sub, dia, sup, right;
} equation;

static inline equation separator(const bw_real *const of[PLANES], int q)
{
  return (equation){of[SUB][q], of[DIAGONAL][q] - of[NEXT_L][q], -of[NEXT_G][q],
                    of[RIGHT][q] - of[NEXT_F][q]};
}

static void planes_of(const bw_tridiagonal *t, int p, size_t q0, const bw_real *of[PLANES])
{
  for (int w = 0; w < PLANES; w++)
    of[w] = told(t, w >= NEXT_F ? (p + 1) % t->ranks : p, w, q0);
}

/* x_p = y_p - z_p X_border for the separators below `inner`; those of a cyclic line hang on the
 * border, the last one (z = 0 else). y, z, c: (inner, 3, N) in work. */
static void eliminate_separators(bw_tridiagonal *t, int inner, size_t q0, int n)
{
  const bw_real *of[PLANES], *before = NULL;
  for (int p = 0; p < inner; p++) {
    bw_real *y = t->work + (size_t)p * 3 * N, *z = y + N, *c = z + N;
    planes_of(t, p, q0, of);
    for (int q = 0; q < n; q++) {
      const equation e = separator(of, q);
      const bw_real y0 = p > 0 ? before[q] : 0, z0 = p > 0 ? before[N + q] : 0;
      const bw_real c0 = p > 0 ? before[2 * N + q] : 0, a = p > 0 ? e.sub : 0;
      const bw_real r = (bw_real)1 / (e.dia - a * c0);
      const bw_real to_border = (p == 0 ? e.sub : 0) + (p == inner - 1 ? e.sup : 0);
      y[q] = (e.right - a * y0) * r;
      z[q] = ((t->cyclic ? to_border : 0) - a * z0) * r;
      c[q] = p < inner - 1 ? e.sup * r : 0;
    }
    before = y;
  }
  for (int p = inner - 2; p >= 0; p--) {
    bw_real *y = t->work + (size_t)p * 3 * N, *z = y + N;
    const bw_real *c = z + N, *after = y + 3 * N;
    for (int q = 0; q < n; q++) {
      y[q] -= c[q] * after[q];
      z[q] -= c[q] * after[N + q];
    }
  }
}

/* X of all separators of lines q0.. to everyone's reply. */
static void solve_separators(bw_tridiagonal *t, size_t q0, int n)
{
  const int inner = t->ranks - 1; /* cyclic: all but the border; else all */
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  const bw_real *first = t->work, *last = t->work + (size_t)(inner > 0 ? inner - 1 : 0) * 3 * N;
  const bw_real *of[PLANES];
  bw_real border[N] = {0};
  eliminate_separators(t, inner, q0, n);
  if (t->cyclic) {
    planes_of(t, inner, q0, of);
    for (int q = 0; q < n; q++) {
      const equation e = separator(of, q);
      if (inner == 0)
        border[q] = e.right / (e.sub + e.dia + e.sup);
      else
        border[q] = (e.right - e.sub * last[q] - e.sup * first[q]) /
                    (e.dia - e.sub * last[N + q] - e.sup * first[N + q]);
    }
  }
  for (int p = 0; p < t->ranks; p++) {
    const bw_real *y = t->work + (size_t)p * 3 * N, *z = y + N;
    bw_real *own = t->reply + t->reply_start[p] + (size_t)OWN * mine + q0;
    bw_real *next = t->reply + t->reply_start[(p + 1) % t->ranks] + (size_t)BEFORE * mine + q0;
    for (int q = 0; q < n; q++)
      own[q] = next[q] = p < inner ? y[q] - z[q] * border[q] : border[q];
  }
}

static void keep_own(const bw_tridiagonal *t, const size_t from_start[], const size_t number[],
                     const bw_real *from, const size_t to_start[], bw_real *to)
{
  memcpy(to + to_start[t->me], from + from_start[t->me], number[t->me] * sizeof *to);
}

void bw_tridiagonal_join(bw_tridiagonal *t)
{
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  bw_grid_swap(t->grid, t->d, t->tell_start, t->tell_count, t->tell, t->hear_start, t->hear_count,
               t->hear);
  keep_own(t, t->tell_start, t->tell_count, t->tell, t->hear_start, t->hear);
  for (size_t q0 = 0; q0 < mine; q0 += N)
    solve_separators(t, q0, mine - q0 < N ? (int)(mine - q0) : N);
  bw_grid_swap(t->grid, t->d, t->reply_start, t->reply_count, t->reply, t->answer_start,
               t->answer_count, t->answer);
  keep_own(t, t->reply_start, t->reply_count, t->reply, t->answer_start, t->answer);
}
