/* config_internal.h -- the steps of bw_config_load, shared by the sources config_*.c only.
 *
 *   read    text -> libyaml's document (it knows the lines), overrides put into it
 *   check   document against the table: every problem in one line; writes what was accepted as
 *           plain YAML with normalised values
 *   convert that YAML -> a struct by libcyaml, with a schema made from the table
 *   copy    what was given, from there into the caller's struct */
#pragma once
#include "bw_config.h"
#include "core_internal.h"
#include <yaml.h>

enum { BW_CONFIG_PATH = 256, BW_CONFIG_DEPTH = 16 };

typedef struct {
  const char *name; /* of the file, for messages */
  yaml_document_t document;
  int root; /* node number, as everywhere: 1 .. count; 0 means no node */
  int n_overrides;
  const char *const *overrides;
  int *first_node; /* (n_overrides) nodes from here on were made by this override or a later one */
} bw_core__config_source;

/* The document of `text` with the overrides in it, shorter ways written out as the table wants
 * them; free also after a failure. */
bw_status bw_core__config_read(const char *name, const char *text, size_t bytes,
                               const bw_config_field fields[], int n_overrides,
                               const char *const overrides[],
                               bw_core__config_source *s) BW_MUST_CHECK;
/* Writes out the shorter ways of bw_config.h in the whole document. */
bw_status bw_core__config_expand(bw_core__config_source *s,
                                 const bw_config_field fields[]) BW_MUST_CHECK;
void bw_core__config_free(bw_core__config_source *s);

/* BW_EINPUT with the line of the first byte that is not UTF-8, or 0. */
bw_status bw_core__config_encoding(const char *name, const char *text, size_t bytes) BW_MUST_CHECK;

const yaml_node_t *bw_core__config_node(const bw_core__config_source *s, int id);
/* The value of `key` in a block, 0 when there is none (or no block); *key_id may be NULL. */
int bw_core__config_find(const bw_core__config_source *s, int id, const char *key, int *key_id);
/* Items of a list (0 for anything else), and one of them. */
int bw_core__config_count(const bw_core__config_source *s, int id);
int bw_core__config_item(const bw_core__config_source *s, int id, int item);
/* Number of the item whose key `name` is this text; -1: none. */
int bw_core__config_named(const bw_core__config_source *s, int id, const char *name);
/* Nothing was written behind the key (or null). */
bool bw_core__config_is_null(const bw_core__config_source *s, int id);
/* The word `none`, which switches an optional block off. */
bool bw_core__config_is_none(const bw_core__config_source *s, int id);
/* Which override made the node; -1: it is the file's. */
int bw_core__config_override(const bw_core__config_source *s, int id);
/* *path = the file that a value names, absolute: beside the case file if it stands there, else (and
 * where the command line names it) from the present folder. The caller's (bw_release). */
bw_status bw_core__config_file(const bw_core__config_source *s, int id, const char *value,
                               char **path) BW_MUST_CHECK;
/* "case.yaml:12" or "--set key=value": where the node comes from; id 0: the file. */
void bw_core__config_where(const bw_core__config_source *s, int id, size_t size, char *text);

/* BW_EINPUT with a line for each problem. `defaults` is the struct before loading. *accepted is
 * the YAML for convert, owned by the caller (bw_release). */
bw_status bw_core__config_check(const bw_core__config_source *s, const bw_config_field fields[],
                                const void *defaults, char **accepted) BW_MUST_CHECK;

/* *out = a struct of `size` bytes with the values of `accepted`, owned by the caller
 * (bw_release); members not in it are 0. */
bw_status bw_core__config_convert(const char *accepted, const bw_config_field fields[], size_t size,
                                  void **out) BW_MUST_CHECK;

/* to <- the members of `from` that the document gives; flags and counts of blocks and lists. */
void bw_core__config_copy(const bw_core__config_source *s, const bw_config_field fields[], int id,
                          const void *from, void *to);

/* "PREFIX.KEY", or KEY when the prefix is empty; cut when too long. */
void bw_core__config_join(const char *prefix, const char *key, char path[BW_CONFIG_PATH]);
/* Number of elements of the member (3 for double x[3]; 1 for a text or a block). */
int bw_core__config_length(const bw_config_field *f);
/* No value: NaN, INT_MIN, "", an empty list. `at` is the struct that has the member. */
bool bw_core__config_unset(const bw_config_field *f, const void *at);
/* "a number > 0", "3 whole numbers from 1 to 7", "one of a, b". */
void bw_core__config_expected(const bw_config_field *f, size_t size, char *text);
/* " (kinematic viscosity [m2/s])", or "" when there is neither. */
void bw_core__config_meaning(const bw_config_field *f, size_t size, char *text);

/* The struct as lines "MARK KEY.PATH = VALUE", one for each value that is set. MARK is = where a
 * restart has to have the same, ~ where it may change, @ for a file, whose content is told by size
 * and checksum. *text is the caller's (bw_release), NULL after BW_EMEM. Local; reads files. */
bw_status bw_core__config_lines(const bw_config_field fields[], const void *config,
                                char **text) BW_MUST_CHECK;

/* The member at `at` as it stands behind its key. */
void bw_core__config_put_value(FILE *out, const bw_config_field *f, const char *at);

/* Decimal and finite, with nothing behind it? */
bool bw_core__config_number(const char *text, double *x);
/* Is x (0 as written) a size that products can be made of? BW_CONFIG_SMALLEST, BW_CONFIG_LARGEST */
bool bw_core__config_meant(const char *text, double x);
bool bw_core__config_in_range(const bw_config_range *r, double x);
/* Is `text` a value of one element of the field? Then it is printed, normalised, to `out`. */
bool bw_core__config_accept(const bw_config_field *f, const char *text, FILE *out);
