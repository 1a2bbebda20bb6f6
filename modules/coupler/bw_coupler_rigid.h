/* bw_coupler_rigid.h -- fluid and rigid bodies in one time loop.
 *
 * One step, the bodies at X_n while the fluid goes from t_n to t_{n+1}:
 *   fluid   three sub-steps: predict, no slip at the markers, project; the markers are the surface
 *           points of the bodies, on the true surface (bw_ibm_mdf_set_normals)
 *   load    the markers' reaction with the inertia of the fluid inside taken out:
 *             F = -rho sum Q dV + rho d/dt int_inside u dV
 *           (M. Uhlmann, J. Comput. Phys. 209 (2005) 448; T. Kempe and J. Froehlich, J. Comput.
 *           Phys. 231 (2012) 3663), the same for the torque about the centre of mass. What drives
 *           the fluid pushes the body, too, as the pressure that it stands for would: the fluid
 *           inside is driven like the rest. The integral is that of the velocity less the body's
 *           own, times the share of each cell inside, over the body, which moves: at t_{n+1} it is
 *           where V_n brings it.
 *   bodies  m V' = F + (m - rho V_body) g + springs, walls, contact: sub-steps of bw_rigid
 *
 * Added mass. The load is that of the step before, so that the added mass m_a of a light body would
 * be a negative damping. A virtual mass m_v = c rho V_body on both sides of the equation,
 *   (m + m_v) A_{n+1} = F_n + m_v A_n,
 * holds where m_v > (m_a - m)/2 and changes no steady motion (S. Schwarz, T. Kempe and J.
 * Froehlich, J. Comput. Phys. 281 (2015) 591); here it is a relaxation of the load by m/(m + m_v).
 * A sphere has m_a = rho V/2, a cylinder rho V; with c = 1 a cylinder holds at a hundredth of the
 * fluid's density (validation/coupler/rigid_fall).
 *
 * With a solid of particles in the same fluid, or in a loop of one's own, the phases are called one
 * by one: begin; force after each bw_ns_channel_predict; advance.
 * Life: create -> { step, or begin, 3 force, advance } -> destroy. Collective. */
#pragma once
#include "bw_coupler_films.h"
#include "bw_ibm_mdf.h"
#include "bw_ns_channel.h"
#include "bw_rigid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fluid, rigid bodies, and what joins them. Opaque. */
typedef struct bw_coupler_rigid bw_coupler_rigid;

/* What a user chooses. */
typedef struct {
  double rho;             /* density of the fluid [M/L^3]                 required */
  double nu;              /* its kinematic viscosity [L^2/T]              required */
  double gravity[3];      /* on bodies, less their buoyancy [L/T^2]       default 0 */
  double virtual_mass;    /* c above [-], >= 0                            default 1 */
  bw_ibm_mdf_config body; /* of the forcing; needs memory                 default that of ibm_mdf */
  bw_coupler_films films; /*                                              default none */
} bw_coupler_rigid_config;

/* rho and nu NaN. Pure. */
bw_coupler_rigid_config bw_coupler_rigid_config_default(void);

/* Bodies in the fluid where they are now. Their surface points are the markers, so that their
 * spacing should be about that of the grid and 1.5 times it at most. The weight is given here, not
 * to bw_rigid. Fluid and bodies are borrowed until destroy. BW_EINPUT names the value; also for
 * films whose roughness is above a cell, and for
 * points further apart than 1.5 grid spacings and for bodies smaller than four of them; BW_EMEM. */
bw_status bw_coupler_rigid_create(const bw_coupler_rigid_config *config, bw_ns_channel *fluid,
                                  bw_rigid *rigid, bw_coupler_rigid **out) BW_MUST_CHECK;
/* Releases everything and sets *coupler to NULL; NULL is fine. */
void bw_coupler_rigid_destroy(bw_coupler_rigid **coupler);

/* One step of dt [T] of fluid and bodies. Errors of bw_ns_channel_check and bw_rigid_step. */
bw_status bw_coupler_rigid_step(bw_coupler_rigid *coupler, double dt) BW_MUST_CHECK;

/* The phases of a step. begin: markers where the bodies are. force: no slip of the predicted
 * velocity, once in each sub-step. advance: load and motion of the bodies. */
bw_status bw_coupler_rigid_begin(bw_coupler_rigid *coupler) BW_MUST_CHECK;
void bw_coupler_rigid_force(bw_coupler_rigid *coupler, double dt);
bw_status bw_coupler_rigid_advance(bw_coupler_rigid *coupler, double dt) BW_MUST_CHECK;

/* What the fluid did to one body in the last step. */
typedef struct {
  double force[3];  /* of the fluid, without buoyancy [M L/T^2] */
  double torque[3]; /* about the centre of mass [M L^2/T^2] */
  double film[6];   /* force and torque of films beside that */
  double braking;   /* power that its films take, half of it of a film between two bodies
                       [M L^2/T^3] */
  double slip;      /* rms over the surface of what the markers' velocity lacks [L/T] */
  double flux;      /* through the surface, half of int |(u - V).n| dA [L^3/T] */
} bw_coupler_rigid_report;
/* report (bodies), the same on all ranks. */
bw_status bw_coupler_rigid_measure(bw_coupler_rigid *coupler,
                                   bw_coupler_rigid_report report[]) BW_MUST_CHECK;

/* What all films have taken since the start [M L^2/T^2], and the least gap of one in the last step
 * [L]; INFINITY: there was none. The same on all ranks. */
double bw_coupler_rigid_film_energy(const bw_coupler_rigid *coupler);
double bw_coupler_rigid_film_gap(const bw_coupler_rigid *coupler);
/* Goes on counting from there, after a restart. */
void bw_coupler_rigid_set_film_energy(bw_coupler_rigid *coupler, double energy);

/* What a restart needs beside the fluid and bw_rigid_save: the memory of the markers, M (n,3) in
 * the order of the surface points of this rank (bw_rigid_point_id says which they are), and the
 * load of the bodies, (bodies,6), the same on all ranks. set puts the markers where the bodies are.
 * Both are collective. */
void bw_coupler_rigid_get_state(bw_coupler_rigid *coupler, double M[], double load[]);
bw_status bw_coupler_rigid_set_state(bw_coupler_rigid *coupler, const double M[],
                                     const double load[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
