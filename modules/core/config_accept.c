/* Which texts are values of a field. */
#include "config_internal.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Decimal and finite, nothing behind it. */
bool bw_core__config_number(const char *text, double *x)
{
  char *end = NULL;
  if (text[0] == '\0' || strspn(text, "+-.0123456789eE") != strlen(text)) return false;
  *x = strtod(text, &end);
  return *end == '\0' && isfinite(*x);
}

bool bw_core__config_in_range(const bw_config_range *r, double x)
{
  if ((r->bounds & BW_BOUND_MIN) && !(x >= r->low)) return false;
  if ((r->bounds & BW_BOUND_ABOVE) && !(x > r->low)) return false;
  if ((r->bounds & BW_BOUND_MAX) && !(x <= r->high)) return false;
  if ((r->bounds & BW_BOUND_BELOW) && !(x < r->high)) return false;
  return true;
}

bool bw_core__config_meant(const char *text, double x)
{
  /* strtod makes 0 of what is too small for it: the digits tell. */
  const size_t digits = strcspn(text, "eE");
  if (x == 0.0) return strcspn(text, "123456789") >= digits;
  return fabs(x) >= BW_CONFIG_SMALLEST && fabs(x) <= BW_CONFIG_LARGEST;
}

/* Accepted as written, so that libcyaml reads the user's own digits. */
static bool accept_double(FILE *out, const bw_config_field *f, const char *text)
{
  double x = 0.0;
  if (!bw_core__config_number(text, &x) || !bw_core__config_in_range(&f->range, x)) return false;
  if (!bw_core__config_meant(text, x)) return false;
  fputs(text, out);
  return true;
}

/* 1e6 and 10.0 are whole numbers too. INT_MIN means "not set". */
static bool accept_int(FILE *out, const bw_config_field *f, const char *text)
{
  double x = 0.0;
  if (!bw_core__config_number(text, &x) || !bw_core__config_in_range(&f->range, x)) return false;
  /* A double holds every int exactly, so that the comparison loses nothing. */
  if (x != floor(x) || x <= (double)INT_MIN || x > (double)INT_MAX) return false;
  fprintf(out, "%d", (int)x);
  return true;
}

static bool accept_bool(FILE *out, const bw_config_field *f, const char *text)
{
  static const char *const words[2][3] = {{"false", "no", "off"}, {"true", "yes", "on"}};
  (void)f;
  /* Whatever spelling came in, one goes out: that is what libcyaml reads. */
  for (int b = 0; b < 2; b++)
    for (int q = 0; q < 3; q++)
      if (strcasecmp(text, words[b][q]) == 0) {
        fputs(words[b][0], out);
        return true;
      }
  return false;
}

static bool accept_text(FILE *out, const bw_config_field *f, const char *text)
{
  if (strlen(text) >= f->size) return false;
  bw_core__put_quoted(out, text);
  return true;
}

static bool accept_word(FILE *out, const bw_config_field *f, const char *text)
{
  for (const bw_config_word *word = f->words; word->word != NULL; word++)
    if (strcmp(text, word->word) == 0) {
      bw_core__put_quoted(out, text);
      return true;
    }
  return false;
}

static bool (*const accept[])(FILE *, const bw_config_field *,
                              const char *) = {[BW_CONFIG_TYPE_DOUBLE] = accept_double,
                                               [BW_CONFIG_TYPE_INT] = accept_int,
                                               [BW_CONFIG_TYPE_BOOL] = accept_bool,
                                               [BW_CONFIG_TYPE_TEXT] = accept_text,
                                               [BW_CONFIG_TYPE_WORD] = accept_word};

bool bw_core__config_accept(const bw_config_field *f, const char *text, FILE *out)
{
  return accept[f->type](out, f, text);
}
