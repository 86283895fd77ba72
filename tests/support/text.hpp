// SPDX-License-Identifier: MIT
/// What tests ask of messages.
#pragma once

#include <string>

namespace fettle::tests::support {

/// Whether part stands somewhere in text.
inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace fettle::tests::support
