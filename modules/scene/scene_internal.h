/* scene_internal.h -- shared by the sources of `scene` only. */
#pragma once
#include "bw_scene_config.h"

/* Tables of scene_fields*.c; each ends with BW_CONFIG_END. */
extern const bw_config_field bw_scene__fluid_fields[];
extern const bw_config_field bw_scene__material_fields[];
extern const bw_config_field bw_scene__body_fields[];
extern const bw_config_field bw_scene__box_fields[];
extern const bw_config_field bw_scene__shape_fields[];
extern const bw_config_field bw_scene__load_fields[];
extern const bw_config_field bw_scene__phase_fields[];
extern const bw_config_field bw_scene__gauge_fields[];
extern const bw_config_field bw_scene__watch_fields[];
extern const bw_config_field bw_scene__output_fields[];
extern const bw_config_field bw_scene__numerics_fields[];
extern const bw_config_word bw_scene__axis_words[];
extern const bw_config_word bw_scene__motion_words[];
extern const bw_config_word bw_scene__truth_words[]; /* false 0, true 1 */

/* The word of a value; "?" where there is none. */
const char *bw_scene__word(const bw_config_word words[], int value);

/* The word of a law. */
typedef struct bw_pd_law bw_pd_law;
const char *bw_scene__law_name(const bw_pd_law *law);

/* Number of the body, material, gauge of this name; -1: none. */
int bw_scene__body_named(const bw_scene_config *c, const char *name);
int bw_scene__material_named(const bw_scene_config *c, const char *name);
int bw_scene__gauge_named(const bw_scene_config *c, const char *name);

/* The next of the names in *rest, which are apart by blanks or commas; false: no more. */
bool bw_scene__next_name(const char **rest, char name[BW_SCENE_NAME]);
/* Is this name among them? */
bool bw_scene__listed(const char *names, const char *name);

/* st; where it is BW_EINPUT of a message that names no body, that of this one is put before it. */
bw_status bw_scene__of_body(const bw_scene_config *c, int b, bw_status st);

/* "NAME, NAME": what there is, for messages. */
void bw_scene__body_names(const bw_scene_config *c, size_t size, char *text);
