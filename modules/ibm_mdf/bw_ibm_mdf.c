/* The object, the forcing iteration, and what is asked of it. */
#include "bw_memory.h"
#include "ibm_mdf_internal.h"

#include <math.h>
#include <string.h>

bw_ibm_mdf_config bw_ibm_mdf_config_default(void)
{
  return (bw_ibm_mdf_config){.kernel = BW_KERNEL_ROMA3, .n_iter = 1, .memory = 0.2};
}

bw_status bw_ibm_mdf_create(bw_grid *grid, const bw_ibm_mdf_config *config, bw_ibm_mdf **out)
{
  const bw_grid_view *g = bw_grid_look(grid);
  *out = NULL;
  /* What follows from the arguments alone fails on every rank alike, before anything is agreed. */
  BW_REQUIRE(config->n_iter >= 1, BW_EINPUT, "n_iter: at least 1 forcing iteration, found %d",
             config->n_iter);
  BW_REQUIRE(config->memory >= 0.0 && config->memory <= 0.5, BW_EINPUT,
             "memory: %g is not in [0, 0.5]; 0.2 is a good share, 0 is none", config->memory);
  BW_REQUIRE((int)config->kernel >= 0 && config->kernel < BW_KERNEL_COUNT, BW_EINPUT,
             "kernel: no row %d in the table of %d", (int)config->kernel, (int)BW_KERNEL_COUNT);
  BW_REQUIRE(g->uniform_y, BW_EINPUT,
             "the immersed boundary needs one spacing per direction: y must not be stretched");
  BW_REQUIRE(g->halo[0] == 2 && g->halo[1] == 2 && (g->n[2] == 1 || g->halo[2] == 2), BW_EINPUT,
             "the immersed boundary needs a grid with halo 2, found %d", g->halo[0]);

  BW_REQUIRE(
      g->size <= INT32_MAX, BW_EINPUT,
      "the immersed boundary counts the cells of a rank in 31 bits, found %zu: use more ranks",
      g->size);

  /* From here on a rank may fail alone, so every status is agreed. */
  bw_ibm_mdf *ib = NULL;
  bw_status st = BW_ALLOCATE(&ib, 1);
  BW_TRY(bw_comm_agree(bw_grid_comm(grid), st));
  ib->grid = grid;
  ib->g = g;
  st = bw_comm_agree(bw_grid_comm(grid), BW_ALLOCATE(&ib->layer, (size_t)g->m[2] + 1));
  if (st != BW_OK) bw_ibm_mdf_destroy(&ib);
  if (st != BW_OK) return st;
  ib->kernel = bw_kernel_delta_get(config->kernel);
  ib->kernel_id = config->kernel;
  ib->n_iter = config->n_iter;
  ib->beta = config->memory;
  ib->share = 1.0;
  ib->cell_volume = g->spacing[0] * g->spacing[1] * g->spacing[2];
  bw_ibm_mdf__find_blocks(ib);
  /* Kernels are chosen once, by support and dimension, so
   * that their loops have constant lengths. */
  ib->interpolate = bw_ibm_mdf__interpolator(ib->kernel->support, g->n[2] == 1);
  ib->spread = bw_ibm_mdf__spreader(ib->kernel->support, g->n[2] == 1);
  *out = ib;
  return BW_OK;
}

void bw_ibm_mdf_destroy(bw_ibm_mdf **ib)
{
  if (*ib == NULL) return;
  bw_ibm_mdf *b = *ib;
  bw_exchange_destroy(&b->plan);
  bw_exchange_destroy(&b->image_plan);
  /* All of them may be NULL: the object may be half built. */
  void *const arrays[] = {&b->sent_from, &b->destination, &b->item,   &b->answer,   &b->received,
                          &b->order,     &b->swap,        &b->key,    &b->key_swap, &b->V,
                          &b->dV,        &b->QdV,         &b->M,      &b->reply,    &b->cast_to,
                          &b->cast_from, &b->cast_item,   &b->cast_F, &b->image,    &b->weights,
                          &b->nodes,     &b->U,           &b->N,      &b->along,    &b->wet,
                          &b->wet_sent,  &b->enclosed};
  for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
    bw_release(arrays[a]);
  bw_release(ib);
}

/* Held markers and images begin <= m < end. */
static bw_ibm_mdf__stencils stencils(const bw_ibm_mdf *ib, size_t begin, size_t end)
{
  return (bw_ibm_mdf__stencils){begin,           end, ib->weights, ib->nodes, ib->g->stride[1],
                                ib->g->stride[2]};
}

/* U (held,3) <- u at the markers. Local. */
static void gather_velocity(bw_ibm_mdf *ib, bw_real *const u[3])
{
  const bw_ibm_mdf__stencils s = stencils(ib, 0, ib->held);
  ib->interpolate(&s, u, ib->U);
}

/* u += what U (times dV/h^3) of markers and images from `begin` on spreads. Local. */
static void spread_from(bw_ibm_mdf *ib, size_t begin, bw_real *const u[3])
{
  const bw_ibm_mdf__stencils s = stencils(ib, begin, ib->held + ib->images);
  ib->spread(&s, ib->U, u);
}

/* Of the markers of s: U <- (V - U) dV/h^3, QdV += (V - U) dV/dt, of both the share that an
 * iteration gives; returns sum |V - U|^2. */
static double velocity_to_force(bw_ibm_mdf *ib, const bw_ibm_mdf__stencils *s, double dt)
{
  const double per_volume = ib->share / ib->cell_volume, per_step = ib->share / dt;
  const double *restrict V = ib->V, *restrict dV = ib->dV;
  double *restrict QdV = ib->QdV, slip = 0.0;
  bw_real *restrict U = ib->U;
  /* POROUS 3.80: Q += (V - U)/dt. U is not needed any more and takes what is spread. */
  for (size_t m = s->begin; m < s->end; m++)
    for (size_t i = 3 * m; i < 3 * m + 3; i++) {
      const double lack = V[i] - (double)U[i];
      slip += lack * lack;
      QdV[i] += lack * dV[m] * per_step;
      /* dt Q dV/h^3: dt is the full one (ERRATA 18), dV area times spacing (ERRATA 17). */
      U[i] = (bw_real)(lack * dV[m] * per_volume);
    }
  return slip;
}

/* The same of markers that know their side (bw_ibm_mdf_set_normals): what is missing is V less the
 * shear's share. The part of it that dQ itself will change is taken at once, so that a step of any
 * length is stable. */
static double velocity_to_traction(bw_ibm_mdf *ib, const bw_ibm_mdf__stencils *s, double dt)
{
  const double per_volume = ib->share / ib->cell_volume, per_step = ib->share / dt;
  double slip = 0.0;
  for (size_t m = s->begin; m < s->end; m++) {
    const double *N = ib->N + 3 * m, dV = ib->dV[m];
    const double hold = ib->along[m] / (ib->along[m] + dt);
    double lack[3];
    const double across = bw_ibm_mdf__lack(ib, m, lack);
    for (size_t c = 0; c < 3; c++) {
      slip += lack[c] * lack[c];
      /* (1 + along/dt) dQ dt = lack, of what lies in the surface. */
      lack[c] -= hold * (lack[c] - across * N[c]);
      ib->QdV[3 * m + c] += lack[c] * dV * per_step;
      ib->U[3 * m + c] = (bw_real)(lack[c] * dV * per_volume);
    }
  }
  return slip;
}

/* One iteration of the held markers: interpolate, then spread what is missing. No support is
 * thicker than four layers, so that spreading may follow four layers behind, while the layers are
 * still in the cache: the result is that of one after the other. */
static double force_held(bw_ibm_mdf *ib, bw_real *const u[3], double dt)
{
  enum { BEHIND = BW_KERNEL_MAX_SUPPORT };
  double slip = 0.0;
  for (int k = 0; k < ib->g->m[2] + BEHIND; k++) {
    /* POROUS 3.79 at the markers of layer k, whose velocity nobody has changed yet. */
    if (k < ib->g->m[2]) {
      const bw_ibm_mdf__stencils s = stencils(ib, ib->layer[k], ib->layer[k + 1]);
      ib->interpolate(&s, u, ib->U);
      slip += ib->sided ? velocity_to_traction(ib, &s, dt) : velocity_to_force(ib, &s, dt);
    }
    /* POROUS 3.81, 3.82 of a layer that no later marker reads. */
    if (k >= BEHIND) {
      const bw_ibm_mdf__stencils s = stencils(ib, ib->layer[k - BEHIND], ib->layer[k - BEHIND + 1]);
      ib->spread(&s, ib->U, u);
    }
  }
  return slip;
}

/* One turn of power iteration for A = interpolate(spread(. dV)) in x: reply[m] <- A reply[m],
 * normalised. Returns <x, A x>/<x, x> with <x, y> = sum dV x y, in which A is self-adjoint: never
 * above its largest eigenvalue. Collective. */
static double power_iteration(bw_ibm_mdf *ib, bw_real *field)
{
  bw_real *const u[3] = {field, field, ib->g->n[2] == 1 ? NULL : field};
  double sum[3] = {0.0, 0.0, 0.0}; /* <x, x>, <x, Ax>, <Ax, Ax> */
  /* A is applied to x by spreading it into an empty field and reading it back. */
  memset(field, 0, ib->g->size * sizeof *field);
  for (size_t m = 0; m < ib->held; m++) {
    ib->U[3 * m] = (bw_real)(ib->reply[m] * ib->dV[m] / ib->cell_volume);
    ib->U[3 * m + 1] = ib->U[3 * m + 2] = 0;
  }
  /* Images spread for blocks whose halo a marker reaches, as in the forcing itself. */
  bw_ibm_mdf__give_images(ib);
  spread_from(ib, 0, u);
  gather_velocity(ib, u);
  /* Rayleigh quotient in the scalar product in which A is self-adjoint. */
  for (size_t m = 0; m < ib->held; m++) {
    const double x = ib->reply[m], Ax = (double)ib->U[3 * m], dV = ib->dV[m];
    sum[0] += dV * x * x, sum[1] += dV * x * Ax, sum[2] += dV * Ax * Ax;
    ib->reply[m] = Ax;
  }
  bw_comm_sum(bw_grid_comm(ib->grid), 3, sum);
  /* Normalised, so that repeated application neither over- nor underflows. */
  for (size_t m = 0; m < ib->held && sum[2] > 0.0; m++)
    ib->reply[m] /= sqrt(sum[2]);
  return sum[0] > 0.0 ? sum[1] / sum[0] : 0.0;
}

bw_status bw_ibm_mdf__check_growth(bw_ibm_mdf *ib)
{
  enum { TURNS = 8 };
  double largest = 0.0;
  bw_real *field = NULL;
  BW_TRY(bw_comm_agree(bw_grid_comm(ib->grid), bw_field_create(ib->grid, &field)));
  /* Any start will do that is not orthogonal to the largest eigenvector: the same slip
   * everywhere. */
  for (size_t m = 0; m < ib->held; m++)
    ib->reply[m] = 1.0;
  for (int q = 0; q < TURNS; q++)
    largest = power_iteration(ib, field);
  bw_release(&field);
  /* With memory a mode is stable while an iteration takes no more than all of its slip. */
  if (ib->beta > 0.0) ib->share = 1.0 / fmax(1.0, largest);
  /* The slip goes through I - A: it grows where an eigenvalue of A is above 2. */
  BW_REQUIRE(largest <= 2.0, BW_EINPUT,
             "markers: forcing would grow by %.2f per iteration, they stand for more volume than "
             "they have room for: give each its area times the grid spacing, or use fewer",
             largest - 1.0);
  return BW_OK;
}

void bw_ibm_mdf_set_ghosts(bw_ibm_mdf *ib, bw_ibm_mdf_ghosts_fn function, void *context)
{
  ib->ghosts = function;
  ib->ghosts_of = context;
}

/* Does marker m have a memory? */
static bool remembers(const bw_ibm_mdf *ib, size_t m)
{
  return !isnan(ib->M[3 * m]);
}

/* u += dt gamma_r spread(M), QdV += gamma_r M. Collective. */
static void recall(bw_ibm_mdf *ib, bw_real *const u[3], double dt)
{
  static const double gamma[3] = {8.0 / 15, 2.0 / 15, 1.0 / 3}; /* bw_ns_channel.h */
  const double share = gamma[ib->call % 3], per_volume = share * dt / ib->cell_volume;
  const double start = bw_wall_time();
  for (size_t m = 0; m < ib->held; m++) {
    const bool has = remembers(ib, m);
    for (size_t i = 3 * m; i < 3 * m + 3; i++) {
      const double M = has ? ib->M[i] : 0.0;
      ib->QdV[i] += share * M;
      ib->U[i] = (bw_real)(per_volume * M);
    }
  }
  const double ready = bw_wall_time();
  bw_ibm_mdf__give_images(ib);
  const double given = bw_wall_time();
  spread_from(ib, 0, u);
  ib->cost.images += given - ready;
  ib->cost.kernels += bw_wall_time() - given + ready - start;
}

void bw_ibm_mdf_force(bw_ibm_mdf *ib, bw_real *const u[3], double dt)
{
  if (ib->markers == ib->outside) return;
  /* What the surface needed before comes first: iterations have to find the rest only. */
  if (ib->beta > 0.0) recall(ib, u, dt);
  /* POROUS 3.79 to 3.82, n_iter times: what one spreading leaves of the slip the next takes. */
  for (int s = 0; s < ib->n_iter; s++) {
    /* Markers near a side read the ghosts beyond it, which no spreading has reached. */
    if (ib->ghosts != NULL && (s > 0 || ib->beta > 0.0)) ib->ghosts(ib->ghosts_of);
    const double start = bw_wall_time();
    const double slip = force_held(ib, u, dt);
    if (s == 0) ib->slip_sum = slip;
    const double held = bw_wall_time();
    /* Other blocks learn what the markers near them spread ... */
    bw_ibm_mdf__give_images(ib);
    const double given = bw_wall_time();
    /* ... and add it themselves, halos included: no field has to be exchanged. */
    spread_from(ib, ib->held, u);
    ib->cost.images += given - held;
    ib->cost.kernels += bw_wall_time() - given + held - start;
  }
  ib->call++;
  ib->cost.forced += (int64_t)ib->held * ib->n_iter;
}

bw_ibm_mdf_cost bw_ibm_mdf_cost_of(const bw_ibm_mdf *ib)
{
  return ib->cost;
}

void bw_ibm_mdf_cost_reset(bw_ibm_mdf *ib)
{
  ib->cost = (bw_ibm_mdf_cost){.forced = 0};
}

/* Memory of held marker m, component c, with the force of the last step in it; NaN for none. */
static double renewed(const bw_ibm_mdf *ib, size_t m, size_t c)
{
  const double M = ib->M[3 * m + c];
  return ib->call == 0 ? M : (1.0 - ib->beta) * M + ib->beta * ib->QdV[3 * m + c];
}

void bw_ibm_mdf_begin_step(bw_ibm_mdf *ib)
{
  /* M <- (1 - beta) M + beta sum_r Q_r; without a step since there is nothing to take up. */
  for (size_t m = 0; ib->call > 0 && ib->beta > 0.0 && m < ib->held; m++)
    for (size_t c = 0; c < 3; c++)
      ib->M[3 * m + c] = renewed(ib, m, c);
  /* What was taken up may press on a surface from all sides; what is as it was has been drained. */
  if (ib->call > 0) bw_ibm_mdf__drain(ib);
  ib->call = 0;
  if (ib->held > 0) memset(ib->QdV, 0, 3 * ib->held * sizeof *ib->QdV);
}

/* held (sorted) values in reply's order -> the caller's array; markers outside get zero. */
static void return_to_caller(bw_ibm_mdf *ib, double out[])
{
  /* Markers outside the box were not sent; theirs stays zero. */
  if (ib->n > 0) memset(out, 0, 3 * ib->n * sizeof *out);
  if (ib->plan == NULL) return;
  bw_exchange_backward(ib->plan, 3 * sizeof *ib->reply, ib->reply, ib->answer);
  for (size_t i = 0; i < ib->n_sent; i++)
    memcpy(out + 3 * ib->sent_from[i], ib->answer + 3 * i, 3 * sizeof *out);
}

void bw_ibm_mdf_marker_force(bw_ibm_mdf *ib, double QdV[])
{
  for (size_t m = 0; m < ib->held; m++)
    memcpy(ib->reply + 3 * (size_t)ib->order[m], ib->QdV + 3 * m, 3 * sizeof *QdV);
  return_to_caller(ib, QdV);
}

void bw_ibm_mdf_memory(bw_ibm_mdf *ib, double M[])
{
  for (size_t m = 0; m < ib->held; m++) {
    const bool has = ib->beta > 0.0 && remembers(ib, m);
    for (size_t c = 0; c < 3; c++)
      ib->reply[3 * (size_t)ib->order[m] + c] = has ? renewed(ib, m, c) : 0.0;
  }
  return_to_caller(ib, M);
}

void bw_ibm_mdf_interpolate(bw_ibm_mdf *ib, bw_real *const u[3], double U[])
{
  gather_velocity(ib, u);
  for (size_t m = 0; m < ib->held; m++)
    for (int c = 0; c < 3; c++)
      ib->reply[3 * (size_t)ib->order[m] + c] = (double)ib->U[3 * m + c];
  return_to_caller(ib, U);
}

void bw_ibm_mdf_lack_of(bw_ibm_mdf *ib, bw_real *const u[3], double lack[])
{
  gather_velocity(ib, u);
  for (size_t m = 0; m < ib->held; m++)
    bw_ibm_mdf__lack(ib, m, ib->reply + 3 * (size_t)ib->order[m]);
  return_to_caller(ib, lack);
}

void bw_ibm_mdf_spread(bw_ibm_mdf *ib, const double F[], bw_real *const u[3])
{
  if (ib->plan == NULL) return;
  /* The caller's order to that of the routes, then to the ranks that hold the markers. */
  for (size_t i = 0; i < ib->n_sent; i++)
    memcpy(ib->answer + 3 * i, F + 3 * ib->sent_from[i], 3 * sizeof *F);
  bw_exchange_forward(ib->plan, 3 * sizeof *F, ib->answer, ib->reply);
  /* Sorted by cell, and already times dV/h^3, as the kernels want it. */
  for (size_t m = 0; m < ib->held; m++)
    for (int c = 0; c < 3; c++)
      ib->U[3 * m + c] =
          (bw_real)(ib->reply[3 * (size_t)ib->order[m] + c] * ib->dV[m] / ib->cell_volume);
  bw_ibm_mdf__give_images(ib);
  spread_from(ib, 0, u);
}

bw_ibm_mdf_report bw_ibm_mdf_measure(bw_ibm_mdf *ib, bw_real *const u[3])
{
  const bw_comm *comm = bw_grid_comm(ib->grid);
  double sum[5] = {ib->slip_sum, 0.0, 0.0, 0.0, 0.0};
  double most[3] = {(double)ib->held, -HUGE_VAL, -HUGE_VAL}; /* held, dV/h^3, -dV/h^3 */
  gather_velocity(ib, u);
  /* The velocity now at the markers: the slip after the last call of force. */
  for (size_t m = 0; m < ib->held; m++) {
    const double volume = ib->dV[m] / ib->cell_volume;
    most[1] = fmax(most[1], volume);
    most[2] = fmax(most[2], -volume);
    double lack[3];
    bw_ibm_mdf__lack(ib, m, lack);
    for (int c = 0; c < 3; c++) {
      sum[1] += lack[c] * lack[c];
      sum[2 + c] += ib->QdV[3 * m + c];
    }
  }
  /* Sums and maxima of all ranks in one message each. */
  bw_comm_sum(comm, 5, sum);
  bw_comm_max(comm, 3, most);
  const double inside = (double)(ib->markers - ib->outside);
  const double per_marker = inside > 0.0 ? 1.0 / inside : 0.0;
  return (bw_ibm_mdf_report){.slip_before = sqrt(sum[0] * per_marker),
                             .slip_after = sqrt(sum[1] * per_marker),
                             .total_force = {sum[2], sum[3], sum[4]},
                             .markers = ib->markers,
                             .outside = ib->outside,
                             .imbalance = most[0] * bw_comm_size(comm) * per_marker,
                             .spacing_min = inside > 0.0 ? -most[2] : 0.0,
                             .spacing_max = inside > 0.0 ? most[1] : 0.0};
}
