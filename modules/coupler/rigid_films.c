/* Films between the rigid bodies of a flow: which faces are near, and how they brake. */
#include "rigid_films.h"
#include "bw_memory.h"

#include <math.h>
#include <string.h>

/* A face: a body, or the wall of the direction d at an end. shift: of its image [L]. */
typedef struct {
  const bw_rigid *rigid;
  int body, d, end; /* body -1: the wall */
  double at;        /* of the wall [L] */
  double shift[3];
} face;

struct bw_coupler__films {
  bw_film *film;
  bw_rigid *rigid; /* borrowed */
  int dims, walls;
  double cell, limit, period[3]; /* 0: not periodic */
  face wall[6];
  double *change;    /* (bodies,6) what the bodies' twists become in the step */
  double *wrench;    /* (bodies,6) of the last step */
  double *power;     /* (bodies) */
  double taken, gap; /* since the start; least of the last step, INFINITY: none */
};

static double distance_of(const void *context, const double x[3])
{
  const face *f = context;
  if (f->body < 0) return f->end == 0 ? x[f->d] - f->at : f->at - x[f->d];
  const double y[3] = {x[0] - f->shift[0], x[1] - f->shift[1], x[2] - f->shift[2]};
  return bw_rigid_distance(f->rigid, f->body, y);
}

static void find_walls(bw_coupler__films *f, const bw_grid_view *g, const bw_ns_channel *fluid)
{
  for (int d = 0; d < f->dims; d++) {
    f->period[d] = g->periodic[d] ? g->length[d] : 0.0;
    for (int end = 0; end < 2; end++)
      if (bw_ns_channel_settings(fluid)->side[d][end].kind == BW_SIDE_WALL)
        f->wall[f->walls++] =
            (face){.body = -1, .d = d, .end = end, .at = end == 0 ? 0.0 : g->length[d]};
  }
}

bw_status bw_coupler__films_create(const bw_coupler_films *config, double mu, bw_ns_channel *fluid,
                                   bw_rigid *rigid, bw_coupler__films **out)
{
  const bw_grid_view *g = bw_grid_look(bw_ns_channel_grid(fluid));
  const bool planar = g->n[2] == 1;
  const double cell = planar ? sqrt(g->spacing[0] * g->spacing[1])
                             : cbrt(g->spacing[0] * g->spacing[1] * g->spacing[2]);
  bw_coupler__films *f = NULL;
  bw_film_config film = bw_film_config_default();
  *out = NULL;
  BW_TRY(bw_coupler__films_check(config, cell));
  BW_REQUIRE(config->least == -INFINITY, BW_EINPUT,
             "films.least = %g: films between rigid bodies bear any pressure; leave it out",
             config->least);
  bw_status st = BW_ALLOCATE(&f, 1);
  if (st == BW_OK) {
    f->gap = INFINITY;
    f->rigid = rigid, f->dims = planar ? 2 : 3, f->cell = cell;
    f->limit = isnan(config->limit) ? 3.0 * cell : config->limit;
    find_walls(f, g, fluid);
    film.mu = mu, film.limit = f->limit, film.roughness = config->roughness;
    film.planar = planar, film.depth = planar ? g->length[2] : 1.0;
    /* A line costs next to nothing. */
    film.cells = planar ? 96 : 32;
    const size_t n = (size_t)bw_rigid_count(rigid);
    st = bw_film_create(&film, &f->film);
    BW_THEN(st, BW_ALLOCATE(&f->change, 6 * n));
    BW_THEN(st, BW_ALLOCATE(&f->wrench, 6 * n));
    BW_THEN(st, BW_ALLOCATE(&f->power, n));
  }
  st = bw_comm_agree(bw_rigid_comm(rigid), st);
  if (st != BW_OK)
    bw_coupler__films_destroy(&f);
  else
    *out = f;
  return st;
}

void bw_coupler__films_destroy(bw_coupler__films **films)
{
  bw_coupler__films *f = *films;
  if (f == NULL) return;
  bw_film_destroy(&f->film);
  bw_release(&f->change);
  bw_release(&f->wrench);
  bw_release(&f->power);
  bw_release(films);
}

/* The image of body `a` that is nearest to x. */
static face body_face(const bw_coupler__films *f, int a, const double x[3])
{
  const bw_rigid_state s = bw_rigid_state_of(f->rigid, a);
  face out = {.rigid = f->rigid, .body = a};
  for (int d = 0; d < f->dims; d++)
    if (f->period[d] > 0.0)
      out.shift[d] = f->period[d] * round((x[d] - s.position[d]) / f->period[d]);
  return out;
}

/* ---- where the grid feels the faces ---- */

/* x away from a face, by `part` of what is missing to the limit; what does not look at the face
 * (normal N) half a cell further: sides begin there, as on the body itself. Returns the part of its
 * surface that it then has: of a side what is left above the limit, half a cell on either side. */
static double retract_from(const bw_coupler__films *f, const face *other, double part,
                           const double N[3], double x[3])
{
  const double away = distance_of(other, x), eps = 1e-3 * f->limit;
  double n[3] = {0.0, 0.0, 0.0}, size = 0.0, facing = 0.0;
  if (away >= f->limit + f->cell) return 1.0;
  for (int d = 0; d < f->dims; d++) {
    double up[3] = {x[0], x[1], x[2]}, down[3] = {x[0], x[1], x[2]};
    up[d] += eps, down[d] -= eps;
    n[d] = distance_of(other, up) - distance_of(other, down);
    size += n[d] * n[d];
  }
  for (int d = 0; d < f->dims; d++) {
    n[d] /= size > 0.0 ? sqrt(size) : 1.0;
    facing -= n[d] * N[d];
  }
  const double side = 1.0 - fmin(1.0, fmax(0.0, facing));
  const double missing = part * (f->limit - away), way = missing + 0.5 * side * f->cell;
  for (int d = 0; d < f->dims; d++)
    x[d] += fmax(0.0, way) * n[d];
  return 1.0 - side * fmin(1.0, fmax(0.0, 0.5 + missing / f->cell));
}

void bw_coupler__films_retract(const bw_coupler__films *f, size_t n, const double N[], double X[],
                               double share[])
{
  const int *of = bw_rigid_point_body(f->rigid);
  for (size_t i = 0; i < n; i++) {
    double *x = X + 3 * i;
    share[i] = 1.0;
    for (int w = 0; w < f->walls; w++)
      share[i] *= retract_from(f, &f->wall[w], 1.0, N + 3 * i, x);
    for (int a = 0; a < bw_rigid_count(f->rigid); a++) {
      if (a == of[i]) continue;
      const face other = body_face(f, a, x);
      share[i] *= retract_from(f, &other, 0.5, N + 3 * i, x);
    }
    /* The forcing divides by a marker's volume. */
    share[i] = fmax(share[i], 1e-6);
  }
}

/* ---- how they brake ---- */

/* x of A x = b by elimination, x in the place of b. */
static void solve6(double A[6][6], double b[6])
{
  for (int k = 0; k < 6; k++) {
    int top = k;
    for (int i = k + 1; i < 6; i++)
      if (fabs(A[i][k]) > fabs(A[top][k])) top = i;
    for (int j = 0; j < 6; j++) {
      const double keep = A[k][j];
      A[k][j] = A[top][j], A[top][j] = keep;
    }
    const double keep = b[k];
    b[k] = b[top], b[top] = keep;
    for (int i = k + 1; i < 6; i++) {
      const double factor = A[i][k] / A[k][k];
      for (int j = k; j < 6; j++)
        A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = 5; k >= 0; k--) {
    for (int j = k + 1; j < 6; j++)
      b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
}

/* From the centre of a face's body to the origin of the film. */
static void arm(const bw_coupler__films *f, const face *a, double r[3])
{
  const bw_film_where w = bw_film_look(f->film);
  const bw_rigid_state s = bw_rigid_state_of(f->rigid, a->body);
  for (int d = 0; d < 3; d++)
    r[d] = w.origin[d] - s.position[d] - a->shift[d];
}

/* out (6) = a twist about the centre as one about the film's origin; of a wrench the other way. */
static void to_origin(const double r[3], const double twist[6], double out[6])
{
  for (int d = 0; d < 3; d++) {
    const int p = (d + 1) % 3, q = (d + 2) % 3;
    out[d] = twist[d] + twist[3 + p] * r[q] - twist[3 + q] * r[p];
    out[3 + d] = twist[3 + d];
  }
}

static void to_centre(const double r[3], const double wrench[6], double out[6])
{
  for (int d = 0; d < 3; d++) {
    const int p = (d + 1) % 3, q = (d + 2) % 3;
    out[d] = wrench[d];
    out[3 + d] = wrench[3 + d] + r[p] * wrench[q] - r[q] * wrench[p];
  }
}

/* Adds sign times what the body of a face does at the film's origin for the impulse J there. */
static void answer(const bw_coupler__films *f, const face *a, const double J[6], double out[6])
{
  double r[3], impulse[6], change[6], moved[6];
  if (a->body < 0) return;
  arm(f, a, r);
  to_centre(r, J, impulse);
  bw_rigid_answer(f->rigid, a->body, impulse, change);
  to_origin(r, change, moved);
  for (int e = 0; e < 6; e++)
    out[e] += moved[e];
}

/* twist (6) += sign times that of the body of a face, as it would be after the step. */
static void add_twist(const bw_coupler__films *f, const face *a, double sign, double twist[6])
{
  double r[3], out[6];
  if (a->body < 0) return;
  arm(f, a, r);
  to_origin(r, f->change + 6 * (ptrdiff_t)a->body, out);
  for (int e = 0; e < 6; e++)
    twist[e] += sign * out[e];
}

/* The impulse sign J on the body of a face: its motion, its book. */
static void give(bw_coupler__films *f, const face *a, double sign, const double J[6], double dt)
{
  double r[3], impulse[6], change[6];
  if (a->body < 0) return;
  arm(f, a, r);
  to_centre(r, J, impulse);
  bw_rigid_answer(f->rigid, a->body, impulse, change);
  for (int e = 0; e < 6; e++) {
    f->change[6 * a->body + e] += sign * change[e];
    f->wrench[6 * a->body + e] += sign * impulse[e] / dt;
  }
}

/* One film: J = -dt D w, w = w* + K J the relative twist after it, K what both bodies answer. */
static bw_status brake(bw_coupler__films *f, const face *a, const face *b, const double x[3],
                       double dt)
{
  const bw_film_face fa = {distance_of, a}, fb = {distance_of, b};
  double D[6][6], A[6][6], w[6] = {0.0}, J[6], power = 0.0;
  if (!bw_film_place(f->film, &fa, &fb, x)) return BW_OK;
  BW_TRY(bw_film_resistance(f->film, true, D));
  add_twist(f, b, 1.0, w);
  add_twist(f, a, -1.0, w);
  for (int e = 0; e < 6; e++) {
    double column[6] = {0.0};
    for (int i = 0; i < 6; i++)
      J[i] = dt * D[i][e];
    answer(f, a, J, column);
    answer(f, b, J, column);
    for (int i = 0; i < 6; i++)
      A[i][e] = column[i] + (i == e ? 1.0 : 0.0);
  }
  solve6(A, w);
  for (int i = 0; i < 6; i++) {
    J[i] = 0.0;
    for (int e = 0; e < 6; e++)
      J[i] -= dt * D[i][e] * w[e];
    power -= w[i] * J[i] / dt;
  }
  give(f, b, 1.0, J, dt);
  give(f, a, -1.0, J, dt);
  f->taken += dt * power;
  f->gap = fmin(f->gap, bw_film_look(f->film).gap);
  f->power[b->body] += a->body < 0 ? power : 0.5 * power;
  if (a->body >= 0) f->power[a->body] += 0.5 * power;
  return BW_OK;
}

/* The twists that all other forces would lead to. */
static void predict(bw_coupler__films *f, double dt, const double F[], const double T[])
{
  for (int q = 0; q < bw_rigid_count(f->rigid); q++) {
    const bw_rigid_state s = bw_rigid_state_of(f->rigid, q);
    double impulse[6], change[6];
    for (int d = 0; d < 3; d++) {
      impulse[d] = dt * (F[3 * q + d] + s.force[d]);
      impulse[3 + d] = dt * (T[3 * q + d] + s.torque[d]);
    }
    bw_rigid_answer(f->rigid, q, impulse, change);
    for (int d = 0; d < 3; d++) {
      f->change[6 * q + d] = s.velocity[d] + change[d];
      f->change[6 * q + 3 + d] = s.spin[d] + change[3 + d];
    }
  }
}

/* Films of body q with the walls and with bodies of smaller number. */
static bw_status brake_body(bw_coupler__films *f, int q, double dt)
{
  const bw_rigid_state s = bw_rigid_state_of(f->rigid, q);
  const double near = bw_rigid_radius(f->rigid, q) + f->limit;
  const face own = {.rigid = f->rigid, .body = q};
  for (int w = 0; w < f->walls; w++) {
    /* The search begins at the foot of the centre. */
    double x[3] = {s.position[0], s.position[1], s.position[2]};
    if (distance_of(&f->wall[w], x) > near) continue;
    x[f->wall[w].d] = f->wall[w].at;
    BW_TRY(brake(f, &f->wall[w], &own, x, dt));
  }
  for (int a = 0; a < q; a++) {
    const face other = body_face(f, a, s.position);
    const bw_rigid_state o = bw_rigid_state_of(f->rigid, a);
    double x[3], r = 0.0;
    for (int d = 0; d < 3; d++)
      x[d] = o.position[d] + other.shift[d] - s.position[d], r += x[d] * x[d];
    /* ... or between both centres, as far from either as they are large. */
    const double part = bw_rigid_radius(f->rigid, q) /
                        (bw_rigid_radius(f->rigid, q) + bw_rigid_radius(f->rigid, a));
    if (sqrt(r) > near + bw_rigid_radius(f->rigid, a)) continue;
    for (int d = 0; d < 3; d++)
      x[d] = s.position[d] + part * x[d];
    BW_TRY(brake(f, &other, &own, x, dt));
  }
  return BW_OK;
}

bw_status bw_coupler__films_brake(bw_coupler__films *f, double dt, double F[], double T[])
{
  const size_t n = (size_t)bw_rigid_count(f->rigid);
  memset(f->wrench, 0, 6 * n * sizeof *f->wrench);
  memset(f->power, 0, n * sizeof *f->power);
  f->gap = INFINITY;
  predict(f, dt, F, T);
  for (int q = 0; q < (int)n; q++)
    BW_TRY(brake_body(f, q, dt));
  for (size_t q = 0; q < n; q++)
    for (size_t d = 0; d < 3; d++) {
      F[3 * q + d] += f->wrench[6 * q + d];
      T[3 * q + d] += f->wrench[6 * q + 3 + d];
    }
  return BW_OK;
}

double bw_coupler__films_taken(const bw_coupler__films *f)
{
  return f->taken;
}

double bw_coupler__films_gap(const bw_coupler__films *f)
{
  return f->gap;
}

void bw_coupler__films_count(bw_coupler__films *f, double taken)
{
  f->taken = taken;
}

double bw_coupler__films_of(const bw_coupler__films *f, int q, double wrench[6])
{
  memcpy(wrench, f->wrench + 6 * (ptrdiff_t)q, 6 * sizeof *wrench);
  return f->power[q];
}
