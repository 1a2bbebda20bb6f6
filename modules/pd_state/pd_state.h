/* pd_state.h -- shared by the state-based laws. */
#pragma once
#include "bw_pd_state_law.h"
#include "pd_law.h"
#include "pd_walk.h"

static const double BW_PD_STATE_MOST_NU = 0.4999; /* beyond it the bulk modulus is infinite */

/* Lame's constants of a material; lam is lam* in plane stress (ERRATA-ADAPT 2). */
static inline void bw_pd_state__lame(const bw_pd_body_config *c, const bw_pd_material *m,
                                     double *lam, double *mu)
{
  const double nu = m->nu;
  *mu = m->E / (2 * (1 + nu));
  *lam = c->geometry == BW_PD_PLANE_STRESS ? m->E * nu / (1 - nu * nu)
                                           : m->E * nu / ((1 + nu) * (1 - 2 * nu));
}

/* Fracture energy of bonds between two groups. */
static inline double bw_pd_state__joint_G0(const bw_pd_body_config *c, int g, int h)
{
  const double own = c->joint_G0[g][h];
  return g == h || isnan(own) ? fmin(c->material[g].G0, c->material[h].G0) : own;
}

/* pd_state_common.c */

/* Poisson's ratios that such a law can have; those left out are the bond law's own. BW_EINPUT. */
bw_status bw_pd_state__check_poisson(const bw_pd_body_config *config) BW_MUST_CHECK;
void bw_pd_state__resolve_poisson(bw_pd_body_config *config);
/* The kernel rows of a level of bonds from group g to group h, (stencil.n, BW_PD_ROW). Local. */
bw_real *bw_pd_state__row(const bw_pd_body *pd, const bw_pd_level *level, int g, int h);
/* Sums over the full family of a level's stencil, or means of a cloud's: of Gamma dV xi.n over the
 * half with xi.n > 0, n along the lattice [L^4]; of Gamma dV |xi| [L^4]. BW_EMEM. Local. */
bw_status bw_pd_state__full_sums(const bw_pd_body *pd, const bw_pd_level *level, double *crossing,
                                 double *moment) BW_MUST_CHECK;
/* Micromodulus of a bond law of the same E, for contact [M/(L^5 T^2)]. */
double bw_pd_state__micromodulus(const bw_pd_body *pd, int group);

/* pd_state_crack.c: what a crack costs, beside the simplest sum. Local. */

/* Poisson's ratio that a body in plane strain with the same moduli in the plane has; in space its
 * own. */
double bw_pd_state__strain_poisson(bw_pd_geometry geometry, double nu);
/* Ordinary law: energy to drive a long crack over that of a flat cut all of whose bonds are at
 * their limit; Poisson's ratio as of plane strain. */
double bw_pd_state__ordinary_crack(const bw_pd_body_config *c, bool inverse, double nu);
/* Correspondence: that energy over E s0^2 horizon, E and Poisson's ratio as of plane strain. */
double bw_pd_state__correspondence_crack(const bw_pd_body_config *c, bool uniform, double nu);

/* pd_state_lanczos.c */

/* pd->frequency2 from the largest eigenvalue of the law's tangent over density, found by Lanczos'
 * method, with the margin that the step keeps. BW_EMEM. Collective. */
bw_status bw_pd_state__bound(bw_pd_body *pd) BW_MUST_CHECK;
/* Masses of relaxation: those of that bound, found anew when bonds have gone. Collective. */
void bw_pd_state__rows(const bw_pd_body *pd, double row[]);
