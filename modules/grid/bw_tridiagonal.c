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
#include "bw_memory.h"
#include "tridiagonal_internal.h"

#include <string.h>

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
  /* Every rank of the line solves the separators of an equal portion of the lines. */
  for (size_t p = 0; p <= r; p++)
    t->portion[p] = t->lines * p / r;
  /* Ahead every rank tells PLANES numbers of each line, back it gets ANSWERS: the lengths of all
   * messages are fixed here. */
  count(t, PLANES, t->tell_start, t->tell_count, t->hear_start, t->hear_count);
  count(t, ANSWERS, t->answer_start, t->answer_count, t->reply_start, t->reply_count);
  const size_t mine = t->portion[t->me + 1] - t->portion[t->me];
  /* Coefficients are those of the whole line; pivots depend on the line's shift and are kept for
   * one batch only. */
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
  /* The last row of a rank is its separator; the last rank of a line with two ends needs none. */
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
  /* diagonal = -(lower + upper) of a singular line is doubled here, which makes the matrix
   * regular. */
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
  /* Down to the last row before the separator: afterwards x_first = F - L X- - G X+. */
  for (int j = 0; j < t->inner; j++)
    carry(n, t->lower[lo + j], t->diagonal[lo + j], t->upper[lo + j], b->scale,
          row_shift(t, b, j, pinned), f + j * b->pitch, &s);
  /* In the row of the separator before, our first row has this coefficient. */
  const bw_real u = t->upper[(lo + t->n - 1) % t->n];
  for (int q = 0; q < n; q++) {
    s.F[q] *= u;
    s.L[q] *= u;
    s.G[q] *= u;
  }
  to_portions(t, NEXT_F, b->first, n, s.F);
  to_portions(t, NEXT_L, b->first, n, s.L);
  to_portions(t, NEXT_G, b->first, n, s.G);
  /* Without a separator of its own this rank has told all it has to. */
  if (t->inner == t->rows) return;
  /* The separator's own row, with the row before it eliminated: -lower l' X- + (...) X+ =
   * right-hand side. */
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
    /* The row before this rank's first is a separator, known since the join: it enters as a known
     * value. */
    from_portions(t, BEFORE, b->first, n, before);
    f_before = before;
  }
  /* Thomas' elimination downward; the first row has no pivot before it. */
  for (int j = 0; j < t->inner; j++) {
    const bw_real a = t->lower[lo + j], c_before = j == 0 ? 0 : t->upper[lo + j - 1];
    bw_real *pivot = t->pivot + (size_t)j * N, *row = f + j * b->pitch;
    eliminate(n, a, t->diagonal[lo + j], a * c_before, b->scale, row_shift(t, b, j, pinned),
              pivot_before, f_before, pivot, row);
    pivot_before = pivot;
    f_before = row;
  }
  /* This rank's separator is known too and is the row that the substitution begins with. */
  if (t->inner < t->rows) from_portions(t, OWN, b->first, n, f + t->inner * b->pitch);
  /* Upward: every row below j holds x already. */
  for (int j = (t->inner < t->rows ? t->inner : t->rows - 1) - 1; j >= 0; j--)
    substitute(n, t->upper[lo + j], t->pivot + (size_t)j * N, f + (j + 1) * b->pitch,
               f + j * b->pitch);
}
