/* bw_solid_words.h -- the words of case files for the choices of bw_solid_config: lists for
 * BW_CONFIG_WORD, each ending with a NULL name. */
#pragma once
#include "bw_config.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const bw_config_word bw_solid_correction_words[]; /* bw_pd_surface_correction */
extern const bw_config_word bw_solid_fraction_words[];   /* bw_pd_volume_fraction */
extern const bw_config_word bw_solid_reach_words[];      /* bw_pd_family_reach */
extern const bw_config_word bw_solid_integrator_words[]; /* bw_solid_integrator */

#ifdef __cplusplus
}
#endif
