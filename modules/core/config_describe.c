/* What a field is and would accept, in words. */
#include "config_internal.h"

#include <limits.h>
#include <math.h>
#include <string.h>

void bw_core__config_join(const char *prefix, const char *key, char path[BW_CONFIG_PATH])
{
  const char *const parts[] = {prefix, prefix[0] == '\0' ? "" : ".", key};
  size_t used = 0; /* cut when too long: only a message suffers */
  char joined[BW_CONFIG_PATH];
  for (int q = 0; q < 3; q++)
    for (const char *c = parts[q]; *c != '\0' && used < BW_CONFIG_PATH - 1; c++)
      joined[used++] = *c;
  joined[used] = '\0';
  memcpy(path, joined, used + 1);
}

int bw_core__config_length(const bw_config_field *f)
{
  return f->type < BW_CONFIG_TYPE_MAP ? (int)(f->size / f->item_size) : 1;
}

static bool double_unset(const void *at)
{
  double x;
  memcpy(&x, at, sizeof x);
  return isnan(x);
}

static bool int_unset(const void *at)
{
  int x;
  memcpy(&x, at, sizeof x);
  return x == INT_MIN;
}

static bool text_unset(const void *at)
{
  return *(const char *)at == '\0';
}

static bool never_unset(const void *at)
{
  (void)at;
  return false;
}

bool bw_core__config_unset(const bw_config_field *f, const void *at)
{
  static bool (*const unset[])(const void *) = {
      [BW_CONFIG_TYPE_DOUBLE] = double_unset, [BW_CONFIG_TYPE_INT] = int_unset,
      [BW_CONFIG_TYPE_BOOL] = never_unset,    [BW_CONFIG_TYPE_TEXT] = text_unset,
      [BW_CONFIG_TYPE_WORD] = int_unset,      [BW_CONFIG_TYPE_MAP] = never_unset,
      [BW_CONFIG_TYPE_LIST] = never_unset};
  const char *member = (const char *)at + f->offset;
  if (f->type == BW_CONFIG_TYPE_LIST) {
    int count;
    memcpy(&count, (const char *)at + f->flag, sizeof count);
    return count <= 0;
  }
  /* An array of which one element is not set is not set. */
  for (int q = 0; q < bw_core__config_length(f); q++)
    if (unset[f->type](member + (size_t)q * f->item_size)) return true;
  return false;
}

/* " > 0 and < 1", " from 1 to 7", ... */
static void describe_range(const bw_config_range *r, size_t size, char *text)
{
  char low[BW_NUMBER_SIZE], high[BW_NUMBER_SIZE];
  bw_core__format_double(r->low, low);
  bw_core__format_double(r->high, high);
  /* Whether a limit itself is allowed decides only about the sign in the text. */
  const bool lower = r->bounds & (BW_BOUND_MIN | BW_BOUND_ABOVE);
  const bool upper = r->bounds & (BW_BOUND_MAX | BW_BOUND_BELOW);
  const char *above = r->bounds & BW_BOUND_MIN ? ">=" : ">";
  const char *below = r->bounds & BW_BOUND_MAX ? "<=" : "<";
  if (lower && upper)
    snprintf(text, size, " %s %s and %s %s", above, low, below, high);
  else if (lower)
    snprintf(text, size, " %s %s", above, low);
  else if (upper)
    snprintf(text, size, " %s %s", below, high);
  else
    text[0] = '\0';
}

static const char *const nouns[][2] = {
    [BW_CONFIG_TYPE_DOUBLE] = {"a number", "numbers"},
    [BW_CONFIG_TYPE_INT] = {"a whole number", "whole numbers"},
    [BW_CONFIG_TYPE_BOOL] = {"true or false", "values true or false"},
    [BW_CONFIG_TYPE_TEXT] = {"a text", "texts"},
    [BW_CONFIG_TYPE_WORD] = {"one of", "words of"},
    [BW_CONFIG_TYPE_MAP] = {"a block of keys", ""},
    [BW_CONFIG_TYPE_LIST] = {"a list of blocks", ""}};

void bw_core__config_expected(const bw_config_field *f, size_t size, char *text)
{
  const int length = bw_core__config_length(f);
  char range[96] = "", several[32] = "";
  describe_range(&f->range, sizeof range, range);
  if (length > 1) snprintf(several, sizeof several, "a list of %d ", length);
  snprintf(text, size, "%s%s%s", several, nouns[f->type][length > 1], range);
  /* "one of a, b, c": the words follow the noun. */
  if (f->words == NULL) return;
  for (const bw_config_word *w = f->words; w->word != NULL; w++) {
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", w == f->words ? " " : ", ", w->word);
  }
}

void bw_core__config_meaning(const bw_config_field *f, size_t size, char *text)
{
  const bool help = f->help != NULL && f->help[0] != '\0';
  const bool unit = f->unit != NULL && f->unit[0] != '\0';
  text[0] = '\0';
  if (help || unit)
    snprintf(text, size, " (%s%s%s%s%s)", help ? f->help : "", help && unit ? " " : "",
             unit ? "[" : "", unit ? f->unit : "", unit ? "]" : "");
}
