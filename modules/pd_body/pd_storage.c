/* Storage arrays: values that neighbours read, in lattice order. */
#include "bw_memory.h"
#include "pd_body.h"

const char BW_PD_LANES_NAME(BW_PD_LANES) = BW_PD_LANES;

/* A storage array with room for overrunning loads on both sides; zero there. */
bw_status bw_pd_body_storage_array(size_t n, bw_real **out)
{
  /* Vectors are loaded whole: at either end they may reach beyond the last particle. */
  bw_real *base = NULL;
  BW_TRY(BW_ALLOCATE(&base, n + 2 * BW_PD_PAD));
  *out = base + BW_PD_PAD;
  return BW_OK;
}

void bw_pd_body_release_storage_array(bw_real **array)
{
  if (*array == NULL) return;
  bw_real *base = *array - BW_PD_PAD;
  bw_release(&base);
  *array = NULL;
}
