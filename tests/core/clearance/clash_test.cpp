// SPDX-License-Identifier: MIT
// Clashes: solids in each other, as assembled and between nodes, and since when. What is neither proven apart nor found in each other is
// undecided, never "contact" or "clear".
#include <catch2/catch.hpp>

#include "core/certificate/certificate_checker.hpp"
#include "core/scene_files/scene_reader.hpp"
#include "core/setup/build_model.hpp"
#include "tests/core/clearance/clearance_models.hpp"

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
        const auto result = certify(model, trajectory, {{0, 1, minimum}}, over_motion())[0];
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
    const auto result = certify(model, trajectory, {{0, 1, 0.001}}, over_motion())[0];
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
            const auto result = certify(model, trajectory, {{0, 1, minimum}}, over_motion())[0];
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
    const auto result = certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(result.is_clash());
    CHECK(result.status == PairStatus::violated);
    CHECK(result.lower == 0);
}

TEST_CASE("Faces that touch exactly are neither a clash nor apart", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5, 0, 0}});
    const auto result = certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(!result.is_clash());
    CHECK(result.lower == 0);
    CHECK(result.status == PairStatus::undecided);
    REQUIRE(result.touch);
    CHECK(result.touch->area == Approx(1));
    CHECK(result.reason.find("they touch") != std::string::npos);
    // Closer than the tolerance, but apart.
    const auto near = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5 + 1e-9, 0, 0}});
    const auto contact = certify(near, as_assembled(near), {{0, 1, 0}}, options_with(1e-6))[0];
    CHECK(contact.status == PairStatus::contact);
    CHECK(contact.lower > 0.9e-9);
}

TEST_CASE("Edges that run along a border are no clash: blocks that slide on each other with no gap are undecided", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {0.9, 0.02, 2}});
    const auto sliding = one_step(model, {{{0.9, 0.02, 2}, zero}, {{0.5, 0.1, 2}, {0, 0, 0.3}}, {{0.2, 0.4, 2}, {0, 0, 0.1}}});
    for (const auto& trajectory : {as_assembled(model), sliding}) {
        const auto result = certify(model, trajectory, {{0, 1, 0}}, over_motion())[0];
        CHECK(!result.is_clash());
        CHECK(result.touch);
        CHECK(result.status == PairStatus::undecided);
    }
    // In each other by less than the decimals of a file tell they touch all the same, but that is proven not to be apart.
    const auto blocks = [](double depth) {
        const auto model = model_of({box({1, 1, 1}), box({1, 1, 1})}, {{0, 0, 0}, {0.9, 0.02, 2 - depth}});
        return certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    };
    CHECK(blocks(1e-7).touch);
    CHECK(blocks(1e-7).status == PairStatus::violated);
    CHECK(blocks(1e-4).is_clash());
}

TEST_CASE("Contact is as far as minimum separation and activation distance reach", "[clearance]") {
    auto model = model_of({box({1, 1, 1}), box({0.5, 0.5, 0.5})}, {{0, 0, 0}, {1.5 + 1.5e-4, 0, 0}});
    CHECK(certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::clear);
    model.dmin = 1e-4;  // dhat is 1e-4, too
    CHECK(certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::contact);
}

TEST_CASE("A body inside a block is a clash for the library and its certificate, over the motion too", "[clearance]") {
    const auto model = model_of({box({1, 1, 1}), box({0.2, 0.2, 0.2})}, {{0, 0, 0}, {0, 0, 0}});
    for (const bool motion : {false, true}) {
        const auto trajectory =
            motion ? one_step(model, {{zero, zero}, {{0.5, 0, 0}, {0, 0, 1}}, {{-0.5, 0, 0}, {0, 0, 0}}}) : as_assembled(model);
        for (const bool with_certificate : {false, true}) {
            const auto [pairs, certificate] = certified(model, trajectory, 0.1, over_motion(), with_certificate);
            const PairClearance& result = pairs[0];
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
        return certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0];
    };
    CHECK(status_at({0, 0, 0}).status == PairStatus::clear);
    CHECK(status_at({0, 0, 0}).solids == Solids::disjoint);
    CHECK(status_at({0.75, 0, 0}).solids == Solids::overlap);
    CHECK(status_at({5, 0, 0}).solids == Solids::overlap);
    CHECK(status_at({3, 0, 0}).solids == Solids::disjoint);
    // Two small blocks as one body: one of them inside is enough.
    const Solid two = join({{box({0.1, 0.1, 0.1}), {3, 0, 0}}, {box({0.1, 0.1, 0.1}), {5, 0, 0}}}, 9);
    const auto model = model_of({two, block}, {zero, zero});
    CHECK(certify(model, as_assembled(model), {{0, 1, 0}}, options_with(1e-6))[0].status == PairStatus::violated);
}

namespace {

// A box without one of the two triangles of the face at +z (box() has them in some order: the one that is farther up).
Solid open_box(const Vector3& half) {
    const Solid whole = box(half);
    auto triangles = whole.mesh.triangles;
    const auto height = [&](const geometry::Triangle& t) {
        return whole.mesh.vertices(2, t[0]) + whole.mesh.vertices(2, t[1]) + whole.mesh.vertices(2, t[2]);
    };
    triangles.erase(
        std::max_element(triangles.begin(), triangles.end(), [&](const auto& x, const auto& y) { return height(x) < height(y); }));
    return make_solid(whole.mesh.vertices, triangles);
}

}  // namespace

TEST_CASE("A part in a mesh that is not closed is not told as clear of it", "[clearance]") {
    for (const Vector3& half : {Vector3(1, 1, 1), Vector3(5, 5, 1), Vector3(1, 1, 20)}) {
        const auto model = model_of({open_box(half), box({0.1, 0.1, 0.1})}, {zero, zero});
        auto [pairs, certificate] = certified(model, as_assembled(model), 0.1, options_with(1e-6), true);
        const PairClearance& result = pairs[0];
        CHECK(result.lower > 0.8);
        CHECK(result.solids == Solids::unverified);
        CHECK(result.status == PairStatus::undecided);
        CHECK(result.reason.find("cannot be verified: a mesh is not closed") != std::string::npos);
        CHECK(certificate.pairs[0].solids == Solids::unverified);
        CHECK(check_certificate(certificate, model, as_assembled(model)).accepted());
        for (const Solids claim : {Solids::disjoint, Solids::not_closed}) {
            certificate.pairs[0].solids = claim;
            CHECK(!check_certificate(certificate, model, as_assembled(model)).accepted());
        }
        auto sheet = model;  // said to be one: then it has no inside
        sheet.bodies[0].mass_kind = core::scene::MassKind::area;
        const auto of_sheet = certified(sheet, as_assembled(sheet), 0.1, options_with(1e-6), true);
        certificate = of_sheet.certificate;
        CHECK(of_sheet.pairs[0].status == PairStatus::clear);
        CHECK(check_certificate(certificate, sheet, as_assembled(sheet)).accepted());
        CHECK(check_certificate(certificate, model, as_assembled(model)).stale);
    }
}

TEST_CASE("Beside its mirror image an open box is no less open", "[clearance]") {
    const Solid open = open_box({1, 1, 1});
    const auto count = static_cast<int>(open.mesh.vertices.cols());
    Matrix3X vertices(3, 2 * count);
    vertices << open.mesh.vertices, open.mesh.vertices.colwise() + Vector3(5, 0, 0);
    auto triangles = open.mesh.triangles;
    for (const auto& t : open.mesh.triangles) triangles.push_back({t[1] + count, t[0] + count, t[2] + count});
    const auto model = model_of({make_solid(vertices, triangles), box({0.1, 0.1, 0.1})}, {zero, zero});
    const auto result = certify(model, as_assembled(model), {{0, 1, 0.1}}, options_with(1e-6))[0];
    CHECK(result.solids == Solids::unverified);
    CHECK(result.status == PairStatus::undecided);
}

TEST_CASE("What joints may have off the path counts for the lids of an open mesh", "[clearance]") {
    const auto model = model_of({open_box({1, 1, 1}), box({0.1, 0.1, 0.1})}, {zero, {0, 0, 1.4}});
    const auto found = [&](double charge) {
        core::clearance::PairRequest request{0, 1, 0.01};
        request.charge = charge;
        return certify(model, as_assembled(model), {request}, options_with(1e-6))[0].solids;
    };
    CHECK(found(0) == Solids::not_closed);
    CHECK(found(0.1) == Solids::not_closed);
    CHECK(found(0.35) != Solids::not_closed);
}

TEST_CASE("A cup in a fixture, which has no word for sheets, is not taken for one", "[clearance]") {
    const std::string cup = R"({"vertices": [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]], "type": "static",
        "faces": [[0,2,1],[0,3,2],[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7]]})";
    const std::string part = R"({"vertices": [[0.1,0.1,0.1],[0.2,0.1,0.1],[0.1,0.2,0.1],[0.1,0.1,0.2]],
        "faces": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]})";
    const auto scene =
        core::scene_files::parse_scene(R"({"rigid_body_problem": {"rigid_bodies": [)" + cup + ", " + part + "]}}", "cup.json");
    REQUIRE(scene);
    CHECK(scene->bodies[0].mass_kind == core::scene::MassKind::area);
    const auto built = core::setup::build_model(*scene);
    REQUIRE(built);
    CHECK(!is_sheet(built->bodies[0]));
    const auto result = certify(*built, as_assembled(*built), {{0, 1, 0.01}}, options_with(1e-6))[0];
    CHECK(result.lower > 0.01);
    CHECK(result.solids == Solids::unverified);
    CHECK(result.status == PairStatus::undecided);
}

TEST_CASE("A part that stays outside of a mesh that is not closed is clear of it, near its opening too", "[clearance]") {
    for (const double gap : {5.0, 0.5, 1e-2}) {
        for (const Vector3& side : {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(1, 0, 0)}) {
            const auto model = model_of({open_box({1, 1, 1}), box({0.1, 0.1, 0.1})}, {zero, (1.1 + gap) * side});
            const auto [pairs, certificate] = certified(model, as_assembled(model), 0.9 * gap, options_with(1e-6), true);
            const PairClearance& result = pairs[0];
            CAPTURE(gap, side.transpose(), result.reason);
            CHECK(result.status == PairStatus::clear);
            CHECK(result.solids == Solids::not_closed);
            CHECK(check_certificate(certificate, model, as_assembled(model)).accepted());
        }
    }
}

TEST_CASE("A part that comes in through the opening of a mesh that is not closed is not told as clear of it", "[clearance]") {
    const auto model = model_of({open_box({1, 1, 1}), box({0.1, 0.1, 0.1})}, {zero, {0, 0, 3}});
    // The triangle that is missing: to which side of the diagonal?
    const auto within = [&](double x, double y) {
        const auto path = one_step(model, {{{x, y, 3}, zero}, {{x, y, 0}, zero}});
        return certify(model, path, {{0, 1, 0.01}}, over_motion())[0];
    };
    int through = 0;
    for (const auto& [x, y] : {std::pair{0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}}) {
        const PairClearance result = within(x, y);
        if (result.is_clash()) continue;  // through the half of the face that is there
        ++through;
        CHECK(result.lower > 0);
        CHECK(result.solids == Solids::unverified);
        CHECK(result.status == PairStatus::undecided);
        // Down to half a part above it, with a certificate.
        const auto path = one_step(model, {{{x, y, 3}, zero}, {{x, y, 1.15}, {0, 0, 1}}});
        const auto [pairs, certificate] = certified(model, path, 0.01, over_motion(), true);
        CHECK(pairs[0].status == PairStatus::clear);
        CHECK(certificate.pairs[0].solids == Solids::not_closed);
        CHECK(check_certificate(certificate, model, path).accepted());
    }
    CHECK(through >= 1);
}

TEST_CASE("What is proven apart is so with a certificate too, however small the gap", "[clearance]") {
    // One slides and turns on the other, nanometres away: the finer proof may come with no nearer place.
    for (int k = 0; k < 12; ++k) {
        const double gap = 1.8e-8 * (1 + k), turn = 0.05 + 0.04 * k, slide = 1e-4 * (k % 4);
        const Vector3 from(slide, -2e-4, 1e-3 + gap), to(-1e-4, slide, 1e-3 + gap);
        const auto model = model_of({box({5e-4, 5e-4, 5e-4}), box({5e-4, 5e-4, 5e-4})}, {{0, 0, 0}, from});
        const auto trajectory = one_step(model, {{from, zero}, {to, Vector3(0, 0, turn)}});
        ClearanceOptions options = over_motion();
        options.tolerance = 1e-5;
        const PairClearance plain = certify(model, trajectory, {{0, 1, 0}}, options)[0];
        const auto [pairs, certificate] = certified(model, trajectory, 0, options, true);
        const PairClearance& proven = pairs[0];
        CAPTURE(gap, turn, plain.lower, plain.upper, proven.lower, proven.upper, proven.reason);
        CHECK(plain.lower > 0);
        CHECK(proven.status == plain.status);
        CHECK(proven.lower > 0);
        REQUIRE(certificate.pairs.size() == 1);
        CHECK(certificate.pairs[0].lower == proven.lower);
        CHECK(certificate.pairs[0].upper <= proven.upper + 1e-13);  // what was found nearest by any search, and its rounding
        CHECK(check_certificate(certificate, model, trajectory).accepted());
    }
}

TEST_CASE("Whether a minimum is kept hangs neither on the tolerance nor on a certificate", "[clearance]") {
    const auto model = model_of({box({5e-3, 5e-3, 5e-3}), box({4e-3, 4e-3, 4e-3})}, {{0, 0, 0}, {0, 0, 11e-3}});
    const auto trajectory = one_step(model, {{{0, 0, 11e-3}, zero}, {{1e-3, 0, 11e-3}, Vector3(0.1, 0.2, 0)}});
    ClearanceOptions exact = over_motion();
    exact.tolerance = 1e-10;
    const PairClearance truth = certify(model, trajectory, {{0, 1, 0}}, exact)[0];
    REQUIRE(truth.lower > 0);
    for (const double off : {-3e-7, -2e-8, 2e-8, 3e-7})
        for (const bool recorded : {false, true}) {
            ClearanceOptions options = over_motion();
            options.tolerance = 1e-5;
            const auto [pairs, certificate] = certified(model, trajectory, truth.lower + off, options, recorded);
            const PairClearance& pair = pairs[0];
            CAPTURE(off, recorded, pair.lower, pair.upper, pair.reason);
            CHECK(pair.status == (off < 0 ? PairStatus::clear : PairStatus::violated));
            if (recorded) CHECK(check_certificate(certificate, model, trajectory).accepted());
        }
}

}  // namespace fettle::core::clearance::clash_test
