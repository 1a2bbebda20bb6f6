/* Lines and slices of the fluid: a file of places and values each time. */
#include "scene_impl.h"

#include "bw_file.h"
#include "bw_memory.h"
#include <math.h>
#include <string.h>

/* How many places a gauge looks at; X NULL: only counted. */
static size_t places(const bw_scene *s, const bw_scene_gauge_config *g, double *X)
{
  const bw_grid_view *v = bw_grid_look(s->grid);
  if (g->has_line) {
    for (int q = 0; X != NULL && q < g->line.points; q++)
      for (int d = 0; d < 3; d++)
        X[3 * q + d] =
            g->line.from[d] + q * (g->line.to[d] - g->line.from[d]) / (g->line.points - 1.0);
    return (size_t)g->line.points;
  }
  /* The cells of a slice, by their centres. */
  const int a = (g->slice.axis + 1) % 3, b = (g->slice.axis + 2) % 3;
  const size_t n = (size_t)v->n[a] * (size_t)v->n[b];
  for (size_t q = 0; X != NULL && q < n; q++) {
    const int at[2] = {(int)(q % (size_t)v->n[a]) + 1, (int)(q / (size_t)v->n[a]) + 1};
    const int d[2] = {a, b};
    X[3 * q + (size_t)g->slice.axis] = g->slice.at;
    for (int k = 0; k < 2; k++)
      X[3 * q + (size_t)d[k]] = d[k] == 1 ? v->y_centre[at[k]] : (at[k] - 0.5) * v->spacing[d[k]];
  }
  return n;
}

/* One text, written by rank 0. */
static bw_status write_rows(bw_scene *s, const char *path, size_t n, const double *X,
                            const double *u, const double *p)
{
  char *text = NULL;
  size_t length = 0;
  bw_status st = BW_OK;
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) st = BW_FAIL(BW_EMEM, "no memory to write %s", path);
  BW_TRY(bw_comm_agree(s->comm, st));
  fprintf(out, "x[L],y[L],z[L]%s%s\n", u != NULL ? ",u[L/T],v[L/T],w[L/T]" : "",
          p != NULL ? ",pressure[M/(L T2)]" : "");
  for (size_t q = 0; q < n; q++) {
    fprintf(out, "%.9g,%.9g,%.9g", X[3 * q], X[3 * q + 1], X[3 * q + 2]);
    if (u != NULL) fprintf(out, ",%.9g,%.9g,%.9g", u[3 * q], u[3 * q + 1], u[3 * q + 2]);
    if (p != NULL) fprintf(out, ",%.9g", p[q]);
    fputc('\n', out);
  }
  if (fclose(out) != 0) st = BW_FAIL(BW_EMEM, "no memory to write %s", path);
  st = bw_comm_agree(s->comm, st);
  BW_THEN(st, bw_file_write_text(s->comm, path, text));
  bw_release(&text);
  return st;
}

bw_status bw_scene__profiles(bw_scene *s, const bw_case *run, int gauge)
{
  const bw_scene_gauge_config *g = &s->config.gauges[gauge];
  char name[BW_SCENE_NAME + 32], *path = NULL;
  double *X = NULL, *u = NULL, *p = NULL;
  size_t n = places(s, g, NULL);
  const bool velocity = bw_scene__listed(g->of, "velocity");
  const bool pressure = bw_scene__listed(g->of, "pressure");
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  if (velocity) BW_THEN(st, BW_ALLOCATE(&u, 3 * n));
  if (pressure) BW_THEN(st, BW_ALLOCATE(&p, n));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK) {
    n = places(s, g, X);
    if (velocity) bw_scene__sample(s, false, n, X, u);
    if (pressure) bw_scene__sample(s, true, n, X, p);
    snprintf(name, sizeof name, "%s-%06lld.csv", g->name, llround(s->time / g->every));
    st = bw_case_path(run, name, &path);
  }
  BW_THEN(st, write_rows(s, path, n, X, u, p));
  bw_release(&path);
  bw_release(&X);
  bw_release(&u);
  bw_release(&p);
  return st;
}
