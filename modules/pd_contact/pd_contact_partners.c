/* Lists of partners that grow in a search, not in the steps between searches. */
#include "bw_memory.h"
#include "pd_contact.h"

#include <string.h>

bw_status bw_pd_contact__append(bw_pd_partners *list, int32_t partner)
{
  if (list->n == list->room) {
    bw_pd_partners more = {.n = list->n, .room = 2 * list->room + 1024};
    BW_TRY(BW_ALLOCATE(&more.partner, more.room));
    if (list->n > 0) memcpy(more.partner, list->partner, list->n * sizeof *more.partner);
    bw_release(&list->partner);
    *list = more;
  }
  list->partner[list->n++] = partner;
  return BW_OK;
}

bw_status bw_pd_contact__busy(size_t n, const size_t start[], size_t *n_busy, int32_t **busy)
{
  size_t found = 0;
  for (size_t q = 0; q < n; q++)
    found += start[q] != start[q + 1];
  BW_TRY(BW_ALLOCATE(busy, found));
  *n_busy = 0;
  for (size_t q = 0; q < n; q++)
    if (start[q] != start[q + 1]) (*busy)[(*n_busy)++] = (int32_t)q;
  return BW_OK;
}
