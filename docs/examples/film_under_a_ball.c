/* A ball of 5 mm radius settles the last part of a millimetre: what the water under it resists.
 * BUILD modules=film
 * TEST  ranks=1 */
#include "bw_film.h"

#include <math.h>
#include <stdio.h>

static double above_the_floor(const void *context, const double x[3])
{
  (void)context;
  return x[1];
}

static double from_the_ball(const void *context, const double x[3])
{
  const double *gap = context, R = 5e-3;
  return sqrt(x[0] * x[0] + pow(x[1] - R - *gap, 2) + x[2] * x[2]) - R;
}

static bw_status resist(double gap, double D[6][6])
{
  const double start[3] = {1e-3, 1e-3, 0.0};
  bw_film_config config = bw_film_config_default();
  bw_film *film = NULL;
  bw_status st = BW_OK;
  config.mu = 1e-3, config.limit = 2e-3, config.roughness = 1e-6;
  BW_TRY(bw_film_create(&config, &film));
  const bw_film_face floor = {above_the_floor, NULL}, ball = {from_the_ball, &gap};
  if (bw_film_place(film, &floor, &ball, start)) st = bw_film_resistance(film, false, D);
  bw_film_destroy(&film);
  return st;
}

int main(void)
{
  for (double gap = 1e-3; gap > 5e-6; gap *= 0.5) {
    double D[6][6];
    if (resist(gap, D) != BW_OK) return 1;
    printf("gap %8.3g mm: %.4g N for 1 m/s\n", 1e3 * gap, D[1][1]);
  }
  return 0;
}
