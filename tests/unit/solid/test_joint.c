/* Where two materials of one body meet: bonds across, breaking, pieces, contact.
 * BUILD modules=pd_interface
 * TEST ranks=1,2,3 */
#include "bw_pd_interface.h"
#include "groups.h"

#include <string.h>

static void part(const double X0[3], double v[3])
{
  v[0] = X0[0] < 4 ? -0.03 : 0.01;
  v[1] = v[2] = 0;
}

/* Of the pieces of a bar that came apart at the joint. */
static void check_pieces(bw_solid *s)
{
  const bw_pd_interface_config config = bw_pd_interface_config_default();
  bw_pd_interface *interface = NULL;
  bw_pd_fragments all;
  bw_check_ok(bw_pd_interface_create(s, &config, &interface));
  bw_check_ok(bw_pd_interface_fragments(interface, NULL, &all));
  ck_assert_int_eq(all.total, 2);
  const bw_pd_fragment *piece = all.largest;
  bw_check_near(piece[0].mass, 2 * 128 * 0.125, 1e-12);
  bw_check_near(piece[1].mass, 6 * 128 * 0.125, 1e-12);
  double P = 0;
  for (size_t q = 0; q < all.n_largest; q++)
    P += piece[q].mass * piece[q].velocity[0];
  bw_check_near(P, ledger_of(s).momentum[0], 1e5 * BW_REAL_EPSILON);
  bw_pd_fragment_release(&all);
  bw_pd_interface_destroy(&interface);
}

static void spin(const double X0[3], double v[3])
{
  v[0] = 0.1 - 0.03 * X0[1];
  v[1] = 0.03 * X0[0];
  v[2] = -0.2;
}

/* One piece of two materials: its centre is that of its mass, about which it spins. */
START_TEST(a_piece_of_two_materials_has_its_centre_of_mass)
{
  const bw_solid_config c = two_halves(BW_PD_3D);
  const bw_pd_interface_config config = bw_pd_interface_config_default();
  bw_pd_interface *interface = NULL;
  bw_pd_fragments all;
  pd_body body = bar(false);
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  pd_set(s, NULL, spin);
  bw_check_ok(bw_pd_interface_create(s, &config, &interface));
  bw_check_ok(bw_pd_interface_fragments(interface, NULL, &all));
  ck_assert_int_eq(all.total, 1);
  const bw_pd_fragment *f = &all.largest[0];
  const double centre = (2 * 2 + 6 * 6) / 8.0, e = 1e4 * BW_REAL_EPSILON; /* halves at 2 and 6 */
  bw_check_near(f->mass, 8 * 160 * 0.125, e);
  bw_check_near(f->centre[0], centre, e);
  bw_check_near(f->centre[1], 1.25, e);
  bw_check_near(f->velocity[0], 0.1 - 0.03 * 1.25, e);
  bw_check_near(f->velocity[1], 0.03 * centre, e);
  bw_check_near(f->spin[2], 0.03, 1e-9 + e); /* solve_spin's 1e-10 of the trace */
  bw_pd_fragment_release(&all);
  bw_pd_interface_destroy(&interface);
  bw_solid_destroy(&s);
  pd_body_release(&body);
}
END_TEST

/* A joint weaker than both sides: it parts there, nothing else breaks, and no less than its
 * fracture energy is paid: a bond goes at the end of the step in which it passes s0, so that with
 * the lattice's calibration and no surface across the joint (periodic sideways) G0 A is the least;
 * a twentieth more is what steps of a fiftieth of the limit add here, in which bonds are stretched
 * by 3 % of s0. */
START_TEST(a_weak_joint_breaks_at_the_joint)
{
  bw_solid_config c = two_halves(BW_PD_3D);
  c.calibration = BW_PD_CALIBRATION_LATTICE;
  c.surface_correction = BW_PD_SURFACE_NONE;
  c.period[1] = c.period[2] = 2;
  c.G0 = c.more.material[0].G0 = 1;
  c.more.joint_G0[0][1] = c.more.joint_G0[1][0] = 1e-3;
  pd_body body = pd_box(16, 4, 4);
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  pd_set(s, NULL, part);
  const double dt = 0.02 * bw_solid_dt_max(s), start = pd_energy(s);
  pd_steps(s, 600, dt);
  const bw_solid_ledger l = ledger_of(s);
  bw_check_near(pd_energy(s) / start, 1, 1e-3);
  ck_assert_double_ge(l.fracture, 1e-3 * 4 * (1 - 1e-6));
  ck_assert_double_le(l.fracture, 1.05e-3 * 4);
  bw_pd_link *link = NULL;
  bw_check_ok(BW_ALLOCATE(&link, (size_t)bw_solid_max_family(s)));
  const bw_pd_extended all = bw_solid_get_extended(s);
  uint8_t *own = NULL, *group = NULL;
  bw_check_ok(BW_ALLOCATE(&own, bw_solid_count(s)));
  bw_check_ok(BW_ALLOCATE(&group, all.n));
  for (size_t i = 0; i < bw_solid_count(s); i++)
    own[i] = (uint8_t)bw_solid_group(s, i);
  bw_solid_fill_extended(s, 1, own, group);
  for (size_t i = 0; i < bw_solid_count(s); i++) {
    const int n = bw_solid_links(s, i, link);
    for (int q = 0; q < n; q++)
      ck_assert_int_eq(link[q].intact, group[link[q].neighbour] == own[i]);
  }
  check_pieces(s);
  bw_release(&link);
  bw_release(&own);
  bw_release(&group);
  bw_solid_destroy(&s);
  pd_body_release(&body);
}
END_TEST

static double separation;

static void close_up(const double X0[3], double u[3])
{
  u[0] = X0[0] < 0.5 ? 0 : separation - 1;
  u[1] = u[2] = 0;
}

/* Two particles without a bond: the force between them is that of the harmonic mean. */
START_TEST(contact_between_two_materials_takes_the_harmonic_mean)
{
  bw_solid_config c = two_halves(BW_PD_3D);
  c.horizon_ratio = 1;
  c.contact = true;
  pd_body two = pd_box(2, 1, 1);
  two.site[0] = 6, two.site[3] = 8; /* groups 0 and 1 */
  c.origin[0] = -3;
  bw_solid *s = make(bw_check_world(), &c, &two, by_half);
  separation = 0.4;
  pd_set(s, close_up, NULL);
  bw_check_ok(bw_solid_evaluate(s));
  double A[6];
  pd_gather(s, bw_solid_get_acceleration, A);
  const double c0 = bw_solid_micromodulus(s), k = 15 * 2 * c0 * 5 * c0 / (c0 + 5 * c0);
  const double f = k * (0.5 / 0.4 - 1) * 0.125;
  bw_check_near(A[0] / (-f / 2), 1, 1e3 * BW_REAL_EPSILON);
  bw_check_near(A[3] / (f / 6), 1, 1e3 * BW_REAL_EPSILON);
  bw_check_near(ledger_of(s).contact / (k * (0.5 * log(0.5 / 0.4) - 0.1) * 0.125 * 0.125), 1,
                1e4 * BW_REAL_EPSILON);
  /* The stiffest pair, of the second group with itself, against the lighter density. */
  const double w2 = fmax(2 * 15 * c0 / 2, fmax(2 * 15 * 5 * c0 / 6, k / 2 + k / 6)) * 0.125 / 0.5;
  bw_check_near(bw_solid_dt_contact(s) * sqrt(w2), 1, 1e-12);
  bw_solid_destroy(&s);
  pd_body_release(&two);
}
END_TEST

static void stretch(const double X0[3], double u[3])
{
  u[0] = 0.01 * X0[0];
  u[1] = u[2] = 0;
}

/* Elastic energy of two bonded particles at x and x + 1. */
static double bond_energy(int32_t x, double A[6])
{
  bw_solid_config c = two_halves(BW_PD_3D);
  c.horizon_ratio = 1;
  c.surface_correction = BW_PD_SURFACE_NONE;
  pd_body two = pd_box(2, 1, 1);
  two.site[0] = x, two.site[3] = x + 1;
  bw_solid *s = make(bw_check_world(), &c, &two, by_half);
  pd_set(s, stretch, NULL);
  const double energy = ledger_of(s).elastic;
  pd_gather(s, bw_solid_get_acceleration, A);
  bw_solid_destroy(&s);
  pd_body_release(&two);
  return energy;
}

/* E is 1 : 5: a bond across has 2 5/6 of the softer one's stiffness, and moves 2 and 6 of
 * density. */
START_TEST(a_bond_across_takes_the_harmonic_mean)
{
  double soft[6], across[6], stiff[6];
  const double e = bond_energy(3, soft), e5 = bond_energy(9, stiff), em = bond_energy(7, across);
  bw_check_near(e5 / e, 5, 1e4 * BW_REAL_EPSILON);
  bw_check_near(em / e, 10.0 / 6, 1e4 * BW_REAL_EPSILON);
  bw_check_near(across[0] / soft[0], 10.0 / 6, 1e4 * BW_REAL_EPSILON);
  bw_check_near(across[3] / soft[3], 10.0 / 18, 1e4 * BW_REAL_EPSILON);
  bw_check_near(stiff[0] / soft[0], 5.0 / 3, 1e4 * BW_REAL_EPSILON);
}
END_TEST

static void meet_again(const double X0[3], double v[3])
{
  v[0] = X0[0] < 4 ? 0.15 : -0.05;
  v[1] = v[2] = 0;
}

/* Halves that a pre-crack has parted are thrown at each other: the book closes over the bounce. */
START_TEST(halves_that_parted_bounce)
{
  bw_solid_config c = two_halves(BW_PD_3D);
  c.contact = true;
  pd_body body = bar(false);
  bw_solid *s = make(bw_check_world(), &c, &body, by_half);
  bw_check_ok(
      bw_solid_precrack(s, (double[]){4, -9, -9}, (double[]){4, 9, -9}, (double[]){4, -9, 9}));
  pd_set(s, NULL, meet_again);
  const bw_solid_ledger start = ledger_of(s);
  const double dt = 0.1 * fmin(bw_solid_dt_max(s), bw_solid_dt_contact(s));
  double most = 0;
  for (int q = 0; q < 60; q++) {
    pd_steps(s, 10, dt);
    most = fmax(most, ledger_of(s).contact);
    bw_check_near(pd_energy(s) / start.kinetic, 1, 0.005); /* (w dt)^2/8 */
  }
  const bw_solid_ledger end = ledger_of(s);
  ck_assert_double_gt(most, 0.02 * start.kinetic);
  bw_check_near(end.momentum[0], start.momentum[0], 1e4 * BW_REAL_EPSILON);
  for (int k = 0; k < 3; k++)
    bw_check_near(end.angular[k], start.angular[k], 1e5 * BW_REAL_EPSILON);
  bw_solid_destroy(&s);
  pd_body_release(&body);
}
END_TEST

static void refused(const bw_solid_config *c, grouping of, const char *words)
{
  pd_body body = bar(true);
  bw_solid *s = NULL;
  uint8_t *group = NULL;
  bw_check_ok(BW_ALLOCATE(&group, (size_t)body.n));
  for (int64_t q = 0; q < body.n; q++)
    group[q] = of(body.site + 3 * q);
  const bw_pd_sites given = {
      .n = bw_comm_rank(bw_check_world()) == 0 ? body.n : 0, .site = body.site, .group = group};
  bw_check_status(bw_solid_create(bw_check_world(), c, &given, &s), BW_EINPUT);
  /* Other ranks are told by whom. */
  if (bw_comm_rank(bw_check_world()) == 0)
    ck_assert_msg(strstr(bw_last_message(), words) != NULL, "%s", bw_last_message());
  bw_release(&group);
  pd_body_release(&body);
}

static uint8_t third(const int32_t site[3])
{
  return site[0] == 5 ? 2 : 0;
}

START_TEST(what_is_wrong_with_a_group_is_named)
{
  const bw_solid_config good = two_halves(BW_PD_PLANE_STRESS);
  bw_solid_config c = good;
  c.more.material[0].E = 0;
  refused(&c, by_half, "more[0].E");
  c = good;
  c.more.material[0].nu = 0.3;
  refused(&c, by_half, "nu = 0.3");
  c = good;
  c.more.joint_G0[0][1] = 2;
  refused(&c, by_half, "joint_G0[0][1]");
  c.more.joint_G0[1][0] = 3; /* two values for one joint */
  refused(&c, by_half, "must be positive and the same");
  refused(&good, third, "group 2");
}
END_TEST

static const bw_check_test tests[] = {
    BW_TEST(a_piece_of_two_materials_has_its_centre_of_mass),
    BW_TEST(a_weak_joint_breaks_at_the_joint),
    BW_TEST(a_bond_across_takes_the_harmonic_mean),
    BW_TEST(contact_between_two_materials_takes_the_harmonic_mean),
    BW_TEST(halves_that_parted_bounce),
    BW_TEST(what_is_wrong_with_a_group_is_named)};
BW_CHECK_MAIN("solid_joint", tests)
