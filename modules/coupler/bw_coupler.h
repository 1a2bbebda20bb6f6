/* bw_coupler.h -- the only place where fluid and solid meet: the time loop's recipe.
 *
 * One step (POROUS 4.3, ERRATA 7, 10, 18, 19):
 *   fluid    three sub-steps: predict, force no slip at the markers, project
 *   load     probes give the traction t on each surface particle; F_h = t A_h/V_h
 *   solid    K sub-steps of dt/K, K the smallest whole number that keeps the solid stable
 *   surface  interface, markers, probe points follow the solid
 *
 * Added mass. The fluid answers to a jump of the surface's velocity with a force -g_k dV/dt in step
 * k after it (sum g_k = m_a; projection undoes part of what forcing did, so the answer takes
 * several steps, however short they are). The load is therefore relaxed, F' = (1 - w) F + w (load
 * of the flow): steady loads are exact, motions faster than dt/w see a filtered load. What holds
 * are the w for which m a_{n+1} = F'_n, F_n = -sum_k g_k a_{n-k} does not grow; all of g at once
 * would give w < 2/(1 + m_a/m). docs/verification/coupler has limits as measured. w = 1 is POROUS's
 * plain explicit scheme. The late load feeds the shortest waves of the lattice: give the solid some
 * damping_mean.
 *
 * Motions faster than the step. The fluid sees one sample of the surface's velocity per step. An
 * elastic mode of frequency omega, theta = omega dt, whose surface has mass m and added mass G,
 * goes by z^2 - 2 z cos theta + 1 + (sin theta/theta) (z - 1)^2 H(z)/(m z) = 0 with
 * H = w G/(1 - (1 - w)/z), so that it grows by (1 - cos theta)/(theta m) Im(H e^{-i theta}) a step:
 * about -(w G/2m) sin theta/theta. Modes with pi < theta < 2 pi, which look like slower ones that
 * run backwards, are fed, and so are those next to pi, where the late answer swings with the step:
 * most of all thin tips, which carry the most fluid for their own mass. A virtual mass m_v on the
 * solid's side stops it: through the step the surface feels F' - (m_v/dt) (V - V_n), V_n what the
 * fluid was told, which takes (m_v/2m) (1 - sin theta/theta) from every mode whatever theta is.
 * What it takes is owed: its mean joins the next load before that is relaxed, so that nothing is
 * lost of a steady load or a steady acceleration. (That feeds slow modes by w/2 of what the relaxed
 * load takes from them. No passive scheme can vanish for steady acceleration: its impedance would
 * have a double zero.) m_v = virtual_mass w rho A h, A the particle's area: in one step neither
 * markers nor probes reach farther than about a cell, so that tips have as much as they need.
 * With a `predictor` the fluid is told the mean velocity over the step instead, that of the solid
 * under the load it felt last: every mode is damped, by w G (1 - cos theta)/(theta^2 m) a step, and
 * no virtual mass is needed (predictor.c). It costs the solid's sub-steps a second time, and light
 * bodies, which swing with the step, hold half the w. Measured: validation, coupler.fast_modes.
 *
 * What holds. The first explicit step measures the limit of w where load_relaxation is left open
 * (NaN): power iteration over "velocity of the surface, load of the fluid, answer of the solid in
 * one step" finds the shapes that the fluid resists most, their answers over forty steps and the
 * recurrence above the limit; a trial with a rough disturbance may lower it (stability.c). Half of
 * it is taken, 0.1 at most, 0.3 with a predictor. Chosen anew when 2 % of the bonds have broken
 * since, or the step is another by half. What was chosen is part of a checkpoint.
 *
 * Iterated coupling (coupling_iterations > 1), for light solids: the step is repeated, from the
 * same state, until the surface moves as the markers were told to, to the residual. The next try's
 * velocity is that of a quasi-Newton step (IQN-ILS, iterate.c); what earlier tries do not tell is
 * relaxed by load_relaxation (0.1; smaller for light plates, whose first tries overshoot most). The
 * load is the whole load of the same step, without the inertia of the fluid inside, which the
 * reaction holds; it has to be that of the motion, too. Markers stay where the
 * surface was at its beginning.
 *
 * Pressure on the surface: forcing acts with the full dt, pressure with gamma_r dt, so that the
 * pressure swings between the sub-steps; what acted over the step is sum_r gamma_r p_r, and that is
 * what the probes read (the pressure conjugate to ERRATA 18's mean force).
 *
 * Where the surface is: a particle is a cube of edge ds, so the nominal surface is the mean height
 * of its open sides, ds/(2 sum_d |n_d|) outside its centre along its normal, ds/2 on a side of the
 * lattice (ERRATA 33). Probes start there. Where it is curved, smooth and whole, markers with
 * memory stand there too and know the normal (bw_ibm_mdf_set_normals); elsewhere, or with a
 * `retraction`, they sit so many grid spacings inside (ERRATA 21), the same on flat faces.
 *
 * What markers remember (bw_ibm_mdf.h) is kept per particle: a block's memory is the sum over its
 * members, and goes back to them in shares of area. Particles that lost a bond have none: faces of
 * a crack may ask for two velocities in the same cells, which a memory would push against for ever.
 *
 * How many markers: one per surface particle, or, where particles are finer than the grid (FSI's
 * plate: ds = h/5, every fifth particle a marker), one per block of k^(dim-1) particles of a face,
 * k = marker_spacing h/ds: at their mean position, with their mean velocity and the sum of their
 * areas. The reaction goes back in shares of area, so that force, torque and power are those of the
 * markers. Particles that lost a bond, and new crack faces, keep markers of their own. Every
 * surface particle has its own probe in any case.
 *
 * Free bodies. With contact on in the solid, sides of the fluid that are walls, free-slip or inflow
 * are walls to the particles (bw_solid_set_walls); what moves through a periodic side goes on; a
 * piece passes an outflow, meets the fluid with the part that is still inside, and is retired
 * (bw_solid_retire) when all of it has passed. Fluid pressure is without its hydrostatic part, so
 * bodies weigh (rho_s - rho) g.
 *
 * The solid can be held (rigid): then no solid step, no load, no surface update is computed.
 * Life: config_default -> create -> { step } -> destroy. All functions are collective unless said
 * otherwise. */
#pragma once
#include "bw_checkpoint.h"
#include "bw_coupler_films.h"
#include "bw_coupler_rigid.h"
#include "bw_ibm_mdf.h"
#include "bw_log.h"
#include "bw_ns_channel.h"
#include "bw_pd_interface.h"
#include "bw_probe.h"
#include "bw_solid.h"
#include "bw_timer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fluid, solid, and what joins them. Opaque. */
typedef struct bw_coupler bw_coupler;

/* What loads the solid: the stress that probes see on the surface (POROUS 3.96), or the reaction
 * of the markers, -rho Q dV (FSI with ERRATA 18). Probes need two cells of room in front of the
 * surface and give a stress; the reaction is right in sum by construction, also in gaps of a few
 * cells, and holds the inertia of the fluid inside the body. */
typedef enum {
  BW_LOAD_PROBES,  /* stress of the fluid at normal probes */
  BW_LOAD_REACTION /* reaction of the markers */
} bw_coupler_load_kind;

/* What a user chooses; lengths in grid spacings are those of x. */
typedef struct {
  double rho;                /* density of the fluid [M/L^3]                required */
  double nu;                 /* its kinematic viscosity [L^2/T]             required */
  bw_kernel_delta_id kernel; /* of the forcing; probes use Roma's           default Roma 3-point */
  int iterations;            /* forcing iterations [-]                      default 1 */
  double memory;             /* of the markers (bw_ibm_mdf.h), 0 .. 0.5 [-]; 0: none, which asks
                                for two iterations or more                  default 0.2 */
  double retraction;         /* of the markers, in grid spacings [-]; NaN: none on smooth curved
                                surfaces (above), elsewhere and without memory that of
                                bw_ibm_mdf_retraction                       default NaN */
  double marker_spacing;     /* along the surface, in grid spacings, at most (whole particles);
                                0: every surface particle is a marker   default 0 */
  double probe_length;       /* in grid spacings [-]                        default 2 */
  bw_probe_profile
      probe_profile;         /* of the velocity along a probe               default quadratic */
  double solid_safety;       /* solid sub-step over its limit, 0 .. 1 [-]   default 0.8 */
  bw_coupler_load_kind load; /*                                             default probes */
  double load_relaxation;    /* share of the new load in each step, (0, 1]; NaN: chosen by what the
                                first coupled step measures ("What holds" below)
                                                                            default NaN */
  bool check_relaxation;     /* measure what holds also where load_relaxation is given
                                (bw_coupler_tell_limit)                     default false */
  bool predictor;            /* tell the fluid how the solid would move in the step under its last
                                load, by its sub-steps once more; no virtual mass then
                                                                            default false */
  double virtual_mass;       /* of the surface, over w rho A h; 0: none [-]   default 1 */
  int coupling_iterations;   /* at most, per step; 1: explicit              default 1 */
  double coupling_residual;  /* iterated: what the surface's velocity lacks of a fixed point, over
                                its norm, that ends it; of the load its square root [-]
                                                                            default 1e-4 */
  double gravity[3];         /* on solid and fluid [L/T^2]                  default 0 */
  bool check_book;   /* stop when fluid and solid no longer exchange work as bodies do, with what
                        and since when (book.c, BW_EDIVERGED)              default true */
  bool count_work;   /* work_given, work_late of the report (an exchange a step) default false */
  bool walled[3][2]; /* [direction][lower, upper]: sides of the box the solid leans on, where it
                        has no surface                                     default false */
  bw_coupler_films films; /* between faces of the solid, and walls           default none */
} bw_coupler_config;

/* Defaults as above, rho and nu NaN. Pure. */
bw_coupler_config bw_coupler_config_default(void);

/* `fluid` and `solid` are borrowed until destroy; the fluid's grid must be uniform with a halo of
 * 2. The solid starts held. BW_EINPUT (message names the value), BW_EMEM. Collective. */
bw_status bw_coupler_create(const bw_coupler_config *config, bw_ns_channel *fluid, bw_solid *solid,
                            bw_coupler **out) BW_MUST_CHECK;
/* Releases everything but fluid and solid, sets *c to NULL; NULL is fine. Collective. */
void bw_coupler_destroy(bw_coupler **c);

/* Rigid bodies of the same fluid join the steps of the coupler, which then are theirs, too: they
 * are not stepped by themselves any more. With `contact` particles and the bodies' true surfaces
 * push each other as particles and walls do (rigid_touch.h). Iterated steps find the fluid's answer
 * to the solid's motion; the bodies' loads stay those of explicit steps with a virtual mass.
 * Checkpoints of the coupler hold no bodies (bw_coupler_rigid_get_state). Borrowed until the
 * coupler is destroyed. BW_EINPUT for a second set, and where a body and a particle pierce each
 * other; BW_EMEM. Collective. */
bw_status bw_coupler_join(bw_coupler *c, bw_coupler_rigid *bodies, bool contact) BW_MUST_CHECK;

/* Hold the solid where it is (true) or let it move (false). Local. */
void bw_coupler_hold_solid(bw_coupler *c, bool held);

/* Will the next steps be measured (true, the default)? Where the load is the reaction or the solid
 * is held, probes are there for bw_coupler_measure only, and what they cost during a step (the mean
 * of the pressure) is saved by saying false before steps that nobody measures. Local, the same on
 * all ranks. */
void bw_coupler_watch(bw_coupler *c, bool watched);

/* Advance both by dt [T]. BW_ECFL, BW_EDIVERGED from either phase; BW_EMEM when the surface grows.
 * Collective. */
bw_status bw_coupler_step(bw_coupler *c, double dt) BW_MUST_CHECK;

/* Did the last windows of the book look right? Good states are those of such steps. Local, the same
 * on all ranks. */
bool bw_coupler_sound(const bw_coupler *c);

/* How many solid sub-steps a step of dt [T] takes, at least 1; INT_MAX for more. Local. */
int bw_coupler_substeps(const bw_coupler *c, double dt);

/* Solid sub-steps that one step may take. A million of a microsecond per particle are hours a step
 * for any solid worth the name, and the error of rounding in their sum begins to be seen. */
#define BW_COUPLER_MOST_SUBSTEPS 1000000

/* BW_EINPUT, with the number and the limit, when a step of dt [T] would take more sub-steps than
 * that; bw_coupler_step refuses them, too. Local, the same on all ranks. */
bw_status bw_coupler_check_substeps(const bw_coupler *c, double dt) BW_MUST_CHECK;

/* Explicit coupling of this body in this fluid. */
typedef struct {
  double relaxation; /* below this load_relaxation small motions do not grow, with the virtual mass
                        of the configuration; 1: whatever it is; NaN: could not be measured */
  double added;      /* what the fluid adds within twelve steps to the mass that resists in one, of
                        the motion for which that is so [-] */
  bool late;         /* that motion is the one that the fluid resists most over twelve steps, not
                        the one that it resists most at once */
} bw_coupler_limit;
/* Measures it for steps of dt [T], from the present state and surface, by some 190 steps of the
 * fluid, 70 of the solid, and 240 of both or more (stability.c); the state is put back, to the same
 * bits. What bw_coupler_measure tells of the last step is lost until the next. BW_EMEM. Collective.
 */
bw_status bw_coupler_find_limit(bw_coupler *c, double dt, bw_coupler_limit *out) BW_MUST_CHECK;
/* What that takes at most while it lasts [byte], of this rank, beside four fields of the grid: as
 * if every particle were surface. Local. */
double bw_coupler_limit_bytes(const bw_coupler *c);

/* Says once on `log` what the first coupled step, or a later one after much had broken, measured
 * and chose; a warning where a given load_relaxation is above half of the limit. Local. */
void bw_coupler_tell_limit(bw_coupler *c, bw_log *log);

/* What was seen in the last step. */
typedef struct {
  double force_reaction[3];       /* on the solid, from the markers, minus rho sum Q dV [M L/T^2] */
  double force_probe[3];          /* on the solid, sum t A over unblocked probes, and the gradient
                                     that drives the fluid times its volume, as p is without it;
                                     NaN after a step that was not watched */
  double force_control_volume[3]; /* on the solid and the fluid inside it, from the momentum
                                     balance of a box around it; 0 when no box was watched */
  double work_given;              /* by the fluid through the markers since the start:
                                     -rho int sum Q dV.V dt [M L^2/T^2]; 0 without count_work */
  double work_late;               /* of it, what a relaxed load brings later or never: int of
                                     (load - F').V dt; 0 without count_work or with w = 1.
                                     given = late + received (the solid's ledger, external, less
                                     its weight's), to the order of the step */
  double work_unseen;             /* of that given, what the load does not hold: by probes, what the
                                     markers do that no probe sees; by the reaction round-off */
  double work_received;           /* by the solid from the load since the start; given = unseen +
                                     late + received but for what the sampling of the motion makes,
                                     of the order of the step (book.c) [M L^2/T^2] */
  double work_film;         /* taken by films since the start, beside what the load brings: the
                                     solid's ledger has it in external; less what the pressure
                                     around them gave, which drives faces apart [M L^2/T^2] */
  int64_t film_nodes;       /* surface points with a film; 0 without films */
  double film_gap;          /* the least of their gaps [L]; INFINITY: no film */
  double film_pressure;     /* their largest pressure [M/(L T^2)] */
  double slip_rms;          /* velocity mismatch at the markers after forcing [L/T] */
  double slip;              /* that over the largest speed of inflows, walls and bodies, or of
                                     the fluid's mean where all of them rest [-] */
  double leak;              /* flux through the surface, (1/2) sum |(U - V).N| A, over that past
                                     it, the same speed times the largest of the three frontal areas
                                     (1/2) sum |N_d| A [-]; NaN after a step in which the surface
                                     became another */
  int iterations;           /* of the last step; 1: explicit */
  double residual;          /* with which it ended [-]; 0 when explicit */
  double relaxation;        /* load_relaxation in use [-] */
  double relaxation_limit;  /* bw_coupler_limit that was measured last; NaN: none was */
  int64_t unconverged;      /* steps so far whose iterations did not reach coupling_residual */
  int64_t markers;          /* of all ranks */
  int64_t markers_outside;  /* of them, outside the box: they force nothing */
  int64_t probes_shortened; /* shortened or crowded by something in their way */
  int64_t probes_blocked;   /* without room: they bring no load */
  double surface_area;      /* of the solid in the box [L^2] */
  double mass_inside;       /* of the solid in the box, with what holds it under the walls [M] */
  double mass_out;          /* beyond a side, still joined to what is inside [M] */
  double mass_left;         /* retired [M]; the sum of the three never changes */
  double imbalance;         /* most markers on a rank over the mean [-] */
} bw_coupler_report;
/* Measures the last step; probes are read for it where they do not load the solid. BW_EMEM.
 * Collective. */
bw_status bw_coupler_measure(bw_coupler *c, bw_coupler_report *out) BW_MUST_CHECK;

/* force (3) <- what the flow did in the last step to the own particles i with on[i] (count), summed
 * over ranks, by the route that loads the solid, whole and not relaxed, with what the gradient that
 * drives the fluid does to them [M L/T^2]; NaN where a held solid has probes in a step that was not
 * watched. BW_EMEM. Collective. */
bw_status bw_coupler_force_on(bw_coupler *c, const bool on[], double force[3]) BW_MUST_CHECK;

/* One warning on `log`, with the remedy, when slip or leak of five reports in a row are above 2 %
 * of the largest speed that the run has had since its start or restart;
 * r is the report of bw_coupler_measure. Not in the first hundred steps, in which every flow slips.
 * The same on all ranks. Local. */
void bw_coupler_warn_slip(bw_coupler *c, const bw_coupler_report *r, bw_log *log);
/* The same of the last report alone, whatever its step: for the end of a run or a phase, so that no
 * result that leaks is left without a word. Local. */
void bw_coupler_warn_end(bw_coupler *c, bw_log *log);

/* One warning on `log` where probes load what they do not suit: a solid that nothing holds, which
 * then falls too fast, or a surface on which more than a third of them are shortened, crowded or
 * blocked. r is the report of bw_coupler_measure. Collective. */
void bw_coupler_warn_load(bw_coupler *c, const bw_coupler_report *r, bw_log *log);

/* Parts of a step whose time is measured. */
typedef enum {
  BW_PART_MOMENTUM, /* predict, correction, halos */
  BW_PART_POISSON,  /* pressure solves */
  BW_PART_FORCING,  /* placing markers, interpolation and spreading */
  BW_PART_PROBES,   /* mean pressure, probes or reaction, load on the particles */
  BW_PART_SOLID,    /* solid sub-steps */
  BW_PART_SURFACE,  /* following the surface */
  BW_PART_COUNT     /* how many there are */
} bw_coupler_part;
/* Where the time went since create, by part. Borrowed. Local. */
bw_timer *bw_coupler_timer(bw_coupler *c);

/* The solid's interface, for fragments and the surface; borrowed. Local. */
bw_pd_interface *bw_coupler_edit_interface(bw_coupler *c);
/* load (n,3): the force of the fluid on each own particle of the solid in the last step, not yet
 * relaxed, with films, without weight [M L/T^2]; nothing of a solid that was held. Local. */
void bw_coupler_get_load(const bw_coupler *c, double load[]);
/* What films have taken since the start, as work_film of the report [M L^2/T^2]. Collective. */
double bw_coupler_film_energy(const bw_coupler *c);
/* The least gap of a film in the last step, as in the report [L]; INFINITY: there was none.
 * Local. */
double bw_coupler_film_gap(const bw_coupler *c);
/* What flows in the films of the last step through the plane through x (3) with the normal n (3)
 * [L^3/T]; the same on all ranks. Local. */
double bw_coupler_film_flux(const bw_coupler *c, const double x[3], const double n[3]);
/* The forcing, for its cost and report; borrowed. Local. */
bw_ibm_mdf *bw_coupler_markers(bw_coupler *c);

/* Remembers the present state in memory, as the last good one: a copy of the fields and particles,
 * allocated by the first call. BW_EMEM. Collective. */
bw_status bw_coupler_keep(bw_coupler *c) BW_MUST_CHECK;
/* Writes the present state into an open checkpoint, under fluid/ and solid/; it is remembered, too.
 * BW_EMEM, BW_EIO. Collective. */
bw_status bw_coupler_save(bw_coupler *c, bw_checkpoint *ck) BW_MUST_CHECK;
/* Writes the remembered state. BW_EINPUT when there is none, BW_EIO. Collective. */
bw_status bw_coupler_save_kept(bw_coupler *c, bw_checkpoint *ck) BW_MUST_CHECK;
/* Replaces the state by that of a checkpoint, written by any number of ranks: the run goes on as it
 * would have. BW_EINPUT when it does not fit, BW_EIO, BW_EMEM. Collective. */
bw_status bw_coupler_load(bw_coupler *c, bw_checkpoint *ck) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
