/* core_internal.h -- shared by the sources of core only. */
#pragma once
#include "bw_status.h"
#include <stddef.h>

enum { BW_MESSAGE_SIZE = 1024 };

/* Replace the last message (bw_comm_agree spreads the failing rank's). Local. */
void bw_core__set_message(const char *text);

/* *part = "PATH.part", owned by the caller (bw_release). Local. */
bw_status bw_core__part_path(const char *path, char **part) BW_MUST_CHECK;
