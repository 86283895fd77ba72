// SPDX-License-Identifier: MIT
#include "core/features/handle.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "core/base/text.hpp"

namespace fettle::core::features {

namespace {

using base::Error;
using base::ErrorCode;

std::string names_of(const Features& features, const std::function<bool(const Feature&)>& is_meant) {
    std::vector<std::string> names;
    for (const Feature& feature : features.features)
        if (is_meant(feature)) names.push_back(feature.name);
    return names.empty() ? "none" : base::joined(names);
}

bool is_round(const Feature& feature) {
    return feature.surface.kind == SurfaceKind::cylinder || feature.surface.kind == SurfaceKind::sphere;
}

bool is_flat(const Feature& feature) { return feature.surface.kind == SurfaceKind::plane; }

bool is_coaxial(const Feature& a, const Feature& b) { return std::find(a.coaxial.begin(), a.coaxial.end(), b.name) != a.coaxial.end(); }

class Making {
public:
    Making(const Handle& handle, const geometry::Mesh& mesh, const Features& features)
        : handle_(handle), mesh_(mesh), features_(features), feature_of_(features.by_triangle(mesh.triangles.size())) {
        out_.kind = handle.kind;
        out_.axis = handle.axis;
        out_.point = handle.point;
        out_.has_band = handle.features.empty() && handle.region.falloff > 0;
    }

    base::Result<Displacement> run() {
        find_features();
        if (error_) return *error_;
        switch (handle_.kind) {
            case HandleKind::radius:
            case HandleKind::diameter:
                scale();
                break;
            case HandleKind::offset:
                offset();
                break;
            case HandleKind::move:
            case HandleKind::turn:
                hold();
                break;
            case HandleKind::stretch:
                stretch();
                break;
            case HandleKind::lattice:
                bend();
                break;
            case HandleKind::morph:
                morph();
                break;
        }
        if (error_) return *error_;
        if (out_.vertices.empty() && by_.empty() && weights_.empty())
            return Error{ErrorCode::inconsistent, handle_.name, "it moves nothing: no corner of the mesh lies where it takes hold"};
        for (const auto& [v, by] : by_) {
            out_.vertices.push_back(v);
            out_.by.push_back(by);
        }
        for (const auto& [v, weight] : weights_) {
            out_.vertices.push_back(v);
            out_.weights.push_back(weight);
        }
        return std::move(out_);
    }

private:
    void fail(ErrorCode code, const std::string& message) {
        if (!error_) error_ = Error{code, handle_.name, message};
    }

    bool may_be(const Feature& feature) const {
        if (handle_.holes && feature.is_hole != *handle_.holes) return false;
        if (handle_.kind == HandleKind::offset) return is_flat(feature);
        return handle_.kind == HandleKind::move || handle_.kind == HandleKind::turn || is_round(feature);
    }

    void find_features() {
        for (const std::string& name : handle_.features) {
            const int found = features_.find(name);
            const auto meant = [this](const Feature& feature) { return may_be(feature); };
            const std::string known = names_of(features_, meant);
            if (found < 0) return fail(ErrorCode::out_of_range, "the mesh has no feature `" + name + "`; of that kind it has: " + known);
            if (!may_be(features_.features[found]))
                return fail(ErrorCode::inconsistent, "`" + name + "` is of another kind; of that kind the mesh has: " + known);
            out_.features.push_back(found);
        }
    }

    template <class Use>
    void for_corners(int feature, const Use& use) const {
        for (const int t : features_.features[feature].triangles)
            for (const int v : mesh_.triangles[t]) use(v);
    }

    // d x / d radius: away from the axis in proportion, x + (r / r0 - 1) away.
    void scale() {
        const double first = features_.features[out_.features.front()].surface.radius;
        const double per_value = handle_.kind == HandleKind::diameter ? 0.5 : 1;
        out_.drawn = first / per_value;
        for (const int f : out_.features) {
            const Feature& feature = features_.features[f];
            const Surface& surface = feature.surface;
            if (std::abs(surface.radius - first) > 2 * features_.tolerance + feature.residual)
                return fail(ErrorCode::inconsistent,
                            base::formatted("`%s` has a radius of %.9g mm, `%s` one of %.9g mm: a handle is of one radius",
                                            features_.features[out_.features.front()].name.c_str(), 1e3 * first, feature.name.c_str(),
                                            1e3 * surface.radius));
            for_corners(f, [&](int v) {
                const Vector3 from = mesh_.vertices.col(v) - surface.point;
                const Vector3 away = surface.kind == SurfaceKind::sphere ? from : Vector3(from - surface.axis.dot(from) * surface.axis);
                by_[v] = per_value / surface.radius * away;
            });
            for (const int chamfer : chamfers_of(f))
                for_corners(chamfer, [&](int v) {
                    const Vector3 from = mesh_.vertices.col(v) - surface.point, away = from - surface.axis.dot(from) * surface.axis;
                    if (away.norm() > 0) by_.try_emplace(v, per_value * feature.facets_largest / surface.radius * away.normalized());
                });
        }
    }

    std::vector<char> corners_of(int feature) const {
        std::vector<char> out(static_cast<std::size_t>(mesh_.vertices.cols()), 0);
        for_corners(feature, [&](int v) { out[v] = 1; });
        return out;
    }

    // Cones on a bore's or a pin's axis that meet it and else flat faces alone: they go along with it.
    std::vector<int> chamfers_of(int moving) const {
        std::vector<int> out;
        const Feature& feature = features_.features[moving];
        const std::vector<char> of_feature = corners_of(moving);
        for (int f = 0; f < count_of(features_.features); ++f) {
            const Feature& cone = features_.features[f];
            if (cone.surface.kind != SurfaceKind::cone || cone.is_hole != feature.is_hole || !is_coaxial(feature, cone)) continue;
            const std::vector<char> of_cone = corners_of(f);
            bool meets = false;
            for (std::size_t v = 0; v < of_cone.size(); ++v) meets = meets || (of_cone[v] != 0 && of_feature[v] != 0);
            if (meets && meets_flat_faces_alone(of_cone, moving, f)) out.push_back(f);
        }
        return out;
    }

    bool meets_flat_faces_alone(const std::vector<char>& corners, int moving, int own) const {
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const int other = feature_of_[t];
            if (other == moving || other == own || (other >= 0 && is_flat(features_.features[other]))) continue;
            for (const int v : mesh_.triangles[t])
                if (corners[v] != 0) return false;
        }
        return true;
    }

    // A corner of the face moves so that it stays in the other flat faces that it is of: along their edge.
    void offset() {
        for (const int f : out_.features) {
            std::map<int, std::vector<Vector3>> normals;  // [corner] of the other faces
            for_corners(f, [&](int v) { normals[v] = {}; });
            for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
                if (feature_of_[t] < 0 || feature_of_[t] == f) continue;
                for (const int v : mesh_.triangles[t])
                    if (const auto mine = normals.find(v); mine != normals.end())
                        mine->second.push_back(normal_at(features_.features[feature_of_[t]].surface, mesh_.vertices.col(v)));
            }
            for (const auto& [v, beside] : normals)
                by_.try_emplace(v, Vector3::Zero()).first->second += along_edge(features_.features[f].surface.axis, beside);
        }
    }

    // The shortest step d with outwards . d = 1 that keeps to all of `beside`, in the sense of least squares.
    static Vector3 along_edge(const Vector3& outwards, const std::vector<Vector3>& beside) {
        Matrix3 across = Matrix3::Identity();  // projects onto what all of them have in common
        for (const Vector3& normal : beside) {
            const Vector3 left = across * normal;
            if (left.norm() < 1e-6) continue;
            across -= left.normalized() * left.normalized().transpose();
        }
        const Vector3 way = across * outwards;
        const double reached = outwards.dot(way);
        return reached > 1e-6 ? Vector3(way / reached) : outwards;
    }

    void hold() {
        std::map<int, double> held;
        for (const int f : out_.features) for_corners(f, [&](int v) { held[v] = 1; });
        for (int v = 0; v < mesh_.vertices.cols() && out_.features.empty(); ++v)
            if (const double weight = handle_.region.weight(mesh_.vertices.col(v)); weight > 0) held[v] = weight;
        for (const auto& [v, weight] : held) {
            if (handle_.kind == HandleKind::turn)
                weights_[v] = weight;
            else
                by_[v] = weight * handle_.axis;
        }
    }

    void stretch() {
        for (int v = 0; v < mesh_.vertices.cols(); ++v) {
            const double share = (handle_.axis.dot(mesh_.vertices.col(v)) - handle_.from) / (handle_.to - handle_.from);
            if (share > 0) by_[v] = std::min(share, 1.0) * handle_.axis;
        }
    }

    static double bernstein(int count, int i, double s) {
        double out = 1;
        const int n = count - 1;
        for (int k = 1; k <= i; ++k) out *= static_cast<double>(n - i + k) / k * s;
        for (int k = 0; k < n - i; ++k) out *= 1 - s;
        return out;
    }

    void bend() {
        const Vector3 size = handle_.region.high - handle_.region.low;
        for (int v = 0; v < mesh_.vertices.cols(); ++v) {
            const Vector3 at = (mesh_.vertices.col(v) - handle_.region.low).cwiseQuotient(size);
            if (at.minCoeff() < 0 || at.maxCoeff() > 1) continue;
            double sum = 0;
            for (const auto& control : handle_.controls) {
                double weight = 1;
                for (std::size_t k = 0; k < 3; ++k) weight *= bernstein(handle_.lattice[k], control[k], at[static_cast<Eigen::Index>(k)]);
                sum += weight;
            }
            if (sum > 0) by_[v] = sum * handle_.axis;
        }
    }

    void morph() {
        if (handle_.target.cols() != mesh_.vertices.cols())
            return fail(ErrorCode::inconsistent,
                        "the other mesh has " + base::counted(static_cast<std::size_t>(handle_.target.cols()), "corner") + ", this one " +
                            std::to_string(mesh_.vertices.cols()) + ": both must have the same triangles, in the same order");
        for (int v = 0; v < mesh_.vertices.cols(); ++v) {
            const Vector3 by = handle_.target.col(v) - mesh_.vertices.col(v);
            if (by != Vector3::Zero()) by_[v] = by;
        }
    }

    const Handle& handle_;
    const geometry::Mesh& mesh_;
    const Features& features_;
    const std::vector<int> feature_of_;  // [triangle]
    Displacement out_;
    std::map<int, Vector3> by_;
    std::map<int, double> weights_;
    std::optional<Error> error_;
};

}  // namespace

double HandleRegion::weight(const Vector3& x) const {
    const double off = kind == Kind::sphere ? (x - centre).norm() - radius : (low - x).cwiseMax(x - high).cwiseMax(0.0).norm();
    if (off <= 0) return 1;
    if (off >= falloff) return 0;
    const double s = 1 - off / falloff;
    return s * s * (3 - 2 * s);
}

Vector3 Displacement::slope(std::size_t k, const Vector3& x, double change) const {
    if (kind != HandleKind::turn) return by[k];
    const Vector3 from = x - point, across = from - axis.dot(from) * axis, ahead = axis.cross(from);
    const double angle = change * weights[k];
    return weights[k] * (std::cos(angle) * ahead - std::sin(angle) * across);
}

base::Result<Displacement> displacement_of(const Handle& handle, const geometry::Mesh& mesh, const Features& features) {
    return Making(handle, mesh, features).run();
}

}  // namespace fettle::core::features
