/* Claim: with films the faces of a solid of particles are braked rightly by each other and by a
 * wall, from a tenth of a cell to three, without a step, also those of a crack; what flows along a
 * slit is that of the cubic law, in the fluid around it too; what films take is booked.
 *
 * Reference  lubrication theory in the plane. Plates of length L at the gap h: mu V L^3/h^3 per
 *            depth. A plate that sinks under the weight F: 1/h^2 grows by 2 F/(mu L^3) per time. A
 *            slit of length l: h^3/(12 mu) times the drop of pressure over l.
 * Measured   Plates of 128 cells, eight high, particles of one cell, mu/rho = 1 cell^2 per unit of
 *            time, moved towards each other by a thousandth of a cell while it is measured; load
 *            by the reaction and by probes. A step: plates that come together from 3.4 cells (by
 *            probes from 4.4, as films begin at four there) to a third of one, by 0.003 cells a
 *            step, and the faces of a crack of 48 cells, cut through
 *            a block, that open from a third of a cell to 3.4 and close again; the largest change
 *            of F h^3 from one step to the next, over the largest of it. The sinking plate is
 *            free, elastic, 32 cells long, over a wall; its gap after it has come from 0.9 to 0.35
 *            cells. The slit: two blocks, 40 cells long, of particles of half a cell, close a
 *            channel of 64 that a gradient drives but for a gap; the fluid beside them is at rest,
 *            so that all of the gradient's drop falls off along the slit. Measured: what flows in
 *            the film, and what flows through the channel in front of the blocks, which is that
 *            and what the grid lets through.
 * Tolerance  10 % and 2 %, the goals set for the method. Of it: a plate's ends, 1.4 h longer than
 *            the plate on either side together. Opposite forces: round-off. Reported alone: the
 *            channel's flow between 2.5 and 3 cells, where the grid takes the film over, which lets
 *            through a third too little there, and what that does to the force, which has not
 *            settled after 200 steps; and where the body itself leaks more than that (a tenth of a
 *            cell; particles that do not stand alike in the cells).
 * BUILD modules=coupler,shape,ns_channel
 * TEST  ranks=2 timeout=1200 */
#include "bw_coupler.h"
#include "bw_memory.h"
#include "bw_shape.h"
#include "bw_validation.h"

#include <math.h>
#include <stdio.h>

/* Blocks of particles in the plane, lengths in cells. */
typedef struct {
  int cells[2];
  double length, height; /* of a block */
  double middle;         /* height of the gap over the floor */
  double gap, speed, dt; /* speed of approach, half of it of either block */
  bw_coupler_load_kind load;
  bool flux;               /* what flows in films is the grid's */
  bool crack, alone, slit; /* cut out of one block; the upper one, free over a wall; see above */
  double drive, weight;    /* gradient along x over rho; gravity */
  double spacing;          /* of the particles; 0: one cell */
} set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  double *X, *V, *load;
  size_t n;
} scene;

static void destroy(scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
  bw_release(&s->X);
  bw_release(&s->V);
  bw_release(&s->load);
}

static bw_status make_fluid(const bw_comm *comm, const set_up *u, scene *s)
{
  bw_grid_config g = bw_grid_config_default();
  bw_ns_channel_config c = bw_ns_channel_config_default();
  g.n[0] = u->cells[0], g.n[1] = u->cells[1], g.n[2] = 1;
  for (int d = 0; d < 3; d++)
    g.length[d] = g.n[d], g.periodic[d] = d != 1;
  g.halo = 2;
  BW_TRY(bw_grid_create(comm, &g, &s->grid));
  c.nu = 1.0;
  if (u->drive > 0.0) c.forcing = BW_FORCING_GRADIENT, c.forcing_value = u->drive;
  for (int d = 0; d < 3; d++)
    c.side[d][0].kind = c.side[d][1].kind = d == 1 ? BW_SIDE_WALL : BW_SIDE_PERIODIC;
  return bw_ns_channel_create(s->grid, &c, &s->fluid);
}

/* Where the upper block is on the lattice: from there it is moved to its gap. */
static double apart(const set_up *u, const bw_solid_config *c)
{
  return u->crack ? 0.0 : 3.0 + ceil(c->horizon_ratio);
}

static bw_status fill(const bw_comm *comm, const set_up *u, const bw_solid_config *c, scene *s)
{
  const double x = 0.5 * u->cells[0], y = u->middle, R = 0.5 * u->length;
  const uint8_t kind_of = u->alone ? BW_PD_FREE : BW_PD_PRESCRIBED;
  bw_shape shape[2];
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  for (int q = 0; q < 2; q++) {
    const double low = q == 0 ? y - u->height : y + apart(u, c);
    shape[q] = (bw_shape){.kind = BW_SHAPE_BOX,
                          .particle_kind = kind_of,
                          .lower = {x - R, low, 0.0},
                          .upper = {x + R, low + u->height, 1.0}};
  }
  const bw_shape_lattice lattice = bw_shape_lattice_straight(c->ds, c->origin, true);
  bw_status st =
      bw_shape_fill(u->alone ? 1 : 2, shape + u->alone, &lattice, 0, 1, &n, &site, &kind, NULL);
  BW_THEN(st, bw_solid_create_same(comm, c, n, site, kind, &s->solid));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

/* Blocks to their gap, with their speeds. */
static void place(const set_up *u, const bw_solid_config *c, scene *s)
{
  bw_solid_get_position(s->solid, s->X);
  for (size_t i = 0; i < s->n; i++) {
    const bool above = s->X[3 * i + 1] > u->middle;
    s->X[3 * i + 1] += above ? 0.5 * u->gap - apart(u, c) : -0.5 * u->gap;
    s->V[3 * i + 1] = above ? -0.5 * u->speed : 0.5 * u->speed;
  }
  bw_solid_set_state(s->solid, s->X, s->V);
  bw_solid_set_prescribed(s->solid, s->V);
}

static bw_status make_solid(const bw_comm *comm, const set_up *u, scene *s)
{
  bw_solid_config c = bw_solid_config_default();
  const double x = 0.5 * u->cells[0], y = u->middle;
  c.geometry = BW_PD_PLANE_STRAIN;
  c.thickness = 1.0, c.ds = u->spacing > 0.0 ? u->spacing : 1.0;
  c.rho = 4.0, c.E = u->alone ? 2e6 : 1e3;
  c.damping.mean = u->alone ? 4e2 : 0.0;
  c.origin[0] = x, c.origin[1] = y, c.origin[2] = 0.5;
  BW_TRY(fill(comm, u, &c, s));
  s->n = bw_solid_count(s->solid);
  BW_TRY(BW_ALLOCATE(&s->X, 3 * s->n));
  BW_TRY(BW_ALLOCATE(&s->V, 3 * s->n));
  BW_TRY(BW_ALLOCATE(&s->load, 3 * s->n));
  if (u->crack)
    BW_TRY(bw_solid_precrack(s->solid, (double[3]){0.0, y, 0.0}, (double[3]){u->cells[0], y, 0.0},
                             NULL));
  place(u, &c, s);
  return BW_OK;
}

static bw_status make(const bw_comm *comm, const set_up *u, scene *s)
{
  bw_coupler_config c = bw_coupler_config_default();
  *s = (scene){0};
  BW_TRY(make_fluid(comm, u, s));
  BW_TRY(make_solid(comm, u, s));
  c.rho = c.nu = 1.0;
  c.load = u->load;
  c.gravity[1] = -u->weight;
  c.walled[1][0] = c.walled[1][1] = u->slit;
  c.films.on = true, c.films.flux = u->flux, c.films.roughness = 1e-3;
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
  return BW_OK;
}

/* Force of the fluid on the upper block along y, and on both. */
static void sum_load(const bw_comm *comm, const set_up *u, scene *s, double out[2])
{
  out[0] = out[1] = 0.0;
  bw_coupler_get_load(s->coupler, s->load);
  bw_solid_get_position(s->solid, s->X);
  for (size_t i = 0; i < s->n; i++) {
    if (s->X[3 * i + 1] > u->middle) out[0] += s->load[3 * i + 1];
    out[1] += s->load[3 * i + 1];
  }
  bw_comm_sum(comm, 2, out);
}

static const set_up plates = {
    .cells = {192, 48}, .length = 128.0, .height = 8.0, .middle = 24.0, .speed = 1e-5, .dt = 0.15};

static bw_status force_at(bw_validation *v, bw_coupler_load_kind load, double gap, bool flux)
{
  set_up u = plates;
  scene s;
  double F[2] = {NAN, NAN};
  char extra[64];
  u.gap = gap, u.load = load, u.flux = flux;
  bw_status st = make(bw_validation_comm(v), &u, &s);
  for (int q = 0; st == BW_OK && q < 200; q++)
    st = bw_coupler_step(s.coupler, u.dt);
  if (st == BW_OK) sum_load(bw_validation_comm(v), &u, &s, F);
  destroy(&s);
  BW_TRY(st);
  /* The film is that of the last step's beginning. */
  const double now = gap - u.speed * 199 * u.dt;
  const double expected = u.speed * pow(u.length / now, 3);
  snprintf(extra, sizeof extra, "\"gap_in_cells\": %g, \"flux\": %d", gap, flux);
  bw_validation_row(v,
                    &(bw_claim){"a face of particles is braked by another one",
                                load == BW_LOAD_PROBES ? "plates_by_probes" : "plates_by_reaction",
                                F[0], expected, flux && gap > 2.5 ? INFINITY : 0.10, BW_ANALYTIC,
                                "lubrication theory", extra});
  return BW_OK;
}

/* Faces that move from one gap to another, at `speed` of approach: largest change of F h^3 from one
 * step to the next, and the largest of it; the first fifth of a cell, the start, is left out. */
static bw_status travel(const bw_comm *comm, set_up *u, scene *s, double to, double most[2])
{
  const double from = u->gap, way = u->speed > 0.0 ? 1.0 : -1.0;
  double before = NAN, F[2];
  for (size_t i = 0; i < s->n; i++)
    s->V[3 * i + 1] = s->X[3 * i + 1] > u->middle ? -0.5 * u->speed : 0.5 * u->speed;
  bw_solid_set_prescribed(s->solid, s->V);
  while (way * (u->gap - to) > 0.0) {
    BW_TRY(bw_coupler_step(s->coupler, u->dt));
    sum_load(comm, u, s, F);
    const double now = F[0] * pow(u->gap, 3);
    if (fabs(u->gap - from) > 0.2) {
      if (!isnan(before)) most[0] = fmax(most[0], fabs(now - before));
      most[1] = fmax(most[1], fabs(now));
      before = now;
    }
    u->gap -= u->speed * u->dt;
  }
  return BW_OK;
}

static bw_status no_step(bw_validation *v, bool crack, bw_coupler_load_kind load, bool flux)
{
  const bw_comm *comm = bw_validation_comm(v);
  set_up u = plates;
  scene s;
  double most[2] = {0.0, 0.0};
  /* By probes the film begins at four cells. */
  const double far = load == BW_LOAD_PROBES ? 4.5 : 3.5;
  char extra[64];
  snprintf(extra, sizeof extra, "\"load\": \"%s\", \"flux\": %d",
           load == BW_LOAD_PROBES ? "probes" : "reaction", flux);
  u.speed = 0.02, u.gap = far, u.load = load, u.flux = flux;
  if (crack) {
    u.cells[0] = 80, u.cells[1] = 40, u.length = 48.0, u.height = 6.0, u.middle = 20.0;
    u.crack = true, u.gap = 0.3, u.speed = -0.02;
  }
  bw_status st = make(comm, &u, &s);
  bw_solid_get_position(s.solid, s.X);
  BW_THEN(st, travel(comm, &u, &s, crack ? far : 0.33, most));
  /* And back. */
  u.speed = 0.02;
  if (crack) BW_THEN(st, travel(comm, &u, &s, 0.33, most));
  destroy(&s);
  BW_TRY(st);
  bw_validation_row(v, &(bw_claim){"the force has no step",
                                   crack ? "crack_that_opens_and_closes" : "plates_that_close",
                                   most[0] / most[1], 0.0, 0.02, BW_CONSERVATION,
                                   "a force is continuous in the gap", extra});
  return BW_OK;
}

/* Mean height of the particles. */
static double mean_height(const bw_comm *comm, scene *s)
{
  double sum[2] = {0.0, (double)s->n};
  bw_solid_get_position(s->solid, s->X);
  for (size_t i = 0; i < s->n; i++)
    sum[0] += s->X[3 * i + 1];
  bw_comm_sum(comm, 2, sum);
  return sum[0] / sum[1];
}

static bw_status sink(bw_validation *v)
{
  const bw_comm *comm = bw_validation_comm(v);
  set_up u = {.cells = {64, 32},
              .length = 32.0,
              .height = 8.0,
              .gap = 2.4,
              .dt = 0.15,
              .load = BW_LOAD_REACTION,
              .alone = true,
              .weight = 3.2};
  scene s;
  bw_coupler_report r = {0};
  bw_solid_ledger ledger = {0};
  double start = NAN, h = 0.5 * u.gap, since = 0.0;
  bw_status st = make(comm, &u, &s);
  const double from = st == BW_OK ? mean_height(comm, &s) : NAN;
  for (int q = 0; st == BW_OK && q < 600 && h > 0.35; q++) {
    st = bw_coupler_step(s.coupler, u.dt);
    h = 0.5 * u.gap + mean_height(comm, &s) - from;
    if (isnan(start) && h < 0.9)
      start = h;
    else if (!isnan(start))
      since += u.dt;
  }
  BW_THEN(st, bw_coupler_measure(s.coupler, &r));
  BW_THEN(st, bw_solid_account(s.solid, &ledger));
  destroy(&s);
  BW_TRY(st);
  const double F = 3.0 * u.weight * u.length * u.height, L = u.length;
  const double fall = 0.5 * u.gap - h;
  bw_validation_row(v,
                    &(bw_claim){"a plate sinks towards a wall", "growth_of_1_over_gap_squared",
                                1.0 / (h * h) - 1.0 / (start * start), 2.0 * F * since / pow(L, 3),
                                0.10, BW_ANALYTIC, "lubrication theory", NULL});
  /* Work of the solid's external forces: weight, load, films. */
  bw_validation_row(v, &(bw_claim){"what films take is booked", "external_work", ledger.external,
                                   F * fall + r.work_received - r.work_film, 0.02, BW_CONSERVATION,
                                   "the solid's ledger, to the order of the step", NULL});
  return BW_OK;
}

/* What flows along x through the cells in front of the blocks. */
static double flow_in_front(const scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  const bw_real *u = bw_ns_channel_velocity(s->fluid)[0];
  double sum = 0.0;
  for (int j = 1; j <= g->m[1]; j++)
    sum += (double)u[bw_at(g, 2, j, 1)];
  bw_comm_sum(bw_grid_comm(s->grid), 1, &sum);
  return sum;
}

/* A slit of that gap, its middle so high. */
static bw_status slit(bw_validation *v, bw_coupler_load_kind load, double gap, double middle)
{
  const double G = 1e-3;
  const set_up u = {.cells = {64, 32},
                    .length = 40.0,
                    .height = 16.0,
                    .middle = middle,
                    .gap = gap,
                    .dt = 0.15,
                    .load = load,
                    .crack = true,
                    .slit = true,
                    .flux = true,
                    .spacing = 0.5,
                    .drive = G};
  scene s;
  double flux = NAN, front = NAN;
  char extra[120];
  bw_status st = make(bw_validation_comm(v), &u, &s);
  for (int q = 0; st == BW_OK && q < 400; q++)
    st = bw_coupler_step(s.coupler, u.dt);
  if (st == BW_OK) {
    flux =
        bw_coupler_film_flux(s.coupler, (double[3]){32.3, middle, 0.5}, (double[3]){1.0, 0.0, 0.0});
    front = flow_in_front(&s);
  }
  destroy(&s);
  BW_TRY(st);
  const double expected = pow(gap, 3) / 12.0 * G * u.cells[0] / u.length;
  const bool tight = gap > 0.4 && gap < 2.5 && middle == 16.0;
  snprintf(extra, sizeof extra, "\"load\": \"%s\", \"gap_in_cells\": %g, \"middle\": %g",
           load == BW_LOAD_PROBES ? "probes" : "reaction", gap, middle);
  bw_validation_row(v, &(bw_claim){"a film flows by the cubic law", "flux_along_a_slit", flux,
                                   expected, 0.10, BW_ANALYTIC, "plane Poiseuille flow", extra});
  bw_validation_row(v, &(bw_claim){"... and comes out on the grid", "flux_of_the_channel", front,
                                   expected, tight ? 0.10 : INFINITY, BW_ANALYTIC,
                                   "plane Poiseuille flow", extra});
  return BW_OK;
}

static bw_status slits(bw_validation *v, bw_coupler_load_kind load)
{
  static const double gaps[] = {0.5, 0.1, 1.0, 1.5, 2.0, 2.45, 2.7, 2.9};
  const bool full = bw_validation_full(v);
  for (int q = 0; q < (full ? 8 : 1); q++)
    BW_TRY(slit(v, load, gaps[q], 16.0));
  return full ? slit(v, load, 0.5, 16.25) : BW_OK;
}

static bw_status run(bw_validation *v)
{
  static const double gaps[] = {0.1, 2.7, 1.0, 2.95, 0.2, 0.5, 1.5, 1.9, 2.2, 2.5, 2.8};
  const bool full = bw_validation_full(v);
  for (int load = 0; load < 2; load++) {
    const bw_coupler_load_kind kind = load == 0 ? BW_LOAD_REACTION : BW_LOAD_PROBES;
    if (!full && kind == BW_LOAD_PROBES) continue;
    for (int q = 0; q < (full ? 11 : 2); q++)
      BW_TRY(force_at(v, kind, gaps[q], false));
    for (int q = 0; q < (full ? 11 : 1); q++)
      BW_TRY(force_at(v, kind, gaps[q], true));
    for (int which = 0; full && which < 4; which++)
      BW_TRY(no_step(v, which % 2 == 1, kind, which > 1));
    BW_TRY(slits(v, kind));
  }
  return sink(v);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.film_particles", run);
}
