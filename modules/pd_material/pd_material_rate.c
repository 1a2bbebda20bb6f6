/* Materials that yield: the rate form of one step, and the return to the cone. */
#include "pd_material_internal.h"

#include <string.h>

static const double SQRT3 = 1.73205080756887729353;

bw_pd_material_yield bw_pd_material_drucker_prager(bw_pd_material_cone cone, double cohesion,
                                                   double friction, double dilation)
{
  /* alpha = a sin(phi) and k = b c cos(phi) with factors of each cone; the third has tangents. */
  const double angle[2] = {friction, dilation};
  double alpha[2], strength = 0;
  for (int q = 1; q >= 0; q--) {
    const double s = sin(angle[q]), c = cos(angle[q]), t = tan(angle[q]);
    const double root = sqrt(9 + 12 * t * t);
    const double slope[] = {2 * s / (SQRT3 * (3 - s)), 2 * s / (SQRT3 * (3 + s)), t / root, s / 3};
    const double k[] = {6 * c / (SQRT3 * (3 - s)), 6 * c / (SQRT3 * (3 + s)), 3 / root, c};
    alpha[q] = slope[cone];
    strength = cohesion * k[cone];
  }
  return (bw_pd_material_yield){.alpha = alpha[0], .k = strength, .dilatancy = alpha[1]};
}

bw_pd_material_yield bw_pd_material_j2(double yield_stress, double hardening_modulus)
{
  /* sqrt(J2) is the uniaxial stress over sqrt 3; the equivalent strain the factor over sqrt 3. */
  return (bw_pd_material_yield){.k = yield_stress / SQRT3, .hardening = hardening_modulus / 3};
}

static void full(const double s[6], double S[9])
{
  const double all[9] = {s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2]};
  memcpy(S, all, sizeof all);
}

static void gradient(const double H[9], double F[9])
{
  for (int q = 0; q < 9; q++)
    F[q] = H[q] + (q % 4 == 0);
}

/* P = sigma cof F; returns the elastic energy J sigma:C^-1:sigma/2 per reference volume. */
static double piola(const bw_pd_material_point *m, const double H[9], const double s[6],
                    double P[9])
{
  double F[9], C[9], S[9];
  gradient(H, F);
  COFACTORS(F, C);
  full(s, S);
  PRODUCT(S, C, P);
  const double J = DETERMINANT(F, C), K = m->lam + 2 * m->mu / 3;
  const double mean = (s[0] + s[1] + s[2]) / 3;
  double deviator = 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
  for (int k = 0; k < 3; k++)
    deviator += (s[k] - mean) * (s[k] - mean);
  return J * (deviator / (4 * m->mu) + mean * mean / (2 * K));
}

/* 1 + (1 - part w)^-1 w' : the Cayley rotation of the spin w (skew) by `part` of itself on each
 * side. With the axial vector a of w, (1 - pw)^-1 = (1 + p w + p^2 a a)/(1 + p^2 a.a). */
static void cayley(const double w[9], double part, double R[9])
{
  const double a[3] = {part * w[7], part * w[2], part * w[3]};
  const double a2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      R[3 * i + j] = ((i == j) * (1 - a2) + 2 * a[i] * a[j] + 2 * part * w[3 * i + j]) / (1 + a2);
}

/* out = R A R^T */
static void turn(const double R[9], const double A[9], double out[9])
{
  double half[9], T[9];
  PRODUCT(R, A, half);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      T[3 * i + j] = R[3 * j + i];
  PRODUCT(half, T, out);
}

/* The trial stress of a step from H0 to H1: ULPH 37-46, the increment turned by half. */
static void trial(const bw_pd_material_point *m, const double H0[9], const double H1[9],
                  const double s0[6], double s[6])
{
  double dF[9], middle[9], C[9], G[9], D[9], w[9], R[9], S[9], turned[9], rise[9];
  for (int q = 0; q < 9; q++) {
    dF[q] = H1[q] - H0[q];
    middle[q] = 0.5 * (H0[q] + H1[q]) + (q % 4 == 0);
  }
  /* G = dF F^-1 at the middle, F^-1 = cof^T/J. */
  COFACTORS(middle, C);
  const double J = DETERMINANT(middle, C);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      G[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        G[3 * i + j] += dF[3 * i + k] * C[3 * j + k] / J;
    }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      D[3 * i + j] = 0.5 * (G[3 * i + j] + G[3 * j + i]);
      w[3 * i + j] = 0.5 * (G[3 * i + j] - G[3 * j + i]);
    }
  /* What there was turns by all of the spin, what comes by half of it. */
  full(s0, S);
  cayley(w, 0.5, R);
  turn(R, S, turned);
  HOOKE(m->lam, m->mu, D, S);
  cayley(w, 0.25, R);
  turn(R, S, rise);
  for (int q = 0; q < 9; q++)
    S[q] = turned[q] + rise[q];
  const double out[6] = {S[0], S[4], S[8], S[5], S[2], S[1]};
  memcpy(s, out, sizeof out);
}

/* Back to the cone from outside; returns the growth of the flow's factor. */
static double back(const bw_pd_material_point *m, double flow, double s[6])
{
  const bw_pd_material_yield *y = &m->yield;
  const double K = m->lam + 2 * m->mu / 3, mean = (s[0] + s[1] + s[2]) / 3;
  double d[6], J2 = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = s[k] - mean;
    d[3 + k] = s[3 + k];
    J2 += 0.5 * d[k] * d[k] + d[3 + k] * d[3 + k];
  }
  /* Inside the cone nothing flows. */
  const double q = sqrt(J2), k = y->k + y->hardening * flow, f = q + 3 * y->alpha * mean - k;
  if (!(f > 0)) return 0;
  /* sqrt(J2) falls by mu and I1 by 9 K dilatancy per factor: the cone is straight. */
  double dl = f / (m->mu + 9 * K * y->alpha * y->dilatancy + y->hardening);
  double scale = q > 0 ? 1 - m->mu * dl / q : 0, new_mean = mean - 3 * K * y->dilatancy * dl;
  if (scale < 0 || q == 0) {
    /* The deviator would turn: the apex of what has hardened until then. */
    dl = q / m->mu;
    scale = 0;
    if (y->alpha > 0) new_mean = (k + y->hardening * dl) / (3 * y->alpha);
  }
  for (int c = 0; c < 6; c++)
    s[c] = scale * d[c] + (c < 3 ? new_mean : 0);
  return dl;
}

/* Stress at H1 with what the cone allows; returns the growth of the flow's factor. */
static double stress_at(const bw_pd_material_point *m, const double H0[9], const double s0[6],
                        double flow, const double H1[9], double s[6])
{
  trial(m, H0, H1, s0, s);
  return back(m, flow, s);
}

/* F33 of plane stress: sigma33 rises with it, by lam + 2 mu at most; the secant's steps are kept
 * between what is known to be too thin and too thick. */
static void thin(const bw_pd_material_point *m, const double H0[9], const double s0[6], double flow,
                 double H1[9])
{
  /* Where the sides move by the elastic law is a good start. */
  double s[6], low = -1 + 1e-3, high = 1e3, before = 0, last = 0;
  double x = H0[8] - m->lam / (m->lam + 2 * m->mu) * (H1[0] - H0[0] + H1[4] - H0[4]);
  for (int pass = 0; pass < 200; pass++) {
    H1[8] = x;
    stress_at(m, H0, s0, flow, H1, s);
    if (fabs(s[2]) <= 1e-13 * m->mu) return;
    if (s[2] > 0) high = fmin(high, x);
    if (s[2] < 0) low = fmax(low, x);
    /* The first step takes the elastic slope, which is the steepest. */
    const bool known = pass > 0 && s[2] != last && x != before;
    const double slope = known ? (s[2] - last) / (x - before) : m->lam + 2 * m->mu;
    double next = x - s[2] / slope;
    if (!(next > low && next < high)) next = 0.5 * (fmax(low, x - 1) + fmin(high, x + 1));
    if (fabs(next - x) < 1e-16 * (1 + fabs(x))) return;
    before = x, last = s[2], x = next;
  }
}

static void get(const bw_pd_material_lanes *from, int n, int lane, double to[])
{
  for (int q = 0; q < n; q++)
    to[q] = from[q][lane];
}

static void put(const double from[], int n, int lane, bw_pd_material_lanes *to)
{
  for (int q = 0; q < n; q++)
    to[q][lane] = from[q];
}

/* One point of a step. */
static void rate_one(const bw_pd_material_point *m, const bw_pd_material_state *old, int lane,
                     double H[9], bw_pd_material_state *next, lanes P[9], lanes *W)
{
  double H0[9], s0[6], s[6], P0[9], P1[9];
  const double flow = old->flow[lane];
  get(old->H, 9, lane, H0);
  get(old->sigma, 6, lane, s0);
  if (m->plane != BW_PD_MATERIAL_SPACE) H[2] = H[5] = H[6] = H[7] = H[8] = 0;
  if (m->plane == BW_PD_MATERIAL_PLANE_STRESS) thin(m, H0, s0, flow, H);
  next->flow[lane] = flow + stress_at(m, H0, s0, flow, H, s);
  /* The book: work by the mean of both stresses, less what is stored. */
  const double before = piola(m, H0, s0, P0), after = piola(m, H, s, P1);
  double work = 0;
  for (int q = 0; q < 9; q++)
    work += 0.5 * (P0[q] + P1[q]) * (H[q] - H0[q]);
  next->dissipated[lane] = old->dissipated[lane] + work - (after - before);
  put(H, 9, lane, next->H);
  put(s, 6, lane, next->sigma);
  put(P1, 9, lane, P);
  if (W != NULL) (*W)[lane] = after;
}

void bw_pd_material_rate(const bw_pd_material_point *m, const bw_pd_material_state *old,
                         const bw_pd_material_lanes H[9], bw_pd_material_state *next,
                         bw_pd_material_lanes P[9], bw_pd_material_lanes *W)
{
  for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++) {
    double one[9];
    get(H, 9, lane, one);
    rate_one(m, old, lane, one, next, P, W);
  }
}

void bw_pd_material_state_stress(const bw_pd_material_point *m, const bw_pd_material_state *state,
                                 bw_pd_material_lanes P[9], bw_pd_material_lanes *W)
{
  for (int lane = 0; lane < BW_PD_MATERIAL_LANES; lane++) {
    double H[9], s[6], one[9];
    get(state->H, 9, lane, H);
    get(state->sigma, 6, lane, s);
    const double w = piola(m, H, s, one);
    if (P != NULL) put(one, 9, lane, P);
    if (W != NULL) (*W)[lane] = w;
  }
}
