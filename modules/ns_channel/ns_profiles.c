/* ns_profiles.c -- profiles and their confidence from the sums of the statistics. */
#include "ns_statistics_internal.h"

#include <math.h>

/* Mean moments [moment][rows] and where a profile reads them. */
typedef struct {
  const double *mean;
  int rows;
  double nu;
  const double *y_face, *y_centre;
} profile_source;

static double moment(const profile_source *m, bw_ns_moment which, int row)
{
  return m->mean[(size_t)which * (size_t)m->rows + (size_t)row];
}

/* One row of a profile: moments first .. (of powers 1, 2, 3, 4), or whatever it needs. */
typedef double (*profile_fn)(const profile_source *m, bw_ns_moment first, int row);

static double plain(const profile_source *m, bw_ns_moment first, int row)
{
  return moment(m, first, row);
}

static double variance(const profile_source *m, bw_ns_moment first, int row)
{
  const double a = moment(m, first, row);
  return moment(m, (bw_ns_moment)(first + 1), row) - a * a;
}

static double rms(const profile_source *m, bw_ns_moment first, int row)
{
  return sqrt(fmax(0.0, variance(m, first, row)));
}

static double skewness(const profile_source *m, bw_ns_moment first, int row)
{
  const double a = moment(m, first, row), b = moment(m, (bw_ns_moment)(first + 1), row);
  const double third = moment(m, (bw_ns_moment)(first + 2), row) - 3.0 * a * b + 2.0 * a * a * a;
  return third / pow(variance(m, first, row), 1.5);
}

static double flatness(const profile_source *m, bw_ns_moment first, int row)
{
  const double a = moment(m, first, row), b = moment(m, (bw_ns_moment)(first + 1), row);
  const double c = moment(m, (bw_ns_moment)(first + 2), row), v = variance(m, first, row);
  const double fourth = moment(m, (bw_ns_moment)(first + 3), row) - 4.0 * a * c + 6.0 * a * a * b -
                        3.0 * a * a * a * a;
  return fourth / (v * v);
}

/* Mean of centres at a face. At a wall the face's own factor is zero, so that the nearest does. */
static double at_face(const profile_source *m, bw_ns_moment which, int row)
{
  const int below = row > 0 ? row : 1, above = row < m->rows - 1 ? row + 1 : row;
  return 0.5 * (moment(m, which, below) + moment(m, which, above));
}

static double uv(const profile_source *m, bw_ns_moment first, int row)
{
  return moment(m, first, row) - at_face(m, BW_NS_MOMENT_U, row) * moment(m, BW_NS_MOMENT_V, row);
}

static double vw(const profile_source *m, bw_ns_moment first, int row)
{
  return moment(m, first, row) - at_face(m, BW_NS_MOMENT_W, row) * moment(m, BW_NS_MOMENT_V, row);
}

static double uw(const profile_source *m, bw_ns_moment first, int row)
{
  return moment(m, first, row) - moment(m, BW_NS_MOMENT_U, row) * moment(m, BW_NS_MOMENT_W, row);
}

/* The mean of dv/dx over a period is nothing, so that <o_z> = -dU/dy. */
static double shear(const profile_source *m, bw_ns_moment first, int row)
{
  return -m->nu * moment(m, first, row);
}

static double total(const profile_source *m, bw_ns_moment first, int row)
{
  return shear(m, first, row) - uv(m, BW_NS_MOMENT_UV, row) + moment(m, BW_NS_MOMENT_EDDY, row);
}

/* ---- budget of k at centres; what belongs to faces is averaged over or differenced between the
 * two of the cell, as the discrete balance of energy has it ---- */
static double k_at_centre(const profile_source *m, bw_ns_moment first, int row)
{
  (void)first;
  return 0.5 * (variance(m, BW_NS_MOMENT_U, row) + variance(m, BW_NS_MOMENT_W, row) +
                0.5 * (variance(m, BW_NS_MOMENT_V, row - 1) + variance(m, BW_NS_MOMENT_V, row)));
}

/* <o_z> = -dU/dy, <o_x> = dW/dy. */
static double production(const profile_source *m, bw_ns_moment first, int row)
{
  double sum = 0.0;
  (void)first;
  /* Mean of the two faces of the cell, where the stresses are. */
  for (int j = row - 1; j <= row; j++)
    sum += uv(m, BW_NS_MOMENT_UV, j) * moment(m, BW_NS_MOMENT_OZ, j) -
           vw(m, BW_NS_MOMENT_VW, j) * moment(m, BW_NS_MOMENT_OX, j);
  return 0.5 * sum;
}

static double dissipation(const profile_source *m, bw_ns_moment first, int row)
{
  /* Gradients at the centre have no mean; those at faces have dU/dy and dW/dy. */
  double sum = moment(m, first, row);
  for (int j = row - 1; j <= row; j++) {
    const double oz = moment(m, BW_NS_MOMENT_OZ, j), ox = moment(m, BW_NS_MOMENT_OX, j);
    sum += 0.5 * (moment(m, BW_NS_MOMENT_FACE_GRADIENTS, j) - oz * oz - ox * ox);
  }
  return -m->nu * sum;
}

/* Minus the divergence of a flux given at faces. */
static double gain(const profile_source *m, const double flux[2], int row)
{
  return -(flux[1] - flux[0]) / (m->y_face[row] - m->y_face[row - 1]);
}

/* <v'a'a'> = <v a a> - 2 A <v'a'>: V = 0 between walls, by continuity. */
static double turbulent_transport(const profile_source *m, bw_ns_moment first, int row)
{
  double flux[2];
  for (int s = 0; s < 2; s++) {
    const int j = row - 1 + s;
    const double U = at_face(m, BW_NS_MOMENT_U, j), W = at_face(m, BW_NS_MOMENT_W, j);
    /* Means are taken off the triple products: <v a a> - 2 A <v'a'>. */
    flux[s] = 0.5 * (moment(m, first, j) + moment(m, BW_NS_MOMENT_VUU, j) +
                     moment(m, BW_NS_MOMENT_VWW, j)) -
              U * uv(m, BW_NS_MOMENT_UV, j) - W * vw(m, BW_NS_MOMENT_VW, j);
  }
  return gain(m, flux, row);
}

static double pressure_transport(const profile_source *m, bw_ns_moment first, int row)
{
  const double flux[2] = {moment(m, first, row - 1), moment(m, first, row)};
  return gain(m, flux, row);
}

/* dk/dy = 0 on a wall, where k begins with y^2. */
static double viscous_diffusion(const profile_source *m, bw_ns_moment first, int row)
{
  double flux[2] = {0.0, 0.0};
  for (int s = 0; s < 2; s++) {
    const int j = row - 1 + s;
    /* The flux through a wall stays zero. */
    if (j == 0 || j == m->rows - 1) continue;
    flux[s] = -m->nu * (k_at_centre(m, first, j + 1) - k_at_centre(m, first, j)) /
              (m->y_centre[j + 1] - m->y_centre[j]);
  }
  return gain(m, flux, row);
}

static const struct {
  profile_fn make;
  bw_ns_moment first;
} profiles[BW_NS_PROFILES] = {
    [BW_NS_PROFILE_U] = {plain, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_W] = {plain, BW_NS_MOMENT_W},
    [BW_NS_PROFILE_P] = {plain, BW_NS_MOMENT_P},
    [BW_NS_PROFILE_U_RMS] = {rms, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_W_RMS] = {rms, BW_NS_MOMENT_W},
    [BW_NS_PROFILE_P_RMS] = {rms, BW_NS_MOMENT_P},
    [BW_NS_PROFILE_UW] = {uw, BW_NS_MOMENT_UW},
    [BW_NS_PROFILE_OY_RMS] = {rms, BW_NS_MOMENT_OY},
    [BW_NS_PROFILE_U_SKEWNESS] = {skewness, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_U_FLATNESS] = {flatness, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_W_SKEWNESS] = {skewness, BW_NS_MOMENT_W},
    [BW_NS_PROFILE_W_FLATNESS] = {flatness, BW_NS_MOMENT_W},
    [BW_NS_PROFILE_K] = {k_at_centre, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_PRODUCTION] = {production, BW_NS_MOMENT_UV},
    [BW_NS_PROFILE_DISSIPATION] = {dissipation, BW_NS_MOMENT_GRADIENTS},
    [BW_NS_PROFILE_TURBULENT_TRANSPORT] = {turbulent_transport, BW_NS_MOMENT_VVV},
    [BW_NS_PROFILE_PRESSURE_TRANSPORT] = {pressure_transport, BW_NS_MOMENT_PV},
    [BW_NS_PROFILE_VISCOUS_DIFFUSION] = {viscous_diffusion, BW_NS_MOMENT_U},
    [BW_NS_PROFILE_V] = {plain, BW_NS_MOMENT_V},
    [BW_NS_PROFILE_V_RMS] = {rms, BW_NS_MOMENT_V},
    [BW_NS_PROFILE_UV] = {uv, BW_NS_MOMENT_UV},
    [BW_NS_PROFILE_VW] = {vw, BW_NS_MOMENT_VW},
    [BW_NS_PROFILE_OX_RMS] = {rms, BW_NS_MOMENT_OX},
    [BW_NS_PROFILE_OZ_RMS] = {rms, BW_NS_MOMENT_OZ},
    [BW_NS_PROFILE_V_SKEWNESS] = {skewness, BW_NS_MOMENT_V},
    [BW_NS_PROFILE_V_FLATNESS] = {flatness, BW_NS_MOMENT_V},
    [BW_NS_PROFILE_SHEAR] = {shear, BW_NS_MOMENT_OZ},
    [BW_NS_PROFILE_EDDY] = {plain, BW_NS_MOMENT_EDDY},
    [BW_NS_PROFILE_TOTAL] = {total, BW_NS_MOMENT_OZ},
};

/* What changes sign when y does: odd in v, o_x, o_z together. */
static const bool odd[BW_NS_MOMENTS] = {
    [BW_NS_MOMENT_V] = true,    [BW_NS_MOMENT_VVV] = true, [BW_NS_MOMENT_UV] = true,
    [BW_NS_MOMENT_VW] = true,   [BW_NS_MOMENT_OX] = true,  [BW_NS_MOMENT_OZ] = true,
    [BW_NS_MOMENT_VUU] = true,  [BW_NS_MOMENT_VWW] = true, [BW_NS_MOMENT_PV] = true,
    [BW_NS_MOMENT_EDDY] = true,
};

bool bw_ns_profile_on_faces(bw_ns_profile_kind kind)
{
  return kind >= BW_NS_PROFILE_V;
}

/* Mean moments of batches first .. last - 1 into s->work. */
static void mean_moments(const bw_ns_statistics *s, int first, int last, double samples, bool fold)
{
  double *mean = s->work, *flat = s->work + s->size;
  /* Sums of the chosen batches over their samples. */
  for (size_t q = 0; q < s->size; q++) {
    double sum = 0.0;
    for (int b = first; b < last; b++)
      sum += s->batch[(size_t)b * s->size + q];
    mean[q] = samples > 0 ? sum / samples : 0.0;
  }
  if (!fold) return;
  /* Folding: a moment and its mirror image, which for odd ones has the other sign. */
  for (int m = 0; m < BW_NS_MOMENTS; m++) {
    const double sign = odd[m] ? -1.0 : 1.0;
    const bool face = m >= BW_NS_MOMENT_V;
    const size_t at = (size_t)m * (size_t)s->rows;
    for (int j = face ? 0 : 1; j < s->rows; j++) {
      /* Faces run from 0 to n1, centres from 1 to n1. */
      const int mirror = s->rows - (face ? 1 : 0) - j;
      flat[at + (size_t)j] = 0.5 * (mean[at + (size_t)j] + sign * mean[at + (size_t)mirror]);
    }
    /* Centres have no row 0. */
    flat[at] = face ? flat[at] : 0.0;
  }
  for (size_t q = 0; q < s->size; q++)
    mean[q] = flat[q];
}

/* 97.5 % points of Student's t for 1 .. 15 degrees of freedom (any table of it). */
static double student(int freedom)
{
  static const double t[BW_NS_BATCHES - 1] = {12.706, 4.303, 3.182, 2.776, 2.571,
                                              2.447,  2.365, 2.306, 2.262, 2.228,
                                              2.201,  2.179, 2.160, 2.145, 2.131};
  return t[freedom - 1];
}

double bw_ns_statistics_moment(const bw_ns_statistics *s, bw_ns_moment which, int row)
{
  double sum = 0.0;
  for (int b = 0; b < BW_NS_BATCHES; b++)
    sum += s->batch[(size_t)b * s->size + (size_t)which * (size_t)s->rows + (size_t)row];
  const long n = bw_ns_statistics_samples(s);
  return n > 0 ? sum / (double)n : 0.0;
}

void bw_ns_statistics_profile(const bw_ns_statistics *s, bw_ns_profile_kind kind, bool fold,
                              bw_ns_estimate out[])
{
  const profile_source m = {s->work, s->rows, s->nu, s->g->y_face, s->g->y_centre};
  const int first = bw_ns_profile_on_faces(kind) ? 0 : 1, n = s->full;
  const profile_fn make = profiles[kind].make;
  double *mean = s->value;
  out[0] = (bw_ns_estimate){0.0, 0.0};
  for (int j = 0; j < s->rows; j++)
    out[j].interval = mean[j] = 0.0;
  /* mean of batches, then squares of what they differ from it */
  for (int pass = 0; pass < 2; pass++)
    for (int b = 0; b < n; b++) {
      mean_moments(s, b, b + 1, (double)s->per_batch, fold);
      for (int j = first; j < s->rows; j++) {
        /* Profiles are not linear in the moments: each batch makes its own. */
        const double x = make(&m, profiles[kind].first, j);
        if (pass == 0)
          mean[j] += x / n;
        else
          out[j].interval += (x - mean[j]) * (x - mean[j]);
      }
    }
  /* The value itself is that of all samples together, those of the unfinished batch included. */
  mean_moments(s, 0, BW_NS_BATCHES, (double)bw_ns_statistics_samples(s), fold);
  for (int j = first; j < s->rows; j++) {
    out[j].mean = make(&m, profiles[kind].first, j);
    /* Student's t times the standard error of the batch means. */
    out[j].interval =
        n < 2 ? (double)NAN : student(n - 1) * sqrt(out[j].interval / ((double)n * (n - 1)));
  }
}
