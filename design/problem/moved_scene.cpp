// SPDX-License-Identifier: MIT
#include "fettle/design/problem/moved_scene.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "fettle/adjoint/model/mechanism_start_adjoint.hpp"
#include "fettle/core/base/contract.hpp"
#include "fettle/design/problem/friction_moves.hpp"
#include "fettle/design/problem/mechanism_moves.hpp"

namespace fettle::design::problem {

namespace {

using description::Design;
using description::Move;
using description::MoveTarget;
using description::Parameter;
using description::Shape;
using description::ShapeInstance;

// Finds or adds the change of a body by a parameter.
BodyChange& change_of(std::vector<BodyChange>& changes, int parameter, int body) {
    for (BodyChange& change : changes) {
        if (change.parameter == parameter && change.body == body) return change;
    }
    BodyChange change;
    change.parameter = parameter;
    change.body = body;
    changes.push_back(std::move(change));
    return changes.back();
}

// Sums of moves: sum of scale * p + offset in the order of the file, so that the same file gives the same bits.
class Mover {
public:
    Mover(const Design& design, const VectorX& p, SceneDerivative derivative)
        : design_(design), parameters_(design.parameters), p_(p), derivative_(derivative) {
        moved_.scene = design.scene;
    }

    Result<MovedScene> run() {
        for (size_t k = 0; k < parameters_.size(); ++k) {
            for (const Move& move : parameters_[k].moves) apply(static_cast<int>(k), move);
        }
        finish_rates();
        finish_vectors();
        finish_turns();
        finish_numbers();
        if (Errors bad = check_numbers(); !bad.empty()) return bad;
        const Errors errors = make_shapes();
        if (!errors.empty()) return errors;
        std::stable_sort(moved_.changes.begin(), moved_.changes.end(), [](const BodyChange& a, const BodyChange& b) {
            return std::pair(a.parameter, a.body) < std::pair(b.parameter, b.body);
        });
        return std::move(moved_);
    }

private:
    // A vector's components that are moved.
    struct VectorSum {
        Move move;
        Vector3 value = Vector3::Zero();
        std::array<bool, 3> set{false, false, false};
    };
    struct NumberSum {
        Move move;
        double value = 0;
    };
    // What is moved: two moves of one target have one key.
    using Key = std::tuple<MoveTarget, int, core::model::Origin::List, int, int, std::vector<std::string>>;
    static Key key_of(const Move& move) {
        const bool of_mechanism = is_of_mechanism(move.target);
        const bool of_materials = is_of_friction(move.target) && move.target != MoveTarget::body_mu;
        const bool of_body = !of_mechanism && !of_materials && !is_of_scene(move.target);
        std::vector<std::string> materials;
        if (of_materials) materials = move.materials;
        std::sort(materials.begin(), materials.end());
        return {move.target,
                of_body ? move.body : 0,
                of_mechanism ? move.part.list : core::model::Origin::List::joint,
                of_mechanism ? move.part.index : 0,
                move.target == MoveTarget::curve_value ? move.entry : 0,
                materials};
    }

    void apply(int k, const Move& move) {
        if (is_vector(move.target)) add_to_vector(move, p_[k]);
        if (is_of_mechanism(move.target) || is_of_friction(move.target) || is_of_scene(move.target)) {
            if (!is_vector(move.target)) add_to_number(move, p_[k]);
            moved_.linear_changes.push_back({k, move});
            return;
        }
        apply_to_body(k, move);
    }

    void add_to_number(const Move& move, double p) {
        NumberSum& sum = numbers_[key_of(move)];
        sum.move = move;
        sum.value += move.scale * p + move.offset;
    }

    void apply_to_body(int k, const Move& move) {
        const double value = move.scale * p_[k] + move.offset;
        core::scene::Body& body = moved_.scene.bodies[static_cast<size_t>(move.body)];
        BodyChange& change = change_of(moved_.changes, k, move.body);
        switch (move.target) {
            case MoveTarget::dimension:
                dimensions_[move.body][move.dimension] += value;
                break;
            case MoveTarget::position:
                change.position_dot += move.scale * move.direction;
                break;
            case MoveTarget::density:
                body.density = densities_[move.body] += value;
                change.density_dot += move.scale;
                break;
            case MoveTarget::motor_rate:
                rates_[{move.body, move.dof}] += value;
                change.rate_dot[move.dof] += move.scale;
                break;
            case MoveTarget::turn:
                break;  // finish_turns, when all are known
            default:
                moved_.linear_changes.push_back({k, move});
        }
    }

    void add_to_vector(const Move& move, double p) {
        VectorSum& sum = vectors_[key_of(move)];
        sum.move = move;
        for (int i = 0; i < 3; ++i) {
            if (move.direction[i] == 0) continue;
            sum.value[i] += move.scale * move.direction[i] * p + move.position_offset[i];
            sum.set[static_cast<size_t>(i)] = true;
        }
    }

    Vector3& moved_vector(const Move& move) {
        if (is_of_mechanism(move.target)) return vector_of(move, moved_.scene.mechanism);
        core::scene::Body& body = moved_.scene.bodies[static_cast<size_t>(move.body)];
        switch (move.target) {
            case MoveTarget::gravity:
                return moved_.scene.gravity;
            case MoveTarget::velocity:
                return body.linear_velocity;
            case MoveTarget::angular_velocity:
                return body.angular_velocity;
            case MoveTarget::force:
                return body.force;
            case MoveTarget::torque:
                return body.torque;
            default:
                FETTLE_ASSERT(move.target == MoveTarget::position, "a vector that is replaced");
                return body.pose.position;
        }
    }

    void finish_vectors() {
        for (const auto& [key, sum] : vectors_) {
            if (sum.move.target == MoveTarget::turn) continue;
            Vector3& vector = moved_vector(sum.move);
            for (int i = 0; i < 3; ++i) {
                if (sum.set[static_cast<size_t>(i)]) vector[i] = sum.value[i];
            }
        }
    }

    // R = exp([theta]) R0, dR = [J dtheta] R, J the left Jacobian.
    void finish_turns() {
        for (const auto& [key, sum] : vectors_) {
            if (sum.move.target != MoveTarget::turn) continue;
            Matrix3& rotation = moved_.scene.bodies[static_cast<size_t>(sum.move.body)].pose.rotation;
            rotation = core::kinematics::rotation(sum.value) * rotation;
        }
        for (size_t k = 0; k < parameters_.size(); ++k) {
            for (const Move& move : parameters_[k].moves) {
                if (move.target != MoveTarget::turn) continue;
                const Matrix3& rotation = moved_.scene.bodies[static_cast<size_t>(move.body)].pose.rotation;
                const Matrix3 left = core::kinematics::left_jacobian(vectors_.at(key_of(move)).value);
                change_of(moved_.changes, static_cast<int>(k), move.body).rotation_dot +=
                    cross_matrix(left * (move.scale * move.direction)) * rotation;
            }
        }
    }

    void finish_numbers() {
        for (const auto& [key, sum] : numbers_) {
            if (sum.move.target == MoveTarget::dmin)
                moved_.scene.dmin = sum.value;
            else if (is_of_friction(sum.move.target))
                set_coefficient(sum.move, sum.value, moved_.scene);
            else
                set_number(sum.move, sum.value, moved_.scene.mechanism);
        }
    }

    Errors check_numbers() const {
        Errors errors;
        if (!(moved_.scene.dmin >= 0)) errors.push_back({ErrorCode::out_of_range, "dmin", "the minimum separation is not negative"});
        for (const LinearChange& change : moved_.linear_changes) {
            if (is_of_mechanism(change.move.target))
                for (Error& error : moved_badly(moved_.scene.mechanism, change.move)) errors.push_back(std::move(error));
            if (is_of_friction(change.move.target))
                for (Error& error : coefficient_moved_badly(moved_.scene, change.move)) errors.push_back(std::move(error));
        }
        return errors;
    }

    void finish_rates() {
        for (const auto& [target, rate] : rates_) {
            auto& curve = moved_.scene.bodies[static_cast<size_t>(target.first)].prescribed[static_cast<size_t>(target.second)];
            FETTLE_ASSERT(curve.has_value(), "a motor's rate moves a prescribed coordinate");
            curve->rate = rate;
        }
    }

    Result<ShapeInstance> part_of(const Shape& shape, const std::vector<double>& values) const {
        if (derivative_ == SceneDerivative::wanted) return shape.at(values);
        Result<core::geometry::Mesh> mesh = shape.mesh(values);
        if (!mesh) return mesh.errors();
        return ShapeInstance{std::move(mesh).value(), {}};
    }

    Errors make_shapes() {
        Errors errors;
        for (const auto& [index, moved] : dimensions_) {
            core::scene::Body& body = moved_.scene.bodies[static_cast<size_t>(index)];
            const Shape* shape = description::shape_of(design_, index);
            FETTLE_ASSERT(shape != nullptr, "a dimension belongs to a shape");
            std::vector<double> values;
            for (const description::ShapeDimension& dimension : shape->dimensions()) {
                const auto found = moved.find(dimension.name);
                values.push_back(found == moved.end() ? dimension.value : found->second);
            }
            Result<ShapeInstance> part = part_of(*shape, values);
            if (!part) {
                for (Error error : part.errors()) {
                    error.where = "body " + body.name + ": " + error.where;
                    errors.push_back(std::move(error));
                }
                continue;
            }
            const bool differs = part->mesh.triangles != body.mesh.triangles || part->mesh.vertices.cols() != body.mesh.vertices.cols();
            if (differs && shape->has_fixed_triangles()) {
                errors.push_back({ErrorCode::mesh_invalid, "body " + body.name, "its shape has other triangles here than as drawn"});
                continue;
            }
            if (derivative_ == SceneDerivative::wanted) add_vertex_changes(index, *shape, part->jacobian);
            body.mesh = std::move(part->mesh);
        }
        return errors;
    }

    void add_vertex_changes(int body, const Shape& shape, const std::vector<Matrix3X>& jacobians) {
        const auto& dimensions = shape.dimensions();
        for (size_t k = 0; k < parameters_.size(); ++k) {
            for (const Move& move : parameters_[k].moves) {
                if (move.target != MoveTarget::dimension || move.body != body) continue;
                const auto found = std::find_if(dimensions.begin(), dimensions.end(),
                                                [&](const auto& dimension) { return dimension.name == move.dimension; });
                FETTLE_ASSERT(found != dimensions.end(), "a shape names its dimensions");
                const Matrix3X& jacobian = jacobians[static_cast<size_t>(found - dimensions.begin())];
                BodyChange& change = change_of(moved_.changes, static_cast<int>(k), body);
                if (change.vertices_dot.cols() == 0) change.vertices_dot = Matrix3X::Zero(3, jacobian.cols());
                change.vertices_dot += move.scale * jacobian;
            }
        }
    }

    const Design& design_;
    const std::vector<Parameter>& parameters_;
    const VectorX& p_;
    SceneDerivative derivative_;
    MovedScene moved_;
    std::map<int, std::map<std::string, double>> dimensions_;
    std::map<Key, VectorSum> vectors_;
    std::map<Key, NumberSum> numbers_;
    std::map<int, double> densities_;
    std::map<std::pair<int, int>, double> rates_;
};

// d(increment over step t)/d(rate): the time during which the motor runs.
double running_time(const core::scene::MotionCurve& curve, double start, double end) {
    const double stop = curve.stop_time.value_or(end);
    return std::min(end, stop) - std::min(start, stop);
}

double motor_part(const BodyChange& change, const core::model::Model& model, const adjoint::BodyGradient& bar) {
    const core::model::Body& body = model.bodies[static_cast<size_t>(change.body)];
    double sum = 0;
    for (int dof = 0; dof < 6; ++dof) {
        if (change.rate_dot[dof] == 0 || !body.prescribed[static_cast<size_t>(dof)]) continue;
        const core::scene::MotionCurve& curve = *body.prescribed[static_cast<size_t>(dof)];
        for (size_t t = 0; t < bar.increment_bar.size(); ++t) {
            const double start = static_cast<double>(t) * model.timestep;
            sum += bar.increment_bar[t][dof] * running_time(curve, start, start + model.timestep) * change.rate_dot[dof];
        }
    }
    return sum;
}

Matrix3 written_rotation(const core::model::Model& model, size_t i) {
    const auto& written = model.mechanism.written.poses;
    return written.empty() ? model.bodies[i].pose_start.rotation : written[i].rotation;
}

// Entry by entry; without joints nothing stands between what was written and the start.
Matrix34 written_pose_bar(const core::model::Model& model, const adjoint::model::WrittenStartGradient& start,
                          const adjoint::BodyGradient& bar, size_t i) {
    const core::model::Body& body = model.bodies[i];
    Matrix34 out;
    if (!model.mechanism.empty()) {
        out << 0.5 * cross_matrix(start.pose_bar[i].tail<3>()) * written_rotation(model, i), start.pose_bar[i].head<3>();
        return out;
    }
    const Matrix3 omega = body.velocity_start.leftCols<3>() * body.pose_start.rotation.transpose();
    out = bar.pose_start_bar;
    out.leftCols<3>() += omega.transpose() * bar.velocity_start_bar.leftCols<3>();
    return out;
}

// Of what stands in the scene's mechanism and friction.
struct SceneGradient {
    adjoint::model::SceneMechanismGradient mechanism;
    adjoint::model::SceneFrictionGradient friction;
};

double linear_part(const Move& move, const core::scene::Scene& scene, const adjoint::ModelGradient& gradient,
                   const adjoint::model::WrittenStartGradient& start, const SceneGradient& of_scene) {
    const auto body = static_cast<size_t>(move.body);
    if (is_of_mechanism(move.target)) {
        if (!is_vector(move.target)) return move.scale * number_gradient(move, of_scene.mechanism);
        return move.scale * move.direction.dot(vector_gradient(move, of_scene.mechanism));
    }
    if (is_of_friction(move.target)) return move.scale * coefficient_gradient(move, scene, of_scene.friction);
    switch (move.target) {
        case MoveTarget::gravity:
            return move.scale * move.direction.dot(gradient.gravity_bar);
        case MoveTarget::dmin:
            return move.scale * gradient.dmin_bar;
        case MoveTarget::velocity:
            return move.scale * move.direction.dot(start.velocity_bar[body].head<3>());
        case MoveTarget::angular_velocity:
            return move.scale * move.direction.dot(start.velocity_bar[body].tail<3>());
        case MoveTarget::force:
            return move.scale * move.direction.dot(gradient.bodies[body].force_bar);
        default:
            FETTLE_ASSERT(move.target == MoveTarget::torque, "every target has its derivative");
            return move.scale * move.direction.dot(gradient.bodies[body].torque_bar);
    }
}

}  // namespace

Result<MovedScene> move_scene(const Design& design, const VectorX& p, SceneDerivative derivative) {
    FETTLE_ASSERT(p.size() == static_cast<Eigen::Index>(design.parameters.size()), "one value per parameter");
    return Mover(design, p, derivative).run();
}

VectorX pull_back(const MovedScene& moved, const core::model::Model& model, const adjoint::ModelGradient& of_model, int parameter_count) {
    adjoint::ModelGradient gradient = of_model;
    adjoint::model::WrittenStartGradient start = adjoint::model::written_start_adjoint(model, gradient);
    const SceneGradient of_scene{adjoint::model::build_mechanism_adjoint(moved.scene, model, gradient.mechanism, start),
                                 adjoint::model::build_friction_adjoint(moved.scene, gradient.friction_bar)};
    VectorX result = VectorX::Zero(parameter_count);
    for (const BodyChange& change : moved.changes) {
        const auto i = static_cast<size_t>(change.body);
        const adjoint::BodyGradient& bar = gradient.bodies[i];
        const Vector3& c = model.bodies[i].reference_point;
        double sum = 0;
        if (change.vertices_dot.cols() > 0) {
            FETTLE_ASSERT(bar.vertices_bar.cols() == change.vertices_dot.cols(), "the model keeps a part's vertices in their order");
            sum += bar.vertices_bar.cwiseProduct(change.vertices_dot).sum();
        }
        const Matrix34 pose_bar = written_pose_bar(model, start, bar, i);
        sum += pose_bar.leftCols<3>().cwiseProduct(change.rotation_dot).sum();
        sum += pose_bar.col(3).dot(change.rotation_dot * c + change.position_dot);
        sum += bar.density_bar * change.density_dot;
        sum += motor_part(change, model, bar) + start.rate_bar[i].dot(change.rate_dot);
        result[change.parameter] += sum;
    }
    for (const LinearChange& change : moved.linear_changes)
        result[change.parameter] += linear_part(change.move, moved.scene, gradient, start, of_scene);
    return result;
}

}  // namespace fettle::design::problem
