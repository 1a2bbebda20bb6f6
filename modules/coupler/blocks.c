/* Markers that several surface particles share, for particles finer than the grid. */
#include "bw_memory.h"
#include "coupler_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Area, position, velocity, normal of a member; 1 where its marker is to know it; its body. */
enum { ROW = 12, NORMAL = 7, SIDED = 10, BODY = 11 };

/* Bits of a block's number: 19 per direction, 3 for the face; the top bit marks particles with a
 * marker of their own, which are known by their id. */
static const int BITS = 19;
static const int64_t OWN_MARKER = (int64_t)1 << 62;

void bw_coupler__blocks_release(bw_coupler__blocks *b)
{
  bw_exchange_destroy(&b->plan);
  double **const all[] = {&b->send, &b->receive, &b->X,    &b->V,     &b->N,
                          &b->M,    &b->dV,      &b->area, &b->force, &b->out};
  for (size_t q = 0; q < sizeof all / sizeof *all; q++)
    bw_release(all[q]);
  bw_release(&b->order);
  bw_release(&b->marker);
  bw_release(&b->body);
  bw_release(&b->particle);
  bw_release(&b->broken);
  bw_release(&b->face);
  bw_release(&b->block);
}

/* 2 axis + side of the largest component of a normal; the first one where two are equal. */
static int8_t face_of(const double axes[3][3], const double N[3])
{
  int best = 0;
  double most = 0.0;
  /* A tie within rounding must not depend on the rank or the compiler: the first axis wins. */
  for (int d = 0; d < 3; d++) {
    const double along = axes[d][0] * N[0] + axes[d][1] * N[1] + axes[d][2] * N[2];
    if (fabs(along) > most + 1e-6) most = fabs(along), best = 2 * d + (along > 0.0);
  }
  return (int8_t)best;
}

/* Which block of k^3 sites of the finest lattice, ds apart, a reference place lies in, packed. */
static int64_t block_of(const bw_solid_config *s, double ds, int k, const double X0[3])
{
  int64_t packed = 0;
  for (int d = 0; d < 3; d++) {
    /* Whole lattice steps from the origin, in the lattice's own axes. */
    double along = 0.0;
    for (int e = 0; e < 3; e++)
      along += (X0[e] - s->origin[e]) * s->axes[d][e];
    /* Coarser particles have their centres between the sites. */
    const double block = floor(floor(along / ds + 0.25) / k);
    /* Masked, as block numbers may be negative. */
    packed = (packed << BITS) | ((int64_t)block & (((int64_t)1 << BITS) - 1));
  }
  return packed;
}

bw_status bw_coupler__blocks_create(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  const bw_solid_config *s = bw_solid_settings(c->solid);
  bw_status st = BW_ALLOCATE(&b->particle, c->n);
  BW_THEN(st, BW_ALLOCATE(&b->broken, c->n));
  BW_THEN(st, BW_ALLOCATE(&b->face, c->n));
  BW_THEN(st, BW_ALLOCATE(&b->block, c->n));
  BW_THEN(st, BW_ALLOCATE(&b->send, ROW * c->n));
  st = bw_comm_agree(bw_solid_comm(c->solid), st);
  if (st != BW_OK) return st;
  /* The first surface: faces and blocks belong to the reference shape and never change. */
  const bw_pd_surface surface = bw_pd_interface_surface(c->interface);
  bw_solid_get_reference(c->solid, c->X);
  const double ds = ldexp(s->ds, -bw_solid_finest(c->solid));
  for (size_t i = 0; i < c->n; i++) {
    b->block[i] = block_of(s, ds, c->block, c->X + 3 * i);
    b->face[i] = -1;
  }
  for (size_t q = 0; q < surface.n; q++)
    b->face[surface.particle[q]] = face_of(s->axes, surface.N + 3 * q);
  b->n_surface = SIZE_MAX; /* no plan yet */
  return BW_OK;
}

/* Has the set of surface particles, or what they lost, changed? The same on all ranks. */
static bool plan_is_stale(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  /* The surface changed, or a particle on it lost a bond and gets a marker of its own. */
  double stale = b->n_surface != c->n_surface ||
                 memcmp(b->particle, c->particle, c->n_surface * sizeof *c->particle) != 0;
  if (stale == 0.0 && b->events != bw_solid_events(c->solid)) stale = 1.0;
  bw_comm_max(bw_solid_comm(c->solid), 1, &stale);
  return stale > 0.0;
}

typedef struct {
  int64_t key, id;
  int32_t member;
} member_key;

static int by_key_and_id(const void *a, const void *b)
{
  const member_key *p = a, *q = b;
  if (p->key != q->key) return p->key < q->key ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

static int64_t key_of(const bw_coupler *c, int32_t p)
{
  const bw_coupler__blocks *b = &c->blocks;
  /* New faces and damaged particles move by themselves, so no block may speak for them. */
  if (b->face[p] < 0 || b->broken[p] > 0) return OWN_MARKER | bw_solid_id(c->solid)[p];
  return ((int64_t)b->face[p] << (3 * BITS)) | b->block[p];
}

/* Any fixed spread of blocks over ranks (Fibonacci hashing). */
static int rank_of(int64_t key, int ranks)
{
  return (int)(((uint64_t)key * 0x9E3779B97F4A7C15u >> 33) % (uint64_t)ranks);
}

/* Number the markers of the members received, in the order of their blocks. */
static bw_status number_markers(bw_coupler__blocks *b, const int64_t received[])
{
  const size_t n = b->n_members;
  member_key *list = NULL;
  bw_release(&b->order);
  bw_release(&b->marker);
  bw_release(&b->receive);
  bw_status st = BW_ALLOCATE(&list, n);
  BW_THEN(st, BW_ALLOCATE(&b->order, n));
  BW_THEN(st, BW_ALLOCATE(&b->marker, n));
  BW_THEN(st, BW_ALLOCATE(&b->receive, ROW * n));
  b->n = 0;
  /* Sorted by block and id: neither order nor numbers depend on who sent a member. */
  for (size_t q = 0; st == BW_OK && q < n; q++)
    list[q] = (member_key){received[2 * q], received[2 * q + 1], (int32_t)q};
  if (st == BW_OK && n > 0) qsort(list, n, sizeof *list, by_key_and_id);
  for (size_t q = 0; st == BW_OK && q < n; q++) {
    /* A new block begins: the next marker. */
    if (q == 0 || list[q].key != list[q - 1].key) b->n++;
    b->order[q] = list[q].member;
    b->marker[list[q].member] = (int32_t)(b->n - 1);
  }
  bw_release(&list);
  return st;
}

static bw_status allocate_markers(bw_coupler__blocks *b)
{
  double **const all[] = {&b->X, &b->V, &b->N, &b->out, &b->M, &b->force, &b->dV, &b->area};
  for (int q = 0; q < 8; q++) {
    bw_release(all[q]);
    BW_TRY(BW_ALLOCATE(all[q], (q < 6 ? 3 : 1) * b->n));
  }
  bw_release(&b->body);
  BW_TRY(BW_ALLOCATE(&b->body, b->n));
  return BW_OK;
}

/* Collective. */
static bw_status make_plan(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  const bw_comm *comm = bw_solid_comm(c->solid);
  const size_t n = c->n_surface;
  int *rank = NULL;
  int64_t *send = NULL, *receive = NULL;
  bw_solid_get_broken(c->solid, b->broken);
  bw_status st = BW_ALLOCATE(&rank, n);
  BW_THEN(st, BW_ALLOCATE(&send, 2 * n));
  /* Members name their block; the rank that gathers it follows from the block alone. */
  for (size_t q = 0; st == BW_OK && q < n; q++) {
    send[2 * q] = key_of(c, c->particle[q]);
    send[2 * q + 1] = bw_solid_id(c->solid)[c->particle[q]];
    rank[q] = rank_of(send[2 * q], bw_comm_size(comm));
  }
  st = bw_comm_agree(comm, st);
  /* The old plan is for another surface. */
  bw_exchange_destroy(&b->plan);
  BW_THEN(st, bw_exchange_create(comm, n, rank, &b->plan));
  /* Plans exist on all ranks: how many members each got decides the sizes. */
  if (st == BW_OK) {
    b->n_members = bw_exchange_received(b->plan);
    st = bw_comm_agree(comm, BW_ALLOCATE(&receive, 2 * b->n_members));
  }
  if (st == BW_OK) {
    /* Each rank numbers the markers it will hand over. */
    bw_exchange_forward(b->plan, 2 * sizeof *send, send, receive);
    st = number_markers(b, receive);
    BW_THEN(st, allocate_markers(b));
    st = bw_comm_agree(comm, st);
  }
  /* What plan_is_stale compares the next surface with. */
  memcpy(b->particle, c->particle, n * sizeof *c->particle);
  b->n_surface = n;
  b->events = bw_solid_events(c->solid);
  bw_release(&rank);
  bw_release(&send);
  bw_release(&receive);
  return st;
}

/* N to the length 1; false if it was no longer than `least`. */
static bool make_unit(double least, double N[3])
{
  const double length = sqrt(N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
  for (int d = 0; d < 3; d++)
    N[d] /= fmax(length, least);
  return length > least;
}

/* Means over the members, weighted with their areas, in a fixed order. */
static void gather_markers(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  memset(b->X, 0, 3 * b->n * sizeof *b->X);
  memset(b->V, 0, 3 * b->n * sizeof *b->V);
  memset(b->N, 0, 3 * b->n * sizeof *b->N);
  memset(b->out, 0, 3 * b->n * sizeof *b->out);
  memset(b->area, 0, b->n * sizeof *b->area);
  /* In the fixed order of blocks and ids, so that sums are the same on any number of ranks. */
  for (size_t q = 0; q < b->n_members; q++) {
    const double *row = b->receive + ROW * b->order[q];
    const size_t m = (size_t)b->marker[b->order[q]];
    b->area[m] += row[0];
    for (int d = 0; d < 3; d++) {
      b->X[3 * m + d] += row[0] * row[1 + d];
      b->V[3 * m + d] += row[0] * row[4 + d];
      b->out[3 * m + d] += row[0] * row[NORMAL + d];
      b->N[3 * m + d] += row[0] * row[SIDED] * row[NORMAL + d];
    }
    b->body[m] = (int)row[BODY];
  }
  for (size_t m = 0; m < b->n; m++) {
    /* Area of the block times the grid spacing is the marker's volume. */
    b->dV[m] = b->area[m] * c->h; /* ERRATA 17 */
    for (int d = 0; d < 3; d++)
      b->X[3 * m + d] /= b->area[m], b->V[3 * m + d] /= b->area[m];
    /* Members look about the same way, being of one face. Most of them know it, or none does. */
    if (!make_unit(0.5 * b->area[m], b->N + 3 * m)) b->N[3 * m] = NAN;
    if (!make_unit(0.5 * b->area[m], b->out + 3 * m)) b->body[m] = -1;
  }
}

bw_status bw_coupler__blocks_follow(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  if (plan_is_stale(c)) BW_TRY(make_plan(c));
  /* Area, place and velocity of each member to the rank of its marker. */
  for (size_t q = 0; q < c->n_surface; q++) {
    b->send[ROW * q] = c->area[q];
    memcpy(b->send + ROW * q + 1, c->marker_X + 3 * q, 3 * sizeof *b->send);
    memcpy(b->send + ROW * q + 4, c->marker_V + 3 * q, 3 * sizeof *b->send);
    memcpy(b->send + ROW * q + NORMAL, c->normal + 3 * q, 3 * sizeof *b->send);
    b->send[ROW * q + SIDED] = !isnan(c->side[3 * q]);
    b->send[ROW * q + BODY] = c->body[c->particle[q]];
  }
  bw_exchange_forward(b->plan, ROW * sizeof *b->send, b->send, b->receive);
  gather_markers(c);
  return BW_OK;
}

/* What belongs to the markers (n,3), times `scale`, to their members, out (n_surface,3), who take
 * it by their own share of the area. Collective. */
static void share_out(bw_coupler *c, const double of_marker[], double scale, double out[])
{
  bw_coupler__blocks *b = &c->blocks;
  for (size_t q = 0; q < b->n_members; q++) { /* the row's place is free */
    const size_t m = (size_t)b->marker[q];
    for (size_t d = 0; d < 3; d++)
      b->receive[3 * q + d] = scale * of_marker[3 * m + d] / b->area[m];
  }
  bw_exchange_backward(b->plan, 3 * sizeof *b->receive, b->receive, out);
  for (size_t q = 0; q < c->n_surface; q++)
    for (size_t d = 0; d < 3; d++)
      out[3 * q + d] *= c->area[q];
}

void bw_coupler__blocks_reaction(bw_coupler *c)
{
  /* Force of the step on the fluid, per marker. */
  bw_ibm_mdf_marker_force(c->ibm, c->blocks.force);
  share_out(c, c->blocks.force, -c->config.rho, c->force); /* ERRATA 18 */
}

void bw_coupler__blocks_gather_memory(bw_coupler *c)
{
  bw_coupler__blocks *b = &c->blocks;
  bw_exchange_forward(b->plan, 3 * sizeof *b->receive, c->marker_M, b->receive);
  memset(b->M, 0, 3 * b->n * sizeof *b->M);
  /* In the fixed order of blocks and ids. A particle without memory is a block of its own. */
  for (size_t q = 0; q < b->n_members; q++) {
    const size_t m = (size_t)b->marker[b->order[q]];
    for (size_t d = 0; d < 3; d++)
      b->M[3 * m + d] += b->receive[3 * (size_t)b->order[q] + d];
  }
}

void bw_coupler__blocks_velocity(bw_coupler *c, double out[])
{
  bw_coupler__blocks *b = &c->blocks;
  bw_ibm_mdf_interpolate(c->ibm, bw_ns_channel_velocity(c->fluid), b->force); /* scratch */
  for (size_t q = 0; q < b->n_members; q++)
    memcpy(b->receive + 3 * q, b->force + 3 * (size_t)b->marker[q], 3 * sizeof *b->force);
  bw_exchange_backward(b->plan, 3 * sizeof *b->receive, b->receive, out);
}

void bw_coupler__blocks_memory(bw_coupler *c)
{
  /* Not in use now: the force per marker. */
  bw_ibm_mdf_memory(c->ibm, c->blocks.force);
  share_out(c, c->blocks.force, 1.0, c->marker_M);
}
