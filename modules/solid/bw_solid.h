/* bw_solid.h -- a peridynamic solid: particles, bonds, damage, contact, explicit dynamics.
 *
 *   rho X'' = L + F + C + D
 * with L the force density of the law (bonds: bw_pd_bond_law.h), F external, C contact
 * (bw_pd_contact.h) and D damping (POROUS 3.38, 3.41 with ERRATA 4); in Verlet's scheme the
 * damping is that of the half-step velocity.
 * Particles sit on a uniform lattice: X0 = origin + axes.(site + 1/2) ds, site[3] integers.
 * With `disorder` it is a cloud instead: X0 is off that place in a random direction, by disorder
 * ds and then less where neighbours nearer than 0.9 ds push each other apart (pd_cloud.c); the
 * same for the same site, seed and axes, whatever else there is. All particles keep the volume of
 * a cell; families and xi are those of the true places.
 * Family: |xi| < horizon + ds/2 (POROUS 3.32, ERRATA 2). A bond beyond its limit breaks for good,
 * checked at the end of every step when breakage is enabled: it holds during the whole step and is
 * gone from the force the next step starts with. Both ends decide alike, on any number of ranks.
 * 2D: site[2] = 0, one layer of `thickness`; X0[2] = origin[2], z components of V and A zero.
 * Shapes   vectors row-major (n,3); particles of a rank are 0..n-1, in lattice order; the global
 *          id of a particle is its row in the lists given to create, joined in rank order.
 * Units    any consistent set: [M], [L], [T].
 * Life     config_default -> create -> { set_force, step }* -> destroy.
 * MPI      particles are divided into compact blocks; "collective" as in bw_comm.h. What returns a
 *          status collectively returns the same kind of answer (OK or not) on all ranks. */
#pragma once
#include "bw_pd_body.h"
#include "bw_pd_bond_law.h"
#include "bw_pd_contact.h"
#include "bw_pd_levels.h"
#include "bw_solid_law.h"
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_solid bw_solid;

/* Time integrator. */
typedef enum {
  BW_SOLID_VERLET, /* velocity Verlet, second order, one evaluation of the forces per step */
  BW_SOLID_RK3     /* Runge-Kutta of third order (POROUS 3.47, 3.48 with ERRATA 5), three */
} bw_solid_integrator;

/* Materials of the particles of groups 1, 2, ..., and what joins them. */
typedef struct {
  int n;                                     /* of them                                default 0 */
  bw_pd_material material[BW_PD_GROUPS - 1]; /* of group 1 and above */
  double joint_G0[BW_PD_GROUPS][BW_PD_GROUPS]; /* bonds between two groups, symmetric [M/T^2];
                                                  default NaN: the smaller of the two */
} bw_solid_groups;

/* Coefficients of damping, zero by default. */
typedef struct {
  double pair;     /* k_d of 3.41, bonds that hold [M/(L^6 T)] */
  double mean;     /* k_d of FSI eq. 9, -k (V - V_mean) [M/(L^3 T)] */
  double absolute; /* -k V, for settling [M/(L^3 T)] */
} bw_solid_damping;

/* How levels follow what happens (bw_solid_levels.h). Lengths are in horizons of level 0. */
typedef struct {
  int level; /* of the finest particles, 1: half of ds, 2: a quarter ...; 0: levels stay as they
                    are                                                           default 0 */
  bw_pd_levels_trigger trigger; /* what `at` and `coarsen_at` are shares of       default stretch */
  double at;                    /* cells beyond this have to be fine              default 0.6 */
  double coarsen_at; /* fine cells below this, for some looks, may be coarse      default 0.2 */
  double buffer;     /* fine cells at least this far around, above 1              default 1.25 */
  double ahead;      /* and this much farther when they are made                  default 2 */
} bw_solid_refine;

/* Where particles are finer. */
typedef struct {
  int n;                      /* boxes; 0: none                                   default 0 */
  bw_pd_box box[BW_PD_BOXES]; /* where they are, several may meet; their level is the least that
                                 there is in them */
  bw_pd_jump jump;        /* bonds between levels                             default balanced */
  bool same_horizon;      /* as bw_pd_finer has it; not where levels change      default false */
  bw_solid_refine refine; /* elsewhere as needed                              default never */
} bw_solid_finer;

/* What a solid is made of and how it moves. Required values start as NaN: refused by name. */
typedef struct {
  bw_pd_geometry geometry;    /* dimension and plane condition                         default 3D */
  double ds;                  /* lattice spacing [L]                  required */
  double thickness;           /* 2D only [L]                          default 1 */
  double horizon_ratio;       /* m = horizon/ds [-], 1 .. 12                            default 3 */
  double rho;                 /* density of group 0 [M/L^3]           required */
  double E;                   /* Young's modulus of group 0 [M/(L T^2)]                required */
  double nu;                  /* Poisson's ratio of group 0: NaN (the law's own); of bonds exactly
                              1/4, or 1/3 in plane stress (ERRATA 14)                default NaN */
  double G0;                  /* fracture energy of group 0 [M/T^2]   default INFINITY */
  bw_solid_groups more;       /* materials of groups 1, 2, ... and joints  default none */
  bw_solid_law_choice choice; /* law and its options; of bonds surface_correction and calibration
                                 below come to them                           default bonds */
  const bw_pd_law *law;       /* borrowed: a row of bw_solid_laws, or one's own (pd_law.h); NULL
                                 (default): that of choice */
  const void *law_options; /* borrowed by create: what that law's header asks for; NULL (default):
                                 those of choice */
  bw_pd_volume_fraction volume_fraction;       /* Gamma; default exact in 3D, linear in 2D */
  bw_pd_surface_correction surface_correction; /* of the bond law; default volume */
  bw_pd_calibration calibration;               /* of the bond law; default none */
  bw_pd_family_reach family_reach; /* |xi| < horizon + ds/2 (default) or |xi| < horizon */
  double disorder;       /* particles start up to this many ds off their sites, 0.4 at most; then
                            volume_fraction is linear or none, 2D and 3D     default 0 */
  int32_t disorder_seed; /* another number, another cloud                    default 0 */
  bw_solid_integrator integrator; /* default Verlet */
  bw_solid_damping damping;       /* default none */
  bool contact;                   /* repulsion of particles nearer than ds that no intact bond joins
                                  (3.40 with n_c = 1, k_c = 15 c0, r_c = ds)  default false */
  double origin[3];               /* of the lattice [L]                   default 0 */
  double axes[3][3];              /* rows: lattice directions             default identity */
  bw_solid_finer finer; /* where particles are finer; cracks run on the finest level alone: a bond
                           beyond its limit elsewhere ends the run     default one level */
  double period[3];     /* periodic length per direction [L], 0: not periodic. Must be a whole
                       number of ds along that axis         default 0 */
} bw_solid_config;

/* The defaults; ds, rho and E are still to be set. Local. */
bw_solid_config bw_solid_config_default(void);

/* The laws that a case file can name, in the order of bw_solid_law_row, ends with NULL. */
extern const bw_pd_law *const bw_solid_laws[];
const bw_pd_law *bw_solid_law_by_name(const char *name); /* NULL: there is none. Local. */
void bw_solid_laws_describe(FILE *out); /* each law and the keys it reads, a line each. Local. */

/* Build particles, families and bonds of the lattice sites that the ranks give, each its part (see
 * bw_pd_sites). BW_EINPUT names the field; two particles on one site are an error; BW_EMEM.
 * `comm` is borrowed until destroy. *out is the caller's, NULL after a failure. Collective. */
bw_status bw_solid_create(const bw_comm *comm, const bw_solid_config *config,
                          const bw_pd_sites *given, bw_solid **out) BW_MUST_CHECK;

/* The same for a small body that every rank has the whole list of: site (n,3), kind (n) or NULL,
 * the same on all ranks; each takes its share. Errors and ownership as above. Collective. */
bw_status bw_solid_create_same(const bw_comm *comm, const bw_solid_config *config, int64_t n,
                               const int32_t site[], const uint8_t kind[],
                               bw_solid **out) BW_MUST_CHECK;

/* What a large body of a material is like, before it is built. */
typedef struct {
  double dt_max, dt_contact; /* steps that are stable, that resolve a collision [T] */
  double critical_stretch;   /* [-] */
  double horizon;            /* [L] */
  double bytes;              /* of memory per particle */
} bw_solid_sample;

/* The same as bw_solid_dt_max and so on, from two small blocks with free faces: time and memory do
 * not grow with the body. The step of a body with notches or pores may be some per cent shorter.
 * Errors of bw_solid_create for the settings. The same on all ranks. Collective. */
bw_status bw_solid_try(const bw_comm *comm, const bw_solid_config *config,
                       bw_solid_sample *out) BW_MUST_CHECK;

/* Frees the solid and sets the pointer to NULL; NULL is fine. Collective. */
void bw_solid_destroy(bw_solid **solid);

/* Break the bonds that cross a segment (2D: from a to b; ends included) or a parallelogram with
 * corner a and edges b-a, c-a (3D; pass c = NULL in 2D), in the reference shape [L]. Unbreakable
 * ones too. Where levels change a horizon around its rim is as fine as can be from then on, so that
 * there are other particles. BW_EINPUT for a cut without extent, or without c in 3D. Collective. */
bw_status bw_solid_precrack(bw_solid *solid, const double a[3], const double b[3],
                            const double c[3]) BW_MUST_CHECK;

/* Whether bonds beyond their limit break at the end of a step; at first they do. The same on all
 * ranks. Local. */
void bw_solid_enable_breakage(bw_solid *solid, bool on);
bool bw_solid_breaks(const bw_solid *solid); /* is it on? Local. */

/* New coefficients of damping, units and meaning as in bw_solid_config; dt_max follows. The same on
 * all ranks. Local. */
void bw_solid_set_damping(bw_solid *solid, double pair, double mean, double absolute);

/* New fracture energy of the first group [M/T^2], and so of its joints without a joint_G0. The same
 * on all ranks; the stable step is found anew. BW_EINPUT unless positive. Collective. */
bw_status bw_solid_set_G0(bw_solid *solid, double G0) BW_MUST_CHECK;

/* Plane walls that the particles do not cross (contact only; replaces earlier ones; n = 0: none).
 * The domain lies where normal.X > offset, normal a unit vector into it. A particle is pushed by
 * its own mirror image with the law of contact, so it touches with its cube's face, ds/2 from its
 * centre (or as near as it began), without friction. Not met by prescribed and retired particles,
 * nor by those that an intact bond joins to a prescribed one beyond the plane (what stands on a
 * foundation). BW_EINPUT without contact, when n > BW_PD_WALLS, a normal is no unit vector, or a
 * free particle is beyond the wall. BW_EDIVERGED of a step when one was thrown through.
 * Collective. */
bw_status bw_solid_set_walls(bw_solid *solid, int n, const bw_pd_wall wall[]) BW_MUST_CHECK;

/* Take own particles (those with gone[i], n) out of the mechanics for good, whole pieces of them:
 * they keep their velocity, no force acts on them or comes from them, and what they stored is
 * booked. Their bonds and damage stay as they are. They carry BW_PD_RETIRED in bw_solid_kind.
 * Prescribed ones stay. BW_EDIVERGED as of evaluate. Collective. */
bw_status bw_solid_retire(bw_solid *solid, const bool gone[]) BW_MUST_CHECK;

/* External force density F of the next steps (n,3) [M/(L^2 T^2)]; copied. Local. */
void bw_solid_set_force(bw_solid *solid, const double F[]);

/* A drag of the next steps, on n own particles, each named once: the force density -k (v - V), with
 * v of the beginning of each step, beside that of set_force; where k dt exceeds the density no more
 * than what takes all of v - V within the step. particle (n), k (n) >= 0 [M/(L^3 T)], V (n,3)
 * [L/T]; copied, n = 0: none. Its work is booked as external. Held and retired particles feel none.
 * BW_EMEM. Local. */
bw_status bw_solid_set_drag(bw_solid *solid, size_t n, const int32_t particle[], const double k[],
                            const double V[]) BW_MUST_CHECK;
/* What it did since it was set, of this rank: impulse (count, 3) <- per volume [M/(L^2 T)]; returns
 * its work [M L^2/T^2]. Local. */
double bw_solid_get_drag(const bw_solid *solid, double impulse[]);

/* Velocity of the prescribed particles (n,3) [L/T] (rows of others ignored), from the next step
 * on; copied. set_state and set_restart give them the velocity of their rows. Local. */
void bw_solid_set_prescribed(bw_solid *solid, const double V[]);

/* One step of dt [T]. BW_ECFL when dt is not positive or above dt_max; BW_EDIVERGED when a particle
 * is not finite or moves more than one horizon in the step (RK3: in a sub-step), or a bond above
 * the finest level is stretched beyond its limit; names the particle, its place. Collective. */
bw_status bw_solid_step(bw_solid *solid, double dt) BW_MUST_CHECK;

/* Largest stable step of the intact network with its damping at small strain [T]: a bound below
 * that of ERRATA 6 by its square root of three (two in the plane), see pd_bond_bounds.c; contact
 * not counted; INFINITY without bonds; the same on all ranks. Local. */
double bw_solid_dt_max(const bw_solid *solid);

/* Step that resolves a collision of two particles [T], 1/w of their oscillation: they part with
 * 0.9 to 1.1 of their speed and keep their energy to 1 % in the mean; at 1.6/w they gain two thirds
 * of it. Twelve touching neighbours are stable to this step, and with bonds as well to
 * (1/dt_max^2 + 1/dt_contact^2)^(-1/2). INFINITY without contact. Local. */
double bw_solid_dt_contact(const bw_solid *solid);

/* Forces at the present motion: what a step begins with when something was set. BW_EDIVERGED when a
 * particle is beyond a wall; BW_EMEM. Collective. */
bw_status bw_solid_evaluate(bw_solid *solid) BW_MUST_CHECK;

/* Views, borrowed until the next restart, retirement or destroy. Local. */
size_t bw_solid_count(const bw_solid *solid);                    /* n: particles of this rank */
int64_t bw_solid_total(const bw_solid *solid);                   /* of all ranks */
const int64_t *bw_solid_id(const bw_solid *solid);               /* (n) global ids */
const uint8_t *bw_solid_kind(const bw_solid *solid);             /* (n) bits BW_PD_PRESCRIBED ... */
const bw_solid_config *bw_solid_settings(const bw_solid *solid); /* of create, defaults resolved */
const bw_comm *bw_solid_comm(const bw_solid *solid);             /* of create */
double bw_solid_horizon(const bw_solid *solid);                  /* of level 0 [L] */
double bw_solid_micromodulus(const bw_solid *solid);     /* c0 of the first group [M/(L^5 T^2)] */
double bw_solid_critical_stretch(const bw_solid *solid); /* s0 of the first group [-]; NaN: the
                                                                law has none */
double bw_solid_volume(const bw_solid *solid);           /* of one particle of level 0 [L^3] */
/* What one own particle i is, by its group and its lattice; settings() holds those of the first
 * group. Local. */
int bw_solid_level(const bw_solid *solid, size_t i);      /* 0: of spacing ds, 1: of ds/2, ... */
int bw_solid_group(const bw_solid *solid, size_t i);      /* row of the materials, 0: the first */
double bw_solid_density(const bw_solid *solid, size_t i); /* [M/L^3] */
double bw_solid_spacing(const bw_solid *solid, size_t i); /* [L] */
double bw_solid_horizon_of(const bw_solid *solid, size_t i); /* [L] */
double bw_solid_volume_of(const bw_solid *solid, size_t i);  /* [L^3] */
bw_pd_body *bw_solid_body(const bw_solid *solid);            /* for laws and tools */

/* Copies in the caller's array (n,3). Positions are not wrapped in periodic directions. Local. */
void bw_solid_get_reference(const bw_solid *solid, double X0[]); /* [L] */
void bw_solid_get_position(const bw_solid *solid, double X[]);   /* [L] */
void bw_solid_get_velocity(const bw_solid *solid, double V[]);   /* [L/T] */
/* [L/T^2], by the last evaluation; 0 of a particle that does not move freely. */
void bw_solid_get_acceleration(const bw_solid *solid, double A[]);

/* damage[n] <- the broken part of each family, weighted with Gamma (POROUS 3.28): 0 whole .. 1;
 * 0 of a particle without family. Local. */
void bw_solid_get_damage(const bw_solid *solid, double damage[]);

/* Positions X [L] and velocities V [L/T], both (n,3), of the own particles; forces are evaluated
 * anew before they are used. Bonds stay as they are. Collective. */
void bw_solid_set_state(bw_solid *solid, const double X[], const double V[]);

/* The bonds of particle h (0 <= h < n), for those who need them one by one (surface detection,
 * fragments): writes up to bw_solid_max_family rows and returns how many. `neighbour` is an
 * index into the extended arrays of get_extended (own particles first, then copies of other
 * ranks' particles and periodic images), `slot` the number of the bond's direction in the stencil
 * (the same for the same lattice offset everywhere), `intact` whether it still holds. Local. */
int bw_solid_links(const bw_solid *solid, size_t h, bw_pd_link link[]);

/* Directions of the stencil: slots are 0 .. max_family - 1. Local. */
int bw_solid_max_family(const bw_solid *solid);
/* xi from site to site of a direction [L], [3], borrowed; in a cloud ends are off their sites. */
const double *bw_solid_stencil_offset(const bw_solid *solid, int slot);
/* Gamma of a direction [-]; in a cloud that of the sites' distance. */
double bw_solid_stencil_fraction(const bw_solid *solid, int slot);
/* Those two are of level 0 alone. Of any level, 0 .. bw_solid_finest: how many directions its
 * stencil has, and where one leads. Local. */
typedef struct {
  double xi[3];  /* from site to site [L] */
  double volume; /* what of the partner's cell is within the owner's horizon, over the owner's own
                    volume [-]: Gamma where both are of one level */
  int other;     /* level of the partner */
} bw_solid_direction;
int bw_solid_finest(const bw_solid *solid);
int bw_solid_directions(const bw_solid *solid, int level);
bw_solid_direction bw_solid_leads(const bw_solid *solid, int level, int slot);

/* Own particles and copies. id: global id; X: present position, copies shifted to where they act.
 * n_extended >= count; borrowed until the next step. Collective (updates the copies). */
bw_pd_extended bw_solid_get_extended(bw_solid *solid);

/* Reference place of one of them, copies where they act [L]. Local. */
void bw_solid_get_place(const bw_solid *solid, size_t extended, double X0[3]);

/* The motion of own particles and copies, to be read where the solid keeps it: that of the extended
 * particle e at place[e]. u: displacement [L]; v: velocity [L/T], only if asked for (an exchange).
 * Borrowed until the next step. Collective (updates the copies). */
bw_pd_motion bw_solid_get_motion(bw_solid *solid, bool velocity);

/* own[n_own] values of `bytes` each -> all[n_extended]: fills the copies' values, own ones first.
 * Collective. */
void bw_solid_fill_extended(bw_solid *solid, size_t bytes, const void *own, void *all);

/* The way back: adds the copies' vectors of all (n_extended,3) to those of their owners, which come
 * first. Collective. */
void bw_solid_sum_extended(bw_solid *solid, double *all);

/* Bytes of this rank's bond lists (slots, blocks, factors per bond). Local. */
size_t bw_solid_list_bytes(const bw_solid *solid);

/* Raised when the set of particles or their surface has changed otherwise than by motion and
 * breaking: whoever keeps lists of particles makes them anew. The same on all ranks. Local. */
int64_t bw_solid_revision(const bw_solid *solid);

/* Counts bond-breaking events of this rank so far (pre-cracks and set_bits too, which may also
 * mend): unchanged means nothing to update. Local. */
int64_t bw_solid_events(const bw_solid *solid);

/* broken[n] <- broken bonds of each own particle (never falls, but by set_bits). Local. */
void bw_solid_get_broken(const bw_solid *solid, uint16_t broken[]);

/* A value of bw_solid_ledger.closest below which particles may have passed between others [-]. */
#define BW_SOLID_TOO_CLOSE 0.6

/* Where energy and momentum are and have gone, of all ranks. The energies balance to the order of
 * the integrator: kinetic + elastic + contact + retired + damping + fracture + plastic + regrid
 * - external stays what it was. */
typedef struct {
  double kinetic, elastic;  /* [M L^2/T^2] present */
  double contact;           /* elastic energy of contact, with walls too, present [M L^2/T^2] */
  double closest;           /* least distance of a pair in contact so far, over ds; INFINITY:
                                     none. Below BW_SOLID_TOO_CLOSE a particle may have passed
                                     between others: the impact is too violent for this ds. */
  double retired;           /* elastic energy of bonds and contact that went when their particles
                                     were retired [M L^2/T^2] */
  double damping, fracture; /* dissipated since the start (or restart's stored value)
                                     [M L^2/T^2] */
  double plastic;           /* dissipated inside particles by the law, so far [M L^2/T^2] */
  double regrid;            /* taken by changes of levels, less what they gave [M L^2/T^2] */
  double external;          /* work of F and of prescribed motion since the start
                                     [M L^2/T^2] */
  double momentum[3], angular[3]; /* [M L/T], [M L^2/T] about the origin of space; retired particles
                                     too, as in kinetic */
  double wall[3];                 /* impulse given to the walls since the start [M L/T] */
  int64_t bonds, broken;          /* undirected bonds: at the start without those a pre-crack cut;
                                     broken by stretch since */
} bw_solid_ledger;

/* Evaluates the forces first where the state was changed since. BW_EDIVERGED when a particle is
 * beyond a wall, BW_EMEM; *out is then left as it was. Collective. */
bw_status bw_solid_account(bw_solid *solid, bw_solid_ledger *out) BW_MUST_CHECK;

/* Kinetic energy and that of the bonds [M L^2/T^2], of all ranks, as of the forces evaluated last:
 * a look that changes nothing, not even lists of contact. Collective. */
double bw_solid_held(const bw_solid *solid);

/* The bonds that hold, for a checkpoint: bits (n, bytes) <- one bit per direction in stencil order,
 * the same on any number of ranks. Local. */
void bw_solid_get_bits(const bw_solid *solid, uint8_t bits[]);
size_t bw_solid_bits_bytes(const bw_solid *solid); /* bytes of one row */

/* The way back; bits of directions in which a particle has no bond are ignored. Collective. */
bw_status bw_solid_set_bits(bw_solid *solid, const uint8_t bits[]) BW_MUST_CHECK;

/* A number that tells one body from another: from ids, reference places, kinds and groups of all
 * particles and the horizon; whether they hold, move or have retired does not count. The same on
 * any number of ranks. A restart belongs to the body with its number. Collective. */
uint64_t bw_solid_fingerprint(const bw_solid *solid);

enum { BW_SOLID_RESTART_SUMS = 14 }; /* sums of the whole solid in a restart */

/* Numbers per particle in a row of a restart: 13, and one for each field that the law wants saved.
 * The same on all ranks. Local. */
size_t bw_solid_restart_row(const bw_solid *solid);

/* Everything else a restart needs: X0-relative displacement, V, acceleration without F, its damping
 * part, 1 when retired (2 more when a state was set and its forces are still to be evaluated), the
 * law's saved fields (n, restart_row), and the ledger's running sums of all ranks (14: damping,
 * fracture, external, directed bonds cut by pre-cracks, retired, impulse on walls, force on them,
 * and the coefficients pair, mean, absolute of the damping in the accelerations).
 * Set bits and rows, in any order, then force and prescribed velocities: the run goes on to the
 * same bits. Where the damping is another one by then, as after the end of a settling, the
 * accelerations are evaluated anew, as they are when bw_solid_set_damping changes it on the way.
 * Both collective. */
void bw_solid_get_restart(const bw_solid *solid, double rows[], double sums[]);
bw_status bw_solid_set_restart(bw_solid *solid, const double rows[],
                               const double sums[]) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
