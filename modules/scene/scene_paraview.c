/* open.pvsm: a state of ParaView that opens all series of a run at once. Written anew with each
 * picture, as the ranges of its colours grow; ParaView takes what it leaves out from its defaults.
 * Series are named by their full path, and ParaView asks where they are if the folder has moved. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "scene_impl.h"

#include "bw_file.h"
#include "bw_memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of the proxies: sources, what shows them, tables of colours. */
enum { SOURCE = 100, SHOWN = 300, COLOURS = 500, VIEW = 700 };

/* One series, and what colours it. */
typedef struct {
  char file[2 * BW_SCENE_NAME]; /* of the series, without its ending */
  const char *kind;             /* of representation */
  const char *look;             /* how it shows */
  bool cells;                   /* values are of cells, else of points */
  const char *array;
  double most; /* largest value */
  int slice;   /* number of the layer of a Slice, normal to z */
} shown;

static void put_text(FILE *out, const char *text)
{
  static const char *const names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
  for (; *text != '\0'; text++) {
    const char *found = strchr("&<>\"", *text);
    found != NULL ? (void)fputs(names[found - "&<>\""], out) : (void)fputc(*text, out);
  }
}

static void open_property(FILE *out, int id, const char *name, int n)
{
  fprintf(out, "      <Property name=\"%s\" id=\"%d.%s\" number_of_elements=\"%d\">\n", name, id,
          name, n);
}

static void put_numbers(FILE *out, int id, const char *name, int n, const double x[])
{
  open_property(out, id, name, n);
  for (int q = 0; q < n; q++)
    fprintf(out, "        <Element index=\"%d\" value=\"%.9g\"/>\n", q, x[q]);
  fputs("      </Property>\n", out);
}

static void put_word(FILE *out, int id, const char *name, const char *word)
{
  open_property(out, id, name, 1);
  fputs("        <Element index=\"0\" value=\"", out);
  put_text(out, word);
  fputs("\"/>\n      </Property>\n", out);
}

static void put_proxy(FILE *out, int id, const char *name, int value)
{
  open_property(out, id, name, 1);
  fprintf(out, "        <Proxy value=\"%d\" output_port=\"0\"/>\n      </Property>\n", value);
}

static void open_proxy(FILE *out, const char *group, const char *type, int id)
{
  fprintf(out, "    <Proxy group=\"%s\" type=\"%s\" id=\"%d\" servers=\"21\">\n", group, type, id);
}

/* The series, its colours from blue over white to red, and how it shows. */
static void put_series(FILE *out, const char *folder, int q, const shown *p)
{
  const double red_blue[] = {0.0,  0.23, 0.30,    0.75, 0.5 * p->most, 0.87,
                             0.87, 0.87, p->most, 0.71, 0.02,          0.15};
  char path[BW_SCENE_PATH + 2 * BW_SCENE_NAME + 8];
  snprintf(path, sizeof path, "%s/%s.pvd", folder, p->file);
  /* Three proxies of ParaView: the files, a table of colours, and how both are shown. */
  open_proxy(out, "sources", "PVDReader", SOURCE + q);
  put_word(out, SOURCE + q, "FileName", path);
  fputs("    </Proxy>\n", out);
  open_proxy(out, "lookup_tables", "PVLookupTable", COLOURS + q);
  put_numbers(out, COLOURS + q, "RGBPoints", 12, red_blue);
  put_numbers(out, COLOURS + q, "ScalarRangeInitialized", 1, (const double[]){1});
  put_numbers(out, COLOURS + q, "VectorMode", 1, (const double[]){0}); /* magnitude */
  fputs("    </Proxy>\n", out);
  open_proxy(out, "representations", p->kind, SHOWN + q);
  put_proxy(out, SHOWN + q, "Input", SOURCE + q);
  put_word(out, SHOWN + q, "Representation", p->look);
  put_numbers(out, SHOWN + q, "Visibility", 1, (const double[]){1});
  put_numbers(out, SHOWN + q, "PointSize", 1, (const double[]){4});
  if (p->slice > 0) put_numbers(out, SHOWN + q, "SliceMode", 1, (const double[]){5}); /* XY */
  if (p->slice > 0) put_numbers(out, SHOWN + q, "Slice", 1, (const double[]){p->slice});
  /* Elements 3 and 4 say where the values stand, at cells or at points, and their name. */
  open_property(out, SHOWN + q, "ColorArrayName", 5);
  for (int k = 0; k < 3; k++)
    fprintf(out, "        <Element index=\"%d\" value=\"\"/>\n", k);
  fprintf(out, "        <Element index=\"3\" value=\"%d\"/>\n", p->cells ? 1 : 0);
  fprintf(out, "        <Element index=\"4\" value=\"%s\"/>\n      </Property>\n", p->array);
  put_proxy(out, SHOWN + q, "LookupTable", COLOURS + q);
  fputs("    </Proxy>\n", out);
}

static void put_view(FILE *out, const bw_scene *s, int n, const double lower[3],
                     const double upper[3])
{
  double middle[3], eye[3], size = 0.0;
  for (int d = 0; d < 3; d++) {
    middle[d] = 0.5 * (lower[d] + upper[d]);
    size = fmax(size, upper[d] - lower[d]);
  }
  /* From the front; in space from somewhat above and beside. */
  memcpy(eye, middle, sizeof eye);
  eye[2] += 2.5 * size;
  if (!s->planar) eye[0] += 0.8 * size, eye[1] += 0.8 * size;
  open_proxy(out, "views", "RenderView", VIEW);
  open_property(out, VIEW, "Representations", n);
  for (int q = 0; q < n; q++)
    fprintf(out, "        <Proxy value=\"%d\"/>\n", SHOWN + q);
  fputs("      </Property>\n", out);
  put_numbers(out, VIEW, "CameraPosition", 3, eye);
  put_numbers(out, VIEW, "CameraFocalPoint", 3, middle);
  put_numbers(out, VIEW, "CameraViewUp", 3, (const double[]){0, 1, 0});
  put_numbers(out, VIEW, "CenterOfRotation", 3, middle);
  put_numbers(out, VIEW, "CameraParallelScale", 1, (const double[]){0.6 * size});
  fputs("    </Proxy>\n", out);
}

static void put_collection(FILE *out, const char *name, int first, int n, const shown *p)
{
  fprintf(out, "    <ProxyCollection name=\"%s\">\n", name);
  for (int q = 0; q < n; q++) {
    fprintf(out, "      <Item id=\"%d\" name=\"", first + q);
    put_text(out, p[q].file);
    fputs("\"/>\n", out);
  }
  fputs("    </ProxyCollection>\n", out);
}

/* The largest value of what colours the fluid: the magnitude of its velocity. Collective. */
static double fastest(const bw_scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  bw_real *const *u = bw_ns_channel_velocity(s->fluid);
  double most = 0.0;
  for (int k = 1; k <= g->m[2]; k++)
    for (int j = 1; j <= g->m[1]; j++)
      for (int i = 1; i <= g->m[0]; i++) {
        double sum = 0.0;
        for (int d = 0; d < 3; d++)
          sum += u[d] == NULL ? 0.0 : pow((double)u[d][bw_at(g, i, j, k)], 2);
        most = fmax(most, sum);
      }
  bw_comm_max(s->comm, 1, &most);
  return most > 0.0 ? sqrt(most) : 1.0;
}

/* What there is to see; lower, upper (3): where. Collective. */
static bw_status look(bw_scene *s, shown *p, int *n, double lower[3], double upper[3])
{
  for (int d = 0; d < 3; d++)
    lower[d] = HUGE_VAL, upper[d] = -HUGE_VAL;
  *n = 0;
  /* With a fluid its box is what is looked at. */
  if (s->fluid != NULL) {
    const bool uniform = bw_grid_look(s->grid)->uniform_y;
    p[*n] = (shown){.file = "fluid",
                    .kind = uniform ? "UniformGridRepresentation" : "StructuredGridRepresentation",
                    .look = s->planar || !uniform ? "Surface" : "Slice",
                    .cells = true,
                    .array = "velocity",
                    .most = fastest(s),
                    .slice = uniform ? bw_grid_look(s->grid)->n[2] / 2 : 0};
    (*n)++;
    for (int d = 0; d < 3; d++)
      lower[d] = 0.0, upper[d] = s->config.domain.length[d];
  }
  if (s->water != NULL) {
    /* Points of the fluid; its walls are a series that is opened by hand. */
    p[*n] = (shown){.file = "fluid",
                    .kind = "GeometryRepresentation",
                    .look = "Points",
                    .array = "velocity",
                    .most = s->water->config.speed};
    (*n)++;
    for (int d = 0; d < 3; d++)
      lower[d] = 0.0, upper[d] = s->planar && d == 2 ? 0.0 : s->config.domain.length[d];
  }
  /* Without one it is the box of all bodies. */
  for (int b = 0; b < s->config.n_bodies && *n == 0; b++) {
    bw_scene__shapes shapes;
    const bw_status st = bw_scene__shapes_make(&s->config, b, &shapes);
    for (int d = 0; d < 3; d++) {
      lower[d] = fmin(lower[d], s->planar && d == 2 ? 0.0 : shapes.lower[d]);
      upper[d] = fmax(upper[d], s->planar && d == 2 ? 0.0 : shapes.upper[d]);
    }
    bw_scene__shapes_release(&shapes);
    BW_TRY(st);
  }
  /* Particles, or the points of rigid surfaces, each solid by itself. */
  const shown points = {.kind = "GeometryRepresentation", .look = "Points", .most = 1.0};
  for (int q = 0; q < s->n_solids; q++) {
    p[*n] = points;
    p[*n].array = "damage";
    bw_scene__series_name(s, q, p[(*n)++].file);
  }
  if (s->rigid != NULL && (s->n_solids == 0 || s->floats != NULL)) {
    p[*n] = points;
    p[*n].array = "body";
    p[*n].most = s->config.n_bodies;
    bw_scene__series_name(s, -1, p[(*n)++].file);
  }
  return BW_OK;
}

/* The text, on rank 0. */
static bw_status compose(const bw_scene *s, const char *folder, int n, const shown *p,
                         const double lower[3], const double upper[3], char **text)
{
  size_t length = 0;
  FILE *out = open_memstream(text, &length);
  if (out == NULL) return BW_FAIL(BW_EMEM, "no memory for open.pvsm");
  fputs("<ParaView>\n  <ServerManagerState version=\"5.10.0\">\n", out);
  for (int q = 0; q < n; q++)
    put_series(out, folder, q, &p[q]);
  put_view(out, s, n, lower, upper);
  put_collection(out, "sources", SOURCE, n, p);
  put_collection(out, "representations", SHOWN, n, p);
  put_collection(out, "lookup_tables", COLOURS, n, p);
  put_collection(out, "views", VIEW, 1, &(shown){.file = "RenderView1"});
  fputs("  </ServerManagerState>\n</ParaView>\n", out);
  return fclose(out) == 0 ? BW_OK : BW_FAIL(BW_EMEM, "no memory for open.pvsm");
}

bw_status bw_scene__paraview(bw_scene *s, const bw_case *run)
{
  shown *p = NULL;
  int n = 0;
  double lower[3], upper[3];
  char *path = NULL, *text = NULL, folder[BW_SCENE_PATH] = "";
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&p, BW_SCENE_BODIES + 2));
  BW_THEN(st, look(s, p, &n, lower, upper));
  BW_THEN(st, bw_case_path(run, "open.pvsm", &path));
  if (st == BW_OK && bw_comm_rank(s->comm) == 0) {
    snprintf(folder, sizeof folder, "%.*s", (int)(strlen(path) - strlen("/open.pvsm")), path);
    char *full = realpath(folder, NULL);
    st = compose(s, full != NULL ? full : folder, n, p, lower, upper, &text);
    bw_release(&full);
  }
  st = bw_comm_agree(s->comm, st);
  BW_THEN(st, bw_file_write_text(s->comm, path, text));
  bw_release(&p);
  bw_release(&path);
  bw_release(&text);
  return st;
}
