/* Fields of a grid: the interior, (z, y, x) in the file, each rank its block. */
#include "bw_memory.h"
#include "checkpoint_internal.h"

typedef struct {
  bw_checkpoint__slab slab;
  int lower[3]; /* first local index stored: 1, or 0 on the rank that has the lower boundary face */
} field_share;

/* A direction of one cell without halo has no second face: index 0 is the cell itself. */
static bool stores_first_face(const bw_grid_view *g, int direction, bool first_face, int d)
{
  return first_face && d == direction && !(d == 2 && g->n[2] == 1);
}

static field_share share_of(const bw_grid_view *g, int direction, bool first_face)
{
  field_share share = {
      .slab = {.kind = BW_CHECKPOINT__FIELD,
               .type = sizeof(bw_real) == sizeof(double) ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT,
               .bytes = sizeof(bw_real),
               .dimensions = 3}};
  for (int d = 0; d < 3; d++) {
    /* The lower boundary face, index 0, belongs to the state of a staggered component: one layer
     * more in the file. */
    const bool face = stores_first_face(g, direction, first_face, d);
    const bool mine = face && g->lo[d] == 0;
    const int at = 2 - d; /* x is the fastest */
    share.lower[d] = mine ? 0 : 1;
    share.slab.size[at] = (hsize_t)g->n[d] + (face ? 1 : 0);
    share.slab.count[at] = (hsize_t)g->m[d] + (mine ? 1 : 0);
    /* Behind that layer everything moves up by one, except on the rank that stores it. */
    share.slab.start[at] = (hsize_t)g->lo[d] + (face && !mine ? 1 : 0);
  }
  return share;
}

static bw_status check_arguments(const bw_checkpoint *ck, const char *name, int direction,
                                 bool first_face)
{
  BW_REQUIRE(!first_face || (direction >= 0 && direction < 3), BW_EINPUT,
             "checkpoint %s: field '%s' with the first face of direction %d, possible are 0 to 2",
             ck->path, name, direction);
  return BW_OK;
}

bw_status bw_checkpoint_put_field(bw_checkpoint *ck, const char *name, const bw_grid *grid,
                                  int direction, bool first_face, const bw_real *field)
{
  const bw_grid_view *g = bw_grid_look(grid);
  BW_TRY(check_arguments(ck, name, direction, first_face));
  const field_share share = share_of(g, direction, first_face);
  bw_real *packed = NULL;
  bw_status st =
      bw_comm_agree(ck->comm, BW_ALLOCATE(&packed, bw_checkpoint__elements(&share.slab)));
  /* Without halo and padding, x fastest: the order of the file. */
  bw_real *to = packed;
  for (int k = share.lower[2]; st == BW_OK && k <= g->m[2]; k++)
    for (int j = share.lower[1]; j <= g->m[1]; j++)
      for (int i = share.lower[0]; i <= g->m[0]; i++)
        *to++ = field[bw_at(g, i, j, k)];
  BW_THEN(st, bw_checkpoint__put(ck, name, &share.slab, packed));
  bw_release(&packed);
  return st;
}

bw_status bw_checkpoint_get_field(bw_checkpoint *ck, const char *name, const bw_grid *grid,
                                  int direction, bool first_face, bw_real *field)
{
  const bw_grid_view *g = bw_grid_look(grid);
  BW_TRY(check_arguments(ck, name, direction, first_face));
  const field_share share = share_of(g, direction, first_face);
  bw_real *packed = NULL;
  bw_status st =
      bw_comm_agree(ck->comm, BW_ALLOCATE(&packed, bw_checkpoint__elements(&share.slab)));
  BW_THEN(st, bw_checkpoint__get(ck, name, &share.slab, packed));
  /* Verified; halos stay as they were until the caller updates them. */
  const bw_real *from = packed;
  for (int k = share.lower[2]; st == BW_OK && k <= g->m[2]; k++)
    for (int j = share.lower[1]; j <= g->m[1]; j++)
      for (int i = share.lower[0]; i <= g->m[0]; i++)
        field[bw_at(g, i, j, k)] = *from++;
  bw_release(&packed);
  return st;
}
