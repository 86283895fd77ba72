// SPDX-License-Identifier: MIT
/// What a part has for another to meet: planes, bores, pins, cones, spheres, tori, as plain values. From meshes they are fitted
/// (find_features.hpp); a reader of exact surfaces fills the same.
#pragma once

#include <string>
#include <vector>

#include "core/features/surface.hpp"

namespace fettle::core::features {

/// Where a hole or boss ends along its axis.
enum class End {
    open,    ///< the material ends there: a hole opens, a boss has its free end
    closed,  ///< material goes on: the bottom of a hole, the step to a narrower one; the shoulder that a boss stands on
    cut      ///< neither: another surface cuts it off at the side
};
const char* to_string(End end);

/// From where to where along the axis, measured from `Feature::origin` [m].
struct Stretch {
    double from = 0, to = 0;
};

struct Feature {
    std::string name;  ///< "B1" of a bore, P of a pin, R of a rounded edge or fillet, F of a flat face, C, S, T of the others
    Surface surface;   ///< `point` lies beside the middle of the length; the axis points along its largest coordinate; of a plane outwards
    bool is_hole = false;  ///< the material is outside; of planes false
    bool is_rounding =
        false;  ///< a cylinder that joins its neighbours smoothly over less than a half turn: an edge rounded, a corner filled
    Vector3 origin = Vector3::Zero();  ///< the axis' point nearest to the frame's origin; of a plane its foot; of a sphere its centre [m]
    Stretch along{};                   ///< of cylinders, cones, tori
    std::vector<Stretch> pieces{};     ///< of cylinders that are interrupted: each; else one
    End lower = End::cut, upper = End::cut;  ///< at `along.from`, at `along.to`
    bool is_through = false;                 ///< of holes: both ends open, or with narrower holes on the same axis that are
    double covered = 0;                      ///< how much of the turn about the axis its facets cover [rad]
    double area = 0;                         ///< of its facets [m^2]
    Vector3 centre = Vector3::Zero();        ///< of the facets' area [m]
    bool is_exact = false;                   ///< the surface is given, not fitted
    double residual = 0;                     ///< the largest distance of a facet's corner that should lie on it [m]
    /// The facets' least and largest distance from the axis or centre (of tori: from the tube's middle circle, corners alone; of cones 0)
    /// [m]. The surface that a mesh was made for lies between, whichever way its facets lean.
    double facets_least = 0, facets_largest = 0;
    std::vector<std::string> coaxial{};  ///< other cylinders, cones and tori of the part on the same axis, to within the tolerance
    std::vector<int> triangles{};        ///< of the mesh, ascending

    double length() const { return along.to - along.from; }
    /// A cone's radius at a height along the axis.
    double radius_at(double height) const { return surface.radius + surface.slope * (height - surface.axis.dot(surface.point - origin)); }
};

struct Features {
    std::vector<Feature> features;  ///< bores, pins, cones, spheres, tori, roundings, flat faces; each kind by place
    double tolerance = 0;           ///< that was used [m]
    double area = 0;                ///< of the mesh [m^2]
    double free_form_area = 0;      ///< of what belongs to none [m^2]
    std::vector<int> free_form{};   ///< its triangles
    /// Index of the feature of this name; -1: none.
    int find(const std::string& name) const;
    /// [triangle] the feature that it is of; -1: of none. @param triangles  of the mesh
    std::vector<int> by_triangle(std::size_t triangles) const;
};

}  // namespace fettle::core::features
