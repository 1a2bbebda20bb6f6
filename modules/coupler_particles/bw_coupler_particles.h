/* bw_coupler_particles.h -- a solid in a fluid of particles: the time loop's recipe.
 *
 * The fluid meets the particles of the solid themselves (bw_ulph_body.h); what loads each is the
 * reaction of its pairs with the fluid. One step:
 *   load     F_n of the fluid at t_n on every solid particle, and its weight
 *   solid    K sub-steps of dt/K under that load, K the smallest whole number that is stable
 *   body     the fluid is told the places at t_n + dt and the mean velocities that led there
 *   fluid    kick, drift, one evaluation, kick: bw_ulph_step; the evaluation gives F_(n+1)
 *
 * The load. The fluid feels F_n half at the end of one step and half at the beginning of the next,
 * so that the solid should feel (F_n + F_(n+1))/2 through the step, of which the last part is not
 * known yet. It feels F_n and what it is still owed, dt/2 (F_n - F_(n-1)) per dt: the line through
 * the last two, which is right to second order, whatever the steps are. (F_n alone is of first
 * order: a light block that water hits then got a fifth more work than the water lost.) Impulses
 * dt F_n, which would keep the energy, make stiff solids ring at each step of the fluid.
 * Momentum: fluid + solid + what is owed, `pending`, is constant to round-off.
 * Work: the fluid's line `bodies` has -dt/2 (F_n + F_(n+1)).v of a step; the solid receives its
 * load times v: the difference is `late`, and given + late = received to round-off. (The solid's
 * own book counts forces with the mean velocities of its kicks: the same to second order in its
 * steps.)
 *
 *
 * Motions faster than the step. A mode of the solid with the frequency omega is seen by the fluid
 * at the ends of steps only; where omega dt is between pi and 2 pi it looks as if it ran backwards,
 * and a load that answers to that feeds it (bw_coupler.h, where it is derived). A virtual mass
 * stops it: through the sub-steps each wetted particle feels -(m_v/dt) (V - V_n), V_n its velocity
 * at t_n, which takes (m_v/2m) (1 - sin theta/theta), theta = omega dt, from every mode; m_v =
 * virtual_mass rho0 c0 dt times the wetted area of the particle, as in a step the answer to a
 * motion of the surface has come c0 dt far. What it takes is kept and comes back, a tenth with each
 * of the next loads: nothing is lost of a load that lasts for some tens of steps. (All of it with
 * the next load, as between a solid and a fluid on a grid, where the load is relaxed besides, was
 * not stable.)
 *
 * Units    as of fluid and solid, which agree; a solid of two dimensions may have a thickness.
 * Life     solid, bw_ulph_create -> create -> bw_ulph_start -> { step }* -> destroy -> the two.
 * Limits   one solid (of as many pieces as there are); the fluid does not see that a solid
 *          particle has been squeezed: it keeps its first volume. */
#pragma once
#include "bw_checkpoint.h"
#include "bw_solid.h"
#include "bw_ulph.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_coupler_particles bw_coupler_particles;

/* What a user chooses. */
typedef struct {
  double gravity[3];   /* on the solid [L/T^2]; that of the fluid's                   default 0 */
  double solid_safety; /* sub-step of the solid over its limit, in (0, 1]            default 0.8 */
  double virtual_mass; /* of wetted particles over rho0 c0 dt area, 0 .. 10          default 0.5 */
  double step_share;   /* of the step that the fluid would take alone, (0, 1]        default 0.4 */
  bool no_slip;        /* the fluid sticks to the solid                            default false */
} bw_coupler_particles_config;

bw_coupler_particles_config bw_coupler_particles_config_default(void); /* Local. */

/* Puts the solid into the fluid, which has not started, with the density rho0 and the spacing dx of
 * its configuration; walls (n_walls) are those that it was created with. All is borrowed until
 * destroy. BW_EINPUT: a value of the configuration by its name; different dimensions; errors of
 * bw_ulph_add_body. BW_EMEM. *out is NULL after a failure. Collective. */
bw_status bw_coupler_particles_create(const bw_coupler_particles_config *config,
                                      const bw_ulph_config *fluid_config, bw_ulph *fluid,
                                      bw_solid *solid, int n_walls, const bw_ulph_wall wall[],
                                      bw_coupler_particles **out) BW_MUST_CHECK;
void bw_coupler_particles_destroy(bw_coupler_particles **c); /* NULL is fine. Local. */

/* Hold the solid where it is (at first it is not), for the fluid to settle. Local. */
void bw_coupler_particles_hold(bw_coupler_particles *c, bool held);

/* Sub-steps that the solid takes in a step of dt [T], at least 1. Local. */
int bw_coupler_particles_substeps(const bw_coupler_particles *c, double dt);

/* Refuses a step of more than BW_COUPLER_PARTICLES_MOST_SUBSTEPS with BW_EINPUT, as the step itself
 * does. Local. */
#define BW_COUPLER_PARTICLES_MOST_SUBSTEPS 1000000
bw_status bw_coupler_particles_check_substeps(const bw_coupler_particles *c,
                                              double dt) BW_MUST_CHECK;

/* The step that is recommended now [T]: step_share of the fluid's: jets along a
 * plate that gives way were not stable at 0.6 and more. Collective. */
double bw_coupler_particles_dt_max(bw_coupler_particles *c);

/* Advance both by dt [T]. BW_ECFL, BW_EDIVERGED of either; BW_EMEM. Collective. */
bw_status bw_coupler_particles_step(bw_coupler_particles *c, double dt) BW_MUST_CHECK;

/* What went from one to the other since the start. */
typedef struct {
  double force[3];   /* of the fluid on the solid now [M L/T^2] */
  double impulse[3]; /* of the loads that the solid has received [M L/T] */
  double pending[3]; /* that the fluid has given and the solid is still to receive [M L/T] */
  double given;      /* work of the fluid on the solid, by its pairs [M L^2/T^2] */
  double late;       /* what the solid received beyond it, as loads come a step late */
  double received;   /* work of all loads but weight on the solid; given + late, to round-off */
  double wetted;     /* area [L^(d-1)] */
} bw_coupler_particles_report;
bw_coupler_particles_report bw_coupler_particles_measure(const bw_coupler_particles *c); /*
 * Collective. */

/* Load on each own particle of the solid at the end of the last step (n,3) [M L/T^2]; pressure of
 * the fluid on each (n), 0 where it is dry. Local; collective. */
void bw_coupler_particles_load(const bw_coupler_particles *c, double F[]);
void bw_coupler_particles_pressure(const bw_coupler_particles *c, double p[]);

/* Fluid, solid and what is between, to and from a checkpoint, under "fluid/", "solid/" and
 * "between/"; the run goes on to the last bit, on any number of ranks. Errors of bw_checkpoint.h;
 * BW_EINPUT for the checkpoint of another solid; BW_EMEM. Collective. */
bw_status bw_coupler_particles_save(bw_coupler_particles *c, bw_checkpoint *ck) BW_MUST_CHECK;
bw_status bw_coupler_particles_restore(bw_coupler_particles *c, bw_checkpoint *ck) BW_MUST_CHECK;

/* The same of a fluid without a solid. Collective. */
bw_status bw_coupler_particles_save_fluid(const bw_comm *comm, const bw_ulph *fluid,
                                          bw_checkpoint *ck) BW_MUST_CHECK;
bw_status bw_coupler_particles_restore_fluid(const bw_comm *comm, bw_ulph *fluid,
                                             bw_checkpoint *ck) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
