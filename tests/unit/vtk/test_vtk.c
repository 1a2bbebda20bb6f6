/* VTK files: every value at its cell or point, on any number of ranks.
 * The same files are read by VTK itself in tests/robustness/vtk_reader.sh.
 * TEST ranks=1,2,3,4 */
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_vtk.h"
#include "vtk_read.h"

/* All values below are sums of small multiples of 1/2: exact in Float32. */
enum { NX = 5, NY = 7, NZ = 6 };

/* Blocks of y (ranks_z = 1), of z (ranks_y = 1), or both; 0, 0: as the grid likes. */
static bw_grid *make_grid_on(int nz, bw_stretch stretch, int ranks_y, int ranks_z)
{
  bw_grid_config config = bw_grid_config_default();
  const int n[3] = {NX, NY, nz};
  for (int d = 0; d < 3; d++) {
    config.n[d] = n[d];
    config.length[d] = 0.25 * n[d] * (d + 1);
  }
  config.y_stretch = stretch;
  config.ranks[0] = ranks_y, config.ranks[1] = ranks_z;
  bw_grid *grid = NULL;
  bw_check_ok(bw_grid_create(bw_check_world(), &config, &grid));
  return grid;
}

static bw_grid *make_grid(int nz, bw_stretch stretch)
{
  return make_grid_on(nz, stretch, 0, 0);
}

static void make_folder(char path[512], const char *name)
{
  char folder[512];
  vtk_path(folder, ".");
  bw_check_ok(bw_folder_make(bw_check_world(), folder));
  vtk_path(path, name);
}

/* c + i + 10 j + 100 k of the global indices, wherever there is memory for it. */
static bw_real *make_field(const bw_grid *grid, double c)
{
  const bw_grid_view *g = bw_grid_look(grid);
  bw_real *a = NULL;
  bw_check_ok(bw_field_create(grid, &a));
  for (int k = 1 - g->halo[2]; k <= g->m[2] + g->halo[2]; k++)
    for (int j = 1 - g->halo[1]; j <= g->m[1] + g->halo[1]; j++)
      for (int i = 1 - g->halo[0]; i <= g->m[0] + g->halo[0]; i++)
        a[bw_at(g, i, j, k)] = (bw_real)(c + i + 10.0 * (j + g->lo[1]) + 100.0 * (k + g->lo[2]));
  return a;
}

static void check_scalar(const vtk_file *f, int nz, const char *name, double factor, double c)
{
  float p[NX * NY * NZ];
  vtk_array(f, name, "Float32", 1, sizeof(float) * (size_t)(NX * NY * nz), p);
  for (int k = 1, q = 0; k <= nz; k++)
    for (int j = 1; j <= NY; j++)
      for (int i = 1; i <= NX; i++, q++)
        ck_assert_float_eq(p[q], (float)(factor * (c + i + 10 * j + 100 * k)));
}

/* Face fields are linear, so that at a centre each is half a cell's step below its own face. */
static void check_vector(const vtk_file *f, int nz)
{
  float u[NX * NY * NZ * 3];
  vtk_array(f, "velocity", "Float32", 3, 3 * sizeof(float) * (size_t)(NX * NY * nz), u);
  for (int k = 1, q = 0; k <= nz; k++)
    for (int j = 1; j <= NY; j++)
      for (int i = 1; i <= NX; i++, q++) {
        const double face = i + 10 * j + 100 * k;
        ck_assert_float_eq(u[3 * q], (float)(1000 + face - 0.5));
        ck_assert_float_eq(u[3 * q + 1], (float)(2000 + face - 5.0));
        ck_assert_float_eq(u[3 * q + 2], nz > 1 ? (float)(3000 + face - 50.0) : 0.0f);
      }
}

static void write_and_check(bw_grid *grid, const char *name)
{
  const int nz = bw_grid_look(grid)->n[2];
  char path[512];
  make_folder(path, name);
  bw_real *p = make_field(grid, 0), *u = make_field(grid, 1000), *v = make_field(grid, 2000),
          *w = make_field(grid, 3000);
  const bw_vtk_field fields[] = {
      {.name = "pressure", .data = {p}},
      {.name = "velocity", .data = {u, v, nz > 1 ? w : NULL}, .staggered = true},
      {.name = "scaled & <odd>", .data = {p}, .scale = -0.5}};
  bw_check_ok(bw_vtk_write_grid(grid, path, 0.125, 3, fields));
  bw_comm_barrier(bw_check_world());

  vtk_file f = vtk_open(path);
  check_scalar(&f, nz, "pressure", 1.0, 0.0);
  check_scalar(&f, nz, "scaled &amp; &lt;odd&gt;", -0.5, 0.0);
  check_vector(&f, nz);
  static const char closing[] = "  </AppendedData>\n</VTKFile>\n";
  ck_assert_str_eq(f.bytes + f.size - strlen(closing), closing);
  vtk_close(&f);

  bw_release(&p);
  bw_release(&u);
  bw_release(&v);
  bw_release(&w);
}

static void write_and_check_grid(int nz, bw_stretch stretch, const char *name)
{
  bw_grid *grid = make_grid(nz, stretch);
  write_and_check(grid, name);
  bw_grid_destroy(&grid);
}

START_TEST(uniform_grid)
{
  write_and_check_grid(NZ, BW_STRETCH_NONE, "uniform.vti");
  char path[512];
  vtk_path(path, "uniform.vti");
  vtk_file f = vtk_open(path);
  vtk_has(&f, "<ImageData WholeExtent=\"0 5 0 7 0 6\" Origin=\"0 0 0\" "
              "Spacing=\"0.25 0.5 0.75\">");
  vtk_close(&f);
}
END_TEST

/* Every division puts every block in its place. */
START_TEST(blocks_of_y_of_z_and_of_both)
{
  const int size = bw_comm_size(bw_check_world());
  for (int ranks_y = 1; ranks_y <= size; ranks_y++) {
    if (size % ranks_y != 0) continue;
    bw_grid *grid = make_grid_on(NZ, BW_STRETCH_NONE, ranks_y, size / ranks_y);
    write_and_check(grid, "blocks.vti");
    bw_grid_destroy(&grid);
    bw_comm_barrier(bw_check_world()); /* all have read it before it is written again */
  }
}
END_TEST

START_TEST(flat_grid_has_a_zero_third_component)
{
  write_and_check_grid(1, BW_STRETCH_NONE, "flat.vti");
}
END_TEST

/* The faces of the stretched direction are those of the grid, to the last bit. */
START_TEST(stretched_grid_has_coordinates)
{
  write_and_check_grid(NZ, BW_STRETCH_TANH, "stretched.vtr");
  char path[512];
  vtk_path(path, "stretched.vtr");
  vtk_file f = vtk_open(path);
  double x[NX + 1], y[NY + 1], z[NZ + 1];
  vtk_array(&f, "x", "Float64", 1, sizeof x, x);
  vtk_array(&f, "y", "Float64", 1, sizeof y, y);
  vtk_array(&f, "z", "Float64", 1, sizeof z, z);
  bw_grid *grid = make_grid(NZ, BW_STRETCH_TANH);
  const bw_grid_view *g = bw_grid_look(grid);
  for (int i = 0; i <= NX; i++)
    ck_assert_double_eq(x[i], 0.25 * i);
  for (int j = 0; j <= NY; j++)
    ck_assert_double_eq(y[j], g->y_face[j]);
  for (int k = 0; k <= NZ; k++)
    ck_assert_double_eq(z[k], 0.75 * k);
  ck_assert_double_ne(y[1], 0.5);
  bw_grid_destroy(&grid);
  vtk_close(&f);
}
END_TEST

/* Rank r has 3 r + 2 points, the last rank of several none; values tell rank and place. */
START_TEST(points_in_rank_order)
{
  enum { MOST = 64 };
  const int me = bw_comm_rank(bw_check_world()), size = bw_comm_size(bw_check_world());
  const bool empty = size > 1 && me == size - 1;
  const size_t n = empty ? 0 : (size_t)(3 * me + 2);
  double position[3 * MOST], force[3 * MOST];
  float damage[MOST];
  int64_t id[MOST];
  uint8_t surface[MOST];
  for (size_t i = 0; i < n; i++) {
    for (size_t c = 0; c < 3; c++) {
      position[3 * i + c] = 100.0 * me + (double)i + 0.25 * (double)c;
      force[3 * i + c] = 1.0 / (1.0 + position[3 * i + c]);
    }
    damage[i] = (float)(0.5 * (double)i);
    id[i] = INT64_C(5000000000) * (me + 1) + (int64_t)i;
    surface[i] = (uint8_t)(200 + i);
  }
  const bw_vtk_array arrays[] = {{"force", BW_VTK_FLOAT64, 3, force},
                                 {"damage", BW_VTK_FLOAT32, 1, damage},
                                 {"id", BW_VTK_INT64, 1, id},
                                 {"surface", BW_VTK_UINT8, 1, empty ? NULL : surface}};
  char path[512];
  make_folder(path, "points.vtp");
  bw_check_ok(bw_vtk_write_points(bw_check_world(), path, 0.375, n, position, 4, arrays));
  bw_comm_barrier(bw_check_world());

  size_t total = 0;
  for (int r = 0; r < (size > 1 ? size - 1 : 1); r++)
    total += (size_t)(3 * r + 2);
  vtk_file f = vtk_open(path);
  float points[3 * MOST];
  int64_t connectivity[MOST], offsets[MOST];
  vtk_array(&f, "Points", "Float32", 3, 3 * total * sizeof(float), points);
  vtk_array(&f, "force", "Float64", 3, 3 * total * sizeof(double), force);
  vtk_array(&f, "damage", "Float32", 1, total * sizeof(float), damage);
  vtk_array(&f, "id", "Int64", 1, total * sizeof(int64_t), id);
  vtk_array(&f, "surface", "UInt8", 1, total, surface);
  vtk_array(&f, "connectivity", "Int64", 1, total * sizeof(int64_t), connectivity);
  vtk_array(&f, "offsets", "Int64", 1, total * sizeof(int64_t), offsets);
  size_t q = 0;
  for (int r = 0; q < total; r++)
    for (int i = 0; i < 3 * r + 2; i++, q++) {
      for (size_t c = 0; c < 3; c++) {
        const double x = 100.0 * r + i + 0.25 * (double)c;
        ck_assert_float_eq(points[3 * q + c], (float)x);
        ck_assert_double_eq(force[3 * q + c], 1.0 / (1.0 + x));
      }
      ck_assert_float_eq(damage[q], (float)(0.5 * i));
      ck_assert_int_eq(id[q], INT64_C(5000000000) * (r + 1) + i);
      ck_assert_int_eq(surface[q], 200 + i);
      ck_assert_int_eq(connectivity[q], (int64_t)q);
      ck_assert_int_eq(offsets[q], (int64_t)q + 1);
    }
  vtk_close(&f);
}
END_TEST

START_TEST(no_points_at_all)
{
  char path[512];
  make_folder(path, "none.vtp");
  const bw_vtk_array array = {"damage", BW_VTK_FLOAT32, 1, NULL};
  bw_check_ok(bw_vtk_write_points(bw_check_world(), path, NAN, 0, NULL, 1, &array));
  vtk_file f = vtk_open(path);
  vtk_has(&f, "NumberOfPoints=\"0\"");
  vtk_close(&f);
}
END_TEST

/* A restart at 0.25 repeats that time: what came from there on before is gone. */
START_TEST(series_continues_after_a_restart)
{
  char path[512];
  make_folder(path, "series.pvd");
  const bw_comm *comm = bw_check_world();
  if (bw_comm_rank(comm) == 0) remove(path);
  bw_comm_barrier(comm);
  const double times[] = {0.0, 0.125, 0.25, 0.375, 0.25};
  for (int q = 0; q < 5; q++) {
    char file[32];
    snprintf(file, sizeof file, "fluid&%d.vti", q);
    bw_check_ok(bw_vtk_series_add(comm, path, times[q], file));
  }
  bw_comm_barrier(comm);
  vtk_file f = vtk_open(path);
  ck_assert_str_eq(f.bytes,
                   "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
                   "  <Collection>\n"
                   "    <DataSet timestep=\"0\" part=\"0\" file=\"fluid&amp;0.vti\"/>\n"
                   "    <DataSet timestep=\"0.125\" part=\"0\" file=\"fluid&amp;1.vti\"/>\n"
                   "    <DataSet timestep=\"0.25\" part=\"0\" file=\"fluid&amp;4.vti\"/>\n"
                   "  </Collection>\n</VTKFile>\n");
  vtk_close(&f);
}
END_TEST

START_TEST(refusals_name_the_path)
{
  const bw_comm *comm = bw_check_world();
  char path[512];
  bw_grid *grid = make_grid(NZ, BW_STRETCH_TANH);
  bw_real *p = make_field(grid, 0);
  const bw_vtk_field field = {.name = "p", .data = {p}}, nameless = {.data = {p}};
  ck_assert_str_eq(bw_vtk_grid_extension(grid), ".vtr");

  make_folder(path, "wrong.vti");
  bw_check_status(bw_vtk_write_grid(grid, path, NAN, 1, &field), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "wrong.vti"));
  make_folder(path, "nameless.vtr");
  bw_check_status(bw_vtk_write_grid(grid, path, NAN, 1, &nameless), BW_EINPUT);
  make_folder(path, "no/such/folder.vtr");
  bw_check_status(bw_vtk_write_grid(grid, path, NAN, 1, &field), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "no/such/folder.vtr"));

  const bw_vtk_array two = {"pair", BW_VTK_FLOAT64, 2, &grid};
  make_folder(path, "pair.vtp");
  bw_check_status(bw_vtk_write_points(comm, path, NAN, 0, NULL, 1, &two), BW_EINPUT);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "'pair'"));

  /* Somebody's own file is left alone. */
  make_folder(path, "foreign.pvd");
  if (bw_comm_rank(comm) == 0) {
    FILE *file = fopen(path, "w");
    fputs("precious", file);
    fclose(file);
  }
  bw_comm_barrier(comm);
  bw_check_status(bw_vtk_series_add(comm, path, 0.0, "a.vti"), BW_EIO);
  vtk_file f = vtk_open(path);
  ck_assert_str_eq(f.bytes, "precious");
  vtk_close(&f);

  bw_release(&p);
  bw_grid_destroy(&grid);
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(uniform_grid),
                                      BW_TEST(blocks_of_y_of_z_and_of_both),
                                      BW_TEST(flat_grid_has_a_zero_third_component),
                                      BW_TEST(stretched_grid_has_coordinates),
                                      BW_TEST(points_in_rank_order),
                                      BW_TEST(no_points_at_all),
                                      BW_TEST(series_continues_after_a_restart),
                                      BW_TEST(refusals_name_the_path)};
BW_CHECK_MAIN("vtk", tests)
