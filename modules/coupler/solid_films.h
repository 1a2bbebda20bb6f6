/* solid_films.h -- films between the faces of a solid of particles; of the coupler only. */
#pragma once
#include "bw_coupler.h"
#include "bw_film_net.h"

enum { BW_COUPLER__SPREAD = 64 };

/* Of a surface point, as ranks tell each other. */
typedef struct {
  int64_t id;
  int32_t rank, particle;
  double X[3], N[3], H, A, mobility;
} bw_coupler__film_point;

/* A face of a cell whose velocity along the film is that of the film's own faces. */
typedef struct {
  ptrdiff_t at;
  int d;        /* component */
  int32_t node; /* the nearest */
  double away, change;
} bw_coupler__braked;

typedef struct bw_coupler__solid_films {
  bw_film_net *net;
  double spread[BW_COUPLER__SPREAD + 1]; /* part of a marker's force beyond a distance, of equal
                                            steps up to the radius of its kernel */
  bw_pd_interface *interface;
  int rank;
  bool stale;                                     /* the films are those of an earlier surface */
  size_t n, room;                                 /* points of all ranks */
  bw_coupler__film_point *list;                   /* (n) by rising id */
  double *X, *N, *H, *A, *mobility, *V, *L, *F;   /* of the points; vectors (room,3) */
  double *edge;                                   /* (room) pressure at the edges */
  double *probe_X, *probe_N, *probe_A, *traction; /* (room,3) of own edges */
  int32_t *probe_of;                              /* (room) which edge */
  unsigned char *flag;                            /* (room) */
  double *T, *p_mid;    /* (room,3), (room) what the grid does between the faces of nodes */
  double *told, *brake; /* (room,3) of nodes: velocity of both faces; force on the solid */
  double *moved;        /* (room) volume that the film has brought to a point */
  int32_t *point_node;  /* (room) node of a point; -1: none */
  ptrdiff_t *source_cell;
  double *source_rate; /* (8 room) */
  size_t n_nodes, n_used, n_edges, n_sources, n_braked, room_braked;
  bw_coupler__braked *braked; /* (room_braked) */
  int32_t *braked_at[3];      /* of the grid's faces: number in `braked`; -1: none */
  const bw_film_node *node;
  const int32_t *used, *edge_point;
  /* (particles) */
  double *base, *density; /* (particles,3) force per volume without films, and theirs */
  double *before, *v, *a; /* (particles,3) places and velocities before a sub-step; scratch */
  double *edge_p;         /* pressure at an edge, relaxed; NaN: not known */
  double *carried;        /* volume that the films of the last step have brought here [L^3] */
  int32_t *row;           /* of the coupler's surface; -1: none */
  int32_t *node_of;       /* node of the film; -1: none */
} bw_coupler__solid_films;

static inline bool bw_coupler__film_own(const bw_coupler__solid_films *f, int32_t s)
{
  return f->list[s].rank == f->rank;
}

/* BW_EINPUT names what is wrong with the coupler's configuration; BW_EMEM. Collective. */
bw_status bw_coupler__solid_films_create(bw_coupler *c) BW_MUST_CHECK;
void bw_coupler__solid_films_destroy(bw_coupler__solid_films **films);
/* What has a row per particle. Local. */
bw_status bw_coupler__solid_films_rows(bw_coupler *c) BW_MUST_CHECK;

/* The surface has moved. Its films are found at the beginning of the next step, so that those of
 * the last one can be asked for until then. Both collective. */
bw_status bw_coupler__solid_films_follow(bw_coupler *c) BW_MUST_CHECK;
bw_status bw_coupler__solid_films_find(bw_coupler *c) BW_MUST_CHECK;
/* Are there any? The same on all ranks. */
bool bw_coupler__solid_films_any(const bw_coupler *c);
/* Does what flows in them concern the grid? The same on all ranks. */
bool bw_coupler__solid_films_flow(const bw_coupler *c);
/* What the marker of own particle p keeps of its memory from step to step: NaN, none and gathers
 * none, where a bond has broken; 1 else. Nearer than two cells both faces of a gap ask the same
 * cells, which cannot have two velocities, and a memory of that would grow without end: below one
 * cell it keeps none. Where what flows in films is the grid's, 1 everywhere, as faces are to be
 * tight, and markers ask for something else there: c->marker_V goes over to the mean of both faces
 * (aim). keep is local, aim collective. */
double bw_coupler__solid_films_keep(const bw_coupler *c, size_t p);
bw_status bw_coupler__solid_films_aim(bw_coupler *c) BW_MUST_CHECK;

/* After c->load is that of c->force: the pressure at the edges of the films, `relaxation` of it
 * new; what the grid does between faces out of c->load. Collective. */
bw_status bw_coupler__solid_films_replace(bw_coupler *c, double dt,
                                          double relaxation) BW_MUST_CHECK;
/* The force on the solid without films (n,3), per volume, as pushed. Local. */
void bw_coupler__solid_films_base(bw_coupler *c, const double F[]);
/* Before and after a sub-step of dt of the solid: its force, with films; what they took. press is
 * collective. */
bw_status bw_coupler__solid_films_press(bw_coupler *c, double dt) BW_MUST_CHECK;
void bw_coupler__solid_films_book(bw_coupler *c, double dt);
/* film_nodes, film_gap, film_pressure of a report. Local, the same on all ranks. */
void bw_coupler__solid_films_look(const bw_coupler *c, bw_coupler_report *r);
/* load (n,3) += the force of films on the particles. Local. */
void bw_coupler__solid_films_add(const bw_coupler *c, double load[]);
/* V (used points) of all ranks: rows of `value` (particles,3). Collective. */
void bw_coupler__solid_films_tell(bw_coupler *c, const double value[]);

/* solid_films_grid.c: what films are to the grid. Before a step of the fluid: what is braked, and
 * what the films of the last step have brought. Collective. */
bw_status bw_coupler__solid_films_open(bw_coupler *c, double dt) BW_MUST_CHECK;
/* In a sub-step, before or after the markers; dt of the step. Collective. */
void bw_coupler__solid_films_brake(bw_coupler *c, double dt, bool after);
/* c->load += what the brake of the step does to the faces. Collective. */
void bw_coupler__solid_films_bear(bw_coupler *c);
/* After the films were solved for a sub-step of the solid. Local. */
void bw_coupler__solid_films_bring(bw_coupler *c, double dt);
/* What was brought in the last step, (n) of the particles. Borrowed. */
double *bw_coupler__solid_films_carried(const bw_coupler *c);
bw_status bw_coupler__solid_films_grid_create(bw_coupler *c) BW_MUST_CHECK;
void bw_coupler__solid_films_grid_release(bw_coupler__solid_films *f);

/* Pressure at the edges as relaxed, (n) of the particles; NaN: not known. Borrowed. */
double *bw_coupler__solid_films_edge(const bw_coupler *c);
