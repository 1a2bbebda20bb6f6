/* What a crack costs by virtual extension: where the ordinary law's calibration is from.
 *
 * Claim      A long crack along the lattice of an ordinary solid needs the fracture energy that was
 *            asked for.
 * Reference  the energy that an extension of the crack releases at fixed displacements of the rim,
 *            G = -dE/da, E(a) the elastic energy of the body with a flat cut that ends at a
 *            (solved, and a polynomial through five lengths).
 * Measured   a disc (in space: a cylinder, periodic along the front) with a cut from its side to
 *            its middle, its rim displaced by the singular field of a crack. Bonds ahead are broken
 *            one after the other, the weakest first, at rest (linear solve), until the crack has
 *            advanced by four spacings. The largest G on the way, at the length that has the same
 *            energy, times how much of that length two spacings of the crack are, is what it costs.
 *            The law's table (pd_state_crack.c) was made so in discs of 20 spacings (m = 4: 28; in
 *            space 14 and 18); quick: a knot of it in a disc of 24, and plane stress between its
 *            knots; full: all of it.
 * Tolerance  2 %: straight lines between the knots, and the disc (20 to 30 spacings: 5e-4).
 *            Correspondence is calibrated by strips (strip_G.c) and reported.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 timeout=3600 */
#include "crack.h"

enum { LENGTHS = 5 };

typedef struct {
  int radius, rim; /* cells */
  double start;    /* where the cut ends [cells from the middle] */
} disc;

static int choose(const int32_t site[3], const void *data, uint8_t *group)
{
  const disc *d = data;
  const double x = site[0] + 0.5 - d->radius, y = site[1] + 0.5 - d->radius, r = hypot(x, y);
  if (r > d->radius) return -1;
  /* What breaks is around the middle, away from the rim. */
  *group = fabs(y) > d->rim + 1 || x < d->start - 3 * d->rim || x > 0.6 * d->radius;
  return r > d->radius - d->rim ? BW_PD_PRESCRIBED : BW_PD_FREE;
}

/* The field of a crack tip in the middle, for K = 2 mu sqrt(2 pi); nu of plane strain. */
static void singular(const crack_body *b, const disc *d, double nu)
{
  for (size_t i = 0; i < bw_solid_count(b->pd); i++) {
    const double x = b->r.X0[3 * i] - d->radius, y = b->r.X0[3 * i + 1] - d->radius;
    const double r = hypot(x, y), angle = atan2(y, x), a = sqrt(r) * (3 - 4 * nu - cos(angle));
    b->U[3 * i] = a * cos(0.5 * angle), b->U[3 * i + 1] = a * sin(0.5 * angle);
  }
}

static bw_status make(const bw_comm *comm, const crack_material *a, const disc *d, double G0,
                      crack_body *b)
{
  double lam, mu;
  bw_solid_config c = crack_config(a, &lam, &mu);
  const int deep = a->geometry == BW_PD_3D ? 2 * d->rim : 1;
  c.G0 = G0;
  BW_TRY(crack_make(comm, &c, (int[3]){2 * d->radius, 2 * d->radius, deep}, choose, d, b));
  singular(b, d, lam / (2 * (lam + mu)));
  return crack_cut(b, -1, d->radius + d->start, d->radius);
}

/* Energies for cuts that end at start + q spacings. */
static bw_status lengths(const bw_comm *comm, const crack_material *a, const disc *d,
                         double energy[LENGTHS], double at[LENGTHS])
{
  crack_body b = {0};
  BW_TRY(make(comm, a, d, INFINITY, &b));
  for (int q = 0; q < LENGTHS; q++) {
    at[q] = d->start + 2 * q;
    BW_TRY(crack_cut(&b, -1, d->radius + at[q], d->radius));
    BW_TRY(crack_rest(&b));
    BW_TRY(crack_energy(&b, CRACK_STRAIN, &energy[q]));
  }
  crack_release(&b);
  return BW_OK;
}

/* Lagrange's polynomial through the lengths and its slope. */
static double through(const double at[], const double value[], double x, double *slope)
{
  double sum = 0;
  *slope = 0;
  for (int k = 0; k < LENGTHS; k++) {
    double w = 1, dw = 0;
    for (int j = 0; j < LENGTHS; j++) {
      if (j == k) continue;
      dw = (dw * (x - at[j]) + w) / (at[k] - at[j]);
      w *= (x - at[j]) / (at[k] - at[j]);
    }
    sum += w * value[k], *slope += dw * value[k];
  }
  return sum;
}

/* The length of a flat cut that has this energy, by Newton's method, and -dE/da there. */
static double length_of(const double at[], const double value[], double energy, double *released)
{
  double x = at[1], slope = 0;
  for (int q = 0; q < 30; q++)
    x -= (through(at, value, x, &slope) - energy) / slope;
  *released = -slope;
  return x;
}

/* What the crack costs over the G0 that the law was given, for a first bond and for the hardest. */
static bw_status cost(const bw_comm *comm, const crack_material *a, int radius, double *first,
                      double *hardest, int *breaks)
{
  const disc d = {.radius = radius, .rim = (int)ceil(a->m + 0.5), .start = -4};
  const double G0 = 1e-9;
  const int deep = a->geometry == BW_PD_3D ? 2 * d.rim : 1;
  double value[LENGTHS], at[LENGTHS], energy, released, load = 1e-6, from = NAN, to = NAN;
  crack_body b = {0};
  *first = *hardest = 0;
  BW_TRY(lengths(comm, a, &d, value, at));
  BW_TRY(make(comm, a, &d, G0, &b));
  const double start = crack_tip(&b);
  for (*breaks = 0; *breaks < 400 && isnan(to); ++*breaks) {
    BW_TRY(crack_rest(&b));
    BW_TRY(crack_energy(&b, CRACK_STRAIN, &energy));
    const double length = length_of(at, value, energy, &released), tip = crack_tip(&b) - start;
    /* The same state two spacings apart: how far a flat cut comes by that energy. */
    if (isnan(from) && tip >= 2) from = length;
    if (tip >= 4) to = length;
    BW_TRY(crack_advance(&b, &load));
    const double G = load * load * released / (deep * G0);
    if (*breaks == 0) *first = G;
    if (isnan(to)) *hardest = fmax(*hardest, G);
  }
  /* A crack with its broken bonds around it is no flat cut: per true length. */
  *first *= 0.5 * (to - from);
  *hardest *= 0.5 * (to - from);
  crack_release(&b);
  return BW_OK;
}

static bw_status row(bw_validation *v, const crack_material *a, int radius, double tolerance)
{
  double first, hardest;
  int breaks;
  char extra[200], more[60];
  BW_TRY(cost(bw_validation_comm(v), a, radius, &first, &hardest, &breaks));
  snprintf(more, sizeof more, ", \"radius\": %d, \"breaks\": %d", radius, breaks);
  crack_words(a, extra, sizeof extra, more);
  state_claim(v, "a crack costs the fracture energy", "G_start_over_G0", first, 1, INFINITY,
              BW_ANALYTIC, "G = -dE/da", extra);
  state_claim(v, "a crack costs the fracture energy", "G_over_G0", hardest, 1, tolerance,
              BW_ANALYTIC, "G = -dE/da", extra);
  return BW_OK;
}

/* The law's table once more: all knots of a geometry. */
static bw_status table(bw_validation *v, bw_pd_geometry geometry)
{
  static const double nu[] = {-0.2, 0, 0.1, 0.2, 0.3, 0.4, 0.45}, m[] = {2, 2.5, 3, 4};
  for (int w = 0; w < 2; w++)
    for (int k = 0; k < 4; k++)
      for (int q = 0; q < 7; q++) {
        const crack_material a = {geometry, BW_SOLID_ORDINARY, w, nu[q], m[k]};
        if (geometry == BW_PD_3D && (k == 1 || k == 3)) continue;
        BW_TRY(row(v, &a, (int)fmax(20, 7 * m[k]), 0.02));
      }
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  const crack_material knot = {BW_PD_PLANE_STRAIN, BW_SOLID_ORDINARY, 0, 0.3, 3};
  const crack_material between = {BW_PD_PLANE_STRESS, BW_SOLID_ORDINARY, 1, 0.35, 3};
  const crack_material other = {BW_PD_PLANE_STRAIN, BW_SOLID_CORRESPONDENCE, 0, 0.3, 3};
  BW_TRY(row(v, &knot, 24, 0.02));
  BW_TRY(row(v, &between, 20, 0.02));
  /* Of a law that is calibrated by strips. */
  BW_TRY(row(v, &other, 20, INFINITY));
  if (!bw_validation_full(v)) return BW_OK;
  BW_TRY(table(v, BW_PD_PLANE_STRAIN));
  return table(v, BW_PD_3D);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.crack_tip", run);
}
