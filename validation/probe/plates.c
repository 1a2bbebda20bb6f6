/* Claim: between two plates of markers probes give the wall shear G H/2 of Poiseuille flow, along
 * the grid and across it, and in gaps too narrow for them they say so.
 *
 * Plates in a periodic box, the fluid between them driven by an acceleration G along them (each
 * cell by its share of the gap), the fluid beyond them at rest. All of the drive ends on the
 * plates, so that the shear on each is G H/2 per density whatever the markers do (closed form).
 * Measured   gaps of 1 to 16 cells, ten places on the grid; plates along x, and along (2, 1).
 *            Retraction by bw_ibm_mdf_retraction; probes with the quadratic profile, dl = 2 h,
 *            solid cells as obstacles (cells whose centre is beyond a plate). Mean and largest
 *            error of the shear, flags; the same without obstacles beside, without claim.
 * Tolerance  a wall felt 0.1 h away from the nominal one moves the parabola's slope at the wall by
 *            2 (0.1 h)/dl: 10 % with dl = 2 h, 20 % with dl = h where a probe is shortened. What
 *            lies within h of the tip's far side is read as well: 10 % more for the largest error,
 *            and, in gaps below 2 h, where that is so of every tip, for the mean.
 *            Crowded probes may be wrong by what they like, but have to be flagged.
 * BUILD modules=ns_channel,ibm_mdf
 * TEST  ranks=1 timeout=3600 */
#include "../../cases/cylinder_drag/body_flow.h"
#include "bw_probe.h"
#include "bw_validation.h"

#include <stdio.h>
#include <string.h>

enum { ASIDE = 12 };          /* cells of solid at least between the backs of the plates */
static const double G = 0.01; /* h = nu = 1 */

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
    {"along the grid", {1.0, 0.0}, 4, 0, 1.0, 4.0, 0.0, 10},
    {"along (2, 1)",
     {0.89442719099991587856, 0.44721359549995793928},
     0,
     2,
     0.89442719099991587856,
     0.0,
     2.23606797749978969641,
     2},
};

typedef struct {
  const slant *a;
  double gap, lower, period; /* lower: height of the lower plate, along the normal */
  body_flow flow;
  body_surface markers, wall; /* lower plate, then upper plate */
  size_t per_plate;
  bw_real *solid;
  bw_probe *probe;
  double *traction;
  unsigned char *flag;
} scene;

typedef struct {
  double count[4];  /* of the flags */
  double sum, most; /* error of the shear by free and shortened probes: sum, largest size */
  double crowded;   /* sum over the crowded ones */
} outcome;

static void destroy(scene *s)
{
  bw_release(&s->traction);
  bw_release(&s->flag);
  bw_release(&s->solid);
  bw_probe_destroy(&s->probe);
  body_surface_free(&s->markers);
  body_surface_free(&s->wall);
  body_flow_destroy(&s->flow);
}

/* Height above the lower plate, in [0, period). */
static double height(const scene *s, double x, double y)
{
  const double eta = s->a->e[0] * y - s->a->e[1] * x - s->lower;
  return eta - s->period * floor(eta / s->period);
}

/* Share of the cell about (x, y) that lies in the gap: 16 x 16 points. */
static double share(const scene *s, double x, double y)
{
  enum { FINE = 16 };
  int in = 0;
  for (int q = 0; q < FINE * FINE; q++)
    in += height(s, x + (q % FINE + 0.5) / FINE - 0.5, y + (q / FINE + 0.5) / FINE - 0.5) < s->gap;
  return (double)in / (FINE * FINE);
}

/* Drive at the points of u and v; solid where a cell's centre is beyond a plate. */
static bw_status fill_fields(scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->flow.grid);
  bw_real **const drive = s->flow.drive;
  BW_TRY(bw_field_create(s->flow.grid, &drive[0]));
  BW_TRY(bw_field_create(s->flow.grid, &drive[1]));
  BW_TRY(bw_field_create(s->flow.grid, &s->solid));
  for (int j = 1; j <= g->m[1]; j++)
    for (int i = 1; i <= g->m[0]; i++) {
      const double x = i - 0.5, y = j + g->lo[1] - 0.5;
      drive[0][bw_at(g, i, j, 1)] = (bw_real)(G * s->a->e[0] * share(s, x + 0.5, y));
      drive[1][bw_at(g, i, j, 1)] = (bw_real)(G * s->a->e[1] * share(s, x, y + 0.5));
      s->solid[bw_at(g, i, j, 1)] = height(s, x, y) > s->gap ? 1 : 0;
    }
  bw_halo_update(s->flow.grid, 2, drive);
  bw_halo_update(s->flow.grid, 1, &s->solid);
  return BW_OK;
}

/* Two plates, `back` behind the nominal ones, points `step` apart. */
static bw_status plates(const bw_comm *comm, const scene *s, double back, double step,
                        body_surface *p)
{
  const double *e = s->a->e, n[2] = {-e[1], e[0]};
  BW_TRY(body_surface_alloc(comm, 2 * s->per_plate, p));
  for (size_t q = 0; q < p->n; q++) {
    const bool upper = q >= s->per_plate;
    const double eta = s->lower + (upper ? s->gap + back : -back);
    const double along = ((double)(q % s->per_plate) + 0.37) * step;
    for (int d = 0; d < 2; d++) {
      p->X[3 * q + (size_t)d] = along * e[d] + eta * n[d];
      p->N[3 * q + (size_t)d] = upper ? -n[d] : n[d];
    }
    p->X[3 * q + 2] = 0.5, p->N[3 * q + 2] = 0.0;
    p->dV[q] = step;
  }
  return BW_OK;
}

static bw_status make(const bw_comm *comm, scene *s)
{
  const bw_ibm_mdf_config body = bw_ibm_mdf_config_default();
  const int m = (int)ceil((s->gap + ASIDE) / s->a->period);
  const double length = s->a->fixed + s->a->per_y * m;
  const body_box box = {.n = {s->a->x_fixed + s->a->x_per_y * m, m, 1},
                        .h = 1.0,
                        .nu = 1.0,
                        .periodic = {true, true, true},
                        .body = body};
  bw_probe_config probe = bw_probe_config_default();
  probe.rho = probe.nu = 1.0, probe.profile = BW_PROBE_QUADRATIC;
  s->period = s->a->period * m;
  s->per_plate = (size_t)lround(length);
  const double step = length / (double)s->per_plate;
  BW_TRY(body_flow_box(comm, &box, &s->flow));
  s->flow.dt = 0.5 * bw_ns_channel_dt_max(s->flow.fluid);
  BW_TRY(fill_fields(s));
  BW_TRY(plates(comm, s, 0.0, step, &s->markers));
  BW_TRY(plates(comm, s, 0.0, step, &s->wall));
  BW_TRY(BW_ALLOCATE(&s->traction, 3 * s->wall.n));
  BW_TRY(BW_ALLOCATE(&s->flag, s->wall.n));
  BW_TRY(bw_probe_create(s->flow.grid, &probe, &s->probe));
  return body_set_markers(&s->flow, &s->markers);
}

/* The probes' shear against G H/2, with obstacles or without. */
static bw_status look(scene *s, bool obstacles, outcome *o)
{
  BW_TRY(bw_probe_set_obstacles(s->probe, obstacles ? s->solid : NULL));
  BW_TRY(bw_probe_set_points(s->probe, s->wall.n, s->wall.X, s->wall.N));
  bw_probe_traction(s->probe, bw_ns_channel_velocity(s->flow.fluid), s->flow.pressure, NULL,
                    s->traction, s->flag);
  for (size_t q = 0; q < s->wall.n; q++) {
    const double *t = s->traction + 3 * q;
    const double error = (t[0] * s->a->e[0] + t[1] * s->a->e[1]) / (0.5 * G * s->gap) - 1.0;
    o->count[s->flag[q]] += 1.0;
    if (s->flag[q] == BW_PROBE_CROWDED) o->crowded += error;
    if (s->flag[q] != BW_PROBE_FREE && s->flag[q] != BW_PROBE_SHORTENED) continue;
    o->sum += error;
    o->most = fmax(o->most, fabs(error));
  }
  return BW_OK;
}

/* All places on the grid; steady after 0.8 of the diffusion time of the box. */
static bw_status all_places(const bw_comm *comm, const slant *a, double gap, outcome o[2])
{
  memset(o, 0, 2 * sizeof *o);
  for (int place = 0; place < a->places; place++) {
    scene s = {.a = a, .gap = gap, .lower = 6.0 + (double)place / a->places};
    bw_status st = make(comm, &s);
    while (st == BW_OK && bw_ns_channel_time(s.flow.fluid) < 0.8 * s.period * s.period)
      st = body_flow_step(&s.flow);
    BW_THEN(st, look(&s, true, &o[0]));
    BW_THEN(st, look(&s, false, &o[1]));
    destroy(&s);
    BW_TRY(st);
  }
  for (int q = 0; q < 2; q++) {
    bw_comm_sum(comm, 4, o[q].count);
    bw_comm_sum(comm, 1, &o[q].sum);
    bw_comm_sum(comm, 1, &o[q].crowded);
    bw_comm_max(comm, 1, &o[q].most);
  }
  return BW_OK;
}

static double mean(double sum, double count)
{
  return count > 0.0 ? sum / count : 0.0;
}

static void rows(bw_validation *v, const slant *a, double gap, const outcome o[2])
{
  const double *n = o[0].count, given = n[BW_PROBE_FREE] + n[BW_PROBE_SHORTENED];
  const double lever = n[BW_PROBE_SHORTENED] > 0.0 ? 0.2 : 0.1, near = gap < 2.0 ? 0.1 : 0.0;
  const struct {
    const char *quantity;
    double measured, tolerance;
  } row[] = {{"mean_error", mean(o[0].sum, given), lever + near},
             {"largest_error", o[0].most, lever + 0.1},
             {"mean_error_crowded", mean(o[0].crowded, n[BW_PROBE_CROWDED]), INFINITY},
             {"mean_error_no_obstacles", mean(o[1].sum, o[1].count[BW_PROBE_FREE]), INFINITY}};
  for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
    char claim[96], extra[192];
    snprintf(claim, sizeof claim, "%s, gap %g, %s", row[q].quantity, gap, a->name);
    snprintf(extra, sizeof extra,
             "\"gap\": %g, \"free\": %g, \"shortened\": %g, \"crowded\": %g, \"blocked\": %g", gap,
             n[BW_PROBE_FREE], n[BW_PROBE_SHORTENED], n[BW_PROBE_CROWDED], n[BW_PROBE_BLOCKED]);
    bw_validation_row(v, &(bw_claim){claim, row[q].quantity, row[q].measured, 0.0, row[q].tolerance,
                                     BW_ANALYTIC, "G H/2 by momentum", extra});
  }
}

static bw_status run(bw_validation *v)
{
  static const double gaps[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 16.0};
  const int most = bw_validation_full(v) ? 10 : 9;
  for (size_t a = 0; a < sizeof slants / sizeof *slants; a++)
    for (int q = 0; q < most; q++) {
      outcome o[2];
      BW_TRY(all_places(bw_validation_comm(v), &slants[a], gaps[q], o));
      rows(v, &slants[a], gaps[q], o);
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "probe.plates", run);
}
