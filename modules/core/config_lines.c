/* The struct as lines, one for each value, by which two runs are compared. */
#include "config_internal.h"

#include "bw_memory.h"
#include "bw_mix.h"
#include <inttypes.h>
#include <string.h>

/* How many bytes a file has, and a checksum of them in their order; false: it cannot be read. */
static bool look_into(const char *path, int64_t *bytes, uint64_t *sum)
{
  uint64_t block[512];
  FILE *in = fopen(path, "rb");
  *bytes = 0, *sum = 0;
  if (in == NULL) return false;
  for (size_t n = sizeof block; n == sizeof block; *bytes += (int64_t)n) {
    /* A last block that is not full ends in zeros; the number of bytes tells them apart. */
    memset(block, 0, sizeof block);
    n = fread(block, 1, sizeof block, in);
    for (size_t q = 0; q < sizeof block / sizeof *block && n > 0; q++)
      *sum = bw_mix(*sum + block[q] + UINT64_C(0x9e3779b97f4a7c15));
  }
  const bool whole = !ferror(in);
  fclose(in);
  return whole;
}

/* The content counts, wherever the file lies now. */
static void put_content(FILE *out, const char *path)
{
  int64_t bytes = 0;
  uint64_t sum = 0;
  bw_core__put_quoted(out, path);
  if (look_into(path, &bytes, &sum))
    fprintf(out, " (%" PRId64 " bytes, checksum %016" PRIx64 ")", bytes, sum);
  else
    fputs(" (cannot be read)", out);
}

static void put_lines(FILE *out, const bw_config_field fields[], const char *at, const char *prefix,
                      bool may_change)
{
  for (const bw_config_field *f = fields; f->key != NULL; f++) {
    const bool free = may_change || (f->need & BW_MAY_CHANGE);
    const bool file = f->range.bounds & BW_BOUND_FILE;
    const char *member = at + f->offset;
    char path[BW_CONFIG_PATH], item[BW_CONFIG_PATH], index[16];
    bw_core__config_join(prefix, f->key, path);
    if (f->type == BW_CONFIG_TYPE_MAP) {
      bool given = true;
      if (f->flag != BW_CONFIG_NO_FLAG) memcpy(&given, at + f->flag, sizeof given);
      /* What a block is that is not there does not count. */
      if (given) put_lines(out, f->fields, member, path, free);
      if (f->flag != BW_CONFIG_NO_FLAG)
        fprintf(out, "%c %s = %s\n", free ? '~' : '=', path, given ? "given" : "none");
    } else if (f->type == BW_CONFIG_TYPE_LIST) {
      int count = 0;
      memcpy(&count, at + f->flag, sizeof count);
      fprintf(out, "%c %s = a list of %d\n", free ? '~' : '=', path, count);
      for (int q = 0; q < count; q++) {
        snprintf(index, sizeof index, "%d", q);
        bw_core__config_join(path, index, item);
        put_lines(out, f->fields, member + (size_t)q * f->item_size, item, free);
      }
    } else if (!bw_core__config_unset(f, at)) {
      fprintf(out, "%c %s = ", file ? '@' : free ? '~' : '=', path);
      if (file)
        put_content(out, member);
      else
        bw_core__config_put_value(out, f, member);
      fputc('\n', out);
    }
  }
}

bw_status bw_core__config_lines(const bw_config_field fields[], const void *config, char **text)
{
  size_t length = 0;
  *text = NULL;
  FILE *out = open_memstream(text, &length);
  BW_REQUIRE(out != NULL, BW_EMEM, "no memory to print the configuration");
  put_lines(out, fields, config, "", false);
  const bool ok = !ferror(out);
  BW_REQUIRE(fclose(out) == 0 && ok, BW_EMEM, "no memory to print the configuration");
  return BW_OK;
}
