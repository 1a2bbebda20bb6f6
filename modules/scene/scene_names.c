/* Names of bodies, materials and gauges, and lists of them. */
#include "pd_law.h"
#include "scene_internal.h"

#include <string.h>

int bw_scene__body_named(const bw_scene_config *c, const char *name)
{
  for (int q = 0; q < c->n_bodies; q++)
    if (strcmp(c->bodies[q].name, name) == 0) return q;
  return -1;
}

int bw_scene__material_named(const bw_scene_config *c, const char *name)
{
  for (int q = 0; q < c->n_materials; q++)
    if (strcmp(c->materials[q].name, name) == 0) return q;
  return -1;
}

int bw_scene__gauge_named(const bw_scene_config *c, const char *name)
{
  for (int q = 0; q < c->n_gauges; q++)
    if (strcmp(c->gauges[q].name, name) == 0) return q;
  return -1;
}

bw_status bw_scene__of_body(const bw_scene_config *c, int b, bw_status st)
{
  if (st != BW_EINPUT || strncmp(bw_last_message(), "bodies.", strlen("bodies.")) == 0) return st;
  return BW_FAIL(st, "bodies.%s: %s", c->bodies[b].name, bw_last_message());
}

bool bw_scene__next_name(const char **rest, char name[BW_SCENE_NAME])
{
  const char *start = *rest + strspn(*rest, " ,\t");
  const size_t length = strcspn(start, " ,\t");
  if (length == 0) return false;
  snprintf(name, BW_SCENE_NAME, "%.*s", (int)length, start);
  *rest = start + length;
  return true;
}

bool bw_scene__listed(const char *names, const char *name)
{
  char one[BW_SCENE_NAME];
  while (bw_scene__next_name(&names, one))
    if (strcmp(one, name) == 0) return true;
  return false;
}

void bw_scene__body_names(const bw_scene_config *c, size_t size, char *text)
{
  size_t used = 0;
  text[0] = '\0';
  for (int q = 0; q < c->n_bodies && used + 1 < size; q++) {
    snprintf(text + used, size - used, "%s%s", q > 0 ? ", " : "", c->bodies[q].name);
    used += strlen(text + used);
  }
  if (used == 0) snprintf(text, size, "none");
}

const char *bw_scene__law_name(const bw_pd_law *law)
{
  return law->name;
}
