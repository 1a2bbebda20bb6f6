/* bw_coupler_fields.h -- the `coupling:` block of a case's YAML: what of bw_coupler_config a user
 * chooses. The case sets the rest (densities, viscosity, walled sides). */
#pragma once
#include "bw_config.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The keys, for a struct bw_coupler_config; ends with BW_CONFIG_END. */
extern const bw_config_field bw_coupler_fields[];

/* The words of two of them, for BW_CONFIG_WORD. */
extern const bw_config_word bw_coupler_kernel_words[];  /* bw_kernel_delta_id */
extern const bw_config_word bw_coupler_profile_words[]; /* bw_probe_profile */

#ifdef __cplusplus
}
#endif
