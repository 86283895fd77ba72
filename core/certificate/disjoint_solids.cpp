// SPDX-License-Identifier: MIT
#include "core/certificate/disjoint_solids.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "core/base/limits.hpp"
#include "core/solids/point_in_solid.hpp"

namespace fettle::core::certificate {
namespace {

enum class Side { outside, inside, unknown };

constexpr double above_rounding = 1 + 1e-12;  // of sums of lengths, far above their rounding

// Both bodies where their paths begin, as seen from the place of one of them.
struct Start {
    IntervalMatrix inner, outer;
    Interval3 offset;  // q_inner - q_outer
};

Side side_of(const Vector3& x, const Start& at, const SolidMesh& outer, double lower) {
    const Interval3 world = times(at.inner, exactly(x)) + at.offset;
    const Vector3 near = middle(at.outer).inverse() * middle(world);
    if (!near.allFinite() || !(near.cwiseAbs().maxCoeff() < largest_magnitude)) return Side::unknown;
    if (!(norm_bound(times(at.outer, exactly(near)) - world) < lower)) return Side::unknown;
    const bool inside = outer.closure ? solids::is_within(near, *outer.closure) : is_in_material(near, outer);
    return inside ? Side::inside : Side::outside;
}

// One part inside is enough; else one that is not known. `outer` is a closed mesh.
Side any_inside(const SolidMesh& inner, const SolidMesh& outer, const Start& at, double lower) {
    Side found = Side::outside;
    for (const int v : inner.samples) {
        const Side side = side_of(inner.mesh->vertices.col(v), at, outer, lower);
        if (side == Side::inside) return side;
        if (side == Side::unknown) found = side;
    }
    return found;
}

bool is_usable(const BodyPath& path) { return path.magnitude < largest_magnitude; }  // false for what is not a number, too

// Is it excluded that a part of `inner` lies in what `outer` would be if it were closed, now or later?
bool stays_outside(const SolidMesh& inner, const SolidMesh& outer, const Start& at, const PairStart& start, bool is_a_outer, double lower) {
    const solids::Closure& closure = *outer.closure;
    // As far as a place may be off that is looked at in the other's frame: much less than the lids are away.
    const double size = closure.vertices.cwiseAbs().maxCoeff() + inner.mesh->vertices.cwiseAbs().maxCoeff();
    const double room = std::min(0.5 * lower, 1e-9 * size);
    const auto is_outside = [&](int v) { return side_of(inner.mesh->vertices.col(v), at, outer, room) == Side::outside; };
    if (!std::all_of(inner.samples.begin(), inner.samples.end(), is_outside)) return false;
    const double away = above_rounding * (room + start.charge);  // of the lids
    if (lower > above_rounding * (closure.reach + away)) return true;
    const int body = is_a_outer ? start.a : start.b, other = is_a_outer ? start.b : start.a;
    std::optional<geometry::BodyHierarchy> own;
    const LidSurface lids{outer.lids->mesh, outer.lids->hierarchy},
        surface{*inner.mesh, inner.hierarchy != nullptr ? *inner.hierarchy : own.emplace(*inner.mesh)};
    if (!inner.lids) return lids_stay_apart({start.trajectory, start.path, body, other}, lids, {&surface}, away);
    const LidSurface inner_lids{inner.lids->mesh, inner.lids->hierarchy};  // two lids must not meet either
    return lids_stay_apart({start.trajectory, start.path, body, other}, lids, {&surface, &inner_lids}, away);
}

}  // namespace

SolidMesh solid_of(const model::Body& body) {
    SolidMesh solid = solid_mesh(body.mesh, is_sheet(body));
    solid.hierarchy = body.hierarchy.get();
    return solid;
}

SolidMesh solid_mesh(const geometry::Mesh& mesh, bool is_sheet) {
    SolidMesh solid;
    solid.mesh = &mesh;
    solid.is_closed = mesh.triangles.empty() || solids::bounds_a_solid(mesh);
    if (!solid.is_closed && !is_sheet) solid.closure = solids::closure_of(mesh);
    if (solid.closure) {
        geometry::Mesh lids = solids::lids_of(*solid.closure);
        geometry::BodyHierarchy hierarchy(lids);
        solid.lids.emplace(SolidMesh::Lids{std::move(lids), std::move(hierarchy)});
    }
    solid.samples = solids::samples_of(mesh);
    solid.shells.resize(mesh.shell_names.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        SolidMesh::Shell& part = solid.shells[mesh.triangle_shell[t]];
        if (part.triangles.empty()) part.low = part.high = mesh.vertices.col(mesh.triangles[t][0]);
        part.triangles.push_back(mesh.triangles[t]);
        for (const int v : mesh.triangles[t]) {
            part.low = part.low.cwiseMin(mesh.vertices.col(v));
            part.high = part.high.cwiseMax(mesh.vertices.col(v));
        }
    }
    return solid;
}

bool is_in_material(const Vector3& point, const SolidMesh& solid) {
    int winding = 0;
    for (const SolidMesh::Shell& shell : solid.shells) {
        if ((point.array() < shell.low.array()).any() || (point.array() > shell.high.array()).any()) continue;
        const auto turns = solids::winding_number(point, solid.mesh->vertices, shell.triangles);
        if (!turns) return false;
        winding += *turns;
    }
    return winding != 0;
}

Solids solids_of(const SolidMesh& a, const SolidMesh& b, const PairStart& start, double lower) {
    if (!(lower > 0)) return Solids::unproven;
    const bool a_holds = a.is_closed && !a.shells.empty(), b_holds = b.is_closed && !b.shells.empty();
    if (a_holds || b_holds || ask_for_path(a, b)) {
        const BodyPath path_a = body_path(start.trajectory, start.step, start.segment, start.a),
                       path_b = body_path(start.trajectory, start.step, start.segment, start.b);
        if (!is_usable(path_a) || !is_usable(path_b)) return Solids::unproven;
        const Start at{pose_at(path_a, 0).rotation, pose_at(path_b, 0).rotation, path_a.place - path_b.place},
            back{at.outer, at.inner, path_b.place - path_a.place};
        const Side a_in_b = b_holds ? any_inside(a, b, at, lower) : Side::outside;
        const Side b_in_a = a_holds ? any_inside(b, a, back, lower) : Side::outside;
        if (a_in_b == Side::inside || b_in_a == Side::inside) return Solids::overlap;
        if (a_in_b == Side::unknown || b_in_a == Side::unknown) return Solids::unproven;
        if (!(lower > start.charge)) return Solids::unproven;
        if (b.closure && !stays_outside(a, b, at, start, false, lower)) return Solids::unverified;
        if (a.closure && !stays_outside(b, a, back, start, true, lower)) return Solids::unverified;
    }
    return a.is_closed && b.is_closed ? Solids::disjoint : Solids::not_closed;
}

}  // namespace fettle::core::certificate
