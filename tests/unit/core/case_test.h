/* case_test.h -- a case for the tests of bw_case: its keys, its folders, its command line. */
#pragma once
#include "bw_case.h"
#include "bw_check.h"
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  double nu;
  int steps;
} config;
static const bw_config_field fields[] = {
    BW_CONFIG_VALUE(config, nu, BW_REQUIRED, BW_ABOVE(0), "m2/s", "kinematic viscosity"),
    BW_CONFIG_VALUE(config, steps, BW_OPTIONAL | BW_MAY_CHANGE, BW_AT_LEAST(0), "", "time steps"),
    BW_CONFIG_END};

/* A checkpoint of these tests is a text: the program's name in a line, then its parameters. */
static inline bw_status read_text(const bw_comm *comm, const char *path, char **program,
                                  char **parameters)
{
  char *text = NULL;
  size_t bytes = 0;
  *program = *parameters = NULL;
  BW_TRY(bw_file_read_text(comm, path, &bytes, &text));
  const size_t first = strcspn(text, "\n");
  bw_check_ok(BW_ALLOCATE(program, bytes + 1));
  bw_check_ok(BW_ALLOCATE(parameters, bytes + 1));
  memcpy(*program, text, first);
  if (first < bytes) memcpy(*parameters, text + first + 1, bytes - first - 1);
  bw_release(&text);
  return BW_OK;
}
#define TUBE "tube\n= nu = 0.5\n~ steps = 7\n" /* what a run of case_file has written */

static const bw_case_about about = {"tube", "flow in a tube", fields, sizeof(config), read_text};
static const bw_case_about other_case = {"plate", "another", fields, sizeof(config), read_text};

/* A folder that is new for every test program run, the same on all ranks. */
static char base[96];
static inline const char *in_base(const char *name, char path[200])
{
  if (base[0] == '\0') {
    int64_t number = bw_comm_rank(bw_check_world()) == 0 ? (int64_t)getpid() : 0;
    bw_comm_max_int(bw_check_world(), 1, &number);
    snprintf(base, sizeof base, "test_core_case/%lld", (long long)number);
    bw_check_ok(bw_folder_make(bw_check_world(), base));
  }
  snprintf(path, 200, "%s/%s", base, name);
  return path;
}

/* begin with the words given (the program's name comes first) */
static inline bw_status begin(const bw_case_about *of, const char *const words[], config *c,
                              bw_case **run)
{
  char *argv[16] = {(char *)"program"};
  static char copy[16][256]; /* a command line lives as long as the program */
  int argc = 1;
  for (; words[argc - 1] != NULL; argc++) {
    snprintf(copy[argc], sizeof copy[argc], "%s", words[argc - 1]);
    argv[argc] = copy[argc];
  }
  *c = (config){.nu = NAN, .steps = 7};
  return bw_case_begin(bw_check_world(), argc, argv, of, c, run);
}
#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

static inline void expect_refusal(const bw_case_about *of, const char *const words[],
                                  bw_status code, const char *piece)
{
  config c;
  bw_case *run = NULL;
  bw_check_status(begin(of, words, &c, &run), code);
  ck_assert_ptr_null(run);
  ck_assert_msg(strstr(bw_last_message(), piece) != NULL, "'%s' not in: %s", piece,
                bw_last_message());
}

static inline const char *case_file(char path[200])
{
  in_base("tube.yaml", path);
  bw_check_ok(bw_file_write_text(bw_check_world(), path, "nu: 0.5\n"));
  return path;
}
