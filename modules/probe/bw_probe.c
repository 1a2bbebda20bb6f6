/* The object, and the traction from what the tips have read. */
#include "bw_memory.h"
#include "probe_internal.h"

#include <math.h>
#include <string.h>

bw_probe_config bw_probe_config_default(void)
{
  return (bw_probe_config){
      .kernel = BW_KERNEL_ROMA3, .length = 2.0, .profile = BW_PROBE_LINEAR, .rho = NAN, .nu = NAN};
}

static bw_status check(const bw_grid_view *g, const bw_probe_config *c)
{
  /* Every refusal names the value and the range; all ranks have the same configuration. */
  BW_REQUIRE((int)c->kernel >= 0 && c->kernel < BW_KERNEL_COUNT, BW_EINPUT,
             "kernel: no row %d in the table of %d", (int)c->kernel, (int)BW_KERNEL_COUNT);
  /* Differences widen the support by a node, and a halo of two holds four. */
  BW_REQUIRE(bw_kernel_delta_get(c->kernel)->support < PROBE_WIDTH, BW_EINPUT,
             "kernel %s: its differences need %d nodes per direction, the halo gives 4; use roma3",
             bw_kernel_delta_get(c->kernel)->name, bw_kernel_delta_get(c->kernel)->support + 1);
  BW_REQUIRE(c->length >= 1.0 && c->length <= 4.0, BW_EINPUT,
             "probe length: 1 to 4 grid spacings, found %g", c->length);
  BW_REQUIRE((int)c->profile >= 0 && c->profile < BW_PROBE_PROFILES, BW_EINPUT,
             "probe profile: 0 (linear) or 1 (quadratic), found %d", (int)c->profile);
  BW_REQUIRE(c->rho > 0.0, BW_EINPUT, "rho: fluid density > 0 is required, found %g", c->rho);
  BW_REQUIRE(c->nu >= 0.0, BW_EINPUT, "nu: kinematic viscosity >= 0 is required, found %g", c->nu);
  BW_REQUIRE(g->uniform_y, BW_EINPUT, "probes need a uniform grid: y must not be stretched");
  BW_REQUIRE(g->halo[0] == 2 && g->halo[1] == 2 && (g->n[2] == 1 || g->halo[2] == 2), BW_EINPUT,
             "probes need a grid with halo 2, found %d", g->halo[0]);
  return BW_OK;
}

bw_status bw_probe_create(bw_grid *grid, const bw_probe_config *config, bw_probe **out)
{
  const bw_grid_view *g = bw_grid_look(grid);
  bw_probe *b = NULL;
  *out = NULL;
  BW_TRY(check(g, config));
  const bw_status st = BW_ALLOCATE(&b, 1);
  BW_TRY(bw_comm_agree(bw_grid_comm(grid), st));
  b->grid = grid;
  b->g = g;
  b->kernel = bw_kernel_delta_get(config->kernel);
  /* The stencil's differences and the probe's length go by the largest spacing. */
  b->h = fmax(g->spacing[0], g->spacing[1]);
  if (g->n[2] > 1) b->h = fmax(b->h, g->spacing[2]);
  b->full = config->length * b->h;
  b->profile = config->profile;
  b->rho = config->rho;
  b->nu = config->nu;
  *out = b;
  return BW_OK;
}

void bw_probe_destroy(bw_probe **probe)
{
  if (*probe == NULL) return;
  bw_probe *b = *probe;
  bw_release(&b->normal);
  bw_release(&b->length);
  bw_release(&b->flag);
  bw_release(&b->obstacles);
  for (int t = 0; t < PROBE_SETS; t++) {
    bw_probe__tips *tips = &b->tips[t];
    bw_exchange_destroy(&tips->plan);
    void *const arrays[] = {&tips->from,     &tips->to,    &tips->item,
                            &tips->answer,   &tips->seen,  &tips->read,
                            &tips->received, &tips->reply, &tips->seen_here};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
      bw_release(arrays[a]);
  }
  bw_release(probe);
}

bw_status bw_probe_set_obstacles(bw_probe *probe, const bw_real *solid)
{
  const size_t size = probe->g->size;
  probe->in_the_way = solid != NULL;
  if (solid == NULL) return BW_OK;
  if (probe->obstacles == NULL) BW_TRY(BW_ALLOCATE(&probe->obstacles, size));
  /* A byte per cell: what is looked at along a probe then stays in the cache. */
  for (size_t i = 0; i < size; i++)
    probe->obstacles[i] = solid[i] > (bw_real)0.5;
  return BW_OK;
}

void bw_probe_set_velocity(bw_probe *probe, const double V[], const double spin[])
{
  probe->V = V;
  probe->spin = spin;
}

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Of one surface point. */
typedef struct {
  const double *V, *spin, *A; /* (3) */
} surface_motion;

static const double *row_of(const double x[], size_t i)
{
  static const double zero[3] = {0.0, 0.0, 0.0};
  return x == NULL ? zero : x + 3 * i;
}

typedef struct {
  double slope, curvature; /* at the wall: df/dn, d2f/dn2 */
} wall_end;

/* f = wall + a eta + b eta^2 with the tip's value and slope. */
static wall_end parabola_through(const bw_probe__along *f, double wall, double dl)
{
  const double b = (f->slope * dl - (f->value - wall)) / (dl * dl);
  return (wall_end){f->slope - 2.0 * b * dl, 2.0 * b};
}

/* p on the wall, where its slope is known. */
static double wall_pressure(const bw_probe__along *p, double slope, double dl)
{
  return p->value - 0.5 * dl * (p->slope + slope);
}

/* POROUS 3.85-3.94: velocity gradient of the tip, trapezoidal pressure. */
static void linear_profile(const bw_probe *b, const bw_probe__reply *r, const double n[3],
                           double dl, const surface_motion *s, double t[3])
{
  const double p = wall_pressure(&r->p, -dot(s->A, n), dl);
  for (int c = 0; c < 3; c++)
    t[c] = b->rho * (-p * n[c] + b->nu * (r->u[c].slope + r->gtn[c]));
}

/* With a = du/dn at the wall and the surface turning as a rigid one does there,
 *   grad u = a n + derivatives along the wall,  (grad u)^T.n = (a.n) n + n x spin.
 * The tip's own (grad u)^T.n would be wrong by the curvature of the wall: even where the wall is
 * at rest, u at the tip turns as n does along the wall, -u_e/R. */
static void quadratic_profile(const bw_probe *b, const bw_probe__reply *r, const double n[3],
                              double dl, const surface_motion *s, double t[3])
{
  const double *w = s->spin;
  /* n x spin: how a surface that turns drags u along with it. */
  const double turn[3] = {n[1] * w[2] - n[2] * w[1], n[2] * w[0] - n[0] * w[2],
                          n[0] * w[1] - n[1] * w[0]};
  double slope[3], an = 0.0, bend = 0.0;
  /* Slope and curvature at the wall from V there and value and slope at the tip. */
  for (int c = 0; c < 3; c++) {
    const wall_end e = parabola_through(&r->u[c], s->V[c], dl);
    slope[c] = e.slope;
    an += e.slope * n[c];
    bend += e.curvature * n[c];
  }
  /* POROUS 3.85 with the sign of ERRATA 19; momentum along n gives dp/dn, viscous part included. */
  const double p = wall_pressure(&r->p, b->nu * bend - dot(s->A, n), dl);
  /* POROUS 3.94 in any directions, by ERRATA 10: t = -p n + mu (grad u + grad u^T).n. */
  for (int c = 0; c < 3; c++)
    t[c] = b->rho * (-p * n[c] + b->nu * (slope[c] + an * n[c] + turn[c]));
}

typedef void (*profile_fn)(const bw_probe *b, const bw_probe__reply *r, const double n[3],
                           double dl, const surface_motion *s, double t[3]);
static const profile_fn profile_of[BW_PROBE_PROFILES] = {
    [BW_PROBE_LINEAR] = linear_profile, [BW_PROBE_QUADRATIC] = quadratic_profile};

/* Replies of one set of tips to their ranks; traction of the points whose probes these are. */
static void probe_set(bw_probe *b, bw_probe__tips *t, bw_real *const u[3], const bw_real *p,
                      const double A[], double traction[])
{
  /* Read where the tips' cells are ... */
  bw_probe__at_tips(b, u, p, t->held, t->received, t->reply);
  /* ... and sent back to the ranks of the points. */
  if (t->plan != NULL) bw_exchange_backward(t->plan, sizeof *t->reply, t->reply, t->answer);
  for (size_t s = 0; s < t->n; s++) {
    const size_t i = t->from[s];
    /* This tip saw an obstacle; a shorter one of the same point is read instead. */
    if (!t->read[s]) continue;
    const surface_motion m = {row_of(b->V, i), row_of(b->spin, i), row_of(A, i)};
    profile_of[b->profile](b, &t->answer[s], b->normal + 3 * i, b->length[i], &m, traction + 3 * i);
  }
}

void bw_probe_traction(bw_probe *b, bw_real *const u[3], const bw_real *p, const double A[],
                       double traction[], unsigned char flag[])
{
  /* Blocked points keep zero. */
  if (b->n > 0) memset(traction, 0, 3 * b->n * sizeof *traction);
  /* Tips that only look for obstacles have no reading. */
  for (int t = 0; t < PROBE_SETS; t++)
    if (t != PROBE_NEAR) probe_set(b, &b->tips[t], u, p, A, traction);
  if (flag != NULL && b->n > 0) memcpy(flag, b->flag, b->n);
}
