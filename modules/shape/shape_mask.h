/* shape_mask.h -- shared by the readers of masks. */
#pragma once
#include "bw_shape_mask.h"

/* An empty mask; `path` names it in messages. */
bw_status bw_shape__mask_create(const char *path, const int64_t size[3], const double lower[3],
                                const double spacing[3], bw_shape_mask **out) BW_MUST_CHECK;
