// SPDX-License-Identifier: MIT
#include "fettle/design/quantities/process_presets.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace fettle::design::quantities::process_presets_test {

using design::quantities::part_tolerance;
using design::quantities::process_preset;
using design::quantities::process_presets;
using design::quantities::required_clearance;

TEST_CASE("Each process requires, per side, its minimum and what both parts may be off by", "[design][presets]") {
    struct Known {
        const char* name;
        double small, middle, large;  // two parts of one band [mm]
    };
    for (const Known& known : {Known{"fdm", 0.7, 0.7, 1.2}, {"sla", 0.375, 0.625, 1.125}, {"sls", 0.6, 0.8, 1.3}, {"mjf", 0.5, 0.7, 1.2}}) {
        CAPTURE(known.name);
        const auto preset = process_preset(known.name, "");
        REQUIRE(preset);
        const auto both = [&](double size) { return 1e3 * required_clearance(*preset, size, size, "").value(); };
        CHECK(both(0.05) == Approx(known.small));
        CHECK(both(0.2) == Approx(known.middle));
        CHECK(both(0.4) == Approx(known.large));
        // One part of each band: the mean.
        CHECK(1e3 * required_clearance(*preset, 0.05, 0.4, "").value() == Approx((known.small + known.large) / 2));
        CHECK(required_clearance(*preset, 0.4, 0.05, "").value() == required_clearance(*preset, 0.05, 0.4, "").value());
    }
}

TEST_CASE("A band holds its upper end, and nothing is said beyond the last", "[design][presets]") {
    for (const auto& preset : process_presets()) {
        CAPTURE(preset.name);
        double before = 0;
        for (std::size_t i = 0; i < preset.bands.size(); ++i) {
            const auto& band = preset.bands[i];
            CHECK(band.tolerance >= before);
            CHECK(part_tolerance(preset, band.up_to, "").value() == band.tolerance);
            const auto beyond = part_tolerance(preset, std::nextafter(band.up_to, 1.0), "pair a:b");
            if (i + 1 < preset.bands.size()) {
                CHECK(beyond.value() == preset.bands[i + 1].tolerance);
                CHECK(preset.bands[i + 1].up_to > band.up_to);
            } else {
                REQUIRE(!beyond);
                CHECK(beyond.errors()[0].where == "pair a:b");
                CHECK(beyond.errors()[0].message.find("--minimum") != std::string::npos);
            }
            before = band.tolerance;
        }
        CHECK(part_tolerance(preset, 0, "").value() == preset.bands[0].tolerance);
        CHECK(preset.minimum > 0);
    }
    CHECK(process_preset("fdn", "").errors()[0].message.find("did you mean \"fdm\"?") != std::string::npos);
    CHECK(!process_preset("casting", ""));
    CHECK(design::quantities::process_table().find("per side") != std::string::npos);
}

}  // namespace fettle::design::quantities::process_presets_test
