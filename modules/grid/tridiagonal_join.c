/* The systems of separators, see the head of bw_tridiagonal.c. The lines are dealt out over the
 * ranks: each solves its portion with what all the others told of it, and tells them their
 * separators. */
#include "tridiagonal_internal.h"

#include <string.h>

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
  /* A separator's row reaches into the next rank, which has told what its first row amounts to. */
  for (int w = 0; w < PLANES; w++)
    of[w] = told(t, w >= NEXT_F ? (p + 1) % t->ranks : p, w, q0);
}

/* x_p = y_p - z_p X_border for the separators below `inner`; those of a cyclic line hang on the
 * border, the last one (z = 0 else). y, z, c: (inner, 3, N) in work. */
static void eliminate_separators(bw_tridiagonal *t, int inner, size_t q0, int n)
{
  const bw_real *of[PLANES], *before = NULL;
  /* Thomas over the separators, with two right-hand sides: y for f, z for the unknown X_border. */
  for (int p = 0; p < inner; p++) {
    bw_real *y = t->work + (size_t)p * 3 * N, *z = y + N, *c = z + N;
    planes_of(t, p, q0, of);
    for (int q = 0; q < n; q++) {
      const equation e = separator(of, q);
      const bw_real y0 = p > 0 ? before[q] : 0, z0 = p > 0 ? before[N + q] : 0;
      const bw_real c0 = p > 0 ? before[2 * N + q] : 0, a = p > 0 ? e.sub : 0;
      /* X_border is the neighbour of the first separator and of the last one below it (the same one
       * where there is only one). */
      const bw_real r = (bw_real)1 / (e.dia - a * c0);
      const bw_real to_border = (p == 0 ? e.sub : 0) + (p == inner - 1 ? e.sup : 0);
      y[q] = (e.right - a * y0) * r;
      z[q] = ((t->cyclic ? to_border : 0) - a * z0) * r;
      c[q] = p < inner - 1 ? e.sup * r : 0;
    }
    before = y;
  }
  /* Upward: both solutions of every later separator are complete. */
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
  /* Cyclic: the row of the border, its neighbours expressed through it by y and z, has one unknown
   * left. */
  if (t->cyclic) {
    planes_of(t, inner, q0, of);
    for (int q = 0; q < n; q++) {
      const equation e = separator(of, q);
      /* One rank alone: the line's only separator is its own neighbour on both sides. */
      if (inner == 0)
        border[q] = e.right / (e.sub + e.dia + e.sup);
      else
        border[q] = (e.right - e.sub * last[q] - e.sup * first[q]) /
                    (e.dia - e.sub * last[N + q] - e.sup * first[N + q]);
    }
  }
  /* Each rank gets its own separator and the one before its first row, which is all it needs to
   * finish. */
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
  /* Every rank now hears of its portion of the lines from all ranks of the line of blocks. */
  bw_grid_swap(t->grid, t->d, t->tell_start, t->tell_count, t->tell, t->hear_start, t->hear_count,
               t->hear);
  keep_own(t, t->tell_start, t->tell_count, t->tell, t->hear_start, t->hear);
  /* Batch by batch, in the cache; no rank waits for another here. */
  for (size_t q0 = 0; q0 < mine; q0 += N)
    solve_separators(t, q0, mine - q0 < N ? (int)(mine - q0) : N);
  /* The separators go back to the ranks whose rows they are. */
  bw_grid_swap(t->grid, t->d, t->reply_start, t->reply_count, t->reply, t->answer_start,
               t->answer_count, t->answer);
  keep_own(t, t->reply_start, t->reply_count, t->reply, t->answer_start, t->answer);
}
