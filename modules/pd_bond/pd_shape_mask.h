/* pd_shape_mask.h -- shared by the readers of masks. */
#pragma once
#include "bw_pd_shape_mask.h"

/* An empty mask; `path` names it in messages. */
bw_status bw_pd_mask__create(const char *path, const int64_t size[3], const double lower[3],
                             const double spacing[3], bw_pd_mask **out) BW_MUST_CHECK;
