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
  BW_REQUIRE((int)c->kernel >= 0 && c->kernel < BW_KERNEL_COUNT, BW_EINPUT,
             "kernel: no row %d in the table of %d", (int)c->kernel, (int)BW_KERNEL_COUNT);
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
  bw_exchange_destroy(&b->plan);
  void *const arrays[] = {&b->point, &b->length, &b->flag,     &b->sent_from, &b->destination,
                          &b->item,  &b->answer, &b->received, &b->reply};
  for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
    bw_release(arrays[a]);
  bw_release(probe);
}

void bw_probe_set_obstacles(bw_probe *probe, const bw_real *solid)
{
  probe->obstacles = solid;
}

void bw_probe_set_velocity(bw_probe *probe, const double V[])
{
  probe->V = V;
}

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The traction over rho at a point of velocity V and acceleration A from what its tip saw.
 * Quadratic: with a = du/dn at the wall, grad u = a n + (derivatives along the wall), so the
 * tangential part of (grad u)^T.n is that of the tip (where it differs by O(dl^2)) and its normal
 * part is a.n; a rotating rigid body then feels none, as it must. */
static void assemble(const bw_probe *b, const bw_probe__reply *r, const double n[3], double dl,
                     const double V[3], const double A[3], double t[3])
{
  double dudn[3], gtn[3], lift = 0.0;
  memcpy(dudn, r->dudn, sizeof dudn);
  memcpy(gtn, r->gtn, sizeof gtn);
  if (b->profile == BW_PROBE_QUADRATIC) {
    for (int c = 0; c < 3; c++) {
      const double chord = (r->u[c] - V[c]) / dl;
      dudn[c] = 2.0 * chord - r->dudn[c];
      lift += 2.0 * (r->dudn[c] - chord) / dl * n[c]; /* d2u_n/dn2 */
    }
    const double change = dot(dudn, n) - dot(r->gtn, n);
    for (int c = 0; c < 3; c++)
      gtn[c] += change * n[c];
  }
  const double dpdn_wall = b->nu * lift - dot(A, n);
  const double p = r->p - 0.5 * dl * (dpdn_wall + r->dpdn);
  for (int c = 0; c < 3; c++)
    t[c] = b->rho * (-p * n[c] + b->nu * (dudn[c] + gtn[c]));
}

void bw_probe_traction(bw_probe *b, bw_real *const u[3], const bw_real *p, const double A[],
                       double traction[], unsigned char flag[])
{
  static const double zero[3] = {0.0, 0.0, 0.0};
  for (size_t q = 0; q < b->held; q++)
    b->reply[q] = bw_probe__at_tip(b, u, p, &b->received[q]);
  if (b->plan != NULL) bw_exchange_backward(b->plan, sizeof *b->reply, b->reply, b->answer);
  if (b->n > 0) memset(traction, 0, 3 * b->n * sizeof *traction);
  for (size_t s = 0; s < b->n_sent; s++) {
    const size_t i = b->sent_from[s];
    assemble(b, &b->answer[s], b->point[i].normal, b->length[i], b->V == NULL ? zero : b->V + 3 * i,
             A == NULL ? zero : A + 3 * i, traction + 3 * i);
  }
  if (flag != NULL && b->n > 0) memcpy(flag, b->flag, b->n);
}
