/* bw_vtk.h -- VTK files that ParaView opens as they are: .vti, .vtr, .vtp and .pvd.
 *
 * Self-contained writer: XML with appended raw binary (UInt64 headers, the byte order of this
 * machine), one file per data set written by all ranks together. Values are written as Float32
 * unless said otherwise. Files are written beside their final name and renamed when complete.
 * Errors: BW_EIO with the path and the system's reason; BW_EINPUT for arguments that make no
 * file; agreed by all ranks. */
#pragma once
#include "bw_grid.h"

BW_BEGIN_DECLS

/* A field of the grid as it goes into a file. Everything is borrowed for the call. */
typedef struct {
  const char *name;       /* "pressure" */
  const bw_real *data[3]; /* one field, or three for a vector (data[1] NULL: scalar). A NULL
                             data[2] with data[1] set is a zero third component (2D) */
  bool staggered;         /* data are u, v, w on faces: averaged to the centres on writing, for
                             which the lower halo has to be up to date (bw_halo_update) */
  double scale;           /* factor on writing; 0 means 1 */
} bw_vtk_field;

/* ".vti" for a uniform grid, ".vtr" when y is stretched; static storage. Local. */
const char *bw_vtk_grid_extension(const bw_grid *grid);

/* Cell data of the grid as ImageData (uniform grid) or, when y is stretched, RectilinearGrid;
 * `path` has to end in the extension of that kind; the file says its time [T] (NaN: it does not);
 * field[count]. Collective. */
bw_status bw_vtk_write_grid(const bw_grid *grid, const char *path, double time, int count,
                            const bw_vtk_field field[]) BW_MUST_CHECK;

/* The elements of an array. */
typedef enum {
  BW_VTK_FLOAT32, /* float */
  BW_VTK_FLOAT64, /* double */
  BW_VTK_INT32,   /* int32_t */
  BW_VTK_INT64,   /* int64_t */
  BW_VTK_UINT8    /* uint8_t */
} bw_vtk_type;

/* Values of points as they go into a file. Everything is borrowed for the call. */
typedef struct {
  const char *name; /* "damage" */
  bw_vtk_type type; /* of the array in memory and in the file */
  int components;   /* 1 or 3 */
  const void *data; /* (n, components) of this rank */
} bw_vtk_array;

/* Points as PolyData vertices, in rank order; position (n,3) of this rank [L]. n may differ and
 * be 0 on some ranks; time as above; array[count], the same names, types and components on all of
 * them. Collective. */
bw_status bw_vtk_write_points(const bw_comm *comm, const char *path, double time, size_t n,
                              const double position[], int count,
                              const bw_vtk_array array[]) BW_MUST_CHECK;

/* Memory that the writing of a grid (one of bw_grid_plan, too) or of n points takes on this rank
 * beside what it is given, at most [bytes]. For estimates before anything is built. Local. */
double bw_vtk_grid_bytes(const bw_grid *grid);
double bw_vtk_points_bytes(double n);

/* Add one file to a time series: rewrites `path` (.pvd) with the entries already in it whose time
 * is below `time`, and this one (so that a restarted run continues its series). `file` is
 * relative to the .pvd. A `path` that holds something else is an error, not overwritten.
 * Collective. */
bw_status bw_vtk_series_add(const bw_comm *comm, const char *path, double time,
                            const char *file) BW_MUST_CHECK;

BW_END_DECLS
