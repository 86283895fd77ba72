// SPDX-License-Identifier: MIT
/// Points that fill the unit cube more evenly than random ones, so that averages over them need fewer: of a smooth function of ten
/// variables the error was seen to fall about as 1 / n from 16 to 65536 points (in the limit nearly as n^(-3/2)), of random points as
/// n^(-1/2).
///
///   Sobol sequence: binary digit b of coordinate d of point k is a sum modulo 2 of digits of k, by direction numbers (Joe and Kuo 2008,
///   SIAM J. Sci. Comput. 30, as boost/random/sobol.hpp has them).
///   Nested uniform scrambling (Owen 1995, in Monte Carlo and Quasi-Monte Carlo Methods): digit b of a coordinate is flipped or not by a
///   random bit that belongs to the digits before it. Each point is then uniform in the cube, so that averages have no bias, and the
///   sequence stays as even as it was. The random bits are a hash of seed, coordinate and digits before (Burley 2020, Practical Hash-based
///   Owen Scrambling, JCGT 9(4); there a cheaper hash, of Laine and Karras, scrambles all digits at once).
///
/// The first 2^m points are the most even: a number of points is best a power of 2. Each point follows from its index alone, in integer
/// arithmetic: it has the same bits on any machine, in any order, on any number of threads, and a run that is taken up again goes on as if
/// it had never ended.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::tolerances {

class SobolPoints {
public:
    static constexpr int most_dimensions = 3667;  ///< for which there are direction numbers

    /// @param dimension  Contract: 1 to most_dimensions.
    /// @param seed       Different seeds give independent scramblings.
    SobolPoints(int dimension, std::uint64_t seed);

    int dimension() const { return static_cast<int>(keys_.size()); }

    /// Point k of the scrambled sequence; coordinates are odd multiples of 2^-53 in (0, 1).
    VectorX point(std::uint32_t k) const;

    /// The first 32 binary digits of coordinate d of point k, highest first, before scrambling. Contract: 0 <= d < dimension.
    std::uint32_t unscrambled(std::uint32_t k, int d) const;

private:
    static constexpr int digits = 32;
    std::vector<std::uint32_t> direction_numbers_;  // of coordinate d and digit r of an index: at digits * d + r
    std::vector<std::uint64_t> keys_;               // of the hash, by coordinate
};

}  // namespace fettle::design::tolerances
