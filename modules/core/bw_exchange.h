/* bw_exchange.h -- a plan for items that have to be on another rank, and for the answers.
 *
 * Set up once from the destination of each item; then moved any number of times, forth
 * (values to where they are needed) and back (answers to where the items came from). Counts
 * travel in the set-up only. Items to this rank itself are copied, not sent. The send buffer
 * grows to the largest set ever moved (running out of memory there ends the run); nothing else is
 * allocated after create. Any number of bytes may go to one partner: what is longer than
 * bw_comm_message_limit travels in several messages.
 * Life     create -> { forward, backward }* -> destroy. */
#pragma once
#include "bw_comm.h"

BW_BEGIN_DECLS

/* The plan, with its buffer. */
typedef struct bw_exchange bw_exchange;

/* Item i of this rank (0 <= i < n) goes to rank destination[i]; one item may be listed for
 * several ranks by listing it several times. The array is copied. `comm` is borrowed until
 * destroy. Ranks with n = 0 take part. BW_EMEM, agreed by all ranks; *out is NULL then.
 * Collective. */
bw_status bw_exchange_create(const bw_comm *comm, size_t n, const int destination[],
                             bw_exchange **out) BW_MUST_CHECK;

/* Free *plan and set it to NULL; NULL inside is fine. Local. */
void bw_exchange_destroy(bw_exchange **plan);

size_t bw_exchange_sent(const bw_exchange *plan);     /* n of create. Local. */
size_t bw_exchange_received(const bw_exchange *plan); /* items that arrive here. Local. */

/* receive[received] <- send[sent] over all ranks, `bytes` each: ordered by source rank, and
 * within one source in its order. Collective. */
void bw_exchange_forward(bw_exchange *plan, size_t bytes, const void *send, void *receive);

/* The way back: answer[sent] (in the order of create) <- reply[received]. Collective. */
void bw_exchange_backward(bw_exchange *plan, size_t bytes, const void *reply, void *answer);

/* Bytes sent to other ranks by one forward of items of `bytes` each. Local. */
size_t bw_exchange_volume(const bw_exchange *plan, size_t bytes);

BW_END_DECLS
