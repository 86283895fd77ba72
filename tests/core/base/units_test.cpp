// SPDX-License-Identifier: MIT
#include "core/base/units.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::base::units_test {

TEST_CASE("lengths with units become metres, rounded once", "[base]") {
    CHECK(parse_length("0.3mm").value() == 0.0003);
    CHECK(parse_length("0.3 mm").value() == 0.0003);
    CHECK(parse_length("  +1e-2 cm ").value() == 0.0001);
    CHECK(parse_length("-25 um").value() == -0.000025);
    CHECK(parse_length("2m").value() == 2);
    CHECK(parse_length("1in").value() == 0.0254);
    CHECK(parse_length("1 ft").value() == 0.3048);
    CHECK(metres_per_unit("mm").value() == 1e-3);
    CHECK(metres_per_unit("um").value() == 1e-6);
}

TEST_CASE("what is no length is refused with what is allowed", "[base]") {
    const auto code = [](const char* text) { return parse_length(text, "--minimum").errors().at(0).code; };
    CHECK(code("") == ErrorCode::parse);
    CHECK(code("mm") == ErrorCode::parse);
    CHECK(code("0.3") == ErrorCode::out_of_range);
    CHECK(code("0.3 inch") == ErrorCode::out_of_range);
    CHECK(code("0.3 MM") == ErrorCode::out_of_range);
    CHECK(code("0.3mm 4") == ErrorCode::out_of_range);
    CHECK(code("nan mm") == ErrorCode::not_finite);
    CHECK(code("inf mm") == ErrorCode::not_finite);
    CHECK(code("1e999 mm") == ErrorCode::not_finite);
    const Error error = parse_length("0.3", "--minimum").errors().at(0);
    CHECK(error.where == "--minimum");
    CHECK(error.message.find("um, mm, cm, m, in, ft") != std::string::npos);
    CHECK_FALSE(metres_per_unit("yard"));
}

TEST_CASE("lengths are written in a unit and read back", "[base]") {
    CHECK(format_length(0.0003, "mm") == "0.3 mm");
    CHECK(format_length(0.03, "mm") == "30 mm");
    CHECK(format_length(0.0254, "in") == "1 in");
    CHECK(format_length(1.0 / 3, "m", 3) == "0.333 m");
    CHECK(parse_length(format_length(0.1234567890123456, "mm", 17)).value() == Approx(0.1234567890123456).epsilon(1e-15));
    CHECK_THROWS_AS(format_length(1, "yard"), ContractError);
}

TEST_CASE("a quantity has a dimension, and another one's unit is refused", "[base]") {
    CHECK(parse_quantity("30 g", Dimension::mass).value() == 0.03);
    CHECK(parse_quantity("1.24 g/cm^3", Dimension::density).value() == 1240);
    CHECK(parse_quantity("2 N mm", Dimension::torque).value() == 0.002);
    CHECK(parse_quantity("180deg", Dimension::angle).value() == Approx(3.14159265358979));
    CHECK(parse_quantity("0.25", Dimension::number).value() == 0.25);
    const Error length = parse_quantity("30mm", Dimension::mass, "a#/x").errors().at(0);
    CHECK(length.code == ErrorCode::wrong_type);
    CHECK(length.where == "a#/x");
    CHECK(length.message.find("\"mm\" is a unit of length, a mass is expected") != std::string::npos);
    CHECK(parse_quantity("30 stone", Dimension::mass).errors().at(0).code == ErrorCode::out_of_range);
    CHECK(parse_quantity("30", Dimension::mass).errors().at(0).code == ErrorCode::out_of_range);
    CHECK_FALSE(si_per_unit("kg", Dimension::length));
    CHECK(si_per_unit("rpm", Dimension::angular_speed).value() == Approx(0.104719755119659));
    CHECK(si_per_unit("deg/s^2", Dimension::angular_acceleration).value() == Approx(0.0174532925199433));
    CHECK(parse_quantity("20 mW", Dimension::power).value() == 0.02);
    CHECK(parse_quantity("3 N s", Dimension::impulse).value() == 3);
    CHECK(parse_quantity("3 N mm s", Dimension::angular_impulse).value() == 0.003);
}

TEST_CASE("every unit has one name, and every dimension an SI unit", "[base]") {
    for (const Unit& unit : units()) {
        CHECK(find_unit(unit.name) == &unit);
        CHECK_FALSE(si_unit(unit.dimension).empty());
        CHECK(parse_quantity("3 " + std::string(unit.name), unit.dimension).value() == to_si(3, unit));
    }
}

TEST_CASE("quantities beyond any mechanism are refused", "[base]") {
    CHECK(parse_length("1e30 m").value() == 1e30);
    CHECK(parse_length("1e31 um").errors().at(0).code == ErrorCode::out_of_range);
    CHECK(parse_length("-1e40 m").errors().at(0).code == ErrorCode::out_of_range);
}

}  // namespace fettle::core::base::units_test
