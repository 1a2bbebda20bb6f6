/* Claim: a free cylinder goes with the fluid, and falls in it, as Stokes flow has it.
 *
 * A stiff free cylinder of a quarter of the channel's height on its centre line, Re = 0.1:
 *   fall       under its weight along a channel with closed ends: its speed;
 *   couette    as heavy as the fluid, between walls that move apart: its spin;
 *   poiseuille as heavy as the fluid, carried by the stream: its speed.
 * Reference  fundamental solutions, data/cylinder_in_channel; for the fall the same as Faxen's
 *            series to 3e-5. Unconfined the spin would be 1/2, the speed 1.5.
 * Measured   mean velocity and spin of the piece when they have settled (four times the slowest
 *            decay, (2 pi/H)^2 nu, of what a symmetric motion leaves). The reference of the fall is
 *            that of the disc of the particles' area (Faxen's series takes it there): 1.7 % wider.
 * Tolerance  a lattice's surface is a staircase, its steps up to a spacing high: what the fluid
 *            meets lies between their mean and their envelope, 0.25 h further out or in, and
 *            forcing knows the surface to 0.1 h (Breugem 2012): 0.7 h of the diameter.
 *            fall: reported, no claim. It goes with D^-1.37 (Faxen's series), so that 0.7 h would
 *            explain 12 % with 8 cells; where between the two the surface is felt is not derived.
 *            By the reaction 8 and, with 16 cells, 4.6 % are measured; with the nominal surface at
 *            the mean height of the particles' open sides, ds/(2 sum |n_i|), 4.3 and 2.8 %.
 *            couette, poiseuille: the lags behind a point of the fluid, 3.6 and 3 %, go with D^2:
 *            2 (0.7/8) of them, 0.6 %, and 0.4 % for slip, which is of the order of the viscous
 *            number of the step, 0.08, times the lag. By probes with 8 cells the spin is reported
 *            only: so narrow a lattice has no smooth surface, probes read the pressure on the sides
 *            of its steps, and what of it turns the cylinder is not derived (1.5 % are measured).
 * BUILD modules=coupler,shape
 * TEST  ranks=1 timeout=3600 */
#include "bw_coupler.h"
#include "bw_validation.h"
#include "cylinder_in_channel.h"
#include "cylinder_of_particles.h"

#include <math.h>
#include <stdio.h>

typedef struct {
  motion motion;
  int cells; /* per diameter */
  bw_coupler_load_kind load;
  double speed; /* of reference: of the fall */
} scene_set_up;

typedef struct {
  bw_grid *grid;
  bw_ns_channel *fluid;
  bw_solid *solid;
  bw_coupler *coupler;
  double h, dt;
} scene;

static void scene_destroy(scene *s)
{
  bw_coupler_destroy(&s->coupler);
  bw_solid_destroy(&s->solid);
  bw_ns_channel_destroy(&s->fluid);
  bw_grid_destroy(&s->grid);
}

/* Sound crosses it twice in a step: stiff. */
static bw_status make_solid(const bw_comm *comm, const scene_set_up *b, scene *s)
{
  const bw_grid_view *g = bw_grid_look(s->grid);
  bw_solid_config c = bw_solid_config_default();
  c.geometry = BW_PD_PLANE_STRAIN;
  c.ds = c.thickness = s->h;
  c.rho = b->motion == FALL ? 2.0 : 1.0;
  c.E = 4.0 * c.rho / (s->dt * s->dt);
  /* pairs: damping against a mean would hold back its turning; the family has about 30 h^3 */
  c.damping.pair = 1.0 * c.rho / (s->dt * 30.0 * s->h * s->h * s->h);
  c.origin[2] = 0.5 * s->h;
  return cylinder_of_particles(comm, 0.5 * g->length[0], 0.5 * g->length[1], &c, &s->solid);
}

static bw_status make_scene(const bw_comm *comm, const scene_set_up *b, scene *s)
{
  bw_coupler_config c = bw_coupler_config_default();
  *s = (scene){0};
  s->h = 1.0 / b->cells;
  s->dt = 0.08 * s->h * s->h;
  BW_TRY(cylinder_fluid(comm, b->motion, b->cells, &s->grid, &s->fluid));
  BW_TRY(make_solid(comm, b, s));
  c.rho = c.nu = 1.0;
  c.load = b->load;
  if (b->motion == FALL) { /* its own volume bears it, that of its particles */
    const double volume = (double)bw_solid_total(s->solid) * s->h * s->h;
    c.gravity[0] = RE / (b->speed * volume); /* (2 - 1) g volume = force, speed per force given */
  }
  BW_TRY(bw_coupler_create(&c, s->fluid, s->solid, &s->coupler));
  bw_coupler_hold_solid(s->coupler, false);
  return BW_OK;
}

/* Speed over that of reference's unit force or stream, or spin over the shear rate; diameter of
 * the disc of the particles' area. */
static bw_status measure(const bw_comm *comm, const scene_set_up *b, double *out, double *wide)
{
  scene s;
  bw_pd_fragments piece = {0};
  bw_status st = make_scene(comm, b, &s);
  const double end = 4.0 * HEIGHTS * HEIGHTS / (4.0 * acos(-1.0) * acos(-1.0));
  for (double t = 0.0; st == BW_OK && t < end; t += s.dt)
    st = bw_coupler_step(s.coupler, s.dt);
  if (st == BW_OK) *wide = 2.0 * s.h * sqrt((double)bw_solid_total(s.solid) / acos(-1.0));
  BW_THEN(st, bw_pd_interface_fragments(bw_coupler_edit_interface(s.coupler), NULL, &piece));
  if (st == BW_OK && piece.total != 1)
    st = BW_FAIL(BW_EDIVERGED, "the cylinder fell into %lld pieces", (long long)piece.total);
  const bw_pd_fragment *body = &piece.largest[0];
  if (st == BW_OK) *out = b->motion == COUETTE ? -body->spin[2] / RE : body->velocity[0] / RE;
  if (b->motion == FALL) *out *= b->speed;
  bw_pd_fragment_release(&piece);
  scene_destroy(&s);
  return st;
}

/* Speed of fall for the blockage k over 1/(4 pi mu): H. Faxen 1946. */
static double faxen(double k)
{
  const double k2 = k * k;
  return -0.9157 - log(k) + k2 * (1.7244 + k2 * (-1.7302 + k2 * (2.4056 - 4.5913 * k2)));
}

static bw_status run(bw_validation *v)
{
  double table[16][3], reference[MOTIONS] = {NAN, NAN, NAN};
  int rows = 0;
  BW_TRY(bw_validation_table("cylinder_in_channel/free_cylinder.csv", 3, 16, table[0], &rows));
  for (int q = 0; q < rows; q++)
    if (table[q][0] == 1.0 / HEIGHTS) reference[(int)table[q][1]] = table[q][2];
  static const bw_coupler_load_kind loads[] = {BW_LOAD_REACTION, BW_LOAD_PROBES};
  static const char *const load_name[] = {"reaction", "probes"};
  for (int m = 0; m < MOTIONS; m++)
    for (int q = 0; q < (bw_validation_full(v) ? 4 : 2); q++) {
      const scene_set_up b = {(motion)m, q < 2 ? 8 : 16, loads[q % 2], reference[FALL]};
      double value = NAN, wide = NAN;
      char text[96], extra[96];
      BW_TRY(measure(bw_validation_comm(v), &b, &value, &wide));
      snprintf(text, sizeof text, "%s, load by %s, %d cells per diameter", name[m],
               load_name[q % 2], b.cells);
      snprintf(extra, sizeof extra, "\"load\": \"%s\", \"cells_per_diameter\": %d",
               load_name[q % 2], b.cells);
      const bool claimed = m == POISEUILLE || (m == COUETTE && q != 1);
      const double same = m == FALL ? faxen(wide / HEIGHTS) / faxen(1.0 / HEIGHTS) : 1.0;
      bw_validation_row(v, &(bw_claim){text, name[m], value, same * reference[m],
                                       claimed ? 0.01 : INFINITY, BW_INDEPENDENT_CODE,
                                       "fundamental solutions, data/cylinder_in_channel", extra});
    }
  return BW_OK;
}

int main(int argc, char **argv)
{
  return bw_validation_main(argc, argv, "coupler.free_cylinder", run);
}
