// SPDX-License-Identifier: MIT
/// Words for messages.
#pragma once

#include <string>

namespace fettle::core::base {

/// The strings, in their order, with ", " between them.
template <class Strings>
std::string joined(const Strings& strings) {
    std::string text;
    for (const auto& each : strings) (text += text.empty() ? "" : ", ") += each;
    return text;
}

}  // namespace fettle::core::base
