#include "plate.h"
#include "bw_memory.h"
#include "bw_pd_shape.h"
#include <math.h>
#include <string.h>

static const double LOOK_FOR_FORKS = 0.25e-6; /* [s] */

static bw_pd_bond_config material(const plate *p)
{
  const plate_solid *s = &p->config.solid;
  bw_pd_bond_config c = bw_pd_bond_config_default();
  c.geometry = BW_PD_PLANE_STRESS;
  c.ds = p->ds;
  c.horizon_ratio = s->horizon_ratio;
  c.rho = s->density;
  c.E = s->young_modulus;
  c.G0 = s->fracture_energy;
  c.surface_correction = (bw_pd_surface_correction)s->surface_correction;
  c.volume_fraction = (bw_pd_volume_fraction)s->volume_fraction;
  c.family_reach = (bw_pd_family_reach)s->family_reach;
  c.integrator = (bw_pd_integrator)s->integrator;
  c.damping_pair = s->damping_pair;
  return c;
}

static bw_status make_solid(plate *p)
{
  const plate_shape *s = &p->config.shape;
  const bw_shape box = {.kind = BW_SHAPE_BOX, .upper = {s->length, s->height, 1.0}};
  const bw_pd_bond_config c = material(p);
  const double from[3] = {-p->ds, 0.5 * s->height, 0.0}, to[3] = {s->notch, 0.5 * s->height, 0.0};
  int64_t n = 0;
  int32_t *site = NULL;
  uint8_t *kind = NULL;
  bw_status st = bw_pd_shape_fill(1, &box, p->ds, c.origin, true, &n, &site, &kind);
  BW_THEN(st, bw_pd_bond_create(p->comm, &c, n, site, kind, &p->solid));
  BW_THEN(st, bw_pd_bond_precrack(p->solid, from, to, NULL));
  bw_release(&site);
  bw_release(&kind);
  return st;
}

static bw_status load_edges(plate *p)
{
  const plate_load *load = &p->config.load;
  const double height = p->config.shape.height, depth = load->rows * p->ds;
  double *F = NULL;
  BW_TRY(BW_ALLOCATE(&F, 3 * p->n));
  for (size_t h = 0; h < p->n; h++) {
    const double y = p->X0[3 * h + 1];
    if (y < depth) F[3 * h + 1] = -load->stress / depth;
    if (y > height - depth) F[3 * h + 1] = load->stress / depth;
  }
  bw_pd_bond_set_force(p->solid, F);
  bw_release(&F);
  return BW_OK;
}

bw_status plate_create(const bw_comm *comm, const plate_config *config, plate *p)
{
  memset(p, 0, sizeof *p);
  p->comm = comm;
  p->config = *config;
  p->ds = config->shape.length / config->shape.particles;
  p->crack = (plate_crack){NAN, NAN, NAN, NAN, NAN};
  BW_REQUIRE(config->shape.notch < config->shape.length, BW_EINPUT,
             "shape.notch = %g has to be shorter than the plate, %g", config->shape.notch,
             config->shape.length);
  BW_REQUIRE(2 * config->load.rows * p->ds < config->shape.height, BW_EINPUT,
             "load.rows = %d: the rows pulled up and down meet", config->load.rows);
  BW_TRY(make_solid(p));
  p->n = bw_pd_bond_count(p->solid);
  bw_status st = BW_ALLOCATE(&p->X0, 3 * p->n);
  BW_THEN(st, BW_ALLOCATE(&p->damage, p->n));
  if (st == BW_OK) {
    bw_pd_bond_get_reference(p->solid, p->X0);
    st = load_edges(p);
  }
  BW_TRY(bw_comm_agree(comm, st));
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  bw_pd_bond_get_damage(p->solid, p->damage);
  p->notch_tip = p->crack.tip = bw_pd_crack_tip(comm, &look, p->n, p->X0, p->damage);
  p->events = bw_pd_bond_events(p->solid);
  return bw_comm_agree(comm, bw_pd_crack_track_note(&p->track, 0.0, p->notch_tip));
}

static void note_time(double *what, bool happened, double time)
{
  if (happened && isnan(*what)) *what = time;
}

/* Has a bond broken on any rank since the last look? Collective. */
static bool broke(plate *p)
{
  int64_t news = bw_pd_bond_events(p->solid) != p->events;
  p->events = bw_pd_bond_events(p->solid);
  bw_comm_max_int(p->comm, 1, &news);
  return news != 0;
}

static bw_status follow_tip(plate *p)
{
  plate_crack *c = &p->crack;
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  if (!broke(p)) return BW_OK;
  bw_pd_bond_get_damage(p->solid, p->damage);
  c->tip = bw_pd_crack_tip(p->comm, &look, p->n, p->X0, p->damage);
  note_time(&c->t_first, true, p->time);
  note_time(&c->t_start, c->tip > p->notch_tip + 0.5 * p->ds, p->time);
  note_time(&c->t_edge, c->tip > p->config.shape.length - p->ds, p->time);
  return bw_comm_agree(p->comm, bw_pd_crack_track_note(&p->track, p->time, c->tip));
}

double plate_speed(const plate *p, double window)
{
  return bw_pd_crack_speed(&p->track, window, p->crack.t_edge);
}

bw_status plate_branches(plate *p, double x, int *branches, double *fork)
{
  const bw_pd_crack_config look = bw_pd_crack_config_default();
  const double gap = 1.5 * p->ds, from = p->config.shape.notch + 0.5 * p->ds;
  bw_pd_crack crack;
  bw_pd_bond_get_damage(p->solid, p->damage);
  BW_TRY(bw_pd_crack_collect(p->comm, &look, p->n, p->X0, p->damage, &crack));
  *branches = bw_pd_crack_branches(&crack, x, 0.5 * p->ds, gap, 0, NULL);
  *fork = bw_pd_crack_fork(&crack, from, p->ds, 3, gap);
  bw_pd_crack_release(&crack);
  return BW_OK;
}

bw_status plate_step(plate *p)
{
  BW_TRY(bw_pd_bond_step(p->solid, p->config.time.step));
  p->steps++;
  p->time = (double)p->steps * p->config.time.step;
  BW_TRY(follow_tip(p));
  const int64_t every = llround(fmax(1.0, LOOK_FOR_FORKS / p->config.time.step));
  if (p->steps % every == 0 && isnan(p->crack.t_branch) && !isnan(p->crack.t_start)) {
    int branches = 0;
    double fork = NAN;
    BW_TRY(plate_branches(p, 0.0, &branches, &fork));
    note_time(&p->crack.t_branch, !isnan(fork), p->time);
  }
  return BW_OK;
}

void plate_destroy(plate *p)
{
  bw_pd_bond_destroy(&p->solid);
  bw_release(&p->X0);
  bw_release(&p->damage);
  bw_pd_crack_track_release(&p->track);
}
