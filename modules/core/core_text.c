#include "core_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void bw_core__format_double(double x, char text[BW_NUMBER_SIZE])
{
  /* 17 digits always read back; fewer mostly do, and are easier to read. */
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, BW_NUMBER_SIZE, "%.*g", digits, x);
    if (strtod(text, NULL) == x) return;
  }
}

void bw_core__put_quoted(FILE *out, const char *text)
{
  fputc('"', out);
  for (const char *c = text; *c != '\0'; c++) {
    /* A quote or backslash inside would end the text or mean something else; control letters have
     * no other way in. */
    if (*c == '"' || *c == '\\')
      fprintf(out, "\\%c", *c);
    else if ((unsigned char)*c < 32)
      fprintf(out, "\\x%02x", (unsigned)*c);
    else
      fputc(*c, out);
  }
  fputc('"', out);
}

/* Optimal string alignment distance: insert, delete, replace, swap neighbours (the usual slips). */
int bw_core__edit_distance(const char *a, const char *b)
{
  enum { LONGEST = 63 };
  int row[3][LONGEST + 1];
  const int m = (int)strlen(a), n = (int)strlen(b);
  if (m > LONGEST || n > LONGEST) return LONGEST;
  for (int j = 0; j <= n; j++)
    row[0][j] = j;
  /* Row i needs the two rows above it, no more: three are kept in turn. */
  for (int i = 1; i <= m; i++) {
    int *now = row[i % 3];
    const int *above = row[(i + 2) % 3], *two_above = row[(i + 1) % 3];
    now[0] = i;
    for (int j = 1; j <= n; j++) {
      int best = above[j - 1] + (a[i - 1] != b[j - 1]);
      if (above[j] + 1 < best) best = above[j] + 1;
      if (now[j - 1] + 1 < best) best = now[j - 1] + 1;
      /* Two neighbouring letters in each other's place count as one slip. */
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
          two_above[j - 2] + 1 < best)
        best = two_above[j - 2] + 1;
      now[j] = best;
    }
  }
  return row[m % 3][n];
}

bool bw_core__near_miss(const char *found, const char *candidate, int *best)
{
  const int length = (int)strlen(candidate), limit = length < 4 ? 1 : length / 3 + 1;
  const int distance = bw_core__edit_distance(found, candidate);
  if (distance > limit || distance >= *best) return false;
  *best = distance;
  return true;
}
