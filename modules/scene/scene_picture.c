/* VTK files: the fluid with what is solid in it, and the particles or surfaces of the bodies. */
#include "scene_impl.h"

#include "bw_memory.h"
#include "bw_shape_surface.h"
#include "bw_vtk.h"
#include <math.h>
#include <string.h>

/* Undoes the motion of a body: where the point X was at t = 0. */
static void undo(const bw_scene_body *b, double time, const double X[3], double X0[3])
{
  const double origin[3] = {0, 0, 0};
  double shift[3], axes[3][3], r[3];
  bw_scene_body still = *b;
  still.has_rotation = false;
  bw_scene__motion(&still, origin, time, shift);
  for (int d = 0; d < 3; d++)
    X0[d] = X[d] - shift[d];
  if (!b->has_rotation) return;
  bw_shape_turn(b->rotation.axis, -b->rotation.rate * time, axes);
  for (int d = 0; d < 3; d++)
    r[d] = X0[d] - b->rotation.centre[d];
  for (int k = 0; k < 3; k++) {
    X0[k] = b->rotation.centre[k];
    for (int d = 0; d < 3; d++)
      X0[k] += axes[d][k] * r[d];
  }
}

/* Is x (3) in a rigid body, or in its image across a periodic side? */
static bool in_rigid(const bw_scene *s, const bw_grid_view *g, int q, const double x[3])
{
  const bw_rigid_state now = bw_rigid_state_of(s->rigid, q);
  double at[3] = {x[0], x[1], s->planar ? 0.0 : x[2]};
  for (int d = 0; d < (s->planar ? 2 : 3); d++)
    if (g->periodic[d]) at[d] -= g->length[d] * round((x[d] - now.position[d]) / g->length[d]);
  return bw_rigid_distance(s->rigid, q, at) < 0.0;
}

/* Cells whose centre is inside a true surface. */
static bw_status mask_surfaces(bw_scene *s, bw_real *mask)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  for (int b = 0; b < s->config.n_bodies; b++) {
    bw_scene__shapes shapes;
    if (s->solid_of[b] >= 0) continue; /* its particles mark it */
    memset(&shapes, 0, sizeof shapes);
    bw_status st = s->rigid != NULL ? BW_OK : bw_scene__shapes_make(&s->config, b, &shapes);
    st = bw_comm_agree(s->comm, st);
    for (int k = 1; st == BW_OK && k <= g->m[2]; k++)
      for (int j = 1; j <= g->m[1]; j++)
        for (int i = 1; i <= g->m[0]; i++) {
          const double x[3] = {(i + g->lo[0] - 0.5) * g->spacing[0], g->y_centre[j + g->lo[1]],
                               (k + g->lo[2] - 0.5) * g->spacing[2]};
          double X0[3];
          if (s->rigid == NULL) undo(&s->config.bodies[b], s->time, x, X0);
          if (s->rigid != NULL ? in_rigid(s, g, s->rigid_of[b], x)
                               : bw_shape_distance(shapes.n, shapes.shape, s->planar, X0) < 0.0)
            mask[bw_at(g, i, j, k)] = (bw_real)(b + 1);
        }
    bw_scene__shapes_release(&shapes);
    BW_TRY(st);
  }
  return BW_OK;
}

/* Cells that hold a particle. Collective. */
static bw_status mask_particles(bw_scene *s, bw_real *mask)
{
  bw_scene__solid *q = &s->solid[0];
  double *body = NULL;
  bw_status st = bw_comm_agree(s->comm, BW_ALLOCATE(&body, q->n));
  BW_TRY(st);
  bw_solid_get_position(q->solid, q->V);
  for (size_t i = 0; i < q->n; i++)
    body[i] = bw_scene__body_of(q, i) + 1.0;
  st = bw_grid_mark(s->grid, q->n, q->V, body, mask);
  bw_release(&body);
  return st;
}

static bw_status write_fluid(bw_scene *s, int solid, const char *path)
{
  (void)solid;
  enum { MOST = 2 + 1 + BW_SCENE_BODIES };
  const bw_grid_view *g = bw_grid_look(s->grid);
  bw_real *const *u = bw_ns_channel_velocity(s->fluid);
  bw_real *body = NULL, *part[BW_SCENE_BODIES] = {NULL};
  bw_vtk_field field[MOST] = {{.name = "velocity", .data = {u[0], u[1], u[2]}, .staggered = true},
                              {.name = "pressure",
                               .data = {bw_ns_channel_pressure(s->fluid)},
                               .scale = s->config.fluid.density}};
  int n = 2;
  bw_status st = BW_OK;
  if (s->config.n_bodies > 0) {
    st = bw_comm_agree(s->comm, bw_field_create(s->grid, &body));
    if (s->n_solids > 0) BW_THEN(st, mask_particles(s, body));
    BW_THEN(st, mask_surfaces(s, body));
    /* The number of the body in the file, and a mask of each by its name. */
    field[n++] = (bw_vtk_field){.name = "body", .data = {body}};
    for (int b = 0; b < s->config.n_bodies && st == BW_OK; b++) {
      st = bw_comm_agree(s->comm, bw_field_create(s->grid, &part[b]));
      for (size_t i = 0; st == BW_OK && i < g->size; i++)
        part[b][i] = body[i] == (bw_real)(b + 1) ? 1 : 0;
      field[n++] = (bw_vtk_field){.name = s->config.bodies[b].name, .data = {part[b]}};
    }
  }
  BW_THEN(st, bw_vtk_write_grid(s->grid, path, s->time, n, field));
  for (int b = 0; b < s->config.n_bodies; b++)
    bw_release(&part[b]);
  bw_release(&body);
  return st;
}

static bw_status write_solid(bw_scene *s, int solid, const char *path)
{
  bw_scene__solid *q = &s->solid[solid];
  const bw_coupler_particles *both = s->water != NULL ? s->water->both : NULL;
  double *X = NULL, *U = NULL, *damage = NULL, *F = NULL, *p = NULL;
  int32_t *body = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * q->n);
  BW_THEN(st, BW_ALLOCATE(&U, 3 * q->n));
  if (both != NULL) BW_THEN(st, BW_ALLOCATE(&F, 3 * q->n));
  if (both != NULL) BW_THEN(st, BW_ALLOCATE(&p, q->n));
  BW_THEN(st, BW_ALLOCATE(&damage, q->n));
  BW_THEN(st, BW_ALLOCATE(&body, q->n));
  st = bw_comm_agree(s->comm, st);
  /* Displacements are from the places at rest; bodies are numbered from 1 in the file. */
  if (st == BW_OK) {
    bw_solid_get_position(q->solid, X);
    bw_solid_get_velocity(q->solid, q->V);
    bw_solid_get_damage(q->solid, damage);
    for (size_t i = 0; i < 3 * q->n; i++)
      U[i] = X[i] - q->X0[i];
    for (size_t i = 0; i < q->n; i++)
      body[i] = bw_scene__body_of(q, i) + 1;
    const bw_vtk_array arrays[] = {
        {"damage", BW_VTK_FLOAT64, 1, damage}, {"displacement", BW_VTK_FLOAT64, 3, U},
        {"velocity", BW_VTK_FLOAT64, 3, q->V}, {"body", BW_VTK_INT32, 1, body},
        {"force", BW_VTK_FLOAT64, 3, F},       {"pressure", BW_VTK_FLOAT64, 1, p}};
    /* The last two are those of a fluid of particles. */
    if (both != NULL) bw_coupler_particles_load(both, F);
    if (both != NULL) bw_coupler_particles_pressure(both, p);
    st = bw_vtk_write_points(s->comm, path, s->time, q->n, X, both != NULL ? 6 : 4, arrays);
  }
  bw_release(&X);
  bw_release(&U);
  bw_release(&F);
  bw_release(&p);
  bw_release(&damage);
  bw_release(&body);
  return st;
}

/* The surface points of rigid bodies. */
static bw_status write_surfaces(bw_scene *s, int solid, const char *path)
{
  (void)solid;
  const size_t n = bw_rigid_points(s->rigid);
  double *X = NULL, *V = NULL, *N = NULL;
  int32_t *body = NULL;
  bw_status st = BW_ALLOCATE(&X, 3 * n);
  BW_THEN(st, BW_ALLOCATE(&V, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&N, 3 * n));
  BW_THEN(st, BW_ALLOCATE(&body, n));
  st = bw_comm_agree(s->comm, st);
  if (st == BW_OK) {
    bw_rigid_surface(s->rigid, X, V, N);
    for (int b = 0; b < s->config.n_bodies; b++)
      for (size_t i = 0; i < n; i++)
        if (bw_rigid_point_body(s->rigid)[i] == s->rigid_of[b]) body[i] = b + 1;
    /* In the plane points are shown in the middle of the one layer of cells. */
    for (size_t i = 0; i < n && s->planar && s->grid != NULL; i++)
      X[3 * i + 2] = 0.5 * bw_grid_look(s->grid)->length[2];
    const bw_vtk_array arrays[] = {{"velocity", BW_VTK_FLOAT64, 3, V},
                                   {"normal", BW_VTK_FLOAT64, 3, N},
                                   {"area", BW_VTK_FLOAT64, 1, bw_rigid_point_area(s->rigid)},
                                   {"body", BW_VTK_INT32, 1, body}};
    st = bw_vtk_write_points(s->comm, path, s->time, n, X, 4, arrays);
  }
  bw_release(&X);
  bw_release(&V);
  bw_release(&N);
  bw_release(&body);
  return st;
}

/* One file of the series `what` at the present time. */
static bw_status add_to_series(bw_scene *s, const bw_case *run, const char *what,
                               const char *extension, int solid,
                               bw_status (*write)(bw_scene *, int, const char *))
{
  char name[3 * BW_SCENE_NAME], series[3 * BW_SCENE_NAME], *path = NULL, *series_path = NULL;
  snprintf(name, sizeof name, "%s-%08lld%s", what, (long long)s->steps, extension);
  snprintf(series, sizeof series, "%s.pvd", what);
  bw_status st = bw_case_path(run, name, &path);
  BW_THEN(st, bw_case_path(run, series, &series_path));
  BW_THEN(st, write(s, solid, path));
  /* The series names the file only after it is there. */
  BW_THEN(st, bw_vtk_series_add(s->comm, series_path, s->time, name));
  bw_release(&path);
  bw_release(&series_path);
  return st;
}

void bw_scene__series_name(const bw_scene *s, int solid, char name[2 * BW_SCENE_NAME])
{
  /* A solid of several bodies has the name of the first. */
  const char *body = solid < 0 ? "" : s->config.bodies[s->solid[solid].body[0]].name;
  const bool taken = strcmp(body, "fluid") == 0 || strcmp(body, "walls") == 0 ||
                     strcmp(body, "rigid-surfaces") == 0;
  snprintf(name, 2 * BW_SCENE_NAME, "%s%s", taken ? "body-" : "",
           solid < 0 ? "rigid-surfaces" : body);
}

bw_status bw_scene_picture(bw_scene *s, const bw_case *run)
{
  char what[2 * BW_SCENE_NAME];
  if (s->fluid != NULL)
    BW_TRY(add_to_series(s, run, "fluid", bw_vtk_grid_extension(s->grid), 0, write_fluid));
  if (s->water != NULL) {
    BW_TRY(add_to_series(s, run, "fluid", ".vtp", 0, bw_scene__water_picture));
    BW_TRY(add_to_series(s, run, "walls", ".vtp", 0, bw_scene__walls_picture));
  }
  bw_scene__series_name(s, -1, what);
  if (s->rigid != NULL && (s->n_solids == 0 || s->floats != NULL))
    BW_TRY(add_to_series(s, run, what, ".vtp", 0, write_surfaces));
  for (int q = 0; q < s->n_solids; q++) {
    bw_scene__series_name(s, q, what);
    BW_TRY(add_to_series(s, run, what, ".vtp", q, write_solid));
  }
  return bw_scene__paraview(s, run);
}
