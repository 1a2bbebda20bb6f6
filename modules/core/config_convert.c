/* libcyaml: a schema made from the table, the struct loaded with it, the given members copied. */
#include "config_internal.h"

#include "bw_memory.h"
#include <cyaml/cyaml.h>
#include <string.h>

/* What the schema is made of; freed together. */
enum { POOL = 1024 };
typedef struct {
  void *blocks[POOL];
  int n;
} pool;

static bw_status pool_take(pool *p, size_t count, size_t size, void *out)
{
  BW_REQUIRE(p->n < POOL, BW_EINPUT, "a configuration of more than %d blocks and lists", POOL);
  BW_TRY(bw_allocate(count, size, out));
  memcpy(&p->blocks[p->n++], out, sizeof(void *));
  return BW_OK;
}

static void pool_free(pool *p)
{
  while (p->n > 0)
    bw_release(&p->blocks[--p->n]);
}

static bw_status make_words(pool *p, const bw_config_field *f, cyaml_schema_value_t *value)
{
  uint32_t n = 0;
  cyaml_strval_t *strings = NULL;
  while (f->words[n].word != NULL)
    n++;
  /* libcyaml has its own list of words and numbers: it lives as long as the schema. */
  BW_TRY(pool_take(p, n, sizeof *strings, &strings));
  for (uint32_t q = 0; q < n; q++)
    strings[q] = (cyaml_strval_t){.str = f->words[q].word, .val = f->words[q].value};
  value->enumeration.strings = strings;
  value->enumeration.count = n;
  return BW_OK;
}

static bw_status make_fields(pool *p, const bw_config_field fields[],
                             const cyaml_schema_field_t **out);

/* One element of the member: a scalar, or the block of a map or of a list's items. */
static bw_status make_element(pool *p, const bw_config_field *f, cyaml_schema_value_t *value)
{
  static const cyaml_type_e types[] = {
      [BW_CONFIG_TYPE_DOUBLE] = CYAML_FLOAT, [BW_CONFIG_TYPE_INT] = CYAML_INT,
      [BW_CONFIG_TYPE_BOOL] = CYAML_BOOL,    [BW_CONFIG_TYPE_TEXT] = CYAML_STRING,
      [BW_CONFIG_TYPE_WORD] = CYAML_ENUM,    [BW_CONFIG_TYPE_MAP] = CYAML_MAPPING,
      [BW_CONFIG_TYPE_LIST] = CYAML_MAPPING};
  /* An element lies in the struct itself: no flag of a pointer. */
  value->type = types[f->type];
  value->flags = CYAML_FLAG_DEFAULT;
  value->data_size = (uint32_t)f->item_size;
  /* What a type needs beside its size; a block leads back to make_fields, as deep as the table
   * is. */
  if (value->type == CYAML_STRING) value->string.max = (uint32_t)f->size - 1;
  if (value->type == CYAML_ENUM) BW_TRY(make_words(p, f, value));
  if (value->type == CYAML_MAPPING) BW_TRY(make_fields(p, f->fields, &value->mapping.fields));
  return BW_OK;
}

static bw_status make_field(pool *p, const bw_config_field *f, cyaml_schema_field_t *field)
{
  const bool list = f->type == BW_CONFIG_TYPE_LIST;
  const uint32_t length =
      list ? (uint32_t)(f->size / f->item_size) : (uint32_t)bw_core__config_length(f);
  cyaml_schema_value_t *element = &field->value;
  field->key = f->key;
  field->data_offset = (uint32_t)f->offset;
  /* An array is a sequence with an entry of its own; a scalar is its own element. */
  if (list || length > 1) {
    BW_TRY(pool_take(p, 1, sizeof *element, &element));
    field->value.type = list ? CYAML_SEQUENCE : CYAML_SEQUENCE_FIXED;
    field->value.data_size = (uint32_t)f->item_size;
    field->value.sequence.entry = element;
    field->value.sequence.min = list ? 0 : length;
    field->value.sequence.max = length;
  }
  if (list) {
    field->count_offset = (uint32_t)f->flag;
    field->count_size = sizeof(int);
  }
  /* Type, size and what is inside belong to the element. */
  BW_TRY(make_element(p, f, element));
  field->value.flags = CYAML_FLAG_OPTIONAL; /* what is missing was found by check */
  return BW_OK;
}

static bw_status make_fields(pool *p, const bw_config_field fields[],
                             const cyaml_schema_field_t **out)
{
  size_t n = 0;
  cyaml_schema_field_t *made = NULL;
  while (fields[n].key != NULL)
    n++;
  /* One row more, which stays zero and ends the list. */
  BW_TRY(pool_take(p, n + 1, sizeof *made, &made));
  for (size_t q = 0; q < n; q++)
    BW_TRY(make_field(p, &fields[q], &made[q]));
  *out = made;
  return BW_OK;
}

bw_status bw_core__config_convert(const char *accepted, const bw_config_field fields[], size_t size,
                                  void **out)
{
  static const cyaml_config_t settings = {.log_fn = NULL, .mem_fn = cyaml_mem};
  pool p = {.n = 0};
  cyaml_schema_value_t top = {
      .type = CYAML_MAPPING, .flags = CYAML_FLAG_POINTER, .data_size = (uint32_t)size};
  void *loaded = NULL;
  /* libcyaml wants the shape of the struct as a tree of its own: built here, thrown away below. */
  bw_status st = bw_allocate(size, 1, out);
  BW_THEN(st, make_fields(&p, fields, &top.mapping.fields));
  if (st == BW_OK) {
    const cyaml_err_t code = cyaml_load_data((const uint8_t *)accepted, strlen(accepted), &settings,
                                             &top, &loaded, NULL);
    if (code == CYAML_OK)
      memcpy(*out, loaded, size);
    else
      st = BW_FAIL(BW_EINPUT, "the configuration passed the checks, but libcyaml says: %s",
                   cyaml_strerror(code));
  }
  /* The struct holds no pointers: its bytes are copied, libcyaml's own memory can go. */
  if (loaded != NULL) cyaml_free(&settings, &top, loaded, 0);
  pool_free(&p);
  if (st != BW_OK) bw_release(out);
  return st;
}

static void copy_list(const bw_core__config_source *s, const bw_config_field *f, int id,
                      const char *from, char *to, int *count)
{
  *count = bw_core__config_count(s, id);
  for (int q = *count - 1; q >= 0; q--) { /* item 0 holds the defaults of all until its turn */
    const size_t at = f->offset + (size_t)q * f->item_size;
    if (q > 0) memcpy(to + at, to + f->offset, f->item_size);
    bw_core__config_copy(s, f->fields, bw_core__config_item(s, id, q), from + at, to + at);
  }
}

void bw_core__config_copy(const bw_core__config_source *s, const bw_config_field fields[], int id,
                          const void *from, void *to)
{
  const char *source = from;
  char *target = to;
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    const int value = bw_core__config_find(s, id, f->key, NULL);
    /* Not in the document: the default stays. libcyaml has 0 there, which nobody asked for. */
    if (value == 0) continue;
    if (f->type == BW_CONFIG_TYPE_MAP) {
      const bool given = !bw_core__config_is_none(s, value);
      if (f->flag != BW_CONFIG_NO_FLAG) memcpy(target + f->flag, &given, sizeof given);
      if (given) bw_core__config_copy(s, f->fields, value, source + f->offset, target + f->offset);
    } else if (f->type == BW_CONFIG_TYPE_LIST) {
      int count = 0;
      copy_list(s, f, value, source, target, &count);
      memcpy(target + f->flag, &count, sizeof count);
    } else {
      memcpy(target + f->offset, source + f->offset, f->size);
    }
  }
}
