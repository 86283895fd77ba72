// SPDX-License-Identifier: MIT
#include "core/model/joint_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/limits.hpp"
#include "core/model/body_geometry.hpp"

namespace fettle::core::model {
namespace {

using parts::CommonPart;
using parts::CutTriangle;
using scene::JointKind;
using Corners = std::array<Vector3, 3>;

constexpr double same_radius = 1e-3;  // share of it: files have so many digits
constexpr double thickest = 0.15;     // a shell, as a share of its radius: facets of a hexagon reach 0.134
constexpr double widest_facet = 1;    // as its chord over the radius: facets of a hexagon
constexpr double flat_sine = 1e-6;    // sine of an angle
constexpr double touch_share = 1e-5;  // of the bodies' size: faces that lie on each other (clearance/touching.hpp)

Corners parent_of(const CutTriangle& t, const geometry::Mesh& a, const geometry::Mesh& b) {
    const geometry::Mesh& mesh = t.of_a ? a : b;
    Corners out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = mesh.vertices.col(mesh.triangles[t.triangle][k]);
    return out;
}

// A line, with distances from it and along it.
struct Axis {
    Vector3 point, along;
    double height(const Vector3& x) const { return along.dot(x - point); }
    Vector3 across(const Vector3& x) const { return x - point - height(x) * along; }
    double radius(const Vector3& x) const { return across(x).norm(); }

    // A chord of one circle about it?
    bool is_chord(const Vector3& x, const Vector3& y) const {
        const double r = radius(x);
        return r > 0 && std::abs(radius(y) - r) <= same_radius * r && (across(x) - across(y)).norm() <= widest_facet * (1 + flat_sine) * r;
    }
    bool is_flat_across(const Corners& c) const {
        const Vector3 n = (c[1] - c[0]).cross(c[2] - c[0]);
        return n.cross(along).norm() <= flat_sine * n.norm();
    }
    // Is the facet one of a surface of revolution: of a cylinder, or with a side on a ring?
    bool is_revolved(const Corners& c) const {
        bool all = true, ring = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 &x = c[k], &y = c[(k + 1) % 3];
            const bool chord = is_chord(x, y);
            all = all && chord;
            ring = ring || (chord && std::abs(height(x) - height(y)) <= same_radius * radius(x));
        }
        return all || ring;
    }
    bool is_round(const Corners& c) const { return is_flat_across(c) || is_revolved(c); }
};

// Is it a shell round a bore, longer along the axis than thick across it?
bool is_pin(const CommonPart& piece, const Axis& axis) {
    double low = infinity, high = -infinity, outer = 0, inner = infinity;
    bool is_hollow = false;
    for (const CutTriangle& t : piece.triangles) {
        const Vector3 area = piece.area_of(t);
        const bool faces_axis = area.dot(axis.across(piece.corner(t, 0))) < -flat_sine * area.norm() * axis.radius(piece.corner(t, 0));
        is_hollow = is_hollow || faces_axis;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3 x = piece.corner(t, k);
            low = std::min(low, axis.height(x));
            high = std::max(high, axis.height(x));
            outer = std::max(outer, axis.radius(x));
            if (faces_axis) inner = std::min(inner, axis.radius(x));
        }
    }
    return is_hollow && outer - inner < std::min(high - low, thickest * outer);
}

bool explains_about_axis(const Axis& axis, const CommonPart& piece, const geometry::Mesh& a, const geometry::Mesh& b) {
    const auto is_round = [&](const CutTriangle& t) { return axis.is_round(parent_of(t, a, b)); };
    return std::all_of(piece.triangles.begin(), piece.triangles.end(), is_round) && is_pin(piece, axis);
}

bool is_on_sphere(const Corners& c, const Vector3& centre) {
    const double r = (c[0] - centre).norm();
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs((c[k] - centre).norm() - r) > same_radius * r || (c[k] - c[(k + 1) % 3]).norm() > widest_facet * (1 + flat_sine) * r)
            return false;
    return r > 0;
}

// A ball that is sunk in the other's material is no ball in its socket: what both have must be a shell between two spheres.
bool explains_about_point(const Vector3& centre, const CommonPart& piece, const geometry::Mesh& a, const geometry::Mesh& b) {
    double on_sphere = 0, all = 0, inner = infinity, outer = 0;
    Vector3 rest = Vector3::Zero();  // the area of a mouth or neck, which is along its axis
    std::vector<Corners> others;
    for (const CutTriangle& t : piece.triangles) {
        const Corners corners = parent_of(t, a, b);
        const Vector3 area = piece.area_of(t);
        const Vector3 from_centre = piece.corner(t, 0) - centre;
        const bool faces_centre = area.dot(from_centre) < -flat_sine * area.norm() * from_centre.norm();
        all += area.norm();
        if (is_on_sphere(corners, centre)) {
            on_sphere += area.norm();
            for (std::size_t k = 0; k < 3; ++k) {
                const double r = (piece.corner(t, k) - centre).norm();
                if (faces_centre) inner = std::min(inner, r);
                outer = std::max(outer, r);
            }
            continue;
        }
        rest += area;
        others.push_back(corners);
    }
    if (!(on_sphere > 0.5 * all) || !(inner < infinity) || !(outer - inner < thickest * outer)) return false;
    const Axis axis{centre, rest.norm() > 0 ? Vector3(rest.normalized()) : Vector3(Vector3::UnitZ())};
    return std::all_of(others.begin(), others.end(), [&](const Corners& c) { return axis.is_round(c); });
}

double size_of(const geometry::Mesh& mesh) { return geometry::box_sides(mesh.vertices).norm(); }

template <class Visit>
void for_joints_between(const Model& model, int a, int b, const Visit& visit) {
    for (const Joint& joint : model.mechanism.joints)
        if (!joint.is_motor && joint.frame_a >= 0 && std::minmax(joint.a, joint.b) == std::minmax(a, b)) visit(joint);
}

}  // namespace

bool explains(JointKind kind, const measure::PlacedFrame& joint, const CommonPart& common, const geometry::Mesh& a,
              const geometry::Mesh& b) {
    if (kind == JointKind::ball) return explains_about_point(joint.point, common, a, b);
    const bool has_axis =
        kind == JointKind::revolute || kind == JointKind::prismatic || kind == JointKind::cylindrical || kind == JointKind::screw;
    return has_axis && explains_about_axis({joint.point, joint.axes.col(2)}, common, a, b);
}

std::vector<std::string> joints_between(const Model& model, int a, int b) {
    std::vector<std::string> names;
    for_joints_between(model, a, b, [&](const Joint& joint) { names.push_back(joint.name); });
    return names;
}

base::Result<JoinedOverlap> joined_overlap(const Model& model, int a, int b) {
    const geometry::Mesh mesh_a = mesh_at_start(model.bodies[a]), mesh_b = mesh_at_start(model.bodies[b]);
    const base::Result<CommonPart> common = parts::common_part(mesh_a, mesh_b);
    if (!common) return common.errors();
    std::vector<kinematics::Pose> poses;
    for (const Body& body : model.bodies) poses.push_back(body.pose_start);
    const double touch = touch_share * std::max(size_of(mesh_a), size_of(mesh_b));
    JoinedOverlap out;
    for (const CommonPart& piece : pieces_of(*common)) {
        const double volume = piece.volume();
        if (!(volume > 0.5 * touch * piece.area())) continue;  // thinner than faces that lie on each other
        out.volume += volume;
        bool explained = false;
        for_joints_between(model, a, b, [&](const Joint& joint) {
            const measure::PlacedFrame frame = measure::placed(model.mechanism.set.frames[joint.frame_a], poses);
            explained = explained || explains(joint.kind, frame, piece, mesh_a, mesh_b);
        });
        out.explained = out.explained && explained;
    }
    return out;
}

}  // namespace fettle::core::model
