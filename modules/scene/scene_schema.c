/* The keys of a scene as a JSON schema (draft 2020-12), from the table that reads them. */
#include "scene_internal.h"

#include <string.h>

static void put_text(FILE *out, const char *text)
{
  fputc('"', out);
  for (; *text != '\0'; text++)
    fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
  fputc('"', out);
}

static void put_range(FILE *out, const bw_config_range *r)
{
  if (r->bounds & BW_BOUND_MIN) fprintf(out, ",\"minimum\":%.17g", r->low);
  if (r->bounds & BW_BOUND_ABOVE) fprintf(out, ",\"exclusiveMinimum\":%.17g", r->low);
  if (r->bounds & BW_BOUND_MAX) fprintf(out, ",\"maximum\":%.17g", r->high);
  if (r->bounds & BW_BOUND_BELOW) fprintf(out, ",\"exclusiveMaximum\":%.17g", r->high);
}

/* One element of a value. */
static void put_element(FILE *out, const bw_config_field *f)
{
  static const char *const types[] = {[BW_CONFIG_TYPE_DOUBLE] = "\"number\"",
                                      [BW_CONFIG_TYPE_INT] = "\"integer\"",
                                      [BW_CONFIG_TYPE_BOOL] = "\"boolean\"",
                                      [BW_CONFIG_TYPE_TEXT] = "[\"string\",\"number\"]"};
  if (f->type != BW_CONFIG_TYPE_WORD) {
    fprintf(out, "{\"type\":%s", types[f->type]);
    put_range(out, &f->range);
    fputc('}', out);
    return;
  }
  fputs("{\"enum\":[", out);
  for (const bw_config_word *w = f->words; w->word != NULL; w++) {
    /* YAML reads these two as booleans. */
    const bool truth = strcmp(w->word, "true") == 0 || strcmp(w->word, "false") == 0;
    if (w != f->words) fputc(',', out);
    truth ? (void)fputs(w->word, out) : put_text(out, w->word);
  }
  fputs("]}", out);
}

/* A value: an element, or as many as the array has; shorter ways where the table allows them. */
static void put_value(FILE *out, const bw_config_field *f)
{
  const size_t length = f->type == BW_CONFIG_TYPE_TEXT ? 1 : f->size / f->item_size;
  const bool point = f->range.bounds & BW_BOUND_POINT, texts = f->range.bounds & BW_BOUND_TEXTS;
  if (length == 1 && !texts) {
    put_element(out, f);
    return;
  }
  if (point || texts) {
    fputs("{\"anyOf\":[", out);
    put_element(out, f);
    fputc(',', out);
  }
  fputs("{\"type\":\"array\",\"items\":", out);
  put_element(out, f);
  if (!texts) fprintf(out, ",\"minItems\":%zu,\"maxItems\":%zu", point ? 1 : length, length);
  fputc('}', out);
  if (point || texts) fputs("]}", out);
}

static void put_table(FILE *out, const bw_config_field fields[], bool named);

static void put_list(FILE *out, const bw_config_field *f)
{
  const bool named = f->range.bounds & BW_BOUND_NAMED;
  fputs("{\"anyOf\":[{\"type\":\"array\",\"items\":", out);
  put_table(out, f->fields, false);
  fprintf(out, ",\"maxItems\":%zu},", f->size / f->item_size);
  /* By names, or one block in place of a list of one. */
  if (named) fputs("{\"type\":\"object\",\"additionalProperties\":", out);
  put_table(out, f->fields, named);
  if (named) fputc('}', out);
  fputs("]}", out);
}

static void put_map(FILE *out, const bw_config_field *f)
{
  const bool brief = f->range.bounds & BW_BOUND_BRIEF;
  if (brief) {
    fputs("{\"anyOf\":[", out);
    put_value(out, &f->fields[0]);
    fputc(',', out);
  }
  put_table(out, f->fields, false);
  if (brief) fputs("]}", out);
}

/* named: the name stands before the block, not in it. */
static void put_table(FILE *out, const bw_config_field fields[], bool named)
{
  bool first = true;
  fputs("{\"type\":\"object\",\"additionalProperties\":false,\"properties\":{", out);
  /* One property per key; its help stands beside what may be written there. */
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    if (named && strcmp(f->key, "name") == 0) continue;
    if (!first) fputs(",\n", out);
    first = false;
    put_text(out, f->key);
    fputs(":{\"description\":", out);
    put_text(out, f->help);
    fputs(",\"allOf\":[", out);
    if (f->type == BW_CONFIG_TYPE_LIST)
      put_list(out, f);
    else if (f->type == BW_CONFIG_TYPE_MAP)
      put_map(out, f);
    else
      put_value(out, f);
    fputs("]}", out);
  }
  /* The keys that have to be given. */
  fputs("},\"required\":[", out);
  first = true;
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    if (!(f->need & BW_REQUIRED) || (named && strcmp(f->key, "name") == 0)) continue;
    if (!first) fputc(',', out);
    first = false;
    put_text(out, f->key);
  }
  fputs("]}", out);
}

void bw_scene_schema(FILE *out)
{
  fputs("{\"$schema\":\"https://json-schema.org/draft/2020-12/schema\",\"title\":\"Breakwater "
        "scene\",\"allOf\":[",
        out);
  put_table(out, bw_scene_fields, false);
  fputs("]}\n", out);
}
