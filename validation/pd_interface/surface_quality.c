/* Claim: on bodies of known shape the surface is found with a precision and a recall of at least
 * 0.99, normals 3.45 point the right way, the reference area is the body's, and the areas
 * of the particles close it.
 * "Right" is a lattice site with an open side (one of its 6 neighbours missing, 4 in 2D): it is
 * what the fluid touches through a face, one layer thick; the brute-force list here knows nothing
 * of sectors or bonds.
 * Tolerances. Precision and recall: 1 %, the goal of the method.
 * Normals: 5 degrees, a goal, and half of it in the mean (absolute), on smooth parts: farther than
 * two horizons (6 ds) from the edges of the body and of a crack that has opened; nearer ones, from
 * one family (3.5 ds) on, are reported.
 * Closure: sum A n.x is the volume (Gauss; a linear pressure then gives its true force). 6 % of the
 * sum of magnitudes: normals 10 degrees wrong cost 1.5 % each way, the edges of a box of side L,
 * where they turn over the horizon, another 0.4 ds/L. POROUS' equal areas are reported beside.
 * Areas of smooth bodies: 3 %. A plane's is off by up to 2 % with its direction (half cells at the
 * rim of the ball about a face); curvature adds none to first order. Bodies with sharp edges are
 * rounded over the horizon: a cube of side L loses 0.8 ds/L (reported, as are the porous media,
 * whose ridges between pores are thinner than ds; their exact area is the spheres').
 * BUILD modules=pd_interface,shape
 * TEST  ranks=2 */
#include "bw_memory.h"
#include "bw_pd_interface.h"
#include "bw_shape.h"
#include "bw_validation.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  const char *name;
  int count;
  bw_shape shape[3];
  bool planar;
  double area;         /* exact [ds^2] or [ds x thickness] */
  double area_allowed; /* relative; INFINITY: reported */
  int round;           /* directions of the normal: 0 not looked at, 2 cylinder, 3 sphere */
  double period_z;
  double pitch; /* spheres are pores at this distance; 0: one ball */
  double crack; /* opens at this x; 0: none */
} body;

static const double family = 3.5, smooth = 6; /* [ds] */

typedef struct {
  double right, found, real;       /* found and real; found; real */
  double area, worst, sum, rows;   /* [ds^2]; angles in degrees, on smooth parts */
  double worst_near;               /* the same nearer to edges */
  double gauss, magnitude, volume; /* sum A n_x x, A |n_x x|, particles [ds^3] */
} tally;

static bool there(int64_t n, const bool *solid, const int size[3], const int at[3], double period)
{
  int q[3] = {at[0], at[1], at[2]};
  (void)n;
  if (period > 0.0) q[2] = (q[2] + (int)period) % (int)period;
  for (int d = 0; d < 3; d++)
    if (q[d] < 0 || q[d] >= size[d]) return false;
  return solid[((size_t)q[2] * (size_t)size[1] + (size_t)q[1]) * (size_t)size[0] + (size_t)q[0]];
}

static bool open_side(const body *b, int64_t n, const bool *solid, const int size[3],
                      const int32_t site[3])
{
  bool open = false;
  for (int d = 0; d < (b->planar ? 2 : 3); d++)
    for (int side = -1; side <= 1; side += 2) {
      int at[3] = {site[0], site[1], site[2]};
      at[d] += side;
      open = open || !there(n, solid, size, at, b->period_z);
    }
  return open;
}

/* Direction from the middle of the body, or into the pore, that the normal at X should have;
 * returns how far the next edge is. */
static double true_normal(const body *b, const double X[3], double n[3])
{
  double squared = 0.0, nearest = INFINITY;
  for (int d = 0; d < b->round; d++) {
    const double c = b->shape[b->count - 1].centre[d], size = b->shape[0].upper[d];
    n[d] = X[d] - (b->pitch > 0.0 ? 0.0 : b->shape[0].centre[d]);
    if (b->pitch > 0.0) {
      n[d] = c + b->pitch * round((X[d] - c) / b->pitch) - X[d];
      nearest = fmin(nearest, fmin(X[d], size - X[d]));
    }
    squared += n[d] * n[d];
  }
  for (int d = 0; d < b->round; d++)
    n[d] /= sqrt(squared);
  if (b->crack > 0.0) nearest = fmin(nearest, fabs(X[0] - b->crack));
  return nearest;
}

/* X: in the reference shape. */
static void add_angle(const body *b, const double X[3], const double N[3], tally *t)
{
  double n[3], dot = 0.0;
  const double far = true_normal(b, X, n);
  for (int d = 0; d < b->round; d++)
    dot += n[d] * N[d];
  const double angle = acos(fmin(1.0, dot)) * 180.0 / acos(-1.0);
  if (far > family) t->worst_near = fmax(t->worst_near, angle);
  if (far <= smooth) return;
  t->worst = fmax(t->worst, angle);
  t->sum += angle;
  t->rows += 1.0;
}

/* Cut the body and move what is beyond the cut away, by more than the horizon. */
static bw_status open_crack(const body *b, bw_solid *pd, bw_pd_interface *pi)
{
  const double far = 1e3, x = b->crack;
  const size_t n = bw_solid_count(pd);
  double *X = NULL, *V = NULL;
  bw_status st = bw_solid_precrack(pd, (double[3]){x, -far, -far}, (double[3]){x, far, -far},
                                   (double[3]){x, -far, far});
  BW_THEN(st, BW_ALLOCATE(&X, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  if (st == BW_OK) {
    bw_solid_get_reference(pd, X);
    for (size_t h = 0; h < n; h++)
      X[3 * h] += X[3 * h] > x ? 4.0 : 0.0;
    bw_solid_set_state(pd, X, V);
    st = bw_pd_interface_update(pi);
  }
  bw_release(&X);
  bw_release(&V);
  return st;
}

static double middle_x(int64_t n, const int32_t site[])
{
  int low = site[0], high = site[0];
  for (int64_t q = 0; q < n; q++) {
    if (site[3 * q] < low) low = site[3 * q];
    if (site[3 * q] > high) high = site[3 * q];
  }
  return 0.5 * (low + high + 1);
}

static void look(const bw_comm *comm, const body *b, const bw_solid *pd, const bw_pd_interface *pi,
                 const double X0[], double middle, tally *t)
{
  const bw_pd_surface s = bw_pd_interface_surface(pi);
  for (size_t q = 0; q < s.n; q++) {
    const double moment = s.N[3 * q] * (s.X[3 * q] + 0.5 * s.N[3 * q] - middle);
    t->gauss += s.A[q] * moment, t->magnitude += s.A[q] * fabs(moment);
    if (b->round > 0) add_angle(b, &X0[3 * s.particle[q]], &s.N[3 * q], t);
  }
  double sums[7] = {t->right, t->found, t->real, t->gauss, t->sum, t->rows, t->magnitude};
  bw_comm_sum(comm, 7, sums);
  bw_comm_max(comm, 1, &t->worst);
  bw_comm_max(comm, 1, &t->worst_near);
  *t = (tally){.right = sums[0],
               .found = sums[1],
               .real = sums[2],
               .area = bw_pd_interface_reference_area(pi),
               .worst = t->worst,
               .sum = sums[4],
               .rows = sums[5],
               .worst_near = t->worst_near,
               .gauss = sums[3],
               .magnitude = sums[6],
               .volume = (double)bw_solid_total(pd)};
}

static bw_status measure(const bw_comm *comm, const body *b, bw_pd_area area, tally *t)
{
  enum { SIDE = 80 }; /* all bodies lie in 0 .. 80 */
  const int size[3] = {SIDE, SIDE, b->planar ? 1 : SIDE};
  bw_solid_config c = bw_solid_config_default();
  c.geometry = b->planar ? BW_PD_PLANE_STRESS : BW_PD_3D;
  c.ds = c.rho = c.E = 1.0;
  c.period[2] = b->period_z;
  bw_pd_interface_config ic = bw_pd_interface_config_default();
  ic.area = area;
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bool *solid = NULL;
  double *X0 = NULL;
  bw_solid *pd = NULL;
  bw_pd_interface *pi = NULL;
  memset(t, 0, sizeof *t);
  const bw_shape_lattice lattice = bw_shape_lattice_straight(1.0, c.origin, b->planar);
  bw_status st = bw_shape_fill(b->count, b->shape, &lattice, 0, 1, &n, &site, &kind, NULL);
  BW_THEN(st, BW_ALLOCATE(&solid, (size_t)SIDE * SIDE * SIDE));
  BW_THEN(st, bw_solid_create_same(comm, &c, n, site, kind, &pd));
  BW_THEN(st, bw_pd_interface_create(pd, &ic, &pi));
  BW_THEN(st, BW_ALLOCATE(&X0, 3 * bw_solid_count(pd)));
  if (st == BW_OK) {
    for (int64_t q = 0; q < n; q++)
      solid[((size_t)site[3 * q + 2] * SIDE + (size_t)site[3 * q + 1]) * SIDE +
            (size_t)site[3 * q]] = true;
    const bool *found = bw_pd_interface_is_surface(pi);
    for (size_t h = 0; h < bw_solid_count(pd); h++) {
      const bool real = open_side(b, n, solid, size, &site[3 * bw_solid_id(pd)[h]]);
      t->right += found[h] && real, t->found += found[h], t->real += real;
    }
    bw_solid_get_reference(pd, X0);
    if (b->crack > 0.0) st = open_crack(b, pd, pi);
    look(comm, b, pd, pi, X0, middle_x(n, site), t);
  }
  bw_pd_interface_destroy(&pi);
  bw_solid_destroy(&pd);
  bw_release(&site);
  bw_release(&kind);
  bw_release(&solid);
  bw_release(&X0);
  return st;
}

static void put_rows(bw_validation *v, size_t n, const bw_claim rows[])
{
  for (size_t q = 0; q < n; q++)
    (void)bw_validation_row(v, &rows[q]);
}

static bw_status one(bw_validation *v, const body *b)
{
  const char gauss[] = "Gauss: the volume of the particles";
  const char brute[] = "brute-force list of sites with an open side", form[] = "closed form";
  tally t, equal;
  char extra[96];
  BW_TRY(measure(bw_validation_comm(v), b, BW_PD_AREA_EQUAL, &equal));
  BW_TRY(measure(bw_validation_comm(v), b, BW_PD_AREA_OPEN_SIDES, &t));
  snprintf(extra, sizeof extra, "\"body\": \"%s\"", b->name);
  const bw_claim whole[] = {
      {"what is found is surface", "precision", t.right / t.found, 1.0, 0.01, BW_ANALYTIC, brute,
       extra},
      {"surface is found", "recall", t.right / t.real, 1.0, 0.01, BW_ANALYTIC, brute, extra},
      {"areas close the body", "gauss_defect", (t.gauss - t.volume) / t.magnitude, 0.0, 0.06,
       BW_CONSERVATION, gauss, extra},
      {"equal areas close the body", "gauss_defect_equal",
       (equal.gauss - t.volume) / equal.magnitude, 0.0, INFINITY, BW_CONSERVATION, gauss, extra},
      {"areas add up to the body's", "area", t.area, b->area, b->area_allowed, BW_ANALYTIC, form,
       extra}};
  const bw_claim directions[] = {
      {"normals point outwards", "angle_max", t.worst, 0.0, 5.0, BW_ANALYTIC, form, extra},
      {"normals point outwards on average", "angle_mean", t.sum / t.rows, 0.0, 2.5, BW_ANALYTIC,
       form, extra},
      {"normals towards edges", "angle_max_from_one_family", t.worst_near, 0.0, INFINITY,
       BW_ANALYTIC, form, extra}};
  if (b->crack == 0.0) put_rows(v, sizeof whole / sizeof *whole, whole);
  if (b->round > 0) put_rows(v, sizeof directions / sizeof *directions, directions);
  return BW_OK;
}

#define PI           3.14159265358979323846
#define MIDDLE       .centre = {30.2, 29.7, 30.1}
#define BALL(r)      .kind = BW_SHAPE_SPHERE, MIDDLE, .radius = (r)
#define ROUND(r)     .kind = BW_SHAPE_CYLINDER, MIDDLE, .radius = (r), .axis = 2
#define BOX(x, y, z) .kind = BW_SHAPE_BOX, .upper = {(x), (y), (z)}
/* One pore of radius r > p/2 in a cell of pitch p leaves a sphere less six caps. */
#define PORE(r, p) (4 * PI * (r) * (r)-6 * 2 * PI * (r) * ((r) - (p) / 2.0))

static const body bodies[] = {
    {"ball 8", 1, {{BALL(8)}}, .area = 4 * PI * 64, .area_allowed = 0.03, .round = 3},
    {"ball 12.5", 1, {{BALL(12.5)}}, .area = 4 * PI * 156.25, .area_allowed = 0.03, .round = 3},
    {"cylinder 8",
     2,
     {{ROUND(8)}, {.kind = BW_SHAPE_BOX, .lower = {30, 29, 0}, .upper = {31, 30, 16}}},
     .area = 2 * PI * 8 * 16,
     .area_allowed = 0.03,
     .round = 2,
     .period_z = 16},
    {"disc 15 (2D)",
     1,
     {{ROUND(15)}},
     .planar = true,
     .area = 2 * PI * 15,
     .area_allowed = 0.03,
     .round = 2},
    {"ball 10", 1, {{BALL(10)}}, .area = 4 * PI * 100, .area_allowed = 0.03, .round = 3},
    {"cylinder 10.3",
     2,
     {{ROUND(10.3)}, {.kind = BW_SHAPE_BOX, .lower = {30, 29, 0}, .upper = {31, 30, 16}}},
     .area = 2 * PI * 10.3 * 16,
     .area_allowed = 0.03,
     .round = 2,
     .period_z = 16},
    {"ball 12.5, cut and opened", 1, {{BALL(12.5)}}, .round = 3, .crack = 30},
    {"pores 8 of 24",
     2,
     {{BOX(48, 48, 48)},
      {.kind = BW_SHAPE_PORES_SC,
       .remove = true,
       .centre = {12, 12, 12},
       .radius = 8,
       .pitch = 24}},
     .area = 8 * 4 * PI * 64 + 6 * 48 * 48,
     .area_allowed = 0.03,
     .round = 3,
     .pitch = 24},
    {"cube 16", 1, {{BOX(16, 16, 16)}}, .area = 6 * 256, .area_allowed = INFINITY},
    {"cube 32", 1, {{BOX(32, 32, 32)}}, .area = 6 * 1024, .area_allowed = INFINITY},
    {"pores 7 of 16",
     2,
     {{BOX(32, 32, 32)},
      {.kind = BW_SHAPE_PORES_SC, .remove = true, .centre = {8, 8, 8}, .radius = 7, .pitch = 16}},
     .area = 8 * 4 * PI * 49 + 6 * 1024,
     .area_allowed = 0.03},
    {"porous medium (POROUS 5, 2 x 2 x 2 pores)",
     2,
     {{BOX(32, 32, 32)},
      {.kind = BW_SHAPE_PORES_SC,
       .remove = true,
       .centre = {8, 8, 8},
       .radius = 9.32,
       .pitch = 16}},
     .area = 8 * PORE(9.32, 16) + 24 * (256 - PI * (9.32 * 9.32 - 64)),
     .area_allowed = INFINITY},
    {"porous medium (POROUS 5, whole)",
     2,
     {{BOX(48, 64, 64)},
      {.kind = BW_SHAPE_PORES_SC,
       .remove = true,
       .centre = {8, 8, 8},
       .radius = 9.32,
       .pitch = 16}},
     .area = 48 * PORE(9.32, 16) + 80 * (256 - PI * (9.32 * 9.32 - 64)),
     .area_allowed = INFINITY},
};

static bw_status run(bw_validation *v)
{
  const size_t all = sizeof bodies / sizeof *bodies;
  for (size_t q = 0; q < all - (bw_validation_full(v) ? 0 : 1); q++)
    BW_TRY(one(v, &bodies[q]));
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_interface.surface_quality", run);
}
