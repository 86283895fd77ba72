// SPDX-License-Identifier: MIT
#include "design/problem/design_problem.hpp"

#include <catch2/catch.hpp>

#include "tests/design/linear_numbers.hpp"
#include "tests/support/mechanisms.hpp"

namespace fettle::design::problem::moved_friction_test {

namespace {

using fettle::tests::design_support::follow;

using namespace fettle::tests::mechanisms;
using namespace fettle::design::description;

// Where a body is at the end along x.
class EndX : public Quantity {
public:
    explicit EndX(int body) : body_(static_cast<size_t>(body)) {}
    Dimension dimension() const override { return Dimension::length; }
    Measurement value(const Simulated& s) const override { return computed(s.trajectory.poses.back()[body_].position.x()); }
    void add_seeds(const Simulated&, const Measurement&, double scale, Seeds& seeds) const override {
        seeds.trajectory_bar.pose_bar.back()[body_](0, 3) += scale;
    }

private:
    size_t body_;
};

void add_coefficient(Design& design, const std::string& name, double value, const std::string& place, double scale = 1, double offset = 0) {
    Parameter p;
    p.name = name;
    p.value = value;
    p.lower = -1;
    p.upper = 2;
    design.parameters.push_back(p);
    follow(design, name, place, scale, offset);
}

// Blocks that slide over a plate: of wood, of steel as the plate is, with a coefficient of its own, and of nothing that is said.
Design blocks() {
    Design design;
    core::scene::Body plate = bar("plate", 1);
    plate.mesh = tests::support::box_mesh({-1, -1, -0.1}, {1, 2, 0});
    plate.type = core::scene::BodyType::static_body;
    for (auto& dof : plate.prescribed) dof = core::scene::MotionCurve{};
    plate.material = "steel";
    std::vector<core::scene::Body> bodies{plate};
    for (const char* name : {"wooden", "steel", "own", "plain"}) {
        core::scene::Body block = bar(name, 0.1);
        block.mesh = tests::support::box_mesh({-0.05, -0.05, 6e-4}, {0.05, 0.05, 0.02});
        block.pose.position = Vector3(0, 0.3 * static_cast<double>(bodies.size() - 1), 0);
        block.linear_velocity = Vector3(0.5, 0, 0);
        bodies.push_back(block);
    }
    bodies[1].material = "wood";
    bodies[2].material = "steel";
    bodies[3].mu = 0.3;
    design.scene = scene_of(bodies, 0.01);
    for (core::scene::Body& body : design.scene.bodies) body.group = -1;
    design.scene.gravity = Vector3(0, 0, -gravity);
    design.scene.dhat = 1e-3;
    design.scene.friction.mu = 0.15;
    design.scene.friction.rounds = 2;
    design.scene.friction.materials = {{"steel", 0.4}};
    design.scene.friction.pairs = {{"wood", "steel", 0.25}};
    design.steps = 8;
    add_coefficient(design, "pair", 0.25, "/friction/pairs/0/mu");
    add_coefficient(design, "material", 0.4, "/materials/steel/mu");
    add_coefficient(design, "body", 0.3, "/bodies/3/mu", 2, -0.3);
    add_coefficient(design, "all others", 0.15, "/friction/mu");
    for (int body = 1; body < 5; ++body) design.constraints.push_back({std::to_string(body), {}, std::make_shared<EndX>(body)});
    return design;
}

}  // namespace

TEST_CASE("coefficients of friction: of a pair, a material, a body and all others", "[friction]") {
    const auto problem = DesignProblem::create(blocks());
    REQUIRE(problem);
    const VectorX start = values_of(problem->design().parameters);
    const DesignEvaluation at = problem->evaluate(start);
    INFO(at.reason);
    REQUIRE(at.usable);
    // Who feels what: wooden the pair alone; steel the material; the other two the geometric mean of it and their own.
    const MatrixX felt = (at.jacobian.array().abs() > 1e-6).cast<double>();
    MatrixX expected(4, 4);
    expected << 1, 0, 0, 0,  //
        0, 1, 0, 0,          //
        0, 1, 1, 0,          //
        0, 1, 0, 1;
    CHECK(felt == expected);
    constexpr double e = 1e-4;
    for (Eigen::Index k = 0; k < start.size(); ++k) {
        EvaluateOptions plain;
        plain.gradients = false;
        const auto values = [&](double s) {
            const DesignEvaluation there = problem->evaluate(start + s * VectorX::Unit(start.size(), k), plain);
            REQUIRE(there.usable);
            VectorX out(4);
            for (Eigen::Index i = 0; i < 4; ++i) out[i] = there.constraints[i].value;
            return out;
        };
        const VectorX wide = (values(e) - values(-e)) / (2 * e), narrow = (values(e / 2) - values(-e / 2)) / e;
        CAPTURE(k, at.jacobian.col(k).transpose());
        CHECK(((4 * narrow - wide) / 3 - at.jacobian.col(k)).norm() < 1e-6 * at.jacobian.col(k).norm());
    }
    CHECK(at.jacobian(2, 2) == Approx(2 * at.jacobian(2, 1) * 0.4 / 0.3).epsilon(1e-9));  // mu = sqrt(own material's), own twice as fast
    VectorX nothing = start;
    nothing[3] = 0;
    CHECK(problem->evaluate(nothing).reason.find("must be greater than 0 for a derivative") != std::string::npos);
}

TEST_CASE("coefficients of friction that are nowhere are told", "[friction]") {
    const auto reason = [](const std::string& place) {
        Design design = blocks();
        design.parameters.clear();
        design.numbers.clear();
        add_coefficient(design, "p", 0.2, place);
        const auto problem = DesignProblem::create(std::move(design));
        return problem ? std::string() : problem.errors()[0].message;
    };
    CHECK(reason("/materials/wood/mu") == "material `wood` has no `mu` in the scene");
    CHECK(reason("/friction/pairs/1/mu") == "there is no pair of materials of that number");
    CHECK(reason("/bodies/7/mu") == "there is no body of that number");
}

}  // namespace fettle::design::problem::moved_friction_test
