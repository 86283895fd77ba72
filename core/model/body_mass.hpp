// SPDX-License-Identifier: MIT
/// Mass of one body: what its mesh measures, integrated once, and the moments that the stepper works with.
#pragma once

#include <optional>

#include "core/model/model.hpp"
#include "core/scene/mass_kind.hpp"

namespace fettle::core::model {

/// What a mesh has to be multiplied with a density, in the file's frame.
struct BodyMeasure {
    Matrix4 unit_moments = Matrix4::Zero();  ///< by the body's MassKind (scene/mass_kind.hpp)
    bool closed_enough = true;               ///< a volume: closed, or nearly; else always

    double amount() const { return unit_moments(3, 3); }  ///< [m^3], [m^2], [m] or a number
    /// [m]; nullopt if there is no such mass.
    std::optional<Vector3> centre() const;
};

BodyMeasure measure_body(const geometry::Mesh& mesh, scene::MassKind kind);

/// c: what the scene names, else the centre of mass (the given one, where it is), else (a mesh without mass of its kind, such as an open
/// one per volume) the middle of its box. [m], in the file's frame.
Vector3 default_reference_point(const scene::Body& body, const BodyMeasure& measure);

/// Least inertia of a wire or points, about any axis, in mass times radius squared.
inline constexpr double least_inertia = 1e-8;

/// M of a body by its mass_kind and density, whose mesh is relative to the reference point and whose radius is known. A straight wire does
/// not resist being turned about itself, nor a point about anything, so that the Newton matrix would be singular: see build_model.hpp.
/// @param dhat  [m]
Matrix4 mass_moments(const Body& body, double dhat);

/// The same from what its mesh has with a density of 1, which bodies of one mesh have in common.
Matrix4 mass_moments(const Body& body, double dhat, const Matrix4& unit_moments);

}  // namespace fettle::core::model
