// SPDX-License-Identifier: MIT
#include "fettle/design/problem/moved_scene.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "fettle/adjoint/model/build_model_adjoint.hpp"
#include "fettle/core/base/contract.hpp"
#include "fettle/core/kinematics/tangent_system.hpp"

namespace fettle::design::problem {

namespace {

using core::scene::Place;
using core::scene::Scene;
using description::Design;
using description::Move;
using description::Shape;
using description::ShapeInstance;

class Mover {
public:
    Mover(const Design& design, const VectorX& p, SceneDerivative derivative)
        : design_(design), derivative_(derivative), moved_{description::described_scene(design), {}, {}} {
        moved_.jacobians.resize(design.scene.bodies.size());
        for (size_t k = 0; k < design.parameters.size(); ++k)
            for (const Move& move : design.parameters[k].moves) add(static_cast<int>(k), move, p[static_cast<Eigen::Index>(k)]);
    }

    Result<MovedScene> run() {
        Errors errors;
        for (const auto& [place, value] : sums_) {
            double& number = core::scene::at(moved_.scene, place);
            number = value;
            is_moved_.insert(&number);
        }
        for (const auto& [place, value] : sums_)
            for (Error& error : core::scene::faults_at(moved_.scene, place)) errors.push_back(std::move(error));
        if (!errors.empty()) return errors;
        for (core::scene::Body& body : moved_.scene.bodies)
            if (!body.turn.isZero(0)) body.pose.rotation = core::kinematics::rotation(body.turn) * body.pose.rotation;
        for (size_t i = 0; i < moved_.scene.bodies.size(); ++i) make_shape(i, errors);
        if (!errors.empty()) return errors;
        return std::move(moved_);
    }

private:
    // Sums in the order of the file, so that the same file gives the same bits.
    void add(int parameter, const Move& move, double p) {
        const Place place = core::scene::find_place(moved_.scene, move.place).value();
        sums_[place] += move.scale * p + move.offset;
        moved_.numbers.push_back({parameter, place, move.scale});
    }

    Result<ShapeInstance> part_of(const Shape& shape, const std::vector<double>& values) const {
        if (derivative_ == SceneDerivative::wanted) return shape.at(values);
        Result<core::geometry::Mesh> mesh = shape.mesh(values);
        if (!mesh) return mesh.errors();
        return ShapeInstance{std::move(mesh).value(), {}};
    }

    // Of a body whose dimensions are moved.
    void make_shape(size_t i, Errors& errors) {
        const Shape* shape = description::shape_of(design_, static_cast<int>(i));
        if (shape == nullptr) return;
        core::scene::Body& body = moved_.scene.bodies[i];
        std::vector<double> values;
        std::vector<bool> is_moved;
        for (const description::ShapeDimension& dimension : shape->dimensions()) {
            const double& value = body.shape->dimensions.at(dimension.name);
            values.push_back(value);
            is_moved.push_back(is_moved_.count(&value) > 0);
        }
        if (std::find(is_moved.begin(), is_moved.end(), true) == is_moved.end()) return;
        Result<ShapeInstance> part = part_of(*shape, values);
        if (!part) {
            for (Error error : part.errors()) {
                error.where = "body " + body.name + ": " + error.where;
                errors.push_back(std::move(error));
            }
            return;
        }
        const bool differs = part->mesh.triangles != body.mesh.triangles || part->mesh.vertices.cols() != body.mesh.vertices.cols();
        if (differs && shape->has_fixed_triangles()) {
            errors.push_back({ErrorCode::mesh_invalid, "body " + body.name, "its shape has other triangles here than as drawn"});
            return;
        }
        for (size_t k = 0; k < part->jacobian.size(); ++k)
            if (is_moved[k]) moved_.jacobians[i][shape->dimensions()[k].name] = std::move(part->jacobian[k]);
        body.mesh = std::move(part->mesh);
    }

    const Design& design_;
    SceneDerivative derivative_;
    MovedScene moved_;
    std::map<Place, double> sums_;
    std::set<const double*> is_moved_;
};

// From the mesh and pose to the dimensions and the turn that they are made of: dR = [J dtheta] R.
void reverse_made(const MovedScene& moved, size_t i, core::scene::Body& bar) {
    for (const auto& [name, jacobian] : moved.jacobians[i]) {
        FETTLE_ASSERT(bar.mesh.vertices.cols() == jacobian.cols(), "the model keeps a part's vertices in their order");
        bar.shape->dimensions.at(name) = bar.mesh.vertices.cwiseProduct(jacobian).sum();
    }
    const core::scene::Body& body = moved.scene.bodies[i];
    const core::kinematics::PoseGradient gradient{bar.pose.position, bar.pose.rotation * body.pose.rotation.transpose()};
    bar.turn = core::kinematics::left_jacobian(body.turn).transpose() * tangent_gradient(gradient).tail<3>();
}

}  // namespace

Result<MovedScene> move_scene(const Design& design, const VectorX& p, SceneDerivative derivative) {
    FETTLE_ASSERT(p.size() == static_cast<Eigen::Index>(design.parameters.size()), "one value per parameter");
    return Mover(design, p, derivative).run();
}

VectorX pull_back(const MovedScene& moved, const core::model::Model& model, const adjoint::ModelGradient& gradient, int parameter_count) {
    Scene bar = adjoint::model::build_model_adjoint(moved.scene, model, gradient);
    for (size_t i = 0; i < bar.bodies.size(); ++i) reverse_made(moved, i, bar.bodies[i]);
    VectorX result = VectorX::Zero(parameter_count);
    for (const MovedNumber& number : moved.numbers) result[number.parameter] += number.slope * core::scene::at(bar, number.place);
    return result;
}

}  // namespace fettle::design::problem
