// SPDX-License-Identifier: MIT
// Pairs that are left unmeasured are as far apart as is said, by the whole search for the least distance; all others have the very answer
// that they have without; and what a certificate says of both is proven to its checker.
#include "core/clearance/far_pairs.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/base/parallel.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "tests/core/clearance/tumbling_boxes.hpp"

namespace fettle::core::clearance::far_pairs_test {

using namespace fettle::tests::support;
using fettle::tests::clearance::tumbling;
using Scene = fettle::tests::clearance::TumblingBoxes;

namespace {

// Every pair, every second one in reverse.
std::vector<PairRequest> all_pairs(const Scene& scene, double minimum, double far) {
    std::vector<PairRequest> pairs;
    const auto count = count_of(scene.model.bodies);
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            pairs.push_back((a + b) % 2 == 0 ? PairRequest{a, b, minimum, far} : PairRequest{b, a, minimum, far});
    return pairs;
}

bool are_same(const PairClearance& x, const PairClearance& y) {
    return x.a == y.a && x.b == y.b && x.lower == y.lower && x.upper == y.upper && x.sampled == y.sampled && x.status == y.status &&
           x.witness.time == y.witness.time && x.witness.point_a == y.witness.point_a && x.witness.point_b == y.witness.point_b &&
           x.solids == y.solids && x.reason == y.reason;
}

ClearanceOptions over_motion() {
    ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-4;
    options.measure_overlap = false;
    return options;
}

struct Counts {
    int far = 0, near = 0;
};

// Compares pairs asked for with `far` with the same without.
void compare(const Scene& scene, const ClearanceOptions& options, double minimum, double far, Counts& counts) {
    const auto exact = certify(scene.model, scene.trajectory, all_pairs(scene, minimum, std::numeric_limits<double>::infinity()), options);
    const auto found = certify(scene.model, scene.trajectory, all_pairs(scene, minimum, far), options);
    REQUIRE(found.size() == exact.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(far, found[i].a, found[i].b, exact[i].lower, exact[i].upper, found[i].lower);
        if (!found[i].is_far) {
            ++counts.near;
            CHECK(are_same(found[i], exact[i]));
            CHECK(!(exact[i].lower >= far && exact[i].status == PairStatus::clear));  // what is far is told so
            continue;
        }
        ++counts.far;
        CHECK(found[i].lower >= far);
        CHECK(found[i].lower <= exact[i].upper);
        CHECK(exact[i].status == PairStatus::clear);
        CHECK(found[i].status == PairStatus::clear);
        CHECK(found[i].solids == exact[i].solids);
        CHECK((std::isinf(found[i].upper) && std::isinf(found[i].sampled) && found[i].witnesses.empty()));
    }
}

}  // namespace

TEST_CASE("what is left unmeasured is far; all else is as it is without") {
    Counts motion, assembled;
    for (unsigned seed = 1; seed < 9; ++seed) {
        const Scene scene = tumbling(6, 3, seed);
        ClearanceOptions options = over_motion();
        for (const double far : {0.3, 1.0, 3.0}) compare(scene, options, 0.5 * far, far, motion);
        options.motion = false;
        for (const double far : {0.3, 1.0, 3.0}) compare(scene, options, 0.5 * far, far, assembled);
    }
    CAPTURE(motion.far, motion.near, assembled.far, assembled.near);
    CHECK((motion.far > 100 && motion.near > 50));
    CHECK((assembled.far > 100 && assembled.near > 50));
}

TEST_CASE("nothing hangs on the number of threads, nor on what else is asked") {
    const Scene scene = tumbling(8, 3, 3);
    const ClearanceOptions options = over_motion();
    const std::vector<PairRequest> pairs = all_pairs(scene, 0.1, 0.2);
    const auto found = certify(scene.model, scene.trajectory, pairs, options);
    const base::ThreadLimit limit(4);
    const auto again = certify(scene.model, scene.trajectory, pairs, options);
    for (std::size_t i = 0; i < pairs.size(); ++i) CHECK((are_same(found[i], again[i]) && found[i].is_far == again[i].is_far));
    // Each has a distance of its own that is far enough for it.
    std::vector<PairRequest> mixed = pairs;
    for (std::size_t i = 0; i < mixed.size(); i += 2) mixed[i].far = std::numeric_limits<double>::infinity();
    const auto some = certify(scene.model, scene.trajectory, mixed, options);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        CHECK(some[i].is_far == (i % 2 == 1 && found[i].is_far));
        if (!found[i].is_far) CHECK(are_same(found[i], some[i]));
    }
}

TEST_CASE("what is inside is not far, however far its surfaces; nor is what cannot be measured") {
    Scene scene;
    scene.model.bodies = {make_body("block", box_mesh({-1, -1, -1}, {1, 1, 1}), make_pose({0, 0, 0}, {0, 0, 0})),
                          make_body("inside", box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), make_pose({0, 0, 0}, {0, 0, 0})),
                          make_body("beside", box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}), make_pose({0, 0, 0}, {3, 0, 0}))};
    scene.trajectory = as_assembled(scene.model);
    ClearanceOptions options;
    const std::vector<PairRequest> pairs{{0, 1, 0.1, 0.2}, {0, 2, 0.1, 0.2}, {1, 2, 0.1, 0.2}};
    auto found = certify(scene.model, scene.trajectory, pairs, options);
    CHECK((!found[0].is_far && found[0].status == PairStatus::violated && found[0].solids == Solids::overlap));
    CHECK((found[1].is_far && found[1].solids == Solids::disjoint));
    CHECK(found[2].is_far);
    scene.trajectory.poses[0][2].position.x() = std::nan("");
    found = certify(scene.model, scene.trajectory, pairs, options);
    CHECK((!found[1].is_far && found[1].status == PairStatus::undecided && found[1].lower == 0));
    CHECK((!found[2].is_far && found[2].status == PairStatus::undecided));
    options.should_stop = [] { return true; };
    scene.trajectory = as_assembled(scene.model);
    scene.trajectory.poses[0][2].position.x() = 1.15;  // boxes do not tell: 0.05 apart
    for (const PairClearance& pair : certify(scene.model, scene.trajectory, {{0, 2, 0.01, 0.1}}, options))
        CHECK((!pair.is_far && !pair.complete));
}

TEST_CASE("a certificate covers far pairs, and claims no more than is told") {
    int far = 0;
    for (const unsigned seed : {2U, 5U}) {
        const Scene scene = tumbling(5, 2, seed);
        const std::vector<PairRequest> pairs = all_pairs(scene, 0.1, 0.2);
        auto [found, certificate] = certify_with_proof(scene.model, scene.trajectory, pairs, over_motion());
        REQUIRE(certificate.pairs.size() == pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            CHECK(certificate.pairs[i].lower == found[i].lower);
            CHECK(std::isfinite(certificate.pairs[i].upper));
            if (!found[i].is_far) continue;
            ++far;
            CHECK(found[i].lower >= 0.2);
            CHECK(certificate.pairs[i].solids == found[i].solids);
        }
        // Clashes, which nothing can certify, apart.
        auto& list = certificate.pairs;
        list.erase(std::remove_if(list.begin(), list.end(), [](const auto& pair) { return pair.lower == 0; }), list.end());
        const auto report = certificate::check_certificate(certificate, scene.model, scene.trajectory);
        for (const auto& fault : report.faults) UNSCOPED_INFO(fault.where << ": " << fault.message);
        CHECK(report.accepted());
    }
    CHECK(far > 3);
}

}  // namespace fettle::core::clearance::far_pairs_test
