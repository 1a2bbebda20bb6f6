/* Building and destroying a body. */
#include "bw_memory.h"
#include "pd_law.h"

#include <math.h>

bw_status bw_pd_body_add_field(bw_pd_body *pd, int after, bool saved, bw_real **value)
{
  BW_REQUIRE(pd->fields.n < BW_PD_FIELDS, BW_EINPUT, "solid: the law %s wants more than %d fields",
             pd->law->name, (int)BW_PD_FIELDS);
  /* Counted once its array stands, so that a half-built body can be destroyed. */
  bw_pd_field *f = &pd->fields.row[pd->fields.n];
  BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &f->value));
  f->after = after;
  f->saved = saved;
  *value = f->value;
  pd->fields.n++;
  return BW_OK;
}

static bw_status state_arrays(bw_pd_body *pd)
{
  const size_t n = pd->n;
  BW_TRY(BW_ALLOCATE(&pd->held.mobile, n));
  /* Room for all fields that a law may ask for: their addresses stay. */
  BW_TRY(BW_ALLOCATE(&pd->fields.row, BW_PD_FIELDS));
  /* What neighbours read lies in storage order; what only its owner reads lies in own order. */
  for (int k = 0; k < 3; k++) {
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &pd->u[k]));
    BW_TRY(bw_pd_body_storage_array(pd->points.n_storage, &pd->vs[k]));
    BW_TRY(BW_ALLOCATE(&pd->v[k], n));
    BW_TRY(BW_ALLOCATE(&pd->a[k], n));
    BW_TRY(BW_ALLOCATE(&pd->load.f[k], n));
    BW_TRY(BW_ALLOCATE(&pd->load.extra[k], n));
    BW_TRY(BW_ALLOCATE(&pd->load.damp[k], n));
  }
  return BW_OK;
}

static bw_status weights(bw_pd_body *pd)
{
  /* Without weights a ledger multiplies once by the mass of all. */
  if (pd->config.n_group == 1 && pd->finest == 0) return BW_OK;
  BW_TRY(BW_ALLOCATE(&pd->points.weight, pd->n));
  /* Work is booked by the mass of the first group; a weight says how much heavier this one is. */
  for (size_t i = 0; i < pd->n; i++)
    pd->points.weight[i] = (bw_real)(bw_pd_body_material(pd, i)->rho / pd->config.material[0].rho *
                                     (bw_pd_body_level(pd, i)->dv / pd->level->dv));
  return BW_OK;
}

static bw_status prescribed_list(bw_pd_body *pd)
{
  bw_pd_held *held = &pd->held;
  /* Counted first: the lists are exactly as long. */
  for (size_t i = 0; i < pd->n; i++)
    held->n += (pd->points.kind[i] & BW_PD_PRESCRIBED) != 0;
  BW_TRY(BW_ALLOCATE(&held->particle, held->n));
  BW_TRY(BW_ALLOCATE(&held->velocity, 3 * held->n));
  size_t q = 0;
  for (size_t i = 0; i < pd->n; i++) {
    /* A factor 0 in place of a branch: kernels run over all particles alike. */
    const bool fixed = (pd->points.kind[i] & BW_PD_PRESCRIBED) != 0;
    held->mobile[i] = fixed ? 0 : 1;
    if (fixed) held->particle[q++] = (int32_t)i;
  }
  return BW_OK;
}

static bw_status check_levels(const bw_pd_body_config *c, const bw_pd_law *law)
{
  BW_REQUIRE(bw_pd_body_finest(c) == 0 || law->levels, BW_EINPUT,
             "solid: levels with law = %s: bonds between two spacings are known to law = bond "
             "and ordinary alone; take one of these or leave levels out",
             law->name);
  return BW_OK;
}

/* first: global id of this rank's first row. */
static bw_status check_sites(const bw_pd_body_config *c, const bw_pd_sites *s, int64_t first)
{
  /* An empty part is fine: some other rank may give all. */
  BW_REQUIRE(s->n >= 0 && s->n < INT32_MAX && (s->n == 0 || s->site != NULL), BW_EINPUT,
             "solid: %lld particles given by one rank; it takes 0 to 2^31", (long long)s->n);
  for (int64_t q = 0; q < s->n; q++) {
    const int kind = s->kind == NULL ? 0 : s->kind[q], group = s->group == NULL ? 0 : s->group[q];
    BW_REQUIRE(kind <= (BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE), BW_EINPUT,
               "solid: particle %lld has the unknown kind %d", (long long)(first + q), kind);
    BW_REQUIRE(group < c->n_group, BW_EINPUT,
               "solid: particle %lld is of group %d; there are materials for %d",
               (long long)(first + q), group, c->n_group);
  }
  return BW_OK;
}

/* Lattice and families first, as the law's constants are sums over them. */
static bw_status build(bw_pd_body *pd, const bw_pd_sites *given, const void *options)
{
  bw_particles_map near = {0};
  bw_pd_refined refined = {0};
  /* Spacing, volume and directions follow from the configuration alone. */
  bw_status st = bw_pd_body_levels(pd);
  BW_THEN(st, pd->finest > 0 ? bw_pd_body_stencil_levels(pd) : bw_pd_body_stencil(pd));
  /* Cells in boxes are split where they are given. */
  BW_THEN(st, bw_pd_body_refine(&pd->config, given, &refined));
  st = bw_comm_agree(pd->comm, st);
  /* Every particle goes to its owner, and every rank learns whose copies it needs. */
  if (st == BW_OK) st = bw_pd_body_distribute(pd, &refined, &near);
  bw_pd_body_refined_release(&refined);
  if (st == BW_OK) {
    /* Own particles and copies are known: they can be numbered and their bonds listed. */
    BW_THEN(st, bw_pd_body_slots(pd, &near));
    BW_THEN(st, state_arrays(pd));
    BW_THEN(st, weights(pd));
    BW_THEN(st, prescribed_list(pd));
    st = bw_comm_agree(pd->comm, st);
  }
  /* Nobody asks for sites any more: neighbours are found by the slots. */
  bw_particles_map_destroy(&near);
  BW_TRY(st);
  bw_pd_body_rows(pd);
  BW_TRY(bw_pd_body_damping_bound(pd));
  pd->mapped = pd->config.finer.map != NULL;
  pd->config.finer.map = NULL; /* borrowed until here */
  /* From here on families, copies and numbering stand; what is left is the law's. */
  BW_TRY(pd->law->prepare(pd, options));
  pd->law->constants(pd);
  return pd->config.finer.later && pd->law->settle != NULL ? BW_OK : pd->law->bound(pd);
}

bw_status bw_pd_body_settle(bw_pd_body *pd, const bool fresh[])
{
  if (pd->law->settle == NULL) return BW_OK;
  BW_TRY(pd->law->settle(pd, fresh));
  pd->law->constants(pd);
  return pd->law->bound(pd);
}

bw_status bw_pd_body_create(const bw_comm *comm, const bw_pd_body_config *config,
                            const bw_pd_law *law, const void *options, const bw_pd_sites *given,
                            bw_pd_body **out)
{
  bw_pd_body *pd = NULL;
  *out = NULL;
  /* A rank that refuses its part still takes part in the counting, which is collective. */
  bw_status st = bw_pd_body_check(config);
  BW_THEN(st, law->check(config, options));
  BW_THEN(st, check_levels(config, law));
  const int64_t first = bw_comm_prefix_sum(comm, given->n);
  BW_THEN(st, check_sites(config, given, first));
  BW_THEN(st, BW_ALLOCATE(&pd, 1));
  /* A body needs one particle somewhere. */
  int64_t total = given->n;
  bw_comm_sum_int(comm, 1, &total);
  if (st == BW_OK && total <= 0)
    st = BW_FAIL(BW_EINPUT, "solid: no particles given (n = %lld)", (long long)total);
  /* From here on all ranks build, or none. */
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    pd->comm = comm;
    pd->config = *config;
    pd->law = law;
    pd->breakage = true;
    st = build(pd, given, options);
  }
  /* Destroy takes whatever stands of a body. */
  if (st != BW_OK) bw_pd_body_destroy(&pd);
  *out = pd;
  return st;
}

static void release_level(bw_pd_level *level)
{
  bw_pd_stencil *s = &level->stencil;
  bw_release(&s->offset);
  bw_release(&s->xi);
  bw_release(&s->r0);
  bw_release(&s->fraction);
  bw_release(&s->volume);
  bw_release(&s->tough);
  bw_release(&s->other);
  bw_release(&s->sure);
  bw_release(&s->number);
  bw_release(&level->row);
}

void bw_pd_body_destroy(bw_pd_body **pd_)
{
  bw_pd_body *pd = *pd_;
  if (pd == NULL) return;
  /* The law's state may refer to the body's arrays: it goes first. */
  if (pd->law != NULL) pd->law->destroy(pd);
  for (int q = 0; q < pd->fields.n; q++)
    bw_pd_body_release_storage_array(&pd->fields.row[q].value);
  for (int l = 0; pd->level != NULL && l <= pd->finest; l++)
    release_level(&pd->level[l]);
  bw_particles_copies_destroy(&pd->halo.copies);
  void *plain[] = {&pd->points.weight,   &pd->level,        &pd->points.site,  &pd->points.id,
                   &pd->points.kind,     &pd->points.group, &pd->points.place, &pd->points.occupant,
                   &pd->halo.extended_X, &pd->bonds.block,  &pd->bonds.slot,   &pd->bonds.run,
                   &pd->bonds.hit,       &pd->bonds.factor, &pd->held.mobile,  &pd->held.particle,
                   &pd->held.velocity,   &pd->fields.row,   &pd->points.level, &pd->bonds.exact};
  for (size_t q = 0; q < sizeof plain / sizeof *plain; q++)
    bw_release(plain[q]);
  for (int k = 0; k < 3; k++) {
    bw_pd_body_release_storage_array(&pd->u[k]);
    bw_pd_body_release_storage_array(&pd->vs[k]);
    bw_pd_body_release_storage_array(&pd->points.shift[k]);
    void *vector[] = {&pd->v[k], &pd->a[k], &pd->load.f[k], &pd->load.extra[k], &pd->load.damp[k]};
    for (size_t q = 0; q < sizeof vector / sizeof *vector; q++)
      bw_release(vector[q]);
  }
  bw_release(pd_);
}
