// SPDX-License-Identifier: MIT
#include "design/description/parameter.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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

TEST_CASE("values far outside their bounds, and those that are no numbers, are told by name") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const std::vector<Parameter> parameters{{"height", 8e-3, 6e-3, 12e-3, *fettle::find_unit("mm")}, {"share", 0.5, 0, 1, {}}};
    const auto errors_at = [&](double height, double share) { return check_values(parameters, Eigen::Vector2d(height, share)); };
    CHECK(errors_at(8e-3, 0.5).empty());
    CHECK(errors_at(0.1e-3, 1.9).empty());  // differences and searches may look beyond
    CHECK(errors_at(17.9e-3, -0.9).empty());
    REQUIRE(errors_at(8, 0.5).size() == 1);  // a factor of 1000
    CHECK(errors_at(8, 0.5)[0].code == ErrorCode::out_of_range);
    CHECK(errors_at(8, 0.5)[0].where == "p/height");
    CHECK(errors_at(8, 0.5)[0].message.find("8000 mm is far outside its bounds, 6 mm to 12 mm") == 0);
    CHECK(errors_at(-0.1e-3, 2.1).size() == 2);
    for (const double bad : {nan, infinity, -infinity}) {
        REQUIRE(errors_at(8e-3, bad).size() == 1);
        CHECK(errors_at(8e-3, bad)[0].code == ErrorCode::not_finite);
        CHECK(errors_at(8e-3, bad)[0].where == "p/share");
    }
    CHECK(check_values(parameters, VectorX::Zero(3)).at(0).code == ErrorCode::inconsistent);
}

}  // namespace fettle::design::description::parameter_test
