/* Masks: cells that are held, layers that are fetched, pieces of an image. */
#include "bw_memory.h"
#include "shape_field.h"
#include "shape_source.h"

#include <math.h>
#include <string.h>

static void close_source(bw_shape_mask *mask)
{
  bw_shape_source *from = mask->source;
  if (from == NULL) return;
  if (from->reader != NULL && from->reader->destroy != NULL) from->reader->destroy(from->state);
  bw_release(&from->path);
  bw_release(&mask->source);
}

void bw_shape_mask_destroy(bw_shape_mask **mask)
{
  if (*mask == NULL) return;
  close_source(*mask);
  bw_release(&(*mask)->solid);
  bw_shape__field_destroy(&(*mask)->surface);
  bw_release(mask);
}

bw_status bw_shape__mask_create(const char *path, const int64_t size[3], const double lower[3],
                                const double spacing[3], bw_shape_mask **out)
{
  *out = NULL;
  /* Cells are numbered in 64 bits; memory is asked for layer by layer. */
  double cells = 1;
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(size[d] > 0, BW_EINPUT, "%s: %lld cells in direction %d", path, (long long)size[d],
               d);
    BW_REQUIRE(spacing[d] > 0 && isfinite(spacing[d]) && isfinite(lower[d]), BW_EINPUT,
               "%s: spacing %g and origin %g in direction %d; they must be positive and finite",
               path, spacing[d], lower[d], d);
    cells *= (double)size[d];
  }
  BW_REQUIRE(cells < 1e18, BW_EINPUT, "%s: %g cells cannot be numbered", path, cells);
  bw_shape_mask *mask = NULL;
  BW_TRY(BW_ALLOCATE(&mask, 1));
  memcpy(mask->size, size, sizeof mask->size);
  memcpy(mask->lower, lower, sizeof mask->lower);
  memcpy(mask->spacing, spacing, sizeof mask->spacing);
  mask->about = (bw_shape_about){.format = "raw", .has_spacing = true, .unit = NAN};
  *out = mask;
  return BW_OK;
}

bw_status bw_shape__source_create(const char *path, const bw_shape_voxels *v, double low,
                                  double high, const bw_shape__reader *reader, void *state,
                                  bw_shape_mask **out)
{
  const size_t room = strlen(path) + 1;
  bw_status st = bw_shape__mask_create(path, v->size, v->lower, v->spacing, out);
  BW_THEN(st, BW_ALLOCATE(&(*out)->source, 1));
  if (st == BW_OK) {
    *(*out)->source =
        (bw_shape_source){.v = *v, .low = low, .high = high, .reader = reader, .state = state};
    st = BW_ALLOCATE(&(*out)->source->path, room);
  } else if (reader->destroy != NULL) {
    reader->destroy(state); /* nobody else knows of it yet */
  }
  if (st == BW_OK) memcpy((*out)->source->path, path, room);
  if (st != BW_OK) bw_shape_mask_destroy(out);
  return st;
}

/* ---- what is held ---- */

bool bw_shape_mask_at(const bw_shape_mask *m, int dims, const double x[3])
{
  int64_t at[3] = {0};
  for (int d = 0; d < dims; d++) {
    /* a centre on the face of two cells belongs to the upper one, whatever the rounding */
    const double cell = (x[d] - m->lower[d]) / m->spacing[d] + 1e-9;
    if (!(cell >= 0 && cell < (double)m->size[d])) return false;
    at[d] = (int64_t)cell;
  }
  BW_ASSERT(at[2] >= m->first && at[2] < m->first + m->held);
  return m->solid[at[0] + m->size[0] * (at[1] + m->size[1] * (at[2] - m->first))] != 0;
}

/* Room for these layers in place of those held, all of them empty. */
static bw_status make_room(int64_t first, int64_t layers, bw_shape_mask *mask)
{
  const double cells = (double)layers * (double)mask->size[0] * (double)mask->size[1];
  BW_REQUIRE(cells < 1e11, BW_EINPUT, "%s: %g cells are more than fit into memory",
             mask->source->path, cells);
  /* Layers held before go first: there is never room for both. */
  bw_release(&mask->solid);
  mask->first = mask->held = 0;
  BW_TRY(BW_ALLOCATE(&mask->solid, (size_t)cells));
  mask->first = first;
  mask->held = layers;
  return BW_OK;
}

/* The same layers as the file numbers them; its other ones are not touched. */
static bw_status read_layers(bw_shape_mask *mask, int64_t first, int64_t layers)
{
  bw_shape_source *from = mask->source;
  const int64_t at = from->first[2] + (from->flipped[2] ? mask->size[2] - first - layers : first);
  return from->reader->read(from, at, at + layers, mask);
}

/* Layer k of a coarse mask from the layers that `fine` holds of it. */
static void join_cells(const bw_shape_mask *fine, const int64_t c[3], int64_t k,
                       bw_shape_mask *mask)
{
  uint8_t *row = mask->solid + (k - mask->first) * mask->size[1] * mask->size[0];
  for (int64_t j = 0; j < mask->size[1]; j++, row += mask->size[0])
    for (int64_t i = 0; i < mask->size[0]; i++) {
      int64_t solid = 0;
      for (int64_t z = 0; z < c[2]; z++)
        for (int64_t y = 0; y < c[1]; y++) {
          const int64_t at = k * c[2] + z - fine->first;
          const uint8_t *from = fine->solid + (at * fine->size[1] + j * c[1] + y) * fine->size[0];
          for (int64_t x = 0; x < c[0]; x++)
            solid += from[i * c[0] + x];
        }
      row[i] = 2 * solid >= c[0] * c[1] * c[2];
    }
}

/* The layers that a coarse mask holds, some of them at a time: 64 MB of the file's voxels, and one
 * layer at least. */
static bw_status read_coarse(bw_shape_mask *mask)
{
  static const double at_once = 64e6;
  const int64_t *c = mask->source->coarse, end = mask->first + mask->held;
  bw_shape_mask fine = *mask;
  bw_status st = BW_OK;
  fine.solid = NULL, fine.held = 0;
  for (int d = 0; d < 3; d++)
    fine.size[d] *= c[d];
  const double layer = (double)fine.size[0] * (double)fine.size[1] * (double)c[2];
  const int64_t many = (int64_t)fmax(1.0, floor(at_once / layer));
  for (int64_t k = mask->first, some; k < end && st == BW_OK; k += some) {
    some = k + many < end ? many : end - k;
    st = make_room(k * c[2], some * c[2], &fine);
    BW_THEN(st, read_layers(&fine, k * c[2], some * c[2]));
    for (int64_t q = k; st == BW_OK && q < k + some; q++)
      join_cells(&fine, c, q, mask);
  }
  mask->about = fine.about;
  bw_release(&fine.solid);
  return st;
}

bw_status bw_shape_mask_hold(bw_shape_mask *mask, int64_t first, int64_t layers)
{
  BW_REQUIRE(first >= 0 && layers >= 0 && first <= mask->size[2] - layers, BW_EINPUT,
             "mask: there are no layers %lld .. %lld of %lld", (long long)first,
             (long long)(first + layers), (long long)mask->size[2]);
  /* What is asked for may be here already. */
  if (first >= mask->first && first + layers <= mask->first + mask->held) return BW_OK;
  BW_TRY(make_room(first, layers, mask));
  const bw_status st =
      mask->source->coarse[0] > 0 ? read_coarse(mask) : read_layers(mask, first, layers);
  /* Half read is not held. */
  if (st != BW_OK) mask->held = 0;
  return st;
}

bw_status bw_shape__mask_all(bw_status st, bw_shape_mask **mask)
{
  BW_THEN(st, bw_shape_mask_hold(*mask, 0, (*mask)->size[2]));
  /* All layers are here: the file is not needed any more. */
  if (st == BW_OK)
    close_source(*mask);
  else
    bw_shape_mask_destroy(mask);
  return st;
}

/* ---- pieces ---- */

bw_status bw_shape_mask_crop(bw_shape_mask *mask, const int64_t from[3], const int64_t to[3])
{
  BW_REQUIRE(mask->source != NULL && mask->source->coarse[0] == 0, BW_EINPUT,
             "mask: only an open one can be cropped, before it is coarsened");
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(from[d] >= 0 && from[d] < to[d] && to[d] <= mask->size[d], BW_EINPUT,
               "%s: crop from %lld to %lld in direction %d; it has voxels 0 .. %lld",
               mask->source->path, (long long)from[d], (long long)to[d], d,
               (long long)mask->size[d]);
  for (int d = 0; d < 3; d++) {
    mask->source->first[d] += mask->source->flipped[d] ? mask->size[d] - to[d] : from[d];
    mask->lower[d] += (double)from[d] * mask->spacing[d];
    mask->size[d] = to[d] - from[d];
  }
  mask->first = mask->held = 0;
  return BW_OK;
}

bw_status bw_shape_mask_flip(bw_shape_mask *mask, int axis)
{
  BW_REQUIRE(mask->source != NULL && mask->source->coarse[0] == 0, BW_EINPUT,
             "mask: only an open one can be flipped, before it is coarsened");
  BW_REQUIRE(axis >= 0 && axis <= 2, BW_EINPUT, "mask: axis = %d has to be 0, 1 or 2", axis);
  mask->source->flipped[axis] = !mask->source->flipped[axis];
  mask->first = mask->held = 0;
  return BW_OK;
}

bw_status bw_shape_mask_coarsen(bw_shape_mask *mask, const int factor[3])
{
  const int64_t none[3] = {0};
  int64_t to[3];
  BW_REQUIRE(mask->source != NULL && mask->source->coarse[0] == 0, BW_EINPUT,
             "mask: only an open one can be coarsened, and once");
  for (int d = 0; d < 3; d++) {
    BW_REQUIRE(factor[d] >= 1 && factor[d] <= mask->size[d], BW_EINPUT,
               "%s: blocks of %d cells along %c; from 1 to the %lld that there are",
               mask->source->path, factor[d], "xyz"[d], (long long)mask -> size[d]);
    to[d] = mask->size[d] - mask->size[d] % factor[d];
  }
  BW_TRY(bw_shape_mask_crop(mask, none, to));
  for (int d = 0; d < 3; d++) {
    mask->source->coarse[d] = factor[d];
    mask->size[d] /= factor[d];
    mask->spacing[d] *= factor[d];
  }
  return BW_OK;
}

/* ---- how much of it is solid ---- */

/* The part of cell `at` along direction d that lies within lower .. upper. */
static double part_within(const bw_shape_mask *m, int d, int64_t at, double lower, double upper)
{
  const double a = m->lower[d] + (double)at * m->spacing[d], b = a + m->spacing[d];
  return fmax(0.0, (fmin(b, upper) - fmax(a, lower)) / m->spacing[d]);
}

/* Solid cells of the layers held, and the same weighted by their part within the box, both in
 * cells; part[] has room for size[0]. */
static void add_held(const bw_shape_mask *m, const double lower[3], const double upper[3],
                     double part[], bw_shape_solid *sum)
{
  for (int64_t i = 0; i < m->size[0]; i++)
    part[i] = part_within(m, 0, i, lower[0], upper[0]);
  const uint8_t *row = m->solid;
  for (int64_t k = m->first; k < m->first + m->held; k++)
    for (int64_t j = 0; j < m->size[1]; j++, row += m->size[0]) {
      const double share =
          part_within(m, 1, j, lower[1], upper[1]) * part_within(m, 2, k, lower[2], upper[2]);
      double inside = 0.0;
      int64_t solid = 0;
      for (int64_t i = 0; i < m->size[0]; i++) {
        solid += row[i];
        inside += row[i] * part[i];
      }
      sum->volume += (double)solid;
      sum->inside += share * inside;
    }
}

bw_status bw_shape_mask_measure(bw_shape_mask *mask, int64_t first, int64_t layers,
                                const double lower[3], const double upper[3], bw_shape_solid *solid)
{
  /* So many layers at a time that they take some megabytes, and one at least. */
  const int64_t many = (int64_t)(4e6 / (double)mask->size[0] / (double)mask->size[1]) + 1;
  bw_shape_solid sum = {0};
  double *part = NULL;
  *solid = sum;
  BW_TRY(BW_ALLOCATE(&part, (size_t)mask->size[0]));
  bw_status st = BW_OK;
  /* What holds all of its layers is looked at where it lies. */
  const int64_t step = mask->source == NULL ? layers : many;
  for (int64_t k = first; k < first + layers && st == BW_OK; k += step) {
    const int64_t some = k + step < first + layers ? step : first + layers - k;
    st = bw_shape_mask_hold(mask, k, some);
    bw_shape_mask held = *mask;
    if (st != BW_OK) break;
    /* More may be held than is asked for here. */
    held.solid += (k - held.first) * held.size[0] * held.size[1];
    held.first = k, held.held = some;
    add_held(&held, lower, upper, part, &sum);
  }
  bw_release(&part);
  const double cell = mask->spacing[0] * mask->spacing[1] * mask->spacing[2];
  *solid = (bw_shape_solid){.volume = cell * sum.volume, .inside = cell * sum.inside};
  return st;
}
