#include "bw_particles_copies.h"
#include "bw_exchange.h"
#include "bw_memory.h"
#include "bw_real.h"

#include <string.h>

struct bw_particles_copies {
  const bw_comm *comm;
  bw_exchange *plan;
  bool offered; /* the plan's items are rows that go out; otherwise questions that go to owners */
  size_t n, rows, copies, width;
  int32_t *asked;                /* (rows) own particle */
  unsigned char *reply, *answer; /* (rows,width), (copies,width) */
};

/* The plan of the questions, and what was found for each that arrived here. */
static bw_status resolve(const bw_comm *comm, const bw_particles_question *question,
                         bw_exchange **plan, int32_t **found)
{
  unsigned char *key = NULL;
  const size_t bytes = question->key_bytes;
  BW_TRY(bw_exchange_create(comm, question->n, question->owner, plan));
  /* Each question is at its owner now, who looks into what is his. */
  const size_t asked = bw_exchange_received(*plan);
  bw_status st = bw_allocate(asked, bytes, &key);
  BW_THEN(st, BW_ALLOCATE(found, asked));
  st = bw_comm_agree(comm, st);
  if (st == BW_OK) {
    bw_exchange_forward(*plan, bytes, question->key, key);
    for (size_t q = 0; q < asked; q++)
      (*found)[q] = question->find(question->context, key + q * bytes);
  }
  bw_release(&key);
  return st;
}

bw_status bw_particles_ask(const bw_comm *comm, const bw_particles_question *question,
                           int32_t index[])
{
  bw_exchange *plan = NULL;
  int32_t *found = NULL;
  const bw_status st = resolve(comm, question, &plan, &found);
  if (st == BW_OK) bw_exchange_backward(plan, sizeof *found, found, index);
  bw_release(&found);
  bw_exchange_destroy(&plan);
  return st;
}

/* Every question has found a particle; index: what the owners said. */
static bw_status check_found(const bw_particles_question *question, size_t n, const int32_t index[])
{
  /* An owner without such a particle has answered -1. */
  for (size_t q = 0; q < question->n; q++) {
    if (index[q] >= 0) continue;
    const unsigned char *key = (const unsigned char *)question->key + q * question->key_bytes;
    int64_t id = 0;
    int32_t site[3] = {0};
    if (question->key_bytes == sizeof site) {
      memcpy(site, key, sizeof site);
      return BW_FAIL(BW_EINPUT,
                     "particles: rank %d has no particle on the site (%d,%d,%d), of which a copy "
                     "was asked for: ask bw_particles_ask first",
                     question->owner[q], site[0], site[1], site[2]);
    }
    if (question->key_bytes == sizeof id) memcpy(&id, key, sizeof id);
    return BW_FAIL(BW_EINPUT,
                   "particles: rank %d has no particle of the key %lld (question %zu beside %zu "
                   "own particles): ask bw_particles_ask first",
                   question->owner[q], (long long)id, q, n);
  }
  return BW_OK;
}

static bw_status allocate_buffers(bw_particles_copies *c)
{
  BW_REQUIRE(c->width >= sizeof(double), BW_EINPUT,
             "particles: copies of width %zu bytes; at least %zu are needed", c->width,
             sizeof(double));
  BW_TRY(bw_allocate(c->rows, c->width, &c->reply));
  return bw_allocate(c->copies, c->width, &c->answer);
}

/* The plan's own buffer is allocated by the largest move so far: this one. */
static bw_status ready(bw_particles_copies *c)
{
  BW_TRY(bw_comm_agree(c->comm, allocate_buffers(c)));
  bw_particles_copies_out(c, c->width, c->reply, c->answer);
  bw_particles_copies_in(c, c->width, c->answer, c->reply);
  return BW_OK;
}

static bw_status ask_owners(bw_particles_copies *c, const bw_particles_question *question)
{
  int32_t *index = NULL;
  c->copies = question->n;
  bw_status st = resolve(c->comm, question, &c->plan, &c->asked);
  if (st == BW_OK) {
    c->rows = bw_exchange_received(c->plan);
    for (size_t q = 0; q < c->rows; q++)
      /* A number beyond the own ones would be a copy: copies of copies are not kept. */
      if (c->asked[q] >= 0 && (size_t)c->asked[q] >= c->n) c->asked[q] = -1;
    st = bw_comm_agree(c->comm, BW_ALLOCATE(&index, c->copies));
  }
  if (st == BW_OK) {
    /* Who asked learns the answer, so that the message can tell what was asked for. */
    bw_exchange_backward(c->plan, sizeof *index, c->asked, index);
    st = bw_comm_agree(c->comm, check_found(question, c->n, index));
  }
  bw_release(&index);
  return st;
}

static bw_status make(const bw_comm *comm, size_t n, size_t width, bw_particles_copies **out)
{
  bw_particles_copies *c = NULL;
  const bw_status st = bw_comm_agree(comm, BW_ALLOCATE(&c, 1));
  if (st == BW_OK)
    *c = (bw_particles_copies){.comm = comm, .n = n, .width = width};
  else
    bw_release(&c);
  *out = c;
  return st;
}

bw_status bw_particles_copies_create(const bw_comm *comm, size_t n,
                                     const bw_particles_question *question, size_t width,
                                     bw_particles_copies **out)
{
  /* Copies in the order of the questions; owners answer, so values flow against the plan. */
  BW_TRY(make(comm, n, width, out));
  bw_status st = ask_owners(*out, question);
  BW_THEN(st, ready(*out));
  if (st != BW_OK) bw_particles_copies_destroy(out);
  return st;
}

static bw_status take_rows(bw_particles_copies *c, const int32_t own[])
{
  BW_TRY(BW_ALLOCATE(&c->asked, c->rows));
  for (size_t q = 0; q < c->rows; q++) {
    BW_REQUIRE(own[q] >= 0 && (size_t)own[q] < c->n, BW_EINPUT,
               "particles: a copy of particle %d is offered; own particles are 0 .. %zu less one",
               own[q], c->n);
    c->asked[q] = own[q];
  }
  return BW_OK;
}

bw_status bw_particles_copies_offer(const bw_comm *comm, size_t n, size_t rows, const int32_t own[],
                                    const int destination[], size_t width,
                                    bw_particles_copies **out)
{
  BW_TRY(make(comm, n, width, out));
  bw_particles_copies *c = *out;
  /* Owners know who needs what: values flow along the plan, and nobody asked. */
  c->offered = true;
  c->rows = rows;
  bw_status st = bw_comm_agree(comm, take_rows(c, own));
  BW_THEN(st, bw_exchange_create(comm, rows, destination, &c->plan));
  if (st == BW_OK) c->copies = bw_exchange_received(c->plan);
  BW_THEN(st, ready(c));
  if (st != BW_OK) bw_particles_copies_destroy(out);
  return st;
}

void bw_particles_copies_destroy(bw_particles_copies **copies)
{
  bw_particles_copies *c = *copies;
  if (c == NULL) return;
  bw_exchange_destroy(&c->plan);
  bw_release(&c->asked);
  bw_release(&c->reply);
  bw_release(&c->answer);
  bw_release(copies);
}

size_t bw_particles_copies_count(const bw_particles_copies *c)
{
  return c->copies;
}

size_t bw_particles_copies_rows(const bw_particles_copies *c)
{
  return c->rows;
}

const int32_t *bw_particles_copies_asked(const bw_particles_copies *c)
{
  return c->asked;
}

void *bw_particles_copies_reply(bw_particles_copies *c)
{
  return c->reply;
}

void *bw_particles_copies_answer(bw_particles_copies *c)
{
  return c->answer;
}

void bw_particles_copies_out(bw_particles_copies *c, size_t bytes, const void *reply, void *answer)
{
  if (c->offered)
    bw_exchange_forward(c->plan, bytes, reply, answer);
  else
    bw_exchange_backward(c->plan, bytes, reply, answer);
}

void bw_particles_copies_in(bw_particles_copies *c, size_t bytes, const void *answer, void *reply)
{
  if (c->offered)
    bw_exchange_backward(c->plan, bytes, answer, reply);
  else
    bw_exchange_forward(c->plan, bytes, answer, reply);
}

void bw_particles_copies_values(bw_particles_copies *c, size_t bytes, const void *own, void *all)
{
  unsigned char *to = all;
  if (all != own && c->n > 0) memmove(all, own, c->n * bytes);
  /* In pieces that fit the buffers: nothing is allocated here. */
  for (size_t at = 0; at < bytes; at += c->width) {
    const size_t piece = bytes - at < c->width ? bytes - at : c->width;
    for (size_t q = 0; q < c->rows; q++)
      memcpy(c->reply + q * piece, to + (size_t)c->asked[q] * bytes + at, piece);
    bw_particles_copies_out(c, piece, c->reply, c->answer);
    for (size_t k = 0; k < c->copies; k++)
      memcpy(to + (c->n + k) * bytes + at, c->answer + k * piece, piece);
  }
}

void bw_particles_copies_sum(bw_particles_copies *c, int components, double all[])
{
  const size_t width = (size_t)components, room = c->width / sizeof(bw_real);
  bw_real *answer = (bw_real *)(void *)c->answer, *reply = (bw_real *)(void *)c->reply;
  for (size_t at = 0; at < width; at += room) {
    const size_t piece = width - at < room ? width - at : room;
    /* What was added to copies goes home, where several copies of one are added in turn. */
    for (size_t k = 0; k < c->copies; k++)
      for (size_t d = 0; d < piece; d++)
        answer[piece * k + d] = (bw_real)all[width * (c->n + k) + at + d];
    bw_particles_copies_in(c, piece * sizeof *answer, answer, reply);
    for (size_t q = 0; q < c->rows; q++)
      for (size_t d = 0; d < piece; d++)
        all[width * (size_t)c->asked[q] + at + d] += (double)reply[piece * q + d];
  }
}
