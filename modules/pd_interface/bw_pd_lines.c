/* The surface is carried by line elements, eight rows of the list at once.
 *
 * A material surface moves as n.a = n0.a0 for any line element a0 that becomes a (Nanson). Three of
 * them, between partners on both sides of a particle along the lattice directions, give n exactly
 * where the deformation is homogeneous between them:
 *   n ~ sum_r (n0.a0_r) c_r / det,  c_r = a_{r+1} x a_{r+2},  det = a_r.c_r.
 * The same three give the rotation of the velocity field, exact for a rigid motion:
 *   spin = 1/2 curl v = 1/2 sum_r c_r x a'_r / det.
 * A moment M is borne by what has the power M.spin for every v: by forces g_r and -g_r on their
 * ends, g_r = M x c_r / (2 det),  sum_r a_r x g_r = M. Ends an even number of spacings apart do not
 * see the lattice's shortest wave. One that is missing (sheets) is the product of the two others;
 * with two missing (rods, lone particles; det = 0) there is nothing to tell. */
#include "pd_interface_internal.h"
#include <math.h>
#include <string.h>

enum { ROWS = BW_PD_INTERFACE__ROWS };
typedef double lanes[ROWS];

/* Where a line element may end: steps to both sides, the best first (about the particle, long,
 * even).
 */
static const int8_t spans[][2] = {{2, 2}, {1, 1}, {2, 0}, {0, 2}, {1, 0}, {0, 1}};

/* The partner that holds some steps along lattice direction r; h itself at none; -1: nobody. */
static int32_t partner_at(const bw_pd_interface *pi, size_t h, int r, int steps)
{
  const bw_pd_interface__stencil *s = bw_pd_interface__stencil_of(pi, h);
  if (steps == 0) return (int32_t)h;
  double xi[3];
  for (int d = 0; d < 3; d++)
    xi[d] = steps * s->ds * s->axes[r][d];
  const int q = bw_pd_interface__slot_of(s, xi, s->level);
  const bool there =
      q >= 0 && pi->seen.state[q] == BW_PD_INTERFACE__INTACT && pi->seen.near[q].cross == 0;
  return there ? pi->seen.near[q].partner : -1;
}

void bw_pd_interface__anchor(bw_pd_interface *pi, size_t h)
{
  for (int r = 0; r < 3; r++) {
    int32_t *end = &pi->anchor[6 * h + 2 * (size_t)r];
    uint8_t *steps = &pi->steps[3 * h + (size_t)r];
    /* Without partners on this line the element is missing: `complete` makes one. */
    end[0] = end[1] = (int32_t)h;
    *steps = r >= pi->stencil->dims; /* across a plane: ds, for good */
    /* The first span of the list of which both ends hold. */
    for (size_t q = 0; r < pi->stencil->dims && q < sizeof spans / sizeof *spans; q++) {
      const int32_t to = partner_at(pi, h, r, spans[q][0]);
      const int32_t from = partner_at(pi, h, r, -spans[q][1]);
      if (to < 0 || from < 0) continue;
      end[0] = to, end[1] = from;
      *steps = (uint8_t)(spans[q][0] + spans[q][1]);
      break;
    }
  }
}

/* a_r of a block's rows in the reference shape. */
static void at_rest(const bw_pd_interface *pi, size_t block, lanes a[3][3])
{
  const bw_pd_interface__lines *l = &pi->now.lines[block];
  const bw_pd_interface__stencil *s = pi->stencil;
  /* Whole steps of the lattice ... */
  for (int r = 0; r < 3; r++)
    for (int d = 0; d < 3; d++) {
      const double axis = s->axes[r][d];
#pragma omp simd
      for (int k = 0; k < ROWS; k++)
        a[r][d][k] = l->spacing[k] * axis * l->steps[r][k];
    }
  /* ... and in a cloud what its particles differ from it. */
  if (pi->now.off_lattice == NULL) return;
  const double *more = &pi->now.off_lattice[9 * ROWS * block];
  for (int r = 0; r < 3; r++)
    for (int d = 0; d < 3; d++, more += ROWS)
      for (int k = 0; k < ROWS; k++)
        a[r][d][k] += more[k];
}

/* a_r += what x differs between the ends. */
static void add_between(const bw_pd_interface__lines *l, const bw_real *const x[3], lanes a[3][3])
{
  for (int r = 0; r < 3; r++) {
    const int32_t *to = l->end[r][0], *from = l->end[r][1];
    for (int k = 0; k < ROWS; k++)
      for (int d = 0; d < 3; d++)
        a[r][d][k] += (double)x[d][to[k]] - (double)x[d][from[k]];
  }
}

/* c += a x b */
static inline void add_cross(lanes a[3], lanes b[3], lanes c[3])
{
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
#pragma omp simd
    for (int k = 0; k < ROWS; k++)
      c[d][k] += a[e][k] * b[f][k] - a[f][k] * b[e][k];
  }
}

/* Of the elements that are missing: a_r is the others' product, b_r (NULL: not asked for) its rate
 * when theirs are b. */
static void complete(const bw_pd_interface__lines *l, lanes a[3][3], lanes (*b)[3])
{
  /* Product of the two others, in all lanes; taken only where an element is missing. */
  for (int r = 0; r < 3 && !l->whole; r++) {
    const int e = (r + 1) % 3, f = (r + 2) % 3;
    lanes product[3] = {{0}}, rate[3] = {{0}};
    add_cross(a[e], a[f], product);
    if (b != NULL) add_cross(b[e], a[f], rate), add_cross(a[e], b[f], rate);
    for (int d = 0; d < 3; d++)
      for (int k = 0; k < ROWS; k++) {
        if (l->steps[r][k] != 0) continue;
        a[r][d][k] = product[d][k];
        if (b != NULL) b[r][d][k] = rate[d][k];
      }
  }
}

static inline void dot(lanes a[3], lanes b[3], lanes out)
{
#pragma omp simd
  for (int k = 0; k < ROWS; k++)
    out[k] = a[0][k] * b[0][k] + a[1][k] * b[1][k] + a[2][k] * b[2][k];
}

/* Present elements a, their products c_r = a_{r+1} x a_{r+2} and det = a_r.c_r; b (NULL: not asked
 * for) the rates of the elements. */
static void present(const bw_pd_interface *pi, size_t block, const bw_pd_motion *now, lanes a[3][3],
                    lanes (*b)[3], lanes c[3][3], lanes det)
{
  const bw_pd_interface__lines *l = &pi->now.lines[block];
  /* a_r = reference element + difference of displacements; b_r that of velocities. */
  at_rest(pi, block, a);
  add_between(l, now->u, a);
  if (b != NULL) add_between(l, now->v, b);
  complete(l, a, b);
  /* c_r = a_{r+1} x a_{r+2}, the reciprocal lines times det. */
  for (int r = 0; r < 3; r++)
    add_cross(a[(r + 1) % 3], a[(r + 2) % 3], c[r]);
  dot(a[0], c[0], det);
}

/* What the particle's line elements differ from the lattice's, in a cloud. */
static void note_cloud(bw_pd_interface *pi, size_t row, size_t h)
{
  const bw_pd_interface__stencil *s = pi->stencil;
  double *more = &pi->now.off_lattice[9 * ROWS * (row / ROWS) + row % ROWS];
  for (size_t r = 0; r < 3; r++) {
    double to[3], from[3];
    bw_solid_get_place(pi->pd, (size_t)pi->anchor[6 * h + 2 * r], to);
    bw_solid_get_place(pi->pd, (size_t)pi->anchor[6 * h + 2 * r + 1], from);
    for (size_t d = 0; d < 3; d++)
      if (pi->anchor[6 * h + 2 * r] != pi->anchor[6 * h + 2 * r + 1])
        more[(3 * r + d) * ROWS] = to[d] - from[d] - s->ds * s->axes[r][d] * pi->steps[3 * h + r];
  }
}

void bw_pd_interface__lay_lines(bw_pd_interface *pi, const bw_pd_motion *now)
{
  const size_t blocks = (pi->now.n_list + ROWS - 1) / ROWS;
  if (blocks > 0) memset(pi->now.lines, 0, blocks * sizeof *pi->now.lines);
  if (pi->now.off_lattice != NULL)
    memset(pi->now.off_lattice, 0, 9 * ROWS * blocks * sizeof(double));
  /* Ends of the elements in storage order, eight rows of the list side by side. */
  for (size_t row = 0; row < pi->now.n_list; row++) {
    const size_t h = (size_t)pi->now.list[row], k = row % ROWS;
    bw_pd_interface__lines *l = &pi->now.lines[row / ROWS];
    if (k == 0) l->whole = row + ROWS <= pi->now.n_list;
    l->spacing[k] = bw_solid_spacing(pi->pd, h);
    for (size_t r = 0; r < 3; r++) {
      l->steps[r][k] = pi->steps[3 * h + r];
      l->whole = l->whole && l->steps[r][k] != 0;
      for (size_t end = 0; end < 2; end++)
        l->end[r][end][k] = now->place[pi->anchor[6 * h + 2 * r + end]];
    }
    if (pi->now.off_lattice != NULL) note_cloud(pi, row, h);
  }
  /* n0.a0 of each element: what stays while the body moves (Nanson). */
  for (size_t block = 0; block < blocks; block++) {
    lanes a[3][3], n[3] = {{0}};
    for (size_t row = block * ROWS; row < pi->now.n_list && row < (block + 1) * ROWS; row++)
      for (size_t d = 0; d < 3; d++)
        n[d][row % ROWS] = pi->fit.own_normal[3 * (size_t)pi->now.list[row] + d];
    /* Missing elements are completed in the reference shape as they will be in the present one. */
    at_rest(pi, block, a);
    complete(&pi->now.lines[block], a, NULL);
    for (int r = 0; r < 3; r++)
      dot(n, a[r], pi->now.lines[block].hold[r]);
  }
}

/* A block's vectors to out (n_list,3); rows of length 0 are those of the reference shape. */
static void tell_block(const bw_pd_interface *pi, size_t block, lanes n[3])
{
  lanes squared, scale;
  dot(n, n, squared);
#pragma omp simd
  for (int k = 0; k < ROWS; k++)
    scale[k] = 1.0 / sqrt(squared[k]);
  /* The last block may be partly empty: its lanes are computed, not told. */
  for (size_t row = block * ROWS; row < pi->now.n_list && row < (block + 1) * ROWS; row++) {
    const size_t k = row % ROWS;
    for (size_t d = 0; d < 3; d++)
      pi->now.list_normal[3 * row + d] = squared[k] > 0.0
                                             ? n[d][k] * scale[k]
                                             : pi->fit.own_normal[3 * pi->now.list[row] + (int)d];
  }
}

void bw_pd_interface__carry_normals(bw_pd_interface *pi, const bw_pd_motion *now)
{
  for (size_t block = 0; block * ROWS < pi->now.n_list; block++) {
    const bw_pd_interface__lines *l = &pi->now.lines[block];
    lanes a[3][3], c[3][3] = {{{0}}}, n[3] = {{0}}, det;
    present(pi, block, now, a, NULL, c, det);
    /* n ~ sum_r (n0.a0_r) c_r/det; only the sign of det matters, as n is made a unit vector. */
    for (int r = 0; r < 3; r++)
      for (int d = 0; d < 3; d++)
#pragma omp simd
        for (int k = 0; k < ROWS; k++)
          n[d][k] += copysign(l->hold[r][k], l->hold[r][k] * det[k]) * c[r][d][k];
    tell_block(pi, block, n);
  }
}

void bw_pd_interface__carry_sides(const bw_pd_interface *pi, size_t block, const bw_pd_motion *now,
                                  double N[ROWS][6][3])
{
  lanes a0[3][3], a[3][3], c[3][3] = {{{0}}}, det;
  at_rest(pi, block, a0);
  complete(&pi->now.lines[block], a0, NULL);
  present(pi, block, now, a, NULL, c, det);
  /* As the normals are carried: n ~ sum_r (n0.a0_r) c_r/det, n0 a direction of the lattice. */
  for (size_t k = 0; k < ROWS; k++)
    for (int side = 0; side < 6; side++) {
      const double *axis = pi->stencil->axes[side / 2], way = side % 2 ? 1.0 : -1.0;
      double n[3] = {0.0, 0.0, 0.0}, squared = 0.0;
      for (int r = 0; r < 3; r++) {
        double hold = 0.0;
        for (int d = 0; d < 3; d++)
          hold += way * axis[d] * a0[r][d][k];
        for (int d = 0; d < 3; d++)
          n[d] += copysign(hold, hold * det[k]) * c[r][d][k];
      }
      for (int d = 0; d < 3; d++)
        squared += n[d] * n[d];
      for (int d = 0; d < 3; d++)
        N[k][side][d] = squared > 0.0 ? n[d] / sqrt(squared) : way * axis[d];
    }
}

/* 1/(2 det) where the elements span space, else 0 (two are missing, or crushed into a plane). */
static void half_inverse(lanes a[3][3], lanes det)
{
  lanes length[3];
  for (int r = 0; r < 3; r++)
    dot(a[r], a[r], length[r]);
#pragma omp simd
  for (int k = 0; k < ROWS; k++) {
    /* Relative to the elements' own lengths: a volume is never compared with an absolute number. */
    const double least = 1e-12 * length[0][k] * length[1][k] * length[2][k];
    det[k] = det[k] * det[k] > least ? 0.5 / det[k] : 0.0;
  }
}

void bw_pd_interface_turn(bw_pd_interface *pi, double spin[])
{
  const bw_pd_motion now = bw_solid_get_motion(pi->pd, true);
  for (size_t block = 0; block * ROWS < pi->now.n_list; block++) {
    lanes a[3][3], b[3][3] = {{{0}}}, c[3][3] = {{{0}}}, w[3] = {{0}}, half;
    present(pi, block, &now, a, b, c, half);
    /* spin = 1/2 sum_r c_r x a'_r/det. */
    for (int r = 0; r < 3; r++)
      add_cross(c[r], b[r], w);
    half_inverse(a, half);
    /* half is 1/(2 det), or 0 where no rotation can be told. */
    for (size_t row = block * ROWS; row < pi->now.n_list && row < (block + 1) * ROWS; row++)
      for (size_t d = 0; d < 3; d++)
        spin[3 * row + d] = half[row % ROWS] * w[d][row % ROWS];
  }
}

/* The forces of the elements that are missing (complete) go to the two others. */
static void hand_over(const bw_pd_interface__lines *l, lanes a[3][3], lanes g[3][3])
{
  for (int r = 0; r < 3 && !l->whole; r++) {
    const int e = (r + 1) % 3, f = (r + 2) % 3;
    lanes lost[3];
    /* What a missing element would have borne is taken off it ... */
    for (int d = 0; d < 3; d++)
      for (int k = 0; k < ROWS; k++) {
        lost[d][k] = l->steps[r][k] == 0 ? g[r][d][k] : 0.0;
        g[r][d][k] -= lost[d][k];
      }
    /* ... and goes to those of which it is the product: the adjoint of `complete`. */
    add_cross(a[f], lost, g[e]);
    add_cross(lost, a[e], g[f]);
  }
}

/* g_r on the ends of a block's elements. */
static void add_forces(const bw_pd_interface *pi, size_t block, lanes g[3][3], double *force)
{
  for (size_t row = block * ROWS; row < pi->now.n_list && row < (block + 1) * ROWS; row++)
    for (size_t r = 0; r < 3; r++) {
      const int32_t *end = &pi->anchor[6 * (size_t)pi->now.list[row] + 2 * r];
      for (size_t d = 0; d < 3; d++) {
        force[3 * (size_t)end[0] + d] += g[r][d][row % ROWS];
        force[3 * (size_t)end[1] + d] -= g[r][d][row % ROWS];
      }
    }
}

void bw_pd_interface_twist(bw_pd_interface *pi, const double moment[], double force[])
{
  const bw_pd_motion now = bw_solid_get_motion(pi->pd, false);
  double *all = pi->fit.borne;
  memset(all, 0, 3 * pi->n_extended * sizeof *all);
  for (size_t block = 0; block * ROWS < pi->now.n_list; block++) {
    lanes a[3][3], c[3][3] = {{{0}}}, g[3][3] = {{{0}}}, M[3] = {{0}}, half;
    /* Moments of eight rows, side by side. */
    for (size_t row = block * ROWS; row < pi->now.n_list && row < (block + 1) * ROWS; row++)
      for (size_t d = 0; d < 3; d++)
        M[d][row % ROWS] = moment[3 * row + d];
    present(pi, block, &now, a, NULL, c, half);
    /* g_r = M x c_r/(2 det). */
    for (int r = 0; r < 3; r++)
      add_cross(M, c[r], g[r]);
    half_inverse(a, half);
    for (int r = 0; r < 3; r++)
      for (int d = 0; d < 3; d++)
        for (int k = 0; k < ROWS; k++)
          g[r][d][k] *= half[k];
    /* Missing elements have no ends to push. */
    hand_over(&pi->now.lines[block], a, g);
    add_forces(pi, block, g, all);
  }
  /* Ends on copies push their owners. */
  bw_solid_sum_extended(pi->pd, all);
  for (size_t i = 0; i < 3 * pi->n; i++)
    force[i] += all[i];
}
