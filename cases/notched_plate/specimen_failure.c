/* Gauges of failure of a specimen, for its pictures and a list. */
#include "specimen_failure.h"
#include "bw_file.h"
#include "bw_memory.h"
#include <math.h>
#include <stdio.h>

enum { PLACES = 20, ROW = 120 }; /* of the list; characters of a line at most */

int specimen_gauges(const specimen *p, int asked[BW_SOLID_FAILURE_GAUGES])
{
  const specimen_strength *s = &p->config.strength;
  /* In the order of bw_solid_failure_gauge; stretch is known where the law has one. */
  const bool wanted[BW_SOLID_FAILURE_GAUGES] = {
      !isnan(s->tension),  !isnan(s->tension),  !isnan(s->yield),
      !isnan(s->cohesion), !isnan(s->cohesion), !isnan(bw_solid_critical_stretch(p->solid)),
      !isnan(s->flaw)};
  const bool any = !isnan(s->tension) || !isnan(s->yield) || !isnan(s->cohesion) || !isnan(s->flaw);
  int n = 0;
  for (int g = 0; g < BW_SOLID_FAILURE_GAUGES && any; g++)
    if (wanted[g]) asked[n++] = g;
  return n;
}

bw_status specimen_used(specimen *p, double used[])
{
  const specimen_strength *s = &p->config.strength;
  bw_solid_strength k = bw_solid_strength_of(p->solid);
  BW_REQUIRE(isnan(s->cohesion) == isnan(s->friction_angle), BW_EINPUT,
             "strength: cohesion = %g and friction_angle = %g are given together or not at all",
             s->cohesion, s->friction_angle);
  BW_REQUIRE(isnan(s->flaw) || !isnan(k.G0), BW_EINPUT,
             "strength.flaw = %g needs solid.fracture_energy", s->flaw);
  k.tension = s->tension, k.yield = s->yield, k.cohesion = s->cohesion, k.flaw = s->flaw;
  k.friction = s->friction_angle * acos(-1.0) / 180.0;
  BW_TRY(bw_solid_failure_compute(p->solid, &k, used));
  return isnan(s->flaw) ? BW_OK : bw_solid_failure_griffith(p->solid, &k, 0.5, used);
}

bw_status specimen_weakest(specimen *p, const bw_case *run, const double used[])
{
  int asked[BW_SOLID_FAILURE_GAUGES];
  char name[64], *path = NULL, *text = NULL;
  const int n = specimen_gauges(p, asked);
  snprintf(name, sizeof name, "weakest-%06lld.csv", (long long)p->steps);
  bw_status st = bw_case_path(run, name, &path);
  BW_THEN(st, BW_ALLOCATE(&text, ROW * (size_t)(n * PLACES + 1)));
  st = bw_comm_agree(p->comm, st);
  size_t end = st != BW_OK ? 0 : (size_t)snprintf(text, ROW, "gauge,load,x[m],y[m],z[m]\n");
  /* All ranks have the same list, and write the same text. */
  for (int q = 0; q < n && st == BW_OK; q++) {
    bw_solid_failure_place place[PLACES];
    int found = 0;
    st = bw_solid_failure_list(p->solid, used, (bw_solid_failure_gauge)asked[q], PLACES, place,
                               &found);
    for (int k = 0; k < found; k++)
      end += (size_t)snprintf(text + end, ROW, "%s,%.6g,%.6g,%.6g,%.6g\n",
                              bw_solid_failure_name[asked[q]], place[k].load, place[k].X0[0],
                              place[k].X0[1], place[k].X0[2]);
  }
  BW_THEN(st, bw_file_write_text(p->comm, path, text));
  bw_release(&text);
  bw_release(&path);
  return st;
}
