// SPDX-License-Identifier: MIT
// Every part of the library with every dimension very large, very small, nothing, negative, no number: a solid whose numbers are finite, or
// a refusal with words.
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "core/geometry/mass_moments.hpp"
#include "design/shapes/part_library.hpp"
#include "tests/design/shapes/part_campaign.hpp"

namespace fettle::design::shapes::extreme_dimensions_test {

namespace {

using core::part_files::PartFile;
using part_campaign::Values;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Extreme values of a dimension as it is, or in [m].
Values extremes(double usual) {
    Values out{0, -0.0, -usual, infinity, -infinity, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::denorm_min()};
    for (const double power : {-300, -150, -30, -15, -12, -9, -6, -3, 3, 5, 6, 8, 9, 12, 15, 30, 150, 300}) {
        out.push_back(std::pow(10, power));
        out.push_back(usual * std::pow(10, power / 2));
    }
    return out;
}

// The fault of what is drawn; empty: none.
std::string fault_at(const PartFile& file, const Values& values) {
    core::parts::Facets coarse;
    coarse.segments = 8;
    const auto part = file.drawn(values, coarse);
    if (!part) {
        for (const Error& error : part.errors())
            if (error.message.empty()) return "a refusal without words";
        return {};
    }
    if (!part->mesh.vertices.allFinite()) return "vertices that are not finite";
    if (!std::isfinite(part->deviation.out) || !std::isfinite(part->deviation.in)) return "deviations that are not finite";
    // That it is closed and does not cross itself is looked at as it is drawn; it may touch itself in a point, as a roof of nothing does.
    const double volume = core::geometry::solid_moments(part->mesh.vertices, part->mesh.triangles)(3, 3);
    return volume >= 0 && std::isfinite(volume) ? std::string() : "a volume of " + std::to_string(volume) + " m^3";
}

}  // namespace

TEST_CASE("parts of the library with an extreme dimension are solids, or refused with words") {
    std::mt19937 random(3);
    for (const LibraryPart& kind : part_library()) {
        const PartFile file = find_part(std::string(kind.name)).value();
        for (int k = 0; k < 3; ++k) {
            Values values = part_campaign::defaults(file);
            const std::size_t which = random() % values.size();
            const Values all = extremes(values[which]);
            values[which] = all[random() % all.size()];
            INFO(kind.name << ": " << file.dimensions()[which].name << " = " << values[which]);
            CHECK(fault_at(file, values) == "");
        }
    }
}

TEST_CASE("lengths too far apart for a solid are named, and not told as a hole in it") {
    const PartFile driver = find_part("geneva_driver").value();
    Values values = part_campaign::defaults(driver);
    for (std::size_t k = 0; k < values.size(); ++k)
        if (driver.dimensions()[k].name == "border") values[k] = 1e6;
    const auto part = driver.drawn(values, {});
    REQUIRE_FALSE(part);
    CHECK(part.errors().size() == 1);
    CHECK(part.errors().front().message.find("lengths so far apart make no solid") != std::string::npos);
}

TEST_CASE("each dimension of each part of the library with each extreme, and several at once", "[slow]") {
    std::mt19937 random(4);
    for (const LibraryPart& kind : part_library()) {
        const PartFile file = find_part(std::string(kind.name)).value();
        const Values usual = part_campaign::defaults(file);
        for (std::size_t which = 0; which < usual.size(); ++which)
            for (const double value : extremes(usual[which])) {
                Values values = usual;
                values[which] = value;
                INFO(kind.name << ": " << file.dimensions()[which].name << " = " << value);
                CHECK(fault_at(file, values) == "");
            }
        for (int k = 0; k < 50; ++k) {  // larger or smaller as a whole, which relations allow, and some of them by themselves
            Values values = usual;
            const double scale = std::pow(10, std::uniform_int_distribution<int>(-40, 40)(random));
            std::string told;
            for (std::size_t d = 0; d < values.size(); ++d) {
                const bool is_angle = file.dimensions()[d].kind == core::part_files::PartDimensionKind::angle;
                if (!is_angle) values[d] *= scale;
                if (random() % 8 == 0) values[d] *= std::pow(10, std::uniform_int_distribution<int>(-12, 12)(random));
                told += " " + std::to_string(values[d]);
            }
            INFO(kind.name << ":" << told);
            CHECK(fault_at(file, values) == "");
        }
    }
}

}  // namespace fettle::design::shapes::extreme_dimensions_test
