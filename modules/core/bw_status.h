/* bw_status.h -- how every function of Breakwater reports failure.
 *
 * Two kinds of failure, two mechanisms:
 *   - the caller or the data is wrong (bad input, no memory, diverged): return a bw_status;
 *   - this code is wrong (broken invariant): BW_ASSERT, compiled out in Release.
 * BW_FAIL, at the place of the failure, writes the message; BW_TRY only passes it on.
 * Messages name what and where, the value found and the remedy, in one line. */
#pragma once
#include "bw_decls.h"
#include <assert.h>

BW_BEGIN_DECLS

/* One list, three uses (enum, name, text). Append only; the numbers are exit codes. 75 is
 * EX_TEMPFAIL of sysexits.h: the run was stopped early in good order and can go on. */
#define BW_STATUS_LIST(X)                                                                          \
  X(BW_OK, 0, "success")                                                                           \
  X(BW_EINPUT, 2, "a value is missing, out of range or contradicts another")                       \
  X(BW_EMEM, 3, "out of memory")                                                                   \
  X(BW_EIO, 4, "a file could not be read or written")                                              \
  X(BW_ECFL, 5, "the time step exceeds the stability limit")                                       \
  X(BW_EDIVERGED, 6, "the solution is not finite or an iteration did not converge")                \
  X(BW_EUSAGE, 7, "the command line was not understood")                                           \
  X(BW_EUNFINISHED, 75, "unfinished")

/* Behind a declaration: a caller that drops the status is warned by the compiler. */
#define BW_MUST_CHECK __attribute__((warn_unused_result))

/* Behind a declaration like printf's: the compiler checks the arguments from number `first` on
 * against the format, which is argument number `fmt`. */
#define BW_PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))

#ifdef __clang__
/* The same on a type, which covers static functions and pointers to functions as well. clang alone
 * knows it (tests/lint/statuses.sh), so that declarations in headers have BW_MUST_CHECK. */
#define BW_MUST_CHECK_TYPE BW_MUST_CHECK
#else
/* Nothing, where the compiler knows no such attribute of a type. */
#define BW_MUST_CHECK_TYPE
#endif

/* What a function returns, and what a program exits with (see BW_STATUS_LIST). */
typedef enum BW_MUST_CHECK_TYPE {
#define X(name, value, text) name = value,
  BW_STATUS_LIST(X)
#undef X
} bw_status;
#undef BW_STATUS_ATTRIBUTE

/* Record the message (printf's format, cut at 4095 bytes) as this thread's last one and return
 * `code` unchanged. `file` and `line` say where, for a debugger. Use through BW_FAIL. Local. */
bw_status bw_fail(bw_status code, const char *file, int line, const char *fmt, ...)
    BW_PRINTF(4, 5) BW_MUST_CHECK;

/* Text of a status code, never NULL; static storage. Local. */
const char *bw_status_text(bw_status code);

/* The last message recorded by this thread ("" when none); static storage, valid until the next
 * failure. Local. */
const char *bw_last_message(void);

/* A failure: the status `code`, with a message in printf's format that goes with it. */
#define BW_FAIL(code, ...) bw_fail((code), __FILE__, __LINE__, __VA_ARGS__)

/* Return from this function with a failure unless `cond` holds. */
#define BW_REQUIRE(cond, code, ...)                                                                \
  do {                                                                                             \
    if (!(cond)) return BW_FAIL((code), __VA_ARGS__);                                              \
  } while (0)

/* Return from this function with the status of `call` unless it is BW_OK. Not where something has
 * to be released first: use BW_THEN. */
#define BW_TRY(call)                                                                               \
  do {                                                                                             \
    const bw_status st_ = (call);                                                                  \
    if (st_ != BW_OK) return st_;                                                                  \
  } while (0)

/* Straight-line set-up code that must reach its clean-up: `call` is skipped once `st` is a
 * failure. */
#define BW_THEN(st, call)                                                                          \
  do {                                                                                             \
    if ((st) == BW_OK) (st) = (call);                                                              \
  } while (0)

/* What this code promises itself; compiled out in Release. Never for what a caller may get
 * wrong. */
#define BW_ASSERT(cond) assert(cond)

BW_END_DECLS
