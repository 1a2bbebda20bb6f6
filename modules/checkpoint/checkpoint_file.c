/* The file as a whole: create, open, close, what is in it. */
#include "bw_comm_mpi.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "checkpoint_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Raised when the meaning of what is stored changes. */
enum { FORMAT = 1 };

static const char format_name[] = "breakwater_format", precision_name[] = "bytes_per_real",
                  complete_name[] = "complete";

static bool first(const bw_checkpoint *ck)
{
  return bw_comm_rank(ck->comm) == 0;
}

static bw_status copy_text(const char *text, const char *tail, char **out)
{
  const size_t size = strlen(text) + strlen(tail) + 1;
  BW_TRY(BW_ALLOCATE(out, size));
  snprintf(*out, size, "%s%s", text, tail);
  return BW_OK;
}

static bw_status begin(const bw_comm *comm, const char *path, bool writing, bw_checkpoint **out)
{
  *out = NULL;
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_path_check(path));
  BW_TRY(BW_ALLOCATE(&ck, 1));
  ck->comm = comm;
  ck->file = H5I_INVALID_HID;
  bw_status st = copy_text(path, "", &ck->path);
  if (writing) BW_THEN(st, copy_text(path, ".part", &ck->part));
  /* HDF5 would print a stack of its own messages; ours say what to do. */
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  *out = ck;
  return st;
}

static void destroy(bw_checkpoint **ck)
{
  if (*ck == NULL) return;
  bw_release(&(*ck)->path);
  bw_release(&(*ck)->part);
  bw_release(ck);
}

/* The system's own reason, which HDF5 does not pass on. */
static bw_status try_system(const bw_checkpoint *ck)
{
  if (!first(ck)) return BW_OK;
  const char *path = ck->part != NULL ? ck->part : ck->path;
  const int flags = ck->part != NULL ? O_WRONLY | O_CREAT | O_TRUNC : O_RDONLY;
  const int handle = open(path, flags, 0666);
  BW_REQUIRE(handle >= 0, BW_EIO, "checkpoint %s: cannot %s it: %s", path,
             ck->part != NULL ? "write" : "open", strerror(errno));
  char byte;
  /* A folder can be opened for reading and not be read. */
  const bool readable = ck->part != NULL || read(handle, &byte, 1) >= 0;
  const int reason = errno;
  close(handle);
  BW_REQUIRE(readable, BW_EIO, "checkpoint %s: cannot read it: %s", path, strerror(reason));
  return BW_OK;
}

/* Access by all ranks together; the newest format, whose structures have checksums. */
static hid_t access_list(const bw_comm *comm)
{
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  if (list < 0) return list;
  if (H5Pset_fapl_mpio(list, bw_comm_mpi(comm), MPI_INFO_NULL) < 0 ||
      H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST) < 0) {
    H5Pclose(list);
    return H5I_INVALID_HID;
  }
  return list;
}

static bw_status create(bw_checkpoint *ck)
{
  /* The system's refusal comes first: HDF5 would only say that it failed. */
  BW_TRY(bw_comm_agree(ck->comm, try_system(ck)));
  const hid_t list = access_list(ck->comm);
  ck->file = H5Fcreate(ck->part, H5F_ACC_TRUNC, H5P_DEFAULT, list);
  if (list >= 0) H5Pclose(list);
  BW_REQUIRE(ck->file >= 0, BW_EIO, "checkpoint %s: HDF5 cannot create it", ck->part);
  /* The mark of completeness is missing until everything else is in the file. */
  BW_REQUIRE(bw_checkpoint__put_attribute(ck->file, format_name, FORMAT) &&
                 bw_checkpoint__put_attribute(ck->file, precision_name, sizeof(bw_real)),
             BW_EIO, "checkpoint %s: HDF5 cannot write its head", ck->part);
  return BW_OK;
}

static bw_status check_head(const bw_checkpoint *ck)
{
  uint64_t format = 0, real = 0, complete = 0;
  BW_REQUIRE(bw_checkpoint__get_attribute(ck->file, format_name, &format), BW_EIO,
             "checkpoint %s: no checkpoint of Breakwater (it is HDF5, but '%s' is missing)",
             ck->path, format_name);
  /* Of another format nothing may be believed, not even the attributes below. */
  BW_REQUIRE(format == FORMAT, BW_EIO,
             "checkpoint %s: format %" PRIu64 ", expected %d; read it with the version of "
             "Breakwater that wrote it",
             ck->path, format, FORMAT);
  BW_REQUIRE(bw_checkpoint__get_attribute(ck->file, complete_name, &complete) && complete == 1,
             BW_EIO,
             "checkpoint %s: it is not complete, its writing was interrupted; use an "
             "earlier one",
             ck->path);
  BW_REQUIRE(bw_checkpoint__get_attribute(ck->file, precision_name, &real), BW_EIO,
             "checkpoint %s: its precision is not readable; use an earlier one", ck->path);
  /* A conversion would not be the same run: it is refused, with the build that would do. */
  BW_REQUIRE(real == sizeof(bw_real), BW_EIO,
             "checkpoint %s: reals have %" PRIu64 " bytes, expected %zu; build with "
             "-DBW_PRECISION=%s",
             ck->path, real, sizeof(bw_real), real == sizeof(float) ? "single" : "double");
  return BW_OK;
}

/* Does HDF5 accept the file? Rank 0 looks alone and without MPI, so that a damaged file is
 * refused before all ranks open it together. */
static bw_status look_alone(const bw_checkpoint *ck)
{
  if (!first(ck)) return BW_OK;
  BW_TRY(try_system(ck));
  BW_REQUIRE(H5Fis_hdf5(ck->path) > 0, BW_EIO,
             "checkpoint %s: no checkpoint of Breakwater (it is not HDF5, or its beginning is "
             "damaged)",
             ck->path);
  bw_checkpoint alone = *ck;
  alone.file = H5Fopen(ck->path, H5F_ACC_RDONLY, H5P_DEFAULT);
  BW_REQUIRE(alone.file >= 0, BW_EIO,
             "checkpoint %s: HDF5 cannot open it, it is cut short or damaged; use an earlier one",
             ck->path);
  const bw_status st = check_head(&alone);
  H5Fclose(alone.file);
  return st;
}

static bw_status open_together(bw_checkpoint *ck)
{
  BW_TRY(bw_comm_agree(ck->comm, look_alone(ck)));
  /* Rank 0 has found the file sound: now all ranks open it for collective reading. */
  const hid_t list = access_list(ck->comm);
  ck->file = H5Fopen(ck->path, H5F_ACC_RDONLY, list);
  if (list >= 0) H5Pclose(list);
  BW_REQUIRE(ck->file >= 0, BW_EIO, "checkpoint %s: HDF5 cannot open it on %d ranks", ck->path,
             bw_comm_size(ck->comm));
  return BW_OK;
}

bw_status bw_checkpoint_create(const bw_comm *comm, const char *path, bw_checkpoint **out)
{
  bw_status st = bw_comm_agree(comm, begin(comm, path, true, out));
  BW_THEN(st, bw_comm_agree(comm, create(*out)));
  if (st != BW_OK) bw_checkpoint_abandon(out);
  return st;
}

bw_status bw_checkpoint_open(const bw_comm *comm, const char *path, bw_checkpoint **out)
{
  bw_status st = bw_comm_agree(comm, begin(comm, path, false, out));
  BW_THEN(st, bw_comm_agree(comm, open_together(*out)));
  if (st != BW_OK) bw_checkpoint_abandon(out);
  return st;
}

/* One step of the end on all ranks: none goes on to the next, which they do together, alone. */
static bw_status step_of_end(const bw_checkpoint *ck, bool done, const char *what)
{
  return bw_comm_agree(ck->comm, done ? BW_OK
                                      : BW_FAIL(BW_EIO,
                                                "checkpoint %s: HDF5 cannot %s (is the disk "
                                                "full?)",
                                                ck->part, what));
}

/* Data before the mark, the mark before the name. */
static bw_status finish(bw_checkpoint *ck)
{
  BW_TRY(step_of_end(ck, H5Fflush(ck->file, H5F_SCOPE_GLOBAL) >= 0, "write it"));
  BW_TRY(step_of_end(ck, bw_checkpoint__put_attribute(ck->file, complete_name, 1), "mark it"));
  /* All that could fail has been written before the close, whose failure HDF5 does not bear. */
  BW_TRY(step_of_end(ck, H5Fflush(ck->file, H5F_SCOPE_GLOBAL) >= 0, "finish it"));
  const herr_t closed = H5Fclose(ck->file);
  ck->file = H5I_INVALID_HID;
  return step_of_end(ck, closed >= 0, "close it");
}

static bw_status rename_on_disk(const bw_checkpoint *ck)
{
  if (!first(ck)) return BW_OK;
  const int handle = open(ck->part, O_RDONLY);
  /* The bytes must be on the disk before the name is: a power failure leaves the old file or the
   * new one. */
  const bool synchronised = handle >= 0 && fsync(handle) == 0;
  const int reason = errno;
  if (handle >= 0) close(handle);
  BW_REQUIRE(synchronised, BW_EIO, "checkpoint %s: cannot bring it to the disk: %s", ck->part,
             strerror(reason));
  BW_REQUIRE(rename(ck->part, ck->path) == 0, BW_EIO, "checkpoint %s: cannot rename it to %s: %s",
             ck->part, ck->path, strerror(errno));
  return BW_OK;
}

bw_status bw_checkpoint_close(bw_checkpoint **ck)
{
  bw_checkpoint *c = *ck;
  if (c == NULL) return BW_OK;
  /* A put that failed makes the file worthless even where its caller went on. */
  bw_status st = c->failed;
  if (c->part != NULL) {
    BW_THEN(st, finish(c));
    BW_THEN(st, bw_comm_agree(c->comm, rename_on_disk(c)));
  }
  /* Not renamed: whatever stood under that name before is still there. */
  if (c->part != NULL && st != BW_OK) {
    bw_checkpoint_abandon(ck);
    return st;
  }
  if (c->file >= 0) H5Fclose(c->file);
  destroy(ck);
  return st;
}

void bw_checkpoint_abandon(bw_checkpoint **ck)
{
  bw_checkpoint *c = *ck;
  if (c == NULL) return;
  /* What is still to be written of a file that is given up goes nowhere. */
  if (c->file >= 0 && c->part != NULL) bw_checkpoint__lose(c->part);
  if (c->file >= 0) H5Fclose(c->file);
  if (c->part != NULL && first(c)) unlink(c->part);
  destroy(ck);
}

/* HDF5 wants every folder of the name looked for in turn. */
bool bw_checkpoint_has(bw_checkpoint *ck, const char *name)
{
  char part[256];
  const size_t length = strlen(name);
  bool found = length > 0 && length < sizeof part;
  for (size_t q = 0; found && q <= length; q++) {
    if (name[q] == '/' || name[q] == '\0') {
      part[q] = '\0';
      if (q > 0) found = H5Lexists(ck->file, part, H5P_DEFAULT) > 0;
    }
    part[q] = name[q];
  }
  /* Ranks see the same file; a disagreement means that one of them could not read it. */
  double all = found ? 1.0 : 0.0;
  bw_comm_min(ck->comm, 1, &all);
  return all > 0.0;
}
