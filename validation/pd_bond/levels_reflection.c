/* What a jump between levels reflects.
 *
 * Claim      Plane waves pass a jump of the spacing with what the two lattices' own dispersion
 *            makes unavoidable, times less than 1.5 (P) and 1.8 (S) at 20 coarse horizons, falling
 *            with the square of the wave number; also in a nest of three levels. The dual form
 *            reflects more, in proportion to the wave number, one-sided families at any length; and
 *            so do finer cells with the horizon of the coarse ones (m-refinement), as the two
 *            lattices' moduli differ. The ordinary law with nu of bonds passes waves as bonds do.
 * Reference  (a) the mismatch of dispersion (k2 - k1)/(k1 + k2) at one frequency, from sums over
 *            the two lattices written here; (b) the semi-discrete equations solved in the frequency
 *            domain by a sparse direct solver in another language (numpy, scipy), two digits.
 * Measured   a Gauss pulse passes a line before the jump, then what comes back; the ratio of both
 *            spectra at a frequency. Verlet's scheme maps frequencies, w -> 2/dt asin(w dt/2),
 *            alike on both sides, so that there is no error of the step in it. All figures go to
 *            levels_reflection.csv, which tools/plot_levels.py draws.
 * Tolerance  (a) the factors above, set before this code was written from what the semi-discrete
 *            equations give (1.4 and 1.7); slopes between 20 and 80 horizons 2 +- 0.1 (the next
 *            order at 20 is (k d)^2/24 = 0.4 %). (b) 5 %: half a unit of the last of two digits.
 * BUILD modules=solid
 * TEST  ranks=1 */
#include "bw_memory.h"
#include "bw_solid.h"
#include "bw_validation.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
enum { M = 3, LEFT = 110, RIGHT = 50, START = 60, PROBE = 30, WIDTH = 5 }; /* coarse horizons */
/* How bonds across the jump are. With the horizon of the coarse cells in the fine ones, too
 * (m-refinement), a belt between two jumps would be as wide as the bar: one jump. */
typedef struct {
  const char *name;
  bw_pd_jump jump;
  bool same_horizon;
  int law; /* of bw_solid_law_row */
} jump_form;
enum { FORMS = 6, OF_NESTS = 3 };
static const jump_form forms[FORMS] = {
    {"balanced", BW_PD_JUMP_BALANCED, false, BW_SOLID_BOND},
    {"dual", BW_PD_JUMP_DUAL, false, BW_SOLID_BOND},
    {"one_sided", BW_PD_JUMP_ONE_SIDED, false, BW_SOLID_BOND},
    {"dual_same_horizon", BW_PD_JUMP_DUAL, true, BW_SOLID_BOND},
    {"one_sided_same_horizon", BW_PD_JUMP_ONE_SIDED, true, BW_SOLID_BOND},
    {"ordinary", BW_PD_JUMP_BALANCED, false, BW_SOLID_ORDINARY}};
enum { LENGTHS = 4 };
static const int lengths[LENGTHS] = {10, 20, 40, 80}; /* wavelengths, coarse horizons */

/* An endless plane lattice; c0 by its own sums, E = 1, plane stress: 3/2 = 1/4 c0 moment. */
typedef struct {
  double h; /* spacing */
  int m;    /* horizon over it */
} lattice;

static double linear_fraction(double r, const lattice *l)
{
  return fmax(0, fmin(1, l->m + 0.5 - r / l->h));
}

/* w^2 of a plane wave along x in a lattice that moves along `motion`, E and rho 1. */
static double lattice_w2(double k, const lattice *l, int motion)
{
  double moment = 0, sum = 0;
  const double h = l->h;
  for (int y = -l->m - 1; y <= l->m + 1; y++)
    for (int x = -l->m - 1; x <= l->m + 1; x++) {
      const double r = h * hypot(x, y), w = linear_fraction(r, l) * h * h;
      if (x == 0 && y == 0) continue;
      const double along = h * (motion == 0 ? x : y);
      moment += w * r;
      sum += w * along * along / (r * r * r) * (1 - cos(k * x * h));
    }
  return 4 * 1.5 / moment * sum;
}

/* Wave number of a lattice at w^2, by halving. */
static double lattice_k(double w2, const lattice *l, int motion)
{
  double low = 0, high = 0.5 * PI / (l->h * l->m / M);
  for (int q = 0; q < 100; q++) {
    const double middle = (low + high) / 2;
    if (lattice_w2(middle, l, motion) < w2)
      low = middle;
    else
      high = middle;
  }
  return (low + high) / 2;
}

/* Mismatch of the coarse lattice and another one, at a wavelength in coarse horizons. */
static double mismatch(const lattice *fine, int motion, int length)
{
  const lattice coarse = {1, M};
  const double k1 = 2 * PI / (length * M);
  const double k2 = lattice_k(lattice_w2(k1, &coarse, motion), fine, motion);
  return fabs(k2 - k1) / (k1 + k2);
}

/* A bar of cells, periodic across with one cell; fine where x > 0. */
static bw_status make(const bw_comm *comm, int levels, int form, bw_solid **pd)
{
  const int n = M * (LEFT + RIGHT);
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRESS;
  c.ds = 1;
  c.rho = c.E = 1;
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  c.finer.jump = forms[form].jump;
  c.choice.law = forms[form].law;
  if (c.choice.law == BW_SOLID_ORDINARY) {
    /* Poisson's ratio of bonds and their weights: the same lattices on both sides. */
    c.choice.poisson_ratio = 1.0 / 3;
    c.choice.influence = BW_PD_STATE_INVERSE;
  }
  c.finer.same_horizon = forms[form].same_horizon;
  c.period[1] = 1;
  c.finer.n = 1;
  /* With two jumps the belt of one coarse horizon begins at x = 0. */
  c.finer.box[0] = (bw_pd_box){levels, {levels == 1 ? 0 : M, -1}, {1e9, 2}};
  int32_t *site = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * (size_t)n));
  for (int q = 0; q < n; q++)
    site[3 * q] = q - M * LEFT;
  const bw_status st = bw_solid_create_same(comm, &c, n, site, NULL, pd);
  bw_release(&site);
  return st;
}

/* The pulse exp(-(x/w)^2) that goes to the right. */
static bw_status start(bw_solid *pd, int motion)
{
  const size_t n = bw_solid_count(pd);
  const double c = sqrt(motion == 0 ? 1.125 : 0.375), w = WIDTH * M, size = 1e-8;
  double *X = NULL, *V = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  if (st == BW_OK) {
    bw_solid_get_reference(pd, X);
    for (size_t i = 0; i < n; i++) {
      const double x = (X[3 * i] + START * M) / w, u = size * exp(-x * x);
      X[3 * i + (size_t)motion] += u;
      V[3 * i + (size_t)motion] = 2 * x / w * c * u;
    }
    bw_solid_set_state(pd, X, V);
  }
  bw_release(&X);
  bw_release(&V);
  return st;
}

/* The own particle nearest to the line. */
static size_t at_line(const bw_solid *pd, double X0[])
{
  size_t best = 0;
  bw_solid_get_reference(pd, X0);
  for (size_t i = 1; i < bw_solid_count(pd); i++)
    if (fabs(X0[3 * i] + PROBE * M) < fabs(X0[3 * best] + PROBE * M)) best = i;
  return best;
}

/* R (LENGTHS) <- reflected over incoming amplitude. */
static bw_status reflect(const bw_comm *comm, int levels, int form, int motion, double R[])
{
  bw_solid *pd = NULL;
  double *X = NULL;
  bw_status st = make(comm, levels, form, &pd);
  BW_THEN(st, BW_ALLOCATE(&X, 3 * bw_solid_count(pd)));
  BW_THEN(st, start(pd, motion));
  if (st == BW_OK) {
    const double dt = 0.9 * bw_solid_dt_max(pd), c = sqrt(motion == 0 ? 1.125 : 0.375);
    const size_t line = at_line(pd, X);
    const double place = X[3 * line + (size_t)motion];
    /* The pulse passes the line half-way of this, its reflection when twice as much is over. */
    const double between = (START - PROBE + PROBE) * M / c, end = (START + PROBE + 25) * M / c;
    double complex seen[2][LENGTHS] = {{0}};
    for (int64_t step = 0; (double)step * dt < end && st == BW_OK; step++) {
      const double t = (double)step * dt;
      bw_solid_get_position(pd, X);
      for (int q = 0; q < LENGTHS; q++) {
        const double w = sqrt(lattice_w2(2 * PI / (lengths[q] * M), &(lattice){1, M}, motion));
        seen[t > between][q] +=
            (X[3 * line + (size_t)motion] - place) * cexp(I * 2 / dt * asin(w * dt / 2) * t);
      }
      st = bw_solid_step(pd, dt);
    }
    for (int q = 0; q < LENGTHS; q++)
      R[q] = cabs(seen[1][q]) / cabs(seen[0][q]);
  }
  bw_release(&X);
  bw_solid_destroy(&pd);
  return st;
}

/* What the frequency domain gives, two digits; 0: not solved there. */
static const double solved[2][2][FORMS][LENGTHS] = {
    {{{4.6e-3, 1.2e-3, 3.0e-4, 7.4e-5},
      {2.2e-2, 6.8e-3, 2.6e-3, 1.2e-3},
      {4.9e-2, 4.6e-2, 4.6e-2, 4.5e-2}},
     {{3.3e-3, 8.3e-4, 2.1e-4, 5.2e-5},
      {9.9e-3, 2.7e-3, 8.6e-4, 3.4e-4},
      {3.0e-2, 2.7e-2, 2.6e-2, 2.6e-2}}},
    {{{5.1e-3, 1.4e-3, 3.7e-4, 9.3e-5}, {2.3e-2, 8.6e-3, 3.7e-3, 1.8e-3}, {0}}}};

/* Figures against the frequency domain, and a line of the table for the picture. */
static void compare(bw_validation *v, int levels, int motion, int form, const double R[],
                    FILE *table)
{
  char quantity[80];
  for (int q = 0; q < LENGTHS; q++) {
    const double want = solved[levels - 1][motion][form][q];
    if (table != NULL)
      fprintf(table, "%d,%c,%s,%d,%.6e\n", levels, "PS"[motion], forms[form].name, lengths[q],
              R[q]);
    snprintf(quantity, sizeof quantity, "R_%d_levels_%c_%s_%d", levels + 1, "PS"[motion],
             forms[form].name, lengths[q]);
    if (want > 0)
      bw_validation_row(v, &(bw_claim){.claim = "reflection as in the frequency domain",
                                       .quantity = quantity,
                                       .measured = R[q],
                                       .reference = want,
                                       .tolerance = 0.05,
                                       .kind = BW_INDEPENDENT_CODE,
                                       .source = "semi-discrete equations, sparse direct solver"});
  }
}

/* The balanced form beside what is unavoidable. */
static void claim_bound(bw_validation *v, int levels, int motion, int form, const double R[])
{
  static const double most[] = {1.5, 1.8};
  const char *law = forms[form].law == BW_SOLID_ORDINARY ? "_ordinary" : "";
  char quantity[80];
  const double bound = mismatch(&(lattice){ldexp(1, -levels), M}, motion, lengths[1]);
  snprintf(quantity, sizeof quantity, "over_bound_%d_levels_%c%s", levels + 1, "PS"[motion], law);
  /* From 1 to the factor: its middle and half of its width. */
  bw_validation_row(v, &(bw_claim){.claim = "at 20 horizons near the mismatch of dispersion",
                                   .quantity = quantity,
                                   .measured = R[1] / bound,
                                   .reference = (1 + most[motion]) / 2,
                                   .tolerance = (most[motion] - 1) / (1 + most[motion]),
                                   .kind = BW_ANALYTIC,
                                   .source = "(k2 - k1)/(k1 + k2) of the two lattices"});
  snprintf(quantity, sizeof quantity, "slope_%d_levels_%c%s", levels + 1, "PS"[motion], law);
  bw_validation_row(v, &(bw_claim){.claim = "reflection falls with the square of k",
                                   .quantity = quantity,
                                   .measured = log(R[1] / R[3]) / log(4),
                                   .reference = 2,
                                   .tolerance = 0.05,
                                   .kind = BW_ORDER,
                                   .source = "mismatch of dispersion"});
}

/* Of one horizon on both sides long waves see two moduli: the lattice's anisotropy is that of its
 * number of neighbours. */
static void claim_moduli(bw_validation *v, int motion, const double R[])
{
  char quantity[80];
  snprintf(quantity, sizeof quantity, "same_horizon_long_%c", "PS"[motion]);
  bw_validation_row(v, &(bw_claim){.claim = "of one horizon long waves meet another modulus",
                                   .quantity = quantity,
                                   .measured = R[LENGTHS - 1],
                                   .reference = mismatch(&(lattice){0.5, 2 * M}, motion, 80),
                                   .tolerance = 0.05,
                                   .kind = BW_ANALYTIC,
                                   .source = "(k2 - k1)/(k1 + k2) of the two lattices"});
}

static bw_status run(bw_validation *v)
{
  char path[512];
  snprintf(path, sizeof path, "%s/levels_reflection.csv", bw_validation_folder(v));
  FILE *table = bw_comm_rank(bw_validation_comm(v)) == 0 ? fopen(path, "w") : NULL;
  if (table != NULL) fprintf(table, "levels_above_0,wave,form,horizons_per_wave,R\n");
  bw_status st = BW_OK;
  for (int levels = 1; levels <= 2 && st == BW_OK; levels++)
    for (int motion = 0; motion < 2 && st == BW_OK; motion++)
      for (int form = 0; form < (levels == 1 ? FORMS : OF_NESTS) && st == BW_OK; form++) {
        double R[LENGTHS];
        st = reflect(bw_validation_comm(v), levels, form, motion, R);
        if (st != BW_OK) break;
        compare(v, levels, motion, form, R, table);
        if (forms[form].jump == BW_PD_JUMP_BALANCED) claim_bound(v, levels, motion, form, R);
        if (forms[form].jump == BW_PD_JUMP_DUAL && forms[form].same_horizon)
          claim_moduli(v, motion, R);
      }
  if (table != NULL) (void)fclose(table);
  return st;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_bond.levels_reflection", run);
}
