/* What turbulent channel flow writes: log, history.csv, profiles in wall units. */
#include "bw_folder.h"
#include "channel_case.h"

#include <stdio.h>

void channel_describe(const bw_grid *plan, const bw_ns_plan *known, const channel_case *c,
                      bw_log *log)
{
  const bw_grid_view *g = bw_grid_look(plan);
  /* wall units of the expected Re_tau = 0.09 Re_b^0.88 (Pope 2000, eq. 7.54, with Re_b on h) */
  const double re_tau = 0.09 * pow(c->fluid.reynolds, 0.88), plus = 2.0 * re_tau;
  bw_log_info(log,
              "Re_b = %g, %d x %d x %d cells; expected Re_tau about %.0f, cells %.1f x %.1f x %.1f "
              "wall units\n%g h/U_b to spin up, then %g of statistics, a sample every %g",
              c->fluid.reynolds, g->n[0], g->n[1], g->n[2], re_tau, g->spacing[0] * plus,
              g->spacing[1] * plus, g->spacing[2] * plus, c->time.spin_up, c->time.statistics,
              c->time.interval);
  const double writing = bw_checkpoint_file_bytes() + bw_checkpoint_field_bytes(plan);
  bw_log_info(log,
              "largest stable step of the bulk flow %.3g h/U_b; memory: about %.3g MiB for each "
              "of %d ranks",
              known->dt_max, (known->bytes + writing) / 1048576.0,
              bw_comm_size(bw_grid_comm(plan)));
}

bw_status channel_open_history(const channel_flow *f, const bw_case *run, bw_history **out)
{
  static const char *const names[] = {
      "time[h/U_b]", "Re_tau_gradient[-]",     "Re_tau_wall[-]", "bulk_velocity[U_b]",
      "dt[h/U_b]",   "kinetic_energy[U_b2/2]", "samples[-]"};
  return bw_case_history(run, sizeof names / sizeof *names, names, bw_ns_channel_time(f->fluid),
                         f->rows, out);
}

double channel_record(channel_flow *f, bw_history *history)
{
  const bw_ns_summary now = bw_ns_channel_summary(f->fluid);
  const double *L = f->config->length, half = 0.5 * f->config->reynolds; /* (h/2) U_b/nu */
  /* Mean of both walls; the gradient's Re_tau belongs to the interval, this one to the instant. */
  const double shear = 0.5 * (bw_ns_channel_side(f->fluid, 1, 0).stress[0] +
                              bw_ns_channel_side(f->fluid, 1, 1).stress[0]);
  const double re_tau = half * sqrt(fmax(0.0, shear));
  const double row[] = {bw_ns_channel_time(f->fluid),
                        half * sqrt(fmax(0.0, 0.5 * f->gradient)), /* u_tau^2 = G h/2 */
                        re_tau,
                        now.bulk_velocity,
                        f->dt,
                        2.0 * now.kinetic_energy / (L[0] * L[1] * L[2]),
                        (double)bw_ns_statistics_samples(f->statistics)};
  bw_history_append(history, row);
  return re_tau;
}

/* ---- profiles in wall units, lower half of the folded channel ---- */
typedef struct {
  const char *name;
  bw_ns_profile_kind kind;
  int power; /* of u_tau that makes it dimensionless; of 1/nu, too, where negative */
} column;

static const column centre_columns[] = {
    {"U_plus", BW_NS_PROFILE_U, 1},
    {"u_rms_plus", BW_NS_PROFILE_U_RMS, 1},
    {"w_rms_plus", BW_NS_PROFILE_W_RMS, 1},
    {"W_plus", BW_NS_PROFILE_W, 1},
    {"uw_plus", BW_NS_PROFILE_UW, 2},
    {"P_plus", BW_NS_PROFILE_P, 2},
    {"p_rms_plus", BW_NS_PROFILE_P_RMS, 2},
    {"omega_y_rms_plus", BW_NS_PROFILE_OY_RMS, -2},
    {"u_skewness", BW_NS_PROFILE_U_SKEWNESS, 0},
    {"u_flatness", BW_NS_PROFILE_U_FLATNESS, 0},
    {"w_skewness", BW_NS_PROFILE_W_SKEWNESS, 0},
    {"w_flatness", BW_NS_PROFILE_W_FLATNESS, 0},
    {"k_plus", BW_NS_PROFILE_K, 2},
    {"production_plus", BW_NS_PROFILE_PRODUCTION, -4},
    {"dissipation_plus", BW_NS_PROFILE_DISSIPATION, -4},
    {"turbulent_transport_plus", BW_NS_PROFILE_TURBULENT_TRANSPORT, -4},
    {"pressure_transport_plus", BW_NS_PROFILE_PRESSURE_TRANSPORT, -4},
    {"viscous_diffusion_plus", BW_NS_PROFILE_VISCOUS_DIFFUSION, -4}};
static const column face_columns[] = {{"V_plus", BW_NS_PROFILE_V, 1},
                                      {"v_rms_plus", BW_NS_PROFILE_V_RMS, 1},
                                      {"uv_plus", BW_NS_PROFILE_UV, 2},
                                      {"vw_plus", BW_NS_PROFILE_VW, 2},
                                      {"shear_plus", BW_NS_PROFILE_SHEAR, 2},
                                      {"total_stress_plus", BW_NS_PROFILE_TOTAL, 2},
                                      {"omega_x_rms_plus", BW_NS_PROFILE_OX_RMS, -2},
                                      {"omega_z_rms_plus", BW_NS_PROFILE_OZ_RMS, -2},
                                      {"v_skewness", BW_NS_PROFILE_V_SKEWNESS, 0},
                                      {"v_flatness", BW_NS_PROFILE_V_FLATNESS, 0},
                                      {"eddy_stress_plus", BW_NS_PROFILE_EDDY, 2}};

/* What makes a column dimensionless. */
static double unit_of(const column *c, double u_tau, double re)
{
  return pow(u_tau, fabs((double)c->power)) * (c->power < 0 ? re : 1.0);
}

/* Every column and, behind it, its 95 % half width. work: (n + 1) rows of 2 n_columns. */
static void write_table(FILE *out, const channel_flow *f, bool faces, int n_columns,
                        const column columns[], double u_tau, bw_ns_estimate work[])
{
  const bw_grid_view *g = bw_grid_look(f->grid);
  const double re = f->config->reynolds;
  const size_t rows = (size_t)g->n[1] + 1;
  fputs("y_over_h[-],y_plus[-]", out);
  /* Head line, and all profiles at once. */
  for (int c = 0; c < n_columns; c++) {
    fprintf(out, ",%s[-],%s_ci95[-]", columns[c].name, columns[c].name);
    bw_ns_statistics_profile(f->statistics, columns[c].kind, true, work + (size_t)c * rows);
  }
  /* The lower half: folded profiles are symmetric. */
  for (int j = faces ? 0 : 1; j <= (faces ? g->n[1] / 2 : (g->n[1] + 1) / 2); j++) {
    const double y = faces ? g->y_face[j] : g->y_centre[j];
    fprintf(out, "\n%.9g,%.9g", y, y * u_tau * re);
    for (int c = 0; c < n_columns; c++) {
      const bw_ns_estimate e = work[(size_t)c * rows + (size_t)j];
      const double unit = unit_of(&columns[c], u_tau, re);
      fprintf(out, ",%.9g,%.3g", e.mean / unit, e.interval / unit);
    }
  }
  fputc('\n', out);
}

static void write_scalars(FILE *out, const channel_flow *f, bw_ns_estimate work[])
{
  const int n = f->config->cells[1];
  const double half = 0.5 * f->config->reynolds;
  /* Everything in wall units follows from u_tau. */
  const bw_ns_estimate u = channel_u_tau(f, work);
  bw_ns_statistics_profile(f->statistics, BW_NS_PROFILE_U, true, work);
  const int c = (n + 1) / 2;
  fprintf(out, "quantity,value,ci95\nRe_tau,%.6g,%.2g\nU_b_plus,%.6g,%.2g\nU_c_plus,%.6g,%.2g\n",
          half * u.mean, half * u.interval, 1.0 / u.mean, u.interval / (u.mean * u.mean),
          work[c].mean / u.mean, work[c].interval / u.mean);
  fprintf(out, "samples,%ld,0\nfull_batches,%d,0\nstatistics_h_over_U_b,%.6g,0\n",
          bw_ns_statistics_samples(f->statistics), bw_ns_statistics_batches(f->statistics),
          (double)bw_ns_statistics_samples(f->statistics) * f->config->interval);
  fprintf(out, "eddy_turnovers,%.4g,0\n", /* of (h/2)/u_tau */
          (double)bw_ns_statistics_samples(f->statistics) * f->config->interval * 2.0 * u.mean);
}

enum {
  CENTRES = sizeof centre_columns / sizeof *centre_columns,
  FACES = sizeof face_columns / sizeof *face_columns
};

/* The same columns as arrays FOLDER/NAME and FOLDER/NAME_ci95. numbers: (2, n + 1). */
static bw_status put_columns(bw_checkpoint *ck, const channel_flow *f, bool faces, int n_columns,
                             const column columns[], bw_ns_estimate work[], double numbers[])
{
  const bw_grid_view *g = bw_grid_look(f->grid);
  const char *folder = faces ? "faces" : "centres";
  const double re = f->config->reynolds, u_tau = channel_u_tau(f, work).mean;
  const int first = faces ? 0 : 1, rows = faces ? g->n[1] / 2 + 1 : (g->n[1] + 1) / 2;
  double *error = numbers + g->n[1] + 1;
  char name[96];
  /* Heights first, then a pair of arrays per column. */
  for (int j = 0; j < rows; j++)
    numbers[j] = faces ? g->y_face[j] : g->y_centre[j + 1];
  snprintf(name, sizeof name, "%s/y_over_h", folder);
  BW_TRY(bw_checkpoint_put_numbers(ck, name, rows, numbers));
  for (int c = 0; c < n_columns; c++) {
    bw_ns_statistics_profile(f->statistics, columns[c].kind, true, work);
    const double unit = unit_of(&columns[c], u_tau, re);
    for (int j = 0; j < rows; j++)
      numbers[j] = work[first + j].mean / unit, error[j] = work[first + j].interval / unit;
    snprintf(name, sizeof name, "%s/%s", folder, columns[c].name);
    BW_TRY(bw_checkpoint_put_numbers(ck, name, rows, numbers));
    snprintf(name, sizeof name, "%s/%s_ci95", folder, columns[c].name);
    BW_TRY(bw_checkpoint_put_numbers(ck, name, rows, error));
  }
  return BW_OK;
}

bw_status channel_profiles_hdf5(channel_flow *f, bw_checkpoint *ck)
{
  /* Without two batches there is no interval. */
  if (bw_ns_statistics_batches(f->statistics) < 2) return BW_OK;
  const size_t rows = (size_t)f->config->cells[1] + 1;
  bw_ns_estimate *work = NULL;
  double *numbers = NULL;
  bw_status st = BW_ALLOCATE(&work, rows);
  BW_THEN(st, BW_ALLOCATE(&numbers, 2 * rows));
  st = bw_comm_agree(bw_grid_comm(f->grid), st);
  BW_THEN(st, put_columns(ck, f, false, CENTRES, centre_columns, work, numbers));
  BW_THEN(st, put_columns(ck, f, true, FACES, face_columns, work, numbers));
  /* The unit of all others, with its own interval. */
  if (st == BW_OK) {
    const bw_ns_estimate u = channel_u_tau(f, work);
    const double re_tau[2] = {0.5 * f->config->reynolds * u.mean,
                              0.5 * f->config->reynolds * u.interval};
    st = bw_checkpoint_put_numbers(ck, "Re_tau_and_ci95", 2, re_tau);
  }
  bw_release(&work);
  bw_release(&numbers);
  return st;
}

bw_status channel_profiles(channel_flow *f, const bw_case *run)
{
  static const char *const names[3] = {"centres.csv", "faces.csv", "scalars.csv"};
  if (bw_ns_statistics_batches(f->statistics) < 2) return BW_OK;
  bw_ns_estimate *work = NULL;
  bw_status st = BW_ALLOCATE(&work, (size_t)CENTRES * (size_t)(f->config->cells[1] + 1));
  st = bw_comm_agree(bw_grid_comm(f->grid), st);
  /* All ranks hold the sums; one writes. */
  for (int q = 0; q < 3 && st == BW_OK; q++) {
    bw_case_text t;
    st = bw_case_text_begin(run, &t);
    if (t.out != NULL) {
      const double u_tau = channel_u_tau(f, work).mean;
      if (q == 0) write_table(t.out, f, false, CENTRES, centre_columns, u_tau, work);
      if (q == 1) write_table(t.out, f, true, FACES, face_columns, u_tau, work);
      if (q == 2) write_scalars(t.out, f, work);
    }
    st = bw_case_text_end(run, &t, names[q], st);
  }
  bw_release(&work);
  return st;
}
