/* The command line that all cases share. */
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_real.h"
#include "case_internal.h"
#include "core_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bw_status take_set(bw_case *run, const char *value)
{
  run->overrides[run->args.n_overrides++] = value;
  return BW_OK;
}

static bw_status take_out(bw_case *run, const char *value)
{
  bw_release(&run->out);
  BW_REQUIRE(value[0] != '\0', BW_EUSAGE, "--out: the name of the folder is empty");
  return bw_path_join("", value, &run->out);
}

static bw_status take_restart(bw_case *run, const char *value)
{
  run->args.restart = value;
  return BW_OK;
}

static bw_status take_overwrite(bw_case *run, const char *value)
{
  (void)value;
  run->args.overwrite = true;
  return BW_OK;
}

/* "90", "15m", "2h30m", "1d": seconds where no unit is told. */
static bw_status take_stop_after(bw_case *run, const char *value)
{
  static const char units[] = "smhd";
  static const double seconds[] = {1.0, 60.0, 3600.0, 86400.0};
  double sum = 0.0;
  bool good = value[0] != '\0';
  for (const char *at = value; good && *at != '\0';) {
    char *end = NULL;
    /* Decimal, without sign: strtod alone would take "inf" and "-1". */
    const double x = strtod(at, &end);
    const char *unit = *end != '\0' ? strchr(units, *end) : NULL;
    good = strspn(at, ".0123456789") > 0 && (size_t)(end - at) <= strspn(at, ".0123456789") &&
           end > at && (unit != NULL || (*end == '\0' && at == value));
    if (!good) break;
    sum += x * seconds[unit != NULL ? unit - units : 0];
    at = end + (unit != NULL);
  }
  BW_REQUIRE(good && isfinite(sum), BW_EUSAGE,
             "--stop-after %s: write a time such as 90s, 15m, 2h or 1d12h", value);
  run->args.stop_after = sum;
  return BW_OK;
}

static bw_status take_check(bw_case *run, const char *value)
{
  (void)value;
  run->args.check = true;
  return BW_OK;
}

static bw_status take_quiet(bw_case *run, const char *value)
{
  (void)value;
  run->args.quiet = true;
  return BW_OK;
}

static bw_status take_help(bw_case *run, const char *value)
{
  (void)value;
  run->help = run->args.stop = true;
  return BW_OK;
}

static bw_status take_version(bw_case *run, const char *value)
{
  (void)value;
  run->version = run->args.stop = true;
  return BW_OK;
}

static const struct option {
  const char *name, *value; /* value: what follows it, NULL for nothing */
  bw_status (*take)(bw_case *, const char *);
  const char *help;
} options[] = {
    {"--set", "KEY.PATH=VALUE", take_set, "replace or add a value of the case file; repeatable"},
    {"--out", "DIR", take_out, "folder of the results"},
    {"--restart", "FILE", take_restart, "go on from a checkpoint"},
    {"--overwrite", NULL, take_overwrite, "replace the results of the same case in that folder"},
    {"--stop-after", "TIME", take_stop_after, "end in good order then, e.g. 2h; exit code 75"},
    {"--check", NULL, take_check, "read and check everything, print the sizes, run nothing"},
    {"--quiet", NULL, take_quiet, "only warnings and errors"},
    {"--help", NULL, take_help, "this text, with all keys of the case file"},
    {"--version", NULL, take_version, "version, commit and precision"},
};
enum { N_OPTIONS = sizeof options / sizeof *options };

/* --name, --name=value (the length of the name counts) */
static const struct option *find_option(const char *word, size_t length)
{
  for (int q = 0; q < N_OPTIONS; q++)
    if (strlen(options[q].name) == length && strncmp(word, options[q].name, length) == 0)
      return &options[q];
  return NULL;
}

static bw_status unknown_option(const char *word)
{
  const char *nearest = NULL;
  int best = 64;
  for (int q = 0; q < N_OPTIONS; q++)
    if (bw_core__near_miss(word, options[q].name, &best)) nearest = options[q].name;
  if (nearest != NULL)
    return BW_FAIL(BW_EUSAGE, "%s: unknown option; did you mean %s?", word, nearest);
  return BW_FAIL(BW_EUSAGE, "%s: unknown option; --help lists them", word);
}

static bw_status parse_option(bw_case *run, int argc, char **argv, int *at)
{
  const char *word = argv[*at], *value = strchr(word, '=');
  /* "--name=value" is one word, "--name value" two. */
  const size_t length = value != NULL ? (size_t)(value - word) : strlen(word);
  const struct option *o = find_option(word, length);
  if (o == NULL) return unknown_option(word);
  BW_REQUIRE(o->value != NULL || value == NULL, BW_EUSAGE, "%s takes no value", o->name);
  /* Behind the equals sign; an option without value has none. */
  if (value != NULL) value++;
  if (o->value != NULL && value == NULL) {
    BW_REQUIRE(*at + 1 < argc, BW_EUSAGE, "%s needs a value: %s %s", o->name, o->name, o->value);
    value = argv[++*at];
  }
  return o->take(run, value);
}

/* out/CASE, or out/CASE-FILE when the case file is called otherwise. */
static bw_status default_folder(bw_case *run)
{
  const char *slash = strrchr(run->args.yaml, '/');
  const char *stem = slash != NULL ? slash + 1 : run->args.yaml, *dot = strrchr(stem, '.');
  const int length = dot != NULL ? (int)(dot - stem) : (int)strlen(stem);
  const size_t room = sizeof "out/-" + strlen(run->about->name) + (size_t)length;
  /* The name of the case is not repeated where the file has it. */
  const bool same =
      strlen(run->about->name) == (size_t)length && strncmp(run->about->name, stem, length) == 0;
  BW_TRY(BW_ALLOCATE(&run->out, room));
  if (same || length == 0)
    snprintf(run->out, room, "out/%s", run->about->name);
  else
    snprintf(run->out, room, "out/%s-%.*s", run->about->name, length, stem);
  return BW_OK;
}

bw_status bw_core__case_parse(bw_case *run, int argc, char **argv)
{
  /* There are at most as many overrides as words. */
  BW_TRY(BW_ALLOCATE(&run->overrides, (size_t)argc));
  for (int q = 1; q < argc; q++) {
    if (argv[q][0] == '-') {
      BW_TRY(parse_option(run, argc, argv, &q));
    } else {
      BW_REQUIRE(run->args.yaml == NULL, BW_EUSAGE,
                 "two case files are given: %s and %s (a value of --set with spaces needs quotes)",
                 run->args.yaml, argv[q]);
      run->args.yaml = argv[q];
    }
  }
  run->args.overrides = run->overrides;
  /* Help and version need no case file. */
  if (run->args.stop) return BW_OK;
  BW_REQUIRE(!run->args.overwrite || run->args.restart == NULL, BW_EUSAGE,
             "--overwrite begins anew and --restart goes on: give one of them");
  BW_REQUIRE(run->args.yaml != NULL, BW_EUSAGE,
             "no case file is given: %s CASE.yaml [options]; --help lists them", run->about->name);
  if (run->out == NULL) BW_TRY(default_folder(run));
  run->args.out = run->out;
  return BW_OK;
}

void bw_core__case_version(void)
{
  printf("breakwater %s (commit %s, %s precision)\n", bw_version(), bw_commit(), BW_REAL_NAME);
}

void bw_core__case_help(const bw_case *run, const void *config)
{
  printf("%s: %s\n\nusage: [mpirun -np N] %s CASE.yaml [options]\n", run->about->name,
         run->about->summary, run->about->name);
  /* Options and keys come from the tables that read them: the text cannot fall behind. */
  for (int q = 0; q < N_OPTIONS; q++) {
    char name[64];
    snprintf(name, sizeof name, "%s %s", options[q].name,
             options[q].value != NULL ? options[q].value : "");
    printf("  %-22s %s\n", name, options[q].help);
  }
  printf("\nkeys of the case file:\n");
  bw_config_help(run->about->fields, config, stdout);
}
