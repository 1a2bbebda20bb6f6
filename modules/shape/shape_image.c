/* Which format an image file has. */
#include "shape_internal.h"
#include "shape_source.h"

#include <string.h>
#include <sys/stat.h>

enum { MAGIC = 8 };

static bool is_nrrd(const unsigned char *first, const char *suffix)
{
  (void)suffix;
  return memcmp(first, "NRRD000", 7) == 0;
}

static bool is_npy(const unsigned char *first, const char *suffix)
{
  (void)suffix;
  return memcmp(first, "\x93NUMPY", 6) == 0;
}

/* Little- and big-endian, each as it was and with 64 bits. */
static bool is_tiff(const unsigned char *first, const char *suffix)
{
  (void)suffix;
  return memcmp(first, "II*\0", 4) == 0 || memcmp(first, "MM\0*", 4) == 0 ||
         memcmp(first, "II+\0", 4) == 0 || memcmp(first, "MM\0+", 4) == 0;
}

/* The format has no magic word. */
static bool is_meta(const unsigned char *first, const char *suffix)
{
  (void)first;
  return bw_shape__same(suffix, ".mhd") || bw_shape__same(suffix, ".mha");
}

/* A format is one row. */
static const struct {
  bool (*is)(const unsigned char *first, const char *suffix);
  bw_status (*open)(const char *path, FILE *file, double low, double high, bw_shape_mask **out);
} formats[] = {{is_nrrd, bw_shape__open_nrrd},
               {is_npy, bw_shape__open_npy},
               {is_tiff, bw_shape__open_tiff},
               {is_meta, bw_shape__open_meta}};

bw_status bw_shape_mask_open_image(const char *path, double low, double high, bw_shape_mask **out)
{
  FILE *file = NULL;
  int64_t length;
  struct stat about;
  unsigned char first[MAGIC + 1] = "";
  *out = NULL;
  /* Several files: a folder, or a pattern of the shell that is no file's name. */
  const bool there = stat(path, &about) == 0, folder = there && S_ISDIR(about.st_mode);
  if (folder || (!there && strpbrk(path, "*?[") != NULL))
    return bw_shape__open_stack(path, folder, low, high, out);
  BW_TRY(bw_shape__open(path, &file, &length));
  const size_t n = fread(first, 1, MAGIC, file);
  const char *name = strrchr(path, '/'), *dot = strrchr(name != NULL ? name : path, '.');
  const char *suffix = dot != NULL ? dot : "";
  size_t row = 0;
  const size_t rows = sizeof formats / sizeof formats[0];
  while (row < rows && !formats[row].is(first, suffix))
    row++;
  rewind(file);
  bw_status st;
  if (row < rows)
    st = formats[row].open(path, file, low, high, out);
  else
    st = BW_FAIL(BW_EINPUT,
                 "%s: is no image that is read: it neither begins as NRRD, TIFF or npy (%zu bytes: "
                 "%02x %02x %02x %02x) nor is called .mhd or .mha; a raw one needs its size",
                 path, n, first[0], first[1], first[2], first[3]);
  fclose(file);
  return st;
}

bw_status bw_shape_mask_read_image(const char *path, double low, double high, bw_shape_mask **out)
{
  return bw_shape__mask_all(bw_shape_mask_open_image(path, low, high, out), out);
}
