/* Two materials in one state-based body.
 *
 * Claim      A joint of two materials carries the same traction on both sides, each side has its
 *            own modulus, and what the joint adds to the body's length is a part of a horizon.
 * Reference  series of two halves: under a strain along y each has sigma/M, M = lam + 2 mu; under a
 *            shear sigma_xy/mu.
 * Measured   a strip of 2 x 40 rows, periodic along x, its upper half five times as stiff, nu = 0.2
 *            below and 0.4 above, moved apart or sheared by its ends (linear solve), plane strain.
 *            Stress and strain in windows four horizons away from joint and ends; the excess length
 *            is what the ends' displacement leaves over the sum of both halves' strains, in units
 *            of horizon times the mean strain, ends' own share taken off by a body of one material.
 * Tolerance  traction: 1e-5, strain and residual. Strain against sigma/M: the lattice's own moduli,
 *            0.5 % for the ordinary law at m = 4 along the lattice (lps_moduli); 1e-5 for
 *            correspondence, whose stress of a homogeneous strain is exact. The excess is reported:
 *            bonds across the joint have the mean of both ends' stiffness.
 * BUILD modules=solid,solid_tools
 * TEST  ranks=1 */
#include "state.h"

enum { HALF = 40, WIDE = 10, ENDS = 4 };
static const double STRAIN = 1e-6;

/* Rows of one strip: where its halves meet is the middle. */
typedef struct {
  bw_solid *pd;
  body_rows r;
} strip;

static bw_status make(const bw_comm *comm, int law, bool joined, strip *s)
{
  enum { N = WIDE * 2 * HALF };
  bw_solid_config c = bw_solid_config_default();
  int32_t site[N][3] = {{0}};
  uint8_t kind[N], group[N];
  c.geometry = BW_PD_PLANE_STRAIN, c.ds = c.rho = 1, c.E = 1, c.horizon_ratio = 4;
  c.choice.law = law, c.choice.poisson_ratio = 0.2, c.period[0] = WIDE;
  c.more.n = 1;
  c.more.material[0] = (bw_pd_material){.rho = 1, .E = 5, .nu = 0.4, .G0 = INFINITY};
  for (int q = 0; q < N; q++) {
    site[q][0] = q % WIDE, site[q][1] = q / WIDE;
    const bool end = site[q][1] < ENDS + 1 || site[q][1] >= 2 * HALF - ENDS - 1;
    kind[q] = end ? BW_PD_PRESCRIBED : BW_PD_FREE;
    group[q] = joined && site[q][1] >= HALF;
  }
  BW_TRY(bw_solid_create(comm, &c, &(bw_pd_sites){N, site[0], kind, group}, &s->pd));
  return body_rows_make(s->pd, &s->r);
}

/* Rest with the ends moved along `d`: out is strain and stress below, then above. */
static bw_status pull(strip *s, size_t d, double out[4])
{
  const double far = 1e9;
  const double from[2] = {HALF - 20, HALF + 17}, to[2] = {HALF - 17, HALF + 20};
  for (size_t i = 0; i < bw_solid_count(s->pd); i++) {
    const bool upper = s->r.X0[3 * i + 1] > HALF;
    for (size_t k = 0; k < 3; k++)
      s->r.X[3 * i + k] =
          k == d && bw_solid_kind(s->pd)[i] & BW_PD_PRESCRIBED && upper ? STRAIN * 2 * HALF : 0;
  }
  BW_TRY(body_at_rest(s->pd, &s->r));
  for (int side = 0; side < 2; side++) {
    const double low[3] = {-far, from[side], -far}, high[3] = {far, to[side], far};
    /* The slope of u over three rows; the stress across y. */
    double u[2];
    for (int e = 0; e < 2; e++) {
      const double at = e == 0 ? from[side] : to[side] - 1;
      for (size_t i = 0; i < bw_solid_count(s->pd); i++)
        s->r.F[i] = s->r.X[3 * i + d] - s->r.X0[3 * i + d];
      u[e] = body_mean(s->pd, s->r.X0, (double[3]){-far, at, -far}, (double[3]){far, at + 1, far},
                       s->r.F, 1);
    }
    out[2 * side] = (u[1] - u[0]) / (to[side] - 1 - from[side]);
    out[2 * side + 1] = body_mean(s->pd, s->r.X0, low, high, s->r.stress + (d == 1 ? 1 : 5), 6);
  }
  return BW_OK;
}

static bw_status joint(bw_validation *v, int law)
{
  strip two = {0}, one = {0};
  double lam[2], mu[2];
  state_lame(BW_PD_PLANE_STRAIN, 1, 0.2, &lam[0], &mu[0]);
  state_lame(BW_PD_PLANE_STRAIN, 5, 0.4, &lam[1], &mu[1]);
  BW_TRY(make(bw_validation_comm(v), law, true, &two));
  BW_TRY(make(bw_validation_comm(v), law, false, &one));
  for (size_t d = 0; d < 2; d++) {
    double a[4], b[4];
    char extra[120];
    BW_TRY(pull(&two, d, a));
    BW_TRY(pull(&one, d, b));
    snprintf(extra, sizeof extra, "\"law\": \"%s\", \"load\": \"%s\"",
             law == BW_SOLID_ORDINARY ? "ordinary" : "correspondence", d == 1 ? "pull" : "shear");
    state_claim(v, "a joint carries one traction", "stress_ratio", a[3] / a[1], 1, 1e-5,
                BW_ANALYTIC, "equilibrium", extra);
    for (int side = 0; side < 2; side++) {
      const double M = d == 1 ? lam[side] + 2 * mu[side] : mu[side];
      state_claim(v, "each side has its own modulus", side == 0 ? "below" : "above",
                  a[2 * side + 1] / (M * a[2 * side]), 1, law == BW_SOLID_ORDINARY ? 0.01 : 1e-5,
                  BW_ANALYTIC, "isotropic elasticity", extra);
    }
    /* Free rows per half, and what the ends add in a body of one material: 2 HALF STRAIN is the sum
     * of strains times rows, ends and joint. */
    const double rows = HALF - ENDS - 0.5, total = STRAIN * 2 * HALF;
    const double ends = total / b[0] - 2 * rows;
    const double excess = (total - (rows + 0.5 * ends) * (a[0] + a[2])) / (0.5 * (a[0] + a[2]));
    state_claim(v, "a joint adds some length", "excess_over_horizon", excess / 4, 0, INFINITY,
                BW_ANALYTIC, "series", extra);
  }
  body_rows_release(&two.r);
  body_rows_release(&one.r);
  bw_solid_destroy(&two.pd);
  bw_solid_destroy(&one.pd);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  BW_TRY(joint(v, BW_SOLID_ORDINARY));
  return joint(v, BW_SOLID_CORRESPONDENCE);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.joint", run);
}
