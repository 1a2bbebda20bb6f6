/* bw_config.h -- a case's own C struct from a YAML file, by one table of fields.
 *
 * The table says for each member: key, type, range, unit, meaning, and whether it must be given.
 * The libcyaml schema, the checks, the messages, the dump and the help all come from it.
 *
 *   typedef struct { double nu; int n[3]; bool periodic[3]; int inflow; char name[64]; } my_fluid;
 *   typedef struct { double radius, x[3]; } my_shape;
 *   typedef struct { my_fluid fluid; bool has_probe; my_probe probe;
 *                    int n_shapes; my_shape shapes[8]; } my_case;
 *   static const bw_config_word inflow_words[] = {{"poiseuille", 0}, {"uniform", 1}, {0}};
 *   static const bw_config_field fluid_fields[] = {
 *     BW_CONFIG_VALUE(my_fluid, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
 *     BW_CONFIG_VALUE(my_fluid, n, BW_REQUIRED, BW_AT_LEAST(1), "", "cells in x, y, z"),
 *     BW_CONFIG_WORD(my_fluid, inflow, BW_OPTIONAL, inflow_words, "velocity profile at x = 0"),
 *     BW_CONFIG_END};
 *   static const bw_config_field fields[] = {
 *     BW_CONFIG_MAP(my_case, fluid, fluid_fields, "the fluid"),
 *     BW_CONFIG_MAP_IF(my_case, probe, has_probe, probe_fields, "normal probes"),
 *     BW_CONFIG_LIST(my_case, shapes, n_shapes, BW_REQUIRED, shape_fields, "the solid"),
 *     BW_CONFIG_END};
 *
 * Defaults are what the struct holds before loading; for the items of a list, what item 0 holds.
 * Not set (an error by name where BW_REQUIRED): NaN, INT_MIN (words too), "", an empty list.
 * The struct is plain: no pointers inside; texts are char arrays, lists are arrays with a count.
 * A fixed array in C (double x[3]) is a YAML list of that length. Numbers are decimal and finite.
 * Overrides are "key.path=value"; shapes.0.radius=2 names an item (its index at most the count,
 * so that the next one may be added); a value may be any YAML ("[1, 2, 3]"). The key `run` at the
 * top level is ignored, so that a run.yaml is itself a case file. */
#pragma once
#include "bw_comm.h"
#include <stddef.h>
#include <stdio.h>

BW_BEGIN_DECLS

typedef enum {
  BW_CONFIG_TYPE_DOUBLE,
  BW_CONFIG_TYPE_INT,
  BW_CONFIG_TYPE_BOOL,
  BW_CONFIG_TYPE_TEXT,
  BW_CONFIG_TYPE_WORD,
  BW_CONFIG_TYPE_MAP,
  BW_CONFIG_TYPE_LIST
} bw_config_type;

typedef enum { BW_OPTIONAL, BW_REQUIRED } bw_config_need;

enum { BW_BOUND_MIN = 1, BW_BOUND_ABOVE = 2, BW_BOUND_MAX = 4, BW_BOUND_BELOW = 8 };
typedef struct {
  int bounds; /* which of the two hold, and whether the limit itself is allowed */
  double low, high;
} bw_config_range;
#define BW_ANY                                                                                     \
  {                                                                                                \
    0, 0, 0                                                                                        \
  }
#define BW_ABOVE(x)                                                                                \
  {                                                                                                \
    BW_BOUND_ABOVE, (x), 0                                                                         \
  } /* > x */
#define BW_AT_LEAST(x)                                                                             \
  {                                                                                                \
    BW_BOUND_MIN, (x), 0                                                                           \
  } /* >= x */
#define BW_BELOW(x)                                                                                \
  {                                                                                                \
    BW_BOUND_BELOW, 0, (x)                                                                         \
  } /* < x */
#define BW_AT_MOST(x)                                                                              \
  {                                                                                                \
    BW_BOUND_MAX, 0, (x)                                                                           \
  } /* <= x */
#define BW_FROM_TO(a, b)                                                                           \
  {                                                                                                \
    BW_BOUND_MIN | BW_BOUND_MAX, (a), (b)                                                          \
  } /* [a, b] */
#define BW_BETWEEN(a, b)                                                                           \
  {                                                                                                \
    BW_BOUND_ABOVE | BW_BOUND_BELOW, (a), (b)                                                      \
  } /* (a, b) */
#define BW_ABOVE_TO(a, b)                                                                          \
  {                                                                                                \
    BW_BOUND_ABOVE | BW_BOUND_MAX, (a), (b)                                                        \
  } /* (a, b] */

typedef struct {
  const char *word; /* NULL ends the list */
  int value;
  const char *help; /* may be NULL */
} bw_config_word;

typedef struct bw_config_field bw_config_field;
struct bw_config_field {
  const char *key; /* NULL ends the table */
  bw_config_type type;
  bw_config_need need;
  size_t offset, size; /* the whole member */
  size_t item_size;    /* of one element: double, int, bool, the struct of a list */
  size_t flag;         /* MAP: offset of its bool, or BW_CONFIG_NO_FLAG; LIST: of its int count */
  bw_config_range range;
  const char *unit, *help;
  const bw_config_word *words;
  const bw_config_field *fields;
};
#define BW_CONFIG_NO_FLAG ((size_t)-1)

#define BW_CONFIG_MEMBER_(T, m) (((T *)0)->m)
#define BW_CONFIG_TYPE_OF_(x)                                                                      \
  _Generic((x),                                                                                    \
      double: BW_CONFIG_TYPE_DOUBLE,                                                               \
      double *: BW_CONFIG_TYPE_DOUBLE,                                                             \
      int: BW_CONFIG_TYPE_INT,                                                                     \
      int *: BW_CONFIG_TYPE_INT,                                                                   \
      bool: BW_CONFIG_TYPE_BOOL,                                                                   \
      bool *: BW_CONFIG_TYPE_BOOL,                                                                 \
      char *: BW_CONFIG_TYPE_TEXT)
#define BW_CONFIG_ITEM_OF_(x)                                                                      \
  _Generic((x),                                                                                    \
      double: sizeof(double),                                                                      \
      double *: sizeof(double),                                                                    \
      int: sizeof(int),                                                                            \
      int *: sizeof(int),                                                                          \
      bool: sizeof(bool),                                                                          \
      bool *: sizeof(bool),                                                                        \
      char *: sizeof(x))

/* A member of type double, int, bool (or a fixed array of one of them) or char[]. The range is
 * for numbers; a text takes BW_ANY. */
#define BW_CONFIG_VALUE(T, m, need, range, unit, help)                                             \
  {                                                                                                \
#m, BW_CONFIG_TYPE_OF_(BW_CONFIG_MEMBER_(T, m)), need, offsetof(T, m),                         \
        sizeof BW_CONFIG_MEMBER_(T, m), BW_CONFIG_ITEM_OF_(BW_CONFIG_MEMBER_(T, m)),               \
        BW_CONFIG_NO_FLAG, range, unit, help, NULL, NULL                                           \
  }
/* An int (or an array of int) given as one of a list of words. */
#define BW_CONFIG_WORD(T, m, need, words, help)                                                    \
  {                                                                                                \
#m, BW_CONFIG_TYPE_WORD, need, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m), sizeof(int),    \
        BW_CONFIG_NO_FLAG, BW_ANY, "", help, words, NULL                                           \
  }
/* A struct with its own table; required values in it must be given. */
#define BW_CONFIG_MAP(T, m, fields, help)                                                          \
  {                                                                                                \
#m, BW_CONFIG_TYPE_MAP, BW_OPTIONAL, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m),           \
        sizeof BW_CONFIG_MEMBER_(T, m), BW_CONFIG_NO_FLAG, BW_ANY, "", help, NULL, fields          \
  }
/* The same where the block may be absent: bool member `flag` becomes true when it is given (its
 * default may be true). Required values in it are asked for only then. */
#define BW_CONFIG_MAP_IF(T, m, flag, fields, help)                                                 \
  {                                                                                                \
#m, BW_CONFIG_TYPE_MAP, BW_OPTIONAL, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m),           \
        sizeof BW_CONFIG_MEMBER_(T, m), offsetof(T, flag), BW_ANY, "", help, NULL, fields          \
  }
/* An array of structs, at most as many as it has; int member `count` tells how many are set. */
#define BW_CONFIG_LIST(T, m, count, need, fields, help)                                            \
  {                                                                                                \
#m, BW_CONFIG_TYPE_LIST, need, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m),                 \
        sizeof BW_CONFIG_MEMBER_(T, m)[0], offsetof(T, count), BW_ANY, "", help, NULL, fields      \
  }
#define BW_CONFIG_END                                                                              \
  {                                                                                                \
    NULL, BW_CONFIG_TYPE_INT, BW_OPTIONAL, 0, 0, 0, 0, BW_ANY, "", "", NULL, NULL                  \
  }

/* config (`size` bytes, with its defaults) <- the file at `path` and then the overrides. `path`
 * NULL: the overrides alone. Rank 0 reads; all ranks get the same struct or the same error:
 * BW_EIO when the file cannot be read, BW_EINPUT with one line for each thing found wrong. The
 * struct is unchanged after an error. Arguments of rank 0 count. Collective. */
bw_status bw_config_load(const bw_comm *comm, const char *path, const bw_config_field fields[],
                         int n_overrides, const char *const overrides[], size_t size,
                         void *config) BW_MUST_CHECK;

/* The struct as YAML that loads back to the same values (%.17g where needed); values not set are
 * left out. *text is allocated and owned by the caller (bw_release). Local. */
bw_status bw_config_dump(const bw_config_field fields[], const void *config,
                         char **text) BW_MUST_CHECK;

/* One line per key: path, type, range, unit, default of `config`, meaning. Local. */
void bw_config_help(const bw_config_field fields[], const void *config, FILE *out);

BW_END_DECLS
