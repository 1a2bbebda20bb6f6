/* Building and destroying the object. */
#include "bw_memory.h"
#include "pd_bond_internal.h"

#include <math.h>

/* A storage array with room for overrunning loads on both sides; zero there. */
bw_status bw_pd_bond__storage_array(size_t n, bw_real **out)
{
  bw_real *base = NULL;
  BW_TRY(BW_ALLOCATE(&base, n + 2 * BW_PD_PAD));
  *out = base + BW_PD_PAD;
  return BW_OK;
}

void bw_pd_bond__release_storage_array(bw_real **array)
{
  if (*array == NULL) return;
  bw_real *base = *array - BW_PD_PAD;
  bw_release(&base);
  *array = NULL;
}

static bw_status state_arrays(bw_pd_bond *pd)
{
  const size_t n = pd->n;
  BW_TRY(bw_pd_bond__storage_array(pd->n_storage, &pd->w));
  BW_TRY(BW_ALLOCATE(&pd->mobile, n));
  BW_TRY(BW_ALLOCATE(&pd->extended_X, 3 * pd->n_extended));
  for (int k = 0; k < 3; k++) {
    BW_TRY(bw_pd_bond__storage_array(pd->n_storage, &pd->u[k]));
    BW_TRY(bw_pd_bond__storage_array(pd->n_storage, &pd->vs[k]));
    BW_TRY(BW_ALLOCATE(&pd->v[k], n));
    BW_TRY(BW_ALLOCATE(&pd->a[k], n));
    BW_TRY(BW_ALLOCATE(&pd->f[k], n));
    BW_TRY(BW_ALLOCATE(&pd->extra[k], n));
    BW_TRY(BW_ALLOCATE(&pd->damp[k], n));
    if (pd->config.integrator != BW_PD_RK3) continue;
    BW_TRY(BW_ALLOCATE(&pd->v_before[k], n));
    BW_TRY(BW_ALLOCATE(&pd->a_before[k], n));
  }
  return BW_OK;
}

static bw_status prescribed_list(bw_pd_bond *pd)
{
  BW_TRY(BW_ALLOCATE(&pd->retired, pd->n));
  for (size_t i = 0; i < pd->n; i++)
    pd->n_prescribed += (pd->kind[i] & BW_PD_PRESCRIBED) != 0;
  BW_TRY(BW_ALLOCATE(&pd->prescribed, pd->n_prescribed));
  BW_TRY(BW_ALLOCATE(&pd->prescribed_v, 3 * pd->n_prescribed));
  size_t q = 0;
  for (size_t i = 0; i < pd->n; i++) {
    const bool held = (pd->kind[i] & BW_PD_PRESCRIBED) != 0;
    pd->mobile[i] = held ? 0 : 1;
    if (held) pd->prescribed[q++] = (int32_t)i;
  }
  return BW_OK;
}

static bw_status check_list(int64_t n, const int32_t site[], const uint8_t kind[])
{
  BW_REQUIRE(n > 0 && site != NULL, BW_EINPUT, "pd_bond: no particles given (n = %lld)",
             (long long)n);
  BW_REQUIRE(n < INT32_MAX, BW_EINPUT, "pd_bond: %lld particles; the limit is 2^31", (long long)n);
  for (int64_t q = 0; kind != NULL && q < n; q++)
    BW_REQUIRE(kind[q] <= (BW_PD_PRESCRIBED | BW_PD_UNBREAKABLE), BW_EINPUT,
               "pd_bond: particle %lld has the unknown kind %d", (long long)q, kind[q]);
  return BW_OK;
}

static bw_status build(bw_pd_bond *pd, int64_t n, const int32_t site[], const uint8_t kind[])
{
  bw_pd_map near = {0};
  bw_pd_bond__material(pd);
  pd->total = n;
  bw_status st = bw_comm_agree(pd->comm, bw_pd_bond__stencil(pd));
  if (st == BW_OK) st = bw_comm_agree(pd->comm, bw_pd_bond__full_family(pd));
  if (st == BW_OK) bw_pd_bond__calibrate(pd);
  if (st == BW_OK) st = bw_pd_bond__distribute(pd, (size_t)n, site, kind, &near);
  if (st == BW_OK) {
    BW_THEN(st, bw_pd_bond__slots(pd, &near));
    BW_THEN(st, state_arrays(pd));
    BW_THEN(st, prescribed_list(pd));
    if (st == BW_OK && pd->config.contact) st = bw_pd_bond__contact_create(pd);
    st = bw_comm_agree(pd->comm, st);
  }
  bw_pd_map_destroy(&near);
  BW_TRY(st);
  BW_TRY(bw_pd_bond__surface_factors(pd));
  if (pd->config.surface_correction == BW_PD_SURFACE_TENSOR) BW_TRY(bw_pd_bond__tensor(pd));
  bw_pd_bond__constants(pd);
  return bw_pd_bond__bounds(pd);
}

bw_status bw_pd_bond_create(const bw_comm *comm, const bw_pd_bond_config *config, int64_t n,
                            const int32_t site[], const uint8_t kind[], bw_pd_bond **out)
{
  bw_pd_bond *pd = NULL;
  *out = NULL;
  bw_status st = bw_pd_bond__check_config(config);
  BW_THEN(st, check_list(n, site, kind));
  BW_THEN(st, BW_ALLOCATE(&pd, 1));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    pd->comm = comm;
    pd->config = *config;
    pd->breakage = true;
    pd->damping_pair = config->damping_pair;
    pd->damping_mean = config->damping_mean;
    pd->damping_absolute = config->damping_absolute;
    st = build(pd, n, site, kind);
  }
  if (st != BW_OK) bw_pd_bond_destroy(&pd);
  *out = pd;
  return st;
}

static void release_stencil(bw_pd_stencil *s)
{
  bw_release(&s->offset);
  bw_release(&s->xi);
  bw_release(&s->r0);
  bw_release(&s->fraction);
  bw_release(&s->sure);
  bw_release(&s->bulk);
  bw_release(&s->row);
  bw_release(&s->number);
}

void bw_pd_bond_destroy(bw_pd_bond **pd_)
{
  bw_pd_bond *pd = *pd_;
  if (pd == NULL) return;
  bw_pd_bond__contact_destroy(pd);
  release_stencil(&pd->stencil);
  bw_exchange_destroy(&pd->halo);
  void *plain[] = {&pd->site,         &pd->id,      &pd->kind,   &pd->place,      &pd->occupant,
                   &pd->asked,        &pd->reply,   &pd->answer, &pd->extended_X, &pd->block,
                   &pd->slot,         &pd->run,     &pd->hit,    &pd->mobile,     &pd->prescribed,
                   &pd->prescribed_v, &pd->retired, &pd->alpha};
  for (size_t q = 0; q < sizeof plain / sizeof *plain; q++)
    bw_release(plain[q]);
  bw_pd_bond__release_storage_array(&pd->w);
  for (int k = 0; k < 3; k++) {
    bw_pd_bond__release_storage_array(&pd->u[k]);
    bw_pd_bond__release_storage_array(&pd->vs[k]);
    bw_pd_bond__release_storage_array(&pd->shift[k]);
    void *vector[] = {&pd->v[k],    &pd->a[k],        &pd->f[k],       &pd->extra[k],
                      &pd->damp[k], &pd->v_before[k], &pd->a_before[k]};
    for (size_t q = 0; q < sizeof vector / sizeof *vector; q++)
      bw_release(vector[q]);
  }
  bw_release(pd_);
}
