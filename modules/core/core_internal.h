/* core_internal.h -- shared by the sources of core only. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { BW_MESSAGE_SIZE = 4096, BW_NUMBER_SIZE = 32 };

/* Replace the last message (bw_comm_agree spreads the failing rank's). Local. */
void bw_core__set_message(const char *text);

/* *part = "PATH.part", owned by the caller (bw_release). Local. */
bw_status bw_core__part_path(const char *path, char **part) BW_MUST_CHECK;

/* The shortest of %.15g, %.16g, %.17g that reads back to x. Local. */
void bw_core__format_double(double x, char text[BW_NUMBER_SIZE]);

/* A YAML text in double quotes. Local. */
void bw_core__put_quoted(FILE *out, const char *text);

/* Letters to insert, delete, replace or swap to get from a to b (63 when longer than that). */
int bw_core__edit_distance(const char *a, const char *b);

/* Is `candidate` likely meant by `found`, and nearer than *best (then updated)? Start with
 * *best = 64. Local. */
bool bw_core__near_miss(const char *found, const char *candidate, int *best);

/* Columns of the terminal behind `stream`, 0 when it is none (or its width is not known). Local. */
int bw_core__terminal_width(FILE *stream);
