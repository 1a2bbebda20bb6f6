/* checkpoint_internal.h -- shared by the sources of checkpoint only. */
#pragma once
#include "bw_checkpoint.h"

#include <hdf5.h>

struct bw_checkpoint {
  const bw_comm *comm;
  char *path, *part; /* final name; name while being written (NULL when reading) */
  hid_t file;        /* negative: closed */
  bw_status failed;  /* the first failure of a put */
};

/* What a data set is, stored beside it so that one is not read as the other. */
typedef enum {
  BW_CHECKPOINT__NUMBERS,
  BW_CHECKPOINT__TEXT,
  BW_CHECKPOINT__FIELD,
  BW_CHECKPOINT__TABLE
} bw_checkpoint__kind;

typedef struct {
  bw_checkpoint__kind kind;
  hid_t type;                 /* of the elements, in memory and in the file */
  size_t bytes;               /* of one element, at most 8 */
  int dimensions;             /* 1 .. 3, slowest first */
  hsize_t size[3];            /* of the whole data set */
  hsize_t start[3], count[3]; /* this rank's share; an empty one is fine */
} bw_checkpoint__slab;

/* Elements of this rank's share. */
size_t bw_checkpoint__elements(const bw_checkpoint__slab *slab);

/* Create the data set and write every rank's share with its checksum. */
bw_status bw_checkpoint__put(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab,
                             const void *data) BW_MUST_CHECK;

/* Read every rank's share; the shares together have to be the whole. Type, sizes and checksum are
 * compared with what the file says. */
bw_status bw_checkpoint__get(bw_checkpoint *ck, const char *name, const bw_checkpoint__slab *slab,
                             void *data) BW_MUST_CHECK;

/* The size of a data set of one dimension. */
bw_status bw_checkpoint__length(bw_checkpoint *ck, const char *name, bw_checkpoint__kind kind,
                                size_t *length) BW_MUST_CHECK;

/* A whole number of 8 bytes kept as an attribute of a file or data set. The calls of HDF5's
 * attributes return false on any failure. */
bool bw_checkpoint__put_attribute(hid_t object, const char *name, uint64_t value);
bool bw_checkpoint__get_attribute(hid_t object, const char *name, uint64_t *value);

/* What this process goes on writing to the file of that name goes into memory, to be forgotten. */
void bw_checkpoint__lose(const char *path);
