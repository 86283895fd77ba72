// SPDX-License-Identifier: MIT
/// Bodies and their motion as other programs want them: named, coloured parts and keyframes. Made from a model and its trajectory; what
/// writes it: glb_writer.hpp, vtk_writer.hpp, export_files.hpp, picture.hpp.
#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"
#include "core/stepper/trajectory.hpp"
#include "design/exports/palette.hpp"

namespace fettle::design::exports {

struct AssemblyPart {
    std::string name;
    Colour colour{};
    core::geometry::Mesh mesh;                  ///< relative to the reference point [m]
    Vector3 reference_point = Vector3::Zero();  ///< in the file's frame [m]
    bool moves = false;                         ///< somewhere in the keyframes
};

struct Keyframe {
    double time = 0;                              ///< [s]
    bool ends_step = true;                        ///< the start, or the end of a time step
    std::vector<core::kinematics::Pose> poses{};  ///< of the reference points' frames, one per part
};

struct Assembly {
    std::vector<AssemblyPart> parts;
    std::vector<Keyframe> keyframes;  ///< at least one, in the order of time
    double length_unit = 1;           ///< of the scene [m]
    Vector3 up = Vector3::UnitZ();
};

/// Keyframes are the nodes of the curved path, and between them as many as it takes for an interpolation with translations straight and
/// rotations at constant rate about one direction (glTF's LINEAR) to stay on the path: exact between the first two nodes of a step,
/// elsewhere within 1e-6 of a body's radius.
/// Contract: the trajectory is the model's.
Assembly assembly_of(const core::model::Model& model, const core::stepper::Trajectory& trajectory);

/// The mesh in its file's frame [m].
core::geometry::Mesh file_mesh(const AssemblyPart& part);

/// Pose of the file's frame: a point x of file_mesh is at rotation * x + position.
core::kinematics::Pose file_pose(const AssemblyPart& part, const core::kinematics::Pose& pose);

/// Up as gravity has it: the axis (+x to -z) nearest to against it; Z where there is no gravity.
Vector3 up_of(const Vector3& gravity);

}  // namespace fettle::design::exports
