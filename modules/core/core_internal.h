/* core_internal.h -- shared by the sources of core only. */
#pragma once

enum { BW_MESSAGE_SIZE = 1024 };

/* Replace the last message (bw_comm_agree spreads the failing rank's). Local. */
void bw_core__set_message(const char *text);
