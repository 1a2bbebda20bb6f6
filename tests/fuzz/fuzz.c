/* What the fuzzers share: a folder, files in it, a look at masks. */
#include "fuzz.h"
#include "bw_memory.h"
#include "fuzz_case.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bw_comm *world;
static char folder[200];

static void stop(const char *what)
{
  perror(what);
  abort();
}

static void clean(void)
{
  char command[300];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  if (folder[0] != 0 && system(command) != 0) perror(folder);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  if (bw_init(argc, argv, &world) != BW_OK) stop("bw_init");
  atexit(clean);
  return 0;
}

const bw_comm *fuzz_comm(void)
{
  return world;
}

const char *fuzz_folder(void)
{
  if (folder[0] != 0) return folder;
  const char *where = getenv("TMPDIR");
  snprintf(folder, sizeof folder, "%s/bw-fuzz-%d", where != NULL ? where : "/dev/shm",
           (int)getpid());
  if (mkdir(folder, 0700) != 0) stop(folder);
  return folder;
}

const char *fuzz_file(const char *name, const uint8_t *data, size_t size)
{
  static char path[4][300];
  static int which;
  which = (which + 1) % 4;
  snprintf(path[which], sizeof path[which], "%s/%s", fuzz_folder(), name);
  const int file = open(path[which], O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || write(file, data, size) != (ssize_t)size || close(file) != 0) stop(path[which]);
  return path[which];
}

void fuzz_read(const char *name, fuzz_base *base)
{
  char path[300];
  struct stat about;
  snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
  const int file = open(path, O_RDONLY);
  if (file < 0 || fstat(file, &about) != 0) stop(path);
  base->size = (size_t)about.st_size;
  base->byte = malloc(base->size + 1);
  if (base->byte == NULL || read(file, base->byte, base->size) != (ssize_t)base->size) stop(path);
  close(file);
}

const char *fuzz_patched(const char *name, const fuzz_base *base, const uint8_t *data, size_t size)
{
  static uint8_t *work;
  static size_t room;
  if (room < base->size + size) {
    free(work);
    room = base->size + size;
    work = malloc(room);
    if (work == NULL) stop(name);
  }
  memcpy(work, base->byte, base->size);
  size_t n = size > 0 && data[0] > 0 ? base->size * data[0] / 256 : base->size;
  for (size_t q = 1; q + 4 <= size && n > 0; q += 4) {
    const size_t at = ((size_t)data[q] << 8 | data[q + 1]) * n >> 16;
    switch (data[q + 2] % 4) {
    case 0:
      work[at] = data[q + 3];
      break;
    case 1:
      work[at] ^= (uint8_t)(1 << data[q + 3] % 8);
      break;
    case 2: /* one byte more */
      memmove(work + at + 1, work + at, n - at);
      work[at] = data[q + 3];
      n++;
      break;
    default: /* and one less */
      memmove(work + at, work + at + 1, n - at - 1);
      n--;
    }
  }
  return fuzz_file(name, work, n);
}

/* A part of the mask that the bytes choose, turned as they choose. */
static void cut(bw_shape_mask *m, const uint8_t *data, size_t size)
{
  int64_t from[3], to[3];
  for (int d = 0; d < 3; d++) {
    from[d] = (int64_t)data[(size_t)d % size] % m->size[d];
    to[d] = from[d] + 1 + (int64_t)data[(size_t)(d + 3) % size] % (m->size[d] - from[d]);
  }
  if (bw_shape_mask_crop(m, from, to) != BW_OK) abort();
  for (int d = 0; d < 3; d++)
    if ((data[size - 1] >> d & 1) && bw_shape_mask_flip(m, d) != BW_OK) abort();
}

void fuzz_mask(bw_status st, bw_shape_mask **mask, const uint8_t *data, size_t size)
{
  static const double lower[3] = {0}, upper[3] = {1, 1, 1};
  bw_shape_solid solid;
  /* A failure leaves nothing behind, and says why. */
  if ((st == BW_OK) != (*mask != NULL) || (st != BW_OK && bw_last_message()[0] == 0)) abort();
  if (st != BW_OK) return;
  bw_shape_mask *m = *mask;
  /* Larger bodies from a surface are refused by who opens them, as only they know what is meant. */
  const double cells = (double)m->size[0] * (double)m->size[1] * (double)m->size[2];
  if (cells <= 1e6) {
    st = bw_shape_mask_measure(m, 0, m->size[2], lower, upper, &solid);
    if (st == BW_OK && !(solid.volume >= 0 && solid.inside <= solid.volume * (1 + 1e-9) + 1e-300))
      abort();
    if (size > 0) cut(m, data, size);
    st = bw_shape_mask_hold(m, m->size[2] / 2, 1);
    if (st == BW_OK) st = bw_shape_mask_hold(m, 0, m->size[2]);
    if (st == BW_OK && (m->first != 0 || m->held != m->size[2])) abort();
  }
  bw_shape_mask_destroy(mask);
}

void fuzz_there_and_back(const fuzz_case *c)
{
  char *text = NULL, *again = NULL;
  fuzz_case d = fuzz_case_default();
  if (bw_config_dump(fuzz_fields, c, &text) != BW_OK) abort();
  const char *path = fuzz_file("dump.yaml", (const uint8_t *)text, strlen(text));
  if (bw_config_load(fuzz_comm(), path, fuzz_fields, 0, NULL, sizeof d, &d) != BW_OK ||
      bw_config_dump(fuzz_fields, &d, &again) != BW_OK || strcmp(text, again) != 0) {
    fprintf(stderr, "%s\n%s\n%s\n", text, again != NULL ? again : "-", bw_last_message());
    abort();
  }
  bw_release(&text);
  bw_release(&again);
}
