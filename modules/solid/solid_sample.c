/* What a body costs and which step it bears, from small blocks of its material. */
#include "bw_memory.h"
#include "solid_internal.h"

#include <math.h>

/* A block of `edge` sites along each side; *bytes is what it holds when it has been stepped, at
 * rest, and its energies were asked for. */
static bw_status make_block(const bw_comm *self, const bw_solid_config *c, int edge, double *bytes,
                            bw_solid **out)
{
  const int layers = c->geometry == BW_PD_3D ? edge : 1;
  const int64_t n = (int64_t)edge * edge * layers;
  int32_t *site = NULL;
  BW_TRY(BW_ALLOCATE(&site, 3 * (size_t)n));
  for (int64_t q = 0; q < n; q++) {
    site[3 * q] = (int32_t)(q % edge);
    site[3 * q + 1] = (int32_t)(q / edge % edge);
    site[3 * q + 2] = (int32_t)(q / edge / edge);
  }
  const double before = (double)bw_memory_in_use();
  bw_solid_ledger ledger;
  bw_status st = bw_solid_create_same(self, c, n, site, NULL, out);
  if (st == BW_OK) st = bw_solid_step(*out, 0.5 * bw_solid_dt_max(*out));
  BW_THEN(st, bw_solid_account(*out, &ledger));
  *bytes = (double)bw_memory_in_use() - before;
  bw_release(&site);
  return st;
}

/* Two blocks: what they differ in is the inside, and a large body is nothing else. */
static bw_status measure(const bw_comm *self, const bw_solid_config *c, bw_solid_sample *s)
{
  const int reach = (int)ceil(c->horizon_ratio) + 1, dimension = c->geometry == BW_PD_3D ? 3 : 2;
  const int large = dimension == 2 ? 3 : 1; /* in a plane a block has few particles */
  const int edge[2] = {large * (2 * reach + 2), large * (3 * reach + 4)};
  double bytes[2] = {0.0, 0.0}, n[2];
  /* The first block is made twice: what libraries set up once is not counted. */
  for (int made = -1; made < 2; made++) {
    const int q = made < 0 ? 0 : made;
    bw_solid *block = NULL;
    const bw_status st = make_block(self, c, edge[q], &bytes[q], &block);
    if (st != BW_OK) bw_solid_destroy(&block);
    BW_TRY(st);
    n[q] = pow(edge[q], dimension);
    s->dt_max = bw_solid_dt_max(block);
    s->dt_contact = bw_solid_dt_contact(block);
    s->critical_stretch = bw_solid_critical_stretch(block);
    s->horizon = bw_solid_horizon(block);
    bw_solid_destroy(&block);
  }
  s->bytes = fmax(0.0, (bytes[1] - bytes[0]) / (n[1] - n[0]));
  return BW_OK;
}

bw_status bw_solid_try(const bw_comm *comm, const bw_solid_config *config, bw_solid_sample *out)
{
  bw_solid_config c = *config;
  bw_comm *self = NULL;
  *out = (bw_solid_sample){0};
  /* A seam has to fit the body, which the block is not. */
  for (int d = 0; d < 3; d++)
    c.period[d] = 0.0;
  /* The step is that of the finest particles, wherever they are. */
  for (int b = 0; b < config->finer.n; b++)
    c.ds = fmin(c.ds, ldexp(config->ds, -config->finer.box[b].level));
  c.ds = fmin(c.ds, ldexp(config->ds, -config->finer.refine.level));
  c.finer.n = c.finer.refine.level = 0;
  bw_status st = bw_comm_self(&self);
  BW_THEN(st, measure(self, &c, out));
  bw_comm_destroy(&self);
  return bw_comm_agree(comm, st);
}
