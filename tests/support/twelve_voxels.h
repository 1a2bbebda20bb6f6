/* twelve_voxels.h -- an image of 3 x 2 x 2 voxels in any format, for tests of its readers. */
#pragma once
#include "bw_check.h"
#include "bw_shape_mask.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* 3 x 2 x 2 voxels of the values 0 to 11; solid where 5 <= v <= 8. */
enum { CELLS = 12, NX = 3, NY = 2, NZ = 2 };
static const unsigned char CONTENT[CELLS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

/* Names of this process. */
static inline const char *path_of(const char *name)
{
  static char path[4][300];
  static int which;
  which = (which + 1) % 4;
  const char *folder = getenv("BW_BUILD_DIR");
  snprintf(path[which], sizeof path[which], "%s/formats_%d_%s", folder != NULL ? folder : ".",
           (int)getpid(), name);
  return path[which];
}

static inline void write_file(const char *name, const char *head, const void *data, size_t bytes)
{
  FILE *file = fopen(path_of(name), "wb");
  ck_assert_ptr_nonnull(file);
  ck_assert_uint_eq(fwrite(head, 1, strlen(head), file), strlen(head));
  if (bytes > 0) ck_assert_uint_eq(fwrite(data, 1, bytes, file), bytes);
  fclose(file);
}

static inline void expect_cells(const bw_shape_mask *m)
{
  ck_assert(m->size[0] == NX && m->size[1] == NY && m->size[2] == NZ);
  for (int q = 0; q < CELLS; q++)
    ck_assert_msg(m->solid[q] == (q >= 5 && q <= 8), "cell %d is %d", q, m->solid[q]);
}

static inline void expect_spacing(const bw_shape_mask *m, double x, double y, double z)
{
  const double h[3] = {x, y, z};
  ck_assert(m->about.has_spacing);
  for (int d = 0; d < 3; d++)
    ck_assert_msg(fabs(m->spacing[d] / h[d] - 1) < 1e-6, "spacing %g for %g", m->spacing[d], h[d]);
}

static inline bw_shape_mask *must_read(const char *name)
{
  bw_shape_mask *m = NULL;
  bw_check_ok(bw_shape_mask_read_image(path_of(name), 5, 8, &m));
  expect_cells(m);
  return m;
}

static inline void must_refuse(const char *name, const char *word)
{
  bw_shape_mask *m = NULL;
  const bw_status st = bw_shape_mask_read_image(path_of(name), 5, 8, &m);
  ck_assert_msg(st != BW_OK, "%s is read, which should say %s", name, word);
  ck_assert_ptr_null(m);
  ck_assert_msg(strstr(bw_last_message(), word) != NULL, "%s: message \"%s\" lacks \"%s\"", name,
                bw_last_message(), word);
}
