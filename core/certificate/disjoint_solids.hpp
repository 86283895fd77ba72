// SPDX-License-Identifier: MIT
/// Are two solids disjoint, and not one inside the other? Surfaces that stay apart do not decide this: a ball inside a block is far from
/// its faces. But surfaces that never meet leave every connected part of one body on the same side of the other for all the time, so that
/// one instant decides, exactly:
///   let x be a point of body a's surface in the world, and every point of b's surface farther than `lower` > 0 from it. Any point Z of b's
///   frame with |R_b Z + q_b - x| < lower (verified in interval arithmetic) is inside b's solid if and only if x is, for the way from one
///   to the other meets no surface; and whether Z is inside is decided by exact predicates (solids/point_in_solid.hpp).
/// A solid is what its shells together wind round, so that a cavity (a shell turned inwards) is not material. Loose edges and points bound
/// nothing, but may lie inside.
///
/// What is not closed has no inside, yet it may have been meant to have one: a part that lies in it is not reported as clear of it. Whether
/// that can be excluded is decided here, for every command: nothing of the other body is within the mesh with its openings closed
/// (solids/closure.hpp) where the time begins, and nothing of it ever meets a lid, so that nothing comes in. The lids are out of reach
/// where `lower` is more than any point of them is from the surface; else lid_distance.hpp looks along the path. Where bodies may be a
/// little off the path (PairStart::charge), surfaces and lids have to stay apart by more than that: so they do on the way from one to the
/// other, and what is outside of the path's bodies is outside of theirs. A body that its scene declares a shell, wires or points
/// (model::is_sheet) is meant to have no inside.
#pragma once

#include <optional>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/certificate/lid_distance.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/geometry/mesh.hpp"
#include "core/model/model.hpp"
#include "core/solids/closure.hpp"

namespace fettle::core::certificate {

/// A mesh that may be inside another one, or have another one inside it.
struct SolidMesh {
    struct Shell {
        std::vector<geometry::Triangle> triangles;
        Vector3 low = Vector3::Zero(), high = Vector3::Zero();  ///< box
    };
    struct Lids {
        geometry::Mesh mesh;
        geometry::BodyHierarchy hierarchy;
    };
    const geometry::Mesh* mesh = nullptr;  ///< must stay where it is
    bool is_closed = false;                ///< solids::bounds_a_solid, or no triangles: then nothing can be inside
    std::vector<Shell> shells;
    std::vector<int> samples;                            ///< one vertex of everything that hangs together
    std::optional<solids::Closure> closure;              ///< of an open mesh that may be meant as a solid
    std::optional<Lids> lids;                            ///< the closure's
    const geometry::BodyHierarchy* hierarchy = nullptr;  ///< of the mesh, if it is at hand; must stay where it is
};
/// Contract: connectivity built. @param is_sheet  It is meant to have no inside, unless it is closed.
SolidMesh solid_mesh(const geometry::Mesh& mesh, bool is_sheet = false);
SolidMesh solid_of(const model::Body& body);

/// Is the point, in the body's frame, in the material? Exact; false on the surface. Contract: closed.
bool is_in_material(const Vector3& point, const SolidMesh& solid);

/// Where the time begins during which two bodies are looked at: as in body_path().
struct PairStart {
    const stepper::Trajectory& trajectory;
    int step = -1, segment = 0;
    int a = 0, b = 0;
    /// All of the time, from `step`, `segment` on, for bodies that are not closed; empty: it is not a path along which they can be
    /// followed.
    std::vector<Place> path{};
    /// How far the two may be from that path, together: it is decided for wherever they are within that [m]
    double charge = 0;
};
/// Is `path` of use for the two?
inline bool ask_for_path(const SolidMesh& a, const SolidMesh& b) { return a.closure.has_value() || b.closure.has_value(); }

/// The finding about the pair over all time during which its surfaces are proven to be farther apart than `lower` [m]; decided at `start`.
/// `not_closed` or `unverified` where one is not closed; `unproven` if lower is 0 or within rounding, or if it is no more than the charge
/// (and of the path itself neither is inside the other).
Solids solids_of(const SolidMesh& a, const SolidMesh& b, const PairStart& start, double lower);

}  // namespace fettle::core::certificate
