/* driver.c -- main of a fuzzer where the compiler brings none: mutates seeds, with no knowledge of
 * what they reach.
 *
 *   fuzz_NAME [--runs=N] [--seconds=S] [--first=N] [--seed=K] [--keep=FILE] SEED...
 *
 * A SEED is a file or a folder of files. Each is run once as it is, which is all when neither runs
 * nor seconds are asked for (so that AFL can start it as `fuzz_NAME @@`). Input number n depends on
 * K and n alone: after a crash, whose number is told, --first=n --runs=1 --keep=FILE makes it again
 * and writes it. */
#include "fuzz.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LONGEST = 1 << 16, MOST = 1000 };

typedef struct {
  size_t n;
  uint8_t *byte;
} input;

static input seeds[MOST];
static int n_seeds;
static uint64_t number;       /* of the input that runs */
static uint8_t work[LONGEST]; /* the input */

/* ---- what went wrong ---- */

static void tell(void)
{
  char text[64];
  const int n = snprintf(text, sizeof text, "fuzz: input %llu\n", (unsigned long long)number);
  if (write(STDERR_FILENO, text, (size_t)n) != n) _exit(99);
}

void __asan_on_error(void); /* called by the address sanitizer */
void __asan_on_error(void)
{
  tell();
}

static void on_signal(int signal_number)
{
  tell();
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

/* ---- seeds ---- */

static void add_file(const char *path)
{
  FILE *file = fopen(path, "rb");
  if (file == NULL || n_seeds == MOST) {
    fprintf(stderr, "fuzz: %s: cannot be read, or is one too many\n", path);
    exit(2);
  }
  input *s = &seeds[n_seeds++];
  s->byte = malloc(LONGEST);
  if (s->byte == NULL) exit(2);
  s->n = fread(s->byte, 1, LONGEST, file);
  fclose(file);
}

static void add(const char *path)
{
  struct stat about;
  if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode)) {
    add_file(path);
    return;
  }
  DIR *folder = opendir(path);
  for (const struct dirent *e; folder != NULL && (e = readdir(folder)) != NULL;) {
    char name[1000];
    snprintf(name, sizeof name, "%s/%s", path, e->d_name);
    if (e->d_name[0] != '.') add_file(name);
  }
  if (folder != NULL) closedir(folder);
}

/* ---- mutations ---- */

static uint64_t state;

/* xorshift64* */
static uint64_t draw(uint64_t below)
{
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return below > 0 ? (state * UINT64_C(2685821657736338717) >> 11) % below : 0;
}

static const char *const words[] = {
    "0",    "-1", "1e300", "-1e-300", "nan",  "inf", "2147483648", "99999999999999999999",
    "\n\n", " ",  ":",     ",",       "[",    "]",   "{",          "}",
    "\"",   "=",  "%",     "\xff",    "\r\n", "1e5", "0.5",        "-",
    "."};

/* Makes room of m bytes at `at`, or takes -m away. */
static void shift(size_t *n, size_t at, long m)
{
  if (m > 0 && *n + (size_t)m > LONGEST) m = (long)(LONGEST - *n);
  if (m < 0 && at + (size_t)-m > *n) m = (long)at - (long)*n;
  const size_t from = m < 0 ? at + (size_t)-m : at, to = m < 0 ? at : at + (size_t)m;
  memmove(work + to, work + from, *n - from);
  *n = (size_t)((long)*n + m);
}

static void insert_word(size_t *n, size_t at)
{
  const char *word = words[draw(sizeof words / sizeof words[0])];
  const size_t m = strlen(word);
  if (draw(2) > 0) shift(n, at, (long)m);
  if (at + m <= *n) memcpy(work + at, word, m);
}

/* A number of 1, 2, 4 or 8 bytes that is at an end of its range. */
static void set_number(size_t n, size_t at)
{
  static const uint64_t values[] = {
      0,          1,   UINT64_MAX,          INT64_MAX,   0x8000000000000000u,
      0x7f800000, 255, 0x7ff0000000000000u, 0x80000000u, 0x7fffffff,
      65535,      16};
  const uint64_t value = values[draw(sizeof values / sizeof values[0])];
  const size_t m = (size_t)1 << draw(4);
  if (at + m <= n) memcpy(work + at, &value, m);
}

static void splice(size_t *n, size_t at)
{
  const input *other = &seeds[draw((uint64_t)n_seeds)];
  if (other->n == 0) return;
  const size_t from = draw(other->n), m = 1 + draw(other->n - from);
  if (draw(2) > 0) shift(n, at, (long)m);
  const size_t room = *n - at;
  memcpy(work + at, other->byte + from, m < room ? m : room);
}

static void mutate(size_t *n)
{
  const size_t at = draw(*n + 1);
  switch (draw(8)) {
  case 0:
    if (at < *n) work[at] ^= (uint8_t)(1u << draw(8));
    break;
  case 1:
    if (at < *n) work[at] = (uint8_t)draw(256);
    break;
  case 2:
    shift(n, at, -(long)(1 + draw(draw(4) > 0 ? 4 : 200)));
    break;
  case 3:
    insert_word(n, at);
    break;
  case 4:
    set_number(*n, at);
    break;
  case 5:
    splice(n, at);
    break;
  case 6:
    if (at < *n && work[at] >= '0' && work[at] <= '9') work[at] = (uint8_t)('0' + draw(10));
    break;
  default:
    *n = draw(4) > 0 ? *n : at;
  }
}

static size_t make(uint64_t seed, uint64_t which)
{
  state = (seed + 1) * UINT64_C(0x9E3779B97F4A7C15) + which * UINT64_C(0xD1B54A32D192ED03);
  if (state == 0) state = 1;
  draw(1), draw(1);
  const input *s = &seeds[draw((uint64_t)n_seeds)];
  size_t n = s->n;
  memcpy(work, s->byte, n);
  for (uint64_t left = 1 + draw(draw(3) > 0 ? 4 : 24); left > 0; left--)
    mutate(&n);
  return n;
}

/* ---- the run ---- */

static void keep(const char *path, size_t n)
{
  FILE *file = fopen(path, "wb");
  if (file == NULL || fwrite(work, 1, n, file) != n || fclose(file) != 0) {
    perror(path);
    exit(2);
  }
}

static bool value_of(const char *argument, const char *key, uint64_t *value)
{
  const size_t n = strlen(key);
  if (strncmp(argument, key, n) != 0) return false;
  *value = strtoull(argument + n, NULL, 10);
  return true;
}

int main(int argc, char **argv)
{
  uint64_t runs = 0, seconds = 0, first = 0, seed = 1;
  const char *kept = NULL;
  static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL};
  LLVMFuzzerInitialize(&argc, &argv);
  for (size_t q = 0; q < sizeof signals / sizeof signals[0]; q++)
    signal(signals[q], on_signal);
  for (int q = 1; q < argc; q++) {
    const char *a = argv[q];
    if (value_of(a, "--runs=", &runs) || value_of(a, "--seconds=", &seconds) ||
        value_of(a, "--first=", &first) || value_of(a, "--seed=", &seed))
      continue;
    if (strncmp(a, "--keep=", 7) == 0)
      kept = a + 7;
    else
      add(a);
  }
  if (n_seeds == 0) return fprintf(stderr, "fuzz: no seeds\n"), 2;
  for (int q = 0; q < n_seeds && first == 0; q++) {
    memcpy(work, seeds[q].byte, seeds[q].n);
    LLVMFuzzerTestOneInput(work, seeds[q].n);
  }
  /* As many as asked for, or as long. */
  const double start = bw_wall_time();
  for (number = first; seconds > 0 || number < first + runs; number++) {
    if (seconds > 0 && bw_wall_time() - start > (double)seconds) break;
    const size_t n = make(seed, number);
    if (kept != NULL) keep(kept, n);
    LLVMFuzzerTestOneInput(work, n);
  }
  printf("fuzz: %d seeds, %llu inputs\n", n_seeds, (unsigned long long)(number - first));
  return 0;
}
