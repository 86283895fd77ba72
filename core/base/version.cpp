// SPDX-License-Identifier: MIT
#include "core/base/version.hpp"

namespace fettle::core::base {

const char* version() { return FETTLE_VERSION; }

}  // namespace fettle::core::base
