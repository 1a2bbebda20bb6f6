/* specimen_main.h -- the driver of the cases that break a specimen. */
#pragma once

/* Returns the exit code. */
int specimen_main(int argc, char **argv, const char *name, const char *title);
