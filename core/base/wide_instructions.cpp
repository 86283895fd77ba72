// SPDX-License-Identifier: MIT
#include "core/base/wide_instructions.hpp"

#include <cstdlib>

namespace fettle::core::base {

bool has_wide_instructions() {
#ifdef __x86_64__
    static const bool has = __builtin_cpu_supports("avx2") && std::getenv("FETTLE_BASELINE_INSTRUCTIONS") == nullptr;
    return has;
#else
    return false;
#endif
}

}  // namespace fettle::core::base
