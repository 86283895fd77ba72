// SPDX-License-Identifier: MIT
#include "core/features/resize.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/contract.hpp"
#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/geometry/body_hierarchy.hpp"
#include "core/solids/self_intersection.hpp"

namespace fettle::core::features {

namespace {

using base::Error;
using base::ErrorCode;

std::string place_text(const Vector3& x) { return base::formatted("(%.6g, %.6g, %.6g) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z()); }

Vector3 scaled_from(const Surface& surface, double factor, const Vector3& x) {
    const Vector3 from = x - surface.point;
    const Vector3 away = surface.kind == SurfaceKind::sphere ? from : Vector3(from - surface.axis.dot(from) * surface.axis);
    return x + (factor - 1) * away;
}

Vector3 area_of(const Matrix3X& x, const geometry::Triangle& t) {
    const Vector3 from = x.col(t[0]);
    return 0.5 * (x.col(t[1]) - from).cross(x.col(t[2]) - from);
}

class Resizing {
public:
    Resizing(const geometry::Mesh& mesh, const Features& features) : mesh_(mesh), features_(features), x_(mesh.vertices) {
        feature_of_.assign(mesh.triangles.size(), -1);
        for (int f = 0; f < count_of(features.features); ++f)
            for (const int t : features.features[f].triangles) feature_of_[t] = f;
        moved_by_.assign(static_cast<std::size_t>(mesh.vertices.cols()), -1);
    }

    void move(const Resize& change) {
        const Feature& feature = features_.features[change.feature];
        const double radius = feature.is_hole ? feature.facets_least : feature.facets_largest, factor = (radius + change.by) / radius;
        FETTLE_ASSERT(radius > 0 && factor > 0, "a round feature with a radius keeps one");
        for (const int t : feature.triangles)
            for (const int v : mesh_.triangles[t]) {
                if (moved_by_[v] == change.feature) continue;
                if (moved_by_[v] >= 0) {
                    error_ = Error{ErrorCode::inconsistent, feature.name,
                                   "it meets " + features_.features[moved_by_[v]].name + " near " + place_text(mesh_.vertices.col(v)) +
                                       ", which is to change too: corners of both cannot follow both"};
                    return;
                }
                moved_by_[v] = change.feature;
                x_.col(v) = scaled_from(feature.surface, factor, mesh_.vertices.col(v));
            }
        for (int f = 0; f < count_of(features_.features); ++f)
            if (goes_along(change.feature, f)) take_along(f, change.feature, (factor - 1) * feature.facets_largest);
    }

    base::Result<geometry::Mesh> result() {
        for (std::size_t t = 0; t < mesh_.triangles.size() && !error_; ++t) check(static_cast<int>(t));
        if (error_) return *error_;
        geometry::Mesh out = mesh_;
        out.vertices = std::move(x_);
        for (const auto& [a, b] : solids::self_intersections(out, 1)) {
            const int by = mover_of(out.triangles[a]) >= 0 ? mover_of(out.triangles[a]) : mover_of(out.triangles[b]);
            return Error{ErrorCode::mesh_invalid, by < 0 ? out.name : features_.features[by].name,
                         "the wall would be cut through near " + place_text(out.vertices.col(out.triangles[a][0])) +
                             name_after(", by ", feature_of_[b])};
        }
        return out;
    }

private:
    bool are_coaxial(const Feature& a, const Feature& b) const {
        return std::find(a.coaxial.begin(), a.coaxial.end(), b.name) != a.coaxial.end();
    }

    // A chamfer of a bore or a pin, which ends at flat faces.
    bool goes_along(int moving, int f) const {
        const Feature &feature = features_.features[moving], &chamfer = features_.features[f];
        if (chamfer.surface.kind != SurfaceKind::cone || chamfer.is_hole != feature.is_hole || !are_coaxial(feature, chamfer)) return false;
        std::vector<char> of_chamfer(moved_by_.size(), 0);
        bool meets = false;
        for (const int t : chamfer.triangles)
            for (const int v : mesh_.triangles[t]) {
                of_chamfer[v] = 1;
                meets = meets || moved_by_[v] == moving;
            }
        if (!meets) return false;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const int other = feature_of_[t];
            if (other == moving || other == f || (other >= 0 && features_.features[other].surface.kind == SurfaceKind::plane)) continue;
            for (const int v : mesh_.triangles[t])
                if (of_chamfer[v] != 0) return false;
        }
        return true;
    }

    void take_along(int f, int moving, double by) {
        const Surface& surface = features_.features[moving].surface;
        for (const int t : features_.features[f].triangles)
            for (const int v : mesh_.triangles[t]) {
                if (moved_by_[v] >= 0) continue;
                moved_by_[v] = moving;
                const Vector3 from = mesh_.vertices.col(v) - surface.point, away = from - surface.axis.dot(from) * surface.axis;
                if (away.norm() > 0) x_.col(v) += by * away.normalized();
            }
    }

    // The feature that moves a corner of the triangle; -1: none does.
    int mover_of(const geometry::Triangle& t) const {
        for (const int v : t)
            if (moved_by_[v] >= 0) return moved_by_[v];
        return -1;
    }

    std::string name_after(const char* before, int feature) const {
        return feature < 0 ? std::string() : before + features_.features[feature].name;
    }

    void check(int t) {
        const geometry::Triangle& corners = mesh_.triangles[t];
        const int mover = mover_of(corners);
        if (mover < 0) return;
        const Feature& moving = features_.features[mover];
        const Vector3 before = area_of(mesh_.vertices, corners), after = area_of(x_, corners);
        if (!(before.dot(after) > 0)) {
            error_ = Error{ErrorCode::mesh_invalid, moving.name,
                           "a triangle" + name_after(" of ", feature_of_[t]) + " near " + place_text(x_.col(corners[0])) +
                               " would turn over: there is too little room round it"};
            return;
        }
        if (feature_of_[t] == mover) return;
        if (feature_of_[t] >= 0 && are_coaxial(moving, features_.features[feature_of_[t]])) {
            const double leant = before.dot(moving.surface.axis) / before.norm(), leans = after.dot(moving.surface.axis) / after.norm();
            if (leant * leans < 0 && std::abs(leant) > 1e-6)
                error_ =
                    Error{ErrorCode::inconsistent, moving.name,
                          name_after("", feature_of_[t]) + " beside it would lean the other way near " + place_text(x_.col(corners[0]))};
            return;
        }
        for (const int v : corners)
            if (moved_by_[v] >= 0) check_corner(t, v, features_.features[moved_by_[v]]);
    }

    // Does the face that the triangle is of stay what it is?
    void check_corner(int t, int v, const Feature& moving) {
        const double by = (x_.col(v) - mesh_.vertices.col(v)).norm();
        if (feature_of_[t] < 0) {
            if (by > features_.tolerance)
                error_ =
                    Error{ErrorCode::inconsistent, moving.name,
                          "it goes over into a face that is no surface near " + place_text(mesh_.vertices.col(v)) + ", which would bend"};
            return;
        }
        const Feature& face = features_.features[feature_of_[t]];
        const double off = std::abs(signed_distance(face.surface, x_.col(v)) - signed_distance(face.surface, mesh_.vertices.col(v)));
        if (off > features_.tolerance + face.residual)
            error_ = Error{ErrorCode::inconsistent, moving.name,
                           "it meets " + face.name + " near " + place_text(mesh_.vertices.col(v)) + ", which would bend"};
    }

    const geometry::Mesh& mesh_;
    const Features& features_;
    Matrix3X x_;
    std::vector<int> feature_of_;  // by triangle
    std::vector<int> moved_by_;    // by vertex: a feature
    std::optional<Error> error_;
};

// From `from` along `way`: the length to the triangle's plane within it; infinity: it is missed.
double hit(const Matrix3X& x, const geometry::Triangle& t, const Vector3& from, const Vector3& way) {
    const Vector3 a = x.col(t[0]), u = x.col(t[1]) - a, v = x.col(t[2]) - a, p = way.cross(v);
    const double determinant = u.dot(p);
    if (std::abs(determinant) < 1e-300) return infinity;
    const Vector3 s = from - a;
    const double b = s.dot(p) / determinant;
    const Vector3 q = s.cross(u);
    const double c = way.dot(q) / determinant;
    if (b < 0 || c < 0 || b + c > 1) return infinity;
    const double length = v.dot(q) / determinant;
    return length > 0 ? length : infinity;
}

// Rays against all triangles of a mesh but some.
class Rays {
public:
    Rays(const geometry::Mesh& mesh, const std::vector<int>& left_out)
        : mesh_(mesh), hierarchy_(mesh), is_left_out_(mesh.triangles.size(), 0) {
        for (const int t : left_out) is_left_out_[t] = 1;
    }

    // How far the nearest one is, if that is less than `within`; infinity: none is.
    double first_hit(const Vector3& from, const Vector3& way, double within) const {
        double least = infinity;
        std::vector<int> open{0};
        while (!open.empty()) {
            const geometry::HierarchyNode& node = hierarchy_.nodes()[open.back()];
            open.pop_back();
            if (!may_hit(node, from, way, std::min(least, within))) continue;
            if (!node.is_leaf()) {
                open.push_back(node.left);
                open.push_back(node.right);
                continue;
            }
            for (int e = node.first; e < node.first + node.count; ++e) {
                const int t = hierarchy_.elements()[e].triangle;
                if (t >= 0 && is_left_out_[t] == 0) least = std::min(least, hit(mesh_.vertices, mesh_.triangles[t], from, way));
            }
        }
        return least < within ? least : infinity;
    }

private:
    static bool may_hit(const geometry::HierarchyNode& node, const Vector3& from, const Vector3& way, double within) {
        double enter = 0, leave = within;
        for (int k = 0; k < 3; ++k) {
            const double low = node.center[k] - node.half_extent[k] - from[k], high = node.center[k] + node.half_extent[k] - from[k];
            if (way[k] == 0) {
                if (low > 0 || high < 0) return false;
                continue;
            }
            const auto [first, last] = std::minmax({low / way[k], high / way[k]});
            enter = std::max(enter, first);
            leave = std::min(leave, last);
        }
        return enter <= leave * (1 + 1e-12);
    }

    const geometry::Mesh& mesh_;
    const geometry::BodyHierarchy hierarchy_;
    std::vector<char> is_left_out_;
};

}  // namespace

base::Result<geometry::Mesh> resized(const geometry::Mesh& mesh, const Features& features, const std::vector<Resize>& changes) {
    Resizing work(mesh, features);
    for (const Resize& change : changes) work.move(change);
    return work.result();
}

std::optional<Wall> wall_behind(const geometry::Mesh& mesh, const Feature& feature) {
    const Rays rays(mesh, feature.triangles);
    std::optional<Wall> least;
    for (const int t : feature.triangles) {
        const auto& corners = mesh.triangles[t];
        const Vector3 inwards = -area_of(mesh.vertices, corners).normalized();
        const Vector3 middle = (mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) + mesh.vertices.col(corners[2])) / 3;
        for (std::size_t k = 0; k < 4; ++k) {
            // A little within the facet, so that no ray runs along a neighbour.
            const Vector3 from = k == 3 ? middle : Vector3(middle + 0.98 * (mesh.vertices.col(corners[k]) - middle));
            const double length = rays.first_hit(from, inwards, least ? least->thickness : infinity);
            if (length < infinity && (!least || length < least->thickness)) least = Wall{length, from};
        }
    }
    return least;
}

}  // namespace fettle::core::features
