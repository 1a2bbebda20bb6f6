/* Two particles: where they are, and how they push each other. */
#include "pd_contact.h"

#include <math.h>

void bw_pd_contact__place(const bw_pd_body *pd, size_t i, double X[3])
{
  bw_pd_body_reference(pd, i, X);
  for (int k = 0; k < 3; k++)
    X[k] += (double)pd->u[k][pd->points.place[i]];
}

void bw_pd_contact__position(const bw_pd_body *pd, size_t i, double y[3])
{
  double X[3];
  bw_pd_contact__place(pd, i, X);
  for (int a = 0; a < 3; a++)
    y[a] =
        pd->config.axes[a][0] * X[0] + pd->config.axes[a][1] * X[1] + pd->config.axes[a][2] * X[2];
}

double bw_pd_contact__repel(bw_pd_pair *w, const double d[3], double r2, double sum[3])
{
  /* Beyond reach, or in one place, where no direction is defined: nothing. */
  const double r = sqrt(r2);
  if (!(r2 < w->reach * w->reach) || r == 0) return 0;
  w->closest = fmin(w->closest, r / w->reach);
  /* 3.40 with ERRATA 3: -k_c (r_c/r - 1) e; d is not yet a unit vector. */
  const double f = w->k * (w->reach / r - 1) / r;
  for (int k = 0; k < 3; k++)
    sum[k] -= f * d[k];
  /* The pair's energy, half at this end. */
  return w->weight * (0.5 * w->k * (w->reach * log(w->reach / r) - w->reach + r));
}

bw_pd_pair bw_pd_contact__law(const bw_pd_body *p, int a, const bw_pd_body *q, int b)
{
  const bw_pd_level *own = bw_pd_contact__level(p, a), *other = bw_pd_contact__level(q, b);
  const int g = a % p->config.n_group, h = b % q->config.n_group;
  /* Of two stiffnesses the harmonic mean; one material's own is taken as it stands. */
  const double x = p->law->micromodulus(p, g) * own->stiff;
  const double y = q->law->micromodulus(q, h) * other->stiff;
  const double modulus = x == y ? x : 2 * x * y / (x + y), rho = p->config.material[g].rho;
  /* An acceleration of the owner: its own density below, the partner's volume above. */
  return (bw_pd_pair){.reach = fmin(own->ds, other->ds),
                      .k = BW_PD_CONTACT_STIFFNESS * modulus * other->dv / rho,
                      .weight = rho * own->dv,
                      .closest = INFINITY};
}

bw_pd_pair bw_pd_contact__pair(const bw_pd_contact *c, int a, int b)
{
  bw_pd_pair pair = c->law[a * c->kinds + b];
  pair.closest = c->closest;
  return pair;
}

double bw_pd_contact_force_of(const bw_pd_body *pd, size_t i)
{
  const int kind = bw_pd_contact__kind(pd, i);
  const bw_pd_pair pair = bw_pd_contact__law(pd, kind, pd, kind);
  /* pair.k is an acceleration of the owner, pair.weight its mass. */
  return pair.k * pair.weight;
}
