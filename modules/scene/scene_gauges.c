/* Gauges: their columns, where they look, a row of the history. */
#include "scene_impl.h"

#include "bw_memory.h"
#include <math.h>
#include <string.h>

enum { COLUMN_NAME = 2 * BW_SCENE_NAME };

void bw_scene__gauges_destroy(bw_scene *s)
{
  for (int g = 0; g < BW_SCENE_GAUGES; g++)
    for (int q = 0; q < BW_SCENE_BODIES; q++)
      bw_release(&s->aim[g].particle[q]);
  for (int k = 0; k < s->n_columns && s->names != NULL; k++) {
    char *name = (char *)(uintptr_t)s->names[k];
    bw_release(&name);
  }
  bw_release(&s->names);
  bw_release(&s->column);
  bw_release(&s->row);
}

/* Columns of one quantity, from *n on; *column NULL: they are only counted. */
static void list_columns(const bw_scene *s, int gauge, const bw_scene__quantity *what,
                         bw_scene__column *column, int *n)
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  if (g->has_line || g->has_slice) return; /* files of their own */
  for (int k = 0; k < what->n; k++) {
    /* No third component in two dimensions; of what turns it is the only one. */
    const size_t length = strlen(what->component[k]);
    const bool third = length > 0 && what->component[k][length - 1] == 'z' &&
                       (length == 1 || what->component[k][length - 2] == '.');
    if (s->planar && third != what->axial && (third || what->axial)) continue;
    /* Only the routes to the force that hold. */
    if (strcmp(what->word, "force") == 0 &&
        !bw_scene__force_holds(&s->config, g, (bw_scene__route)(k / 3)))
      continue;
    if (column != NULL) column[*n] = (bw_scene__column){gauge, what, k};
    (*n)++;
  }
}

static void all_columns(const bw_scene *s, bw_scene__column *column, int *n)
{
  char word[BW_SCENE_NAME];
  *n = 1; /* time */
  for (int g = 0; g < s->config.n_gauges; g++)
    for (const char *rest = s->config.gauges[g].of; bw_scene__next_name(&rest, word);)
      list_columns(s, g, bw_scene__quantity_named(&s->config.gauges[g], word), column, n);
}

/* GAUGE, GAUGE.x, or with several quantities GAUGE.QUANTITY.x; and [unit]. */
static void name_column(const bw_scene *s, const bw_scene__column *c, char name[COLUMN_NAME])
{
  const bw_scene_gauge_config *g = &s->config.gauges[c->gauge];
  const bool several = strpbrk(g->of, " ,") != NULL;
  const char *part = c->what->component[c->component];
  snprintf(name, COLUMN_NAME, "%s%s%s%s%s[%s]", g->name, several ? "." : "",
           several ? c->what->word : "", part[0] != '\0' ? "." : "", part, c->what->unit);
}

static double spacing(const bw_scene *s, int solid, int32_t particle)
{
  return bw_solid_spacing(s->solid[solid].solid, (size_t)particle);
}

/* The nearest particles of this rank: all that are as near as the nearest of all ranks. */
static void keep_nearest(bw_scene *s, const bw_scene_gauge_config *g, bw_scene__aim *aim)
{
  double least = HUGE_VAL;
  for (int pass = 0; pass < 2; pass++) {
    for (int q = 0; q < s->n_solids; q++) {
      int kept = 0;
      for (int k = 0; k < aim->n[q]; k++) {
        const double *x = s->solid[q].X0 + 3 * aim->particle[q][k];
        const double z = s->planar ? 0.0 : x[2] - g->nearest[2];
        const double r = hypot(hypot(x[0] - g->nearest[0], x[1] - g->nearest[1]), z);
        if (pass == 0) least = fmin(least, r);
        if (pass == 1 && r <= least + 1e-6 * spacing(s, q, aim->particle[q][k]))
          aim->particle[q][kept++] = aim->particle[q][k];
      }
      if (pass == 1) aim->n[q] = kept;
    }
    if (pass == 0) bw_comm_min(s->comm, 1, &least);
  }
}

/* The particles of the bodies of a gauge; those that hold them count for the force on supports. */
static bool belongs(const bw_scene *s, const bw_scene_gauge_config *g, int b, bool support)
{
  const bw_scene_config *c = &s->config;
  if (g->body[0] == '\0' || bw_scene__listed(g->body, c->bodies[b].name)) return true;
  for (int a = 0; a < c->n_bodies && support; a++)
    for (int k = 0; k < c->bodies[a].n_held; k++)
      if (strcmp(c->bodies[a].held[k].by, c->bodies[b].name) == 0 &&
          bw_scene__listed(g->body, c->bodies[a].name))
        return true;
  return false;
}

static bw_status take_aim(bw_scene *s, int gauge)
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  bw_scene__aim *aim = &s->aim[gauge];
  const bool support = bw_scene__listed(g->of, "force_on_support");
  bw_status st = BW_OK;
  for (int q = 0; q < s->n_solids; q++)
    BW_THEN(st, BW_ALLOCATE(&aim->particle[q], s->solid[q].n));
  BW_TRY(bw_comm_agree(s->comm, st));
  /* Every rank notes its own particles that the gauge looks at. */
  for (int q = 0; q < s->n_solids; q++) {
    for (size_t i = 0; i < s->solid[q].n; i++) {
      const int b = bw_scene__body_of(&s->solid[q], i);
      if (!belongs(s, g, b, support)) continue;
      const double *x = s->solid[q].X0 + 3 * i, ds = bw_solid_spacing(s->solid[q].solid, i);
      if (g->has_region && !bw_scene__in_box(&g->region, s->planar, ds, x)) continue;
      if (support && !(bw_solid_kind(s->solid[q].solid)[i] & BW_PD_PRESCRIBED)) continue;
      aim->particle[q][aim->n[q]++] = (int32_t)i;
    }
  }
  /* Of all ranks: the nearest ones, and how many there are. A gauge of none would print nothing for
   * ever, so it is refused. */
  if (bw_scene__given(g->nearest)) keep_nearest(s, g, aim);
  for (int q = 0; q < s->n_solids; q++)
    for (int k = 0; k < aim->n[q]; k++)
      aim->count += bw_scene__share(&s->solid[q], (size_t)aim->particle[q][k]);
  bw_comm_sum(s->comm, 1, &aim->count);
  BW_REQUIRE(aim->count > 0, BW_EINPUT,
             "gauges.%s: no %sparticle of %s is there; change region or body", g->name,
             support ? "held " : "", g->body[0] != '\0' ? g->body : "any body");
  return BW_OK;
}

/* Does a quantity of this gauge look at particles? */
static bool looks_at_particles(const bw_scene *s, const bw_scene_gauge_config *g)
{
  char word[BW_SCENE_NAME];
  for (const char *rest = g->of; bw_scene__next_name(&rest, word);) {
    const bw_scene__quantity *what = bw_scene__quantity_named(g, word);
    if (bw_scene__of_rigid(&s->config, g, what)) continue;
    if (what->source == BW_SCENE__OF_PLACE || strcmp(word, "force_on_support") == 0 ||
        strcmp(word, "crack_tip") == 0)
      return true;
  }
  return false;
}

bw_status bw_scene__gauges_aim(bw_scene *s)
{
  for (int g = 0; g < s->config.n_gauges; g++) {
    if (s->aim[g].count == 0) continue;
    for (int q = 0; q < s->n_solids; q++) {
      bw_release(&s->aim[g].particle[q]);
      s->aim[g].n[q] = 0;
    }
    s->aim[g].count = 0;
    BW_TRY(take_aim(s, g));
  }
  return BW_OK;
}

bw_status bw_scene__gauges_create(bw_scene *s)
{
  int n = 0;
  all_columns(s, NULL, &n);
  /* Counted, now there is room for columns, their names and a row. */
  bw_status st = BW_ALLOCATE(&s->column, (size_t)n);
  BW_THEN(st, BW_ALLOCATE(&s->names, (size_t)n));
  BW_THEN(st, BW_ALLOCATE(&s->row, (size_t)n));
  for (int k = 0; st == BW_OK && k < n; k++) {
    char *name = NULL;
    st = BW_ALLOCATE(&name, COLUMN_NAME);
    s->names[k] = name;
    s->n_columns = k + 1;
  }
  BW_TRY(bw_comm_agree(s->comm, st));
  all_columns(s, s->column, &n);
  for (int k = 0; k < n; k++) {
    char *name = (char *)(uintptr_t)s->names[k];
    if (k == 0)
      snprintf(name, COLUMN_NAME, "time[T]");
    else
      name_column(s, &s->column[k], name);
  }
  /* Columns are named. Particles are looked up once, as they stay with their rank. */
  for (int g = 0; g < s->config.n_gauges; g++)
    if (!s->sketched && looks_at_particles(s, &s->config.gauges[g])) {
      BW_REQUIRE(
          s->n_solids > 0, BW_EINPUT,
          "gauges.%s: bodies of this scene do not deform, they have no particles to look at; "
          "ask for of: force",
          s->config.gauges[g].name);
      BW_TRY(take_aim(s, g));
    }
  return s->sketched ? BW_OK : bw_scene__note_cuts(s);
}

int bw_scene_columns(const bw_scene *s, const char *const **names)
{
  *names = s->names;
  return s->n_columns;
}

static bw_status measure(bw_scene *s, int gauge, const bw_scene__quantity *what,
                         double value[BW_SCENE__COMPONENTS])
{
  for (int k = 0; k < BW_SCENE__COMPONENTS; k++)
    value[k] = NAN;
  if (bw_scene__of_rigid(&s->config, &s->config.gauges[gauge], what))
    return bw_scene__measure_rigid(s, gauge, what, value);
  const bool fluid = what->source >= BW_SCENE__OF_POINT || strcmp(what->word, "force") == 0;
  if (fluid && s->water != NULL) return bw_scene__measure_water(s, gauge, what, value);
  if (fluid) return bw_scene__measure_fluid(s, gauge, what, value);
  return bw_scene__measure_solid(s, gauge, what, value);
}

bw_status bw_scene_measure(bw_scene *s, double row[])
{
  double value[BW_SCENE__COMPONENTS];
  row[0] = s->time;
  for (int k = 1; k < s->n_columns; k++) {
    const bw_scene__column *c = &s->column[k], *before = &s->column[k - 1];
    /* Each quantity once; its components are columns side by side. */
    if (k == 1 || before->gauge != c->gauge || before->what != c->what)
      BW_TRY(measure(s, c->gauge, c->what, value));
    row[k] = value[c->component];
  }
  /* Wall pressures are means from row to row. */
  if (s->water != NULL) {
    memset(s->water->patch, 0, sizeof s->water->patch);
    s->water->covered = 0.0;
  }
  return BW_OK;
}

int bw_scene__column_named(const bw_scene *s, const char *name)
{
  for (int k = 1; k < s->n_columns; k++) {
    const size_t own = strcspn(s->names[k], "[");
    if (own == strlen(name) && strncmp(s->names[k], name, own) == 0) return k;
  }
  return -1;
}

void bw_scene__column_names(const bw_scene *s, const char *name, size_t size, char list[])
{
  char own_name[BW_SCENE_NAME];
  size_t used = 0;
  snprintf(own_name, sizeof own_name, "%.*s", (int)strcspn(name, "."), name);
  const int gauge = bw_scene__gauge_named(&s->config, own_name);
  list[0] = '\0';
  for (int k = 1; k < s->n_columns; k++) {
    const size_t own = strcspn(s->names[k], "[");
    if ((gauge >= 0 && s->column[k].gauge != gauge) || used + own + 3 > size) continue;
    used += (size_t)snprintf(list + used, size - used, "%s%.*s", used > 0 ? ", " : "", (int)own,
                             s->names[k]);
  }
}

bw_status bw_scene_gauge(bw_scene *s, const char *name, double *value)
{
  char known[512];
  double all[BW_SCENE__COMPONENTS];
  const int k = bw_scene__column_named(s, name);
  bw_scene__column_names(s, name, sizeof known, known);
  BW_REQUIRE(k > 0, BW_EINPUT, "scene: there is no gauge %s; there are: %s", name, known);
  BW_TRY(measure(s, s->column[k].gauge, s->column[k].what, all));
  *value = all[s->column[k].component];
  return BW_OK;
}
