/* The pieces of all ranks in one order, without a list of all of them. */
#include "bw_memory.h"
#include "pd_fragment_internal.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = 1000, WORDS = sizeof(bw_pd_fragment) / sizeof(uint64_t) };
_Static_assert(sizeof(bw_pd_fragment) % sizeof(uint64_t) == 0, "a fragment is whole words");

bool bw_pd_fragment__before(const bw_pd_fragment *a, const bw_pd_fragment *b)
{
  if (a->particles != b->particles) return a->particles > b->particles;
  return a->label < b->label;
}

static int in_order(const void *a, const void *b)
{
  return bw_pd_fragment__before(a, b) ? -1 : bw_pd_fragment__before(b, a);
}

void bw_pd_fragment_release(bw_pd_fragments *f)
{
  bw_release(&f->own);
  *f = (bw_pd_fragments){0};
}

/* Size and label of that piece which comes first of those given, one by each rank (NULL: none);
 * where there is none on any rank, particles are 0. Collective. */
static bw_pd_fragment first_of(const bw_comm *comm, const bw_pd_fragment *mine)
{
  int64_t particles = mine != NULL ? mine->particles : 0;
  bw_comm_max_int(comm, 1, &particles);
  const bool largest = mine != NULL && mine->particles == particles;
  int64_t lowest = largest ? -mine->label : INT64_MIN;
  bw_comm_max_int(comm, 1, &lowest);
  return (bw_pd_fragment){.particles = particles, .label = particles > 0 ? -lowest : 0};
}

void bw_pd_fragment__find_largest(const bw_comm *comm, bw_pd_fragments *out)
{
  size_t next = 0; /* of own */
  out->n_largest =
      (size_t)(out->total < BW_PD_FRAGMENT_LARGEST ? out->total : BW_PD_FRAGMENT_LARGEST);
  for (size_t k = 0; k < out->n_largest; k++) {
    const bw_pd_fragment *mine = next < out->n ? &out->own[next] : NULL;
    const bw_pd_fragment first = first_of(comm, mine);
    uint64_t words[WORDS] = {0};
    if (mine != NULL && mine->label == first.label) {
      memcpy(words, mine, sizeof words);
      next++;
    }
    bw_comm_xor(comm, WORDS, words); /* one rank has bits in them */
    memcpy(&out->largest[k], words, sizeof words);
  }
}

bw_status bw_pd_fragment_visit(const bw_comm *comm, const bw_pd_fragments *f,
                               void (*visit)(void *context, size_t n, const bw_pd_fragment piece[]),
                               void *context)
{
  size_t done = 0; /* of own */
  for (int64_t left = f->total; left > 0;) {
    /* Each rank looks BATCH pieces ahead. What does not come after the last one that any rank sees
     * is complete: no rank has another piece that belongs between. */
    const size_t ahead = f->n - done < BATCH ? f->n - done : BATCH;
    const bool more = done + ahead < f->n;
    const bw_pd_fragment last = first_of(comm, more ? &f->own[done + ahead - 1] : NULL);
    size_t n = 0, bytes = 0;
    while (n < ahead && (last.particles == 0 || !bw_pd_fragment__before(&last, &f->own[done + n])))
      n++;
    void *all = NULL;
    BW_TRY(bw_comm_gather(comm, n * sizeof *f->own, n > 0 ? &f->own[done] : NULL, &bytes, &all));
    if (bw_comm_rank(comm) == 0) {
      qsort(all, bytes / sizeof *f->own, sizeof *f->own, in_order);
      visit(context, bytes / sizeof *f->own, all);
    }
    bw_release(&all);
    done += n;
    left = (int64_t)(f->n - done);
    bw_comm_sum_int(comm, 1, &left);
  }
  return BW_OK;
}
