// SPDX-License-Identifier: MIT
// A design made in memory, with a quantity of its own: the mean height of a brick on a table that a motor tilts, and its derivatives.
#include <cstdio>

#include "design/gradient_audit/difference_check.hpp"
#include "design/shapes/file_part.hpp"

namespace core = fettle::core;
using namespace fettle::design::description;

// Mean height of a body's reference point over the motion [m].
class MeanHeight : public Quantity {
public:
    explicit MeanHeight(std::size_t body) : body_(body) {}
    fettle::Dimension dimension() const override { return fettle::Dimension::length; }
    Measurement value(const Simulated& simulated) const override {
        double sum = 0;
        for (const auto& poses : simulated.trajectory.poses) sum += poses[body_].position.z();
        return computed(sum / static_cast<double>(simulated.trajectory.poses.size()));
    }
    void add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const override {
        for (auto& bars : seeds.trajectory_bar.pose_bar)
            bars[body_](2, 3) += scale / static_cast<double>(simulated.trajectory.poses.size());
    }

private:
    std::size_t body_;
};

int main() {
    Design design;
    design.scene.gravity = {0, 0, -9.81};
    design.scene.timestep = 0.005;
    design.steps = 12;
    core::scene::Body table, brick;
    table.name = "table", brick.name = "brick";
    table.type = core::scene::BodyType::kinematic_body;  // a motor tilts it
    table.prescribed.fill(core::scene::MotionCurve{});
    table.prescribed[4]->rate = 0.7;
    table.pose.position = {0, 0, -0.005};
    brick.pose.position = {0.003, 0.001, 0.00512};
    const auto box = [](double x, double y, double z) {
        return fettle::design::shapes::FilePart::create("box", {{"size_x", x}, {"size_y", y}, {"size_z", z}}).value();
    };
    if (!add_part(design, table, box(0.06, 0.06, 0.01)) || !add_part(design, brick, box(0.02, 0.012, 0.01))) return 3;
    design.parameters = {{"length", 0.02, 0.015, 0.03, *fettle::find_unit("mm")}, {"speed", 0.7, 0.2, 1.0, *fettle::find_unit("rad/s")}};
    const auto follows = [&](const char* place, const char* formula) { return set_number(design, place, formula).empty(); };
    if (!follows("/bodies/brick/shape/dimensions/size_x", "length") || !follows("/bodies/table/prescribed/ry/rate", "speed")) return 3;
    design.objective = {{"height", 1, 1e-3, std::make_shared<MeanHeight>(1)}};  // in mm

    const auto problem = fettle::design::problem::DesignProblem::create(std::move(design));
    for (const auto& error : problem.errors()) std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
    if (!problem) return 3;
    const auto at = problem->evaluate(values_of(problem->design().parameters));
    const auto check = fettle::design::gradient_audit::check_gradients(*problem, values_of(problem->design().parameters), at);
    std::printf("mean height %.6f mm\n", at.objective);
    for (const auto& row : check.rows)
        std::printf("d/d %s: %.9g, by differences %.9g\n", row.parameter.c_str(), row.adjoint, row.difference);
    return at.usable && check.failures.empty() && check.largest_relative_error < 1e-5 ? 0 : 2;
}
