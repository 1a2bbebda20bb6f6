/* Stress and strain of the medium, and how they are distributed (POROUS 6.4.3). */
#include "bw_file.h"
#include "bw_memory.h"
#include "porous_case.h"

#include <math.h>
#include <stdio.h>

bw_status porous_tensors_make(porous_run *p, porous_tensors *t)
{
  const size_t n = bw_solid_count(p->solid);
  double *F = NULL, *tensor = NULL;
  *t = (porous_tensors){0};
  bw_status st = BW_ALLOCATE(&F, 9 * n);
  BW_THEN(st, BW_ALLOCATE(&tensor, BW_PD_SYMMETRIC * n));
  BW_THEN(st, BW_ALLOCATE(&t->stress, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&t->strain, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&t->von_mises, n));
  st = bw_comm_agree(p->comm, st);
  /* One tensor after the other in the same array: stress, then strain from F. */
  if (st == BW_OK) {
    bw_solid_stress_compute(p->solid, F, tensor);
    bw_pd_tensor_von_mises(n, tensor, t->von_mises);
    st = bw_pd_tensor_principal(n, tensor, t->stress, NULL);
    bw_pd_tensor_strain(n, F, tensor);
    BW_THEN(st, bw_pd_tensor_principal(n, tensor, t->strain, NULL));
    st = bw_comm_agree(p->comm, st);
  }
  bw_release(&F);
  bw_release(&tensor);
  if (st != BW_OK) porous_tensors_release(t);
  return st;
}

void porous_tensors_release(porous_tensors *t)
{
  bw_release(&t->stress);
  bw_release(&t->strain);
  bw_release(&t->von_mises);
}

/* The clamped layer does not move and is left out. An odd number of bins: what is at rest is in the
 * middle of one, not on an edge. */
enum { BINS = 201, CURVES = 3 };
static const double RANGE = 2; /* of the limits E s0 and s0 */

static bw_status densities(const porous_run *p, const porous_tensors *t,
                           double density[CURVES][BINS], double outside[CURVES])
{
  const size_t n = bw_solid_count(p->solid);
  const uint8_t *kind = bw_solid_kind(p->solid);
  const double s0 = bw_solid_critical_stretch(p->solid);
  const double limit[CURVES] = {p->config->solid.young_modulus * s0,
                                p->config->solid.young_modulus * s0, s0};
  double *value = NULL, *weight = NULL;
  bw_status st = BW_ALLOCATE(&value, n);
  BW_THEN(st, BW_ALLOCATE(&weight, n));
  st = bw_comm_agree(p->comm, st);
  /* Clamped particles weigh nothing. */
  for (size_t i = 0; st == BW_OK && i < n; i++)
    weight[i] = (kind[i] & BW_PD_PRESCRIBED) == 0;
  /* Each over the value at which a bond would break. */
  for (int c = 0; c < CURVES && st == BW_OK; c++) {
    for (size_t i = 0; i < n; i++) {
      const double of[CURVES] = {t->stress[3 * i], t->von_mises[i], t->strain[3 * i]};
      value[i] = of[c] / limit[c];
    }
    st = bw_solid_stress_pdf(p->comm, n, value, weight, -RANGE, RANGE, BINS, density[c],
                             &outside[c]);
  }
  bw_release(&value);
  bw_release(&weight);
  return st;
}

bw_status porous_stress_csv(porous_run *p)
{
  enum { ROW = 80 }; /* characters of a line at most */
  porous_tensors t;
  double density[CURVES][BINS], outside[CURVES];
  char text[ROW * (BINS + 3)], name[64], *path = NULL;
  BW_TRY(porous_tensors_make(p, &t));
  bw_status st = densities(p, &t, density, outside);
  /* The densities hold all that is needed. */
  porous_tensors_release(&t);
  BW_TRY(st);
  /* All ranks make the same text; rank 0 writes it. */
  int used =
      snprintf(text, 3 * ROW,
               "# limit: stress %.9g Pa, strain %.9g; outside the range: %.3g %.3g %.3g\n"
               "over_limit[-],max_principal_stress[-],von_mises[-],max_principal_strain[-]\n",
               p->config->solid.young_modulus * bw_solid_critical_stretch(p->solid),
               bw_solid_critical_stretch(p->solid), outside[0], outside[1], outside[2]);
  for (int b = 0; b < BINS; b++)
    used += snprintf(text + used, ROW, "%.9g,%.9g,%.9g,%.9g\n", RANGE * ((2 * b + 1.0) / BINS - 1),
                     density[0][b], density[1][b], density[2][b]);
  snprintf(name, sizeof name, "stress-%s.csv", porous_phase_name[p->phase]);
  st = bw_case_path(p->run, name, &path);
  BW_THEN(st, bw_file_write_text(p->comm, path, text));
  bw_release(&path);
  return st;
}
