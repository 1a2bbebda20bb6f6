#include "bw_particles_migrate.h"
#include "bw_exchange.h"
#include "bw_memory.h"
#include "bw_particles_partition.h"

#include <math.h>
#include <string.h>

/* Cells are told apart this far from `lower`: 2^21 in all, as the partition allows. `near` looks at
 * all cells in reach of a point, which should be few. */
enum { FARTHEST = 1 << 20, REACH = 4 };

struct bw_particles_space {
  const bw_comm *comm;
  double lower[3], edge[3]; /* edges with a whole number of cells in a period [L] */
  double least;             /* the edge asked for [L] */
  int32_t count[3];         /* cells in a period, 0: not periodic */
  bw_particles_partition *partition;
};

bw_particles_space_config bw_particles_space_config_default(void)
{
  return (bw_particles_space_config){.edge = NAN};
}

static bw_status check(const bw_particles_space_config *config)
{
  BW_REQUIRE(isfinite(config->edge) && config->edge > 0, BW_EINPUT,
             "particles: space in cells with an edge of %g; it must be above 0", config->edge);
  for (int k = 0; k < 3; k++) {
    BW_REQUIRE(isfinite(config->lower[k]), BW_EINPUT,
               "particles: lower[%d] = %g; a finite position is needed", k, config->lower[k]);
    BW_REQUIRE(isfinite(config->period[k]) && config->period[k] >= 0, BW_EINPUT,
               "particles: the period %g in direction %d; it must be above 0, or 0 for none",
               config->period[k], k);
  }
  return BW_OK;
}

/* Cell number of a coordinate, not wrapped. fmin and fmax leave out what is not a number. */
static int32_t number(const bw_particles_space *s, int k, double x)
{
  const double cell = floor((x - s->lower[k]) / s->edge[k]);
  return (int32_t)fmax(-FARTHEST, fmin(FARTHEST - 1, cell));
}

static int32_t wrap(const bw_particles_space *s, int k, int32_t cell)
{
  const int32_t n = s->count[k];
  return n == 0 ? cell : (cell % n + n) % n;
}

static void cell_of(const bw_particles_space *s, const double x[3], int32_t cell[3])
{
  for (int k = 0; k < 3; k++)
    cell[k] = wrap(s, k, number(s, k, x[k]));
}

static bw_status divide(bw_particles_space *s, size_t n, const double x[])
{
  /* A division of cells weighted by the points in them. */
  int32_t *cell = NULL;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&cell, 3 * n));
  for (size_t q = 0; q < n && st == BW_OK; q++)
    cell_of(s, x + 3 * q, cell + 3 * q);
  BW_THEN(st, bw_particles_partition_create(s->comm, n, cell, &s->partition));
  bw_release(&cell);
  return st;
}

static void lay_out(const bw_comm *comm, const bw_particles_space_config *config,
                    bw_particles_space *s)
{
  s->comm = comm;
  s->least = config->edge;
  for (int k = 0; k < 3; k++) {
    /* A whole number of cells goes into a period; the edge becomes a little longer. */
    const double p = config->period[k];
    s->lower[k] = config->lower[k];
    s->count[k] = p > 0 ? (int32_t)fmin(FARTHEST, fmax(1, floor(p / config->edge))) : 0;
    s->edge[k] = p > 0 ? p / s->count[k] : config->edge;
  }
}

bw_status bw_particles_space_create(const bw_comm *comm, const bw_particles_space_config *config,
                                    size_t n, const double x[], bw_particles_space **out)
{
  bw_particles_space *s = NULL;
  *out = NULL;
  BW_TRY(bw_comm_agree(comm, check(config)));
  bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&s, 1));
  if (st == BW_OK) {
    lay_out(comm, config, s);
    st = divide(s, n, x);
  }
  if (st != BW_OK) bw_particles_space_destroy(&s);
  *out = s;
  return st;
}

void bw_particles_space_destroy(bw_particles_space **space)
{
  if (*space == NULL) return;
  bw_particles_partition_destroy(&(*space)->partition);
  bw_release(space);
}

int bw_particles_space_owner(const bw_particles_space *s, const double x[3])
{
  int32_t cell[3];
  cell_of(s, x, cell);
  return bw_particles_partition_owner(s->partition, cell);
}

/* Cells within reach of a coordinate, first .. last, not wrapped; each cell of a period once. */
static void cells_in_reach(const bw_particles_space *s, int k, double x, double reach,
                           int32_t *first, int32_t *last)
{
  /* Wider by more than what round-off can do to the number of a cell: 2^20 times 2^-52. */
  const double wide = reach + 1e-9 * s->edge[k];
  *first = number(s, k, x - wide);
  *last = number(s, k, x + wide);
  if (s->count[k] > 0 && *last - *first >= s->count[k]) *last = *first + s->count[k] - 1;
}

/* Ranks other than this one that own a cell within reach of x: rank[] (their number is returned).
 * seen[size] < stamp, set to stamp for those that are listed. */
static size_t ranks_near(const bw_particles_space *s, const double x[3], double reach, size_t stamp,
                         size_t seen[], int rank[])
{
  const int me = bw_comm_rank(s->comm);
  /* A box of cells holds the ball of this reach; a few corners too many cost little. */
  int32_t first[3], last[3], at[3], cell[3];
  size_t n = 0;
  for (int k = 0; k < 3; k++)
    cells_in_reach(s, k, x[k], reach, &first[k], &last[k]);
  for (at[2] = first[2]; at[2] <= last[2]; at[2]++)
    for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
      for (at[0] = first[0]; at[0] <= last[0]; at[0]++) {
        for (int k = 0; k < 3; k++)
          cell[k] = wrap(s, k, at[k]);
        /* Each rank once, though several of its cells may be in reach. */
        const int r = bw_particles_partition_owner(s->partition, cell);
        if (r == me || seen[r] == stamp) continue;
        seen[r] = stamp;
        rank[n++] = r;
      }
  return n;
}

/* Room for `size` more rows beyond n. */
static bw_status grow(size_t n, size_t size, size_t *capacity, int32_t **own, int **destination)
{
  if (n + size <= *capacity) return BW_OK;
  /* Twofold, so that many calls cost no more than a few copies. */
  const size_t larger = 2 * *capacity + size + 1024;
  int32_t *o = NULL;
  int *d = NULL;
  bw_status st = BW_ALLOCATE(&o, larger);
  BW_THEN(st, BW_ALLOCATE(&d, larger));
  if (st != BW_OK) {
    bw_release(&o);
    return st;
  }
  if (n > 0) memcpy(o, *own, n * sizeof *o);
  if (n > 0) memcpy(d, *destination, n * sizeof *d);
  bw_release(own);
  bw_release(destination);
  *own = o;
  *destination = d;
  *capacity = larger;
  return BW_OK;
}

bw_status bw_particles_space_near(const bw_particles_space *s, size_t n, const double x[],
                                  double reach, size_t *rows, int32_t **own, int **destination)
{
  const size_t size = (size_t)bw_comm_size(s->comm);
  size_t *seen = NULL, capacity = 0;
  *rows = 0;
  *own = NULL;
  *destination = NULL;
  BW_REQUIRE(reach > 0 && reach <= REACH * s->least, BW_EINPUT,
             "particles: a reach of %g across cells with an edge of %g; up to %d edges are allowed",
             reach, s->least, REACH);
  BW_REQUIRE(n <= INT32_MAX, BW_EINPUT,
             "particles: %zu points on one rank; below 2^31 can be numbered: take more ranks", n);
  bw_status st = BW_ALLOCATE(&seen, size);
  BW_THEN(st, grow(0, size, &capacity, own, destination));
  for (size_t q = 0; q < n && st == BW_OK; q++) {
    /* Its ranks are written straight to the end of the list: room for all that there may be. */
    st = grow(*rows, size, &capacity, own, destination);
    if (st != BW_OK) break;
    const size_t found = ranks_near(s, x + 3 * q, reach, q + 1, seen, *destination + *rows);
    for (size_t k = 0; k < found; k++)
      (*own)[(*rows)++] = (int32_t)q;
  }
  bw_release(&seen);
  if (st != BW_OK) {
    bw_release(own);
    bw_release(destination);
    *rows = 0;
  }
  return st;
}

/* The plan that takes each point to its owner. */
static bw_status plan_way(const bw_particles_space *s, size_t n, const double x[],
                          bw_exchange **plan)
{
  int *destination = NULL;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&destination, n));
  for (size_t q = 0; q < n && st == BW_OK; q++)
    destination[q] = bw_particles_space_owner(s, x + 3 * q);
  BW_THEN(st, bw_exchange_create(s->comm, n, destination, plan));
  bw_release(&destination);
  return st;
}

bw_status bw_particles_migrate(const bw_particles_space *s, size_t n, const double x[],
                               size_t bytes, const void *rows, size_t *n_out, double **x_out,
                               void **rows_out)
{
  bw_exchange *plan = NULL;
  double *there = NULL;
  void *with = NULL;
  bw_status st = plan_way(s, n, x, &plan);
  if (st == BW_OK) {
    /* Counts have been exchanged; room is made before the first point leaves. */
    *n_out = bw_exchange_received(plan);
    st = BW_ALLOCATE(&there, 3 * *n_out);
    BW_THEN(st, bw_allocate(*n_out, bytes, &with));
    st = bw_comm_agree(s->comm, st);
  }
  if (st == BW_OK) {
    /* Places and rows travel by the same plan, and stay in the same order. */
    bw_exchange_forward(plan, 3 * sizeof *there, x, there);
    if (bytes > 0) bw_exchange_forward(plan, bytes, rows, with);
  } else {
    bw_release(&there);
    bw_release(&with);
    *n_out = 0;
  }
  bw_exchange_destroy(&plan);
  *x_out = there;
  *rows_out = with;
  return st;
}

/* The last step of splitmix64 (Steele, Lea & Flood 2014): every bit of z moves every bit. */
static uint64_t mixed(uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

uint64_t bw_particles_checksum(const bw_comm *comm, size_t n, size_t bytes, const void *rows)
{
  uint64_t sum = 0;
  for (size_t q = 0; q < n; q++) {
    const unsigned char *row = (const unsigned char *)rows + q * bytes;
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (size_t at = 0; at < bytes; at += sizeof hash) {
      uint64_t piece = 0;
      memcpy(&piece, row + at, bytes - at < sizeof piece ? bytes - at : sizeof piece);
      hash = mixed(hash ^ piece) + 0x9e3779b97f4a7c15u;
    }
    sum += hash;
  }
  /* Halves are summed, so that nothing overflows; the whole is the sum modulo 2^64. */
  int64_t half[2] = {(int64_t)(sum & 0xffffffffu), (int64_t)(sum >> 32)};
  bw_comm_sum_int(comm, 2, half);
  return (uint64_t)half[0] + ((uint64_t)half[1] << 32);
}
