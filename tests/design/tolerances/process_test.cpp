// SPDX-License-Identifier: MIT
#include "design/tolerances/process.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "design/tolerances/known_processes.hpp"

namespace fettle::design::tolerances::process_test {

namespace {

constexpr double mm = 1e-3;

DeviationLimits limits(const char* process, FeatureKind kind, double size) {
    return process_deviation(*find_known_process(process), kind, size * mm, "").value().limits;
}
// Bias and half width [mm].
void check(const char* process, FeatureKind kind, double size, double bias, double width) {
    CAPTURE(process, to_string(kind), size);
    const DeviationLimits found = limits(process, kind, size);
    CHECK((found.lower + found.upper) / 2 / mm == Approx(bias).margin(1e-12));
    CHECK((found.upper - found.lower) / 2 / mm == Approx(width));
}

}  // namespace

TEST_CASE("processes: the published figures, by kind and size") {
    check("fdm", FeatureKind::length, 20, 0, 0.3);
    check("fdm", FeatureKind::length, 100, 0, 0.3);
    check("fdm", FeatureKind::length, 200, 0, 1);
    check("fdm", FeatureKind::hole, 8, -0.2, 0.3);
    check("fdm", FeatureKind::pin, 8, 0, 0.3);
    check("sla", FeatureKind::hole, 8, 0, 0.1);
    check("sla", FeatureKind::wall, 150, 0, 0.3);
    check("sls", FeatureKind::height, 30, 0, 0.2);
    check("sls", FeatureKind::gap, 1, -0.15, 0.2);
    check("sls", FeatureKind::length, 300, 0, 0.6);
    check("mjf", FeatureKind::slot, 5, -0.15, 0.3);
    check("mjf", FeatureKind::length, 250, 0, 0.5);
    check("cnc", FeatureKind::pin, 25, 0, 0.2);
    check("cnc", FeatureKind::length, 200, 0, 0.5);
    check("laser", FeatureKind::hole, 25, 0.2, 0.13);
    check("laser", FeatureKind::wall, 25, -0.2, 0.13);
    for (const Process& process : known_processes()) {
        CAPTURE(process.name);
        CHECK(process.name == find_known_process(process.name)->name);
        for (const FeatureSpread& feature : process.features) CHECK(!feature.source.empty());
    }
    CHECK(find_known_process("casting") == nullptr);
}

TEST_CASE("processes: an angle by its shorter leg, of what lengths are off by or by its class") {
    CHECK(limits("fdm", FeatureKind::angle, 30).upper == Approx(0.01));  // 0.3 mm on 30 mm
    CHECK(limits("fdm", FeatureKind::angle, 30).lower == Approx(-0.01));
    CHECK(limits("cnc", FeatureKind::angle, 30).upper == Approx(0.5 * std::numbers::pi / 180));  // ISO 2768-m, 10 to 50 mm: 30'
}

TEST_CASE("processes: what is not covered is refused") {
    const auto refused = [](const char* process, FeatureKind kind, double size) {
        const auto found = process_deviation(*find_known_process(process), kind, size, "x");
        REQUIRE(!found);
        CHECK(found.errors()[0].where == "x");
        return found.errors()[0];
    };
    CHECK(refused("laser", FeatureKind::height, 3 * mm).message ==
          "process \"laser\" says nothing of features of the kind height; it has hole, pin, slot, gap, wall, length");
    CHECK(refused("fdm", FeatureKind::hole, 0).code == ErrorCode::out_of_range);
    CHECK(refused("fdm", FeatureKind::hole, -1 * mm).code == ErrorCode::out_of_range);
    CHECK(refused("fdm", FeatureKind::angle, 0).message.find("shorter leg") != std::string::npos);
    CHECK(refused("fdm", FeatureKind::hole, std::nan("")).code == ErrorCode::not_finite);
    CHECK(refused("cnc", FeatureKind::wall, 0.3 * mm).message.find("below 0.5 mm") != std::string::npos);
}

TEST_CASE("processes: a bias by size holds between the sizes that it was measured at, and stays beyond") {
    const Process process{"mine", "", 0, {{FeatureKind::hole, -0.1 * mm, 0.01, 0.06 * mm, 0, 0, "", 3 * mm, 8 * mm, ""}}, std::nullopt};
    const auto at = [&](double size) { return process_deviation(process, FeatureKind::hole, size * mm, "").value(); };
    CHECK(at(5).limits.upper / mm == Approx(-0.05 + 0.06));
    CHECK(at(5).is_sure_size);
    CHECK(at(8).is_sure_size);
    CHECK(at(40).limits.lower / mm == Approx(-0.02 - 0.06));
    CHECK(!at(40).is_sure_size);
    CHECK(at(1).limits.lower / mm == Approx(-0.07 - 0.06));
    CHECK(!at(1).is_sure_size);
}

TEST_CASE("processes: what the features of one print share") {
    const Process& fdm = *find_known_process("fdm");
    CHECK(shared_part(fdm, FeatureKind::hole).group == "fdm");
    CHECK(shared_part(fdm, FeatureKind::hole).correlation == -0.5);
    CHECK(shared_part(fdm, FeatureKind::pin).correlation == 0.5);
    CHECK(shared_part(fdm, FeatureKind::length).group == "fdm lengths");
    CHECK(shared_part(fdm, FeatureKind::height).group == "fdm heights");
    CHECK(shared_part(fdm, FeatureKind::angle).group.empty());
    CHECK(shared_part(*find_known_process("cnc"), FeatureKind::hole).group.empty());
}

}  // namespace fettle::design::tolerances::process_test
