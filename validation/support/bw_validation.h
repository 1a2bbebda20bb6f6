/* bw_validation.h -- a validation program: a table of claims, a JSON file, an exit code.
 *
 *   int main(int argc, char **argv) { return bw_validation_main(argc, argv, "grid.halo", run); }
 * where run(v) measures and calls bw_validation_row for each claim (on all ranks; rank 0 prints).
 * The file is $BW_BUILD_DIR/verification/NAME.json (build/verification when unset). The exit code
 * is 0 only if every row passed and run returned BW_OK. */
#pragma once
#include "bw_comm.h"
#include <stdbool.h>

typedef struct bw_validation bw_validation;

typedef enum {
  BW_ANALYTIC,
  BW_PUBLISHED,
  BW_INDEPENDENT_CODE,
  BW_CONSERVATION,
  BW_ORDER
} bw_claim_kind;

typedef struct {
  const char *claim;    /* "divergence stays at round-off" */
  const char *quantity; /* "max_divergence" */
  double measured, reference;
  double tolerance; /* on error = |measured-reference|/|reference|; absolute when reference is 0.
                       INFINITY: reported beside, no claim made */
  bw_claim_kind kind;
  const char *source; /* closed form, or author, year, table; never this code */
  const char *extra;  /* more JSON members, e.g. "\"nodes\": 4000" or NULL */
} bw_claim;

const bw_comm *bw_validation_comm(const bw_validation *v);
bool bw_validation_full(const bw_validation *v);          /* --full: the documents' resolution */
const char *bw_validation_folder(const bw_validation *v); /* for plots and data files */

/* Record one row; true when it passes (false for NaN). The same on all ranks. */
bool bw_validation_row(bw_validation *v, const bw_claim *claim);

/* The rows of data/FILE that begin with `columns` numbers between commas, in table (most, columns),
 * row-major; comments and heads are passed over. *rows: how many. BW_EIO when the file cannot be
 * read, BW_EINPUT when it has none or more than `most`. Local. */
bw_status bw_validation_table(const char *file, int columns, int most, double table[],
                              int *rows) BW_MUST_CHECK;

/* log(e1/e2)/log(h1/h2): the order seen between two resolutions. */
double bw_validation_order(double h1, double e1, double h2, double e2);

int bw_validation_main(int argc, char **argv, const char *name, bw_status (*run)(bw_validation *v));
