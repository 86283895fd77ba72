// SPDX-License-Identifier: MIT
/// Instructions for four doubles at a time, used where the processor has them. Each operation rounds by itself, so that bits are the same
/// with and without (nothing is compiled to fused multiply-adds).
///
///     [[gnu::always_inline]] inline void work(const double* x, double* out);             // on Four inside
///     FETTLE_WIDE void work_wide(const double* x, double* out) { work(x, out); }
///     if (base::has_wide_instructions()) work_wide(x, out); else work(x, out);
///
/// What takes or gives a Four does so by reference: how such values are passed depends on the instructions that a function is compiled for.
#pragma once

namespace fettle::core::base {

using Four = double __attribute__((vector_size(32)));

#ifdef __x86_64__
#define FETTLE_WIDE [[gnu::target("avx2")]]
#else
#define FETTLE_WIDE
#endif

/// Does the processor have what FETTLE_WIDE stands for? Not with FETTLE_BASELINE_INSTRUCTIONS in the environment, for tests that compare.
bool has_wide_instructions();

}  // namespace fettle::core::base
