// SPDX-License-Identifier: MIT
#include "design/gradient_audit/sweep_agreement.hpp"

#include <catch2/catch.hpp>

#include "tests/design/small_problem.hpp"

namespace fettle::design::gradient_audit::sweep_agreement_test {

using namespace fettle::tests::design_support;

TEST_CASE("backwards and forwards agree on a design's own simulation", "[gradient]") {
    const std::string rubbing = replaced(small_scene, R"("end_time": 0.1,)", R"("end_time": 0.1, "friction": { "mu": 0.3 },)");
    for (const std::string& scene : {std::string(small_scene), rubbing}) {
        const DesignFolder folder(small_design, scene);
        const problem::DesignProblem problem = problem_of(folder);
        const VectorX p = description::values_of(problem.design().parameters);
        problem::DesignEvaluation at = problem.evaluate(p);
        INFO(at.reason);
        REQUIRE(at.usable);
        const SweepAgreement agreement = compare_sweeps(problem, at);
        CAPTURE(agreement.quantity, agreement.disagreement);
        CHECK(agreement.failure.empty());
        CHECK(agreement.disagreement > 0);
        CHECK(agreement.disagreement < 1e-9);

        // What neither can differentiate is told.
        at.runs.front().simulation.trajectory.poses[3][1].position.z() += 1e-6;
        at.runs.front().simulation.trajectory.steps[2].nodes.back()[1].position.z() += 1e-6;
        CHECK(compare_sweeps(problem, at).failure.find("out of balance") != std::string::npos);
    }
}

TEST_CASE("backwards and forwards agree on what friction carries, by every integrator", "[gradient]") {
    std::string design = small_design;
    const size_t objective = design.find(R"("objective": [)") + std::string(R"("objective": [)").size();
    design.insert(objective, R"(
    { "type": "contact_force", "body": "cube", "of": "table", "axis": [1, 0, 0], "over": "end", "weight": 1 },
    { "type": "contact_torque", "body": "cube", "of": "table", "point": [3, 2, 1], "axis": [0, 1, 0], "over": "mean", "weight": 1 },)");
    for (const char* integrator : {"implicit_euler", "bdf2", "newmark"})
        for (const char* rounds : {"1", "3", R"("converged")"}) {
            std::string scene = replaced(small_scene, R"("end_time": 0.1,)",
                                         R"("end_time": 0.1, "integrator": "I", "friction": { "mu": 0.3, "rounds": R },)");
            if (integrator == std::string("newmark"))  // by longer steps it gains more energy than there is, and ends
                scene = replaced(scene, R"("timestep": 0.005)", R"("timestep": 0.0005)");
            scene = replaced(replaced(scene, R"("I")", "\"" + std::string(integrator) + "\""), "\"rounds\": R",
                             "\"rounds\": " + std::string(rounds));
            const DesignFolder folder(design, scene);
            const problem::DesignProblem problem = problem_of(folder);
            const problem::DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
            INFO(integrator << ", rounds " << rounds << ": " << at.reason);
            REQUIRE(at.usable);
            const SweepAgreement agreement = compare_sweeps(problem, at);
            CAPTURE(agreement.quantity, agreement.disagreement, agreement.failure);
            CHECK(agreement.failure.empty());
            CHECK(agreement.disagreement < 1e-8);
        }
}

// A slide that a damper has brought to its steady speed: no start and no mass changes what the motor pushes with against the spring any
// more. What the two sweeps then have is the rounding of 4 N, and not to be compared with itself.
TEST_CASE("backwards and forwards agree on an effort that nothing in the directions moves", "[gradient]") {
    for (const char* end_time : {"0.012", "0.02", "0.04"}) {
        const std::string scene =
            replaced(R"json({"fettle_scene": 1, "units": "mm", "timestep": 0.001, "end_time": END, "gravity": [0, 0, 0],
          "bodies": [{"name": "slide", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 30, "size_y": 10, "size_z": 10}}},
                     {"name": "push", "density": 1000, "position": [40, 0, 0],
                      "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 10, "size_z": 10}}}],
          "joints": [{"name": "rail", "type": "prismatic", "b": "slide", "point": [0, 0, 0], "axis": [1, 0, 0], "damping": 20},
                     {"name": "core", "type": "prismatic", "a": "slide", "b": "push", "point": [40, 0, 0], "axis": [1, 0, 0], "stiffness": 300,
                      "preload": 3}],
          "motors": [{"name": "pull", "joint": "rail", "force": {"times": [0], "values": [10]}},
                     {"name": "drive", "joint": "core", "travel": {"rate": 13}}]})json",
                     "END", end_time);
        const DesignFolder folder(R"json({"fettle_design": 1, "scene": "small.scene.json", "units": "mm",
          "parameters": [{"name": "k", "unit": "N/m", "value": 300, "lower": 100, "upper": 500}], "set": {"/joints/core/stiffness": "= k"},
          "objective": [{"type": "motor_effort", "motor": "drive", "over": "end"}]})json",
                                  scene);
        const problem::DesignProblem problem = problem_of(folder);
        const problem::DesignEvaluation at = problem.evaluate(description::values_of(problem.design().parameters));
        INFO(end_time << ": " << at.reason);
        REQUIRE(at.usable);
        const SweepAgreement agreement = compare_sweeps(problem, at);
        CAPTURE(agreement.quantity, agreement.disagreement, agreement.failure);
        CHECK(agreement.failure.empty());
        CHECK(agreement.disagreement < 1e-8);
    }
}

}  // namespace fettle::design::gradient_audit::sweep_agreement_test
