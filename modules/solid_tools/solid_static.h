/* solid_static.h -- shared by the relaxation and the linear solve. */
#pragma once
#include "bw_solid_static.h"
#include "pd_law.h"

bw_status bw_solid_static__check(const bw_solid *s, const bw_solid_static_config *config);

/* What residuals are measured by: at least `floor` (the scale before bonds broke, else 0). */
typedef struct {
  double floor, first, scale; /* first: -1 before the first call */
} bw_solid_static_scale;

/* Residual from norms squared of all ranks: of the free rows, of F, of the reactions. */
double bw_solid_static__residual(double free2, double F2, double reaction2,
                                 bw_solid_static_scale *s);
