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
 * A fixed array in C (double x[3]) is a YAML list of that length. Numbers are decimal, finite and
 * of a size that products can be made of (BW_CONFIG_LARGEST).
 * Overrides are "key.path=value"; shapes.0.radius=2 names an item (its index at most the count,
 * so that the next one may be added); a value may be any YAML ("[1, 2, 3]"). The key `run` at the
 * top level is ignored, so that a run.yaml is itself a case file.
 * Shorter ways to write a value, where the table allows them: items by their names
 * (BW_CONFIG_NAMED), a block in place of a list of one (every list), a scalar in place of a block
 * (BW_CONFIG_BRIEF), a list of texts in place of one with blanks (BW_TEXTS), a point with fewer
 * numbers (BW_POINT).
 * Tables are written in C: the macros choose by type (_Generic), which C++ cannot. A C++ program
 * may load, dump and describe with a table of a C source. */
#pragma once
#include "bw_comm.h"
#include <stddef.h>
#include <stdio.h>

BW_BEGIN_DECLS

/* What a member is, in C and in YAML; the macros below choose it. */
typedef enum {
  BW_CONFIG_TYPE_DOUBLE, /* double or a fixed array of them: a finite decimal number */
  BW_CONFIG_TYPE_INT,    /* int or a fixed array: a whole number, also written 1e6 */
  BW_CONFIG_TYPE_BOOL,   /* bool or a fixed array: true, yes, on or false, no, off */
  BW_CONFIG_TYPE_TEXT,   /* char[]: a text that fits, its end included */
  BW_CONFIG_TYPE_WORD,   /* int or a fixed array: one of a list of words */
  BW_CONFIG_TYPE_MAP,    /* a struct with its own table: a block of keys */
  BW_CONFIG_TYPE_LIST    /* an array of structs with a count: a list of blocks */
} bw_config_type;

/* Must a value be given, and may it differ when a run goes on? BW_MAY_CHANGE is added by |. */
typedef enum {
  BW_OPTIONAL = 0, /* no: what the struct holds before loading stays */
  BW_REQUIRED = 1, /* yes, unless the struct holds one before loading: an error by name otherwise */
  BW_MAY_CHANGE = 2 /* how long, how often to write, what to show: with --restart another value than
                       the checkpoint's is listed; that of any other key is refused (bw_case.h) */
} bw_config_need;

/* Which limits of a bw_config_range hold; combined by |. */
enum {
  BW_BOUND_MIN = 1,     /* x >= low */
  BW_BOUND_ABOVE = 2,   /* x > low */
  BW_BOUND_MAX = 4,     /* x <= high */
  BW_BOUND_BELOW = 8,   /* x < high */
  BW_BOUND_FILE = 16,   /* a text that names a file to be read */
  BW_BOUND_NAMED = 32,  /* a list whose items have names: a block NAME: {keys} is one, too */
  BW_BOUND_BRIEF = 64,  /* a block: a scalar is its first key, too */
  BW_BOUND_TEXTS = 128, /* a text: a list of texts is joined by blanks */
  BW_BOUND_POINT = 256  /* numbers: fewer, or one without brackets, leave the rest at 0 */
};

/* Sizes of numbers. Beyond them even the sixth power leaves what a double holds, and no quantity in
 * units of any trade is so small or large: 0, or |x| of [BW_CONFIG_SMALLEST, BW_CONFIG_LARGEST]. */
#define BW_CONFIG_SMALLEST 1e-50
#define BW_CONFIG_LARGEST  1e50

/* The numbers a member may have, in the member's unit. Written by the macros below. */
typedef struct {
  int bounds;       /* which of the two hold, and whether the limit itself is allowed */
  double low, high; /* the limits; looked at only where `bounds` says so */
} bw_config_range;

/* Any finite number. */
#define BW_ANY                                                                                     \
  {                                                                                                \
    0, 0, 0                                                                                        \
  }

/* For a text: the path of a file that the program reads. A relative one is looked for beside the
 * case file, then in the present folder; on the command line from the present folder. The struct
 * gets the absolute path. */
#define BW_FILE                                                                                    \
  {                                                                                                \
    BW_BOUND_FILE, 0, 0                                                                            \
  }

/* For a text: it may be written as a list of texts, which are joined by blanks. */
#define BW_TEXTS                                                                                   \
  {                                                                                                \
    BW_BOUND_TEXTS, 0, 0                                                                           \
  }

/* For an array of numbers: those left out at its end are 0, as z in two dimensions; one number
 * needs no brackets. */
#define BW_POINT                                                                                   \
  {                                                                                                \
    BW_BOUND_POINT, 0, 0                                                                           \
  }

/* Numbers greater than x. */
#define BW_ABOVE(x)                                                                                \
  {                                                                                                \
    BW_BOUND_ABOVE, (x), 0                                                                         \
  }

/* Numbers not less than x. */
#define BW_AT_LEAST(x)                                                                             \
  {                                                                                                \
    BW_BOUND_MIN, (x), 0                                                                           \
  }

/* Numbers less than x. */
#define BW_BELOW(x)                                                                                \
  {                                                                                                \
    BW_BOUND_BELOW, 0, (x)                                                                         \
  }

/* Numbers not greater than x. */
#define BW_AT_MOST(x)                                                                              \
  {                                                                                                \
    BW_BOUND_MAX, 0, (x)                                                                           \
  }

/* Numbers of [a, b]. */
#define BW_FROM_TO(a, b)                                                                           \
  {                                                                                                \
    BW_BOUND_MIN | BW_BOUND_MAX, (a), (b)                                                          \
  }

/* Numbers of (a, b). */
#define BW_BETWEEN(a, b)                                                                           \
  {                                                                                                \
    BW_BOUND_ABOVE | BW_BOUND_BELOW, (a), (b)                                                      \
  }

/* Numbers of (a, b]. */
#define BW_ABOVE_TO(a, b)                                                                          \
  {                                                                                                \
    BW_BOUND_ABOVE | BW_BOUND_MAX, (a), (b)                                                        \
  }

/* A word of the case file and the number that stands for it in the struct. */
typedef struct {
  const char *word; /* NULL ends the list */
  int value;        /* of the int member; not INT_MIN, which means not set */
  const char *help; /* may be NULL */
} bw_config_word;

/* One row of a table: a key of the file and the member it fills. Written by the macros below. */
typedef struct bw_config_field bw_config_field;

/* The row; texts and tables are borrowed (literals and constants). */
struct bw_config_field {
  const char *key;       /* the member's name; NULL ends the table */
  bw_config_type type;   /* what the member is */
  bw_config_need need;   /* whether a value must be given, may change; of a LIST for its items */
  size_t offset, size;   /* of the whole member in its struct [bytes] */
  size_t item_size;      /* of one element: double, int, bool, the struct of a list [bytes] */
  size_t flag;           /* MAP: offset of its bool, or BW_CONFIG_NO_FLAG; LIST: of its int count */
  bw_config_range range; /* of each number; no bounds for other types */
  const char *unit;      /* "m2/s"; "" for a pure number */
  const char *help;      /* what it means, for --help and messages */
  const bw_config_word *words;   /* WORD: the list, ended by a NULL word; else NULL */
  const bw_config_field *fields; /* MAP, LIST: the table of the struct; else NULL */
};

/* `flag` of a block that is always there. */
#define BW_CONFIG_NO_FLAG ((size_t)-1)

/* For the macros below: member m of T as an expression that is not evaluated. */
#define BW_CONFIG_MEMBER_(T, m) (((T *)0)->m)

/* For the macros below: the bw_config_type of a member. */
#define BW_CONFIG_TYPE_OF_(x)                                                                      \
  _Generic((x),                                                                                    \
      double: BW_CONFIG_TYPE_DOUBLE,                                                               \
      double *: BW_CONFIG_TYPE_DOUBLE,                                                             \
      int: BW_CONFIG_TYPE_INT,                                                                     \
      int *: BW_CONFIG_TYPE_INT,                                                                   \
      bool: BW_CONFIG_TYPE_BOOL,                                                                   \
      bool *: BW_CONFIG_TYPE_BOOL,                                                                 \
      char *: BW_CONFIG_TYPE_TEXT)

/* For the macros below: bytes of one element of a member; of a text, all of it. */
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
 * for numbers; a text takes BW_ANY or BW_FILE. */
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

/* The same where items have names: the first member of the struct is `name`, a text that is unique
 * in the list. In the file NAME: {keys} is an item; a list of blocks with the key `name` is the
 * same. Overrides and messages name items by their names. */
#define BW_CONFIG_NAMED(T, m, count, need, fields, help)                                           \
  {                                                                                                \
#m, BW_CONFIG_TYPE_LIST, need, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m),                 \
        sizeof BW_CONFIG_MEMBER_(T, m)[0], offsetof(T, count),                                     \
                                       {BW_BOUND_NAMED, 0, 0 }, "", help, NULL, fields             \
  }

/* A block that may be absent (as BW_CONFIG_MAP_IF) and for which a scalar may stand: the value of
 * the first key of its table. */
#define BW_CONFIG_BRIEF(T, m, flag, fields, help)                                                  \
  {                                                                                                \
#m, BW_CONFIG_TYPE_MAP, BW_OPTIONAL, offsetof(T, m), sizeof BW_CONFIG_MEMBER_(T, m),           \
        sizeof BW_CONFIG_MEMBER_(T, m), offsetof(T, flag),                                         \
        {BW_BOUND_BRIEF, 0, 0 }, "", help, NULL, fields                                            \
  }

/* The end of a table. */
#define BW_CONFIG_END                                                                              \
  {                                                                                                \
    NULL, BW_CONFIG_TYPE_INT, BW_OPTIONAL, 0, 0, 0, 0, BW_ANY, "", "", NULL, NULL                  \
  }

/* config (`size` bytes, with its defaults) <- the file at `path` and then
 * overrides[n_overrides], each "key.path=value". `path` NULL: the overrides alone. Rank 0 reads;
 * all ranks get the same struct or the same error: BW_EIO when the file cannot be read,
 * BW_EINPUT with one line for each thing found wrong. The struct is unchanged after an error.
 * Arguments of rank 0 count. Collective. */
bw_status bw_config_load(const bw_comm *comm, const char *path, const bw_config_field fields[],
                         int n_overrides, const char *const overrides[], size_t size,
                         void *config) BW_MUST_CHECK;

/* The struct as YAML that loads back to the same values (%.17g where needed); values not set are
 * left out. *text is allocated and owned by the caller (bw_release), NULL after BW_EMEM. Local. */
bw_status bw_config_dump(const bw_config_field fields[], const void *config,
                         char **text) BW_MUST_CHECK;

/* One line per key on `out`: path, type, range, unit, default of `config`, meaning. Local. */
void bw_config_help(const bw_config_field fields[], const void *config, FILE *out);

BW_END_DECLS
