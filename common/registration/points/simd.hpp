#pragma once
// Debian's baseline is SSE2; a kernel marked LILOC_WIDE is compiled for AVX2 as well and chosen at load time.
// LILOC_WIDEST, for integers, adds AVX-512; floats would round differently there, by fused multiplication.
// Sanitized builds keep the baseline: their runtimes start after the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LILOC_SANITIZED)
#define LILOC_WIDE __attribute__((target_clones("avx2", "default")))
#define LILOC_WIDEST __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define LILOC_WIDE
#define LILOC_WIDEST
#endif
