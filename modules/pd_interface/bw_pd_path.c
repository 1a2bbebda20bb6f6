/* A crack that turns: the part of it that hangs together, how far it got, its direction. */
#include "bw_memory.h"
#include "bw_pd_crack.h"
#include <math.h>

void bw_pd_crack_crop(bw_pd_crack *crack, const double lower[2], const double upper[2])
{
  size_t kept = 0;
  for (size_t q = 0; q < crack->n; q++) {
    const double s = crack->s[q], t = crack->t[q];
    /* Half-open, so that windows side by side share no particle. */
    if (s < lower[0] || s >= upper[0] || t < lower[1] || t >= upper[1]) continue;
    crack->s[kept] = s;
    crack->t[kept++] = t;
  }
  crack->n = kept;
}

typedef struct {
  bool *reached; /* (n) */
  size_t *queue; /* (n) those reached, in the order they were */
  size_t found;
} front;

/* Put those within `gap` of (s, t) at the end of the queue. The list rises in s, so that they
 * stand around place `at`. */
static void spread(const bw_pd_crack *c, size_t at, double s, double t, double gap, front *f)
{
  size_t low = at, high = at;
  /* In a list that rises in s only a strip of 2 gap has to be looked at. */
  while (low > 0 && c->s[low - 1] >= s - gap)
    low--;
  while (high < c->n && c->s[high] <= s + gap)
    high++;
  for (size_t q = low; q < high; q++) {
    if (f->reached[q] || hypot(c->s[q] - s, c->t[q] - t) > gap) continue;
    f->reached[q] = true;
    f->queue[f->found++] = q;
  }
}

bw_status bw_pd_crack_join(bw_pd_crack *crack, double s, double t, double gap)
{
  front f = {NULL, NULL, 0};
  bw_status st = BW_ALLOCATE(&f.reached, crack->n);
  BW_THEN(st, BW_ALLOCATE(&f.queue, crack->n));
  if (st == BW_OK) {
    size_t at = 0, kept = 0;
    while (at < crack->n && crack->s[at] < s)
      at++;
    /* The front begins at the given point, which need not be a particle. */
    spread(crack, at, s, t, gap, &f);
    /* Breadth first: the queue grows while it is read. */
    for (size_t k = 0; k < f.found; k++) {
      const size_t q = f.queue[k];
      spread(crack, q, crack->s[q], crack->t[q], gap, &f);
    }
    /* What was not reached is dropped, the order stays. */
    for (size_t q = 0; q < crack->n; q++) {
      if (!f.reached[q]) continue;
      crack->s[kept] = crack->s[q];
      crack->t[kept++] = crack->t[q];
    }
    crack->n = kept;
  }
  bw_release(&f.reached);
  bw_release(&f.queue);
  return st;
}

double bw_pd_crack_reach(const bw_pd_crack *crack, double s, double t, double tip[2])
{
  double farthest = NAN;
  for (size_t q = 0; q < crack->n; q++) {
    const double distance = hypot(crack->s[q] - s, crack->t[q] - t);
    /* False against NaN, so the first particle is always taken. */
    if (distance <= farthest) continue;
    farthest = distance;
    if (tip != NULL) tip[0] = crack->s[q], tip[1] = crack->t[q];
  }
  return farthest;
}

bw_pd_crack_line bw_pd_crack_fit(const bw_pd_crack *crack, double s, double t, double a, double b)
{
  bw_pd_crack_line line = {0, NAN, NAN};
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0; /* sums about (s, t) */
  for (size_t q = 0; q < crack->n; q++) {
    const double ds = crack->s[q] - s, dt = crack->t[q] - t, distance = hypot(ds, dt);
    if (distance < a || distance > b) continue;
    line.n++;
    x += ds, y += dt;
    xx += ds * ds, xy += ds * dt, yy += dt * dt;
  }
  /* Fewer than four tell no direction. */
  if (line.n < 4) return line;
  const double n = (double)line.n;
  x /= n, y /= n;
  xx = xx / n - x * x, xy = xy / n - x * y, yy = yy / n - y * y;
  /* Principal axis of the second moments; the smaller eigenvalue is the width squared. */
  line.angle = 0.5 * atan2(2.0 * xy, xx - yy);
  const double smaller = 0.5 * (xx + yy) - hypot(0.5 * (xx - yy), xy);
  line.width = sqrt(fmax(smaller, 0.0));
  /* An axis has no sense of direction: away from the start. */
  if (x * cos(line.angle) + y * sin(line.angle) < 0.0)
    line.angle += line.angle > 0.0 ? -acos(-1.0) : acos(-1.0);
  return line;
}
