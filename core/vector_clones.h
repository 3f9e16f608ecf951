// SPDX-License-Identifier: BSD-3-Clause
// Attribute for functions that are compiled twice, for every x86-64 processor and for those with AVX2; the
// version is chosen when the program starts.
//
// It is meant for loops over doubles that compilers vectorise, with twice as many numbers at once. The
// results have the same bits: sums are not reordered, and expressions are not contracted (-ffp-contract=off).
// On other processors and compilers there is one version, and likewise under sanitizers, which cannot choose
// so early.
#pragma once

// 1 if the processor is of the kind whose functions may be compiled for AVX2 and AVX-512 explicitly
// ([[gnu::target]]).
#if defined(__x86_64__)
#define HALOCLINE_HAS_X86_VECTORS 1
#else
#define HALOCLINE_HAS_X86_VECTORS 0
#endif

#if HALOCLINE_HAS_X86_VECTORS && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HALOCLINE_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HALOCLINE_VECTOR_CLONES
#endif
