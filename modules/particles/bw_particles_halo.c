#include "bw_particles_halo.h"
#include "bw_memory.h"
#include "bw_particles_copies.h"

#include <string.h>

/* Places that are to be looked up: `capacity` of them have room in the halo's arrays. */
typedef struct {
  const bw_particles_lattice *lattice;
  const bw_particles_map *near;
  bw_particles_halo *halo;
  size_t capacity;
  bw_particles_map seen; /* place -> its number in the list */
  int32_t *own;          /* (n_offset,3) of one particle; NULL: all have the same */
  int me;
} list;

static void home_of(const bw_particles_lattice *lattice, const int32_t place[3], int32_t home[3])
{
  /* Images are looked up where their owner has them. */
  for (int k = 0; k < 3; k++) {
    const int32_t p = lattice->period[k], above = place[k] - lattice->lower[k];
    home[k] = p == 0 ? place[k] : lattice->lower[k] + (above % p + p) % p;
  }
}

static bw_status grow(list *l)
{
  bw_particles_halo larger = {.n = l->halo->n}, *old = l->halo;
  const size_t capacity = 2 * l->capacity + 1024;
  /* The old list stays whole if the new one cannot be made. */
  bw_status st = BW_ALLOCATE(&larger.place, 3 * capacity);
  BW_THEN(st, BW_ALLOCATE(&larger.home, 3 * capacity));
  BW_THEN(st, BW_ALLOCATE(&larger.owner, capacity));
  if (st != BW_OK) {
    bw_particles_halo_destroy(&larger);
    return st;
  }
  if (old->n > 0) {
    memcpy(larger.place, old->place, 3 * old->n * sizeof *old->place);
    memcpy(larger.home, old->home, 3 * old->n * sizeof *old->home);
    memcpy(larger.owner, old->owner, old->n * sizeof *old->owner);
  }
  bw_particles_halo_destroy(old);
  *old = larger;
  l->capacity = capacity;
  return BW_OK;
}

/* Note a place where no own particle is, unless it is noted already or surely empty. */
static bw_status note(list *l, const int32_t place[3])
{
  bw_particles_halo *h = l->halo;
  int32_t home[3], found;
  home_of(l->lattice, place, home);
  const int owner = bw_particles_partition_owner(l->lattice->partition, home);
  /* This rank knows its own particles: at a site of its own, only an image can be met. */
  if (owner == l->me && bw_particles_map_get(l->near, home) < 0) return BW_OK;
  BW_REQUIRE(h->n < INT32_MAX, BW_EINPUT,
             "particles: 2^31 places around those of one rank: take more ranks");
  BW_TRY(bw_particles_map_put(&l->seen, place, (int32_t)h->n, &found));
  if (found >= 0) return BW_OK;
  if (h->n == l->capacity) BW_TRY(grow(l));
  memcpy(h->place + 3 * h->n, place, 3 * sizeof *place);
  memcpy(h->home + 3 * h->n, home, sizeof home);
  h->owner[h->n++] = owner;
  return BW_OK;
}

static bw_status list_places(list *l, size_t n, const int32_t site[])
{
  const bw_particles_map *near = l->near;
  int32_t lower[3], upper[3];
  for (int k = 0; k < 3; k++) {
    lower[k] = (int32_t)near->lower[k];
    upper[k] = (int32_t)(near->lower[k] + near->size[k] - 1);
  }
  /* As wide as the map of own sites, whose margin is the reach of an offset. */
  BW_TRY(bw_particles_map_create(n, lower, upper, &l->seen));
  for (size_t i = 0; i < n; i++) {
    const int32_t *offset = l->lattice->offset;
    int n_offset = l->lattice->n_offset;
    if (l->lattice->offsets_of != NULL) {
      n_offset = l->lattice->offsets_of(l->lattice->context, i, l->own);
      offset = l->own;
    }
    for (int q = 0; q < n_offset; q++) {
      const int32_t *s = site + 3 * i, *o = offset + 3 * q;
      const int32_t place[3] = {s[0] + o[0], s[1] + o[1], s[2] + o[2]};
      if (bw_particles_map_get(near, place) < 0) BW_TRY(note(l, place));
    }
  }
  return BW_OK;
}

static int32_t own_at(const void *context, const void *key)
{
  return bw_particles_map_get(context, key);
}

/* Places that turned out to be empty go out of the list; the others are numbered. */
static bw_status keep_occupied(bw_particles_halo *h, const int32_t index[], size_t n,
                               bw_particles_map *near)
{
  /* The list closes up in place; numbers follow those of the own particles. */
  size_t kept = 0;
  for (size_t q = 0; q < h->n; q++) {
    int32_t found;
    if (index[q] < 0) continue;
    memmove(h->place + 3 * kept, h->place + 3 * q, 3 * sizeof *h->place);
    memmove(h->home + 3 * kept, h->home + 3 * q, 3 * sizeof *h->home);
    h->owner[kept] = h->owner[q];
    BW_REQUIRE(n + kept < INT32_MAX, BW_EINPUT,
               "particles: %zu own ones and their copies exceed 2^31: take more ranks", n);
    BW_TRY(bw_particles_map_put(near, h->place + 3 * kept, (int32_t)(n + kept), &found));
    kept++;
  }
  h->n = kept;
  return BW_OK;
}

bw_status bw_particles_halo_create(const bw_comm *comm, const bw_particles_lattice *lattice,
                                   size_t n, const int32_t site[], bw_particles_map *near,
                                   bw_particles_halo *halo)
{
  int32_t *index = NULL;
  list l = {.lattice = lattice, .near = near, .halo = halo, .me = bw_comm_rank(comm)};
  memset(halo, 0, sizeof *halo);
  bw_status st = grow(&l);
  if (lattice->offsets_of != NULL) BW_THEN(st, BW_ALLOCATE(&l.own, 3 * (size_t)lattice->n_offset));
  /* A single rank has all there is, but for images. */
  const int32_t *period = lattice->period;
  const bool alone = bw_comm_size(comm) == 1 && period[0] + period[1] + period[2] == 0;
  if (!alone) BW_THEN(st, list_places(&l, n, site));
  BW_THEN(st, BW_ALLOCATE(&index, halo->n));
  st = bw_comm_agree(comm, st);
  /* Nobody's map has copies in it while questions are answered: only own particles are found. */
  const bw_particles_question question = {halo->n,    halo->owner, 3 * sizeof *halo->home,
                                          halo->home, own_at,      near};
  BW_THEN(st, bw_particles_ask(comm, &question, index));
  if (st == BW_OK) st = bw_comm_agree(comm, keep_occupied(halo, index, n, near));
  bw_release(&index);
  bw_release(&l.own);
  bw_particles_map_destroy(&l.seen);
  return st;
}

void bw_particles_halo_destroy(bw_particles_halo *halo)
{
  bw_release(&halo->place);
  bw_release(&halo->home);
  bw_release(&halo->owner);
  memset(halo, 0, sizeof *halo);
}
