/* The exact part of a square or cube cell that lies within the horizon. */
#include "pd_body.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>

/* Integral of sqrt(R^2 - x^2) from 0 to x. */
static double under_arc(double R, double x)
{
  const double c = fmax(-1, fmin(1, x / R));
  return 0.5 * (x * sqrt(fmax(0, R * R - x * x)) + R * R * asin(c));
}

/* Height at x of the disc inside y0 <= y <= y1. */
static double height(double R, double x, double y0, double y1, double *arc_weight)
{
  const double h = sqrt(fmax(0, R * R - x * x));
  const double top = fmin(y1, h), bottom = fmax(y0, -h);
  *arc_weight = 0;
  if (top <= bottom) return 0;
  *arc_weight = (h < y1) + (-h > y0); /* how often the arc itself bounds the strip */
  return (h < y1 ? 0 : y1) - (-h > y0 ? 0 : y0);
}

static void sort(int n, double x[])
{
  for (int i = 1; i < n; i++)
    for (int k = i; k > 0 && x[k] < x[k - 1]; k--) {
      const double swap = x[k];
      x[k] = x[k - 1];
      x[k - 1] = swap;
    }
}

/* Area of the disc of radius R about the origin inside the unit square about (cx, cy): the bounds
 * in y change only where the arc meets a side, and between those the integral is closed. */
static double disc_in_square(double R, double cx, double cy)
{
  const double x0 = cx - 0.5, x1 = cx + 0.5, y0 = cy - 0.5, y1 = cy + 0.5;
  /* Vertical cuts where the arc enters or leaves the square, or ends. */
  double cut[8] = {x0, x1};
  int n = 2;
  const double meets[3] = {R, R > fabs(y0) ? sqrt(R * R - y0 * y0) : x0,
                           R > fabs(y1) ? sqrt(R * R - y1 * y1) : x0};
  for (int q = 0; q < 3; q++)
    for (int sign = -1; sign <= 1; sign += 2) {
      const double x = sign * meets[q];
      if (x > x0 && x < x1) cut[n++] = x;
    }
  sort(n, cut);
  double area = 0;
  /* Between two cuts the bounds in y are the same all the way. */
  for (int q = 0; q + 1 < n; q++) {
    const double middle = 0.5 * (cut[q] + cut[q + 1]);
    double arcs;
    if (fabs(middle) >= R) continue;
    /* Straight sides give a rectangle, the arc its closed integral. */
    const double flat = height(R, middle, y0, y1, &arcs);
    area += flat * (cut[q + 1] - cut[q]) + arcs * (under_arc(R, cut[q + 1]) - under_arc(R, cut[q]));
  }
  return fmax(0, fmin(1, area));
}

double bw_pd_body_fraction_area(double m, const double offset[3])
{
  return disc_in_square(m, fabs(offset[0]), fabs(offset[1]));
}

typedef struct {
  double m, x, y;
} ball;

static double slice(double z, void *data)
{
  const ball *b = data;
  const double R2 = b->m * b->m - z * z;
  return R2 > 0 ? disc_in_square(sqrt(R2), b->x, b->y) : 0;
}

/* Slices of the ball are discs: one adaptive quadrature (doubly adaptive, good with kinks). */
bw_status bw_pd_body_fraction_volume(double m, const double offset[3], double *fraction)
{
  /* Most cells are inside or outside altogether. */
  const double x = fabs(offset[0]), y = fabs(offset[1]), z = fabs(offset[2]);
  const double near2 =
      pow(fmax(0, x - 0.5), 2) + pow(fmax(0, y - 0.5), 2) + pow(fmax(0, z - 0.5), 2);
  const double far2 = pow(x + 0.5, 2) + pow(y + 0.5, 2) + pow(z + 0.5, 2);
  *fraction = far2 <= m * m ? 1 : 0;
  if (far2 <= m * m || near2 >= m * m) return BW_OK;

  /* A cell that the sphere cuts: POROUS 3.3.5, read as in ERRATA 2. */
  gsl_integration_cquad_workspace *work = gsl_integration_cquad_workspace_alloc(200);
  BW_REQUIRE(work != NULL, BW_EMEM, "solid: no memory for the volume fractions");
  ball b = {m, x, y};
  gsl_function f = {slice, &b};
  /* GSL ends the program by default; we want a status. */
  gsl_error_handler_t *old = gsl_set_error_handler_off();
  const int code =
      gsl_integration_cquad(&f, z - 0.5, z + 0.5, 1e-11, 1e-11, work, fraction, NULL, NULL);
  gsl_set_error_handler(old);
  gsl_integration_cquad_workspace_free(work);
  /* GSL_EDIVERGE is said where the tolerance is at the limit of rounding: the value is good. */
  BW_REQUIRE(code == GSL_SUCCESS || code == GSL_EDIVERGE, BW_EDIVERGED,
             "solid: volume fraction of offset (%g,%g,%g) at horizon/ds = %g: %s", offset[0],
             offset[1], offset[2], m, gsl_strerror(code));
  *fraction = fmax(0, fmin(1, *fraction));
  return BW_OK;
}
