/* fuzz_case.h -- a case with one of everything that a table can have. */
#pragma once
#include "bw_config.h"

#include <limits.h>
#include <math.h>

typedef struct {
  double x[3], radius;
  int kind;
} fuzz_body;

typedef struct {
  double nu;
  int n[3];
  bool periodic[2];
  char file[100], name[20];
  bool has_probe;
  fuzz_body probe;
  int bodies_given;
  fuzz_body bodies[4];
} fuzz_case;

static const bw_config_word fuzz_kinds[] = {{"ball", 0, ""}, {"box", 1, ""}, {0}};
static const bw_config_field fuzz_body_fields[] = {
    BW_CONFIG_VALUE(fuzz_body, x, BW_OPTIONAL, BW_FROM_TO(-1, 1), "m", "place"),
    BW_CONFIG_VALUE(fuzz_body, radius, BW_REQUIRED, BW_ABOVE(0), "m", "radius"),
    BW_CONFIG_WORD(fuzz_body, kind, BW_OPTIONAL, fuzz_kinds, "kind"), BW_CONFIG_END};
static const bw_config_field fuzz_fields[] = {
    BW_CONFIG_VALUE(fuzz_case, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "viscosity"),
    BW_CONFIG_VALUE(fuzz_case, n, BW_REQUIRED, BW_AT_LEAST(1), "", "cells"),
    BW_CONFIG_VALUE(fuzz_case, periodic, BW_OPTIONAL, BW_ANY, "", "periodic"),
    BW_CONFIG_VALUE(fuzz_case, file, BW_OPTIONAL, BW_FILE, "", "a file"),
    BW_CONFIG_VALUE(fuzz_case, name, BW_OPTIONAL, BW_ANY, "", "a name"),
    BW_CONFIG_MAP_IF(fuzz_case, probe, has_probe, fuzz_body_fields, "one that may be there"),
    BW_CONFIG_LIST(fuzz_case, bodies, bodies_given, BW_OPTIONAL, fuzz_body_fields, "several"),
    BW_CONFIG_END};

/* Nothing is given yet. */
static inline fuzz_case fuzz_case_default(void)
{
  const fuzz_body body = {.radius = NAN};
  return (fuzz_case){.nu = NAN, .n = {INT_MIN, INT_MIN, INT_MIN}, .probe = body, .bodies = {body}};
}

/* What was read is dumped and loaded again, to the same text; else the program ends. */
void fuzz_there_and_back(const fuzz_case *c);
