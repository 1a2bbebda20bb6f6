/* One data set: created, written and read by all ranks, each its share; checked on reading. */
#include "bw_mix.h"
#include "checkpoint_internal.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char checksum_name[] = "checksum", kind_attribute[] = "kind";

static const char *kind_name(uint64_t kind)
{
  static const char *const names[] = {"numbers", "a text", "a field", "a table"};
  return kind < sizeof names / sizeof *names ? names[kind] : "of unknown kind";
}

size_t bw_checkpoint__elements(const bw_checkpoint__slab *slab)
{
  size_t n = 1;
  for (int d = 0; d < slab->dimensions; d++)
    n *= (size_t)slab->count[d];
  return n;
}

/* `bytes` is a constant where this is inlined, so that no copy is left in the loop. */
static inline uint64_t hash_elements(uint64_t index, size_t n, size_t bytes,
                                     const unsigned char *data)
{
  uint64_t hash = 0;
  for (size_t i = 0; i < n; i++) {
    uint64_t bits = 0;
    memcpy(&bits, data + i * bytes, bytes);
    /* The place is part of what is hashed: values in each other's place are noticed. Exclusive or
     * commutes, so that the sum does not depend on who held what. */
    hash ^= bw_mix(bits + bw_mix(index + i + 1));
  }
  return hash;
}

/* A run of elements whose place in the whole data set begins at `index`. */
static uint64_t hash_run(uint64_t index, size_t n, size_t bytes, const unsigned char *data)
{
  if (bytes == 8) return hash_elements(index, n, 8, data);
  if (bytes == 4) return hash_elements(index, n, 4, data);
  return hash_elements(index, n, bytes, data);
}

/* The share as runs along the fastest direction. */
static uint64_t hash_share(const bw_checkpoint__slab *slab, const void *data)
{
  hsize_t size[3] = {1, 1, 1}, start[3] = {0, 0, 0}, count[3] = {1, 1, 1};
  /* One or two dimensions are three of which the slowest have one entry. */
  for (int d = 0, e = 3 - slab->dimensions; d < slab->dimensions; d++, e++)
    size[e] = slab->size[d], start[e] = slab->start[d], count[e] = slab->count[d];
  const unsigned char *at = data;
  uint64_t hash = 0;
  for (hsize_t k = start[0]; k < start[0] + count[0]; k++)
    for (hsize_t j = start[1]; j < start[1] + count[1]; j++) {
      /* Place of this run in the whole data set, whatever the partition. */
      const uint64_t index = (k * size[1] + j) * size[2] + start[2];
      hash ^= hash_run(index, (size_t)count[2], slab->bytes, at);
      at += (size_t)count[2] * slab->bytes;
    }
  return hash;
}

static uint64_t checksum(const bw_checkpoint *ck, const bw_checkpoint__slab *slab, const void *data)
{
  uint64_t hash = bw_checkpoint__elements(slab) > 0 ? hash_share(slab, data) : 0;
  bw_comm_xor(ck->comm, 1, &hash);
  return hash;
}

/* Layers of the slowest direction that this share moves in one operation: what MPI's counts of
 * bytes can say for any share, and at least one layer. */
static hsize_t layers_at_once(const bw_checkpoint *ck, const bw_checkpoint__slab *slab)
{
  hsize_t layer = slab->bytes;
  for (int d = 1; d < slab->dimensions; d++)
    layer *= slab->size[d]; /* that of the whole: all ranks find the same */
  const hsize_t most = layer > 0 ? bw_comm_message_limit(ck->comm) / layer : 1;
  return most > 0 ? most : 1;
}

/* Move layers first .. first + n of the share between memory and the open data set, all ranks in
 * one operation. */
static bool transfer_layers(hid_t set, const bw_checkpoint__slab *slab, hsize_t first, hsize_t n,
                            const unsigned char *from, unsigned char *to)
{
  bw_checkpoint__slab part = *slab;
  part.start[0] += first;
  part.count[0] = n;
  const hsize_t moved = bw_checkpoint__elements(&part);
  const hid_t memory = H5Screate_simple(1, &moved, NULL), file = H5Dget_space(set);
  const hid_t together = H5Pcreate(H5P_DATASET_XFER);
  bool ok = memory >= 0 && file >= 0 && together >= 0 &&
            H5Pset_dxpl_mpio(together, H5FD_MPIO_COLLECTIVE) >= 0;
  /* An empty share takes part with an empty selection. */
  if (ok && moved > 0)
    ok = H5Sselect_hyperslab(file, H5S_SELECT_SET, part.start, NULL, part.count, NULL) >= 0;
  else if (ok)
    ok = H5Sselect_none(memory) >= 0 && H5Sselect_none(file) >= 0;
  /* No early way out: the others wait in the transfer. */
  if (from != NULL)
    ok = H5Dwrite(set, slab->type, memory, file, together, from) >= 0 && ok;
  else
    ok = H5Dread(set, slab->type, memory, file, together, to) >= 0 && ok;
  if (together >= 0) H5Pclose(together);
  if (file >= 0) H5Sclose(file);
  if (memory >= 0) H5Sclose(memory);
  return ok;
}

/* Move the share between memory and the open data set. Every rank makes as many operations as the
 * one with the most layers needs: nearly always one. */
static bool transfer(const bw_checkpoint *ck, hid_t set, const bw_checkpoint__slab *slab,
                     const unsigned char *from, unsigned char *to)
{
  const hsize_t most = layers_at_once(ck, slab), mine = slab->count[0];
  const size_t layer = mine > 0 ? bw_checkpoint__elements(slab) / (size_t)mine * slab->bytes : 0;
  int64_t rounds = 1;
  if (slab->size[0] > most) { /* known to all, as sizes are */
    rounds = (int64_t)((mine + most - 1) / most);
    bw_comm_max_int(ck->comm, 1, &rounds);
  }
  bool ok = true;
  for (int64_t q = 0; q < rounds; q++) {
    const hsize_t begin = (hsize_t)q * most, first = begin < mine ? begin : mine;
    const hsize_t n = mine - first < most ? mine - first : most;
    const size_t at = (size_t)first * layer;
    ok = transfer_layers(set, slab, first, n, from != NULL ? from + at : NULL,
                         to != NULL ? to + at : NULL) &&
         ok;
  }
  return ok;
}

static hid_t create(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab)
{
  const hid_t space = H5Screate_simple(slab->dimensions, slab->size, NULL);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE), layout = H5Pcreate(H5P_DATASET_CREATE);
  /* A name may have folders; they are made as needed. */
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER); /* all of it is written below */
  const hid_t set = H5Dcreate2(ck->file, name, slab->type, space, links, layout, H5P_DEFAULT);
  if (layout >= 0) H5Pclose(layout);
  if (links >= 0) H5Pclose(links);
  if (space >= 0) H5Sclose(space);
  return set;
}

static bool is_empty(const bw_checkpoint__slab *slab)
{
  for (int d = 0; d < slab->dimensions; d++)
    if (slab->size[d] == 0) return true;
  return false;
}

static bw_status put(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab,
                     const void *data)
{
  /* Collective, hence before the first refusal; all ranks then find the same below. */
  const uint64_t sum = checksum(ck, slab, data);
  const unsigned char nothing = 0;
  BW_REQUIRE(ck->part != NULL, BW_EINPUT, "checkpoint %s is open for reading: cannot put '%s'",
             ck->path, name);
  BW_REQUIRE(!bw_checkpoint_has(ck, name), BW_EINPUT,
             "checkpoint %s: data set '%s' is written twice", ck->part, name);
  /* The name is free on all ranks: HDF5 makes the data set collectively. */
  const hid_t set = create(ck, name, slab);
  bw_status st = bw_comm_agree(
      ck->comm, set >= 0 ? BW_OK
                         : BW_FAIL(BW_EIO, "checkpoint %s: HDF5 cannot create the data set '%s'",
                                   ck->part, name));
  if (st == BW_OK) {
    /* Kind and checksum stand beside the values; a failure is remembered, for the transfer is
     * collective. */
    bool ok = bw_checkpoint__put_attribute(set, kind_attribute, slab->kind) &&
              bw_checkpoint__put_attribute(set, checksum_name, sum);
    if (!is_empty(slab)) ok = transfer(ck, set, slab, data != NULL ? data : &nothing, NULL) && ok;
    if (!ok)
      st = BW_FAIL(BW_EIO, "checkpoint %s: cannot write the data set '%s' (is the disk full?)",
                   ck->part, name);
  }
  if (set >= 0 && H5Dclose(set) < 0 && st == BW_OK)
    st = BW_FAIL(BW_EIO, "checkpoint %s: cannot close the data set '%s'", ck->part, name);
  return bw_comm_agree(ck->comm, st);
}

bw_status bw_checkpoint__put(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab,
                             const void *data)
{
  const bw_status st = put(ck, name, slab, data);
  if (ck->part != NULL && ck->failed == BW_OK) ck->failed = st;
  return st;
}

/* "4 x 5 x 6" */
static void print_sizes(char *out, size_t room, int dimensions, const hsize_t size[])
{
  size_t used = 0;
  out[0] = '\0';
  for (int d = 0; d < dimensions && used < room; d++)
    used += (size_t)snprintf(out + used, room - used, "%s%" PRIu64, d > 0 ? " x " : "",
                             (uint64_t)size[d]);
}

/* Sizes of an open data set; false when it has not 1 to 3 dimensions. */
static bool sizes_of(hid_t set, int *dimensions, hsize_t size[3])
{
  const hid_t space = H5Dget_space(set);
  *dimensions = space >= 0 ? H5Sget_simple_extent_ndims(space) : -1;
  const bool ok =
      *dimensions >= 1 && *dimensions <= 3 && H5Sget_simple_extent_dims(space, size, NULL) >= 0;
  if (space >= 0) H5Sclose(space);
  return ok;
}

static bw_status check_sizes(const bw_checkpoint *ck, const char *name, hid_t set,
                             const bw_checkpoint__slab *slab)
{
  int dimensions = 0;
  hsize_t size[3] = {0};
  char found[80], expected[80];
  BW_REQUIRE(sizes_of(set, &dimensions, size), BW_EIO,
             "checkpoint %s: the sizes of data set '%s' are not readable; use an earlier one",
             ck->path, name);
  /* Both sizes go into the message: the user sees which grid the file was written for. */
  const bool same = dimensions == slab->dimensions &&
                    memcmp(size, slab->size, sizeof size[0] * (size_t)dimensions) == 0;
  print_sizes(found, sizeof found, dimensions, size);
  print_sizes(expected, sizeof expected, slab->dimensions, slab->size);
  BW_REQUIRE(same, BW_EIO,
             "checkpoint %s: data set '%s' has size %s, expected %s; restart with the case that "
             "wrote it",
             ck->path, name, found, expected);
  return BW_OK;
}

static bw_status check_kind(const bw_checkpoint *ck, const char *name, hid_t set,
                            bw_checkpoint__kind expected)
{
  uint64_t kind = 0;
  BW_REQUIRE(bw_checkpoint__get_attribute(set, kind_attribute, &kind), BW_EIO,
             "checkpoint %s: data set '%s' has no readable kind; use an earlier one", ck->path,
             name);
  BW_REQUIRE(kind == (uint64_t)expected, BW_EIO,
             "checkpoint %s: data set '%s' is %s, expected %s; restart with the case that wrote it",
             ck->path, name, kind_name(kind), kind_name((uint64_t)expected));
  return BW_OK;
}

static bw_status check_type(const bw_checkpoint *ck, const char *name, hid_t set, hid_t expected)
{
  const hid_t type = H5Dget_type(set);
  const bool same = type >= 0 && H5Tequal(type, expected) > 0;
  if (type >= 0) H5Tclose(type);
  BW_REQUIRE(same, BW_EIO,
             "checkpoint %s: data set '%s' has elements of another type than expected; restart "
             "with the case that wrote it",
             ck->path, name);
  return BW_OK;
}

static bw_status open_set(bw_checkpoint *ck, const char *name, hid_t *set)
{
  *set = H5I_INVALID_HID;
  BW_REQUIRE(ck->part == NULL, BW_EINPUT,
             "checkpoint %s is open for writing: cannot get '%s' from it", ck->path, name);
  BW_REQUIRE(bw_checkpoint_has(ck, name), BW_EIO,
             "checkpoint %s: there is no data set '%s'; restart with the case that wrote it",
             ck->path, name);
  /* It is listed, but may be damaged all the same. */
  *set = H5Dopen2(ck->file, name, H5P_DEFAULT);
  return bw_comm_agree(
      ck->comm, *set >= 0
                    ? BW_OK
                    : BW_FAIL(BW_EIO, "checkpoint %s: data set '%s' is damaged; use an earlier one",
                              ck->path, name));
}

static bw_status check_all(const bw_checkpoint *ck, const char *name, hid_t set,
                           const bw_checkpoint__slab *slab, uint64_t *sum)
{
  BW_TRY(check_kind(ck, name, set, slab->kind));
  BW_TRY(check_type(ck, name, set, slab->type));
  BW_TRY(check_sizes(ck, name, set, slab));
  BW_REQUIRE(bw_checkpoint__get_attribute(set, checksum_name, sum), BW_EIO,
             "checkpoint %s: data set '%s' has no readable checksum; use an earlier one", ck->path,
             name);
  return BW_OK;
}

static bw_status read_share(bw_checkpoint *ck, const char *name, hid_t set,
                            const bw_checkpoint__slab *slab, void *data)
{
  unsigned char nothing = 0;
  const bool ok = is_empty(slab) || transfer(ck, set, slab, NULL, data != NULL ? data : &nothing);
  BW_REQUIRE(ok, BW_EIO, "checkpoint %s: data set '%s' cannot be read; use an earlier one",
             ck->path, name);
  return BW_OK;
}

bw_status bw_checkpoint__get(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab,
                             void *data)
{
  hid_t set = H5I_INVALID_HID;
  uint64_t expected = 0;
  bw_status st = open_set(ck, name, &set);
  /* Of the kind, type and sizes asked for: otherwise nothing is read into the caller's array. */
  BW_THEN(st, bw_comm_agree(ck->comm, check_all(ck, name, set, slab, &expected)));
  BW_THEN(st, bw_comm_agree(ck->comm, read_share(ck, name, set, slab, data)));
  if (set >= 0) H5Dclose(set);
  if (st != BW_OK) return st;
  /* What arrived in memory is hashed, by all ranks together, and compared with what was written. */
  const uint64_t found = checksum(ck, slab, data);
  BW_REQUIRE(found == expected, BW_EIO,
             "checkpoint %s: data set '%s' is damaged (checksum %016" PRIx64
             ", expected %016" PRIx64 "); use an earlier one",
             ck->path, name, found, expected);
  return BW_OK;
}

bw_status bw_checkpoint__length(bw_checkpoint *ck, const char *name, bw_checkpoint__kind kind,
                                size_t *length)
{
  hid_t set = H5I_INVALID_HID;
  int dimensions = 0;
  hsize_t size[3] = {0};
  bw_status st = open_set(ck, name, &set);
  if (st == BW_OK) {
    /* The length of a text is not known before it is read; that it is one is checked first. */
    st = check_kind(ck, name, set, kind);
    if (st == BW_OK && !(sizes_of(set, &dimensions, size) && dimensions == 1))
      st = BW_FAIL(BW_EIO, "checkpoint %s: the size of data set '%s' is not readable", ck->path,
                   name);
    st = bw_comm_agree(ck->comm, st);
  }
  if (set >= 0) H5Dclose(set);
  *length = (size_t)size[0];
  return st;
}
