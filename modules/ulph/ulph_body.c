/* The solids in the fluid: their particles come, move, and are read. */
#include "bw_memory.h"
#include "bw_number.h"
#include "bw_shape_surface.h"
#include "ulph_internal.h"

/* ---- they come ---- */
static bw_status check_spacing(const bw_ulph *u, double spacing)
{
  int64_t times = 0;
  const double dx = u->config.dx;
  BW_REQUIRE(spacing > 0 && bw_divides(dx, spacing, &times) && times >= 1, BW_EINPUT,
             "ulph: the solid's particles are %g apart and the fluid's %g; the solid has to be as "
             "fine or finer by a whole number: take %g for the solid, or %g for the fluid",
             spacing, dx, dx / fmax(1, ceil(dx / spacing * (1 - 1e-9))),
             spacing * fmax(1, rint(dx / spacing)));
  BW_REQUIRE(u->body.n == 0, BW_EINPUT,
             "ulph: solids are there already: give all of them in one call");
  return BW_OK;
}

static bw_status copy_body(bw_ulph *u, int64_t n, const double V[], const double x[], int n_walls,
                           const bw_ulph_wall wall[])
{
  bw_ulph__body *b = &u->body;
  const bool planar = u->config.dimensions == 2;
  b->n = n;
  BW_TRY(BW_ALLOCATE(&b->volume, (size_t)n));
  BW_TRY(BW_ALLOCATE(&b->x, 3 * (size_t)n));
  BW_TRY(BW_ALLOCATE(&b->v, 3 * (size_t)n));
  memcpy(b->x, x, 3 * (size_t)n * sizeof *x);
  for (int64_t i = 0; i < n; i++) {
    bool seen = true;
    for (int w = 0; w < n_walls && seen; w++)
      seen = bw_shape_distance(wall[w].count, wall[w].shape, planar, x + 3 * i) > 0;
    b->volume[i] = seen ? V[i] : 0;
  }
  return BW_OK;
}

/* Two faces of each particle; this rank takes its share, wherever they are. */
static bw_status add_faces(bw_ulph *u)
{
  const int64_t rank = bw_comm_rank(u->comm), size = bw_comm_size(u->comm), n = u->body.n;
  const int64_t from = n * rank / size, to = n * (rank + 1) / size;
  BW_TRY(BW_ENLARGE(&u->own, u->n, u->n + 2 * (size_t)(to - from)));
  for (int64_t q = 2 * from; q < 2 * to; q++) {
    const int64_t i = q / 2;
    if (u->body.volume[i] <= 0) continue;
    bw_ulph__particle p = {.id = ((int64_t)u->n_walls << 40) + q, .wall = u->n_walls};
    p.m = u->config.rho0 * u->body.volume[i];
    p.rho = u->config.rho0;
    memcpy(p.x, u->body.x + 3 * i, sizeof p.x);
    memcpy(p.at, p.x, sizeof p.at);
    u->own[u->n++] = p;
  }
  return BW_OK;
}

/* Fluid inside of a solid, by the lists. */
static bw_status check_apart(const bw_ulph *u, double least)
{
  for (size_t c = 0; c < u->facing.n; c++)
    for (int l = 0; l < u->facing.of[c].lanes; l++) {
      const double *x = u->own[u->face.first + u->facing.of[c].first + (size_t)l].x;
      for (size_t e = u->facing.of[c].begin; e < u->facing.of[c].walls; e++) {
        const double *y = u->near[u->list[e]].x;
        const double d[3] = {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
        BW_REQUIRE(bw_ulph__dot(d, d) >= least * least * (1 - 1e-9), BW_EINPUT,
                   "ulph: the fluid particle at (%g, %g, %g) is inside the solid, %g from its "
                   "particle at (%g, %g, %g): cut the solid out of the fluid",
                   y[0], y[1], y[2], sqrt(bw_ulph__dot(d, d)), x[0], x[1], x[2]);
      }
    }
  return BW_OK;
}

bw_status bw_ulph_add_body(bw_ulph *u, int64_t n, const double V[], const double x[],
                           double spacing, bool no_slip, int n_walls, const bw_ulph_wall wall[])
{
  BW_TRY(bw_comm_agree(u->comm, check_spacing(u, spacing)));
  BW_TRY(bw_comm_agree(u->comm, copy_body(u, n, V, x, n_walls, wall)));
  u->no_slip[u->n_walls] = u->body.no_slip = no_slip;
  BW_TRY(bw_comm_agree(u->comm, add_faces(u)));
  BW_TRY(bw_ulph__rebuild(u));
  return bw_comm_agree(u->comm, check_apart(u, 0.25 * (u->config.dx + spacing)));
}

/* ---- they move, and are read ---- */
void bw_ulph_move_body(bw_ulph *u, const double x[], const double v[])
{
  memcpy(u->body.x, x, 3 * (size_t)u->body.n * sizeof *x);
  memcpy(u->body.v, v, 3 * (size_t)u->body.n * sizeof *v);
}

void bw_ulph_body_force(const bw_ulph *u, double F[], double area[])
{
  const size_t n = (size_t)u->body.n;
  memset(F, 0, 3 * n * sizeof *F);
  memset(area, 0, n * sizeof *area);
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    const size_t b = bw_ulph__body_particle(p);
    area[b] += p->surface;
    for (size_t k = 0; k < 3; k++)
      F[3 * b + k] += p->a[k] + p->shift[k];
  }
  bw_comm_sum(u->comm, 3 * n, F);
  bw_comm_sum(u->comm, n, area);
}

void bw_ulph_body_pressure(const bw_ulph *u, double p[])
{
  memset(p, 0, (size_t)u->body.n * sizeof *p);
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++)
    p[bw_ulph__body_particle(u->own + i)] += 0.5 * u->own[i].p;
  bw_comm_sum(u->comm, (size_t)u->body.n, p);
}

/* ---- checkpoints ---- */
/* A row: place of the lists, place, velocity; of each face force, drag, area. */
enum { PLACES = 9, FACE = 7 };

void bw_ulph_body_get(const bw_ulph *u, double rows[])
{
  memset(rows, 0, (size_t)u->body.n * BW_ULPH_BODY_ROW * sizeof *rows);
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++) {
    const bw_ulph__particle *p = u->own + i;
    const size_t b = bw_ulph__body_particle(p);
    double *row = rows + BW_ULPH_BODY_ROW * b, *face = row + PLACES + FACE * (p->id & 1);
    /* One of the two faces tells where they are. */
    if ((p->id & 1) == 0) {
      memcpy(row, p->at, sizeof p->at);
      memcpy(row + 3, u->body.x + 3 * b, sizeof p->x);
      memcpy(row + 6, u->body.v + 3 * b, sizeof p->v);
    }
    memcpy(face, p->a, sizeof p->a);
    memcpy(face + 3, p->shift, sizeof p->shift);
    face[6] = p->surface;
  }
  bw_comm_sum(u->comm, (size_t)u->body.n * BW_ULPH_BODY_ROW, rows);
}

void bw_ulph_body_set(bw_ulph *u, const double rows[])
{
  for (size_t b = 0; b < (size_t)u->body.n; b++) {
    const double *row = rows + BW_ULPH_BODY_ROW * b;
    if (u->body.volume[b] <= 0) continue;
    memcpy(u->body.x + 3 * b, row + 3, 3 * sizeof *row);
    memcpy(u->body.v + 3 * b, row + 6, 3 * sizeof *row);
  }
  for (size_t i = u->face.first; i < u->face.first + u->face.own; i++) {
    bw_ulph__particle *p = u->own + i;
    const size_t b = bw_ulph__body_particle(p);
    const double *row = rows + BW_ULPH_BODY_ROW * b, *face = row + PLACES + FACE * (p->id & 1);
    memcpy(p->at, row, sizeof p->at);
    memcpy(p->a, face, sizeof p->a);
    memcpy(p->shift, face + 3, sizeof p->shift);
    p->surface = face[6];
  }
}
