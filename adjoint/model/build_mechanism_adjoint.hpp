// SPDX-License-Identifier: MIT
/// From a model's frames, rows and terms back to the scene's joints, springs, motors and loads that they were made of
/// (core/model/build_mechanism.hpp). Values as written that rests, screws, gears and motors count from hang on the poses as written too.
/// A frame's axes are, for an axis of length |a|, z = a/|a|, and across it
///   x = unit(e x z), y = z x x, e the world's axis least along z;   of end b, as far as the two axes are not across each other,
///   x = unit((1 - z z^T) R_b^T R_a x_a), y = z x x.
/// Constants are the stiffness of stops, and the radius by which stops and friction of angles are measured (core/model/build_mechanism.hpp,
/// TermScales).
#pragma once

#include <array>
#include <vector>

#include "fettle/adjoint/model/mechanism_start_adjoint.hpp"
#include "fettle/core/scene/scene.hpp"

namespace fettle::adjoint::model {

struct AttachmentGradient {
    Vector3 point = Vector3::Zero(), axis = Vector3::Zero();  ///< the axis of any length
};

struct CoordinateForcesGradient {
    double stiffness = 0, rest = 0, preload = 0, damping = 0, friction = 0;
    std::array<double, 2> limits{0, 0};
};

/// Of a joint or spring.
struct EndsGradient {
    AttachmentGradient a, b;
    CoordinateForcesGradient forces;
    double pitch = 0, ratio = 0;
};

struct CurveGradient {
    double rate = 0;
    std::vector<double> values;
};

struct PointLoadGradient {
    Vector3 point = Vector3::Zero(), force = Vector3::Zero();
};

/// dJ/d(core::scene::Mechanism), list by list.
struct SceneMechanismGradient {
    std::vector<EndsGradient> joints, springs;
    std::vector<CurveGradient> motors;
    std::vector<PointLoadGradient> loads;
};

/// @param gradient  of the model, after written_start_adjoint.
/// @param start     poses as written: added to.
/// Contract: the model was built from the scene; a load whose force is 0 has no frames and no derivative, for the caller to refuse.
SceneMechanismGradient build_mechanism_adjoint(const core::scene::Scene& scene, const core::model::Model& model,
                                               const MechanismGradient& gradient, WrittenStartGradient& start);

}  // namespace fettle::adjoint::model
