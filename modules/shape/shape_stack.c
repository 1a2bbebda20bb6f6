/* Layers from TIFF pages: of one file, or of many files with one page each. */
#include "bw_memory.h"
#include "shape_tiff.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One name: its pages are the layers; several: one layer each. */
typedef struct {
  size_t n, room;
  char **name;
} stack;

static void forget(void *state)
{
  stack *s = state;
  for (size_t q = 0; q < s->n; q++)
    bw_release(&s->name[q]);
  bw_release(&s->name);
  bw_release(&s);
}

static bw_status add(stack *s, const char *folder, const char *name)
{
  if (s->n == s->room) {
    BW_TRY(BW_ENLARGE(&s->name, s->n, 2 * s->room + 64));
    s->room = 2 * s->room + 64;
  }
  const size_t room = strlen(folder) + strlen(name) + 2;
  BW_TRY(BW_ALLOCATE(&s->name[s->n], room));
  snprintf(s->name[s->n++], room, "%s%s%s", folder, folder[0] != 0 ? "/" : "", name);
  return BW_OK;
}

/* ---- rows to the mask ---- */

typedef struct {
  bw_shape_source *source;
  bw_shape_mask *into;
  int64_t k;
} layer;

static void take(void *to, int64_t j, void *row)
{
  const layer *l = to;
  bw_shape__put_row(l->source, j, l->k, row, l->into);
}

/* The present page is that of layer k: is it as the first one was? */
static bw_status check_page(const bw_shape__tiff *t, const bw_shape_voxels *v,
                            bw_shape__tiff_page *p)
{
  BW_TRY(bw_shape__tiff_page_of(t, p));
  BW_REQUIRE(
      p->width == v->size[0] && p->height == v->size[1] && p->type == v->type, BW_EINPUT,
      "%s: page %d has %u x %u voxels of %d bits, the first one %lld x %lld of %zu bytes; all "
      "layers need the same",
      t->path, t->page, p->width, p->height, p->bits, (long long)v->size[0], (long long)v->size[1],
      bw_shape__bytes(v->type));
  return BW_OK;
}

static bw_status next_page(bw_shape__tiff *t)
{
  BW_REQUIRE(TIFFReadDirectory(t->tif) == 1, BW_EIO, "%s: page %d cannot be read: %s", t->path,
             t->page + 1, t->said);
  t->page++;
  return BW_OK;
}

static bw_status read_file(const char *name, bw_shape_source *s, int64_t skip, int64_t pages,
                           layer to)
{
  bw_shape__tiff t;
  bw_shape__tiff_page p;
  bw_status st = bw_shape__tiff_open(name, &t);
  for (int64_t q = 0; q < skip; q++)
    BW_THEN(st, next_page(&t));
  for (int64_t q = 0; q < pages; q++, to.k++) {
    if (q > 0) BW_THEN(st, next_page(&t));
    BW_THEN(st, check_page(&t, &s->v, &p));
    BW_THEN(st, bw_shape__tiff_rows(&t, &p, take, &to));
  }
  bw_shape__tiff_close(&t);
  return st;
}

static bw_status read_stack(bw_shape_source *s, int64_t from, int64_t to, bw_shape_mask *into)
{
  const stack *all = s->state;
  if (from == to) return BW_OK;
  const layer first = {.source = s, .into = into, .k = from};
  if (all->n == 1) return read_file(all->name[0], s, from, to - from, first);
  for (int64_t k = from; k < to; k++)
    BW_TRY(read_file(all->name[k], s, 0, 1, (layer){.source = s, .into = into, .k = k}));
  return BW_OK;
}

static const bw_shape__reader reader = {.read = read_stack, .destroy = forget};

/* ---- sizes, where a program has written them ---- */

/* The word behind `key` in a text, to the next of `end`; false where there is none. */
static bool word_behind(const char *text, const char *key, const char *end, size_t room,
                        char word[])
{
  const char *at = strstr(text, key);
  if (at == NULL) return false;
  at += strlen(key);
  const size_t n = strcspn(at, end);
  if (n == 0 || n >= room) return false;
  memcpy(word, at, n);
  word[n] = 0;
  return true;
}

static bool number_behind(const char *text, const char *key, const char *end, double *x)
{
  char word[64];
  if (!word_behind(text, key, end, sizeof word, word)) return false;
  *x = strtod(word, NULL);
  return isfinite(*x) && *x > 0.0;
}

/* ImageJ: voxels per unit as the resolution of x and y; z and the unit in lines of the description.
 */
static bool imagej(const bw_shape__tiff *t, const char *text, bw_shape__header *h)
{
  float per[2] = {0};
  char unit[64];
  if (strncmp(text, "ImageJ=", 7) != 0 || !word_behind(text, "\nunit=", "\r\n", sizeof unit, unit))
    return false;
  h->about.unit = bw_shape__unit(unit);
  if (isnan(h->about.unit) || !TIFFGetField(t->tif, TIFFTAG_XRESOLUTION, &per[0]) ||
      !TIFFGetField(t->tif, TIFFTAG_YRESOLUTION, &per[1]))
    return false;
  h->v.spacing[0] = 1.0 / (double)per[0], h->v.spacing[1] = 1.0 / (double)per[1];
  return number_behind(text, "\nspacing=", "\r\n", &h->v.spacing[2]);
}

/* OME: attributes of the XML in the description; micrometres where no unit is given. */
static bool ome(const char *text, bw_shape__header *h)
{
  static const char *const size[3] = {"PhysicalSizeX=\"", "PhysicalSizeY=\"", "PhysicalSizeZ=\""};
  static const char *const unit[3] = {"PhysicalSizeXUnit=\"", "PhysicalSizeYUnit=\"",
                                      "PhysicalSizeZUnit=\""};
  for (int d = 0; d < 3; d++) {
    char word[64] = "um";
    if (!number_behind(text, size[d], "\"", &h->v.spacing[d])) return false;
    word_behind(text, unit[d], "\"", sizeof word, word);
    const double metres = bw_shape__unit(word);
    if (isnan(metres)) return false;
    h->v.spacing[d] *= metres;
  }
  h->about.unit = 1.0; /* they are metres now */
  return true;
}

/* A page has a resolution for print, but nothing says how far pages are apart, unless a program of
 * the trade has written it. */
static void find_spacing(const bw_shape__tiff *t, bw_shape__header *h)
{
  const char *text = NULL;
  double spacing[3];
  if (!TIFFGetField(t->tif, TIFFTAG_IMAGEDESCRIPTION, &text) || text == NULL) return;
  h->about.has_spacing = imagej(t, text, h) || ome(text, h);
  memcpy(spacing, h->v.spacing, sizeof spacing);
  for (int d = 0; d < 3; d++)
    if (!(isfinite(spacing[d]) && spacing[d] > 0.0)) h->about.has_spacing = false;
  if (h->about.has_spacing) return;
  h->about.unit = NAN;
  for (int d = 0; d < 3; d++)
    h->v.spacing[d] = 1.0;
}

/* ---- opening ---- */

/* ImageJ writes more than 4 GB as one page with all numbers behind it. */
static bw_status check_count(const bw_shape__tiff *t, int64_t pages)
{
  const char *text = NULL;
  double images;
  TIFFSetDirectory(t->tif, 0);
  if (!TIFFGetField(t->tif, TIFFTAG_IMAGEDESCRIPTION, &text) || text == NULL ||
      strncmp(text, "ImageJ=", 7) != 0 || !number_behind(text, "\nimages=", "\r\n", &images))
    return BW_OK;
  BW_REQUIRE(images == (double)pages, BW_EINPUT,
             "%s: ImageJ speaks of %g images, the file has %lld pages; save it as an image "
             "sequence or as NRRD",
             t->path, images, (long long)pages);
  return BW_OK;
}

/* Size, type and spacing from the first page; all pages of the file have to be alike: *pages. */
static bw_status look_at(const char *name, bw_shape__header *h, int64_t *pages)
{
  bw_shape__tiff t;
  bw_shape__tiff_page p;
  *pages = 1;
  bw_status st = bw_shape__tiff_open(name, &t);
  BW_THEN(st, bw_shape__tiff_page_of(&t, &p));
  if (st == BW_OK && !h->has_size) {
    h->v.size[0] = p.width, h->v.size[1] = p.height;
    h->v.type = p.type;
    h->v.big_endian = bw_shape__machine_is_big(); /* libtiff turns the bytes */
    h->has_size = h->has_type = h->ordered = true;
    find_spacing(&t, h);
  }
  BW_THEN(st, check_page(&t, &h->v, &p));
  while (st == BW_OK && !TIFFLastDirectory(t.tif)) {
    st = next_page(&t);
    BW_THEN(st, check_page(&t, &h->v, &p));
    *pages += 1;
  }
  BW_THEN(st, check_count(&t, *pages));
  bw_shape__tiff_close(&t);
  return st;
}

static bw_status look_at_all(const stack *s, const char *path, bw_shape__header *h)
{
  int64_t pages = 0;
  BW_REQUIRE(s->n > 0, BW_EIO, "%s: no file whose name ends with .tif or .tiff is there", path);
  for (size_t q = 0; q < s->n; q++) {
    BW_TRY(look_at(s->name[q], h, &pages));
    BW_REQUIRE(pages == 1 || s->n == 1, BW_EINPUT,
               "%s: has %lld pages, where each of %zu files is one layer", s->name[q],
               (long long)pages, s->n);
  }
  h->v.size[2] = s->n > 1 ? (int64_t)s->n : pages;
  for (int d = 0; d < 3; d++) {
    if (!isnan(h->about.unit)) h->v.spacing[d] *= h->about.unit;
    h->v.lower[d] = 0.0;
  }
  return BW_OK;
}

/* Takes over the stack. */
static bw_status open_names(bw_status st, stack *s, const char *path, double low, double high,
                            bw_shape_mask **out)
{
  bw_shape__header h = {.path = path,
                        .about = {.format = "TIFF", .unit = NAN},
                        .v = {.size = {1, 1, 1}, .spacing = {1, 1, 1}}};
  *out = NULL;
  if (s == NULL) return st;
  BW_THEN(st, look_at_all(s, path, &h));
  BW_THEN(st, bw_shape__check_voxels(path, &h.v, low, high));
  if (st != BW_OK) {
    forget(s);
    return st;
  }
  BW_TRY(bw_shape__source_create(path, &h.v, low, high, &reader, s, out));
  (*out)->about = h.about;
  return BW_OK;
}

bw_status bw_shape__open_tiff(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out)
{
  stack *s = NULL;
  (void)file; /* libtiff opens it itself */
  bw_status st = BW_ALLOCATE(&s, 1);
  BW_THEN(st, add(s, "", path));
  return open_names(st, s, path, low, high, out);
}

/* Digits count as the number that they are: ct_9 before ct_10. */
static int by_number(const void *a, const void *b)
{
  const char *p = *(char *const *)a, *q = *(char *const *)b;
  while (*p != 0 && *q != 0) {
    if (isdigit((unsigned char)*p) && isdigit((unsigned char)*q)) {
      p += strspn(p, "0"), q += strspn(q, "0");
      const size_t m = strspn(p, "0123456789"), n = strspn(q, "0123456789");
      const int order = m != n ? (m > n) - (m < n) : strncmp(p, q, m);
      if (order != 0) return order;
      p += m, q += n;
    } else {
      if (*p != *q) return (unsigned char)*p - (unsigned char)*q;
      p++, q++;
    }
  }
  /* The same number written differently still has one order. */
  return *p != 0 || *q != 0 ? (*p != 0) - (*q != 0) : strcmp(*(char *const *)a, *(char *const *)b);
}

static bw_status list_folder(const char *path, stack *s)
{
  DIR *folder = opendir(path);
  BW_REQUIRE(folder != NULL, BW_EIO, "%s: cannot be opened: %s", path, strerror(errno));
  bw_status st = BW_OK;
  for (const struct dirent *one; st == BW_OK && (one = readdir(folder)) != NULL;) {
    const char *dot = strrchr(one->d_name, '.');
    if (dot != NULL && (bw_shape__same(dot, ".tif") || bw_shape__same(dot, ".tiff")))
      st = add(s, path, one->d_name);
  }
  closedir(folder);
  return st;
}

static bw_status list_pattern(const char *path, stack *s)
{
  glob_t found = {0};
  bw_status st = BW_OK;
  if (glob(path, 0, NULL, &found) == 0)
    for (size_t q = 0; q < found.gl_pathc && st == BW_OK; q++)
      st = add(s, "", found.gl_pathv[q]);
  globfree(&found);
  if (st == BW_OK && s->n == 0)
    st = BW_FAIL(BW_EIO, "%s: cannot be opened: no file has such a name", path);
  return st;
}

bw_status bw_shape__open_stack(const char *path, bool folder, double low, double high,
                               bw_shape_mask **out)
{
  stack *s = NULL;
  bw_status st = BW_ALLOCATE(&s, 1);
  BW_THEN(st, folder ? list_folder(path, s) : list_pattern(path, s));
  if (st == BW_OK && s->n > 0) qsort(s->name, s->n, sizeof *s->name, by_number);
  return open_names(st, s, path, low, high, out);
}
