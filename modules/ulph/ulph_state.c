/* The state on its way into a checkpoint and back. */
#include "bw_memory.h"
#include "ulph_internal.h"

/* Numbers of the whole: time, time of the lists, steps, lists made, first energy; then the book and
 * what the forces give per time. */
enum { PLAIN = 5, BOOK = BW_ULPH__LINES + 6 * BW_ULPH__PUSHES };

void bw_ulph_state_get(const bw_ulph *u, double rows[], double numbers[])
{
  for (size_t i = 0; i < u->fluid.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    double *row = rows + BW_ULPH_ROW * i;
    memcpy(row, p->x, sizeof p->x);
    memcpy(row + 3, p->v, sizeof p->v);
    memcpy(row + 6, p->a, sizeof p->a);
    memcpy(row + 9, p->at, sizeof p->at);
    memcpy(row + 12, p->shift, sizeof p->shift);
    row[15] = p->rho;
    row[16] = p->m;
  }
  memset(numbers, 0, BW_ULPH_NUMBERS * sizeof *numbers);
  const double plain[PLAIN] = {u->time, u->time_built, (double)u->steps, (double)u->rebuilds,
                               u->first_energy};
  memcpy(numbers, plain, sizeof plain);
  memcpy(numbers + PLAIN, &u->book, sizeof u->book);
  memcpy(numbers + PLAIN + BOOK, &u->rate, sizeof u->rate);
}

static void take_row(const bw_ulph *u, int64_t id, const double row[], bw_ulph__particle *p)
{
  const double c2 = u->config.c0 * u->config.c0;
  *p = (bw_ulph__particle){.id = id, .wall = -1, .rho = row[15], .m = row[16]};
  memcpy(p->x, row, sizeof p->x);
  memcpy(p->v, row + 3, sizeof p->v);
  memcpy(p->a, row + 6, sizeof p->a);
  memcpy(p->at, row + 9, sizeof p->at);
  memcpy(p->shift, row + 12, sizeof p->shift);
  p->p = c2 * (p->rho - u->config.rho0);
}

/* Fluid of the rows, and the walls that were there. */
static bw_status replace(bw_ulph *u, size_t n, const int64_t id[], const double rows[])
{
  bw_ulph__particle *own = NULL;
  BW_TRY(BW_ALLOCATE(&own, n + u->wall.own + u->face.own));
  for (size_t i = 0; i < n; i++)
    take_row(u, id[i], rows + BW_ULPH_ROW * i, own + i);
  const size_t others = u->wall.own + u->face.own;
  if (others > 0) memcpy(own + n, u->own + u->wall.first, others * sizeof *own);
  bw_release(&u->own);
  u->own = own;
  u->n = n + others;
  u->fluid.own = u->wall.first = n;
  u->face.first = n + u->wall.own;
  return BW_OK;
}

/* Every identity once: numbers and sums of them and of their squares are as they should be. */
static bw_status check_ids(const bw_ulph *u, size_t n, const int64_t id[])
{
  uint64_t mix[2] = {0, 0};
  int64_t count = (int64_t)n;
  bool inside = true;
  for (size_t i = 0; i < n; i++) {
    inside = inside && id[i] >= 0 && id[i] < u->total;
    mix[0] ^= (uint64_t)id[i] * UINT64_C(0x9e3779b97f4a7c15);
  }
  for (int64_t k = 0; k < u->total && bw_comm_rank(u->comm) == 0; k++)
    mix[1] ^= (uint64_t)k * UINT64_C(0x9e3779b97f4a7c15);
  bw_comm_xor(u->comm, 2, mix);
  bw_comm_sum_int(u->comm, 1, &count);
  if (inside && count == u->total && mix[0] == mix[1]) return BW_OK;
  return BW_FAIL(BW_EINPUT,
                 "ulph: a state of %lld particles, or with numbers that are not 0 .. %lld, "
                 "for a fluid of %lld: it belongs to another set-up",
                 (long long)count, (long long)u->total - 1, (long long)u->total);
}

bw_status bw_ulph_state_set(bw_ulph *u, size_t n, const int64_t id[], const double rows[],
                            const double numbers[])
{
  BW_TRY(bw_comm_agree(u->comm, check_ids(u, n, id)));
  BW_TRY(bw_comm_agree(u->comm, replace(u, n, id, rows)));
  u->time_built = numbers[1];
  /* Lists as they were made then, so that sums go on in the same order ... */
  bw_ulph__move_walls(u, u->time_built);
  BW_TRY(bw_ulph__rebuild(u));
  /* ... and everything else as it is now. */
  u->time = numbers[0];
  u->steps = (int64_t)numbers[2];
  u->rebuilds = (int64_t)numbers[3];
  u->first_energy = numbers[4];
  memcpy(&u->book, numbers + PLAIN, sizeof u->book);
  memcpy(&u->rate, numbers + PLAIN + BOOK, sizeof u->rate);
  bw_ulph__move_walls(u, u->time);
  u->started = true;
  return BW_OK;
}
