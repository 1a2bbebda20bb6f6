/* levels_test.h -- what the tests of levels share, of those that stay and of those that change. */
#pragma once
#include "pd_test.h"

#include <string.h>

static inline void levels_shift(const double X0[3], double u[3])
{
  u[0] = 0.02 * sin(2 * X0[0] + 3 * X0[1]);
  u[1] = 0.03 * cos(X0[1] - X0[0]);
  u[2] = 0;
}

/* A small body is refused with this word in the message. */
static inline void levels_refused(const bw_solid_config *c, const char *word)
{
  pd_body body = pd_box(6, 5, c->geometry == BW_PD_3D ? 4 : 1);
  bw_solid *pd = NULL;
  ck_assert_int_eq(bw_solid_create_same(bw_check_world(), c, body.n, body.site, body.kind, &pd),
                   BW_EINPUT);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "%s is not in: %s", word,
                bw_last_message());
  pd_body_release(&body);
}
