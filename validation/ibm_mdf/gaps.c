/* Claim: gaps of a few cells let through what they should, between plates along the grid and across
 * it, and between cylinders.
 *
 * plates     in a periodic box, the fluid between them driven by an acceleration G along them (each
 *            cell by its share of the gap), the fluid beyond them at rest: the flow rate is
 *            G H^3/(12 nu), H the gap.
 * cylinders  square array, half of the area solid, driven along a side by a gradient that acts
 *            everywhere, in slow flow: F = K mu U, K = 532.55, the gap is 0.2021 of the pitch.
 *            The tortuosity of that flow (bw_ns_channel_tortuosity) is the secant of the slant.
 * Reference  closed form; series of the stream function, data/cylinder_array (the same as Sangani
 *            and Acrivos 1982 to 1e-5 here).
 * Measured   gaps of 4, 8, 16 cells (cylinders: 4.04, 8.08, 16.2), markers on the true surface;
 *            mean over several places on the grid. Steady: plates after 0.8 of a diffusion time
 *            of the box, cylinders when U changes by less than 1e-5 in a hundredth of one.
 * Tolerance  3 % with 8 cells, a goal set before, in (h/H)^2 with 4 and 16. Order 1.8 at least
 *            where the error of the finer grid is above 2e-4 (the shares of the cells, the table,
 *            what is not steady); between cylinders it is reported: 0.2, 0.4 and 0.3 % are left
 *            there, as much as 0.012 h of wall are worth with 16 cells, which is not explained.
 * BUILD modules=ns_channel
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_validation.h"

#include <stdio.h>

enum { ASIDE = 12 };          /* cells of solid at least between the backs of the plates */
static const double G = 0.01; /* h = nu = 1 */
static const double SURE = 2e-4;

/* Direction of the plates in a periodic box of (x_fixed + x_per_y m, m) cells: the stack of plates
 * repeats after `period` m along the normal (-e_y, e_x), a plate is `fixed + per_y m` long. */
typedef struct {
  const char *name;
  double e[2];
  int x_fixed, x_per_y;
  double period, fixed, per_y;
  int places; /* on the grid */
} slant;

static const slant slants[] = {
    {"along the grid", {1.0, 0.0}, 4, 0, 1.0, 4.0, 0.0, 5},
    {"along (2, 1)",
     {0.89442719099991587856, 0.44721359549995793928},
     0,
     2,
     0.89442719099991587856,
     0.0,
     2.23606797749978969641,
     2},
    {"along (1, 1)",
     {0.70710678118654752440, 0.70710678118654752440},
     0,
     1,
     0.70710678118654752440,
     0.0,
     1.41421356237309504880,
     2},
};

typedef struct {
  const slant *a;
  double gap, lower, period; /* lower: height of the lower plate, along the normal */
  double length;             /* of a plate within the box */
  body_flow flow;
} scene;

/* Share of the cell about (x, y) that lies in the gap: 16 x 16 points. */
static double share(const scene *s, double x, double y)
{
  enum { FINE = 16 };
  int in = 0;
  for (int q = 0; q < FINE * FINE; q++) {
    const double px = x + (q % FINE + 0.5) / FINE - 0.5, py = y + (q / FINE + 0.5) / FINE - 0.5;
    const double eta = s->a->e[0] * py - s->a->e[1] * px - s->lower;
    in += eta - s->period * floor(eta / s->period) < s->gap;
  }
  return (double)in / (FINE * FINE);
}

/* The drive at the points of u and v. */
static bw_status drive_gap(scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->flow.grid);
  bw_real **const drive = s->flow.drive;
  BW_TRY(bw_field_create(s->flow.grid, &drive[0]));
  BW_TRY(bw_field_create(s->flow.grid, &drive[1]));
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++) {
      const double x = i - 0.5, y = j + g->lo[1] - 0.5;
      drive[0][bw_at(g, i, j, 1)] = (bw_real)(G * s->a->e[0] * share(s, x + 0.5, y));
      drive[1][bw_at(g, i, j, 1)] = (bw_real)(G * s->a->e[1] * share(s, x, y + 0.5));
    }
  bw_halo_update(s->flow.grid, 2, drive);
  return BW_OK;
}

/* Markers of both plates, a spacing apart. */
static bw_status set_plates(const bw_comm *comm, scene *s)
{
  const double *e = s->a->e, n[2] = {-e[1], e[0]};
  const size_t per_plate = (size_t)lround(s->length);
  const double step = s->length / (double)per_plate;
  body_surface p;
  bw_status st = body_surface_alloc(comm, 2 * per_plate, &p);
  for (size_t q = 0; st == BW_OK && q < p.n; q++) {
    const bool upper = q >= per_plate;
    const double along = ((double)(q % per_plate) + 0.37) * step;
    for (int d = 0; d < 2; d++) {
      p.X[3 * q + (size_t)d] = along * e[d] + (s->lower + (upper ? s->gap : 0.0)) * n[d];
      p.N[3 * q + (size_t)d] = upper ? -n[d] : n[d];
    }
    p.X[3 * q + 2] = 0.5;
    p.dV[q] = step;
  }
  BW_THEN(st, body_set_markers(&s->flow, &p));
  body_surface_free(&p);
  return st;
}

static bw_status make_plates(const bw_comm *comm, scene *s)
{
  const int m = (int)ceil((s->gap + ASIDE) / s->a->period);
  const body_box box = {.n = {s->a->x_fixed + s->a->x_per_y * m, m, 1},
                        .h = 1.0,
                        .nu = 1.0,
                        .periodic = {true, true, true},
                        .body = bw_ibm_mdf_config_default()};
  s->length = s->a->fixed + s->a->per_y * m;
  s->period = s->a->period * m;
  BW_TRY(body_flow_box(comm, &box, &s->flow));
  s->flow.dt = 0.5 * bw_ns_channel_dt_max(s->flow.fluid);
  BW_TRY(drive_gap(s));
  return set_plates(comm, s);
}

/* Flow through the gap per depth: the sum over its cells, over the length of a plate. */
static double flow_rate(scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->flow.grid);
  bw_real *const *u = bw_ns_channel_velocity(s->flow.fluid);
  double sum = 0.0;
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++)
      for (int d = 0; d < 2; d++)
        sum += (double)(s->flow.drive[d][bw_at(g, i, j, 1)] * u[d][bw_at(g, i, j, 1)]) / G;
  bw_comm_sum(bw_grid_comm(s->flow.grid), 1, &sum);
  return sum / s->length;
}

/* Means over the places of the flow rate over the closed form, and of the tortuosity. */
static bw_status plates(const bw_comm *comm, const slant *a, double gap, double *ratio,
                        double *tortuosity)
{
  static const double nowhere[3] = {-1e9, -1e9, -1e9}, everywhere[3] = {1e9, 1e9, 1e9};
  *ratio = *tortuosity = 0.0;
  for (int place = 0; place < a->places; place++) {
    scene s = {.a = a, .gap = gap, .lower = 6.0 + (double)place / a->places};
    bw_status st = make_plates(comm, &s);
    while (st == BW_OK && bw_ns_channel_time(s.flow.fluid) < 0.8 * s.period * s.period)
      st = body_flow_step(&s.flow);
    if (st == BW_OK) {
      *ratio += flow_rate(&s) / (G * gap * gap * gap / 12.0) / a->places;
      *tortuosity += bw_ns_channel_tortuosity(s.flow.fluid, 0, nowhere, everywhere) / a->places;
    }
    body_flow_destroy(&s.flow);
    BW_TRY(st);
  }
  return BW_OK;
}

/* K of the array with this many cells along the pitch, the cylinder off the nodes by off h. */
static bw_status cylinder(const bw_comm *comm, int cells, const double off[2], double *K)
{
  const double R = sqrt(0.5 / acos(-1.0)), h = 1.0 / cells;
  const double centre[2] = {0.5 + off[0] * h, 0.5 + off[1] * h};
  const double gradient = 50.0; /* U = 0.1: Re = 0.08 */
  const body_box box = {.n = {cells, cells, 1},
                        .h = h,
                        .nu = 1.0,
                        .periodic = {true, true, true},
                        .forcing = BW_FORCING_GRADIENT,
                        .forcing_value = gradient,
                        .body = bw_ibm_mdf_config_default()};
  body_flow f = {0};
  body_surface s = {0};
  bw_status st = body_flow_box(comm, &box, &f);
  BW_THEN(st, body_surface_alloc(comm, body_circle_size(R, h), &s));
  if (st == BW_OK) {
    body_circle(&s, 0, body_circle_size(R, h), centre, R, h);
    f.dt = 0.5 * bw_ns_channel_dt_max(f.fluid);
    st = body_set_markers(&f, &s);
  }
  double last = HUGE_VAL, U = 0.0;
  while (st == BW_OK && fabs(U - last) > 1e-5 * fabs(U)) {
    const double until = bw_ns_channel_time(f.fluid) + 0.01;
    last = U;
    while (st == BW_OK && bw_ns_channel_time(f.fluid) < until)
      st = body_flow_step(&f);
    if (st == BW_OK) U = bw_ns_channel_summary(f.fluid).bulk_velocity;
  }
  *K = gradient / U;
  body_surface_free(&s);
  body_flow_destroy(&f);
  return st;
}

/* Mean over places on the grid; the spread of it goes with the kernel's noise. */
static bw_status cylinders(const bw_comm *comm, int cells, double *K)
{
  enum { PLACES = 5 };
  *K = 0.0;
  for (int q = 0; q < PLACES; q++) {
    const double off[2] = {(double)(2 * q % PLACES) / PLACES, (q + 0.5) / PLACES};
    double one = NAN;
    BW_TRY(cylinder(comm, cells, off, &one));
    *K += one / PLACES;
  }
  return BW_OK;
}

static void rows(bw_validation *v, const char *name, int gap, double value, double reference,
                 const char *source, double before, bool claimed)
{
  char claim[96], extra[64];
  const double error = value / reference - 1.0;
  snprintf(claim, sizeof claim, "%s, gap of %d cells", name, gap);
  snprintf(extra, sizeof extra, "\"gap\": %d", gap);
  bw_validation_row(v, &(bw_claim){claim, "flow", value, reference, 0.03 * 64.0 / (gap * gap),
                                   BW_ANALYTIC, source, extra});
  if (gap == 4 || fabs(error) < SURE) return;
  /* How much is missing to the least order. */
  const double order = bw_validation_order(2.0, fabs(before), 1.0, fabs(error));
  snprintf(claim, sizeof claim, "%s, order from %d to %d cells", name, gap / 2, gap);
  bw_validation_row(v, &(bw_claim){claim, "order", order, 1.8, INFINITY, BW_ORDER, source, extra});
  if (!claimed) return;
  snprintf(claim, sizeof claim, "%s, %d cells: order of 1.8 at least", name, gap);
  bw_validation_row(v, &(bw_claim){claim, "order_missing", fmax(0.0, 1.8 - order), 0.0, 0.0,
                                   BW_ORDER, source, extra});
}

/* 2 %: a goal set before. */
static void winding(bw_validation *v, const slant *a, int gap, double tortuosity)
{
  char claim[96], extra[64];
  snprintf(claim, sizeof claim, "tortuosity %s, gap of %d cells", a->name, gap);
  snprintf(extra, sizeof extra, "\"gap\": %d", gap);
  bw_validation_row(v, &(bw_claim){claim, "tortuosity", tortuosity, 1.0 / a->e[0], 0.02,
                                   BW_ANALYTIC, "secant of the slant", extra});
}

static bw_status run(bw_validation *v)
{
  enum { COLUMNS = 3, MOST = 16 };
  double table[MOST][COLUMNS], K = NAN, before = NAN;
  int n = 0;
  BW_TRY(bw_validation_table("cylinder_array/square_array.csv", COLUMNS, MOST, table[0], &n));
  for (int q = 0; q < n; q++)
    if (table[q][0] == 0.5) K = table[q][1];
  for (int gap = 4; gap <= 16; gap *= 2) {
    double value = NAN;
    BW_TRY(cylinders(bw_validation_comm(v), 5 * gap, &value));
    rows(v, "cylinders", gap, value, K, "series, data/cylinder_array", before, false);
    before = value / K - 1.0;
  }
  for (size_t a = 0; a < sizeof slants / sizeof *slants; a++)
    for (int gap = 4; gap <= 16; gap *= 2) {
      double ratio = NAN, tortuosity = NAN;
      BW_TRY(plates(bw_validation_comm(v), &slants[a], gap, &ratio, &tortuosity));
      rows(v, slants[a].name, gap, ratio, 1.0, "Poiseuille flow", before, true);
      winding(v, &slants[a], gap, tortuosity);
      before = ratio - 1.0;
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ibm_mdf.gaps", run);
}
