/* Loads that fill cracks: where their source is, and how much they fill. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <string.h>

bool bw_scene__in_cracks(const bw_scene_load *l)
{
  return l->kind == BW_SCENE_PRESSURE && strcmp(l->where.side, "crack") == 0;
}

/* Particles of the body that the cracks of the start have cost bonds, those in the box if there is
 * one. Local. */
static void find_source(const bw_scene *s, const bw_scene__acting *a, const uint16_t broken[],
                        bool source[])
{
  const bw_scene_load *l = &s->config.loads[a->load];
  const bw_scene__solid *q = &s->solid[a->solid];
  const int body = bw_scene__body_named(&s->config, l->on);
  bw_scene_where box = l->where;
  box.side[0] = '\0';
  for (size_t i = 0; i < q->n; i++)
    source[i] = broken[i] > 0 && bw_scene__body_of(q, i) == body &&
                bw_scene__in_where(&box, s->planar, bw_solid_settings(q->solid)->ds, NULL, NULL,
                                   q->X0 + 3 * i);
}

bw_status bw_scene__fill_cracks(bw_scene *s, bw_scene__acting *a)
{
  const bw_scene__solid *q = &s->solid[a->solid];
  uint16_t *broken = NULL;
  bool *source = NULL;
  int64_t some = 0;
  bw_status st = BW_ALLOCATE(&broken, q->n);
  BW_THEN(st, BW_ALLOCATE(&source, q->n));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK) {
    bw_solid_get_broken(q->solid, broken);
    find_source(s, a, broken, source);
  }
  for (size_t i = 0; st == BW_OK && i < q->n; i++)
    some += source[i];
  bw_comm_sum_int(s->comm, 1, &some);
  if (st == BW_OK && some == 0)
    st =
        BW_FAIL(BW_EINPUT,
                "loads.%d.where.box: no crack of %s begins in it; leave it out, and all its cracks "
                "are filled",
                a->load, s->config.loads[a->load].on);
  BW_THEN(st, bw_solid_crack_create(q->solid, source, &a->crack));
  bw_release(&broken);
  bw_release(&source);
  return st;
}

bw_status bw_scene__measure_cracks(bw_scene *s, const char *names, bw_solid_crack_size *out)
{
  *out = (bw_solid_crack_size){0};
  for (int k = 0; k < s->n_acting; k++) {
    bw_solid_crack_size size;
    const bw_scene__acting *a = &s->acting[k];
    if (a->crack == NULL || !bw_scene__listed(names, s->config.loads[a->load].on)) continue;
    BW_TRY(bw_solid_crack_measure(a->crack, &size));
    out->bonds += size.bonds, out->area += size.area, out->volume += size.volume;
  }
  return BW_OK;
}
