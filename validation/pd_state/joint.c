/* Two materials, and two laws, in one state-based body.
 *
 * Claim      A joint of two materials, or of two laws, carries the same traction on both sides,
 *            each side has its own modulus, and what the joint adds to the body's length is a part
 *            of a horizon.
 * Reference  series of two halves: under a strain along y each has sigma/M, M = lam + 2 mu; under a
 *            shear sigma_xy/mu.
 * Measured   a strip of 2 x 40 rows, periodic along x, its upper half five times as stiff, nu = 0.2
 *            below and 0.4 above, moved apart or sheared by its ends (linear solve), plane strain.
 *            Stress and strain in windows four horizons away from joint and ends; the excess length
 *            is what the ends' displacement leaves over the sum of both halves' strains, in units
 *            of horizon times the mean strain, ends' own share taken off by bodies of one law. Two
 *            laws: ordinary below, correspondence above, of the same material and of two. Also the
 *            largest force on a particle of that body of one material under a uniform strain.
 * Tolerance  traction: 1e-5, strain and residual. Strain against sigma/M: the lattice's own moduli,
 *            0.5 % for the ordinary law at m = 4 along the lattice (lps_moduli); 1e-5 for
 *            correspondence, whose stress of a homogeneous strain is exact. The excess is reported:
 *            bonds across the joint have the mean of both ends' stiffness, and two laws spread one
 *            stress differently over a family. Long waves are reflected by k times half of it.
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

/* The laws below and above, and the upper material. */
typedef struct {
  const char *name;
  int law[2]; /* of bw_solid_law_row */
  double E, nu;
} pairing;

/* only: -1, both halves as they are paired; else all of it as that half, of the lower material. */
static bw_status make(const bw_comm *comm, const pairing *p, int only, strip *s)
{
  enum { N = WIDE * 2 * HALF };
  bw_solid_config c = bw_solid_config_default();
  bw_pd_state_mixed_options o = bw_pd_state_mixed_options_default();
  int32_t site[N][3] = {{0}};
  uint8_t kind[N], group[N];
  c.geometry = BW_PD_PLANE_STRAIN, c.ds = c.rho = 1, c.E = 1, c.horizon_ratio = 4;
  c.choice.law = p->law[only > 0], c.nu = 0.2, c.period[0] = WIDE;
  c.more.n = 1;
  c.more.material[0] = (bw_pd_material){.rho = 1, .E = p->E, .nu = p->nu, .G0 = INFINITY};
  if (only < 0 && p->law[0] != p->law[1]) {
    o.correspondence_group[1] = true;
    c.choice.law = BW_SOLID_BOND;
    c.law = &bw_pd_state_mixed_law, c.law_options = &o;
  }
  for (int q = 0; q < N; q++) {
    site[q][0] = q % WIDE, site[q][1] = q / WIDE;
    const bool end = site[q][1] < ENDS + 1 || site[q][1] >= 2 * HALF - ENDS - 1;
    kind[q] = end ? BW_PD_PRESCRIBED : BW_PD_FREE;
    group[q] = only < 0 && site[q][1] >= HALF;
  }
  BW_TRY(bw_solid_create(comm, &c, &(bw_pd_sites){N, site[0], kind, group}, &s->pd));
  return body_rows_make(s->pd, &s->r);
}

static void release(strip *s)
{
  body_rows_release(&s->r);
  bw_solid_destroy(&s->pd);
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

/* What an end adds in a body of one law, in rows: 2 HALF STRAIN is the sum of strains times rows
 * and both ends. */
static bw_status end_rows(bw_validation *v, const pairing *p, size_t d, double rows, double end[2])
{
  for (int side = 0; side < 2; side++) {
    strip one = {0};
    double b[4];
    BW_TRY(make(bw_validation_comm(v), p, side, &one));
    BW_TRY(pull(&one, d, b));
    end[side] = STRAIN * HALF / b[0] - rows;
    release(&one);
  }
  return BW_OK;
}

static bw_status joint(bw_validation *v, const pairing *p)
{
  strip two = {0};
  double lam[2], mu[2];
  state_lame(BW_PD_PLANE_STRAIN, 1, 0.2, &lam[0], &mu[0]);
  state_lame(BW_PD_PLANE_STRAIN, p->E, p->nu, &lam[1], &mu[1]);
  BW_TRY(make(bw_validation_comm(v), p, -1, &two));
  for (size_t d = 0; d < 2; d++) {
    const double rows = HALF - ENDS - 0.5; /* free ones per half */
    double a[4], end[2];
    char extra[160];
    BW_TRY(pull(&two, d, a));
    BW_TRY(end_rows(v, p, d, rows, end));
    snprintf(extra, sizeof extra, "\"law\": \"%s\", \"E_ratio\": %g, \"load\": \"%s\"", p->name,
             p->E, d == 1 ? "pull" : "shear");
    state_claim(v, "a joint carries one traction", "stress_ratio", a[3] / a[1], 1, 1e-5,
                BW_ANALYTIC, "equilibrium", extra);
    for (int side = 0; side < 2; side++) {
      const double M = d == 1 ? lam[side] + 2 * mu[side] : mu[side];
      state_claim(v, "each side has its own modulus", side == 0 ? "below" : "above",
                  a[2 * side + 1] / (M * a[2 * side]), 1,
                  p->law[side] == BW_SOLID_ORDINARY ? 0.01 : 1e-5, BW_ANALYTIC,
                  "isotropic elasticity", extra);
    }
    const double halves = (rows + end[0]) * a[0] + (rows + end[1]) * a[2];
    const double excess = (STRAIN * 2 * HALF - halves) / (0.5 * (a[0] + a[2]));
    state_claim(v, "a joint adds some length", "excess_over_horizon", excess / 4, 0, INFINITY,
                BW_ANALYTIC, "series", extra);
  }
  release(&two);
  return BW_OK;
}

/* The largest force on a free particle under a uniform strain along y, times the horizon over E
 * strain. */
static bw_status ghost(bw_validation *v, const pairing *p)
{
  strip s = {0};
  double most = 0;
  BW_TRY(make(bw_validation_comm(v), p, -1, &s));
  for (size_t k = 0; k < 3 * bw_solid_count(s.pd); k++)
    s.r.X[k] = (k % 3 == 1 ? 1 + STRAIN : 1) * s.r.X0[k];
  bw_solid_set_state(s.pd, s.r.X, s.r.V);
  BW_TRY(bw_solid_evaluate(s.pd));
  bw_solid_get_acceleration(s.pd, s.r.F);
  for (size_t i = 0; i < bw_solid_count(s.pd); i++)
    if (!(bw_solid_kind(s.pd)[i] & BW_PD_PRESCRIBED)) most = fmax(most, fabs(s.r.F[3 * i + 1]));
  state_claim(v, "a joint of two laws has forces under a uniform strain",
              "force_times_horizon_over_E_strain", 4 * most / STRAIN, 0, INFINITY, BW_ANALYTIC,
              "patch test", "\"E_ratio\": 1");
  release(&s);
  return BW_OK;
}

static bw_status run(bw_validation *v)
{
  enum { O = BW_SOLID_ORDINARY, C = BW_SOLID_CORRESPONDENCE };
  static const pairing pairs[] = {{"ordinary", {O, O}, 5, 0.4},
                                  {"correspondence", {C, C}, 5, 0.4},
                                  {"ordinary and correspondence", {O, C}, 5, 0.4},
                                  {"ordinary and correspondence", {O, C}, 1, 0.2}};
  for (int q = 0; q < 4; q++)
    BW_TRY(joint(v, &pairs[q]));
  return ghost(v, &pairs[3]);
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "pd_state.joint", run);
}
