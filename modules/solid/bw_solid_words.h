/* bw_solid_words.h -- the words of case files for the choices of bw_solid_config: lists for
 * BW_CONFIG_WORD, each ending with a NULL name. */
#pragma once
#include "bw_config.h"
#include "bw_solid_law.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const bw_config_word bw_solid_correction_words[];  /* bw_pd_surface_correction */
extern const bw_config_word bw_solid_fraction_words[];    /* bw_pd_volume_fraction */
extern const bw_config_word bw_solid_reach_words[];       /* bw_pd_family_reach */
extern const bw_config_word bw_solid_calibration_words[]; /* bw_pd_calibration */
extern const bw_config_word bw_solid_integrator_words[];  /* bw_solid_integrator */
extern const bw_config_word bw_solid_law_words[];         /* bw_solid_law_row */
extern const bw_config_word bw_solid_influence_words[];   /* bw_pd_state_influence */
extern const bw_config_word bw_solid_weight_words[];      /* bw_pd_state_weight */
extern const bw_config_word bw_solid_elastic_words[];     /* bw_pd_material_elastic */
extern const bw_config_word bw_solid_breaks_words[];      /* bw_pd_state_breaks */
extern const bw_config_word bw_solid_plastic_words[];     /* bw_solid_plastic */
extern const bw_config_word bw_solid_cone_words[];        /* bw_pd_material_cone */

/* Rows of a table of configuration for a struct T that has a bw_solid_law_choice as its member
 * `choice`: keys law, poisson_ratio and so on, side by side with the struct's own. */
#define BW_SOLID_LAW_KEYS(T)                                                                       \
  BW_SOLID_LAW_WORD_(T, law, bw_solid_law_words, "how it answers to deformation"),                 \
      BW_SOLID_LAW_VALUE_(T, poisson_ratio, BW_BETWEEN(-1, 0.5), "",                               \
                          "Poisson's ratio; left out: that of bonds, 1/4, in plane stress 1/3"),   \
      BW_SOLID_LAW_WORD_(T, influence, bw_solid_influence_words,                                   \
                         "law ordinary: how much a neighbour at a distance counts"),               \
      BW_SOLID_LAW_WORD_(T, weight, bw_solid_weight_words,                                         \
                         "law correspondence: how much a neighbour at a distance counts"),         \
      BW_SOLID_LAW_WORD_(T, elastic, bw_solid_elastic_words, "law correspondence: its energy"),    \
      BW_SOLID_LAW_VALUE_(T, stabilisation, BW_FROM_TO(0, 100), "",                                \
                          "law correspondence: stiffness against modes without energy, over mu"),  \
      BW_SOLID_LAW_WORD_(T, breaks, bw_solid_breaks_words,                                         \
                         "law correspondence: what breaks a bond"),                                \
      BW_SOLID_LAW_VALUE_(T, limit, BW_ABOVE(0), "Pa or 1",                                        \
                          "stress, cohesion or factor of flow that a pair bears"),                 \
      BW_SOLID_LAW_WORD_(T, plastic, bw_solid_plastic_words, "law correspondence: how it yields"), \
      BW_SOLID_LAW_VALUE_(T, yield_stress, BW_ABOVE(0), "Pa", "of J2: uniaxial stress"),           \
      BW_SOLID_LAW_VALUE_(T, hardening, BW_AT_LEAST(0), "Pa",                                      \
                          "of J2: slope of that stress; left out: 0"),                             \
      BW_SOLID_LAW_VALUE_(T, cohesion, BW_ABOVE(0), "Pa", "of Drucker-Prager: cohesion"),          \
      BW_SOLID_LAW_VALUE_(T, friction_angle, BW_FROM_TO(0, 89), "deg",                             \
                          "of Drucker-Prager and Mohr-Coulomb: friction"),                         \
      BW_SOLID_LAW_VALUE_(T, dilation_angle, BW_FROM_TO(0, 89), "deg",                             \
                          "of Drucker-Prager: angle of dilation; left out: 0"),                    \
      BW_SOLID_LAW_WORD_(T, cone, bw_solid_cone_words,                                             \
                         "of Drucker-Prager: where the cone meets Mohr-Coulomb's pyramid")

/* For the macro above: a row whose key is the member's name within `choice`. */
#define BW_SOLID_LAW_VALUE_(T, m, range, unit, help)                                               \
  {                                                                                                \
#m, BW_CONFIG_TYPE_DOUBLE, BW_OPTIONAL, offsetof(T, choice.m), sizeof(double), sizeof(double), \
        BW_CONFIG_NO_FLAG, range, unit, help, NULL, NULL                                           \
  }
/* The same of a word. */
#define BW_SOLID_LAW_WORD_(T, m, words, help)                                                      \
  {                                                                                                \
#m, BW_CONFIG_TYPE_WORD, BW_OPTIONAL, offsetof(T, choice.m), sizeof(int), sizeof(int),         \
        BW_CONFIG_NO_FLAG, BW_ANY, "", help, words, NULL                                           \
  }

#ifdef __cplusplus
}
#endif
