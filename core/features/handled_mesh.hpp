// SPDX-License-Identifier: MIT
/// A mesh with dimensions (handle.hpp): its corners as a function of one value for each handle, with the exact derivative, and what must
/// hold of a mesh whose dimensions are changed.
///
///     const std::vector<core::features::Handle> handles{{.name = "bore", .features = {"B1", "B2"}}};
///     const auto part = core::features::HandledMesh::create(mesh, handles);
///     if (!part) return 3;  // no such bore, two that are not of one radius
///     const auto wider = part->at({2.2e-3});  // errors: a face that would bend, a triangle that would turn over, a wall cut through
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/expression/tape.hpp"
#include "core/features/find_features.hpp"
#include "core/features/handle.hpp"

namespace fettle::core::features {

class HandledMesh {
public:
    /// Finds the features itself. @param wall  material that must be left behind features that handles change [m]; 0: some
    /// Errors: those of displacement_of; unsupported, of a mesh that stands for exact surfaces (Mesh::deviation): a handle that bends them.
    static base::Result<HandledMesh> create(geometry::Mesh mesh, const std::vector<Handle>& handles, double wall = 0);
    /// With features that were found before.
    static base::Result<HandledMesh> create(geometry::Mesh mesh, Features features, const std::vector<Handle>& handles, double wall = 0);

    const geometry::Mesh& drawn() const { return mesh_; }
    const Features& features() const { return features_; }
    double drawn_value(std::size_t handle) const { return displacements_[handle].drawn; }

    /// The mesh at other values [SI], one for each handle: the same triangles; corners that nothing moves are the same bit for bit.
    /// Errors (mesh_invalid, inconsistent), with `where` the handle's name, or the feature's where it has one, and in the message the
    /// place:
    ///   - a triangle would turn over, or the surface pass through itself
    ///   - a flat or round face that a handle of features does not move would bend, or one that lies in a stretch, a move or a turn: a
    ///     cone beside a bore on its axis may change its slope, but not lean the other way
    ///   - less than the wall would be left behind a feature that is changed (wall_behind: measured, not proven)
    base::Result<geometry::Mesh> at(const std::vector<double>& values) const;

    /// d corners / d value, 3 x n for each handle.
    std::vector<Matrix3X> jacobian(const std::vector<double>& values) const;

    /// Corners as formulas of the values.
    struct Recorded {
        expression::Nodes nodes;
        std::vector<std::array<int, 3>> vertices;
    };
    Recorded recorded(const std::vector<double>& values) const;

private:
    class Check;
    HandledMesh(geometry::Mesh mesh, Features features, double wall)
        : mesh_(std::move(mesh)), features_(std::move(features)), wall_(wall) {}
    Matrix3X moved(const std::vector<double>& values) const;
    std::optional<base::Error> fault_of_wall(const geometry::Mesh& mesh, const std::vector<double>& values) const;
    double growth(const std::vector<double>& values) const;

    geometry::Mesh mesh_;
    Features features_;
    double wall_ = 0;
    std::vector<std::string> names_;           ///< of handles
    std::vector<Displacement> displacements_;  ///< one for each
};

}  // namespace fettle::core::features
