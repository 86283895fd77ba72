// SPDX-License-Identifier: MIT
#include "fettle/design/problem/moved_scene.hpp"

#include <algorithm>
#include <map>

#include "fettle/core/base/contract.hpp"

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
    Mover(const Design& design, const VectorX& p) : design_(design), parameters_(design.parameters), p_(p) { moved_.scene = design.scene; }

    Result<MovedScene> run() {
        for (size_t k = 0; k < parameters_.size(); ++k) {
            for (const Move& move : parameters_[k].moves) apply(static_cast<int>(k), move);
        }
        finish_positions();
        finish_rates();
        const Errors errors = make_shapes();
        if (!errors.empty()) return errors;
        std::stable_sort(moved_.changes.begin(), moved_.changes.end(), [](const BodyChange& a, const BodyChange& b) {
            return std::pair(a.parameter, a.body) < std::pair(b.parameter, b.body);
        });
        return std::move(moved_);
    }

private:
    struct PositionSum {
        Vector3 value = Vector3::Zero();
        std::array<bool, 3> set{false, false, false};
    };

    void apply(int k, const Move& move) {
        const double value = move.scale * p_[k] + move.offset;
        core::scene::Body& body = moved_.scene.bodies[static_cast<size_t>(move.body)];
        BodyChange& change = change_of(moved_.changes, k, move.body);
        switch (move.target) {
            case MoveTarget::dimension:
                dimensions_[move.body][move.dimension] += value;
                break;
            case MoveTarget::position:
                change.position_dot += move.scale * move.direction;
                add_position(move, p_[k]);
                break;
            case MoveTarget::density:
                body.density = densities_[move.body] += value;
                change.density_dot += move.scale;
                break;
            case MoveTarget::motor_rate:
                rates_[{move.body, move.dof}] += value;
                change.rate_dot[move.dof] += move.scale;
                break;
        }
    }

    void add_position(const Move& move, double p) {
        PositionSum& sum = positions_[move.body];
        for (int i = 0; i < 3; ++i) {
            if (move.direction[i] == 0) continue;
            sum.value[i] += move.scale * move.direction[i] * p + move.position_offset[i];
            sum.set[static_cast<size_t>(i)] = true;
        }
    }

    void finish_positions() {
        for (const auto& [body, sum] : positions_) {
            for (int i = 0; i < 3; ++i) {
                if (sum.set[static_cast<size_t>(i)]) moved_.scene.bodies[static_cast<size_t>(body)].pose.position[i] = sum.value[i];
            }
        }
    }

    void finish_rates() {
        for (const auto& [target, rate] : rates_) {
            auto& curve = moved_.scene.bodies[static_cast<size_t>(target.first)].prescribed[static_cast<size_t>(target.second)];
            FETTLE_ASSERT(curve.has_value(), "a motor's rate moves a prescribed coordinate");
            curve->rate = rate;
        }
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
            Result<ShapeInstance> part = shape->at(values);
            if (!part) {
                for (Error error : part.errors()) {
                    error.where = "body " + body.name + ": " + error.where;
                    errors.push_back(std::move(error));
                }
                continue;
            }
            if (part->mesh.triangles != body.mesh.triangles || part->mesh.vertices.cols() != body.mesh.vertices.cols()) {
                errors.push_back({ErrorCode::mesh_invalid, "body " + body.name, "its shape has other triangles here than as drawn"});
                continue;
            }
            add_vertex_changes(index, *shape, part->jacobian);
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
    MovedScene moved_;
    std::map<int, std::map<std::string, double>> dimensions_;
    std::map<int, PositionSum> positions_;
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

}  // namespace

Result<MovedScene> move_scene(const Design& design, const VectorX& p) {
    FETTLE_ASSERT(p.size() == static_cast<Eigen::Index>(design.parameters.size()), "one value per parameter");
    return Mover(design, p).run();
}

VectorX pull_back(const MovedScene& moved, const core::model::Model& model, const adjoint::ModelGradient& gradient, int parameter_count) {
    VectorX result = VectorX::Zero(parameter_count);
    for (const BodyChange& change : moved.changes) {
        const adjoint::BodyGradient& bar = gradient.bodies[static_cast<size_t>(change.body)];
        const Vector3& c = model.bodies[static_cast<size_t>(change.body)].reference_point;
        double sum = 0;
        if (change.vertices_dot.cols() > 0) {
            FETTLE_ASSERT(bar.vertices_bar.cols() == change.vertices_dot.cols(), "the model keeps a part's vertices in their order");
            sum += bar.vertices_bar.cwiseProduct(change.vertices_dot).sum();
        }
        sum += bar.pose_start_bar.leftCols<3>().cwiseProduct(change.rotation_dot).sum();
        sum += bar.pose_start_bar.col(3).dot(change.rotation_dot * c + change.position_dot);
        sum += bar.density_bar * change.density_dot;
        sum += motor_part(change, model, bar);
        result[change.parameter] += sum;
    }
    return result;
}

}  // namespace fettle::design::problem
