/* rigid_internal.h -- shared by the sources of rigid only. */
#pragma once
#include "bw_rigid.h"

/* How a body may turn: about all axes, about the axis 0, 1 or 2 alone, or as it is told. */
enum { RIGID_FREE = -1, RIGID_TOLD = 3 };

typedef struct {
  int count, turns; /* of shapes; RIGID_FREE, 0 .. 2 or RIGID_TOLD */
  bw_shape *shape;  /* (count) own copy */
  bool held[3];
  double stiffness[6], damping[6];
  double mass, volume, area, radius; /* area: of the whole surface */
  double inertia[3];                 /* principal */
  double start[3], axes[3][3];       /* centre at the start; columns: principal axes then */
  double X[3], V[3];                 /* centre */
  double R[3][3];                    /* columns: principal axes now */
  double L[3], W[3];                 /* angular momentum (of RIGID_FREE), spin */
  double angle[3];                   /* integral of the spin where it is not free */
  double F[3], T[3];                 /* loaded */
  double f[3], t[3];                 /* springs, weight, contact */
  double rub[6];                     /* of that, force and torque by friction */
} bw_rigid__body;

struct bw_rigid {
  const bw_comm *comm; /* borrowed */
  bw_rigid_config config;
  int n;
  bw_rigid__body *body; /* (n) */
  double time, contact; /* contact: energy of the last evaluation */
  double rubbed;        /* taken by friction so far */
  double lag;           /* T of friction [T] */
  size_t points;        /* of this rank */
  int64_t all;          /* points of all ranks */
  int64_t *id;          /* (points) number among them */
  int *of;              /* (points) body */
  double *area;         /* (points) */
  double *y, *m;        /* (points,3) place and normal in the frame of the principal axes */
  double *sum; /* (n,6) forces and torques to be added over ranks, the same by friction, and
                           the energy */
};

static inline double rigid_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void rigid_cross(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* out = R y. */
static inline void rigid_turn(const double R[3][3], const double y[3], double out[3])
{
  for (int d = 0; d < 3; d++)
    out[d] = rigid_dot(R[d], y);
}

/* out = R^T x. */
static inline void rigid_turn_back(const double R[3][3], const double x[3], double out[3])
{
  for (int d = 0; d < 3; d++)
    out[d] = R[0][d] * x[0] + R[1][d] * x[1] + R[2][d] * x[2];
}

/* Mass, centre, principal axes of body q from what was asked for. Local. */
bw_status bw_rigid__mass(const bw_rigid_config *config, int q, const bw_rigid_body *ask,
                         bw_rigid__body *b) BW_MUST_CHECK;
/* The surface points of all bodies. Local. */
bw_status bw_rigid__make_points(bw_rigid *rigid) BW_MUST_CHECK;
/* W of a body that turns freely, from L. Local. */
void bw_rigid__find_spin(bw_rigid__body *b);
/* f, t of all bodies where they are. Collective. */
void bw_rigid__forces(bw_rigid *rigid);
/* The contact's part of it: adds to sum (n,6) and, where there is friction, its own part to the
 * n rows behind; returns this rank's part of the energy. Local. */
double bw_rigid__contact(const bw_rigid *rigid, double sum[]);
/* The turn since the start as angle times axis. Local. */
void bw_rigid__turned(const bw_rigid__body *b, double angle[3]);
/* Place of a point of space in the body as it was at the start. Local. */
void bw_rigid__at_start(const bw_rigid__body *b, const double x[3], double start[3]);
