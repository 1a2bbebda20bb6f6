/* bw_folder.h -- folders and paths. Rank 0 touches the disk; all ranks get its answer. */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* Make `path` and its missing parents; an existing folder is fine. BW_EIO with the part that
 * failed and the system's reason, also when the folder is there but not writable. Collective. */
bw_status bw_folder_make(const bw_comm *comm, const char *path) BW_MUST_CHECK;

/* Is there a file or folder of that name? The same answer on all ranks. Collective. */
bool bw_path_exists(const bw_comm *comm, const char *path);

/* The longest path [bytes] of a file that all ranks write or read together. Open MPI's file layer
 * makes names of its own from it in 256 bytes and aborts the program where they do not fit;
 * PATH.part and the number of a rank are in them. */
#define BW_PATH_LONGEST 235

/* BW_EIO with the length and the remedy for a longer one. Local. */
bw_status bw_path_check(const char *path) BW_MUST_CHECK;

/* *out = "FOLDER/NAME" (just NAME when folder is "" or NAME begins with '/'), allocated, owned by
 * the caller (bw_release); NULL after BW_EMEM. Local. */
bw_status bw_path_join(const char *folder, const char *name, char **out) BW_MUST_CHECK;

BW_END_DECLS
