/* Shorter ways to write a value, written out as the table wants them: named items, lists of one,
 * scalars for blocks, lists for texts, points with fewer numbers.
 *
 * Nodes of libyaml's document are only added; what is replaced stays behind, unused. A new node has
 * the place in the file of what it replaces, for messages. */
#include "config_internal.h"

#include "bw_memory.h"
#include <string.h>

static yaml_node_t *node_of(bw_core__config_source *s, int id)
{
  return yaml_document_get_node(&s->document, id);
}

/* New nodes; 0: no memory. */
static int new_scalar(bw_core__config_source *s, const char *text, int place)
{
  const int id = yaml_document_add_scalar(&s->document, NULL, (const unsigned char *)text,
                                          (int)strlen(text), YAML_PLAIN_SCALAR_STYLE);
  if (id != 0) node_of(s, id)->start_mark = node_of(s, place)->start_mark;
  return id;
}

static int new_sequence(bw_core__config_source *s, int place)
{
  const int id = yaml_document_add_sequence(&s->document, NULL, YAML_ANY_SEQUENCE_STYLE);
  if (id != 0) node_of(s, id)->start_mark = node_of(s, place)->start_mark;
  return id;
}

static int new_mapping(bw_core__config_source *s, int place)
{
  const int id = yaml_document_add_mapping(&s->document, NULL, YAML_ANY_MAPPING_STYLE);
  if (id != 0) node_of(s, id)->start_mark = node_of(s, place)->start_mark;
  return id;
}

static bw_status no_memory(const bw_core__config_source *s)
{
  return BW_FAIL(BW_EMEM, "no memory to read %s", s->name);
}

static bool append_pair(bw_core__config_source *s, int id, int key, int value)
{
  return id != 0 && key != 0 && value != 0 &&
         yaml_document_append_mapping_pair(&s->document, id, key, value) != 0;
}

static bool append_item(bw_core__config_source *s, int id, int item)
{
  return id != 0 && item != 0 && yaml_document_append_sequence_item(&s->document, id, item) != 0;
}

/* A value that is a block, with `name` in front: another block, as a block may be used twice. */
static int named_item(bw_core__config_source *s, int key, int value)
{
  const int item = new_mapping(s, key), name = new_scalar(s, "name", key);
  if (!append_pair(s, item, name, key)) return 0;
  if (bw_core__config_is_null(s, value)) return item;
  /* Anything but a block is kept under a key that no table has, to be refused with its line. */
  if (node_of(s, value)->type != YAML_MAPPING_NODE)
    return append_pair(s, item, new_scalar(s, "(a block of keys is needed)", value), value) ? item
                                                                                            : 0;
  const ptrdiff_t pairs =
      node_of(s, value)->data.mapping.pairs.top - node_of(s, value)->data.mapping.pairs.start;
  for (ptrdiff_t q = 0; q < pairs; q++) {
    const yaml_node_pair_t pair = node_of(s, value)->data.mapping.pairs.start[q];
    if (!append_pair(s, item, pair.key, pair.value)) return 0;
  }
  return item;
}

/* NAME: {keys}, ... as a list of blocks. */
static int named_list(bw_core__config_source *s, int id)
{
  const int list = new_sequence(s, id);
  const ptrdiff_t pairs =
      node_of(s, id)->data.mapping.pairs.top - node_of(s, id)->data.mapping.pairs.start;
  for (ptrdiff_t q = 0; list != 0 && q < pairs; q++) {
    const yaml_node_pair_t pair = node_of(s, id)->data.mapping.pairs.start[q];
    if (!append_item(s, list, named_item(s, pair.key, pair.value))) return 0;
  }
  return list;
}

/* {keys} as a list of that block. */
static int list_of_one(bw_core__config_source *s, int id)
{
  const int list = new_sequence(s, id);
  return append_item(s, list, id) ? list : 0;
}

/* VALUE as {FIRST KEY: VALUE}. */
static int block_of_one(bw_core__config_source *s, const bw_config_field *f, int id)
{
  const int block = new_mapping(s, id);
  return append_pair(s, block, new_scalar(s, f->fields[0].key, id), id) ? block : 0;
}

/* [a, b] as "a b"; the list itself where an item is no scalar, for a message. */
static int joined_texts(bw_core__config_source *s, int id)
{
  char *text = NULL;
  size_t length = 0;
  bool scalars = true;
  FILE *out = open_memstream(&text, &length);
  if (out == NULL) return 0;
  for (int q = 0; q < bw_core__config_count(s, id); q++) {
    const yaml_node_t *item = bw_core__config_node(s, bw_core__config_item(s, id, q));
    scalars = scalars && item->type == YAML_SCALAR_NODE;
    if (scalars) fprintf(out, "%s%s", q > 0 ? " " : "", (const char *)item->data.scalar.value);
  }
  const bool written = fclose(out) == 0;
  const int joined = !written ? 0 : scalars ? new_scalar(s, text, id) : id;
  bw_release(&text);
  return joined;
}

/* x or [x, y] with zeros up to the length of the array. */
static int whole_point(bw_core__config_source *s, const bw_config_field *f, int id)
{
  const int length = bw_core__config_length(f), list = new_sequence(s, id);
  const bool one = node_of(s, id)->type == YAML_SCALAR_NODE;
  const int count = one ? 1 : bw_core__config_count(s, id);
  for (int q = 0; list != 0 && q < length; q++) {
    const int item = q >= count ? new_scalar(s, "0", id)
                     : one      ? id
                                : bw_core__config_item(s, id, q);
    if (!append_item(s, list, item)) return 0;
  }
  return list;
}

/* What the value of a field becomes; itself where nothing is short, 0: no memory. */
static int written_out(bw_core__config_source *s, const bw_config_field *f, int id)
{
  const yaml_node_type_t type = bw_core__config_node(s, id)->type;
  const int bounds = f->range.bounds, count = bw_core__config_count(s, id);
  const bool plain = type == YAML_SCALAR_NODE && !bw_core__config_is_null(s, id);
  if (f->type == BW_CONFIG_TYPE_LIST && type == YAML_MAPPING_NODE)
    return bounds & BW_BOUND_NAMED ? named_list(s, id) : list_of_one(s, id);
  if (bounds & BW_BOUND_BRIEF && plain && !bw_core__config_is_none(s, id))
    return block_of_one(s, f, id);
  if (bounds & BW_BOUND_TEXTS && type == YAML_SEQUENCE_NODE) return joined_texts(s, id);
  if (bounds & BW_BOUND_POINT && (plain || (count > 0 && count < bw_core__config_length(f))))
    return whole_point(s, f, id);
  return id;
}

static bw_status expand_block(bw_core__config_source *s, const bw_config_field fields[], int id,
                              int depth);

/* What lies inside of a value that is written out. */
static bw_status expand_inside(bw_core__config_source *s, const bw_config_field *f, int id,
                               int depth)
{
  if (f->type == BW_CONFIG_TYPE_MAP) return expand_block(s, f->fields, id, depth + 1);
  for (int q = 0; f->type == BW_CONFIG_TYPE_LIST && q < bw_core__config_count(s, id); q++)
    BW_TRY(expand_block(s, f->fields, bw_core__config_item(s, id, q), depth + 1));
  return BW_OK;
}

static bw_status expand_block(bw_core__config_source *s, const bw_config_field fields[], int id,
                              int depth)
{
  const yaml_node_t *node = bw_core__config_node(s, id);
  /* An alias of YAML may lead back to itself: depth is bounded. */
  if (node == NULL || node->type != YAML_MAPPING_NODE || depth > BW_CONFIG_DEPTH) return BW_OK;
  for (ptrdiff_t q = 0; q < node->data.mapping.pairs.top - node->data.mapping.pairs.start; q++) {
    const yaml_node_pair_t pair = node->data.mapping.pairs.start[q];
    const yaml_node_t *key = bw_core__config_node(s, pair.key);
    const bw_config_field *f = fields;
    while (f->key != NULL && (key->type != YAML_SCALAR_NODE ||
                              strcmp(f->key, (const char *)key->data.scalar.value) != 0))
      f++;
    if (f->key == NULL) continue; /* check says so */
    const int value = written_out(s, f, pair.value);
    if (value == 0) return no_memory(s);
    node_of(s, id)->data.mapping.pairs.start[q].value = value;
    BW_TRY(expand_inside(s, f, value, depth));
    /* Looked up anew: adding nodes may have moved all of them. */
    node = bw_core__config_node(s, id);
  }
  return BW_OK;
}

bw_status bw_core__config_expand(bw_core__config_source *s, const bw_config_field fields[])
{
  return expand_block(s, fields, s->root, 0);
}
