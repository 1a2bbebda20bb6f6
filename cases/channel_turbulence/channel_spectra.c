#include "channel_case.h"

#include <stdio.h>

/* One table: correlations R(r)/R(0) over r/h, or spectra E(k)/(u_tau^2 h) over k h. column:
 * (n/2 + 1) for each of 3 components and CHANNEL_HEIGHTS; half: (n/2 + 1). */
static void write_table(FILE *out, const channel_flow *f, bool spectrum, int direction,
                        double u_tau, double *column, double *half)
{
  const int n = f->config->cells[direction], lags = n / 2 + 1;
  const double L = f->config->length[direction], two_pi = 2.0 * acos(-1.0);
  fputs(spectrum ? "k_h[-]" : "r_over_h[-]", out);
  for (int q = 0; q < CHANNEL_HEIGHTS; q++)
    for (int a = 0; a < 3; a++) {
      double *to = column + (size_t)(3 * q + a) * (size_t)lags;
      fprintf(out, ",%c%c_yplus%d[-]", "uvw"[a], "uvw"[a], channel_heights[q]);
      for (int r = 0; r < lags; r++)
        to[r] = 0.0;
      for (int side = 0; side < 2; side++) {
        const int plane = q + side * CHANNEL_HEIGHTS;
        if (spectrum)
          bw_ns_correlations_spectrum(f->correlations, plane, a, direction, half);
        else
          bw_ns_correlations_get(f->correlations, plane, a, direction, half);
        for (int r = 0; r < lags; r++)
          to[r] += 0.5 * half[r];
      }
    }
  for (int r = spectrum ? 1 : 0; r < lags; r++) {
    fprintf(out, "\n%.9g", spectrum ? two_pi * r / L : r * L / n);
    for (int c = 0; c < 3 * CHANNEL_HEIGHTS; c++) {
      const double *of = column + (size_t)c * (size_t)lags;
      /* E_m is the energy of a band of width 2 pi/L */
      fprintf(out, ",%.6g", of[r] / (spectrum ? two_pi / L * u_tau * u_tau : of[0]));
    }
  }
  fputc('\n', out);
}

static bw_status write_file(const channel_flow *f, const bw_case *run, const char *name,
                            bool spectrum, int direction, double u_tau, double *column)
{
  char *path = NULL;
  BW_TRY(bw_case_path(run, name, &path));
  bw_status st = BW_OK;
  FILE *out = fopen(path, "w");
  if (out == NULL) st = BW_FAIL(BW_EIO, "%s: cannot be written", path);
  if (out != NULL) {
    const size_t lags = (size_t)f->config->cells[direction] / 2 + 1;
    write_table(out, f, spectrum, direction, u_tau, column, column + 3 * CHANNEL_HEIGHTS * lags);
    if (fclose(out) != 0) st = BW_FAIL(BW_EIO, "%s: could not be written to the end", path);
  }
  bw_release(&path);
  return st;
}

bw_status channel_spectra(channel_flow *f, const bw_case *run)
{
  static const struct {
    const char *name;
    bool spectrum;
    int direction;
  } table[] = {{"correlations_x.csv", false, 0},
               {"correlations_z.csv", false, 2},
               {"spectra_x.csv", true, 0},
               {"spectra_z.csv", true, 2}};
  const bw_comm *comm = bw_grid_comm(f->grid);
  if (bw_ns_correlations_samples(f->correlations) == 0) return BW_OK;
  const int *n = f->config->cells, most = (n[0] > n[2] ? n[0] : n[2]) / 2 + 1;
  double *column = NULL;
  bw_ns_estimate *rows = NULL;
  bw_status st = BW_ALLOCATE(&column, (size_t)most * (3 * CHANNEL_HEIGHTS + 1));
  BW_THEN(st, BW_ALLOCATE(&rows, (size_t)n[1] + 1));
  const double u_tau = st == BW_OK ? channel_u_tau(f, rows).mean : 0.0;
  for (size_t q = 0; q < 4 && st == BW_OK && bw_comm_rank(comm) == 0; q++)
    st = write_file(f, run, table[q].name, table[q].spectrum, table[q].direction, u_tau, column);
  bw_release(&column);
  bw_release(&rows);
  return bw_comm_agree(comm, st);
}
