// SPDX-License-Identifier: MIT
#include "design/problem/moved_scene.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "adjoint/model/build_model_adjoint.hpp"
#include "core/base/contract.hpp"
#include "core/kinematics/tangent_system.hpp"

namespace fettle::design::problem {

namespace {

using core::scene::Place;
using core::scene::Scene;
using description::Design;
using description::Shape;
using description::ShapeInstance;

class Mover {
public:
    Mover(const Design& design, const VectorX& p, SceneDerivative derivative)
        : design_(design), derivative_(derivative), moved_{description::described_scene(design), {}, {}} {
        moved_.jacobians.resize(design.scene.bodies.size());
        const std::vector<std::string> names = description::names_of(design.parameters);
        for (const core::scene::BoundNumber& number : design.numbers) add(number, names, p);
    }

    Result<MovedScene> run() {
        Errors errors;
        for (const auto& [place, value] : values_) {
            double& number = core::scene::at(moved_.scene, place);
            number = value;
            is_moved_.insert(&number);
        }
        for (const auto& [place, value] : values_)
            for (Error& error : core::scene::faults_at(moved_.scene, place)) errors.push_back(std::move(error));
        if (!errors.empty()) return errors;
        for (core::scene::Body& body : moved_.scene.bodies) turn(body);
        for (size_t i = 0; i < moved_.scene.bodies.size(); ++i) make_shape(i, errors);
        if (!errors.empty()) return errors;
        return std::move(moved_);
    }

private:
    void add(const core::scene::BoundNumber& number, const std::vector<std::string>& names, const VectorX& p) {
        const Place place = core::scene::find_place(moved_.scene, number.place).value();
        const std::vector<int> positions = core::expression::positions_of(number.formula, names);
        std::vector<double> inputs;
        for (const int position : positions) inputs.push_back(p[position]);
        const core::expression::ValueAndGradient at = core::expression::differentiated(number.formula, inputs);
        values_[place] = at.value;
        for (size_t k = 0; k < positions.size(); ++k) moved_.numbers.push_back({positions[k], place, at.gradient[k]});
    }

    // The pose follows from what was moved of it.
    void turn(core::scene::Body& body) const {
        const double* numbers = body.orientation.numbers.data();
        const bool is_written_anew = std::any_of(numbers, numbers + 3, [&](const double& x) { return is_moved_.count(&x) > 0; });
        if (is_written_anew)
            core::scene::settle_rotation(body);
        else if (!body.turn.isZero(0))
            body.pose.rotation = core::kinematics::rotation(body.turn) * body.pose.rotation;
    }

    Result<ShapeInstance> part_of(const Shape& shape, const std::vector<double>& values, const std::vector<bool>& is_moved) const {
        if (derivative_ == SceneDerivative::wanted) return shape.differentiated(values, is_moved);
        Result<core::geometry::Mesh> mesh = shape.mesh(values);
        if (!mesh) return mesh.errors();
        return ShapeInstance{std::move(mesh).value(), {}};
    }

    // Makes the shape of a body whose dimensions are moved.
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
        Result<ShapeInstance> part = part_of(*shape, values, is_moved);
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
    std::map<Place, double> values_;
    std::set<const double*> is_moved_;
};

// From the mesh and pose to the dimensions, the turn and the angles that they are made of: dR = [J dturn + exp(turn) W dangles]x R.
void reverse_made(const MovedScene& moved, size_t i, core::scene::Body& bar) {
    for (const auto& [name, jacobian] : moved.jacobians[i]) {
        FETTLE_ASSERT(bar.mesh.vertices.cols() == jacobian.cols(), "the model keeps a part's vertices in their order");
        bar.shape->dimensions.at(name) = bar.mesh.vertices.cwiseProduct(jacobian).sum();
    }
    const core::scene::Body& body = moved.scene.bodies[i];
    const core::kinematics::PoseGradient gradient{bar.pose.position, bar.pose.rotation * body.pose.rotation.transpose()};
    const Vector3 turned = tangent_gradient(gradient).tail<3>();
    bar.turn = core::kinematics::left_jacobian(body.turn).transpose() * turned;
    const Matrix3 axes = core::kinematics::rotation(body.turn) * core::scene::rotation_axes(body.orientation);
    bar.orientation.numbers = axes.transpose() * turned;
}

}  // namespace

Result<MovedScene> move_scene(const Design& design, const VectorX& p, SceneDerivative derivative) {
    FETTLE_ASSERT(p.size() == static_cast<Eigen::Index>(design.parameters.size()), "one value per parameter");
    return Mover(design, p, derivative).run();
}

MatrixX pull_back(const MovedScene& moved, const core::model::Model& model, const std::vector<adjoint::ModelGradient>& gradients,
                  int parameter_count) {
    const adjoint::model::MechanismStartAdjoint start(model);
    MatrixX rows = MatrixX::Zero(count_of(gradients), parameter_count);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
        Scene bar = adjoint::model::build_model_adjoint(moved.scene, model, start, gradients[k]);
        for (size_t i = 0; i < bar.bodies.size(); ++i) reverse_made(moved, i, bar.bodies[i]);
        for (const MovedNumber& number : moved.numbers) rows(k, number.parameter) += number.slope * core::scene::at(bar, number.place);
    }
    return rows;
}

}  // namespace fettle::design::problem
