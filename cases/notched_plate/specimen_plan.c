/* What of a specimen can be known before it is built: what is refused, what it costs. */
#include "bw_number.h"
#include "specimen.h"
#include <math.h>
#include <string.h>

/* Limits that were not given are infinite, windows follow from the plate. */
static void open_limits(specimen_config *c)
{
  for (int q = 0; q < c->n_loads; q++) {
    if (isnan(c->loads[q].from)) c->loads[q].from = -HUGE_VAL;
    if (isnan(c->loads[q].to)) c->loads[q].to = HUGE_VAL;
  }
  for (int d = 0; d < 2; d++) {
    if (isnan(c->follow.lower[d])) c->follow.lower[d] = -HUGE_VAL;
    if (isnan(c->follow.upper[d])) c->follow.upper[d] = HUGE_VAL;
  }
  if (isnan(c->follow.fit_to)) c->follow.fit_to = HUGE_VAL;
  /* The windows of the branching plate, whose length is 0.1 m, in proportion. */
  if (isnan(c->follow.speed_window)) c->follow.speed_window = 2e-6 * (c->shape.length / 0.1);
  if (isnan(c->follow.angle_over)) c->follow.angle_over = 5e-3 * (c->shape.length / 0.1);
}

/* Particles have 32-bit numbers, and sites are looked through one by one. */
static bw_status check_count(const specimen_shape *s, bool solid)
{
  const double ds = s->length / s->particles;
  const double rows = round(s->height / ds), layers = solid ? round(s->thickness / ds) : 1.0;
  const double n = s->particles * rows * layers;
  BW_REQUIRE(
      n <= (double)INT32_MAX, BW_EINPUT,
      "shape.particles = %d over shape.length = %g make a spacing of %.3g and a plate of %d x "
      "%.0f x %.0f particles, %.3g in all; at most %d",
      s->particles, s->length, ds, s->particles, rows, layers, n, INT32_MAX);
  /* A turned lattice is looked through far beyond the plate. */
  static const double scanned = 2e10; /* sites of some nanoseconds each: a minute */
  const double over = s->lattice_angle == 0.0 ? 0.0 : s->particles + rows;
  BW_REQUIRE((s->particles + 2.0 * over) * (rows + 2.0 * over) * layers <= scanned, BW_EINPUT,
             "shape.lattice_angle = %g: %d x %.0f particles are too many for a turned lattice",
             s->lattice_angle, s->particles, rows);
  BW_REQUIRE(rows >= 1.0, BW_EINPUT, "shape.height = %g is less than a spacing, %g", s->height, ds);
  return BW_OK;
}

static bw_status check_ranges(const specimen_config *c)
{
  for (int d = 0; d < 2; d++)
    BW_REQUIRE(c->follow.lower[d] < c->follow.upper[d], BW_EINPUT,
               "follow.lower[%d] = %g has to be below follow.upper[%d] = %g", d, c->follow.lower[d],
               d, c->follow.upper[d]);
  BW_REQUIRE(c->follow.fit_from < c->follow.fit_to, BW_EINPUT,
             "follow.fit_from = %g has to be below follow.fit_to = %g", c->follow.fit_from,
             c->follow.fit_to);
  /* The tip of a notch in this plate, to a spacing; sections are laid across the crack from
   * there. */
  const double edge[2] = {c->shape.length, c->shape.height};
  const double ds = c->shape.length / c->shape.particles;
  for (int d = 0; d < 2; d++)
    BW_REQUIRE(c->follow.from[d] >= -ds && c->follow.from[d] <= edge[d] + ds, BW_EINPUT,
               "follow.from[%d] = %g is outside the plate, 0 to %g m (millimetres for metres?)", d,
               c->follow.from[d], edge[d]);
  const double steps = ceil(c->time.end / c->time.step - 1e-9);
  BW_REQUIRE(steps <= (double)BW_MOST_STEPS, BW_EINPUT,
             "time.end = %g takes %.3g steps of time.step = %g, more than the %g that anybody can "
             "wait for; take a larger step",
             c->time.end, steps, c->time.step, (double)BW_MOST_STEPS);
  return check_count(&c->shape, c->solid.geometry == BW_PD_3D);
}

/* ---- what touches nothing ----
 * Places are looked at along a line, at most so many, whatever the number of particles. */
enum { LOOKS = 10000, WINDOW = 2 };

typedef bool site_test(const specimen *p, const void *what, const double x[3]);

/* The sites about `near`: is there one in the plate with `test`? Turned back to the lattice. */
static bool any_site(const specimen *p, const double near[2], site_test *test, const void *what)
{
  const bw_solid_config c = specimen_material(p);
  const double r[2] = {near[0] - c.origin[0], near[1] - c.origin[1]};
  const int i = (int)floor((r[0] * c.axes[0][0] + r[1] * c.axes[0][1]) / c.ds);
  const int j = (int)floor((r[0] * c.axes[1][0] + r[1] * c.axes[1][1]) / c.ds);
  for (int a = -WINDOW; a <= WINDOW; a++)
    for (int b = -WINDOW; b <= WINDOW; b++) {
      double x[3] = {0.0, 0.0, 0.0};
      specimen_place(&c, i + a, j + b, x);
      if (test(p, what, x)) return true;
    }
  return false;
}

static bool in_hole(const specimen *p, const void *what, const double x[3])
{
  const specimen_hole *o = what;
  return specimen_inside(p, 0, x) && hypot(x[0] - o->centre[0], x[1] - o->centre[1]) < o->radius;
}

static bool takes_load(const specimen *p, const void *what, const double x[3])
{
  return specimen_inside(p, p->config.n_holes, x) && specimen_loaded(p, what, x);
}

/* The line of a notch, and a site on one side of it. */
typedef struct {
  const specimen_notch *notch;
  double a[2];
} half_bond;

/* Twice the area of the triangle a, b, x: its sign is the side of x. */
static double side_of(const double a[2], const double b[2], const double x[2])
{
  return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
}

static bool other_end(const specimen *p, const void *what, const double x[3])
{
  const half_bond *h = what;
  const double *s = h->notch->from, *e = h->notch->to;
  return specimen_inside(p, p->config.n_holes, x) &&
         side_of(s, e, h->a) * side_of(s, e, x) <= 0.0 &&
         side_of(h->a, x, s) * side_of(h->a, x, e) <= 0.0 &&
         hypot(x[0] - h->a[0], x[1] - h->a[1]) > 0.5 * p->ds;
}

/* Does a bond begin here that the notch cuts? */
static bool cut_bond(const specimen *p, const void *what, const double x[3])
{
  half_bond h = {.notch = what, .a = {x[0], x[1]}};
  return specimen_inside(p, p->config.n_holes, x) && any_site(p, h.a, other_end, &h);
}

/* The part of from .. to in the plate, and a spacing around it (Liang and Barsky); false: none. */
static bool clip(const specimen *p, const double from[2], const double to[2], double part[2])
{
  const double edge[2] = {p->config.shape.length, p->config.shape.height};
  part[0] = 0.0, part[1] = 1.0;
  for (int d = 0; d < 2; d++) {
    const double way = to[d] - from[d], low = -p->ds - from[d], high = edge[d] + p->ds - from[d];
    if (way == 0.0 && (low > 0.0 || high < 0.0)) return false;
    if (way == 0.0) continue;
    part[0] = fmax(part[0], fmin(low / way, high / way));
    part[1] = fmin(part[1], fmax(low / way, high / way));
  }
  return part[0] <= part[1];
}

/* Looks along from .. to, half a spacing apart. */
static bool along_line(const specimen *p, const double from[2], const double to[2], site_test *test,
                       const void *what)
{
  double part[2];
  if (!clip(p, from, to, part)) return false;
  const double length = hypot(to[0] - from[0], to[1] - from[1]) * (part[1] - part[0]);
  const int looks = (int)fmin(LOOKS, ceil(2.0 * length / p->ds)) + 1;
  for (int q = 0; q < looks; q++) {
    const double t = part[0] + (part[1] - part[0]) * (q + 0.5) / looks;
    const double x[2] = {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
    if (any_site(p, x, test, what)) return true;
  }
  return false;
}

static bw_status check_notches(const specimen *p)
{
  const specimen_shape *s = &p->config.shape;
  for (int q = 0; q < p->config.n_notches; q++) {
    const specimen_notch *k = &p->config.notches[q];
    BW_REQUIRE(along_line(p, k->from, k->to, cut_bond, k), BW_EINPUT,
               "notches.%d: from [%g, %g] to [%g, %g] cuts no bond of the plate, 0 to %g and 0 to "
               "%g m (millimetres for metres?)",
               q, k->from[0], k->from[1], k->to[0], k->to[1], s->length, s->height);
  }
  return BW_OK;
}

static bw_status check_holes(const specimen *p)
{
  const specimen_shape *s = &p->config.shape;
  for (int q = 0; q < p->config.n_holes; q++) {
    const specimen_hole *o = &p->config.holes[q];
    /* The plate's place nearest to the middle is the first that a hole takes. */
    const double at[2] = {fmin(fmax(o->centre[0], 0.0), s->length),
                          fmin(fmax(o->centre[1], 0.0), s->height)};
    BW_REQUIRE(any_site(p, at, in_hole, o), BW_EINPUT,
               "holes.%d: centre [%g, %g], radius %g takes no particle of the plate, 0 to %g and 0 "
               "to %g m with a spacing of %g m (millimetres for metres?)",
               q, o->centre[0], o->centre[1], o->radius, s->length, s->height, p->ds);
  }
  return BW_OK;
}

static bw_status check_loads(const specimen *p)
{
  const specimen_shape *s = &p->config.shape;
  for (int q = 0; q < p->config.n_loads; q++) {
    const specimen_load *load = &p->config.loads[q];
    const bool upright = load->edge == SPECIMEN_LEFT || load->edge == SPECIMEN_RIGHT;
    const double length = upright ? s->height : s->length, inset = 0.5 * p->ds;
    /* Along the middle of the outermost row. */
    const double across = load->edge == SPECIMEN_LEFT || load->edge == SPECIMEN_BOTTOM
                              ? inset
                              : (upright ? s->length : s->height) - inset;
    const double first = fmax(load->from, 0.0), last = fmin(load->to, length);
    const double from[2] = {upright ? across : first, upright ? first : across};
    const double to[2] = {upright ? across : last, upright ? last : across};
    BW_REQUIRE(load->from < load->to, BW_EINPUT,
               "loads.%d.from = %g has to be below loads.%d.to = %g", q, load->from, q, load->to);
    BW_REQUIRE(first < last && along_line(p, from, to, takes_load, load), BW_EINPUT,
               "loads.%d: from %g to %g loads no particle of its edge, 0 to %g m (millimetres for "
               "metres?)",
               q, load->from, load->to, length);
  }
  return BW_OK;
}

/* Numbers that cannot be meant: strains of more than tenfold, speeds far above that of sound, loads
 * that never rise, rows that the plate does not have, a time in which no sound is heard. */
static bw_status check_sizes(const specimen *p)
{
  static const double most = 10.0, longest = 1e6, least = 1e-6;
  const specimen_config *c = &p->config;
  const double sound = sqrt(c->solid.young_modulus / c->solid.density);
  for (int q = 0; q < c->n_loads; q++) {
    const specimen_load *load = &c->loads[q];
    const bool traction = load->kind == SPECIMEN_TRACTION;
    const double size = hypot(load->value[0], load->value[1]);
    const double whole = traction ? c->solid.young_modulus : sound;
    BW_REQUIRE(size / whole <= most, BW_EINPUT,
               "loads.%d.value: %g is %.3g times %s, %g; at most %g times; check its unit", q, size,
               size / whole, traction ? "solid.young_modulus" : "the speed of sound", whole, most);
    BW_REQUIRE(load->rise <= longest * c->time.end, BW_EINPUT,
               "loads.%d.rise = %g is %.3g times time.end = %g: nothing would be loaded", q,
               load->rise, load->rise / c->time.end, c->time.end);
    const double across = load->edge == SPECIMEN_LEFT || load->edge == SPECIMEN_RIGHT
                              ? c->shape.length
                              : c->shape.height;
    BW_REQUIRE(load->rows <= across / p->ds, BW_EINPUT,
               "loads.%d.rows = %d: the plate has %.0f there", q, load->rows, across / p->ds);
  }
  BW_REQUIRE(
      sound * c->time.end / p->ds >= least, BW_EINPUT,
      "time.end = %g: sound, of %g m/s by solid.young_modulus and solid.density, passes %.3g "
      "of a particle until then, which rounding hides; at least %g",
      c->time.end, sound, sound * c->time.end / p->ds, least);
  return BW_OK;
}

bw_status specimen_begin(const bw_comm *comm, const specimen_config *config, specimen *p)
{
  memset(p, 0, sizeof *p);
  p->comm = comm;
  p->config = *config;
  open_limits(&p->config);
  BW_TRY(check_ranges(&p->config));
  p->ds = config->shape.length / config->shape.particles;
  BW_TRY(check_holes(p));
  BW_TRY(check_notches(p));
  BW_TRY(check_loads(p));
  return check_sizes(p);
}

/* Particles in all, but for notches and the edges of holes. */
static double expected_particles(const specimen *p)
{
  const specimen_shape *s = &p->config.shape;
  const bool solid = p->config.solid.geometry == BW_PD_3D;
  double area = s->length * s->height;
  for (int q = 0; q < p->config.n_holes; q++)
    area -= acos(-1.0) * p->config.holes[q].radius * p->config.holes[q].radius;
  return fmax(1.0, area / (p->ds * p->ds) * (solid ? round(s->thickness / p->ds) : 1.0));
}

bw_status specimen_plan(const bw_comm *comm, const specimen_config *config, bw_log *log)
{
  const double own_bytes = 3 * 8 + 8 + 3 * 8 + 2; /* X0, damage, F, loads and notched */
  /* X and U while one is written, and what the writer takes for a point (bw_vtk_points_bytes; who
   * takes this file alone has no vtk). */
  const double picture = 2 * 3 * 8 + (3 * 4 + 8 + 3 * 8);
  specimen p;
  bw_solid_sample sample;
  BW_TRY(specimen_begin(comm, config, &p));
  const bw_solid_config material = specimen_material(&p);
  BW_TRY(bw_solid_try(comm, &material, &sample));
  const double n = expected_particles(&p), mine = n / bw_comm_size(comm);
  const specimen_solid *s = &p.config.solid;
  bw_log_info(log, "about %.3g particles of %g m, lattice turned by %g deg, horizon %g m", n, p.ds,
              p.config.shape.lattice_angle, sample.horizon);
  bw_log_info(log, "bonds break at a stretch of %.4g; sound travels at %.0f m/s (sqrt(E/rho))",
              sample.critical_stretch, sqrt(s->young_modulus / s->density));
  bw_log_info(log, "time step %g s of at most about %.3g s, %.0f steps", p.config.time.step,
              sample.dt_max, ceil(p.config.time.end / p.config.time.step - 1e-9));
  bw_log_info(log, "memory     about %.3g MiB for each of %d ranks",
              mine * (sample.bytes + own_bytes + picture) / 1048576.0, bw_comm_size(comm));
  BW_REQUIRE(p.config.time.step <= sample.dt_max * (1.0 + 1e-12), BW_EINPUT,
             "time.step = %g s is over the limit of the material at this spacing, %.4g s",
             p.config.time.step, sample.dt_max);
  return BW_OK;
}
