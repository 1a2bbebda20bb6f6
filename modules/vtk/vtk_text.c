/* The XML text of a file's header. */
#include "bw_memory.h"
#include "vtk_internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void reserve(bw_vtk__text *text, size_t more)
{
  if (text->status != BW_OK || text->used + more <= text->room) return;
  const size_t room = 2 * text->room + more + 1024;
  char *chars = NULL;
  text->status = BW_ALLOCATE(&chars, room);
  if (text->status != BW_OK) return;
  if (text->used > 0) memcpy(chars, text->chars, text->used);
  bw_release(&text->chars);
  text->chars = chars;
  text->room = room;
}

void bw_vtk__add(bw_vtk__text *text, const char *fmt, ...)
{
  va_list args;
  va_start(args, fmt);
  /* A first pass measures, a second one prints; the arguments have to be begun anew for it. */
  const int length = vsnprintf(NULL, 0, fmt, args);
  va_end(args);
  reserve(text, (size_t)length + 1);
  if (text->status != BW_OK) return;
  va_start(args, fmt);
  vsnprintf(text->chars + text->used, (size_t)length + 1, fmt, args);
  va_end(args);
  text->used += (size_t)length;
}

void bw_vtk__add_escaped(bw_vtk__text *text, const char *name)
{
  for (; *name != '\0'; name++) {
    switch (*name) {
    case '&':
      bw_vtk__add(text, "&amp;");
      break;
    case '<':
      bw_vtk__add(text, "&lt;");
      break;
    case '>':
      bw_vtk__add(text, "&gt;");
      break;
    case '"':
      bw_vtk__add(text, "&quot;");
      break;
    default:
      bw_vtk__add(text, "%c", *name);
    }
  }
}
