// SPDX-License-Identifier: MIT
#include "fettle/design/description/parameter.hpp"

#include <catch2/catch.hpp>

namespace fettle::design::description::parameter_test {

using fettle::design::description::from_si;
using fettle::design::description::representable;

TEST_CASE("units of parameters: file values and SI values go both ways bit for bit") {
    for (const fettle::Unit& unit : fettle::units()) {
        for (const double value : {14.7, 0.1, 1.0 / 3, 13.5, 5.345, 1240.0}) {
            INFO(unit.name << " " << value);
            CHECK(fettle::to_si(from_si(fettle::to_si(value, unit), unit), unit) == fettle::to_si(value, unit));
            const double near = representable(value * 1.000000123456789, unit);
            CHECK(representable(near, unit) == near);
            CHECK(near == Approx(value * 1.000000123456789).epsilon(1e-15));
        }
    }
    CHECK(fettle::to_si(14.7, *fettle::find_unit("mm")) == 0.0147);
    CHECK(from_si(0.0147, *fettle::find_unit("mm")) == 14.7);
}

}  // namespace fettle::design::description::parameter_test
