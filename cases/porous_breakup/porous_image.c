/* A medium from a file: voxels or a closed surface. Sizes are settled before anything is filled. */
#include "bw_memory.h"
#include "porous_body.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char AXIS[3] = {'x', 'y', 'z'};

/* So many times longer than the channel a body from a file has the wrong unit. */
static const double MOST = 10.0;

bw_shape porous_box(const porous_config *q)
{
  const porous_medium *m = &q->medium;
  return (bw_shape){.kind = BW_SHAPE_BOX,
                    .lower = {m->front, 0.0, 0.0},
                    .upper = {m->front + m->length, q->domain.length[1], q->domain.length[2]}};
}

/* The mask, cut to the box of the medium. */
static bw_status cut_mask(const porous_config *q, porous_body *b)
{
  BW_TRY(BW_ALLOCATE(&b->shape, 2 + POROUS_SLABS));
  b->shape[1] = porous_box(q);
  b->shape[0] = (bw_shape){.kind = BW_SHAPE_MASK, .mask = b->mask};
  b->shape[1].remove = b->shape[1].outside = true;
  b->count = 2;
  return BW_OK;
}

/* ---- voxels ---- */

static bool given(const int x[3])
{
  return x[0] != INT_MIN;
}

/* A raw file is laid out as the case says, others as they say themselves. */
static bw_status open_image(const porous_image *m, bw_shape_mask **mask)
{
  if (!given(m->size)) {
    BW_REQUIRE(m->type == INT_MIN && m->skip == 0 && m->byte_order == 0, BW_EINPUT,
               "medium.image: type, byte_order and skip describe a raw file, whose size (voxels "
               "along x, y, z) is missing");
    return bw_shape_mask_open_image(m->file, m->solid[0], m->solid[1], mask);
  }
  BW_REQUIRE(m->type != INT_MIN, BW_EINPUT,
             "medium.image.type is missing: size describes a raw file, e.g. type: uint8");
  bw_shape_voxels v = {.type = (bw_shape_voxel_type)m->type,
                       .big_endian = m->byte_order == 1,
                       .spacing = {1.0, 1.0, 1.0},
                       .skip = m->skip};
  for (int d = 0; d < 3; d++)
    v.size[d] = m->size[d];
  BW_TRY(bw_shape_mask_open_raw(m->file, &v, m->solid[0], m->solid[1], mask));
  (*mask)->about.has_spacing = false;
  return BW_OK;
}

static bw_status cut_image(const porous_image *m, bw_shape_mask *mask)
{
  int64_t from[3], to[3];
  for (int d = 0; d < 3; d++) {
    from[d] = given(m->from) ? m->from[d] : 0;
    to[d] = given(m->to) ? m->to[d] : mask->size[d];
    BW_REQUIRE(from[d] < to[d] && to[d] <= mask->size[d], BW_EINPUT,
               "medium.image.from[%d] = %lld, medium.image.to[%d] = %lld: the image has the voxels "
               "0 to %lld along %c",
               d, (long long)from[d], d, (long long)to[d], (long long)mask->size[d] - 1, AXIS[d]);
  }
  BW_TRY(bw_shape_mask_crop(mask, from, to));
  for (int d = 0; d < 3; d++)
    if (m->flip[d]) BW_TRY(bw_shape_mask_flip(mask, d));
  return BW_OK;
}

static bool is_cube(const double h[3])
{
  return fabs(h[1] / h[0] - 1.0) < 1e-6 && fabs(h[2] / h[0] - 1.0) < 1e-6;
}

/* Edges of a voxel in metres: from the case, or from the file with the unit of one of them. */
static bw_status set_spacing(const porous_image *m, bw_shape_mask *mask)
{
  const bw_shape_about *f = &mask->about;
  double *h = mask->spacing;
  const bool one = !isnan(m->voxel), three = !isnan(m->spacing[0]), unit = m->unit != INT_MIN;
  BW_REQUIRE(one + three + unit <= 1, BW_EINPUT,
             "medium.image: voxel, spacing and unit each give the size of a voxel; give one");
  /* Without a word of the file or the case nobody knows how long a voxel is. */
  BW_REQUIRE(f->has_spacing || one || three, BW_EINPUT,
             "medium.image: %s does not say how large a voxel is; give its edge in m "
             "(medium.image.voxel), or three (medium.image.spacing)%s%s",
             m->file, f->not_read[0] != 0 ? "; its header has keys that are not known: " : "",
             f->not_read);
  if (one) {
    BW_REQUIRE(
        !f->has_spacing || is_cube(h), BW_EINPUT,
        "medium.image.voxel = %g m would make cubes of the voxels of %s, whose edges are %g, "
        "%g and %g; give medium.image.unit of these, or medium.image.spacing",
        m->voxel, m->file, h[0], h[1], h[2]);
    h[0] = h[1] = h[2] = m->voxel;
  }
  if (three) memcpy(h, m->spacing, sizeof m->spacing);
  if (unit) {
    BW_REQUIRE(isnan(f->unit) || f->unit == porous_units[m->unit], BW_EINPUT,
               "medium.image.unit is %g m, but %s says that its spacings are in %g m; leave it out",
               porous_units[m->unit], m->file, f->unit);
    for (int d = 0; d < 3 && isnan(f->unit); d++)
      h[d] *= porous_units[m->unit];
  }
  return BW_OK;
}

/* An image far larger than the channel is in another unit; one smaller than the medium would leave
 * a part of it empty. */
static bw_status check_length(const porous_config *q, const bw_shape_mask *mask)
{
  const bw_shape box = porous_box(q);
  const porous_image *m = &q->medium.image;
  for (int d = 0; d < 3; d++) {
    const double h = mask->spacing[d], have = h * (double)mask->size[d];
    const double need = box.upper[d] - box.lower[d], channel = q->domain.length[d];
    BW_REQUIRE(have <= MOST * channel, BW_EINPUT,
               "medium.image: %s is %g m along %c (%lld voxels of %g m%s), the channel %g m: is it "
               "in another unit (medium.image.unit, or voxel)? Of a larger image take a part "
               "(medium.image.from, to)",
               m->file, have, AXIS[d], (long long)mask->size[d], h,
               isnan(mask->about.unit) ? "; the file names no unit" : "", channel);
    char advice[120] = "";
    if (is_cube(mask->spacing))
      snprintf(advice, sizeof advice, "voxels of %g m (medium.image.voxel) or ",
               need / (double)mask->size[d]);
    BW_REQUIRE(have >= need * (1.0 - 1e-9), BW_EINPUT,
               "medium.image: %s is %g m along %c (%lld voxels of %g m), the medium %g m; the rest "
               "would be empty: take %sa smaller medium",
               m->file, have, AXIS[d], (long long)mask->size[d], h, need, advice);
  }
  return BW_OK;
}

bw_status porous_image_body(const porous_config *q, porous_body *b)
{
  const porous_image *m = &q->medium.image;
  const bw_shape box = porous_box(q);
  snprintf(b->key, sizeof b->key, "medium.image.solid = [%g, %g] of %s", m->solid[0], m->solid[1],
           m->file);
  BW_TRY(open_image(m, &b->mask));
  BW_TRY(cut_image(m, b->mask));
  BW_TRY(set_spacing(m, b->mask));
  if (m->coarsen[0] * m->coarsen[1] * m->coarsen[2] > 1)
    BW_TRY(bw_shape_mask_coarsen(b->mask, m->coarsen));
  BW_TRY(check_length(q, b->mask));
  /* Its corner at the front, on the floor and at z = 0, wherever the file puts it. */
  memcpy(b->mask->lower, box.lower, sizeof b->mask->lower);
  return cut_mask(q, b);
}

/* ---- surfaces ---- */

bw_status porous_surface_body(const porous_config *q, porous_body *b)
{
  const porous_surface *m = &q->medium.surface;
  const bw_shape box = porous_box(q);
  bw_shape_surface_config c = bw_shape_surface_config_default();
  snprintf(b->key, sizeof b->key, "medium.surface.scale = %g of %s", m->scale, m->file);
  c.scale = m->scale;
  c.spacing = q->domain.length[1] / q->domain.cells[1];
  /* The corner of its box where the medium begins; cells are the sites of particles. */
  c.placed = true;
  memcpy(c.at, box.lower, sizeof c.at);
  BW_TRY(bw_shape_mask_open_stl(m->file, &c, &b->mask));
  for (int d = 0; d < 3; d++)
    BW_REQUIRE(
        b->mask->about.length[d] <= MOST * q->domain.length[d], BW_EINPUT,
        "medium.surface: %s is %g m along %c, the channel %g m: is medium.surface.scale = %g "
        "m the length of its unit (0.001 for mm)?",
        m->file, b->mask->about.length[d], AXIS[d], q->domain.length[d], m->scale);
  return cut_mask(q, b);
}

/* ---- what --check tells ---- */

static void tell_format(const porous_config *q, const porous_body *b, bw_log *log)
{
  const bw_shape_mask *m = b->mask;
  const porous_image *said = &q->medium.image;
  const bool assumed = m->about.has_spacing && isnan(m->about.unit) && isnan(said->voxel) &&
                       isnan(said->spacing[0]) && said->unit == INT_MIN;
  if (strcmp(m->about.format, "STL") == 0)
    bw_log_info(log, "surface    a box of %g x %g x %g m", m->about.length[0], m->about.length[1],
                m->about.length[2]);
  else
    bw_log_info(log,
                "image      %s, %lld x %lld x %lld voxels of %g x %g x %g m: a box of %g x %g x "
                "%g m%s",
                m->about.format, (long long)m->size[0], (long long)m->size[1],
                (long long)m->size[2], m->spacing[0], m->spacing[1], m->spacing[2],
                m->spacing[0] * (double)m->size[0], m->spacing[1] * (double)m->size[1],
                m->spacing[2] * (double)m->size[2],
                assumed ? " (the file names no unit: taken as m)" : "");
  if (m->about.not_read[0] != 0)
    bw_log_warn(log, "the image's header has keys that are not known, and not read: %s",
                m->about.not_read);
}

bw_status porous_tell_mask(const bw_comm *comm, const porous_config *q, porous_body *b,
                           bw_case *run)
{
  bw_log *log = bw_case_log(run);
  const bw_shape box = porous_box(q);
  bw_shape_solid solid;
  if (b->mask == NULL) return BW_OK;
  tell_format(q, b, log);
  /* Each rank looks at its share of the layers. */
  const int64_t layers = b->mask->size[2], size = bw_comm_size(comm), rank = bw_comm_rank(comm);
  const int64_t first = layers * rank / size, end = layers * (rank + 1) / size;
  BW_TRY(bw_comm_agree(
      comm, bw_shape_mask_measure(b->mask, first, end - first, box.lower, box.upper, &solid)));
  double sum[3] = {solid.volume, solid.inside, b->mask->about.inside_out};
  bw_comm_sum(comm, 3, sum);
  double whole = 1.0;
  for (int d = 0; d < 3; d++)
    whole *= b->mask->spacing[d] * (double)b->mask->size[d];
  bw_log_info(log,
              "           %g m3 of solid in it, %.2f %%; the medium's box cuts off %.2f %% of "
              "that",
              sum[0], 100.0 * sum[0] / whole,
              sum[0] > 0.0 ? fmax(0.0, 100.0 * (1.0 - sum[1] / sum[0])) : 0.0);
  if (sum[2] > 0.0)
    bw_log_warn(log, "the surface is inside out, its normals point inwards: it has been turned");
  if (b->mask->about.turned > 0)
    bw_log_warn(log,
                "%u facets of the surface pointed to the other side than those around them: "
                "they have been turned",
                b->mask->about.turned);
  return BW_OK;
}
