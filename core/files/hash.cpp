// SPDX-License-Identifier: MIT
#include "core/files/hash.hpp"

namespace fettle::core::files {

std::string hexadecimal(std::uint64_t hash) {
    std::string text(16, '0');
    for (std::size_t k = 0; k < 16; ++k) text[15 - k] = "0123456789abcdef"[(hash >> (4 * k)) & 15];
    return text;
}

std::string hash_of(std::string_view text) {
    Fnv1a hash;
    hash.add(text);
    return hexadecimal(hash.value());
}

}  // namespace fettle::core::files
