// SPDX-License-Identifier: MIT
/// The version of the library, as CMakeLists.txt states it.
#pragma once

namespace fettle::core::base {

/// "major.minor.patch"
const char* version();

}  // namespace fettle::core::base
