/* bw_particles_copies.h -- copies of particles that others own: values out, sums back.
 *
 * Own particles have the numbers 0 .. n-1 of their rank; its copies follow as n .. n + copies - 1.
 * Who needs a copy asks the owner for it by a key (a lattice site, an identity), or the owner gives
 * it unasked; either way the plan is made once and used many times. A rank may have copies of its
 * own particles (images across a period), and several of one particle.
 * The owner's side works on rows, one per copy given: row q is a copy of own particle asked[q].
 * Life     create or offer -> { values, sum, out, in }* -> destroy. */
#pragma once
#include "bw_comm.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bw_particles_copies bw_particles_copies;

/* The number of the own particle that a key names; -1: there is none. Called on the owner's rank,
 * as often as its particles are asked for; `context` is the owner's own pointer. */
typedef int32_t bw_particles_find(const void *context, const void *key);

/* What a rank asks of others, and how it answers what it is asked. Arrays are borrowed during the
 * call they are passed to. */
typedef struct {
  size_t n;                /* questions of this rank; 0 is fine */
  const int *owner;        /* (n) rank that is asked, 0 .. size-1 */
  size_t key_bytes;        /* of one key; the same on all ranks */
  const void *key;         /* (n) keys, e.g. (n,3) int32_t sites or (n) int64_t identities */
  bw_particles_find *find; /* answers what this rank is asked */
  const void *context;     /* passed to find */
} bw_particles_question;

/* index[q] <- number on its rank of the particle that question q names, -1 if the rank asked has no
 * such particle: tells which places around own particles are occupied, before copies are made.
 * BW_EMEM, the same on all ranks. Collective. */
bw_status bw_particles_ask(const bw_comm *comm, const bw_particles_question *question,
                           int32_t index[]) BW_MUST_CHECK;

/* Copies that their holders ask for: copy c, which gets the number n + c, is of the particle that
 * question c names. n: own particles of this rank. Values of up to `width` bytes per particle are
 * moved without another allocation, wider ones in pieces of that width; width >= 8, the same on all
 * ranks. `comm` is borrowed until destroy. *out is owned by the caller, NULL after a failure.
 * BW_EINPUT when somebody is asked for a particle that it does not have (the key is named),
 * BW_EMEM; the same on all ranks. Collective. */
bw_status bw_particles_copies_create(const bw_comm *comm, size_t n,
                                     const bw_particles_question *question, size_t width,
                                     bw_particles_copies **out) BW_MUST_CHECK;

/* Copies that their owners give unasked: row q, 0 <= q < rows, is of own particle own[q] and goes
 * to the rank destination[q]. Copies of a rank are ordered by the owner's rank and within it as the
 * owner lists them. Both arrays are copied; all else as above. Collective. */
bw_status bw_particles_copies_offer(const bw_comm *comm, size_t n, size_t rows, const int32_t own[],
                                    const int destination[], size_t width,
                                    bw_particles_copies **out) BW_MUST_CHECK;

void bw_particles_copies_destroy(bw_particles_copies **copies); /* NULL is fine. Local. */

size_t bw_particles_copies_count(const bw_particles_copies *copies); /* of this rank. Local. */
size_t bw_particles_copies_rows(const bw_particles_copies *copies);  /* given by it. Local. */

/* (rows) own particle of each row; owned by the object. Local. */
const int32_t *bw_particles_copies_asked(const bw_particles_copies *copies);

/* own[n] values of `bytes` each -> all[n + copies]: own ones first, then what the owners of the
 * copies hold. own == all is allowed. Collective. */
void bw_particles_copies_values(bw_particles_copies *copies, size_t bytes, const void *own,
                                void *all);

/* all (n + copies, components): what the copies hold is added to what their owners hold, in the
 * order of the rows; the copies' own values stay. It travels in bw_real. Collective. */
void bw_particles_copies_sum(bw_particles_copies *copies, int components, double all[]);

/* For callers that pack themselves: reply[rows] on the owners' ranks -> answer[copies], `bytes`
 * each. Bytes beyond `width` may allocate. Collective. */
void bw_particles_copies_out(bw_particles_copies *copies, size_t bytes, const void *reply,
                             void *answer);
/* And back: answer[copies] -> reply[rows]. Collective. */
void bw_particles_copies_in(bw_particles_copies *copies, size_t bytes, const void *answer,
                            void *reply);

/* Room for one call of `out` or `in`: (rows, width) and (copies, width) bytes, aligned to 64; owned
 * by the object, written by every collective function above. Local. */
void *bw_particles_copies_reply(bw_particles_copies *copies);
void *bw_particles_copies_answer(bw_particles_copies *copies);

#ifdef __cplusplus
}
#endif
