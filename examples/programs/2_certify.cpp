// SPDX-License-Identifier: MIT
// A clearance that is proven: a hammer on a hinge swings past a post; how near does it come, over the whole continuous motion? The proof is
// data, and is checked without the search that found it.
#include <cstdio>

#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/setup/build_model.hpp"
#include "core/stepper/simulate.hpp"
#include "design/shapes/file_part.hpp"

namespace core = fettle::core;

core::scene::Body box(const std::string& name, core::scene::BodyType type, const fettle::Vector3& size) {
    core::scene::Body body;
    body.name = name;
    body.type = type;
    const auto part = fettle::design::shapes::FilePart::create("box", {{"size_x", size.x()}, {"size_y", size.y()}, {"size_z", size.z()}});
    body.mesh = drawn_mesh(**part).value();
    if (type == core::scene::BodyType::static_body) body.prescribed.fill(core::scene::MotionCurve{});
    return body;
}

int main() {
    core::scene::Scene scene;
    scene.gravity = {0, 0, -9.81};
    scene.end_time = 0.5;
    scene.bodies.push_back(box("hammer", core::scene::BodyType::dynamic_body, {0.04, 0.01, 0.01}));
    scene.bodies.push_back(box("post", core::scene::BodyType::static_body, {0.01, 0.01, 0.01}));
    scene.bodies[1].pose.position = {-0.02, 0, -0.0465};  // its upper edge is just out of the hammer's reach
    core::scene::Joint hinge;
    hinge.name = "hinge";
    hinge.a = {.body = "", .point = {-0.02, 0, 0}, .axis = {0, 1, 0}};
    hinge.b = {.body = "hammer", .point = {-0.02, 0, 0}, .axis = {0, 1, 0}};
    scene.mechanism.joints.push_back(hinge);

    const auto model = core::setup::build_model(scene);
    for (const auto& error : model.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
    if (!model) return 3;
    const core::stepper::Simulation simulation = core::stepper::simulate(*model);

    core::clearance::ClearanceOptions options;
    options.motion = true;
    const auto [pairs, certificate] =
        core::clearance::certify_with_proof(*model, simulation.trajectory, {{.a = 0, .b = 1, .minimum = 0.3e-3}}, options);
    const auto& pair = pairs.front();
    std::printf("%s: at least %.4f mm, at most %.4f mm, nearest at %.3f s\n", core::clearance::to_string(pair.status), 1000 * pair.lower,
                1000 * pair.upper, pair.witness.time);
    const auto check = core::certificate::check_certificate(certificate, *model, simulation.trajectory);
    std::printf("the certificate is %s: %ld leaves\n", check.accepted() ? "accepted" : "rejected", check.leaves);
    return check.accepted() && pair.status == core::clearance::PairStatus::clear ? 0 : 1;
}
