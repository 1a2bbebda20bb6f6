/* bw_scene.h -- a whole set-up read from one file, built from the modules it needs, and stepped.
 *
 *   bw_scene_config *c;  ...  bw_scene_config_default(c);
 *   bw_scene_read(comm, "scene.yaml", 0, NULL, c);
 *   bw_scene_create(comm, c, NULL, &scene);
 *   while (!bw_scene_done(scene)) bw_scene_step(scene, INFINITY);
 *   bw_scene_gauge(scene, "tip.y", &y);
 *   bw_scene_destroy(&scene);
 *
 * What is built follows from the file, and nothing else is: solids alone have no grid, a fluid
 * alone no particles; bodies that do not move beside others that do not deform are surfaces in the
 * fluid; what deforms in a flow is one solid of the coupler. bw_scene_blocks says what runs, and
 * why. Solids without fluid are stepped by bw_solid_step, several by bw_solid_assembly_step; a
 * fluid by bw_ns_channel_step; markers of bodies between its halves; fluid and solids by
 * bw_coupler_step.
 * Units    any consistent set: [M], [L], [T].
 * Life     config_default, read -> create -> { step, gauge }* -> destroy. Collective unless said
 *          otherwise. */
#pragma once
#include "bw_case.h"
#include "bw_checkpoint.h"
#include "bw_scene_config.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_scene bw_scene;

/* *c <- the file at `path` with overrides "key.path=value" (n of them), resolved and checked.
 * BW_EIO, BW_EINPUT. Collective. */
bw_status bw_scene_read(const bw_comm *comm, const char *path, int n_overrides,
                        const char *const overrides[], bw_scene_config *c) BW_MUST_CHECK;

/* Builds what the scene needs, at t = 0. The configuration is copied, resolved and checked again.
 * `log` may be NULL. BW_EINPUT names key and value; BW_EMEM, BW_EIO. *out is the caller's, NULL
 * after a failure. Collective. */
bw_status bw_scene_create(const bw_comm *comm, const bw_scene_config *config, bw_log *log,
                          bw_scene **out) BW_MUST_CHECK;
void bw_scene_destroy(bw_scene **scene); /* NULL is fine. Collective. */

/* The next step, as long as stability allows, which ends at `until` [T], the end of the phase or of
 * the scene at the latest; ends of phases are acted on. BW_ECFL, BW_EDIVERGED, BW_EMEM.
 * Collective. */
bw_status bw_scene_step(bw_scene *scene, double until) BW_MUST_CHECK;

/* Have all phases ended? The same on all ranks. Local. */
bool bw_scene_done(const bw_scene *scene);
double bw_scene_time(const bw_scene *scene);                     /* [T]. Local. */
int64_t bw_scene_steps(const bw_scene *scene);                   /* so far. Local. */
double bw_scene_last_step(const bw_scene *scene);                /* [T]. Local. */
int bw_scene_phase_now(const bw_scene *scene);                   /* number of the phase. Local. */
const bw_scene_config *bw_scene_settings(const bw_scene *scene); /* resolved, borrowed. Local. */

/* *value <- a gauge of a component, "tip.y", as of the last measure or now. BW_EINPUT for a name
 * that there is not (the message lists them). Collective. */
bw_status bw_scene_gauge(bw_scene *scene, const char *name, double *value) BW_MUST_CHECK;

/* Columns of a history: time[T] and every gauge; (n) names, borrowed. Local. */
int bw_scene_columns(const bw_scene *scene, const char *const **names);
/* row (columns) <- the present state; of steps that were not to be measured, forces are NaN.
 * Collective. */
bw_status bw_scene_measure(bw_scene *scene, double row[]) BW_MUST_CHECK;
/* Says whether the next steps will be measured (default true). Local. */
void bw_scene_expect(bw_scene *scene, bool measured);

/* One line for each block that can run: whether it does, and why. Local. */
void bw_scene_blocks(const bw_scene *scene, FILE *out);
/* Lines of sizes, limits of the step and what rules, and what will be poor. Collective. */
bw_status bw_scene_describe(bw_scene *scene, bw_log *log) BW_MUST_CHECK;

/* State into an open checkpoint, and back on any number of ranks: the run goes on as it would have.
 * BW_EINPUT when it does not fit, BW_EIO, BW_EMEM. Collective. */
bw_status bw_scene_save(bw_scene *scene, bw_checkpoint *ck) BW_MUST_CHECK;
bw_status bw_scene_restore(bw_scene *scene, bw_checkpoint *ck) BW_MUST_CHECK;

/* Files of the present state in the folder of the run: fluid.pvd, NAME.pvd of solids, lines and
 * slices. Collective. */
bw_status bw_scene_picture(bw_scene *scene, const bw_case *run) BW_MUST_CHECK;

/* The whole run of a case: history, pictures, checkpoints, what is watched. Collective. */
bw_status bw_scene_run(const bw_comm *comm, void *config, bw_case *run) BW_MUST_CHECK;

#ifdef __cplusplus
}
#endif
