/* bw_solid_static.h -- states at rest: adaptive dynamic relaxation, linear small-strain solve.
 *
 *   0 = L + F on every free particle; prescribed ones stay where they are.
 * Residual: |L + F| over the free particles divided by the larger of |F| and |L + F| over the
 * prescribed ones (the reactions; at least as large as before bonds broke), or, when both are zero,
 * by its first value; norms are roots of sums of squares. A body with contact is refused.
 *
 * Relaxation (Underwood, in Belytschko & Hughes 1983; Kilic & Madenci 2010): central differences
 * with unit step and fictitious masses m_h, the law's row sums (of bonds
 * m_h = 1/2 sum_l c0 alpha Gamma V_l/|xi|; Gershgorin: no frequency of the fictitious body is above
 * the limit 2 of the scheme), damped by
 * c = 2 sqrt(v.Kv/v.mv), the Rayleigh quotient of the present motion: K v is the change of the
 * force in the last step, so no diagonal stand-in for K is needed.
 * Linear: K u = F with K the law's tangent at the reference positions (of bonds
 * K = sum c0 alpha Gamma V/|xi| e (x) e of those that hold), by conjugate gradients with the same
 * masses as preconditioner. */
#pragma once
#include "bw_solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* When a state counts as at rest. */
typedef struct {
  double tolerance;   /* on the residual [-], 0 .. 1; above rounding    default 1e-6 */
  int max_iterations; /* force evaluations, of each equilibrium         default 100000 */
  bool breaks;        /* break what is beyond its limit when at rest and relax again, until nothing
                         breaks; not by the linear solve                default false */
} bw_solid_static_config;

/* The defaults. Local. */
bw_solid_static_config bw_solid_static_config_default(void);

/* What it took. */
typedef struct {
  int64_t iterations; /* force evaluations (relaxation) or products with K (linear) in all */
  double residual;    /* reached [-]; NaN: nothing was done */
  int64_t broken;     /* undirected bonds broken on the way, of all ranks */
} bw_solid_static_report;

/* Move the particles to rest under the force of set_force; velocities are zero afterwards. The
 * ledger's running sums do not count this work but for fracture. Damping is not used. BW_EINPUT for
 * a body with contact and for the configuration; BW_EDIVERGED when max_iterations do not reach the
 * tolerance (report: how far they came; the state is the last one); BW_EMEM. Collective. */
bw_status bw_solid_static_relax(bw_solid *solid, const bw_solid_static_config *config,
                                bw_solid_static_report *report) BW_MUST_CHECK;

/* U (n,3) [L]: on entry the displacement of the prescribed particles (rows of others: where to
 * start from), on exit of all, under the force of set_force. The object's state is not changed.
 * Errors as above. Collective. */
bw_status bw_solid_static_linear(bw_solid *solid, const bw_solid_static_config *config, double U[],
                                 bw_solid_static_report *report) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
