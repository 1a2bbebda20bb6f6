/* channel_case.h -- turbulent channel flow: what the sources of the case share. */
#pragma once
#include "bw_case.h"
#include "bw_history.h"
#include "channel_flow.h"

/* What the YAML file says (tables in channel_config.c). */
typedef struct {
  double length[3]; /* box [h]; length[1] is 1 */
  int cells[3];
  double stretch;   /* of y by tanh [-]; 0: uniform               default 0 */
  char faces[1024]; /* path of a file with the faces in y; empty: none */
} channel_domain;
typedef struct {
  double reynolds;     /* U_b h/nu [-] */
  double perturbation; /* of the first velocity [U_b]                default 0.2 */
  int viscous;         /* bw_ns_viscous                              default explicit */
  int eddy;            /* bw_ns_eddy                                 default none */
} channel_fluid;
typedef struct {
  double spin_up;       /* before the statistics [h/U_b] */
  double statistics;    /* their length [h/U_b] */
  double interval;      /* between samples [h/U_b]                   default 0.2 */
  double courant_share; /* step over the largest stable one [-]      default 0.8 */
} channel_time;
typedef struct {
  double checkpoint_every; /* checkpoint and profiles so far [h/U_b] default 5 */
} channel_output;
typedef struct {
  channel_domain domain;
  channel_fluid fluid;
  channel_time time;
  channel_output output;
} channel_case;

extern const bw_config_field channel_fields[]; /* its keys */
channel_case channel_case_default(void);       /* required values NaN or INT_MIN */
/* What the recipe (channel_flow.h) wants of it; borrows c->domain.faces. */
channel_config channel_config_of(const channel_case *c);

/* channel_output.c: sizes and times of what will run. Local. */
void channel_describe(const bw_grid *plan, const bw_ns_plan *known, const channel_case *c,
                      bw_log *log);
/* Creates history.csv, or goes on with it from the checkpoint that was read. Collective. */
bw_status channel_open_history(const channel_flow *f, const bw_case *run,
                               bw_history **out) BW_MUST_CHECK;
/* A row of history.csv; returns Re_tau of the present wall shear. Collective. */
double channel_record(channel_flow *f, bw_history *history);
/* centres.csv and faces.csv in wall units, scalars.csv; nothing before the first full batches.
 * Collective. */
bw_status channel_profiles(channel_flow *f, const bw_case *run) BW_MUST_CHECK;

/* channel_spectra.c: correlations_x.csv, correlations_z.csv, spectra_x.csv, spectra_z.csv, both
 * halves averaged; nothing before the first sample. Collective. */
bw_status channel_spectra(channel_flow *f, const bw_case *run) BW_MUST_CHECK;

/* The columns of the profiles into an HDF5 file, as arrays TABLE/COLUMN. Collective. */
bw_status channel_profiles_hdf5(channel_flow *f, bw_checkpoint *ck) BW_MUST_CHECK;
/* Those of correlations and spectra. Collective. */
bw_status channel_spectra_hdf5(channel_flow *f, bw_checkpoint *ck) BW_MUST_CHECK;
