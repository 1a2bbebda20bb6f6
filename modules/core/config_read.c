/* The file as libyaml's document, and the overrides put into it. */
#include "config_internal.h"

#include "bw_memory.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const yaml_node_t *bw_core__config_node(const bw_core__config_source *s, int id)
{
  const yaml_document_t *d = &s->document;
  return id > 0 && d->nodes.start + id <= d->nodes.top ? d->nodes.start + id - 1 : NULL;
}

static yaml_node_t *node_of(bw_core__config_source *s, int id)
{
  return yaml_document_get_node(&s->document, id);
}

static const char *scalar_of(const yaml_node_t *node)
{
  return node != NULL && node->type == YAML_SCALAR_NODE ? (const char *)node->data.scalar.value
                                                        : NULL;
}

/* Which pair of a block has this key; -1 when none has, or `id` is no block. */
static int pair_index(const bw_core__config_source *s, int id, const char *key)
{
  const yaml_node_t *node = bw_core__config_node(s, id);
  if (node == NULL || node->type != YAML_MAPPING_NODE) return -1;
  const yaml_node_pair_t *pairs = node->data.mapping.pairs.start;
  for (int q = 0; pairs + q < node->data.mapping.pairs.top; q++) {
    const char *name = scalar_of(bw_core__config_node(s, pairs[q].key));
    if (name != NULL && strcmp(name, key) == 0) return q;
  }
  return -1;
}

int bw_core__config_find(const bw_core__config_source *s, int id, const char *key, int *key_id)
{
  const int q = pair_index(s, id, key);
  if (q < 0) return 0;
  const yaml_node_pair_t *pair = bw_core__config_node(s, id)->data.mapping.pairs.start + q;
  if (key_id != NULL) *key_id = pair->key;
  return pair->value;
}

int bw_core__config_count(const bw_core__config_source *s, int id)
{
  const yaml_node_t *node = bw_core__config_node(s, id);
  if (node == NULL || node->type != YAML_SEQUENCE_NODE) return 0;
  return (int)(node->data.sequence.items.top - node->data.sequence.items.start);
}

int bw_core__config_item(const bw_core__config_source *s, int id, int item)
{
  return bw_core__config_node(s, id)->data.sequence.items.start[item];
}

int bw_core__config_named(const bw_core__config_source *s, int id, const char *name)
{
  for (int q = 0; q < bw_core__config_count(s, id); q++) {
    const int given = bw_core__config_find(s, bw_core__config_item(s, id, q), "name", NULL);
    const char *text = scalar_of(bw_core__config_node(s, given));
    if (text != NULL && strcmp(text, name) == 0) return q;
  }
  return -1;
}

static bool is_plain_word(const bw_core__config_source *s, int id, const char *const words[])
{
  const yaml_node_t *node = bw_core__config_node(s, id);
  const char *text = scalar_of(node);
  if (text == NULL || node->data.scalar.style != YAML_PLAIN_SCALAR_STYLE) return false;
  for (int q = 0; words[q] != NULL; q++)
    if (strcasecmp(text, words[q]) == 0) return true;
  return false;
}

bool bw_core__config_is_null(const bw_core__config_source *s, int id)
{
  static const char *const words[] = {"", "~", "null", NULL};
  return is_plain_word(s, id, words);
}

bool bw_core__config_is_none(const bw_core__config_source *s, int id)
{
  static const char *const words[] = {"none", NULL};
  return is_plain_word(s, id, words);
}

int bw_core__config_override(const bw_core__config_source *s, int id)
{
  int override = s->n_overrides - 1;
  /* Nodes are numbered in the order in which they were made: those of the file first, then those of
   * each override. */
  while (override >= 0 && (s->first_node[override] == 0 || id < s->first_node[override]))
    override--;
  return override;
}

void bw_core__config_where(const bw_core__config_source *s, int id, size_t size, char *text)
{
  const int override = bw_core__config_override(s, id);
  const yaml_node_t *node = bw_core__config_node(s, id);
  if (node == NULL)
    snprintf(text, size, "%s", s->name);
  else if (override >= 0)
    snprintf(text, size, "--set %s", s->overrides[override]);
  else
    snprintf(text, size, "%s:%zu", s->name, node->start_mark.line + 1);
}

static bw_status not_yaml(const char *name, const char *text, const yaml_parser_t *parser)
{
  const char *context = parser->context != NULL ? parser->context : "";
  size_t line = parser->problem_mark.line + 1;
  /* What the reader of bytes refuses has a place among them, no line. */
  for (size_t q = 0; parser->error == YAML_READER_ERROR && q < parser->problem_offset; q++)
    line += text[q] == '\n';
  return BW_FAIL(BW_EINPUT, "%s:%zu: not YAML: %s%s%s", name, line,
                 parser->problem != NULL ? parser->problem : "cannot be parsed",
                 context[0] != '\0' ? " " : "", context);
}

/* One document; an empty text gives an empty scalar. */
static bw_status parse(const char *name, const char *text, size_t bytes, yaml_document_t *document)
{
  yaml_parser_t parser;
  yaml_document_t second;
  bw_status st = BW_OK;
  BW_TRY(bw_core__config_encoding(name, text, bytes));
  BW_REQUIRE(yaml_parser_initialize(&parser), BW_EMEM, "no memory to read %s", name);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, bytes);
  /* A failed load leaves no document to be deleted. */
  if (!yaml_parser_load(&parser, document)) {
    st = not_yaml(name, text, &parser);
    yaml_parser_delete(&parser);
    return st;
  }
  /* A second document would be overlooked in silence: it is looked for and refused. */
  if (!yaml_parser_load(&parser, &second)) {
    st = not_yaml(name, text, &parser);
  } else {
    const yaml_node_t *root = yaml_document_get_root_node(&second);
    if (root != NULL)
      st = BW_FAIL(BW_EINPUT, "%s:%zu: a second YAML document begins: keep one in the file", name,
                   root->start_mark.line + 1);
    yaml_document_delete(&second);
  }
  yaml_parser_delete(&parser);
  if (st != BW_OK) yaml_document_delete(document);
  return st;
}

static int add_scalar(yaml_document_t *d, const char *text, size_t length,
                      yaml_scalar_style_t style)
{
  return yaml_document_add_scalar(d, NULL, (const unsigned char *)text, (int)length, style);
}

/* A copy of a node of another document; 0 when there is no memory or it is too deep. */
static int copy_node(yaml_document_t *to, yaml_document_t *from, int id, int depth)
{
  const yaml_node_t *node = yaml_document_get_node(from, id);
  int copy = 0;
  /* An alias of YAML may lead back to itself: depth is bounded. */
  if (node == NULL || depth > BW_CONFIG_DEPTH) return 0;
  if (node->type == YAML_SCALAR_NODE)
    return add_scalar(to, (const char *)node->data.scalar.value, node->data.scalar.length,
                      node->data.scalar.style);
  if (node->type == YAML_SEQUENCE_NODE) {
    copy = yaml_document_add_sequence(to, NULL, YAML_FLOW_SEQUENCE_STYLE);
    for (const yaml_node_item_t *i = node->data.sequence.items.start;
         copy != 0 && i < node->data.sequence.items.top; i++)
      if (!yaml_document_append_sequence_item(to, copy, copy_node(to, from, *i, depth + 1)))
        return 0;
    return copy;
  }
  copy = yaml_document_add_mapping(to, NULL, YAML_FLOW_MAPPING_STYLE);
  for (const yaml_node_pair_t *p = node->data.mapping.pairs.start;
       copy != 0 && p < node->data.mapping.pairs.top; p++)
    if (!yaml_document_append_mapping_pair(to, copy, copy_node(to, from, p->key, depth + 1),
                                           copy_node(to, from, p->value, depth + 1)))
      return 0;
  return copy;
}

/* The value of an override as a node of the document. */
static bw_status add_value(bw_core__config_source *s, const char *override, const char *text,
                           int *id)
{
  char name[BW_CONFIG_PATH];
  yaml_document_t value;
  snprintf(name, sizeof name, "--set %.200s", override);
  /* "key=" is an empty text, not the absence of a value. */
  if (text[0] == '\0') {
    *id = add_scalar(&s->document, "", 0, YAML_DOUBLE_QUOTED_SCALAR_STYLE);
  } else {
    /* Any YAML is a value, as it would be in the file. */
    BW_TRY(parse(name, text, strlen(text), &value));
    *id = yaml_document_get_root_node(&value) == NULL
              ? add_scalar(&s->document, "", 0, YAML_PLAIN_SCALAR_STYLE)
              : copy_node(&s->document, &value, 1, 0);
    yaml_document_delete(&value);
  }
  BW_REQUIRE(*id != 0, BW_EMEM, "%s: no memory, or too deeply nested", name);
  return BW_OK;
}

/* List index of a path segment: -1 when it is no number. */
static int index_of(const char *segment, size_t length)
{
  if (length == 0 || length > 6 || strspn(segment, "0123456789") < length) return -1;
  return atoi(segment);
}

/* Where the value of a segment below `id` is kept; made (with value 0) when it is not there. */
static bw_status slot(bw_core__config_source *s, const char *override, int id, const char *segment,
                      size_t length, int **value)
{
  char key[BW_CONFIG_PATH];
  snprintf(key, sizeof key, "%.*s", (int)length, segment);
  const int before = (int)(segment - override) - 1;
  BW_REQUIRE(length > 0, BW_EINPUT, "--set %s: empty key in the path", override);
  /* Below a list the segment is an index; one behind the last adds an item. */
  if (node_of(s, id)->type == YAML_SEQUENCE_NODE) {
    const int number = index_of(segment, length), count = bw_core__config_count(s, id);
    const int index = number >= 0 ? number : bw_core__config_named(s, id, key);
    BW_REQUIRE(
        index >= 0 && index <= count, BW_EINPUT,
        "--set %s: %.*s is a list of %d items: '%s' must be a number from 0 to %d, or the name of "
        "an item",
        override, before, override, count, key, count);
    if (index == count) {
      const int empty = add_scalar(&s->document, "", 0, YAML_PLAIN_SCALAR_STYLE);
      BW_REQUIRE(empty != 0 && yaml_document_append_sequence_item(&s->document, id, empty), BW_EMEM,
                 "--set %s: no memory", override);
    }
    *value = node_of(s, id)->data.sequence.items.start + index;
    return BW_OK;
  }
  /* Below a block it is a key; a scalar has nothing below it. */
  BW_REQUIRE(node_of(s, id)->type == YAML_MAPPING_NODE, BW_EINPUT,
             "--set %s: %.*s is a value, it has no key '%s'", override, before, override, key);
  /* The file does not have the key: it is added, and check decides whether the table knows it. */
  if (pair_index(s, id, key) < 0) {
    const int name = add_scalar(&s->document, key, strlen(key), YAML_PLAIN_SCALAR_STYLE);
    const int empty = add_scalar(&s->document, "", 0, YAML_PLAIN_SCALAR_STYLE);
    BW_REQUIRE(name != 0 && empty != 0 &&
                   yaml_document_append_mapping_pair(&s->document, id, name, empty),
               BW_EMEM, "--set %s: no memory", override);
  }
  /* Looked up anew: adding nodes may have moved all of them. */
  *value = &node_of(s, id)->data.mapping.pairs.start[pair_index(s, id, key)].value;
  return BW_OK;
}

/* A place that the path goes through but the file does not have becomes a block or a list. */
static bw_status open_slot(bw_core__config_source *s, const char *override, const char *next,
                           int **value)
{
  if (!bw_core__config_is_null(s, **value) && !bw_core__config_is_none(s, **value)) return BW_OK;
  /* The next segment tells what is missing: a number asks for a list, a word for a block. */
  const int made = index_of(next, strcspn(next, ".=")) >= 0
                       ? yaml_document_add_sequence(&s->document, NULL, YAML_ANY_SEQUENCE_STYLE)
                       : yaml_document_add_mapping(&s->document, NULL, YAML_ANY_MAPPING_STYLE);
  BW_REQUIRE(made != 0, BW_EMEM, "--set %s: no memory", override);
  **value = made; /* the slot is in the parent's own array: it stays where it is */
  return BW_OK;
}

static bw_status apply(bw_core__config_source *s, const char *override)
{
  const char *segment = override, *equals = strchr(override, '=');
  int id = s->root, *value = NULL, given = 0;
  BW_REQUIRE(equals != NULL && equals > override, BW_EINPUT,
             "--set %s: write it as --set key.path=value", override);
  /* The value's own nodes are made first; what the path needs on its way follows. */
  BW_TRY(add_value(s, override, equals + 1, &given));
  for (;;) {
    /* One segment of the path each time round, as long as dots follow. */
    const size_t length = strcspn(segment, ".=");
    BW_TRY(slot(s, override, id, segment, length, &value));
    segment += length;
    if (segment == equals) break;
    segment++;
    BW_TRY(open_slot(s, override, segment, &value));
    id = *value;
  }
  *value = given;
  return BW_OK;
}

bw_status bw_core__config_read(const char *name, const char *text, size_t bytes,
                               const bw_config_field fields[], int n_overrides,
                               const char *const overrides[], bw_core__config_source *s)
{
  *s = (bw_core__config_source){.name = name};
  BW_TRY(BW_ALLOCATE(&s->first_node, (size_t)n_overrides));
  BW_TRY(parse(name, text, bytes, &s->document));
  /* An empty file is an empty block: all values come from the defaults and the overrides. */
  if (yaml_document_get_root_node(&s->document) == NULL) {
    yaml_document_delete(&s->document);
    BW_REQUIRE(yaml_document_initialize(&s->document, NULL, NULL, NULL, 1, 1), BW_EMEM,
               "no memory to read %s", name);
    s->root = yaml_document_add_mapping(&s->document, NULL, YAML_ANY_MAPPING_STYLE);
  } else {
    s->root = 1;
  }
  BW_REQUIRE(s->root != 0 && node_of(s, s->root)->type == YAML_MAPPING_NODE, BW_EINPUT,
             "%s: the file must hold 'key: value' lines", name);
  /* Once for the file, so that overrides find its items; once for what they brought. */
  BW_TRY(bw_core__config_expand(s, fields));
  s->overrides = overrides;
  for (s->n_overrides = 0; s->n_overrides < n_overrides; s->n_overrides++) {
    /* From this number on nodes belong to the override that is applied now. */
    s->first_node[s->n_overrides] = (int)(s->document.nodes.top - s->document.nodes.start) + 1;
    BW_TRY(apply(s, overrides[s->n_overrides]));
  }
  if (n_overrides > 0) BW_TRY(bw_core__config_expand(s, fields));
  return BW_OK;
}

void bw_core__config_free(bw_core__config_source *s)
{
  if (s->root != 0) yaml_document_delete(&s->document);
  bw_release(&s->first_node);
}
