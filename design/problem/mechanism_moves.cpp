// SPDX-License-Identifier: MIT
#include "fettle/design/problem/mechanism_moves.hpp"

#include "fettle/core/base/contract.hpp"

namespace fettle::design::problem {

namespace {

using adjoint::model::EndsGradient;
using adjoint::model::SceneMechanismGradient;
using core::model::Origin;
using core::scene::CoordinateForces;
using core::scene::Joint;
using core::scene::JointKind;
using core::scene::Mechanism;
using description::Move;
using description::MoveTarget;
using List = Origin::List;

size_t index_of(const Move& move) { return static_cast<size_t>(move.part.index); }

size_t length_of(const Mechanism& mechanism, List list) {
    switch (list) {
        case List::joint:
            return mechanism.joints.size();
        case List::spring:
            return mechanism.springs.size();
        case List::motor:
            return mechanism.motors.size();
        case List::load:
            return mechanism.loads.size();
    }
    return 0;
}

std::string name_of(const Mechanism& mechanism, const Move& move) {
    switch (move.part.list) {
        case List::joint:
            return mechanism.joints[index_of(move)].name;
        case List::spring:
            return mechanism.springs[index_of(move)].name;
        case List::motor:
            return mechanism.motors[index_of(move)].name;
        case List::load:
            return mechanism.loads[index_of(move)].name;
    }
    return {};
}

CoordinateForces& forces_of(const Move& move, Mechanism& mechanism) {
    return move.part.list == List::joint ? mechanism.joints[index_of(move)].forces : mechanism.springs[index_of(move)].forces;
}

const CoordinateForces& forces_of(const Move& move, const Mechanism& mechanism) {
    return move.part.list == List::joint ? mechanism.joints[index_of(move)].forces : mechanism.springs[index_of(move)].forces;
}

bool couples(const Joint& joint) { return joint.kind == JointKind::gear || joint.kind == JointKind::rack; }

bool has_coordinate(const Joint& joint) {
    return joint.kind == JointKind::revolute || joint.kind == JointKind::screw || joint.kind == JointKind::prismatic ||
           joint.kind == JointKind::cylindrical;
}

std::string misfit_of_ends(const Mechanism& mechanism, const Move& move) {
    const bool is_joint = move.part.list == List::joint;
    const bool is_axis = move.target == MoveTarget::axis_a || move.target == MoveTarget::axis_b;
    const std::string none = "has no " + std::string(is_axis ? "axis" : "point") + " of its own";
    if (!is_joint) return is_axis || !mechanism.springs[index_of(move)].joint.empty() ? none : "";
    const Joint& joint = mechanism.joints[index_of(move)];
    return couples(joint) || (is_axis && joint.kind == JointKind::ball) ? none : "";
}

std::string misfit_of_forces(const Mechanism& mechanism, const Move& move) {
    const bool is_joint = move.part.list == List::joint;
    if (is_joint && !has_coordinate(mechanism.joints[index_of(move)])) return "has no coordinate for a force to act along";
    const CoordinateForces& forces = forces_of(move, mechanism);
    const bool of_spring = move.target == MoveTarget::rest || move.target == MoveTarget::preload || move.target == MoveTarget::stiffness;
    if (of_spring && !(forces.stiffness > 0)) return "has no spring: a `stiffness` greater than 0 is wanted in the scene";
    if (move.target == MoveTarget::preload && forces.rest) return "has a `rest`, from which its preload follows";
    if (move.target == MoveTarget::rest && forces.preload != 0) return "has a `preload`, from which its rest follows";
    if (move.target == MoveTarget::damping && !(forces.damping > 0)) return "has no `damping` greater than 0 in the scene";
    if (move.target == MoveTarget::friction && !(forces.friction > 0)) return "has no `friction` greater than 0 in the scene";
    const bool of_limits = move.target == MoveTarget::lower_limit || move.target == MoveTarget::upper_limit;
    return of_limits && !forces.limits ? "has no `limits` in the scene" : "";
}

std::string misfit_of_kind(const Mechanism& mechanism, const Move& move) {
    const List list = move.part.list;
    switch (move.target) {
        case MoveTarget::point_a:
        case MoveTarget::point_b:
        case MoveTarget::axis_a:
        case MoveTarget::axis_b:
            return list == List::joint || list == List::spring ? misfit_of_ends(mechanism, move) : "is no joint or spring";
        case MoveTarget::pitch:
            return list == List::joint && mechanism.joints[index_of(move)].kind == JointKind::screw ? "" : "is no screw";
        case MoveTarget::ratio:
            return list == List::joint && couples(mechanism.joints[index_of(move)]) ? "" : "is no gear or rack";
        case MoveTarget::curve_rate:
            return list == List::motor ? "" : "is no motor";
        case MoveTarget::curve_value:
            if (list != List::motor) return "is no motor";
            return move.entry >= 0 && static_cast<size_t>(move.entry) < mechanism.motors[index_of(move)].curve.values.size()
                       ? ""
                       : "has no such value in its curve";
        case MoveTarget::load_point:
        case MoveTarget::load_force:
            return list == List::load ? "" : "is no load";
        default:
            return list == List::joint || list == List::spring ? misfit_of_forces(mechanism, move) : "is no joint or spring";
    }
}

const EndsGradient& ends_of(const Move& move, const SceneMechanismGradient& gradient) {
    return move.part.list == List::joint ? gradient.joints[index_of(move)] : gradient.springs[index_of(move)];
}

}  // namespace

std::string misfit(const Mechanism& mechanism, const Move& move) {
    FETTLE_ASSERT(is_of_mechanism(move.target), "a move of a mechanism's part");
    if (move.part.index < 0 || index_of(move) >= length_of(mechanism, move.part.list))
        return "there is no joint, spring, motor or load of that number";
    const std::string reason = misfit_of_kind(mechanism, move);
    return reason.empty() ? reason : "`" + name_of(mechanism, move) + "` " + reason;
}

void set_number(const Move& move, double value, Mechanism& mechanism) {
    switch (move.target) {
        case MoveTarget::stiffness:
            forces_of(move, mechanism).stiffness = value;
            break;
        case MoveTarget::rest:
            forces_of(move, mechanism).rest = value;
            break;
        case MoveTarget::preload:
            forces_of(move, mechanism).preload = value;
            break;
        case MoveTarget::damping:
            forces_of(move, mechanism).damping = value;
            break;
        case MoveTarget::friction:
            forces_of(move, mechanism).friction = value;
            break;
        case MoveTarget::lower_limit:
            (*forces_of(move, mechanism).limits)[0] = value;
            break;
        case MoveTarget::upper_limit:
            (*forces_of(move, mechanism).limits)[1] = value;
            break;
        case MoveTarget::pitch:
            mechanism.joints[index_of(move)].pitch = value;
            break;
        case MoveTarget::ratio:
            mechanism.joints[index_of(move)].ratio = value;
            break;
        case MoveTarget::curve_value:
            mechanism.motors[index_of(move)].curve.values[static_cast<size_t>(move.entry)] = value;
            break;
        case MoveTarget::curve_rate:
            mechanism.motors[index_of(move)].curve.rate = value;
            break;
        default:
            FETTLE_ASSERT(false, "a number of a mechanism's part");
    }
}

Vector3& vector_of(const Move& move, Mechanism& mechanism) {
    const size_t i = index_of(move);
    const bool is_joint = move.part.list == List::joint;
    switch (move.target) {
        case MoveTarget::point_a:
            return is_joint ? mechanism.joints[i].a.point : mechanism.springs[i].a.point;
        case MoveTarget::point_b:
            return is_joint ? mechanism.joints[i].b.point : mechanism.springs[i].b.point;
        case MoveTarget::axis_a:
            return mechanism.joints[i].a.axis;
        case MoveTarget::axis_b:
            return mechanism.joints[i].b.axis;
        case MoveTarget::load_point:
            return mechanism.loads[i].point;
        default:
            FETTLE_ASSERT(move.target == MoveTarget::load_force, "a vector of a mechanism's part");
            return mechanism.loads[i].force;
    }
}

double number_gradient(const Move& move, const SceneMechanismGradient& gradient) {
    const size_t i = index_of(move);
    switch (move.target) {
        case MoveTarget::stiffness:
            return ends_of(move, gradient).forces.stiffness;
        case MoveTarget::rest:
            return ends_of(move, gradient).forces.rest;
        case MoveTarget::preload:
            return ends_of(move, gradient).forces.preload;
        case MoveTarget::damping:
            return ends_of(move, gradient).forces.damping;
        case MoveTarget::friction:
            return ends_of(move, gradient).forces.friction;
        case MoveTarget::lower_limit:
            return ends_of(move, gradient).forces.limits[0];
        case MoveTarget::upper_limit:
            return ends_of(move, gradient).forces.limits[1];
        case MoveTarget::pitch:
            return gradient.joints[i].pitch;
        case MoveTarget::ratio:
            return gradient.joints[i].ratio;
        case MoveTarget::curve_value:
            return gradient.motors[i].values[static_cast<size_t>(move.entry)];
        default:
            FETTLE_ASSERT(move.target == MoveTarget::curve_rate, "a number of a mechanism's part");
            return gradient.motors[i].rate;
    }
}

Vector3 vector_gradient(const Move& move, const SceneMechanismGradient& gradient) {
    switch (move.target) {
        case MoveTarget::point_a:
            return ends_of(move, gradient).a.point;
        case MoveTarget::point_b:
            return ends_of(move, gradient).b.point;
        case MoveTarget::axis_a:
            return ends_of(move, gradient).a.axis;
        case MoveTarget::axis_b:
            return ends_of(move, gradient).b.axis;
        case MoveTarget::load_point:
            return gradient.loads[index_of(move)].point;
        default:
            FETTLE_ASSERT(move.target == MoveTarget::load_force, "a vector of a mechanism's part");
            return gradient.loads[index_of(move)].force;
    }
}

Errors moved_badly(const Mechanism& mechanism, const Move& move) {
    const std::string where = "`" + name_of(mechanism, move) + "`";
    const auto none = [&](double value, const char* what) -> Errors {
        if (value > 0) return {};
        return {{ErrorCode::out_of_range, where, std::string("its ") + what + " must be greater than 0 for a derivative"}};
    };
    switch (move.target) {
        case MoveTarget::stiffness:
            return none(forces_of(move, mechanism).stiffness, "stiffness");
        case MoveTarget::damping:
            return none(forces_of(move, mechanism).damping, "damping");
        case MoveTarget::friction:
            return none(forces_of(move, mechanism).friction, "friction");
        case MoveTarget::load_force:
            return none(mechanism.loads[index_of(move)].force.norm(), "force");
        case MoveTarget::ratio:
            if (mechanism.joints[index_of(move)].ratio != 0) return {};
            return {{ErrorCode::out_of_range, where, "its ratio (of a rack: its radius) must not be 0"}};
        case MoveTarget::lower_limit:
        case MoveTarget::upper_limit: {
            const auto& limits = *forces_of(move, mechanism).limits;
            if (limits[0] < limits[1]) return {};
            return {{ErrorCode::out_of_range, where, "its lower limit must be less than the upper one"}};
        }
        default:
            return {};
    }
}

}  // namespace fettle::design::problem
