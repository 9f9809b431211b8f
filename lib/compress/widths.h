// Loops that compilers make vectors of, once for each width that processors have: all give the same bits, for each
// number is made by the same operations.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(__GNUC__) &&                    \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ACDF_WIDTHS __attribute__((target_clones("avx2", "default")))
#else
#define ACDF_WIDTHS
#endif
