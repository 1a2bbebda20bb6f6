/* Nodes of the film, their feet on the other face, links along the faces, edges. */
#include "bw_memory.h"
#include "film_net_internal.h"

#include <math.h>
#include <string.h>

/* Faces that meet at less than 60 degrees from flat: sides of a narrow gap, not of a corner. */
static const double FACING = -0.5;
/* How far the faces may have passed through each other, in spacings: half a particle. */
static const double THROUGH = 0.5;
/* How far the mean of the points may be off the foot, in spacings. */
static const double OFF = 0.6;

/* What lies this much further ahead than the nearest is behind a face, in spacings. */
static const double HIDDEN = 0.75;

/* Points in front of a node. */
typedef struct {
  int n;
  int32_t point[FILM_NET_FACE];
  double way[FILM_NET_FACE][3]; /* from centre to centre */
} front;

/* Gap between s and q along n: both surfaces are H off their centres. */
static double gap_along(const bw_film_net *w, size_t s, size_t q, const double way[3],
                        const double n[3])
{
  return film_net__dot(way, n) - w->H[s] - w->H[q];
}

/* The points ahead of s in the direction N that look back. */
static void look_ahead(const bw_film_net *w, size_t s, const double N[3], front *o)
{
  const double ds = w->config.spacing, range = FILM_NET_REACH * ds;
  const size_t n = bw_film_net__around(w, w->X + 3 * s, bw_film_net__reach(w));
  double nearest = HUGE_VAL;
  int kept = 0;
  o->n = 0;
  for (size_t a = 0; a < n && o->n < FILM_NET_FACE; a++) {
    const size_t q = (size_t)w->near[a];
    double *way = o->way[o->n];
    if (q == s || film_net__dot(N, w->N + 3 * q) > FACING) continue;
    film_net__between(w, w->X + 3 * s, w->X + 3 * q, way);
    const double along = film_net__dot(way, N), gap = gap_along(w, s, q, way, N);
    if (gap < -THROUGH * ds || gap > w->config.limit + FILM_NET_BEYOND * ds) continue;
    if (film_net__dot(way, way) - along * along > range * range) continue;
    o->point[o->n++] = (int32_t)q;
    nearest = fmin(nearest, gap);
  }
  /* What lies behind the nearest face is hidden by it. */
  for (int a = 0; a < o->n; a++) {
    if (gap_along(w, s, (size_t)o->point[a], o->way[a], N) > nearest + HIDDEN * ds) continue;
    o->point[kept] = o->point[a];
    memmove(o->way[kept++], o->way[a], sizeof o->way[a]);
  }
  o->n = kept;
}

/* Two directions across n. */
static void across(const double n[3], double e[2][3])
{
  int least = 0;
  for (int d = 1; d < 3; d++)
    if (fabs(n[d]) < fabs(n[least])) least = d;
  double size = 0.0;
  for (int d = 0; d < 3; d++) {
    e[0][d] = (d == least ? 1.0 : 0.0) - n[d] * n[least];
    size += e[0][d] * e[0][d];
  }
  for (int d = 0; d < 3; d++)
    e[0][d] /= sqrt(size);
  for (int d = 0; d < 3; d++)
    e[1][d] = n[(d + 1) % 3] * e[0][(d + 2) % 3] - n[(d + 2) % 3] * e[0][(d + 1) % 3];
}

/* Solves the symmetric 3 x 3 system A x = b by Gauss; false: singular. */
static bool solve3(double A[3][3], double b[3])
{
  for (int k = 0; k < 3; k++) {
    if (!(A[k][k] > 1e-14)) return false;
    for (int i = k + 1; i < 3; i++) {
      const double part = A[i][k] / A[k][k];
      for (int j = k; j < 3; j++)
        A[i][j] -= part * A[k][j];
      b[i] -= part * b[k];
    }
  }
  for (int k = 2; k >= 0; k--) {
    for (int j = k + 1; j < 3; j++)
      b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  return true;
}

/* Weights of the points in front, whose mean lies on the line of n (moving least squares of first
 * order); false: the line passes beside them. */
static bool find_foot(const bw_film_net *w, const front *o, const double n[3], double weight[])
{
  const double ds = w->config.spacing, range = FILM_NET_REACH * ds;
  double e[2][3], omega[FILM_NET_FACE], f[FILM_NET_FACE][3], A[3][3] = {{0.0}}, sum = 0.0;
  double mean[2] = {0.0, 0.0};
  across(n, e);
  for (int a = 0; a < o->n; a++) {
    const double s = film_net__dot(o->way[a], e[0]) / ds, t = film_net__dot(o->way[a], e[1]) / ds;
    const double part = fmax(0.0, 1.0 - hypot(s, t) * ds / range);
    omega[a] = part * part + 1e-12;
    f[a][0] = 1.0, f[a][1] = s, f[a][2] = t;
    sum += omega[a], mean[0] += omega[a] * s, mean[1] += omega[a] * t;
  }
  if (o->n == 0 || hypot(mean[0], mean[1]) > OFF * sum) return false;
  for (int a = 0; a < o->n; a++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        A[i][j] += omega[a] / sum * f[a][i] * f[a][j];
  /* Along a line, or with one point, nothing is known across. */
  A[1][1] += 1e-12, A[2][2] += 1e-12;
  double c[3] = {1.0, 0.0, 0.0}, total = 0.0;
  if (!solve3(A, c)) return false;
  for (int a = 0; a < o->n; a++) {
    weight[a] = omega[a] / sum * film_net__dot(c, f[a]);
    total += weight[a];
  }
  for (int a = 0; a < o->n; a++)
    weight[a] /= total;
  return true;
}

static bw_status make_feet(bw_film_net *w, size_t more)
{
  if (w->n_feet + more <= w->room_feet) return BW_OK;
  const size_t room = 2 * (w->n_feet + more) + 256;
  BW_TRY(BW_ENLARGE(&w->foot, w->n_feet, room));
  w->room_feet = room;
  return BW_OK;
}

static double share_of(const bw_film_net *w, double gap)
{
  const double t = (w->config.limit - gap) / (w->config.limit - w->config.full);
  return t >= 1.0 ? 1.0 : t <= 0.0 ? 0.0 : t * t * (3.0 - 2.0 * t);
}

/* Area of s across n. Of a particle with one open side it is that side, which A has seen along a
 * leaning normal; of others A is that of the surface. */
static double facing_area(const bw_film_net *w, size_t s, const double n[3])
{
  const double facing = fmax(0.0, film_net__dot(n, w->N + 3 * s)), ds = w->config.spacing;
  const double side = ds * (w->config.planar ? w->config.depth : ds);
  return w->A[s] < (1.0 + 1e-6) * side ? fmin(side, w->A[s] / fmax(facing, 0.5)) : w->A[s] * facing;
}

/* Adds node s with the normal n, the gap as told by the way across, its feet before it. */
static void add_node(bw_film_net *w, size_t s, const double n[3], double gap, bool wall)
{
  bw_film_node *node = w->node + w->n_nodes;
  *node = (bw_film_node){.point = (int32_t)s, .wall = wall, .gap = fmax(gap, w->config.roughness)};
  memcpy(node->normal, n, 3 * sizeof *n);
  node->area = (wall ? 1.0 : 0.5) * facing_area(w, s, n);
  node->share = share_of(w, node->gap);
  w->node_of[s] = (int32_t)w->n_nodes;
  w->foot_at[++w->n_nodes] = w->n_feet;
}

/* The nearest wall that s looks at: its distance; HUGE_VAL: none. */
static double wall_ahead(const bw_film_net *w, size_t s, double n[3])
{
  double least = HUGE_VAL;
  for (int q = 0; q < w->config.n_walls; q++) {
    const bw_film_wall *wall = w->config.wall + q;
    const size_t d = (size_t)wall->direction;
    const double sign = wall->upper ? 1.0 : -1.0;
    const double away = sign * (wall->at - w->X[3 * s + d]) - w->H[s];
    if (sign * w->N[3 * s + d] < -FACING || !(away < least)) continue;
    least = away;
    n[0] = n[1] = n[2] = 0.0;
    n[d] = sign;
  }
  return least;
}

/* The foot of s, which looks along N: weights of the points in front, the normal n of both faces.
 * The foot tells how the other face looks, which moves the foot: a leaning normal finds its own
 * mirror image. */
static bool find_pair(const bw_film_net *w, const front *o, const double N[3], double n[3],
                      double weight[])
{
  enum { PASSES = 4 };
  memcpy(n, N, 3 * sizeof *n);
  for (int pass = 0; pass < PASSES; pass++) {
    double size = 0.0;
    if (!find_foot(w, o, n, weight)) return false;
    for (int d = 0; d < 3; d++) {
      n[d] = N[d];
      for (int a = 0; a < o->n; a++)
        n[d] -= weight[a] * w->N[3 * (size_t)o->point[a] + (size_t)d];
      size += n[d] * n[d];
    }
    for (int d = 0; d < 3; d++)
      n[d] /= sqrt(size);
  }
  return find_foot(w, o, n, weight);
}

/* Point s, looking along N, as a node over points or over a wall, whichever is nearer; none where
 * neither is nearer than the limit. given: N is the normal of both faces. */
static bw_status look(bw_film_net *w, size_t s, const double N[3], bool given)
{
  front o;
  double weight[FILM_NET_FACE], n[3], across_wall[3], gap = HUGE_VAL;
  const double wall = wall_ahead(w, s, across_wall);
  look_ahead(w, s, N, &o);
  memcpy(n, N, sizeof n);
  if (given ? find_foot(w, &o, N, weight) : find_pair(w, &o, N, n, weight)) {
    gap = 0.0;
    for (int a = 0; a < o.n; a++)
      gap += weight[a] * gap_along(w, s, (size_t)o.point[a], o.way[a], n);
  }
  if (!(fmin(wall, gap) < w->config.limit)) return BW_OK;
  if (wall < gap) {
    add_node(w, s, across_wall, wall, true);
    return BW_OK;
  }
  BW_TRY(make_feet(w, (size_t)o.n));
  for (int a = 0; a < o.n; a++)
    w->foot[w->n_feet++] = (film_net_foot){o.point[a], weight[a]};
  add_node(w, s, n, gap, false);
  return BW_OK;
}

/* The end of a film: its last points stand on the edge and look aside, half along the film. Those
 * beside a node look where it looks. */
static bw_status reach_edges(bw_film_net *w)
{
  /* What is found here is looked around, too, until the face has turned away. */
  for (size_t a = 0; a < w->n_nodes; a++) {
    const size_t s = (size_t)w->node[a].point, n = bw_film_net__neighbours(w, s);
    double N[3];
    memcpy(N, w->node[a].normal, sizeof N);
    /* `look` needs the list of its own point. */
    int32_t beside[FILM_NET_FACE];
    const size_t most = n < FILM_NET_FACE ? n : FILM_NET_FACE;
    memcpy(beside, w->near, most * sizeof *beside);
    for (size_t b = 0; b < most; b++) {
      const size_t q = (size_t)beside[b];
      const double facing = film_net__dot(w->N + 3 * q, N);
      if (w->node_of[q] == -1 && facing > 0.5) BW_TRY(look(w, q, N, true));
    }
  }
  return BW_OK;
}

static void use(bw_film_net *w, int32_t point)
{
  if (w->is_used[point]) return;
  w->is_used[point] = true;
  w->used[w->n_used++] = point;
}

static void list_used(bw_film_net *w)
{
  memset(w->is_used, 0, w->n * sizeof *w->is_used);
  for (size_t a = 0; a < w->n_nodes; a++) {
    use(w, w->node[a].point);
    for (size_t f = w->foot_at[a]; f < w->foot_at[a + 1]; f++)
      use(w, w->foot[f].point);
  }
}

bw_status bw_film_net__find(bw_film_net *w)
{
  w->n_nodes = w->n_feet = w->n_links = w->n_edges = w->n_used = 0;
  for (size_t s = 0; s < w->n; s++)
    w->node_of[s] = -1;
  BW_TRY(bw_film_net__sort(w));
  for (size_t s = 0; s < w->n; s++)
    BW_TRY(look(w, s, w->N + 3 * s, false));
  BW_TRY(reach_edges(w));
  BW_TRY(bw_film_net__link(w));
  list_used(w);
  return BW_OK;
}
