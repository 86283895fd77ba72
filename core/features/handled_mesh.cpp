// SPDX-License-Identifier: MIT
#include "core/features/handled_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <set>

#include "core/base/contract.hpp"
#include "core/base/text.hpp"
#include "core/features/wall.hpp"
#include "core/solids/self_intersection.hpp"

namespace fettle::core::features {

namespace {

using base::Error;
using base::ErrorCode;
using expression::Number;
using expression::Tape;

std::string place_text(const Vector3& x) { return base::formatted("(%.6g, %.6g, %.6g) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z()); }

Vector3 area_of(const Matrix3X& x, const geometry::Triangle& t) {
    const Vector3 from = x.col(t[0]);
    return 0.5 * (x.col(t[1]) - from).cross(x.col(t[2]) - from);
}

bool is_of_radius(HandleKind kind) { return kind == HandleKind::radius || kind == HandleKind::diameter; }

// Does it move features and nothing else, so that the faces beside these must stay where they are?
bool is_of_features(const Displacement& d) { return !d.features.empty(); }

// Is a bent surface what it is for?
bool is_free(HandleKind kind) { return kind == HandleKind::lattice || kind == HandleKind::morph; }

}  // namespace

/// What must hold of the mesh at other values.
class HandledMesh::Check {
public:
    Check(const HandledMesh& of, const std::vector<double>& values, const Matrix3X& x) : of_(of), mesh_(of.mesh_), x_(x) {
        for (std::size_t k = 0; k < values.size(); ++k) changes_.push_back(values[k] - of.displacements_[k].drawn);
        feature_of_ = of.features_.by_triangle(mesh_.triangles.size());
        movers_.resize(static_cast<std::size_t>(mesh_.vertices.cols()));
        for (std::size_t k = 0; k < changes_.size(); ++k)
            if (changes_[k] != 0)
                for (const int v : of.displacements_[k].vertices) movers_[v].push_back(static_cast<int>(k));
        for (const Feature& feature : features()) surfaces_.push_back(feature.surface);
        for (std::size_t k = 0; k < changes_.size(); ++k)
            if (changes_[k] != 0 && is_of_features(of.displacements_[k])) move_surfaces(static_cast<int>(k));
    }

    std::optional<Error> fault() {
        for (std::size_t t = 0; t < mesh_.triangles.size() && !error_; ++t) check_triangle(static_cast<int>(t));
        bool has_regions = false;
        for (std::size_t k = 0; k < changes_.size(); ++k)
            has_regions = has_regions || (changes_[k] != 0 && !is_of_features(of_.displacements_[k]));
        for (int f = 0; f < count_of(features()) && has_regions && !error_; ++f) check_shape(f);
        return error_;
    }

    /// The surface passes through itself at these triangles.
    Error crossing(int a, int b) const {
        const int by = mover_of(a) >= 0 ? mover_of(a) : mover_of(b);
        return {ErrorCode::mesh_invalid, by < 0 ? mesh_.name : called(by, a),
                "the wall would be cut through near " + place_text(x_.col(mesh_.triangles[a][0])) + name_after(", by ", feature_of_[b])};
    }

private:
    const std::vector<Feature>& features() const { return of_.features_.features; }

    void fail(ErrorCode code, const std::string& where, const std::string& message) {
        if (!error_) error_ = Error{code, where, message};
    }

    // Where the handle's own features are then.
    void move_surfaces(int k) {
        const Displacement& d = of_.displacements_[k];
        for (const int f : d.features) {
            Surface& surface = surfaces_[f];
            if (is_of_radius(d.kind))
                surface.radius += changes_[k] / (d.kind == HandleKind::diameter ? 2 : 1);
            else if (d.kind == HandleKind::offset)
                surface.point += changes_[k] * surface.axis;
            else
                surface = carried(surface, d, changes_[k]);
        }
    }

    static Surface carried(Surface surface, const Displacement& d, double change) {
        if (d.kind != HandleKind::turn) {
            surface.point += change * d.axis;
            return surface;
        }
        const Eigen::AngleAxisd turn(change, d.axis);
        surface.point = d.point + turn * (surface.point - d.point);
        surface.axis = turn * surface.axis;
        return surface;
    }

    // The first handle that moves a corner of the triangle; -1: none does.
    int mover_of(int t) const {
        for (const int v : mesh_.triangles[t])
            if (!movers_[v].empty()) return movers_[v].front();
        return -1;
    }

    // A feature that handle k moves at the triangle, or the handle's name.
    std::string called(int k, int t) const {
        const Displacement& d = of_.displacements_[k];
        for (const int f : d.features)
            for (const int own : features()[f].triangles)
                for (const int v : mesh_.triangles[own])
                    for (const int corner : mesh_.triangles[t])
                        if (v == corner) return features()[f].name;
        return d.features.empty() ? of_.names_[k] : features()[d.features.front()].name;
    }

    std::string name_after(const char* before, int feature) const {
        return feature < 0 ? std::string() : before + features()[feature].name;
    }

    // How far turns have turned the triangle, so that its normal can be compared.
    Vector3 turned(int t, Vector3 normal) const {
        for (std::size_t k = 0; k < changes_.size(); ++k) {
            const Displacement& d = of_.displacements_[k];
            if (d.kind != HandleKind::turn || changes_[k] == 0) continue;
            double weight = 0;
            for (const int v : mesh_.triangles[t]) {
                const auto at = std::lower_bound(d.vertices.begin(), d.vertices.end(), v);
                if (at != d.vertices.end() && *at == v) weight += d.weights[static_cast<std::size_t>(at - d.vertices.begin())] / 3;
            }
            normal = Eigen::AngleAxisd(weight * changes_[k], d.axis) * normal;
        }
        return normal;
    }

    void check_triangle(int t) {
        const geometry::Triangle& corners = mesh_.triangles[t];
        const int mover = mover_of(t);
        if (mover < 0) return;
        const Vector3 before = area_of(mesh_.vertices, corners), after = area_of(x_, corners);
        if (!(turned(t, before).dot(after) > 0))
            return fail(ErrorCode::mesh_invalid, called(mover, t),
                        "a triangle" + name_after(" of ", feature_of_[t]) + " near " + place_text(x_.col(corners[0])) +
                            " would turn over: there is too little room round it");
        for (const int v : corners) {
            int rounds = -1;
            for (const int k : movers_[v]) {
                if (!is_of_features(of_.displacements_[k])) continue;
                if (is_of_radius(of_.displacements_[k].kind)) {
                    if (rounds >= 0)
                        return fail(ErrorCode::inconsistent, called(rounds, t),
                                    "it meets " + called(k, t) + " near " + place_text(mesh_.vertices.col(v)) +
                                        ", which is to change too: corners of both cannot follow both");
                    rounds = k;
                }
                check_corner(t, v, k, before, after);
                if (error_) return;
            }
        }
    }

    bool is_coaxial(const Displacement& d, int f) const {
        return std::any_of(d.features.begin(), d.features.end(), [&](int own) {
            const auto& names = features()[own].coaxial;
            return is_of_radius(d.kind) && std::find(names.begin(), names.end(), features()[f].name) != names.end();
        });
    }

    // Does the face that the triangle is of stay what it is, where handle k moves its corner?
    void check_corner(int t, int v, int k, const Vector3& before, const Vector3& after) {
        const Displacement& d = of_.displacements_[k];
        const int face = feature_of_[t];
        if (face >= 0 && std::count(d.features.begin(), d.features.end(), face) > 0) return;
        if (face >= 0 && is_coaxial(d, face)) {
            const Vector3 axis = features()[d.features.front()].surface.axis;
            const double leant = before.dot(axis) / before.norm(), leans = after.dot(axis) / after.norm();
            if (leant * leans < 0 && std::abs(leant) > 1e-6)
                fail(ErrorCode::inconsistent, called(k, t),
                     features()[face].name + " beside it would lean the other way near " + place_text(x_.col(mesh_.triangles[t][0])));
            return;
        }
        if (face < 0) {
            if (way_of(k, v).norm() > of_.features_.tolerance)
                fail(ErrorCode::inconsistent, called(k, t),
                     "it goes over into a face that is no surface near " + place_text(mesh_.vertices.col(v)) + ", which would bend");
            return;
        }
        const Feature& feature = features()[face];
        const double off = std::abs(signed_distance(surfaces_[face], x_.col(v)) - signed_distance(feature.surface, mesh_.vertices.col(v)));
        if (off > of_.features_.tolerance + feature.residual && !is_moved_freely(v))
            fail(ErrorCode::inconsistent, called(k, t),
                 "it meets " + feature.name + " near " + place_text(mesh_.vertices.col(v)) + ", which would bend");
    }

    // How far handle k alone moves a corner.
    Vector3 way_of(int k, int v) const {
        const Displacement& d = of_.displacements_[k];
        const auto at = std::lower_bound(d.vertices.begin(), d.vertices.end(), v);
        if (at == d.vertices.end() || *at != v) return Vector3::Zero();
        const auto by = d.at(static_cast<std::size_t>(at - d.vertices.begin()), mesh_.vertices.col(v), changes_[k]);
        return {by[0], by[1], by[2]};
    }

    bool is_moved_freely(int v) const {
        return std::any_of(movers_[v].begin(), movers_[v].end(), [&](int k) { return !is_of_features(of_.displacements_[k]); });
    }

    // Does a feature in a stretch, a move or a turn of a region stay one, of the same size? What lies in a band may be bent if it is flat.
    void check_shape(int f) {
        const Feature& feature = features()[f];
        const bool is_flat = feature.surface.kind == SurfaceKind::plane;
        std::set<int> corners;
        for (const int t : feature.triangles) corners.insert(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
        int held = -1;
        std::size_t count = 0;
        for (const int v : corners)
            for (const int k : movers_[v]) {
                if (is_of_features(of_.displacements_[k])) continue;
                if (is_free(of_.displacements_[k].kind) || (is_flat && of_.displacements_[k].has_band)) return;
                held = k;
                ++count;
            }
        if (held < 0) return;
        Matrix3X before(3, count_of(corners)), after = before;
        Eigen::Index i = 0;
        for (const int v : corners) {
            before.col(i) = mesh_.vertices.col(v);
            after.col(i++) = x_.col(v);
        }
        // As a whole it is carried by the rigid motion that comes nearest.
        const Eigen::Matrix4d motion = Eigen::umeyama(before, after, false);
        Surface there = feature.surface;
        there.point = motion.topLeftCorner<3, 3>() * there.point + motion.topRightCorner<3, 1>();
        there.axis = motion.topLeftCorner<3, 3>() * there.axis;
        there.radius = surfaces_[f].radius;
        const double allowed = of_.features_.tolerance + feature.residual;
        double off = 0;  // corners where a face is cut lay within the arc of a facet before
        for (i = 0; i < before.cols(); ++i)
            off = std::max(off, std::abs(signed_distance(there, after.col(i)) - signed_distance(feature.surface, before.col(i))));
        if (off > allowed)
            fail(ErrorCode::inconsistent, of_.names_[held],
                 feature.name + " near " + place_text(feature.centre) + base::formatted(" would bend by %.3g mm", 1e3 * off) +
                     (count < corners.size() ? ": it lies partly where the handle takes hold" : ": it lies across the handle"));
    }

    const HandledMesh& of_;
    const geometry::Mesh& mesh_;
    const Matrix3X& x_;
    std::vector<double> changes_;           // [handle]
    std::vector<int> feature_of_;           // [triangle]
    std::vector<std::vector<int>> movers_;  // [corner] handles
    std::vector<Surface> surfaces_;         // [feature] as its own handles have it
    std::optional<Error> error_;
};

base::Result<HandledMesh> HandledMesh::create(geometry::Mesh mesh, const std::vector<Handle>& handles, double wall) {
    Features features = find_features(mesh);
    return create(std::move(mesh), std::move(features), handles, wall);
}

base::Result<HandledMesh> HandledMesh::create(geometry::Mesh mesh, Features features, const std::vector<Handle>& handles, double wall) {
    HandledMesh out(std::move(mesh), std::move(features), wall);
    base::Errors errors;
    for (const Handle& handle : handles) {
        base::Result<Displacement> made = displacement_of(handle, out.mesh_, out.features_);
        if (!made) {
            errors.insert(errors.end(), made.errors().begin(), made.errors().end());
            continue;
        }
        if (out.mesh_.deviation && made->features.empty())
            errors.push_back({ErrorCode::unsupported, handle.name,
                              "this handle bends faces, and the mesh stands for exact surfaces, which would not be known any more: take "
                              "features (`bores`, `pins`, `offset`, `move`), or a mesh (STL, 3MF) in its place"});
        out.names_.push_back(handle.name);
        out.displacements_.push_back(*std::move(made));
    }
    if (!errors.empty()) return errors;
    return out;
}

Matrix3X HandledMesh::moved(const std::vector<double>& values) const {
    FETTLE_ASSERT(values.size() == displacements_.size(), "one value for each handle");
    Matrix3X x = mesh_.vertices;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Displacement& d = displacements_[k];
        const double change = values[k] - d.drawn;
        if (change == 0) continue;
        for (std::size_t i = 0; i < d.vertices.size(); ++i) {
            const std::array<double, 3> by = d.at(i, mesh_.vertices.col(d.vertices[i]), change);
            x.col(d.vertices[i]) += Vector3(by[0], by[1], by[2]);
        }
    }
    return x;
}

base::Result<geometry::Mesh> HandledMesh::at(const std::vector<double>& values) const {
    for (std::size_t k = 0; k < values.size(); ++k)
        if (is_of_radius(displacements_[k].kind) && !(values[k] > 0))
            return Error{ErrorCode::out_of_range, names_[k],
                         base::formatted("%.6g mm is no radius: more than 0 is expected", 1e3 * values[k])};
    geometry::Mesh out = mesh_;
    out.vertices = moved(values);
    if (out.vertices == mesh_.vertices) return out;
    Check check(*this, values, out.vertices);
    if (std::optional<Error> fault = check.fault()) return *std::move(fault);
    const auto crossings = solids::self_intersections(out, 1);
    if (!crossings.empty() && solids::self_intersections(mesh_, 1).empty()) return check.crossing(crossings[0].first, crossings[0].second);
    if (std::optional<Error> fault = fault_of_wall(out, values)) return *std::move(fault);
    if (out.deviation) {
        // Faces beside may leave theirs by as much as the check lets through; radii are fitted. So nothing of it is proven any more.
        double beside = features_.tolerance;
        for (const Feature& feature : features_.features) beside = std::max(beside, features_.tolerance + feature.residual);
        for (double* by : {&out.deviation->in, &out.deviation->out}) *by = growth(values) * *by + beside;
        out.deviation->in_is_proven = out.deviation->out_is_proven = false;
    }
    return out;
}

// Facets of a radius that grows leave their arcs in proportion.
double HandledMesh::growth(const std::vector<double>& values) const {
    double out = 1;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (is_of_radius(displacements_[k].kind)) out = std::max(out, values[k] / displacements_[k].drawn);
    return out;
}

std::optional<Error> HandledMesh::fault_of_wall(const geometry::Mesh& mesh, const std::vector<double>& values) const {
    if (!(wall_ > 0)) return std::nullopt;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Displacement& d = displacements_[k];
        if (values[k] == d.drawn) continue;
        for (const int f : d.features) {
            const std::optional<Wall> left = wall_behind(mesh, features_.features[f]);
            if (left && left->thickness < wall_)
                return Error{ErrorCode::inconsistent, features_.features[f].name,
                             base::formatted("a wall of %.4g mm would be left behind it near ", 1e3 * left->thickness) +
                                 place_text(left->place) + base::formatted("; %.4g mm are asked for", 1e3 * wall_)};
        }
    }
    return std::nullopt;
}

std::vector<Matrix3X> HandledMesh::jacobian(const std::vector<double>& values) const {
    std::vector<Matrix3X> out;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Displacement& d = displacements_[k];
        out.emplace_back(Matrix3X::Zero(3, mesh_.vertices.cols()));
        for (std::size_t i = 0; i < d.vertices.size(); ++i)
            out.back().col(d.vertices[i]) = d.slope(i, mesh_.vertices.col(d.vertices[i]), values[k] - d.drawn);
    }
    return out;
}

HandledMesh::Recorded HandledMesh::recorded(const std::vector<double>& values) const {
    Tape tape;
    std::vector<std::array<Number, 3>> x;
    for (int v = 0; v < mesh_.vertices.cols(); ++v) x.push_back({mesh_.vertices(0, v), mesh_.vertices(1, v), mesh_.vertices(2, v)});
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Displacement& d = displacements_[k];
        const Number change = tape.input(values[k]) - Number(d.drawn);
        for (std::size_t i = 0; i < d.vertices.size(); ++i) {
            const int v = d.vertices[i];
            const std::array<Number, 3> by = d.at<Number>(i, mesh_.vertices.col(v), change);
            for (std::size_t j = 0; j < 3; ++j) x[v][j] += by[j];
        }
    }
    Recorded out;
    for (const auto& each : x) out.vertices.push_back({tape.node_of(each[0]), tape.node_of(each[1]), tape.node_of(each[2])});
    out.nodes = tape.nodes();
    return out;
}

}  // namespace fettle::core::features
