/* bw_pd_material.h -- how a point of a material answers to its deformation gradient.
 *
 * Elastic, with an energy density W(F) per reference volume and P = dW/dF (first Piola-Kirchhoff):
 *   linear               W = lam/2 (tr e)^2 + mu e:e,  e = sym(F - 1): small turns only
 *   St. Venant-Kirchhoff the same of Green's strain E = (F^T F - 1)/2
 *   neo-Hookean          W = mu/2 (tr F^T F - 3) - mu g + lam/2 g^2,  g = ln J
 *   Hencky               W = lam/2 (tr h)^2 + mu h:h,  h = ln(F^T F)/2
 * Below J = 1/10 the logarithm of J is continued by its parabola there, so that a point that is
 * turned inside out has a finite stress that turns it back.
 * Plastic, in rate form (ULPH 37-46 with the errata of the rate form): a step from F0 to F1 has
 *   D + W = 2 (F1 - F0) (F1 + F0)^-1,  sigma = R sigma0 R^T + Q C:D Q^T,
 * R the rotation by W (Cayley), Q by half of it; then sigma returns to the cone
 *   sqrt(J2) + alpha I1 <= k + h p
 * along its flow rule with `dilatancy` in place of alpha (not associated); to the apex where the
 * deviator would turn. J2 is the cone with alpha = 0. P = sigma cof F. The book of a point: the
 * work P:dF by the trapezoidal rule is what W, the elastic energy J sigma:C^-1:sigma/2, gains and
 * what is dissipated.
 * Plane strain: F33 = 1. Plane stress: F33 follows from sigma33 = 0.
 * An energy of one's own is a bw_pd_material_energy (docs/add-a-material.md).
 *
 * Shapes   tensors of 9 row-major numbers; symmetric ones xx yy zz yz xz xy; BW_PD_MATERIAL_LANES
 *          points at a time. Always in double. Sources: docs/sources.md ULPH; Holzapfel, Nonlinear
 *          Solid Mechanics (2000), ch. 6; Hughes & Winget, Int. J. Numer. Meth. Eng. 15 (1980).
 * All functions are local. */
#pragma once
#include "bw_status.h"
#include <stdbool.h>

BW_BEGIN_DECLS

enum { BW_PD_MATERIAL_LANES = 8 }; /* points of one call */

/* One number of each point. */
typedef double bw_pd_material_lanes
    __attribute__((vector_size(BW_PD_MATERIAL_LANES * sizeof(double))));

/* What is left out of space. */
typedef enum {
  BW_PD_MATERIAL_SPACE,        /* nothing */
  BW_PD_MATERIAL_PLANE_STRESS, /* sigma33 = 0 */
  BW_PD_MATERIAL_PLANE_STRAIN  /* F33 = 1 */
} bw_pd_material_plane;

/* Energy of an elastic material. */
typedef enum {
  BW_PD_MATERIAL_LINEAR,       /* of the symmetric gradient */
  BW_PD_MATERIAL_SAINT_VENANT, /* St. Venant-Kirchhoff: of Green's strain */
  BW_PD_MATERIAL_NEO_HOOKEAN,  /* of F^T F and J */
  BW_PD_MATERIAL_HENCKY,       /* of the logarithmic strain */
  BW_PD_MATERIAL_ENERGIES      /* how many */
} bw_pd_material_elastic;

/* Which Drucker-Prager cone stands for Mohr-Coulomb's cohesion and angle of friction. */
typedef enum {
  BW_PD_MATERIAL_COMPRESSION_CONE, /* meets it in triaxial compression */
  BW_PD_MATERIAL_EXTENSION_CONE,   /* in triaxial extension */
  BW_PD_MATERIAL_PLANE_ASSOCIATED, /* in plane strain when it dilates by the angle of friction */
  BW_PD_MATERIAL_PLANE_ISOCHORIC   /* in plane strain without dilation: exact there */
} bw_pd_material_cone;

/* sqrt(J2) + alpha I1 <= k + hardening p, p the factor of the flow so far. */
typedef struct {
  double alpha;     /* slope of the cone, 0: J2 [-] */
  double k;         /* shear strength [M/(L T^2)]; INFINITY: it does not yield */
  double dilatancy; /* alpha of the flow rule; 0: it keeps its volume [-] */
  double hardening; /* dk/dp [M/(L T^2)] */
} bw_pd_material_yield;

enum { BW_PD_MATERIAL_PARAMETERS = 4 }; /* numbers of an energy of one's own, at most */

typedef struct bw_pd_material_energy bw_pd_material_energy;

/* A material. */
typedef struct {
  bw_pd_material_plane plane;       /* what is left out of space */
  bw_pd_material_elastic elastic;   /* its energy; not read where it yields */
  double lam, mu;                   /* Lame's constants [M/(L T^2)] */
  bw_pd_material_yield yield;       /* where it yields */
  const bw_pd_material_energy *own; /* borrowed: an energy in place of `elastic`; NULL: none */
  double parameter[BW_PD_MATERIAL_PARAMETERS]; /* of `own`, as it likes */
} bw_pd_material_point;

/* An energy of one's own. At small strain it has to be Hooke's of lam and mu: stable steps and
 * linear statics take those. */
struct bw_pd_material_energy {
  const char *name; /* its word */
  /* P and, unless NULL, W of H = F - 1 in space: in the plane H[8] is what F33 - 1 is, and the
   * others out of it are 0. Local. */
  void (*stress)(const bw_pd_material_point *m, const bw_pd_material_lanes H[9],
                 bw_pd_material_lanes P[9], bw_pd_material_lanes *W);
};

/* Elastic material of Young's modulus E [M/(L T^2)] and Poisson's ratio nu, without yield. */
bw_pd_material_point bw_pd_material_elastic_point(bw_pd_material_plane plane,
                                                  bw_pd_material_elastic elastic, double E,
                                                  double nu);
/* Drucker-Prager: cohesion c [M/(L T^2)], friction and dilation angles [rad]. */
bw_pd_material_yield bw_pd_material_drucker_prager(bw_pd_material_cone cone, double cohesion,
                                                   double friction, double dilation);
/* J2: stress of uniaxial yield [M/(L T^2)], its slope with the equivalent plastic strain. */
bw_pd_material_yield bw_pd_material_j2(double yield_stress, double hardening_modulus);

/* P [M/(L T^2)] and, unless NULL, W [M/(L T^2)] of the displacement gradient H = F - 1 (9); in
 * the plane the entries out of it are not read, and H[8] becomes what F33 - 1 is. */
void bw_pd_material_stress(const bw_pd_material_point *m, bw_pd_material_lanes H[9],
                           bw_pd_material_lanes P[9], bw_pd_material_lanes *W);

/* What a point with yield remembers. */
typedef struct {
  bw_pd_material_lanes H[9];       /* F - 1 */
  bw_pd_material_lanes sigma[6];   /* Cauchy stress [M/(L T^2)] */
  bw_pd_material_lanes flow;       /* factor of the flow so far, p above [-] */
  bw_pd_material_lanes dissipated; /* per reference volume [M/(L T^2)] */
} bw_pd_material_state;

/* The step from `old` to the displacement gradient H: `next`, P, and, unless NULL, the elastic
 * energy W. old and next may not overlap. */
void bw_pd_material_rate(const bw_pd_material_point *m, const bw_pd_material_state *old,
                         const bw_pd_material_lanes H[9], bw_pd_material_state *next,
                         bw_pd_material_lanes P[9], bw_pd_material_lanes *W);
/* P [M/(L T^2)] and elastic energy W of a state as it is; either may be NULL. */
void bw_pd_material_state_stress(const bw_pd_material_point *m, const bw_pd_material_state *s,
                                 bw_pd_material_lanes P[9], bw_pd_material_lanes *W);

/* Largest a.n:dP/dF:a.n over unit vectors a and n at an elastic state H (9, one point): density
 * times the square of the fastest wave [M/(L T^2)]; lam + 2 mu in space without strain. */
double bw_pd_material_largest_tangent(const bw_pd_material_point *m, const double H[9]);

BW_END_DECLS
