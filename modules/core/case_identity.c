/* A restart is the same run: what a checkpoint says of the run that wrote it, against this one. */
#include "bw_memory.h"
#include "case_internal.h"
#include "config_internal.h"

#include <string.h>

/* One value of a case, a line "MARK KEY = VALUE" (bw_core__config_lines). */
typedef struct {
  char mark;
  const char *key, *value;
  int key_length, length; /* of the value */
} value_line;

/* The line at *at, which moves behind it; false: there is none. What is no such line is passed. */
static bool next_line(const char **at, value_line *line)
{
  while (**at != '\0') {
    const char *begin = *at, *end = begin + strcspn(begin, "\n"), *equals = strstr(begin, " = ");
    *at = *end != '\0' ? end + 1 : end;
    if (equals == NULL || equals >= end || equals < begin + 3 || begin[1] != ' ') continue;
    *line = (value_line){.mark = begin[0],
                         .key = begin + 2,
                         .value = equals + 3,
                         .key_length = (int)(equals - begin - 2),
                         .length = (int)(end - equals - 3)};
    return true;
  }
  return false;
}

static bool find_line(const char *text, const value_line *like, value_line *line)
{
  while (next_line(&text, line))
    if (line->key_length == like->key_length &&
        strncmp(line->key, like->key, (size_t)like->key_length) == 0)
      return true;
  *line = (value_line){.mark = like->mark, .value = "not set", .length = 7};
  return false;
}

/* Of a file the content counts, which stands behind its path. */
static bool same_value(const value_line *a, const value_line *b)
{
  const char *x = a->value, *y = b->value;
  int n = a->length, m = b->length;
  if (a->mark == '@' && b->mark == '@') {
    while (n > 0 && x[n - 1] != '(')
      n--;
    while (m > 0 && y[m - 1] != '(')
      m--;
    x += n, y += m;
    n = a->length - n, m = b->length - m;
  }
  return n == m && strncmp(x, y, (size_t)n) == 0;
}

typedef struct {
  FILE *refused, *changed; /* lines of text */
  const char *path;        /* of the checkpoint */
  int n_refused;
} comparison;

/* A difference: `key` gives the name, `now` and `before` the values. */
static void put_difference(comparison *c, const value_line *key, const value_line *now,
                           const value_line *before)
{
  enum { SHOWN = 8, LONGEST = 120 };
  const int n = now->length < LONGEST ? now->length : LONGEST;
  const int m = before->length < LONGEST ? before->length : LONGEST;
  if (key->mark == '~') {
    fprintf(c->changed, "%.*s is %.*s, was %.*s\n", key->key_length, key->key, n, now->value, m,
            before->value);
    return;
  }
  c->n_refused++;
  if (c->n_refused <= SHOWN)
    fprintf(c->refused, "%s--restart %s: %.*s is %.*s, was %.*s in the run that wrote it",
            c->n_refused > 1 ? "\n" : "", c->path, key->key_length, key->key, n, now->value, m,
            before->value);
  else if (c->n_refused == SHOWN + 1)
    fputs("\n(and more)", c->refused);
}

/* Every value of this run, then those that only the other one had. */
static void compare(comparison *c, const char *mine, const char *stored)
{
  value_line a, b;
  for (const char *at = mine; next_line(&at, &a);)
    if (!find_line(stored, &a, &b) || !same_value(&a, &b)) put_difference(c, &a, &a, &b);
  for (const char *at = stored; next_line(&at, &b);)
    if (!find_line(mine, &b, &a)) put_difference(c, &b, &a, &b);
}

/* Of one rank. */
static bw_status same_case(bw_case *run, const char *stored)
{
  char *refused = NULL;
  size_t n_refused = 0, n_changed = 0;
  bw_release(&run->changed);
  comparison c = {.refused = open_memstream(&refused, &n_refused),
                  .changed = open_memstream(&run->changed, &n_changed),
                  .path = run->args.restart};
  const bool ok = c.refused != NULL && c.changed != NULL;
  if (ok) compare(&c, run->parameters, stored);
  if (c.refused != NULL) fclose(c.refused);
  if (c.changed != NULL) fclose(c.changed);
  bw_status st = BW_OK;
  if (!ok)
    st = BW_FAIL(BW_EMEM, "no memory to compare this run with %s", run->args.restart);
  else if (c.n_refused > 0)
    st = BW_FAIL(BW_EINPUT, "%s; keep what it had, or begin anew", refused);
  bw_release(&refused);
  return st;
}

static bw_status same_program(const bw_case *run, const char *program)
{
  BW_REQUIRE(strcmp(program, run->about->name) == 0, BW_EINPUT,
             "--restart %s: written by %.80s, this is %s; go on with the program that wrote it",
             run->args.restart, program, run->about->name);
  return BW_OK;
}

bw_status bw_core__case_identity(bw_case *run, const void *config)
{
  const bw_case_args *a = &run->args;
  const bool speaker = bw_comm_rank(a->comm) == 0;
  char *program = NULL, *stored = NULL;
  BW_REQUIRE(a->restart == NULL || run->about->read_checkpoint != NULL, BW_EUSAGE,
             "--restart %s: %s writes no checkpoints; run it from the start", a->restart,
             run->about->name);
  if (run->about->read_checkpoint == NULL) return BW_OK;
  /* Rank 0 looks into the files that the case reads; a checkpoint takes its text. */
  bw_status st = speaker ? bw_core__config_lines(run->about->fields, config, &run->parameters)
                         : bw_allocate(1, 1, &run->parameters);
  BW_TRY(bw_comm_agree(a->comm, st));
  if (a->restart == NULL) return BW_OK;
  /* Before the folder is touched, and with --check, too. */
  BW_TRY(run->about->read_checkpoint(a->comm, a->restart, &program, &stored));
  st = same_program(run, program);
  if (speaker) BW_THEN(st, same_case(run, stored));
  bw_release(&program);
  bw_release(&stored);
  return bw_comm_agree(a->comm, st);
}

/* The next line of *at without its end, or NULL. */
static const char *take_line(const char **at, int *length)
{
  const char *line = *at;
  if (line == NULL || *line == '\0') return NULL;
  *length = (int)strcspn(line, "\n");
  *at = line + *length + (line[*length] != '\0');
  return line;
}

void bw_core__case_tell_changes(const bw_case *run)
{
  const char *at = run->changed;
  int n = 0;
  for (const char *line; (line = take_line(&at, &n)) != NULL;)
    bw_log_info(run->log, "changed    %.*s in the run that wrote the checkpoint", n, line);
}

void bw_core__case_record_changes(FILE *out, const bw_case *run)
{
  const char *at = run->changed;
  int n = 0;
  if (at == NULL || *at == '\0') return;
  fputs("  changed:\n", out);
  for (const char *line; (line = take_line(&at, &n)) != NULL;) {
    char one[512];
    snprintf(one, sizeof one, "%.*s", n, line);
    fputs("    - ", out);
    bw_core__put_quoted(out, one);
    fputc('\n', out);
  }
}

bw_status bw_case_check_end(const bw_case *run, const char *key, double end, double done)
{
  BW_REQUIRE(run->args.restart == NULL || done <= end * (1.0 + 1e-9), BW_EINPUT,
             "--restart %s: it is at %.10g already, beyond %s = %.10g; give a later end, or an "
             "earlier checkpoint",
             run->args.restart, done, key, end);
  if (run->args.restart != NULL && done >= end * (1.0 - 1e-9))
    bw_log_info(run->log, "%s: the run is complete; a larger %s goes on with it", run->args.restart,
                key);
  return BW_OK;
}

const char *bw_case_program(const bw_case *run)
{
  return run->about->name;
}

const char *bw_case_parameters(const bw_case *run)
{
  return run->parameters != NULL ? run->parameters : "";
}
