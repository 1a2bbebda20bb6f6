/* vtk_read.h -- as much of a reader as the tests need: a file, its XML, its appended blocks. */
#pragma once
#include "bw_check.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  char *bytes;
  size_t size;
  const char *data; /* what offsets count from */
} vtk_file;

/* A folder for the files of this program: one per number of ranks, as tests run side by side. */
static inline void vtk_path(char path[512], const char *name)
{
  const char *folder = getenv("BW_VTK_TEST_DIR");
  const char *build = getenv("BW_BUILD_DIR");
  if (folder != NULL)
    snprintf(path, 512, "%s/%s", folder, name);
  else
    snprintf(path, 512, "%s/vtk_test_np%d/%s", build != NULL ? build : "build",
             bw_comm_size(bw_check_world()), name);
}

static inline vtk_file vtk_open(const char *path)
{
  vtk_file f = {0};
  FILE *file = fopen(path, "rb");
  ck_assert_msg(file != NULL, "cannot open %s", path);
  fseek(file, 0, SEEK_END);
  f.size = (size_t)ftell(file);
  rewind(file);
  f.bytes = calloc(f.size + 1, 1);
  ck_assert_uint_eq(fread(f.bytes, 1, f.size, file), f.size);
  fclose(file);
  static const char mark[] = "<AppendedData encoding=\"raw\">\n_";
  f.data = strstr(f.bytes, mark);
  if (f.data != NULL) f.data += strlen(mark);
  return f;
}

static inline void vtk_close(vtk_file *f)
{
  free(f->bytes);
  f->bytes = NULL;
}

static inline void vtk_has(const vtk_file *f, const char *text)
{
  ck_assert_msg(strstr(f->bytes, text) != NULL, "the file has no '%s'", text);
}

/* Copy the block of the array called `name`: checks its type, components and length. */
static inline void vtk_array(const vtk_file *f, const char *name, const char *type, int components,
                             size_t bytes, void *out)
{
  char head[256];
  snprintf(head, sizeof head,
           "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
           "offset=\"",
           type, name, components);
  const char *at = strstr(f->bytes, head);
  ck_assert_msg(at != NULL, "no array '%s' of type %s and %d components", name, type, components);
  ck_assert_ptr_nonnull(f->data);
  const char *block = f->data + strtoull(at + strlen(head), NULL, 10);
  uint64_t length = 0;
  ck_assert(block + sizeof length + bytes <= f->bytes + f->size);
  memcpy(&length, block, sizeof length);
  ck_assert_msg(length == bytes, "array '%s' has %llu bytes, expected %zu", name,
                (unsigned long long)length, bytes);
  memcpy(out, block + sizeof length, bytes);
}
