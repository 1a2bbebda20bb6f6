/* bw_solid_law.h -- which law of the table a solid has, and its options, as plain numbers: what a
 * case file can say of a material besides density, Young's modulus and fracture energy.
 *
 * bw_solid_config.choice holds one; bw_solid_create makes the law's options of it unless `law` or
 * `law_options` are given. BW_SOLID_LAW_KEYS (bw_solid_words.h) reads one from a case file. */
#pragma once
#include "bw_pd_bond_law.h"
#include "bw_pd_state_law.h"

BW_BEGIN_DECLS

/* Rows of bw_solid_laws. */
typedef enum {
  BW_SOLID_BOND,          /* bonds: Poisson's ratio 1/4, or 1/3 in plane stress */
  BW_SOLID_ORDINARY,      /* ordinary state-based */
  BW_SOLID_CORRESPONDENCE /* correspondence */
} bw_solid_law_row;

/* What a correspondence solid yields by. */
typedef enum {
  BW_SOLID_ELASTIC,        /* it does not */
  BW_SOLID_J2,             /* yield_stress, hardening */
  BW_SOLID_DRUCKER_PRAGER, /* cohesion, friction_angle, dilation_angle */
} bw_solid_plastic;

/* A law and its options. What a law does not read has to be left at its default. */
typedef struct {
  int law;               /* bw_solid_law_row                                  default bond */
  double poisson_ratio;  /* not bonds [-]; config.nu says the same     default NaN: that of bonds */
  int influence;         /* ordinary: bw_pd_state_influence              default constant */
  int weight;            /* correspondence: bw_pd_state_weight              default cubic */
  int elastic;           /* correspondence: bw_pd_material_elastic    default neo-Hookean */
  double stabilisation;  /* correspondence: beta kappa/mu [-]                 default 4/3 */
  int breaks;            /* correspondence: bw_pd_state_breaks         default by stretch */
  double limit;          /* of breaks by a stress [M/(L T^2)] or flow [-]     default NaN */
  int plastic;           /* correspondence: bw_solid_plastic              default elastic */
  double yield_stress;   /* J2: uniaxial [M/(L T^2)]                          default NaN */
  double hardening;      /* J2: its slope [M/(L T^2)]                         default NaN: 0 */
  double cohesion;       /* Drucker-Prager [M/(L T^2)]                        default NaN */
  double friction_angle; /* Drucker-Prager, and breaks by it or Mohr-Coulomb [degrees]
                                                                              default NaN */
  double dilation_angle; /* Drucker-Prager [degrees]                       default NaN: 0 */
  int cone;              /* Drucker-Prager: bw_pd_material_cone   default plane strain,
                            isochoric */
} bw_solid_law_choice;

/* The defaults: bonds. Local. */
bw_solid_law_choice bw_solid_law_choice_default(void);

/* Refuses what contradicts itself: options of another law, a strength that is missing or not
 * positive. BW_EINPUT names the key. Local; bw_solid_create does it, too. */
bw_status bw_solid_law_check(const bw_solid_law_choice *choice) BW_MUST_CHECK;

BW_END_DECLS
