/* What a configuration has to be, by name. */
#include "ulph_internal.h"

/* The speed of sound over the largest expected speed: densities then vary by about a hundredth. */
static const double SLOWEST_SOUND = 10;

bw_ulph_config bw_ulph_config_default(void)
{
  return (bw_ulph_config){.dx = NAN,
                          .rho0 = NAN,
                          .speed = NAN,
                          .c0 = NAN,
                          .alpha = 0.02,
                          .alpha_wall = 0.1,
                          .delta = 0.1,
                          .shifting = 2,
                          .tension_cure = true,
                          .step_share = 1};
}

/* A number with its name and what it may be. */
typedef struct {
  const char *name;
  double value, least, most;
  bool above; /* the least is not allowed itself */
} limit;

bw_status bw_ulph__check(const bw_ulph_config *c)
{
  const limit limits[] = {{"dx", c->dx, 0, 1e50, true},
                          {"rho0", c->rho0, 0, 1e50, true},
                          {"speed", c->speed, 0, 1e50, false},
                          {"gravity[0]", c->gravity[0], -1e50, 1e50, false},
                          {"gravity[1]", c->gravity[1], -1e50, 1e50, false},
                          {"gravity[2]", c->gravity[2], -1e50, 1e50, false},
                          {"mu", c->mu, 0, 1e50, false},
                          {"alpha", c->alpha, 0, 1, false},
                          {"alpha_wall", c->alpha_wall, 0, 1, false},
                          {"delta", c->delta, 0, 0.3, false},
                          {"shifting", c->shifting, 0, 10, false},
                          {"step_share", c->step_share, 0, 2.4, true}};
  BW_REQUIRE(c->dimensions == 2 || c->dimensions == 3, BW_EINPUT,
             "ulph: dimensions is %d; 2 or 3 are possible", c->dimensions);
  for (size_t q = 0; q < sizeof limits / sizeof *limits; q++) {
    const limit *l = limits + q;
    BW_REQUIRE(l->value >= l->least && l->value <= l->most && !(l->above && l->value == l->least),
               BW_EINPUT, "ulph: %s is %g; it must be %s %g and at most %g", l->name, l->value,
               l->above ? "above" : "at least", l->least, l->most);
  }
  BW_REQUIRE(c->dimensions == 3 || c->gravity[2] == 0, BW_EINPUT,
             "ulph: gravity[2] is %g in two dimensions; give 0", c->gravity[2]);
  return BW_OK;
}

/* sqrt(|g| H), H the extent of the fluid along g. */
static double fall_speed(const bw_comm *comm, const bw_ulph_config *c, size_t n, const double x[])
{
  const double g = sqrt(bw_ulph__dot(c->gravity, c->gravity));
  double range[2] = {-INFINITY, -INFINITY};
  if (g == 0) return 0;
  for (size_t i = 0; i < n; i++) {
    const double up = -bw_ulph__dot(c->gravity, x + 3 * i) / g;
    range[0] = fmax(range[0], up);
    range[1] = fmax(range[1], -up);
  }
  bw_comm_max(comm, 2, range);
  return sqrt(g * fmax(0, range[0] + range[1] + c->dx));
}

bw_status bw_ulph__check_sound(const bw_comm *comm, bw_ulph_config *c, size_t n, const double x[])
{
  const double fall = fall_speed(comm, c, n, x), needed = SLOWEST_SOUND * fmax(c->speed, fall);
  if (isnan(c->c0)) c->c0 = needed;
  BW_REQUIRE(
      c->c0 > 0, BW_EINPUT,
      "ulph: neither speed, %g, nor gravity, nor c0 says how fast sound is: give the largest "
      "speed that is expected",
      c->speed);
  BW_REQUIRE(c->c0 >= needed * (1 - 1e-12), BW_EINPUT,
             "ulph: c0 is %g, a Mach number of %.3g; it must be at least %g, 10 times the largest "
             "of the expected speed, %g, and sqrt(g height), %g",
             c->c0, needed / SLOWEST_SOUND / c->c0, needed, c->speed, fall);
  return BW_OK;
}
