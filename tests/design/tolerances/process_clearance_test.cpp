// SPDX-License-Identifier: MIT
#include "design/tolerances/process_clearance.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "design/tolerances/known_processes.hpp"

namespace fettle::design::tolerances::process_clearance_test {

TEST_CASE("Each process requires, per side, its minimum and what both parts may be off by", "[design][presets]") {
    struct Known {
        const char* name;
        double small, middle, large;  // two parts of one band [mm]
    };
    for (const Known& known : {Known{"fdm", 0.7, 0.7, 1.2}, {"sla", 0.375, 0.625, 1.125}, {"sls", 0.6, 0.8, 1.3}, {"mjf", 0.5, 0.7, 1.2}}) {
        CAPTURE(known.name);
        const Process* process = find_known_process(known.name);
        REQUIRE(process != nullptr);
        const auto both = [&](double size) { return 1e3 * required_clearance(*process, size, size, "").value(); };
        CHECK(both(0.05) == Approx(known.small));
        CHECK(both(0.2) == Approx(known.middle));
        CHECK(both(0.4) == Approx(known.large));
        // One part of each band: the mean.
        CHECK(1e3 * required_clearance(*process, 0.05, 0.4, "").value() == Approx((known.small + known.large) / 2));
        CHECK(required_clearance(*process, 0.4, 0.05, "").value() == required_clearance(*process, 0.05, 0.4, "").value());
    }
}

TEST_CASE("A band holds its upper end, and nothing is said beyond the last", "[design][presets]") {
    for (const Process& process : known_processes()) {
        CAPTURE(process.name);
        if (!process.clearance) continue;
        double before = 0;
        const std::vector<SizeBand>& bands = process.clearance->bands;
        for (std::size_t i = 0; i < bands.size(); ++i) {
            const auto& band = bands[i];
            CHECK(band.tolerance >= before);
            CHECK(part_tolerance(process, band.up_to, "").value() == band.tolerance);
            const auto beyond = part_tolerance(process, std::nextafter(band.up_to, 1.0), "pair a:b");
            if (i + 1 < bands.size()) {
                CHECK(beyond.value() == bands[i + 1].tolerance);
                CHECK(bands[i + 1].up_to > band.up_to);
            } else {
                REQUIRE(!beyond);
                CHECK(beyond.errors()[0].where == "pair a:b");
                CHECK(beyond.errors()[0].message.find("--minimum") != std::string::npos);
            }
            before = band.tolerance;
        }
        CHECK(part_tolerance(process, 0, "").value() == bands[0].tolerance);
        CHECK(process.clearance->minimum > 0);
    }
    CHECK(clearance_table().find("per side") != std::string::npos);
    CHECK(clearance_table().find("laser") == std::string::npos);
}

TEST_CASE("A process that says nothing of clearances is refused, and one without bands goes by its lengths") {
    const auto refused = required_clearance(*find_known_process("cnc"), 0.05, 0.05, "pair a:b");
    REQUIRE(!refused);
    CHECK(refused.errors()[0].code == ErrorCode::unsupported);
    CHECK(refused.errors()[0].message.find("minimum_gap") != std::string::npos);
    Process own{"own", "", 0, {{FeatureKind::length, 0.04e-3, 0, 0.1e-3, 0.01, 50e-3}}, ClearanceNeed{0.1e-3, "", {}}};
    // T = 0.14 of a small part, 0.04 + 0.8 of one of 80 mm.
    CHECK(required_clearance(own, 20e-3, 80e-3, "").value() == Approx((0.1 + 0.07 + 0.42) * 1e-3));
}

}  // namespace fettle::design::tolerances::process_clearance_test
