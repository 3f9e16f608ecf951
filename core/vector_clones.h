// SPDX-License-Identifier: BSD-3-Clause
// Functions that are compiled twice, for every x86-64 processor and for those with AVX2, and chosen when the
// program starts.
//
// For loops over doubles that compilers make vectors: twice as many numbers at once. The bits are the same:
// vectors are not summed in another order, and nothing is contracted (-ffp-contract=off). Other processors
// and compilers have one of them; so have sanitizers, which cannot choose so early.
#pragma once

// Whether the processor is of the kind whose functions may be compiled for AVX2 and AVX-512 by hand
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
