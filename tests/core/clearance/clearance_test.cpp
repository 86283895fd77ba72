// SPDX-License-Identifier: MIT
#include "core/clearance/clearance.hpp"

#include <catch2/catch.hpp>

#include "core/base/parallel.hpp"
#include "tests/core/clearance/clearance_models.hpp"

namespace fettle::core::clearance::clearance_test {

using namespace fettle::tests::clearance;

TEST_CASE("Boxes as assembled: bounds, status and witness", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5}), box({1, 1, 1})}, {{0, 0, 0}, {2, 0.1, 0.2}, {0, 2.00005, 0}});
    const auto start = as_assembled(model);
    CHECK(start.steps.empty());
    CHECK(start.body_names[2] == "body 2");
    const auto results =
        certify(model, start, {{0, 1, 0.4}, {0, 1, 0.6}, {1, 0, 0.5}, {0, 1, 0}, {0, 2, 0}, {1, 2, 0.1}}, options_with(1e-6));
    const std::vector<PairStatus> expected{PairStatus::clear, PairStatus::violated, PairStatus::undecided,
                                           PairStatus::clear, PairStatus::contact,  PairStatus::clear};
    for (std::size_t i = 0; i < results.size(); ++i) {
        CAPTURE(i, results[i].lower, results[i].upper);
        CHECK(std::string(to_string(results[i].status)) == to_string(expected[i]));
        CHECK(results[i].upper - results[i].lower <= 1e-6);
        CHECK(results[i].lower <= results[i].upper);
        CHECK(std::abs((results[i].witness.point_a - results[i].witness.point_b).norm() - results[i].upper) < 1e-12);
        CHECK(results[i].witness.step == -1);
    }
    CHECK(results[0].upper == Approx(0.5).epsilon(0).margin(1e-12));
    CHECK(results[2].upper == Approx(0.5).epsilon(0).margin(1e-12));
    CHECK(results[2].a == 1);
    CHECK(results[4].upper == Approx(5e-5).epsilon(0).margin(1e-12));
    CHECK(results[5].upper == Approx(std::hypot(0.5, 0.40005)).epsilon(0).margin(1e-12));
}

TEST_CASE("A pin in a bore as assembled: distance of polygons", "[clearance]") {
    const int n = 24;
    const double pin = 0.005, bore = 0.0053;
    const auto model = model_of({prism(n, pin, 0.03), ring(n, bore, 0.01, 0.02)}, {{0, 0, 0}, {0, 0, 0}});
    const auto result = certify(model, as_assembled(model), {{0, 1, 3e-4}}, options_with(1e-9))[0];
    const double exact = (bore - pin) * std::cos(M_PI / n);
    CHECK(result.lower <= exact);
    CHECK(result.lower >= exact - 1e-9);
    CHECK(result.upper == Approx(exact).epsilon(0).margin(1e-14));
    CHECK(result.status == PairStatus::violated);  // 0.30 mm between round parts is less between the flats of polygons
}

TEST_CASE("Over the motion: intermediate nodes, time of the witness", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {3, 0, 0}});
    // Nearest at the middle node, (1.7, 0, 0): the ends alone would not show it.
    const auto trajectory = one_step(model, {{{3, 0, 0}, Vector3::Zero()}, {{1.7, 0, 0}, Vector3::Zero()}, {{2.5, 1, 0}, {0, 0, 0.3}}});
    ClearanceOptions options;
    options.motion = true;
    const auto over_motion = certify(model, trajectory, {{0, 1, 0.1}}, options)[0];
    CHECK(over_motion.upper == Approx(0.2).epsilon(0).margin(1e-6));
    CHECK(over_motion.lower == Approx(0.2).epsilon(0).margin(1e-6));
    CHECK(over_motion.witness.step == 0);
    CHECK(over_motion.witness.time == Approx(2.25).epsilon(0).margin(1e-5));
    options.motion = false;
    const auto as_it_starts = certify(model, trajectory, {{0, 1, 0.1}}, options)[0];
    CHECK(as_it_starts.upper == Approx(1.5).epsilon(0).margin(1e-12));
    CHECK(as_it_starts.witness.time == 2);
}

TEST_CASE("A lever's tip on an arc: the least distance is that of the arc, not of its chord", "[clearance]") {
    const double reach = std::hypot(1, 0.01);
    const auto model = model_of({box({0.1, 2, 2}), box({1, 0.01, 0.3})}, {{1.2, 0, 0}, {0, 0, 0}});
    auto trajectory = one_step(model, {{{0, 0, 0}, Vector3::Zero()}, {{0, 0, 0}, {0, 0, 2.5 * M_PI}}});  // more than a turn
    trajectory.poses[1][1].rotation = core::kinematics::rotation(Vector3(0, 0, 2.5 * M_PI));
    ClearanceOptions options;
    options.motion = true;
    options.tolerance = 1e-9;
    const auto result = certify(model, trajectory, {{0, 1, 0.01}}, options)[0];
    CHECK(result.lower <= 1.1 - reach);
    CHECK(result.upper >= 1.1 - reach);
    CHECK(result.upper - result.lower <= 1e-9);
}

TEST_CASE("The number of threads and the order of pairs change no bit", "[clearance]") {
    std::mt19937 random(4);
    std::vector<Solid> solids;
    std::vector<Vector3> positions;
    for (int i = 0; i < 6; ++i) {
        solids.push_back(random_solid(random, 1));
        positions.push_back(Vector3(3.0 * (i % 3), 3.0 * (i / 3), 0));
    }
    const auto model = model_of(solids, positions);
    std::vector<PairRequest> pairs;
    for (int a = 0; a < 6; ++a)
        for (int b = a + 1; b < 6; ++b) pairs.push_back({a, b, 0.1});
    const auto run = [&](int threads, const std::vector<PairRequest>& requests) {
        const core::base::ThreadLimit limit(threads);
        int reports = 0;
        ClearanceOptions options;
        options.on_pair = [&](int, int of) { reports += of == count_of(requests); };
        const auto results = certify(model, as_assembled(model), requests, options);
        CHECK(reports == count_of(requests));
        return results;
    };
    const auto one = run(1, pairs), four = run(4, pairs);
    const auto reversed = run(2, {pairs.rbegin(), pairs.rend()});
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& last = reversed[pairs.size() - 1 - i];
        CHECK((one[i].lower == four[i].lower && one[i].upper == four[i].upper && one[i].witness.point_a == four[i].witness.point_a));
        CHECK((one[i].lower == last.lower && one[i].upper == last.upper));
    }
}

TEST_CASE("The margin curve bounds every segment, and the nodes alone see less than the path", "[clearance]") {
    const double reach = std::hypot(1, 0.01);
    const auto model = model_of({box({0.1, 2, 2}), box({1, 0.01, 0.3})}, {{1.2, 0, 0}, {0, 0, 0}});
    const Vector3 zero = Vector3::Zero();
    auto trajectory = one_step(model, {{zero, zero}, {zero, {0, 0, 1.3}}, {zero, {0, 0, 4.0}}, {zero, {0, 0, 4.5}}});
    trajectory.poses[0][1].rotation = core::kinematics::rotation(Vector3(0, 0, 0.7));
    trajectory.poses[1][1].rotation = core::kinematics::rotation(Vector3(0, 0, 5.2));
    ClearanceOptions options = options_with(1e-7);
    options.motion = options.margin_curve = true;
    const auto result = certify(model, trajectory, {{0, 1, 0.01}}, options)[0];
    CHECK(result.upper == Approx(1.1 - reach).epsilon(0).margin(1e-7));
    CHECK(result.witness.segment == 1);  // half a turn from the start: the other tip
    REQUIRE(result.margin.size() == 3);
    double least_at_nodes = 1e300;
    for (int k = 0; k < 3; ++k) {
        const MarginInterval& m = result.margin[k];
        const MovingPair pair{box({0.1, 2, 2}), box({1, 0.01, 0.3}), core::stepper::path_segment(trajectory, 0, k, 0),
                              core::stepper::path_segment(trajectory, 0, k, 1)};
        const double least = static_cast<double>(sampled_minimum(pair, 400, 8));
        CAPTURE(k, m.lower, m.upper, least);
        CHECK((m.step == 0 && m.segment == k));
        CHECK(m.time_start == Approx(2 + 0.5 * k / 3));
        CHECK(m.time_end == Approx(2 + 0.5 * (k + 1) / 3));
        CHECK(m.lower <= least);
        CHECK(m.upper >= least - 1e-12);
        CHECK(m.upper - m.lower <= std::max(1e-7, 1e-3 * m.upper) * 1.001);
        CHECK(m.lower >= result.lower);
        least_at_nodes = std::min({least_at_nodes, static_cast<double>(pair.distance_at(0)), static_cast<double>(pair.distance_at(1))});
    }
    CHECK(result.sampled == Approx(least_at_nodes).epsilon(0).margin(1e-9));
    CHECK(result.sampled > result.upper + 0.01);
}

TEST_CASE("All witnesses that tie, each once", "[clearance]") {
    const int n = 8;
    const auto model = model_of({prism(n, 0.005, 0.03), ring(n, 0.0053, 0.01, 0.02)}, {{0, 0, 0}, {0, 0, 0}});
    ClearanceOptions options = options_with(1e-9);
    CHECK(certify(model, as_assembled(model), {{0, 1, 0}}, options)[0].witnesses.size() == 1);
    options.witness_tolerance = 1e-7;
    const auto result = certify(model, as_assembled(model), {{0, 1, 0}}, options)[0];
    REQUIRE(result.witnesses.size() >= static_cast<std::size_t>(n));
    CHECK(result.witnesses.size() <= static_cast<std::size_t>(options.max_witnesses));
    CHECK((result.witnesses[0].point_a == result.witness.point_a && result.witnesses[0].primitive_b == result.witness.primitive_b));
    std::vector<bool> side(n, false);
    for (std::size_t i = 0; i < result.witnesses.size(); ++i) {
        const Witness& w = result.witnesses[i];
        CHECK(w.distance <= result.upper + options.witness_tolerance);
        CHECK((w.point_a - w.point_b).norm() == Approx(w.distance).epsilon(0).margin(1e-15));
        const Vector3 d = w.point_b - w.point_a;
        side[static_cast<std::size_t>(std::lround((std::atan2(d.y(), d.x()) / (2 * M_PI) + 1) * n - 0.5)) % n] = true;
        for (std::size_t k = 0; k < i; ++k)
            CHECK((w.point_a - result.witnesses[k].point_a).norm() + (w.point_b - result.witnesses[k].point_b).norm() > 1e-12);
    }
    CHECK(std::count(side.begin(), side.end(), true) == n);  // one at least from each flat of the bore
    options.max_witnesses = 3;
    CHECK(certify(model, as_assembled(model), {{0, 1, 0}}, options)[0].witnesses.size() == 3);
}

TEST_CASE("Nearest twice during a motion: two witnesses", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {3, 0, 0}});
    // To the left wall of a passage and back, and again.
    const auto trajectory = one_step(model, {{{3, 0, 0}, Vector3::Zero()},
                                             {{1.7, 0, 0}, {0, 0, 0.2}},
                                             {{3, 0, 0}, Vector3::Zero()},
                                             {{1.7, 0, 0}, {0, 0, 0.2}},
                                             {{3, 0, 0}, Vector3::Zero()}});
    ClearanceOptions options = options_with(1e-8);
    options.motion = true;
    options.witness_tolerance = 1e-9;
    const auto result = certify(model, trajectory, {{0, 1, 0}}, options)[0];
    std::vector<double> times;
    for (const Witness& w : result.witnesses) times.push_back(w.time);
    std::sort(times.begin(), times.end());
    REQUIRE(times.size() >= 2);
    CHECK(times.front() < 2.2);
    CHECK(times.back() > 2.3);
}

TEST_CASE("Passing through is told from touching", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.2, 0.2, 3}), box({1, 1, 1})}, {{0, 0, 0}, {0.1, 0.15, 0.3}, {2, 0, 0}});
    const auto results = certify(model, as_assembled(model), {{0, 1, 0}, {0, 2, 0}, {0, 1, 0.1}}, options_with(1e-6));
    CHECK(results[0].intersecting);
    CHECK(results[0].status == PairStatus::violated);
    CHECK(results[0].lower == 0);
    CHECK(!results[1].intersecting);
    CHECK(results[1].status == PairStatus::undecided);  // faces in one plane: whether they cross is a matter of rounding
    CHECK(results[2].status == PairStatus::violated);
}

TEST_CASE("Stopped, out of budget, or far enough: true bounds that say so", "[clearance]") {
    const auto model = model_of({prism(24, 0.005, 0.03), ring(24, 0.0053, 0.01, 0.02)}, {{0, 0, 0}, {1e-5, 0, 0}});
    const auto start = as_assembled(model);
    const auto whole = certify(model, start, {{0, 1, 2.8e-4}}, options_with(1e-9))[0];
    CHECK(whole.complete);
    ClearanceOptions stopped = options_with(1e-9);
    stopped.should_stop = [] { return true; };
    const auto at_once = certify(model, start, {{0, 1, 2.8e-4}}, stopped)[0];
    CHECK(!at_once.complete);
    CHECK((at_once.lower <= whole.lower && at_once.upper >= whole.upper));
    CHECK(at_once.status == PairStatus::undecided);
    ClearanceOptions poor = options_with(1e-9);
    poor.max_evaluations = 3;
    const auto out = certify(model, start, {{0, 1, 2.8e-4}}, poor)[0];
    CHECK(!out.complete);
    CHECK((out.lower <= whole.lower && out.upper >= whole.upper));
    const auto boxes = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {4, 0.1, 0.2}});
    ClearanceOptions enough = options_with(1e-9);
    enough.enough = 1;
    const auto far = certify(boxes, as_assembled(boxes), {{0, 1, 0.5}}, enough)[0];
    CHECK(far.status == PairStatus::clear);
    CHECK((far.lower >= 1 && far.lower <= 2 && far.upper >= 2));
}

TEST_CASE("Wires and points have clearances too", "[clearance]") {
    const auto loose = [](const std::vector<Vector3>& points, const std::vector<core::geometry::Edge>& edges) {
        Solid solid;
        solid.mesh.name = "loose";
        solid.mesh.vertices.resize(3, static_cast<long>(points.size()));
        for (std::size_t i = 0; i < points.size(); ++i) solid.mesh.vertices.col(static_cast<long>(i)) = points[i];
        core::geometry::build_connectivity(solid.mesh, edges);
        solid.hierarchy = std::make_shared<core::geometry::BodyHierarchy>(solid.mesh);
        return solid;
    };
    const Solid wire = loose({{-1, 0, 0}, {1, 0, 0}}, {{0, 1}}), point = loose({{0, 0, 0}}, {}), solid = box({1, 1, 1});
    const auto model = model_of({wire, wire, point, point, solid}, {{0, 0, 0}, {0.2, 0, 0.5}, {0.1, 0, -0.7}, {3, 0, 4}, {0, -3, 0}});
    const auto results =
        certify(model, as_assembled(model), {{0, 1, 0}, {0, 2, 0}, {2, 0, 0}, {2, 3, 0}, {0, 4, 0}, {4, 2, 0}}, options_with(1e-9));
    const std::vector<double> expected{0.5, 0.7, 0.7, std::hypot(2.9, 4.7), 2, 2};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(results[i].upper == Approx(expected[i]).epsilon(0).margin(1e-12));
        CHECK(results[i].lower == Approx(expected[i]).epsilon(0).margin(1e-9));
    }
    CHECK((results[1].witness.kind_a == Primitive::edge && results[1].witness.kind_b == Primitive::vertex));
    CHECK((results[2].witness.kind_a == Primitive::vertex && results[2].witness.kind_b == Primitive::edge));
    CHECK((results[3].witness.kind_a == Primitive::vertex && results[3].witness.kind_b == Primitive::vertex));
    CHECK((results[5].witness.kind_a == Primitive::triangle && results[5].witness.kind_b == Primitive::vertex));
}

}  // namespace fettle::core::clearance::clearance_test
