/* Fragments: their number, mass, centre, velocity and spin for known rigid motions.
 * BUILD modules=shape
 * TEST ranks=1,2,3,4 */
#include "body.h"

typedef struct {
  double low[3], high[3]; /* box of the piece (reference) */
  double velocity[3], spin[3];
  double particles;
} motion;

/* Give each piece its motion about its own centre, then compare the list with it. */
static void check(body *b, int count, const motion piece[], double rho)
{
  const size_t n = bw_solid_count(b->pd);
  double *X = NULL, *V = NULL;
  int64_t *label = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_check_ok(BW_ALLOCATE(&label, n));
  bw_solid_get_reference(b->pd, X);
  for (size_t h = 0; h < n; h++) {
    int found = 0;
    for (int q = 0; q < count; q++) {
      const motion *m = &piece[q];
      double r[3];
      bool in = true;
      for (size_t d = 0; d < 3; d++) {
        in = in && X[3 * h + d] > m->low[d] && X[3 * h + d] < m->high[d];
        r[d] = X[3 * h + d] - 0.5 * (m->low[d] + m->high[d]);
      }
      if (!in) continue;
      found++;
      for (size_t d = 0; d < 3; d++) {
        const size_t e = (d + 1) % 3, f = (d + 2) % 3;
        V[3 * h + d] = m->velocity[d] + m->spin[e] * r[f] - m->spin[f] * r[e];
      }
    }
    ck_assert_int_eq(found, 1);
  }
  bw_solid_set_state(b->pd, X, V);
  bw_check_ok(bw_pd_interface_update(b->pi));
  bw_pd_fragments all;
  bw_check_ok(bw_pd_interface_fragments(b->pi, label, &all));
  ck_assert_int_eq(all.total, count);
  double particles = 0.0;
  for (int q = 0; q < count; q++) { /* pieces are given in the order of the list */
    const bw_pd_fragment *f = &all.largest[q];
    bw_check_near((double)f->particles, piece[q].particles, 0);
    bw_check_near(f->mass, rho * piece[q].particles, 1e-12);
    for (size_t d = 0; d < 3; d++) {
      bw_check_near(f->centre[d], 0.5 * (piece[q].low[d] + piece[q].high[d]), 2e-6);
      bw_check_near(f->velocity[d], piece[q].velocity[d], 2e-6);
      bw_check_near(f->spin[d], piece[q].spin[d], 2e-6);
    }
    particles += (double)f->particles;
    double mine = 0.0;
    for (size_t h = 0; h < n; h++)
      mine += label[h] == f->label;
    ck_assert_double_eq(body_sum(mine), piece[q].particles);
  }
  ck_assert_double_eq(particles, (double)b->n);
  bw_release(&X);
  bw_release(&V);
  bw_release(&label);
  bw_pd_fragment_release(&all);
}

/* Four bodies too far apart for bonds: block, long bar over all ranks, rod of two, single one. */
START_TEST(separate_bodies_with_known_motions)
{
  const motion piece[] = {
      {{0, 0, 0}, {6, 7, 8}, {1, -2, 3}, {0.1, 0.2, -0.3}, 336},
      {{-10, 20, 0}, {30, 22, 3}, {0, 0.5, 0}, {0, -0.01, 0.02}, 240},
      {{20, 0, 0}, {22, 1, 1}, {1, 1, 1}, {0, 0.5, -0.25}, 2}, /* no spin along its axis, x */
      {{40, 0, 0}, {41, 1, 1}, {-1, 0, 2}, {0, 0, 0}, 1},
  };
  bw_shape shape[4];
  memset(shape, 0, sizeof shape);
  for (int q = 0; q < 4; q++) {
    shape[q].kind = BW_SHAPE_BOX;
    memcpy(shape[q].lower, piece[q].low, sizeof shape[q].lower);
    memcpy(shape[q].upper, piece[q].high, sizeof shape[q].upper);
  }
  bw_solid_config c = body_config(false);
  c.rho = 2.5;
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(4, shape, &c, &ic);
  check(&b, 4, piece, 2.5);
  body_destroy(&b);
}
END_TEST

/* One body cut in two by broken bonds only; 2D: spin about z. */
START_TEST(broken_bonds_part_a_body)
{
  const motion piece[] = {
      {{0, 0, -1}, {20, 6, 1}, {0.3, 0.1, 0}, {0, 0, 0.05}, 120},
      {{0, 6, -1}, {20, 10, 1}, {-0.3, 0.4, 0}, {0, 0, -0.1}, 80},
  };
  const bw_shape shape[] = {{.kind = BW_SHAPE_BOX, .upper = {20, 10, 1}}};
  const bw_solid_config c = body_config(true);
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(1, shape, &c, &ic);
  bw_pd_fragments all;
  bw_check_ok(bw_pd_interface_fragments(b.pi, NULL, &all));
  ck_assert_int_eq(all.total, 1);
  ck_assert_int_eq(all.largest[0].label, 0);
  ck_assert_int_eq(all.largest[0].particles, 200);
  bw_pd_fragment_release(&all);
  const double from[3] = {-1, 6, 0}, to[3] = {21, 6, 0};
  bw_check_ok(bw_solid_precrack(b.pd, from, to, NULL));
  check(&b, 2, piece, 1.0);
  /* One body all the same: its bonds are there, if broken. */
  int64_t *label = NULL;
  bw_check_ok(BW_ALLOCATE(&label, bw_solid_count(b.pd)));
  bw_check_ok(bw_pd_interface_bodies(b.pi, label));
  for (size_t h = 0; h < bw_solid_count(b.pd); h++)
    ck_assert_int_eq(label[h], 0);
  bw_release(&label);
  body_destroy(&b);
}
END_TEST

/* A piece that lies across the seam of a periodic direction is one, with the centre, velocity
 * and spin of the whole one beside it (both are the same box, moved by 9 in x and by half a
 * period in z). */
START_TEST(a_piece_across_the_seam_is_whole)
{
  bw_solid_config c = body_config(false);
  c.period[2] = 20.0;
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  const bw_shape shape[] = {{.kind = BW_SHAPE_BOX, .lower = {0, 0, 6}, .upper = {4, 5, 12}},
                            {.kind = BW_SHAPE_BOX, .lower = {9, 0, 0}, .upper = {13, 5, 2}},
                            {.kind = BW_SHAPE_BOX, .lower = {9, 0, 16}, .upper = {13, 5, 20}}};
  body b = body_create(3, shape, &c, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL;
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  bw_solid_get_reference(b.pd, X);
  const double spin[3] = {0.3, -0.2, 0.1}, v[3] = {1, 2, 3};
  for (size_t h = 0; h < n; h++) {
    const bool seam = X[3 * h] > 6.0;
    const double z = X[3 * h + 2] + (seam && X[3 * h + 2] > 10.0 ? -20.0 : 0.0);
    const double r[3] = {X[3 * h] - (seam ? 11 : 2), X[3 * h + 1] - 2.5, z - (seam ? -1 : 9)};
    for (size_t d = 0; d < 3; d++)
      V[3 * h + d] = v[d] + spin[(d + 1) % 3] * r[(d + 2) % 3] - spin[(d + 2) % 3] * r[(d + 1) % 3];
  }
  bw_solid_set_state(b.pd, X, V);
  bw_pd_fragments all;
  bw_check_ok(bw_pd_interface_fragments(b.pi, NULL, &all));
  ck_assert_int_eq(all.total, 2);
  for (size_t q = 0; q < 2; q++) {
    ck_assert_int_eq(all.largest[q].particles, 120);
    const bool seam = all.largest[q].centre[0] > 6.0;
    bw_check_near(all.largest[q].centre[2], seam ? -1.0 : 9.0, 2e-6); /* label 0 is at z = 0.5 */
    for (int d = 0; d < 3; d++) {
      bw_check_near(all.largest[q].velocity[d], v[d], 2e-6);
      bw_check_near(all.largest[q].spin[d], spin[d], 2e-6);
    }
  }
  bw_pd_fragment_release(&all);
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}
END_TEST

/* A crooked piece, whose axes of inertia are oblique, that turns about any axis. */
START_TEST(spin_of_a_crooked_piece)
{
  const bw_shape shape[] = {{.kind = BW_SHAPE_BOX, .upper = {9, 3, 3}},
                            {.kind = BW_SHAPE_BOX, .lower = {6, 0, 0}, .upper = {9, 8, 3}},
                            {.kind = BW_SHAPE_BOX, .lower = {6, 5, 0}, .upper = {9, 8, 7}}};
  const bw_solid_config c = body_config(false);
  const bw_pd_interface_config ic = bw_pd_interface_config_default();
  body b = body_create(3, shape, &c, &ic);
  const size_t n = bw_solid_count(b.pd);
  double *X = NULL, *V = NULL, centre[3] = {0.0, 0.0, 0.0};
  bw_check_ok(BW_ALLOCATE(&X, 3 * n));
  bw_check_ok(BW_ALLOCATE(&V, 3 * n));
  for (int64_t q = 0; q < 3 * b.n; q++)
    centre[q % 3] += (b.site[q] + 0.5) / (double)b.n;
  const double spin[3] = {0.3, -0.7, 0.2}, v[3] = {1, 2, 3};
  bw_solid_get_reference(b.pd, X);
  for (size_t h = 0; h < n; h++)
    for (size_t d = 0; d < 3; d++) {
      const size_t e = (d + 1) % 3, f = (d + 2) % 3;
      V[3 * h + d] =
          v[d] + spin[e] * (X[3 * h + f] - centre[f]) - spin[f] * (X[3 * h + e] - centre[e]);
    }
  bw_solid_set_state(b.pd, X, V);
  bw_pd_fragments all;
  bw_check_ok(bw_pd_interface_fragments(b.pi, NULL, &all));
  ck_assert_int_eq(all.total, 1);
  for (int d = 0; d < 3; d++) {
    bw_check_near(all.largest[0].centre[d], centre[d], 2e-6);
    bw_check_near(all.largest[0].velocity[d], v[d], 2e-6);
    bw_check_near(all.largest[0].spin[d], spin[d], 2e-6);
  }
  bw_pd_fragment_release(&all);
  bw_release(&X);
  bw_release(&V);
  body_destroy(&b);
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(separate_bodies_with_known_motions),
    BW_TEST(broken_bonds_part_a_body),
    BW_TEST(a_piece_across_the_seam_is_whole),
    BW_TEST(spin_of_a_crooked_piece),
};
BW_CHECK_MAIN("pd_interface.fragment", tests)
