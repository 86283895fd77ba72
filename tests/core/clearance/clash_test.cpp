// SPDX-License-Identifier: MIT
// Clashes: solids in each other, as assembled and between nodes, and since when. What is neither proven apart nor found in each other is
// undecided, never "contact" or "clear".
#include <catch2/catch.hpp>

#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/tests/core/clearance/clearance_models.hpp"

namespace fettle::core::clearance::clash_test {

using namespace fettle::tests::clearance;
using core::certificate::check_certificate;

namespace {

const Vector3 zero = Vector3::Zero();

}  // namespace

TEST_CASE("A plate that is passed through between two nodes is a clash, since its first instant", "[clearance]") {
    const auto model = model_of({box({0.01, 1, 1}), box({0.1, 0.1, 0.1})}, {{0, 0, 0}, {-1, 0.02, 0.03}});
    const auto trajectory = one_step(model, {{{-1, 0.02, 0.03}, zero}, {{3, 0.02, 0.03}, zero}});
    for (const double minimum : {0.0, 0.001}) {
        const auto result = certify_clearance(model, trajectory, {{0, 1, minimum}}, over_motion())[0];
        CHECK(result.is_clash());
        CHECK(result.status == PairStatus::violated);
        CHECK(result.lower == 0);
        // 0.89 of the 4 m that one step of 0.5 s goes, from 2 s on.
        const double first = 2 + 0.5 * 0.89 / 4;
        CAPTURE(result.clash_not_before, result.clash_time);
        CHECK(result.clash_not_before <= first);
        CHECK(result.clash_time == Approx(first).epsilon(0).margin(1e-6));
        CHECK(result.clash_time - result.clash_not_before < 1e-6);
        CHECK(result.witness.time == result.clash_time);
        CHECK(result.witness.point_a.x() == Approx(-0.01).epsilon(0).margin(1e-5));
    }
}

TEST_CASE("A clash in a later step is found with its first instant", "[clearance]") {
    const auto model = model_of({box({0.01, 1, 1}), box({0.1, 0.1, 0.1})}, {{0, 0, 0}, {-2, 0, 0}});
    auto trajectory = one_step(model, {{{-2, 0, 0}, zero}, {{-1, 0, 0}, zero}});
    for (const double x : {-0.5, 0.5, 1.5, 0.0, -2.0}) {  // there and back: the first time counts
        core::stepper::TrajectoryStep step;
        step.nodes.push_back(trajectory.steps.back().nodes.back());
        step.nodes.push_back({{zero, zero}, {{x, 0, 0}, zero}});
        trajectory.steps.push_back(step);
        trajectory.poses.push_back(trajectory.poses.back());
        trajectory.poses.back()[1].position = {x, 0, 0};
    }
    const auto result = certify_clearance(model, trajectory, {{0, 1, 0.001}}, over_motion())[0];
    CHECK(result.status == PairStatus::violated);
    CHECK(result.is_clash());
    const double first = 2 + 0.5 * (2 + 0.39);
    CHECK(result.clash_time == Approx(first).epsilon(0).margin(1e-5));
    CHECK(result.clash_not_before <= first);
    CHECK(result.clash_not_before > first - 1e-5);
    CHECK(result.witness.step == 2);
}

TEST_CASE("Solids that coincide are a clash, though no edge passes through a face", "[clearance]") {
    for (const bool motion : {false, true}) {
        const auto model = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {0, 0, 0}});
        const auto trajectory = motion ? one_step(model, {{zero, zero}, {zero, zero}}) : as_assembled(model);
        for (const double minimum : {0.0, 0.1}) {
            const auto result = certify_clearance(model, trajectory, {{0, 1, minimum}}, over_motion())[0];
            CHECK(result.is_clash());
            CHECK(result.status == PairStatus::violated);
            REQUIRE(result.overlap);
            CHECK(result.overlap->depth_lower > 1.9);
            CHECK(result.overlap->depth_upper <= 2 + 1e-9);
        }
    }
}

TEST_CASE("One wholly inside another with no gap is a clash", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {0.5, 0, 0}});  // a face in a face
    const auto result = certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(result.is_clash());
    CHECK(result.status == PairStatus::violated);
    CHECK(result.lower == 0);
}

TEST_CASE("Faces that touch exactly are undecided: neither a clash nor apart", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5, 0, 0}});
    const auto result = certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(!result.is_clash());
    CHECK(result.lower == 0);
    CHECK(result.status == PairStatus::undecided);
    CHECK(result.reason.find("rounding") != std::string::npos);
    // Closer than the tolerance, but apart.
    const auto near = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5 + 1e-9, 0, 0}});
    const auto contact = certify_clearance(near, as_assembled(near), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(contact.status == PairStatus::contact);
    CHECK(contact.lower > 0.9e-9);
}

TEST_CASE("Edges that run along a border are no clash: blocks that slide on each other with no gap are undecided", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {0.9, 0.02, 2}});
    const auto sliding = one_step(model, {{{0.9, 0.02, 2}, zero}, {{0.5, 0.1, 2}, {0, 0, 0.3}}, {{0.2, 0.4, 2}, {0, 0, 0.1}}});
    for (const auto& trajectory : {as_assembled(model), sliding}) {
        const auto result = certify_clearance(model, trajectory, {{0, 1, 0}}, over_motion())[0];
        CHECK(!result.is_clash());
        CHECK(result.status == PairStatus::undecided);
    }
    // A tenth of a micrometre in each other is one.
    const auto deeper = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {0.9, 0.02, 2 - 1e-7}});
    CHECK(certify_clearance(deeper, as_assembled(deeper), {{0, 1, 0}}, options_with(1e-6))[0].is_clash());
}

TEST_CASE("Contact is as far as minimum separation and activation distance reach", "[clearance]") {
    auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5 + 1.5e-4, 0, 0}});
    CHECK(certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::clear);
    model.dmin = 1e-4;  // dhat is 1e-4, too
    CHECK(certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::contact);
}

TEST_CASE("A body inside a block is a clash for the library and its certificate, over the motion too", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.2, 0.2, 0.2})}, {{0, 0, 0}, {0, 0, 0}});
    for (const bool motion : {false, true}) {
        const auto trajectory =
            motion ? one_step(model, {{zero, zero}, {{0.5, 0, 0}, {0, 0, 1}}, {{-0.5, 0, 0}, {0, 0, 0}}}) : as_assembled(model);
        for (const bool with_certificate : {false, true}) {
            core::certificate::Certificate certificate;
            ClearanceOptions options = over_motion();
            if (with_certificate) options.certificate = &certificate;
            const auto result = certify_clearance(model, trajectory, {{0, 1, 0.1}}, options)[0];
            CHECK(result.solids == Solids::overlap);
            CHECK(result.status == PairStatus::violated);
            CHECK((result.lower == 0 && result.upper == 0));
            CHECK(result.clash_time == (motion ? 2 : trajectory.time_start));
            REQUIRE(result.overlap);
            CHECK(result.overlap->volume_lower <= 0.064);
            CHECK(result.overlap->volume_upper >= 0.064);
            CHECK(result.overlap->depth_lower > 0.39);  // 2 r of the ball in the small one; to get out takes 1.2 at least
            CHECK(result.overlap->depth_upper >= 1.2 - 0.5 * motion - 1e-9);
            if (with_certificate) CHECK(!check_certificate(certificate, model, trajectory).accepted());
        }
    }
}

TEST_CASE("A cavity is not material; a body is told in whichever shell it lies", "[clearance]") {
    // A block with a cavity, and beside it, of the same body, another block.
    const auto join = [](const std::vector<std::pair<Solid, Vector3>>& parts, std::size_t inverted) {
        std::vector<core::geometry::Triangle> triangles;
        Matrix3X vertices(3, 0);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto& mesh = parts[i].first.mesh;
            const auto first = static_cast<int>(vertices.cols());
            vertices.conservativeResize(3, first + mesh.vertices.cols());
            vertices.rightCols(mesh.vertices.cols()) = mesh.vertices.colwise() + parts[i].second;
            for (auto t : mesh.triangles) {
                if (i == inverted) std::swap(t[0], t[1]);
                triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
            }
        }
        return make_solid(vertices, triangles);
    };
    const Solid block = join({{box({1, 1, 1}), zero}, {box({0.5, 0.5, 0.5}), zero}, {box({1, 1, 1}), {5, 0, 0}}}, 1);
    const auto status_at = [&](const Vector3& place) {
        const auto model = model_of({block, box({0.1, 0.1, 0.1})}, {zero, place});
        return certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    };
    CHECK(status_at({0, 0, 0}).status == PairStatus::clear);
    CHECK(status_at({0, 0, 0}).solids == Solids::disjoint);
    CHECK(status_at({0.75, 0, 0}).solids == Solids::overlap);
    CHECK(status_at({5, 0, 0}).solids == Solids::overlap);
    CHECK(status_at({3, 0, 0}).solids == Solids::disjoint);
    // Two small blocks as one body: one of them inside is enough.
    const Solid two = join({{box({0.1, 0.1, 0.1}), {3, 0, 0}}, {box({0.1, 0.1, 0.1}), {5, 0, 0}}}, 9);
    const auto model = model_of({two, block}, {zero, zero});
    CHECK(certify_clearance(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::violated);
}

TEST_CASE("Of a body that is not closed disjoint solids cannot be verified, and that is said", "[clearance]") {
    Solid open = box({1, 1, 1});
    auto triangles = open.mesh.triangles;
    triangles.pop_back();
    open = make_solid(open.mesh.vertices, triangles);
    const auto model = model_of({open, box({0.1, 0.1, 0.1})}, {zero, zero});
    core::certificate::Certificate certificate;
    ClearanceOptions options = options_with(1e-6);
    options.certificate = &certificate;
    const auto result = certify_clearance(model, as_assembled(model), {{0, 1, 0.1}}, options)[0];
    CHECK(result.solids == Solids::not_closed);
    CHECK(certificate.pairs[0].solids == Solids::not_closed);
    CHECK(check_certificate(certificate, model, as_assembled(model)).accepted());
    certificate.pairs[0].solids = Solids::disjoint;
    CHECK(!check_certificate(certificate, model, as_assembled(model)).accepted());
}

}  // namespace fettle::core::clearance::clash_test
