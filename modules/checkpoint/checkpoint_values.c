/* Small things every rank knows: rank 0 writes and reads them. */
#include "bw_memory.h"
#include "checkpoint_internal.h"

#include <stdio.h>
#include <string.h>

static bw_checkpoint__slab slab_of(const bw_checkpoint *ck, bw_checkpoint__kind kind, hid_t type,
                                   size_t bytes, size_t n)
{
  const bool first = bw_comm_rank(ck->comm) == 0;
  return (bw_checkpoint__slab){.kind = kind,
                               .type = type,
                               .bytes = bytes,
                               .dimensions = 1,
                               .size = {n},
                               .count = {first ? n : 0}};
}

bw_status bw_checkpoint_put_numbers(bw_checkpoint *ck, const char *name, int n, const double x[])
{
  BW_REQUIRE(n >= 0, BW_EINPUT, "checkpoint %s: '%s' with %d numbers", ck->path, name, n);
  const bw_checkpoint__slab slab =
      slab_of(ck, BW_CHECKPOINT__NUMBERS, H5T_NATIVE_DOUBLE, sizeof *x, (size_t)n);
  return bw_checkpoint__put(ck, name, &slab, x);
}

bw_status bw_checkpoint_get_numbers(bw_checkpoint *ck, const char *name, int n, double x[])
{
  BW_REQUIRE(n >= 0, BW_EINPUT, "checkpoint %s: '%s' with %d numbers", ck->path, name, n);
  const bw_checkpoint__slab slab =
      slab_of(ck, BW_CHECKPOINT__NUMBERS, H5T_NATIVE_DOUBLE, sizeof *x, (size_t)n);
  BW_TRY(bw_checkpoint__get(ck, name, &slab, x));
  /* Rank 0's share is all of it; the others learn it here. */
  bw_comm_broadcast(ck->comm, (size_t)n * sizeof *x, x);
  return BW_OK;
}

bw_status bw_checkpoint_put_text(bw_checkpoint *ck, const char *name, const char *text)
{
  int64_t length = (int64_t)strlen(text); /* rank 0's text counts, and its length */
  bw_comm_broadcast(ck->comm, sizeof length, &length);
  const bw_checkpoint__slab slab =
      slab_of(ck, BW_CHECKPOINT__TEXT, H5T_NATIVE_UINT8, 1, (size_t)length);
  return bw_checkpoint__put(ck, name, &slab, text);
}

bw_status bw_checkpoint_get_text(bw_checkpoint *ck, const char *name, char **text)
{
  size_t length = 0;
  *text = NULL;
  BW_TRY(bw_checkpoint__length(ck, name, BW_CHECKPOINT__TEXT, &length));
  const bw_checkpoint__slab slab = slab_of(ck, BW_CHECKPOINT__TEXT, H5T_NATIVE_UINT8, 1, length);
  /* The allocation is zeroed and one byte longer, so that the text ends. */
  bw_status st = bw_comm_agree(ck->comm, BW_ALLOCATE(text, length + 1));
  BW_THEN(st, bw_checkpoint__get(ck, name, &slab, *text));
  if (st == BW_OK)
    bw_comm_broadcast(ck->comm, length, *text);
  else
    bw_release(text);
  return st;
}
