// SPDX-License-Identifier: MIT
/// For tables and hashes in memory: spreads the few bits in which numbers of one kind differ over all 64. Not for files (files/hash.hpp).
#pragma once

#include <cstdint>

namespace fettle::core::base {

/// One to one. Source: the finaliser of splitmix64 (Steele, Lea, Flood 2014).
inline std::uint64_t mixed_bits(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

}  // namespace fettle::core::base
