/* vtk_internal.h -- shared by the sources of vtk only: the XML text and the appended data. */
#pragma once
#include "bw_vtk.h"

/* Buffers of MPI while a file is open: measured with Open MPI 4.1. */
#define BW_VTK__FILE_BYTES (0.3 * 1048576.0)

#include "bw_file.h"
#include <stddef.h>
#include <stdint.h>

/* A text that grows; zero-initialise. After a failure `status` keeps the reason and further
 * additions do nothing, so that a header is written straight down and checked once. */
typedef struct {
  char *chars; /* owned, zero-terminated */
  size_t used, room;
  bw_status status;
} bw_vtk__text;

void bw_vtk__add(bw_vtk__text *text, const char *fmt, ...) BW_PRINTF(2, 3);
/* A name as an attribute value: & < > " are escaped. */
void bw_vtk__add_escaped(bw_vtk__text *text, const char *name);

/* What XML calls an element type, and its size; a row per bw_vtk_type. */
typedef struct {
  const char *name;
  size_t bytes;
} bw_vtk__kind;
const bw_vtk__kind *bw_vtk__kind_of(bw_vtk_type type); /* NULL when there is no such type */

/* The file: header text, then blocks of appended data, each a UInt64 length and its bytes. The
 * writer keeps its place while blocks are added in the order the header declared them. */
typedef struct {
  const bw_comm *comm;
  bw_file *file;
  uint64_t declared; /* bytes of appended data the header has promised so far */
  int64_t place;     /* where the next block begins in the file */
} bw_vtk__writer;

/* Opening and closing lines common to all files; `type` is "ImageData" or another data set. */
void bw_vtk__begin(bw_vtk__text *text, const char *type);
void bw_vtk__end(bw_vtk__text *text, const char *type);
/* The time as VTK's readers know it, between the data set's line and its piece; NaN: nothing. */
void bw_vtk__time(bw_vtk__text *text, double time);

/* <DataArray> of `values` elements in all, at the offset that follows those declared before. */
void bw_vtk__declare(bw_vtk__writer *writer, bw_vtk__text *text, const char *name, bw_vtk_type type,
                     int components, uint64_t values);

/* Create the file and write the header on rank 0. Collective. */
bw_status bw_vtk__open(bw_vtk__writer *writer, const char *path,
                       const bw_vtk__text *text) BW_MUST_CHECK;

/* Begin the next block, of `bytes` in all; *start is where its data begin. Collective. */
bw_status bw_vtk__block(bw_vtk__writer *writer, uint64_t bytes, int64_t *start) BW_MUST_CHECK;

/* The closing lines, then the rename; or, given a failure, the removal. Collective. */
bw_status bw_vtk__close(bw_vtk__writer *writer, bw_status so_far) BW_MUST_CHECK;
