/* Files written by all ranks together, small text files, folders, stop signals.
 * TEST ranks=1,2,3,4 */
#include "bw_check.h"
#include "bw_file.h"
#include "bw_folder.h"
#include "bw_memory.h"
#include "bw_stop.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* A folder of its own per number of ranks: the tests of several may run at once. */
static char folder[64];
static void in_own_folder(const char *name, char path[128])
{
  snprintf(folder, sizeof folder, "test_core_file_np%d", bw_comm_size(bw_check_world()));
  bw_check_ok(bw_folder_make(bw_check_world(), folder));
  snprintf(path, 128, "%s/%s", folder, name);
}

static int byte_at(int64_t position)
{
  return (int)((position * 31 + position / 251) % 256);
}

/* Rank r owns 100 r bytes (rank 0 none), laid out in falling rank order, written in two calls. */
START_TEST(ranks_write_their_bytes)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm), size = bw_comm_size(comm);
  char path[128], *text = NULL;
  unsigned char mine[400];
  int64_t offset = 10, total = 10;
  size_t bytes = 0;
  in_own_folder("data.bin", path);
  for (int r = 0; r < size; r++) {
    if (r > me) offset += 100 * r;
    total += 100 * r;
  }
  for (int i = 0; i < 100 * me; i++)
    mine[i] = (unsigned char)byte_at(offset + i);
  unsigned char head[10];
  for (int i = 0; i < 10; i++)
    head[i] = (unsigned char)byte_at(i);

  bw_file *file = NULL;
  bw_check_ok(bw_file_create(comm, path, &file));
  bw_check_ok(bw_file_write_at_all(file, offset, (size_t)(100 * me), me == 0 ? NULL : mine));
  bw_check_ok(bw_file_write_at_all(file, 0, me == 0 ? 10 : 0, head));
  bw_check_ok(bw_file_close(&file));
  ck_assert_ptr_null(file);

  bw_check_ok(bw_file_read_text(comm, path, &bytes, &text));
  ck_assert_int_eq((int64_t)bytes, total);
  for (int64_t i = 0; i < total; i++)
    ck_assert_int_eq((unsigned char)text[i], byte_at(i));
  bw_release(&text);
}
END_TEST

/* Until close the old content stays; an abandoned file leaves nothing behind. */
START_TEST(unfinished_files_replace_nothing)
{
  const bw_comm *comm = bw_check_world();
  char path[128], part[140], *text = NULL;
  bw_file *file = NULL;
  in_own_folder("old.txt", path);
  snprintf(part, sizeof part, "%s.part", path);
  bw_check_ok(bw_file_write_text(comm, path, "old content"));
  bw_check_ok(bw_file_create(comm, path, &file));
  bw_check_ok(bw_file_write_at_all(file, 0, bw_comm_rank(comm) == 0 ? 3 : 0, "new"));
  bw_check_ok(bw_file_read_text(comm, path, NULL, &text));
  ck_assert_str_eq(text, "old content");
  bw_release(&text);
  ck_assert(bw_path_exists(comm, part));
  bw_file_abandon(&file);
  ck_assert(!bw_path_exists(comm, part));
  bw_file_abandon(&file); /* NULL is fine */
  bw_check_ok(bw_file_read_text(comm, path, NULL, &text));
  ck_assert_str_eq(text, "old content");
  bw_release(&text);

  bw_check_ok(bw_file_create(comm, path, &file));
  bw_check_ok(bw_file_write_at_all(file, 0, bw_comm_rank(comm) == 0 ? 3 : 0, "new"));
  bw_check_ok(bw_file_close(&file));
  bw_check_ok(bw_file_read_text(comm, path, NULL, &text));
  ck_assert_str_eq(text, "new"); /* shorter than the old one: nothing of it is left */
  bw_release(&text);
}
END_TEST

START_TEST(refusals_name_the_path_and_the_reason)
{
  const bw_comm *comm = bw_check_world();
  char path[128], inside[140], *text = NULL;
  bw_file *file = NULL;
  in_own_folder("missing_folder/data.bin", path);
  bw_check_status(bw_file_create(comm, path, &file), BW_EIO);
  ck_assert_ptr_null(file);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), path));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "No such file or directory"));
  bw_check_status(bw_file_write_text(comm, path, "x"), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "No such file or directory"));
  bw_check_status(bw_file_read_text(comm, path, NULL, &text), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), path));
  ck_assert_ptr_null(text);
  bw_check_status(bw_file_read_text(comm, folder, NULL, &text), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "Is a directory"));

  in_own_folder("in_the_way", path);
  bw_check_ok(bw_file_write_text(comm, path, "a file"));
  snprintf(inside, sizeof inside, "%s/sub", path);
  bw_check_status(bw_folder_make(comm, inside), BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "in the way"));
  ck_assert_ptr_nonnull(strstr(bw_last_message(), path));
}
END_TEST

/* The limit on file size stands for a full disk: a write that cannot be completed is an error,
 * on all ranks, and the file does not appear. */
START_TEST(a_short_write_is_an_error)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  const size_t bytes = 8192;
  char path[128], *data = NULL;
  bw_file *file = NULL;
  in_own_folder("too_large.bin", path);
  bw_check_ok(BW_ALLOCATE(&data, bytes));
  struct rlimit before, low;
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  bw_check_ok(bw_file_create(comm, path, &file));
  getrlimit(RLIMIT_FSIZE, &before);
  low = before;
  low.rlim_cur = 4096;
  setrlimit(RLIMIT_FSIZE, &low);
  bw_status st = bw_file_write_at_all(file, (int64_t)bytes * me, bytes, data);
  if (st == BW_OK)
    st = bw_file_close(&file);
  else
    bw_file_abandon(&file);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  ck_assert_int_eq(st, BW_EIO);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), path));
  ck_assert(!bw_path_exists(comm, path));
  bw_release(&data);
}
END_TEST

/* Bytes that were written and are not there at the end (a full disk may show up late). */
START_TEST(missing_bytes_are_noticed_at_the_end)
{
  const bw_comm *comm = bw_check_world();
  const int me = bw_comm_rank(comm);
  char path[128], part[140];
  bw_file *file = NULL;
  in_own_folder("cut.bin", path);
  snprintf(part, sizeof part, "%s.part", path);
  bw_check_ok(bw_file_create(comm, path, &file));
  bw_check_ok(bw_file_write_at_all(file, 4 * me, 4, "abcd"));
  bw_comm_barrier(comm);
  if (me == 0) ck_assert_int_eq(truncate(part, 4 * bw_comm_size(comm) - 1), 0);
  bw_check_status(bw_file_close(&file), BW_EIO);
  ck_assert_ptr_null(file);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), path));
  ck_assert(!bw_path_exists(comm, path));
  ck_assert(!bw_path_exists(comm, part));
}
END_TEST

START_TEST(folders_are_made_with_parents)
{
  const bw_comm *comm = bw_check_world();
  char path[128], deep[200], *joined = NULL;
  in_own_folder("a", path);
  snprintf(deep, sizeof deep, "%s/b//c/", path);
  bw_check_ok(bw_folder_make(comm, deep));
  bw_check_ok(bw_folder_make(comm, deep)); /* again is fine */
  ck_assert(bw_path_exists(comm, deep));
  bw_check_ok(bw_path_join("a/b", "c", &joined));
  ck_assert_str_eq(joined, "a/b/c");
  bw_release(&joined);
  bw_check_ok(bw_path_join("a/", "c", &joined));
  ck_assert_str_eq(joined, "a/c");
  bw_release(&joined);
  bw_check_ok(bw_path_join("a", "/c", &joined));
  ck_assert_str_eq(joined, "/c");
  bw_release(&joined);
}
END_TEST

/* Refused in our words before Open MPI's file layer would abort; the longest that is allowed
 * works. */
START_TEST(paths_that_are_too_long)
{
  const bw_comm *comm = bw_check_world();
  char path[400];
  bw_file *file = NULL;
  in_own_folder("", path);
  while (strlen(path) < BW_PATH_LONGEST)
    strcat(path, "a");
  bw_check_ok(bw_file_create(comm, path, &file));
  bw_check_ok(bw_file_close(&file));
  ck_assert(bw_path_exists(comm, path));
  strcat(path, "a");
  bw_check_status(bw_file_create(comm, path, &file), BW_EIO);
  ck_assert_ptr_null(file);
  ck_assert_ptr_nonnull(strstr(bw_last_message(), "has 236 bytes, 235 at most"));
}
END_TEST

/* A signal at one rank stops all, in the same call. */
START_TEST(a_signal_to_one_rank_reaches_all)
{
  const bw_comm *comm = bw_check_world();
  static const int signals[] = {SIGTERM, SIGINT, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2};
  for (size_t q = 0; q < sizeof signals / sizeof *signals; q++) {
    bw_stop_install();
    ck_assert(!bw_stop_requested(comm));
    if (bw_comm_rank(comm) == bw_comm_size(comm) - 1) raise(signals[q]);
    ck_assert(bw_stop_requested(comm));
    ck_assert(bw_stop_requested(comm));
    const bool here = bw_comm_rank(comm) == bw_comm_size(comm) - 1;
    ck_assert_int_eq(bw_stop_signal(), here ? signals[q] : 0);
    bw_stop_clear();
    ck_assert(!bw_stop_requested(comm));
  }
}
END_TEST

/* What a child process dies of that gets the signals, one after the other; 0: it lives. */
static int died_of(int first, int second, bool nohup)
{
  int how = 0;
  const pid_t child = fork();
  if (child == 0) {
    if (nohup) signal(SIGHUP, SIG_IGN);
    bw_stop_install();
    if (first != 0) raise(first);
    if (second != 0) raise(second);
    _exit(0);
  }
  ck_assert_int_gt(child, 0);
  ck_assert_int_eq(waitpid(child, &how, 0), child);
  return WIFSIGNALED(how) ? WTERMSIG(how) : 0;
}

/* Who asks twice does not wait, whatever the two signals are. */
START_TEST(a_second_signal_ends_at_once)
{
  ck_assert_int_eq(died_of(SIGTERM, 0, false), 0);
  ck_assert_int_eq(died_of(SIGTERM, SIGTERM, false), SIGTERM);
  ck_assert_int_eq(died_of(SIGUSR1, SIGINT, false), SIGINT);
  ck_assert_int_eq(died_of(SIGHUP, SIGUSR2, false), SIGUSR2);
  ck_assert_int_eq(died_of(SIGTERM, SIGHUP, true), 0); /* nohup holds */
}
END_TEST

static const bw_check_test tests[] = {BW_TEST(ranks_write_their_bytes),
                                      BW_TEST(unfinished_files_replace_nothing),
                                      BW_TEST(refusals_name_the_path_and_the_reason),
                                      BW_TEST(a_short_write_is_an_error),
                                      BW_TEST(missing_bytes_are_noticed_at_the_end),
                                      BW_TEST(folders_are_made_with_parents),
                                      BW_TEST(paths_that_are_too_long),
                                      BW_TEST(a_signal_to_one_rank_reaches_all),
                                      BW_TEST(a_second_signal_ends_at_once)};
BW_CHECK_MAIN("core.file", tests)
