#pragma once
// Debian's baseline is SSE2; a kernel marked LILOC_WIDE is compiled for AVX2 as well and chosen at load time.
// Sanitized builds keep the baseline: their runtimes start after the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LILOC_SANITIZED)
#define LILOC_WIDE __attribute__((target_clones("avx2,fma", "default")))
#else
#define LILOC_WIDE
#endif
