// SPDX-License-Identifier: MIT
#include "core/clearance/faces_alone.hpp"

#include <catch2/catch.hpp>

#include "core/clearance/clearance.hpp"
#include "core/setup/build_model.hpp"
#include "tests/support/box_mesh.hpp"

namespace fettle::core::clearance::faces_alone_test {

namespace {

scene::Body box(const std::string& name, double x) {
    scene::Body body;
    body.name = name;
    body.type = scene::BodyType::static_body;
    for (auto& coordinate : body.prescribed) coordinate = scene::MotionCurve{};
    body.mesh = tests::support::box_mesh(Vector3::Constant(-0.01), Vector3::Constant(0.01));
    body.pose.position.x() = x;
    return body;
}

}  // namespace

TEST_CASE("faces of two bodies alone are certified, and their witness is told by the whole bodies' primitives") {
    scene::Scene scene;
    scene.bodies = {box("left", 0), box("right", 0.05)};
    const auto model = setup::build_model(scene);
    REQUIRE(model);
    // The face of the left box that looks away, and the upper one of the right box (support/box_mesh.hpp).
    const FacesAlone faces(*model, {0, {8, 9}}, {1, {2, 3}});
    ClearanceOptions options;
    options.tolerance = 1e-9;
    const auto measured = [&](const FacesAlone& of) {
        return of.in_whole(certify(of.model(), as_assembled(of.model()), {{0, 1}}, options).front());
    };
    const PairClearance pair = measured(faces);
    CHECK(pair.lower > 0);
    CHECK(pair.lower <= 0.05);
    CHECK(pair.upper == Approx(0.05));  // from x = -0.01 to x = 0.04, where the upper face's edge is
    CHECK(certificate::are_apart(pair.solids));
    const Witness& w = pair.witness;
    const auto corners = [&](int body, Primitive kind, int primitive) -> std::vector<int> {
        const geometry::Mesh& mesh = model->bodies[body].mesh;
        if (kind == Primitive::vertex) return {primitive};
        if (kind == Primitive::edge) return {mesh.edges[primitive][0], mesh.edges[primitive][1]};
        return {mesh.triangles[primitive].begin(), mesh.triangles[primitive].end()};
    };
    for (const int v : corners(0, w.kind_a, w.primitive_a)) CHECK(model->bodies[0].mesh.vertices(0, v) < 0);
    for (const int v : corners(1, w.kind_b, w.primitive_b)) CHECK(model->bodies[1].mesh.vertices(2, v) > 0);

    // One whole body: still a solid, within which a face of the other would be found.
    CHECK(measured(FacesAlone(*model, {0, {}}, {1, {8, 9}})).upper == Approx(0.03));
    scene.bodies[1].pose.position.x() = 0.005;
    scene.bodies[1].mesh = tests::support::box_mesh(Vector3::Constant(-0.002), Vector3::Constant(0.002));
    const auto inside = setup::build_model(scene);
    REQUIRE(inside);
    const FacesAlone face(*inside, {0, {}}, {1, {8, 9}});
    CHECK(certify(face.model(), as_assembled(face.model()), {{0, 1}}, options).front().solids == Solids::overlap);
}

}  // namespace fettle::core::clearance::faces_alone_test
