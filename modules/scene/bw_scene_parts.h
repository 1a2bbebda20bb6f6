/* bw_scene_parts.h -- parts of a scene file: sizes of its lists, shapes, the box and the fluid.
 *
 * Any consistent set of units: [M], [L], [T]. Numbers that were not given are NaN, words INT_MIN,
 * texts "" (bw_scene_config.h, which includes this one). */
#pragma once
#include "bw_config.h"

BW_BEGIN_DECLS

/* Sizes of the lists of a scene. */
enum {
  BW_SCENE_NAME = 48,      /* bytes of a name, its end included */
  BW_SCENE_NAMES = 256,    /* bytes of a list of names */
  BW_SCENE_PATH = 512,     /* bytes of the path of a file */
  BW_SCENE_MATERIALS = 16, /* materials */
  BW_SCENE_BODIES = 64,    /* bodies */
  BW_SCENE_PARTS = 17,     /* shapes of a body */
  BW_SCENE_LEVELS = 16,    /* boxes in which it is finer */
  BW_SCENE_HELD = 6,       /* places where a body is held */
  BW_SCENE_CRACKS = 8,     /* cracks of a body */
  BW_SCENE_LOADS = 32,     /* loads */
  BW_SCENE_PHASES = 12,    /* phases */
  BW_SCENE_GAUGES = 48,    /* gauges */
  BW_SCENE_WATCHED = 48,   /* lines of `watch` */
  BW_SCENE_VORTICES = 8    /* vortices at the start of the fluid */
};

/* One shape of a body or a fluid: exactly one of its blocks is given. */
typedef struct {
  double from[3], to[3]; /* [L] */
} bw_scene_box;
typedef struct {
  int axis;         /* 0, 1, 2 */
  double centre[2]; /* in the plane across the axis, in the order x, y, z [L] */
  double radius;    /* [L] */
  double from, to;  /* along the axis [L]; NaN: without end */
} bw_scene_cylinder;
typedef struct {
  double centre[3]; /* [L] */
  double radius;    /* [L] */
} bw_scene_sphere;
typedef struct {
  int kind;             /* bw_shape_kind */
  double centre[3];     /* of one pore [L] */
  double radius, pitch; /* [L] */
} bw_scene_pores;
typedef struct {
  char file[BW_SCENE_PATH]; /* .nrrd .nhdr .mhd .mha */
  double low, high;         /* voxels of [low, high] are solid */
  double at[3];             /* lower corner [L]; NaN: the file's */
  double voxel;             /* edge of a voxel [L]; NaN: the file's */
  int from[3], to[3];       /* voxels that count, first and behind the last; INT_MIN: all */
  bool flip[3];             /* the last voxel along x, y, z comes first */
  int coarsen[3];           /* voxels along x, y, z that make one */
} bw_scene_image;
typedef struct {
  char file[BW_SCENE_PATH]; /* binary or text STL */
  double unit;              /* of the file's lengths [L] */
  double cell;              /* cells it is filled with [L]; NaN: half the spacing */
} bw_scene_stl;
typedef struct {
  bool has_box, has_cylinder, has_sphere, has_pores, has_image, has_stl; /* which are given */
  bw_scene_box box;                                                      /* particles in it */
  bw_scene_cylinder cylinder;                                            /* when has_cylinder */
  bw_scene_sphere sphere;                                                /* when has_sphere */
  bw_scene_pores pores;                                                  /* when has_pores */
  bw_scene_image image;                                                  /* when has_image */
  bw_scene_stl stl;                                                      /* when has_stl */
  char minus[BW_SCENE_NAME];    /* a body whose shapes are taken away */
  bool remove;                  /* this shape is taken away */
  bool held;                    /* the sites of this shape are held */
  char material[BW_SCENE_NAME]; /* of the sites of this shape; "": the body's */
} bw_scene_shape;

/* What the fluid is. */
typedef enum {
  BW_SCENE_INCOMPRESSIBLE, /* a flow on a grid */
  BW_SCENE_PARTICLES,      /* particles with a free surface */
  BW_SCENE_NO_FLUID        /* none */
} bw_scene_fluid_model;

/* A tank that is shaken is at amplitude (cos(2 pi frequency t) - 1): it begins at rest. */
typedef struct {
  double amplitude[3]; /* [L] */
  double frequency;    /* [1/T] */
} bw_scene_shake;

/* The box of the fluid; without it there are solids alone. */
typedef struct {
  double length[3];          /* edges, lower corner at the origin [L] */
  int cells[3];              /* cells[2] = 1: two dimensions */
  double stretch;            /* of y by tanh [-], 0: uniform */
  char open[BW_SCENE_NAMES]; /* around a fluid of particles: sides without a wall */
  bool has_shake;            /* is it given? */
  bw_scene_shake shake;      /* of the walls around a fluid of particles */
} bw_scene_domain;

/* A side of that box. */
typedef struct {
  int kind, profile;  /* bw_ns_side_kind, bw_ns_profile */
  double velocity[3]; /* of a wall or a uniform inflow [L/T] */
  double mean;        /* mean velocity of a poiseuille inflow [L/T]; NaN: not given */
  double ramp;        /* time over which an inflow or a moving wall reaches its velocity [T] */
} bw_scene_side;
typedef struct {
  bw_scene_side lower, upper; /* at 0 and at the length */
} bw_scene_pair;
typedef struct {
  bw_scene_pair x, y, z; /* normal to x, y and z */
  bool has_z;            /* are there sides in z? Not in two dimensions */
} bw_scene_sides;

/* A vortex along z, u_theta = swirl s exp((1 - s^2)/2) with s = r/radius. */
typedef struct {
  double centre[3]; /* [L] */
  double radius;    /* where it is fastest [L] */
  double swirl;     /* largest velocity [L/T]; > 0: counterclockwise */
} bw_scene_vortex;
typedef struct {
  double velocity[3];                          /* everywhere [L/T] */
  bool developed;                              /* laminar profile of the inflow everywhere */
  int n_vortices;                              /* how many of vortices */
  bw_scene_vortex vortices[BW_SCENE_VORTICES]; /* added to it */
  int hydrostatic;                             /* particles: 1: the pressure of rest; INT_MIN: 1 */
  char file[BW_SCENE_PATH];                    /* a checkpoint to take the fluid from */
} bw_scene_start;
typedef struct {
  int kind;     /* bw_ns_forcing */
  int axis;     /* 0: x */
  double value; /* bulk velocity [L/T], or -dp/dx over the density [L/T^2] */
} bw_scene_forcing;
/* What walls and bodies are to the fluid. */
typedef enum {
  BW_SCENE_SLIP, /* it slips along them */
  BW_SCENE_STICK /* it sticks to them */
} bw_scene_walls;
typedef struct {
  int model;                /* bw_scene_fluid_model */
  double density;           /* [M/L^3] */
  double viscosity;         /* kinematic [L^2/T] */
  bool has_sides;           /* are they given? */
  bw_scene_sides sides;     /* of the box */
  bw_scene_start start;     /* the flow at the beginning */
  bool has_forcing;         /* is it given? */
  bw_scene_forcing forcing; /* what drives the flow */
  double film_roughness;    /* of films between bodies, faces of cracks, walls [L]; NaN: none */
  int eddy;                 /* bw_ns_eddy */
  int film_flux;            /* is what flows in films between particles the grid's? */
  double film_limit;        /* gap from which the grid carries them [L]; NaN: three cells */
  double film_least;        /* pressure below which they cavitate [M/(L T^2)]; NaN: never */
  int n_shape;              /* of a fluid of particles: how many of shape */
  bw_scene_shape shape[BW_SCENE_PARTS]; /* where it is at first, without the bodies */
  double speed;                         /* of it, the largest expected [L/T]; NaN: 2 sqrt(g H) */
  int walls;                            /* bw_scene_walls; INT_MIN: by the model */
} bw_scene_fluid;

BW_END_DECLS
