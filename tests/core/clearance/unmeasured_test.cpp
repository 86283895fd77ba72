// SPDX-License-Identifier: MIT
// Numbers that are not finite, or absurd, handed to the library: undecided, soon, and never "clear".
#include <catch2/catch.hpp>

#include <limits>

#include "core/clearance/search_front.hpp"
#include "tests/core/clearance/clearance_models.hpp"

namespace fettle::core::clearance::unmeasured_test {

using namespace fettle::tests::clearance;

namespace {

const Vector3 zero = Vector3::Zero();

void check_undecided(const PairClearance& result) {
    CHECK(result.status == PairStatus::undecided);
    CHECK(result.lower == 0);
    CHECK(!std::isnan(result.upper));
    CHECK(!result.reason.empty());
}

}  // namespace

TEST_CASE("Paths that are no numbers or absurd ones are undecided", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {3, 0, 0}});
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double x : {nan, inf, -inf, 1e160, 1e158, 1e31, 1e25, 1e300}) {
        CAPTURE(x);
        for (const double minimum : {0.0, 0.1}) {
            for (const bool with_certificate : {false, true}) {
                const auto check = [&](const core::stepper::Trajectory& trajectory) {
                    const auto [pairs, certificate] = certified(model, trajectory, minimum, over_motion(), with_certificate);
                    check_undecided(pairs[0]);
                    CHECK(certificate.pairs.empty());
                };
                const auto moved = one_step(model, {{{3, 0, 0}, zero}, {{x, 0, 0}, zero}});
                check(moved);
                auto turned = one_step(model, {{{3, 0, 0}, zero}, {{3, 0, 0}, {0, x, 0}}});
                turned.poses[1] = turned.poses[0];
                check(turned);
                auto start = as_assembled(model);
                start.poses[0][1].position.y() = x;
                if (x != 1e25) check(start);  // that far they are apart
                start.poses[0][1].position.y() = 0;
                start.poses[0][1].rotation(1, 2) = x;
                check(start);
            }
        }
    }
    // The pairs beside it are measured all the same.
    const auto three = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5}), box({1, 1, 1})}, {{0, 0, 0}, {3, 0, 0}, {nan, 0, 0}});
    const auto results = certify(three, as_assembled(three), {{0, 2, 0}, {0, 1, 0.1}}, options_with(1e-6));
    check_undecided(results[0]);
    CHECK(results[1].status == PairStatus::clear);
}

TEST_CASE("A bound that is no number proves nothing", "[clearance]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    double dip = -1;
    for (std::size_t i = 0; i < 4; ++i) {
        Coefficients c{1, 1, 1, 1};
        c[i] = nan;
        CHECK(!(least_value(c, dip) > 0));
        c[i] = std::numeric_limits<double>::infinity();
        CHECK(!(least_value(c, dip) > 0));
    }
    CHECK(std::isnan(least_of(nan, 1)));
    CHECK(std::isnan(least_of(1, nan)));
    const Solid solid = box({1, 1, 1});
    const PieceTree tree = make_piece_tree(solid.mesh, *solid.hierarchy);
    const std::vector<PairSegment> segments{pair_segment(core::kinematics::PathSegment{}, core::kinematics::PathSegment{}, 1, 1)};
    const SearchOptions options;
    for (const bool aside : {true, false}) {
        SearchFront front(tree, tree, segments, options, -1);
        front.push(1, EntryKind::segment, 0);
        if (aside)
            front.set_aside(nan);
        else
            front.push(nan, EntryKind::segment, 1);
        CHECK(front.lower_bound() == 0);
        CHECK(front.is_settled());
    }
}

}  // namespace fettle::core::clearance::unmeasured_test
