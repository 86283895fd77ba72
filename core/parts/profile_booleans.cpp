// SPDX-License-Identifier: MIT
#include "fettle/core/parts/profile_booleans.hpp"
namespace fettle::core::parts {
Result<Profile> united(const std::vector<Profile>& profiles) { return together(profiles); }
}  // namespace fettle::core::parts
