#pragma once

/// Before a function whose time counts: compiled for generic x86-64 and again for AVX2; the faster
/// one is chosen when the program starts. Other processors, and sanitizers (which cannot run code
/// before they are set up), get the generic one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SCREE_MULTIVERSION __attribute__((target_clones("default", "avx2")))
#else
#define SCREE_MULTIVERSION
#endif
