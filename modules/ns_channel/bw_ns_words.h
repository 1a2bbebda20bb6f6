/* bw_ns_words.h -- the words of case files for the choices of bw_ns_channel_config: lists for
 * BW_CONFIG_WORD, each ending with a NULL name. */
#pragma once
#include "bw_config.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const bw_config_word bw_ns_side_words[];    /* bw_ns_side_kind */
extern const bw_config_word bw_ns_profile_words[]; /* bw_ns_profile, without callback */
extern const bw_config_word bw_ns_forcing_words[]; /* bw_ns_forcing, without none */
extern const bw_config_word bw_ns_viscous_words[]; /* bw_ns_viscous */
extern const bw_config_word bw_ns_eddy_words[];    /* bw_ns_eddy */

#ifdef __cplusplus
}
#endif
