/* shape_source.h -- shared by the readers of masks: where layers come from, headers in making. */
#pragma once
#include "bw_shape_mask.h"
#include <stdio.h>

/* How a kind of file gives its layers. */
typedef struct {
  /* All rows of the file's layers from <= k < to, each once and in any order, to
   * bw_shape__put_row. */
  bw_status (*read)(bw_shape_source *source, int64_t from, int64_t to, bw_shape_mask *into);
  /* Frees source->state; NULL: there is nothing to free. */
  void (*destroy)(void *state);
} bw_shape__reader;

/* From where and how an open mask reads its layers. */
struct bw_shape_source {
  char *path;        /* of the numbers, for messages too */
  bw_shape_voxels v; /* of the whole file */
  double low, high;  /* values of a solid voxel */
  int64_t first[3];  /* the voxel of the file that lies first in the mask, counted in the file */
  bool flipped[3];   /* the mask goes from high to low numbers of the file */
  int64_t coarse[3]; /* voxels of the file in a cell of the mask; 0: one, as it is read */
  const bw_shape__reader *reader;
  void *state; /* the reader's own */
};

/* What a header has said so far, whatever its format. */
typedef struct {
  const char *path;  /* of the header */
  bw_shape_voxels v; /* skip: in the data, unpacked where they are compressed */
  bw_shape_about about;
  int dims; /* 2 or 3 */
  bool has_type, has_size, ordered;
  bool attached;    /* the numbers follow the header in the same file ... */
  int64_t end;      /* ... from this byte on */
  bool at_end;      /* the numbers are the last bytes of the file, whatever is before */
  bool compressed;  /* by zlib */
  bool reversed[3]; /* an axis runs against x, y or z */
  double origin[3]; /* centre of the first voxel */
  char data[4096];  /* name of the data file, beside the header */
} bw_shape__header;

/* A word and the type that it stands for; NULL ends a list. */
typedef struct {
  const char *word;
  bw_shape_voxel_type type;
} bw_shape__type_word;

/* Opens a file that is there, is no folder or device (which could keep us waiting for ever), and
 * may be read; BW_EIO has the system's reason. *length: its bytes. Local. */
bw_status bw_shape__open(const char *path, FILE **file, int64_t *length) BW_MUST_CHECK;

/* Bytes of a number. Local. */
size_t bw_shape__bytes(bw_shape_voxel_type type);
/* Is the first byte of a number in memory the largest? Local. */
bool bw_shape__machine_is_big(void);

/* An open mask whose layers `reader` gives: takes over `state`, also after a failure. Local. */
bw_status bw_shape__source_create(const char *path, const bw_shape_voxels *v, double low,
                                  double high, const bw_shape__reader *reader, void *state,
                                  bw_shape_mask **out) BW_MUST_CHECK;

/* Row j of the file's layer k, v.size[0] numbers as in the file, to the mask where it has this row;
 * the row's bytes are turned in place. Local. */
void bw_shape__put_row(const bw_shape_source *source, int64_t j, int64_t k, void *row,
                       bw_shape_mask *into);

/* Can these numbers be read at all? BW_EINPUT. Local. */
bw_status bw_shape__check_voxels(const char *path, const bw_shape_voxels *v, double low,
                                 double high) BW_MUST_CHECK;
/* Are `length` bytes exactly what the voxels need behind those skipped? The message says which way
 * it differs. Local. */
bw_status bw_shape__check_length(const char *path, const bw_shape_voxels *v,
                                 int64_t length) BW_MUST_CHECK;

/* A mask that was opened with status `st`, with all of its layers and without its file; destroyed
 * after a failure. Local. */
bw_status bw_shape__mask_all(bw_status st, bw_shape_mask **mask) BW_MUST_CHECK;
/* A mask of which nothing is held yet; `path` names it in messages. Local. */
bw_status bw_shape__mask_create(const char *path, const int64_t size[3], const double lower[3],
                                const double spacing[3], bw_shape_mask **out) BW_MUST_CHECK;

/* Opened by one of the following with the same arguments: numbers as they are, or packed by zlib or
 * gzip (`skip` bytes before the packed ones, v->skip in the unpacked ones). Local. */
bw_status bw_shape__open_packed(const char *path, int64_t skip, const bw_shape_voxels *v,
                                double low, double high, bw_shape_mask **out) BW_MUST_CHECK;

/* Readers of formats: what the file says, into an open mask. `file` (at its start) stays the
 * caller's. Local. */
bw_status bw_shape__open_nrrd(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape__open_meta(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape__open_npy(const char *path, FILE *file, double low, double high,
                             bw_shape_mask **out) BW_MUST_CHECK;
bw_status bw_shape__open_tiff(const char *path, FILE *file, double low, double high,
                              bw_shape_mask **out) BW_MUST_CHECK;
/* A stack of TIFF files, one a layer, in the order of the numbers in their names: those of a
 * folder, or those whose path matches a pattern of the shell. Local. */
bw_status bw_shape__open_stack(const char *path, bool folder, double low, double high,
                               bw_shape_mask **out) BW_MUST_CHECK;

/* ---- headers of text ---- */

/* Are the words the same but for capitals? Local. */
bool bw_shape__same(const char *a, const char *b);
/* Blanks off the end; the place where the text begins is returned. Local. */
char *bw_shape__trim(char *text);
/* A unit of length, in or without quotes, in metres; NaN for what is none. Local. */
double bw_shape__unit(const char *word);
/* `n` finite numbers with any of " ,()[]" between them and nothing behind. Local. */
bw_status bw_shape__numbers(const bw_shape__header *h, const char *key, const char *value, int n,
                            double out[]) BW_MUST_CHECK;
/* Values of keys that formats share. Local. */
bw_status bw_shape__set_type(bw_shape__header *h, const bw_shape__type_word types[],
                             const char *value) BW_MUST_CHECK;
bw_status bw_shape__set_dims(bw_shape__header *h, const char *key, const char *value) BW_MUST_CHECK;
bw_status bw_shape__set_size(bw_shape__header *h, const char *key, const char *value) BW_MUST_CHECK;
bw_status bw_shape__set_spacing(bw_shape__header *h, const char *key,
                                const char *value) BW_MUST_CHECK;
bw_status bw_shape__set_order(bw_shape__header *h, const char *key, const char *value,
                              const char *big, const char *little) BW_MUST_CHECK;
bw_status bw_shape__set_skip(bw_shape__header *h, const char *key, const char *value) BW_MUST_CHECK;
/* Rows of a matrix that has to be diagonal; the sizes on it to out (3), their signs to reversed
 * (3). Local. */
bw_status bw_shape__set_directions(bw_shape__header *h, const char *key, const char *value,
                                   double out[3]) BW_MUST_CHECK;
/* A unit of length that the file names; what is none is refused. Local. */
bw_status bw_shape__set_unit(bw_shape__header *h, const char *key, const char *value) BW_MUST_CHECK;
/* Remember a key that is not read. Local. */
void bw_shape__not_read(bw_shape__header *h, const char *key);
/* The mask of a header that has been read to its end. Local. */
bw_status bw_shape__open_header(bw_shape__header *h, double low, double high,
                                bw_shape_mask **out) BW_MUST_CHECK;
