// SPDX-License-Identifier: MIT
#include "design/tolerances/sobol.hpp"

#include <boost/random/sobol.hpp>

#include "core/base/contract.hpp"
#include "core/base/mixed_bits.hpp"

namespace fettle::design::tolerances {

namespace {

// Number i of the stream that splitmix64 makes of a key.
std::uint64_t hashed(std::uint64_t key, std::uint64_t i) { return core::base::mixed_bits(key + i * 0x9e3779b97f4a7c15u); }

// 52 digits: what follows the 32 of the sequence is random.
std::uint64_t scrambled(std::uint32_t digits, std::uint64_t key) {
    std::uint64_t before = 1;  // the digits before; the leading 1 says how many they are
    std::uint64_t result = 0;
    for (int b = 31; b >= 0; --b) {
        const std::uint64_t digit = digits >> b & 1;
        result = result << 1 | (digit ^ hashed(key, before) >> 63);
        before = before << 1 | digit;
    }
    return result << 20 | hashed(key, before) >> 44;
}

}  // namespace

SobolPoints::SobolPoints(int dimension, std::uint64_t seed) {
    FETTLE_ASSERT(dimension >= 1 && dimension <= most_dimensions, "direction numbers are there for 1 to 3667 dimensions");
    direction_numbers_.resize(static_cast<size_t>(dimension) * digits);
    for (int r = 0; r < digits; ++r) {
        // Point j of Boost's order is the sum of the direction numbers of the digits of j ^ (j >> 1), and its first point has j = 1:
        // j = 2^(r + 1) - 1 is direction number r alone.
        boost::random::sobol sequence(static_cast<size_t>(dimension));
        sequence.seed((std::uint64_t{2} << r) - 2);
        for (int d = 0; d < dimension; ++d)
            direction_numbers_[static_cast<size_t>(d * digits + r)] = static_cast<std::uint32_t>(sequence() >> 32);
    }
    const std::uint64_t stream = core::base::mixed_bits(seed + 1);  // mixed_bits(0) is 0
    for (int d = 0; d < dimension; ++d) keys_.push_back(hashed(stream, static_cast<std::uint64_t>(d) + 1));
}

std::uint32_t SobolPoints::unscrambled(std::uint32_t k, int d) const {
    FETTLE_ASSERT(d >= 0 && d < dimension(), "a coordinate");
    const std::uint32_t* direction_number = &direction_numbers_[static_cast<size_t>(d * digits)];
    std::uint32_t result = 0;
    for (; k != 0; k >>= 1, ++direction_number)
        if (k & 1) result ^= *direction_number;
    return result;
}

VectorX SobolPoints::point(std::uint32_t k) const {
    VectorX result(dimension());
    for (int d = 0; d < dimension(); ++d)
        result[d] = (static_cast<double>(scrambled(unscrambled(k, d), keys_[static_cast<size_t>(d)])) + 0.5) * 0x1p-52;
    return result;
}

}  // namespace fettle::design::tolerances
