/* The struct as YAML, and the list of keys for --help. */
#include "config_internal.h"

#include <string.h>

static void put_item(FILE *out, const bw_config_field *f, const char *at)
{
  char number[BW_NUMBER_SIZE];
  double x;
  int i;
  bool b;
  /* The struct is raw memory at the field's offset; each type is copied out by its own size. */
  switch (f->type) {
  case BW_CONFIG_TYPE_DOUBLE:
    memcpy(&x, at, sizeof x);
    bw_core__format_double(x, number);
    fputs(number, out);
    break;
  case BW_CONFIG_TYPE_INT:
    memcpy(&i, at, sizeof i);
    fprintf(out, "%d", i);
    break;
  case BW_CONFIG_TYPE_BOOL:
    memcpy(&b, at, sizeof b);
    fputs(b ? "true" : "false", out);
    break;
  case BW_CONFIG_TYPE_WORD:
    memcpy(&i, at, sizeof i);
    /* The file has the word, the struct its number. */
    for (const bw_config_word *w = f->words; w->word != NULL; w++)
      if (w->value == i) {
        fputs(w->word, out);
        break;
      }
    break;
  default:
    bw_core__put_quoted(out, at);
  }
}

void bw_core__config_put_value(FILE *out, const bw_config_field *f, const char *at)
{
  const int length = bw_core__config_length(f);
  if (length > 1) fputc('[', out);
  for (int q = 0; q < length; q++) {
    if (q > 0) fputs(", ", out);
    put_item(out, f, at + (size_t)q * f->item_size);
  }
  if (length > 1) fputc(']', out);
}

static bool any_set(const bw_config_field fields[], const char *at)
{
  for (const bw_config_field *f = fields; f->key != NULL; f++)
    if (f->type >= BW_CONFIG_TYPE_MAP || !bw_core__config_unset(f, at)) return true;
  return false;
}

/* Block style, two columns per level; `first` is what stands before the first key ("- " in a
 * list item) in place of the indent. */
static void put_table(FILE *out, const bw_config_field fields[], const char *at, int indent,
                      const char *first)
{
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    const char *member = at + f->offset;
    int count = 0;
    bool given = true;
    /* Not set: left out, so that what is printed loads back to the same. */
    if (f->type < BW_CONFIG_TYPE_MAP && bw_core__config_unset(f, at)) continue;
    fprintf(out, "%*s%s%s:", indent - (int)strlen(first), "", first, f->key);
    first = "";
    if (f->type == BW_CONFIG_TYPE_MAP) {
      if (f->flag != BW_CONFIG_NO_FLAG) memcpy(&given, at + f->flag, sizeof given);
      /* An optional block that is off says so: its default may be on. */
      fputs(!given ? " none\n" : any_set(f->fields, member) ? "\n" : " {}\n", out);
      if (given) put_table(out, f->fields, member, indent + 2, "");
    } else if (f->type == BW_CONFIG_TYPE_LIST) {
      memcpy(&count, at + f->flag, sizeof count);
      fputs(count > 0 ? "\n" : " []\n", out);
      /* The dash of an item stands before the first key of its block. */
      for (int q = 0; q < count; q++) {
        const char *item = member + (size_t)q * f->item_size;
        if (any_set(f->fields, item))
          put_table(out, f->fields, item, indent + 4, "- ");
        else
          fprintf(out, "%*s- {}\n", indent + 2, "");
      }
    } else {
      fputc(' ', out);
      bw_core__config_put_value(out, f, member);
      fputc('\n', out);
    }
  }
}

bw_status bw_config_dump(const bw_config_field fields[], const void *config, char **text)
{
  size_t length = 0;
  *text = NULL;
  FILE *out = open_memstream(text, &length);
  BW_REQUIRE(out != NULL, BW_EMEM, "no memory to print the configuration");
  put_table(out, fields, config, 0, "");
  const bool ok = !ferror(out);
  BW_REQUIRE(fclose(out) == 0 && ok, BW_EMEM, "no memory to print the configuration");
  return BW_OK;
}

static void help_table(FILE *out, const bw_config_field fields[], const char *at,
                       const char *prefix)
{
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    char path[BW_CONFIG_PATH], expected[256], meaning[256], item[BW_CONFIG_PATH];
    const bool unset = f->type >= BW_CONFIG_TYPE_MAP || bw_core__config_unset(f, at);
    bw_core__config_join(prefix, f->key, path);
    bw_core__config_expected(f, sizeof expected, expected);
    bw_core__config_meaning(f, sizeof meaning, meaning);
    fprintf(out, "  %-32s %s%s", path, expected, meaning);
    if ((f->need & BW_REQUIRED) && unset) fputs("; required", out);
    if (f->type == BW_CONFIG_TYPE_MAP && f->flag != BW_CONFIG_NO_FLAG) fputs("; optional", out);
    if (f->type == BW_CONFIG_TYPE_LIST) fprintf(out, "; at most %d", (int)(f->size / f->item_size));
    if (!unset) {
      fputs("; default ", out);
      bw_core__config_put_value(out, f, at + f->offset);
    }
    if (f->need & BW_MAY_CHANGE) fputs("; may change with --restart", out);
    fputc('\n', out);
    bw_core__config_join(path, "N", item);
    /* Blocks follow their own line, key by key; items of a list are named by N. */
    if (f->fields != NULL)
      help_table(out, f->fields, at + f->offset, f->type == BW_CONFIG_TYPE_LIST ? item : path);
  }
}

void bw_config_help(const bw_config_field fields[], const void *config, FILE *out)
{
  help_table(out, fields, config, "");
}
