/* Two-point correlations and spectra as tables, in csv and HDF5. */
#include "bw_folder.h"
#include "channel_case.h"

#include <stdio.h>

static const struct {
  const char *name;
  bool spectrum;
  int direction;
} tables[] = {{"correlations_x", false, 0},
              {"correlations_z", false, 2},
              {"spectra_x", true, 0},
              {"spectra_z", true, 2}};
enum { TABLES = sizeof tables / sizeof *tables, COLUMNS = 3 * CHANNEL_HEIGHTS };

/* Column c: a component at a height, both halves averaged: R(r)/R(0), or E(k)/(u_tau^2 h) (E_m is
 * the energy of a band of width 2 pi/L). of, half: (n/2 + 1). */
static void fill_column(const channel_flow *f, int table, int c, double u_tau, double *of,
                        double *half)
{
  const int d = tables[table].direction, lags = f->config->cells[d] / 2 + 1;
  for (int r = 0; r < lags; r++)
    of[r] = 0.0;
  /* A plane and its mirror image in the other half. */
  for (int side = 0; side < 2; side++) {
    const int plane = c / 3 + side * CHANNEL_HEIGHTS;
    if (tables[table].spectrum)
      bw_ns_correlations_spectrum(f->correlations, plane, c % 3, d, half);
    else
      bw_ns_correlations_get(f->correlations, plane, c % 3, d, half);
    for (int r = 0; r < lags; r++)
      of[r] += 0.5 * half[r];
  }
  /* Correlations over R(0), spectra per wave number over u_tau^2. */
  const double band = 2.0 * acos(-1.0) / f->config->length[d];
  const double unit = tables[table].spectrum ? band * u_tau * u_tau : of[0];
  for (int r = 0; r < lags; r++)
    of[r] /= unit;
}

/* r/h, or k h. */
static double abscissa(const channel_flow *f, int table, int r)
{
  const int d = tables[table].direction;
  const double L = f->config->length[d];
  return tables[table].spectrum ? 2.0 * acos(-1.0) * r / L : r * L / f->config->cells[d];
}

static void column_name(int c, size_t size, char name[])
{
  const char q = "uvw"[c % 3];
  snprintf(name, size, "%c%c_yplus%d", q, q, channel_heights[c / 3]);
}

/* column: (COLUMNS + 1, n/2 + 1). */
static void write_table(FILE *out, const channel_flow *f, int table, double u_tau, double *column)
{
  const int lags = f->config->cells[tables[table].direction] / 2 + 1;
  fputs(tables[table].spectrum ? "k_h[-]" : "r_over_h[-]", out);
  /* Head line, and all columns at once. */
  for (int c = 0; c < COLUMNS; c++) {
    char name[32];
    column_name(c, sizeof name, name);
    fprintf(out, ",%s[-]", name);
    fill_column(f, table, c, u_tau, column + c * lags, column + COLUMNS * lags);
  }
  /* k = 0 does not fit a logarithmic axis; r = 0 is 1. */
  for (int r = tables[table].spectrum ? 1 : 0; r < lags; r++) {
    fprintf(out, "\n%.9g", abscissa(f, table, r));
    for (int c = 0; c < COLUMNS; c++)
      fprintf(out, ",%.6g", column[c * lags + r]);
  }
  fputc('\n', out);
}

static bw_status write_file(const channel_flow *f, const bw_case *run, int table, double u_tau,
                            double *column)
{
  char name[32];
  bw_case_text t;
  const bw_status st = bw_case_text_begin(run, &t);
  snprintf(name, sizeof name, "%s.csv", tables[table].name);
  if (t.out != NULL) write_table(t.out, f, table, u_tau, column);
  return bw_case_text_end(run, &t, name, st);
}

/* From k = 0 and r = 0 on. column: (2, n/2 + 1). */
static bw_status put_table(bw_checkpoint *ck, const channel_flow *f, int table, double u_tau,
                           double *column)
{
  const int lags = f->config->cells[tables[table].direction] / 2 + 1;
  char name[96], last[32];
  for (int r = 0; r < lags; r++)
    column[r] = abscissa(f, table, r);
  snprintf(name, sizeof name, "%s/%s", tables[table].name,
           tables[table].spectrum ? "k_h" : "r_over_h");
  BW_TRY(bw_checkpoint_put_numbers(ck, name, lags, column));
  for (int c = 0; c < COLUMNS; c++) {
    column_name(c, sizeof last, last);
    snprintf(name, sizeof name, "%s/%s", tables[table].name, last);
    fill_column(f, table, c, u_tau, column, column + lags);
    BW_TRY(bw_checkpoint_put_numbers(ck, name, lags, column));
  }
  return BW_OK;
}

/* Where the columns go to: csv files, or one of HDF5. */
static bw_status each_table(channel_flow *f, const bw_case *run, bw_checkpoint *ck)
{
  const bw_comm *comm = bw_grid_comm(f->grid);
  /* Before the first sample there is nothing to divide by. */
  if (bw_ns_correlations_samples(f->correlations) == 0) return BW_OK;
  const int *n = f->config->cells, most = (n[0] > n[2] ? n[0] : n[2]) / 2 + 1;
  double *column = NULL;
  bw_ns_estimate *rows = NULL;
  bw_status st = BW_ALLOCATE(&column, (size_t)most * (COLUMNS + 1));
  BW_THEN(st, BW_ALLOCATE(&rows, (size_t)n[1] + 1));
  st = bw_comm_agree(comm, st);
  /* All ranks make the same columns. */
  const double u_tau = st == BW_OK ? channel_u_tau(f, rows).mean : 0.0;
  for (int q = 0; q < TABLES && st == BW_OK; q++)
    st = ck != NULL ? put_table(ck, f, q, u_tau, column) : write_file(f, run, q, u_tau, column);
  bw_release(&column);
  bw_release(&rows);
  return bw_comm_agree(comm, st);
}

bw_status channel_spectra(channel_flow *f, const bw_case *run)
{
  return each_table(f, run, NULL);
}

bw_status channel_spectra_hdf5(channel_flow *f, bw_checkpoint *ck)
{
  return each_table(f, NULL, ck);
}
