#include "core_internal.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

static int width_of(int fd)
{
  struct winsize size = {0};
  if (!isatty(fd) || ioctl(fd, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

/* mpirun gives its ranks a pseudo terminal of width 0 as stdout, whatever its own stdout is (a
 * file, a pipe): only the launcher's own stdout tells. It can be looked up on Linux. */
static int width_of_launcher(void)
{
  char path[64];
  snprintf(path, sizeof path, "/proc/%ld/fd/1", (long)getppid());
  const int fd = open(path, O_WRONLY | O_NOCTTY | O_NONBLOCK);
  if (fd < 0) return 0;
  const int width = width_of(fd);
  close(fd);
  return width;
}

int bw_core__terminal_width(FILE *stream)
{
  const int fd = fileno(stream);
  if (fd < 0 || !isatty(fd)) return 0;
  const int width = width_of(fd);
  return width > 0 ? width : width_of_launcher();
}
