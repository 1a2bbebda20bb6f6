/* Several solids stepped together: the pieces of a Verlet step in turn, and contact between them.
 *
 * Between steps load.extra of every solid holds the contact between solids too. Whatever evaluates
 * one solid by itself (a new state, retiring) loses that share: the counts of evaluations tell, and
 * the next step begins with the forces of all. */
#include "bw_memory.h"
#include "bw_pd_contact_between.h"
#include "bw_solid_assembly.h"
#include "solid_internal.h"

#include <math.h>

struct bw_solid_assembly {
  int n;
  bw_solid **solid;               /* (n) borrowed */
  bw_pd_contact_between *between; /* NULL: half built */
};

static const bw_comm *comm_of(const bw_solid_assembly *set)
{
  return set->solid[0]->body->comm;
}

static bw_status check(int n, bw_solid *const solid[])
{
  BW_REQUIRE(n >= 1 && solid != NULL, BW_EINPUT, "solid_assembly: %d solids; at least 1", n);
  for (int q = 0; q < n; q++) {
    BW_REQUIRE(solid[q]->config.integrator == BW_SOLID_VERLET, BW_EINPUT,
               "solid_assembly: solid %d has integrator = rk3; in an assembly use verlet", q);
    BW_REQUIRE(solid[q]->levels == NULL, BW_EINPUT,
               "solid_assembly: the levels of solid %d change, which contact between solids does "
               "not follow; leave refine.level out",
               q);
  }
  return BW_OK;
}

static bw_status allocate(int n, bw_solid *const solid[], bw_solid_assembly *set,
                          bw_pd_body ***body)
{
  BW_TRY(BW_ALLOCATE(&set->solid, (size_t)n));
  BW_TRY(BW_ALLOCATE(body, (size_t)n));
  for (int q = 0; q < n; q++) {
    set->solid[q] = solid[q];
    solid[q]->shared = -1;
    (*body)[q] = solid[q]->body;
  }
  set->n = n;
  return BW_OK;
}

/* Solids may touch from the start, not pierce each other. */
static bw_status check_room(bw_solid_assembly *set)
{
  BW_TRY(bw_pd_contact_between_update(set->between));
  (void)bw_pd_contact_between_energy(set->between); /* looks at all pairs */
  double closest = bw_pd_contact_between_closest(set->between);
  bw_comm_min(comm_of(set), 1, &closest);
  BW_REQUIRE(
      closest >= BW_SOLID_TOO_CLOSE, BW_EINPUT,
      "solid_assembly: particles of two solids are %g of the smaller spacing apart, less than %g: "
      "the solids pierce each other; move one",
      closest, BW_SOLID_TOO_CLOSE);
  return BW_OK;
}

bw_status bw_solid_assembly_create(int n, bw_solid *const solid[], bw_solid_assembly **out)
{
  bw_solid_assembly *set = NULL;
  bw_pd_body **body = NULL;
  *out = NULL;
  BW_TRY(check(n, solid)); /* the same on all ranks */
  bw_status st = BW_ALLOCATE(&set, 1);
  BW_THEN(st, allocate(n, solid, set, &body));
  st = bw_comm_agree(solid[0]->body->comm, st);
  BW_THEN(st, bw_pd_contact_between_create(n, body, &set->between));
  BW_THEN(st, check_room(set));
  bw_release(&body);
  if (st != BW_OK) bw_solid_assembly_destroy(&set);
  *out = set;
  return st;
}

void bw_solid_assembly_destroy(bw_solid_assembly **set_)
{
  bw_solid_assembly *set = *set_;
  if (set == NULL) return;
  bw_pd_contact_between_destroy(&set->between);
  for (int q = 0; q < set->n; q++)
    set->solid[q]->shared = 0;
  bw_release(&set->solid);
  bw_release(set_);
}

/* The forces between solids on top of those of each, which are new. Collective. */
static bw_status add_between(bw_solid_assembly *set)
{
  /* Agreed: a search fails on all ranks or on none. */
  BW_TRY(bw_pd_contact_between_update(set->between));
  bw_pd_contact_between_force(set->between);
  for (int q = 0; q < set->n; q++) {
    /* From here on `extra` is read in the kicks and has to be emptied before the next forces. */
    set->solid[q]->loaded = true;
    set->solid[q]->shared = set->solid[q]->evaluated;
  }
  return BW_OK;
}

/* Forces of all solids and between them. Everybody evaluates, also where one has failed: the
 * exchanges are collective. */
static bw_status evaluate_all(bw_solid_assembly *set, bool check_bonds)
{
  bw_status st = BW_OK;
  for (int q = 0; q < set->n; q++) {
    const bw_status seen = bw_solid__evaluate(set->solid[q], check_bonds);
    st = st == BW_OK ? seen : st;
  }
  const bw_status between = add_between(set);
  return st == BW_OK ? between : st;
}

/* Do all solids hold the forces of the present motion, those between them too? A restart gives
 * them. */
static bool is_current(const bw_solid_assembly *set)
{
  for (int q = 0; q < set->n; q++) {
    const bw_solid *s = set->solid[q];
    if (!s->body->current) return false;
    if (!s->restored && s->shared != s->evaluated) return false;
  }
  return true;
}

static bw_status make_current(bw_solid_assembly *set)
{
  if (is_current(set)) return BW_OK;
  return bw_comm_agree(comm_of(set), evaluate_all(set, false));
}

static bw_status check_step(const bw_solid_assembly *set, double dt)
{
  for (int q = 0; q < set->n; q++) {
    const double limit = bw_solid_dt_max(set->solid[q]);
    BW_REQUIRE(dt > 0 && dt <= limit * (1 + 1e-12), BW_ECFL,
               "solid_assembly: dt = %g must be positive and at most %g of solid %d; take smaller "
               "sub-steps",
               dt, limit, q);
  }
  return BW_OK;
}

bw_status bw_solid_assembly_step(bw_solid_assembly *set, double dt)
{
  bw_status st = BW_OK;
  BW_TRY(check_step(set, dt));
  /* Prescribed velocities first, as damping depends on them; where a solid has to evaluate itself
   * for its new state, all do, with the forces between them. */
  for (int q = 0; q < set->n; q++)
    BW_TRY(bw_solid__begin(set->solid[q]));
  BW_TRY(make_current(set));
  /* Every solid has to have moved before the first force between two is known. */
  for (int q = 0; q < set->n; q++) {
    const bw_status moved = bw_solid__leap(set->solid[q], dt);
    st = st == BW_OK ? moved : st;
  }
  const bw_status seen = evaluate_all(set, true);
  st = st == BW_OK ? seen : st;
  for (int q = 0; q < set->n; q++)
    bw_solid__land(set->solid[q], dt);
  /* What is beyond its limit has held through the whole step, as in a solid alone. */
  for (int q = 0; q < set->n; q++) {
    if (st == BW_OK) st = bw_solid__end(set->solid[q]);
    set->solid[q]->restored = false;
  }
  return bw_comm_agree(comm_of(set), st);
}

static double rate2(double dt)
{
  return 1 / (dt * dt);
}

double bw_solid_assembly_dt(const bw_solid_assembly *set)
{
  double within = 0;
  for (int q = 0; q < set->n; q++)
    within = fmax(within, rate2(bw_solid_dt_max(set->solid[q])) +
                              rate2(bw_solid_dt_contact(set->solid[q])));
  const double all = within + rate2(bw_pd_contact_between_time(set->between));
  return all > 0 ? 1 / sqrt(all) : INFINITY;
}

static void add_ledger(bw_solid_ledger *sum, const bw_solid_ledger *l)
{
  sum->kinetic += l->kinetic;
  sum->elastic += l->elastic;
  sum->contact += l->contact;
  sum->closest = fmin(sum->closest, l->closest);
  sum->retired += l->retired;
  sum->damping += l->damping;
  sum->fracture += l->fracture;
  sum->plastic += l->plastic;
  sum->regrid += l->regrid;
  sum->external += l->external;
  for (int k = 0; k < 3; k++) {
    sum->momentum[k] += l->momentum[k];
    sum->angular[k] += l->angular[k];
    sum->wall[k] += l->wall[k];
  }
  sum->bonds += l->bonds;
  sum->broken += l->broken;
}

bw_status bw_solid_assembly_account(bw_solid_assembly *set, bw_solid_ledger *out)
{
  bw_solid_ledger sum = {.closest = INFINITY};
  BW_TRY(make_current(set));
  for (int q = 0; q < set->n; q++) {
    bw_solid_ledger one;
    BW_TRY(bw_solid_account(set->solid[q], &one));
    add_ledger(&sum, &one);
  }
  /* After a restart nobody has looked for pairs yet. */
  BW_TRY(bw_pd_contact_between_update(set->between));
  double energy = bw_pd_contact_between_energy(set->between);
  double closest = bw_pd_contact_between_closest(set->between);
  bw_comm_sum(comm_of(set), 1, &energy);
  bw_comm_min(comm_of(set), 1, &closest);
  sum.contact += energy;
  sum.closest = fmin(sum.closest, closest);
  *out = sum;
  return BW_OK;
}

int64_t bw_solid_assembly_pairs(const bw_solid_assembly *set)
{
  int64_t pairs = (int64_t)bw_pd_contact_between_pairs(set->between);
  bw_comm_sum_int(comm_of(set), 1, &pairs);
  return pairs;
}
