/* Bytes that are no text: a case file in another encoding, or with a hole in it. */
#include "config_internal.h"

#include <string.h>

/* Bytes of the UTF-8 letter that begins at s (n bytes follow, itself included); 0: it is none. */
static size_t letter(const unsigned char *s, size_t n)
{
  static const struct {
    unsigned char mask, head;
    size_t length;
  } forms[] = {{0x80, 0x00, 1}, {0xe0, 0xc0, 2}, {0xf0, 0xe0, 3}, {0xf8, 0xf0, 4}};
  for (size_t q = 0; q < sizeof forms / sizeof *forms; q++) {
    if ((s[0] & forms[q].mask) != forms[q].head) continue;
    if (forms[q].length > n) return 0;
    for (size_t k = 1; k < forms[q].length; k++)
      if ((s[k] & 0xc0) != 0x80) return 0;
    /* c0 and c1 would spell a letter of one byte with two; beyond f4 Unicode has ended. */
    return s[0] == 0xc0 || s[0] == 0xc1 || s[0] > 0xf4 ? 0 : forms[q].length;
  }
  return 0;
}

bw_status bw_core__config_encoding(const char *name, const char *text, size_t bytes)
{
  const unsigned char *s = (const unsigned char *)text;
  size_t line = 1, length = 0;
  BW_REQUIRE(bytes < 2 || !((s[0] == 0xfe && s[1] == 0xff) || (s[0] == 0xff && s[1] == 0xfe)),
             BW_EINPUT, "%s:1: the file is UTF-16: save it as UTF-8", name);
  for (size_t q = 0; q < bytes; q += length) {
    /* A C text would end here, and what follows would be overlooked in silence. */
    BW_REQUIRE(s[q] != 0, BW_EINPUT,
               "%s:%zu: a byte of 0, which no text has: remove it, or save the file as UTF-8", name,
               line);
    length = letter(s + q, bytes - q);
    BW_REQUIRE(length > 0, BW_EINPUT, "%s:%zu: the byte 0x%02x is not UTF-8: save it as UTF-8",
               name, line, (unsigned)s[q]);
    line += s[q] == '\n';
  }
  return BW_OK;
}
