/* bw_decls.h -- C linkage for the public headers, so that a C++ program can include them.
 *
 *   #include ...                  outside: an included header brings its own pair
 *   BW_BEGIN_DECLS
 *   ... types and functions ...
 *   BW_END_DECLS
 * kernel_delta, which knows no other module, spells the pair out. */
#pragma once

#ifdef __cplusplus
#define BW_BEGIN_DECLS extern "C" {
#define BW_END_DECLS   }
#else
#define BW_BEGIN_DECLS
#define BW_END_DECLS
#endif
