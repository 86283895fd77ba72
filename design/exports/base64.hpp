// SPDX-License-Identifier: MIT
/// Bytes as text, for data URLs and for numbers within JSON.
#pragma once

#include <string>
#include <string_view>

namespace fettle::design::exports {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

}  // namespace fettle::design::exports
