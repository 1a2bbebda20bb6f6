/* The document against the table: one line per problem, and the accepted values as plain YAML. */
#include "config_internal.h"

#include "bw_memory.h"
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

typedef struct {
  const bw_core__config_source *source;
  const bw_config_field *all; /* the table of the top level, to look for misplaced keys */
  FILE *problems, *accepted;
  int n_problems;
} walk;

enum { FOUND = 64, EXPECTED = 320, MEANING = 320 };

/* "WHERE: text", one line. */
BW_PRINTF(3, 4) static void problem(walk *w, int id, const char *fmt, ...)
{
  char where[BW_CONFIG_PATH];
  va_list args;
  bw_core__config_where(w->source, id, sizeof where, where);
  fprintf(w->problems, "%s%s: ", w->n_problems > 0 ? "\n" : "", where);
  va_start(args, fmt);
  vfprintf(w->problems, fmt, args);
  va_end(args);
  w->n_problems++;
}

/* A value for a message; long ones are cut. */
static void found(const walk *w, int id, char text[FOUND])
{
  const yaml_node_t *node = bw_core__config_node(w->source, id);
  /* A block or a list is described, not printed. */
  if (node->type == YAML_MAPPING_NODE)
    snprintf(text, FOUND, "a block");
  else if (node->type == YAML_SEQUENCE_NODE)
    snprintf(text, FOUND, "a list of %d", bw_core__config_count(w->source, id));
  else if (node->data.scalar.length == 0)
    snprintf(text, FOUND, "nothing");
  else
    snprintf(text, FOUND, "%.60s", (const char *)node->data.scalar.value);
}

static void wrong(walk *w, const bw_config_field *f, int id, const char *path)
{
  char value[FOUND], expected[EXPECTED], meaning[MEANING];
  found(w, id, value);
  bw_core__config_expected(f, sizeof expected, expected);
  bw_core__config_meaning(f, sizeof meaning, meaning);
  problem(w, id, "%s = %s: must be %s%s", path, value, expected, meaning);
}

/* Is it a number of this kind, but of a size that cannot be meant? */
static bool wrong_size(const bw_config_field *f, const char *text, double x)
{
  if (f->type == BW_CONFIG_TYPE_DOUBLE) return !bw_core__config_meant(text, x);
  return x == floor(x) && fabs(x) > (double)INT_MAX;
}

/* Why a value that looks right was refused. */
static void refuse(walk *w, const bw_config_field *f, int id, const char *path, const char *text)
{
  char expected[EXPECTED], meaning[MEANING];
  const char *nearest = NULL;
  int best = 64;
  bw_core__config_expected(f, sizeof expected, expected);
  bw_core__config_meaning(f, sizeof meaning, meaning);
  /* A slip of the pen is likelier than another meaning: the nearest word is named. */
  if (f->words != NULL)
    for (const bw_config_word *word = f->words; word->word != NULL; word++)
      if (bw_core__near_miss(text, word->word, &best)) nearest = word->word;
  double x = 0.0;
  /* Five things may be wrong: a number out of its range, one of a size that cannot be meant, a text
   * too long, a word misspelt, or another kind of value altogether. */
  const bool number = f->type == BW_CONFIG_TYPE_DOUBLE || f->type == BW_CONFIG_TYPE_INT;
  if (number && bw_core__config_number(text, &x) && !bw_core__config_in_range(&f->range, x)) {
    const char *relation = strpbrk(expected, "<>");
    problem(w, id, "%s = %s: must be %s%s", path, text, relation, meaning);
  } else if (number && bw_core__config_number(text, &x) && wrong_size(f, text, x)) {
    const bool whole = f->type == BW_CONFIG_TYPE_INT;
    problem(w, id, "%s = %s: too %s; %s %.10g%s", path, text, fabs(x) < 1.0 ? "small" : "large",
            fabs(x) < 1.0 ? "0, or in size at least" : "in size at most",
            whole           ? (double)INT_MAX
            : fabs(x) < 1.0 ? BW_CONFIG_SMALLEST
                            : BW_CONFIG_LARGEST,
            meaning);
  } else if (f->type == BW_CONFIG_TYPE_TEXT) {
    problem(w, id, "%s: must be a text of at most %d bytes, %d are given%s", path, (int)f->size - 1,
            (int)strlen(text), meaning);
  } else if (nearest != NULL) {
    problem(w, id, "%s = %s: must be %s; did you mean %s?%s", path, text, expected, nearest,
            meaning);
  } else {
    wrong(w, f, id, path);
  }
}

static void check_scalar(walk *w, const bw_config_field *f, int id, const char *path)
{
  const yaml_node_t *node = bw_core__config_node(w->source, id);
  const bool text = f->type == BW_CONFIG_TYPE_TEXT;
  /* A text of nothing at all is no text; "" in quotes is an empty one. */
  if (node->type != YAML_SCALAR_NODE ||
      (text && node->data.scalar.length == 0 && bw_core__config_is_null(w->source, id))) {
    wrong(w, f, id, path);
    return;
  }
  const char *value = (const char *)node->data.scalar.value;
  char *file = NULL;
  if ((f->range.bounds & BW_BOUND_FILE) && value[0] != '\0') {
    if (bw_core__config_file(w->source, id, value, &file) != BW_OK) {
      problem(w, id, "%s: %s", path, bw_last_message());
      return;
    }
    value = file;
  }
  /* What is accepted is written for libcyaml; every other way out is one line for the user. */
  if (file == NULL && strlen(value) != node->data.scalar.length)
    wrong(w, f, id, path); /* a 0 byte inside: "\0" of YAML */
  else if (!bw_core__config_accept(f, value, w->accepted))
    refuse(w, f, id, path, value);
  else if (text && value[0] == '\0' && (f->need & BW_REQUIRED))
    wrong(w, f, id, path);
  bw_release(&file);
}

/* A scalar, or a list of exactly as many as the array has. */
static void check_value(walk *w, const bw_config_field *f, int id, const char *path)
{
  const int length = bw_core__config_length(f);
  char item_path[BW_CONFIG_PATH], index[16];
  if (length == 1) {
    check_scalar(w, f, id, path);
    return;
  }
  /* x: [1, 2] for double x[3] is refused as a whole, for which element is missing cannot be
   * told. */
  if (bw_core__config_count(w->source, id) != length) {
    wrong(w, f, id, path);
    return;
  }
  fputc('[', w->accepted);
  for (int q = 0; q < length; q++) {
    snprintf(index, sizeof index, "%d", q);
    bw_core__config_join(path, index, item_path);
    check_scalar(w, f, bw_core__config_item(w->source, id, q), item_path);
    fputs(", ", w->accepted);
  }
  fputc(']', w->accepted);
}

/* Path of the field of that key anywhere in the table; false when there is none. */
static bool search_key(const bw_config_field fields[], const char *prefix, const char *key,
                       char path[BW_CONFIG_PATH])
{
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    char here[BW_CONFIG_PATH], item[BW_CONFIG_PATH];
    bw_core__config_join(prefix, f->key, here);
    /* The first one in the order of the table is as good a guess as any. */
    if (strcmp(f->key, key) == 0) {
      memcpy(path, here, sizeof here);
      return true;
    }
    /* Blocks of a list are named by the first one. */
    bw_core__config_join(here, "0", item);
    if (f->fields != NULL &&
        search_key(f->fields, f->type == BW_CONFIG_TYPE_LIST ? item : here, key, path))
      return true;
  }
  return false;
}

static void unknown_key(walk *w, const bw_config_field fields[], int id, const char *prefix,
                        const char *key)
{
  char path[BW_CONFIG_PATH], meant[BW_CONFIG_PATH];
  const char *nearest = NULL;
  int best = 64;
  bw_core__config_join(prefix, key, path);
  /* First guess: misspelt. Second: right, but in another block. */
  for (const bw_config_field *f = fields; f->key != NULL; f++)
    if (bw_core__near_miss(key, f->key, &best)) nearest = f->key;
  if (nearest != NULL) bw_core__config_join(prefix, nearest, meant);
  if (nearest != NULL || search_key(w->all, "", key, meant)) {
    problem(w, id, "%s: unknown key; did you mean %s?", path, meant);
    return;
  }
  /* No guess: the keys of this block are listed. */
  char known[EXPECTED] = "";
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    const size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "", f->key);
  }
  problem(w, id, "%s: unknown key; known here: %s", path, known);
}

/* Keys that the table does not have, and keys given twice. */
static void check_keys(walk *w, const bw_config_field fields[], int id, const char *prefix)
{
  const yaml_node_t *node = bw_core__config_node(w->source, id);
  if (node == NULL || node->type != YAML_MAPPING_NODE) return;
  for (const yaml_node_pair_t *p = node->data.mapping.pairs.start; p < node->data.mapping.pairs.top;
       p++) {
    const yaml_node_t *name = bw_core__config_node(w->source, p->key);
    if (name->type != YAML_SCALAR_NODE) {
      problem(w, p->key, "%s%sa key must be a word", prefix, prefix[0] != '\0' ? ": " : "");
      continue;
    }
    const char *key = (const char *)name->data.scalar.value;
    const bw_config_field *f = fields;
    int first = 0;
    while (f->key != NULL && strcmp(f->key, key) != 0)
      f++;
    /* The block `run` is the record of an earlier run: a run.yaml is a case file too. */
    if (f->key == NULL && !(prefix[0] == '\0' && strcmp(key, "run") == 0))
      unknown_key(w, fields, p->key, prefix, key);
    /* find gives the first of its name: any other is a second one, which YAML parsers take in
     * silence. */
    if (bw_core__config_find(w->source, id, key, &first) != 0 && first != p->key) {
      char path[BW_CONFIG_PATH], where[BW_CONFIG_PATH];
      bw_core__config_join(prefix, key, path);
      bw_core__config_where(w->source, first, sizeof where, where);
      problem(w, p->key, "%s: given twice, first at %s", path, where);
    }
  }
}

static void check_table(walk *w, const bw_config_field fields[], int id, int place,
                        const char *prefix, const char *defaults);

/* `id` 0: not given; `place` is the node to name then. */
static void check_map(walk *w, const bw_config_field *f, int id, int place, const char *path,
                      const char *defaults)
{
  const bool optional = f->flag != BW_CONFIG_NO_FLAG;
  bool given = true;
  /* A block that is not written is there if the defaults say so. */
  if (optional && id == 0) memcpy(&given, defaults + f->flag, sizeof given);
  if (!given || (optional && id != 0 && bw_core__config_is_none(w->source, id))) {
    /* Written as `none`: libcyaml gets an empty block, and copy sets the flag to false. */
    if (id != 0) fputs("{}", w->accepted);
    return;
  }
  if (id != 0 && !bw_core__config_is_null(w->source, id) &&
      bw_core__config_node(w->source, id)->type != YAML_MAPPING_NODE) {
    wrong(w, f, id, path);
    return;
  }
  /* Given or not, required values in the block must be there: a missing one is found even without
   * the block's own line. */
  check_table(w, f->fields, id, place, path, defaults + f->offset);
}

enum { ITEM = 64 };

/* How messages call an item: by its name where it has one, else by its number. */
static void item_name(const walk *w, const bw_config_field *f, int item, int q, char text[ITEM])
{
  const int id = bw_core__config_find(w->source, item, "name", NULL);
  const yaml_node_t *node = bw_core__config_node(w->source, id);
  if ((f->range.bounds & BW_BOUND_NAMED) && node != NULL && node->type == YAML_SCALAR_NODE)
    snprintf(text, ITEM, "%.60s", (const char *)node->data.scalar.value);
  else
    snprintf(text, ITEM, "%d", q);
}

/* Two items of one name could not be told apart. */
static void check_unique(walk *w, const bw_config_field *f, int id, int item, int q,
                         const char *path)
{
  char name[ITEM];
  item_name(w, f, item, q, name);
  if ((f->range.bounds & BW_BOUND_NAMED) && bw_core__config_named(w->source, id, name) < q &&
      bw_core__config_named(w->source, id, name) >= 0)
    problem(w, item, "%s: there is another item of that name; choose a new one", path);
}

static void check_list(walk *w, const bw_config_field *f, int id, const char *path,
                       const char *defaults)
{
  const int count = bw_core__config_count(w->source, id), most = (int)(f->size / f->item_size);
  char meaning[MEANING], item_path[BW_CONFIG_PATH], index[ITEM];
  bw_core__config_meaning(f, sizeof meaning, meaning);
  if (bw_core__config_node(w->source, id)->type != YAML_SEQUENCE_NODE &&
      !bw_core__config_is_null(w->source, id))
    wrong(w, f, id, path);
  else if (count == 0 && (f->need & BW_REQUIRED))
    problem(w, id, "%s: at least one item is needed%s", path, meaning);
  else if (count > most)
    problem(w, id, "%s: at most %d items, %d are given%s", path, most, count, meaning);
  else {
    /* Each item is a block with the same table, and with the defaults of item 0. */
    fputc('[', w->accepted);
    for (int q = 0; q < count; q++) {
      const int item = bw_core__config_item(w->source, id, q);
      const yaml_node_t *node = bw_core__config_node(w->source, item);
      item_name(w, f, item, q, index);
      bw_core__config_join(path, index, item_path);
      check_unique(w, f, id, item, q, item_path);
      if (node->type == YAML_MAPPING_NODE)
        check_table(w, f->fields, item, item, item_path, defaults + f->offset);
      else
        problem(w, item, "%s: must be a block of keys%s", item_path, meaning);
      fputs(", ", w->accepted);
    }
    fputc(']', w->accepted);
  }
}

static void missing(walk *w, const bw_config_field *f, int place, const char *path)
{
  char expected[EXPECTED], meaning[MEANING];
  bw_core__config_expected(f, sizeof expected, expected);
  bw_core__config_meaning(f, sizeof meaning, meaning);
  problem(w, place, "%s is missing: give %s%s", path, expected, meaning);
}

static void check_table(walk *w, const bw_config_field fields[], int id, int place,
                        const char *prefix, const char *defaults)
{
  /* What is there but unknown, then what is known and wrong or missing: one walk finds all. */
  check_keys(w, fields, id, prefix);
  if (id != 0) fputc('{', w->accepted);
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    char path[BW_CONFIG_PATH];
    int key = place;
    const int value = bw_core__config_find(w->source, id, f->key, &key);
    bw_core__config_join(prefix, f->key, path);
    /* What is accepted so far is plain YAML again, in the order of the table. */
    if (value != 0) fprintf(w->accepted, "\"%s\": ", f->key);
    if (f->type == BW_CONFIG_TYPE_MAP)
      check_map(w, f, value, key, path, defaults);
    else if (value == 0 && (f->need & BW_REQUIRED) && bw_core__config_unset(f, defaults))
      missing(w, f, place, path);
    else if (value != 0 && f->type == BW_CONFIG_TYPE_LIST)
      check_list(w, f, value, path, defaults);
    else if (value != 0)
      check_value(w, f, value, path);
    if (value != 0) fputs(", ", w->accepted);
  }
  if (id != 0) fputc('}', w->accepted);
}

/* The lines that fit into a message, and how many more there are. */
static bw_status report(const walk *w, char *lines)
{
  enum { ROOM = BW_MESSAGE_SIZE - 64 };
  int shown = 0;
  char more[48] = "";
  /* Cut at a whole line, with the number of those that follow. */
  if (strlen(lines) > ROOM) {
    lines[ROOM] = '\0';
    char *last = strrchr(lines, '\n');
    if (last != NULL) *last = '\0';
    for (const char *c = lines; c != NULL; c = strchr(c + 1, '\n'))
      shown++;
    snprintf(more, sizeof more, "\n(and %d more)", w->n_problems - shown);
  }
  return BW_FAIL(BW_EINPUT, "%s%s", lines, more);
}

bw_status bw_core__config_check(const bw_core__config_source *s, const bw_config_field fields[],
                                const void *defaults, char **accepted)
{
  walk w = {.source = s, .all = fields};
  char *lines = NULL;
  size_t n_lines = 0, n_accepted = 0;
  bw_status st = BW_OK;
  *accepted = NULL;
  w.problems = open_memstream(&lines, &n_lines);
  w.accepted = open_memstream(accepted, &n_accepted);
  const bool ok = w.problems != NULL && w.accepted != NULL;
  /* One walk writes both: the problems for the user and the accepted values for convert. */
  if (ok) check_table(&w, fields, s->root, 0, "", defaults);
  if (w.problems != NULL) fclose(w.problems);
  if (w.accepted != NULL) fclose(w.accepted);
  if (!ok)
    st = BW_FAIL(BW_EMEM, "no memory to check %s", s->name);
  else if (w.n_problems > 0)
    st = report(&w, lines);
  bw_release(&lines);
  if (st != BW_OK) bw_release(accepted);
  return st;
}
