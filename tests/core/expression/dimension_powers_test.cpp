// SPDX-License-Identifier: MIT
#include "core/expression/dimension_powers.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::expression::dimension_powers_test {

TEST_CASE("every dimension of a unit has powers, and is named by them") {
    for (const Unit& unit : units()) {
        INFO(unit.name);
        const auto named = named_dimension(powers_of(unit.dimension));
        REQUIRE(named);
        const bool twins = unit.dimension == Dimension::energy;  // the powers of a torque
        CHECK(*named == (twins ? Dimension::torque : unit.dimension));
    }
}

TEST_CASE("dimensions multiply, and have names where they are known") {
    const DimensionPowers length = powers_of(Dimension::length), time = powers_of(Dimension::time);
    CHECK(same(product(length, length), powers_of(Dimension::area)));
    CHECK(same(product(length, time, -1), powers_of(Dimension::speed)));
    CHECK(same(product({}, powers_of(Dimension::volume), 1.0 / 3), length));
    CHECK(product(length, length, -1).is_number());
    CHECK_FALSE(powers_of(Dimension::angle).is_number());
    CHECK(same(product(powers_of(Dimension::angular_speed), time, -1), powers_of(Dimension::angular_acceleration)));
    CHECK(same(product(powers_of(Dimension::force), powers_of(Dimension::speed)), powers_of(Dimension::power)));
    CHECK(same(product(powers_of(Dimension::force), time), powers_of(Dimension::impulse)));
    CHECK(same(product(powers_of(Dimension::mass), product(length, product(length, time, -1))), powers_of(Dimension::angular_impulse)));
    CHECK(described(length) == "a length");
    CHECK(described(powers_of(Dimension::area)) == "an area");
    CHECK(described(product(length, powers_of(Dimension::stiffness), -1)) == "a quantity in m kg^-1 s^2");
}

}  // namespace fettle::core::expression::dimension_powers_test
