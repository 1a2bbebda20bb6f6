#include "bw_status.h"
#include "core_internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The one mutable global of the project: the text that goes with the last failure. */
static _Thread_local char last_message[BW_MESSAGE_SIZE];

bw_status bw_fail(bw_status code, const char *file, int line, const char *fmt, ...)
{
  char text[BW_MESSAGE_SIZE];
  va_list args;
  va_start(args, fmt);
  vsnprintf(text, sizeof text, fmt, args);
  va_end(args);
  bw_core__set_message(text);
  (void)file, (void)line; /* for the debugger: the user needs the key, not the source line */
  return code;
}

const char *bw_status_text(bw_status code)
{
  switch (code) {
#define X(name, value, text)                                                                       \
  case name:                                                                                       \
    return text;
    BW_STATUS_LIST(X)
#undef X
  }
  return "unknown status";
}

const char *bw_last_message(void)
{
  return last_message;
}

void bw_core__set_message(const char *text)
{
  snprintf(last_message, sizeof last_message, "%s", text);
}
