/* channel_flow.h -- the recipe of turbulent channel flow: objects, initial field, an interval of
 * time, checkpoints. The case and validation/ns_channel/channel_turbulence.c run this same code.
 *
 * Units: h (full height) and U_b (bulk velocity, held constant), so nu = 1/Re_b. Time advances in
 * equal intervals; the steps within one are chosen from field and time alone, so that what follows
 * a checkpoint (between two steps) does not depend on whether it was read. */
#pragma once
#include "bw_case.h"
#include "bw_checkpoint.h"
#include "bw_memory.h"
#include "bw_ns_correlations.h"
#include "bw_ns_statistics.h"
#include "bw_number.h"

#include <limits.h>
#include <math.h>

/* What a run is. */
typedef struct {
  double length[3]; /* box [h]; length[1] is 1 */
  int cells[3];
  double stretch;       /* of y by tanh; 0: uniform */
  const char *faces;    /* file with the faces in y; NULL: none */
  int viscous;          /* bw_ns_viscous */
  int eddy;             /* bw_ns_eddy */
  double reynolds;      /* U_b h/nu */
  double perturbation;  /* of the laminar profile that the run starts from [U_b] */
  double interval;      /* between samples [h/U_b] */
  double courant_share; /* of the largest stable step */
  double spin_up;       /* before statistics begin [h/U_b] */
} channel_config;

/* The objects of a run and how far it is. */
typedef struct {
  const channel_config *config; /* borrowed */
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_ns_statistics *statistics;
  bw_ns_correlations *correlations;
  double *state;       /* the numbers of both on their way to disk */
  int64_t intervals;   /* done */
  int64_t steps;       /* done */
  double dt, gradient; /* of the last interval: the step, the mean of -dp/dx */
  double impulse;      /* of the gradient, over what is done of the interval going on ... */
  int64_t part;        /* ... and its steps so far */
  const bw_case *run;  /* borrowed: asked whether to stop; NULL: never */
  bool stopped;        /* on the way through an interval */
  int64_t rows;        /* of history.csv when the checkpoint is written, or was */
} channel_flow;

static inline void channel_destroy(channel_flow *f)
{
  bw_release(&f->state);
  bw_ns_correlations_destroy(&f->correlations);
  bw_ns_statistics_destroy(&f->statistics);
  bw_ns_channel_destroy(&f->fluid);
  bw_grid_destroy(&f->grid);
}

/* Heights of correlations and spectra in wall units of Re_tau = 180; the last is the centre. */
enum { CHANNEL_HEIGHTS = 5, CHANNEL_PLANES = 2 * CHANNEL_HEIGHTS };
static const int channel_heights[CHANNEL_HEIGHTS] = {5, 15, 30, 60, 180};

/* Row j of u and w next to the height, and its mirror image: planes q and CHANNEL_HEIGHTS + q. (v
 * is at the faces above these centres: one above row j, the other, mirrored, below it.) */
static inline int channel_row(const bw_grid_view *g, int plane)
{
  const int n = g->n[1];
  const double y = (double)channel_heights[plane % CHANNEL_HEIGHTS] / 360.0;
  int best = 1;
  /* Nearest centre of the lower half; the other plane is its mirror image. */
  for (int j = 2; j <= (n + 1) / 2; j++)
    if (fabs(g->y_centre[j] - y) <= fabs(g->y_centre[best] - y)) best = j;
  return plane < CHANNEL_HEIGHTS ? best : n + 1 - best;
}

/* A number in (-1, 1) that looks random, the same on all machines and ranks. */
static inline double channel_noise(const double x[3], int c)
{
  uint64_t s = 0x9e3779b97f4a7c15u * (uint64_t)(c + 1);
  /* Hash of the place, so that the noise belongs to the point and not to a rank. */
  for (int d = 0; d < 3; d++) {
    s ^= (uint64_t)(int64_t)llround(x[d] * 1048576.0) + 0x9e3779b97f4a7c15u + (s << 6) + (s >> 2);
    s = (s ^ (s >> 30)) * 0xbf58476d1ce4e5b9u; /* the mixing steps of splitmix64 */
    s = (s ^ (s >> 27)) * 0x94d049bb133111ebu;
    s ^= s >> 31;
  }
  return (double)(s >> 11) * 0x1p-52 - 1.0;
}

/* The laminar parabola; rolls along the stream that lift slow fluid (whose streaks break down),
 * waves across them and noise that break every symmetry. Rolls are some 0.8 h apart, waves 2 h.
 * What is not free of divergence the solver projects away. */
static inline void channel_initial(const double x[3], double t, void *context, double u[3])
{
  const channel_config *q = context;
  const double pi = acos(-1.0), y = x[1];
  /* Whole waves in the periodic box, as near to 0.8 h and 2 h as it allows. */
  const double kz = 2.0 * pi * fmax(1.0, round(q->length[2] / 0.8)) / q->length[2];
  const double kx = 2.0 * pi * fmax(1.0, round(q->length[0] / 2.0)) / q->length[0];
  const double f = pow(sin(pi * y), 2.0), df = pi * sin(2.0 * pi * y), a = q->perturbation;
  (void)t;
  /* Everything but the parabola vanishes at the walls with sin^2(pi y). */
  u[0] = 6.0 * y * (1.0 - y) + a * f * sin(kx * x[0]) * sin(kz * x[2] + 1.0);
  u[1] = a * f * (cos(kz * x[2]) + 0.5 * cos(kx * x[0] + 0.7) * cos(0.5 * kz * x[2]));
  u[2] = -a * df / kz * sin(kz * x[2]) + 0.5 * a * f * sin(kx * x[0] + 2.0);
  for (int c = 0; c < 3; c++)
    u[c] += 0.2 * a * f * channel_noise(x, c);
}

/* Profiles are means of both halves. */
static inline bw_status channel_symmetric(const bw_grid_view *g, const char *faces)
{
  const int n = g->n[1];
  for (int j = 0; j <= n; j++)
    BW_REQUIRE(
        fabs(g->y_face[j] + g->y_face[n - j] - g->length[1]) <= 1e-9 * g->length[1], BW_EINPUT,
        "%s: face %d at %.12g is not the mirror image of face %d at %.12g; both halves of the "
        "channel are averaged, make them alike",
        faces, j, g->y_face[j], n - j, g->y_face[n - j]);
  return BW_OK;
}

typedef bw_status channel_grid_maker(const bw_comm *, const bw_grid_config *, bw_grid **);

/* The grid, made by `make`: bw_grid_create, or bw_grid_plan to look at it. */
static inline bw_status channel_grid(const bw_comm *comm, const channel_config *q,
                                     channel_grid_maker *make, bw_grid **grid)
{
  double *faces = NULL;
  bw_grid_config g = bw_grid_config_default();
  for (int d = 0; d < 3; d++)
    g.n[d] = q->cells[d], g.length[d] = q->length[d], g.periodic[d] = d != 1;
  BW_REQUIRE(q->length[1] == 1.0, BW_EINPUT,
             "channel: the height is %g, but h is the unit of length; give 1", q->length[1]);
  BW_REQUIRE(
      q->stretch == 0.0 || q->faces == NULL, BW_EINPUT,
      "domain.stretch = %g and domain.faces = %s both say where the faces in y are; give one",
      q->stretch, q->faces);
  /* Uniform, tanh, or as the file says. */
  if (q->stretch > 0.0) g.y_stretch = BW_STRETCH_TANH, g.y_stretch_strength = q->stretch;
  if (q->faces != NULL) {
    BW_TRY(bw_grid_read_table(comm, q->faces, g.n[1], g.length[1], &faces));
    g.y_stretch = BW_STRETCH_TABLE, g.y_table = faces;
  }
  bw_status st = make(comm, &g, grid);
  /* Both halves are averaged, so they must be alike. */
  if (faces != NULL) BW_THEN(st, channel_symmetric(bw_grid_look(*grid), q->faces));
  bw_release(&faces);
  return st;
}

/* What flows: walls in y by default, U_b = 1 by definition. Local. */
static inline bw_ns_channel_config channel_fluid_of(const channel_config *config)
{
  bw_ns_channel_config c = bw_ns_channel_config_default();
  for (int s = 0; s < 2; s++)
    c.side[0][s].kind = c.side[2][s].kind = BW_SIDE_PERIODIC;
  c.nu = 1.0 / config->reynolds;
  c.viscous = (bw_ns_viscous)config->viscous;
  c.eddy = (bw_ns_eddy)config->eddy;
  /* The gradient follows, and with it Re_tau. */
  c.forcing = BW_FORCING_FLOW_RATE;
  c.forcing_value = 1.0;
  return c;
}

/* All objects; the fluid is at rest. `config` is borrowed until destroy. */
static inline bw_status channel_create(const bw_comm *comm, const channel_config *config,
                                       channel_flow *f)
{
  *f = (channel_flow){.config = config};
  BW_TRY(channel_grid(comm, config, bw_grid_create, &f->grid));
  const bw_ns_channel_config c = channel_fluid_of(config);
  BW_TRY(bw_ns_channel_create(f->grid, &c, &f->fluid));
  BW_TRY(bw_ns_statistics_create(f->fluid, &f->statistics));
  /* Correlations and spectra at five heights of both halves. */
  int row[CHANNEL_PLANES];
  for (int plane = 0; plane < CHANNEL_PLANES; plane++)
    row[plane] = channel_row(bw_grid_look(f->grid), plane);
  BW_TRY(bw_ns_correlations_create(f->fluid, CHANNEL_PLANES, row, &f->correlations));
  /* One buffer carries either state to disk. */
  const size_t a = bw_ns_statistics_state_size(f->statistics);
  const size_t b = bw_ns_correlations_state_size(f->correlations);
  return bw_comm_agree(comm, BW_ALLOCATE(&f->state, a > b ? a : b));
}

/* The perturbed parabola at t = 0. Collective. */
static inline bw_status channel_start(channel_flow *f)
{
  channel_config at_start = *f->config;
  return bw_ns_channel_set_velocity(f->fluid, channel_initial, &at_start, 0.0);
}

/* Has the flow been spun up? Local. */
static inline bool channel_sampling(const channel_flow *f)
{
  return (double)f->intervals * f->config->interval > f->config->spin_up * (1.0 + 1e-12);
}

/* Steps to the end of the interval, as large as the present field allows. */
static inline bw_status channel_steps_left(const channel_flow *f, double span, int64_t *left)
{
  const double longest = f->config->courant_share * bw_ns_channel_dt_max(f->fluid);
  const double now = bw_ns_channel_time(f->fluid), count = ceil(span / longest);
  BW_REQUIRE(bw_to_int64(count, left) && *left >= 1 && *left <= BW_MOST_STEPS &&
                 now + span / count > now,
             BW_EDIVERGED,
             "at t = %g the largest stable step is %.3g: %.3g steps to the next sample; the "
             "velocities are too large for the cells",
             now, longest, count);
  return BW_OK;
}

/* One interval, in steps that divide what is left of it evenly, as large as the present field
 * allows; a sample at its end once the flow is spun up. Less of it (f->stopped) when the run is
 * asked to stop. */
static inline bw_status channel_advance(channel_flow *f)
{
  const channel_config *q = f->config;
  const double end = (double)(f->intervals + 1) * q->interval;
  /* The number of steps left is chosen anew after each, as the field changes. */
  for (int64_t left = 2; left > 1;) {
    const double span = end - bw_ns_channel_time(f->fluid);
    BW_TRY(channel_steps_left(f, span, &left));
    const double dt = span / (double)left;
    BW_TRY(bw_ns_channel_step(f->fluid, dt));
    /* Mean gradient of the interval, for Re_tau. */
    f->impulse += dt * bw_ns_channel_gradient(f->fluid); /* that of the last sub-step */
    f->part++;
    f->stopped = left > 1 && f->run != NULL && bw_case_stopping(f->run);
    if (f->stopped) return BW_OK;
  }
  f->dt = q->interval / (double)f->part;
  f->gradient = f->impulse / q->interval;
  f->steps += f->part;
  f->intervals++;
  f->impulse = 0.0, f->part = 0;
  /* Exactly the end, so that a restart has the same times. */
  bw_ns_channel_set_time(f->fluid, end);
  /* Only what has forgotten the start is sampled. */
  if (channel_sampling(f)) {
    bw_ns_statistics_sample(f->statistics);
    bw_ns_correlations_sample(f->correlations);
  }
  return BW_OK;
}

enum { CHANNEL_PROGRESS = 7 };
static const char *const channel_field_name[4] = {"fluid/u", "fluid/v", "fluid/w", "fluid/p"};

/* Fields, sums and progress to a file. Collective. */
static inline bw_status channel_save(channel_flow *f, const char *path)
{
  bw_real *const *u = bw_ns_channel_velocity(f->fluid);
  const bw_real *field[4] = {u[0], u[1], u[2], bw_ns_channel_pressure(f->fluid)};
  const double progress[CHANNEL_PROGRESS] = {(double)f->intervals,
                                             (double)f->steps,
                                             bw_ns_channel_gradient(f->fluid),
                                             bw_ns_channel_time(f->fluid),
                                             f->impulse,
                                             (double)f->part,
                                             (double)f->rows};
  bw_checkpoint *ck = NULL;
  bw_ns_statistics_get_state(f->statistics, f->state);
  bw_status st = bw_checkpoint_create(bw_grid_comm(f->grid), path, &ck);
  BW_THEN(st, bw_checkpoint_put_case(ck, f->run));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "case/progress", CHANNEL_PROGRESS, progress));
  BW_THEN(st, bw_checkpoint_put_numbers(ck, "statistics",
                                        (int)bw_ns_statistics_state_size(f->statistics), f->state));
  /* The statistics are on disk: the buffer is free for the correlations. */
  bw_ns_correlations_get_state(f->correlations, f->state);
  BW_THEN(st,
          bw_checkpoint_put_numbers(ck, "correlations",
                                    (int)bw_ns_correlations_state_size(f->correlations), f->state));
  for (int c = 0; c < 4; c++)
    BW_THEN(st,
            bw_checkpoint_put_field(ck, channel_field_name[c], f->grid, c % 3, false, field[c]));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  return st;
}

/* Goes on from a file, to the last bit, on any number of ranks. Collective. */
static inline bw_status channel_load(channel_flow *f, const char *path)
{
  bw_real *const *u = bw_ns_channel_velocity(f->fluid);
  bw_real *field[4] = {u[0], u[1], u[2], bw_ns_channel_pressure(f->fluid)};
  double progress[CHANNEL_PROGRESS];
  bw_checkpoint *ck = NULL;
  BW_TRY(bw_checkpoint_open(bw_grid_comm(f->grid), path, &ck));
  bw_status st = bw_checkpoint_get_numbers(ck, "case/progress", CHANNEL_PROGRESS, progress);
  const bool whole = st == BW_OK && bw_to_int64(progress[0], &f->intervals) &&
                     bw_to_int64(progress[1], &f->steps) && bw_to_int64(progress[5], &f->part) &&
                     bw_to_int64(progress[6], &f->rows);
  if (st == BW_OK && !whole)
    st = BW_FAIL(BW_EINPUT, "%s: 'case/progress' holds numbers that no run has", path);
  if (st == BW_OK && channel_sampling(f)) { /* else nothing was sampled yet */
    st = bw_checkpoint_get_numbers(ck, "statistics",
                                   (int)bw_ns_statistics_state_size(f->statistics), f->state);
    BW_THEN(st, bw_ns_statistics_set_state(f->statistics, f->state));
    BW_THEN(st, bw_checkpoint_get_numbers(ck, "correlations",
                                          (int)bw_ns_correlations_state_size(f->correlations),
                                          f->state));
    BW_THEN(st, bw_ns_correlations_set_state(f->correlations, f->state));
  }
  /* Fields by global cells: any number of ranks. */
  for (int c = 0; c < 4; c++)
    BW_THEN(st,
            bw_checkpoint_get_field(ck, channel_field_name[c], f->grid, c % 3, false, field[c]));
  BW_THEN(st, bw_checkpoint_close(&ck));
  bw_checkpoint_abandon(&ck);
  if (st != BW_OK) return st;
  /* Numbers and halos complete the state. */
  f->impulse = progress[4];
  bw_ns_channel_set_gradient(f->fluid, progress[2]);
  bw_ns_channel_set_time(f->fluid, progress[3]);
  bw_ns_channel_refresh(f->fluid);
  return BW_OK;
}

/* u_tau/U_b from the mean wall shear of the statistics, and its 95 % interval. */
static inline bw_ns_estimate channel_u_tau(const channel_flow *f, bw_ns_estimate work[])
{
  bw_ns_statistics_profile(f->statistics, BW_NS_PROFILE_SHEAR, true, work);
  /* u_tau^2 = tau_w/rho; the interval is that of the root. */
  const double u = sqrt(work[0].mean);
  return (bw_ns_estimate){u, 0.5 * work[0].interval / u};
}
