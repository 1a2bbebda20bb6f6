/* Volume that enters and leaves inside the box: div u = its rate in those cells. */
#include "bw_memory.h"
#include "ns_channel_internal.h"

#include <string.h>

static bw_status make_room(bw_ns_sources *s, size_t n)
{
  if (n <= s->room) return BW_OK;
  s->room = 0;
  bw_release(&s->cell);
  bw_release(&s->rate);
  BW_TRY(BW_ALLOCATE(&s->cell, 2 * n));
  BW_TRY(BW_ALLOCATE(&s->rate, 2 * n));
  s->room = 2 * n;
  return BW_OK;
}

bw_status bw_ns_channel_set_sources(bw_ns_channel *ns, size_t n, const ptrdiff_t cell[],
                                    const double rate[])
{
  bw_ns_sources *s = &ns->sources;
  s->n = 0;
  BW_TRY(make_room(s, n));
  if (n > 0) {
    memcpy(s->cell, cell, n * sizeof *cell);
    memcpy(s->rate, rate, n * sizeof *rate);
  }
  s->n = n;
  return BW_OK;
}

void bw_ns__sources_take(const bw_ns_channel *ns, double scale, bw_real *f)
{
  const bw_ns_sources *s = &ns->sources;
  for (size_t q = 0; q < s->n; q++)
    f[s->cell[q]] -= (bw_real)(scale * s->rate[q]);
}

void bw_ns__sources_destroy(bw_ns_channel *ns)
{
  bw_release(&ns->sources.cell);
  bw_release(&ns->sources.rate);
}
