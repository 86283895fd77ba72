// SPDX-License-Identifier: MIT
// A shape of one's own, optimised: the heaviest square peg with 0.3 mm of certified clearance to a wall, its head 1.2 times its foot.
#include <cstdio>

#include "design/quantities/clearance.hpp"
#include "design/quantities/mass.hpp"
#include "design/shapes/file_part.hpp"
#include "design/studies/optimise_design.hpp"

using namespace fettle::design::description;
using fettle::Matrix3X;
using fettle::design::shapes::FilePart;

// A frustum about the origin, 10 mm high: half widths at the foot and at the top. Vertices are linear in both.
class Peg : public Shape {
public:
    const std::vector<ShapeDimension>& dimensions() const override { return dimensions_; }
    fettle::Result<ShapeInstance> at(const std::vector<double>& d) const override {
        if (!(d[0] > 0 && d[1] > 0)) return fettle::Error{fettle::ErrorCode::out_of_range, "foot", "a peg's widths are above 0"};
        ShapeInstance part{drawn_mesh(*FilePart::create("box", {{"size_x", 2}, {"size_y", 2}, {"size_z", 0.01}}).value()).value(), {}};
        part.jacobian.assign(2, Matrix3X::Zero(3, part.mesh.vertices.cols()));
        for (Eigen::Index i = 0; i < part.mesh.vertices.cols(); ++i) {
            const std::size_t end = part.mesh.vertices(2, i) < 0 ? 0 : 1;
            part.jacobian[end].col(i).head<2>() = part.mesh.vertices.col(i).head<2>();
            part.mesh.vertices.col(i).head<2>() *= d[end];
        }
        return part;
    }

private:
    std::vector<ShapeDimension> dimensions_{{"foot", 0.004}, {"top", 0.005}};
};

int main() {
    Design design;
    fettle::core::scene::Body peg, wall;
    peg.name = "peg", wall.name = "wall";
    wall.type = fettle::core::scene::BodyType::static_body;
    wall.prescribed.fill(fettle::core::scene::MotionCurve{});
    wall.pose.position = {0.015, 0, 0};  // its face stands at x = 10 mm
    const auto block = FilePart::create("box", {{"size_x", 0.01}, {"size_y", 0.04}, {"size_z", 0.04}});
    if (!block || !add_part(design, peg, std::make_shared<Peg>()) || !add_part(design, wall, *block)) return 3;
    design.steps = 1;
    design.parameters = {{"foot", 0.004, 0.002, 0.012, *fettle::find_unit("mm")}, {"top", 0.005, 0.002, 0.012, *fettle::find_unit("mm")}};
    for (const std::string name : {"foot", "top"})
        if (!set_number(design, "/bodies/peg/shape/dimensions/" + name, name).empty()) return 3;
    using namespace fettle::design::quantities;
    design.objective = {{"mass", -1, 1e-3, std::make_shared<Mass>(design.scene, std::vector<int>{0})}};
    design.constraints = {
        {"clearance", {.lower = 0.3e-3, .margin = 1e-7, .unit = 1e-3}, std::make_shared<Clearance>(ClearanceRange{0, 1})}};
    design.relations = {{.name = "head", .bounds = {.lower = 1.2, .margin = 1e-5}, .at = [](const fettle::VectorX& p) {
                             return RelationValue{p[1] / p[0], fettle::Vector2(-p[1] / (p[0] * p[0]), 1 / p[0])};
                         }}};
    const auto problem = fettle::design::problem::DesignProblem::create(std::move(design));
    if (!problem) return 3;
    const auto outcome = fettle::design::studies::optimise_design(*problem);
    std::printf("%s: foot %.4f mm, top %.4f mm, certified clearance %.4f mm\n", to_string(outcome->report.status),
                1000 * outcome->report.point[0], 1000 * outcome->report.point[1], 1000 * outcome->final.constraints[0].lower);
    return outcome->report.feasible && outcome->report.point[1] > 0.0096 && outcome->report.point[0] < 0.0081 ? 0 : 1;
}
