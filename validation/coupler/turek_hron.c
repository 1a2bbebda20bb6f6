/* Claim: a flap of rubber behind a cylinder bends, and swings, as in Turek and Hron's benchmark.
 *
 * Reference  S. Turek and J. Hron, Lecture Notes Comput. Sci. Eng. 53 (2006) 371: the newer, finer
 *            tables of the FeatFlow group, data/turek_hron (good to about 1 % in FSI3's mean drag
 *            and frequency, 2 % in the amplitude of its tip, 3 to 5 % in its other amplitudes).
 * Set-up     channel 2.5 x 0.41 m, cylinder of 0.1 m at (0.2, 0.2), flap of 0.35 x 0.02 m behind
 *            it. FSI1 Re 20, rests; FSI2 Re 100 and ten times the fluid's density, FSI3 Re 200 and
 *            the fluid's density: both swing. FSI2, FSI3 from rest, the inflow comes up in 2 s.
 *            FSI1 rests, so that its density and damping are free: those of FSI2, about critical.
 * Solid      bonds, whose Poisson ratio is 1/4 and not 0.4: E such that E/(1 - nu^2), which bends,
 *            is the benchmark's. 12 particles across, two a cell at least, horizon 3 spacings,
 *            surface correction `tensor`, as in bending_plate_fem; waves of the lattice are damped
 *            at a thirtieth of its own rate, which is 1e-4 of a period for the first mode.
 * Coupling   load by probes, iterated to 1e-3 (FSI1: explicit); all else by default.
 * Measured   (max + min)/2 and (max - min)/2 of each period, mean over the last ten. Forces on
 *            cylinder and flap per depth: the markers' reaction with the inertia of the fluid
 *            inside taken out, rho_f d/dt sum V_h v_h; those of the probes beside.
 * Tolerance  goals set for 164 cells before anything was measured (tip FSI1 3 %, FSI2 5 %, FSI3
 *            3 %, frequency FSI2 2 %, FSI3 1 %), that much more on coarser grids as a scheme of
 *            first order would be worse, from 82 cells on: with 41 the flap is two cells thick, and
 *            the two sheets of forces on its sides are within each other's reach. Drag at rest,
 *            too, from 82 cells on: the wall is known to 0.1 h (Breugem 2012), 1 % of the diameter;
 *            the drag of a cylinder that fills a quarter of the channel goes with its 1.5th power
 *            or so: 1.5 %. momentum: the reaction is what the momentum of a box says, to
 *            round-off of sums of 1e4 cells. All else is reported.
 * Forms      quick: FSI1 with 41 cells over the height of the channel, for 6 s. --full: all cases
 *            with 82 cells, for hours; it goes on where it was stopped (turek_hron-CASE-CELLS.h5
 *            beside the rows, removed when all is done). BW_TUREK_HRON=fsi3:123 in the environment:
 *            that alone; fsi3:123:reaction, :explicit, :predictor: loaded by the reaction, not
 *            iterated, neither but with a predictor (nothing claimed).
 * BUILD modules=coupler,shape,checkpoint
 * TEST  ranks=1 timeout=36000 */
#include "bw_validation.h"
#include "flap_in_channel.h"

#include <stdlib.h>

enum { PERIODS = 10 };

static const flap_case CASES[] = {
    {"fsi1", 0.2, 1e4, 1.4e6, 4e-3, 0.0, 15.0, 0.0, 1, 0.03, INFINITY, BW_LOAD_PROBES, false},
    {"fsi2", 1.0, 1e4, 1.4e6, 1.6e-3, 2.0, 18.0, 12.0, 50, 0.05, 0.02, BW_LOAD_PROBES, false},
    {"fsi3", 2.0, 1e3, 5.6e6, 8e-4, 2.0, 7.0, 5.5, 50, 0.03, 0.01, BW_LOAD_PROBES, false}};

/* Mean and amplitude of one column, over whole periods of the tip; frequency of the tip. */
typedef struct {
  double mean[COLUMNS], amplitude[COLUMNS], frequency;
  double drift; /* of the tip's amplitude, between the first and the second half of the periods */
  int periods;
} swing;

/* The rows at which the tip goes up through its mean, from time `from` on; how many. */
static int crossings(const flap *f, double from, int most, int at[], double when[])
{
  double low = INFINITY, high = -INFINITY;
  int n = 0;
  for (int q = 0; q < f->rows; q++) {
    const double *row = f->row + (size_t)q * COLUMNS;
    if (row[T] < from) continue;
    low = fmin(low, row[UY]);
    high = fmax(high, row[UY]);
  }
  const double middle = 0.5 * (low + high);
  for (int q = 1; q < f->rows; q++) {
    const double *row = f->row + (size_t)q * COLUMNS, *last = row - COLUMNS;
    if (row[T] < from || last[UY] > middle || row[UY] <= middle) continue;
    /* The last `most` of them are kept. */
    if (n == most) {
      memmove(at, at + 1, (size_t)(most - 1) * sizeof *at);
      memmove(when, when + 1, (size_t)(most - 1) * sizeof *when);
      n--;
    }
    const double part = (middle - last[UY]) / (row[UY] - last[UY]);
    at[n] = q;
    when[n++] = last[T] + part * (row[T] - last[T]);
  }
  return n;
}

static swing find_swing(const flap *f)
{
  swing s = {.periods = 0};
  int at[PERIODS + 1];
  double when[PERIODS + 1], half[2] = {0.0, 0.0};
  const int n = crossings(f, f->of.from, PERIODS + 1, at, when) - 1;
  if (n < 2) return s;
  s.periods = n;
  s.frequency = n / (when[n] - when[0]);
  for (int p = 0; p < n; p++)
    for (int c = UX; c < TRIES; c++) {
      double low = INFINITY, high = -INFINITY;
      for (int q = at[p]; q < at[p + 1]; q++) {
        const double x = f->row[(size_t)q * COLUMNS + (size_t)c];
        low = fmin(low, x);
        high = fmax(high, x);
      }
      s.mean[c] += 0.5 * (low + high) / n;
      s.amplitude[c] += 0.5 * (high - low) / n;
      if (c == UY && p != n / 2) half[p > n / 2] += 0.5 * (high - low);
    }
  s.drift = half[0] > 0.0 ? half[1] / half[0] * (n / 2) / (n - n / 2 - 1) - 1.0 : NAN;
  return s;
}

/* What rests: the last row. */
static swing find_rest(const flap *f)
{
  swing s = {.periods = 0};
  const double *last = f->row + (size_t)(f->rows - 1) * COLUMNS, *before = last;
  for (int c = UX; c < TRIES; c++)
    s.mean[c] = last[c];
  /* How much the tip still moved in the last tenth of the run. */
  before -= (size_t)(f->rows / 10) * COLUMNS;
  s.drift = last[UY] / before[UY] - 1.0;
  return s;
}

static void claim(bw_validation *v, const flap *f, const char *quantity, double measured,
                  double reference, double tolerance)
{
  char text[128], extra[128];
  snprintf(text, sizeof text, "%s, %s, %d cells", quantity, f->of.name, f->cells);
  snprintf(extra, sizeof extra, "\"case\": \"%s\", \"cells\": %d", f->of.name, f->cells);
  bw_validation_row(v, &(bw_claim){text, quantity, measured, reference, tolerance, BW_PUBLISHED,
                                   "Turek and Hron 2006, FeatFlow's newer tables, data/turek_hron",
                                   extra});
}

/* The row of the file: case, (mean, amplitude) of ux, uy, drag, lift, then the tip's frequency. */
static void rows(bw_validation *v, const flap *f, const double reference[])
{
  static const char *const name[] = {"ux", "uy", "drag", "lift"};
  const bool rests = f->of.ramp == 0.0;
  const swing s = rests ? find_rest(f) : find_swing(f);
  const double coarser = 164.0 / f->cells;
  char quantity[64];
  double tries = 0.0;
  for (int q = 0; q < 4; q++) {
    const bool claimed = q == 1 && f->cells >= 82;
    const double rest = q == 2 && f->cells >= 82 ? 0.03 * 41.0 / f->cells
                        : claimed                ? coarser * f->of.tip
                                                 : INFINITY;
    snprintf(quantity, sizeof quantity, "%s_mean", name[q]);
    claim(v, f, quantity, s.mean[UX + q], reference[1 + 2 * q], rests ? rest : INFINITY);
    if (rests) continue;
    snprintf(quantity, sizeof quantity, "%s_amplitude", name[q]);
    claim(v, f, quantity, s.amplitude[UX + q], reference[2 + 2 * q],
          claimed ? coarser * f->of.tip : INFINITY);
  }
  for (int q = 0; q < 2; q++) {
    snprintf(quantity, sizeof quantity, "%s_mean_by_probes", name[2 + q]);
    claim(v, f, quantity, s.mean[DRAG_PROBES + q], reference[5 + 2 * q], INFINITY);
    if (rests) continue;
    snprintf(quantity, sizeof quantity, "%s_amplitude_by_probes", name[2 + q]);
    claim(v, f, quantity, s.amplitude[DRAG_PROBES + q], reference[6 + 2 * q], INFINITY);
  }
  if (!rests) claim(v, f, "frequency", s.frequency, reference[9], coarser * f->of.frequency);
  claim(v, f, rests ? "tip_still_moves" : "amplitude_still_changes", s.drift, 0.0, INFINITY);
  bw_validation_row(v, &(bw_claim){"momentum", "momentum", f->force[0], f->force[1], 1e-8,
                                   BW_CONSERVATION, "momentum of a box around the body", NULL});
  for (int q = 0; q < f->rows; q++)
    tries += f->row[(size_t)q * COLUMNS + TRIES] / f->rows;
  if (!rests) claim(v, f, "iterations", tries, 0.0, INFINITY);
}

/* The history, for figures. */
static bw_status write_history(bw_validation *v, const flap *f)
{
  char path[1024];
  if (bw_comm_rank(bw_validation_comm(v)) != 0) return BW_OK;
  snprintf(path, sizeof path, "%s/turek_hron-%s-%d.csv", bw_validation_folder(v), f->of.name,
           f->cells);
  FILE *file = fopen(path, "w");
  BW_REQUIRE(file != NULL, BW_EIO, "cannot write %s", path);
  fprintf(file, "t_s,ux_m,uy_m,drag_N_per_m,lift_N_per_m,drag_probes_N_per_m,lift_probes_N_per_m,"
                "iterations\n");
  for (int q = 0; q < f->rows; q++)
    for (int c = 0; c < COLUMNS; c++)
      fprintf(file, "%.8g%c", f->row[(size_t)q * COLUMNS + (size_t)c],
              c + 1 < COLUMNS ? ',' : '\n');
  BW_REQUIRE(fclose(file) == 0, BW_EIO, "cannot write %s", path);
  return BW_OK;
}

static void name_state(const bw_validation *v, const flap_case *c, int cells, char path[1024])
{
  snprintf(path, 1024, "%s/turek_hron-%s-%d.h5", bw_validation_folder(v), c->name, cells);
}

static bw_status one_run(bw_validation *v, int row, const char *how, int cells,
                         const double reference[])
{
  flap f = {.of = CASES[row], .cells = cells};
  if (!bw_validation_full(v)) f.of.end = 6.0;
  name_state(v, &f.of, cells, f.path);
  if (how[0] != '\0') f.of.tip = f.of.frequency = INFINITY;
  if (strcmp(how, "reaction") == 0) f.of.load = BW_LOAD_REACTION;
  f.of.predictor = strcmp(how, "predictor") == 0;
  if (f.of.predictor || strcmp(how, "explicit") == 0) f.of.iterations = 1;
  bw_status st = flap_make(bw_validation_comm(v), &f);
  BW_THEN(st, flap_march(bw_validation_comm(v), &f, bw_validation_full(v)));
  /* Also of a run that was stopped on the way. */
  const bw_status written = bw_comm_agree(bw_validation_comm(v), write_history(v, &f));
  BW_THEN(st, written);
  if (st == BW_OK) rows(v, &f, reference);
  flap_destroy(&f);
  return st;
}

/* A case asked for by the environment, "fsi3:123": its row and cells, or row -1; how it is coupled
 * if not as it stands. */
static bw_status asked(int *row, int *cells, char how[16])
{
  const char *text = getenv("BW_TUREK_HRON");
  char name[8] = "";
  *row = -1;
  if (text == NULL) return BW_OK;
  BW_REQUIRE(sscanf(text, "%7[a-z0-9]:%d:%15s", name, cells, how) >= 2 && *cells >= 20, BW_EINPUT,
             "BW_TUREK_HRON=%s: a case and its cells are wanted, as fsi3:123", text);
  for (int q = 0; q < 3; q++)
    if (strcmp(name, CASES[q].name) == 0) *row = q;
  BW_REQUIRE(*row >= 0, BW_EINPUT, "BW_TUREK_HRON=%s: fsi1, fsi2 or fsi3", text);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  enum { FIELDS = 10, MOST = 3 };
  double table[MOST][FIELDS];
  int found = 0;
  BW_TRY(bw_validation_table("turek_hron/turek_hron.csv", FIELDS, MOST, table[0], &found));
  BW_REQUIRE(found == MOST, BW_EINPUT, "data/turek_hron has %d cases, not %d", found, MOST);
  int row = -1, cells = 82;
  char how[16] = "";
  BW_TRY(asked(&row, &cells, how));
  if (!bw_validation_full(v)) return one_run(v, 0, "", 41, table[0]);
  for (int q = 0; q < MOST; q++)
    if (row < 0 || row == q) BW_TRY(one_run(v, q, how, cells, table[q]));
  /* All is done: the next call begins anew. */
  for (int q = 0; q < MOST; q++) {
    char path[1024];
    name_state(v, &CASES[q], cells, path);
    if ((row < 0 || row == q) && bw_comm_rank(bw_validation_comm(v)) == 0) remove(path);
  }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.turek_hron", run);
}
