// SPDX-License-Identifier: MIT
/// The one hash of the project: FNV-1a with 64 bits, over bytes. It shows whether files and meshes are still the same; it does not
/// withstand someone who wants two to collide.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace fettle::core::files {

/// Feed it, then read `value`. Words are taken lowest byte first, so that the machine's order of bytes does not matter.
class Fnv1a {
public:
    void add(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3u; }
    void add(std::string_view text) {
        for (const char c : text) add(static_cast<unsigned char>(c));
    }
    void add(std::uint64_t word) { add_bytes(word, 8); }
    void add(std::uint32_t word) { add_bytes(word, 4); }
    void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }

    std::uint64_t value() const { return value_; }

private:
    void add_bytes(std::uint64_t word, int bytes) {
        for (int i = 0; i < bytes; ++i, word >>= 8) add(static_cast<unsigned char>(word & 255));
    }
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// 16 hexadecimal digits.
std::string hexadecimal(std::uint64_t hash);

/// The hash of a text, as 16 hexadecimal digits.
std::string hash_of(std::string_view text);

}  // namespace fettle::core::files
