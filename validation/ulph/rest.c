/* Claim      Water at rest in a tank stays at rest: the rows at the surface settle by a small part
 *            of dx, the floor carries the hydrostatic pressure, and what moves is negligible.
 *            ULPH's filter of the density (equation 24), put into the same tank here, does not let
 *            it: it is exact for constants only.
 * Reference  p = rho g (H - y).
 * Measured   20 (40) rows, over 20 times sqrt(H/g) (with the filter every second step: 5 times).
 * Tolerance  Surface 0.2 dx and floor 0.5 %: references of the method (rho g 0.2 dx is 1 % of the
 *            floor's pressure at 20 rows; sound of the settling rows is averaged over 5 sqrt(H/g)).
 *            Kinetic energy 1e-6 rho g H^2 L. The filter has to miss it:
 *            each application puts 0.4 rho g dx on the upper row, which then moves. A tank of two
 *            walls, a floor and sides, has to rest as well: images across a corner are across both.
 *            Over a floor that is tilted by 0.2 (a lattice of the wall along it) its kinetic energy
 *            after 10 (180) sqrt(H/g) is reported, as water does not rest there: sites and floor do
 *            not fit, particles beside it are in disorder, the extrapolated image is not the mirror
 *            image any more, and what it gives (the line `ghosts` of the book) keeps the water
 *            stirring.
 * BUILD modules=shape
 * TEST  ranks=1 */
#include "tank.h"

static const double H = 1, RHO = 1000;

static bw_status make(const bw_comm *comm, int rows, bw_ulph **u)
{
  bw_ulph_config c = bw_ulph_config_default();
  tank_water water = {H, RHO};
  c.dimensions = 2, c.dx = H / rows, c.rho0 = RHO, c.gravity[1] = -tank_g;
  c.speed = sqrt(tank_g * H);
  const tank t = {.size = {H, 1.2 * H, 0}, .upper = {H, H, 0}};
  BW_TRY(tank_create(comm, &c, &t, u));
  return bw_ulph_start(*u, tank_rest, &water);
}

static void claim(bw_validation *v, const char *quantity, double measured, double reference,
                  double tolerance)
{
  bw_validation_row(v, &(bw_claim){.claim = "water at rest stays at rest",
                                   .quantity = quantity,
                                   .measured = measured,
                                   .reference = reference,
                                   .tolerance = tolerance,
                                   .kind = BW_ANALYTIC,
                                   .source = "hydrostatics"});
}

static bw_status stay(bw_validation *v, int rows)
{
  const double unit = sqrt(H / tank_g), dx = H / rows;
  const double lower[3] = {0.2 * H, -0.9 * dx, 0}, upper[3] = {0.8 * H, 0, 0};
  const double all[2][3] = {{-9, -9, 0}, {9, 9, 0}};
  bw_ulph *u = NULL;
  double floor = 0, half = 0, kinetic = 0;
  int n = 0;
  BW_TRY(make(bw_validation_comm(v), rows, &u));
  /* A little more than rho0 g H, as water is compressed. */
  const double weight = bw_ulph_account(u).mass * tank_g / H;
  for (int q = 1; q <= 200; q++) {
    while (q > 150 && bw_ulph_time(u) < (0.1 * q - 0.01) * unit) {
      BW_TRY(bw_ulph_step(u, bw_ulph_dt_max(u)));
      floor += bw_ulph_wall_pressure(u, lower, upper), n++;
    }
    BW_TRY(tank_run(u, 0.1 * q * unit));
    if (q > 80 && q <= 100) half += bw_ulph_account(u).kinetic / 20;
    if (q > 180) kinetic += bw_ulph_account(u).kinetic / 20;
  }
  /* The first layer of the floor lies half a spacing below it. */
  claim(v, "surface_over_dx", (bw_ulph_reach(u, 1, all[0], all[1]) - H) / dx, 0, 0.2);
  claim(v, "floor_pressure_over_weight", floor / n, weight * (1 + 0.5 * dx / H), 0.005);
  claim(v, "kinetic_energy_over_rho_g_H2_L", kinetic / (RHO * tank_g * H * H * H), 0, 1e-6);
  claim(v, "kinetic_energy_halfway_over_rho_g_H2_L", half / (RHO * tank_g * H * H * H), 0, 1e-6);
  bw_ulph_destroy(&u);
  return BW_OK;
}

/* A tank of two walls, the floor of which rises by `rise` along x. */
static bw_status make_of_two(const bw_comm *comm, int rows, double rise, bw_ulph **u)
{
  const double dx = H / rows, t = 4 * dx, cosine = 1 / sqrt(1 + rise * rise), sine = rise * cosine;
  const double origin[3] = {0, 0, 0};
  const bw_shape_frame slope = {{{cosine, sine, 0}, {-sine, cosine, 0}, {0, 0, 1}}, {0}};
  const bw_shape floor = {.lower = {-3, -t, -1}, .upper = {3, 0, 1}, .frame = &slope};
  const bw_shape sides[2] = {{.lower = {-t, -t, 0}, .upper = {H + t, 1.5 * H, 1}},
                             {.remove = true, .lower = {0, -9, 0}, .upper = {H, 9, 1}}};
  bw_shape water[2] = {{.upper = {H, H, 1}}, floor};
  bw_ulph_wall walls[2] = {{.count = 1, .shape = &floor}, {.count = 2, .shape = sides}};
  bw_ulph_config c = bw_ulph_config_default();
  tank_water rest = {H, RHO};
  double *x = NULL;
  size_t n = 0, kept = 0;
  water[1].remove = true;
  memcpy(walls[0].axes, slope.axes, sizeof slope.axes);
  c.dimensions = 2, c.dx = dx, c.rho0 = RHO, c.gravity[1] = -tank_g, c.speed = sqrt(tank_g * H);
  bw_status st = bw_ulph_fill(comm, &c, origin, 2, water, &n, &x);
  /* Sites that the floor nearly touches are left out. */
  for (size_t i = 0; i < n; i++)
    if (cosine * x[3 * i + 1] - sine * x[3 * i] > 0.25 * dx)
      memmove(x + 3 * kept++, x + 3 * i, 3 * sizeof *x);
  BW_THEN(st, bw_ulph_create(comm, &c, kept, x, 2, walls, u));
  BW_THEN(st, bw_ulph_start(*u, tank_rest, &rest));
  bw_release(&x);
  return st;
}

static bw_status stay_in_corners(bw_validation *v, double rise, double end)
{
  const double unit = RHO * tank_g * H * H * H;
  bw_ulph *u = NULL;
  bw_status st = make_of_two(bw_validation_comm(v), 20, rise, &u);
  BW_THEN(st, tank_run(u, end * sqrt(H / tank_g)));
  if (st == BW_OK) {
    const bw_ulph_ledger l = bw_ulph_account(u);
    claim(v,
          rise > 0 ? "tilted_floor_kinetic_energy_over_rho_g_H2_L"
                   : "two_walls_kinetic_energy_over_rho_g_H2_L",
          l.kinetic / unit, 0, rise > 0 ? INFINITY : 1e-6);
    claim(v,
          rise > 0 ? "tilted_floor_images_gave_over_rho_g_H2_L"
                   : "two_walls_images_gave_over_rho_g_H2_L",
          l.ghosts / unit, 0, INFINITY);
  }
  bw_ulph_destroy(&u);
  return st;
}

/* rho <- sum w rho/sum w over all particles within 3 dx (one rank, every pair). */
static bw_status filter(bw_ulph *u, double dx)
{
  const size_t n = bw_ulph_count(u);
  double *rows = NULL, *rho = NULL, numbers[BW_ULPH_NUMBERS];
  int64_t *id = NULL;
  bw_status st = BW_ALLOCATE(&rows, BW_ULPH_ROW * n);
  BW_THEN(st, BW_ALLOCATE(&rho, n));
  BW_THEN(st, BW_ALLOCATE(&id, n));
  if (st == BW_OK) {
    bw_ulph_ids(u, id);
    bw_ulph_state_get(u, rows, numbers);
    for (size_t i = 0; i < n; i++) {
      double sum[2] = {0, 0};
      for (size_t j = 0; j < n; j++) {
        const double *a = rows + BW_ULPH_ROW * i, *b = rows + BW_ULPH_ROW * j;
        const double r2 = (pow(b[0] - a[0], 2) + pow(b[1] - a[1], 2)) / pow(1.2 * dx, 2);
        if (r2 >= 9) continue;
        sum[0] += (exp(-r2) - exp(-9)) * b[15];
        sum[1] += exp(-r2) - exp(-9);
      }
      rho[i] = sum[0] / sum[1];
    }
    for (size_t i = 0; i < n; i++)
      rows[BW_ULPH_ROW * i + 15] = rho[i];
    st = bw_ulph_state_set(u, n, id, rows, numbers);
  }
  bw_release(&rows);
  bw_release(&rho);
  bw_release(&id);
  return st;
}

static bw_status with_filter(bw_validation *v, int rows)
{
  const double end = 5 * sqrt(H / tank_g), all[2][3] = {{-9, -9, 0}, {9, 9, 0}};
  bw_ulph *u = NULL;
  BW_TRY(make(bw_validation_comm(v), rows, &u));
  while (bw_ulph_time(u) < end) {
    BW_TRY(bw_ulph_step(u, bw_ulph_dt_max(u)));
    if (bw_ulph_steps(u) % 2 == 0) BW_TRY(filter(u, H / rows));
  }
  const double off = (bw_ulph_reach(u, 1, all[0], all[1]) - H) * rows / H;
  const double kinetic = bw_ulph_account(u).kinetic / (RHO * tank_g * H * H * H);
  claim(v, "filter_24_misses", kinetic > 1e-6, 1, 0);
  claim(v, "filter_24_surface_over_dx", off, 0, INFINITY);
  claim(v, "filter_24_kinetic_energy_over_rho_g_H2_L", kinetic, 0, INFINITY);
  bw_ulph_destroy(&u);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(stay(v, bw_validation_full(v) ? 40 : 20));
  BW_TRY(with_filter(v, 20));
  const double end = bw_validation_full(v) ? 180 : 10;
  BW_TRY(stay_in_corners(v, 0, end));
  return stay_in_corners(v, 0.2, end);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "ulph.rest", run);
}
