/* What a checkpoint holds. */
#include "bw_mix.h"
#include "solid_internal.h"

#include <string.h>

size_t bw_solid_bits_bytes(const bw_solid *s)
{
  return ((size_t)s->body->directions + 7) / 8;
}

void bw_solid_get_bits(const bw_solid *s, uint8_t bits[])
{
  const bw_pd_body *pd = s->body;
  const size_t bytes = bw_solid_bits_bytes(s);
  /* By direction, not by slot: slots differ with the number of ranks. */
  memset(bits, 0, pd->n * bytes);
  for (size_t b = 0; b < pd->bonds.n_block; b++)
    for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++)
      for (int lane = 0; lane < BW_PD_LANES; lane++)
        if (pd->bonds.slot[q].mask >> lane & 1) {
          const size_t h = (size_t)bw_pd_body_owner(&pd->bonds.block[b], lane);
          const int d = pd->bonds.slot[q].direction;
          bits[h * bytes + (size_t)d / 8] |= (uint8_t)(1u << d % 8);
        }
}

bw_status bw_solid_set_bits(bw_solid *s, const uint8_t bits[])
{
  bw_pd_body *pd = s->body;
  const size_t bytes = bw_solid_bits_bytes(s);
  int64_t changed = 0;
  for (size_t b = 0; b < pd->bonds.n_block; b++) {
    pd->bonds.block[b].broken = false;
    for (uint32_t q = pd->bonds.block[b].slot; q < pd->bonds.block[b + 1].slot; q++) {
      bw_pd_slot *slot = &pd->bonds.slot[q];
      /* A bond that never was cannot come to hold. */
      const uint8_t before = slot->mask;
      slot->mask = 0;
      for (int lane = 0; lane < BW_PD_LANES; lane++) {
        if (!(slot->family >> lane & 1)) continue;
        const size_t h = (size_t)bw_pd_body_owner(&pd->bonds.block[b], lane);
        const int d = slot->direction;
        if (bits[h * bytes + (size_t)d / 8] >> d % 8 & 1) slot->mask |= (uint8_t)(1u << lane);
      }
      changed |= slot->mask != before;
      /* Contact looks for broken bonds in these blocks. */
      if (slot->mask != slot->family) pd->bonds.block[b].broken = true;
    }
  }
  /* Whether forces are those of now is known to all ranks alike. */
  bw_comm_max_int(pd->comm, 1, &changed);
  if (changed == 0) return BW_OK;
  /* Whoever keeps lists of bonds makes them anew; forces given by a restart stay. */
  pd->bonds.events++;
  if (s->contact != NULL) bw_pd_contact_recheck(s->contact);
  if (!s->restored) pd->current = false;
  return BW_OK;
}

static uint64_t mix_number(uint64_t hash, double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bw_mix(hash + bits + UINT64_C(0x9e3779b97f4a7c15));
}

uint64_t bw_solid_fingerprint(const bw_solid *s)
{
  const bw_pd_body *pd = s->body;
  uint64_t all = 0;
  for (size_t i = 0; i < pd->n; i++) {
    double X0[3];
    bw_pd_body_reference(pd, i, X0);
    uint64_t hash = bw_mix((uint64_t)pd->points.id[i] + 1);
    for (int k = 0; k < 3; k++)
      hash = mix_number(hash, X0[k]);
    hash = bw_mix(hash + (pd->points.kind[i] & ~(unsigned)BW_PD_RETIRED));
    /* Exclusive or: whoever owns a particle, its part is the same. */
    all ^= bw_mix(hash + pd->points.group[i]);
  }
  bw_comm_xor(pd->comm, 1, &all);
  return mix_number(all, pd->level[0].horizon);
}

size_t bw_solid_restart_row(const bw_solid *s)
{
  size_t width = BW_SOLID__ROW;
  for (int q = 0; q < s->body->fields.n; q++)
    width += s->body->fields.row[q].saved;
  return width;
}

/* The law's saved fields of the own particles, behind the rest of each row. */
static void get_fields(const bw_solid *s, double rows[])
{
  const bw_pd_body *pd = s->body;
  const size_t width = bw_solid_restart_row(s);
  size_t column = BW_SOLID__ROW;
  for (int q = 0; q < pd->fields.n; q++) {
    if (!pd->fields.row[q].saved) continue;
    for (size_t i = 0; i < pd->n; i++)
      rows[width * i + column] = (double)pd->fields.row[q].value[pd->points.place[i]];
    column++;
  }
}

/* Copies get a field at once: nothing is evaluated before the next step moves the particles. */
static void set_fields(bw_solid *s, const double rows[])
{
  bw_pd_body *pd = s->body;
  const size_t width = bw_solid_restart_row(s);
  size_t column = BW_SOLID__ROW;
  for (int q = 0; q < pd->fields.n; q++) {
    if (!pd->fields.row[q].saved) continue;
    for (size_t i = 0; i < pd->n; i++)
      pd->fields.row[q].value[pd->points.place[i]] = (bw_real)rows[width * i + column];
    if (pd->fields.row[q].after >= 0) bw_pd_body_fill_places(pd, pd->fields.row[q].value);
    column++;
  }
}

/* Behind the running sums: the coefficients of the damping that the accelerations hold. */
enum { DAMPING = BW_SOLID_RESTART_SUMS - 3 };
static void get_damping(const bw_solid *s, double damping[3])
{
  damping[0] = s->body->damping.pair;
  damping[1] = s->body->damping.mean;
  damping[2] = s->body->damping.absolute;
}

/* Is the damping still that of the rows? */
static bool damped_alike(const bw_solid *s, const double sums[])
{
  double now[3];
  get_damping(s, now);
  return memcmp(now, sums + DAMPING, sizeof now) == 0;
}

void bw_solid_get_restart(const bw_solid *s, double rows[], double sums[])
{
  const bw_pd_body *pd = s->body;
  const size_t width = bw_solid_restart_row(s);
  /* In a set a solid that was evaluated by itself has lost the others' push. */
  const bool lone = s->shared != 0 && s->shared != s->evaluated && !s->restored;
  const int stale = pd->current && !lone ? 0 : BW_SOLID__STALE;
  for (size_t i = 0; i < pd->n; i++) {
    double *row = rows + width * i;
    for (size_t k = 0; k < 3; k++) {
      row[k] = (double)pd->u[k][pd->points.place[i]];
      row[3 + k] = (double)pd->v[k][i];
      row[6 + k] = (double)(pd->a[k][i] + pd->load.extra[k][i]);
      row[9 + k] = (double)pd->load.damp[k][i];
    }
    const int gone = pd->points.kind[i] & BW_PD_RETIRED ? BW_SOLID__GONE : 0;
    row[BW_SOLID__ROW - 1] = gone | stale;
  }
  get_fields(s, rows);
  const bw_solid_book *book = &s->book;
  const double none[3] = {0};
  const double *on_walls = s->contact != NULL ? bw_pd_contact_wall_force(s->contact) : none;
  const double mine[BW_SOLID_RESTART_SUMS] = {
      book->damping, pd->bonds.released, book->external, (double)book->precracked,
      book->retired, book->wall[0],      book->wall[1],  book->wall[2],
      on_walls[0],   on_walls[1],        on_walls[2]};
  memcpy(sums, mine, sizeof mine);
  bw_comm_sum(pd->comm, DAMPING, sums);
  get_damping(s, sums + DAMPING);
}

/* The sums of all ranks are the first one's. */
static void set_sums(bw_solid *s, const double sums[])
{
  bw_pd_body *pd = s->body;
  const double own = bw_comm_rank(pd->comm) == 0;
  s->book.damping = own * sums[0];
  pd->bonds.released = own * sums[1];
  s->book.external = own * sums[2];
  s->book.precracked = (int64_t)(own * sums[3]);
  s->book.retired = own * sums[4];
  for (int k = 0; k < 3; k++) {
    s->book.wall[k] = own * sums[5 + k];
    if (s->contact != NULL) bw_pd_contact_wall_force(s->contact)[k] = own * sums[8 + k];
  }
}

/* Were the rows written before the forces of a new state were known? The same on all ranks. */
static bool are_stale(const bw_solid *s, const double rows[])
{
  int64_t stale = 0;
  for (size_t i = 0; i < s->body->n; i++)
    stale |= (int)rows[bw_solid_restart_row(s) * i + BW_SOLID__ROW - 1] & BW_SOLID__STALE;
  bw_comm_max_int(s->body->comm, 1, &stale);
  return stale != 0;
}

bw_status bw_solid_set_restart(bw_solid *s, const double rows[], const double sums[])
{
  bw_pd_body *pd = s->body;
  const size_t width = bw_solid_restart_row(s);
  for (size_t i = 0; i < pd->n; i++)
    /* The acceleration is taken over, not evaluated: the run goes on to the same bits. */
    for (size_t k = 0; k < 3; k++) {
      const double *row = rows + width * i + k;
      pd->u[k][pd->points.place[i]] = (bw_real)row[0];
      pd->v[k][i] = (bw_real)row[3];
      pd->a[k][i] = (bw_real)row[6];
      pd->load.damp[k][i] = (bw_real)row[9]; /* for the book: that of Verlet is of the half step */
      pd->load.extra[k][i] = 0;              /* inside a */
    }
  set_fields(s, rows);
  if (s->levels != NULL) BW_TRY(bw_pd_body_settle(pd, NULL));
  bw_pd_body_adopt_prescribed(pd);
  bw_solid__retire_rows(s, width, rows);
  set_sums(s, sums);
  /* Copies follow; with a given, the state counts as evaluated, unless nobody had evaluated it, or
   * it holds a damping that has ended. */
  bw_pd_body_refresh(pd, true);
  pd->current = s->restored = !are_stale(s, rows) && damped_alike(s, sums);
  s->loaded = s->contact != NULL || bw_pd_body_damped(pd);
  return BW_OK;
}
