// SPDX-License-Identifier: MIT
#include "core/parts/helix.hpp"

#include <cmath>
#include <numbers>

#include "tests/core/parts/part_check.hpp"

namespace fettle::core::parts::helix_test {

using part_check::checked;
using part_check::draw;
using part_check::told;
using part_check::volume;
using std::numbers::pi;

TEST_CASE("a spring has the volume of Pappus, either hand") {
    const auto spring = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        return along_helix(drawing, *filled(circle({d[0], 0}, d[1], "wire")), d[2], d[3]);
    };
    for (const double pitch : {3e-3, -3e-3}) {
        const DrawnPart part = checked(spring, {8e-3, 1e-3, pitch, 3.3}, {0, 64, Lean::through});
        CHECK(volume(part) == Approx(pi * 1e-6 * 2 * pi * 8e-3 * 3.3).epsilon(5e-3));
        CHECK(part.deviation.out > 0);
    }
    CHECK(told(draw(spring, {8e-3, 1e-3, 1.5e-3, 3.3}).errors()) ==
          "wire: `wire` is 2.004 mm high and meets itself after a turn: the pitch is 1.5 mm\n");
}

TEST_CASE("a twisted bar keeps its section and its volume") {
    const auto bar = [](Drawing& drawing, const std::vector<Number>& d) -> Result<Solid> {
        const auto profile = with_hole(*filled(rectangle({-0.5 * d[0], -0.5 * d[1]}, d[0], d[1], "bar")), circle({}, 0.3 * d[1], "bore"));
        if (!profile) return profile.errors();
        return twisted(drawing, *profile, d[3], d[3] + d[2], d[4]);
    };
    for (const double twist : {1.3, -1.3}) {
        const DrawnPart part = checked(bar, {8e-3, 4e-3, 20e-3, 1e-3, twist}, {0, 96, Lean::through});
        CHECK(volume(part) == Approx((32 - pi * 1.44) * 20e-9).epsilon(2e-3));
    }
}

}  // namespace fettle::core::parts::helix_test
