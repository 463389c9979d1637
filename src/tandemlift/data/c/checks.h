/* What the arithmetic of these files needs: IEEE 754, every operation rounded on its own to its own type. */
#ifndef TANDEMLIFT_CHECKS_H
#define TANDEMLIFT_CHECKS_H

#include <float.h>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) \
    || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "compile without -ffast-math and what it contains: NaN and the order of sums matter here"
#endif
/* What compilers would do all the same: reorder sums, or fuse a product and a sum into one instruction, rounded once. */
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wignored-pragmas" /* some processors do not have it */
#pragma float_control(precise, on)
#pragma clang diagnostic pop
#pragma clang fp reassociate(off)
#elif defined(__GNUC__)
#if defined(__FMA__) /* GCC makes vfmaddsub of neighbours, whatever -ffp-contract says */
#pragma GCC optimize("no-tree-slp-vectorize")
#endif
#if !defined(__STRICT_ANSI__) /* -std=gnu99 and the like fuse by default */
#pragma GCC optimize("fp-contract=off")
#endif
#endif
#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || FLT_MANT_DIG != 24
#error "float and double must be those of IEEE 754, with 24 and 53 bits"
#endif
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "operations must be rounded to their own type, not to long double: on 32-bit x86, -msse2 -mfpmath=sse"
#endif
#if defined(_MSC_VER) && defined(_M_FP_FAST)
#error "compile with /fp:precise"
#endif

/* What a self-test says when bits differ: some options are seen in the results only. */
#define TANDEMLIFT_WRONG_BITS \
    "This compiler or an option changes results: compile with -std=c99 -O2 -ffp-contract=off, without" \
    " -funsafe-math-optimizations and -ffp-contract=fast"

#endif
